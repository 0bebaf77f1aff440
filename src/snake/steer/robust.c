// SPDX-License-Identifier: MIT
#include "snake/steer/robust.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/angle.h"

enum { INTEGRAL = ROBUST_STATES, states };
enum { GAIN, FORWARD, INTEGRAL_GAIN, gains }; // the first as its logarithm
enum { inputs = states + gains + 1, outputs = states + 1 };

typedef struct scenario {
    robust_robot robot;
    moray_map map;
} scenario;

// in = [state, gains, t], out = [state', squared error]
static void closed_loop(void *self, const double complex *in, double complex *out)
{
    const robust_robot *robot = self;
    const double limit = robot->spec->offset;
    const double complex *s = in + states, t = s[gains];
    double rate;
    const double complex error = moray_robust_reference(robot, t, &rate) - in[ROBUST_THETA], gain = exp(s[GAIN]);
    const double complex wanted = gain * (error + s[INTEGRAL_GAIN] * in[INTEGRAL]) + s[FORWARD] * rate;
    const double complex command = moray_robust_limited(wanted, limit), within = command / limit;
    moray_robust_rates(robot, in, command, out);
    out[INTEGRAL] = error * (1 - within * within); // rests at the limit
    out[states] = error * error / (ROBUST_ERROR_UNIT * ROBUST_ERROR_UNIT);
}

static void release_scenario(scenario *at)
{
    moray_map_release(&at->map);
    free(at->robot.plant);
}

static moray_status make_scenario(scenario *at, const moray_robust_spec *spec, const moray_scenario *own)
{
    const double probe[inputs] = {0.1,  0.05,     own->speed, 0.01, 0.2 * spec->offset,
                                  0.02, log(0.1), 0.2,        0.1,  0.37 * spec->duration};
    MORAY_TRY(moray_robust_robot_new(&at->robot, spec, own));
    return moray_map_from_complex(&at->map, inputs, outputs, closed_loop, &at->robot, NULL, probe);
}

static void mean_error(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_robust_spec *spec = data;
    out->objective = moray_robust_noise(spec, exp(at->s[GAIN]));
    for (int k = 0; k < spec->n; k++)
        out->objective += at->phase[k].q[0] / spec->duration / spec->n;
}

// ---- Solving -------------------------------------------------------------------------------------------------------

typedef struct room {
    scenario at[MORAY_ROBUST_SCENARIOS];
    moray_phase_spec phase[MORAY_ROBUST_SCENARIOS];
    moray_bounds x0[MORAY_ROBUST_SCENARIOS][states], x[states], q;
    moray_samples samples[MORAY_ROBUST_SCENARIOS];
    double *guess; // times, then states, of all phases
} room;

enum { points = 401 };

static void make_guess(room *r, const moray_robust_spec *spec, int k)
{
    double *time = r->guess + (size_t)k * points * (1 + states), *x = time + points;
    for (int i = 0; i < points; i++) {
        time[i] = spec->duration * i / (points - 1);
        moray_robust_guess(&spec->scenario[k], time[i], x + i * states);
        x[i * states + INTEGRAL] = 0;
    }
    r->samples[k] = (moray_samples){.n = points, .time = time, .x = x};
}

static void bound_states(room *r, const moray_robust_spec *spec)
{
    const double all_round = 4 * M_PI;
    moray_robust_bounds(spec, r->x);
    r->x[INTEGRAL] = moray_between(-all_round * spec->duration, all_round * spec->duration);
    r->q = moray_at_least(0);
}

static moray_status make_phase(room *r, const moray_robust_spec *spec, int k)
{
    static const char *const names[states] = {"theta", "v_theta", "v_t", "v_n", "phi_0", "integral"};
    double start[states] = {0};
    MORAY_TRY(make_scenario(&r->at[k], spec, &spec->scenario[k]));
    moray_robust_start(&spec->scenario[k], start);
    for (int i = 0; i < states; i++)
        r->x0[k][i] = moray_fixed(start[i]);
    r->phase[k] = (moray_phase_spec){.nx = states,
                                     .nq = 1,
                                     .map = &r->at[k].map,
                                     .t0 = moray_fixed(0),
                                     .tf = moray_fixed(spec->duration),
                                     .x = {r->x, states},
                                     .x0 = {r->x0[k], states},
                                     .q = {&r->q, 1},
                                     .x_names = names};
    make_guess(r, spec, k);
    return moray_ok();
}

static moray_status solve(room *r, const moray_robust_spec *spec, moray_heading_gains *found, double *objective)
{
    static const char *const names[gains] = {"log gain", "forward", "integral gain"};
    const moray_bounds s[gains] = {moray_between(log(0.002), log(20)), moray_between(0, 20), moray_between(0, 20)};
    const double start[gains] = {log(spec->start.proportional), spec->start.forward, spec->start.integral};
    moray_ocp *ocp;
    moray_solution *solution = NULL;
    MORAY_TRY(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "robust gains",
                                                    .phases = spec->n,
                                                    .phase = r->phase,
                                                    .ns = gains,
                                                    .s = {s, gains},
                                                    .s_names = names,
                                                    .endpoint = mean_error,
                                                    .data = spec}));
    const moray_guess guess = {.phase = r->samples, .s = start};
    moray_status status = moray_solve(ocp, &spec->settings, &guess, &solution);
    if (!moray_failed(status)) {
        const double *at = moray_solution_parameters(solution);
        const moray_nlp_outcome outcome = moray_solution_info(solution)->outcome;
        *found =
            (moray_heading_gains){.proportional = exp(at[GAIN]), .forward = at[FORWARD], .integral = at[INTEGRAL_GAIN]};
        *objective = moray_solution_objective(solution);
        if (outcome != MORAY_NLP_SOLVED && outcome != MORAY_NLP_ACCEPTABLE)
            status = moray_solution_failure(solution);
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return status;
}

moray_status moray_robust_gains(moray_heading_gains *found, double *objective, const moray_robust_spec *spec)
{
    MORAY_TRY(moray_robust_check(spec));
    room *r = calloc(1, sizeof *r);
    if (!r)
        return moray_error(MORAY_MEMORY, "no memory for %d scenarios", spec->n);
    r->guess = calloc((size_t)spec->n * points * (1 + states), sizeof *r->guess);
    moray_status status = r->guess ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d scenarios", spec->n);
    bound_states(r, spec);
    for (int k = 0; k < spec->n && !moray_failed(status); k++)
        status = make_phase(r, spec, k);
    if (!moray_failed(status))
        status = solve(r, spec, found, objective);
    for (int k = 0; k < spec->n; k++)
        release_scenario(&r->at[k]);
    free(r->guess);
    free(r);
    return status;
}
