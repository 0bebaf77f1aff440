// SPDX-License-Identifier: MIT
//
// Property 3: turning by the joint offset phi_0, which is given in parts of the joint amplitude so that both models
// share it.
#include "swim.h"

static const double still[2] = {0, 0};

// What the studies found of the claims, by moray_model.
typedef struct claims {
    bool straight[2], clockwise[2], grows[2], grows_with_speed[2];
} claims;

static moray_gait offset_gait(const paper *p, int model, double ratio, double omega)
{
    moray_gait gait = p->gait[model];
    gait.offset = ratio * gait.amplitude;
    gait.omega = omega;
    return gait;
}

static moray_status swim(paper *p, int model, double ratio, double omega, moray_steady *steady)
{
    moray_swim_track *orbit;
    const moray_gait gait = offset_gait(p, model, ratio, omega);
    paper_progress(p, "phi_0 = %.3g of the amplitude, omega %.0f deg/s", ratio, omega / DEG);
    return paper_orbit_in(p, still, (moray_model)model, &gait, 2, steady, &orbit);
}

// Of a rate [rad/s] what is not rounding.
static double tidy(double rate)
{
    return fabs(rate) < 1e-9 ? 0 : rate;
}

// ---- By offset -----------------------------------------------------------------------------------------------------

static void json_swim(moray_json *json, const char *key, double value, const moray_steady steady[2])
{
    const double rates[2] = {steady[0].heading_drift / DEG, steady[1].heading_drift / DEG};
    const double speeds[2] = {steady[0].speed, steady[1].speed};
    moray_json_object(json, NULL,
                      MORAY_MEMBERS({key, value}, {"control_turning_deg_s", rates[MORAY_CONTROL_ORIENTED]},
                                    {"fp_turning_deg_s", rates[MORAY_FIRST_PRINCIPLES]},
                                    {"control_speed_m_s", speeds[MORAY_CONTROL_ORIENTED]},
                                    {"fp_speed_m_s", speeds[MORAY_FIRST_PRINCIPLES]}));
}

static moray_status draw_offsets(paper *p, const double *ratio, const double *turning, int n)
{
    const moray_column columns[] = {{"phi_0 / amplitude", NULL, ratio, 1},
                                    {moray_model_name(0), "deg/s", turning, 1},
                                    {moray_model_name(1), "deg/s", turning + n, 1}};
    return paper_draw(p, &(paper_graph){NULL, "Property 3: turning by the joint offset, in still water",
                                        "phi_0 / joint amplitude", "turning rate, counter-clockwise [deg/s]", columns,
                                        3, n, .style = MORAY_CURVE_MARKED});
}

// turning[n] at ascending offsets, of which the one in the middle is zero.
static void judge_offsets(const double *turning, int n, int model, claims *found)
{
    const double middle = turning[n / 2];
    found->straight[model] = fabs(middle) < 1e-3 * fabs(turning[0]);
    found->clockwise[model] = turning[n - 1] < 0 && turning[0] > 0;
    found->grows[model] = true;
    for (int k = 1; k < n; k++)
        if ((turning[k] - turning[k - 1]) * (turning[n - 1] - turning[0]) <= 0)
            found->grows[model] = false;
}

static moray_status vary_offset(paper *p, claims *found)
{
    static const double ratio[] = {-1. / 3, -1. / 4, -1. / 6, -1. / 12, 0, 1. / 12, 1. / 6, 1. / 4, 1. / 3};
    enum { N = sizeof ratio / sizeof *ratio };
    moray_table_row rows[N];
    double turning[2 * N];
    moray_json_open_list(p->json, "by_offset");
    for (int k = 0; k < N; k++) {
        moray_steady steady[2];
        for (int model = 0; model < 2; model++) {
            MORAY_TRY(swim(p, model, ratio[k], p->settings->omega, &steady[model]));
            turning[model * N + k] = tidy(steady[model].heading_drift) / DEG;
        }
        rows[k] = (moray_table_row){.label = paper_label(p, "phi_0 = %+.3f of the amplitude", ratio[k]),
                                    .value = {100 * ratio[k] * p->gait[0].amplitude, turning[k], steady[0].speed,
                                              ratio[k] * p->gait[1].amplitude / DEG, turning[N + k], steady[1].speed}};
        json_swim(p->json, "offset_of_amplitude", ratio[k], steady);
    }
    moray_json_close(p->json);
    for (int model = 0; model < 2; model++)
        judge_offsets(turning + model * N, N, model, found);
    MORAY_TRY(paper_rows(
        p,
        "Property 3: turning rate (counter-clockwise) by the joint offset, in still water; "
        "control-oriented model left, first-principles model right",
        PAPER_HEADS("phi_0 [cm]", "rate [deg/s]", "speed [m/s]", "phi_0 [deg]", "rate [deg/s]", "speed [m/s]"), rows,
        N));
    return draw_offsets(p, ratio, turning, N);
}

// ---- By speed ------------------------------------------------------------------------------------------------------

enum { SPEEDS = 6 };

static moray_status draw_speeds(paper *p, double speed[2][SPEEDS], double turning[2][SPEEDS])
{
    moray_curve curves[2];
    moray_column columns[4];
    for (int model = 0; model < 2; model++) {
        curves[model] = (moray_curve){.label = moray_model_name(model),
                                      .x = speed[model],
                                      .y = turning[model],
                                      .n = SPEEDS,
                                      .style = MORAY_CURVE_MARKED};
        columns[2 * model] = (moray_column){.name = model ? "speed, first-principles" : "speed, control-oriented",
                                            .unit = "m/s",
                                            .values = speed[model]};
        columns[2 * model + 1] = (moray_column){.name = model ? "rate, first-principles" : "rate, control-oriented",
                                                .unit = "deg/s",
                                                .values = turning[model]};
    }
    MORAY_TRY(paper_csv(p, "speed", columns, 4, SPEEDS));
    return paper_figure(p, &(moray_figure){.name = "speed",
                                           .title = "Property 3: turning by speed, phi_0 a sixth of the amplitude",
                                           .x_label = "speed through the water [m/s]",
                                           .y_label = "magnitude of the turning rate [deg/s]",
                                           .curves = curves,
                                           .n_curves = 2});
}

