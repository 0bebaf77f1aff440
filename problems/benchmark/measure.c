// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "benchmark.h"
#include "moray/clock.h"
#include "moray/number.h"

double cost_evaluation(const cost *c)
{
    return c->piece[FUNCTION] + c->piece[JACOBIAN] + c->piece[HESSIAN];
}

moray_settings benchmark_settings(const char *scheme, int intervals, moray_linear_solver linear, bool timed)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = intervals;
    settings.barrier = 1e-6; // every start is an orbit; peers/casadi_s1 begin there too
    settings.timing = timed;
    settings.linear_solver = linear;
    return settings;
}

double total_over_ours(const named_cost *c)
{
    return c->mumps.total / c->cost.total;
}

double linear_over_ours(const named_cost *c)
{
    return c->mumps.piece[LINEAR] / c->mumps.iterations / (c->cost.piece[LINEAR] / c->cost.iterations);
}

// What Ipopt does besides is what is left of the total.
static cost read_account(const moray_solution *solution, double set_up, double total, double wall)
{
    const moray_nlp_info *info = moray_solution_info(solution);
    const double *by = info->evaluation_by;
    const int *calls = info->evaluations;
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(solution, &meshes);
    return (cost){.piece = {[SETUP] = set_up,
                            [FUNCTION] = by[0] + by[2],
                            [JACOBIAN] = by[1] + by[3],
                            [HESSIAN] = by[4],
                            [IPOPT] = total - set_up - info->evaluation_seconds - info->linear_seconds,
                            [LINEAR] = info->linear_seconds},
                  .total = total,
                  .wall = wall,
                  .solved = info->outcome == MORAY_NLP_SOLVED,
                  .linear_solver = info->linear_solver,
                  .iterations = info->iterations,
                  .objective = moray_solution_objective(solution),
                  .size = moray_solution_size(solution),
                  .nodes = mesh[meshes - 1].nodes,
                  .sweeps = calls[2] + calls[3] + calls[4],
                  .sweep = by[2] / calls[2]};
}

// As users have it, then with its parts timed, which takes longer.
static moray_status measure_once(const subject *of, moray_linear_solver linear, cost *found)
{
    double total = 0, wall = 0, memory = 0;
    for (int timed = 0; timed < 2; timed++) {
        moray_solution *solution = NULL;
        const double before = memory_begin(), start = moray_processor_clock(), wall_start = moray_clock();
        const moray_status status = of->solve(of->self, linear, timed, &solution);
        const double spent = moray_processor_clock() - start;
        if (!moray_failed(status) && timed)
            *found = read_account(solution, spent - moray_solution_info(solution)->cpu_seconds, total, wall);
        else {
            total = spent;
            wall = moray_clock() - wall_start;
            memory = memory_peak(before);
        }
        moray_solution_free(solution);
        of->forget(of->self);
        MORAY_TRY(status);
    }
    found->memory = memory;
    return moray_ok();
}

// Of the numbers at `offset` in n costs; work[n].
static double median_cost(const cost *costs, size_t offset, int n, double *work)
{
    for (int k = 0; k < n; k++)
        work[k] = *(const double *)((const char *)&costs[k] + offset);
    return moray_quantile(work, n, 0.5);
}

static moray_status measure_all(const subject *of, moray_linear_solver linear, int repeats, cost *costs, double *work,
                                cost *found)
{
    for (int k = 0; k < repeats; k++)
        MORAY_TRY(measure_once(of, linear, &costs[k]));
    *found = costs[0];
    for (size_t k = 0; k < PIECES; k++)
        found->piece[k] = median_cost(costs, offsetof(cost, piece) + k * sizeof(double), repeats, work);
    found->total = median_cost(costs, offsetof(cost, total), repeats, work);
    found->sweep = median_cost(costs, offsetof(cost, sweep), repeats, work);
    found->memory = costs[0].memory; // later ones reuse what the first left behind
    found->wall = median_cost(costs, offsetof(cost, wall), repeats, work);
    return moray_ok();
}

moray_status measure(const subject *of, moray_linear_solver linear, int repeats, cost *found)
{
    cost *costs = calloc((size_t)repeats, sizeof *costs);
    double *work = calloc((size_t)repeats, sizeof *work);
    moray_status status = costs && work ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d costs", repeats);
    if (!moray_failed(status) && of->begin)
        status = of->begin(of->self);
    if (!moray_failed(status))
        status = measure_all(of, linear, repeats, costs, work, found);
    if (of->end)
        of->end(of->self);
    free(costs);
    free(work);
    return status;
}

double fitted_exponent(const double *x, const double *y, int n)
{
    double count = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int k = 0; k < n; k++) {
        if (!(x[k] > 0 && y[k] > 0))
            continue;
        const double u = log(x[k]), v = log(y[k]);
        count++;
        sx += u;
        sy += v;
        sxx += u * u;
        sxy += u * v;
    }
    return count < 2 ? NAN : (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

const char *const exponent_names[EXPONENTS] = {"setup", "evaluation", "solver", "iteration", "memory"};

void growth_exponents(const growth *g, double exponent[EXPONENTS])
{
    double size[MOST_POINTS], value[EXPONENTS][MOST_POINTS];
    for (int k = 0; k < g->n; k++) {
        const cost *c = &g->cost[k];
        const double iterations = c->iterations;
        size[k] = g->size[k];
        value[0][k] = c->piece[SETUP];
        value[1][k] = cost_evaluation(c) / iterations;
        value[2][k] = (c->piece[IPOPT] + c->piece[LINEAR]) / iterations;
        value[3][k] = value[1][k] + value[2][k];
        value[4][k] = c->memory;
    }
    for (int i = 0; i < EXPONENTS; i++)
        exponent[i] = fitted_exponent(size, value[i], g->n);
}
