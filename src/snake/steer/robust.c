// SPDX-License-Identifier: MIT
#include "moray/snake/robust.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/angle.h"
#include "snake/plant/average.h"

enum { THETA, V_THETA, V_T, V_N, PHI_0, INTEGRAL, states };
enum { GAIN, FORWARD, INTEGRAL_GAIN, gains }; // the first as its logarithm
enum { inputs = states + gains + 1, outputs = states + 1 };
enum { plant_inputs = MORAY_STEERING_STATES + 1 + MORAY_STEERING_PARAMETERS + 1 };

static const double error_unit = 10 * MORAY_DEGREE;

typedef struct scenario {
    const moray_robust_spec *spec;
    const moray_scenario *own;
    moray_average *plant;
    moray_map map;
} scenario;

// Keeps a value within its limit, rounded off.
static double complex limited(double complex value, double limit)
{
    return limit * tanh(value / limit);
}

// in = [state, gains, t], out = [state', squared error]
static void closed_loop(void *self, const double complex *in, double complex *out)
{
    const scenario *at = self;
    const moray_robust_spec *spec = at->spec;
    const moray_gait *gait = &spec->gait;
    const double complex *s = in + states, t = s[gains];
    double rate;
    const double now = moray_reference_at(at->own->reference, creal(t), &rate);
    const double complex error = now + rate * (t - creal(t)) - in[THETA], gain = exp(s[GAIN]);
    const double complex wanted = gain * (error + s[INTEGRAL_GAIN] * in[INTEGRAL]) + s[FORWARD] * rate;
    const double complex command = limited(wanted, spec->offset), within = command / spec->offset;
    const double complex v_phi_0 = limited((command - in[PHI_0]) / spec->lag, spec->offset_rate);
    const double turning = at->own->belief.turning;
    double complex full[plant_inputs] = {[MORAY_STATE_THETA] = in[THETA],
                                         [MORAY_STATE_V_THETA] = in[V_THETA],
                                         [MORAY_STATE_V_1] = in[V_T],
                                         [MORAY_STATE_V_2] = in[V_N],
                                         [MORAY_STATE_PHI_0] = turning * in[PHI_0],
                                         [MORAY_STATE_V_PHI_0] = turning * v_phi_0};
    double complex rates[MORAY_STEERING_STATES + 1];
    double complex *p = full + MORAY_STEERING_STATES + 1;
    p[MORAY_STEERING_AMPLITUDE] = gait->amplitude * at->own->belief.amplitude;
    p[MORAY_STEERING_OMEGA] = gait->omega;
    p[MORAY_STEERING_DELTA] = gait->delta;
    moray_average_rates(at->plant, full, rates);
    out[THETA] = in[V_THETA];
    out[V_THETA] = rates[MORAY_STATE_V_THETA];
    out[V_T] = rates[MORAY_STATE_V_1];
    out[V_N] = rates[MORAY_STATE_V_2];
    out[PHI_0] = v_phi_0;
    out[INTEGRAL] = error * (1 - within * within); // rests at the limit
    out[states] = error * error / (error_unit * error_unit);
}

static void release_scenario(scenario *at)
{
    moray_map_release(&at->map);
    free(at->plant);
}

// In still water: how a robot turns in a uniform current is how it turns without.
static moray_status make_scenario(scenario *at, const moray_robust_spec *spec, const moray_scenario *own)
{
    const moray_plant_spec plant = {.robot = spec->robot, .joints = MORAY_JOINTS_STEERED};
    const double probe[inputs] = {0.1,  0.05,     own->speed, 0.01, 0.2 * spec->offset,
                                  0.02, log(0.1), 0.2,        0.1,  0.37 * spec->duration};
    *at = (scenario){.spec = spec, .own = own};
    MORAY_TRY(moray_average_new(&at->plant, &plant));
    return moray_map_from_complex(&at->map, inputs, outputs, closed_loop, at, NULL, probe);
}

static void mean_error(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_robust_spec *spec = data;
    const moray_num gain = exp(at->s[GAIN]);
    const double noise = spec->noise * spec->noise * spec->sampling / (2 * error_unit * error_unit);
    out->objective = 0;
    for (int k = 0; k < spec->n; k++)
        out->objective += (at->phase[k].q[0] / spec->duration + noise * gain * fabs(spec->scenario[k].turn)) / spec->n;
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

// The reference as though it were followed, somewhat late: the sizes of all that is solved for are taken from here.
static void make_guess(room *r, const moray_robust_spec *spec, int k)
{
    double *time = r->guess + (size_t)k * points * (1 + states), *x = time + points, rate;
    const double late = 1;
    memset(x, 0, points * states * sizeof *x);
    for (int i = 0; i < points; i++) {
        time[i] = spec->duration * i / (points - 1);
        x[i * states + THETA] = moray_reference_at(spec->scenario[k].reference, fmax(time[i] - late, 0), &rate);
        x[i * states + V_THETA] = rate;
        x[i * states + V_T] = spec->scenario[k].speed;
        x[i * states + PHI_0] = rate / spec->scenario[k].turn;
    }
    r->samples[k] = (moray_samples){.n = points, .time = time, .x = x};
}

// Wide, but such that the robot swims ahead, as the averaged plant takes for granted.
static void bound_states(room *r, const moray_robust_spec *spec)
{
    const double speed = spec->scenario->speed, all_round = 4 * M_PI;
    r->x[THETA] = moray_between(-all_round, all_round);
    r->x[V_THETA] = moray_between(-1, 1);
    r->x[V_T] = moray_between(0.1 * speed, 3 * speed);
    r->x[V_N] = moray_between(-speed, speed);
    r->x[PHI_0] = moray_between(-spec->offset, spec->offset);
    r->x[INTEGRAL] = moray_between(-all_round * spec->duration, all_round * spec->duration);
    r->q = moray_at_least(0);
}

static moray_status make_phase(room *r, const moray_robust_spec *spec, int k)
{
    static const char *const names[states] = {"theta", "v_theta", "v_t", "v_n", "phi_0", "integral"};
    const moray_scenario *own = &spec->scenario[k];
    double rate;
    MORAY_TRY(make_scenario(&r->at[k], spec, own));
    const moray_bounds x0[states] = {moray_fixed(moray_reference_at(own->reference, 0, &rate)),
                                     moray_fixed(0),
                                     moray_fixed(own->speed),
                                     moray_fixed(0),
                                     moray_fixed(0),
                                     moray_fixed(0)};
    memcpy(r->x0[k], x0, sizeof x0);
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
    if (spec->n < 1 || spec->n > MORAY_ROBUST_SCENARIOS)
        return moray_error(MORAY_INPUT, "%d scenarios: must be from 1 to %d", spec->n, MORAY_ROBUST_SCENARIOS);
    if (!(spec->start.proportional > 0 && spec->lag > 0 && spec->offset > 0 && spec->offset_rate > 0 &&
          spec->noise >= 0 && spec->sampling >= 0))
        return moray_error(MORAY_INPUT, "gain to start from = %g, lag = %g s, limits %g, %g: must be above 0",
                           spec->start.proportional, spec->lag, spec->offset, spec->offset_rate);
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
