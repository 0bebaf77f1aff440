// SPDX-License-Identifier: MIT
//
// Logs made ready: which measurements count, the grid of steps, scales, and what is refused by its whole text.
#include "swum_logs.h"

// ---- Items ---------------------------------------------------------------------------------------------------------

typedef struct window {
    double early, late; // rows within [first + early, last - late]
} window;

static bool counts(const moray_swim_log *log, window w, int kind, int joint, int row)
{
    const double t = row * swum_step, T = (SWUM_ROWS - 1) * swum_step;
    const double *const channel[] = {log->p_x, log->p_y, log->heading};
    return t >= w.early && t <= T - w.late && !isnan(kind < 3 ? channel[kind][row] : log->u[2 * row + joint]);
}

// Row by row, kind by kind, joint by joint.
static void check_items(const moray_identify *v, const moray_swim_log *logs, window w)
{
    int total = 0;
    for (int r = 0; r < v->runs; r++) {
        const moray_swim_log *log = &logs[r];
        int n = 0, off = 0;
        for (int row = 0; row < SWUM_ROWS; row++)
            for (int kind = 0; kind < (v->spec.model == MORAY_FIRST_PRINCIPLES ? 4 : 3); kind++)
                for (int joint = 0; joint < (kind == 3 ? 2 : 1); joint++) {
                    const struct item *item = &v->run[r].item[n];
                    if (!counts(log, w, kind, joint, row))
                        continue;
                    const double *const channel[] = {log->p_x, log->p_y, log->heading, log->u};
                    off += item->row != row || item->joint != joint || (int)item->kind != kind ||
                           item->observed != channel[kind][kind == 3 ? 2 * row + joint : row] ||
                           item->sigma != v->run[r].sigma[kind];
                    n++;
                }
        CHECK(v->run[r].items == n && off == 0 && n > 0, "run %d: %d items, %d expected, %d wrong", r, v->run[r].items,
              n, off);
        total += n;
    }
    CHECK(v->items == total && v->columns == v->spec.n + FIRST * v->runs, "%d items of all", v->items);
}

// Delays that an estimate may have leave rows out: those of instruments, estimated or not, the longer one at either
// end.
static void test_items(void)
{
    static const char *const both[] = {"c_t", "heading_delay", "position_delay", "joint_delay"};
    static const struct {
        int n;
        double fixed, lower[4], upper[4];
        window w;
    } cases[] = {{1, 0, {0.1}, {2}, {0, 0}},
                 {1, 0.375, {0.1}, {2}, {0.375, 0}},
                 {1, -0.25, {0.1}, {2}, {0, 0.25}},
                 {2, 0.25, {0.1, -0.125}, {2, 0.5}, {0.5, 0.125}},
                 {3, 0, {0.1, -0.125, -0.375}, {2, 0.5, 0.25}, {0.5, 0.375}},
                 {4, 0, {0.1, -0.25, -0.125, -1}, {2, 0.125, 0.625, 1}, {0.625, 0.25}}};
    for (int model = 0; model < 2; model++) {
        moray_swim_log log[SWUM_LOGS];
        swum_logs((moray_model)model, swum_noise(), log);
        log[0].p_x[3] = log[0].p_y[4] = log[1].heading[9] = log[1].heading[SWUM_ROWS - 1] = NAN;
        if (log[1].u)
            log[1].u[2 * 7] = log[1].u[2 * 8 + 1] = NAN;
        for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
            swum_spec s;
            moray_identify *v;
            swum_choose(&s, (moray_model)model, both, cases[k].n);
            memcpy(s.lower, cases[k].lower, sizeof cases[k].lower);
            memcpy(s.upper, cases[k].upper, sizeof cases[k].upper);
            s.spec.start.position_delay = cases[k].fixed;
            CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
            check_items(v, log, cases[k].w);
            moray_identify_free(v);
        }
        swum_free(log);
    }
}

// ---- Steps and scales ----------------------------------------------------------------------------------------------

