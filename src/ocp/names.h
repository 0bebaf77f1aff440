// SPDX-License-Identifier: MIT
//
// What an entry of a vector is called, in texts for the user. text[size].
#ifndef SRC_OCP_NAMES_H
#define SRC_OCP_NAMES_H

#include "ocp/layout.h"

// "state v" or "state x[2]"
void moray_function_entry_name(const char *kind, const char *letter, const char *const *names, int i, char *text,
                               int size);

// Inputs [x, u, s, t] and outputs [f, c, g] of a phase: "control u[0]", "dynamics of state v".
void moray_phase_input_name(const moray_ocp *ocp, int p, int i, char *text, int size);
void moray_phase_output_name(const moray_ocp *ocp, int p, int i, char *text, int size);

// Inputs and outputs [J, e, events of the observations] of the endpoint: "final state v of phase wire", "event e[0]".
void moray_endpoint_input_name(const moray_ocp *ocp, int i, char *text, int size);
void moray_endpoint_output_name(const moray_ocp *ocp, int i, char *text, int size);

// Inputs of the endpoint that belong to one phase: [x0, t0, xf, tf, q].
void moray_phase_end_name(const struct phase *phase, int i, char *text, int size);

// "state v of phase wire observed at t = 1.25", of what is seen of the k-th time.
void moray_observed_name(const struct phase *phase, int k, const char *what, char *text, int size);

// A column or row of the programme at decision vector x: "control u[0] of phase wire at t = 1.25".
void moray_layout_column_name(const struct layout *layout, const moray_ocp *ocp, const double *x, int column,
                              char *text, int size);
void moray_layout_row_name(const struct layout *layout, const moray_ocp *ocp, const double *x, int row, char *text,
                           int size);

// Error: MORAY_INPUT naming two of a scope that have the same name, or one that is empty, too long or would break a
// file.
moray_status moray_check_names(const moray_ocp *ocp);

#endif
