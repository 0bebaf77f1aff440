// SPDX-License-Identifier: MIT
#include "moray/snake/options.h"

#include <math.h>
#include <string.h>

#include "snake/swim/options_links.h"
#include "snake/swim/options_motor.h"

static const char *const models[] = {
    [MORAY_CONTROL_ORIENTED] = "control", [MORAY_FIRST_PRINCIPLES] = "fp|complex", NULL};
static const char *const hydrodynamics[] = {[MORAY_PAPER] = "paper", [MORAY_CONSISTENT] = "consistent", NULL};
static const char *const rotations[] = {[MORAY_ROTATION_PAPER] = "paper", [MORAY_ROTATION_STRIP] = "strip", NULL};
static const char *const drags[] = {
    [MORAY_DRAG_LINEAR] = "linear", [MORAY_DRAG_QUADRATIC] = "quadratic", [MORAY_DRAG_BOTH] = "both", NULL};
static const char *const added_masses[] = {
    [MORAY_ADDED_MASS_PAPER] = "paper", [MORAY_ADDED_MASS_INVARIANT] = "invariant", NULL};
static const char *const frames[] = {[MORAY_FRAME_PAPER] = "paper", [MORAY_FRAME_INVARIANT] = "invariant", NULL};
_Static_assert(sizeof(moray_hydrodynamics) == 5 * sizeof(int), "choices are stored as int");
_Static_assert(sizeof(moray_model) == sizeof(int), "choices are stored as int");

#define SPAN(low, high) .min = (low), .max = (high)
#define ABOVE(low) .min = (low), .max = INFINITY, .open = true
#define AT_LEAST(low) .min = (low), .max = INFINITY
#define REAL(where, name, field)                                                                                       \
    .section = where, .key = name, .type = MORAY_OPTION_REAL, MORAY_AT(moray_snake_options, field)
#define ROBOT(name, field) REAL("robot", name, robot.field)
#define LINK(name, field) REAL("robot", name, geometry.field)
#define EACH(name, field)                                                                                              \
    .section = "links", .key = name, .type = MORAY_OPTION_LIST, MORAY_AT(moray_snake_options, lists.field)
#define MOTOR(kind, name, field)                                                                                       \
    .section = "motor", .key = name, .type = MORAY_OPTION_##kind, MORAY_AT(moray_snake_options, motor.field)
#define HYDRO(name, list)                                                                                              \
    .section = "robot", .key = #name, .type = MORAY_OPTION_CHOICE, MORAY_AT(moray_snake_options, robot.hydro.name),    \
    .choices = list
#define BY_WORD "; by --hydrodynamics unless given"
#define AS_TUNED "; unless given that which the authors tuned for their robot, refused where another one turns"
#define FROM_TAIL ", from link 1, the tail, to link N, the head; for all links where a key of [robot] stands for it"
#define FROM_GEOMETRY "; from the geometry unless given"

