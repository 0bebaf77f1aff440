// SPDX-License-Identifier: MIT
//
// The problem of steering as the transcription sees it: bounds, names, objective, events and rows, by hand.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "ocp/problem.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES, links = 4, joints = links - 1, lines = 2 };
enum { nu = 2, nc = 2, nq = 2, ne = 2 }; // of the task

// in = [x, phi_0'', two controls, s, t]
static void extra(void *self, const double complex *in, double complex *out)
{
    (void)self;
    out[0] = in[states + 1] * in[states + 2];
    out[1] = in[MORAY_STATE_THETA] + 3 * in[states];
    out[2] = in[states + 2] * in[states + 2] + in[states + 3 + MORAY_STEERING_PARAMETERS];
    out[3] = in[states + 1] - in[states + 3 + MORAY_STEERING_DELTA];
}

static void events(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 7 * at->phase->xf[MORAY_STATE_P_X];
    out->e[0] = at->phase->x0[MORAY_STATE_P_Y];
    out->e[1] = 2 * at->phase->tf;
}

static const double weights[nq] = {5, -0.5};
static const char *const u_names[] = {"first", "second"}, *const c_names[] = {"product", "sum"},
                         *const e_names[] = {"start", "twice"};

static moray_steering_spec spec_of(moray_model model, const moray_bounds *u, const moray_bounds *c,
                                   const moray_bounds *e)
{
    moray_steering_spec spec = {.robot = moray_robot_paper(),
                                .model = model,
                                .current = {0.05, 0.1},
                                .limits = {.theta_max = moray_between(5 * DEG, 30 * DEG),
                                           .omega = moray_between(1, 3),
                                           .delta = moray_between(0.4, 1.1),
                                           .offset = 0.02,
                                           .offset_rate = 0.03,
                                           .offset_acceleration = 0.07,
                                           .power = 0.9},
                                .t0 = moray_fixed(2),
                                .tf = moray_between(5, 9),
                                .task = {.name = "errand",
                                         .nu = nu,
                                         .nc = nc,
                                         .nq = nq,
                                         .extra = extra,
                                         .ne = ne,
                                         .events = events,
                                         .u = u,
                                         .c = c,
                                         .e = e,
                                         .u_names = u_names,
                                         .c_names = c_names,
                                         .e_names = e_names,
                                         .weight = weights,
                                         .weight_power = 0.25,
                                         .weight_time = 11}};
    spec.robot.links = links;
    for (int r = 0; r < states; r++) {
        spec.x0[r] = moray_between(-1 - r, 2 + r);
        spec.xf[r] = moray_between(-0.1 * r, 0.5 + r);
    }
    spec.x0[MORAY_STATE_PHI_0] = moray_between(-0.01, 5);
    spec.xf[MORAY_STATE_PHI_0] = moray_between(-5, 0.005);
    spec.x0[MORAY_STATE_V_PHI_0] = moray_between(-1, 0.02);
    spec.xf[MORAY_STATE_V_PHI_0] = moray_between(-0.025, 1);
    return spec;
}

static const moray_bounds own_u[nu] = {{-3, 4}, {1, 2}}, own_c[nc] = {{-6, 7}, {-0.5, 0.25}},
                          own_e[ne] = {{-8, 9}, {1, 50}};

static void check_bounds(moray_bounds got, double lower, double upper, const char *what)
{
    CHECK_NEAR(got.lower, lower, 1e-14, what);
    CHECK_NEAR(got.upper, upper, 1e-14, what);
}

static void check_name(const char *got, const char *want)
{
    CHECK(got && strcmp(got, want) == 0, "named %s: %s", want, got ? got : "nothing");
}

static void check_states(const struct phase *phase, bool control)
{
    static const char *const names[2][states] = {{"theta", "p_x", "p_y", "v_theta", "v_t", "v_n", "phi_0", "phi_0'"},
                                                 {"theta", "p_x", "p_y", "v_theta", "v_x", "v_y", "phi_0", "phi_0'"}};
    for (int r = 0; r < states; r++) {
        check_name(phase->x_names[r], names[!control][r]);
        if (r == MORAY_STATE_PHI_0 || r == MORAY_STATE_V_PHI_0)
            continue;
        CHECK(phase->x[r].lower <= -MORAY_INFINITY && phase->x[r].upper >= MORAY_INFINITY, "is free");
        check_bounds(phase->x0[r], -1 - r, 2 + r, "at the start");
        check_bounds(phase->xf[r], -0.1 * r, 0.5 + r, "in the end");
    }
    check_bounds(phase->x[MORAY_STATE_PHI_0], -0.02, 0.02, "offset");
    check_bounds(phase->x0[MORAY_STATE_PHI_0], -0.01, 0.02, "at the start, the narrower on either side");
    check_bounds(phase->xf[MORAY_STATE_PHI_0], -0.02, 0.005, "and in the end");
    check_bounds(phase->x[MORAY_STATE_V_PHI_0], -0.03, 0.03, "its rate");
    check_bounds(phase->x0[MORAY_STATE_V_PHI_0], -0.03, 0.02, "at the start");
    check_bounds(phase->xf[MORAY_STATE_V_PHI_0], -0.025, 0.03, "and in the end");
}

