// SPDX-License-Identifier: MIT
#include "app/gait_endpoint.h"

#include <math.h>

// Positions in the endpoint's input [x0, t0, xf, tf, q, s].
struct places {
    int x0, xf, tf, energy, a, omega, delta;
};

static struct places places_of(const struct gait_endpoint *e)
{
    const int s = 2 * e->nx + 3;
    return (struct places){0, e->nx + 1, 2 * e->nx + 1, 2 * e->nx + 2, s, s + 1, s + 2};
}

static bool is_position(const struct gait_endpoint *e, int state)
{
    return state == e->position || state == e->position + 1;
}

// Displacement over the period along (side = 0) or across (side = 1) the course.
static double displacement(const struct gait_endpoint *e, const double *in, int side)
{
    const struct places at = places_of(e);
    const double dx = in[at.xf + e->position] - in[at.x0 + e->position];
    const double dy = in[at.xf + e->position + 1] - in[at.x0 + e->position + 1];
    return side ? -dx * e->course[1] + dy * e->course[0] : dx * e->course[0] + dy * e->course[1];
}

// 1 / (L cos(delta/2)) of (33), or 1 / (2 sin(delta/2)) of (27), with two derivatives by delta.
struct reciprocal {
    double value, slope, curvature;
};

static struct reciprocal amplitude_reciprocal(const struct gait_endpoint *e, double delta)
{
    const double scale = e->revolute ? 2 : e->L, c = cos(delta / 2), s = sin(delta / 2);
    const double d = e->revolute ? s : c, slope = (e->revolute ? c : -s) / 2; // d'' = -d/4
    return (struct reciprocal){1 / (scale * d), -slope / (scale * d * d),
                               (0.25 / d + 2 * slope * slope / (d * d * d)) / scale};
}

moray_bounds gait_amplitude_bounds(const struct gait_endpoint *e, moray_bounds theta_max)
{
    if (e->revolute)
        return theta_max;
    return moray_between(sin(theta_max.lower), sin(theta_max.upper));
}

static void endpoint_value(void *self, const double *in, double *out)
{
    const struct gait_endpoint *e = self;
    const struct places at = places_of(e);
    *out++ = -displacement(e, in, 0) / in[at.tf];
    for (int r = 0; r < e->nx; r++)
        if (!is_position(e, r))
            *out++ = in[at.xf + r] - in[at.x0 + r];
    *out++ = displacement(e, in, 1);
    *out++ = in[at.omega] * in[at.tf];
    *out++ = in[at.a] * amplitude_reciprocal(e, in[at.delta]).value;
    if (e->power)
        *out++ = in[at.energy] / in[at.tf];
    if (e->rate)
        *out++ = in[at.a] * in[at.omega];
}

static void walk_endpoint_jacobian(const struct gait_endpoint *e, const double *in, triplets *out)
{
    const struct places at = places_of(e);
    const double T = in[at.tf], a = in[at.a];
    const struct reciprocal amplitude = amplitude_reciprocal(e, in[at.delta]);
    const double along = displacement(e, in, 0);
    int row = 0;
    for (int k = 0; k < 2; k++) {
        triplets_put(out, row, at.xf + e->position + k, -e->course[k] / T);
        triplets_put(out, row, at.x0 + e->position + k, e->course[k] / T);
    }
    triplets_put(out, row++, at.tf, along / (T * T));
    for (int r = 0; r < e->nx; r++)
        if (!is_position(e, r)) {
            triplets_put(out, row, at.xf + r, 1);
            triplets_put(out, row++, at.x0 + r, -1);
        }
    const double across[2] = {-e->course[1], e->course[0]};
    for (int k = 0; k < 2; k++) {
        triplets_put(out, row, at.xf + e->position + k, across[k]);
        triplets_put(out, row, at.x0 + e->position + k, -across[k]);
    }
    row++;
    triplets_put(out, row, at.omega, T);
    triplets_put(out, row++, at.tf, in[at.omega]);
    triplets_put(out, row, at.a, amplitude.value);
    triplets_put(out, row++, at.delta, a * amplitude.slope);
    if (e->power) {
        triplets_put(out, row, at.energy, 1 / T);
        triplets_put(out, row++, at.tf, -in[at.energy] / (T * T));
    }
    if (e->rate) {
        triplets_put(out, row, at.a, in[at.omega]);
        triplets_put(out, row, at.omega, a);
    }
}

static void walk_endpoint_hessian(const struct gait_endpoint *e, const double *in, const double *weight, triplets *out)
{
    const struct places at = places_of(e);
    const double T = in[at.tf], a = in[at.a];
    const struct reciprocal amplitude = amplitude_reciprocal(e, in[at.delta]);
    for (int k = 0; k < 2; k++) {
        triplets_put_lower(out, at.tf, at.xf + e->position + k, weight[0] * e->course[k] / (T * T));
        triplets_put_lower(out, at.tf, at.x0 + e->position + k, -weight[0] * e->course[k] / (T * T));
    }
    triplets_put(out, at.tf, at.tf, -2 * weight[0] * displacement(e, in, 0) / (T * T * T));
    const double *event =
        weight + 1 + (e->nx - 2) + 1; // past the objective, periodicity and the cross-course displacement
    triplets_put_lower(out, at.omega, at.tf, event[0]);
    triplets_put_lower(out, at.delta, at.a, event[1] * amplitude.slope);
    triplets_put(out, at.delta, at.delta, event[1] * a * amplitude.curvature);
    event += 2;
    if (e->power) {
        triplets_put_lower(out, at.energy, at.tf, -*event / (T * T));
        triplets_put(out, at.tf, at.tf, 2 * *event++ * in[at.energy] / (T * T * T));
    }
    if (e->rate)
        triplets_put_lower(out, at.omega, at.a, *event);
}

static void endpoint_jacobian(void *self, const double *in, double *values)
{
    struct gait_endpoint *e = self;
    triplets_start(&e->jac, values);
    walk_endpoint_jacobian(e, in, &e->jac);
}

static void endpoint_hessian(void *self, const double *in, const double *weight, double *values)
{
    struct gait_endpoint *e = self;
    triplets_start(&e->hess, values);
    walk_endpoint_hessian(e, in, weight, &e->hess);
}

moray_status gait_endpoint_map(moray_map *map, struct gait_endpoint *e)
{
    double zeros[1024] = {0};
    const int inputs = 2 * e->nx + 3 + 4;
    e->events = e->nx - 2 + 3 + e->power + e->rate;
    if (inputs > 1024)
        return moray_error(MORAY_INPUT, "links: %d states are more than this form is made for", e->nx);
    zeros[places_of(e).tf] = 1; // while recording, any point does
    triplets_record(&e->jac);
    walk_endpoint_jacobian(e, zeros, &e->jac);
    MORAY_TRY(triplets_close(&e->jac));
    triplets_record(&e->hess);
    walk_endpoint_hessian(e, zeros, zeros, &e->hess);
    MORAY_TRY(triplets_close(&e->hess));
    *map = (moray_map){.n_in = inputs,
                       .n_out = 1 + e->events,
                       .jac = e->jac.pattern,
                       .hess = e->hess.pattern,
                       .self = e,
                       .value = endpoint_value,
                       .jacobian = endpoint_jacobian,
                       .hessian = endpoint_hessian};
    return moray_ok();
}

void gait_endpoint_free(struct gait_endpoint *endpoint)
{
    triplets_free(&endpoint->jac);
    triplets_free(&endpoint->hess);
}
