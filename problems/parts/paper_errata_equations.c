// SPDX-License-Identifier: MIT
//
// Errata in the equations of the control-oriented model: as printed beside as corrected.
#include "paper_errata.h"

enum { PERIODS = 15, LAST = 5, PER_PERIOD = 60, POINTS = 361 };

static moray_status swimmer_reading(paper *p, moray_reading reading, moray_swimmer **swimmer)
{
    return paper_swimmer(p, p->robot, MORAY_CONTROL_ORIENTED, reading, swimmer);
}

static double period_of(const paper *p)
{
    return 2 * M_PI / p->settings->omega;
}

// ---- E1 ------------------------------------------------------------------------------------------------------------

// dv_n in the states of the corrected model's steady swimming.
static moray_status acceleration(paper *p, moray_reading reading, const moray_swim_track *orbit, double *dv_n)
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
    moray_swim_setup setup = moray_basin_setup(&p->basin, MORAY_CONTROL_ORIENTED);
    MORAY_TRY(swimmer_reading(p, MORAY_READ_CORRECTED, &setup.swimmer));
    return paper_orbit_of(p, &setup, &p->gait[MORAY_CONTROL_ORIENTED], POINTS, NULL, orbit);
}

// From rest; v_n[k] of sample k.
static moray_status swim_23h(paper *p, moray_reading reading, moray_swim_track **track, double **v_n)
{
    const moray_gait_change change = {0, p->gait[MORAY_CONTROL_ORIENTED]};
    paper_swim_plan plan = {.model = MORAY_CONTROL_ORIENTED, .schedule = &change, .n_changes = 1};
    MORAY_TRY(swimmer_reading(p, reading, &plan.swimmer));
    MORAY_TRY(paper_swim(p, &plan, PERIODS * period_of(p), period_of(p) / PER_PERIOD, track));
    MORAY_TRY(paper_numbers(p, (size_t)(*track)->n, v_n));
    for (int k = 0; k < (*track)->n; k++)
        (*v_n)[k] = (*track)->x[(k + 1) * (*track)->n_states - 1];
    return moray_ok();
}

static moray_status draw_23h(paper *p, moray_swim_track *const track[2], double *const v_n[2])
{
    static const char *const labels[] = {"(16c)", "(23h) as printed"};
    moray_curve curves[2];
    moray_column columns[3] = {{.name = "t", .unit = "s", .values = track[0]->t}};
    for (int c = 0; c < 2; c++) {
        curves[c] = (moray_curve){.label = labels[c], .x = track[c]->t, .y = v_n[c], .n = track[c]->n};
        columns[1 + c] = (moray_column){.name = c ? "v_n by (23h)" : "v_n by (16c)", .unit = "m/s", .values = v_n[c]};
    }
    MORAY_TRY(paper_csv(p, "e1", columns, 3, track[0]->n));
    return paper_figure(p, &(moray_figure){.name = "e1",
                                           .title = "E1: lateral velocity from rest, control-oriented model",
                                           .x_label = "time [s]",
                                           .y_label = "v_n [m/s]",
                                           .curves = curves,
                                           .n_curves = 2});
}

moray_status erratum_23h(paper *p)
{
    static const moray_reading readings[] = {MORAY_READ_23H_PRINTED, MORAY_READ_CORRECTED};
    moray_swim_track *orbit, *track[2];
    double dv_n[2][POINTS], *v_n[2], v_x[2], rms[2], end[2];
    MORAY_TRY(corrected_orbit(p, &orbit));
    for (int c = 0; c < 2; c++) {
        MORAY_TRY(acceleration(p, readings[c], orbit, dv_n[c]));
        MORAY_TRY(swim_23h(p, readings[c], &track[c], &v_n[c]));
        const int last = track[c]->n - 1, from = last - LAST * PER_PERIOD;
        v_x[c] = (track[c]->pose[last].p_x - track[c]->pose[from].p_x) / (track[c]->t[last] - track[c]->t[from]);
        rms[c] = root_mean_square(dv_n[c], POINTS);
        end[c] = v_n[c][last];
    }
    const double duration = track[0]->t[track[0]->n - 1];
    const moray_table_row rows[] = {
        {.label = "dv_n/dt in the corrected model's steady swimming, root mean square",
         .value = {rms[0], rms[1]},
         .unit = "m/s^2"},
        {.label = paper_label(p, "v_n after %.4g s from rest", duration), .value = {end[0], end[1]}, .unit = "m/s"},
        {.label = "v_x, mean of the last five periods of them", .value = {v_x[0], v_x[1]}, .unit = "m/s"},
    };
    moray_json_open(p->json, "e1");
    moray_json_numbers(p->json, "dv_n_rms_printed_corrected_m_s2", rms, 2);
    moray_json_numbers(p->json, "v_n_printed_corrected_m_s", end, 2);
    moray_json_numbers(p->json, "v_x_printed_corrected_m_s", v_x, 2);
    moray_json_close(p->json);
    MORAY_TRY(paper_table(p, &(moray_table){.title = "E1: (23h) has h_4 and h_5 the other way round than (16c)",
                                            .columns = {"as printed", "corrected"},
                                            .n_columns = 2,
                                            .rows = rows,
                                            .n_rows = 3}));
    return draw_23h(p, (moray_swim_track *[]){track[1], track[0]}, (double *[]){v_n[1], v_n[0]});
}

