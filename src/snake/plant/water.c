// SPDX-License-Identifier: MIT
//
// Plants in water that is not uniform: the current is that at (p_x, p_y) and t, for the whole robot. In uniform water
// the outputs are affine in the current, where drag is linear, so that three maps give them and all derivatives
// exactly,
//     out = M_0 + V_x (M_x - M_0) + V_y (M_y - M_0),        M_0, M_x, M_y in the currents (0, 0), (1, 0), (0, 1);
// where drag is not linear but the added mass invariant, they depend on p' - V alone, and one map in water at rest
// does,
//     out = M_0(.., p' - V, ..)       but for the rows p' of the state's derivative, which stay.
// The chain rule adds the derivatives of V.
#include "snake/plant/water.h"

#include <stdlib.h>
#include <string.h>

enum { WAYS = 3, PLACES = 3, P_X = MORAY_STATE_P_X, P_Y = MORAY_STATE_P_Y };
// Second derivatives of V by pairs of x, y, t, as moray_water_slopes orders them.
static const int second[PLACES][PLACES] = {{3, 4, 6}, {4, 5, 7}, {6, 7, 8}};

typedef struct water_plant {
    const moray_water *water;
    moray_map base[WAYS];
    bool shifted; // by p' - V, on base[0] alone
    int n_in, n_out;
    int place[PLACES];  // of p_x, p_y, t among the inputs
    int wet_from;       // outputs that feel the current: the last three of the body, and from here to
    int wet_to;         // the power's, those of the joints and their motors
    double *at;         // n_in: shifted inputs
    double *out[WAYS];  // n_out each
    double *jac[WAYS];  // n_out x n_in each
    double *hess[WAYS]; // n_in x n_in each, lower triangle
    double *values;     // over a pattern
    moray_pattern jac_pattern, hess_pattern;
    double V[2], d[2][MORAY_WATER_SLOPES];
} water_plant;

static int ways(const water_plant *self)
{
    return self->shifted ? 1 : WAYS;
}

// Water at the point; the inputs that the maps see.
static const double *look(water_plant *self, const double *in)
{
    moray_water_slopes(self->water, in[P_X], in[P_Y], in[self->place[2]], self->V, self->d);
    if (!self->shifted)
        return in;
    memcpy(self->at, in, (size_t)self->n_in * sizeof *in);
    self->at[MORAY_STATE_V_1] -= self->V[0];
    self->at[MORAY_STATE_V_2] -= self->V[1];
    return self->at;
}

static void value(void *context, const double *in, double *out)
{
    water_plant *self = context;
    const double *seen = look(self, in);
    for (int k = 0; k < ways(self); k++)
        self->base[k].value(self->base[k].self, seen, self->out[k]);
    memcpy(out, self->out[0], (size_t)self->n_out * sizeof *out);
    if (self->shifted) {
        out[P_X] = in[MORAY_STATE_V_1];
        out[P_Y] = in[MORAY_STATE_V_2];
        return;
    }
    for (int i = 0; i < self->n_out; i++)
        out[i] += self->V[0] * (self->out[1][i] - self->out[0][i]) + self->V[1] * (self->out[2][i] - self->out[0][i]);
}

// Spreads the Jacobian of a map over n_out x n_in numbers.
static void spread_jacobian(water_plant *self, int k, const double *seen)
{
    const moray_map *base = &self->base[k];
    memset(self->jac[k], 0, (size_t)(self->n_out * self->n_in) * sizeof *self->jac[k]);
    base->jacobian(base->self, seen, self->values);
    for (int e = 0; e < base->jac.nnz; e++)
        self->jac[k][base->jac.row[e] * self->n_in + base->jac.col[e]] = self->values[e];
}

static void spread_hessian(water_plant *self, int k, const double *seen, const double *weight)
{
    const moray_map *base = &self->base[k];
    memset(self->hess[k], 0, (size_t)(self->n_in * self->n_in) * sizeof *self->hess[k]);
    base->hessian(base->self, seen, weight, self->values);
    for (int e = 0; e < base->hess.nnz; e++)
        self->hess[k][base->hess.row[e] * self->n_in + base->hess.col[e]] += self->values[e];
}

// Output i by V_c: what the current moves, of affine outputs their slope, of shifted ones that by p'.
static double by_current(const water_plant *self, int i, int c)
{
    if (!self->shifted)
        return self->out[1 + c][i] - self->out[0][i];
    return i == P_X || i == P_Y ? 0 : -self->jac[0][i * self->n_in + MORAY_STATE_V_1 + c];
}

// Row i of the Jacobian, V held.
static double held(const water_plant *self, int i, int j)
{
    const int e = i * self->n_in + j;
    double sum = self->jac[0][e];
    for (int c = 0; c < 2 && !self->shifted; c++)
        sum += self->V[c] * (self->jac[1 + c][e] - self->jac[0][e]);
    return sum;
}

