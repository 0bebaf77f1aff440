// SPDX-License-Identifier: MIT
#include "path.h"

static const double look_every = 0.1; // of a feedback [s]
static const double patience = 1.5;   // times the duration of the plan, before the end is given up

// ---- Laws ----------------------------------------------------------------------------------------------------------

enum { LOS, ILOS, PLAN, BOTH, RECEDING }; // line of sight, without and with integral action
enum { GAIN, LOOKAHEAD, AHEAD, INTEGRAL, NUMBERS };
enum { RMS, SETTLED_RMS, SETTLED_LARGEST, TIME, POWER, COST, SCORES }; // as of moray_path_score; what tuning minimises

static const steer_number numbers[NUMBERS] = {
    [GAIN] = {"gain_m_rad", "gain, cm/deg", 100 * DEG, .searched = {MORAY_TUNED_LOGARITHMIC, 0.002, 20, 0}},
    [LOOKAHEAD] = {"lookahead_m", "lookahead, m", 1, .searched = {MORAY_TUNED_LOGARITHMIC, 0.1, 20, 0}},
    [AHEAD] = {"ahead_m", "ahead, m", 1, .searched = {MORAY_TUNED_LINEAR, 0, 5, 0}},
    [INTEGRAL] = {"integral_gain_m_s", "integral, cm/s", 100, .searched = {MORAY_TUNED_WITH_ZERO, 0, 0.3, 1e-3}},
};

static moray_status set_guidance(steer_steersman *h)
{
    const path_job *job = (const path_job *)h->job;
    const bool planned = h->trial->law->kind == STEER_PLANNED;
    const double *number = h->trial->number;
    h->own.guidance = (moray_guidance){.path = planned ? &job->planned : &job->path,
                                       .plan = planned ? &job->steer.plan[h->trial->plan] : NULL,
                                       .plan_scale = h->plan.scale,
                                       .lookahead = number[LOOKAHEAD],
                                       .ahead = planned ? 0 : number[AHEAD],
                                       .gain = planned ? 0 : number[INTEGRAL],
                                       .period = look_every};
    steer_set_feedback(h, number[GAIN], moray_guidance_target, planned ? moray_guidance_feed : NULL, &h->own.guidance);
    return moray_ok();
}

static moray_status set_receding(steer_steersman *h)
{
    const path_job *job = (const path_job *)h->job;
    const moray_straight_motion *straight = &h->job->straight[h->trial->gait][h->trial->plan];
    moray_path_replanner *replanner = &h->own.path;
    *replanner = (moray_path_replanner){.spec = path_spec(job, h->trial->plan, false),
                                        .horizon = h->job->look_ahead_periods * 2 * M_PI / straight->gait.omega};
    replanner->spec.tube = MORAY_INFINITY;
    replanner->spec.speed =
        job->planned.length / moray_path_duration(&job->planned, 0, straight->speed, h->job->snake.current);
    return steer_set_receding(h, "radau4", moray_path_replan(replanner), &replanner->spec.limits, 0, h->plan.solution);
}

enum { SIGHT = 1 << GAIN | 1 << LOOKAHEAD | 1 << AHEAD };

static const steer_law laws[] = {
    [LOS] = {"line of sight", .set = set_guidance, .tuned = SIGHT, .start = {0.06, 2.8, 0.4, 0}, .curve = 1},
    [ILOS] = {"line of sight", .set = set_guidance, .tuned = SIGHT | 1 << INTEGRAL, .start = {0.06, 2.8, 0.4, 0.02},
              .curve = 2},
    [PLAN] = {"plan", STEER_PLANNED, .start = {NAN, NAN, NAN, NAN}},
    [BOTH] = {"plan and feedback", STEER_PLANNED, .set = set_guidance, .tuned = 1 << GAIN | 1 << LOOKAHEAD,
              .start = {0.06, 1.5, NAN, NAN}, .curve = 3},
    [RECEDING] = {"receding", STEER_RECEDING, .set = set_receding, .start = {NAN, NAN, NAN, NAN}},
};

