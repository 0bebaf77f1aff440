// SPDX-License-Identifier: MIT
//
// Errata in the equations of the control-oriented model: as printed beside as corrected.
#include "errata.h"

enum { PERIODS = 15, LAST = 5, PER_PERIOD = 60, SAMPLES = PERIODS * PER_PERIOD + 1, POINTS = 361 };

static moray_status swimmer_reading(paper *p, paper_reading reading, moray_swimmer **swimmer)
{
    return paper_swimmer(p, p->robot, MORAY_CONTROL_ORIENTED, reading, swimmer);
}

static double period_of(const paper *p)
{
    return 2 * M_PI / p->settings->omega;
}

// ---- E1 ------------------------------------------------------------------------------------------------------------

// dv_n in the states of the corrected model's steady swimming.
static moray_status acceleration(paper *p, paper_reading reading, const moray_swim_track *orbit, double *dv_n)
{
    const moray_gait *gait = &p->gait[MORAY_CONTROL_ORIENTED];
    moray_swimmer *swimmer;
    double *ubar;
    MORAY_TRY(swimmer_reading(p, reading, &swimmer));
    MORAY_TRY(paper_numbers(p, (size_t)(orbit->n_joints + orbit->n_states), &ubar));
    for (int k = 0; k < orbit->n; k++) {
        const double *x = orbit->x + k * orbit->n_states;
        moray_swimmer_control(swimmer, gait, orbit->t[k], x, ubar);
        if (!moray_swimmer_rates(swimmer, x, ubar, ubar + orbit->n_joints, NULL))
            return moray_error(MORAY_NUMERIC, "the control-oriented model is singular at t = %g", orbit->t[k]);
        dv_n[k] = ubar[orbit->n_joints + orbit->n_states - 1];
    }
    return moray_ok();
}

static double root_mean_square(const double *values, int n)
{
    double sum = 0;
    for (int k = 0; k < n; k++)
        sum += values[k] * values[k] / n;
    return sqrt(sum);
}

static moray_status corrected_orbit(paper *p, moray_swim_track **orbit)
{
    moray_swim_setup setup = moray_test_rig_setup(&p->rig, MORAY_CONTROL_ORIENTED);
    MORAY_TRY(swimmer_reading(p, PAPER_CORRECTED, &setup.swimmer));
    return paper_orbit_of(p, &setup, &p->gait[MORAY_CONTROL_ORIENTED], POINTS, NULL, orbit);
}

// From rest: v_n of every sample, NaN where the simulation has broken off, and mean v_x of the last five periods.
typedef struct sway {
    double t[SAMPLES], v_n[SAMPLES], v_x, dv_n_rms;
} sway;

// That the equations as printed cannot be simulated to the end would be a finding, too.
static moray_status swim_23h(paper *p, paper_reading reading, sway *s)
{
    const moray_gait_change change = {0, p->gait[MORAY_CONTROL_ORIENTED]};
    const double step = period_of(p) / PER_PERIOD;
    paper_swim_plan plan = {.model = MORAY_CONTROL_ORIENTED, .schedule = &change, .n_changes = 1};
    moray_swim_track *track;
    MORAY_TRY(swimmer_reading(p, reading, &plan.swimmer));
    const moray_status status = paper_swim(p, &plan, (SAMPLES - 1) * step, step, &track);
    if (moray_failed(status) && !(status.code == MORAY_NUMERIC && reading != PAPER_CORRECTED))
        return status;
    for (int k = 0; k < SAMPLES; k++) {
        s->t[k] = k * step;
        s->v_n[k] = k < track->n ? track->x[(k + 1) * track->n_states - 1] : NAN;
    }
    const int last = SAMPLES - 1, from = last - LAST * PER_PERIOD;
    s->v_x = track->n == SAMPLES ? (track->pose[last].p_x - track->pose[from].p_x) / (s->t[last] - s->t[from]) : NAN;
    return moray_ok();
}

static moray_status draw_23h(paper *p, const sway *printed, const sway *corrected)
{
    static const char *const labels[] = {"(16c)", "(23h) as printed"};
    const moray_column columns[] = {{.name = "t", .unit = "s", .values = printed->t},
                                    {.name = "v_n by (16c)", .unit = "m/s", .values = corrected->v_n},
                                    {.name = "v_n by (23h)", .unit = "m/s", .values = printed->v_n}};
    return paper_draw(p, &(paper_graph){"e1", "E1: lateral velocity from rest, control-oriented model", "time [s]",
                                        "v_n [m/s]", columns, 3, SAMPLES, .labels = labels});
}

static void json_23h(moray_json *json, const char *key, const sway *s)
{
    moray_json_object(
        json, key,
        MORAY_MEMBERS({"dv_n_rms_m_s2", s->dv_n_rms}, {"v_n_m_s", s->v_n[SAMPLES - 1]}, {"v_x_m_s", s->v_x}));
}

