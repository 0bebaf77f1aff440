// SPDX-License-Identifier: MIT
#include "path.h"

static const double across_unit = 0.1; // m of cross-track error, in the objective

moray_path_spec path_spec(const path_job *job, moray_model model, bool averaged)
{
    const moray_snake_options *snake = &job->steer.snake;
    // The objective as a tenth of a mean over time: multipliers of the order of one.
    const double seconds = 10 * job->path.length / job->steer.straight[0][model].speed;
    return (moray_path_spec){.robot = snake->robot,
                             .model = model,
                             .averaged = averaged,
                             .current = {snake->current[0], snake->current[1]},
                             .water = job->steer.water,
                             .limits = steer_limits(&job->steer, model),
                             .weight = {.across = 1 / (across_unit * across_unit * seconds),
                                        .time = job->weight_time / seconds,
                                        .steering = job->steer.weight_steering / seconds},
                             .path = &job->planned,
                             .tube = fmin(job->tube, MORAY_INFINITY),
                             .reach = job->reach};
}

// ---- Corners -------------------------------------------------------------------------------------------------------

// How far the arcs of a path pass beside its waypoints at the most [m].
static double passes_by(const moray_path *path)
{
    double most = 0;
    for (int k = 0; k < path->n; k++)
        most = fmax(most, path->radius * (1 / cos(path->piece[k].curvature * path->piece[k].length / 2) - 1));
    return most;
}

// A plan cuts a narrow corner beyond its centre, where the nearest point of the path jumps and no plan is certified. So
// it is made for corners of half the circle on which the robot turns, and wider ones where the path hardly changes, as
// the legs have room for them, and eased; within a tube for those that are asked for.
static moray_status round_corners(path_job *job, double circle)
{
    const double widest = 10 * circle, enough = 0.5 * circle, hardly = 0.1 * across_unit, step = 0.9;
    if (job->radius >= enough || isfinite(job->tube))
        return moray_path_read(&job->planned, job->path_text, job->radius);
    for (double radius = widest; radius > job->radius; radius *= step) {
        const moray_status status = moray_path_read(&job->planned, job->path_text, radius);
        if (!moray_failed(status) && (radius <= enough || passes_by(&job->planned) <= hardly))
            return moray_path_ease(&job->planned);
        moray_path_free(&job->planned);
        if (moray_failed(status) && status.code != MORAY_INPUT)
            return status;
    }
    return moray_path_read(&job->planned, job->path_text, job->radius);
}

// ---- What limits the robot -----------------------------------------------------------------------------------------

// Speed over ground along a course, crabbing.
static double way(const path_job *job, double speed, double course)
{
    const double *V = job->steer.snake.current, c = cos(course), s = sin(course);
    const double side = V[1] * c - V[0] * s;
    return sqrt(fmax(speed * speed - side * side, 0)) + V[0] * c + V[1] * s;
}

double path_turning(const path_job *job, const moray_path_piece *piece)
{
    const double speed = job->speed, turned = piece->curvature * piece->length;
    return fabs(piece->curvature) * fmax(way(job, speed, piece->course), way(job, speed, piece->course + turned));
}

// The corner that asks for the fastest turning; NULL without corners.
static const moray_path_piece *tightest(const path_job *job)
{
    const moray_path_piece *worst = NULL;
    for (int k = 0; k < job->path.n; k++)
        if (job->path.piece[k].curvature != 0 &&
            (!worst || path_turning(job, &job->path.piece[k]) > path_turning(job, worst)))
            worst = &job->path.piece[k];
    return worst;
}

// A leg of the path in that of the plan; NULL where the arcs leave nothing of it.
static const moray_path_piece *planned_leg(const path_job *job, const moray_path_piece *leg)
{
    for (int k = 0; k < job->planned.n; k++)
        if (job->planned.piece[k].leg == leg->leg && job->planned.piece[k].curvature == 0 &&
            job->planned.piece[k].sharpness == 0)
            return &job->planned.piece[k];
    return NULL;
}

