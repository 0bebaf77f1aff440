// SPDX-License-Identifier: MIT
//
// What is the same along all directions is worked out once; then as many directions at a time as a register holds.
#include "snake/model/fp_tangent.h"

#include <stdint.h>
#include <string.h>
#include <tgmath.h>

#include "base/lanes.h"
#include "snake/model/fp_bends.h"

#define REAL double
#define TYPED(name) name##_d
#include "snake/model/fp_motor.inc"
#include "snake/model/fp_slopes.inc"
#undef REAL
#undef TYPED

// Along and across a link.
typedef struct local {
    double t, n;
} local;

// Of a link and the joint before it. a, xi, water: of the centre of mass, its virtual acceleration, the current; the
// rest is named as in fp_adjoint.inc, by_tt and bend being the derivatives of its slopes.
typedef struct known {
    double c, s, w, rel_t, rel_n, a_t, a_n, xi_t, xi_n, water_t, water_n, turned_on;
    double load_a, load_xi, both_t, by_theta_t, by_theta_n, on_v_t, on_v_n, by_tt;
    double by_uu, by_uv, by_vv; // of the weighted power and supply
    slopes_d by;
    fp_bends bend;
    fp_vector_d net;
    local by_xi, by_v, by_a;
    double inverse[3][3]; // of the balances; in the first link
} known;

static local turned_to(const known *at, fp_vector_d a)
{
    return (local){at->c * a.x + at->s * a.y, at->c * a.y - at->s * a.x};
}

// ---- Known at the point --------------------------------------------------------------------------------------------

static void know_link(const fp_point *point, const fp_part *part, int k, known *at)
{
    const fp_link_d *link = &point->links[k];
    const fp_dual_link_d *dual = &point->dual[k];
    const bool invariant = point->robot->invariant;
    at->c = link->c;
    at->s = link->s;
    at->w = point->motion->dtheta[k];
    const local rel = turned_to(at, (fp_vector_d){link->v.x - point->V[0], link->v.y - point->V[1]});
    const local a = turned_to(at, link->a), xi = turned_to(at, dual->xi), on_v = turned_to(at, dual->on_v);
    const local water = turned_to(at, (fp_vector_d){point->V[0], point->V[1]});
    at->rel_t = rel.t, at->rel_n = rel.n;
    at->a_t = a.t, at->a_n = a.n;
    at->xi_t = xi.t, at->xi_n = xi.n;
    at->on_v_t = on_v.t, at->on_v_n = on_v.n;
    at->water_t = water.t, at->water_n = water.n;
    at->turned_on = invariant ? rel.n : -water.n;
    at->by = fluid_slopes_d(point->robot, part, rel.t, rel.n, at->w, invariant ? rel.t : -water.t);
    at->by_tt = -2 * part->q_t * fp_sign(rel.t);
    at->bend = fp_drag_bends(point->robot, part, rel.n, at->w);
    at->by_theta_t = at->by.t_t * rel.n - link->f_n;
    at->by_theta_n = link->f_t - at->by.n_n * rel.t + part->mu_n * at->w * at->turned_on;
    at->load_a = part->mu_n * a.n + part->mu_1 * point->ddtheta[k];
    at->load_xi = part->mu_n * xi.n + part->mu_1 * dual->turn;
    at->net = dual->net;
}

static double of_lines(const fp_point *point, int joint)
{
    const moray_motor *motor = &point->robot->motor;
    double sum = 0;
    for (int k = 0; k < motor->lines && point->weight->sigma; k++)
        sum += point->weight->sigma[k * (point->robot->links - 1) + joint];
    return sum;
}

static void know_joint(const fp_point *point, int k, known *at)
{
    const double *w = point->motion->dtheta, pi = point->weight->pi;
    const fp_terminal_bends bend = fp_terminals_bend(&point->robot->motor, point->u[k], w[k] - w[k + 1]);
    at->by_uu = pi * bend.uu;
    at->by_uv = pi * bend.uv;
    at->by_vv = pi * bend.vv + of_lines(point, k) * bend.slope;
}

// The pull on each link of the one before it, from the sums of net forces behind.
static void know_pulls(const fp_point *point, known *at)
{
    fp_vector_d pull = {0, 0};
    for (int k = 0; k < point->robot->links; k++) {
        const fp_part *part = fp_part_of(point->robot, k, point->robot->alike ? point->robot->part : NULL);
        const fp_vector_d ahead = {pull.x - at[k].net.x, pull.y - at[k].net.y};
        const fp_vector_d both = {part->rear * pull.x + part->front * ahead.x,
                                  part->rear * pull.y + part->front * ahead.y};
        at[k].both_t = turned_to(&at[k], both).t;
        pull = ahead;
    }
}

// As next_column in fp_adjoint.inc.
static fp_vector_d next_sum(const fp_part *part, fp_vector_d mean, fp_vector_d *behind, fp_vector_d z)
{
    const fp_vector_d own = {z.x - part->weight * mean.x, z.y - part->weight * mean.y};
    const fp_vector_d all = {part->rear * own.x + 2 * behind->x, part->rear * own.y + 2 * behind->y};
    *behind = (fp_vector_d){behind->x + own.x, behind->y + own.y};
    return all;
}

