// SPDX-License-Identifier: MIT
#include <math.h>

#include "moray/angle.h"
#include "moray/snake/budget.h"
#include "moray/snake/trial.h"

static double theta_max_of(const moray_robot *robot, const moray_gait *gait)
{
    return moray_theta_max_from_amplitude(robot, MORAY_CONTROL_ORIENTED, gait->amplitude, gait->delta);
}

static double end_angle(const moray_robot *robot, const moray_gait *gait, int link)
{
    return moray_theta_max_of_link(robot, MORAY_FIRST_PRINCIPLES, gait, link) / MORAY_DEGREE;
}

void moray_gait_to_json(moray_json *json, const char *key, const moray_robot *robot, const moray_gait gait[2])
{
    const moray_gait *control = &gait[MORAY_CONTROL_ORIENTED], *revolute = &gait[MORAY_FIRST_PRINCIPLES];
    moray_json_object(json, key,
                      MORAY_MEMBERS({"a_m", control->amplitude}, {"alpha_deg", revolute->amplitude / MORAY_DEGREE},
                                    {"theta_max_deg", theta_max_of(robot, control) / MORAY_DEGREE},
                                    {"omega_deg_s", control->omega / MORAY_DEGREE},
                                    {"delta_deg", control->delta / MORAY_DEGREE}, {"phi0_m", control->offset},
                                    {"phi0_deg", revolute->offset / MORAY_DEGREE}, {"taper", control->taper}));
}

// Joint work per distance along the course.
static double course_cost(const moray_steady *steady, bool held, double course)
{
    return held ? steady->power / moray_course_speed(steady, course) : NAN;
}

static moray_budget budget_of(const moray_robot *robot, const moray_steady *steady, bool held, double course)
{
    return moray_budget_of(robot, steady->power, steady->speed, held ? moray_course_speed(steady, course) : NAN);
}

void moray_steady_to_json(moray_json *json, const char *key, const moray_robot *robot, moray_model model,
                          const moray_gait_trial *trial, double course)
{
    const moray_steady *steady = &trial->steady[model];
    const bool control = model == MORAY_CONTROL_ORIENTED;
    moray_json_open(json, key);
    moray_json_text(json, "model", control ? "control" : "fp");
    moray_json_members(
        json, MORAY_MEMBERS({"speed_m_s", steady->speed},
                            {"course_speed_m_s", trial->held[model] ? moray_course_speed(steady, course) : NAN},
                            {"power_W", steady->power}, {"cost_of_transport_J_m", steady->cost_of_transport},
                            {"course_cost_J_m", course_cost(&trial->steady[model], trial->held[model], course)},
                            {control ? "peak_force_N" : "peak_torque_N_m", steady->peak_effort},
                            {"max_link_angle_deg", steady->peak_link_angle / MORAY_DEGREE}));
    const moray_budget budget = budget_of(robot, steady, trial->held[model], course);
    if (robot->motor.fitted)
        moray_json_text(json, "power_is", moray_power_label(robot, model));
    moray_budget_to_json(json, robot, &budget);
    if (!trial->held[model])
        moray_json_text(json, "course_not_held", trial->why[model].text);
    moray_json_close(json);
}

