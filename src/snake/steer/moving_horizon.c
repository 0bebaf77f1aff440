// SPDX-License-Identifier: MIT
//
// States: of the averaged plant, its velocities relative to the water, in the body's frame. Parameters: the current,
// and the logarithms of the two factors.
#include "moray/snake/moving_horizon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/snake/plant.h"

enum { body = MORAY_BODY_STATES, V_X = 0, V_Y, AMPLITUDE, TURNING, parameters, channels = 3 };
enum {
    plant_inputs = MORAY_STEERING_STATES + 1 + MORAY_STEERING_PARAMETERS + 1,
    plant_outputs = MORAY_STEERING_STATES + 1
};

typedef struct window {
    const moray_navigator_spec *spec;
    const moray_log *log;
    moray_map plant;
    int first, n;         // of the log
    double *time, *value; // [n], [n][channels]
    double before[parameters], doubt[parameters];
} window;

// Offset and its rate at t.
static void steered(const moray_log *log, double t, double *offset, double *rate)
{
    int low = 0, high = log->n - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(log->t[middle] <= t ? &low : &high) = middle;
    }
    *rate = (log->offset[high] - log->offset[low]) / (log->t[high] - log->t[low]);
    *offset = log->offset[low] + *rate * (t - log->t[low]);
}

static void swim(const moray_real_node *at, moray_real_rates *out, const void *data)
{
    const window *w = data;
    const double turning = exp(at->s[TURNING]);
    double in[plant_inputs] = {0}, rates[plant_outputs], offset, rate;
    double *gait = in + MORAY_STEERING_STATES + 1;
    steered(w->log, at->t, &offset, &rate);
    memcpy(in, at->x, body * sizeof *in);
    in[MORAY_STATE_PHI_0] = turning * offset;
    in[MORAY_STATE_V_PHI_0] = turning * rate;
    gait[MORAY_STEERING_AMPLITUDE] = w->spec->gait.amplitude * exp(at->s[AMPLITUDE]);
    gait[MORAY_STEERING_OMEGA] = w->spec->gait.omega;
    gait[MORAY_STEERING_DELTA] = w->spec->gait.delta;
    w->plant.value(w->plant.self, in, rates);
    memcpy(out->f, rates, body * sizeof *rates);
    out->f[MORAY_STATE_P_X] += at->s[V_X];
    out->f[MORAY_STATE_P_Y] += at->s[V_Y];
}

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[MORAY_STATE_THETA];
    y[1] = at->x[MORAY_STATE_P_X];
    y[2] = at->x[MORAY_STATE_P_Y];
}

// How far it is from what was believed.
static void depart(const moray_real_ends *at, moray_real_end_values *out, const void *data)
{
    const window *w = data;
    out->objective = 0;
    for (int k = 0; k < parameters; k++) {
        const double part = w->doubt[k] > 0 ? (at->s[k] - w->before[k]) / w->doubt[k] : 0;
        out->objective += part * part;
    }
}

static moray_status open_window(window *w, double length)
{
    const moray_log *all = w->log;
    const moray_belief *belief = &w->spec->belief;
    const double current = w->spec->current_doubt, factor = w->spec->factor_doubt;
    const double before[] = {belief->current[0], belief->current[1], log(belief->amplitude), log(belief->turning)},
                 doubt[] = {current, current, factor, factor};
    memcpy(w->before, before, sizeof before);
    memcpy(w->doubt, doubt, sizeof doubt);
    while (w->first < all->n && all->t[w->first] < all->t[all->n - 1] - length)
        w->first++;
    w->time = malloc((size_t)(all->n - w->first) * (1 + channels) * sizeof *w->time);
    if (!w->time)
        return moray_error(MORAY_MEMORY, "no memory for a window of %d readings", all->n - w->first);
    w->value = w->time + (all->n - w->first);
    for (int k = w->first; k < all->n; k++) {
        if (isnan(all->heading[k]))
            continue;
        const double read[channels] = {all->heading[k], all->p_x[k], all->p_y[k]};
        memcpy(w->value + channels * w->n, read, sizeof read);
        w->time[w->n++] = all->t[k];
    }
    return w->n > 1 ? moray_ok()
                    : moray_error(MORAY_INPUT, "window = %g s: %d readings in it, must be at least 2", length, w->n);
}

