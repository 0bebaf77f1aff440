// SPDX-License-Identifier: MIT
#include "moray/snake/turn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "snake/steer/dubins.h"
#include "snake/steer/guess.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES };

typedef struct turn_task {
    moray_turn_spec spec;
    double weight;
    moray_bounds e[2];
} turn_task;

static const char *const event_names[] = {"heading at the end", "turning at the end"};

static void extra(void *self, const double complex *in, double complex *out)
{
    const turn_task *task = self;
    const moray_num steering = in[states] / task->spec.limits.offset;
    *out = steering * steering;
}

// Heading and its rate without the undulation, in whatever stroke the turn ends.
static void events(const moray_ends *at, moray_end_values *out, const void *data)
{
    const turn_task *task = data;
    const double *factor = task->spec.undulation;
    const moray_num omega = at->s[MORAY_STEERING_OMEGA], c = cos(omega * at->phase->tf), s = sin(omega * at->phase->tf);
    out->e[0] = at->phase->xf[MORAY_STATE_THETA] - factor[0] * c - factor[1] * s;
    out->e[1] = at->phase->xf[MORAY_STATE_V_THETA] - omega * (factor[1] * c - factor[0] * s);
}

static moray_status check(const moray_turn_spec *spec)
{
    if (!isfinite(spec->heading))
        return moray_error(MORAY_INPUT, "heading at the end = %g: must be finite", spec->heading);
    if (!(spec->limits.offset < MORAY_INFINITY))
        return moray_error(MORAY_INPUT, "offset: must be limited, the steering effort counts in it");
    if (!(spec->steering >= 0))
        return moray_error(MORAY_INPUT, "weight of the steering = %g: must not be below 0", spec->steering);
    if (!(spec->shortest > 0 && spec->longest > spec->shortest))
        return moray_error(MORAY_INPUT, "time of the turn = %g:%g s: must be a range above 0", spec->shortest,
                           spec->longest);
    return moray_ok();
}

static moray_steering_spec steering_spec(const moray_turn_spec *spec, turn_task *task)
{
    moray_steering_spec steering = {.robot = spec->robot,
                                    .model = spec->model,
                                    .averaged = spec->averaged,
                                    .current = {spec->current[0], spec->current[1]},
                                    .water = spec->water,
                                    .limits = spec->limits,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_between(spec->shortest, spec->longest),
                                    .task = {.name = "turn",
                                             .nq = 1,
                                             .extra = extra,
                                             .ne = 2,
                                             .events = events,
                                             .self = task,
                                             .e = task->e,
                                             .e_names = event_names,
                                             .weight = &task->weight,
                                             .weight_time = 1}};
    for (int r = 0; r < states; r++) {
        steering.x0[r] = moray_fixed(spec->start[r]);
        steering.xf[r] = r >= 6 ? moray_fixed(0) : moray_free();
    }
    for (int k = 0; k < 2 && spec->to_position; k++)
        steering.xf[1 + k] = moray_fixed(spec->position[k]);
    return steering;
}

