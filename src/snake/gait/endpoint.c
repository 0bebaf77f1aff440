// SPDX-License-Identifier: MIT
#include "snake/gait/endpoint.h"

#include <math.h>

// Of what the objective and the events other than periodicity are functions: displacement along and across the course,
// period, joint work, parameters in their order (phi_0 has a place and no user).
enum { ALONG, ACROSS, PERIOD, WORK, AMPLITUDE, OMEGA, DELTA, TAPER = DELTA + 2, FEATURES };

// A function of some features with its derivatives; second ones by pairs of features where they are not zero.
struct term {
    double value;
    int n, n_curved;
    int feature[3];
    double slope[3];
    int pair[6][2]; // indices into feature
    double curve[6];
};

enum { MOST_TERMS = 12, MOST_INPUTS = 4096 };

// ---- Features in the input [x0, t0, xf, tf, q, s] ------------------------------------------------------------------

// A feature is a sum of inputs with weights: returns how many.
static int inputs_of(const struct gait_endpoint *e, int feature, int at[4], double weight[4])
{
    const int xf = e->nx + 1, tf = 2 * e->nx + 1, s = tf + 2;
    if (feature == ALONG || feature == ACROSS) {
        for (int k = 0; k < 2; k++) {
            const double w = feature == ALONG ? e->course[k] : k == 0 ? -e->course[1] : e->course[0];
            at[2 * k] = xf + e->position + k, weight[2 * k] = w;
            at[2 * k + 1] = e->position + k, weight[2 * k + 1] = -w;
        }
        return 4;
    }
    at[0] = feature == PERIOD ? tf : feature == WORK ? tf + 1 : e->series ? s : s + feature - AMPLITUDE;
    weight[0] = 1;
    return 1;
}

static void features_of(const struct gait_endpoint *e, const double *in, double value[FEATURES])
{
    int at[4];
    double weight[4];
    for (int f = 0; f < FEATURES; f++) {
        const int n = inputs_of(e, f, at, weight);
        value[f] = 0;
        for (int i = 0; i < n; i++)
            value[f] += weight[i] * in[at[i]];
    }
}

// ---- Terms ---------------------------------------------------------------------------------------------------------

static struct term linear(const double *value, int feature)
{
    return (struct term){.value = value[feature], .n = 1, .feature = {feature}, .slope = {1}};
}

static struct term product(const double *value, int one, int other)
{
    return (struct term){.value = value[one] * value[other],
                         .n = 2,
                         .feature = {one, other},
                         .slope = {value[other], value[one]},
                         .n_curved = 1,
                         .pair = {{0, 1}},
                         .curve = {1}};
}

// sign * over / under
static struct term ratio(const double *value, double sign, int over, int under)
{
    const double a = value[over], b = value[under];
    return (struct term){.value = sign * a / b,
                         .n = 2,
                         .feature = {over, under},
                         .slope = {sign / b, -sign * a / (b * b)},
                         .n_curved = 2,
                         .pair = {{0, 1}, {1, 1}},
                         .curve = {-sign / (b * b), 2 * sign * a / (b * b * b)}};
}

// A function of delta with two derivatives.
struct curve {
    double value, slope, curvature;
};

// 1 / (L cos(delta/2)) of (33), or 1 / (2 sin(delta/2)) of (27)
static struct curve amplitude_reciprocal(const struct gait_endpoint *e, double delta)
{
    const double scale = e->revolute ? 2 : e->L, c = cos(delta / 2), s = sin(delta / 2);
    const double d = e->revolute ? s : c, slope = (e->revolute ? c : -s) / 2; // d'' = -d/4
    return (struct curve){1 / (scale * d), -slope / (scale * d * d),
                          (0.25 / d + 2 * slope * slope / (d * d * d)) / scale};
}

static struct term link_angle(const struct gait_endpoint *e, const double *value)
{
    const struct curve r = amplitude_reciprocal(e, value[DELTA]);
    const double a = value[AMPLITUDE];
    return (struct term){.value = a * r.value,
                         .n = 2,
                         .feature = {AMPLITUDE, DELTA},
                         .slope = {r.value, a * r.slope},
                         .n_curved = 2,
                         .pair = {{0, 1}, {1, 1}},
                         .curve = {r.slope, a * r.curvature}};
}