static void test_grid(void)
{
    static const char *const few[] = {"c_t", "current_x", "lambda_3"};
    const double T = (SWUM_ROWS - 1) * swum_step, wanted[] = {0.3, 0.25, 5, 0};
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    swum_logs(MORAY_FIRST_PRINCIPLES, (moray_swim_log_noise){0}, log);
    for (int k = 0; k < 5; k++) {
        swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 3);
        s.spec.step = k < 4 ? wanted[k] : 0;
        s.spec.joints = k < 4 ? MORAY_LOGGED_AUTO : MORAY_LOGGED_SPLINE;
        s.spec.start.robot.lambda_3 = s.lower[2] = 0;
        CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
        for (int r = 0; r < SWUM_LOGS; r++) {
            moray_gait gait;
            double shift;
            CHECK(moray_identify_gait(v, r, &gait, &shift) == (k < 4), "on a gait or not");
            const double omega = r ? 3.1 : 2.2, h = k < 3 ? wanted[k] : k == 3 ? 2 * M_PI / omega / 120 : 0.02;
            CHECK(v->run[r].steps == (int)ceil(T / h * (1 - 1e-9)), "%d steps", v->run[r].steps);
            CHECK_NEAR(v->run[r].h * v->run[r].steps, T, 1e-12, "from end to end");
            CHECK(k == 4 || (fabs(gait.omega - omega) < 1e-5 && fabs(gait.amplitude - (r ? 0.5 : 0.7)) < 1e-5 &&
                             fabs(remainder(omega * shift, 2 * M_PI)) < 1e-4),
                  "the gait it swam: omega %.7g, shift %.1e", gait.omega, shift);
        }
        CHECK(v->scale[0] == s.spec.start.robot.c_t && v->scale[1] == 0.1 && v->scale[2] == s.upper[2],
              "scales %g, %g, %g", v->scale[0], v->scale[1], v->scale[2]);
        moray_identify_free(v);
    }
    swum_free(log);
}

// ---- First states --------------------------------------------------------------------------------------------------

// Of a straight line by a camera that is turned, without headings: it looks where it goes, from the first row to the
// last, or as fast as it begins where the last is missing.
static void check_guess(moray_model model, bool rest, int missing)
{
    static const char *const few[] = {"c_t"};
    const double turned = 0.4, camera[2] = {0.3, -0.2}, way = atan2(0.4, -0.3) - turned;
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    moray_estimate at;
    swum_logs(model, (moray_swim_log_noise){0}, log);
    for (int row = 0; row < SWUM_ROWS; row++) {
        log[0].p_x[row] = 1 - 0.3 * row * swum_step;
        log[0].p_y[row] = 0.2 + 0.4 * row * swum_step;
    }
    if (missing >= 0)
        log[0].p_y[missing] = NAN;
    log[0].heading = NULL;
    swum_choose(&s, model, few, 1);
    s.spec.rest = rest;
    CHECK_OK(moray_identify_new(&v, &s.spec, log, 1), "new");
    moray_identify_start(v, 0, &at);
    const double h = model == MORAY_CONTROL_ORIENTED ? way : 0, *got = at.first[0]; // the other's are along x and y
    const double want[FIRST] = {way,
                                cos(turned) * 1 + sin(turned) * 0.2 + camera[0],
                                -sin(turned) * 1 + cos(turned) * 0.2 + camera[1],
                                0,
                                rest ? 0 : 0.5 * cos(way - h),
                                rest ? 0 : 0.5 * sin(way - h)};
    for (int i = 0; i < FIRST; i++)
        CHECK_NEAR(remainder(got[i] - want[i], 2 * M_PI), 0, 1e-6, "first state");
    moray_identify_free(v);
    swum_free(log);
}

