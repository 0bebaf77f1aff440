// SPDX-License-Identifier: MIT
#include <string.h>

#include "benchmark.h"

static const char *const piece_keys[PIECES] = {"setup_s",   "function_s", "jacobian_s",
                                               "hessian_s", "ipopt_s",    "linear_solver_s"};

static void json_floor(moray_json *json, const machine *rates, const cost *c)
{
    double term[FLOOR_TERMS];
    const double floor = cost_floor(rates, c, term);
    moray_json_members(json,
                       MORAY_MEMBERS({"floor_s", floor}, {"floor_factorisation_s", term[FLOOR_FACTORS]},
                                     {"floor_streaming_s", term[FLOOR_STREAM]},
                                     {"floor_functions_s", term[FLOOR_CALLS]}, {"total_over_floor", c->total / floor}));
    moray_json_text(json, "floor_is_mostly", floor_term_text(term));
}

static void json_cost(moray_json *json, const machine *rates, const cost *c)
{
    moray_json_bool(json, "solved", c->solved);
    moray_json_text(json, "linear_solver", moray_linear_solver_text(c->linear_solver));
    moray_json_members(json, MORAY_MEMBERS({"objective", c->objective}, {"iterations", c->iterations},
                                           {"nvar", c->size.variables}, {"ncon", c->size.constraints},
                                           {"nnz_jac", c->size.nnz_jac}, {"nnz_hess", c->size.nnz_hess}));
    for (int k = 0; k < PIECES; k++)
        moray_json_number(json, piece_keys[k], c->piece[k]);
    moray_json_members(json, MORAY_MEMBERS({"evaluation_s", cost_evaluation(c)}, {"total_s", c->total},
                                           {"wall_s", c->wall}, {"peak_memory_bytes", c->memory}));
    json_floor(json, rates, c);
}

// The same with MUMPS, and how many times more that costs.
static void json_mumps(moray_json *json, const named_cost *c)
{
    moray_json_open(json, "with_mumps");
    moray_json_bool(json, "solved", c->mumps.solved);
    moray_json_members(json, MORAY_MEMBERS({"objective", c->mumps.objective}, {"iterations", c->mumps.iterations},
                                           {"linear_solver_s", c->mumps.piece[LINEAR]}, {"total_s", c->mumps.total},
                                           {"total_over_ours", total_over_ours(c)},
                                           {"linear_solver_over_ours", linear_over_ours(c)}));
    moray_json_close(json);
}

static void json_growth(moray_json *json, const machine *rates, const growth *g)
{
    double exponent[EXPONENTS];
    growth_exponents(g, exponent);
    moray_json_open(json, NULL);
    moray_json_text(json, "problem", g->name);
    moray_json_text(json, "over", g->over);
    moray_json_open(json, "exponents");
    for (int i = 0; i < EXPONENTS; i++)
        moray_json_number(json, exponent_names[i], exponent[i]);
    moray_json_close(json);
    moray_json_open_list(json, "points");
    for (int k = 0; k < g->n; k++) {
        moray_json_open(json, NULL);
        moray_json_number(json, g->over, g->size[k]);
        json_cost(json, rates, &g->cost[k]);
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_close(json);
}

static void json_simulation(moray_json *json, const simulated *s)
{
    moray_json_open_list(json, "simulation");
    for (int k = 0; k < s->n; k++)
        for (int model = 0; model < 2; model++) {
            moray_json_open(json, NULL);
            moray_json_text(json, "model", moray_model_key(model));
            moray_json_number(json, "links", s->links[k]);
            moray_json_number(json, "simulated_s_per_s", s->rate[model][k]);
            moray_json_close(json);
        }
    moray_json_close(json);
}

void benchmark_summary(const void *found, moray_json *json)
{
    const benchmark *run = found;
    moray_json_text(json, "clock", "processor time, medians");
    moray_json_number(json, "repeats", run->repeats);
    moray_json_number(json, "dense_flops_per_s", run->machine.flops);
    moray_json_number(json, "streamed_bytes_per_s", run->machine.bytes);
    moray_json_open_list(json, "problems");
    for (int k = 0; k < run->n_cases; k++) {
        moray_json_open(json, NULL);
        moray_json_text(json, "name", run->cases[k].name);
        json_cost(json, &run->machine, &run->cases[k].cost);
        json_mumps(json, &run->cases[k]);
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_open_list(json, "growth");
    for (int k = 0; k < run->n_growths; k++)
        json_growth(json, &run->machine, &run->growths[k]);
    moray_json_close(json);
    json_simulation(json, &run->simulation);
}

// Time of one iteration over what grows.
static moray_status draw_growth(const benchmark *run, const char *over, const char *name, const char *title)
{
    double size[MOST_GROWTHS][MOST_POINTS], ms[MOST_GROWTHS][MOST_POINTS];
    moray_curve curves[MOST_GROWTHS];
    int n = 0;
    for (int i = 0; i < run->n_growths; i++) {
        const growth *g = &run->growths[i];
        if (strcmp(g->over, over) != 0)
            continue;
        for (int k = 0; k < g->n; k++) {
            size[n][k] = g->size[k];
            ms[n][k] = 1000 * (g->cost[k].total - g->cost[k].piece[SETUP]) / g->cost[k].iterations;
        }
        curves[n] = (moray_curve){.label = g->name, .x = size[n], .y = ms[n], .n = g->n, .style = MORAY_CURVE_MARKED};
        n++;
    }
    if (n == 0)
        return moray_ok();
    return moray_output_figure(run->common.output, &(moray_figure){.name = name,
                                                                   .title = title,
                                                                   .x_label = over,
                                                                   .y_label = "processor time [ms]",
                                                                   .log_x = true,
                                                                   .log_y = true,
                                                                   .curves = curves,
                                                                   .n_curves = n});
}

moray_status benchmark_draw(const void *found, moray_output *output)
{
    const benchmark *run = found;
    if (run->part == S1)
        MORAY_TRY(s1_write_start(output));
    MORAY_TRY(draw_growth(run, "states", "growth_states", "One iteration, over states"));
    MORAY_TRY(draw_growth(run, "intervals", "growth_intervals", "One iteration, over intervals"));
    return draw_growth(run, "links", "growth_links", "One iteration, over links");
}