// cot(delta/2) / (2 sin(delta/2) (N-2)) or tan(delta/2) / (L cos(delta/2) (N-2)), what a taper adds across
static struct curve across_taper(const struct gait_endpoint *e, double delta)
{
    const double k = 1 / ((e->revolute ? 2 : e->L) * (e->links - 2)), c = cos(delta / 2), s = sin(delta / 2);
    const double d = e->revolute ? s : c, n = e->revolute ? c : s, sign = e->revolute ? -1 : 1;
    return (struct curve){k * n / (d * d), sign * k * (1 + n * n) / (2 * d * d * d),
                          k * n * (5 + n * n) / (4 * d * d * d * d)};
}

// Square of the link-angle amplitude at the head (side 1) or the tail (-1): a^2 (r^2 g^2 + p^2 taper^2), where r is
// amplitude_reciprocal, p across_taper and g = 1 + side taper (N-1)/(N-2).
static struct term end_link_angle(const struct gait_endpoint *e, const double *value, double side)
{
    const struct curve r = amplitude_reciprocal(e, value[DELTA]), p = across_taper(e, value[DELTA]);
    const double a = value[AMPLITUDE], taper = value[TAPER], slope = side * (e->links - 1) / (e->links - 2);
    const double g = 1 + slope * taper, g2 = g * g, t2 = taper * taper;
    const double sum = r.value * r.value * g2 + p.value * p.value * t2;
    const double by_delta = 2 * (r.value * r.slope * g2 + p.value * p.slope * t2);
    const double by_taper = 2 * (r.value * r.value * g * slope + p.value * p.value * taper);
    return (struct term){.value = a * a * sum,
                         .n = 3,
                         .feature = {AMPLITUDE, DELTA, TAPER},
                         .slope = {2 * a * sum, a * a * by_delta, a * a * by_taper},
                         .n_curved = 6,
                         .pair = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}},
                         .curve = {2 * sum, 2 * a * by_delta, 2 * a * by_taper,
                                   2 * a * a *
                                       ((r.slope * r.slope + r.value * r.curvature) * g2 +
                                        (p.slope * p.slope + p.value * p.curvature) * t2),
                                   4 * a * a * (r.value * r.slope * g * slope + p.value * p.slope * taper),
                                   2 * a * a * (r.value * r.value * slope * slope + p.value * p.value)}};
}

// Rate amplitude of the last (side 1) or the first joint (-1).
static struct term end_rate(const double *value, double side)
{
    const double a = value[AMPLITUDE], omega = value[OMEGA], g = 1 + side * value[TAPER];
    return (struct term){.value = a * omega * g,
                         .n = 3,
                         .feature = {AMPLITUDE, OMEGA, TAPER},
                         .slope = {omega * g, a * g, side * a * omega},
                         .n_curved = 3,
                         .pair = {{0, 1}, {0, 2}, {1, 2}},
                         .curve = {g, side * omega, side * a}};
}

moray_bounds moray_gait_amplitude_bounds(const struct gait_endpoint *e, moray_bounds theta_max)
{
    if (e->revolute)
        return theta_max;
    return moray_between(sin(theta_max.lower), sin(theta_max.upper));
}

// The objective, then the events behind periodicity in their order; returns how many.
static int terms_of(const struct gait_endpoint *e, const double *in, struct term *term)
{
    double value[FEATURES];
    int n = 0;
    features_of(e, in, value);
    term[n++] = e->goal == MORAY_GAIT_FASTEST ? ratio(value, -1, ALONG, PERIOD) : ratio(value, 1, WORK, ALONG);
    term[n++] = linear(value, ACROSS);
    term[n++] = product(value, OMEGA, PERIOD);
    if (!e->series)
        term[n++] = link_angle(e, value);
    if (e->head)
        term[n++] = end_link_angle(e, value, 1);
    if (e->tail)
        term[n++] = end_link_angle(e, value, -1);
    if (e->power)
        term[n++] = ratio(value, 1, WORK, PERIOD);
    if (e->rate && (e->head || !e->tail))
        term[n++] = e->head ? end_rate(value, 1) : product(value, AMPLITUDE, OMEGA);
    if (e->rate && e->tail)
        term[n++] = end_rate(value, -1);
    if (e->speed)
        term[n++] = ratio(value, 1, ALONG, PERIOD);
    return n;
}

