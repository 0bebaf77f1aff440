// SPDX-License-Identifier: MIT
//
// Optimality conditions at random points with random multipliers, by the gradients and Jacobians of the programme, of
// two phases that have all that a programme may.
#include "everything.h"

#include <string.h>

#include "ocp/certificate/optimality.h"

enum { MOST = 600, ENTRIES = 8000 };
static const double give = 2e-8;

// ---- What is expected ----

struct sizes {
    double column[MOST], row[MOST], gradient[MOST], g[MOST];
};

static void fill(const moray_solution *solution, const struct witness *w, struct sizes *z)
{
    static double jac[ENTRIES];
    const moray_nlp *nlp = &solution->transcription->nlp;
    const moray_iterate *at = &solution->iterate;
    CHECK(nlp->n < MOST && nlp->m < MOST && nlp->nnz_jac < ENTRIES, "%d columns, %d rows", nlp->n, nlp->m);
    moray_witness_columns(w, z->column);
    moray_witness_rows(w, z->row);
    nlp->constraints(nlp->self, at->x, true, z->g);
    nlp->gradient(nlp->self, at->x, false, z->gradient);
    nlp->jacobian(nlp->self, at->x, false, jac);
    for (int k = 0; k < nlp->nnz_jac; k++)
        z->gradient[nlp->jac_col[k]] += at->lambda[nlp->jac_row[k]] * jac[k];
    for (int j = 0; j < nlp->n; j++)
        z->gradient[j] += at->z_upper[j] - at->z_lower[j];
}

static void add_side(double multiplier, double slack, double bound, double size, double *gain, double *gap)
{
    if (fabs(bound) < MORAY_INFINITY && multiplier >= 0)
        *gap += slack > 0 ? multiplier * slack : 0;
    else
        *gain += fabs(multiplier) * size;
}

static double beyond(double value, double low, double high)
{
    const double allowed_low = low < high && low > -MORAY_INFINITY ? low - give * fabs(low) : low;
    const double allowed_high = low < high && high < MORAY_INFINITY ? high + give * fabs(high) : high;
    return value < allowed_low ? allowed_low - value : value > allowed_high ? value - allowed_high : 0;
}

static struct optimality expect(const moray_solution *solution, const struct sizes *z, double objective)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    const moray_iterate *at = &solution->iterate;
    struct optimality o = {.column = -1, .row = -1};
    double largest = 0;
    for (int j = 0; j < nlp->n; j++) {
        const double low = nlp->x_lower[j], high = nlp->x_upper[j];
        double gain = low < high ? fabs(z->gradient[j]) * z->column[j] : 0;
        if (low < high) {
            add_side(at->z_lower[j], at->x[j] - low, low, z->column[j], &gain, &o.gap);
            add_side(at->z_upper[j], high - at->x[j], high, z->column[j], &gain, &o.gap);
        }
        o.improvement += gain;
        if (gain > largest)
            largest = gain, o.column = j;
        const double far = beyond(at->x[j], low, high) / z->column[j];
        if (far > o.feasibility)
            o.feasibility = far, o.row = nlp->m + j;
    }
    for (int i = 0; i < nlp->m; i++) {
        const double low = nlp->g_lower[i], high = nlp->g_upper[i], lambda = at->lambda[i];
        if (low == high)
            o.improvement += fabs(lambda * (z->g[i] - low));
        else
            add_side(fabs(lambda), lambda > 0 ? high - z->g[i] : z->g[i] - low, lambda > 0 ? high : low, z->row[i],
                     &o.improvement, &o.gap);
        const double far = beyond(z->g[i], low, high) / z->row[i];
        if (far > o.feasibility)
            o.feasibility = far, o.row = i;
    }
    o.improvement /= objective, o.gap /= objective;
    return o;
}

// What is told of the objective, or of what data see, whichever is further off.
static double expect_told(const moray_solution *solution, const struct witness *w)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[1];
    double told = fabs(solution->iterate.objective - t->end_out[0]) / moray_witness_objective(w);
    for (int k = 0; k < DATA; k++) {
        double x[NX1 + NU1];
        moray_solution_at(solution, 1, t->ocp->phase[1].observed.time[k], x, x + NX1);
        for (int r = 0; r < NX1 + NU1; r++)
            told = tap_worse(told, fabs(solution->iterate.x[layout->sight[k].x + r] - x[r]) / w->phase[1].size[r]);
    }
    return told;
}

static void check(moray_solution *solution)
{
    static struct sizes z;
    struct witness w;
    struct optimality found;
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    fill(solution, &w, &z);
    const struct optimality o = expect(solution, &z, moray_witness_objective(&w));
    const double told = expect_told(solution, &w);
    CHECK_OK(moray_measure_optimality(&w, &found), "optimality");
    CHECK(fabs(found.improvement / o.improvement - 1) < 1e-7, "the gain is %.10g, expected %.10g", found.improvement,
          o.improvement);
    CHECK(found.column == o.column, "most by column %d, expected %d", found.column, o.column);
    CHECK(fabs(found.gap / o.gap - 1) < 1e-12, "slacks hold %.10g, expected %.10g", found.gap, o.gap);
    CHECK(fabs(found.feasibility / o.feasibility - 1) < 1e-12 && found.row == o.row,
          "violated by %.10g in row %d, expected %.10g in %d", found.feasibility, found.row, o.feasibility, o.row);
    CHECK(fabs(found.told / told - 1) < 1e-10, "what is told is off by %.10g, expected %.10g", found.told, told);
    double *spoilt = &solution->iterate.lambda[solution->transcription->layout.phase[0].node[1].path];
    *spoilt = NAN;
    CHECK_OK(moray_measure_optimality(&w, &found), "without a number");
    CHECK(isinf(found.improvement), "no gain is as bad as none that is known: %g", found.improvement);
    *spoilt = 0;
    moray_witness_free(&w);
}

