// SPDX-License-Identifier: MIT
//
// States of the filter: of the averaged plant with its velocities relative to the water, in the body's frame; the
// current; the logarithms of the two factors.
#include "moray/snake/navigator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "moray/control/kalman.h"
#include "moray/snake/plant.h"

enum { body = MORAY_BODY_STATES, V_X = body, V_Y, AMPLITUDE, TURNING, states };
enum {
    plant_inputs = MORAY_STEERING_STATES + 1 + MORAY_STEERING_PARAMETERS + 1,
    plant_outputs = MORAY_STEERING_STATES + 1
};

static const double longest_step = 0.25; // of the classical Runge-Kutta method [s]

// ---- The averaged plant --------------------------------------------------------------------------------------------

typedef struct averaged {
    moray_map map;
    moray_gait gait;
    double offset, rate; // at the start of a move
} averaged;

static moray_status averaged_new(averaged *plant, const moray_robot *robot, const moray_gait *gait)
{
    const moray_plant_spec spec = {.robot = *robot, .joints = MORAY_JOINTS_STEERED};
    *plant = (averaged){.gait = *gait};
    return moray_average_plant(&plant->map, &spec);
}

static void rates(const averaged *plant, double t, const double *x, double *dx)
{
    const double turning = exp(x[TURNING]), offset = plant->offset + plant->rate * t;
    double in[plant_inputs] = {0}, out[plant_outputs];
    memcpy(in, x, body * sizeof *x);
    in[MORAY_STATE_PHI_0] = turning * offset;
    in[MORAY_STATE_V_PHI_0] = turning * plant->rate;
    double *s = in + MORAY_STEERING_STATES + 1;
    s[MORAY_STEERING_AMPLITUDE] = plant->gait.amplitude * exp(x[AMPLITUDE]);
    s[MORAY_STEERING_OMEGA] = plant->gait.omega;
    s[MORAY_STEERING_DELTA] = plant->gait.delta;
    plant->map.value(plant->map.self, in, out);
    memset(dx, 0, states * sizeof *dx);
    memcpy(dx, out, body * sizeof *dx);
    dx[MORAY_STATE_P_X] += x[V_X];
    dx[MORAY_STATE_P_Y] += x[V_Y];
}

static void ahead(const double *x, double h, const double *slope, double *at)
{
    for (int i = 0; i < states; i++)
        at[i] = x[i] + h * slope[i];
}

// A moray_kalman_move.
static bool move(void *self, double time, double *x)
{
    const averaged *plant = self;
    const int n = moray_count_up(time / longest_step);
    const double h = n ? time / n : 0;
    for (int i = 0; i < n; i++) {
        double k[4][states], at[states];
        const double t = i * h;
        rates(plant, t, x, k[0]);
        ahead(x, h / 2, k[0], at);
        rates(plant, t + h / 2, at, k[1]);
        ahead(x, h / 2, k[1], at);
        rates(plant, t + h / 2, at, k[2]);
        ahead(x, h, k[2], at);
        rates(plant, t + h, at, k[3]);
        for (int j = 0; j < states; j++)
            x[j] += h / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
    }
    return true;
}

// ---- Beliefs -------------------------------------------------------------------------------------------------------

// What the plant comes to with these factors: speed through the water, and rate of turning.
static void settle(averaged *plant, double amplitude, double turning, double offset, double *speed, double *rate)
{
    const double long_enough = 60;
    double x[states] = {[MORAY_STATE_V_1] = 0.2, [AMPLITUDE] = log(amplitude), [TURNING] = log(turning)};
    plant->offset = offset;
    plant->rate = 0;
    move(plant, long_enough, x);
    *speed = hypot(x[MORAY_STATE_V_1], x[MORAY_STATE_V_2]);
    *rate = x[MORAY_STATE_V_THETA];
}

// Speed grows with the amplitude, the rate of turning with the offset.
static double factor(averaged *plant, bool turning, double amplitude, double offset, double wanted)
{
    double low = log(1.0 / 3), high = log(3);
    for (int k = 0; k < 40; k++) {
        const double middle = (low + high) / 2;
        double speed, rate;
        settle(plant, turning ? amplitude : exp(middle), turning ? exp(middle) : 1, turning ? offset : 0, &speed,
               &rate);
        *((turning ? fabs(rate) < fabs(wanted) : speed < wanted) ? &low : &high) = middle;
    }
    return exp((low + high) / 2);
}

moray_status moray_belief_find(moray_belief *belief, const moray_robot *robot, const moray_gait *gait, double speed,
                               double offset, double rate)
{
    averaged plant;
    double found[2];
    *belief = (moray_belief){.amplitude = 1, .turning = 1};
    MORAY_TRY(averaged_new(&plant, robot, gait));
    belief->amplitude = factor(&plant, false, 1, 0, speed);
    belief->turning = factor(&plant, true, belief->amplitude, offset, rate);
    settle(&plant, belief->amplitude, belief->turning, 0, &found[0], &found[1]);
    const double straight = found[0];
    settle(&plant, belief->amplitude, belief->turning, offset, &found[0], &found[1]);
    moray_map_release(&plant.map);
    if (fabs(straight - speed) > 1e-4 * speed || fabs(fabs(found[1]) - fabs(rate)) > 1e-3 * fabs(rate))
        return moray_error(MORAY_NOT_SOLVED, "no factors of the averaged plant give %g m/s and %g rad/s", speed, rate);
    return moray_ok();
}

