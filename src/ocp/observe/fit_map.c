// SPDX-License-Identifier: MIT
//
// J + sum over times and channels of rho(z), z = sqrt(w) (h - y), with gradient rho' sqrt(w) h' and Hessian
// rho'' w h' h'^T + rho' sqrt(w) h''. Every time has inputs x, u of its own; parameters are shared with the endpoint.
// Residuals h - y and the sum may be events too.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/observe/fit_parts.h"
#include "ocp/observe/observed.h"
#include "ocp/probe.h"
#include "ocp/transcription.h"

double moray_loss_at(const struct observed *observed, double z, double *slope, double *curvature)
{
    const double d = observed->threshold;
    const bool far = observed->loss == MORAY_HUBER && fabs(z) > d;
    *slope = far ? copysign(2 * d, z) : 2 * z;
    *curvature = far ? 0 : 2;
    return far ? 2 * d * fabs(z) - d * d : z * z;
}

// ---- One time ----

void moray_fit_inputs(const struct fit_map *fit, int p, int k, const double *end_in, double *in)
{
    const struct part *part = &fit->part[p];
    for (int i = 0; i < moray_fit_width(part) + fit->ocp->ns; i++)
        in[i] = end_in[moray_fit_place(fit, part, k, i)];
    in[moray_fit_width(part) + fit->ocp->ns] = part->phase->observed.time[k];
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

// bend[locals][locals], full, of one time, where its losses count `times` and its residuals weight[outputs] (NULL: 0).
static void bend_at(const struct fit_map *fit, const struct part *part, int k, double times, const double *weight,
                    bool curvature_of_h)
{
    const int n = moray_fit_width(part) + fit->ocp->ns;
    const moray_pattern *jac = &part->map->jac, *hess = &part->map->hess;
    memset(part->bend, 0, (size_t)n * (size_t)n * sizeof *part->bend);
    for (int j = 0; j < part->map->n_out; j++) {
        double slope, curvature;
        loss_of(part, k, j, &slope, &curvature);
        const int event = part->event[k * part->map->n_out + j];
        part->weight[j] = times * slope + (weight && event >= 0 ? weight[event] : 0);
        memset(part->gradient, 0, (size_t)n * sizeof *part->gradient);
        for (int e = 0; e < jac->nnz; e++)
            if (jac->row[e] == j)
                part->gradient[jac->col[e]] = part->jac[e];
        for (int e = 0; e < part->pairs; e++)
            part->bend[part->a[e] * n + part->b[e]] +=
                times * curvature * part->gradient[part->a[e]] * part->gradient[part->b[e]];
    }
    if (!curvature_of_h)
        return;
    part->map->hessian(part->map->self, part->in, part->weight, part->hess);
    for (int e = 0; e < hess->nnz; e++)
        if (hess->row[e] < n)
            part->bend[hess->row[e] * n + hess->col[e]] += part->hess[e];
}

// ---- The map ----

static void value(void *self, const double *in, double *out)
{
    const struct fit_map *fit = self;
    fit->base->value(fit->base->self, in, out);
    for (int p = 0; p < fit->ocp->phases; p++) {
        const struct part *part = &fit->part[p];
        const struct observed *o = &part->phase->observed;
        double sum = 0;
        for (int k = 0; k < o->n; k++) {
            look(fit, p, k, in, false);
            for (int j = 0; j < o->ny; j++) {
                double slope, curvature;
                sum += loss_of(part, k, j, &slope, &curvature);
                if (part->event[k * o->ny + j] >= 0)
                    out[part->event[k * o->ny + j]] = part->out[j] - o->value[k * o->ny + j];
            }
        }
        out[0] += o->events_only ? 0 : sum;
        if (part->sum >= 0)
            out[part->sum] = sum;
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
            for (int i = 0; i < part->inputs && !part->phase->observed.events_only; i++)
                values[*at++] += part->gradient[part->input[i]];
            for (int i = 0; i < part->inputs && part->sum >= 0; i++)
                values[*at++] += part->gradient[part->input[i]];
            for (int e = 0; e < part->map->jac.nnz; e++)
                if (part->event[k * part->map->n_out + part->map->jac.row[e]] >= 0 &&
                    part->map->jac.col[e] < part->map->n_in - 1)
                    values[*at++] += part->jac[e];
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
        const int n = moray_fit_width(part) + fit->ocp->ns;
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            look(fit, p, k, in, true);
            bend_at(fit, part, k, moray_fit_weight(part, weight), weight, !fit->gauss_newton);
            for (int e = 0; e < part->pairs; e++)
                values[*at++] += part->bend[part->a[e] * n + part->b[e]];
        }
    }
}

int moray_fit_information(const struct fit_map *fit, const double *end_in, int *row, int *col, double *values)
{
    int entries = 0;
    for (int p = 0; p < fit->ocp->phases; p++) {
        const struct part *part = &fit->part[p];
        const int n = moray_fit_width(part) + fit->ocp->ns;
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            if (values) {
                look(fit, p, k, end_in, true);
                bend_at(fit, part, k, part->phase->observed.events_only ? 0 : 1, NULL, false);
            }
            for (int e = 0; e < part->pairs; e++, entries++) {
                if (row) {
                    row[entries] = moray_fit_place(fit, part, k, part->a[e]);
                    col[entries] = moray_fit_place(fit, part, k, part->b[e]);
                }
                if (values)
                    values[entries] = part->bend[part->a[e] * n + part->b[e]] / 2;
            }
        }
    }
    return entries;
}

// ---- All of it ----

static moray_status check_controls(const struct part *part, const moray_ocp *ocp, const struct layout *layout, int p)
{
    for (int i = 0; i < part->inputs && !moray_data_move(part->phase); i++)
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
        MORAY_TRY(moray_fit_part_new(&fit->part[p], ocp, p, fit->map.n_in, fit->map.n_out));
        fit->map.n_out += moray_observed_events(&ocp->phase[p].observed);
        fit->map.n_in += ocp->phase[p].observed.n * (ocp->phase[p].nx + ocp->phase[p].nu);
        MORAY_TRY(check_controls(&fit->part[p], ocp, layout, p));
    }
    return moray_fit_make_patterns(fit);
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
        free(fit->part[p].event);
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
