// SPDX-License-Identifier: MIT
#include "snake/gait/over.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Events of a gait problem, at most.
enum { most_events = MORAY_BODY_STATES + GAIT_OPTIONAL_EVENTS };

// ---- Parameters (amplitude, omega of each, delta, offset of each, taper, t) ----------------------------------------

// Where those of scenario k stand, ascending.
static void places(const moray_gait_over *over, int k, int place[MORAY_GAIT_PARAMETERS])
{
    const int n = over->n, at[] = {0, 1 + k, 1 + n, 2 + n + k, 2 + 2 * n};
    memcpy(place, at, sizeof at);
}

static int place_of_t(const moray_gait_over *over)
{
    return 3 + 2 * over->n;
}

// ---- Ends ----------------------------------------------------------------------------------------------------------

// Events of scenario k: its own but, after the first, without those of the shared shape: places [first, last).
static void shared_events(const moray_gait_over *over, int k, int *first, int *last)
{
    const struct gait_endpoint *e = &over->problem[k]->endpoint;
    *first = e->nx;
    *last = k > 0 ? e->nx + 1 + e->head + e->tail : e->nx;
}

static int events_of(const moray_gait_over *over, int k)
{
    int first, last;
    shared_events(over, k, &first, &last);
    return over->problem[k]->e.n - (last - first);
}

static moray_num gain_of(const moray_gait_over *over, int k, const moray_phase_ends *period)
{
    const moray_gait_problem *problem = over->problem[k];
    const int p = problem->endpoint.position;
    const double *V = problem->spec.current;
    const moray_num x = (period->xf[p] - period->x0[p]) / period->tf - V[0];
    const moray_num y = (period->xf[p + 1] - period->x0[p + 1]) / period->tf - V[1];
    return csqrt(x * x + y * y) / over->speed[k] - 1;
}

static void over_ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_gait_over *over = data;
    const moray_num t = over->goal == MORAY_OVER_WORST ? at->s[place_of_t(over)] : 0;
    moray_num *e = out->e, sum = 0;
    for (int k = 0; k < over->n; k++) {
        int place[MORAY_GAIT_PARAMETERS], first, last;
        moray_num own[MORAY_GAIT_PARAMETERS], all[most_events];
        moray_end_values of = {.e = all};
        places(over, k, place);
        for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++)
            own[i] = at->s[place[i]];
        moray_gait_ends(&(moray_ends){&at->phase[k], own}, &of, &over->problem[k]->endpoint);
        shared_events(over, k, &first, &last);
        for (int i = 0; i < over->problem[k]->e.n; i++)
            if (i < first || i >= last)
                *e++ = all[i];
        const moray_num gain = gain_of(over, k, &at->phase[k]);
        sum += gain / over->n;
        if (over->goal == MORAY_OVER_WORST)
            *e++ = gain - t;
    }
    out->objective = over->goal == MORAY_OVER_WORST ? -t : -sum;
}

// ---- Construction --------------------------------------------------------------------------------------------------

static void nothing_value(void *self, const double *in, double *out)
{
    (void)self, (void)in, (void)out;
}

static void nothing_hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in, (void)weight, (void)values;
}

// The plant of scenario k, which stays its problem's, with the parameters of all.
static moray_status widen_plant(moray_gait_over *over, int k)
{
    const moray_gait_problem *problem = over->problem[k];
    const int nx = problem->size.nx;
    int place[MORAY_BODY_STATES + MORAY_GAIT_PARAMETERS + 1];
    moray_map base = problem->plant;
    moray_map none = {
        .n_in = nx + over->ns + 1, .value = nothing_value, .jacobian = nothing_value, .hessian = nothing_hessian};
    base.release = NULL;
    for (int i = 0; i < nx; i++)
        place[i] = i;
    places(over, k, place + nx);
    for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++)
        place[nx + i] += nx;
    place[nx + MORAY_GAIT_PARAMETERS] = nx + over->ns;
    return moray_map_join(&over->plant[k], &base, place, &none, base.n_out);
}

