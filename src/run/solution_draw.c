// SPDX-License-Identifier: MIT
//
// Figures of a solve: how the solver got there, and how good the mesh is where.
#include <math.h>
#include <stdlib.h>

#include "moray/app/run.h"
#include "ocp/solution.h"

enum { MOST_PHASES = 7 }; // that colours tell apart

// Every solve begins with iteration 0; iterations are counted through all of them.
static moray_status draw_convergence(const moray_solution *solution, moray_output *output)
{
    int n;
    const moray_progress *at = moray_solution_iterations(solution, &n);
    double *values = malloc((size_t)(4 * n) * sizeof *values), *x = values, *violation = x + n, *dual = x + 2 * n,
           *begin = x + 3 * n;
    if (n < 2 || !values) {
        free(values);
        return n < 2 ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a figure");
    }
    int begun = 0;
    for (int k = 0; k < n; k++) {
        x[k] = k;
        violation[k] = at[k].infeasibility > 0 ? at[k].infeasibility : NAN; // a logarithm has no place for 0
        dual[k] = at[k].dual_infeasibility > 0 ? at[k].dual_infeasibility : NAN;
        begin[k] = at[k].iteration == 0 ? fmax(violation[k], dual[k]) : NAN; // of which one may be 0
        begun += at[k].iteration == 0;
    }
    const moray_curve curves[] = {{.label = "violation of the constraints",
                                   .x = x,
                                   .y = violation,
                                   .n = n,
                                   .style = MORAY_CURVE_MARKED,
                                   .colour = MORAY_COLOUR_BASELINE},
                                  {.label = "dual infeasibility: gradient of the Lagrangian",
                                   .x = x,
                                   .y = dual,
                                   .n = n,
                                   .style = MORAY_CURVE_MARKED,
                                   .colour = MORAY_COLOUR_BEST},
                                  {.label = "start of a solve",
                                   .x = x,
                                   .y = begin,
                                   .n = n,
                                   .style = MORAY_CURVE_POINTS,
                                   .colour = MORAY_COLOUR_LIMIT}};
    const moray_status status = moray_output_figure(output, &(moray_figure){.name = "convergence",
                                                                            .title = "Convergence of the solver",
                                                                            .x_label = "iteration",
                                                                            .y_label = "scaled violation",
                                                                            .log_y = true,
                                                                            .curves = curves,
                                                                            .n_curves = begun > 1 ? 3 : 2});
    free(values);
    return status;
}

// A step for every interval of a phase: x[2 n], y[2 n].
static moray_status make_steps(const moray_solution *solution, int p, double *x, double *y, double *edge, double *error)
{
    const int n = moray_solution_intervals(solution, p, edge);
    MORAY_TRY(moray_solution_interval_errors(solution, p, error));
    for (int k = 0; k < n; k++) {
        x[2 * k] = edge[k];
        x[2 * k + 1] = edge[k + 1];
        y[2 * k] = y[2 * k + 1] = error[k] > 0 ? error[k] : NAN;
    }
    return moray_ok();
}

static moray_status draw_steps(const moray_solution *solution, double tolerance, const char *time_unit, double *room,
                               moray_output *output)
{
    const moray_ocp *ocp = solution->transcription->ocp;
    const int phases = ocp->phases < MOST_PHASES ? ocp->phases : MOST_PHASES;
    moray_curve curves[MOST_PHASES + 1];
    double ends[2] = {INFINITY, -INFINITY}, limit[2] = {tolerance, tolerance};
    char title[80], time[40];
    int intervals = 0;
    for (int p = 0; p < phases; p++) {
        const int n = moray_solution_intervals(solution, p, NULL);
        double *x = room, *y = x + 2 * n, *edge = y + 2 * n, *error = edge + n + 1;
        MORAY_TRY(make_steps(solution, p, x, y, edge, error));
        room += 6 * n + 1;
        ends[0] = fmin(ends[0], x[0]);
        ends[1] = fmax(ends[1], x[2 * n - 1]);
        curves[p] =
            (moray_curve){.label = phases > 1 && ocp->phase[p].name ? ocp->phase[p].name : "error of an interval",
                          .x = x,
                          .y = y,
                          .n = 2 * n};
        intervals += n;
    }
    curves[phases] =
        (moray_curve){.label = "what is accepted", .x = ends, .y = limit, .n = 2, .colour = MORAY_COLOUR_LIMIT};
    snprintf(time, sizeof time, time_unit ? "time [%.30s]" : "time", time_unit);
    snprintf(title, sizeof title, "The mesh: %d intervals and the error of each", intervals);
    return moray_output_figure(output, &(moray_figure){.name = "mesh",
                                                       .title = title,
                                                       .x_label = time,
                                                       .y_label = "relative error of the dynamics",
                                                       .log_y = true,
                                                       .curves = curves,
                                                       .n_curves = phases + 1});
}

static moray_status draw_mesh(const moray_solution *solution, double tolerance, const char *time_unit,
                              moray_output *output)
{
    size_t n = 0;
    if (!moray_is_solved(solution))
        return moray_ok();
    for (int p = 0; p < solution->transcription->ocp->phases; p++)
        n += 6 * (size_t)moray_solution_intervals(solution, p, NULL) + 1;
    double *room = malloc(n * sizeof *room);
    if (!room)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    const moray_status status = draw_steps(solution, tolerance, time_unit, room, output);
    free(room);
    return status;
}

moray_status moray_solution_draw(const moray_solution *solution, double tolerance, const char *time_unit,
                                 moray_output *output)
{
    MORAY_TRY(draw_mesh(solution, tolerance, time_unit, output));
    return draw_convergence(solution, output);
}
