// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <string.h>

#include "way.h"

static const char *const kinds[] = {"a gait for each place", "the best of these all the way", "the paper's gait"};
enum { KINDS = 3, TEXT = 2 * MORAY_PATH_SIZE + 1000 };

struct sheet {
    moray_table table[2];
    moray_table_row place[WAY_PLACES], total[KINDS];
    char label[WAY_PLACES][40], text[TEXT], words[600];
};

static double theta_max_of(const way_job *run, const moray_gait *gait)
{
    return moray_theta_max_from_amplitude(&run->job.snake.robot, run->job.snake.model, gait->amplitude, gait->delta);
}

static moray_budget budget_of(const way_job *run, const moray_gait_prediction *at)
{
    return moray_budget_of(&run->job.snake.robot, at->power, at->speed, at->course_speed);
}

static way_total total_of(const way_job *run, int kind)
{
    const way_total all[KINDS] = {run->own, run->one, run->paper};
    return all[kind];
}

// How far speed and power are off those of the gaits swum from rest, at most [%].
static double largest_miss(const way_job *run)
{
    double most = 0;
    for (int k = 0; k < run->places; k++) {
        const way_place *p = &run->place[k];
        const double speed = moray_course_speed(&p->swum, p->course) / p->at.prediction.course_speed - 1,
                     power = p->swum.power / p->at.prediction.power - 1;
        most = isnan(p->swum.power) ? INFINITY : fmax(most, 100 * fmax(fabs(speed), fabs(power)));
    }
    return most;
}

// ---- Tables and words ----------------------------------------------------------------------------------------------

static void fill(const way_job *run, struct sheet *s)
{
    static const char *const columns[] = {"V_x, m/s",         "V_y", "theta_max, deg", "omega, deg/s", "delta, deg",
                                          "over ground, m/s", "W",   "whole, J/m"};
    s->table[0] =
        (moray_table){.title = "The way, place by place", .n_columns = 8, .rows = s->place, .n_rows = run->places};
    memcpy(s->table[0].columns, columns, sizeof columns);
    for (int k = 0; k < run->places; k++) {
        const way_place *p = &run->place[k];
        const moray_gait_prediction *at = &p->at.prediction;
        snprintf(s->label[k], sizeof *s->label, "at %.4g m, %.4g s", p->along, p->t);
        s->place[k] = (moray_table_row){.label = s->label[k],
                                        .value = {p->current[0], p->current[1], theta_max_of(run, &at->gait) / DEG,
                                                  at->gait.omega / DEG, at->gait.delta / DEG, at->course_speed,
                                                  at->power, budget_of(run, at).over_ground}};
    }
    s->table[1] = (moray_table){.title = "The whole way",
                                .columns = {"time, s", "whole work, J", "J/m over ground"},
                                .n_columns = 3,
                                .rows = s->total,
                                .n_rows = KINDS};
    for (int kind = 0; kind < KINDS; kind++) {
        const way_total total = total_of(run, kind);
        s->total[kind] =
            (moray_table_row){.label = kinds[kind], .value = {total.time, total.work, total.work / run->path.length}};
    }
}

static void describe(const way_job *run, struct sheet *s)
{
    const moray_snake_options *snake = &run->job.snake;
    char links[MORAY_LINKS_TEXT];
    moray_text_add(
        s->text, TEXT, "%s, %s model; %.4g m along %s through the water of %s; %s, and %.4g W whatever the gait.",
        moray_snake_links_text(&snake->robot, links), moray_model_name(snake->model), run->path.length, run->way_text,
        run->water_file, moray_power_label(&snake->robot, snake->model), snake->robot.supply.constant);
    moray_text_add(
        s->words, sizeof s->words,
        "Steady gaits in the currents met there and then, with what a second is worth where they change with time. A "
        "gait for each place takes %+.3g %% of work beside "
        "the best kept all the way (that of %.4g m), %+.3g %% beside the paper's. Swum from rest in these "
        "currents the gaits are off by %.2g %% in speed or power at most.",
        100 * (run->own.work / run->one.work - 1), run->place[run->best].along,
        100 * (run->own.work / run->paper.work - 1), largest_miss(run));
}

