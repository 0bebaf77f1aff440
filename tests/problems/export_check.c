// SPDX-License-Identifier: MIT
//
// Whether the C header that export wrote does what the library does. Compiled with the header as snake.h; the arguments
// are those of the export, such as --config DIR/run.ini. Prints the largest differences, fails above 1e-12 in double,
// 1e-4 in float.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "export/export.h"
#include "snake.h"

#ifndef STEERED // kind of the law: 0 none, 1 heading, 2 path, 3 plan
#define STEERED 0
#endif

static const double agree = sizeof(snake_real) < 8 ? 1e-4 : 1e-12;
static bool failed;

static void tell(const char *what, double difference)
{
    const bool good = difference <= agree; // false for NaN
    printf("%-40s %.2e%s\n", what, difference, good ? "" : " differs");
    failed = failed || !good;
}

// A NaN is worse than any number.
static double worse(double worst, double difference)
{
    return isnan(difference) ? INFINITY : fmax(worst, difference);
}

// ---- Joints --------------------------------------------------------------------------------------------------------

static void compare_joints(const export_found *found)
{
    double worst = 0, ramp[3], phi[3 * SNAKE_JOINTS];
    snake_real got[3][SNAKE_JOINTS];
    snake_state state;
    snake_start(&state);
    for (int k = 0; k <= 1000; k++) {
        const double t = k * 3e-3 * found->period;
        moray_gait_reference(&found->gait, SNAKE_JOINTS, t, phi, phi + SNAKE_JOINTS, phi + 2 * SNAKE_JOINTS);
        export_ramp(t, found->job->ramp * found->period, ramp);
        snake_joints(&state, (snake_real)t, got[0], got[1], got[2]);
        for (int i = 0; i < SNAKE_JOINTS; i++) {
            const double w = phi[i], dw = phi[SNAKE_JOINTS + i], ddw = phi[2 * SNAKE_JOINTS + i];
            worst = worse(worst, fabs((double)got[0][i] - ramp[0] * w));
            worst = worse(worst, fabs((double)got[1][i] - ramp[1] * w - ramp[0] * dw));
            worst = worse(worst, fabs((double)got[2][i] - ramp[2] * w - 2 * ramp[1] * dw - ramp[0] * ddw));
        }
    }
    tell("joints, rates, accelerations", worst);
}

// ---- Joint controller, on the plant --------------------------------------------------------------------------------

typedef void control_fn(const export_found *found, moray_swimmer *swimmer, double t, const double *x, double *ubar);

static void by_library(const export_found *found, moray_swimmer *swimmer, double t, const double *x, double *ubar)
{
    moray_swimmer_control(swimmer, &found->gait, t, x, ubar);
}

static void by_header(const export_found *found, moray_swimmer *swimmer, double t, const double *x, double *ubar)
{
    double phi[SNAKE_JOINTS], v_phi[SNAKE_JOINTS];
    snake_real measured[SNAKE_JOINTS], rate[SNAKE_JOINTS], out[SNAKE_JOINTS];
    snake_state state;
    (void)found;
    snake_start(&state);
    moray_swimmer_joints(swimmer, x, phi, v_phi);
    for (int i = 0; i < SNAKE_JOINTS; i++) {
        measured[i] = (snake_real)phi[i];
        rate[i] = (snake_real)v_phi[i];
    }
    snake_control(&state, (snake_real)t, measured, rate, out);
    for (int i = 0; i < SNAKE_JOINTS; i++)
        ubar[i] = (double)out[i];
}

// Heun's method from rest, straight, with a joint bent; x[3 * states], the result in front.
static void swim(const export_found *found, moray_swimmer *swimmer, control_fn *control, double *x)
{
    const int n = moray_swimmer_states(swimmer), steps = 2000;
    const double h = 2e-3, t0 = (double)SNAKE_RAMP;
    double *at = x + n, *slope = at + n, *next = slope + n, ubar[SNAKE_JOINTS];
    moray_swimmer_rest(swimmer, 0.3, 0, 0, x);
    x[0] += 0.05;
    for (int k = 0; k < steps; k++) {
        control(found, swimmer, t0 + k * h, x, ubar);
        moray_swimmer_rates(swimmer, x, ubar, slope, NULL);
        for (int i = 0; i < n; i++)
            at[i] = x[i] + h * slope[i];
        control(found, swimmer, t0 + (k + 1) * h, at, ubar);
        moray_swimmer_rates(swimmer, at, ubar, next, NULL);
        for (int i = 0; i < n; i++)
            x[i] += h / 2 * (slope[i] + next[i]);
    }
}

static void compare_plant(const export_found *found)
{
    moray_swimmer *swimmer;
    if (moray_failed(moray_swimmer_new(&swimmer, &found->job->snake.robot, MORAY_FIRST_PRINCIPLES)))
        exit(2);
    const int n = moray_swimmer_states(swimmer);
    double *one = calloc(8 * (size_t)n, sizeof *one), *other = one + 4 * n, worst = 0;
    swim(found, swimmer, by_library, one);
    swim(found, swimmer, by_header, other);
    for (int i = 0; i < n; i++)
        worst = worse(worst, fabs(one[i] - other[i]));
    tell("states after 4 s under (34)", worst);
    free(one);
    moray_swimmer_free(swimmer);
}

// ---- Steering, in closed loop --------------------------------------------------------------------------------------

#if STEERED
static const export_found *all;
static moray_reference reference;

