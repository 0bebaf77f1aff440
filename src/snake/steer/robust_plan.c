// SPDX-License-Identifier: MIT
//
// All scenarios side by side in one phase, under one command: the states of each, what is fed forward, and the heading
// that is fed back, the mean over the scenarios.
#include "snake/steer/robust.h"

#include <math.h>
#include <stdlib.h>
#include <tgmath.h>

#include "moray/angle.h"

enum { SQUARES, STEERING, integrands };
enum { most_states = MORAY_ROBUST_SCENARIOS * ROBUST_STATES + 2, most_inputs = most_states + 3 };
static const double per_second = 10; // points of the plan found

typedef struct manoeuvre {
    const moray_robust_spec *spec;
    int states; // those of the scenarios, then wanted, heading
    bool blind;
    robust_robot robot[MORAY_ROBUST_SCENARIOS];
    moray_map map;
} manoeuvre;

static int wanted_of(const manoeuvre *m)
{
    return m->states - 2;
}

static int heading_of(const manoeuvre *m)
{
    return m->states - 1;
}

// in = [states, wanted', log gain unless blind, t], out = [states', integrands]
static void together(void *self, const double complex *in, double complex *out)
{
    const manoeuvre *m = self;
    const moray_robust_spec *spec = m->spec;
    const double complex *u = in + m->states, t = u[m->blind ? 1 : 2], gain = m->blind ? 0 : exp(u[1]);
    const double complex heading = in[heading_of(m)], hurry = u[0] / spec->offset_rate;
    double complex squares = 0, turning = 0;
    for (int k = 0; k < spec->n; k++) {
        const double complex *x = in + k * ROBUST_STATES;
        const double complex wanted = in[wanted_of(m)] + gain * (heading - x[ROBUST_THETA]);
        double rate;
        const double complex error = moray_robust_reference(&m->robot[k], t, &rate) - x[ROBUST_THETA];
        moray_robust_rates(&m->robot[k], x, moray_robust_limited(wanted, spec->offset), out + k * ROBUST_STATES);
        squares += error * error / (ROBUST_ERROR_UNIT * ROBUST_ERROR_UNIT) / spec->n;
        turning += x[ROBUST_V_THETA] / spec->n;
    }
    out[wanted_of(m)] = u[0];
    out[heading_of(m)] = turning;
    out[m->states + SQUARES] = squares;
    out[m->states + STEERING] = hurry * hurry;
}

static void mean_error(const moray_ends *at, moray_end_values *out, const void *data)
{
    const manoeuvre *m = data;
    const moray_robust_spec *spec = m->spec;
    const moray_num *q = at->phase->q;
    out->objective = (q[SQUARES] + spec->weight_steering * q[STEERING]) / spec->duration;
    if (!m->blind)
        out->objective += moray_robust_noise(spec, exp(at->s[0]));
}

static void release(manoeuvre *m)
{
    moray_map_release(&m->map);
    for (int k = 0; k < m->spec->n; k++)
        free(m->robot[k].plant);
    free(m);
}

static moray_status make(manoeuvre *m, const moray_robust_spec *spec)
{
    double probe[most_inputs] = {0};
    for (int k = 0; k < spec->n; k++) {
        const double at[ROBUST_STATES] = {0.1 + 0.01 * k, 0.05, spec->scenario[k].speed, 0.01, 0.2 * spec->offset};
        for (int i = 0; i < ROBUST_STATES; i++)
            probe[k * ROBUST_STATES + i] = at[i];
        MORAY_TRY(moray_robust_robot_new(&m->robot[k], spec, &spec->scenario[k]));
    }
    double *u = probe + m->states;
    probe[wanted_of(m)] = 0.1 * spec->offset;
    probe[heading_of(m)] = 0.12;
    *u++ = 0.1 * spec->offset_rate;
    if (!m->blind)
        *u++ = log(0.1);
    *u++ = 0.37 * spec->duration;
    return moray_map_from_complex(&m->map, (int)(u - probe), m->states + integrands, together, m, NULL, probe);
}

// ---- Solving -------------------------------------------------------------------------------------------------------

typedef struct room {
    moray_bounds x[most_states], x0[most_states], u, q[integrands];
    double *guess; // times, states, controls
} room;

static void bound(room *r, const manoeuvre *m)
{
    const moray_robust_spec *spec = m->spec;
    const double beyond = 4, all_round = 4 * M_PI; // what is wanted may go beyond the limits, which round it off
    double start[ROBUST_STATES], mean = 0;
    for (int k = 0; k < spec->n; k++) {
        moray_robust_bounds(spec, r->x + k * ROBUST_STATES);
        moray_robust_start(&spec->scenario[k], start);
        for (int i = 0; i < ROBUST_STATES; i++)
            r->x0[k * ROBUST_STATES + i] = moray_fixed(start[i]);
        mean += start[ROBUST_THETA] / spec->n;
    }
    r->x[wanted_of(m)] = moray_between(-beyond * spec->offset, beyond * spec->offset);
    r->x0[wanted_of(m)] = moray_fixed(0);
    r->x[heading_of(m)] = moray_between(-all_round, all_round);
    r->x0[heading_of(m)] = moray_fixed(mean);
    r->u = moray_between(-beyond * spec->offset_rate, beyond * spec->offset_rate);
    r->q[SQUARES] = r->q[STEERING] = moray_at_least(0);
}

