// SPDX-License-Identifier: MIT
//
// Control law (22): does it make phi'' = ubar of the joint dynamics (16a)? The accelerations that the joint forces of
// (22) cause are found forwards, from (14) and (15) alone.
#include <complex.h>
#include <stdlib.h>

#include "forward.h"
#include "swim.h"

enum { STATES = 500, SIZES = 4 };

// ---- Random states -------------------------------------------------------------------------------------------------

static double uniform(unsigned short seed[3], double size)
{
    return size * (2 * erand48(seed) - 1);
}

// Largest differences over random states, relative to the largest acceleration of the state.
typedef struct {
    double joints, body;
    int states;
} misses;

static void compare(const paper_forward *f, const double *ubar, const double *dx, const double *z, misses *worst)
{
    const int N = f->N;
    double scale = fmax(fabs(z[N - 1]), fabs(z[N])), joints = 0;
    for (int i = 0; i < N - 1; i++) {
        scale = fmax(scale, fabs(ubar[i]));
        joints = fmax(joints, fabs(z[i] - ubar[i]));
    }
    worst->states++;
    worst->joints = fmax(worst->joints, joints / scale);
    worst->body = fmax(worst->body, fabs(z[N - 1] - dx[2 * N + 2]) / scale);
    worst->body = fmax(worst->body, fabs(z[N] - dx[2 * N + 3]) / scale);
}

// A random state of the swimmer: joints up to half a link apart, any heading, velocities of up to 0.5 in SI units.
static void random_state(const moray_robot *robot, unsigned short seed[3], double *x, double *ubar)
{
    const int N = robot->links;
    for (int i = 0; i < 2 * N + 4; i++)
        x[i] = uniform(seed, i < N - 1 ? robot->l : i == N - 1 ? M_PI : 0.5);
    for (int i = 0; i < N - 1; i++)
        ubar[i] = uniform(seed, 2);
}

static paper_situation situation_of(int N, const double V[2], const double *x, const double *u)
{
    const double c = cos(x[N - 1]), s = sin(x[N - 1]);
    return (paper_situation){.phi = x,
                             .v_phi = x + N + 2,
                             .u = u,
                             .v_tr = x[2 * N + 2] - (V[0] * c + V[1] * s),
                             .v_nr = x[2 * N + 3] - (V[1] * c - V[0] * s)};
}

static moray_status try_states(paper *p, const moray_robot *robot, misses *worst)
{
    const int N = robot->links;
    const double *V = p->settings->snake.current;
    unsigned short seed[3] = {1, 2, 3};
    moray_swimmer *swimmer;
    paper_forward f;
    double *x;
    MORAY_TRY(paper_swimmer(p, robot, MORAY_CONTROL_ORIENTED, p->settings->reading, &swimmer));
    MORAY_TRY(paper_forward_new(p, robot, &f));
    MORAY_TRY(paper_numbers(p, 7 * (size_t)N + 16, &x));
    double *dx = x + 2 * N + 4, *ubar = dx + 2 * N + 4, *u = ubar + N, *z = u + N;
    for (int k = 0; k < STATES; k++) {
        random_state(robot, seed, x, ubar);
        if (!moray_swimmer_rates(swimmer, x, ubar, dx, u))
            continue; // h_1 of (17) is not positive: no body has such an inertia
        const paper_situation at = situation_of(N, V, x, u);
        if (!paper_forward_accelerations(&f, &at, z))
            return moray_error(MORAY_NUMERIC, "the balances (15) of %d links are singular", N);
        compare(&f, ubar, dx, z, worst);
    }
    return moray_ok();
}