void path_crab(const path_job *job, const moray_path_piece *leg, double *asked, double *planned)
{
    enum { points = 4000 };
    const moray_steering_plan *plan = steer_last_plan(&job->steer);
    const moray_path_piece *swum = planned_leg(job, leg);
    const double *V = job->steer.snake.current, speed = plan->straight.speed, course = leg->course;
    double t0, tf, x[MORAY_STEERING_STATES], u[2], sum = 0;
    int n = 0;
    *asked = -asin((V[1] * cos(course) - V[0] * sin(course)) / speed);
    moray_solution_times(plan->solution, 0, &t0, &tf);
    for (int k = 0; swum && k <= points; k++) {
        const double t = t0 + (tf - t0) * k / points;
        moray_solution_at(plan->solution, 0, t, x, u);
        const double part = (u[1] - swum->start) / swum->length;
        if (part < 0.4 || part > 0.8)
            continue;
        sum += remainder(moray_straight_motion_heading(&plan->straight, t, x[MORAY_STATE_THETA]) - course, 2 * M_PI);
        n++;
    }
    *planned = n ? sum / n : NAN;
}

static void say_corner(const path_job *job, const moray_path_piece *corner, double turn_rate, char *text, size_t size)
{
    moray_text_add(
        text, size,
        "the corner behind leg %d turns by %.4g deg on a radius of %.4g m: at the robot's speed over ground that "
        "is %.3g deg/s, and with its offset at the limit it turns at %.3g deg/s",
        corner->leg, fabs(corner->curvature) * corner->length / DEG, fabs(1 / corner->curvature),
        path_turning(job, corner) / DEG, turn_rate / DEG);
}

void path_explain(const steer_job *steer, char *text, size_t size)
{
    const path_job *job = (const path_job *)steer;
    const moray_model model = steer->snake.model;
    const moray_steering_limits limits = steer_limits(steer, model);
    const double speed = steer_last_plan(steer)->straight.speed, turn_rate = fabs(steer->turn_rate[model]);
    const moray_path_piece *corner = tightest(job);
    steer_say_limit(steer, text, size);
    moray_text_add(text, size, " at %.2f deg/s, in still water on a circle of %.3g m, which takes %.3g s to build up.",
                   turn_rate / DEG, speed / turn_rate, limits.offset / limits.offset_rate);
    if (corner && path_turning(job, corner) > turn_rate) {
        moray_text_add(text, size, " That is too slow: ");
        say_corner(job, corner, turn_rate, text, size);
        moray_text_add(text, size, ".");
        if (job->planned.radius > job->radius)
            moray_text_add(text, size, " The plans are made for corners eased to a radius of %.3g m.",
                           job->planned.radius);
    } else if (corner)
        moray_text_add(text, size, " The corners ask for up to %.2f deg/s.", path_turning(job, corner) / DEG);
    moray_text_add(text, size,
                   " Swimming straight along the path, crabbing, would take %.1f s by the triangle of velocities. T",
                   moray_path_duration(&job->path, 0, speed, steer->snake.current));
    steer_say_saturation(steer, text, size);
}

