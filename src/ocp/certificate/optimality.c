// SPDX-License-Identifier: MIT
//
// The gradient of the Lagrangian from dense differences: for a node with weights w of [f, c, g] it is A' w, through
// t = t0 + T tau and the factor T of f and g also into the free times.
#include "ocp/certificate/optimality.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/hold.h"
#include "ocp/observe/sight.h"

static const double give = 2e-8; // of a bound, relative: twice the solver's

struct measure {
    const struct witness *e;
    const struct transcription *t;
    double *gradient, *column, *row, *g; // [columns], sizes of columns and rows, constraints
    double *weight, *in_use, *lambda_f;  // scratch
};

// Entry j of A' weight, of the block at hand (p: NULL for the endpoint), the derivatives in use where differences say
// nothing.
static double weighted(const struct measure *m, const struct phase_witness *p, int j)
{
    const struct kept *at = p ? &p->kept : &m->e->end;
    const double *size = p ? p->size : m->e->end_size, *out_size = p ? p->out_size : m->e->end_out_size;
    double sum = 0;
    for (int i = 0; i < at->map->n_out; i++) {
        const int k = j * at->map->n_out + i;
        const bool speaks = moray_witness_speaks(at->doubt[k], at->kink[k], size[j], out_size[i]);
        sum += m->weight[i] * (speaks ? at->jac[k] : m->in_use[k]);
    }
    return sum;
}

static void add_time(struct measure *m, const struct phase_layout *layout, double to_t0, double to_tf)
{
    if (layout->t0 != absent)
        m->gradient[layout->t0] += to_t0;
    if (layout->tf != absent)
        m->gradient[layout->tf] += to_tf;
}

static void add_node(struct measure *m, int p, int n)
{
    const struct transcription *t = m->t;
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const struct phase_cache *cache = &t->phase[p];
    const struct node *node = &layout->node[n];
    const int nx = phase->nx, nc = phase->nc, n_in = cache->map->n_in, n_out = cache->map->n_out;
    const double *lambda = m->e->solution->iterate.lambda, T = cache->tf - cache->t0;
    double by_duration = 0;
    memcpy(m->weight, m->lambda_f + n * nx, (size_t)nx * sizeof *m->weight);
    memcpy(m->weight + nx, lambda + node->path, (size_t)nc * sizeof *m->weight);
    for (int k = 0; k < phase->nq; k++)
        m->weight[nx + nc + k] = -T * node->weight * lambda[layout->integral_row + k];
    for (int i = 0; i < n_out; i++)
        if (i < nx || i >= nx + nc)
            by_duration += m->weight[i] / T * cache->out[n * n_out + i];
    const struct phase_witness *witness = &m->e->phase[p];
    const int *column = moray_node_columns(t, p, node);
    moray_witness_at(m->e, p, n);
    moray_witness_in_use(m->e, p, n, m->in_use);
    for (int j = 0; j < n_in - 1; j++)
        m->gradient[column[j]] += weighted(m, witness, j);
    const double by_time = weighted(m, witness, n_in - 1);
    add_time(m, layout, by_time * (1 - node->tau) - by_duration, by_time * node->tau + by_duration);
}

static void add_end_controls(struct measure *m, int p, int end)
{
    const struct phase_layout *layout = &m->t->layout.phase[p];
    const int nx = m->t->ocp->phase[p].nx;
    const double *lambda = m->e->solution->iterate.lambda + layout->u_row[end];
    double ell[MORAY_MAX_STAGES + 2];
    const struct interval *interval = moray_layout_end(layout, end, ell);
    for (int r = 0; r < m->t->ocp->phase[p].nu; r++) {
        m->gradient[layout->u_end[end] + r] += lambda[r];
        for (int j = interval->scheme->first; j <= interval->scheme->last; j++)
            m->gradient[layout->node[interval->first + j].x + nx + r] -= ell[j] * lambda[r];
    }
}

