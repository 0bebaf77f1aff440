// SPDX-License-Identifier: MIT
//
// Where an interval is not accurate enough: more stages if its slope is smooth, that is, its Legendre coefficients
// decay fast enough for the stages allowed to do; else smaller intervals, placed where the slope changes most.
#include "ocp/refinement/refine.h"

#include <math.h>
#include <stdlib.h>

#include "ocp/certificate/unseen.h"
#include "ocp/refinement/examine.h"
#include "ocp/legendre.h"
#include "ocp/hold.h"
#include "ocp/observe/observed.h"

enum { most_pieces = 4, first_raise = 4 }; // first_raise: stages before which decay cannot be told
static const double concentrated = 0.7;    // share of an interval's variation between two nodes that calls for a cut
static const double least_width = 1e-9;
static const double aim = 0.1;  // of the tolerance
static const double vain = 0.3; // part of the error left by more stages that says they do not help

struct refinement {
    struct examiner e;
    double tolerance;
    struct mesh mesh; // grows
    double spare;     // error of its last interval where that stands as it was, else infinite
    double *error;    // [intervals] of the old mesh
    double *where;    // [2 intervals] in them, 0..1, where there is what no node tells, NaN: nowhere; and scratch
};

// Contribution of the slope of the i-th integrated quantity at stage point j to it, relative to its size.
static double slope_at(const struct refinement *r, const struct interval *interval, int j, int i)
{
    const struct transcription *t = r->e.solution->transcription;
    const struct phase_cache *cache = &t->phase[r->e.p];
    const double h = (cache->tf - cache->t0) * interval->width;
    const double *out = cache->out + (interval->first + j) * t->ocp->phase[r->e.p].map->n_out;
    return h * out[moray_examiner_output(&r->e, i)] / r->e.size[i];
}

// size[stages]: norm over all that is integrated of the Legendre coefficients of the slope.
static void legendre_sizes(const struct refinement *r, const struct interval *interval, double *size)
{
    const moray_scheme *scheme = interval->scheme;
    const int s = scheme->stages;
    double gauss[MORAY_MAX_STAGES], weight[MORAY_MAX_STAGES], ell[MORAY_MAX_STAGES + 2], integral[MORAY_MAX_STAGES + 2];
    moray_legendre_gauss(s, gauss, weight);
    for (int k = 0; k < s; k++)
        size[k] = 0;
    for (int i = 0; i < r->e.n; i++) {
        double coefficient[MORAY_MAX_STAGES] = {0};
        for (int point = 0; point < s; point++) {
            double slope = 0;
            moray_scheme_basis(scheme, gauss[point], ell, integral);
            for (int j = scheme->first; j <= scheme->last; j++)
                slope += ell[j] * slope_at(r, interval, j, i);
            for (int k = 0; k < s; k++)
                coefficient[k] += (2 * k + 1) * weight[point] * moray_legendre_value(k, gauss[point]) * slope;
        }
        for (int k = 0; k < s; k++)
            size[k] = hypot(size[k], coefficient[k]);
    }
}

// Rate d of the decay e^(-d k) of the coefficients, or NaN where there are too few to tell. Pairs of neighbours,
// because an even or odd slope lacks every other one.
static double decay(const struct refinement *r, const struct interval *interval)
{
    const int s = interval->scheme->stages;
    double size[MORAY_MAX_STAGES];
    if (s < 3)
        return NAN;
    legendre_sizes(r, interval, size);
    if (s == 3)
        return log(size[1] / size[2]);
    return log(fmax(size[1], size[2]) / fmax(size[s - 2], size[s - 1])) / (s - 3);
}

// The pair of neighbouring stage points between which the slope changes most, and its share in the whole change.
static int largest_change(const struct refinement *r, const struct interval *interval, double *share)
{
    double sum = 0, most = 0;
    int where = interval->scheme->first;
    for (int j = interval->scheme->first; j < interval->scheme->last; j++) {
        double change = 0;
        for (int i = 0; i < r->e.n; i++)
            change = hypot(change, slope_at(r, interval, j + 1, i) - slope_at(r, interval, j, i));
        sum += change;
        if (change > most) {
            most = change;
            where = j;
        }
    }
    *share = sum > 0 ? most / sum : 0;
    return where;
}

static void add_interval(struct mesh *mesh, double end, int stages)
{
    mesh->stages[mesh->intervals++] = stages;
    mesh->edge[mesh->intervals] = end;
}

