// SPDX-License-Identifier: MIT
//
// Multiple-stage launch vehicle (Benson 2004; GPOPS; PSOPT): the heaviest payload of a Delta III into a transfer orbit.
// Four phases: six boosters, three boosters, first stage alone, second stage, whose end is free.
//
//   maximise m(tf)
//   r' = v,  v' = -mu r / |r|^3 + (T u + D) / m,  m' = - propellant / burn time of what burns,  |u| = 1
//   D = -rho Cd A |w| w / 2,  w = v - Omega x r,  rho = rho0 exp(-(|r| - Re) / H)
//   from rest on the ground at 28.5 deg to a, e, i, Omega, omega of the orbit; the empty stages drop between phases
//
// PSOPT prints 7529.661 kg on 18 to 25 nodes a phase; the refined value is 7529.712, which SOCS and GPOPS-II print too.
#include <math.h>
#include <tgmath.h>

#include "degree.h"
#include "classics.h"

static const double mu = 3.986012e14, Re = 6378145, Omega = 7.29211585e-5;
static const double Cd = 0.5, A = 4 * M_PI, rho0 = 1.225, H = 7200;
static const double latitude = 28.5 * M_PI / 180;

struct engine {
    double mass, propellant, burn, thrust; // total mass [kg], propellant [kg], burn time [s], thrust [N]
};
static const struct engine booster = {19290, 17010, 75.2, 628500}, first = {104380, 95550, 261, 1083100},
                           second = {19300, 16820, 700, 110094};
static const double payload = 4164;
static const double begin[] = {0, 75.2, 150.4, 261, 961}; // of the phases; the last ends freely
static const int boosters[] = {6, 3, 0, 0};               // burning

static double rate(struct engine engine)
{
    return engine.propellant / engine.burn;
}

static double empty(struct engine engine)
{
    return engine.mass - engine.propellant;
}

// Mass at the beginning of a phase, and what is dropped at its end.
static double initial_mass(int phase)
{
    double m = 9 * booster.mass + first.mass + second.mass + payload;
    if (phase > 0)
        m -= 6 * booster.mass + rate(first) * begin[1];
    if (phase > 1)
        m -= 3 * booster.mass + rate(first) * (begin[2] - begin[1]);
    return phase > 2 ? second.mass + payload : m;
}

static double dropped(int phase)
{
    return phase == 2 ? empty(first) : boosters[phase] * empty(booster);
}

static double mass_rate(int phase)
{
    return phase == 3 ? rate(second) : boosters[phase] * rate(booster) + rate(first);
}

static double thrust(int phase)
{
    return phase == 3 ? second.thrust : boosters[phase] * booster.thrust + first.thrust;
}

static void ascend(const moray_node *at, moray_rates *out, int phase)
{
    const moray_num *r = at->x, *v = at->x + 3, *u = at->u, m = at->x[6];
    const moray_num distance = moray_sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    const moray_num w[] = {v[0] + Omega * r[1], v[1] - Omega * r[0], v[2]};
    const moray_num speed = moray_sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const moray_num drag = rho0 * moray_exp(-(distance - Re) / H) * Cd * A * speed / 2;
    for (int i = 0; i < 3; i++) {
        out->f[i] = v[i];
        out->f[3 + i] = -mu * r[i] / (distance * distance * distance) + (thrust(phase) * u[i] - drag * w[i]) / m;
    }
    out->f[6] = -mass_rate(phase);
    out->c[0] = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
}

#define STAGE(name, phase)                                                                                             \
    static void name(const moray_node *at, moray_rates *out, const void *data)                                         \
    {                                                                                                                  \
        (void)data;                                                                                                    \
        ascend(at, out, phase);                                                                                        \
    }
STAGE(six_boosters, 0)
STAGE(three_boosters, 1)
STAGE(first_stage, 2)
STAGE(second_stage, 3)

// Angle whose cosine is c, in the upper half of the circle or the lower as `side` tells.
static moray_num angle(moray_num c, moray_num side)
{
    return creal(side) < 0 ? 2 * M_PI - acos(c) : acos(c);
}

static moray_num dot(const moray_num *a, const moray_num *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// a, e, i, Omega, omega of the orbit through position r and velocity v.
static void elements(const moray_num *r, const moray_num *v, moray_num *e)
{
    const moray_num distance = moray_sqrt(dot(r, r)), energy = dot(v, v) / 2 - mu / distance;
    const moray_num h[] = {r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]};
    const moray_num n[] = {-h[1], h[0], 0}, length = moray_sqrt(dot(n, n));
    moray_num eccentric[3];
    for (int i = 0; i < 3; i++)
        eccentric[i] = ((dot(v, v) - mu / distance) * r[i] - dot(r, v) * v[i]) / mu;
    e[0] = -mu / (2 * energy);
    e[1] = moray_sqrt(dot(eccentric, eccentric));
    e[2] = acos(h[2] / moray_sqrt(dot(h, h)));
    e[3] = angle(n[0] / length, n[1]);
    e[4] = angle(dot(n, eccentric) / (length * e[1]), eccentric[2]);
}