static moray_status why_not(const path_job *job, const moray_steering_plan *plan)
{
    char text[400] = "";
    const moray_path_piece *corner = tightest(job);
    const double turn_rate = fabs(job->steer.turn_rate[plan->straight.model]);
    const moray_status told = steer_not_solved(plan->solution);
    if (told.code != MORAY_NOT_SOLVED || steer_cut_short(plan->solution) || !corner ||
        path_turning(job, corner) <= turn_rate)
        return told;
    say_corner(job, corner, turn_rate, text, sizeof text);
    if (!isfinite(job->tube))
        return moray_error(MORAY_NOT_SOLVED, "the path is not followed: %s; %s", text, told.text);
    return moray_error(MORAY_NOT_SOLVED, "tube_m = %g cannot be kept: %s", job->tube, text);
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

// A corner begins and ends with a kink.
static moray_settings settings_of(path_job *job, bool averaged, const moray_straight_motion *straight)
{
    const double per_period = averaged ? 1.2 : job->steer.intervals_per_period,
                 period = 2 * M_PI / straight->gait.omega;
    const double seconds = moray_path_duration(&job->path, 0, straight->speed, job->steer.snake.current);
    return steer_settings(&job->steer, averaged, (int)ceil(seconds / period * per_period) + 4, 1e-4, 1e-4);
}

static moray_status solve(path_job *job, moray_model model, bool averaged, const moray_gait *gait,
                          const moray_steering_plan *from, moray_steering_plan *plan)
{
    const moray_path_spec spec = path_spec(job, model, averaged);
    moray_straight_motion straight;
    steer_clock_give(&job->steer.clock, averaged ? 0.2 : model < job->steer.snake.model ? 0.3 : 0.5);
    MORAY_TRY(moray_straight_motion_find(&straight, &spec.robot, model, gait));
    MORAY_TRY(moray_path_passable(spec.path, straight.speed, spec.current));
    MORAY_TRY(steer_find_turn_rate(&job->steer, model, gait));
    job->speed = straight.speed;
    const moray_settings settings = settings_of(job, averaged, &straight);
    MORAY_TRY(moray_path_plan_make(plan, &spec, &settings, gait, job->start, job->heading,
                                   steer_alike(&job->steer, model, from) ? from : NULL));
    MORAY_TRY(steer_interruption());
    if (!steer_solved(plan->solution) && steer_alike(&job->steer, model, from) && from &&
        !steer_cut_short(plan->solution)) {
        moray_steering_plan_free(plan);
        MORAY_TRY(moray_path_plan_make(plan, &spec, &settings, gait, job->start, job->heading, NULL));
        MORAY_TRY(steer_interruption());
    }
    return steer_solved(plan->solution) ? moray_ok() : why_not(job, plan);
}

static moray_status make_plan(path_job *job, moray_model model, const moray_gait *gait, const moray_steering_plan *from)
{
    MORAY_TRY(solve(job, model, false, gait, from, &job->steer.plan[model]));
    return steer_straight_motions(&job->steer, 1 + (int)model, &job->steer.plan[model].straight.gait, model);
}

// The verdict before any plan: whether the gait, or else the fastest that the limits allow, which then takes its place,
// makes way along every course of the path.
static moray_status check_courses(path_job *job, moray_model model, moray_gait *gait)
{
    steer_job *steer = &job->steer;
    moray_straight_motion straight;
    MORAY_TRY(moray_straight_motion_find(&straight, &steer->snake.robot, model, gait));
    const moray_status verdict = moray_path_passable(&job->path, straight.speed, steer->snake.current);
    if (!moray_failed(verdict) || steer_gait_given(steer) || (model == MORAY_FIRST_PRINCIPLES && !job->find_gait))
        return verdict;
    MORAY_TRY(steer_fastest_gait(steer, model, steer_limits(steer, model).power, gait));
    MORAY_TRY(steer_interruption());
    MORAY_TRY(moray_straight_motion_find(&straight, &steer->snake.robot, model, gait));
    return moray_path_passable(&job->path, straight.speed, steer->snake.current);
}

// The corners of the plans, by the circle of the gait that they begin from.
static moray_status make_room(path_job *job, const moray_gait *gait)
{
    moray_straight_motion straight;
    MORAY_TRY(moray_straight_motion_find(&straight, &job->steer.snake.robot, MORAY_CONTROL_ORIENTED, gait));
    MORAY_TRY(steer_find_turn_rate(&job->steer, MORAY_CONTROL_ORIENTED, gait));
    return round_corners(job, straight.speed / fabs(job->steer.turn_rate[MORAY_CONTROL_ORIENTED]));
}

moray_status path_make_plans(path_job *job)
{
    steer_job *steer = &job->steer;
    const moray_robot *robot = &steer->snake.robot;
    const moray_gait paper = moray_gait_paper(robot);
    moray_gait first = steer_first_gait(steer),
               gait = moray_gait_map(robot, &first, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    if (isnan(job->heading))
        job->heading = job->path.piece->course;
    MORAY_TRY(steer_straight_motions(steer, 0, &paper, MORAY_CONTROL_ORIENTED));
    MORAY_TRY(check_courses(job, MORAY_CONTROL_ORIENTED, &first));
    if (steer->snake.model == MORAY_FIRST_PRINCIPLES)
        MORAY_TRY(check_courses(job, MORAY_FIRST_PRINCIPLES, &gait));
    MORAY_TRY(make_room(job, &first));
    MORAY_TRY(solve(job, MORAY_CONTROL_ORIENTED, true, &first, NULL, &steer->plan[STEER_AVERAGED]));
    MORAY_TRY(make_plan(job, MORAY_CONTROL_ORIENTED, &steer->plan[STEER_AVERAGED].straight.gait,
                        &steer->plan[STEER_AVERAGED]));
    if (steer->snake.model == MORAY_CONTROL_ORIENTED)
        return moray_ok();
    steer_clock_give(&steer->clock, 0.3);
    if (job->find_gait && !steer_gait_given(steer))
        MORAY_TRY(steer_fastest_gait(steer, MORAY_FIRST_PRINCIPLES, steer_limits(steer, MORAY_FIRST_PRINCIPLES).power,
                                     &gait));
    return make_plan(job, MORAY_FIRST_PRINCIPLES, &gait, &steer->plan[MORAY_CONTROL_ORIENTED]);
}
