// SPDX-License-Identifier: MIT
//
// The laws, each behind the same instruments, on the same gait.
#include "sea.h"

#include <string.h>

static const double look_every = 0.1; // [s]
static const double smoothing = 0.5;  // of the heading whose rate a derivative is [s]
static const double reach = 3;        // of a path, before which its way does not count as settled [m]

enum { GAIN, FORWARD, LEAD, INTEGRAL, DERIVATIVE }; // heading
enum { LOOKAHEAD = 1, AHEAD, SIGHT_INTEGRAL };      // path, behind the gain
enum { NOTHING = -1 };

const moray_tuned_number sea_numbers[2][SEA_NUMBERS] = {{{MORAY_TUNED_LOGARITHMIC, 0.002, 20, 0},
                                                         {MORAY_TUNED_WITH_ZERO, 0, 20, 0.05},
                                                         {MORAY_TUNED_WITH_ZERO, 0, 8, 0.1},
                                                         {MORAY_TUNED_WITH_ZERO, 0, 20, 0.01},
                                                         {MORAY_TUNED_WITH_ZERO, 0, 5, 0.05}},
                                                        {{MORAY_TUNED_LOGARITHMIC, 0.002, 20, 0},
                                                         {MORAY_TUNED_LOGARITHMIC, 0.1, 20, 0},
                                                         {MORAY_TUNED_WITH_ZERO, 0, 5, 0.1},
                                                         {MORAY_TUNED_WITH_ZERO, 0, 0.3, 1e-3}}};
const char *const sea_number_names[2][SEA_NUMBERS] = {
    {"gain_m_rad", "forward_m_s_rad", "lead_s", "integral_1_s", "derivative_s"},
    {"gain_m_rad", "lookahead_m", "ahead_m", "integral_m_s"}};

#define NO_SUBSET                                                                                                      \
    {                                                                                                                  \
        NOTHING, NOTHING, NOTHING                                                                                      \
    }

static const sea_law heading_laws[] = {
    {"P", "nothing", 1 << GAIN, {0.12}, NO_SUBSET, false, 0},
    {"P, rate fed forward", "nothing", 1 << GAIN | 1 << FORWARD, {0.12, 0.2}, {0, NOTHING, NOTHING}, false, 0},
    {"PID",
     "nothing",
     1 << GAIN | 1 << INTEGRAL | 1 << DERIVATIVE,
     {0.12, 0, 0, 0.05, 0.5},
     {0, NOTHING, NOTHING},
     false,
     0},
    {"P ahead", "nothing", 1 << GAIN | 1 << LEAD, {0.12, 0, 2}, {0, NOTHING, NOTHING}, false, 0},
    {"PID and rate, ahead", "nothing", 31, {0.12, 0.2, 2, 0.05, 0.5}, {1, 2, 3}, false, 0},
    {"PI, rate, by collocation",
     "nothing",
     1 << GAIN | 1 << FORWARD | 1 << INTEGRAL,
     {0.05, 0.05},
     NO_SUBSET,
     true,
     SEA_TOLD},
    {"receding, told", "all", 0, {0}, NO_SUBSET, false, SEA_TOLD},
    {"receding, believing", "beliefs", 0, {0}, NO_SUBSET, false, SEA_BELIEVING},
    {"receding, estimating", "beliefs", 0, {0}, NO_SUBSET, false, SEA_ESTIMATING},
    {"plan and feedback", "beliefs", 1 << GAIN | 1 << LEAD, {0.12, 0, 0.2}, NO_SUBSET, false, SEA_BEFOREHAND},
    {"robust plan", "training", 0, {0.12}, NO_SUBSET, false, SEA_OVER_ALL}};

static const sea_law path_laws[] = {
    {"LOS", "nothing", 7, {0.06, 2.8, 0.4}, NO_SUBSET, false, 0},
    {"ILOS", "nothing", 15, {0.06, 2.8, 0.4, 0.02}, {0, NOTHING, NOTHING}, false, 0},
    {"receding, told", "all", 0, {0}, NO_SUBSET, false, SEA_TOLD},
    {"receding, believing", "beliefs", 0, {0}, NO_SUBSET, false, SEA_BELIEVING},
    {"receding, estimating", "beliefs", 0, {0}, NO_SUBSET, false, SEA_ESTIMATING},
    {"plan and feedback", "beliefs", 1 << GAIN | 1 << LOOKAHEAD, {0.06, 1.5}, NO_SUBSET, false, SEA_BEFOREHAND}};