// ---- Sizes of columns and rows, each that of what it is ----

static void add(double **to, const double *size, int n)
{
    for (int i = 0; i < n; i++)
        *(*to)++ = size[i];
}

// Of what the endpoint depends on, in its order.
static void check_end_sizes(const moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    struct witness w;
    double sizes[MOST], *to = sizes;
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    for (int p = 0; p < 2; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const double *size = w.phase[p].size;
        for (int end = 0; end < 2; end++) {
            add(&to, size, phase->nx);
            add(&to, &w.duration, 1);
        }
        add(&to, w.phase[p].integral, phase->nq);
        for (int end = 0; end < 2 && p == 0; end++)
            add(&to, size + NX0, NU0);
    }
    add(&to, w.phase[0].size + NX0 + NU0, NS);
    for (int k = 0; k < DATA; k++)
        add(&to, w.phase[1].size, NX1 + NU1);
    CHECK(to - sizes == t->endpoint->n_in, "%d inputs, expected %d", t->endpoint->n_in, (int)(to - sizes));
    for (int j = 0; j < t->endpoint->n_in; j++)
        CHECK(w.end_size[j] == sizes[j], "input %d of the ends has the size %g, not %g", j, w.end_size[j], sizes[j]);
    moray_witness_free(&w);
}

static void check_sizes(moray_solution *solution)
{
    static double column[MOST], row[MOST], columns[MOST], rows[MOST];
    const struct transcription *t = solution->transcription;
    struct witness w;
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    w.phase[0].size[NX0] = 0, w.phase[1].out_size[NX1] = 0; // which count as 1
    for (int i = 0; i < MOST; i++)
        columns[i] = rows[i] = 1;
    for (int p = 0; p < 2; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const struct phase_layout *layout = &t->layout.phase[p];
        const double *size = w.phase[p].size, *u = size + phase->nx;
        for (int n = 0; n < layout->nodes; n++) {
            const struct node *node = &layout->node[n];
            for (int r = 0; r < phase->nx + (node->collocated ? phase->nu : 0); r++)
                columns[node->x + r] = size[r];
            for (int r = 0; r < phase->nc && node->collocated; r++)
                rows[node->path + r] = w.phase[p].out_size[phase->nx + r];
            if (n > 0)
                for (int r = 0; r < phase->nx; r++)
                    rows[layout->interval[0].defect + (n - 1) * phase->nx + r] = size[r];
            if (p == 1 && node->before != absent)
                rows[node->hold] = u[0];
        }
        for (int m = 0; m < phase->nq; m++)
            columns[layout->q + m] = rows[layout->integral_row + m] = w.phase[p].integral[m];
        for (int end = 0; end < 2; end++)
            for (int r = 0; r < phase->nu && layout->u_row[end] != absent; r++)
                columns[layout->u_end[end] + r] = rows[layout->u_row[end] + r] = u[r];
        for (int k = 0; layout->sight && k < DATA; k++)
            for (int r = 0; r < phase->nx + phase->nu; r++)
                columns[layout->sight[k].x + r] = rows[layout->sight[k].row + r] = size[r];
        if (layout->t0 != absent)
            columns[layout->t0] = w.duration;
        columns[layout->tf] = w.duration;
        if (layout->length_row != absent)
            rows[layout->length_row] = w.duration;
    }
    for (int k = 0; k < NS; k++)
        columns[t->layout.s + k] = w.end_size[t->endpoint->n_in - DATA * (NX1 + NU1) - NS + k];
    for (int k = 0; k < t->endpoint->n_out - 1; k++)
        rows[t->layout.events + k] = w.end_out_size[1 + k];
    memset(column, 0, sizeof column), memset(row, 0, sizeof row);
    moray_witness_columns(&w, column);
    moray_witness_rows(&w, row);
    for (int j = 0; j < t->nlp.n; j++)
        CHECK(column[j] == (columns[j] > 0 ? columns[j] : 1), "column %d has the size %g, not %g", j, column[j],
              columns[j]);
    for (int i = 0; i < t->nlp.m; i++)
        CHECK(row[i] == (rows[i] > 0 ? rows[i] : 1), "row %d has the size %g, not %g", i, row[i], rows[i]);
    CHECK(column[t->nlp.n] == 0 && row[t->nlp.m] == 0, "and none behind");
    moray_witness_free(&w);
}

int main(void)
{
    static const char *const schemes[] = {"radau3", "gauss2", "radau2", "gauss3"};
    unsigned long long seed = 41;
    for (int k = 0; k < 4; k++) {
        moray_ocp *ocp = NULL;
        moray_solution *solution = begin(&ocp, schemes[k]);
        for (int trial = 0; trial < 12; trial++) {
            scatter(solution, &seed);
            check(solution);
        }
        check_sizes(solution);
        check_end_sizes(solution);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    return tap_done();
}
