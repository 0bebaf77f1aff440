// SPDX-License-Identifier: MIT
//
// Constraints, their Jacobian and the Hessian of the Lagrangian from what the maps gave at the nodes. With T = tf - t0,
// interval width w and t = t0 + T tau:
//   defect   sum_j P_ij x_j - T w sum_j Q_ij f_j
//   integral q - T sum_n weight_n g_n
//   length   T
//   end      u0 - sum_j ell_j(0) u_j over the first interval, or the same of uf, where no node has the control
#include <string.h>

#include "ocp/hold.h"
#include "ocp/observe/sight.h"

static double duration(const struct transcription *t, int p)
{
    return t->phase[p].tf - t->phase[p].t0;
}

// ---- Constraints ----

// Row block i of an interval: P and Q are the scheme's (I and its integration matrix for collocation at all points), so
// that one loop serves Lobatto, Radau and Gauss; entries that are zero for a scheme cost nothing.
static void interval_defects(const struct transcription *t, int p, const struct interval *interval, double *g)
{
    const int nx = t->ocp->phase[p].nx, n_out = t->phase[p].map->n_out, points = interval->scheme->points;
    const struct node *node = t->layout.phase[p].node + interval->first;
    const double *out = t->phase[p].out + interval->first * n_out, h = duration(t, p) * interval->width;
    for (int i = 0; i < points - 1; i++) {
        double *defect = g + interval->defect + i * nx;
        memset(defect, 0, (size_t)nx * sizeof *defect);
        for (int j = 0; j < points; j++) {
            const double P = interval->scheme->P[i * points + j], hQ = h * interval->scheme->Q[i * points + j];
            for (int r = 0; r < nx && P != 0; r++)
                defect[r] += P * t->x[node[j].x + r];
            for (int r = 0; r < nx && hQ != 0; r++)
                defect[r] -= hQ * out[j * n_out + r];
        }
    }
}

// Path constraints stand where the dynamics are collocated, once a node; the integrals use the weights of the same
// nodes.
static void path_and_integrals(const struct transcription *t, int p, double *g)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = phase->nx, nc = phase->nc, nq = phase->nq, n_out = t->phase[p].map->n_out;
    memcpy(g + layout->integral_row, t->x + layout->q, (size_t)nq * sizeof *g);
    for (int n = 0; n < layout->nodes; n++) {
        const double *out = t->phase[p].out + n * n_out;
        if (!layout->node[n].collocated)
            continue;
        memcpy(g + layout->node[n].path, out + nx, (size_t)nc * sizeof *g);
        for (int m = 0; m < nq; m++)
            g[layout->integral_row + m] -= duration(t, p) * layout->node[n].weight * out[nx + nc + m];
    }
}

static void end_controls(const struct transcription *t, int p, int end, double *g)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = t->ocp->phase[p].nx, nu = t->ocp->phase[p].nu;
    double ell[MORAY_MAX_STAGES + 2], *row = g + layout->u_row[end];
    const struct interval *interval = moray_layout_end(layout, end, ell);
    const struct node *node = layout->node + interval->first;
    memcpy(row, t->x + layout->u_end[end], (size_t)nu * sizeof *row);
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++)
        for (int r = 0; r < nu; r++)
            row[r] -= ell[j] * t->x[node[j].x + nx + r];
}

void moray_assemble_constraints(const struct transcription *t, double *g)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        for (int k = 0; k < t->layout.phase[p].mesh.intervals; k++)
            interval_defects(t, p, &t->layout.phase[p].interval[k], g);
        path_and_integrals(t, p, g);
        for (int end = 0; end < 2; end++)
            if (t->layout.phase[p].u_row[end] != absent)
                end_controls(t, p, end, g);
        moray_assemble_holds(t, p, g);
        moray_assemble_sights(t, p, g);
        if (t->layout.phase[p].length_row != absent)
            g[t->layout.phase[p].length_row] = duration(t, p);
    }
    memcpy(g + t->layout.events, t->end_out + 1, (size_t)(t->endpoint->n_out - 1) * sizeof *g);
}

