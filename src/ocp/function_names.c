// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "ocp/names.h"
#include "ocp/observe/observed.h"
#include "ocp/probe.h"

void moray_function_entry_name(const char *kind, const char *letter, const char *const *names, int i, char *text,
                               int size)
{
    if (names)
        snprintf(text, (size_t)size, "%s %s", kind, names[i]);
    else
        snprintf(text, (size_t)size, "%s %s[%d]", kind, letter, i);
}

void moray_phase_input_name(const moray_ocp *ocp, int p, int i, char *text, int size)
{
    const struct phase *phase = &ocp->phase[p];
    const int nx = phase->nx, nu = phase->nu, ns = phase->ns;
    if (i < nx)
        moray_function_entry_name("state", "x", phase->x_names, i, text, size);
    else if (i < nx + nu)
        moray_function_entry_name("control", "u", phase->u_names, i - nx, text, size);
    else if (i < nx + nu + ns)
        moray_function_entry_name("parameter", "s", ocp->s_names, i - nx - nu, text, size);
    else
        snprintf(text, (size_t)size, "time");
}

void moray_phase_output_name(const moray_ocp *ocp, int p, int i, char *text, int size)
{
    const struct phase *phase = &ocp->phase[p];
    const int nx = phase->nx, nc = phase->nc;
    if (i < nx)
        moray_function_entry_name("dynamics of state", "x", phase->x_names, i, text, size);
    else if (i < nx + nc)
        moray_function_entry_name("path constraint", "c", phase->c_names, i - nx, text, size);
    else
        moray_function_entry_name("integrand", "g", NULL, i - nx - nc, text, size);
}

enum { name_size = 100 };

void moray_phase_end_name(const struct phase *phase, int i, char *text, int size)
{
    const int nx = phase->nx, first = i <= nx, u0 = 2 * nx + 2 + phase->nq, uf = u0 + phase->nu;
    char what[name_size];
    if (i >= u0)
        moray_function_entry_name(i < uf ? "initial control" : "final control", "u", phase->u_names,
                                  i < uf ? i - u0 : i - uf, what, name_size);
    else if (i >= 2 * nx + 2)
        moray_function_entry_name("integral", "q", NULL, i - 2 * nx - 2, what, name_size);
    else if (i == nx || i == 2 * nx + 1)
        snprintf(what, name_size, first ? "initial time" : "final time");
    else
        moray_function_entry_name(first ? "initial state" : "final state", "x", phase->x_names, first ? i : i - nx - 1,
                                  what, name_size);
    snprintf(text, (size_t)size, "%s of phase %s", what, phase->name);
}

void moray_observed_name(const struct phase *phase, int k, const char *what, char *text, int size)
{
    snprintf(text, (size_t)size, "%s of phase %s observed at t = %.6g", what, phase->name, phase->observed.time[k]);
}

// Inputs [x, u] of each observed time in turn.
static void observed_input_name(const moray_ocp *ocp, int i, char *text, int size)
{
    char what[name_size];
    for (int p = 0; p < ocp->phases; p++) {
        const int width = ocp->phase[p].nx + ocp->phase[p].nu, n = ocp->phase[p].observed.n;
        if (i < width * n) {
            moray_phase_input_name(ocp, p, i % width, what, name_size);
            moray_observed_name(&ocp->phase[p], i / width, what, text, size);
            return;
        }
        i -= width * n;
    }
}

void moray_endpoint_input_name(const moray_ocp *ocp, int i, char *text, int size)
{
    for (int p = 0; p < ocp->phases; p++) {
        const int n = moray_end_inputs(&ocp->phase[p]);
        if (i < n) {
            moray_phase_end_name(&ocp->phase[p], i, text, size);
            return;
        }
        i -= n;
    }
    if (i < ocp->ns)
        moray_function_entry_name("parameter", "s", ocp->s_names, i, text, size);
    else
        observed_input_name(ocp, i - ocp->ns, text, size);
}

static void observed_event_name(const moray_ocp *ocp, int i, char *text, int size)
{
    char what[name_size];
    int p = 0, k, j;
    for (int n; p + 1 < ocp->phases && i >= (n = moray_observed_events(&ocp->phase[p].observed)); p++)
        i -= n;
    const struct observed *o = &ocp->phase[p].observed;
    moray_observed_event(o, i, &k, &j);
    if (k == o->n) {
        snprintf(text, (size_t)size, "sum of the observations of phase %s", ocp->phase[p].name);
        return;
    }
    moray_function_entry_name("residual", "y", o->names, j, what, name_size);
    snprintf(text, (size_t)size, "%s of phase %s at t = %.6g", what, ocp->phase[p].name, o->time[k]);
}

void moray_endpoint_output_name(const moray_ocp *ocp, int i, char *text, int size)
{
    if (i == 0)
        snprintf(text, (size_t)size, "objective");
    else if (i <= ocp->ne)
        moray_function_entry_name("event", "e", ocp->e_names, i - 1, text, size);
    else
        observed_event_name(ocp, i - 1 - ocp->ne, text, size);
}
