// SPDX-License-Identifier: MIT
//
// J + sum over times and channels of rho(z), z = sqrt(w) (h - y), with gradient rho' sqrt(w) h' and Hessian
// rho'' w h' h'^T + rho' sqrt(w) h''. Every time has inputs x, u of its own; parameters are shared with the endpoint.
#include "ocp/observe/fit_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/observe/observed.h"
#include "ocp/probe.h"
#include "ocp/transcription.h"

// Of a phase: the places that one observation of it has in the patterns, in local inputs [x, u, s].
struct part {
    const moray_map *map;
    const struct phase *phase;
    int first;         // input of the fit where the first time begins
    int inputs, pairs; // local inputs that h depends on, and pairs of them, lower triangle
    int *input;        // [inputs]
    int *a, *b;        // [pairs]
    double *in, *out, *jac, *hess, *weight, *gradient, *bend; // scratch for one time
};

struct fit_map {
    moray_map map;
    const moray_map *base;
    const moray_ocp *ocp;
    struct part *part;     // [phases]
    int s;                 // input of the first parameter
    int *jac_at, *hess_at; // where values of pairs and inputs go, time by time
    bool gauss_newton;
};

double moray_loss_at(const struct observed *observed, double z, double *slope, double *curvature)
{
    const double d = observed->threshold;
    const bool far = observed->loss == MORAY_HUBER && fabs(z) > d;
    *slope = far ? copysign(2 * d, z) : 2 * z;
    *curvature = far ? 0 : 2;
    return far ? 2 * d * fabs(z) - d * d : z * z;
}

// ---- One time ----

static int width(const struct part *part)
{
    return part->phase->nx + part->phase->nu;
}

// The input of the fit of a local input.
static int place(const struct fit_map *fit, const struct part *part, int k, int local)
{
    return local < width(part) ? part->first + k * width(part) + local : fit->s + local - width(part);
}

void moray_fit_inputs(const struct fit_map *fit, int p, int k, const double *end_in, double *in)
{
    const struct part *part = &fit->part[p];
    for (int i = 0; i < width(part) + fit->ocp->ns; i++)
        in[i] = end_in[place(fit, part, k, i)];
    in[width(part) + fit->ocp->ns] = part->phase->observed.time[k];
}

static double loss_of(const struct part *part, int k, int j, double *slope, double *curvature)
{
    const struct observed *o = &part->phase->observed;
    const double y = o->value[k * o->ny + j], root = sqrt(o->weight[j]);
    *slope = *curvature = 0;
    if (isnan(y) || root == 0)
        return 0;
    const double loss = moray_loss_at(o, root * (part->out[j] - y), slope, curvature);
    *slope *= root;
    *curvature *= root * root;
    return loss;
}

static void look(const struct fit_map *fit, int p, int k, const double *in, bool derivatives)
{
    const struct part *part = &fit->part[p];
    moray_fit_inputs(fit, p, k, in, part->in);
    part->map->value(part->map->self, part->in, part->out);
    if (derivatives)
        part->map->jacobian(part->map->self, part->in, part->jac);
}

const double *moray_fit_predict(const struct fit_map *fit, int p, int k, const double *end_in)
{
    look(fit, p, k, end_in, false);
    return fit->part[p].out;
}

// bend[locals][locals], full, of one time.
static void bend_at(const struct fit_map *fit, const struct part *part, int k, bool curvature_of_h)
{
    const int n = width(part) + fit->ocp->ns;
    const moray_pattern *jac = &part->map->jac, *hess = &part->map->hess;
    memset(part->bend, 0, (size_t)n * (size_t)n * sizeof *part->bend);
    for (int j = 0; j < part->map->n_out; j++) {
        double slope, curvature;
        loss_of(part, k, j, &slope, &curvature);
        part->weight[j] = slope;
        memset(part->gradient, 0, (size_t)n * sizeof *part->gradient);
        for (int e = 0; e < jac->nnz; e++)
            if (jac->row[e] == j && jac->col[e] < n)
                part->gradient[jac->col[e]] = part->jac[e];
        for (int e = 0; e < part->pairs; e++)
            part->bend[part->a[e] * n + part->b[e]] +=
                curvature * part->gradient[part->a[e]] * part->gradient[part->b[e]];
    }
    if (!curvature_of_h)
        return;
    part->map->hessian(part->map->self, part->in, part->weight, part->hess);
    for (int e = 0; e < hess->nnz; e++)
        if (hess->row[e] < n && hess->col[e] < n)
            part->bend[hess->row[e] * n + hess->col[e]] += part->hess[e];
}

