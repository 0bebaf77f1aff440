// SPDX-License-Identifier: MIT
//
// Every allocation of the library fails once: each run then ends with MORAY_MEMORY and frees what it had, which the
// leak sanitizer sees.
#include "allocations.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>
#include <unistd.h>

#include "linear/kkt_factors.h"
#include "linear/ldl.h"
#include "moray/control/receding_horizon.h"
#include "moray/snake/gait_problem.h"
#include "moray/ocp.h"
#include "moray/snake/orbit.h"
#include "moray/app/results.h"
#include "moray/sim.h"
#include "moray/snake/swim.h"

// ---- What is run ---------------------------------------------------------------------------------------------------

// The mass of Bryson and Denham, with refinement: problem, solution, certificate, and a second solve from the first.
static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->c[0] = at->x[0] - 1.0 / 9;
    out->g[0] = at->u[0] * at->u[0] / 2;
}

static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_status certify(const moray_solution *solution)
{
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    moray_certificate certificate;
    return moray_certify(solution, &integrator, &certificate);
}

static moray_status solve_twice(const moray_ocp *ocp)
{
    moray_settings settings = moray_settings_default();
    moray_solution *first = NULL, *second = NULL;
    settings.intervals = 4;
    settings.max_refinements = 1;
    moray_status status = moray_solve(ocp, &settings, NULL, &first);
    if (!moray_failed(status))
        status = certify(first);
    if (!moray_failed(status)) {
        const moray_guess guess = moray_guess_from_solution(first);
        settings.intervals = 6;
        status = moray_solve(ocp, &settings, &guess, &second);
    }
    moray_solution_free(first);
    moray_solution_free(second);
    return status;
}

static moray_status turn(void)
{
    moray_ocp *ocp = NULL;
    const moray_phase_spec phase = {.name = "turn",
                                    .nx = 2,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = push,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(1)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(-1)),
                                    .c = MORAY_BOUNDS(moray_at_most(0))};
    moray_status status =
        moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "turn", .phases = 1, .phase = &phase, .endpoint = effort});
    if (!moray_failed(status))
        status = solve_twice(ocp);
    moray_ocp_free(ocp);
    return status;
}

// The same mass replanned on its way, and recorded.
static moray_status plan_push(void *self, double t, const double *x, void **problem, const moray_ocp **ocp)
{
    moray_ocp *made;
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = push,
                                    .t0 = moray_fixed(t),
                                    .tf = moray_fixed(t + 1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(x[0]), moray_fixed(x[1])),
                                    .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .c = MORAY_BOUNDS(moray_at_most(0))};
    (void)self;
    MORAY_TRY(moray_ocp_new(&made, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = effort}));
    *problem = made;
    *ocp = made;
    return moray_ok();
}

static void free_push(void *problem)
{
    moray_ocp_free(problem);
}

static bool pushed(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t, (void)self;
    dx[0] = x[1];
    dx[1] = u[0];
    return true;
}

static moray_status run_loop(moray_receding_horizon *receding, moray_closed_loop_record *record)
{
    static const double times[] = {0, 0.3};
    const moray_controller controller = moray_receding_horizon_controller(receding);
    double x[2] = {0, 0.2};
    const moray_closed_loop_spec spec = {.plant = {.nx = 2, .nu = 1, .rates = pushed},
                                         .controller = &controller,
                                         .t1 = 0.3,
                                         .times = times,
                                         .n_times = 2,
                                         .observe = moray_closed_loop_record_add,
                                         .observer = record,
                                         .settings = moray_sim_settings_default()};
    return moray_closed_loop_run(&spec, x);
}

static moray_status replan(void)
{
    moray_receding_horizon *receding = NULL;
    moray_closed_loop_record record = {0};
    moray_receding_horizon_spec spec = {.replanner = {.nx = 2, .nu = 1, .make = plan_push, .free = free_push},
                                        .settings = moray_settings_default(),
                                        .horizon = 1,
                                        .interval = 0.2};
    spec.settings.intervals = 4;
    moray_status status = moray_receding_horizon_new(&receding, &spec);
    if (!moray_failed(status))
        status = moray_closed_loop_record_new(&record, 2, 1, 2);
    if (!moray_failed(status))
        status = run_loop(receding, &record);
    moray_closed_loop_record_free(&record);
    moray_receding_horizon_free(receding);
    return status;
}

static moray_robot small_robot(void)
{
    moray_robot robot = moray_robot_paper();
    robot.links = 3;
    return robot;
}

// The orbit of a gait, its stability and its gradients.
static moray_status orbit(void)
{
    const moray_robot robot = small_robot();
    const moray_gait gait = {.amplitude = 0.3, .omega = 2, .delta = 1};
    moray_orbit_spec spec = moray_orbit_spec_default(&robot, MORAY_FIRST_PRINCIPLES);
    moray_orbit *orbit = NULL;
    moray_orbit_result result;
    moray_floquet floquet;
    moray_orbit_gradient gradient;
    spec.intervals = 4;
    moray_status status = moray_orbit_new(&orbit, &spec);
    if (!moray_failed(status))
        status = moray_orbit_solve(orbit, &gait, &result);
    if (!moray_failed(status))
        status = moray_orbit_floquet(orbit, &floquet);
    if (!moray_failed(status))
        status = moray_orbit_gradients(orbit, &gradient);
    moray_orbit_free(orbit);
    return status;
}

