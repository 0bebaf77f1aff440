// SPDX-License-Identifier: MIT
#include "turn.h"

static const int periods_after = 6; // swum behind the last plan

// ---- Laws ----------------------------------------------------------------------------------------------------------

enum { BANG, BRAKE, PLAN, BOTH };
enum { HOLD, BRAKING, GAIN, NUMBERS };

// Of the heading without its undulation: from when on it stays within the band around where it is to be (NaN: it does
// not) [s]; the integral of how far it is outside, or 1 where that is more, over the band [s]; how far off it is over
// the last period [rad]; how near the robot came to the end position [m]; mean power [W].
enum { SETTLED, WEIGHTED, FINAL, MISS, POWER, SCORES };

static const steer_number numbers[NUMBERS] = {
    [HOLD] = {.key = "hold_s"}, // their ranges: by the turn
    [BRAKING] = {.key = "brake_s"},
    [GAIN] = {"gain_m_rad", .searched = {MORAY_TUNED_LOGARITHMIC, 0.002, 20, 0}},
};

// The offset ramps up to its limit, stays there, goes to the other limit if it brakes, and comes to rest.
static moray_offset bang_offset(double t, const void *self)
{
    const struct steer_bang *b = self;
    const double rate = b->limit / b->ramp, low = b->brake > 0 ? -fmin(b->brake / b->ramp, 1) : 0;
    const double down = b->ramp + b->hold, rest = down + (1 - low) * b->ramp;
    const double up = rest + fmax(b->brake - b->ramp, 0), end = up - low * b->ramp;
    if (t < b->ramp)
        return (moray_offset){.value = rate * t, .rate = rate};
    if (t < down)
        return (moray_offset){.value = b->limit};
    if (t < rest)
        return (moray_offset){.value = b->limit - rate * (t - down), .rate = -rate};
    if (t < up)
        return (moray_offset){.value = low * b->limit};
    if (t < end)
        return (moray_offset){.value = low * b->limit + rate * (t - up), .rate = rate};
    return (moray_offset){0};
}

static moray_status set_bang(steer_steersman *h)
{
    const turn_job *job = (const turn_job *)h->job;
    const moray_steering_limits limits = steer_limits(h->job, h->model);
    const double side = job->angle * h->job->turn_rate[h->model] < 0 ? -1 : 1, *number = h->trial->number;
    h->own.bang =
        (struct steer_bang){side * limits.offset, limits.offset / limits.offset_rate, number[HOLD], number[BRAKING]};
    h->controller = (moray_swim_controller){.offset = bang_offset, .self = &h->own.bang};
    return moray_ok();
}

static const steer_law laws[] = {
    [BANG] = {"bang-bang", .set = set_bang, .tuned = 1 << HOLD, .start = {0, 0, NAN}, .curve = 1},
    [BRAKE] = {"bang-bang, braking", .set = set_bang, .tuned = 1 << HOLD | 1 << BRAKING, .start = {0, 0, NAN},
               .curve = 2},
    [PLAN] = {"plan", STEER_PLANNED, .start = {NAN, NAN, NAN}, .curve = 3},
    [BOTH] = {"plan and feedback", STEER_PLANNED, .set = steer_set_both, .tuned = 1 << GAIN, .start = {NAN, NAN, 0.06}},
};