static int place_of(const water_plant *self, int col)
{
    for (int k = 0; k < PLACES; k++)
        if (self->place[k] == col)
            return k;
    return -1;
}

static void all_jacobians(water_plant *self, const double *in)
{
    const double *seen = look(self, in);
    for (int k = 0; k < ways(self); k++) {
        self->base[k].value(self->base[k].self, seen, self->out[k]);
        spread_jacobian(self, k, seen);
    }
}

static void jacobian(void *context, const double *in, double *values)
{
    water_plant *self = context;
    all_jacobians(self, in);
    for (int e = 0; e < self->jac_pattern.nnz; e++) {
        const int i = self->jac_pattern.row[e], j = self->jac_pattern.col[e], k = place_of(self, j);
        values[e] = held(self, i, j);
        for (int c = 0; c < 2 && k >= 0; c++)
            values[e] += by_current(self, i, c) * self->d[c][k];
    }
}

// Derivative of the weighted sum by V_c, and of that by input j, V held; shifted also by V_b.
static double weighed(const water_plant *self, const double *weight, int c)
{
    double sum = 0;
    for (int i = 0; i < self->n_out; i++)
        sum += weight[i] * by_current(self, i, c);
    return sum;
}

static double lower(const double *hess, int n, int i, int j)
{
    return i > j ? hess[i * n + j] : hess[j * n + i];
}

static double weighed_slope(const water_plant *self, const double *weight, int c, int j)
{
    double sum = 0;
    if (self->shifted)
        return -lower(self->hess[0], self->n_in, MORAY_STATE_V_1 + c, j);
    for (int i = 0; i < self->n_out; i++) {
        const int e = i * self->n_in + j;
        sum += weight[i] * (self->jac[1 + c][e] - self->jac[0][e]);
    }
    return sum;
}

// Of the pair of inputs i, j: V_c moves with those that are places.
static double moved(const water_plant *self, const double *weight, const double on_V[2], int i, int j)
{
    const int a = place_of(self, i), b = place_of(self, j);
    double sum = 0;
    for (int c = 0; c < 2; c++) {
        if (a >= 0)
            sum += self->d[c][a] * weighed_slope(self, weight, c, j);
        if (b >= 0)
            sum += self->d[c][b] * weighed_slope(self, weight, c, i);
        if (a >= 0 && b >= 0)
            sum += on_V[c] * self->d[c][second[a][b]];
        for (int e = 0; e < 2 && a >= 0 && b >= 0 && self->shifted; e++)
            sum += self->d[c][a] * self->d[e][b] *
                   lower(self->hess[0], self->n_in, MORAY_STATE_V_1 + c, MORAY_STATE_V_1 + e);
    }
    return sum;
}

static void hessian(void *context, const double *in, const double *weight, double *values)
{
    water_plant *self = context;
    all_jacobians(self, in);
    const double *seen = self->shifted ? self->at : in;
    for (int k = 0; k < ways(self); k++)
        spread_hessian(self, k, seen, weight);
    const double on_V[2] = {weighed(self, weight, 0), weighed(self, weight, 1)};
    for (int e = 0; e < self->hess_pattern.nnz; e++) {
        const int i = self->hess_pattern.row[e], j = self->hess_pattern.col[e], at = i * self->n_in + j;
        values[e] = self->hess[0][at];
        for (int c = 0; c < 2 && !self->shifted; c++)
            values[e] += self->V[c] * (self->hess[1 + c][at] - self->hess[0][at]);
        if (place_of(self, i) >= 0 || place_of(self, j) >= 0)
            values[e] += moved(self, weight, on_V, i, j);
    }
}

// ---- Patterns ------------------------------------------------------------------------------------------------------

static bool wet(const water_plant *self, int output)
{
    return (output >= MORAY_STATE_V_THETA && output < MORAY_BODY_STATES) ||
           (output >= self->wet_from && output < self->wet_to) || output == self->n_out - 1;
}

static moray_status list(const bool *marks, int rows, int columns, moray_pattern *pattern)
{
    int n = 0;
    for (int e = 0; e < rows * columns; e++)
        n += marks[e];
    MORAY_TRY(moray_pattern_new(pattern, n));
    for (int e = 0, k = 0; e < rows * columns; e++)
        if (marks[e]) {
            pattern->row[k] = e / columns;
            pattern->col[k++] = e % columns;
        }
    return moray_ok();
}