// ---- Jacobian ----

void moray_put_input(const struct transcription *t, int p, const struct node *node, const int *column, int row, int in,
                     double value, triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    if (in < t->phase[p].map->n_in - 1) {
        triplets_put(out, row, column[in], value);
        return;
    }
    if (layout->t0 != absent)
        triplets_put(out, row, layout->t0, value * (1 - node->tau));
    if (layout->tf != absent)
        triplets_put(out, row, layout->tf, value * node->tau);
}

// d(T factor)/d(t0, tf)
static void put_duration(const struct transcription *t, int p, int row, double factor, triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    if (layout->t0 != absent)
        triplets_put(out, row, layout->t0, -factor);
    if (layout->tf != absent)
        triplets_put(out, row, layout->tf, factor);
}

// Row block i of the defects, as far as it depends on f at node n: - T wQ f
static void put_dynamics(const struct transcription *t, int p, int n, int first_row, double wQ, triplets *out)
{
    const moray_map *map = t->phase[p].map;
    const struct node *node = &t->layout.phase[p].node[n];
    const double *jac = t->phase[p].jac + n * map->jac.nnz, *value = t->phase[p].out + n * map->n_out;
    const int nx = t->ocp->phase[p].nx, *column = moray_node_columns(t, p, node);
    const double hQ = duration(t, p) * wQ;
    for (int k = 0; k < map->jac.nnz; k++)
        if (map->jac.row[k] < nx)
            moray_put_input(t, p, node, column, first_row + map->jac.row[k], map->jac.col[k], -hQ * jac[k], out);
    for (int r = 0; r < nx; r++)
        put_duration(t, p, first_row + r, -wQ * value[r], out);
}

static void put_interval(const struct transcription *t, int p, const struct interval *interval, triplets *out)
{
    const int nx = t->ocp->phase[p].nx, points = interval->scheme->points;
    const struct node *node = t->layout.phase[p].node + interval->first;
    for (int i = 0; i < points - 1; i++) {
        const int row = interval->defect + i * nx;
        for (int j = 0; j < points; j++) {
            const double P = interval->scheme->P[i * points + j], Q = interval->scheme->Q[i * points + j];
            for (int r = 0; r < nx && P != 0; r++)
                triplets_put(out, row + r, node[j].x + r, P);
            if (Q != 0)
                put_dynamics(t, p, interval->first + j, row, interval->width * Q, out);
        }
    }
}

// Of one collocated node: c into its own rows, - T weight g into the rows of the integrals, and what T does to those.
static void put_path_and_integrals(const struct transcription *t, int p, int n, triplets *out)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const struct node *node = &layout->node[n];
    const moray_map *map = t->phase[p].map;
    const double *jac = t->phase[p].jac + n * map->jac.nnz, *value = t->phase[p].out + n * map->n_out;
    const int *column = moray_node_columns(t, p, node), before_g = phase->nx + phase->nc;
    for (int k = 0; k < map->jac.nnz; k++) {
        const int row = map->jac.row[k];
        if (row >= before_g)
            moray_put_input(t, p, node, column, layout->integral_row + row - before_g, map->jac.col[k],
                            -duration(t, p) * node->weight * jac[k], out);
        else if (row >= phase->nx)
            moray_put_input(t, p, node, column, node->path + row - phase->nx, map->jac.col[k], jac[k], out);
    }
    for (int m = 0; m < phase->nq; m++)
        put_duration(t, p, layout->integral_row + m, -node->weight * value[before_g + m], out);
}