// ---- The filter ----------------------------------------------------------------------------------------------------

struct moray_navigator {
    moray_navigator_spec spec;
    averaged plant;
    moray_kalman *filter;
    double t;
    double noise[states];
};

static moray_status start(moray_navigator *n)
{
    const moray_navigator_spec *spec = &n->spec;
    const double current = spec->current_doubt * spec->current_doubt, factors = spec->factor_doubt * spec->factor_doubt;
    const double x[states] = {[MORAY_STATE_THETA] = spec->heading,       [MORAY_STATE_P_X] = spec->position[0],
                              [MORAY_STATE_P_Y] = spec->position[1],     [MORAY_STATE_V_1] = spec->speed,
                              [V_X] = spec->belief.current[0],           [V_Y] = spec->belief.current[1],
                              [AMPLITUDE] = log(spec->belief.amplitude), [TURNING] = log(spec->belief.turning)};
    // Of the first state some per cent. The averaged plant's turning is what it has least right, by a degree in some
    // seconds; the current and the factors may drift by half their doubt in five minutes.
    const double doubt[states] = {1e-4, 1e-4, 1e-4, 1e-5, 1e-4, 1e-4, current, current, factors, factors};
    const double noise[states] = {1e-4, 1e-6,           1e-6,           1e-4,           1e-7,
                                  1e-7, current / 1200, current / 1200, factors / 1200, factors / 1200};
    memcpy(n->noise, noise, sizeof noise);
    return moray_kalman_new(&n->filter, states, x, doubt);
}

moray_status moray_navigator_new(moray_navigator **result, const moray_navigator_spec *spec)
{
    *result = NULL;
    if (!(spec->heading_error > 0 && spec->position_error > 0 && spec->rate_error >= 0 && spec->current_doubt >= 0 &&
          spec->factor_doubt >= 0))
        return moray_error(MORAY_INPUT, "errors of the readings, %g rad and %g m: must be above 0, doubts at least 0",
                           spec->heading_error, spec->position_error);
    moray_navigator *n = calloc(1, sizeof *n);
    if (!n)
        return moray_error(MORAY_MEMORY, "no memory for a navigator");
    n->spec = *spec;
    moray_status status = averaged_new(&n->plant, &spec->robot, &spec->gait);
    if (!moray_failed(status))
        status = start(n);
    if (moray_failed(status))
        moray_navigator_free(n);
    else
        *result = n;
    return status;
}

void moray_navigator_free(moray_navigator *navigator)
{
    if (!navigator)
        return;
    moray_kalman_free(navigator->filter);
    moray_map_release(&navigator->plant.map);
    free(navigator);
}

moray_status moray_navigator_advance(moray_navigator *n, double t, double offset, double rate)
{
    const double time = t - n->t;
    if (!(time > 0))
        return moray_ok();
    n->plant.offset = offset;
    n->plant.rate = rate;
    MORAY_TRY(moray_kalman_predict(n->filter, time, move, &n->plant, n->noise));
    n->t = t;
    return moray_ok();
}

static void see(void *self, const double *x, double *z)
{
    (void)self;
    z[0] = x[MORAY_STATE_THETA];
    z[1] = x[MORAY_STATE_P_X];
    z[2] = x[MORAY_STATE_P_Y];
}

moray_status moray_navigator_read(moray_navigator *n, double heading, double p_x, double p_y)
{
    const double z[3] = {heading, p_x, p_y}, a = n->spec.heading_error, p = n->spec.position_error;
    return moray_kalman_update(n->filter, 3, see, NULL, z, (double[]){a * a, p * p, p * p}, 1);
}

static void see_rate(void *self, const double *x, double *z)
{
    (void)self;
    z[0] = x[MORAY_STATE_V_THETA];
}

moray_status moray_navigator_read_rate(moray_navigator *n, double rate)
{
    const double error = n->spec.rate_error;
    return moray_kalman_update(n->filter, 1, see_rate, NULL, &rate, (double[]){error * error}, 0);
}

moray_belief moray_navigator_belief(const moray_navigator *n)
{
    const double *x = moray_kalman_estimate(n->filter);
    return (moray_belief){exp(x[AMPLITUDE]), exp(x[TURNING]), {x[V_X], x[V_Y]}};
}

double moray_navigator_doubt(const moray_navigator *n)
{
    return sqrt(fmax(moray_kalman_covariance(n->filter, V_X, V_X), moray_kalman_covariance(n->filter, V_Y, V_Y)));
}

void moray_navigator_state(const moray_navigator *n, double state[body])
{
    const double *x = moray_kalman_estimate(n->filter);
    const double c = cos(x[MORAY_STATE_THETA]), s = sin(x[MORAY_STATE_THETA]);
    memcpy(state, x, body * sizeof *x);
    state[MORAY_STATE_V_1] += c * x[V_X] + s * x[V_Y];
    state[MORAY_STATE_V_2] += c * x[V_Y] - s * x[V_X];
}
