// SPDX-License-Identifier: MIT
#include "ocp/observe/observed.h"

#include <math.h>
#include <string.h>

#include "ocp/hold.h"

static const double same = 1e-9; // distance of edges, in the length of the phase, that are one
static const double near = 0.25; // part of an interval by which its edge is moved rather than the interval cut

// ---- What is asked ----

static moray_status check_function(const struct phase *phase, const moray_observations *given)
{
    const int inputs = phase->nx + phase->nu + phase->ns + 1;
    if (!!given->observe + !!given->map != 1)
        return moray_error(MORAY_INPUT, "observations of phase %s: need a function or a map, and only one",
                           phase->name);
    if (given->map && (given->map->n_in != inputs || given->map->n_out != given->ny))
        return moray_error(MORAY_INPUT,
                           "observations of phase %s: the map has %d inputs and %d outputs, needs %d and %d",
                           phase->name, given->map->n_in, given->map->n_out, inputs, given->ny);
    if (given->loss == MORAY_HUBER && !(given->threshold > 0 && isfinite(given->threshold)))
        return moray_error(MORAY_INPUT, "observations of phase %s: the threshold of Huber's loss is %g, must be > 0",
                           phase->name, given->threshold);
    return moray_ok();
}

static moray_status check_data(const struct phase *phase, const moray_observations *given)
{
    for (int k = 0; k < given->n; k++)
        if (!(given->time[k] >= phase->t0.lower && given->time[k] <= phase->tf.upper))
            return moray_error(MORAY_INPUT, "observations of phase %s: time[%d] = %g is not within [%g, %g]",
                               phase->name, k, given->time[k], phase->t0.lower, phase->tf.upper);
    for (int k = 0; k < given->n * given->ny; k++)
        if (isinf(given->value[k]))
            return moray_error(MORAY_INPUT, "observations of phase %s: value[%d][%d] is infinite", phase->name,
                               k / given->ny, k % given->ny);
    for (int j = 0; given->weight && j < given->ny; j++)
        if (!(given->weight[j] >= 0 && isfinite(given->weight[j])))
            return moray_error(MORAY_INPUT, "observations of phase %s: weight[%d] = %g, must not be negative",
                               phase->name, j, given->weight[j]);
    return moray_ok();
}

moray_status moray_check_observations(const struct phase *phase, const moray_observations *given)
{
    if (given->n < 0 || given->ny < 1 || !given->time || !given->value)
        return moray_error(MORAY_INPUT, "observations of phase %s: n %d, ny %d; need times, values and a channel",
                           phase->name, given->n, given->ny);
    MORAY_TRY(check_function(phase, given));
    return check_data(phase, given);
}

void moray_hold_observations(struct phase *phase, const moray_observations *given)
{
    for (int k = 0; k < given->n; k++) {
        phase->t0.upper = fmin(phase->t0.upper, given->time[k]);
        phase->tf.lower = fmax(phase->tf.lower, given->time[k]);
    }
}

bool moray_data_move(const struct phase *phase)
{
    return phase->observed.n > 0 && !(moray_bounds_are_fixed(phase->t0) && moray_bounds_are_fixed(phase->tf));
}

// ---- Events ----

bool moray_has_residual_event(const struct observed *o, int k, int j)
{
    return o->residual && !isnan(o->value[k * o->ny + j]);
}

int moray_observed_events(const struct observed *o)
{
    int n = o->has_sum;
    for (int k = 0; k < o->n; k++)
        for (int j = 0; j < o->ny; j++)
            n += moray_has_residual_event(o, k, j);
    return n;
}

moray_bounds moray_observed_event(const struct observed *o, int i, int *k, int *j)
{
    for (*k = 0; *k < o->n; ++*k)
        for (*j = 0; *j < o->ny; ++*j)
            if (moray_has_residual_event(o, *k, *j) && i-- == 0)
                return o->residual[*j];
    return o->sum;
}

// ---- Places on a mesh ----

