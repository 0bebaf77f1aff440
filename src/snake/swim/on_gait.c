// SPDX-License-Identifier: MIT
//
// A swimmer whose joints begin on the gait: by (34) they stay on it, and the deviation of their offset obeys
// e'' = -k_d e' - k_p e whatever the body does, so that only the body's six states need be integrated.
#include "moray/snake/swim.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "snake/swim/closed_loop_plant.h"

enum { body = MORAY_BODY_STATES, ENERGY = body, states };

static const double no_wait = 1e-9; // of a step: what is left by rounding
static const double alike = 1e-11;  // of a step: what steps differ by rounding

typedef struct fading {
    double time, of[2][2];
} fading;

typedef struct on_gait {
    moray_swimmer *swimmer;
    const moray_swim_plan *plan;
    const moray_swim_on_gait *how;
    moray_gait gait;
    int n, n_joints;
    double t, start, y[states];
    swim_current current;
    double deviation[2];  // of the offset from what is commanded, and its rate, at t
    fading half_faded;    // of that in half a step
    double slope[states]; // of y at t,
    bool known;           // where nothing has changed since it was found
    int measurements;
    double *x, *dx, *phi, *v_phi, *ubar, *u;
} on_gait;

// ---- Joints --------------------------------------------------------------------------------------------------------

// What a deviation and its rate are a time later, per unit of each.
static fading fading_after(const moray_robot *robot, double time)
{
    const double half = robot->k_d / 2;
    const double complex root = csqrt(half * half - robot->k_p) + 1e-9 * half; // never zero
    const double complex c = ccosh(root * time), s = csinh(root * time) / root;
    const double decay = exp(-half * time), even = creal(c), odd = creal(s), back = creal(root * root * s);
    return (fading){.time = time,
                    .of = {{decay * (even + half * odd), decay * odd},
                           {decay * (back - half * half * odd), decay * (even - half * odd)}}};
}

static void relax(const fading *by, const double e[2], double after[2])
{
    const double value = by->of[0][0] * e[0] + by->of[0][1] * e[1];
    after[1] = by->of[1][0] * e[0] + by->of[1][1] * e[1];
    after[0] = value;
}

static moray_offset commanded(const on_gait *r, double t)
{
    const moray_swim_controller *controller = r->plan->controller;
    return controller ? controller->offset(t, controller->self) : (moray_offset){.value = r->gait.offset};
}

// The offset at t, where its deviation is e[].
static moray_gait gait_at(const on_gait *r, double t, const double e[2])
{
    const moray_robot *robot = moray_swimmer_robot(r->swimmer);
    const moray_offset wanted = commanded(r, t);
    moray_gait gait = r->gait;
    gait.offset = wanted.value + e[0];
    gait.offset_rate = wanted.rate + e[1];
    gait.offset_acceleration = wanted.acceleration - robot->k_d * e[1] - robot->k_p * e[0];
    return gait;
}

static void move_joints(on_gait *r, double t, const double e[2])
{
    const moray_gait gait = gait_at(r, t, e);
    moray_gait_reference(&gait, r->n_joints, t, r->phi, r->v_phi, r->ubar);
}

// ---- Body ----------------------------------------------------------------------------------------------------------

// With the joints moved to where they are at t; leaves the full state in x.
static void place(on_gait *r, double t, const double *y)
{
    moray_swim_turn(r->swimmer, &r->current, t);
    moray_swimmer_with_joints(r->swimmer, r->phi, r->v_phi, y, r->x);
    if (r->plan->water)
        moray_swim_stir(r->swimmer, r->plan->water, t, r->x);
}

// Likewise, and the efforts in u; where that is NULL, without them and the power.
static bool rates(on_gait *r, double t, const double *y, double *dy, double *u)
{
    const moray_robot *robot = moray_swimmer_robot(r->swimmer);
    place(r, t, y);
    if (!moray_swimmer_rates(r->swimmer, r->x, r->ubar, r->dx, u))
        return false;
    moray_state_body(moray_swimmer_model(r->swimmer), robot->links, r->dx, dy);
    dy[ENERGY] = u ? moray_swimmer_power(r->swimmer, u, r->v_phi) : 0;
    return true;
}