static void print(const void *found, const moray_report *report)
{
    const way_job *run = found;
    int passed = 0;
    for (int k = 0; k < run->places; k++)
        passed += run->place[k].at.certificate.pass;
    printf("%s\n\n", report->text);
    moray_tables_print(report->tables, report->n_tables, stdout);
    printf("%s\n\nCertificates: %d of %d pass\n", report->sections->text, passed, run->places);
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

static void place_to_json(moray_json *json, const way_job *run, const way_place *p)
{
    const moray_gait_prediction *at = &p->at.prediction;
    const bool control = run->job.snake.model == MORAY_CONTROL_ORIENTED;
    moray_json_open(json, NULL);
    moray_json_members(json, MORAY_MEMBERS({"along_m", p->along}, {"x_m", p->x}, {"y_m", p->y}, {"t_s", p->t},
                                           {"course_deg", p->course / DEG}));
    moray_json_numbers(json, "current_m_s", p->current, 2);
    moray_json_members(json,
                       MORAY_MEMBERS({"theta_max_deg", theta_max_of(run, &at->gait) / DEG},
                                     {"omega_deg_s", at->gait.omega / DEG}, {"delta_deg", at->gait.delta / DEG},
                                     {control ? "phi0_m" : "phi0_deg", at->gait.offset / (control ? 1 : DEG)},
                                     {"course_speed_m_s", at->course_speed}, {"power_W", at->power},
                                     {"whole_cost_J_m", budget_of(run, at).over_ground}, {"time_price_W", p->price}));
    moray_json_object(
        json, "validated",
        MORAY_MEMBERS({"course_speed_m_s", moray_course_speed(&p->swum, p->course)}, {"power_W", p->swum.power}));
    moray_certificate_to_json(json, &p->at.certificate);
    moray_json_close(json);
}

static void summarise(const void *found, moray_json *json)
{
    static const char *const keys[KINDS] = {"adapted", "one_gait", "paper"};
    const way_job *run = found;
    moray_snake_to_json(json, &run->job.snake);
    moray_json_text(json, "water", run->water_file);
    moray_json_text(json, "way", run->way_text);
    moray_json_number(json, "length_m", run->path.length);
    moray_json_open_list(json, "places");
    for (int k = 0; k < run->places; k++)
        place_to_json(json, run, &run->place[k]);
    moray_json_close(json);
    for (int kind = 0; kind < KINDS; kind++) {
        const way_total total = total_of(run, kind);
        const moray_gait *gait = kind == 1   ? &run->place[run->best].at.prediction.gait
                                 : kind == 2 ? &run->job.paper.gait[run->job.snake.model]
                                             : NULL;
        moray_json_open(json, keys[kind]);
        moray_json_members(json, MORAY_MEMBERS({"time_s", total.time}, {"work_J", total.work},
                                               {"cost_J_m", total.work / run->path.length}));
        if (gait)
            moray_json_members(json,
                               MORAY_MEMBERS({"theta_max_deg", theta_max_of(run, gait) / DEG},
                                             {"omega_deg_s", gait->omega / DEG}, {"delta_deg", gait->delta / DEG}));
        moray_json_close(json);
    }
}

// ---- Files ---------------------------------------------------------------------------------------------------------

enum { ALONG, TIME, X, Y, CURRENT_X, CURRENT_Y, COURSE_CURRENT, THETA_MAX, OMEGA, DELTA, SPEED, POWER, COST, VALUES };

// value[places][VALUES], angles in deg.
static void list(const way_job *run, double *value)
{
    for (int k = 0; k < run->places; k++, value += VALUES) {
        const way_place *p = &run->place[k];
        const moray_gait_prediction *at = &p->at.prediction;
        const double of[VALUES] = {[ALONG] = p->along,
                                   [TIME] = p->t,
                                   [X] = p->x,
                                   [Y] = p->y,
                                   [CURRENT_X] = p->current[0],
                                   [CURRENT_Y] = p->current[1],
                                   [COURSE_CURRENT] = p->current[0] * cos(p->course) + p->current[1] * sin(p->course),
                                   [THETA_MAX] = theta_max_of(run, &at->gait) / DEG,
                                   [OMEGA] = at->gait.omega / DEG,
                                   [DELTA] = at->gait.delta / DEG,
                                   [SPEED] = at->course_speed,
                                   [POWER] = at->power,
                                   [COST] = budget_of(run, at).over_ground};
        memcpy(value, of, sizeof of);
    }
}

static moray_status write(const void *found, moray_output *output)
{
    static const char *const heads[VALUES][2] = {
        {"along", "m"},          {"t", "s"},         {"x", "m"},           {"y", "m"},         {"V_x", "m/s"},
        {"V_y", "m/s"},          {"V_along", "m/s"}, {"theta_max", "deg"}, {"omega", "deg/s"}, {"delta", "deg"},
        {"course_speed", "m/s"}, {"power", "W"},     {"whole_cost", "J/m"}};
    const way_job *run = found;
    double value[WAY_PLACES * VALUES];
    moray_column column[VALUES];
    FILE *file;
    MORAY_TRY(moray_output_file(output, "way.csv", &file));
    list(run, value);
    for (int i = 0; i < VALUES; i++)
        column[i] = (moray_column){.name = heads[i][0], .unit = heads[i][1], .values = value + i, .stride = VALUES};
    moray_csv_write(file, column, VALUES, run->places);
    return moray_ok();
}

static moray_status draw(const void *found, moray_output *output)
{
    const way_job *run = found;
    double value[WAY_PLACES * VALUES];
    list(run, value);
    const moray_curve curves[] = {{.label = "speed over ground",
                                   .x = value,
                                   .y = value + SPEED,
                                   .n = run->places,
                                   .stride = VALUES,
                                   .style = MORAY_CURVE_MARKED},
                                  {.label = "current along the course",
                                   .x = value,
                                   .y = value + COURSE_CURRENT,
                                   .n = run->places,
                                   .stride = VALUES,
                                   .style = MORAY_CURVE_MARKED}};
    return moray_output_figure(output, &(moray_figure){.name = "way",
                                                       .title = "Speed and current along the way",
                                                       .x_label = "along the way [m]",
                                                       .y_label = "speed [m/s]",
                                                       .curves = curves,
                                                       .n_curves = 2});
}

// ---- The whole -----------------------------------------------------------------------------------------------------

moray_status way_report(gait_job *job)
{
    static struct sheet sheet; // large
    const way_job *run = (const way_job *)job;
    struct sheet *s = &sheet;
    s->text[0] = s->words[0] = 0;
    fill(run, s);
    describe(run, s);
    const moray_section section = {.title = "What adapting gains", .text = s->words, .figures = ""};
    const moray_report report = {
        .title = job->name, .text = s->text, .tables = s->table, .n_tables = 2, .sections = &section, .n_sections = 1};
    return moray_app_show(&job->common, &(moray_results){.name = job->name,
                                                         .found = run,
                                                         .summary = summarise,
                                                         .print = print,
                                                         .write = write,
                                                         .draw = draw,
                                                         .report = &report});
}
