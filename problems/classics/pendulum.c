// SPDX-License-Identifier: MIT
//
// Pendulum as a mass on a rod (Betts 2010, ex. 10.103, where the length is differentiated twice): the length itself is
// the algebraic equation, of index 3, and the tension l the algebraic variable. The least effort that brings it down to
// rest.
//
//   minimise integral of u^2
//   x' = v,  y' = w,  v' = -2 l x + u y,  w' = -g - 2 l y - u x,  x^2 + y^2 = 1,  g = 9.81
//   t in [0, 3],  (x, y, v, w)(0) = (1, 0, 0, 0),  x(3) = v(3) = 0,  |x, y, v, w| <= 5,  -1 <= l <= 15
//
// The book prints J = 12.8738850. In polar coordinates, where there is no constraint, the optimum is 12.8738889, too.
#include "classics.h"

static const double g = 9.81;

static void swing(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x = at->x[0], y = at->x[1], u = at->u[0], l = at->u[1];
    out->f[0] = at->x[2];
    out->f[1] = at->x[3];
    out->f[2] = -2 * l * x + u * y;
    out->f[3] = -g - 2 * l * y - u * x;
    out->c[0] = x * x + y * y;
    out->g[0] = u * u;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_bounds box = moray_between(-5, 5), none = moray_fixed(0), any = moray_free();
    const moray_phase_spec phase = {.name = "swing",
                                    .nx = 4,
                                    .nu = 2,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = swing,
                                    .tf = moray_fixed(3),
                                    .x = MORAY_BOUNDS(box, box, box, box),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), none, none, none),
                                    .xf = MORAY_BOUNDS(none, any, none, any),
                                    .u = MORAY_BOUNDS(any, moray_between(-1, 15)),
                                    .c = MORAY_BOUNDS(moray_fixed(1))};
    return classic_new(ocp, "pendulum", &phase, classic_first_integral, data);
}

const struct classic classic_pendulum = {.name = "pendulum",
                                         .title = "Pendulum of index 3",
                                         .source = "Betts 2010, ex. 10.103",
                                         .published = "12.8738850",
                                         .computed = "12.8738889",
                                         .build = build,
                                         .scheme = "hermite-simpson"};
