// SPDX-License-Identifier: MIT
#include "ocp/probe.h"

#include <math.h>

int moray_phase_inputs(const struct phase *p)
{
    return p->nx + p->nu + p->ns + 1;
}

int moray_end_inputs(const struct phase *p)
{
    return 2 * p->nx + 2 + p->nq + (p->end_controls ? 2 * p->nu : 0);
}

int moray_endpoint_inputs(const moray_ocp *ocp)
{
    int n = ocp->ns;
    for (int i = 0; i < ocp->phases; i++)
        n += moray_end_inputs(&ocp->phase[i]);
    return n;
}

static double finite_size(double bound)
{
    return fabs(bound) < MORAY_INFINITY ? fabs(bound) : 0;
}

static const double negligible = 1e-8; // a value that is fixed there is 0 and rounding

static double size_of(moray_bounds bounds)
{
    const double size = fmax(finite_size(bounds.lower), finite_size(bounds.upper));
    if (bounds.lower == bounds.upper && size < negligible)
        return 1;
    return size > 0 ? fmin(size, 1) : 1;
}

static void size_list(const moray_bounds *bounds, int n, double **size)
{
    for (int i = 0; i < n; i++)
        *(*size)++ = size_of(bounds[i]);
}

static double state_size(const struct phase *p, int i)
{
    return fmin(size_of(p->x0[i]), size_of(p->xf[i])); // which hold the bounds of x too
}

void moray_phase_sizes(const moray_ocp *ocp, const struct phase *p, double *size)
{
    for (int i = 0; i < p->nx; i++)
        *size++ = state_size(p, i);
    size_list(p->u, p->nu, &size);
    size_list(ocp->s, ocp->ns, &size);
    *size = fmin(size_of(p->t0), size_of(p->tf));
}

void moray_endpoint_sizes(const moray_ocp *ocp, double *size)
{
    for (int k = 0; k < ocp->phases; k++) {
        const struct phase *p = &ocp->phase[k];
        for (int end = 0; end < 2; end++) {
            for (int i = 0; i < p->nx; i++)
                *size++ = state_size(p, i);
            *size++ = fmin(size_of(p->t0), size_of(p->tf));
        }
        size_list(p->q, p->nq, &size);
        for (int end = 0; end < 2 && p->end_controls; end++)
            size_list(p->u, p->nu, &size);
    }
    size_list(ocp->s, ocp->ns, &size);
}

static double probe_value(moray_bounds bounds, double size, int i, int trial)
{
    const double shift = 0.2 * (fmod(0.618033988749895 * (i + 1) + 0.37 * trial, 1) - 0.5);
    const bool boxed = bounds.lower > -MORAY_INFINITY && bounds.upper < MORAY_INFINITY;
    const double width = boxed ? bounds.upper - bounds.lower : size + fabs(moray_bounds_middle(bounds));
    const double value = moray_bounds_middle(bounds) + width * (shift + (boxed ? 0 : 0.3));
    return fmin(fmax(value, bounds.lower), bounds.upper);
}

static void probe_list(const moray_bounds *bounds, int n, int trial, double **in)
{
    for (int i = 0; i < n; i++)
        *(*in)++ = probe_value(bounds[i], size_of(bounds[i]), i, trial);
}

// The middle between the ends says most about where a state lives; beside it, because both may be fixed at zero.
static void probe_states(const struct phase *p, int trial, double **in)
{
    for (int i = 0; i < p->nx; i++) {
        const double x0 = probe_value(p->x0[i], state_size(p, i), i, trial);
        const double xf = probe_value(p->xf[i], state_size(p, i), i + 7, trial);
        const double middle = 0.55 * x0 + 0.45 * xf, beside = 0.05 * (state_size(p, i) + fabs(middle));
        *(*in)++ = fmin(fmax(middle + beside, p->x[i].lower), p->x[i].upper);
    }
}

void moray_phase_probe(const moray_ocp *ocp, const struct phase *p, int trial, double *in)
{
    probe_states(p, trial, &in);
    probe_list(p->u, p->nu, trial, &in);
    probe_list(ocp->s, ocp->ns, trial, &in);
    *in = 0.6 * probe_value(p->t0, size_of(p->t0), 0, trial) + 0.4 * probe_value(p->tf, size_of(p->tf), 1, trial);
}

void moray_endpoint_probe(const moray_ocp *ocp, int trial, double *in)
{
    for (int k = 0; k < ocp->phases; k++) {
        const struct phase *p = &ocp->phase[k];
        probe_list(p->x0, p->nx, trial, &in);
        probe_list(&p->t0, 1, trial, &in);
        probe_list(p->xf, p->nx, trial, &in);
        probe_list(&p->tf, 1, trial + 1, &in);
        probe_list(p->q, p->nq, trial, &in);
        if (p->end_controls) {
            probe_list(p->u0, p->nu, trial, &in);
            probe_list(p->uf, p->nu, trial + 1, &in);
        }
    }
    probe_list(ocp->s, ocp->ns, trial, &in);
}

// ---- Points over the whole box ----

static const double wide = 1e3, endless = 1e9; // beside a size of 1

