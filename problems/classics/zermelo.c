// SPDX-License-Identifier: MIT
//
// Zermelo's problem (Bryson and Ho 1975, sec. 2.7): the fastest way of a boat of speed V to the origin through a
// current that is given by a table. Lengths in h, times in h / V, speeds in V.
//
//   minimise tf,  x' = cos theta + u(x, y),  y' = sin theta,  from (3.66, -1.86) to (0, 0)
//   u = -y at the points of a table, through which a surface of splines goes: of a linear current, that current itself,
//   in which x has a part by rounding alone, so that
//   tf = tan theta_f - tan theta_0, where with a = theta_0, b = theta_f
//     -1.86 = sec a - sec b,  3.66 = (sec b (tan b - tan a) - tan a (sec b - sec a)
//                                     + ln((tan b + sec b) / (tan a + sec a))) / 2
//   Bryson and Ho print a = 105 deg, b = 240 deg, tf = 5.46.
#include <math.h>
#include <tgmath.h>

#include "classics.h"
#include "degree.h"
#include "moray/table.h"

enum { nx = 4, ny = 5 };
static const double x_of_table[nx] = {-4, 0, 3, 7}, y_of_table[ny] = {-4, -2, 0, 1, 3};
static const double u_of_table[nx][ny] = {{4, 2, 0, -1, -3}, {4, 2, 0, -1, -3}, {4, 2, 0, -1, -3}, {4, 2, 0, -1, -3}};
static moray_surface *current; // made once, for the life of the program

static void sail(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num theta = at->u[0];
    out->f[0] = moray_cos(theta) + moray_surface_at(current, at->x[0], at->x[1]);
    out->f[1] = moray_sin(theta);
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "crossing",
                                    .nx = 2,
                                    .nu = 1,
                                    .continuous = sail,
                                    .tf = moray_between(0.1, 100),
                                    .x0 = MORAY_BOUNDS(moray_fixed(3.66), moray_fixed(-1.86)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0))};
    if (!current)
        MORAY_TRY(
            moray_surface_new(&current, nx, x_of_table, ny, y_of_table, u_of_table[0], MORAY_NOT_A_KNOT, MORAY_LINEAR));
    return classic_new(ocp, "zermelo", &phase, classic_final_time, data);
}

// Straight to the origin, heading turned evenly.
static const moray_samples straight = {2, (const double[]){0, 5}, (const double[]){3.66, -1.86, 0, 0},
                                       (const double[]){90 * DEG, 250 * DEG}};

const struct classic classic_zermelo = {.name = "zermelo",
                                        .title = "Zermelo in a tabulated current",
                                        .source = "Bryson, Ho 1975, sec. 2.7",
                                        .published = "5.46",
                                        .closed_form = 5.4578652636,
                                        .build = build,
                                        .straight = &straight};
