// SPDX-License-Identifier: MIT
//
// Balanced field length (dymos; after Raymer): the runway on which an airliner that loses an engine at the decision
// speed either stops or takes off and clears 35 ft at its end. Five phases, a tree: after the first the take-off is
// rejected, or goes on with one engine: to rotation, rotating, climbing.
//
//   minimise r(tf) of the rejected take-off = r(tf) of the climb
//   ground:  r' = v,  m v' = T cos a - D - F mu,  F = m g - L cos a - T sin a
//   climb:   r' = v cos c,  h' = v sin c,  m v' = T cos a - D - m g sin c,  m v c' = T sin a + L - m g cos c
//   L = q S CL,  D = q S (CD0 + K CL^2),  q = rho v^2 / 2,  CL = CL0 + a / a_max (CL_max - CL0)
//   K = K0 33 k / (1 + 33 k),  k = ((h + h_w) / (b / 2))^1.5,  K0 = 1 / (pi AR e),  v_stall^2 = 2 m g / (rho S CL_max)
//   a = 0 up to rotation, from where it rises evenly to at most 10 deg until F = 0, in 1 s to 5 s;
//   v >= 1.2 v_stall at rotation;  -10 <= a <= 15 deg, 0 <= c <= 5 deg in the climb, which ends at 35 ft with c = 5 deg
//   and v >= 1.25 v_stall                                                                          r(tf) = 2197 m
// The climb's first angle of attack is left free: nothing depends on a control at one point.
#include <math.h>
#include <tgmath.h>

#include "classics.h"
#include "degree.h"

static const double lbm = 0.45359237, lbf = 4.4482216152605, ft = 0.3048, kn = 1852. / 3600;
static const double g = 9.80665, rho = 1.225, S = 124.7, CD0 = 0.03, CL0 = 0.5, CL_max = 2, a_max = 10 * DEG;
static const double h_w = 1, AR = 9.45, efficiency = 0.801, span = 35.7, m = 174200 * lbm, thrust = 27000 * lbf;
enum { roll, reject, go, rotate, climb, phases };

// Of the aeroplane at speed v, height h and angle of attack a.
struct forces {
    moray_num lift, drag;
};

static struct forces forces(moray_num v, moray_num h, moray_num a)
{
    const moray_num CL = CL0 + a / a_max * (CL_max - CL0), k = 33 * moray_pow((h + h_w) / (span / 2), 1.5);
    const moray_num K = k / (1 + k) / (M_PI * AR * efficiency), q = rho * v * v / 2;
    return (struct forces){q * S * CL, q * S * (CD0 + K * CL * CL)};
}

static moray_num load_on_wheels(moray_num v, moray_num a, double T)
{
    return m * g - forces(v, 0, a).lift * moray_cos(a) - T * moray_sin(a);
}

static void on_ground(const moray_node *at, moray_rates *out, moray_num a, double T, double friction)
{
    const moray_num v = at->x[1];
    out->f[0] = v;
    out->f[1] = (T * moray_cos(a) - forces(v, 0, a).drag - load_on_wheels(v, a, T) * friction) / m;
}

static void run_up(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    on_ground(at, out, 0, 2 * thrust, 0.03);
}

static void brake(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    on_ground(at, out, 0, 0, 0.3);
}

static void go_on(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    on_ground(at, out, 0, thrust, 0.03);
}

static void turn_up(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    on_ground(at, out, at->x[2], thrust, 0.03);
    out->f[2] = at->s[0];
}

static void climb_out(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num h = at->x[1], v = at->x[2], c = at->x[3], a = at->u[0];
    const struct forces force = forces(v, h, a);
    out->f[0] = v * moray_cos(c);
    out->f[1] = v * moray_sin(c);
    out->f[2] = (thrust * moray_cos(a) - force.drag) / m - g * moray_sin(c);
    out->f[3] = (thrust * moray_sin(a) + force.lift) / (m * v) - g / v * moray_cos(c);
}

// Phase `next` begins when `before` ends, with r and v where they stand in its states.
static moray_num *follow(moray_num *e, const moray_phase_ends *before, const moray_phase_ends *next, int v)
{
    *e++ = next->t0 - before->tf;
    *e++ = next->x0[0] - before->xf[0];
    *e++ = next->x0[v] - before->xf[1];
    return e;
}