static moray_status compare_sizes(paper *p)
{
    const int links[SIZES] = {p->robot->links, 2, 5, 40};
    moray_table_row rows[SIZES];
    misses all = {0};
    for (int i = 0; i < SIZES; i++) {
        moray_robot robot = *p->robot;
        misses worst = {0};
        robot.links = links[i];
        paper_progress(p, "random states of %d links", links[i]);
        MORAY_TRY(try_states(p, &robot, &worst));
        rows[i] = (moray_table_row){.label = paper_label(p, "%d links", links[i]),
                                    .value = {worst.joints, worst.body, worst.states}};
        all.joints = fmax(all.joints, worst.joints);
        all.states += worst.states;
        all.body = fmax(all.body, worst.body);
    }
    moray_json_members(p->json,
                       MORAY_MEMBERS({"states", all.states}, {"joint_error", all.joints}, {"body_error", all.body}));
    return paper_rows(p,
                      "What (14) and (15) make of the forces (22): largest error in random states, over the "
                      "largest acceleration of the state",
                      PAPER_HEADS("phi'' - ubar", "v_t', v_n' - (16)", "states"), rows, SIZES);
}

// ---- Closed loop ---------------------------------------------------------------------------------------------------

// With phi'' = ubar, (34) makes of the error e = phi - phi_ref of every joint e'' + k_d e' + k_p e = 0.
static double decay(const moray_robot *robot, double e, double de, double t)
{
    const double complex root = csqrt(robot->k_d * robot->k_d / 4 - robot->k_p), fast = -robot->k_d / 2 - root;
    const double complex slow = -robot->k_d / 2 + root, part = (de - slow * e) / (fast - slow);
    return creal(part * cexp(fast * t) + (e - part) * cexp(slow * t));
}

// Of joint i from (25) in sample k of a track that began at rest with the joints straight.
static double tracking_error(const moray_swim_track *track, const moray_gait *gait, int k, int i)
{
    return track->x[(size_t)k * track->n_states + i] -
           gait->amplitude * sin(gait->omega * track->t[k] + i * gait->delta);
}

static double expected_error(const moray_robot *robot, const moray_gait *gait, double t, int i)
{
    const double phase = i * gait->delta;
    return decay(robot, -gait->amplitude * sin(phase), -gait->amplitude * gait->omega * cos(phase), t);
}

static moray_status draw(paper *p, const moray_swim_track *track, const moray_gait *gait, int joint)
{
    double *error, *expected;
    MORAY_TRY(paper_numbers(p, track->n, &error));
    MORAY_TRY(paper_numbers(p, track->n, &expected));
    for (int k = 0; k < track->n; k++) {
        error[k] = 1000 * tracking_error(track, gait, k, joint);
        expected[k] = 1000 * expected_error(p->robot, gait, track->t[k], joint);
    }
    const moray_curve curves[] = {
        {.label = "control-oriented model with (22) and (34)", .x = track->t, .y = error, .n = track->n},
        {.label = "e'' + k_d e' + k_p e = 0", .x = track->t, .y = expected, .n = track->n}};
    return paper_figure(p,
                        &(moray_figure){.title = paper_label(p, "Joint %d on its way from rest to the gait", joint + 1),
                                        .x_label = "time [s]",
                                        .y_label = "phi - phi_ref [mm]",
                                        .curves = curves,
                                        .n_curves = 2});
}

static moray_status close_loop(paper *p)
{
    const int joints = p->robot->links - 1;
    const moray_gait_change change = {0, p->gait[MORAY_CONTROL_ORIENTED]};
    const paper_swim_plan plan = {.model = MORAY_CONTROL_ORIENTED, .schedule = &change, .n_changes = 1};
    moray_swim_track *track;
    double worst = 0, first = 0;
    MORAY_TRY(paper_swim(p, &plan, 1, 0.01, &track));
    for (int k = 0; k < track->n; k++)
        for (int i = 0; i < joints; i++) {
            const double error = tracking_error(track, &change.gait, k, i);
            worst = fmax(worst, fabs(error - expected_error(p->robot, &change.gait, track->t[k], i)));
            first = fmax(first, k == 0 ? fabs(error) : 0);
        }
    moray_json_number(p->json, "closed_loop_error", worst / first);
    MORAY_TRY(paper_say(p,
                        "In closed loop from rest, every joint of the simulated control-oriented model follows the "
                        "linear equation of its error that (34) asks for, to %.1e of the first error.",
                        worst / first));
    return draw(p, track, &change.gait, joints / 2);
}

moray_status paper_linearising(paper *p)
{
    MORAY_TRY(compare_sizes(p));
    return close_loop(p);
}
