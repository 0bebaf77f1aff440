// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "ocp/names.h"

enum { name_size = 100 };

static void in_phase(const struct layout *layout, const moray_ocp *ocp, const double *x, int p, double tau,
                     const char *what, char *text, int size)
{
    snprintf(text, (size_t)size, "%s of phase %s at t = %.6g", what, ocp->phase[p].name,
             moray_layout_time(layout, ocp, x, p, tau));
}

void moray_layout_column_name(const struct layout *layout, const moray_ocp *ocp, const double *x, int column,
                              char *text, int size)
{
    char what[name_size];
    if (column >= layout->s) {
        moray_function_entry_name("parameter", "s", ocp->s_names, column - layout->s, text, size);
        return;
    }
    int p = 0;
    while (p + 1 < layout->phases && column >= layout->phase[p + 1].node[0].x)
        p++;
    const struct phase_layout *phase = &layout->phase[p];
    if (phase->sight && column >= phase->sight[0].x) {
        const int width = ocp->phase[p].nx + ocp->phase[p].nu, i = column - phase->sight[0].x;
        moray_phase_input_name(ocp, p, i % width, what, name_size);
        moray_observed_name(&ocp->phase[p], i / width, what, text, size);
        return;
    }
    if (column >= phase->q) {
        const int nx = ocp->phase[p].nx, m = column - phase->q;
        const int input = column == phase->t0 ? nx : column == phase->tf ? 2 * nx + 1 : 2 * nx + 2 + m;
        moray_phase_end_name(&ocp->phase[p], input, text, size);
        return;
    }
    int n = 0;
    while (n + 1 < phase->nodes && column >= phase->node[n + 1].x)
        n++;
    const int i = column - phase->node[n].x, nx = ocp->phase[p].nx;
    if (i < nx)
        moray_function_entry_name("state", "x", ocp->phase[p].x_names, i, what, name_size);
    else
        moray_function_entry_name("control", "u", ocp->phase[p].u_names, i - nx, what, name_size);
    in_phase(layout, ocp, x, p, phase->node[n].tau, what, text, size);
}

static void defect_name(const struct layout *layout, const moray_ocp *ocp, const double *x, int p, int row, char *text,
                        int size)
{
    const struct phase_layout *phase = &layout->phase[p];
    const int nx = ocp->phase[p].nx;
    char what[name_size];
    const int i = row - phase->interval[0].defect; // as many to a node, but for the first
    moray_function_entry_name("defect of state", "x", ocp->phase[p].x_names, i % nx, what, name_size);
    in_phase(layout, ocp, x, p, phase->node[i / nx + 1].tau, what, text, size);
}

static void hold_name(const struct layout *layout, const moray_ocp *ocp, const double *x, int p, int row, char *text,
                      int size)
{
    const struct phase_layout *phase = &layout->phase[p];
    char what[name_size];
    int n = 0;
    while (n + 1 < phase->nodes && row >= phase->node[n + 1].hold)
        n++;
    moray_function_entry_name("hold of control", "u", ocp->phase[p].u_names,
                              ocp->phase[p].held[row - phase->node[n].hold], what, name_size);
    in_phase(layout, ocp, x, p, phase->node[n].tau, what, text, size);
}

void moray_layout_row_name(const struct layout *layout, const moray_ocp *ocp, const double *x, int row, char *text,
                           int size)
{
    char what[name_size];
    if (row >= layout->events) {
        moray_endpoint_output_name(ocp, 1 + row - layout->events, text, size);
        return;
    }
    int p = 0;
    while (p + 1 < layout->phases && row >= layout->phase[p + 1].node[0].path)
        p++;
    const struct phase_layout *phase = &layout->phase[p];
    if (phase->sight && row >= phase->sight[0].row) {
        const int width = ocp->phase[p].nx + ocp->phase[p].nu, i = row - phase->sight[0].row;
        char input[name_size];
        moray_phase_input_name(ocp, p, i % width, input, name_size);
        snprintf(what, name_size, "definition of %.80s", input);
        moray_observed_name(&ocp->phase[p], i / width, what, text, size);
    } else if (row == phase->length_row) {
        snprintf(text, (size_t)size, "length of phase %s", ocp->phase[p].name);
    } else if (row >= phase->hold_row) {
        hold_name(layout, ocp, x, p, row, text, size);
    } else if (row >= phase->integral_row + ocp->phase[p].nq) {
        const int m = row - phase->integral_row;
        moray_phase_end_name(&ocp->phase[p], 2 * ocp->phase[p].nx + 2 + m, what, name_size);
        snprintf(text, (size_t)size, "definition of %s", what);
    } else if (row >= phase->integral_row) {
        snprintf(text, (size_t)size, "definition of integral q[%d] of phase %s", row - phase->integral_row,
                 ocp->phase[p].name);
    } else if (row >= phase->interval[0].defect) {
        defect_name(layout, ocp, x, p, row, text, size);
    } else {
        int n = 0;
        while (n + 1 < phase->nodes && row >= phase->node[n + 1].path)
            n++;
        moray_function_entry_name("path constraint", "c", ocp->phase[p].c_names, row - phase->node[n].path, what,
                                  name_size);
        in_phase(layout, ocp, x, p, phase->node[n].tau, what, text, size);
    }
}