moray_status moray_turn_new(moray_steering_problem *problem, const moray_turn_spec *spec)
{
    *problem = (moray_steering_problem){0};
    MORAY_TRY(check(spec));
    turn_task *task = problem->task = calloc(1, sizeof *task);
    if (!task)
        return moray_error(MORAY_MEMORY, "no memory for the turn");
    *task = (turn_task){.spec = *spec, .weight = spec->steering, .e = {moray_fixed(spec->heading), moray_fixed(0)}};
    const moray_steering_spec steering = steering_spec(spec, task);
    const moray_status status = moray_steering_new(&problem->steering, &steering);
    if (moray_failed(status))
        moray_steering_problem_free(problem);
    return status;
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

// A guess of the turn: how it goes about it, and how long that takes.
typedef struct outline {
    moray_dubins way; // turning steadily; where the end has a position, by arcs and legs
    double radius, seconds;
} outline;

enum { most_outlines = 4, enough = 2 }; // tried; solved, of which the faster is taken

// Arcs begin and end gently, so they are wider than the circle of steady turning; how much is a guess, too.
static const double wide[] = {1.15, 1.6};

// In the order of their times; the slowest falls out where there are too many.
static int insert(outline *plans, int n, outline next)
{
    int at = n;
    while (at > 0 && plans[at - 1].seconds > next.seconds)
        at--;
    if (at == most_outlines)
        return n;
    const int moved = n < most_outlines ? n - at : most_outlines - 1 - at;
    memmove(plans + at + 1, plans + at, (size_t)moved * sizeof *plans);
    plans[at] = next;
    return n < most_outlines ? n + 1 : n;
}

// All ways to the end position, or one turn without a way.
static int outlines_of(const moray_turn_spec *spec, double speed, double turn_rate, outline plans[most_outlines])
{
    const double ramp = spec->limits.offset / spec->limits.offset_rate, circle = speed / fabs(turn_rate);
    const double steady = fabs(spec->heading) / fabs(turn_rate) + 2 * ramp + 1;
    const double distance = spec->to_position ? hypot(spec->position[0], spec->position[1]) : 0;
    int n = 0;
    for (int w = 0; spec->to_position && w < (int)(sizeof wide / sizeof *wide); w++)
        for (int kind = 0; kind < MORAY_DUBINS_KINDS; kind++) {
            outline next = {.radius = wide[w] * circle};
            const double longest = 10 * (steady + (distance + 8 * next.radius) / speed);
            if (moray_dubins_in_current(kind, spec->position, spec->heading, spec->current, speed, next.radius, longest,
                                        &next.way, &next.seconds))
                n = insert(plans, n, next);
        }
    if (n > 0)
        return n;
    plans[0] = (outline){.way = {.turn = {spec->heading < 0 ? -1 : 1}, .length = {fabs(spec->heading)}},
                         .radius = wide[0] * circle,
                         .seconds = fmax(steady, distance / (0.2 * speed))};
    return 1;
}

// Curvature of the way, in 1/m, where a share of it is swum.
static double curvature_at(const outline *plan, double share)
{
    const double *length = plan->way.length;
    double left = share * (length[0] + length[1] + length[2]);
    int part = 0;
    while (part < 2 && left > length[part])
        left -= length[part++];
    return plan->way.turn[part] / plan->radius;
}

static void guess_outline(steering_guess *guess, const moray_turn_spec *spec, const moray_straight_motion *straight,
                          const outline *plan, double turn_rate)
{
    const double *V = spec->current, *length = plan->way.length;
    const int n = guess->samples.n;
    const double step = plan->seconds / (n - 1), way = plan->radius * (length[0] + length[1] + length[2]);
    const double speed = way / plan->seconds;
    double p[2] = {0, 0}, heading = 0;
    for (int k = 0; k < n; k++) {
        double *x = guess->x + k * states;
        const double rate = speed * curvature_at(plan, (k + 0.5) / n);
        guess->time[k] = step * k;
        moray_straight_motion_start(straight, heading, V, x);
        if (spec->averaged)
            x[MORAY_STATE_THETA] = heading;
        x[MORAY_STATE_V_THETA] = rate;
        x[MORAY_STATE_PHI_0] = fmin(fmax(rate / turn_rate, -0.9), 0.9) * spec->limits.offset;
        memcpy(x + MORAY_STATE_P_X, p, sizeof p);
        for (int i = 0; i < 2; i++)
            p[i] += step * ((spec->to_position ? speed : straight->speed) * (i ? sin(heading) : cos(heading)) + V[i]);
        heading += step * rate;
    }
    moray_steering_parameters(&straight->gait, guess->s);
}

// No averaged way to a pose is much faster than the fastest outline: without that floor Ipopt shortens the time before
// it minds the end. Small turns of the heading alone are: an outline brings the offset to its limit and back.
static moray_status pose_problem(moray_steering_plan *plan, moray_turn_spec *spec, double fastest, double slowest)
{
    double V[2];
    moray_steering_current(spec->water, spec->current, 0, 0, 0, V);
    moray_straight_motion_start(&plan->straight, 0, V, spec->start);
    if (spec->averaged)
        spec->start[MORAY_STATE_THETA] = spec->start[MORAY_STATE_V_THETA] = 0;
    for (int k = 0; k < 2; k++)
        spec->undulation[k] = spec->averaged ? 0 : plan->straight.undulation[k];
    spec->shortest = spec->averaged && spec->to_position ? 0.5 * fastest : 0.1;
    spec->longest = 6 * slowest;
    return moray_turn_new(&plan->problem, spec);
}

static bool solved(const moray_solution *solution)
{
    return moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED;
}

static moray_status solve(moray_steering_plan *plan, const moray_settings *settings, const steering_guess *samples,
                          moray_solution **solution)
{
    const moray_guess guess = {.phase = &samples->samples, .s = samples->s};
    return moray_solve(moray_steering_ocp(plan->problem.steering), settings, &guess, solution);
}

// Keeps the better of two solutions, the only one where there was none.
static void keep(moray_steering_plan *plan, moray_solution *next)
{
    const bool better = !plan->solution ||
                        (solved(next) && (!solved(plan->solution) ||
                                          moray_solution_objective(next) < moray_solution_objective(plan->solution)));
    moray_solution_free(better ? plan->solution : next);
    if (better)
        plan->solution = next;
}

// The faster of the first two that solve; where none does, from the first with more time; else what that led to.
static moray_status solve_outlines(moray_steering_plan *plan, const moray_turn_spec *spec,
                                   const moray_settings *settings, steering_guess *samples, const outline *plans, int n,
                                   double turn_rate)
{
    for (int k = 0, done = 0; k <= n && done < enough && (k < n || done == 0); k++) {
        moray_solution *next = NULL;
        outline likely = plans[k % n];
        likely.seconds *= k < n ? 1 : 1.5;
        guess_outline(samples, spec, &plan->straight, &likely, turn_rate);
        MORAY_TRY(solve(plan, settings, samples, &next));
        done += solved(next);
        keep(plan, next);
    }
    return moray_ok();
}

// How many of the outlines come before the first that takes much longer than the fastest: a whole turn more.
static int as_fast(const outline *plans, int n)
{
    const double much_longer = 2;
    int k = 1;
    while (k < n && plans[k].seconds < much_longer * plans[0].seconds)
        k++;
    return k;
}

// Where no averaged way is found, that is since the fastest outlines are a little too narrow for the robot, and longer
// ones are drawn to them: once more with the floor of the longer ones.
static moray_status solve_longer(moray_steering_plan *plan, moray_turn_spec *spec, const moray_settings *settings,
                                 steering_guess *samples, const outline *plans, int n, double turn_rate)
{
    for (int first = as_fast(plans, n); first < n && !solved(plan->solution);
         first += as_fast(plans + first, n - first)) {
        if (moray_solution_info(plan->solution)->outcome == MORAY_NLP_INTERRUPTED)
            break;
        moray_solution_free(plan->solution);
        moray_steering_problem_free(&plan->problem);
        plan->solution = NULL;
        MORAY_TRY(pose_problem(plan, spec, plans[first].seconds, plans[n - 1].seconds));
        MORAY_TRY(solve_outlines(plan, spec, settings, samples, plans + first, n - first, turn_rate));
    }
    return moray_ok();
}

static moray_status make(moray_steering_plan *plan, moray_turn_spec *spec, const moray_settings *settings,
                         const moray_gait *gait, double turn_rate, const moray_steering_plan *from, double stretch)
{
    steering_guess samples;
    outline likely[most_outlines];
    MORAY_TRY(moray_straight_motion_find(&plan->straight, &spec->robot, spec->model, gait));
    const int n = outlines_of(spec, plan->straight.speed, turn_rate, likely);
    MORAY_TRY(pose_problem(plan, spec, likely[0].seconds, likely[n - 1].seconds));
    MORAY_TRY(moray_steering_guess_new(&samples, 16 * settings->intervals + 1, 1));
    moray_status status;
    if (from) {
        moray_steering_guess_from_other(&samples, &spec->robot, from->solution, &from->straight, spec->model, stretch);
        status = solve(plan, settings, &samples, &plan->solution);
    } else
        status = solve_outlines(plan, spec, settings, &samples, likely, spec->averaged ? n : 1, turn_rate);
    if (!moray_failed(status) && !from && spec->averaged)
        status = solve_longer(plan, spec, settings, &samples, likely, n, turn_rate);
    free(samples.time);
    MORAY_TRY(status);
    if (!spec->averaged)
        return moray_ok();
    const moray_gait found = moray_steering_gait(moray_solution_parameters(plan->solution));
    return moray_straight_motion_find(&plan->straight, &spec->robot, spec->model, &found);
}

moray_status moray_turn_plan_make(moray_steering_plan *plan, const moray_turn_spec *spec,
                                  const moray_settings *settings, const moray_gait *gait, double turn_rate,
                                  const moray_steering_plan *from, double stretch)
{
    moray_turn_spec own = *spec;
    if (!own.averaged)
        moray_steering_keep_gait(&own.limits, &own.robot, own.model, gait);
    *plan = (moray_steering_plan){0};
    const moray_status status = make(plan, &own, settings, gait, turn_rate, from, stretch);
    if (moray_failed(status))
        moray_steering_plan_free(plan);
    return status;
}
