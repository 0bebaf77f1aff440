// SPDX-License-Identifier: MIT
#include "ocp/certificate/unseen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/dense.h"

static const double step_part = 1e-4; // of a size, by which states and parameters are moved
static const double inset = 1e-6;     // of an interval, from its ends
static const double nearby = 1e-3;    // of the way from one point to the next
static const double resolved = 0.1;   // of how far effects differ from node to node, what a polynomial may miss of them
enum { halvings = 12 };
static const double small_jump = 1e-5; // in parts of the objective

// The ends of what is used of a control, its size apart at least, within its bounds.
static void choose_controls(struct unseen *u)
{
    const struct transcription *t = u->e->solution->transcription;
    const struct phase *phase = &t->ocp->phase[u->e->p];
    const struct phase_layout *layout = &t->layout.phase[u->e->p];
    for (int r = 0; r < phase->nu; r++) {
        double low = INFINITY, high = -INFINITY;
        for (int n = 0; n < layout->nodes; n++) {
            if (!layout->node[n].collocated)
                continue;
            low = fmin(low, t->x[layout->node[n].x + phase->nx + r]);
            high = fmax(high, t->x[layout->node[n].x + phase->nx + r]);
        }
        const double more = fmax(u->e->witness->size[phase->nx + r] - (high - low), 0) / 2;
        u->control[0][r] = fmin(fmax(low - more, phase->u[r].lower), phase->u[r].upper);
        u->control[1][r] = fmin(fmax(high + more, phase->u[r].lower), phase->u[r].upper);
    }
}

static void choose_direction(struct unseen *u)
{
    const struct phase *phase = &u->e->solution->transcription->ocp->phase[u->e->p];
    for (int j = 0; j < phase->nx + phase->nu + phase->ns; j++) {
        const bool control = j >= phase->nx && j < phase->nx + phase->nu;
        u->direction[j] = control ? 0 : moray_dense_entry(j, MORAY_DENSE_UNSEEN) * u->e->witness->size[j];
    }
}

moray_status moray_unseen_new(struct unseen *u, struct examiner *e)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase *phase = &t->ocp->phase[e->p];
    const size_t n_in = (size_t)phase->map->n_in, n_out = (size_t)phase->map->n_out, nu = (size_t)phase->nu;
    const size_t nx = (size_t)phase->nx, states = (size_t)t->layout.phase[e->p].nodes * nx;
    double *block = calloc(
        states + 5 * nx + n_in + 2 * nu + (4 + MORAY_UNSEEN_KINDS * (MORAY_MAX_STAGES + 3)) * n_out + 1, sizeof *block);
    // Without controls the least and the largest are the same.
    *u = (struct unseen){.e = e, .kinds = nu > 0 ? MORAY_UNSEEN_KINDS : high_control, .costate = block};
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    u->direction = block + states;
    u->control[0] = u->direction + n_in;
    u->control[1] = u->control[0] + nu;
    u->price = u->control[1] + nu;
    u->here = u->price + n_out;
    u->moved = u->here + n_out;
    u->told = u->moved + n_out;
    u->state = u->told + n_out;
    u->before = u->state + nx;
    u->last = u->before + nx;
    u->half = u->last + nx;
    u->end = u->half + nx;
    u->at_nodes = u->end + nx;
    for (int kind = 0; kind < MORAY_UNSEEN_KINDS; kind++)
        u->spread[kind] = u->at_nodes + ((size_t)MORAY_UNSEEN_KINDS * (MORAY_MAX_STAGES + 2) + (size_t)kind) * n_out;
    moray_solution_nodes(e->solution, e->p, NULL, u->costate);
    choose_controls(u);
    choose_direction(u);
    return moray_ok();
}

void moray_unseen_free(struct unseen *u)
{
    free(u->costate);
}

// ---- Effects ----

static int outputs(const struct unseen *u)
{
    return u->e->solution->transcription->ocp->phase[u->e->p].map->n_out;
}

// A sum over the outputs by what they cost, of what is more than `spread` (NULL: nothing) allows; what is not finite,
// away from the trajectory, costs nothing.
static double cost_of(const struct unseen *u, const double *effect, const double *told, const double *spread)
{
    double sum = 0;
    for (int i = 0; i < outputs(u); i++) {
        const double off = fabs(effect[i] - (told ? told[i] : 0)), allowed = spread ? resolved * spread[i] : 0;
        sum += u->price[i] > 0 && !(off <= allowed) ? u->price[i] * (off - allowed) : 0;
    }
    return isfinite(sum) ? sum : 0;
}

