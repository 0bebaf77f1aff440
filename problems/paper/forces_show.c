// SPDX-License-Identifier: MIT
//
// Property 1, Fig. 2 and Remark 3 on the first-principles model.
#include "forces.h"

static const char *const meanings[TERMS] = {
    "I     added mass, along",   "II    added mass, across",  "III   drag, along", "IV    drag, across",
    "V     added mass with V_x", "VI    added mass with V_y", "VII   drag of V_x", "VIII  drag of V_y"};

// ---- One period ----------------------------------------------------------------------------------------------------

static moray_status show_terms(paper *p, const char *title, const force_terms *f)
{
    moray_table_row rows[TERMS + 1];
    for (int j = 0; j < TERMS; j++)
        rows[j] = (moray_table_row){.label = meanings[j],
                                    .value = {f->mean[j], f->peak[j], 100 * f->share[j], 100 * f->cancelled[j]}};
    rows[TERMS] = (moray_table_row){.label = "sum of all less N m p_x''", .value = {NAN, f->residual, NAN, NAN}};
    return paper_rows(p, title, PAPER_HEADS("mean [N]", "peak [N]", "share [%]", "cancelled [%]"), rows, TERMS + 1);
}

static void json_terms(moray_json *json, const char *key, const force_terms *f)
{
    moray_json_open(json, key);
    for (int j = 0; j < TERMS; j++) {
        moray_json_object(json, term_names[j],
                          MORAY_MEMBERS({"mean_N", f->mean[j]}, {"peak_N", f->peak[j]},
                                        {"share_percent", 100 * f->share[j]},
                                        {"cancelled_percent", 100 * f->cancelled[j]}));
    }
    moray_json_number(json, "residual_N", f->residual);
    moray_json_close(json);
}

// The terms values[TERMS * n] over x[n] as a file and as curves: the larger ones, and what the others come to.
static moray_status show_curves(paper *p, const moray_figure *frame, const moray_column *x, const double *values, int n,
                                moray_curve_style style)
{
    enum { SHOWN = 5, REST = SHOWN, ALL, CURVES };
    static const int shown[SHOWN] = {3, 2, 6, 7, 1};
    moray_column columns[1 + TERMS] = {*x};
    moray_curve curves[CURVES];
    double *sums;
    MORAY_TRY(paper_numbers(p, (size_t)(2 * n), &sums));
    for (int j = 0; j < TERMS; j++) {
        columns[1 + j] = (moray_column){.name = term_names[j], .unit = "N", .values = values + j * n};
        for (int k = 0; k < n; k++) {
            sums[k] += j == 0 || j == 4 || j == 5 ? values[j * n + k] : 0;
            sums[n + k] += values[j * n + k];
        }
    }
    for (int s = 0; s < CURVES; s++)
        curves[s] = (moray_curve){.label = s < SHOWN   ? meanings[shown[s]]
                                           : s == REST ? "I + V + VI"
                                                       : "all",
                                  .x = x->values,
                                  .y = s < SHOWN ? values + shown[s] * n : sums + (s - REST) * n,
                                  .n = n,
                                  .style = style};
    moray_figure figure = *frame;
    figure.y_label = "force along the heading [N]";
    figure.curves = curves;
    figure.n_curves = CURVES;
    MORAY_TRY(paper_csv(p, frame->name, columns, 1 + TERMS, n));
    return paper_figure(p, &figure);
}

static moray_status draw_period(paper *p, const chain *c, const force_terms *f)
{
    double *number;
    MORAY_TRY(paper_numbers(p, (size_t)c->N, &number));
    for (int i = 0; i < c->N; i++)
        number[i] = i + 1;
    const moray_column time = {.name = "t", .unit = "s", .values = c->orbit->t},
                       link = {.name = "link", .values = number};
    const moray_figure over_time = {.name = "terms",
                                    .title = "Terms of (6), summed over the links",
                                    .x_label = "time [s]"},
                       of_link = {.name = "links", .title = "Terms of (6), means over a period", .x_label = "link"},
                       at_once = {.name = "fig2", .title = "Fig. 2: terms of (6) at one instant", .x_label = "link"};
    MORAY_TRY(show_curves(p, &over_time, &time, f->over_time, CHAIN_POINTS, MORAY_CURVE_LINE));
    MORAY_TRY(show_curves(p, &of_link, &link, f->of_link, c->N, MORAY_CURVE_MARKED));
    return show_curves(p, &at_once, &link, f->at_once, c->N, MORAY_CURVE_MARKED);
}

// ---- Other phase shifts (Remark 3) ---------------------------------------------------------------------------------

typedef struct shift {
    double delta;
    force_terms f;
} shift;

static moray_status swim_shift(paper *p, double delta, shift *s)
{
    chain c;
    moray_gait gait = p->gait[MORAY_FIRST_PRINCIPLES];
    gait.delta = delta;
    gait.amplitude =
        moray_amplitude_from_theta_max(p->robot, MORAY_FIRST_PRINCIPLES, p->settings->theta_max, gait.delta);
    s->delta = delta;
    paper_progress(p, "delta %.0f deg", delta / DEG);
    MORAY_TRY(chain_swim(p, p->rig.current, &gait, &c));
    return force_terms_of(p, &c, &s->f);
}