int sea_laws(const sea_job *job, const sea_law **laws)
{
    *laws = job->task == SEA_HEADING ? heading_laws : path_laws;
    return job->task == SEA_HEADING ? sizeof heading_laws / sizeof *heading_laws : sizeof path_laws / sizeof *path_laws;
}

// ---- Who steers ----------------------------------------------------------------------------------------------------

typedef struct steersman {
    moray_plan plan;
    moray_robust_plan robust;     // owned
    int unplanned;                // plans that failed, with another in their place
    double early, ahead;          // of a plan: what is fed forward, and all of it, for what is late behind it [s]
    const moray_reading *reading; // the newest: a plan's heading is that of when it was taken
    moray_feedback feedback;
    moray_heading_law law;
    moray_guidance guidance;
    moray_heading_replanner heading;
    moray_path_replanner path;
    moray_adaptive *adaptive;
    moray_swim_controller controller;
    moray_instruments *instruments;
    moray_path_seeker seeker;
} steersman;

static double planned_heading(const moray_swim_sample *sample, void *self)
{
    const steersman *h = self;
    double t0, t1, x[MORAY_STEERING_STATES];
    (void)sample;
    moray_solution_times(h->plan.solution, 0, &t0, &t1);
    moray_solution_at(h->plan.solution, 0, fmin(h->reading->t + h->ahead, t1), x, NULL);
    return x[MORAY_STATE_THETA];
}

static double planned_offset(const moray_swim_sample *sample, double t, void *self)
{
    const steersman *h = self;
    (void)sample;
    return moray_plan_offset(&h->plan, t + h->early + h->ahead).value;
}

static void follow_plan(steersman *h, const sea_job *job, const sea_draw *draw, double ahead)
{
    h->plan = (moray_plan){draw->plan.solution, job->scale};
    h->early = job->actuators.dead_time;
    h->ahead = ahead;
    h->feedback.target = planned_heading;
    h->feedback.feed = planned_offset;
    h->feedback.self = h;
}

static double robust_heading(const moray_swim_sample *sample, void *self)
{
    const steersman *h = self;
    (void)sample;
    return moray_robust_plan_heading(&h->robust, h->reading->t + h->ahead);
}

static double robust_offset(const moray_swim_sample *sample, double t, void *self)
{
    const steersman *h = self;
    (void)sample;
    return h->plan.scale * moray_robust_plan_wanted(&h->robust, t + h->early + h->ahead);
}

static void set_feedback(steersman *h, const sea_job *job, const sea_draw *draw, bool planned, const double *number)
{
    h->feedback = (moray_feedback){.gain = job->scale * number[GAIN],
                                   .straight = &job->believed_straight,
                                   .offset = job->offset * fabs(job->scale),
                                   .offset_rate = job->offset_rate * fabs(job->scale),
                                   .period = look_every};
    if (job->task == SEA_HEADING && planned) {
        follow_plan(h, job, draw, number[LEAD]);
    } else if (job->task == SEA_HEADING) {
        h->law = (moray_heading_law){
            .gains = {number[GAIN], number[FORWARD], number[LEAD], number[INTEGRAL], number[DERIVATIVE]},
            .reference = &draw->reference,
            .feedback = &h->feedback,
            .scale = job->scale,
            .smoothing = smoothing};
        h->feedback.target = moray_heading_law_target;
        h->feedback.feed = moray_heading_law_feed;
        h->feedback.self = &h->law;
    } else {
        h->guidance = (moray_guidance){.path = &job->path,
                                       .plan = planned ? &job->plan : NULL,
                                       .plan_scale = job->scale,
                                       .lookahead = number[LOOKAHEAD],
                                       .ahead = number[AHEAD],
                                       .gain = number[SIGHT_INTEGRAL],
                                       .period = look_every};
        h->feedback.target = moray_guidance_target;
        h->feedback.feed = planned ? moray_guidance_feed : NULL;
        h->feedback.self = &h->guidance;
    }
    h->controller = moray_feedback_controller(&h->feedback);
}

// As far ahead of time as the plan with feedback is tuned to be. Without a plan over all robots, that one.
static moray_status set_robust(steersman *h, const sea_job *job, const sea_draw *draw, const sea_law *law)
{
    const sea_law *laws;
    const int n = sea_laws(job, &laws);
    for (int k = 0; k < n; k++)
        if (laws[k].knows == SEA_BEFOREHAND)
            set_feedback(h, job, draw, true, job->number[k]);
    const moray_status status = sea_robust_plan(job, draw, law->start, &h->robust);
    h->unplanned = status.code == MORAY_NOT_SOLVED;
    if (h->unplanned)
        return moray_ok();
    MORAY_TRY(status);
    h->early = job->actuators.dead_time - sea_lag(job); // the plan has the lag of what is fed back too
    h->feedback.gain = job->scale * h->robust.gain;
    h->feedback.target = robust_heading;
    h->feedback.feed = robust_offset;
    return moray_ok();
}

