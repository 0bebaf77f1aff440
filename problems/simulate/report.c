// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "simulate.h"

static bool is_control(const simulate *run)
{
    return run->snake.model == MORAY_CONTROL_ORIENTED;
}

// ---- In words ------------------------------------------------------------------------------------------------------

static void describe(const simulate *run, const simulate_results *results, char *text, size_t size)
{
    const moray_robot *robot = &run->snake.robot;
    const moray_gait *gait = simulate_last_gait(results);
    const bool control = is_control(run);
    const double theta_max =
        moray_theta_max_from_amplitude(robot, run->snake.model, gait->amplitude, gait->delta) / DEG;
    char changes[60] = "", taper[40] = "", links[MORAY_LINKS_TEXT], water[MORAY_PATH_SIZE + 12] = "";
    if (results->n_changes > 1)
        snprintf(changes, sizeof changes, "%d gaits, the last one from t = %g s: ", results->n_changes,
                 results->schedule[results->n_changes - 1].t);
    if (gait->taper != 0)
        snprintf(taper, sizeof taper, ", taper %g", gait->taper);
    if (results->water)
        snprintf(water, sizeof water, "water of %s, ", run->water_file);
    snprintf(text, size,
             "%s, %s model, %scurrent (%.6g, %.6g) m/s%s. %stheta_max %.4g deg (%s = %.4g %s), omega %.4g deg/s, delta "
             "%.4g deg, phi_0 %.4g %s%s.",
             moray_snake_links_text(robot, links), moray_model_name(run->snake.model), water, results->current[0],
             results->current[1], results->water ? " in the mean of the table below" : "", changes, theta_max,
             control ? "a" : "alpha", gait->amplitude * (control ? 100 : 1 / DEG), control ? "cm" : "deg",
             gait->omega / DEG, gait->delta / DEG, gait->offset * (control ? 100 : 1 / DEG), control ? "cm" : "deg",
             taper);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { MEAN_ROWS = 10, BUDGET_ROWS = 5, RUN_ROWS = 8 };

struct tables {
    moray_table table[2];
    moray_table_row mean[MEAN_ROWS + BUDGET_ROWS], run[RUN_ROWS];
    char title[120], integrator[60];
};

// Without the rounding errors of what is zero.
static void tidy(moray_table_row *rows, int n)
{
    for (int i = 0; i < n; i++)
        if (fabs(rows[i].value[0]) < 1e-9)
            rows[i].value[0] = 0;
}

// What the whole robot costs, and how near its motors are to what their supply allows. Returns how many rows.
static int budget_rows(const simulate *run, const simulate_results *r, moray_table_row *rows)
{
    const moray_robot *robot = &run->snake.robot;
    int n = 0;
    if (robot->motor.lines > 0 && !is_control(run))
        rows[n++] = (moray_table_row){
            .label = "largest share of what the motors give", .value = {100 * r->peak_load}, .unit = "%"};
    if (!moray_budget_tells(robot))
        return n;
    rows[n++] = (moray_table_row){
        .label = "whole power, with electronics and hotel load", .value = {r->budget.whole}, .unit = "W"};
    rows[n++] =
        (moray_table_row){.label = "whole work along the course", .value = {r->budget.over_ground}, .unit = "J/m"};
    if (!(robot->supply.battery > 0))
        return n;
    rows[n++] = (moray_table_row){.label = "endurance of the battery", .value = {r->budget.endurance}, .unit = "h"};
    rows[n++] = (moray_table_row){.label = "range along the course", .value = {r->budget.range / 1000}, .unit = "km"};
    return n;
}

static void fill_means(const simulate *run, const simulate_results *r, struct tables *t)
{
    const char *effort_unit = is_control(run) ? "N" : "N m";
    const moray_table_row rows[MEAN_ROWS] = {
        {.label = "mean velocity v_x", .value = {r->v_x}, .unit = "m/s"},
        {.label = "mean velocity v_y", .value = {r->v_y}, .unit = "m/s"},
        {.label = "speed through the water", .value = {r->speed}, .unit = "m/s"},
        {.label = "speed along the course", .value = {r->course_speed}, .unit = "m/s"},
        {.label = moray_power_label(&run->snake.robot, run->snake.model), .value = {r->power}, .unit = "W"},
        {.label = "cost of transport", .value = {r->cost_of_transport}, .unit = "J/m"},
        {.label = is_control(run) ? "peak joint force" : "peak joint torque",
         .value = {r->peak_effort},
         .unit = effort_unit},
        {.label = "largest link angle from heading", .value = {r->peak_link_angle / DEG}, .unit = "deg"},
        {.label = "mean heading", .value = {r->heading / DEG}, .unit = "deg"},
        {.label = "peak effort of the whole run", .value = {r->peak_effort_of_run}, .unit = effort_unit},
    };
    memcpy(t->mean, rows, sizeof rows);
    const int n = MEAN_ROWS + budget_rows(run, r, t->mean + MEAN_ROWS);
    tidy(t->mean, n);
    if (r->window.periods > 0)
        snprintf(t->title, sizeof t->title, "Last %d period%s, %.5g s to %.5g s", r->window.periods,
                 r->window.periods > 1 ? "s" : "", r->window.from, r->window.to);
    else
        snprintf(t->title, sizeof t->title, "%.5g s to %.5g s, less than a period of the last gait", r->window.from,
                 r->window.to);
    t->table[0] = (moray_table){.title = t->title, .n_columns = 1, .rows = t->mean, .n_rows = n};
}

static void fill_run(const simulate *run, const simulate_results *r, struct tables *t)
{
    const moray_table_row rows[RUN_ROWS] = {
        {.label = "end of the simulation", .value = {r->t1}, .unit = "s"},
        {.label = "position p_x", .value = {r->end.p_x}, .unit = "m"},
        {.label = "position p_y", .value = {r->end.p_y}, .unit = "m"},
        {.label = "heading", .value = {r->end.heading / DEG}, .unit = "deg"},
        {.label = run->snake.robot.motor.fitted && !is_control(run) ? "work at the motors" : "joint work",
         .value = {r->energy},
         .unit = "J"},
        {.label = "integrator", .text = t->integrator},
        {.label = "steps", .value = {(double)r->statistics.steps}},
        {.label = "evaluations of the right-hand side", .value = {(double)r->statistics.rhs_evaluations}},
    };
    snprintf(t->integrator, sizeof t->integrator, "%s, rtol %g, atol %g", simulate_integrators[run->integrator],
             r->sim.rtol, r->sim.atol);
    memcpy(t->run, rows, sizeof rows);
    tidy(t->run, RUN_ROWS);
    t->table[1] = (moray_table){.title = "Whole run", .n_columns = 1, .rows = t->run, .n_rows = RUN_ROWS};
}

static void print(const void *found, const moray_report *report)
{
    (void)found;
    printf("%s\n\n", report->text);
    moray_tables_print(report->tables, 1, stdout);
    moray_table_print(&report->tables[1], stdout);
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

static void json_gait(moray_json *json, const simulate *run, const moray_gait_change *change)
{
    const moray_robot *robot = &run->snake.robot;
    const bool control = is_control(run);
    const moray_gait *gait = &change->gait;
    const double theta_max = moray_theta_max_from_amplitude(robot, run->snake.model, gait->amplitude, gait->delta);
    moray_json_object(json, NULL,
                      MORAY_MEMBERS({"t_s", change->t}, {"theta_max_deg", theta_max / DEG},
                                    {control ? "a_m" : "alpha_deg", control ? gait->amplitude : gait->amplitude / DEG},
                                    {"omega_deg_s", gait->omega / DEG}, {"delta_deg", gait->delta / DEG},
                                    {control ? "phi0_m" : "phi0_deg", control ? gait->offset : gait->offset / DEG},
                                    {"taper", gait->taper}));
}

static void json_head(moray_json *json, const simulate *run, const simulate_results *results)
{
    static moray_snake_options met; // large
    met = run->snake;
    memcpy(met.current, results->current, sizeof met.current);
    moray_snake_to_json(json, &met);
    moray_json_number(json, "course_deg", run->snake.course / DEG);
    if (results->water)
        moray_json_text(json, "water", run->water_file);
    moray_json_open_list(json, "gaits");
    for (int i = 0; i < results->n_changes; i++)
        json_gait(json, run, &results->schedule[i]);
    moray_json_close(json);
}

static void json_mean(moray_json *json, const simulate *run, const simulate_results *r)
{
    const bool control = is_control(run);
    moray_json_object(json, "simulated",
                      MORAY_MEMBERS({"from_s", r->window.from}, {"to_s", r->window.to}, {"periods", r->window.periods},
                                    {"v_x_m_s", r->v_x}, {"v_y_m_s", r->v_y}, {"speed_m_s", r->speed},
                                    {"course_speed_m_s", r->course_speed}, {"power_W", r->power},
                                    {"cost_of_transport_J_m", r->cost_of_transport},
                                    {control ? "peak_force_N" : "peak_torque_N_m", r->peak_effort},
                                    {"max_link_angle_deg", r->peak_link_angle / DEG},
                                    {"heading_deg", r->heading / DEG}));
}

static void json_run(moray_json *json, const simulate *run, const simulate_results *r)
{
    const bool control = is_control(run);
    const double position[] = {r->end.p_x, r->end.p_y};
    moray_json_open(json, "run");
    moray_json_number(json, "duration_s", r->t1);
    moray_json_numbers(json, "end_position_m", position, 2);
    moray_json_members(json, MORAY_MEMBERS({"end_heading_deg", r->end.heading / DEG}, {"energy_J", r->energy},
                                           {control ? "peak_force_N" : "peak_torque_N_m", r->peak_effort_of_run}));
    moray_json_close(json);
    moray_json_open(json, "integrator");
    moray_json_text(json, "name", simulate_integrators[run->integrator]);
    moray_json_members(json, MORAY_MEMBERS({"rtol", r->sim.rtol}, {"atol", r->sim.atol},
                                           {"steps", (double)r->statistics.steps},
                                           {"rhs_evaluations", (double)r->statistics.rhs_evaluations}));
    moray_json_close(json);
}

// ---- All of it -----------------------------------------------------------------------------------------------------

static void summarise(const void *found, moray_json *json)
{
    const simulate_results *results = found;
    json_head(json, results->run, results);
    json_mean(json, results->run, results);
    moray_budget_to_json(json, &results->run->snake.robot, &results->budget);
    if (results->run->snake.robot.motor.fitted)
        moray_json_text(json, "power_is", moray_power_label(&results->run->snake.robot, results->run->snake.model));
    if (results->peak_load > 0)
        moray_json_number(json, "motor_load", results->peak_load);
    json_run(json, results->run, results);
}

moray_status simulate_report(const simulate_results *results)
{
    const simulate *run = results->run;
    struct tables t;
    char text[500 + MORAY_PATH_SIZE];
    moray_swim_scene scene = {0};
    fill_means(run, results, &t);
    fill_run(run, results, &t);
    describe(run, results, text, sizeof text);
    if (run->common.output)
        MORAY_TRY(moray_swim_scene_add(
            &scene,
            &(moray_swim_look){.name = is_control(run) ? "control-oriented model" : "first-principles model",
                               .width = 2 * run->snake.geometry.a_e},
            &results->track, results->swimmer));
    scene.scene.title = "The robot swimming";
    const moray_report report = {
        .title = "simulate: a gait swum", .text = text, .scene = &scene.scene, .tables = t.table, .n_tables = 2};
    const moray_status status = moray_app_show(&run->common, &(moray_results){.name = "simulate",
                                                                              .found = results,
                                                                              .summary = summarise,
                                                                              .print = print,
                                                                              .write = simulate_trajectory,
                                                                              .draw = simulate_figures,
                                                                              .report = &report});
    moray_swim_scene_free(&scene);
    return status;
}
