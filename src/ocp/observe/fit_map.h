// SPDX-License-Identifier: MIT
//
// The endpoint of a problem with observations: its objective and the losses of all residuals.
#ifndef SRC_OCP_FIT_MAP_H
#define SRC_OCP_FIT_MAP_H

#include "ocp/layout.h"

struct fit_map;
struct transcription;

// A fit of the maps that the problem has now; NULL where nothing is observed. Error: MORAY_MEMORY; MORAY_INPUT where a
// control is observed at a time at which the scheme has none.
moray_status moray_fit_map_new(struct fit_map **fit, const moray_ocp *ocp, const struct layout *layout);
void moray_fit_map_free(struct fit_map *fit);

// in = [those of the endpoint, then x, u of each observed time], out = [J, e, events of the observations]
const moray_map *moray_fit_map(const struct fit_map *fit);

// in[x, u, s, t] of the k-th time of phase p, from inputs of the map.
void moray_fit_inputs(const struct fit_map *fit, int p, int k, const double *end_in, double *in);

// h[ny] there; scratch of the fit.
const double *moray_fit_predict(const struct fit_map *fit, int p, int k, const double *end_in);

// Hessians leave out the curvature of constraints and observations, or do not.
void moray_fit_be_gauss_newton(struct transcription *t, bool gauss_newton);

// Second derivatives, as Gauss and Newton take them, of half the losses: entries between inputs of the map, lower
// triangle not sorted. Returns how many; arrays may be NULL.
int moray_fit_information(const struct fit_map *fit, const double *end_in, int *row, int *col, double *value);

// Slope and curvature of the loss at z = sqrt(weight) residual; returns the loss.
double moray_loss_at(const struct observed *observed, double z, double *slope, double *curvature);

#endif