static void test_guesses(void)
{
    for (int model = 0; model < 2; model++)
        for (int rest = 0; rest < 2; rest++) {
            check_guess((moray_model)model, rest, -1);
            check_guess((moray_model)model, rest, 0);
            check_guess((moray_model)model, rest, SWUM_ROWS - 1);
        }
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refused(const swum_spec *s, const moray_swim_log *log, int logs, const char *text)
{
    moray_identify *v;
    const moray_status status = moray_identify_new(&v, &s->spec, log, logs);
    CHECK(status.code == MORAY_INPUT && !v && strcmp(status.text, text) == 0, "\"%s\", expected \"%s\"", status.text,
          text);
    moray_identify_free(v);
}

static void test_spec_refused(moray_swim_log log[SWUM_LOGS])
{
    static const char *const few[] = {"c_t", "c_n"};
    swum_spec s;
    swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 2);
    s.spec.n = 0;
    refused(&s, log, 1, "0 unknowns: must be 1 to 20");
    s.spec.n = 21;
    refused(&s, log, 1, "21 unknowns: must be 1 to 20");
    s.spec.n = 2;
    refused(&s, log, 0, "0 logs: must be 1 to 12");
    refused(&s, log, 13, "13 logs: must be 1 to 12");
    moray_swim_log many[MORAY_IDENTIFY_RUNS];
    moray_identify *of_many;
    for (int k = 0; k < MORAY_IDENTIFY_RUNS; k++)
        many[k] = log[k % 2];
    CHECK_OK(moray_identify_new(&of_many, &s.spec, many, MORAY_IDENTIFY_RUNS), "twelve logs");
    moray_identify_free(of_many);
    s.spec.n = MORAY_MOST_UNKNOWNS;
    s.lower[0] = s.upper[0] = 1;
    char text[120];
    snprintf(text, sizeof text, "c_t = %g at the start: must be within its bounds, 1 to 1", s.spec.start.robot.c_t);
    refused(&s, log, 1, text); // not for their number
    swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 2);
    s.unknown[1] = moray_unknown_named("rot_gain");
    refused(&s, log, 1, "rot_gain: the first-principles model with this hydrodynamics does not feel it");
    s.unknown[1] = moray_unknown_named("c_n");
    s.spec.start.robot.c_n = 12;
    s.lower[1] = 12.5, s.upper[1] = 14;
    refused(&s, log, 1, "c_n = 12 at the start: must be within its bounds, 12.5 to 14");
    s.lower[1] = 10, s.upper[1] = 11.5;
    refused(&s, log, 1, "c_n = 12 at the start: must be within its bounds, 10 to 11.5");
    s.lower[1] = s.upper[1] = 12;
    refused(&s, log, 1, "c_n = 12 at the start: must be within its bounds, 12 to 12");
    for (int side = 0; side < 2; side++) { // at either bound
        moray_identify *v;
        s.lower[1] = side ? 11 : 12, s.upper[1] = side ? 12 : 13;
        CHECK_OK(moray_identify_new(&v, &s.spec, log, 1), "at a bound");
        moray_identify_free(v);
    }
}

static void test_logs_refused(moray_swim_log log[SWUM_LOGS])
{
    static const char *const few[] = {"c_t", "c_n"};
    swum_spec s;
    swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 2);
    s.spec.start.robot.links = 4;
    refused(&s, log, 1, "log log_1: 2 joints, but the robot has 4 links");
    s.spec.start.robot.links = 3;
    s.spec.step = 3e-6;
    refused(&s, log, 1, "log log_1: 4 s in steps of 3e-06 s are 1.33e+06 steps: must be at most 1000000");
    for (int row = 5; row < SWUM_ROWS; row++)
        log[1].heading[row] = NAN;
    s.spec.step = 0;
    refused(&s, log, 2, "log log_2: heading: 5 values are too few for a spline; leave the column out");
    log[0].p_x = log[0].p_y = log[0].heading = NULL;
    swum_choose(&s, MORAY_CONTROL_ORIENTED, few, 2);
    refused(&s, log, 1, "log log_1: no measurement that the control-oriented model can be compared with");
}

int main(void)
{
    moray_swim_log log[SWUM_LOGS];
    test_items();
    test_grid();
    test_guesses();
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    test_spec_refused(log);
    test_logs_refused(log);
    swum_free(log);
    return tap_done();
}