// What stands in the defects and the definitions of integrals beside the functions.
static void add_linear(struct measure *m, int p)
{
    const struct phase_layout *layout = &m->t->layout.phase[p];
    const int nx = m->t->ocp->phase[p].nx;
    const double *lambda = m->e->solution->iterate.lambda;
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const struct interval *interval = &layout->interval[k];
        const int points = interval->scheme->points;
        for (int i = 0; i < points - 1; i++)
            for (int j = 0; j < points; j++)
                for (int r = 0; r < nx; r++)
                    m->gradient[layout->node[interval->first + j].x + r] +=
                        interval->scheme->P[i * points + j] * lambda[interval->defect + i * nx + r];
    }
    for (int q = 0; q < m->t->ocp->phase[p].nq; q++)
        m->gradient[layout->q + q] += lambda[layout->integral_row + q];
    for (int end = 0; end < 2; end++)
        if (layout->u_row[end] != absent)
            add_end_controls(m, p, end);
    moray_add_holds(m->t, p, lambda, m->gradient);
    moray_add_sights(m->t, p, lambda, m->gradient);
    if (layout->length_row != absent)
        add_time(m, layout, -lambda[layout->length_row], lambda[layout->length_row]);
}

static void add_endpoint(struct measure *m)
{
    const moray_map *map = m->t->endpoint;
    m->weight[0] = 1;
    memcpy(m->weight + 1, m->e->solution->iterate.lambda + m->t->layout.events,
           (size_t)(map->n_out - 1) * sizeof *m->weight);
    moray_witness_at(m->e, -1, 0);
    moray_witness_in_use(m->e, -1, 0, m->in_use);
    for (int j = 0; j < map->n_in; j++)
        if (m->t->end_column[j] >= 0)
            m->gradient[m->t->end_column[j]] += weighted(m, NULL, j);
}

static void fill_gradient(struct measure *m)
{
    const moray_iterate *at = &m->e->solution->iterate;
    for (int j = 0; j < m->t->nlp.n; j++)
        m->gradient[j] = at->z_upper[j] - at->z_lower[j];
    for (int p = 0; p < m->t->ocp->phases; p++) {
        moray_dynamics_multipliers(m->t, p, at->lambda, m->lambda_f);
        for (int n = 0; n < m->t->layout.phase[p].nodes; n++)
            if (m->t->layout.phase[p].node[n].collocated)
                add_node(m, p, n);
        add_linear(m, p);
    }
    add_endpoint(m);
}

// What a multiplier of one side makes of a slack goes to the gap; of a side without bound, or with the wrong sign, what
// it makes of a move by the whole size is returned.
static double slackness(double multiplier, double slack, bool bounded, double size, struct optimality *o)
{
    if (!bounded || multiplier < 0)
        return fabs(multiplier) * size;
    o->gap += multiplier * fmax(slack, 0);
    return 0;
}

static double column_gain(const struct measure *m, int j, struct optimality *o)
{
    const moray_nlp *nlp = &m->t->nlp;
    const moray_iterate *at = &m->e->solution->iterate;
    const double low = nlp->x_lower[j], high = nlp->x_upper[j];
    if (low == high)
        return 0;
    return fabs(m->gradient[j]) * m->column[j] +
           slackness(at->z_lower[j], at->x[j] - low, low > -MORAY_INFINITY, m->column[j], o) +
           slackness(at->z_upper[j], high - at->x[j], high < MORAY_INFINITY, m->column[j], o);
}

static double row_gain(const struct measure *m, int i, struct optimality *o)
{
    const moray_nlp *nlp = &m->t->nlp;
    const double lambda = m->e->solution->iterate.lambda[i];
    if (nlp->g_lower[i] == nlp->g_upper[i])
        return fabs(lambda * (m->g[i] - nlp->g_lower[i]));
    const bool upper = lambda > 0;
    const bool bounded = upper ? nlp->g_upper[i] < MORAY_INFINITY : nlp->g_lower[i] > -MORAY_INFINITY;
    const double slack = upper ? nlp->g_upper[i] - m->g[i] : m->g[i] - nlp->g_lower[i];
    return slackness(fabs(lambda), slack, bounded, m->row[i], o);
}