static void put_end_controls(const struct transcription *t, int p, int end, triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = t->ocp->phase[p].nx;
    double ell[MORAY_MAX_STAGES + 2];
    const struct interval *interval = moray_layout_end(layout, end, ell);
    const struct node *node = layout->node + interval->first;
    for (int r = 0; r < t->ocp->phase[p].nu; r++) {
        triplets_put(out, layout->u_row[end] + r, layout->u_end[end] + r, 1);
        for (int j = interval->scheme->first; j <= interval->scheme->last; j++)
            triplets_put(out, layout->u_row[end] + r, node[j].x + nx + r, -ell[j]);
    }
}

// One walk for pattern and values: recording, it notes where entries go, and ever after writes values in that order.
void moray_walk_jacobian(const struct transcription *t, triplets *out)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int k = 0; k < layout->mesh.intervals; k++)
            put_interval(t, p, &layout->interval[k], out);
        for (int n = 0; n < layout->nodes; n++)
            if (layout->node[n].collocated)
                put_path_and_integrals(t, p, n, out);
        for (int m = 0; m < t->ocp->phase[p].nq; m++)
            triplets_put(out, layout->integral_row + m, layout->q + m, 1);
        for (int end = 0; end < 2; end++)
            if (layout->u_row[end] != absent)
                put_end_controls(t, p, end, out);
        moray_walk_holds(t, p, out);
        moray_walk_sights(t, p, out);
        if (layout->length_row != absent)
            put_duration(t, p, layout->length_row, 1, out);
    }
    const moray_pattern *jac = &t->endpoint->jac;
    for (int k = 0; k < jac->nnz; k++)
        if (jac->row[k] > 0 && t->end_column[jac->col[k]] >= 0)
            triplets_put(out, t->layout.events + jac->row[k] - 1, t->end_column[jac->col[k]], t->end_jac[k]);
}

// ---- Hessian ----

// What multiplies f at a node in the Lagrangian: - T w sum_i Q_ij lambda_i over the defects of all intervals it serves,
// so that each node needs a single Hessian of its weighted sum.
void moray_dynamics_multipliers(const struct transcription *t, int p, const double *lambda, double *lambda_f)
{
    const int nx = t->ocp->phase[p].nx;
    const struct phase_layout *layout = &t->layout.phase[p];
    memset(lambda_f, 0, (size_t)(layout->nodes * nx) * sizeof *lambda_f);
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const struct interval *interval = &layout->interval[k];
        const int points = interval->scheme->points;
        for (int i = 0; i < points - 1; i++)
            for (int j = 0; j < points; j++) {
                const double hQ = duration(t, p) * interval->width * interval->scheme->Q[i * points + j];
                for (int r = 0; r < nx && hQ != 0; r++)
                    lambda_f[(interval->first + j) * nx + r] -= hQ * lambda[interval->defect + i * nx + r];
            }
    }
    moray_add_sights_to_dynamics(t, p, lambda, lambda_f);
}

// Second derivatives of weight * out through x, u, s and t.
static void put_curvature(const struct transcription *t, int p, const struct node *node, const int *column,
                          triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const moray_pattern *hess = &t->phase[p].map->hess;
    const int time = t->phase[p].map->n_in - 1, t0 = layout->t0, tf = layout->tf;
    const double before = 1 - node->tau, after = node->tau;
    for (int k = 0; k < hess->nnz; k++) {
        const int row = hess->row[k], col = hess->col[k];
        const double value = t->map_hess[k];
        if (row < time) {
            triplets_put_lower(out, column[row], column[col], value);
            continue;
        }
        if (t0 != absent)
            triplets_put_lower(out, t0, col < time ? column[col] : t0, value * before * (col < time ? 1 : before));
        if (tf != absent)
            triplets_put_lower(out, tf, col < time ? column[col] : tf, value * after * (col < time ? 1 : after));
        if (t0 != absent && tf != absent && col == time)
            triplets_put_lower(out, tf, t0, value * before * after);
    }
}