// Both guidance laws on the gait found and, the first within its time, on the paper's.
static void choose_trials(steer_job *job)
{
    static const char *const names[][2] = {{"LOS, paper's gait", "ILOS, paper's gait"},
                                           {"LOS, gait found", "ILOS, gait found"}};
    const int gaits[2] = {0, 1 + (int)job->snake.model};
    const steer_trial *before[2] = {NULL, NULL};
    for (int g = 0; g < 2; g++) {
        steer_trial *sight = steer_add(job, names[g][0], &laws[LOS], gaits[g], MORAY_CONTROL_ORIENTED);
        steer_trial *integral = steer_add(job, names[g][1], &laws[ILOS], gaits[g], MORAY_CONTROL_ORIENTED);
        sight->subset[0] = before[0]; // of the other gait
        integral->subset[0] = sight;
        integral->subset[1] = before[1];
        before[0] = sight;
        before[1] = integral;
    }
    steer_add_plans(job, &laws[PLAN], &laws[BOTH]);
    steer_add_receding(job, &laws[RECEDING]);
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

static void start(steer_steersman *h, moray_swim_closed_loop_spec *spec)
{
    const path_job *job = (const path_job *)h->job;
    h->seeker = (moray_path_seeker){&job->path, 0};
    spec->heading = job->heading;
    spec->position[0] = job->start[0];
    spec->position[1] = job->start[1];
    spec->duration = patience * steer_duration(steer_last_plan(h->job)->solution);
    spec->observe = moray_path_seek;
    spec->observer = &h->seeker;
}

static double judge(const steer_trial *trial, const steer_steersman *h, const moray_swim_closed_loop *closed_loop,
                    double *score)
{
    const path_job *job = (const path_job *)h->job;
    const moray_path_score s = moray_swim_closed_loop_path_score(closed_loop, &job->path, job->reach);
    const double seconds = isnan(s.time) ? 2 * closed_loop->track.t[closed_loop->track.n - 1] : s.time;
    (void)trial;
    score[RMS] = s.rms;
    score[SETTLED_RMS] = s.settled_rms;
    score[SETTLED_LARGEST] = s.settled_largest;
    score[TIME] = s.time;
    score[POWER] = s.power;
    score[COST] = 100 * s.rms * s.rms * seconds + job->weight_time * seconds;
    return score[COST];
}

static double swum(const steer_job *job, const steer_trial *trial)
{
    const double period = 2 * M_PI / job->straight[trial->gait][trial->plan].gait.omega;
    return trial->record[MORAY_FIRST_PRINCIPLES].plans * job->replan_periods * period;
}

// ---- Tables --------------------------------------------------------------------------------------------------------

static const steer_score scores[SCORES] = {{"rms_m", 1},  {"settled_rms_m", 1}, {"settled_largest_m", 1},
                                           {"time_s", 1}, {"power_W", 1},       {"cost", 1}};

static const steer_column score_columns[] = {{"control: RMS", MORAY_CONTROL_ORIENTED, RMS, .unit = 0.01},
                                             {"time", MORAY_CONTROL_ORIENTED, TIME, .unit = 1},
                                             {"first-pr.: RMS", MORAY_FIRST_PRINCIPLES, RMS, .unit = 0.01},
                                             {"settled", MORAY_FIRST_PRINCIPLES, SETTLED_RMS, .unit = 0.01},
                                             {"largest", MORAY_FIRST_PRINCIPLES, SETTLED_LARGEST, .unit = 0.01},
                                             {"time", MORAY_FIRST_PRINCIPLES, TIME, .unit = 1},
                                             {"cost", MORAY_FIRST_PRINCIPLES, COST, .unit = 1},
                                             {"power", MORAY_FIRST_PRINCIPLES, POWER, .unit = 1}};

static void leg_table(const path_job *job, steer_tables *tables)
{
    moray_table table = {.title = "Path; crab angle: heading less course, asked for by the current and planned",
                         .columns = {"length, m", "course, deg", "crab, deg", "planned", "turning, deg/s"},
                         .n_columns = 5};
    for (int k = 0; k < job->path.n && k < STEER_ROWS; k++) {
        const moray_path_piece *piece = &job->path.piece[k];
        const bool leg = piece->curvature == 0;
        double asked = NAN, planned = NAN;
        if (leg)
            path_crab(job, piece, &asked, &planned);
        snprintf(tables->label[k], sizeof *tables->label, leg ? "leg %d" : "corner behind leg %d", piece->leg);
        tables->rows[tables->n][table.n_rows++] =
            (moray_table_row){.label = tables->label[k],
                              .value = {piece->length, piece->course / DEG, asked / DEG, planned / DEG,
                                        leg ? NAN : path_turning(job, piece) / DEG}};
    }
    steer_add_table(tables, &table);
}

static void tables(const steer_job *job, steer_tables *tables)
{
    steer_gait_table(job, tables, 0);
    leg_table((const path_job *)job, tables);
    steer_score_table(job, tables, sizeof score_columns / sizeof *score_columns);
    steer_tuning_table(job, tables);
}

// ---- In words ------------------------------------------------------------------------------------------------------

static void headline(const steer_job *steer, FILE *file)
{
    const path_job *job = (const path_job *)steer;
    fprintf(file, "path %s, radius %g m, from (%g, %g)", job->path_text, job->radius, job->start[0], job->start[1]);
}

// One planner beside the guidance tuned on the same gait; receding horizon for itself.
static void conclude(const steer_job *job, char *text, size_t size)
{
    const steer_trial *plan = steer_last_trial(job, BOTH), *receding = steer_last_trial(job, RECEDING);
    const steer_trial *rival = steer_best_on(job, 1 + (int)job->snake.model, 1 << LOS | 1 << ILOS, COST);
    *text = 0;
    if (!plan || !rival) {
        moray_text_add(text, size, "The time given ended before both the plan and tuned guidance were swum.");
        return;
    }
    const double *a = plan->score[1], *b = rival->score[1];
    moray_text_add(text, size,
                   "First-principles model, same limits, same gait: the %s takes %.2f s with a settled RMS cross-track "
                   "error of %.2f cm, the better of the tuned guidances (%s) %.2f s and %.2f cm; in what both were to "
                   "minimise %.2f against %.2f%s.",
                   plan->name, a[TIME], 100 * a[SETTLED_RMS], rival->name, b[TIME], 100 * b[SETTLED_RMS], a[COST],
                   b[COST], a[COST] < b[COST] ? "" : ": the plan LOSES");
    if (receding)
        moray_text_add(text, size, " In receding horizon (%s) it is %.2f.", receding->name, receding->score[1][COST]);
}

// ---- JSON, figures -------------------------------------------------------------------------------------------------

static void json_head(const steer_job *steer, moray_json *json)
{
    const path_job *job = (const path_job *)steer;
    moray_json_text(json, "path", job->path_text);
    moray_json_number(json, "length_m", job->path.length);
    moray_json_text(json, "scheme", steer->common.scheme);
    moray_json_open_list(json, "legs");
    for (int k = 0; k < job->path.n; k++) {
        const moray_path_piece *leg = &job->path.piece[k];
        double asked, planned;
        if (leg->curvature != 0)
            continue;
        path_crab(job, leg, &asked, &planned);
        moray_json_object(json, NULL,
                          MORAY_MEMBERS({"leg", leg->leg}, {"course_deg", leg->course / DEG},
                                        {"crab_by_triangle_deg", asked / DEG}, {"crab_planned_deg", planned / DEG}));
    }
    moray_json_close(json);
}

static void json_plan(const steer_job *job, moray_json *json, moray_model model)
{
    moray_json_number(json, "time_s", steer_duration(job->plan[model].solution));
    steer_json_gait(job, json, 1 + (int)model);
}

static void json_tail(const steer_job *steer, moray_json *json)
{
    const path_job *job = (const path_job *)steer;
    double turning = 0;
    for (int k = 0; k < job->path.n; k++)
        turning = fmax(turning, path_turning(job, &job->path.piece[k]));
    moray_json_open(json, "limits");
    moray_json_number(json, "turn_rate_deg_s", fabs(steer->turn_rate[steer->snake.model]) / DEG);
    moray_json_number(json, "corner_turn_rate_deg_s", turning / DEG);
    steer_json_saturation(steer, json, steer->snake.model);
    moray_json_close(json);
}

static bool values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values)
{
    double along = 0;
    for (int k = 0; trial && k < track->n; k++) {
        const moray_pose *pose = &track->pose[k];
        moray_path_project(&((const path_job *)job)->path, pose->p_x, pose->p_y, &along, &values[k]);
        values[k] *= 100;
    }
    return trial != NULL;
}