static void check_controls(const moray_ocp *ocp, const struct phase *phase)
{
    check_bounds(phase->t0, 2, 2, "begins");
    check_bounds(phase->tf, 5, 9, "ends");
    check_name(phase->name, "errand");
    CHECK(phase->nu == 1 + nu && phase->nq == 1 + nq && ocp->ne == 2 + ne, "counts");
    check_bounds(phase->u[0], -0.07, 0.07, "acceleration of the offset");
    check_name(phase->u_names[0], "phi_0''");
    for (int k = 0; k < nu; k++) {
        check_bounds(phase->u[1 + k], own_u[k].lower, own_u[k].upper, "a control of the task");
        check_name(phase->u_names[1 + k], u_names[k]);
    }
    check_name(ocp->e_names[0], "theta_max");
    check_name(ocp->e_names[1], "mean power");
    CHECK(ocp->e[1].lower <= -MORAY_INFINITY && ocp->e[1].upper == 0.9, "power at most");
    for (int k = 0; k < ne; k++) {
        check_bounds(ocp->e[2 + k], own_e[k].lower, own_e[k].upper, "an event of the task");
        check_name(ocp->e_names[2 + k], e_names[k]);
    }
    check_bounds(ocp->s[MORAY_STEERING_OMEGA], 1, 3, "omega");
    check_bounds(ocp->s[MORAY_STEERING_DELTA], 0.4, 1.1, "delta");
    check_name(ocp->s_names[1], "omega");
    check_name(ocp->s_names[2], "delta");
}

// Of integrals 2, 3 and the work 40 from 2 s to 7 s, from 4 m along y to 6 m along x.
static void check_ends(const moray_ocp *ocp, double amplitude, double theta_max)
{
    enum { q = 2 * states + 2, s = q + nq + 1, inputs = s + MORAY_STEERING_PARAMETERS, outputs = 1 + 2 + ne };
    double in[inputs] = {[MORAY_STATE_P_Y] = 4,
                         [states] = 2,
                         [states + 1 + MORAY_STATE_P_X] = 6,
                         [q - 1] = 7,
                         [q] = 2,
                         [q + 1] = 3,
                         [q + 2] = 40,
                         [s + MORAY_STEERING_AMPLITUDE] = amplitude,
                         [s + MORAY_STEERING_OMEGA] = 2,
                         [s + MORAY_STEERING_DELTA] = 0.8};
    double out[outputs];
    const moray_map *map = ocp->endpoint->map;
    if (!CHECK(map->n_in == inputs && map->n_out == outputs, "%d numbers in, %d out", map->n_in, map->n_out))
        return;
    map->value(map->self, in, out);
    CHECK_NEAR(out[0], 7 * 6 + 11 * 5 + 0.25 * 40 + 5 * 2 - 0.5 * 3, 1e-12, "objective");
    CHECK_NEAR(out[1], theta_max, 1e-12, "what the amplitude is a measure of");
    CHECK_NEAR(out[2], 40.0 / 5, 1e-12, "mean power");
    CHECK_NEAR(out[3], 4, 1e-12, "first event of the task");
    CHECK_NEAR(out[4], 14, 1e-12, "second one");
}

static void test_control(void)
{
    const moray_steering_spec spec = spec_of(MORAY_CONTROL_ORIENTED, own_u, own_c, own_e);
    moray_steering *problem;
    CHECK_OK(moray_steering_new(&problem, &spec), "problem");
    const moray_ocp *ocp = moray_steering_ocp(problem);
    const struct phase *phase = &ocp->phase[0];
    check_states(phase, true);
    check_controls(ocp, phase);
    const double l = spec.robot.l;
    check_name(ocp->s_names[0], "a");
    check_bounds(ocp->s[MORAY_STEERING_AMPLITUDE], 0, 2 * l * sin(30 * DEG), "amplitude of (33)");
    check_bounds(ocp->e[0], sin(5 * DEG), sin(30 * DEG), "the sine of theta_max");
    check_ends(ocp, 0.03, 0.03 / (2 * l * cos(0.4)));
    CHECK(phase->nc == nc, "%d path constraints", phase->nc);
    for (int k = 0; k < nc; k++) {
        check_bounds(phase->c[k], own_c[k].lower, own_c[k].upper, "a path constraint of the task");
        check_name(phase->c_names[k], c_names[k]);
    }
    moray_steering_free(problem);
}