static void fill_parameters(moray_gait_over *over, const moray_gait_scenario *scenario)
{
    static const char *const names[] = {"amplitude", "omega", "delta", "phi_0", "taper"};
    for (int k = over->n - 1; k >= 0; k--) { // what is shared ends as the first has it
        int place[MORAY_GAIT_PARAMETERS];
        places(over, k, place);
        for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++) {
            const bool own = i == 1 || i == 3;
            over->bounds[place[i]] = over->problem[k]->s.at[i];
            snprintf(over->text[place[i]], OVER_NAME, own ? "%s on %s" : "%s", names[i], scenario[k].name);
        }
    }
    if (over->goal == MORAY_OVER_WORST) {
        over->bounds[place_of_t(over)] = moray_at_least(-1);
        snprintf(over->text[place_of_t(over)], OVER_NAME, "least gain");
    }
}

static void fill_events(moray_gait_over *over, const moray_gait_scenario *scenario)
{
    int at = over->ns;
    for (int k = 0; k < over->n; k++) {
        const moray_gait_problem *problem = over->problem[k];
        int first, last;
        shared_events(over, k, &first, &last);
        for (int i = 0; i < problem->e.n; i++) {
            if (i >= first && i < last)
                continue;
            const bool power = problem->endpoint.power && i == moray_gait_power_event(&problem->endpoint);
            over->bounds[at] = power ? moray_fixed(problem->e.at[i].upper) : problem->e.at[i];
            snprintf(over->text[at++], OVER_NAME, "%s on %.24s", problem->names[i], scenario[k].name);
        }
        if (over->goal == MORAY_OVER_WORST) {
            over->bounds[at] = moray_at_least(0);
            snprintf(over->text[at++], OVER_NAME, "gain on %.24s", scenario[k].name);
        }
    }
}

static moray_status make_problems(moray_gait_over *over, const moray_gait_scenario *scenario)
{
    over->ns = 3 + 2 * over->n + (over->goal == MORAY_OVER_WORST);
    for (int k = 0; k < over->n; k++) {
        moray_gait_problem_spec spec = scenario[k].problem;
        spec.goal = MORAY_GAIT_FASTEST;
        if (spec.joints != MORAY_JOINTS_ON_GAIT || spec.model != scenario[0].problem.model)
            return moray_error(MORAY_INPUT, "scenario %s: all have their joints on the gait, and the same model",
                               scenario[k].name);
        if (!(scenario[k].speed > 0 && isfinite(scenario[k].speed)))
            return moray_error(MORAY_INPUT, "scenario %s: speed of the baseline = %g m/s: must be finite and above 0",
                               scenario[k].name, scenario[k].speed);
        over->speed[k] = scenario[k].speed;
        MORAY_TRY(moray_gait_problem_new(&over->problem[k], &spec));
        MORAY_TRY(widen_plant(over, k));
        over->phase[k] = over->problem[k]->phase;
        over->phase[k].name = scenario[k].name;
        over->phase[k].map = &over->plant[k];
        over->ne += events_of(over, k) + (over->goal == MORAY_OVER_WORST);
    }
    return moray_ok();
}

static moray_status make(moray_gait_over *over, const moray_gait_scenario *scenario)
{
    MORAY_TRY(make_problems(over, scenario));
    const size_t all = (size_t)(over->ns + over->ne);
    over->bounds = calloc(all, sizeof *over->bounds);
    over->text = calloc(all, sizeof *over->text);
    over->name = calloc(all, sizeof *over->name);
    if (!over->bounds || !over->text || !over->name)
        return moray_error(MORAY_MEMORY, "no memory for a gait over %d scenarios", over->n);
    fill_parameters(over, scenario);
    fill_events(over, scenario);
    for (size_t i = 0; i < all; i++)
        over->name[i] = over->text[i];
    return moray_ocp_new(&over->ocp, &(moray_ocp_spec){.name = "gait over scenarios",
                                                       .phases = over->n,
                                                       .phase = over->phase,
                                                       .ns = over->ns,
                                                       .s = {over->bounds, over->ns},
                                                       .s_names = over->name,
                                                       .ne = over->ne,
                                                       .e = {over->bounds + over->ns, over->ne},
                                                       .e_names = over->name + over->ns,
                                                       .endpoint = over_ends,
                                                       .data = over});
}