// The last three rows only for gaits with a taper.
int moray_gait_rows(const moray_robot *robot, const moray_gait_trial *const *trials, int n, moray_table_row *rows)
{
    static const char *const labels[][2] = {{"theta_max, amplitude of (24)", "deg"},
                                            {"omega, frequency", "deg/s"},
                                            {"delta, phase shift", "deg"},
                                            {"a, by (33)", "cm"},
                                            {"alpha, by (27)", "deg"},
                                            {"phi_0, control-oriented", "cm"},
                                            {"phi_0, first-principles", "deg"},
                                            {"taper of the amplitude", ""},
                                            {"theta_max of the head, by (27)", "deg"},
                                            {"theta_max of the tail, by (27)", "deg"}};
    enum { count = sizeof labels / sizeof *labels };
    bool tapers = false;
    for (int i = 0; i < count; i++)
        rows[i] = (moray_table_row){.label = labels[i][0], .unit = labels[i][1]};
    for (int k = 0; k < n; k++) {
        const moray_gait *control = &trials[k]->gait[MORAY_CONTROL_ORIENTED];
        const moray_gait *revolute = &trials[k]->gait[MORAY_FIRST_PRINCIPLES];
        const double values[count] = {theta_max_of(robot, control) / MORAY_DEGREE,
                                      control->omega / MORAY_DEGREE,
                                      control->delta / MORAY_DEGREE,
                                      100 * control->amplitude,
                                      revolute->amplitude / MORAY_DEGREE,
                                      fabs(control->offset) < 1e-9 ? 0 : 100 * control->offset,
                                      fabs(revolute->offset) < 1e-9 ? 0 : revolute->offset / MORAY_DEGREE,
                                      fabs(control->taper) < 1e-6 ? 0 : control->taper,
                                      end_angle(robot, revolute, robot->links),
                                      end_angle(robot, revolute, 1)};
        tapers = tapers || fabs(control->taper) >= 1e-6;
        for (int i = 0; i < count; i++)
            rows[i].value[k] = values[i];
    }
    return tapers ? count : count - 3;
}

// What the whole robot costs, behind the rows of its joints; returns how many.
static int budget_rows(const moray_robot *robot, moray_model model, const moray_gait_trial *const *trials, int n,
                       double course, moray_table_row *rows)
{
    const int count = moray_budget_tells(robot) ? robot->supply.battery > 0 ? 4 : 2 : 0;
    const char *const labels[][2] = {{"whole power, with electronics and hotel load", "W"},
                                     {"whole work along the course", "J/m"},
                                     {"endurance of the battery", "h"},
                                     {"range along the course", "km"}};
    for (int i = 0; i < count; i++)
        rows[i] = (moray_table_row){.label = labels[i][0], .unit = labels[i][1]};
    for (int k = 0; k < n; k++) {
        const moray_budget budget = budget_of(robot, &trials[k]->steady[model], trials[k]->held[model], course);
        const double values[] = {budget.whole, budget.over_ground, budget.endurance, budget.range / 1000};
        for (int i = 0; i < count; i++)
            rows[i].value[k] = values[i];
    }
    return count;
}

// The row of the work along the course only where a current makes a difference.
int moray_steady_rows(const moray_robot *robot, moray_model model, const moray_gait_trial *const *trials, int n,
                      double course, moray_table_row *rows)
{
    const bool control = model == MORAY_CONTROL_ORIENTED;
    const char *const labels[][2] = {{"speed through the water", "m/s"},
                                     {"speed along the course", "m/s"},
                                     {moray_power_label(robot, model), "W"},
                                     {"cost of transport", "J/m"},
                                     {control ? "peak joint force" : "peak joint torque", control ? "N" : "N m"},
                                     {"largest link angle from heading", "deg"},
                                     {"joint work along the course", "J/m"}};
    enum { count = sizeof labels / sizeof *labels };
    bool drifts = false;
    for (int i = 0; i < count; i++)
        rows[i] = (moray_table_row){.label = labels[i][0], .unit = labels[i][1]};
    for (int k = 0; k < n; k++) {
        const moray_steady *steady = &trials[k]->steady[model];
        const bool held = trials[k]->held[model];
        const double values[count] = {steady->speed,
                                      held ? moray_course_speed(steady, course) : NAN,
                                      steady->power,
                                      steady->cost_of_transport,
                                      steady->peak_effort,
                                      steady->peak_link_angle / MORAY_DEGREE,
                                      course_cost(steady, held, course)};
        for (int i = 0; i < count; i++)
            rows[i].value[k] = values[i];
        drifts = drifts || (held && fabs(values[1] - values[0]) > 1e-6);
    }
    const int own = drifts ? count : count - 1;
    return own + budget_rows(robot, model, trials, n, course, rows + own);
}
