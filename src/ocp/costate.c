// SPDX-License-Identifier: MIT
//
// Costates and Hamiltonian from the multipliers of the programme.
#include <math.h>
#include <string.h>

#include "ocp/hold.h"
#include "ocp/solution.h"

// Where f is collocated its coefficient in the Lagrangian is T weight times the costate. At other points the costate is
// what a push of the state there costs: -+ the defects' multipliers times their coefficients of that state.
static void costate_from_ends(const moray_solution *solution, int p, int n, double *costate)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = t->ocp->phase[p].nx;
    memset(costate, 0, (size_t)nx * sizeof *costate);
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const struct interval *interval = &layout->interval[k];
        const int points = interval->scheme->points;
        const bool last = n == layout->nodes - 1 && k == layout->mesh.intervals - 1;
        if (interval->first != n && !last)
            continue;
        for (int i = 0; i < points - 1; i++)
            for (int r = 0; r < nx; r++)
                costate[r] += (last ? -1 : 1) * solution->iterate.lambda[interval->defect + i * nx + r] *
                              interval->scheme->P[i * points + (last ? points - 1 : 0)];
    }
}

// lambda_f = T weight costate at a collocated node: the discrete adjoint is the costate's collocation by the adjoint
// scheme.
int moray_solution_nodes(const moray_solution *solution, int p, double *time, double *costate)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = t->ocp->phase[p].nx;
    const double T = t->phase[p].tf - t->phase[p].t0;
    if (costate)
        moray_dynamics_multipliers(t, p, solution->iterate.lambda, costate);
    for (int n = 0; n < layout->nodes; n++) {
        if (time)
            time[n] = t->phase[p].t0 + T * layout->node[n].tau;
        for (int r = 0; costate && r < nx && layout->node[n].collocated; r++)
            costate[n * nx + r] /= T * layout->node[n].weight;
        if (costate && !layout->node[n].collocated)
            costate_from_ends(solution, p, n, costate + n * nx);
    }
    return layout->nodes;
}

// H = g + lambda f, with lambda_f and the integrals' multipliers divided by what T weight brought in.
int moray_solution_hamiltonian(const moray_solution *solution, int p, double *hamiltonian)
{
    const struct transcription *t = solution->transcription;
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const double T = t->phase[p].tf - t->phase[p].t0, *lambda_f = t->phase[p].lambda;
    moray_dynamics_multipliers(t, p, solution->iterate.lambda, t->phase[p].lambda);
    for (int n = 0; n < layout->nodes; n++) {
        const double *out = t->phase[p].out + n * t->phase[p].map->n_out;
        hamiltonian[n] = layout->node[n].collocated ? 0 : NAN;
        for (int r = 0; r < phase->nx; r++)
            hamiltonian[n] += lambda_f[n * phase->nx + r] / (T * layout->node[n].weight) * out[r];
        for (int m = 0; m < phase->nq; m++)
            hamiltonian[n] -= solution->iterate.lambda[layout->integral_row + m] * out[phase->nx + phase->nc + m];
    }
    return layout->nodes;
}

// ---- Bounds and path constraints -----------------------------------------------------------------------------------

static double bound_multiplier(const moray_solution *solution, int column)
{
    return solution->iterate.z_upper[column] - solution->iterate.z_lower[column];
}

static bool same_bounds(moray_bounds one, moray_bounds other)
{
    return one.lower == other.lower && one.upper == other.upper;
}

int moray_solution_multipliers(const moray_solution *solution, int p, double *c, double *x, double *u)
{
    const struct transcription *t = solution->transcription;
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const double T = t->phase[p].tf - t->phase[p].t0;
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        const double share = node->collocated ? T * node->weight : NAN;
        const bool inside = n > 0 && n < layout->nodes - 1;
        const moray_bounds *own = n == 0 ? phase->u0 : inside ? phase->u : phase->uf;
        for (int r = 0; c && r < phase->nc; r++)
            c[n * phase->nc + r] = node->collocated ? solution->iterate.lambda[node->path + r] / share : NAN;
        for (int r = 0; x && r < phase->nx; r++)
            x[n * phase->nx + r] = inside ? bound_multiplier(solution, node->x + r) / share : NAN;
        for (int r = 0; u && r < phase->nu; r++)
            u[n * phase->nu + r] = node->collocated && same_bounds(own[r], phase->u[r]) && !moray_is_held(phase, r)
                                       ? bound_multiplier(solution, node->x + phase->nx + r) / share
                                       : NAN;
    }
    return layout->nodes;
}

void moray_solution_end_multipliers(const moray_solution *solution, int p, double *x0, double *xf)
{
    const struct transcription *t = solution->transcription;
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const int first = layout->node[0].x, last = layout->node[layout->nodes - 1].x;
    for (int r = 0; r < phase->nx; r++) {
        if (x0)
            x0[r] = moray_bounds_are_fixed(phase->x0[r]) ? NAN : bound_multiplier(solution, first + r);
        if (xf)
            xf[r] = moray_bounds_are_fixed(phase->xf[r]) ? NAN : bound_multiplier(solution, last + r);
    }
}