moray_heading_spec sea_heading_spec(const sea_job *job, const sea_draw *draw)
{
    const double error_unit = 10 * DEG;
    return (moray_heading_spec){.robot = job->believed,
                                .model = MORAY_CONTROL_ORIENTED,
                                .averaged = true,
                                .current = {job->belief.current[0], job->belief.current[1]},
                                .weight = {1 / (error_unit * error_unit), 0, job->weight_steering},
                                .reference = &draw->reference,
                                .max_error = MORAY_INFINITY};
}

moray_path_spec sea_path_spec(const sea_job *job, double speed)
{
    const double across_unit = 0.1, seconds = 10 * job->path.length / speed;
    return (moray_path_spec){
        .robot = job->believed,
        .model = MORAY_CONTROL_ORIENTED,
        .averaged = true,
        .current = {job->belief.current[0], job->belief.current[1]},
        .weight = {1 / (across_unit * across_unit * seconds), 1 / seconds, job->weight_steering / seconds},
        .path = &job->path,
        .tube = MORAY_INFINITY,
        .reach = reach,
        .speed = speed};
}

static void pose_problems(steersman *h, const sea_job *job, const sea_draw *draw, double speed, double horizon)
{
    h->heading = (moray_heading_replanner){.spec = sea_heading_spec(job, draw), .horizon = horizon, .preview = true};
    h->path = (moray_path_replanner){.spec = sea_path_spec(job, speed), .horizon = horizon};
}

moray_navigator_spec sea_navigator_spec(const sea_job *job, const sea_draw *draw, int knows)
{
    const bool told = knows == SEA_TOLD, estimates = knows == SEA_ESTIMATING, path = job->task == SEA_PATH;
    const double current_doubt = 0.1, factor_doubt = 0.15, least_heading = 0.5 * DEG, least_position = 0.02;
    const double least_rate = 1 * DEG; // what the averaged plant leaves of a stroke
    double rate;
    return (moray_navigator_spec){.robot = job->believed,
                                  .gait = job->gait,
                                  .heading =
                                      path ? job->path.piece->course : moray_reference_at(&draw->reference, 0, &rate),
                                  .position = {0, path ? SEA_BESIDE : 0},
                                  .speed = told ? draw->straight.speed : job->believed_straight.speed,
                                  .belief = told ? draw->truth : job->belief,
                                  .current_doubt = estimates ? current_doubt : 0,
                                  .factor_doubt = estimates ? factor_doubt : 0,
                                  .heading_error = hypot(job->sensors.heading, least_heading),
                                  .position_error = hypot(job->sensors.position, least_position),
                                  .rate_error = job->sensors.gyro ? hypot(job->sensors.rate, least_rate) : 0};
}

static moray_status set_receding(steersman *h, const sea_job *job, const sea_draw *draw, const sea_law *law)
{
    const double period = 2 * M_PI / job->gait.omega, horizon = job->look_ahead_periods * period;
    const moray_straight_motion *known = law->knows == SEA_TOLD ? &draw->straight : &job->believed_straight;
    pose_problems(h, job, draw, known->speed, horizon);
    moray_adaptive_spec spec = {.navigator = sea_navigator_spec(job, draw, law->knows),
                                .measured = known,
                                .scale = job->scale,
                                .limits = {.offset = job->offset, .offset_rate = job->offset_rate},
                                .heading = job->task == SEA_HEADING ? &h->heading : NULL,
                                .path = job->task == SEA_PATH ? &h->path : NULL,
                                .settings = moray_settings_default(),
                                .horizon = horizon,
                                .interval = job->replan_periods * period,
                                .look = look_every,
                                .dead_time = job->actuators.dead_time};
    spec.settings.scheme = "radau3";
    spec.settings.intervals = (int)ceil(3 * job->look_ahead_periods);
    spec.settings.tolerance = 1e-6;
    spec.settings.max_iterations = 100;
    MORAY_TRY(moray_adaptive_new(&h->adaptive, &spec));
    h->controller = moray_adaptive_controller(h->adaptive);
    return moray_ok();
}