static moray_samples guess(room *r, const manoeuvre *m, int points)
{
    const moray_robust_spec *spec = m->spec;
    double *time = r->guess, *x = time + points, *u = x + (size_t)points * m->states;
    for (int i = 0; i < points; i++, x += m->states) {
        time[i] = spec->duration * i / (points - 1);
        for (int k = 0; k < spec->n; k++) {
            double *own = x + k * ROBUST_STATES;
            moray_robust_guess(&spec->scenario[k], time[i], own);
            x[wanted_of(m)] += own[ROBUST_PHI_0] / spec->n;
            x[heading_of(m)] += own[ROBUST_THETA] / spec->n;
        }
    }
    return (moray_samples){.n = points, .time = time, .x = time + points, .u = u};
}

static moray_status read(moray_robust_plan *plan, const manoeuvre *m, const moray_solution *solution)
{
    double x[most_states];
    plan->duration = m->spec->duration;
    plan->n = (int)ceil(per_second * plan->duration) + 1;
    plan->point = calloc((size_t)plan->n, sizeof *plan->point);
    if (!plan->point)
        return moray_error(MORAY_MEMORY, "no memory for a plan of %d points", plan->n);
    plan->gain = m->blind ? 0 : exp(moray_solution_parameters(solution)[0]);
    for (int i = 0; i < plan->n; i++) {
        moray_solution_at(solution, 0, plan->duration * i / (plan->n - 1), x, NULL);
        plan->point[i] = (moray_robust_point){.wanted = x[wanted_of(m)], .heading = x[heading_of(m)]};
    }
    return moray_ok();
}

static moray_status solve(room *r, const manoeuvre *m, moray_robust_plan *plan, double *objective)
{
    static const char *const names[] = {"log gain"};
    const moray_robust_spec *spec = m->spec;
    const moray_bounds s[] = {moray_between(log(0.002), log(20))};
    const double start[] = {log(spec->start.proportional)};
    const int points = (int)ceil(2 * spec->duration) + 1;
    moray_ocp *ocp;
    moray_solution *solution = NULL;
    const moray_phase_spec phase = {.nx = m->states,
                                    .nu = 1,
                                    .nq = integrands,
                                    .map = &m->map,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(spec->duration),
                                    .x = {r->x, m->states},
                                    .x0 = {r->x0, m->states},
                                    .u = {&r->u, 1},
                                    .q = {r->q, integrands}};
    r->guess = calloc((size_t)points * (size_t)(2 + m->states), sizeof *r->guess);
    if (!r->guess)
        return moray_error(MORAY_MEMORY, "no memory for %d scenarios", spec->n);
    MORAY_TRY(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "robust plan",
                                                    .phases = 1,
                                                    .phase = &phase,
                                                    .ns = !m->blind,
                                                    .s = {s, !m->blind},
                                                    .s_names = names,
                                                    .endpoint = mean_error,
                                                    .data = m}));
    const moray_samples samples = guess(r, m, points);
    moray_status status = moray_solve(ocp, &spec->settings, &(moray_guess){.phase = &samples, .s = start}, &solution);
    if (!moray_failed(status)) {
        const moray_nlp_outcome outcome = moray_solution_info(solution)->outcome;
        *objective = moray_solution_objective(solution);
        if (outcome != MORAY_NLP_SOLVED && outcome != MORAY_NLP_ACCEPTABLE)
            status = moray_solution_failure(solution);
        else
            status = read(plan, m, solution);
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return status;
}

moray_status moray_robust_plan_make(moray_robust_plan *plan, double *objective, const moray_robust_spec *spec,
                                    bool blind)
{
    *plan = (moray_robust_plan){0};
    MORAY_TRY(moray_robust_check(spec));
    if (!(spec->weight_steering > 0))
        return moray_error(MORAY_INPUT, "weight of steering = %g: must be above 0", spec->weight_steering);
    manoeuvre *m = calloc(1, sizeof *m);
    room *r = calloc(1, sizeof *r);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for %d scenarios", spec->n);
    if (m) {
        *m = (manoeuvre){.spec = spec, .states = spec->n * ROBUST_STATES + 2, .blind = blind};
        if (r)
            status = make(m, spec);
    }
    if (!moray_failed(status)) {
        bound(r, m);
        status = solve(r, m, plan, objective);
    }
    if (r)
        free(r->guess);
    free(r);
    if (m)
        release(m);
    return status;
}

void moray_robust_plan_free(moray_robust_plan *plan)
{
    free(plan->point);
    *plan = (moray_robust_plan){0};
}

static moray_robust_point at_time(const moray_robust_plan *plan, double t)
{
    const double at = fmin(fmax(t / plan->duration, 0), 1) * (plan->n - 1);
    const int k = at < plan->n - 2 ? (int)at : plan->n - 2;
    const moray_robust_point *from = &plan->point[k], *to = from + 1;
    return (moray_robust_point){.wanted = from->wanted + (at - k) * (to->wanted - from->wanted),
                                .heading = from->heading + (at - k) * (to->heading - from->heading)};
}

double moray_robust_plan_wanted(const moray_robust_plan *plan, double t)
{
    return at_time(plan, t).wanted;
}

double moray_robust_plan_heading(const moray_robust_plan *plan, double t)
{
    return at_time(plan, t).heading;
}