static void points(const steer_job *steer, double x[STEER_POINTS], double y[STEER_POINTS])
{
    const moray_path *path = &((const path_job *)steer)->path;
    for (int k = 0; k < STEER_POINTS; k++) {
        const moray_path_point at = moray_path_at(path, path->length * k / (STEER_POINTS - 1));
        x[k] = creal(at.x);
        y[k] = creal(at.y);
    }
}

// ---- The program ---------------------------------------------------------------------------------------------------

static moray_status read_water(path_job *job)
{
    enum { places = 50 };
    double place[places][2];
    for (int k = 0; k < places; k++) {
        const moray_path_point at = moray_path_at(&job->path, job->path.length * k / (places - 1));
        place[k][0] = creal(at.x);
        place[k][1] = creal(at.y);
    }
    return steer_read_water(&job->steer, (const double(*)[2])place, places);
}

static moray_status work(steer_job *steer)
{
    path_job *job = (path_job *)steer;
    MORAY_TRY(moray_path_read(&job->path, job->path_text, job->radius));
    MORAY_TRY(read_water(job));
    const moray_status made = path_make_plans(job);
    if (moray_failed(made))
        MORAY_TRY(steer_do_without(steer, made));
    choose_trials(steer);
    return steer_run_trials(steer);
}

static void release(steer_job *steer)
{
    moray_path_free(&((path_job *)steer)->path);
    moray_path_free(&((path_job *)steer)->planned);
}