static moray_status show_shifts(paper *p, const shift *s, int n)
{
    moray_table_row shares[TERMS], peaks[TERMS];
    moray_table table = {.n_columns = n, .rows = shares, .n_rows = TERMS};
    for (int k = 0; k < n; k++)
        table.columns[k] = paper_label(p, "%.3g deg", s[k].delta / DEG);
    for (int j = 0; j < TERMS; j++) {
        shares[j] = peaks[j] = (moray_table_row){.label = meanings[j], .unit = "%"};
        for (int k = 0; k < n; k++) {
            shares[j].value[k] = 100 * s[k].f.share[j];
            peaks[j].value[k] = 100 * s[k].f.peak[j] / s[k].f.thrust;
        }
    }
    table.title = "Remark 3: share of each term at other phase shifts delta";
    MORAY_TRY(paper_table(p, &table));
    table.title = "Remark 3: peak of each term in the sum over the links, against the mean thrust";
    table.rows = peaks;
    return paper_table(p, &table);
}

static void json_shifts(moray_json *json, const shift *s, int n)
{
    moray_json_open_list(json, "by_delta");
    for (int k = 0; k < n; k++) {
        moray_json_open(json, NULL);
        moray_json_number(json, "delta_deg", s[k].delta / DEG);
        json_terms(json, "terms", &s[k].f);
        moray_json_close(json);
    }
    moray_json_close(json);
}

static moray_status draw_shifts(paper *p)
{
    enum { MOST = 16, ROWS = 1 + TERMS };
    const double full = 2 * M_PI / (p->robot->links - 1);
    double values[ROWS][MOST];
    int n = 0;
    for (int k = 0; k < MOST; k++) {
        shift s;
        if (full * (5 + k) / 10 >= 170 * DEG)
            break;
        MORAY_TRY(swim_shift(p, full * (5 + k) / 10, &s));
        values[TERMS][n] = s.delta / DEG;
        for (int j = 0; j < TERMS; j++)
            values[j][n] = 100 * s.f.share[j];
        n++;
    }
    enum { SHOWN = 4 };
    static const int shown[SHOWN] = {4, 3, 7, 2};
    const char *labels[SHOWN];
    moray_column columns[ROWS] = {{.name = "delta", .unit = "deg", .values = values[TERMS]}};
    for (int j = 0; j < TERMS; j++)
        columns[1 + j] = (moray_column){.name = term_names[j], .unit = "%", .values = values[j]};
    for (int c = 0; c < SHOWN; c++)
        labels[c] = meanings[shown[c] - 1];
    return paper_draw(p, &(paper_graph){"shares", "Remark 3: share of the terms of (6) in the mean thrust",
                                        "phase shift delta [deg]", "share [%]", columns, ROWS, n, MORAY_CURVE_MARKED,
                                        labels, shown, SHOWN});
}

static moray_status leave_full_wave(paper *p)
{
    const int N = p->robot->links;
    const double full = 2 * M_PI / (N - 1),
                 deltas[] = {0.5 * full, 0.75 * full, 2 * M_PI / N, full, 1.5 * full, 2 * full};
    shift s[MORAY_TABLE_COLUMNS];
    int n = 0;
    for (unsigned k = 0; k < sizeof deltas / sizeof *deltas; k++)
        if (deltas[k] < 170 * DEG)
            MORAY_TRY(swim_shift(p, deltas[k], &s[n++]));
    MORAY_TRY(show_shifts(p, s, n));
    json_shifts(p->json, s, n);
    return draw_shifts(p);
}

// ---- The study -----------------------------------------------------------------------------------------------------

static moray_status conclude(paper *p, const chain *c, const force_terms *f)
{
    const double swing = chain_heading_swing(c);
    double rest = 0;
    const int cancelling[] = {1, 4, 5, 7};
    for (int k = 0; k < 4; k++)
        rest = fmax(rest, fabs(f->share[cancelling[k]]));
    MORAY_TRY(paper_say(p,
                        "Property 1, in the mean over a period: IV gives %.1f %% of the thrust, VII %.1f %%, and III "
                        "takes %.1f %% of it; I comes to %.2f %%, and none of II, V, VI, VIII to more than %.2f %%.",
                        100 * f->share[3], 100 * f->share[6], -100 * f->share[2], 100 * f->share[0], 100 * rest));
    if (f->peak[7] == 0)
        return moray_ok();
    return paper_say(p,
                     "At an instant they do not all cancel: VIII reaches %.2f N. Fig. 2 cancels it over a wave that "
                     "stands still in heading, whereas the heading of the robot swings by %.1f deg to either side, and "
                     "N (c_n - c_t) V_y times that is %.2f N.",
                     f->peak[7], swing / DEG,
                     p->robot->links * (p->robot->c_n - p->robot->c_t) * fabs(c->current[1]) * swing);
}

static moray_status swim(paper *p, const double current[2], const char *title, const char *key, chain *c,
                         force_terms *f)
{
    paper_progress(p, "%s", title);
    MORAY_TRY(chain_swim(p, current, &p->gait[MORAY_FIRST_PRINCIPLES], c));
    MORAY_TRY(force_terms_of(p, c, f));
    json_terms(p->json, key, f);
    return show_terms(p, title, f);
}

moray_status paper_forces(paper *p)
{
    const double still[2] = {0, 0}, *V = p->rig.current;
    chain c;
    force_terms f;
    MORAY_TRY(swim(p, still, "Terms of (6) in still water", "still_water", &c, &f));
    if (V[0] != 0 || V[1] != 0)
        MORAY_TRY(swim(p, V, "Terms of (6) in the current", "current", &c, &f));
    MORAY_TRY(draw_period(p, &c, &f));
    MORAY_TRY(conclude(p, &c, &f));
    return leave_full_wave(p);
}