moray_status moray_gait_over_new(moray_gait_over **result, const moray_gait_scenario *scenario, int n,
                                 moray_over_goal goal)
{
    *result = NULL;
    if (n < 1 || n > MORAY_SCENARIOS)
        return moray_error(MORAY_INPUT, "%d scenarios: must be 1 to %d", n, MORAY_SCENARIOS);
    moray_gait_over *over = calloc(1, sizeof *over);
    if (!over)
        return moray_error(MORAY_MEMORY, "no memory for a gait over %d scenarios", n);
    over->n = n;
    over->goal = goal;
    const moray_status status = make(over, scenario);
    if (moray_failed(status))
        moray_gait_over_free(over);
    else
        *result = over;
    return status;
}

void moray_gait_over_free(moray_gait_over *over)
{
    if (!over)
        return;
    moray_ocp_free(over->ocp);
    for (int k = 0; k < over->n; k++) {
        moray_map_release(&over->plant[k]);
        moray_gait_problem_free(over->problem[k]);
    }
    free(over->bounds);
    free(over->text);
    free(over->name);
    free(over);
}

// ---- Solving -------------------------------------------------------------------------------------------------------

static double speed_on(const moray_gait_problem *problem, const moray_swim_track *orbit)
{
    const moray_pose *first = &orbit->pose[0], *last = &orbit->pose[orbit->n - 1];
    const double T = orbit->t[orbit->n - 1] - orbit->t[0];
    return hypot((last->p_x - first->p_x) / T - problem->spec.current[0],
                 (last->p_y - first->p_y) / T - problem->spec.current[1]);
}

static void guess_parameters(const moray_gait_over *over, const moray_gait *gait, const moray_swim_track *orbit,
                             double *s)
{
    double least = INFINITY;
    for (int k = over->n - 1; k >= 0; k--) {
        double own[MORAY_GAIT_PARAMETERS];
        int place[MORAY_GAIT_PARAMETERS];
        places(over, k, place);
        moray_gait_to_parameters(&gait[k], own);
        for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++)
            s[place[i]] = own[i];
        least = fmin(least, speed_on(over->problem[k], &orbit[k]) / over->speed[k] - 1);
    }
    if (over->goal == MORAY_OVER_WORST)
        s[place_of_t(over)] = least;
}

moray_status moray_gait_over_solve(const moray_gait_over *over, const moray_settings *settings, const moray_gait *gait,
                                   const moray_swim_track *orbit, moray_solution **solution)
{
    moray_samples samples[MORAY_SCENARIOS];
    double s[4 + 2 * MORAY_SCENARIOS];
    size_t rows = 0;
    for (int k = 0; k < over->n; k++)
        rows += (size_t)orbit[k].n;
    double *x = calloc(rows * MORAY_BODY_STATES + 1, sizeof *x), *next = x;
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %d scenarios", over->n);
    for (int k = 0; k < over->n; k++) {
        moray_gait_problem_states(over->problem[k], &orbit[k], next);
        samples[k] = (moray_samples){.n = orbit[k].n, .time = orbit[k].t, .x = next};
        next += orbit[k].n * MORAY_BODY_STATES;
    }
    guess_parameters(over, gait, orbit, s);
    const moray_guess guess = {.phase = samples, .s = s};
    const moray_status status = moray_solve(over->ocp, settings, &guess, solution);
    free(x);
    return status;
}

moray_gait_prediction moray_gait_over_prediction(const moray_gait_over *over, const moray_solution *solution, int k)
{
    const double *s = moray_solution_parameters(solution);
    double own[MORAY_GAIT_PARAMETERS];
    int place[MORAY_GAIT_PARAMETERS];
    places(over, k, place);
    for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++)
        own[i] = s[place[i]];
    return moray_gait_problem_read(over->problem[k], solution, k, own);
}

double moray_gait_over_gain(const moray_solution *solution)
{
    return -moray_solution_objective(solution);
}
