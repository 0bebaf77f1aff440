// SPDX-License-Identifier: MIT
//
// Minimum time to climb of a supersonic aircraft (Bryson, Desai and Hoffman 1969; GPOPS; PSOPT),
// with its lift, drag and thrust tables splined.
//
//   minimise tf
//   h' = v sin gamma,  v' = (T cos alpha - D) / m - mu / r^2 sin gamma
//   gamma' = (T sin alpha + L) / (m v) + cos gamma (v / r - mu / (v r^2)),  w' = -T / Isp,  m = w / g0, r = Re + h
//   L = c_La(M) alpha S rho v^2 / 2,  D = (c_D0(M) + eta(M) c_La(M) alpha^2) S rho v^2 / 2,  T(M, h),  |alpha| <= 20
//   deg (0 ft, 424.26 ft/s, 0, 42000 lb) to (65600 ft, 968.148 ft/s, 0)
//
// The tables are Bryson's as GPOPS and PSOPT give them, splined naturally; the atmosphere is the 1976 one.
// tf = 321.1 s (PSOPT: 321.1089; with its first releases' atmosphere, which falls colder above 11 km too, 318.8). dymos
// gives 321.0 for a smooth fit to other tables.
#include <math.h>
#include <tgmath.h>

#include "degree.h"
#include "classics.h"
#include "spline.h"

static const double S = 530, Re = 20902900, Isp = 1600, mu = 0.14076539e17, g0 = 32.174; // feet, pounds, seconds
static const double foot = 0.3048;

static const double mach[] = {0, 0.4, 0.8, 0.9, 1, 1.2, 1.4, 1.6, 1.8}; // of the aerodynamic tables
static const double c_La[] = {3.44, 3.44, 3.44, 3.58, 4.44, 3.44, 3.01, 2.86, 2.44};
static const double c_D0[] = {0.013, 0.013, 0.013, 0.014, 0.031, 0.041, 0.039, 0.036, 0.035};
static const double eta[] = {0.54, 0.54, 0.54, 0.75, 0.79, 0.78, 0.89, 0.93, 0.93};

static const double thrust_mach[] = {0, 0.2, 0.4, 0.6, 0.8, 1, 1.2, 1.4, 1.6, 1.8};
static const double altitude[] = {0, 5e3, 10e3, 15e3, 20e3, 25e3, 30e3, 40e3, 50e3, 70e3}; // [ft]
static const double thrust[10][10] = {                                                     // [lb], a row a Mach number
    {24200, 24000, 20300, 17300, 14500, 12200, 10200, 5700, 3400, 100},
    {28000, 24600, 21100, 18100, 15200, 12800, 10700, 6500, 3900, 200},
    {28300, 25200, 21900, 18700, 15900, 13400, 11200, 7300, 4400, 400},
    {30800, 27200, 23800, 20500, 17300, 14700, 12300, 8100, 4900, 800},
    {34500, 30300, 26600, 23200, 19800, 16800, 14100, 9400, 5600, 1100},
    {37900, 34300, 30400, 26800, 23300, 19800, 16800, 11200, 6800, 1400},
    {36100, 38000, 34900, 31300, 27300, 23600, 20100, 13400, 8300, 1700},
    {34300, 36600, 38500, 36100, 31600, 28100, 24200, 16200, 10000, 2200},
    {32500, 35200, 42100, 38700, 35700, 32000, 28100, 19300, 11900, 2900},
    {30700, 33800, 45700, 41300, 39800, 34600, 31100, 21700, 13300, 3100}};

struct tables {
    spline mach, thrust_mach, altitude;
};
static struct tables splines; // of the constants above; every build makes them the same

// Density [slug/ft^3] and speed of sound [ft/s] of the 1976 standard atmosphere: 6.5 K/km up to 11 km, constant above.
static void atmosphere(moray_num h, moray_num *rho, moray_num *sound)
{
    const moray_num km = h * foot / 1000, geopotential = km * 6369 / (km + 6369);
    moray_num T = 288.15 - 6.5 * geopotential, pressure = moray_pow(288.15 / T, 34.163195 / -6.5);
    if (creal(geopotential) > 11) {
        T = 216.65;
        pressure = 0.2233611 * moray_exp(-34.163195 * (geopotential - 11) / 216.65);
    }
    *rho = 1.22521 * pressure * 288.15 / T * 0.062427960841 / 32.174049;
    *sound = 20.0468 * moray_sqrt(T) / foot;
}

static moray_num splined(const moray_num *weight, int n, const double *value)
{
    moray_num sum = 0;
    for (int i = 0; i < n; i++)
        sum += weight[i] * value[i];
    return sum;
}

static void fly(const moray_node *at, moray_rates *out, const void *data)
{
    const struct tables *tables = data;
    const moray_num h = at->x[0], v = at->x[1], gamma = at->x[2], w = at->x[3], alpha = at->u[0], r = Re + h;
    moray_num rho, sound, by_mach[10], by_altitude[10], T = 0;
    atmosphere(h, &rho, &sound);
    spline_weights(&tables->thrust_mach, v / sound, by_mach);
    spline_weights(&tables->altitude, h, by_altitude);
    for (int i = 0; i < 10; i++)
        T += by_mach[i] * splined(by_altitude, 10, thrust[i]);
    spline_weights(&tables->mach, v / sound, by_mach);
    const moray_num slope = splined(by_mach, 9, c_La), pressure = S * rho * v * v / 2, m = w / g0;
    const moray_num L = slope * alpha * pressure;
    const moray_num D = (splined(by_mach, 9, c_D0) + splined(by_mach, 9, eta) * slope * alpha * alpha) * pressure;
    out->f[0] = v * moray_sin(gamma);
    out->f[1] = (T * moray_cos(alpha) - D) / m - mu / (r * r) * moray_sin(gamma);
    out->f[2] = (T * moray_sin(alpha) + L) / (m * v) + moray_cos(gamma) * (v / r - mu / (v * r * r));
    out->f[3] = -T / Isp;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    (void)data;
    struct tables *tables = &splines;
    spline_new(&tables->mach, 9, mach);
    spline_new(&tables->thrust_mach, 10, thrust_mach);
    spline_new(&tables->altitude, 10, altitude);
    const moray_phase_spec phase = {
        .name = "climb",
        .nx = 4,
        .nu = 1,
        .continuous = fly,
        .tf = moray_between(200, 500),
        .x = MORAY_BOUNDS(moray_between(0, 69000), moray_between(1, 2000), moray_between(-89 * DEG, 89 * DEG),
                          moray_between(10000, 45000)),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(424.26), moray_fixed(0), moray_fixed(42000)),
        .xf = MORAY_BOUNDS(moray_fixed(65600), moray_fixed(968.148), moray_fixed(0), moray_free()),
        .u = MORAY_BOUNDS(moray_between(-20 * DEG, 20 * DEG))};
    return classic_new(ocp, "climb", &phase, classic_final_time, tables);
}

// PSOPT: straight, a fifth of the weight burnt, 500 s.
static const moray_samples start = {2, (const double[]){0, 500},
                                    (const double[]){0, 424.26, 0, 42000, 65600, 968.148, 0, 0.8 * 42000},
                                    (const double[]){0, 0}};

const struct classic classic_climb = {.name = "climb",
                                      .title = "Minimum time to climb",
                                      .source = "Bryson, Desai and Hoffman 1969; PSOPT",
                                      .published = "321.1",
                                      .build = build,
                                      .straight = &start,
                                      .intervals = 30};