static void value_with(struct unseen *u, int kind, double *value)
{
    struct examiner *e = u->e;
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    memcpy(e->in + phase->nx, u->control[kind - low_control], (size_t)phase->nu * sizeof *e->in);
    phase->map->value(phase->map->self, e->in, value);
}

// Slope along the direction of states on one side of the point in e->in, whose values are in u->here.
static void slope_at(struct unseen *u, int side, double *slope)
{
    const struct phase *phase = &u->e->solution->transcription->ocp->phase[u->e->p];
    const moray_map *map = phase->map;
    double *at = u->e->in;
    for (int j = 0; j < map->n_in - 1; j++)
        at[j] += side * step_part * u->direction[j];
    map->value(map->self, at, slope);
    for (int j = 0; j < map->n_in - 1; j++)
        at[j] -= side * step_part * u->direction[j];
    for (int i = 0; i < map->n_out; i++)
        slope[i] = side * (slope[i] - u->here[i]) / step_part;
}

static bool has_room(const struct unseen *u, int side)
{
    const struct phase *phase = &u->e->solution->transcription->ocp->phase[u->e->p];
    for (int i = 0; i < phase->nx; i++) {
        const double x = u->e->in[i] + side * step_part * u->direction[i];
        if (x < phase->x[i].lower || x > phase->x[i].upper)
            return false;
    }
    return true;
}

// effect[n_out] at the point in e->in, of the side that is nearer to what is told (NULL: nothing), within bounds.
static void states_effect(struct unseen *u, const double *told, double *effect)
{
    const moray_map *map = u->e->solution->transcription->ocp->phase[u->e->p].map;
    double least = INFINITY;
    map->value(map->self, u->e->in, u->here);
    memset(effect, 0, (size_t)map->n_out * sizeof *effect);
    if (told)
        memcpy(effect, told, (size_t)map->n_out * sizeof *effect);
    for (int side = -1; side <= 1; side += 2) {
        if (!has_room(u, side))
            continue;
        slope_at(u, side, u->moved);
        const double cost = cost_of(u, u->moved, told, NULL);
        if (cost < least) {
            least = cost;
            memcpy(effect, u->moved, (size_t)map->n_out * sizeof *effect);
        }
    }
}

// Kinds in their order: where there are no controls the first leaves the values that are the second's.
static void effect_at(struct unseen *u, int kind, const double *told, double *effect)
{
    if (kind == along_states)
        states_effect(u, told, effect);
    else if (u->kinds == high_control)
        memcpy(effect, u->here, (size_t)outputs(u) * sizeof *effect);
    else
        value_with(u, kind, effect);
}

// What outputs cost at most at the nodes of the interval, by their multipliers.
static void set_prices(struct unseen *u, const struct interval *interval)
{
    const struct transcription *t = u->e->solution->transcription;
    const struct phase *phase = &t->ocp->phase[u->e->p];
    const struct phase_layout *layout = &t->layout.phase[u->e->p];
    memset(u->price, 0, (size_t)phase->map->n_out * sizeof *u->price);
    for (int j = 0; j < interval->scheme->points; j++)
        for (int r = 0; r < phase->nx; r++)
            u->price[r] = fmax(u->price[r], fabs(u->costate[(interval->first + j) * phase->nx + r]));
    for (int m = 0; m < phase->nq; m++)
        u->price[phase->nx + phase->nc + m] = fabs(u->e->solution->iterate.lambda[layout->integral_row + m]);
}

static double *effect_of(struct unseen *u, int kind, int j)
{
    return u->at_nodes + (kind * (MORAY_MAX_STAGES + 2) + j) * outputs(u);
}

static double time_at(const struct unseen *u, const struct interval *interval, double tau)
{
    const struct transcription *t = u->e->solution->transcription;
    const struct phase_cache *cache = &t->phase[u->e->p];
    const double start = t->layout.phase[u->e->p].node[interval->first].tau;
    return cache->t0 + (cache->tf - cache->t0) * (start + tau * interval->width);
}

// Just within the interval at its ends, where a phase may begin or end on a kink.
static void look_at_nodes(struct unseen *u, const struct interval *interval)
{
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
        const double tau = fmin(fmax(interval->scheme->node[j], inset), 1 - inset);
        moray_examiner_place(u->e, interval, time_at(u, interval, tau), NULL);
        for (int kind = 0; kind < u->kinds; kind++)
            effect_at(u, kind, NULL, effect_of(u, kind, j));
    }
}

static void interpolate(struct unseen *u, const struct interval *interval, int kind, const double *ell)
{
    memset(u->told, 0, (size_t)outputs(u) * sizeof *u->told);
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++)
        for (int i = 0; i < outputs(u); i++)
            u->told[i] += ell[j] * effect_of(u, kind, j)[i];
}