static const moray_option robot_rows[] = {
    {.flag = "robot",
     .argument = "FILE",
     .type = MORAY_OPTION_INI,
     .help = "INI file with the robot and any other keys"},
    MORAY_ROW(INT, moray_snake_options, robot.links, "robot", "links", .flag = "links", SPAN(2, MORAY_MOST_LINKS),
              .help = "number of links N"),
    MORAY_ROW(CHOICE, moray_snake_options, model, "problem", "model", .flag = "model", .choices = models,
              .help = "control-oriented or first-principles (fp, also called complex) model"),
    {.section = "problem",
     .key = "current",
     .flag = "current",
     .argument = "VX,VY",
     .type = MORAY_OPTION_PAIR,
     MORAY_AT(moray_snake_options, current),
     .unit = "m/s",
     .help = "current in the global frame"},
    {REAL("problem", "course", course), .flag = "course", .argument = "DEG", SPAN(-360, 360), .unit = "deg",
     .help = "direction of travel over ground"},
    {LINK("length_m", length), ABOVE(0), .unit = "m", .help = "length of a link, 2l"},
    {LINK("a_e_m", a_e), ABOVE(0), .unit = "m", .help = "semi-axis of a link in the plane of motion"},
    {LINK("b_e_m", b_e), ABOVE(0), .unit = "m", .help = "vertical semi-axis of a link"},
    {LINK("rho_kg_m3", rho), ABOVE(0), .unit = "kg/m^3", .help = "density of the fluid"},
    {LINK("C_f", C_f), AT_LEAST(0), .help = "friction drag constant"},
    {LINK("C_D", C_D), AT_LEAST(0), .help = "pressure drag constant"},
    {LINK("C_A", C_A), AT_LEAST(0), .help = "added mass constant"},
    {LINK("C_M", C_M), AT_LEAST(0), .help = "added inertia constant"},
    {ROBOT("l_m", l), ABOVE(0), .unit = "m", .help = "half the length of a link" FROM_GEOMETRY},
    {ROBOT("m_kg", m), ABOVE(0), .unit = "kg", .help = "mass of a link" FROM_GEOMETRY},
    {ROBOT("J_kg_m2", J), ABOVE(0), .unit = "kg m^2",
     .help = "moment of inertia of a link; from mass and geometry unless given"},
    {ROBOT("c_t", c_t), AT_LEAST(0), .unit = "kg/s", .help = "tangential drag of a link" FROM_GEOMETRY},
    {ROBOT("c_n", c_n), AT_LEAST(0), .unit = "kg/s", .help = "normal drag of a link" FROM_GEOMETRY},
    {ROBOT("mu_n", mu_n), AT_LEAST(0), .unit = "kg", .help = "normal added mass of a link" FROM_GEOMETRY},
    {ROBOT("lambda_1", lambda_1), AT_LEAST(0), .unit = "kg m^2",
     .help = "added inertia in the fluid torque (4)" FROM_GEOMETRY},
    {ROBOT("lambda_2", lambda_2), AT_LEAST(0), .unit = "kg m^2/s",
     .help = "linear drag in the fluid torque (4)" FROM_GEOMETRY},
    {ROBOT("lambda_3", lambda_3), AT_LEAST(0), .unit = "kg m^2",
     .help = "quadratic drag in the fluid torque (4)" FROM_GEOMETRY},
    {ROBOT("rot_damping", rot_damping), AT_LEAST(0), .unit = "1/s",
     .help = "rotational damping of the control-oriented model, first constant of (20)" AS_TUNED},
    {ROBOT("rot_gain", rot_gain), AT_LEAST(0), .unit = "1/(m^2 s)",
     .help = "gain from joint offset to turning in the control-oriented model, second constant of (20)" AS_TUNED},
    {ROBOT("k_p", k_p), AT_LEAST(0), .unit = "1/s^2", .help = "proportional gain of the joint controller (34)"},
    {ROBOT("k_d", k_d), AT_LEAST(0), .unit = "1/s", .help = "derivative gain of the joint controller (34)"},
    MORAY_ROW(CHOICE, moray_snake_options, hydrodynamics, "robot", "hydrodynamics", .flag = "hydrodynamics",
              .choices = hydrodynamics, .help = "the paper's, or strips, both drags, invariant added mass and frame"),
    {HYDRO(rotation, rotations), .help = "drag and added mass at a link's centre or along it, fp model" BY_WORD},
    {HYDRO(drag, drags), .help = "growth of the drag with velocity, fp model" BY_WORD},
    {HYDRO(added_mass, added_masses), .help = "form of the added mass in a current, fp model" BY_WORD},
    {HYDRO(frame, frames), .help = "form of (15) where the robot turns, control-oriented model" BY_WORD},
    MORAY_ROW(INT, moray_snake_options, robot.hydro.pieces, "robot", "pieces", SPAN(1, 1000),
              .help = "rigid pieces a link is cut into for drag and added mass, fp model without strips"),
    {EACH("link_length_m", length), ABOVE(0), .unit = "m", .help = "length of each link" FROM_TAIL},
    {EACH("link_a_e_m", a_e), ABOVE(0), .unit = "m", .help = "semi-axis of each link in the plane of motion"},
    {EACH("link_b_e_m", b_e), ABOVE(0), .unit = "m", .help = "vertical semi-axis of each link"},
    {EACH("link_m_kg", m), ABOVE(0), .unit = "kg", .help = "mass of each link" FROM_GEOMETRY},
    {EACH("link_J_kg_m2", J), ABOVE(0), .unit = "kg m^2",
     .help = "moment of inertia of each link about its centre of mass; from mass and geometry unless given"},
    {EACH("link_c_t", c_t), AT_LEAST(0), .unit = "kg/s", .help = "tangential drag of each link" FROM_GEOMETRY},
    {EACH("link_c_n", c_n), AT_LEAST(0), .unit = "kg/s", .help = "normal drag of each link" FROM_GEOMETRY},
    {EACH("link_mu_n", mu_n), AT_LEAST(0), .unit = "kg", .help = "normal added mass of each link" FROM_GEOMETRY},
    {EACH("link_lambda_1", lambda_1), AT_LEAST(0), .unit = "kg m^2",
     .help = "lambda_1 of (4) of each link" FROM_GEOMETRY},
    {EACH("link_lambda_2", lambda_2), AT_LEAST(0), .unit = "kg m^2/s",
     .help = "lambda_2 of (4) of each link" FROM_GEOMETRY},
    {EACH("link_lambda_3", lambda_3), AT_LEAST(0), .unit = "kg m^2",
     .help = "lambda_3 of (4) of each link" FROM_GEOMETRY},
    {EACH("link_cm_m", cm), .unit = "m",
     .help = "centre of mass of each link, from its middle towards the head; 0 unless given"},
    {EACH("link_cb_m", cb), .unit = "m",
     .help = "centre of buoyancy of each link, at which the water acts, likewise; 0 unless given"},
    {EACH("fin_c_t", fin_c_t), AT_LEAST(0), .unit = "kg/s",
     .help = "tangential drag of a fin on each link; none unless given"},
    {EACH("fin_c_n", fin_c_n), AT_LEAST(0), .unit = "kg/s",
     .help = "normal drag of a fin on each link; none unless given"},
    {EACH("fin_mu_n", fin_mu_n), AT_LEAST(0), .unit = "kg",
     .help = "normal added mass of a fin on each link; none unless given"},
    {EACH("fin_at_m", fin_at), .unit = "m",
     .help = "place of the fin of each link, from its middle towards the head; at the middle unless given"},
    {MOTOR(LIST, "motor_speed_deg_s", speed), AT_LEAST(0), .unit = "deg/s",
     .help = "speeds at the joint of the motors' torque-speed line or table, fp model, rising from 0; for all joints"},
    {MOTOR(LIST, "motor_torque_N_m", torque), AT_LEAST(0), .unit = "N m",
     .help = "torque at the joint that a motor gives at each of these speeds at most, falling and concave"},
    {MOTOR(REAL, "motor_efficiency", efficiency), .min = 1e-3, .max = 1,
     .help = "of the gear where the motor drives the joint; 1 unless given"},
    {MOTOR(REAL, "motor_back_efficiency", back_efficiency), SPAN(0, 1),
     .help =
         "of the gear where the joint drives the motor, which so much of that power comes back from; unless given 0 "
         "with motor_efficiency, 1 without"},
    {MOTOR(REAL, "motor_friction_N_m", friction), AT_LEAST(0), .unit = "N m",
     .help = "dry friction at the joint; none unless given"},
    {MOTOR(REAL, "motor_viscous_N_m_s", viscous), AT_LEAST(0), .unit = "N m s/rad",
     .help = "viscous friction at the joint; none unless given"},
    {MOTOR(LIMIT, "motor_constant", constant), ABOVE(0), .unit = "N m/sqrt(W)",
     .help = "torque at the joint for the square root of the winding's loss; none: no loss"},
    {MOTOR(LIMIT, "motor_rate_deg_s", rate), ABOVE(0), .unit = "deg/s",
     .help = "speed of the joints at most, fp model"},
    {MOTOR(REAL, "motor_idle_W", idle), AT_LEAST(0), .unit = "W", .help = "what the electronics of each motor draw"},
    {MOTOR(REAL, "motor_smooth_deg_s", smooth_rate), ABOVE(0), .unit = "deg/s",
     .help = "speed within which dry friction changes its sign smoothly"},
    {MOTOR(REAL, "motor_smooth_W", smooth_power), ABOVE(0), .unit = "W",
     .help = "power within which the gear changes its direction smoothly"},
    {REAL("battery", "hotel_W", motor.hotel), AT_LEAST(0), .unit = "W",
     .help = "what the robot draws besides its motors"},
    {REAL("battery", "battery_Wh", motor.battery), ABOVE(0), .unit = "Wh",
     .help = "energy of the battery; none unless given"},
};