static const moray_meaning words[] = {
    {"LOS", "line of sight: steering for a point of the path some way ahead"},
    {"ILOS", "with an integral of the cross-track error, against the current"},
    {"settled", "without the first way to the path"},
    {"cross-track error", "distance of the centre of mass from the path"},
    {"crab angle", "heading less course: how far the robot points into the current"},
    {NULL, NULL},
};

const steer_program path_steering = {
    .work = work,
    .release = release,
    .laws = laws,
    .numbers = numbers,
    .n_numbers = NUMBERS,
    .rough_per_second = 20,
    .start = start,
    .judge = judge,
    .scores = scores,
    .n_scores = SCORES,
    .title = "path_following: a path followed in a current",
    .words = words,
    .score_title = "Cross-track error, cm (settled: without the first way to the path); time to the end, s; cost as in "
                   "the objective; power, W",
    .columns = score_columns,
    .tables = tables,
    .headline = headline,
    .conclude = conclude,
    .explain = path_explain,
    .doubt = path_doubt,
    .swum = swum,
    .tells_name = true,
    .json_head = json_head,
    .json_plan = json_plan,
    .json_tail = json_tail,
    .over_time = {.name = "across",
                  .title = "Cross-track error, first-principles model",
                  .y_label = "to the left of the path [cm]"},
    .values = values,
    .path = points,
};