static moray_status find_patterns(water_plant *self)
{
    const int n = self->n_in;
    bool *slopes = calloc((size_t)((self->n_out + n) * n), sizeof *slopes),
         *bends = slopes ? slopes + self->n_out * n : NULL;
    if (!slopes)
        return moray_error(MORAY_MEMORY, "no memory for the patterns of a plant");
    for (int k = 0; k < ways(self); k++) {
        const moray_pattern *jac = &self->base[k].jac, *hess = &self->base[k].hess;
        for (int e = 0; e < jac->nnz; e++)
            slopes[jac->row[e] * n + jac->col[e]] = true;
        for (int e = 0; e < hess->nnz; e++)
            bends[hess->row[e] * n + hess->col[e]] = true;
    }
    for (int k = 0; k < PLACES; k++) {
        const int col = self->place[k];
        for (int i = 0; i < self->n_out; i++)
            slopes[i * n + col] = slopes[i * n + col] || wet(self, i);
        for (int j = 0; j < n; j++)
            bends[j > col ? j * n + col : col * n + j] = true;
    }
    moray_status status = list(slopes, self->n_out, n, &self->jac_pattern);
    if (!moray_failed(status))
        status = list(bends, n, n, &self->hess_pattern);
    free(slopes);
    return status;
}

// ---- Construction --------------------------------------------------------------------------------------------------

static void release_plant(water_plant *self)
{
    for (int k = 0; k < WAYS; k++)
        moray_map_release(&self->base[k]);
    free(self->at);
    free(self);
}

static void release(moray_map *map)
{
    moray_pattern_free(&map->jac);
    moray_pattern_free(&map->hess);
    release_plant(map->self);
}

static moray_status make_maps(water_plant *self, const moray_plant_spec *spec, moray_plant_maker *make)
{
    moray_plant_spec still = *spec;
    still.water = NULL;
    for (int k = 0; k < ways(self); k++) {
        still.current[0] = k == 1;
        still.current[1] = k == 2;
        MORAY_TRY(make(&self->base[k], &still));
    }
    return moray_ok();
}

static moray_status take_room(water_plant *self)
{
    const size_t n_in = (size_t)self->n_in, n_out = (size_t)self->n_out;
    const size_t most = n_out * n_in > n_in * n_in ? n_out * n_in : n_in * n_in;
    double *at = calloc(n_in + WAYS * (n_out + n_out * n_in + n_in * n_in) + most, sizeof *at);
    if (!at)
        return moray_error(MORAY_MEMORY, "no memory for a plant in a current over place and time");
    self->at = at;
    at += n_in;
    for (int k = 0; k < WAYS; k++) {
        self->out[k] = at;
        self->jac[k] = self->out[k] + n_out;
        self->hess[k] = self->jac[k] + n_out * n_in;
        at = self->hess[k] + n_in * n_in;
    }
    self->values = at;
    return moray_ok();
}

static moray_status set_up(water_plant *self, const moray_plant_spec *spec, moray_plant_maker *make)
{
    MORAY_TRY(make_maps(self, spec, make));
    const moray_plant_size size = moray_plant_sizes(spec);
    self->n_in = self->base[0].n_in;
    self->n_out = self->base[0].n_out;
    self->place[0] = P_X;
    self->place[1] = P_Y;
    self->place[2] = self->n_in - 1;
    self->wet_from = size.nx;
    self->wet_to = size.nx + ((spec->path_forces ? 1 : 0) + (spec->path_supply ? spec->robot.motor.lines : 0)) *
                                 (spec->robot.links - 1);
    MORAY_TRY(take_room(self));
    return find_patterns(self);
}

moray_status moray_water_plant(moray_map *map, const moray_plant_spec *spec, bool first_principles,
                               moray_plant_maker *make)
{
    const moray_hydrodynamics *hydro = &spec->robot.hydro;
    const bool motor = first_principles && spec->robot.motor.fitted;
    const bool linear = !first_principles || (hydro->drag == MORAY_DRAG_LINEAR && !motor);
    if (spec->joints == MORAY_JOINTS_CLOSED_LOOP || spec->joints == MORAY_JOINTS_FREE)
        return moray_error(MORAY_INPUT, "water that is not uniform: only with the joints on a gait");
    if (!linear && hydro->added_mass != MORAY_ADDED_MASS_INVARIANT)
        return moray_error(MORAY_INPUT, "water that is not uniform: %s needs added_mass = invariant",
                           motor ? "the power of motors" : "quadratic drag");
    water_plant *self = calloc(1, sizeof *self);
    if (!self)
        return moray_error(MORAY_MEMORY, "no memory for a plant in a current over place and time");
    self->water = spec->water;
    self->shifted = !linear;
    const moray_status status = set_up(self, spec, make);
    *map = (moray_map){.n_in = self->n_in,
                       .n_out = self->n_out,
                       .jac = self->jac_pattern,
                       .hess = self->hess_pattern,
                       .self = self,
                       .value = value,
                       .jacobian = jacobian,
                       .hessian = hessian,
                       .release = release};
    if (moray_failed(status))
        moray_map_release(map);
    return status;
}