static void split_evenly(struct mesh *mesh, double end, int pieces, int stages)
{
    const double start = mesh->edge[mesh->intervals];
    for (int i = 1; i < pieces; i++)
        add_interval(mesh, start + (end - start) * i / pieces, stages);
    add_interval(mesh, end, stages);
}

// An effect that no node tells is cut out at the points on either side of where it is largest, so that it gets nodes.
static void cut_out(struct refinement *r, const struct interval *interval, double where)
{
    const struct node *node = r->e.solution->transcription->layout.phase[r->e.p].node + interval->first;
    const double apart = 1.0 / moray_points_between(interval, interval->scheme->points);
    const double start = node[0].tau, end = node[interval->scheme->points - 1].tau;
    const double left = start + (where - apart) * interval->width, right = start + (where + apart) * interval->width;
    if (left > start + least_width)
        add_interval(&r->mesh, left, r->mesh.method.stages);
    if (right < end - least_width)
        add_interval(&r->mesh, right, r->mesh.method.stages);
    add_interval(&r->mesh, end, r->mesh.method.stages);
}

// A jump or kink between two nodes is cut out at those nodes; elsewhere the error falls with width^(stages + 1), which
// gives the number of even pieces.
static void split(struct refinement *r, const struct interval *interval, double excess)
{
    const struct node *node = r->e.solution->transcription->layout.phase[r->e.p].node + interval->first;
    const int last = interval->scheme->points - 1, s = interval->scheme->stages;
    double share;
    const int j = largest_change(r, interval, &share);
    if (share < concentrated) {
        split_evenly(&r->mesh, node[last].tau, (int)fmin(fmax(ceil(pow(excess, 1.0 / (s + 1))), 2), most_pieces), s);
        return;
    }
    if (j > 0)
        add_interval(&r->mesh, node[j].tau, r->mesh.method.stages);
    split_evenly(&r->mesh, node[j + 1].tau, 2, r->mesh.method.stages);
    if (j + 1 < last)
        add_interval(&r->mesh, node[last].tau, r->mesh.method.stages);
}

// Makes one of an interval and the one before it.
static void merge_last(struct mesh *mesh, double end, enum mesh_past past)
{
    enum mesh_past *merged = &mesh->past[mesh->intervals - 1];
    mesh->edge[mesh->intervals] = end;
    *merged = past == mesh_settled || *merged == mesh_settled ? mesh_settled : mesh_merged;
}

// Takes an interval over as it is, or merges it with its neighbour of as many stages where their error allows; not
// where that was tried before, between two that are settled: an error that is small because the edge stands on a kink
// is back once the edge is gone, and the meshes would alternate for ever.
static void keep(struct refinement *r, double end, int stages, enum mesh_past past, double error)
{
    const int last = r->mesh.intervals - 1;
    const double merged = (error + r->spare) * ldexp(1, stages + 1);
    const bool tried = last >= 0 && past == mesh_settled && r->mesh.past[last] == mesh_settled;
    const struct phase *phase = &r->e.solution->transcription->ocp->phase[r->e.p];
    const double edge = last >= 0 ? r->mesh.edge[r->mesh.intervals] : 0;
    const bool stays = moray_is_observed_at(phase, edge) || moray_holds_at(phase, edge);
    if (last >= 0 && !tried && !stays && r->mesh.stages[last] == stages && merged < aim * aim * r->tolerance) {
        merge_last(&r->mesh, end, past);
        r->spare = INFINITY;
    } else {
        add_interval(&r->mesh, end, stages);
        r->mesh.past[last + 1] = past;
        r->spare = error;
    }
}

// Coefficients e^(-rate k) need log(excess)/rate more stages; where more stages did not help last time the interval is
// cut.
static void refine_interval(struct refinement *r, int k)
{
    const double error = r->error[k], unseen_at = r->where[k];
    const struct phase_layout *layout = &r->e.solution->transcription->layout.phase[r->e.p];
    const struct interval *interval = &layout->interval[k];
    const double raised_from = layout->mesh.raised_from[k];
    const struct node *node = layout->node + interval->first;
    const int s = interval->scheme->stages, first = r->mesh.intervals;
    const double end = node[interval->scheme->points - 1].tau, excess = error / (aim * r->tolerance);
    if ((error <= r->tolerance && isnan(unseen_at)) || interval->width < least_width) {
        keep(r, end, s, layout->mesh.past[k], error);
        return;
    }
    r->spare = INFINITY;
    const double rate = decay(r, interval), stages = isnan(rate) ? first_raise : s + ceil(log(excess) / rate);
    const bool in_vain = error > vain * raised_from;
    if (!isnan(unseen_at)) {
        cut_out(r, interval, unseen_at);
    } else if (stages > s && stages <= REFINE_MOST_STAGES && (raised_from == 0 || !in_vain)) {
        r->mesh.raised_from[r->mesh.intervals] = error;
        add_interval(&r->mesh, end, (int)stages);
    } else {
        split(r, interval, excess);
    }
    for (int i = first; i < r->mesh.intervals; i++)
        r->mesh.past[i] = layout->mesh.past[k] == mesh_untouched ? mesh_untouched : mesh_settled;
}

