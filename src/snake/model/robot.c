// SPDX-License-Identifier: MIT
#include "moray/snake/model.h"

#include <math.h>

#include "snake/model/links.h"

const char *moray_model_name(moray_model model)
{
    return model == MORAY_CONTROL_ORIENTED ? "control-oriented" : "first-principles";
}

const char *moray_model_key(moray_model model)
{
    return model == MORAY_CONTROL_ORIENTED ? "control" : "fp";
}

moray_link_geometry moray_link_geometry_paper(void)
{
    return (moray_link_geometry){
        .length = 0.14, .a_e = 0.05, .b_e = 0.03, .rho = 1000, .C_f = 0.03, .C_D = 2, .C_A = 1, .C_M = 1};
}

moray_robot moray_robot_paper(void)
{
    moray_robot robot = {
        .links = 10, .rot_damping = 1.15, .rot_gain = 40, .k_p = 200, .k_d = 50, .hydro = {.pieces = 1}};
    moray_link_geometry geometry = moray_link_geometry_paper();
    moray_robot_from_geometry(&robot, &geometry);
    return robot;
}

// Elliptic cylinder with semi-axes a_e in the plane of motion and b_e across it, by the formulas that Sec. V-A refers
// to (units: erratum E8).
void moray_robot_from_geometry(moray_robot *robot, const moray_link_geometry *g)
{
    const double l = g->length / 2, perimeter = g->a_e + g->b_e;
    const double focal2 = g->a_e * g->a_e - g->b_e * g->b_e;
    robot->l = l;
    robot->m = g->rho * M_PI * g->a_e * g->b_e * g->length;
    robot->J = robot->m * (g->length * g->length / 12 + g->a_e * g->a_e / 4);
    robot->c_t = g->rho * M_PI * g->C_f * perimeter / 2 * l;
    robot->c_n = g->rho * g->C_D * 2 * g->b_e * l;
    robot->mu_n = g->rho * M_PI * g->C_A * g->b_e * g->b_e * g->length;
    robot->lambda_1 = g->rho * M_PI * g->C_M * focal2 * focal2 * l * l * l / 12;
    robot->lambda_2 = g->rho * M_PI * g->C_f * perimeter * l * l * l / 6;
    robot->lambda_3 = g->rho * M_PI * g->C_f * perimeter * l * l * l * l / 8;
}

moray_hydrodynamics moray_hydrodynamics_consistent(void)
{
    return (moray_hydrodynamics){.rotation = MORAY_ROTATION_STRIP,
                                 .drag = MORAY_DRAG_BOTH,
                                 .added_mass = MORAY_ADDED_MASS_INVARIANT,
                                 .frame = MORAY_FRAME_INVARIANT,
                                 .pieces = 1};
}

static moray_status check_hydrodynamics(const moray_hydrodynamics *hydro)
{
    const struct {
        const char *name;
        int value, last;
    } choices[] = {{"rotation", (int)hydro->rotation, MORAY_ROTATION_STRIP},
                   {"drag", (int)hydro->drag, MORAY_DRAG_BOTH},
                   {"added_mass", (int)hydro->added_mass, MORAY_ADDED_MASS_INVARIANT},
                   {"frame", (int)hydro->frame, MORAY_FRAME_INVARIANT},
                   {"pieces", hydro->pieces, 1000}};
    for (unsigned i = 0; i < sizeof choices / sizeof *choices; i++)
        if (choices[i].value < 0 || choices[i].value > choices[i].last)
            return moray_error(MORAY_INPUT, "%s = %d: must be within 0:%d", choices[i].name, choices[i].value,
                               choices[i].last);
    if (hydro->pieces > 1 && hydro->rotation == MORAY_ROTATION_STRIP)
        return moray_error(MORAY_INPUT, "pieces = %d: with rotation = strip a link is not cut", hydro->pieces);
    return moray_ok();
}

moray_status moray_robot_check_swims(const moray_robot *robot)
{
    if (robot->links > 2)
        return moray_ok();
    return moray_error(MORAY_NOT_SOLVED,
                       "links = %d: two links cannot swim: exchanged and mirrored they are the same robot in the same "
                       "motion, which would swim the other way; give 3 or more",
                       robot->links);
}

moray_status moray_robot_check(const moray_robot *robot)
{
    if (robot->links < 2 || robot->links > MORAY_MOST_LINKS)
        return moray_error(MORAY_INPUT, "links = %d: a robot has at least 2 links and at most %d", robot->links,
                           MORAY_MOST_LINKS);
    const struct {
        const char *name;
        double value;
        bool may_be_zero;
    } fields[] = {
        {"l", robot->l, false},
        {"m", robot->m, false},
        {"J", robot->J, false},
        {"c_t", robot->c_t, true},
        {"c_n", robot->c_n, true},
        {"mu_n", robot->mu_n, true},
        {"lambda_1", robot->lambda_1, true},
        {"lambda_2", robot->lambda_2, true},
        {"lambda_3", robot->lambda_3, true},
        {"rot_damping", robot->rot_damping, true},
        {"rot_gain", robot->rot_gain, true},
        {"k_p", robot->k_p, true},
        {"k_d", robot->k_d, true},
    };
    for (unsigned i = 0; i < sizeof fields / sizeof *fields; i++) {
        const double value = fields[i].value;
        if (!isfinite(value) || value < 0 || (value == 0 && !fields[i].may_be_zero))
            return moray_error(MORAY_INPUT, "%s = %g: must be finite and %s 0", fields[i].name, value,
                               fields[i].may_be_zero ? "at least" : "above");
    }
    MORAY_TRY(moray_links_check(robot));
    MORAY_TRY(moray_motor_check(&robot->motor));
    MORAY_TRY(moray_supply_check(&robot->supply));
    return check_hydrodynamics(&robot->hydro);
}