// ---- E2 ------------------------------------------------------------------------------------------------------------

enum { AMPLITUDES = 6, WAYS = 3 }; // ways: first principles, L = 2l, l for L

static moray_status speed(paper *p, int way, double theta_max, double *v_x)
{
    const moray_model model = way == 0 ? MORAY_FIRST_PRINCIPLES : MORAY_CONTROL_ORIENTED;
    const moray_gait_change change = {0, paper_gait(p, model, theta_max)};
    paper_swim_plan plan = {.model = model, .schedule = &change, .n_changes = 1};
    MORAY_TRY(paper_swimmer(p, p->robot, model, way == 2 ? MORAY_READ_L_PRINTED : MORAY_READ_CORRECTED, &plan.swimmer));
    return paper_mean_velocity(p, &plan, PERIODS * period_of(p), LAST, v_x, NULL);
}

// (12) over the true link angle, for the small angles of the gait (24) inside the body: with phi of (28), both sines.
static double estimate_of_link_angle(const paper *p, double L)
{
    const double half = cos(p->settings->delta / 2);
    return 2 * p->robot->l * half * half / L;
}

static moray_status draw_half_link(paper *p, const double *theta_max, double v_x[WAYS][AMPLITUDES])
{
    static const char *const labels[WAYS] = {"first-principles", "control-oriented, L = 2l",
                                             "control-oriented, l as printed"};
    moray_curve curves[WAYS];
    moray_column columns[1 + WAYS] = {{.name = "theta_max", .unit = "deg", .values = theta_max}};
    for (int c = 0; c < WAYS; c++) {
        curves[c] = (moray_curve){
            .label = labels[c], .x = theta_max, .y = v_x[c], .n = AMPLITUDES, .style = MORAY_CURVE_MARKED};
        columns[1 + c] = (moray_column){.name = labels[c], .unit = "m/s", .values = v_x[c]};
    }
    MORAY_TRY(paper_csv(p, "e2", columns, 1 + WAYS, AMPLITUDES));
    return paper_figure(p, &(moray_figure){.name = "e2",
                                           .title = "E2: straight motion, l of (8), (12), (13) as 2l and as printed",
                                           .x_label = "theta_max [deg]",
                                           .y_label = "mean v_x [m/s]",
                                           .curves = curves,
                                           .n_curves = WAYS});
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
    moray_json_numbers(p->json, "v_x_complex_m_s", v_x[0], AMPLITUDES);
    moray_json_close(p->json);
    MORAY_TRY(paper_table(p, &(moray_table){.title = "E2: l of (8), (12), (13) is a whole link, elsewhere half a link",
                                            .columns = {"as printed", "L = 2l", "first-principles"},
                                            .n_columns = 3,
                                            .rows = rows,
                                            .n_rows = AMPLITUDES + 1}));
    MORAY_TRY(
        paper_say(p,
                  "E2: Sec. V-B finds good accordance at 10 and 15 deg and too much speed of the simplified model "
                  "beyond, which is so with L = 2l only. At %g deg, where the assumption of small angles holds best, "
                  "the speed is %+.1f %% off the "
                  "first-principles model's with L = 2l and %+.1f %% with l as printed.",
                  theta_max[0], 100 * (v_x[1][0] / v_x[0][0] - 1), 100 * (v_x[2][0] / v_x[0][0] - 1)));
    return draw_half_link(p, theta_max, v_x);
}