moray_status erratum_23h(paper *p)
{
    static const paper_reading readings[] = {PAPER_23H_PRINTED, PAPER_CORRECTED};
    static sway s[2]; // printed, corrected
    moray_swim_track *orbit;
    double dv_n[POINTS];
    MORAY_TRY(corrected_orbit(p, &orbit));
    for (int c = 0; c < 2; c++) {
        MORAY_TRY(acceleration(p, readings[c], orbit, dv_n));
        MORAY_TRY(swim_23h(p, readings[c], &s[c]));
        s[c].dv_n_rms = root_mean_square(dv_n, POINTS);
    }
    const moray_table_row rows[] = {
        {.label = "dv_n/dt in the corrected model's steady swimming, root mean square",
         .value = {s[0].dv_n_rms, s[1].dv_n_rms},
         .unit = "m/s^2"},
        {.label = paper_label(p, "v_n after %.4g s from rest", s[0].t[SAMPLES - 1]),
         .value = {s[0].v_n[SAMPLES - 1], s[1].v_n[SAMPLES - 1]},
         .unit = "m/s"},
        {.label = "v_x, mean of the last five periods of them", .value = {s[0].v_x, s[1].v_x}, .unit = "m/s"},
    };
    moray_json_open(p->json, "e1");
    json_23h(p->json, "as_printed", &s[0]);
    json_23h(p->json, "corrected", &s[1]);
    moray_json_close(p->json);
    MORAY_TRY(paper_rows(p, "E1: (23h) has h_4 and h_5 the other way round than (16c)",
                         PAPER_HEADS("as printed", "corrected"), rows, 3));
    return draw_23h(p, &s[0], &s[1]);
}

// ---- E2 ------------------------------------------------------------------------------------------------------------

enum { AMPLITUDES = 6, WAYS = 3 }; // ways: first principles, L = 2l, l for L

static moray_status speed(paper *p, int way, double theta_max, double *v_x)
{
    const moray_model model = way == 0 ? MORAY_FIRST_PRINCIPLES : MORAY_CONTROL_ORIENTED;
    const moray_gait_change change = {0, paper_gait(p, model, theta_max)};
    paper_swim_plan plan = {.model = model, .schedule = &change, .n_changes = 1};
    MORAY_TRY(paper_swimmer(p, p->robot, model, way == 2 ? PAPER_L_PRINTED : PAPER_CORRECTED, &plan.swimmer));
    return paper_mean_velocity(p, &plan, PERIODS * period_of(p), LAST, v_x);
}

// (12) over the true link angle, for the small angles of the gait (24) inside the body: with phi of (28), both sines.
static double estimate_of_link_angle(const paper *p, double L)
{
    const double half = cos(p->settings->delta / 2);
    return 2 * p->robot->l * half * half / L;
}

static moray_status draw_half_link(paper *p, const double *theta_max, double v_x[WAYS][AMPLITUDES])
{
    const moray_column columns[] = {{.name = "theta_max", .unit = "deg", .values = theta_max},
                                    {.name = "first-principles", .unit = "m/s", .values = v_x[0]},
                                    {.name = "control-oriented, L = 2l", .unit = "m/s", .values = v_x[1]},
                                    {.name = "control-oriented, l as printed", .unit = "m/s", .values = v_x[2]}};
    return paper_draw(p, &(paper_graph){"e2", "E2: straight motion, l of (8), (12), (13) as 2l and as printed",
                                        "theta_max [deg]", "mean v_x [m/s]", columns, 1 + WAYS, AMPLITUDES,
                                        .style = MORAY_CURVE_MARKED});
}

moray_status erratum_half_link(paper *p)
{
    static const double theta_max[AMPLITUDES] = {5, 10, 15, 20, 25, 30};
    double v_x[WAYS][AMPLITUDES];
    moray_table_row rows[AMPLITUDES + 1];
    for (int k = 0; k < AMPLITUDES; k++) {
        paper_progress(p, "E2, theta_max %g deg", theta_max[k]);
        for (int way = 0; way < WAYS; way++)
            MORAY_TRY(speed(p, way, theta_max[k] * DEG, &v_x[way][k]));
        rows[k] = (moray_table_row){.label = paper_label(p, "mean v_x, theta_max %g deg", theta_max[k]),
                                    .value = {v_x[2][k], v_x[1][k], v_x[0][k]},
                                    .unit = "m/s"};
    }
    const double l = p->robot->l;
    rows[AMPLITUDES] = (moray_table_row){.label = "small link angle by (12), in parts of the true one",
                                         .value = {estimate_of_link_angle(p, l), estimate_of_link_angle(p, 2 * l), 1}};
    moray_json_open(p->json, "e2");
    moray_json_numbers(p->json, "theta_max_deg", theta_max, AMPLITUDES);
    moray_json_numbers(p->json, "v_x_printed_m_s", v_x[2], AMPLITUDES);
    moray_json_numbers(p->json, "v_x_corrected_m_s", v_x[1], AMPLITUDES);
    moray_json_numbers(p->json, "v_x_fp_m_s", v_x[0], AMPLITUDES);
    moray_json_close(p->json);
    MORAY_TRY(paper_rows(p, "E2: l of (8), (12), (13) is a whole link, elsewhere half a link",
                         PAPER_HEADS("as printed", "L = 2l", "first-principles"), rows, AMPLITUDES + 1));
    MORAY_TRY(
        paper_say(p,
                  "E2: Sec. V-B finds good accordance at 10 and 15 deg and too much speed of the simplified model "
                  "beyond, which is so with L = 2l only. At %g deg, where the assumption of small angles holds best, "
                  "the speed is %+.1f %% off the "
                  "first-principles model's with L = 2l and %+.1f %% with l as printed.",
                  theta_max[0], 100 * (v_x[1][0] / v_x[0][0] - 1), 100 * (v_x[2][0] / v_x[0][0] - 1)));
    return draw_half_link(p, theta_max, v_x);
}
