// SPDX-License-Identifier: MIT
//
// A solution as a picture: states and controls of all phases over time, each by its own largest value, so that those of
// different units share an axis.
#include <math.h>
#include <stdlib.h>

#include "picture.h"

enum { POINTS = 151, MOST = 7, MOST_STATES = 64 }; // points of a phase; curves that colours tell apart

struct picture {
    int nx, nu, n, phases; // curves; phases with the widths of the first
    double *t, *value[MOST];
    char label[MOST][40];
};

static void sample(const moray_solution *solution, struct picture *p)
{
    double x[MOST_STATES], u[MOST_STATES];
    for (int phase = 0; phase < p->phases; phase++) {
        double t0, tf;
        moray_solution_times(solution, phase, &t0, &tf);
        for (int k = 0; k < POINTS; k++) {
            const int row = phase * POINTS + k;
            p->t[row] = t0 + (tf - t0) * k / (POINTS - 1);
            moray_solution_at(solution, phase, p->t[row], x, u);
            for (int i = 0; i < p->n; i++)
                p->value[i][row] = i < p->n - p->nu ? x[i] : u[i - (p->n - p->nu)];
        }
    }
}

// In the place of a curve its share of its largest value, which the label tells.
static void share(struct picture *p)
{
    for (int i = 0; i < p->n; i++) {
        const int states = p->n - p->nu;
        double most = 0;
        for (int k = 0; k < p->phases * POINTS; k++)
            most = fmax(most, fabs(p->value[i][k]));
        for (int k = 0; k < p->phases * POINTS && most > 0; k++)
            p->value[i][k] /= most;
        snprintf(p->label[i], sizeof p->label[i], "%s %d, up to %.4g", i < states ? "state" : "control",
                 i < states ? i + 1 : i - states + 1, most);
    }
}

static moray_status draw(const struct classic *classic, struct picture *p, moray_output *output)
{
    moray_curve curves[MOST];
    for (int i = 0; i < p->n; i++)
        curves[i] = (moray_curve){
            .label = p->label[i], .x = p->t, .y = p->value[i], .n = p->phases * POINTS, .dotted = i >= p->n - p->nu};
    return moray_output_figure(output, &(moray_figure){.name = classic->name,
                                                       .title = classic->title,
                                                       .x_label = "time",
                                                       .y_label = "share of its largest value",
                                                       .curves = curves,
                                                       .n_curves = p->n});
}

moray_status classic_draw(const struct classic *classic, const moray_ocp *ocp, const moray_solution *solution,
                          moray_output *output)
{
    struct picture p = {.phases = 0};
    moray_ocp_widths(ocp, 0, &p.nx, &p.nu);
    for (int phase = 0; phase < moray_ocp_phases(ocp); phase++) {
        int nx, nu;
        moray_ocp_widths(ocp, phase, &nx, &nu);
        if (nx == p.nx && nu == p.nu)
            p.phases++;
        else
            break;
    }
    if (p.nx > MOST_STATES || p.nu > MOST_STATES)
        return moray_ok();
    p.nu = p.nu < MOST - 1 ? p.nu : MOST - 1;
    p.n = p.nx + p.nu < MOST ? p.nx + p.nu : MOST;
    const size_t rows = (size_t)(p.phases * POINTS);
    p.t = malloc((size_t)(p.n + 1) * rows * sizeof *p.t);
    if (!p.t)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    for (int i = 0; i < p.n; i++)
        p.value[i] = p.t + (size_t)(i + 1) * rows;
    sample(solution, &p);
    share(&p);
    const moray_status status = draw(classic, &p, output);
    free(p.t);
    return status;
}
