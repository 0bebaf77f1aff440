// SPDX-License-Identifier: MIT
//
// S1, a programme that any tool can be given. Control-oriented model of the paper's robot, N = 10, all 24 states of
// (21) with the joint controller (34), in the current (0.1, 0.1) m/s, over one period T:
//
//   maximise  p_x(T) / T
//   over      states x(t), (a, omega, delta, phi_0), T;  T in [2 pi / 180, 2 pi / 30] 1/deg s
//   with      p(0) = 0, p_y(T) = 0, all other states periodic, omega T = 2 pi,
//             sin 1 deg <= a / (L cos(delta / 2)) <= sin 20 deg, 0 <= a <= L sin 20 deg,
//             omega in [30, 180] deg/s, delta in [30, 50] deg, phi_0 in [-0.02, 0.02] m
//
// Separated Hermite-Simpson, 20 intervals: 960 defects. Start: the orbit of theta_max = 10 deg, omega = 120 deg/s,
// delta = 40 deg, started straight along x. Optimum 0.603777 m/s (0.603772 on a fine mesh).
#include <complex.h>
#include <string.h>

#include "benchmark.h"

static const double current[2] = {0.1, 0.1};
static const int position = S1_LINKS; // of p_x among the states of (21): after N-1 joints and theta

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    const s1_case *c = data;
    const moray_phase_ends *period = &at->phase[0];
    const moray_num *x0 = period->x0, *xf = period->xf, a = at->s[0], omega = at->s[1], delta = at->s[2];
    moray_num *e = out->e;
    out->objective = -xf[position] / period->tf;
    for (int r = 0; r < S1_STATES; r++)
        if (r != position) // p_y starts at 0
            *e++ = xf[r] - x0[r];
    *e++ = omega * period->tf;
    *e++ = a / (c->L * ccos(delta / 2));
}

static moray_status begin(void *self)
{
    s1_case *c = self;
    const moray_robot robot = moray_robot_paper();
    moray_test_rig rig;
    moray_steady steady;
    c->L = 2 * robot.l;
    c->gait = (moray_gait){.omega = 120 * DEG, .delta = 40 * DEG};
    c->gait.amplitude = moray_amplitude_from_theta_max(&robot, MORAY_CONTROL_ORIENTED, 10 * DEG, c->gait.delta);
    MORAY_TRY(moray_test_rig_new(&rig, &robot, current, 0));
    const moray_swim_setup setup = moray_test_rig_setup(&rig, MORAY_CONTROL_ORIENTED);
    moray_status status = moray_swim_steady(&setup, &c->gait, 0, &steady, &c->orbit, 101);
    moray_test_rig_free(&rig);
    return status;
}

static void end(void *self)
{
    s1_case *c = self;
    moray_swim_track_free(&c->orbit);
}

static moray_status make_ocp(s1_case *c)
{
    const moray_plant_spec plant = {
        .robot = moray_robot_paper(), .joints = MORAY_JOINTS_CLOSED_LOOP, .current = {current[0], current[1]}};
    const moray_bounds s[] = {moray_between(0, c->L * sin(20 * DEG)), moray_between(30 * DEG, 180 * DEG),
                              moray_between(30 * DEG, 50 * DEG), moray_between(-0.02, 0.02), moray_fixed(0)};
    moray_bounds x0[S1_STATES], e[S1_STATES + 1];
    for (int r = 0; r < S1_STATES; r++)
        x0[r] = r == position || r == position + 1 ? moray_fixed(0) : moray_free();
    for (int r = 0; r < S1_STATES - 1; r++)
        e[r] = moray_fixed(0);
    e[S1_STATES - 1] = moray_fixed(2 * M_PI);
    e[S1_STATES] = moray_between(sin(1 * DEG), sin(20 * DEG));
    MORAY_TRY(moray_control_plant(&c->plant, &plant));
    const moray_phase_spec phase = {.name = "period",
                                    .nx = S1_STATES,
                                    .nq = 1, // joint work, which the plant has
                                    .map = &c->plant,
                                    .tf = moray_between(2 * M_PI / (180 * DEG), 2 * M_PI / (30 * DEG)),
                                    .x0 = {x0, S1_STATES}};
    return moray_ocp_new(&c->ocp, &(moray_ocp_spec){.name = "S1",
                                                    .phases = 1,
                                                    .phase = &phase,
                                                    .ns = 5,
                                                    .s = {s, 5},
                                                    .ne = S1_STATES + 1,
                                                    .e = {e, S1_STATES + 1},
                                                    .endpoint = ends,
                                                    .data = c});
}

static moray_status solve(void *self, moray_linear_solver linear, bool timed, moray_solution **solution)
{
    s1_case *c = self;
    const moray_settings settings = benchmark_settings("hermite-simpson", 20, linear, timed);
    const double s[] = {c->gait.amplitude, c->gait.omega, c->gait.delta, c->gait.offset, 0};
    const moray_samples orbit = {.n = c->orbit.n, .time = c->orbit.t, .x = c->orbit.x};
    const moray_guess guess = {.phase = &orbit, .s = s};
    MORAY_TRY(make_ocp(c));
    return moray_solve(c->ocp, &settings, &guess, solution);
}

static void forget(void *self)
{
    s1_case *c = self;
    moray_ocp_free(c->ocp);
    moray_map_release(&c->plant);
    c->ocp = NULL;
}

// (21), then what it consists of by joints and body.
static void name_state(int k, char name[16])
{
    static const char *const body[] = {"theta", "p_x", "p_y"}, *const rates[] = {"v_theta", "v_t", "v_n"};
    const int joints = S1_LINKS - 1, half = S1_STATES / 2, of_half = k % half;
    if (of_half < joints)
        snprintf(name, 16, "%s_%d", k < half ? "phi" : "v_phi", of_half + 1);
    else
        snprintf(name, 16, "%s", (k < half ? body : rates)[of_half - joints]);
}

static void write_orbit(const moray_swim_track *orbit, FILE *file)
{
    char names[S1_STATES][16];
    moray_column columns[1 + S1_STATES] = {{"t", "s", orbit->t, 1}};
    for (int k = 0; k < S1_STATES; k++) {
        name_state(k, names[k]);
        columns[1 + k] = (moray_column){names[k], NULL, orbit->x + k, S1_STATES};
    }
    moray_csv_write(file, columns, 1 + S1_STATES, orbit->n);
}

moray_status s1_write_start(moray_output *output)
{
    s1_case s1 = {0};
    FILE *file;
    moray_status status = begin(&s1);
    if (!moray_failed(status))
        status = moray_output_file(output, "s1_start.csv", &file);
    if (!moray_failed(status))
        write_orbit(&s1.orbit, file);
    end(&s1);
    return status;
}

subject s1_subject(s1_case *c)
{
    return (subject){begin, solve, forget, end, c};
}