// The best gait of a small robot, from its orbit by simulation, on one model. Stopped early it ends with a diagnosis,
// which says as much as there is memory for.
static moray_status solve_gait(const moray_gait_problem *problem, moray_swimmer *swimmer, const moray_gait *gait)
{
    const moray_swim_setup setup = {.swimmer = swimmer, .settings = moray_swim_settings_default()};
    moray_settings settings = moray_settings_default();
    moray_steady steady;
    moray_swim_track track = {0};
    moray_solution *solution = NULL;
    settings.scheme = "lobatto5";
    settings.intervals = 6;
    settings.max_iterations = 2;
    moray_status status = moray_swim_steady(&setup, gait, 0, &steady, &track, 9);
    if (!moray_failed(status))
        status = moray_gait_problem_solve(problem, &settings, gait, &track, &solution);
    moray_solution_free(solution);
    moray_swim_track_free(&track);
    return status;
}

static moray_status swim(moray_model model)
{
    const moray_gait_limits limits = {.theta_max = moray_between(0.01, 0.5),
                                      .omega = moray_between(0.5, 4),
                                      .delta = moray_between(0.5, 1.5),
                                      .offset = moray_fixed(0),
                                      .taper = moray_fixed(0),
                                      .power = 0.05,
                                      .joint_rate = MORAY_INFINITY,
                                      .joint_effort = 5};
    const moray_gait_problem_spec spec = {.robot = small_robot(), .model = model, .limits = limits};
    const moray_gait gait = {.amplitude = model == MORAY_CONTROL_ORIENTED ? 0.05 : 0.3, .omega = 2, .delta = 1};
    moray_gait_problem *problem = NULL;
    moray_swimmer *swimmer = NULL;
    moray_status status = moray_swimmer_new(&swimmer, &spec.robot, model);
    if (!moray_failed(status))
        status = moray_gait_problem_new(&problem, &spec);
    if (!moray_failed(status))
        status = solve_gait(problem, swimmer, &gait);
    moray_gait_problem_free(problem);
    moray_swimmer_free(swimmer);
    return status;
}

static moray_status swim_control(void)
{
    return swim(MORAY_CONTROL_ORIENTED);
}

static moray_status swim_fp(void)
{
    return swim(MORAY_FIRST_PRINCIPLES);
}

// Factors with room for what is planned, then with delayed pivots, then in another order: constraints i of an arrow
// whose head alone moves them.
enum { SHAFT = 40 };

static moray_status factor_arrow(moray_ldl *ldl, double shaft)
{
    double value[3 * SHAFT], x[2 * SHAFT + 1] = {1};
    for (int i = 0; i < SHAFT; i++) {
        value[3 * i] = 1;
        value[3 * i + 1] = shaft;
        value[3 * i + 2] = 0.1 * (1 + i);
    }
    MORAY_TRY(moray_ldl_factor(ldl, value, 0.1));
    return moray_ldl_solve(ldl, 1, x);
}

static moray_status factors(void)
{
    int row[3 * SHAFT], col[3 * SHAFT];
    moray_ldl *ldl = NULL;
    for (int i = 0; i < SHAFT; i++) {
        row[3 * i] = col[3 * i] = col[3 * i + 1] = 2 * i;
        row[3 * i + 1] = col[3 * i + 2] = 2 * i + 1;
        row[3 * i + 2] = 2 * SHAFT;
    }
    moray_status status = moray_ldl_new(&ldl, 2 * SHAFT + 1, &(moray_pattern){3 * SHAFT, row, col});
    for (int k = 0; k < 3 && !moray_failed(status); k++)
        status = factor_arrow(ldl, k == 0 ? 1 : 1e-3);
    if (!moray_failed(status) && moray_ldl_statistics_of(ldl).orders != 2)
        status = moray_error(MORAY_NUMERIC, "nothing was outgrown");
    moray_ldl_free(ldl);
    return status;
}

// Two constraints on three variables, in the null space; then with something on their diagonal, by LDL'.
static moray_status few_degrees(void)
{
    int row[] = {0, 1, 2, 3, 3, 4, 4, 4}, col[] = {0, 1, 2, 0, 2, 1, 2, 4};
    double value[] = {2, 3, 4, 1, 0.5, 1, -0.5, 0}, x[] = {1, 2, 3, 4, 5};
    kkt_factors *kkt = NULL;
    moray_status status = moray_kkt_factors_new(&kkt, 5, &(moray_pattern){8, row, col});
    for (int k = 0; k < 2 && !moray_failed(status); k++) {
        value[7] = -0.1 * k;
        status = moray_kkt_factors_factor(kkt, value, 1e-4);
        if (!moray_failed(status))
            status = moray_kkt_factors_solve(kkt, 1, x);
    }
    moray_kkt_factors_free(kkt);
    return status;
}

// A directory of results.
static char directory[] = "/tmp/moray_memory_XXXXXX";

static moray_status write_results(moray_output *output)
{
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    moray_json *json = moray_json_new();
    moray_json_number(json, "speed_m_s", 0.25);
    moray_json_open(json, "gait");
    moray_json_text(json, "name", "eel");
    moray_json_close(json);
    const moray_status status = moray_json_write(json, file);
    moray_json_free(json);
    return moray_failed(status) ? status : moray_output_commit(output);
}

static moray_status results(void)
{
    moray_output *output = NULL;
    moray_status status = moray_output_open(&output, directory);
    if (!moray_failed(status))
        status = write_results(output);
    moray_output_free(output);
    return status;
}

int main(void)
{
    char summary[60];
    if (!CHECK(mkdtemp(directory) != NULL, "a directory"))
        return 1;
    fail_each("problem, solution, certificate", false, turn);
    fail_each("receding horizon", false, replan);
    fail_each("orbit", false, orbit);
    fail_each("gait on the control-oriented model", true, swim_control);
    fail_each("gait on the first-principles model", true, swim_fp);
    fail_each("factors", false, factors);
    fail_each("factors in the null space", false, few_degrees);
    fail_each("results", false, results);
    remove(strcat(strcpy(summary, directory), "/summary.json"));
    rmdir(directory);
    return tap_done();
}