static void field(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *p = at->phase;
    const double stall = 2 * m * g / (rho * S * CL_max); // v_stall^2
    moray_num *e = follow(out->e, &p[roll], &p[reject], 1);
    e = follow(e, &p[roll], &p[go], 1);
    e = follow(e, &p[go], &p[rotate], 1);
    e = follow(e, &p[rotate], &p[climb], 2);
    *e++ = p[climb].xf[0] - p[reject].xf[0];
    *e++ = load_on_wheels(p[rotate].xf[1], p[rotate].xf[2], thrust);
    *e++ = p[go].xf[1] / sqrt(stall);
    *e++ = p[climb].xf[2] / sqrt(stall);
    for (int i = roll; i < phases; i++)
        *e++ = p[i].tf - p[i].t0;
    out->objective = p[reject].xf[0];
}

#define GROUND(name_, function) .name = name_, .nx = 2, .continuous = function, .x = MORAY_BOUNDS(far, far)
static moray_status build(moray_ocp **ocp, const void *data)
{
    (void)data;
    const moray_bounds zero = moray_fixed(0), far = moray_at_least(0), any = moray_free(), later = moray_at_least(0);
    const moray_phase_spec phase[phases] = {
        [roll] = {GROUND("brake release to v1", run_up), .tf = later, .x0 = MORAY_BOUNDS(zero, zero)},
        [reject] = {GROUND("rejected", brake), .t0 = later, .tf = later, .xf = MORAY_BOUNDS(any, zero)},
        [go] = {GROUND("v1 to rotation", go_on), .t0 = later, .tf = later},
        [rotate] = {.name = "rotation",
                    .nx = 3,
                    .continuous = turn_up,
                    .t0 = later,
                    .tf = later,
                    .x = MORAY_BOUNDS(far, far, moray_between(0, 10 * DEG)),
                    .x0 = MORAY_BOUNDS(any, any, zero)},
        [climb] = {.name = "climb",
                   .nx = 4,
                   .nu = 1,
                   .continuous = climb_out,
                   .t0 = later,
                   .tf = later,
                   .x = MORAY_BOUNDS(far, far, far, moray_between(0, 5 * DEG)),
                   .x0 = MORAY_BOUNDS(any, zero, any, zero),
                   .xf = MORAY_BOUNDS(any, moray_fixed(35 * ft), any, moray_fixed(5 * DEG)),
                   .u = MORAY_BOUNDS(moray_between(-10 * DEG, 15 * DEG))}};
    const moray_bounds long_ = moray_between(1, 1000);
    const moray_bounds e[] = {zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              zero,
                              moray_at_least(1.2),
                              moray_at_least(1.25),
                              long_,
                              long_,
                              long_,
                              moray_between(1, 5),
                              moray_between(1, 100)};
    const int ne = sizeof e / sizeof *e;
    return moray_ocp_new(ocp, &(moray_ocp_spec){.name = "balanced field",
                                                .phases = phases,
                                                .phase = phase,
                                                .endpoint = field,
                                                .ns = 1,
                                                .s = MORAY_BOUNDS(moray_between(0, 10 * DEG)),
                                                .ne = ne,
                                                .e = {e, ne}});
}

// dymos: straight, phase by phase.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    static const struct {
        double begin, duration, r[2], v[2];
    } guess[phases] = {[roll] = {0, 35, {0, 2500}, {1e-4, 100}},
                       [reject] = {35, 1, {2500, 5000}, {110, 1e-4}},
                       [go] = {35, 35, {2500, 300}, {100, 110}},
                       [rotate] = {35, 5, {1750, 1800}, {80, 85}},
                       [climb] = {30, 20, {5000 * ft, 5500 * ft}, {160 * kn, 170 * kn}}};
    (void)data;
    x[0] = guess[phase].r[0] + tau * (guess[phase].r[1] - guess[phase].r[0]);
    x[phase == climb ? 2 : 1] = guess[phase].v[0] + tau * (guess[phase].v[1] - guess[phase].v[0]);
    if (phase == rotate)
        x[2] = 0;
    if (phase == climb) {
        x[1] = tau * 35 * ft;
        x[3] = tau * 5 * DEG;
        u[0] = 5 * DEG;
    }
    return guess[phase].begin + tau * guess[phase].duration;
}

const struct classic classic_balanced_field = {.name = "balanced-field",
                                               .title = "Balanced field length",
                                               .source = "dymos",
                                               .published = "2197",
                                               .build = build,
                                               .start = start};