// ---- The map ----

static void value(void *self, const double *in, double *out)
{
    const struct fit_map *fit = self;
    double slope, curvature;
    fit->base->value(fit->base->self, in, out);
    for (int p = 0; p < fit->ocp->phases; p++)
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            look(fit, p, k, in, false);
            for (int j = 0; j < fit->part[p].map->n_out; j++)
                out[0] += loss_of(&fit->part[p], k, j, &slope, &curvature);
        }
}

static void jacobian(void *self, const double *in, double *values)
{
    const struct fit_map *fit = self;
    const int *at = fit->jac_at;
    memset(values, 0, (size_t)fit->map.jac.nnz * sizeof *values);
    fit->base->jacobian(fit->base->self, in, values);
    for (int p = 0; p < fit->ocp->phases; p++) {
        const struct part *part = &fit->part[p];
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            double curvature;
            look(fit, p, k, in, true);
            for (int j = 0; j < part->map->n_out; j++)
                loss_of(part, k, j, &part->weight[j], &curvature);
            memset(part->gradient, 0, (size_t)part->map->n_in * sizeof *part->gradient);
            for (int e = 0; e < part->map->jac.nnz; e++)
                part->gradient[part->map->jac.col[e]] += part->weight[part->map->jac.row[e]] * part->jac[e];
            for (int i = 0; i < part->inputs; i++)
                values[*at++] += part->gradient[part->input[i]];
        }
    }
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    const struct fit_map *fit = self;
    const int *at = fit->hess_at;
    memset(values, 0, (size_t)fit->map.hess.nnz * sizeof *values);
    fit->base->hessian(fit->base->self, in, weight, values);
    for (int p = 0; p < fit->ocp->phases; p++) {
        const struct part *part = &fit->part[p];
        const int n = width(part) + fit->ocp->ns;
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            look(fit, p, k, in, true);
            bend_at(fit, part, k, !fit->gauss_newton);
            for (int e = 0; e < part->pairs; e++)
                values[*at++] += weight[0] * part->bend[part->a[e] * n + part->b[e]];
        }
    }
}

int moray_fit_information(const struct fit_map *fit, const double *end_in, int *row, int *col, double *values)
{
    int entries = 0;
    for (int p = 0; p < fit->ocp->phases; p++) {
        const struct part *part = &fit->part[p];
        const int n = width(part) + fit->ocp->ns;
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            if (values) {
                look(fit, p, k, end_in, true);
                bend_at(fit, part, k, false);
            }
            for (int e = 0; e < part->pairs; e++, entries++) {
                if (row) {
                    row[entries] = place(fit, part, k, part->a[e]);
                    col[entries] = place(fit, part, k, part->b[e]);
                }
                if (values)
                    values[entries] = part->bend[part->a[e] * n + part->b[e]] / 2;
            }
        }
    }
    return entries;
}

// ---- Patterns ----

// Which local inputs and pairs h has.
static moray_status find_pairs(struct part *part, int ns)
{
    const int n = part->phase->nx + part->phase->nu + ns;
    const moray_map *map = part->map;
    bool *felt = calloc((size_t)n * (size_t)(n + 1) + 1, sizeof *felt), *pair = felt ? felt + n : NULL;
    part->input = calloc((size_t)n + 1, sizeof *part->input);
    part->a = calloc((size_t)n * (size_t)n + 1, sizeof *part->a);
    part->b = calloc((size_t)n * (size_t)n + 1, sizeof *part->b);
    if (!felt || !part->input || !part->a || !part->b) {
        free(felt);
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    }
    for (int e = 0; e < map->jac.nnz; e++)
        for (int d = 0; d < map->jac.nnz && map->jac.col[e] < n; d++) {
            felt[map->jac.col[e]] = true;
            if (map->jac.row[d] == map->jac.row[e] && map->jac.col[d] <= map->jac.col[e])
                pair[map->jac.col[e] * n + map->jac.col[d]] = true;
        }
    for (int e = 0; e < map->hess.nnz; e++)
        if (map->hess.row[e] < n && map->hess.col[e] < n)
            pair[map->hess.row[e] * n + map->hess.col[e]] = true;
    for (int i = 0; i < n; i++)
        if (felt[i])
            part->input[part->inputs++] = i;
    for (int k = 0; k < n * n; k++)
        if (pair[k])
            part->a[part->pairs] = k / n, part->b[part->pairs++] = k % n;
    free(felt);
    return moray_ok();
}