// Two lines of every motor, then the rates of a stroke either way, then what the task adds.
static void check_rows(const struct phase *phase)
{
    enum { first = lines * joints, inputs = states + 1 + nu + MORAY_STEERING_PARAMETERS + 1 };
    double in[inputs] = {0}, out[40];
    CHECK(phase->nc == first + 2 + nc, "%d path constraints", phase->nc);
    for (int k = 0; k < first; k++) {
        char name[24];
        snprintf(name, sizeof name, "supply %d", k + 1);
        check_name(phase->c_names[k], name);
        check_bounds(phase->c[k], k < joints ? -5 : -8, k < joints ? 5 : 8, "what a line of the motor allows");
    }
    check_name(phase->c_names[first], "joint rate up");
    check_name(phase->c_names[first + 1], "joint rate down");
    for (int k = 0; k < 2; k++)
        CHECK(phase->c[first + k].upper == 1.5 && phase->c[first + k].lower <= -MORAY_INFINITY, "rate of joints");
    for (int k = 0; k < nc; k++) {
        check_bounds(phase->c[first + 2 + k], own_c[k].lower, own_c[k].upper, "a path constraint of the task");
        check_name(phase->c_names[first + 2 + k], c_names[k]);
    }
    in[MORAY_STATE_THETA] = 0.3;
    in[MORAY_STATE_V_PHI_0] = 0.02;
    in[states] = 0.05;
    in[states + 1] = -3;
    in[states + 2] = 2;
    in[states + 3 + MORAY_STEERING_AMPLITUDE] = 0.4;
    in[states + 3 + MORAY_STEERING_OMEGA] = 2.5;
    in[states + 3 + MORAY_STEERING_DELTA] = 0.7;
    in[inputs - 1] = 6;
    const moray_map *map = phase->map;
    if (!CHECK(map->n_in == inputs && map->n_out == states + phase->nc + nq + 1, "%d numbers in, %d out", map->n_in,
               map->n_out))
        return;
    map->value(map->self, in, out);
    const double want[] = {1 + 0.02, 1 - 0.02, -6, 0.3 + 0.15, 4 + 6, -3 - 0.7};
    for (int k = 0; k < 6; k++)
        CHECK_NEAR(out[states + first + k], want[k], 1e-12, "rates of a stroke, the task's rows and integrands");
    CHECK(out[states] != 0, "behind them the motors' own");
}

static void test_motors(void)
{
    moray_steering_spec spec = spec_of(MORAY_FIRST_PRINCIPLES, own_u, own_c, own_e);
    moray_steering *problem;
    spec.robot.motor = (moray_motor){.fitted = true,
                                     .forward = 1,
                                     .backward = 1,
                                     .smooth_rate = 1,
                                     .smooth_power = 1,
                                     .lines = lines,
                                     .torque = {5, 8},
                                     .slope = {0.01, 0.5}};
    spec.robot.supply.rate = 1.5;
    CHECK_OK(moray_steering_new(&problem, &spec), "problem");
    const moray_ocp *ocp = moray_steering_ocp(problem);
    check_states(&ocp->phase[0], false);
    check_controls(ocp, &ocp->phase[0]);
    check_name(ocp->s_names[0], "alpha");
    check_bounds(ocp->s[MORAY_STEERING_AMPLITUDE], 0, 60 * DEG, "amplitude of (27)");
    check_bounds(ocp->e[0], 5 * DEG, 30 * DEG, "theta_max");
    check_ends(ocp, 0.3, 0.3 / (2 * sin(0.4)));
    check_rows(&ocp->phase[0]);
    moray_steering_free(problem);
    const double none[] = {0, INFINITY};
    for (int k = 0; k < 2; k++) {
        spec.robot.supply.rate = none[k];
        CHECK_OK(moray_steering_new(&problem, &spec), "problem");
        CHECK(moray_steering_ocp(problem)->phase[0].nc == lines * joints + nc, "joints as fast as they like");
        moray_steering_free(problem);
    }
}

// ---- Where the task is looked at ----------------------------------------------------------------------------------

// Depends on a state each at the far end of the time and of a control of its own, and everywhere on none but the first.
static void far_off(void *self, const double complex *in, double complex *out)
{
    const double *from = self, t = creal(in[states + 3 + MORAY_STEERING_PARAMETERS]);
    out[0] = in[0] * in[0];
    out[0] += t > from[0] ? in[1] * in[1] : 0;
    out[0] += t < from[1] ? in[2] * in[2] : 0;
    out[0] += creal(in[states + 1]) > from[2] ? in[3] * in[3] : 0;
    out[0] += creal(in[states + 2]) < from[3] ? in[4] * in[4] : 0;
    out[1] = creal(in[5]) > 0.05 ? in[6] * in[6] : 0;
    out[2] = out[3] = in[0];
}