// The product of T with F = weight * (f, g) adds dF d(tf - t0) + d(tf - t0) dF; `weight` holds T times those of F.
// Where data move, the times do more to the multipliers of f than T does.
static void put_duration_products(const struct transcription *t, int p, int n, const int *column, triplets *out)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const moray_pattern *jac = &t->phase[p].map->jac;
    const double *values = t->phase[p].jac + n * jac->nnz, tau = layout->node[n].tau, T = duration(t, p);
    const int time = t->phase[p].map->n_in - 1, t0 = layout->t0, tf = layout->tf;
    for (int k = 0; k < jac->nnz; k++) {
        if (jac->row[k] >= phase->nx && jac->row[k] < phase->nx + phase->nc)
            continue;
        const double slope = t->weight[jac->row[k]] / T * values[k];
        double by_t0 = -slope, by_tf = slope;
        if (t->phase[p].by_time && jac->row[k] < phase->nx) {
            const double *by_time = t->phase[p].by_time + 2 * n * phase->nx + jac->row[k];
            by_t0 += by_time[0] * values[k], by_tf += by_time[phase->nx] * values[k];
        }
        const bool of_time = jac->col[k] == time;
        const int other = of_time ? -1 : column[jac->col[k]];
        if (t0 != absent)
            triplets_put_lower(out, t0, of_time ? t0 : other, by_t0 * (of_time ? 2 * (1 - tau) : 1));
        if (tf != absent)
            triplets_put_lower(out, tf, of_time ? tf : other, by_tf * (of_time ? 2 * tau : 1));
        if (of_time && t0 != absent && tf != absent)
            triplets_put_lower(out, tf, t0, by_t0 * tau + by_tf * (1 - tau));
    }
}

// Curvature of the weighted (f, c, g) at a node; T times f and g is a product, whose mixed terms come only with free
// times.
static void put_node_hessian(const struct transcription *t, int p, int n, const double *lambda, triplets *out)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const struct node *node = &layout->node[n];
    const moray_map *map = t->phase[p].map;
    const int nx = phase->nx, nc = phase->nc, *column = moray_node_columns(t, p, node);
    memcpy(t->weight, t->phase[p].lambda + n * nx, (size_t)nx * sizeof *t->weight);
    memcpy(t->weight + nx, lambda + node->path, (size_t)nc * sizeof *t->weight);
    for (int m = 0; m < phase->nq; m++)
        t->weight[nx + nc + m] = -duration(t, p) * node->weight * lambda[layout->integral_row + m];
    if (!out->recording)
        map->hessian(map->self, t->phase[p].in + n * map->n_in, t->weight, t->map_hess);
    put_curvature(t, p, node, column, out);
    if (layout->t0 != absent || layout->tf != absent)
        put_duration_products(t, p, n, column, out);
}

static void put_endpoint_hessian(const struct transcription *t, double sigma, const double *lambda, triplets *out)
{
    const moray_map *map = t->endpoint;
    t->weight[0] = sigma;
    memcpy(t->weight + 1, lambda + t->layout.events, (size_t)(map->n_out - 1) * sizeof *t->weight);
    if (!out->recording)
        map->hessian(map->self, t->end_in, t->weight, t->map_hess);
    for (int k = 0; k < map->hess.nnz; k++) {
        const int row = t->end_column[map->hess.row[k]], col = t->end_column[map->hess.col[k]];
        if (row >= 0 && col >= 0)
            triplets_put_lower(out, row, col, t->map_hess[k]);
    }
}

void moray_walk_hessian(const struct transcription *t, double sigma, const double *lambda, triplets *out)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        moray_dynamics_multipliers(t, p, lambda, t->phase[p].lambda);
        if (t->phase[p].by_time)
            moray_sights_by_time(t, p, lambda, t->phase[p].by_time);
        for (int n = 0; n < t->layout.phase[p].nodes; n++)
            if (t->layout.phase[p].node[n].collocated)
                put_node_hessian(t, p, n, lambda, out);
        moray_bend_sights(t, p, lambda, out);
    }
    put_endpoint_hessian(t, sigma, lambda, out);
}