static moray_offset header_offset(double t, const void *self)
{
    const snake_state *state = self;
    return (moray_offset){.value = (double)snake_offset(state, (snake_real)t), .rate = (double)state->slope};
}

static moray_status header_measure(const moray_swim_sample *sample, void *self)
{
    const snake_real t = (snake_real)sample->t, heading = (snake_real)sample->pose.heading;
#if STEERED == 1
    double rate, target = moray_reference_at(&reference, sample->t + all->gains.lead, &rate);
    snake_steer(self, t, heading, (snake_real)target, (snake_real)rate);
#elif STEERED == 2
    snake_steer(self, t, heading, (snake_real)sample->pose.p_x, (snake_real)sample->pose.p_y);
#else
    snake_steer(self, t, heading);
#endif
    return moray_ok();
}

#if STEERED == 3
static double feed_plan(const moray_swim_sample *sample, double t, void *law)
{
    const double at = fmin(t / all->job->look, all->n_plan - 1.0), k = fmin(floor(at), all->n_plan - 2.0);
    const double *row = all->plan + 2 * (int)k;
    return moray_heading_law_feed(sample, t, law) + row[0] + (at - k) * (row[2] - row[0]);
}
#endif

static moray_swim_closed_loop run(const moray_swim_controller *controller)
{
    const moray_swim_on_gait how = {.steps = 48};
    moray_swim_closed_loop loop = {0};
    const moray_status status =
        moray_swim_closed_loop_run(&loop, &(moray_swim_closed_loop_spec){.robot = &all->job->snake.robot,
                                                                         .straight = &all->straight,
                                                                         .heading = 0.1,
                                                                         .position = {0, 0.5},
                                                                         .current = {0.03, -0.05},
                                                                         .controller = controller,
                                                                         .duration = 40,
                                                                         .intervals = 200,
                                                                         .on_gait = &how});
    if (moray_failed(status)) {
        fprintf(stderr, "%s\n", status.text);
        exit(2);
    }
    return loop;
}

static void read_reference(char *text)
{
#if STEERED == 3
    reference.n = all->n_plan;
    reference.time = calloc(2 * (size_t)reference.n, sizeof(double));
    reference.heading = reference.time + reference.n;
    for (int k = 0; k < reference.n; k++) {
        reference.time[k] = k * all->job->look;
        reference.heading[k] = all->plan[2 * k + 1];
    }
    (void)text;
#else
    if (moray_failed(moray_reference_read(&reference, text)))
        exit(2);
#endif
}

static void compare_steering(void)
{
    char text[] = "ramps:3=0,8=40,20=40,21=-20";
    moray_feedback feedback = {.gain = all->scale * all->gains.proportional,
                               .straight = &all->straight,
                               .offset = all->offset,
                               .offset_rate = all->offset_rate,
                               .period = all->job->look};
    moray_heading_law law = {.gains = all->gains,
                             .reference = &reference,
                             .feedback = &feedback,
                             .scale = all->scale,
                             .smoothing = all->job->smoothing};
    moray_guidance guidance = {.path = &all->path,
                               .lookahead = all->lookahead,
                               .ahead = all->ahead,
                               .gain = all->sight_integral,
                               .period = all->job->look};
    snake_state state;
    read_reference(text);
    feedback.target = STEERED == 2 ? moray_guidance_target : moray_heading_law_target;
    feedback.feed = STEERED == 2 ? NULL : moray_heading_law_feed;
#if STEERED == 3
    feedback.feed = feed_plan;
#endif
    feedback.self = STEERED == 2 ? (void *)&guidance : (void *)&law;
    const moray_swim_controller own = moray_feedback_controller(&feedback);
    snake_start(&state);
    const moray_swim_controller exported = {header_offset, header_measure, all->job->look, &state};
    moray_swim_closed_loop one = run(&own), other = run(&exported);
    double place = 0, heading = 0, offset = 0, most = 0;
    for (int k = 0; k < one.track.n; k++) {
        const moray_pose *a = &one.track.pose[k], *b = &other.track.pose[k];
        place = worse(place, hypot(a->p_x - b->p_x, a->p_y - b->p_y));
        heading = worse(heading, fabs(a->heading - b->heading));
        offset = worse(offset, fabs(one.offset[k] - other.offset[k]));
        most = fmax(most, fabs(one.offset[k]));
    }
    tell("position in closed loop, m", place);
    tell("heading in closed loop, rad", heading);
    tell("joint offset in closed loop, rad", offset);
    if (!(most > 1e-3)) {
        printf("nobody steered: the largest offset is %g rad\n", most);
        failed = true;
    }
    moray_swim_closed_loop_free(&one);
    moray_swim_closed_loop_free(&other);
    if (STEERED == 3)
        free(reference.time);
    else
        moray_reference_free(&reference);
}
#endif

// ---- All -----------------------------------------------------------------------------------------------------------

int main(int argc, char **argv)
{
    static export_job job;
    static export_found found;
    moray_request request;
    job = export_defaults();
    moray_status status = moray_app_parse(&export_program, argc, argv, &job, &request);
    if (!moray_failed(status))
        status = export_gather(&found, &job);
    if (moray_failed(status)) {
        fprintf(stderr, "%s\n", status.text);
        return 2;
    }
    compare_joints(&found);
    compare_plant(&found);
#if STEERED
    all = &found;
    if ((int)found.law != STEERED)
        return 2;
    compare_steering();
#endif
    export_release(&found);
    return failed;
}