// u->spread: how far the effects at the nodes of the interval differ.
static void find_spread(struct unseen *u, const struct interval *interval, int kind)
{
    for (int i = 0; i < outputs(u); i++) {
        double low = INFINITY, high = -INFINITY;
        for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
            low = fmin(low, effect_of(u, kind, j)[i]);
            high = fmax(high, effect_of(u, kind, j)[i]);
        }
        u->spread[kind][i] = isfinite(high - low) ? high - low : 0;
    }
}

// ---- Jumps ----

// What the functions at the time and with the controls in e->in have between states a and b beside their slopes at
// both, by what it costs: next to nothing where they are smooth, and where they jump as much as they do.
static double jump_between(struct unseen *u, int kind, const double *a, const double *b)
{
    double *at = u->e->in, jump = 0;
    const int nx = u->e->solution->transcription->ocp->phase[u->e->p].nx, n_out = outputs(u);
    const double part[] = {0, nearby, 1 - nearby, 1};
    double *value[] = {u->here, u->moved, u->told, u->e->out};
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < nx; i++)
            at[i] = a[i] + part[k] * (b[i] - a[i]);
        value_with(u, kind, value[k]);
    }
    for (int i = 0; i < n_out; i++) {
        const double slopes = (value[1][i] - value[0][i] + value[3][i] - value[2][i]) / (2 * nearby);
        jump += u->price[i] > 0 ? u->price[i] * fabs(value[3][i] - value[0][i] - slopes) : 0;
    }
    return isfinite(jump) ? jump : 0;
}

// Halves the way as long as there is a jump on it: a steep slope is gone soon, a jump is not. Leaves u->before there.
static double jump_of(struct unseen *u, int kind, double small)
{
    const int nx = u->e->solution->transcription->ocp->phase[u->e->p].nx;
    double jump = jump_between(u, kind, u->before, u->state);
    memcpy(u->end, u->state, (size_t)nx * sizeof *u->end);
    for (int k = 0; k < halvings && jump > small; k++) {
        for (int i = 0; i < nx; i++)
            u->half[i] = (u->before[i] + u->end[i]) / 2;
        const double first = jump_between(u, kind, u->before, u->half), second = jump_between(u, kind, u->half, u->end);
        memcpy(first > second ? u->end : u->before, u->half, (size_t)nx * sizeof *u->half);
        jump = fmax(first, second);
    }
    return jump;
}

static double jump_since(struct unseen *u, double small)
{
    const size_t state = (size_t)u->e->solution->transcription->ocp->phase[u->e->p].nx * sizeof *u->state;
    double jump = 0;
    memcpy(u->state, u->e->in, state);
    for (int kind = low_control; kind < u->kinds && u->begun; kind++) {
        memcpy(u->before, u->last, state);
        jump = fmax(jump, jump_of(u, kind, small));
    }
    memcpy(u->last, u->state, state);
    u->begun = true;
    return jump;
}

// ---- All of it ----

double moray_unseen_interval(struct unseen *u, const struct interval *interval, double objective, double *jumps,
                             double *where)
{
    const struct phase_cache *cache = &u->e->solution->transcription->phase[u->e->p];
    const int count = moray_points_between(interval, interval->scheme->points);
    const double T = cache->tf - cache->t0;
    double ell[MORAY_MAX_STAGES + 2], integral[MORAY_MAX_STAGES + 2], sum[MORAY_UNSEEN_KINDS] = {0}, most = 0,
                                                                      worst = 0;
    *where = 0.5;
    if (jumps)
        *jumps = 0;
    set_prices(u, interval);
    look_at_nodes(u, interval);
    for (int kind = 0; kind < u->kinds; kind++)
        find_spread(u, interval, kind);
    for (int k = 0; k < count; k++) {
        const double tau = (k + 0.5) / count;
        moray_scheme_basis(interval->scheme, tau, ell, integral);
        moray_examiner_place_by_basis(u->e, interval, time_at(u, interval, tau), ell, integral);
        for (int kind = 0; kind < u->kinds; kind++) {
            interpolate(u, interval, kind, ell);
            effect_at(u, kind, u->told, u->e->out);
            const double here = cost_of(u, u->e->out, u->told, u->spread[kind]);
            sum[kind] += here;
            if (here > most)
                most = here, *where = tau;
        }
        if (jumps)
            *jumps += jump_since(u, small_jump * objective / T) * T / objective;
    }
    for (int kind = 0; kind < u->kinds; kind++)
        worst = fmax(worst, sum[kind] * T * interval->width / count / objective);
    return worst;
}