// Bang-bang steering knows of no position.
static void choose_trials(turn_job *job)
{
    steer_job *steer = &job->steer;
    const double steady = fabs(job->angle / steer->turn_rate[MORAY_FIRST_PRINCIPLES]);
    const moray_steering_limits limits = steer_limits(steer, MORAY_FIRST_PRINCIPLES);
    const double ramp = limits.offset / limits.offset_rate;
    steer->number[HOLD].searched.upper = 2 * steady + 2 * ramp;
    steer->number[BRAKING].searched.upper = 4 * ramp;
    steer_trial *bang = steer_add(steer, "bang-bang", &laws[BANG], 0, MORAY_CONTROL_ORIENTED);
    bang->number[HOLD] = fmax(steady - ramp, 0);
    steer_add(steer, "bang-bang, braking", &laws[BRAKE], 0, MORAY_CONTROL_ORIENTED)->subset[0] = bang;
    steer_add_plans(steer, &laws[PLAN], &laws[BOTH]);
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

static void start(steer_steersman *h, moray_swim_closed_loop_spec *spec)
{
    const double period = 2 * M_PI / h->job->straight[0][h->model].gait.omega;
    spec->duration = 1.5 * steer_duration(steer_last_plan(h->job)->solution) + periods_after * period;
}

static double judge(const steer_trial *trial, const steer_steersman *h, const moray_swim_closed_loop *closed_loop,
                    double *score)
{
    const turn_job *job = (const turn_job *)h->job;
    const moray_straight_motion *straight = &h->job->straight[trial->gait][h->model];
    const moray_swim_track *track = &closed_loop->track;
    const int last = track->n - 1;
    const double period = 2 * M_PI / straight->gait.omega, end = track->t[last], step = end / last;
    double settled = 0, weighted = 0, final = 0, miss = INFINITY;
    int n = 0;
    for (int k = 0; k <= last; k++) {
        const moray_pose *pose = &track->pose[k];
        const double t = track->t[k], error = moray_straight_motion_heading(straight, t, pose->heading) - job->angle;
        if (fabs(error) > job->band)
            settled = t + step;
        weighted += step * fmin(fabs(error) / job->band, 1);
        miss = fmin(miss, hypot(pose->p_x - job->end[0], pose->p_y - job->end[1]));
        if (t > end - period) {
            final += error;
            n++;
        }
    }
    score[SETTLED] = settled > end - period ? NAN : settled;
    score[WEIGHTED] = weighted;
    score[FINAL] = final / n;
    score[MISS] = turn_to_position(job) ? miss : NAN;
    score[POWER] = track->energy[last] / end;
    return weighted;
}

// ---- Table, words --------------------------------------------------------------------------------------------------

static const steer_score scores[SCORES] = {
    {"settled_s", 1}, {"weighted_s", 1}, {"final_deg", DEG}, {"miss_m", 1}, {"power_W", 1}};

static const steer_column score_columns[] = {{"control: time", MORAY_CONTROL_ORIENTED, SETTLED, .unit = 1},
                                             {"error", MORAY_CONTROL_ORIENTED, FINAL, .unit = DEG},
                                             {"first-pr.: time", MORAY_FIRST_PRINCIPLES, SETTLED, .unit = 1},
                                             {"weighted", MORAY_FIRST_PRINCIPLES, WEIGHTED, .unit = 1},
                                             {"error", MORAY_FIRST_PRINCIPLES, FINAL, .unit = DEG},
                                             {"power", MORAY_FIRST_PRINCIPLES, POWER, .unit = 1},
                                             {"tuned by", .score = STEER_SPENT},
                                             {"nearest", MORAY_FIRST_PRINCIPLES, MISS, .unit = 1}};

static void tables(const steer_job *job, steer_tables *tables)
{
    steer_score_table(job, tables, turn_to_position((const turn_job *)job) ? 8 : 7);
}

static void headline(const steer_job *steer, FILE *file)
{
    const turn_job *job = (const turn_job *)steer;
    fprintf(file, "turn by %g deg", job->angle / DEG);
    if (turn_to_position(job))
        fprintf(file, " to (%g, %g) m", job->end[0], job->end[1]);
}

// The plan and bang-bang steering, both swum blindly; with feedback for itself.
static void conclude(const steer_job *steer, char *text, size_t size)
{
    const turn_job *job = (const turn_job *)steer;
    const steer_trial *ours = steer_last_trial(steer, PLAN), *both = steer_last_trial(steer, BOTH);
    const steer_trial *theirs = steer_best(steer, 1 << BANG | 1 << BRAKE, WEIGHTED);
    *text = 0;
    if (!ours || !theirs) {
        moray_text_add(text, size, "The time given ended before both planned and bang-bang turns were swum.");
        return;
    }
    const double *a = ours->score[1], *b = theirs->score[1];
    char settled[2][40];
    for (int k = 0; k < 2; k++) {
        const double t = (k ? b : a)[SETTLED];
        snprintf(settled[k], sizeof settled[k], isnan(t) ? "never while it swam" : "after %.2f s", t);
    }
    const double plan = steer_duration(steer_last_plan(steer)->solution);
    if (turn_to_position(job))
        moray_text_add(
            text, size,
            "First-principles model: the %s comes within %.3g cm of the end position; it takes %.2f s. Bang-bang "
            "steering, tuned for the heading alone, passes at %.3g m.",
            ours->name, 100 * a[MISS], plan, b[MISS]);
    else
        moray_text_add(
            text, size,
            "First-principles model, same limits: the %s, swum blindly, is within %.3g deg of its heading %s, "
            "of the tuned bang-bang turns the better (%s) %s; weighted by the error %.3f s against %.3f s%s. "
            "The plan itself takes %.2f s, until offset and turning are at rest.",
            ours->name, job->band / DEG, settled[0], theirs->name, settled[1], a[WEIGHTED], b[WEIGHTED],
            fabs(a[WEIGHTED] / b[WEIGHTED] - 1) < 0.02
                ? ", as good as the same: the fastest turn is a bang-bang one, which the plan finds without trials"
            : a[WEIGHTED] < b[WEIGHTED] ? ""
                                        : ": the plan LOSES",
            plan);
    if (both && turn_to_position(job))
        moray_text_add(text, size, " With feedback around the plan it is %.3g cm.", 100 * both->score[1][MISS]);
    else if (both)
        moray_text_add(text, size, " With feedback around it %.3f s, weighted.", both->score[1][WEIGHTED]);
}

static void turn_explain(const steer_job *job, char *text, size_t size)
{
    const moray_model model = job->snake.model;
    const moray_steering_limits limits = steer_limits(job, model);
    const steer_saturation share = steer_saturation_of(job, model);
    const double rate = fabs(job->turn_rate[model]), angle = ((const turn_job *)job)->angle;
    const char *limited = share.offset > 2 * share.rate   ? "The limit of the offset decides"
                          : share.rate > 2 * share.offset ? "The rate of the offset decides"
                                                          : "Offset and rate decide together";
    steer_say_limit(job, text, size);
    moray_text_add(
        text, size,
        " steadily at %.2f deg/s, %.4g deg in %.2f s; to bring the offset there and back takes %.3g s each. %s: "
        "t",
        rate / DEG, angle / DEG, fabs(angle) / rate, limits.offset / limits.offset_rate, limited);
    steer_say_saturation(job, text, size);
    moray_text_add(
        text, size,
        " The heading swings with every stroke: it counts without the undulation of straight swimming, and the "
        "turn may end in any part of a stroke.");
}

// ---- JSON, figures -------------------------------------------------------------------------------------------------

static void json_head(const steer_job *steer, moray_json *json)
{
    const turn_job *job = (const turn_job *)steer;
    moray_json_number(json, "angle_deg", job->angle / DEG);
    if (turn_to_position(job))
        moray_json_numbers(json, "end_m", job->end, 2);
    moray_json_text(json, "scheme", steer->common.scheme);
    steer_json_gait(steer, json, 0);
}

static void json_plan(const steer_job *job, moray_json *json, moray_model model)
{
    moray_json_number(json, "time_s", steer_duration(job->plan[model].solution));
    moray_json_number(json, "turn_rate_deg_s", fabs(job->turn_rate[model]) / DEG);
    steer_json_saturation(job, json, model);
}

static bool values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values)
{
    for (int k = 0; trial && k < track->n; k++)
        values[k] = moray_straight_motion_heading(&job->straight[0][1], track->t[k], track->pose[k].heading) / DEG;
    return trial != NULL;
}