static double tau_of(const struct phase *phase, int k)
{
    return (phase->observed.time[k] - phase->t0.lower) / (phase->tf.lower - phase->t0.lower);
}

bool moray_is_observed_at(const struct phase *phase, double tau)
{
    for (int k = 0; k < phase->observed.n && !moray_data_move(phase); k++)
        if (fabs(tau_of(phase, k) - tau) <= same)
            return true;
    return false;
}

// The interval that holds tau, with its left edge.
static int interval_of(const struct mesh *mesh, double tau)
{
    int k = 0;
    while (k + 1 < mesh->intervals && tau >= mesh->edge[k + 1])
        k++;
    return k;
}

// An edge that the user put where it is stays, for it may stand on a kink.
static bool is_given(const struct phase *phase, double tau)
{
    for (int k = 0; phase->mesh && k <= phase->intervals; k++)
        if (fabs(phase->mesh[k] - tau) <= same)
            return true;
    return false;
}

static bool may_move(const struct mesh *mesh, const struct phase *phase, int edge)
{
    return edge > 0 && edge < mesh->intervals && !moray_is_observed_at(phase, mesh->edge[edge]) &&
           !moray_holds_at(phase, mesh->edge[edge]) && !is_given(phase, mesh->edge[edge]);
}

static void insert(struct mesh *mesh, int k, double tau)
{
    const size_t after = (size_t)(mesh->intervals - k);
    memmove(mesh->edge + k + 2, mesh->edge + k + 1, after * sizeof *mesh->edge);
    memmove(mesh->raised_from + k + 1, mesh->raised_from + k, after * sizeof *mesh->raised_from);
    memmove(mesh->stages + k + 1, mesh->stages + k, after * sizeof *mesh->stages);
    memmove(mesh->past + k + 1, mesh->past + k, after * sizeof *mesh->past);
    mesh->edge[k + 1] = tau;
    mesh->intervals++;
}

static void cut_at(struct mesh *mesh, const struct phase *phase, double tau)
{
    const int k = interval_of(mesh, tau);
    const double left = mesh->edge[k], right = mesh->edge[k + 1], reach = near * (right - left);
    if (tau - left <= same || right - tau <= same)
        return;
    if (tau - left < reach && may_move(mesh, phase, k))
        mesh->edge[k] = tau;
    else if (right - tau < reach && may_move(mesh, phase, k + 1))
        mesh->edge[k + 1] = tau;
    else
        insert(mesh, k, tau);
}

moray_status moray_cut_at_observations(struct mesh *mesh, const struct phase *phase)
{
    if (phase->observed.n == 0 || moray_data_move(phase))
        return moray_ok();
    struct mesh room;
    const size_t n = (size_t)mesh->intervals;
    MORAY_TRY(moray_mesh_new(&room, mesh->intervals + phase->observed.n));
    room.intervals = mesh->intervals;
    room.method = mesh->method;
    memcpy(room.edge, mesh->edge, (n + 1) * sizeof *mesh->edge);
    memcpy(room.raised_from, mesh->raised_from, n * sizeof *mesh->raised_from);
    memcpy(room.stages, mesh->stages, n * sizeof *mesh->stages);
    memcpy(room.past, mesh->past, n * sizeof *mesh->past);
    for (int k = 0; k < phase->observed.n; k++)
        cut_at(&room, phase, tau_of(phase, k));
    moray_mesh_free(mesh);
    *mesh = room;
    return moray_ok();
}

const struct node *moray_observed_node(const struct layout *layout, const moray_ocp *ocp, int p, int k)
{
    const struct phase_layout *phase = &layout->phase[p];
    const double tau = tau_of(&ocp->phase[p], k);
    const struct node *nearest = phase->node;
    for (int i = 0; i <= phase->mesh.intervals; i++) {
        const int n = i < phase->mesh.intervals ? phase->interval[i].first : phase->nodes - 1;
        if (fabs(phase->node[n].tau - tau) < fabs(nearest->tau - tau))
            nearest = &phase->node[n];
    }
    return nearest;
}