// ---- The map -------------------------------------------------------------------------------------------------------

static bool is_position(const struct gait_endpoint *e, int state)
{
    return state == e->position || state == e->position + 1;
}

// Output of a term: the rows of periodicity stand between the objective and the others.
static int row_of(const struct gait_endpoint *e, int term)
{
    return term == 0 ? 0 : e->nx - 2 + term;
}

static void endpoint_value(void *self, const double *in, double *out)
{
    const struct gait_endpoint *e = self;
    struct term term[MOST_TERMS];
    const int n = terms_of(e, in, term);
    for (int k = 0; k < n; k++)
        out[row_of(e, k)] = term[k].value;
    for (int r = 0, row = 1; r < e->nx; r++)
        if (!is_position(e, r))
            out[row++] = in[e->nx + 1 + r] - in[r];
}

static void walk_endpoint_jacobian(const struct gait_endpoint *e, const double *in, triplets *out)
{
    struct term term[MOST_TERMS];
    const int n = terms_of(e, in, term);
    for (int k = 0; k < n; k++)
        for (int i = 0; i < term[k].n; i++) {
            int at[4];
            double weight[4];
            const int inputs = inputs_of(e, term[k].feature[i], at, weight);
            for (int j = 0; j < inputs; j++)
                triplets_put(out, row_of(e, k), at[j], term[k].slope[i] * weight[j]);
        }
    for (int r = 0, row = 1; r < e->nx; r++)
        if (!is_position(e, r)) {
            triplets_put(out, row, e->nx + 1 + r, 1);
            triplets_put(out, row++, r, -1);
        }
}

// curve d(one) d(other), and the same with the two exchanged: of a feature with itself, each pair of inputs once.
static void put_curve(const struct gait_endpoint *e, int one, int other, double curve, triplets *out)
{
    int at[2][4];
    double weight[2][4];
    const int n = inputs_of(e, one, at[0], weight[0]), m = inputs_of(e, other, at[1], weight[1]);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < (one == other ? i + 1 : m); j++)
            triplets_put_lower(out, at[0][i], at[1][j], curve * weight[0][i] * weight[1][j]);
}

static void walk_endpoint_hessian(const struct gait_endpoint *e, const double *in, const double *weight, triplets *out)
{
    struct term term[MOST_TERMS];
    const int n = terms_of(e, in, term);
    for (int k = 0; k < n; k++)
        for (int i = 0; i < term[k].n_curved; i++)
            put_curve(e, term[k].feature[term[k].pair[i][0]], term[k].feature[term[k].pair[i][1]],
                      weight[row_of(e, k)] * term[k].curve[i], out);
}

static void endpoint_jacobian(void *self, const double *in, double *values)
{
    struct gait_endpoint *e = self;
    moray_triplets_start(&e->jac, values);
    walk_endpoint_jacobian(e, in, &e->jac);
}

static void endpoint_hessian(void *self, const double *in, const double *weight, double *values)
{
    struct gait_endpoint *e = self;
    moray_triplets_start(&e->hess, values);
    walk_endpoint_hessian(e, in, weight, &e->hess);
}

moray_status moray_gait_endpoint_map(moray_map *map, struct gait_endpoint *e)
{
    double zeros[MOST_INPUTS] = {0}; // while recording, any point does
    struct term term[MOST_TERMS];
    const int inputs = 2 * e->nx + 3 + (e->series ? e->series : MORAY_GAIT_PARAMETERS);
    if (inputs > MOST_INPUTS)
        return moray_error(MORAY_INPUT, "links: %d inputs are more than this form is made for", inputs);
    e->events = e->nx - 2 + terms_of(e, zeros, term) - 1;
    e->power_event = e->nx - 2 + (e->series ? 2 : 3) + e->head + e->tail;
    moray_triplets_record(&e->jac);
    walk_endpoint_jacobian(e, zeros, &e->jac);
    MORAY_TRY(moray_triplets_close(&e->jac));
    moray_triplets_record(&e->hess);
    walk_endpoint_hessian(e, zeros, zeros, &e->hess);
    MORAY_TRY(moray_triplets_close(&e->hess));
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

void moray_gait_endpoint_free(struct gait_endpoint *endpoint)
{
    moray_triplets_free(&endpoint->jac);
    moray_triplets_free(&endpoint->hess);
}