static moray_status vary_speed(paper *p, claims *found)
{
    static const double factor[SPEEDS] = {0.25, 0.5, 0.75, 1, 1.5, 2};
    moray_table_row rows[SPEEDS];
    double speed[2][SPEEDS], turning[2][SPEEDS];
    moray_json_open_list(p->json, "by_speed");
    for (int k = 0; k < SPEEDS; k++) {
        moray_steady steady[2];
        const double omega = factor[k] * p->settings->omega;
        for (int model = 0; model < 2; model++) {
            MORAY_TRY(swim(p, model, 1. / 6, omega, &steady[model]));
            speed[model][k] = steady[model].speed;
            turning[model][k] = fabs(steady[model].heading_drift) / DEG;
            found->grows_with_speed[model] =
                k == 0 || (found->grows_with_speed[model] && turning[model][k] > turning[model][k - 1] &&
                           speed[model][k] > speed[model][k - 1]);
        }
        rows[k] = (moray_table_row){
            .label = paper_label(p, "omega %.4g deg/s", omega / DEG),
            .value = {speed[0][k], steady[0].heading_drift / DEG, fabs(steady[0].heading_drift) / speed[0][k],
                      speed[1][k], steady[1].heading_drift / DEG, fabs(steady[1].heading_drift) / speed[1][k]}};
        json_swim(p->json, "omega_deg_s", omega / DEG, steady);
    }
    moray_json_close(p->json);
    MORAY_TRY(paper_rows(
        p,
        "Property 3: turning rate by speed, phi_0 a sixth of the amplitude, in still water; "
        "control-oriented model left, first-principles model right",
        PAPER_HEADS("speed [m/s]", "rate [deg/s]", "curv. [1/m]", "speed [m/s]", "rate [deg/s]", "curv. [1/m]"), rows,
        SPEEDS));
    return draw_speeds(p, speed, turning);
}

// ---- In the current ------------------------------------------------------------------------------------------------

// Time of a whole turn after sample `from`, by its pose once a period; NaN when the track ends before.
static double turn_time(const moray_swim_track *track, int from)
{
    for (int k = from + 1; k < track->n; k++) {
        const double before = fabs(track->pose[k - 1].heading - track->pose[from].heading);
        const double now = fabs(track->pose[k].heading - track->pose[from].heading);
        if (now >= 2 * M_PI)
            return track->t[k - 1] + (track->t[k] - track->t[k - 1]) * (2 * M_PI - before) / (now - before) -
                   track->t[from];
    }
    return NAN;
}

// Mean rate over a whole turn in the current of the settings, once the start is over.
static moray_status turn_once(paper *p, int model, double still_rate, double *rate)
{
    enum { START = 10, MOST = 2000 };
    const moray_gait gait = offset_gait(p, model, 1. / 6, p->settings->omega);
    const double period = 2 * M_PI / gait.omega, needed = START + 2 * (2 * M_PI / fabs(still_rate)) / period;
    const int n = needed < MOST ? (int)needed : MOST;
    const moray_gait_change change = {.t = 0, .gait = gait};
    const paper_swim_plan plan = {.model = (moray_model)model, .schedule = &change, .n_changes = 1};
    moray_swim_track *track;
    MORAY_TRY(paper_swim(p, &plan, (n - 1) * period, period, &track));
    *rate = copysign(2 * M_PI / turn_time(track, START), track->pose[n - 1].heading - track->pose[START].heading);
    return moray_ok();
}

static moray_status turn_in_current(paper *p)
{
    double rate[2];
    moray_steady steady[2];
    moray_table_row rows[2];
    for (int model = 0; model < 2; model++) {
        MORAY_TRY(swim(p, model, 1. / 6, p->settings->omega, &steady[model]));
        MORAY_TRY(turn_once(p, model, steady[model].heading_drift, &rate[model]));
        rows[model] = (moray_table_row){.label = moray_model_name(model),
                                        .value = {steady[model].heading_drift / DEG, rate[model] / DEG,
                                                  100 * (rate[model] / steady[model].heading_drift - 1)}};
    }
    moray_json_numbers(p->json, "mean_turning_in_current_rad_s", rate, 2);
    return paper_rows(p, "Turning rate over a whole turn, phi_0 a sixth of the amplitude",
                      PAPER_HEADS("still water [deg/s]", "current [deg/s]", "change [%]"), rows, 2);
}

static const char *yes(bool claim)
{
    return claim ? "yes" : "NO";
}

moray_status paper_offset(paper *p)
{
    claims found;
    MORAY_TRY(vary_offset(p, &found));
    MORAY_TRY(vary_speed(p, &found));
    MORAY_TRY(turn_in_current(p));
    for (int model = 1; model >= 0; model--)
        MORAY_TRY(paper_say(p,
                            "Property 3, %s model: straight without offset: %s; a positive offset turns it clockwise: "
                            "%s; faster with more offset: %s; faster at more speed: %s.",
                            moray_model_name(model), yes(found.straight[model]), yes(found.clockwise[model]),
                            yes(found.grows[model]), yes(found.grows_with_speed[model])));
    return paper_say(p, "That the two models turn opposite ways is erratum E3: (1) and (20) disagree in the sign of "
                        "phi_0.");
}
