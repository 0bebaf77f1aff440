// SPDX-License-Identifier: MIT
//
// The law of steering: numbers that are given, else those of a law of the run, else where the tuning of the programs
// that steer begins.
#include "export.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLACE = 96, MOST_PLAN = 1000000 };

// ---- A law of the run ----------------------------------------------------------------------------------------------

// The list of laws in the summary, and how a law is named and judged there.
typedef struct listed {
    const char *list, *cost;
    bool trials; // of a program that steers, which has laws of its own plans besides
} listed;

static listed list_of(const export_found *found)
{
    if (moray_json_count_at(found->run, "steering") > 0)
        return (listed){"steering", found->law == EXPORT_PATH ? "validated.cost" : "validated.rms_deg", true};
    return (listed){moray_json_count_at(found->run, "laws") > 0 ? "laws" : NULL, "training_cost", false};
}

static double number_of(const export_found *found, const char *list, int k, const char *key)
{
    char place[PLACE];
    snprintf(place, sizeof place, "%s.%d.%s", list, k, key);
    return moray_json_number_at(found->run, place);
}

static bool says(const export_found *found, const char *list, int k, const char *key, const char *word)
{
    char place[PLACE];
    snprintf(place, sizeof place, "%s.%d.%s", list, k, key);
    const char *text = moray_json_text_at(found->run, place);
    return text && strcmp(text, word) == 0;
}

// Whether it is a law of the kind that is exported.
static bool suits(const export_found *found, const listed *laws, int k)
{
    static const char *const words[] = {"", "feedback", "line of sight", "plan and feedback"};
    if (isnan(number_of(found, laws->list, k, "gain_m_rad")))
        return false;
    if (laws->trials) // the exported gait is not the paper's, which some trials swim on
        return says(found, laws->list, k, "law", words[found->law]) && !says(found, laws->list, k, "gait", "paper");
    return found->law != EXPORT_PLAN && says(found, laws->list, k, "told", "nothing") && // the others have plans
           isnan(number_of(found, laws->list, k, "lookahead_m")) == (found->law == EXPORT_HEADING);
}

// The law of the least cost; of plans the last, which is the one that trajectory.csv shows.
static int best_law(const export_found *found, const listed *laws)
{
    int best = -1;
    double least = INFINITY;
    for (int k = 0; k < moray_json_count_at(found->run, laws->list); k++) {
        const double cost = found->law == EXPORT_PLAN ? -k : number_of(found, laws->list, k, laws->cost);
        if (suits(found, laws, k) && (cost < least || best < 0)) {
            best = k;
            least = cost;
        }
    }
    return best;
}

static moray_status choose(const export_found *found, const listed *laws, int *chosen)
{
    const int n = moray_json_count_at(found->run, laws->list), wanted = found->job->trial;
    *chosen = wanted ? wanted - 1 : best_law(found, laws);
    if (wanted > n || (wanted && !suits(found, laws, *chosen)))
        return moray_error(MORAY_INPUT,
                           "trial = %d: of the %d laws in %.100s/summary.json that is not one of this kind", wanted, n,
                           found->job->from);
    return moray_ok();
}

// What a summary calls the numbers of a law.
typedef struct source {
    double given, *to;
    const char *key, *other;
    double usual;
} source;

static moray_status take_numbers(export_found *found)
{
    const export_job *job = found->job;
    const bool path = found->law == EXPORT_PATH;
    const source sources[] = {
        {job->gains.proportional, &found->gains.proportional, "gain_m_rad", NULL, path ? 0.06 : 0.12},
        {job->gains.forward, &found->gains.forward, "forward_m_s_rad", NULL, 0},
        {job->gains.lead, &found->gains.lead, "lead_s", NULL, 0},
        {job->gains.integral, &found->gains.integral, "integral_1_s", NULL, 0},
        {job->gains.derivative, &found->gains.derivative, "derivative_s", NULL, 0},
        {job->lookahead, &found->lookahead, "lookahead_m", NULL, 2.8},
        {job->ahead, &found->ahead, "ahead_m", NULL, 0.4},
        {job->sight_integral, &found->sight_integral, "integral_m_s", "integral_gain_m_s", 0.02},
    };
    const listed laws = list_of(found);
    int k = -1;
    if (laws.list)
        MORAY_TRY(choose(found, &laws, &k));
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) {
        const source *s = &sources[i];
        double value = s->given;
        if (isnan(value) && k >= 0)
            value = number_of(found, laws.list, k, s->key);
        if (isnan(value) && k >= 0 && s->other)
            value = number_of(found, laws.list, k, s->other);
        *s->to = !isnan(value) ? value : k >= 0 && i > 0 && s->to != &found->lookahead ? 0 : s->usual;
    }
    return moray_ok();
}