// ---- A trial -------------------------------------------------------------------------------------------------------

static void judge(const sea_job *job, const sea_draw *draw, const moray_swim_closed_loop *closed_loop, sea_score *score)
{
    const int last = closed_loop->track.n - 1;
    if (job->task == SEA_HEADING) {
        const moray_heading_score s =
            moray_swim_closed_loop_heading_score(closed_loop, &draw->straight, &draw->reference);
        score->value[0] = s.rms;
        score->value[1] = s.largest;
        score->value[2] = s.power;
        score->cost = s.rms * s.rms / (100 * DEG * DEG);
    } else {
        const moray_path_score s = moray_swim_closed_loop_path_score(closed_loop, &job->path, reach);
        const double seconds = isnan(s.time) ? closed_loop->track.t[last] : s.time;
        score->value[0] = s.rms;
        score->value[1] = seconds;
        score->value[2] = score->cost = 100 * s.rms * s.rms * seconds + seconds;
    }
    score->known = true;
}

static moray_status swim(const sea_job *job, const sea_draw *draw, steersman *h, moray_swim_closed_loop *closed_loop)
{
    const moray_swim_controller outer = moray_instruments_controller(h->instruments);
    const moray_swim_on_gait how = {.steps = 24};
    double rate;
    moray_swim_closed_loop_spec spec = {.robot = &draw->robot,
                                        .straight = &draw->straight,
                                        .heading = moray_reference_at(&draw->reference, 0, &rate),
                                        .current = {draw->current[0], draw->current[1]},
                                        .current_turning = draw->current_turning,
                                        .controller = &outer,
                                        .torque = job->actuators.torque,
                                        .duration = job->duration,
                                        .intervals = (int)ceil(10 * job->duration),
                                        .tolerance = 1e-5,
                                        .on_gait = job->actuators.torque > 0 ? NULL : &how};
    if (job->task == SEA_PATH) {
        spec.heading = job->path.piece->course;
        spec.position[1] = SEA_BESIDE;
        h->seeker = (moray_path_seeker){&job->path, 0};
        spec.observe = moray_path_seek;
        spec.observer = &h->seeker;
    }
    return moray_swim_closed_loop_run(closed_loop, &spec);
}

static moray_status set_law(steersman *h, const sea_job *job, const sea_draw *draw, const sea_law *law,
                            const double *number)
{
    if (law->knows == SEA_OVER_ALL)
        return set_robust(h, job, draw, law);
    if (!law->tuned)
        return set_receding(h, job, draw, law);
    set_feedback(h, job, draw, law->knows == SEA_BEFOREHAND, number);
    return moray_ok();
}

static moray_status set_out(const sea_job *job, const sea_draw *draw, int which, const double *number, steersman *h,
                            moray_swim_closed_loop *closed_loop)
{
    const sea_law *laws;
    moray_sensors sensors = job->sensors;
    sea_laws(job, &laws);
    sensors.seed = draw->seed; // the same errors for every law
    MORAY_TRY(set_law(h, job, draw, &laws[which], number));
    MORAY_TRY(moray_instruments_new(&h->instruments, &sensors, &job->actuators, &draw->straight, draw->robot.links,
                                    &h->controller));
    h->law.reading = h->reading = moray_instruments_reading(h->instruments);
    if (h->adaptive)
        moray_adaptive_look_at(h->adaptive, h->reading);
    return swim(job, draw, h, closed_loop);
}

static void dismiss(steersman *h)
{
    moray_adaptive_free(h->adaptive);
    moray_instruments_free(h->instruments);
    moray_robust_plan_free(&h->robust);
}

moray_status sea_record(const sea_job *job, const sea_draw *draw, int which, const double *number,
                        moray_swim_closed_loop *closed_loop)
{
    steersman h = {0};
    const moray_status status = set_out(job, draw, which, number, &h, closed_loop);
    dismiss(&h);
    return status;
}

moray_status sea_swim(const sea_job *job, const sea_draw *draw, int which, const double *number, sea_score *score)
{
    steersman h = {0};
    moray_swim_closed_loop closed_loop;
    *score = (sea_score){0};
    const moray_status status = set_out(job, draw, which, number, &h, &closed_loop);
    if (!moray_failed(status)) {
        judge(job, draw, &closed_loop, score);
        moray_swim_closed_loop_free(&closed_loop);
    }
    score->failures = h.adaptive ? moray_adaptive_record(h.adaptive)->failures : h.unplanned;
    dismiss(&h);
    return status;
}
