// SPDX-License-Identifier: MIT
#include "snake/gait/problem.h"
#include "snake/model/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { most_states = MORAY_BODY_STATES + 2 * (MORAY_MOST_LINKS - 1) };

static moray_gait gait_of(const moray_gait_problem *problem, const double *s)
{
    return problem->spec.joints == MORAY_JOINTS_SERIES ? (moray_gait){.omega = s[0]} : moray_gait_from_parameters(s);
}

moray_gait_prediction moray_gait_problem_read(const moray_gait_problem *problem, const moray_solution *solution,
                                              int phase, const double *s)
{
    const moray_gait_problem_spec *spec = &problem->spec;
    const int at = problem->endpoint.position;
    double t0, tf, x[most_states];
    moray_gait_prediction prediction = {.gait = gait_of(problem, s)};
    moray_solution_times(solution, phase, &t0, &tf);
    moray_solution_at(solution, phase, tf, x, NULL);
    prediction.v_x = x[at] / tf;
    prediction.v_y = x[at + 1] / tf;
    prediction.speed = hypot(prediction.v_x - spec->current[0], prediction.v_y - spec->current[1]);
    prediction.course_speed = prediction.v_x * cos(spec->course) + prediction.v_y * sin(spec->course);
    prediction.power = moray_solution_integrals(solution, phase)[0] / tf;
    return prediction;
}

moray_gait_prediction moray_gait_problem_prediction(const moray_gait_problem *problem, const moray_solution *solution)
{
    moray_gait_prediction prediction =
        moray_gait_problem_read(problem, solution, 0, moray_solution_parameters(solution));
    if (problem->endpoint.power)
        prediction.power_price = moray_solution_event_multipliers(solution)[moray_gait_power_event(&problem->endpoint)];
    return prediction;
}

moray_gait_slope moray_gait_problem_slope(const moray_gait_problem *problem, const moray_solution *solution,
                                          const moray_sensitivity *sensitivity)
{
    const moray_gait_prediction prediction = moray_gait_problem_prediction(problem, solution);
    const int at = problem->endpoint.position;
    const double *course = problem->endpoint.course, *s = moray_sensitivity_parameters(sensitivity);
    double t0, tf, d_t0, d_tf, d_x0[most_states], d_xf[most_states];
    moray_solution_times(solution, 0, &t0, &tf);
    moray_sensitivity_times(sensitivity, 0, &d_t0, &d_tf);
    moray_sensitivity_ends(sensitivity, 0, d_x0, d_xf);
    const double d_way = d_xf[at] * course[0] + d_xf[at + 1] * course[1];
    const double d_work = moray_sensitivity_integrals(sensitivity, 0)[0];
    return (moray_gait_slope){.gait = gait_of(problem, s),
                              .course_speed = (d_way - prediction.course_speed * d_tf) / tf,
                              .power = (d_work - prediction.power * d_tf) / tf};
}

// The plant's state from the swimmer's.
static void plant_state(const moray_gait_problem *problem, const double *full, double *x)
{
    if (problem->spec.joints == MORAY_JOINTS_CLOSED_LOOP) {
        memcpy(x, full, (size_t)problem->size.nx * sizeof *x);
        return;
    }
    moray_state_body(problem->spec.model, problem->spec.robot.links, full, x);
}

void moray_gait_problem_states(const moray_gait_problem *problem, const moray_swim_track *orbit, double *x)
{
    for (int k = 0; k < orbit->n; k++)
        plant_state(problem, orbit->x + k * orbit->n_states, x + k * problem->size.nx);
}

moray_status moray_gait_problem_solve(const moray_gait_problem *problem, const moray_settings *settings,
                                      const moray_gait *gait, const moray_swim_track *orbit, moray_solution **solution)
{
    const int nx = problem->size.nx;
    MORAY_TRY(moray_gait_without_series(gait, "the start of an optimisation"));
    if (problem->size.ns != MORAY_GAIT_PARAMETERS)
        return moray_error(MORAY_INPUT, "a problem of %d parameters does not start from a gait, which has %d",
                           problem->size.ns, MORAY_GAIT_PARAMETERS);
    double s[MORAY_GAIT_PARAMETERS], *x = calloc((size_t)(orbit->n * nx) + 1, sizeof *x);
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %d samples", orbit->n);
    moray_gait_problem_states(problem, orbit, x);
    moray_gait_to_parameters(gait, s);
    const moray_samples samples = {.n = orbit->n, .time = orbit->t, .x = x};
    const moray_guess guess = {.phase = &samples, .s = s};
    moray_settings own = *settings;
    own.barrier_shared = true; // an orbit is right but for its limits, of which a fine mesh has many
    moray_status status = moray_solve(problem->ocp, &own, &guess, solution);
    free(x);
    return status;
}

moray_status moray_gait_problem_continue(const moray_gait_problem *problem, const moray_settings *settings,
                                         const moray_solution *from, const double *s, moray_solution **solution)
{
    const int nx = problem->size.nx, n = 4 * settings->intervals + 1;
    double *time = calloc((size_t)(n * (1 + nx)), sizeof *time), t0, tf;
    if (!time)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %d samples", n);
    double *x = time + n;
    moray_solution_times(from, 0, &t0, &tf);
    for (int k = 0; k < n; k++) {
        time[k] = t0 + (tf - t0) * k / (n - 1);
        moray_solution_at(from, 0, time[k], x + k * nx, NULL);
    }
    const moray_samples samples = {.n = n, .time = time, .x = x};
    const moray_guess guess = {.phase = &samples, .s = s};
    const moray_status status = moray_solve(problem->ocp, settings, &guess, solution);
    free(time);
    return status;
}
