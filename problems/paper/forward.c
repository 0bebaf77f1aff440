// SPDX-License-Identifier: MIT
#include "forward.h"

// Dbar = D^T (D D^T)^{-1}: its transpose solves (D D^T) X = D.
static moray_status make_dbar(paper *p, paper_forward *f)
{
    const int N = f->N, n = N - 1;
    double *gram, *x;
    MORAY_TRY(paper_numbers(p, (size_t)n * n, &gram));
    MORAY_TRY(paper_numbers(p, (size_t)n * N, &x));
    for (int i = 0; i < n; i++) {
        gram[i * n + i] = 2;
        if (i > 0)
            gram[i * n + i - 1] = gram[(i - 1) * n + i] = -1;
        x[i * N + i] = 1;
        x[i * N + i + 1] = -1;
    }
    if (!moray_dense_solve(n, gram, N, x))
        return moray_error(MORAY_NUMERIC, "D D^T of %d links is singular", N);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < n; j++)
            f->Dbar[i * n + j] = x[j * N + i];
    return moray_ok();
}

moray_status paper_forward_new(paper *p, const moray_robot *robot, paper_forward *f)
{
    const double L = 2 * robot->l;
    const int N = robot->links;
    double *memory;
    *f = (paper_forward){.N = N,
                         .m = robot->m,
                         .mu_n = robot->mu_n,
                         .c_t = robot->c_t,
                         .c_n = robot->c_n,
                         .c_p = (robot->c_n - robot->c_t) / (2 * L),
                         .mu_p = robot->mu_n / (2 * L),
                         .ch_n = robot->c_n / (4 * L * L)};
    MORAY_TRY(paper_numbers(p, (size_t)N * (N - 1) + 3 * (size_t)N + (size_t)(N + 1) * (N + 3), &memory));
    f->Dbar = memory;
    f->at_phi = f->Dbar + N * (N - 1);
    f->dbar_v = f->at_phi + N;
    f->dbar_acc = f->dbar_v + N;
    f->matrix = f->dbar_acc + N;
    f->residual = f->matrix + (N + 1) * (N + 1);
    f->trial = f->residual + N + 1;
    return make_dbar(p, f);
}

static void dbar_times(const paper_forward *f, const double *v, double *out)
{
    for (int i = 0; i < f->N; i++) {
        out[i] = 0;
        for (int j = 0; j < f->N - 1; j++)
            out[i] += f->Dbar[i * (f->N - 1) + j] * v[j];
    }
}

// By how much accelerations z = (phi'', v_t', v_n') miss the balances (15), with the fluid forces (14).
static void balances(const paper_forward *f, const paper_situation *at, const double *z, double *residual)
{
    const int N = f->N;
    const double dv_t = z[N - 1], dv_n = z[N];
    double sum_t = 0, sum_n = 0, f_n_before = 0;
    dbar_times(f, z, f->dbar_acc);
    for (int i = 0; i < N; i++) {
        const double b = f->at_phi[i], across = at->v_nr - f->dbar_v[i], acc = dv_n - f->dbar_acc[i];
        const double f_t = f->mu_p * b * acc + f->c_p * b * across - (f->c_t + f->ch_n * b * b) * at->v_tr; // (14a)
        const double f_n = f->mu_p * b * dv_t - f->mu_n * acc + f->c_p * b * at->v_tr - f->c_n * across;    // (14b)
        sum_t += f_t;
        sum_n += f_n;
        if (i > 0) { // (15a), joint i of the paper
            const int j = i - 1;
            const double ddt_u = 2 * at->u[j] - (j > 0 ? at->u[j - 1] : 0) - (j < N - 2 ? at->u[j + 1] : 0);
            residual[j] = f->m * z[j] + (f_n_before - f_n) - ddt_u;
        }
        f_n_before = f_n;
    }
    residual[N - 1] = N * f->m * dv_t - sum_t; // (15b)
    residual[N] = N * f->m * dv_n - sum_n;     // (15c)
}

// The balances are linear in the accelerations: their matrix comes column by column.
bool paper_forward_accelerations(const paper_forward *f, const paper_situation *at, double *z)
{
    const int N = f->N, n = N + 1;
    for (int i = 0; i < N; i++)
        f->at_phi[i] = (i < N - 1 ? at->phi[i] : 0) + (i > 0 ? at->phi[i - 1] : 0);
    dbar_times(f, at->v_phi, f->dbar_v);
    for (int i = 0; i < n; i++)
        f->trial[i] = 0;
    balances(f, at, f->trial, z);
    for (int j = 0; j < n; j++) {
        f->trial[j] = 1;
        balances(f, at, f->trial, f->residual);
        for (int i = 0; i < n; i++)
            f->matrix[i * n + j] = f->residual[i] - z[i];
        f->trial[j] = 0;
    }
    for (int i = 0; i < n; i++)
        z[i] = -z[i];
    return moray_dense_solve(n, f->matrix, 1, z);
}