// r->where of what the nodes of an interval do not tell, where the phase has much of it; *sum: in parts of its limit.
static moray_status find_unseen(struct refinement *r, double objective, double *sum)
{
    const struct phase_layout *layout = &r->e.solution->transcription->layout.phase[r->e.p];
    const int intervals = layout->mesh.intervals;
    struct unseen u;
    double *part = r->where + intervals;
    MORAY_TRY(moray_unseen_new(&u, &r->e));
    *sum = 0;
    for (int k = 0; k < intervals; k++) {
        // Jumps are left to the certificate: no mesh mends them.
        part[k] = moray_unseen_interval(&u, &layout->interval[k], objective, NULL, &r->where[k]) / MORAY_LIMIT_UNSEEN;
        *sum += part[k];
    }
    for (int k = 0; k < intervals; k++)
        if (*sum <= 1 || part[k] * intervals < *sum)
            r->where[k] = NAN;
    moray_unseen_free(&u);
    return moray_ok();
}

// Errors of the intervals, what the certificate will ask. What no node tells is looked for where these are small.
static moray_status measure(struct refinement *r, double objective, double *worst)
{
    const struct phase_layout *layout = &r->e.solution->transcription->layout.phase[r->e.p];
    double unseen = 0, largest = 0;
    for (int k = 0; k < layout->mesh.intervals; k++) {
        r->error[k] = moray_examiner_error(&r->e, &layout->interval[k]);
        r->where[k] = NAN;
        largest = fmax(largest, r->error[k]);
    }
    if (largest <= r->tolerance)
        MORAY_TRY(find_unseen(r, objective, &unseen));
    *worst = fmax(*worst, unseen > 1 ? fmax(largest, unseen * MORAY_LIMIT_UNSEEN) : largest);
    return moray_ok();
}

static moray_status make_mesh(struct refinement *r, struct mesh *mesh)
{
    const struct transcription *t = r->e.solution->transcription;
    const struct mesh *old = &t->layout.phase[r->e.p].mesh;
    MORAY_TRY(moray_mesh_new(&r->mesh, most_pieces * old->intervals));
    r->mesh.intervals = 0;
    r->mesh.method = old->method;
    r->mesh.t0 = t->phase[r->e.p].t0;
    r->mesh.tf = t->phase[r->e.p].tf;
    for (int k = 0; k < old->intervals; k++)
        refine_interval(r, k);
    *mesh = r->mesh;
    return moray_ok();
}

static moray_status refine_phase(const struct witness *w, int p, double tolerance, struct mesh *mesh, double *worst)
{
    struct refinement r = {.tolerance = tolerance, .spare = INFINITY};
    const size_t intervals = (size_t)w->solution->transcription->layout.phase[p].mesh.intervals;
    MORAY_TRY(moray_examiner_new(&r.e, w, p));
    r.error = calloc(3 * intervals, sizeof *r.error);
    r.where = r.error + intervals;
    moray_status status = r.error ? measure(&r, moray_witness_objective(w), worst)
                                  : moray_error(MORAY_MEMORY, "no memory to refine a mesh");
    if (mesh && !moray_failed(status))
        status = make_mesh(&r, mesh);
    free(r.error);
    moray_examiner_free(&r.e);
    return status;
}

moray_status moray_refine(const moray_solution *solution, double tolerance, struct mesh *meshes, double *worst)
{
    struct witness w;
    *worst = 0;
    MORAY_TRY(moray_witness_of_sizes(&w, solution));
    moray_status status = moray_ok();
    for (int p = 0; p < solution->transcription->ocp->phases && !moray_failed(status); p++)
        status = refine_phase(&w, p, tolerance, meshes ? &meshes[p] : NULL, worst);
    moray_witness_free(&w);
    return status;
}