// ---- The program ---------------------------------------------------------------------------------------------------

static moray_status work(steer_job *steer)
{
    turn_job *job = (turn_job *)steer;
    if (job->angle == 0 && !turn_to_position(job))
        return moray_error(MORAY_INPUT, "angle_deg = 0: must not be, unless there is an end_m");
    const double ends[2][2] = {{0, 0},
                               {turn_to_position(job) ? job->end[0] : 0, turn_to_position(job) ? job->end[1] : 0}};
    MORAY_TRY(steer_read_water(steer, ends, 2));
    const moray_status made = turn_make_plans(job);
    if (moray_failed(made))
        MORAY_TRY(steer_do_without(steer, made));
    choose_trials(job);
    return steer_run_trials(steer);
}

static const moray_meaning words[] = {
    {"bang-bang", "the joint offset at its limit for a time that is tuned, then none"},
    {"braking", "with the other limit before the end"},
    {NULL, NULL},
};

const steer_program turn_steering = {
    .work = work,
    .one_gait = true,
    .laws = laws,
    .numbers = numbers,
    .n_numbers = NUMBERS,
    .rough_per_second = 20,
    .start = start,
    .judge = judge,
    .scores = scores,
    .n_scores = SCORES,
    .title = "min_time_turn: the fastest turn",
    .words = words,
    .score_title = "Time until the heading stays in the band, s; the same, weighted by the error within it; final "
                   "error, deg; power, W; nearest to the end position, m",
    .columns = score_columns,
    .tables = tables,
    .headline = headline,
    .conclude = conclude,
    .explain = turn_explain,
    .duration = "turn of",
    .json_head = json_head,
    .json_plan = json_plan,
    .over_time = {.name = "heading",
                  .title = "Heading without its undulation, first-principles model",
                  .y_label = "heading [deg]"},
    .values = values,
};
