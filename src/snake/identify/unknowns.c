// SPDX-License-Identifier: MIT
//
// What can be estimated: one table.
#include <string.h>

#include "snake/identify/unknowns.h"

#define ROBOT(field) .at = offsetof(moray_unknowns, robot.field)
#define WORLD(field) .at = offsetof(moray_unknowns, field), .offset = true

const struct unknown moray_unknown_table[] = {
    {"c_t", "kg/s", ROBOT(c_t)},
    {"c_n", "kg/s", ROBOT(c_n)},
    {"mu_n", "kg", ROBOT(mu_n)},
    {"lambda_1", "kg m^2", ROBOT(lambda_1), .fp = true, .torque = true},
    {"lambda_2", "kg m^2/s", ROBOT(lambda_2), .fp = true, .torque = true},
    {"lambda_3", "kg m^2", ROBOT(lambda_3), .fp = true, .torque = true},
    {"m", "kg", ROBOT(m)},
    {"J", "kg m^2", ROBOT(J), .fp = true},
    {"rot_damping", "1/s", ROBOT(rot_damping), .control = true},
    {"rot_gain", "1/(m^2 s)", ROBOT(rot_gain), .control = true},
    {"current_x", "m/s", WORLD(current[0]), .scale = 0.1},
    {"current_y", "m/s", WORLD(current[1]), .scale = 0.1},
    {"heading_bias", "rad", WORLD(heading_bias), .scale = 0.1, .instrument = true},
    {"camera_rotation", "rad", WORLD(camera_rotation), .scale = 0.1, .instrument = true},
    {"camera_x", "m", WORLD(camera[0]), .scale = 0.1, .instrument = true},
    {"camera_y", "m", WORLD(camera[1]), .scale = 0.1, .instrument = true},
    {"position_delay", "s", WORLD(position_delay), .scale = 0.1, .instrument = true},
    {"heading_delay", "s", WORLD(heading_delay), .scale = 0.1, .instrument = true},
    {"joint_delay", "s", WORLD(joint_delay), .scale = 0.1},
};
enum { UNKNOWNS = sizeof moray_unknown_table / sizeof *moray_unknown_table };
_Static_assert((int)UNKNOWNS <= (int)MORAY_MOST_UNKNOWNS, "estimates have room for all");

int moray_unknown_named(const char *name)
{
    for (int k = 0; k < UNKNOWNS; k++)
        if (strcmp(moray_unknown_table[k].name, name) == 0)
            return k;
    return -1;
}

const char *moray_unknown_name(int unknown)
{
    return unknown < UNKNOWNS ? moray_unknown_table[unknown].name : NULL;
}

const char *moray_unknown_unit(int unknown)
{
    return moray_unknown_table[unknown].unit;
}

bool moray_unknown_applies(int unknown, const moray_robot *robot, moray_model model)
{
    const struct unknown *u = &moray_unknown_table[unknown];
    const bool control = model == MORAY_CONTROL_ORIENTED, strips = robot->hydro.rotation == MORAY_ROTATION_STRIP;
    return !(u->fp && control) && !(u->control && !control) && !(u->torque && strips);
}

double *moray_unknown_at(int unknown, moray_unknowns *world)
{
    return (double *)((char *)world + moray_unknown_table[unknown].at);
}
