// SPDX-License-Identifier: MIT
//
// Eel-like motion, which Sec. VI leaves to future work: joint amplitudes that grow or fall along the body, in both
// models and in the mapping between them, in still water.
#include "swim.h"

enum { TAPERS = 7, SHOWN = 3, POINTS = 181 };
static const double tapers[TAPERS] = {-0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75};
static const int shown[SHOWN] = {1, 3, 5};

// The gait of the settings with a taper: mapped from one model, the other has the same theta_max in the middle.
static moray_gait tapered(const paper *p, moray_model model, double taper)
{
    moray_gait gait = p->gait[MORAY_CONTROL_ORIENTED];
    gait.taper = taper;
    return moray_gait_map(p->robot, &gait, MORAY_CONTROL_ORIENTED, model);
}

// ---- Speed and power -----------------------------------------------------------------------------------------------

typedef struct {
    double speed[2][TAPERS], power[2][TAPERS], cost[2][TAPERS];             // by model, omega of the settings
    double equal_speed[2][TAPERS], equal_cost[2][TAPERS], omega[2][TAPERS]; // at the power of no taper; NaN: cannot
} findings;

static moray_status swim(paper *p, moray_model model, findings *f)
{
    moray_swim_setup setup = {.settings = p->rig.settings};
    moray_steady steady;
    MORAY_TRY(paper_swimmer(p, p->robot, model, p->settings->reading, &setup.swimmer));
    for (int i = 0; i < TAPERS; i++) {
        const moray_gait gait = tapered(p, model, tapers[i]);
        paper_progress(p, "%s, taper %g", moray_model_name(model), tapers[i]);
        MORAY_TRY(moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0));
        f->speed[model][i] = steady.speed;
        f->power[model][i] = steady.power;
        f->cost[model][i] = steady.cost_of_transport;
    }
    for (int i = 0; i < TAPERS; i++) {
        moray_gait gait = tapered(p, model, tapers[i]);
        paper_progress(p, "%s, taper %g at equal power", moray_model_name(model), tapers[i]);
        MORAY_TRY(moray_swim_match_power(&setup, &gait, 0, f->power[model][TAPERS / 2], &steady));
        f->equal_speed[model][i] = steady.speed;
        f->equal_cost[model][i] = steady.cost_of_transport;
        f->omega[model][i] = gait.omega / DEG;
    }
    return moray_ok();
}

// One table of both models: three quantities, `of[quantity][model][taper]`.
static moray_status table(paper *p, const char *title, const char *const names[3], const double (*const of[3])[TAPERS])
{
    moray_table_row rows[TAPERS];
    moray_table made = {.title = title, .n_columns = 6, .rows = rows, .n_rows = TAPERS};
    for (int k = 0; k < 6; k++)
        made.columns[k] = paper_label(p, "%s %s", k < 3 ? "f.-p." : "c.-o.", names[k % 3]);
    for (int i = 0; i < TAPERS; i++) {
        rows[i] = (moray_table_row){.label = paper_label(p, "taper %g", tapers[i])};
        for (int k = 0; k < 6; k++)
            rows[i].value[k] = of[k % 3][paper_model_order[k / 3]][i];
    }
    return paper_table(p, &made);
}

static moray_status tell(paper *p, const findings *f)
{
    const char *const names[3] = {"m/s", "W", "J/m"}, *const equal_names[3] = {"m/s", "J/m", "deg/s"};
    const double(*const of[3])[TAPERS] = {f->speed, f->power, f->cost};
    const double(*const equal[3])[TAPERS] = {f->equal_speed, f->equal_cost, f->omega};
    MORAY_TRY(
        table(p, "Speed, power, cost of transport (f.-p.: first-principles, c.-o.: control-oriented)", names, of));
    MORAY_TRY(table(p, "At the power that each model needs without taper: speed, cost of transport, omega", equal_names,
                    equal));
    moray_json_numbers(p->json, "taper", tapers, TAPERS);
    for (int model = 0; model < 2; model++) {
        moray_json_open(p->json, model == MORAY_CONTROL_ORIENTED ? "control" : "fp");
        moray_json_numbers(p->json, "speed_m_s", f->speed[model], TAPERS);
        moray_json_numbers(p->json, "power_W", f->power[model], TAPERS);
        moray_json_numbers(p->json, "cost_of_transport_J_m", f->cost[model], TAPERS);
        moray_json_numbers(p->json, "equal_power_speed_m_s", f->equal_speed[model], TAPERS);
        moray_json_numbers(p->json, "equal_power_omega_deg_s", f->omega[model], TAPERS);
        moray_json_close(p->json);
    }
    return moray_ok();
}