static moray_status part_new(struct part *part, const moray_ocp *ocp, int p, int first)
{
    const struct phase *phase = &ocp->phase[p];
    *part = (struct part){.map = phase->observed.map, .phase = phase, .first = first};
    if (phase->observed.n == 0)
        return moray_ok();
    const moray_map *map = part->map;
    const size_t n = (size_t)map->n_in, ny = (size_t)map->n_out;
    part->in = calloc(2 * n + 2 * ny + (size_t)map->jac.nnz + (size_t)map->hess.nnz + n * n, sizeof *part->in);
    if (!part->in)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    part->gradient = part->in + n;
    part->out = part->gradient + n;
    part->weight = part->out + ny;
    part->jac = part->weight + ny;
    part->hess = part->jac + map->jac.nnz;
    part->bend = part->hess + map->hess.nnz;
    return find_pairs(part, ocp->ns);
}

// An entry of the pattern; one between parameters stands once, at *known unless that is negative.
static int entry(moray_pattern *pattern, int row, int col, int *known)
{
    if (known && *known >= 0)
        return *known;
    pattern->row[pattern->nnz] = row;
    pattern->col[pattern->nnz] = col;
    if (known)
        *known = pattern->nnz;
    return pattern->nnz++;
}

// Where the endpoint has entries between parameters: slope[ns] of the objective, pair[ns][ns]; -1: nowhere.
static void find_shared(const struct fit_map *fit, int *slope, int *pair)
{
    const int ns = fit->ocp->ns;
    const moray_pattern *jac = &fit->base->jac, *hess = &fit->base->hess;
    for (int i = 0; i < ns + ns * ns; i++)
        slope[i] = -1;
    for (int k = 0; k < jac->nnz; k++)
        if (jac->row[k] == 0 && jac->col[k] >= fit->s)
            slope[jac->col[k] - fit->s] = k;
    for (int k = 0; k < hess->nnz; k++)
        if (hess->row[k] >= fit->s && hess->col[k] >= fit->s)
            pair[(hess->row[k] - fit->s) * ns + hess->col[k] - fit->s] = k;
}

// Parameters are inputs before those of the times: the lower triangle has them as columns.
static void place_entries(struct fit_map *fit, int *slope, int *pair)
{
    const int ns = fit->ocp->ns;
    int jac = 0, hess = 0;
    for (int p = 0; p < fit->ocp->phases; p++) {
        const struct part *part = &fit->part[p];
        const int w = part->phase->nx + part->phase->nu;
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            for (int i = 0; i < part->inputs; i++) {
                const int at = part->input[i];
                fit->jac_at[jac++] = entry(&fit->map.jac, 0, place(fit, part, k, at), at >= w ? &slope[at - w] : NULL);
            }
            for (int e = 0; e < part->pairs; e++) {
                const int a = place(fit, part, k, part->a[e]), b = place(fit, part, k, part->b[e]);
                int *known = part->a[e] >= w && part->b[e] >= w ? &pair[(a - fit->s) * ns + b - fit->s] : NULL;
                fit->hess_at[hess++] = entry(&fit->map.hess, a > b ? a : b, a > b ? b : a, known);
            }
        }
    }
}