static moray_status pose(const window *w, moray_ocp **ocp)
{
    const double a = 1 / (w->spec->heading_error * w->spec->heading_error),
                 p = 1 / (w->spec->position_error * w->spec->position_error), weight[channels] = {a, p, p};
    moray_bounds s[parameters];
    for (int k = 0; k < parameters; k++)
        s[k] = w->doubt[k] > 0 ? moray_between(w->before[k] - 1, w->before[k] + 1) : moray_fixed(w->before[k]);
    const moray_phase_spec phase = {
        .name = "window",
        .nx = body,
        .continuous_real = swim,
        .t0 = moray_fixed(w->time[0]),
        .tf = moray_fixed(w->time[w->n - 1]),
        .observed = {.n = w->n, .ny = channels, .time = w->time, .value = w->value, .weight = weight, .observe = see}};
    return moray_ocp_new(ocp, &(moray_ocp_spec){.name = "moving horizon",
                                                .phases = 1,
                                                .ns = parameters,
                                                .phase = &phase,
                                                .endpoint_real = depart,
                                                .s = {s, parameters},
                                                .data = w});
}

// From the readings, swimming steadily; each off by its error, as on the readings the objective would have no size.
static moray_status fit(const window *w, const moray_ocp *ocp, const moray_settings *settings,
                        moray_solution **solution)
{
    double *x = calloc((size_t)w->n * body, sizeof *x);
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for the guess of a window");
    for (int k = 0; k < w->n; k++) {
        const double *read = w->value + channels * k;
        x[k * body + MORAY_STATE_THETA] = read[0] + w->spec->heading_error;
        x[k * body + MORAY_STATE_P_X] = read[1] + w->spec->position_error;
        x[k * body + MORAY_STATE_P_Y] = read[2] + w->spec->position_error;
        x[k * body + MORAY_STATE_V_1] = w->spec->speed;
    }
    const moray_samples samples = {.n = w->n, .time = w->time, .x = x};
    const moray_status status = moray_solve(ocp, settings, &(moray_guess){.phase = &samples, .s = w->before}, solution);
    free(x);
    MORAY_TRY(status);
    return moray_solution_info(*solution)->outcome == MORAY_NLP_SOLVED ? moray_ok() : moray_solution_failure(*solution);
}

static moray_status tell(const moray_solution *solution, moray_belief *found, double error[4])
{
    const double *s = moray_solution_parameters(solution);
    moray_fit of = {0};
    *found = (moray_belief){exp(s[AMPLITUDE]), exp(s[TURNING]), {s[V_X], s[V_Y]}};
    if (!error)
        return moray_ok();
    const moray_status status = moray_fit_new(&of, solution, true);
    for (int k = 0; k < parameters && !moray_failed(status); k++)
        error[k] = of.error[k] * (k < AMPLITUDE ? 1 : exp(s[k]));
    moray_fit_free(&of);
    return status;
}

moray_status moray_moving_horizon(const moray_navigator_spec *spec, const moray_log *log, double length,
                                  const moray_settings *settings, moray_belief *found, double error[4])
{
    const moray_plant_spec plant = {.robot = spec->robot, .joints = MORAY_JOINTS_STEERED};
    window w = {.spec = spec, .log = log};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    MORAY_TRY(moray_average_plant(&w.plant, &plant));
    moray_status status = open_window(&w, length);
    if (!moray_failed(status))
        status = pose(&w, &ocp);
    if (!moray_failed(status))
        status = fit(&w, ocp, settings, &solution);
    if (!moray_failed(status))
        status = tell(solution, found, error);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    free(w.time);
    moray_map_release(&w.plant);
    return status;
}
