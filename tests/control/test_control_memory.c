// SPDX-License-Identifier: MIT
//
// Every allocation of closed loops, filters, orbits, paths and tunings fails once, each by itself.
#include "allocations.h"

#include <string.h>
#include <unistd.h>

#include "moray/control/closed_loop.h"
#include "moray/control/kalman.h"
#include "moray/control/path.h"
#include "moray/control/periodic_orbit.h"
#include "moray/control/receding_horizon.h"
#include "moray/control/tuning.h"

// ---- Loops ---------------------------------------------------------------------------------------------------------

static bool rates(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t, (void)x, (void)self;
    dx[0] = u[0];
    return true;
}

static moray_status follow(const moray_controller *controller)
{
    static const double times[] = {0, 0.1, 0.3};
    double x = 0.5;
    moray_closed_loop_record record;
    MORAY_TRY(moray_closed_loop_record_new(&record, 1, 1, 3));
    const moray_closed_loop_spec spec = {.plant = {.nx = 1, .nu = 1, .rates = rates},
                                         .controller = controller,
                                         .t1 = 0.3,
                                         .times = times,
                                         .n_times = 3,
                                         .observe = moray_closed_loop_record_add,
                                         .observer = &record,
                                         .settings = moray_sim_settings_default()};
    const moray_status status = moray_closed_loop_run(&spec, &x);
    moray_closed_loop_record_free(&record);
    return status;
}

static void halve(double t, double *u, const void *self)
{
    (void)t, (void)self;
    u[0] = -0.5;
}

static moray_status loop(void)
{
    return follow(&(moray_controller){.nu = 1, .control = halve});
}

// To rest with the least effort, stated anew each time.
static void drive(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0] + at->x[0] * at->x[0];
}

static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_status state_anew(void *self, double t, const double *x, void **problem, const moray_ocp **ocp)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = drive,
                                    .t0 = moray_fixed(t),
                                    .tf = moray_fixed(t + 1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(x[0])),
                                    .xf = MORAY_BOUNDS(moray_fixed(0))};
    moray_ocp *made;
    (void)self;
    MORAY_TRY(moray_ocp_new(&made, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = effort}));
    *ocp = *problem = made;
    return moray_ok();
}

static void free_problem(void *problem)
{
    moray_ocp_free(problem);
}

static moray_status replan(void)
{
    moray_receding_horizon *receding;
    moray_receding_horizon_spec spec = {.replanner = {.nx = 1, .nu = 1, .make = state_anew, .free = free_problem},
                                        .settings = moray_settings_default(),
                                        .horizon = 1,
                                        .interval = 0.2};
    spec.settings.intervals = 1;
    spec.settings.max_refinements = 0;
    MORAY_TRY(moray_receding_horizon_new(&receding, &spec));
    const moray_controller controller = moray_receding_horizon_controller(receding);
    const moray_status status = follow(&controller);
    moray_receding_horizon_free(receding);
    return status;
}

static bool drift(void *self, double time, double *x)
{
    (void)self;
    x[0] += time * x[1];
    return true;
}

static moray_status filter(void)
{
    moray_kalman *kalman;
    for (int k = 0; k < 2; k++) {
        MORAY_TRY(moray_kalman_new(&kalman, 2, (double[]){1, 2}, (double[]){1, 1}));
        const moray_status status = moray_kalman_predict(kalman, 0.1, drift, NULL, (double[]){0, 0.1});
        moray_kalman_free(kalman);
        MORAY_TRY(status);
    }
    return moray_ok();
}

// ---- Orbits --------------------------------------------------------------------------------------------------------

static void driven(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = in[1];
    out[1] = -2 * in[0] - in[1] + in[2] * in[3];
}

static void at_rest(double t, double *x, const void *self)
{
    (void)t, (void)self;
    x[0] = x[1] = 0;
}

static moray_status use_orbit(moray_periodic_orbit *orbit)
{
    const double p[] = {0.3, 1}, slope[6] = {1, 2, 3, 4, 5, 6};
    const moray_periodic_orbit_guess guess = {.state = at_rest};
    moray_periodic_orbit_info info;
    double M[4], by[2];
    double complex lambda[2];
    MORAY_TRY(moray_periodic_orbit_solve(orbit, p, &guess, &info));
    MORAY_TRY(moray_periodic_orbit_monodromy(orbit, M));
    MORAY_TRY(moray_periodic_orbit_multipliers(orbit, lambda));
    return moray_periodic_orbit_ends_gradient(orbit, slope, by);
}

static moray_status find_orbit(void)
{
    static const moray_closing_condition both[] = {{MORAY_CLOSE_RETURNS, 0, 0}, {MORAY_CLOSE_RETURNS, 1, 0}};
    static const double probe[] = {0.3, 0.7, 0.4, 0.9};
    moray_map plant, closing;
    moray_periodic_orbit *orbit;
    MORAY_TRY(moray_map_from_complex(&plant, 4, 2, driven, NULL, NULL, probe));
    moray_status status = moray_closing_map(&closing, 2, 1, both, 2);
    if (!moray_failed(status)) {
        const moray_periodic_orbit_spec spec = {
            .nx = 2, .ns = 1, .plant = &plant, .closing = &closing, .scheme = "radau2", .intervals = 3};
        status = moray_periodic_orbit_new(&orbit, &spec);
        CHECK(moray_failed(status) == !orbit, "an orbit or none");
        if (!moray_failed(status))
            status = use_orbit(orbit);
        moray_periodic_orbit_free(orbit);
        moray_map_release(&closing);
    }
    moray_map_release(&plant);
    return status;
}

// ---- Paths ---------------------------------------------------------------------------------------------------------

static char path_file[] = "/tmp/moray-path-XXXXXX";

static moray_status read_and_ease(const char *text)
{
    moray_path path;
    MORAY_TRY(moray_path_read(&path, text, 0.2));
    const moray_status status = moray_path_ease(&path);
    moray_path_free(&path);
    return status;
}

static moray_status read_paths(void)
{
    MORAY_TRY(read_and_ease("0,0 1,1 2,0"));
    return read_and_ease(path_file);
}

// ---- Tunings -------------------------------------------------------------------------------------------------------

static bool bowl(void *self, const double *x, double *cost)
{
    (void)self;
    *cost = (x[0] - 0.3) * (x[0] - 0.3);
    return true;
}

// A search that has no memory ends where it began.
static moray_status tune(void)
{
    static const moray_tuned_number unit = {MORAY_TUNED_LINEAR, 0, 1, 0};
    const moray_tuning_problem problem = {.n = 1, .number = &unit, .cost = bowl};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x;
    settings.starts = settings.jobs = 1;
    settings.evaluations = 5;
    return moray_tune(&problem, &settings, NULL, 0, &x, &info);
}

int main(void)
{
    FILE *file = fdopen(mkstemp(path_file), "w");
    fputs("x_m,y_m\n0,0\n1,1\n2,0\n", file);
    fclose(file);
    fail_each("a closed loop", false, loop);
    fail_each("a receding horizon", false, replan);
    fail_each("filters", false, filter);
    fail_each("an orbit", false, find_orbit);
    fail_each("paths", false, read_paths);
    fail_each("a tuning", true, tune);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    unlink(path_file);
    return tap_done();
}
