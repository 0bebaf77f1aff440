// SPDX-License-Identifier: MIT
//
// Purcell's three-link swimmer (Purcell 1977; Giraldi, Martinon and Zoppello 2013; BOCOP): how far it swims in 25 s
// where nothing has inertia.
//
//   maximise x(25)
//   beta1' = u1,  beta3' = u2,  |u| <= 1,  |beta| <= 1.5
//   x', y', theta' such that no force and no torque act on the whole: on a piece of a link moving at velocity v acts
//   the force -xi (v e) e - eta (v n) n with e along the link, n across it, eta = 2 xi links of lengths 1, 2, 1 at
//   angles theta + beta1, theta, theta + beta3 to the x axis; (x, y) the middle of the body x(0) = y(0) = 0, y(25) = 0,
//   -3.15 <= theta <= 3.15, theta(0) <= 0, beta1(0) >= 0
//
// BOCOP's example; CTDirect's reference value is 0.984273. There are many local maxima, and from the constant start the
// scheme, the mesh and the solver decide which is found: coarse meshes end between 0.84 and 1.00; gauss3, refined from
// 60 intervals, at 0.991877.
#include <math.h>
#include <tgmath.h>

#include "classics.h"
#include "linear.h"

static const double xi = 1, eta = 2;

// A piece of a link from `root` on the body in the direction sign * e, turning against the body at `rate`.
struct piece {
    double root[2], sign;
    moray_num e[2], rate;
};

// Adds the force and the torque about the middle of the body, which moves at V = (x', y', theta') in its own frame.
static void add_drag(const struct piece *piece, const moray_num *V, moray_num rate, moray_num *drag)
{
    const moray_num *e = piece->e, n[] = {-e[1], e[0]};
    const moray_num v[] = {V[0] - V[2] * piece->root[1], V[1] + V[2] * piece->root[0]}; // of the root
    const moray_num turn = piece->sign * (V[2] + rate), across = v[0] * n[0] + v[1] * n[1];
    const moray_num along = -xi * (v[0] * e[0] + v[1] * e[1]),
                    side = -eta * (across + turn / 2); // integrals over length 1
    const moray_num F[] = {along * e[0] + side * n[0], along * e[1] + side * n[1]};
    drag[0] += F[0];
    drag[1] += F[1];
    drag[2] += piece->root[0] * F[1] - piece->root[1] * F[0] - piece->sign * eta * (across / 2 + turn / 3);
}

static void swim(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num c = moray_cos(at->x[2]), s = moray_sin(at->x[2]);
    const struct piece pieces[] = {{{-1, 0}, -1, {moray_cos(at->x[3]), moray_sin(at->x[3])}, at->u[0]},
                                   {{0, 0}, -1, {1, 0}, 0},
                                   {{0, 0}, 1, {1, 0}, 0},
                                   {{1, 0}, 1, {moray_cos(at->x[4]), moray_sin(at->x[4])}, at->u[1]}};
    const moray_num still[3] = {0};
    moray_num resistance[3][3] = {{0}}, V[3] = {0};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 3; j++) // symmetric: rows are columns
            add_drag(&pieces[i], (const moray_num[]){j == 0, j == 1, j == 2}, 0, resistance[j]);
        moray_num drag[3] = {0};
        add_drag(&pieces[i], still, pieces[i].rate, drag);
        for (int j = 0; j < 3; j++)
            V[j] -= drag[j];
    }
    linear_solve3(resistance, V);
    out->f[0] = V[0] * c - V[1] * s;
    out->f[1] = V[0] * s + V[1] * c;
    out->f[2] = V[2];
    out->f[3] = at->u[0];
    out->f[4] = at->u[1];
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_bounds any = moray_free(), turn = moray_between(-3.15, 3.15), bend = moray_between(-1.5, 1.5);
    const moray_phase_spec phase = {
        .name = "swim",
        .nx = 5,
        .nu = 2,
        .continuous = swim,
        .tf = moray_fixed(25),
        .x = MORAY_BOUNDS(any, any, turn, bend, bend),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_at_most(0), moray_at_least(0), any),
        .xf = MORAY_BOUNDS(any, moray_fixed(0), any, any, any),
        .u = MORAY_BOUNDS(moray_between(-1, 1), moray_between(-1, 1))};
    return classic_new(ocp, "swimmer", &phase, classic_first_state, data);
}

// BOCOP and CTDirect: 0.1 everywhere.
static const moray_samples start = {2, (const double[]){0, 25},
                                    (const double[]){0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1},
                                    (const double[]){0.1, 0.1, 0.1, 0.1}};

const struct classic classic_swimmer = {.name = "swimmer",
                                        .title = "Three-link swimmer, 25 s",
                                        .source = "Giraldi, Martinon and Zoppello 2013; BOCOP",
                                        .published = "0.984273",
                                        .maximised = true,
                                        .build = build,
                                        .straight = &start,
                                        .intervals = 60,
                                        .tolerance = 1e-8};