// What the run steers by, where the kind of law is not given.
static export_law law_of_run(const export_found *found)
{
    const char *program = moray_json_text_at(found->run, "problem"), *task = moray_json_text_at(found->run, "task");
    if (!program)
        return EXPORT_NONE;
    if (strcmp(program, "path_following") == 0 || (task && strcmp(task, "path") == 0))
        return EXPORT_PATH;
    if (strcmp(program, "heading_tracking") == 0 || (task && strcmp(task, "heading") == 0))
        return EXPORT_HEADING;
    return strcmp(program, "min_time_turn") == 0 ? EXPORT_PLAN : EXPORT_NONE;
}

// ---- A plan --------------------------------------------------------------------------------------------------------

static moray_status sample_plan(export_found *found, const moray_spline *offset, const moray_spline *heading)
{
    const double look = found->job->look;
    double range[2];
    moray_spline_range(offset, range);
    if (!(range[0] <= 0 && range[1] > 0 && range[1] / look < MOST_PLAN))
        return moray_error(MORAY_INPUT,
                           "plan: from t = %g to %g s in steps of %g s: must begin at 0 and take fewer than %d steps",
                           range[0], range[1], look, MOST_PLAN);
    found->n_plan = (int)floor(range[1] / look * (1 + 1e-12)) + 1;
    found->plan = malloc(2 * (size_t)found->n_plan * sizeof *found->plan);
    if (!found->plan)
        return moray_error(MORAY_MEMORY, "no memory for a plan of %d numbers", found->n_plan);
    for (int k = 0; k < found->n_plan; k++) {
        const double t = k * look;
        found->plan[2 * k] = moray_spline_real(offset, t, NULL);
        found->plan[2 * k + 1] =
            moray_straight_motion_heading(&found->straight, t, moray_spline_real(heading, t, NULL));
    }
    return moray_ok();
}

static moray_status read_plan(export_found *found)
{
    char path[MORAY_PATH_SIZE + 20];
    const export_job *job = found->job;
    moray_spline *offset = NULL, *heading = NULL;
    if (!job->plan_file[0] && !job->from[0])
        return moray_error(MORAY_INPUT, "--law plan: --plan FILE or --from DIR must tell phi_0(t) and the heading");
    if (job->plan_file[0])
        snprintf(path, sizeof path, "%s", job->plan_file);
    else
        snprintf(path, sizeof path, "%s/trajectory.csv", job->from);
    moray_status status = moray_spline_read(&offset, path, "t", "phi_0", MORAY_NOT_A_KNOT, MORAY_HOLD);
    if (!moray_failed(status))
        status = moray_spline_read(&heading, path, "t", "heading", MORAY_NOT_A_KNOT, MORAY_HOLD);
    if (!moray_failed(status))
        status = sample_plan(found, offset, heading);
    moray_spline_free(offset);
    moray_spline_free(heading);
    return status;
}

// ---- All -----------------------------------------------------------------------------------------------------------

static moray_status read_path(export_found *found)
{
    if (!found->job->path_text[0])
        return moray_error(MORAY_INPUT, "--law path: --path must tell the waypoints");
    return moray_path_read(&found->path, found->job->path_text, found->job->radius);
}

moray_status export_gather_law(export_found *found)
{
    const export_job *job = found->job;
    const moray_robot *robot = &job->snake.robot;
    found->law = job->law < 0 ? law_of_run(found) : (export_law)job->law;
    if (found->law == EXPORT_NONE)
        return moray_ok();
    if (found->gait.series)
        return moray_error(MORAY_INPUT,
                           "--law: a gait with a series has no joint offset to steer by; give a gait (25)");
    if (fabs(found->gait.offset) > 1e-9)
        return moray_error(MORAY_INPUT, "phi0_deg = %g: the law of steering sets the joint offset; must be 0",
                           found->gait.offset / DEG);
    found->gait.offset = 0;
    MORAY_TRY(take_numbers(found));
    const moray_gait other = moray_gait_map(robot, &found->gait, MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED);
    if (!(fabs(other.amplitude) > 0))
        return moray_error(MORAY_INPUT, "alpha_deg = 0: a robot without a gait is not steered");
    found->scale = -found->gait.amplitude / other.amplitude; // erratum E3
    found->offset = fabs(found->scale) * job->offset;
    found->offset_rate = fabs(found->scale) * job->offset_rate;
    MORAY_TRY(moray_straight_motion_find(&found->straight, robot, MORAY_FIRST_PRINCIPLES, &found->gait));
    if (found->law == EXPORT_PATH)
        MORAY_TRY(read_path(found));
    return found->law == EXPORT_PLAN ? read_plan(found) : moray_ok();
}