moray_snake_options moray_snake_options_default(void)
{
    moray_snake_options options = {
        .robot = moray_robot_paper(), .geometry = moray_link_geometry_paper(), .model = MORAY_CONTROL_ORIENTED};
    moray_robot *r = &options.robot;
    r->l = r->m = r->J = r->c_t = r->c_n = r->mu_n = r->lambda_1 = r->lambda_2 = r->lambda_3 = NAN;
    r->rot_damping = r->rot_gain = NAN;
    memset(&r->hydro, -1, offsetof(moray_hydrodynamics, pieces)); // not given
    moray_links_none(&options.lists);
    options.motor = moray_motor_options_default();
    return options;
}

// What was not given comes from the word.
static void make_hydrodynamics(moray_hydrodynamics *hydro, int word)
{
    const moray_hydrodynamics from =
        word == MORAY_CONSISTENT ? moray_hydrodynamics_consistent() : (moray_hydrodynamics){.pieces = 1};
    hydro->rotation = (int)hydro->rotation < 0 ? from.rotation : hydro->rotation;
    hydro->drag = (int)hydro->drag < 0 ? from.drag : hydro->drag;
    hydro->added_mass = (int)hydro->added_mass < 0 ? from.added_mass : hydro->added_mass;
    hydro->frame = (int)hydro->frame < 0 ? from.frame : hydro->frame;
}

