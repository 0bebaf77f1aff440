// SPDX-License-Identifier: MIT
//
// The options of a program about snake robots: the robot, the model, the current and the course.
#ifndef MORAY_SNAKE_OPTIONS_H
#define MORAY_SNAKE_OPTIONS_H

#include "moray/export.h"
#include "moray/app/options.h"
#include "moray/app/results.h"
#include "moray/snake/model.h"

MORAY_BEGIN

enum { MORAY_PAPER, MORAY_CONSISTENT }; // the word of --hydrodynamics

// Lists of numbers, one for each link from link 1, the tail, on, as the keys of [links] have them; behind the last one,
// or where there is none, NaN.
typedef double moray_link_list[MORAY_MOST_LINKS];
typedef struct moray_link_lists {
    moray_link_list length, a_e, b_e, m, J, c_t, c_n, mu_n, lambda_1, lambda_2, lambda_3, cm, cb;
    moray_link_list fin_c_t, fin_c_n, fin_mu_n, fin_at;
} moray_link_lists;

// The keys of [motor] and [battery]; NaN: not given.
typedef struct moray_motor_options {
    double speed[MORAY_MOTOR_LINES + 1], torque[MORAY_MOTOR_LINES + 1]; // lists
    double efficiency, back_efficiency, friction, viscous, constant, rate, smooth_rate, smooth_power;
    double idle, hotel, battery; // [W] of each motor, [W], [Wh]
} moray_motor_options;

typedef struct moray_snake_options {
    moray_robot robot; // before parsing l, m, J, c_t, c_n, mu_n and lambda_1..3 are NaN: from the geometry,
                       // the choices of its hydro -1: from hydrodynamics; rot_damping and rot_gain NaN: the paper's
    int hydrodynamics;
    moray_link_geometry geometry; // gives the coefficients of the robot that are not given directly
    moray_model model;
    double current[2]; // V_x, V_y [m/s]
    double course;     // direction of travel over ground [rad]
    moray_link_lists lists;
    moray_motor_options motor;
    moray_link link[MORAY_MOST_LINKS]; // after parsing: to which robot.link refers, where the links are not equal
    bool not_tuned; // after parsing: rot_damping or rot_gain is the paper's, and the robot is another one
} moray_snake_options;

// The paper's robot in still water, control-oriented model.
MORAY_API moray_snake_options moray_snake_options_default(void);

// --robot FILE, --links, --model, --current, --course and the keys of [robot]; in the end the robot is made and checked
// (error: MORAY_INPUT). As a group of a program: {&moray_snake_option_table, offsetof(SETTINGS, FIELD)}.
MORAY_API extern const moray_option_table moray_snake_option_table;

// Before the control-oriented model turns, steered or in a current across. Error: MORAY_INPUT where the constants of
// (20) are not this robot's, with the command that fits them; swimming straight in still water does without them.
MORAY_API moray_status moray_snake_turning(const moray_snake_options *options);

// "model", "robot" and "current_m_s" of a summary; of a robot of unequal links with those, and with the equal robot
// that the control-oriented model swims in its place.
MORAY_API void moray_snake_to_json(moray_json *json, const moray_snake_options *options);

// "10 links"; of unequal ones with the equal robot that the control-oriented model swims, and whether there are motors,
// which that model has not. Returns text.
enum { MORAY_LINKS_TEXT = 320 };
MORAY_API const char *moray_snake_links_text(const moray_robot *robot, char text[MORAY_LINKS_TEXT]);

MORAY_END

#endif
