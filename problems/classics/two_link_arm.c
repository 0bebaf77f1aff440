// SPDX-License-Identifier: MIT
//
// Two-link robotic arm (Luus 2000; PROPT): move it from rest to rest in minimum time. The torques are bang-bang.
//
//   minimise tf
//   x1' = (sin x3 (9/4 cos x3 x1^2 + 2 x2^2) + 4/3 (u1 - u2) - 3/2 cos x3 u2) / d
//   x2' = -(sin x3 (7/2 x1^2 + 9/4 cos x3 x2^2) - 7/3 u2 + 3/2 cos x3 (u1 - u2)) / d
//   x3' = x2 - x1,  x4' = x1,  d = 31/36 + 9/4 sin^2 x3,  |u| <= 1
//   (0, 0, 0.5, 0) to (0, 0, 0.5, 0.522)
//
// PSOPT prints tf = 2.988662 on 40 Legendre nodes, whose polynomial smears the switches; its notes give 2.983629 on 80
// nodes and 2.983021 by shooting, and say that neither has converged. Refined meshes of every family give 2.982280.
#include <math.h>
#include <tgmath.h>

#include "classics.h"

static void swing(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x1 = at->x[0], x2 = at->x[1], x3 = at->x[2], u1 = at->u[0], u2 = at->u[1];
    const moray_num s = moray_sin(x3), c = moray_cos(x3), d = 31. / 36 + 9. / 4 * s * s;
    out->f[0] = (s * (9. / 4 * c * x1 * x1 + 2 * x2 * x2) + 4. / 3 * (u1 - u2) - 3. / 2 * c * u2) / d;
    out->f[1] = -(s * (7. / 2 * x1 * x1 + 9. / 4 * c * x2 * x2) - 7. / 3 * u2 + 3. / 2 * c * (u1 - u2)) / d;
    out->f[2] = x2 - x1;
    out->f[3] = x1;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {
        .name = "swing",
        .nx = 4,
        .nu = 2,
        .continuous = swing,
        .tf = moray_between(1, 10),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(0.5), moray_fixed(0)),
        .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(0.5), moray_fixed(0.522)),
        .u = MORAY_BOUNDS(moray_between(-1, 1), moray_between(-1, 1))};
    return classic_new(ocp, "two-link arm", &phase, classic_final_time, data);
}

const struct classic classic_two_link_arm = {.name = "two-link-arm",
                                             .title = "Two-link arm, minimum time",
                                             .source = "Luus 2000; PROPT; PSOPT",
                                             .published = "2.988662",
                                             .computed = "2.98228",
                                             .build = build};