static void orbit(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *end = &at->phase[3];
    moray_num *e = out->e;
    out->objective = -end->xf[6];
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < 7; i++)
            *e++ = at->phase[p + 1].x0[i] - at->phase[p].xf[i] + (i == 6 ? dropped(p) : 0);
    elements(end->xf, end->xf + 3, e);
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    (void)data;
    moray_continuous_fn *const stage[] = {six_boosters, three_boosters, first_stage, second_stage};
    const moray_bounds r = moray_between(-2 * Re, 2 * Re), v = moray_between(-10000, 10000);
    const moray_bounds_list u = MORAY_BOUNDS(moray_between(-1, 1), moray_between(-1, 1), moray_between(-1, 1)),
                            one = MORAY_BOUNDS(moray_fixed(1));
    static const char *const names[] = {"six boosters", "three boosters", "first stage", "second stage"};
    const double x = Re * cos(latitude), z = Re * sin(latitude);
    const moray_bounds ground[] = {moray_fixed(x),
                                   moray_fixed(0),
                                   moray_fixed(z),
                                   moray_fixed(0),
                                   moray_fixed(Omega * x),
                                   moray_fixed(0),
                                   moray_fixed(initial_mass(0))};
    moray_bounds states[4][7];
    moray_phase_spec phase[4];
    for (int p = 0; p < 4; p++) {
        for (int i = 0; i < 6; i++)
            states[p][i] = i < 3 ? r : v;
        states[p][6] = moray_between(payload, initial_mass(0));
        phase[p] = (moray_phase_spec){.name = names[p],
                                      .nx = 7,
                                      .nu = 3,
                                      .nc = 1,
                                      .continuous = stage[p],
                                      .t0 = moray_fixed(begin[p]),
                                      .tf = p == 3 ? moray_between(begin[3], begin[4]) : moray_fixed(begin[p + 1]),
                                      .x = {states[p], 7},
                                      .u = u,
                                      .c = one};
    }
    phase[0].x0 = (moray_bounds_list){ground, 7};
    moray_bounds e[26];
    for (int i = 0; i < 21; i++)
        e[i] = moray_fixed(0);
    const double target[] = {24361140, 0.7308, 28.5 * DEG, 269.8 * DEG, 130.5 * DEG};
    for (int i = 0; i < 5; i++)
        e[21 + i] = moray_fixed(target[i]);
    return moray_ocp_new(
        ocp,
        &(moray_ocp_spec){.name = "launch", .phases = 4, .phase = phase, .endpoint = orbit, .ne = 26, .e = {e, 26}});
}

// GPOPS: on the ground until the second stage, which is at the perigee of the orbit; thrust along x.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)data;
    const double a = 24361140, e = 0.7308, i = 28.5 * DEG, node = 269.8 * DEG, omega = 130.5 * DEG;
    const double end = phase == 3 ? payload : initial_mass(phase + 1) + dropped(phase);
    if (phase < 3) {
        x[0] = Re * cos(latitude);
        x[1] = 0;
        x[2] = Re * sin(latitude);
        x[3] = x[5] = 0;
        x[4] = Omega * x[0];
    } else {
        const double r = a * (1 - e), v = sqrt(mu / (a * (1 - e * e))) * (1 + e);
        x[0] = r * (cos(node) * cos(omega) - sin(node) * sin(omega) * cos(i));
        x[1] = r * (sin(node) * cos(omega) + cos(node) * sin(omega) * cos(i));
        x[2] = r * sin(omega) * sin(i);
        x[3] = v * (-cos(node) * sin(omega) - sin(node) * cos(omega) * cos(i));
        x[4] = v * (-sin(node) * sin(omega) + cos(node) * cos(omega) * cos(i));
        x[5] = v * cos(omega) * sin(i);
    }
    x[6] = (1 - tau) * initial_mass(phase) + tau * end;
    u[0] = 1;
    u[1] = u[2] = 0;
    return begin[phase] + tau * (begin[phase + 1] - begin[phase]);
}

const struct classic classic_launch = {.name = "launch",
                                       .title = "Multiple-stage launch vehicle",
                                       .source = "Benson 2004; GPOPS; PSOPT",
                                       .published = "7529.66",
                                       .computed = "7529.712",
                                       .maximised = true,
                                       .build = build,
                                       .start = start,
                                       .intervals = 5};