static void know_columns(const fp_point *point, known *at)
{
    const int N = point->robot->links;
    fp_vector_d mean[3] = {{0}}, behind[3] = {{0}};
    for (int k = 0; k < N; k++) {
        const fp_dual_link_d *dual = &point->dual[k];
        const fp_vector_d *const z[] = {&dual->net, &dual->on_v, &dual->on_a};
        for (int i = 0; i < 3; i++)
            mean[i] = (fp_vector_d){mean[i].x + z[i]->x / N, mean[i].y + z[i]->y / N};
    }
    for (int k = N - 1; k >= 0; k--) {
        const fp_part *part = fp_part_of(point->robot, k, point->robot->alike ? point->robot->part : NULL);
        const fp_dual_link_d *dual = &point->dual[k];
        at[k].by_xi = turned_to(&at[k], next_sum(part, mean[0], &behind[0], dual->net));
        at[k].by_v = turned_to(&at[k], next_sum(part, mean[1], &behind[1], dual->on_v));
        at[k].by_a = turned_to(&at[k], next_sum(part, mean[2], &behind[2], dual->on_a));
    }
}

static void know(const fp_point *point, known *at)
{
    for (int k = 0; k < point->robot->links; k++)
        know_link(point, fp_part_of(point->robot, k, point->robot->alike ? point->robot->part : NULL), k, &at[k]);
    for (int k = 0; k < point->robot->links - 1; k++)
        know_joint(point, k, &at[k]);
    know_pulls(point, at);
    know_columns(point, at);
    for (int i = 0; i < 3; i++) {
        double *column = at->inverse[i]; // symmetric
        column[0] = column[1] = column[2] = 0;
        column[i] = 1;
        moray_fp_solve_balance_d(point->balance, column);
    }
}

// ---- Along the directions ------------------------------------------------------------------------------------------

typedef double lanes_own __attribute__((vector_size(OWN_LANES * sizeof(double))));
#define LANES lanes_own
#define TYPED(name) name##_own
#include "snake/model/fp_tangent.inc"
#undef LANES
#undef TYPED

#ifdef SEVERAL_PROCESSORS
typedef double lanes_4 __attribute__((vector_size(32)));
#define LANES lanes_4
#define TYPED(name) name##_4
#include "snake/model/fp_tangent.inc"
#undef LANES
#undef TYPED

typedef double lanes_8 __attribute__((vector_size(64)));
#define LANES lanes_8
#define TYPED(name) name##_8
#include "snake/model/fp_tangent.inc"
#undef LANES
#undef TYPED
#endif

static fp_directions directions_from(const fp_directions *all, int first)
{
    fp_directions from = *all;
    from.theta += first;
    from.dtheta += first;
    from.ubar += first;
    from.v += first;
    return from;
}

static fp_tangents tangents_from(const fp_tangents *all, int first)
{
    return (fp_tangents){all->theta + first, all->dtheta + first, all->ddtheta + first, all->v + first};
}

typedef struct sweeps {
    const fp_point *point;
    const known *known;
    void *links;
    const fp_directions *along;
    const fp_tangents *out;
} sweeps;

#define SWEEPS(lanes)                                                                                                  \
    do {                                                                                                               \
        enum { wide = sizeof(lanes_##lanes) / sizeof(double) };                                                        \
        const fp_part plain = fp_part_alike(all->point->robot);                                                        \
        for (int first = 0; first < all->along->n; first += wide) {                                                    \
            const fp_directions from = directions_from(all->along, first);                                             \
            const fp_tangents to = tangents_from(all->out, first);                                                     \
            if (all->point->robot->alike)                                                                              \
                sweep_##lanes(all->point, &plain, all->known, all->links, &from, &to);                                 \
            else                                                                                                       \
                sweep_##lanes(all->point, NULL, all->known, all->links, &from, &to);                                   \
        }                                                                                                              \
    } while (0)

static void sweeps_own(const sweeps *all)
{
    SWEEPS(own);
}

#ifdef SEVERAL_PROCESSORS
__attribute__((target("arch=x86-64-v3"))) static void sweeps_4(const sweeps *all)
{
    SWEEPS(4);
}

__attribute__((target("arch=x86-64-v4"))) static void sweeps_8(const sweeps *all)
{
    SWEEPS(8);
}
#endif

// ---- Interface -----------------------------------------------------------------------------------------------------

enum { boundary = FP_LANES * sizeof(double), per_lane = sizeof(lane_link_own) / sizeof(lanes_own) * sizeof(double) };

size_t moray_fp_tangents_bytes(int N)
{
    return (size_t)N * (sizeof(known) + FP_LANES * per_lane) + boundary;
}

int moray_fp_widest(void)
{
    return processor_lanes();
}

void moray_fp_tangents(int wide, const fp_point *at, const fp_directions *along, void *memory, const fp_tangents *out)
{
    const size_t N = (size_t)at->robot->links, off = (uintptr_t)memory % boundary;
    char *links = (char *)memory + (off > 0 ? boundary - off : 0);
    known *point = (known *)(void *)(links + N * FP_LANES * per_lane);
    const sweeps all = {at, point, links, along, out};
    know(at, point);
#ifdef SEVERAL_PROCESSORS
    if (wide > OWN_LANES) {
        (wide == 8 ? sweeps_8 : sweeps_4)(&all);
        return;
    }
#else
    (void)wide;
#endif
    sweeps_own(&all);
}