static moray_status draw(paper *p, const findings *f)
{
    const double *const speed[2] = {f->speed[0], f->speed[1]};
    const double *const equal[2] = {f->equal_speed[0], f->equal_speed[1]};
    moray_column columns[7] = {{.name = "taper", .values = tapers}};
    for (int k = 0; k < 2; k++) {
        const moray_model model = paper_model_order[k];
        const char *name = moray_model_name(model);
        columns[1 + k] = (moray_column){paper_label(p, "speed %s", name), "m/s", f->speed[model], 1};
        columns[3 + k] = (moray_column){paper_label(p, "power %s", name), "W", f->power[model], 1};
        columns[5 + k] =
            (moray_column){paper_label(p, "speed at equal power %s", name), "m/s", f->equal_speed[model], 1};
    }
    MORAY_TRY(paper_csv(p, NULL, columns, 7, TAPERS));
    MORAY_TRY(paper_compare(p, "speed", "Eel-like motion at one frequency", "taper (below 0: larger at the tail)",
                            "speed [m/s]", tapers, speed, TAPERS));
    return paper_compare(p, "equal_power", "Eel-like motion at one power for each model",
                         "taper (below 0: larger at the tail)", "speed [m/s]", tapers, equal, TAPERS);
}

// ---- Link angles ---------------------------------------------------------------------------------------------------

// Amplitude of link i = 0..N-1 by moray/snake.h.
static double by_formula(const paper *p, moray_model model, double taper, int i)
{
    const int N = p->robot->links;
    const moray_gait gait = tapered(p, model, taper);
    const double s = 2 * (i - 0.5) / (N - 2) - 1, half = tan(gait.delta / 2);
    const double middle = model == MORAY_CONTROL_ORIENTED ? gait.amplitude * cos(gait.delta / 2) / (2 * p->robot->l)
                                                          : gait.amplitude / (2 * sin(gait.delta / 2));
    return middle * hypot(1 + taper * s, taper / (N - 2) * (model == MORAY_CONTROL_ORIENTED ? half : 1 / half));
}

// Half of what the orientation of each link sweeps over in a period of steady swimming.
static moray_status simulate_links(paper *p, moray_model model, double taper, double *amplitude)
{
    const double still[2] = {0, 0};
    const int N = p->robot->links;
    const moray_gait gait = tapered(p, model, taper);
    const moray_swimmer *swimmer = p->rig.swimmer[model];
    moray_swim_track *orbit;
    double *angle, *unused;
    MORAY_TRY(paper_numbers(p, (size_t)N * POINTS, &angle));
    MORAY_TRY(paper_numbers(p, 2 * (size_t)N, &unused));
    MORAY_TRY(paper_orbit_in(p, still, model, &gait, POINTS, NULL, &orbit));
    for (int k = 0; k < orbit->n; k++)
        moray_swimmer_links(swimmer, orbit->x + (size_t)k * orbit->n_states, unused, unused + N, angle + k * N);
    for (int i = 0; i < N; i++)
        amplitude[i] = paper_half_range(angle + i, N, orbit->n) / DEG;
    return moray_ok();
}

static moray_status draw_links(paper *p, moray_model model)
{
    const int N = p->robot->links;
    double *data;
    moray_curve curves[2 * SHOWN];
    MORAY_TRY(paper_numbers(p, (size_t)N * (1 + 2 * SHOWN), &data));
    for (int i = 0; i < N; i++)
        data[i] = i + 1;
    for (int k = 0; k < SHOWN; k++) {
        const double taper = tapers[shown[k]];
        double *formula = data + (1 + 2 * k) * N, *simulated = formula + N;
        for (int i = 0; i < N; i++)
            formula[i] = by_formula(p, model, taper, i) / DEG;
        MORAY_TRY(simulate_links(p, model, taper, simulated));
        curves[k] = (moray_curve){.label = paper_label(p, "taper %g, derived", taper), data, formula, N};
        curves[SHOWN + k] = (moray_curve){.label = paper_label(p, "taper %g, simulated", taper),
                                          .x = data,
                                          .y = simulated,
                                          .n = N,
                                          .style = MORAY_CURVE_POINTS};
    }
    return paper_figure(
        p, &(moray_figure){.name = model == MORAY_CONTROL_ORIENTED ? "links_control" : "links_fp",
                           .title = paper_label(p, "Swing of the links, %s model", moray_model_name(model)),
                           .x_label = "link (1: tail)",
                           .y_label = "amplitude of the link angle [deg]",
                           .curves = curves,
                           .n_curves = 2 * SHOWN});
}

// ---- All of it -----------------------------------------------------------------------------------------------------

moray_status paper_eel(paper *p)
{
    findings f;
    for (int k = 0; k < 2; k++)
        MORAY_TRY(swim(p, paper_model_order[k], &f));
    MORAY_TRY(tell(p, &f));
    MORAY_TRY(paper_say(p,
                        "The amplitude of joint i is alpha (1 + taper s_i), with s_i from -1 at the tail to 1 at the "
                        "head. (27) and (33) then hold where s = 0, in the middle; link i, between two joints, swings "
                        "with theta_max (1 + taper s), s taken halfway between them, but for terms of second "
                        "order: theta_max sqrt((1 + taper s)^2 + (taper cot(delta/2)/(N-2))^2) for revolute joints, "
                        "with tan in place of cot for prismatic ones. So the same taper serves both models. On top "
                        "of it comes the swing that all links share, which the water decides."));
    MORAY_TRY(draw(p, &f));
    for (int k = 0; k < 2; k++)
        MORAY_TRY(draw_links(p, paper_model_order[k]));
    return moray_ok();
}