// A bit for each of the states that a row knows of.
static unsigned knows(const struct phase *phase, int row)
{
    unsigned bits = 0;
    for (int e = 0; e < phase->map->jac.nnz; e++)
        if (phase->map->jac.row[e] == row && phase->map->jac.col[e] < states)
            bits |= 1u << phase->map->jac.col[e];
    return bits;
}

static void test_looks(moray_bounds t0, moray_bounds tf, const double from[4])
{
    double thresholds[4] = {from[0], from[1], from[2], from[3]};
    moray_steering_spec spec = spec_of(MORAY_CONTROL_ORIENTED, own_u, own_c, own_e);
    moray_steering *problem;
    spec.t0 = t0;
    spec.tf = tf;
    spec.task.extra = far_off;
    spec.task.self = thresholds;
    spec.task.events = NULL;
    CHECK_OK(moray_steering_new(&problem, &spec), "problem");
    const struct phase *phase = &moray_steering_ocp(problem)->phase[0];
    CHECK(knows(phase, states) == 0x1f, "from end to end of time and controls: %x", knows(phase, states));
    CHECK(knows(phase, states + 1) == 1u << 6, "and on either side of a state's typical value: %x",
          knows(phase, states + 1));
    moray_steering_free(problem);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refuse(const moray_steering_spec *spec, const char *says)
{
    char taken;
    moray_steering *problem = (void *)&taken;
    const moray_status status = moray_steering_new(&problem, spec);
    CHECK(status.code == MORAY_INPUT && strncmp(status.text, says, strlen(says)) == 0, "'%s': %s", says, status.text);
    CHECK(!problem, "and nothing is left");
}

static void test_refused(void)
{
    const moray_steering_spec good = spec_of(MORAY_CONTROL_ORIENTED, own_u, own_c, own_e);
    moray_steering_spec bad = good;
    bad.limits.offset = 0;
    refuse(&bad, "offset limit");
    bad = good, bad.limits.offset_rate = -1;
    refuse(&bad, "offset rate limit");
    bad = good, bad.limits.offset_acceleration = 0;
    refuse(&bad, "offset acceleration limit");
    bad = good, bad.limits.power = 0;
    refuse(&bad, "power_W");
    bad = good, bad.task.nu = -1;
    refuse(&bad, "further controls of errand = -1: must be from 0 to 15");
    bad.task.nu = 16;
    refuse(&bad, "further controls of errand = 16: must be from 0 to 15");
    bad = good, bad.model = MORAY_FIRST_PRINCIPLES, bad.averaged = true;
    refuse(&bad, "averaged: only the control-oriented model has an averaged plant");
    bad = good, bad.current[0] = NAN;
    refuse(&bad, "current = nan,0.1: must be finite");
    bad = good, bad.current[1] = INFINITY;
    refuse(&bad, "current = 0.05,inf: must be finite");
    bad = good, bad.limits.omega = moray_between(3, 1);
    refuse(&bad, "omega");
    bad = good, bad.robot.links = 0;
    refuse(&bad, "links");
}

// Limits of finite size are mapped, all by the ratio of the amplitudes.
static void test_mapped(void)
{
    moray_robot robot = moray_robot_paper();
    const moray_gait gait = moray_gait_paper(&robot);
    const double ratio =
        moray_gait_map(&robot, &gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES).amplitude / gait.amplitude;
    moray_steering_limits limits = {.offset = 2, .offset_rate = 3, .offset_acceleration = 5, .power = 0.4};
    for (int k = 0; k < 4; k++) {
        moray_steering_limits some = limits;
        double *const fields[] = {&some.offset, &some.offset_rate, &some.offset_acceleration};
        if (k < 3)
            *fields[k] = MORAY_INFINITY;
        const moray_steering_limits mapped =
            moray_steering_limits_map(&robot, &some, &gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
        const double got[] = {mapped.offset, mapped.offset_rate, mapped.offset_acceleration}, was[] = {2, 3, 5};
        for (int j = 0; j < 3; j++)
            CHECK_NEAR(got[j] / (j == k ? MORAY_INFINITY : was[j] * ratio), 1, 1e-14, "a limit");
        CHECK(mapped.power == 0.4, "power as it is");
    }
}

int main(void)
{
    test_control();
    test_motors();
    test_looks(moray_fixed(2), moray_between(5, 9), (double[]){8.7, 2.3, 3.6, 1.05});
    test_looks(moray_fixed(-1), moray_between(-1, MORAY_INFINITY), (double[]){-0.9, -1.1, 3.6, 1.05});
    test_refused();
    test_mapped();
    return tap_done();
}