static moray_status make_patterns(struct fit_map *fit)
{
    size_t jac = 1, hess = 1;
    for (int p = 0; p < fit->ocp->phases; p++) {
        jac += (size_t)fit->part[p].inputs * (size_t)fit->ocp->phase[p].observed.n;
        hess += (size_t)fit->part[p].pairs * (size_t)fit->ocp->phase[p].observed.n;
    }
    const int base_jac = fit->base->jac.nnz, base_hess = fit->base->hess.nnz;
    fit->jac_at = calloc(jac, sizeof *fit->jac_at);
    fit->hess_at = calloc(hess, sizeof *fit->hess_at);
    if (!fit->jac_at || !fit->hess_at)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    MORAY_TRY(moray_pattern_new(&fit->map.jac, base_jac + (int)jac));
    MORAY_TRY(moray_pattern_new(&fit->map.hess, base_hess + (int)hess));
    memcpy(fit->map.jac.row, fit->base->jac.row, (size_t)base_jac * sizeof(int));
    memcpy(fit->map.jac.col, fit->base->jac.col, (size_t)base_jac * sizeof(int));
    memcpy(fit->map.hess.row, fit->base->hess.row, (size_t)base_hess * sizeof(int));
    memcpy(fit->map.hess.col, fit->base->hess.col, (size_t)base_hess * sizeof(int));
    fit->map.jac.nnz = base_jac, fit->map.hess.nnz = base_hess;
    const size_t ns = (size_t)fit->ocp->ns;
    int *shared = calloc(ns + ns * ns + 1, sizeof *shared);
    if (!shared)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    find_shared(fit, shared, shared + ns);
    place_entries(fit, shared, shared + ns);
    free(shared);
    return moray_ok();
}

// ---- All of it ----

static moray_status check_controls(const struct part *part, const moray_ocp *ocp, const struct layout *layout, int p)
{
    for (int i = 0; i < part->inputs; i++)
        for (int k = 0; k < part->phase->observed.n; k++) {
            const int u = part->input[i] - part->phase->nx;
            if (u >= 0 && u < part->phase->nu && !moray_observed_node(layout, ocp, p, k)->collocated)
                return moray_error(MORAY_INPUT,
                                   "observations of phase %s depend on its controls, which the scheme does not have at "
                                   "t = %g: choose a lobatto scheme",
                                   part->phase->name, part->phase->observed.time[k]);
        }
    return moray_ok();
}

static moray_status make(struct fit_map *fit, const struct layout *layout)
{
    const moray_ocp *ocp = fit->ocp;
    fit->s = moray_endpoint_inputs(ocp) - ocp->ns;
    fit->map = (moray_map){.n_in = fit->s + ocp->ns,
                           .n_out = fit->base->n_out,
                           .self = fit,
                           .value = value,
                           .jacobian = jacobian,
                           .hessian = hessian};
    fit->part = calloc((size_t)ocp->phases, sizeof *fit->part);
    if (!fit->part)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    for (int p = 0; p < ocp->phases; p++) {
        MORAY_TRY(part_new(&fit->part[p], ocp, p, fit->map.n_in));
        fit->map.n_in += ocp->phase[p].observed.n * (ocp->phase[p].nx + ocp->phase[p].nu);
        MORAY_TRY(check_controls(&fit->part[p], ocp, layout, p));
    }
    return make_patterns(fit);
}

moray_status moray_fit_map_new(struct fit_map **result, const moray_ocp *ocp, const struct layout *layout)
{
    int n = 0;
    *result = NULL;
    for (int p = 0; p < ocp->phases; p++)
        n += ocp->phase[p].observed.n;
    if (n == 0)
        return moray_ok();
    struct fit_map *fit = calloc(1, sizeof *fit);
    if (!fit)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    fit->ocp = ocp;
    fit->base = ocp->endpoint->map;
    const moray_status status = make(fit, layout);
    if (moray_failed(status))
        moray_fit_map_free(fit);
    else
        *result = fit;
    return status;
}

void moray_fit_map_free(struct fit_map *fit)
{
    if (!fit)
        return;
    for (int p = 0; fit->part && p < fit->ocp->phases; p++) {
        free(fit->part[p].input);
        free(fit->part[p].a);
        free(fit->part[p].b);
        free(fit->part[p].in);
    }
    free(fit->part);
    free(fit->jac_at);
    free(fit->hess_at);
    moray_pattern_free(&fit->map.jac);
    moray_pattern_free(&fit->map.hess);
    free(fit);
}

const moray_map *moray_fit_map(const struct fit_map *fit)
{
    return &fit->map;
}

void moray_fit_be_gauss_newton(struct transcription *t, bool gauss_newton)
{
    t->gauss_newton = gauss_newton;
    if (t->fit)
        t->fit->gauss_newton = gauss_newton;
}
