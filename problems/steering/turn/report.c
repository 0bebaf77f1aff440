// SPDX-License-Identifier: MIT
#include "turn.h"

// ---- Table, words --------------------------------------------------------------------------------------------------

const steer_score turn_scores[TURN_SCORES] = {
    {"settled_s", 1}, {"weighted_s", 1}, {"final_deg", DEG}, {"miss_m", 1}, {"power_W", 1}};

const steer_column turn_columns[TURN_COLUMNS] = {{"control: time", MORAY_CONTROL_ORIENTED, TURN_SETTLED, .unit = 1},
                                                 {"error", MORAY_CONTROL_ORIENTED, TURN_FINAL, .unit = DEG},
                                                 {"first-pr.: time", MORAY_FIRST_PRINCIPLES, TURN_SETTLED, .unit = 1},
                                                 {"weighted", MORAY_FIRST_PRINCIPLES, TURN_WEIGHTED, .unit = 1},
                                                 {"error", MORAY_FIRST_PRINCIPLES, TURN_FINAL, .unit = DEG},
                                                 {"power", MORAY_FIRST_PRINCIPLES, TURN_POWER, .unit = 1},
                                                 {"tuned by", .score = STEER_SPENT},
                                                 {"nearest", MORAY_FIRST_PRINCIPLES, TURN_MISS, .unit = 1}};

void turn_tables(const steer_job *job, steer_tables *tables)
{
    steer_score_table(job, tables, turn_to_position((const turn_job *)job) ? TURN_COLUMNS : TURN_COLUMNS - 1);
}

void turn_headline(const steer_job *steer, FILE *file)
{
    const turn_job *job = (const turn_job *)steer;
    fprintf(file, "turn by %g deg", job->angle / DEG);
    if (turn_to_position(job))
        fprintf(file, " to (%g, %g) m", job->end[0], job->end[1]);
}

void turn_conclude(const steer_job *steer, char *text, size_t size)
{
    const turn_job *job = (const turn_job *)steer;
    const steer_trial *ours = steer_best(steer, 1 << TURN_PLAN | 1 << TURN_BOTH, TURN_WEIGHTED);
    const steer_trial *theirs = steer_best(steer, 1 << TURN_BANG | 1 << TURN_BRAKE, TURN_WEIGHTED);
    const double *a = ours->score[1], *b = theirs->score[1];
    const double plan = steer_duration(steer_last_plan(steer)->solution);
    if (turn_to_position(job))
        snprintf(
            text, size,
            "First-principles model: %s comes within %.3g cm of the end position; the plan takes %.2f s. Bang-bang "
            "steering, tuned for the heading alone, passes at %.3g m.",
            ours->name, 100 * a[TURN_MISS], plan, b[TURN_MISS]);
    else
        snprintf(
            text, size,
            "First-principles model, same limits: the best optimised turn (%s) is within %.3g deg of its heading "
            "after %.2f s, of the tuned bang-bang turns the better (%s) after %.2f s; weighted by the error %.3f s "
            "against %.3f s%s. The plan itself takes %.2f s, until offset and turning are at rest.",
            ours->name, job->band / DEG, a[TURN_SETTLED], theirs->name, b[TURN_SETTLED], a[TURN_WEIGHTED],
            b[TURN_WEIGHTED],
            fabs(a[TURN_WEIGHTED] / b[TURN_WEIGHTED] - 1) < 0.02
                ? ", as good as the same: the fastest turn is a bang-bang one, which the plan finds without trials"
            : a[TURN_WEIGHTED] < b[TURN_WEIGHTED] ? ""
                                                  : ": the optimised one LOSES",
            plan);
}

void turn_explain(const steer_job *job, char *text, size_t size)
{
    const moray_model model = job->common.model;
    const moray_steering_limits limits = steer_limits(job, model);
    const steer_saturation share = steer_saturation_of(job, model);
    const double rate = fabs(job->turn_rate[model]), angle = ((const turn_job *)job)->angle;
    const char *limited = share.offset > 2 * share.rate   ? "The limit of the offset decides"
                          : share.rate > 2 * share.offset ? "The rate of the offset decides"
                                                          : "Offset and rate decide together";
    steer_say_limit(job, text, size);
    steer_say(text, size,
              " steadily at %.2f deg/s, %.4g deg in %.2f s; to bring the offset there and back takes %.3g s each. %s: "
              "t",
              rate / DEG, angle / DEG, fabs(angle) / rate, limits.offset / limits.offset_rate, limited);
    steer_say_saturation(job, text, size);
    steer_say(text, size,
              " The heading swings with every stroke: it counts without the undulation of straight swimming, and the "
              "turn may end in any part of a stroke.");
}

// ---- JSON, figures -------------------------------------------------------------------------------------------------

void turn_json_head(const steer_job *steer, moray_json *json)
{
    const turn_job *job = (const turn_job *)steer;
    moray_json_number(json, "angle_deg", job->angle / DEG);
    if (turn_to_position(job))
        moray_json_numbers(json, "end_m", job->end, 2);
    moray_json_text(json, "scheme", steer->common.scheme);
    steer_json_gait(steer, json, 0);
}

void turn_json_plan(const steer_job *job, moray_json *json, moray_model model)
{
    moray_json_number(json, "time_s", steer_duration(job->plan[model].solution));
    moray_json_number(json, "turn_rate_deg_s", fabs(job->turn_rate[model]) / DEG);
    steer_json_saturation(job, json, model);
}

bool turn_values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values)
{
    for (int k = 0; trial && k < track->n; k++)
        values[k] = moray_straight_motion_heading(&job->straight[0][1], track->t[k], track->pose[k].heading) / DEG;
    return trial != NULL;
}