// Beyond what solvers let a bound give way by.
static double outside(double value, double lower, double upper)
{
    const double low = lower > -MORAY_INFINITY && lower < upper ? give * fabs(lower) : 0;
    const double high = upper < MORAY_INFINITY && lower < upper ? give * fabs(upper) : 0;
    return isnan(value) ? INFINITY : fmax(fmax(lower - low - value, value - upper - high), 0);
}

static void judge(const struct measure *m, struct optimality *o)
{
    const moray_nlp *nlp = &m->t->nlp;
    const double *x = m->e->solution->iterate.x;
    double worst = 0;
    for (int j = 0; j < nlp->n; j++) {
        const double gain = column_gain(m, j, o);
        const double far = outside(x[j], nlp->x_lower[j], nlp->x_upper[j]) / m->column[j];
        o->improvement += gain;
        if (!(gain <= worst))
            worst = gain, o->column = j;
        if (far > o->feasibility)
            o->feasibility = far, o->row = nlp->m + j;
    }
    for (int i = 0; i < nlp->m; i++) {
        const double far = outside(m->g[i], nlp->g_lower[i], nlp->g_upper[i]) / m->row[i];
        o->improvement += row_gain(m, i, o);
        if (far > o->feasibility)
            o->feasibility = far, o->row = i;
    }
    o->improvement /= moray_witness_objective(m->e);
    o->gap /= moray_witness_objective(m->e);
    o->improvement = isnan(o->improvement) ? INFINITY : o->improvement;
    o->told = fabs(m->e->solution->iterate.objective - m->t->end_out[0]) / moray_witness_objective(m->e);
}

// What moving data see, against the trajectory. work[nx + nu].
static double sight_error(const struct measure *m, double *work)
{
    const struct transcription *t = m->t;
    double worst = 0;
    for (int p = 0; p < t->ocp->phases; p++)
        for (int k = 0; t->layout.phase[p].sight && k < t->ocp->phase[p].observed.n; k++) {
            moray_solution_at(m->e->solution, p, t->ocp->phase[p].observed.time[k], work, work + t->ocp->phase[p].nx);
            worst = fmax(worst, moray_sight_error(t, p, k, work, work + t->ocp->phase[p].nx, m->e->phase[p].size));
        }
    return worst;
}

static moray_status allocate(struct measure *m)
{
    const struct transcription *t = m->t;
    size_t out = (size_t)t->endpoint->n_out, block = out * (size_t)t->endpoint->n_in, f = 0;
    for (int p = 0; p < t->ocp->phases; p++) {
        const size_t n_out = (size_t)t->phase[p].map->n_out, entries = n_out * (size_t)t->phase[p].map->n_in;
        const size_t states = (size_t)(t->layout.phase[p].nodes * t->ocp->phase[p].nx);
        const size_t n_in = (size_t)t->phase[p].map->n_in;
        out = n_out > out ? n_out : out;
        out = n_in > out ? n_in : out;
        block = entries > block ? entries : block;
        f = states > f ? states : f;
    }
    const size_t columns = (size_t)t->layout.columns, rows = (size_t)t->layout.rows;
    m->gradient = calloc(2 * columns + 2 * rows + out + block + f, sizeof *m->gradient);
    if (!m->gradient)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    m->column = m->gradient + columns;
    m->row = m->column + columns;
    m->g = m->row + rows;
    m->weight = m->g + rows;
    m->in_use = m->weight + out;
    m->lambda_f = m->in_use + block;
    return moray_ok();
}

moray_status moray_measure_optimality(const struct witness *e, struct optimality *optimality)
{
    struct measure m = {.e = e, .t = e->solution->transcription};
    *optimality = (struct optimality){.column = -1, .row = -1};
    MORAY_TRY(allocate(&m));
    moray_witness_columns(e, m.column);
    moray_witness_rows(e, m.row);
    moray_assemble_constraints(m.t, m.g);
    fill_gradient(&m);
    judge(&m, optimality);
    optimality->told = fmax(optimality->told, sight_error(&m, m.weight));
    free(m.gradient);
    return moray_ok();
}