// The i-th input of the k-th point: 0..1, each part of 1/(n - 1) once as k goes on.
static double part_of_box(int i, int k)
{
    const int parts = moray_probe_points - 1, stride = 1 + 7 * i % (parts - 1);
    return ((k * stride + 11 * i) % parts + 0.1 + 0.8 * fmod(0.618033988749895 * (i + k), 1)) / parts;
}

// Bounds of astronomical size are none.
static moray_bounds trimmed(moray_bounds b, double size)
{
    return (moray_bounds){b.lower < -endless * size ? -MORAY_INFINITY : b.lower,
                          b.upper > endless * size ? MORAY_INFINITY : b.upper};
}

static double mirrored(double value, moray_bounds b)
{
    if (value < b.lower)
        value = 2 * b.lower - value;
    if (value > b.upper)
        value = 2 * b.upper - value;
    return fmin(fmax(value, b.lower), b.upper);
}

// Wide bounds are looked at as they are at every other point.
static double box_value(moray_bounds bounds, double size, double centre, double reach, int i, int k)
{
    const double part = part_of_box(i, k), side = 2 * part - 1;
    const moray_bounds b = trimmed(bounds, size);
    const double width = b.upper - b.lower;
    if (width <= wide * size || (k % 2 && width < 2 * endless * size))
        return b.lower + part * width;
    const double distance = (reach + size + fabs(centre)) * pow(10, 3 * fabs(side) - 2);
    return mirrored(centre + copysign(distance, side), b);
}

static void box_list(const moray_bounds *bounds, int n, int first, int k, double **in)
{
    for (int i = 0; i < n; i++) {
        const double size = size_of(bounds[i]);
        *(*in)++ = box_value(bounds[i], size, moray_bounds_middle(trimmed(bounds[i], size)), 0, first + i, k);
    }
}

static void box_states(const struct phase *p, int k, double **in)
{
    for (int i = 0; i < p->nx; i++) {
        const double size = state_size(p, i);
        const double x0 = moray_bounds_middle(trimmed(p->x0[i], size));
        const double xf = moray_bounds_middle(trimmed(p->xf[i], size));
        *(*in)++ = box_value(p->x[i], size, (x0 + xf) / 2, fabs(xf - x0), i, k);
    }
}

void moray_phase_points(const moray_ocp *ocp, const struct phase *p, int trial, double *points)
{
    const int n_in = moray_phase_inputs(p);
    const moray_bounds time = {p->t0.lower, p->tf.upper};
    moray_phase_probe(ocp, p, trial, points);
    for (int k = 1; k < moray_probe_points; k++) {
        double *in = points + k * n_in;
        box_states(p, k, &in);
        box_list(p->u, p->nu, p->nx, k, &in);
        box_list(ocp->s, ocp->ns, p->nx + p->nu, k, &in);
        box_list(&time, 1, n_in - 1, k, &in);
    }
}

void moray_endpoint_points(const moray_ocp *ocp, int trial, double *points)
{
    const int n_in = moray_endpoint_inputs(ocp);
    moray_endpoint_probe(ocp, trial, points);
    for (int k = 1; k < moray_probe_points; k++) {
        double *point = points + k * n_in, *in = point;
        for (int i = 0; i < ocp->phases; i++) {
            const struct phase *p = &ocp->phase[i];
            box_list(p->x0, p->nx, (int)(in - point), k, &in);
            box_list(&p->t0, 1, (int)(in - point), k, &in);
            box_list(p->xf, p->nx, (int)(in - point), k, &in);
            box_list(&p->tf, 1, (int)(in - point), k, &in);
            box_list(p->q, p->nq, (int)(in - point), k, &in);
            if (p->end_controls) {
                box_list(p->u0, p->nu, (int)(in - point), k, &in);
                box_list(p->uf, p->nu, (int)(in - point), k, &in);
            }
        }
        box_list(ocp->s, ocp->ns, (int)(in - point), k, &in);
    }
}

// ---- The box ----

static moray_bounds *add_bounds(moray_bounds *box, const moray_bounds *bounds, int n)
{
    for (int i = 0; i < n; i++)
        *box++ = bounds[i];
    return box;
}

void moray_phase_box(const moray_ocp *ocp, const struct phase *p, moray_bounds *box)
{
    box = add_bounds(box, p->x, p->nx);
    box = add_bounds(box, p->u, p->nu);
    box = add_bounds(box, ocp->s, ocp->ns);
    *box = moray_between(p->t0.lower, p->tf.upper);
}

void moray_endpoint_box(const moray_ocp *ocp, moray_bounds *box)
{
    for (const struct phase *p = ocp->phase; p < ocp->phase + ocp->phases; p++) {
        box = add_bounds(box, p->x, p->nx);
        box = add_bounds(box, &p->t0, 1);
        box = add_bounds(box, p->x, p->nx);
        box = add_bounds(box, &p->tf, 1);
        box = add_bounds(box, p->q, p->nq);
        for (int end = 0; end < 2 && p->end_controls; end++)
            box = add_bounds(box, p->u, p->nu);
    }
    add_bounds(box, ocp->s, ocp->ns);
}