// What the body is ahead by along a slope; energy too.
static void ahead(const double *y, double h, const double *slope, double *at)
{
    for (int i = 0; i < states; i++)
        at[i] = y[i] + h * slope[i];
}

static bool slope_here(on_gait *r)
{
    move_joints(r, r->t, r->deviation);
    return rates(r, r->t, r->y, r->slope, r->u);
}

// The classical method of the fourth order from the slope at its start and that in its middle, k[0], where the joints
// are; k[1] and k[2] are scratch.
static bool fourth_order(on_gait *r, double h, const double end[2], double k[3][states])
{
    double at[states];
    ahead(r->y, h / 2, k[0], at);
    bool good = rates(r, r->t + h / 2, at, k[1], r->u);
    move_joints(r, r->t + h, end);
    ahead(r->y, h, k[1], at);
    good = good && rates(r, r->t + h, at, k[2], r->u);
    for (int i = 0; i < states; i++)
        r->y[i] += h / 6 * (r->slope[i] + 2 * k[0][i] + 2 * k[1][i] + k[2][i]);
    return good;
}

// Likewise Kutta's of the third.
static bool third_order(on_gait *r, double h, const double end[2], double k[3][states])
{
    double at[states];
    for (int i = 0; i < body; i++)
        at[i] = r->y[i] + h * (2 * k[0][i] - r->slope[i]);
    move_joints(r, r->t + h, end);
    const bool good = rates(r, r->t + h, at, k[1], NULL);
    for (int i = 0; i < body; i++)
        r->y[i] += h / 6 * (r->slope[i] + 4 * k[0][i] + k[1][i]);
    r->y[ENERGY] += h * r->slope[ENERGY];
    return good;
}

static bool step(on_gait *r, double h)
{
    const bool third = r->how->order == 3;
    double k[3][states], at[states], half[2], end[2];
    bool good = r->known || slope_here(r);
    if (fabs(r->half_faded.time - h / 2) > alike * h)
        r->half_faded = fading_after(moray_swimmer_robot(r->swimmer), h / 2);
    relax(&r->half_faded, r->deviation, half);
    relax(&r->half_faded, half, end);
    move_joints(r, r->t + h / 2, half);
    ahead(r->y, h / 2, r->slope, at);
    good = good && rates(r, r->t + h / 2, at, k[0], third ? NULL : r->u);
    good = good && (third ? third_order : fourth_order)(r, h, end, k);
    memcpy(r->deviation, end, sizeof end);
    r->t += h;
    r->known = false;
    return good;
}

static moray_status advance(on_gait *r, double t)
{
    const double longest = 2 * M_PI / r->gait.omega / r->how->steps;
    const double way = t - r->t;
    const int n = moray_count_up(way / longest - no_wait);
    for (int k = 0; k < n; k++)
        if (!step(r, way / n))
            return moray_error(MORAY_NUMERIC, "the swimmer cannot be integrated at t = %.6g s", r->t);
    r->t = t;
    return moray_ok();
}

// ---- Stops ---------------------------------------------------------------------------------------------------------

static moray_swim_sample show(const on_gait *r, const double *u)
{
    moray_swim_sample shown = {
        .t = r->t, .x = r->x, .u = u, .pose = moray_swimmer_pose(r->swimmer, r->x), .energy = r->y[ENERGY]};
    moray_swimmer_current(r->swimmer, shown.current);
    return shown;
}

static moray_swim_sample sample(on_gait *r)
{
    r->known = slope_here(r);
    return show(r, r->u);
}

// Without efforts, which would take as long as a quarter of a step.
static moray_swim_sample sample_motion(on_gait *r)
{
    move_joints(r, r->t, r->deviation);
    place(r, r->t, r->y);
    return show(r, NULL);
}

