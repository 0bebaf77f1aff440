// SPDX-License-Identifier: MIT
//
// Brachistochrone (Bryson and Ho 1975, sec. 2.7): the wire on which a bead slides fastest from rest.
//
//   minimise tf
//   x' = v sin u,  y' = v cos u,  v' = g cos u        (y downward, from (0, 0), at rest)
//
//   to (10, 5) with g = 9.80665, the (0, 10) to (10, 5) of dymos:  tf = 1.80160312
//   to (2, 2)  with g = 9.8, the one of PSOPT:                     tf = 0.82475914
//
// Closed form: the cycloid x = a (s - sin s), y = a (1 - cos s) through the end, reached after tf = s sqrt(a / g).
#include <math.h>
#include <tgmath.h>

#include "classics.h"

struct wire {
    double x, y, g;
};

static void slide(const moray_node *at, moray_rates *out, const void *data)
{
    const struct wire *wire = data;
    const moray_num v = at->x[2], u = at->u[0];
    out->f[0] = v * sin(u);
    out->f[1] = v * cos(u);
    out->f[2] = wire->g * cos(u);
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const struct wire *wire = data;
    const moray_phase_spec phase = {.name = "wire",
                                    .nx = 3,
                                    .nu = 1,
                                    .continuous = slide,
                                    .tf = moray_between(0, 10),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(wire->x), moray_fixed(wire->y), moray_free()),
                                    .u = MORAY_BOUNDS(moray_between(0, M_PI))};
    return classic_new(ocp, "brachistochrone", &phase, classic_final_time, data);
}

// Along the straight wire, whose speed follows from energy.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase;
    const struct wire *wire = data;
    const double length = hypot(wire->x, wire->y), v_end = sqrt(2 * wire->g * wire->y);
    x[0] = wire->x * tau;
    x[1] = wire->y * tau;
    x[2] = v_end * sqrt(tau);
    u[0] = atan2(wire->x, wire->y);
    return 2 * length / v_end * sqrt(tau);
}

const struct classic classic_brachistochrone = {.name = "brachistochrone",
                                                .title = "Brachistochrone to (10, 5)",
                                                .source = "Bryson and Ho 1975, 2.7; dymos",
                                                .published = "1.80160312",
                                                .closed_form = 1.8016031225,
                                                .build = build,
                                                .start = start,
                                                .data = &(const struct wire){10, 5, 9.80665}};

const struct classic classic_brachistochrone_near = {.name = "brachistochrone-near",
                                                     .title = "Brachistochrone to (2, 2)",
                                                     .source = "Bryson and Ho 1975, 2.7; PSOPT",
                                                     .published = "0.82475914",
                                                     .closed_form = 0.8247591432,
                                                     .build = build,
                                                     .start = start,
                                                     .data = &(const struct wire){2, 2, 9.8}};