// Whether links, geometry, mass and coefficients are those of the paper's robot.
static bool is_the_papers(const moray_robot *robot)
{
    const moray_robot paper = moray_robot_paper();
    const double one[] = {robot->l,    robot->m,        robot->J,        robot->c_t,     robot->c_n,
                          robot->mu_n, robot->lambda_1, robot->lambda_2, robot->lambda_3},
                 other[] = {paper.l,    paper.m,        paper.J,        paper.c_t,     paper.c_n,
                            paper.mu_n, paper.lambda_1, paper.lambda_2, paper.lambda_3};
    const double rounding = 1e-9;
    for (unsigned i = 0; i < sizeof one / sizeof *one; i++)
        if (!(fabs(one[i] - other[i]) <= rounding * other[i]))
            return false;
    return robot->links == paper.links && !robot->link;
}

// The constants of (20) where they are not given.
static bool make_turning(moray_robot *robot)
{
    const moray_robot paper = moray_robot_paper();
    const bool given = !isnan(robot->rot_damping) && !isnan(robot->rot_gain);
    robot->rot_damping = isnan(robot->rot_damping) ? paper.rot_damping : robot->rot_damping;
    robot->rot_gain = isnan(robot->rot_gain) ? paper.rot_gain : robot->rot_gain;
    return given || is_the_papers(robot);
}

moray_status moray_snake_turning(const moray_snake_options *options)
{
    const moray_robot paper = moray_robot_paper();
    if (!options->not_tuned)
        return moray_ok();
    return moray_error(
        MORAY_INPUT,
        "rot_damping, rot_gain: not given; %g and %g are tuned for the paper's robot, not for this one: fit "
        "them with `paper fit --set write_ini=FILE` and this robot's other options, then add --robot FILE",
        paper.rot_damping, paper.rot_gain);
}

// The robot of geometry and direct coefficients.
static moray_status make_robot(void *settings)
{
    moray_snake_options *options = settings;
    moray_robot *given = &options->robot, made = options->robot;
    const moray_link_lists *lists = &options->lists;
    if (moray_links_listed(lists)) {
        MORAY_TRY(moray_links_make(lists, &options->geometry, given, options->link));
        moray_robot_from_links(&made, options->link);
    } else {
        moray_link_of_geometry(&made, &options->geometry, given);
    }
    make_hydrodynamics(&made.hydro, options->hydrodynamics);
    MORAY_TRY(moray_motor_make(&options->motor, &made));
    options->not_tuned = !make_turning(&made);
    *given = made;
    return moray_robot_check(&made);
}

const moray_option_table moray_snake_option_table = {
    .rows = robot_rows, .n = sizeof robot_rows / sizeof *robot_rows, .finish = make_robot};