// What is commanded may jump here; the joints do not.
static moray_status measure(on_gait *r)
{
    const moray_swim_controller *controller = r->plan->controller;
    const moray_swim_sample shown = sample_motion(r);
    const moray_gait gait = gait_at(r, r->t, r->deviation);
    MORAY_TRY(moray_swim_afloat(r->plan->water, &shown));
    MORAY_TRY(controller->measure(&shown, controller->self));
    const moray_offset wanted = commanded(r, r->t);
    r->deviation[0] = gait.offset - wanted.value;
    r->deviation[1] = gait.offset_rate - wanted.rate;
    r->known = false;
    r->measurements++;
    return moray_ok();
}

static double next_measurement(const on_gait *r)
{
    const moray_swim_controller *controller = r->plan->controller;
    return controller && controller->measure ? r->start + r->measurements * controller->period : INFINITY;
}

// To t, with every measurement up to and at it.
static moray_status go(on_gait *r, double t)
{
    for (double stop; (stop = next_measurement(r)) <= t;) {
        MORAY_TRY(advance(r, stop));
        MORAY_TRY(measure(r));
    }
    return advance(r, t);
}

static moray_status run(on_gait *r)
{
    const moray_swim_plan *plan = r->plan;
    for (int i = 0; i < plan->n_times; i++) {
        MORAY_TRY(go(r, plan->times[i]));
        const moray_swim_sample shown = sample(r);
        MORAY_TRY(moray_swim_afloat(plan->water, &shown));
        if (!plan->observe(&shown, plan->observer))
            return moray_ok();
    }
    return go(r, plan->t1);
}

static moray_status check(const moray_swimmer *swimmer, const moray_swim_plan *plan, const moray_swim_on_gait *how)
{
    if (moray_swimmer_torque(swimmer) > 0)
        return moray_error(MORAY_INPUT, "joints exactly on a gait: not with torques of at most %g N m",
                           moray_swimmer_torque(swimmer));
    if (plan->n_changes != 1 || plan->schedule[0].gait.series)
        return moray_error(MORAY_INPUT, "joints exactly on a gait: one gait without a series is needed");
    if (how->steps < 8)
        return moray_error(MORAY_INPUT, "steps = %d: must be at least 8 a period", how->steps);
    if (how->order != 0 && how->order != 3 && how->order != 4)
        return moray_error(MORAY_INPUT, "order = %d: must be 3 or 4, or 0, which is 4", how->order);
    if (plan->controller && plan->controller->measure && !(plan->controller->period > 0))
        return moray_error(MORAY_INPUT, "period of the controller = %g: must be above 0", plan->controller->period);
    return moray_ok();
}

moray_status moray_swim_run_on_gait(moray_swimmer *swimmer, const moray_swim_plan *plan, const moray_swim_on_gait *how,
                                    double *x, double *energy)
{
    MORAY_TRY(check(swimmer, plan, how));
    const int n = moray_swimmer_states(swimmer), n_joints = moray_swimmer_robot(swimmer)->links - 1;
    double *memory = calloc((size_t)(2 * n + 4 * n_joints), sizeof *memory);
    if (!memory)
        return moray_error(MORAY_MEMORY, "no memory to simulate a swimmer of %d states", n);
    on_gait r = {.swimmer = swimmer,
                 .plan = plan,
                 .how = how,
                 .gait = plan->schedule[0].gait,
                 .n = n,
                 .n_joints = n_joints,
                 .t = plan->t0,
                 .start = plan->t0,
                 .current = moray_swim_current(swimmer, plan),
                 .x = memory,
                 .dx = memory + n,
                 .phi = memory + 2 * n,
                 .v_phi = memory + 2 * n + n_joints,
                 .ubar = memory + 2 * n + 2 * n_joints,
                 .u = memory + 2 * n + 3 * n_joints};
    moray_state_body(moray_swimmer_model(swimmer), n_joints + 1, x, r.y);
    const moray_status status = run(&r);
    sample(&r);
    memcpy(x, r.x, (size_t)n * sizeof *x);
    if (energy)
        *energy = r.y[ENERGY];
    moray_swimmer_set_current(swimmer, r.current.V[0], r.current.V[1]);
    free(memory);
    return status;
}
