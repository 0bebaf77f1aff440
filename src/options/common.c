// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <math.h>

static const char *const models[] = {[MORAY_CONTROL_ORIENTED] = "control", [MORAY_FIRST_PRINCIPLES] = "fp", NULL};
static const char *const linear_solvers[] = {
    [MORAY_LINEAR_OWN] = "moray", [MORAY_LINEAR_MUMPS] = "mumps", [MORAY_LINEAR_MA57] = "ma57", NULL};
_Static_assert(sizeof(moray_model) == sizeof(int) && sizeof(moray_linear_solver) == sizeof(int),
               "choices are stored as int");

#define SPAN(low, high) .min = (low), .max = (high)
#define ABOVE(low) .min = (low), .max = INFINITY, .open = true
#define AT_LEAST(low) .min = (low), .max = INFINITY
#define REAL(where, name, field) .section = where, .key = name, .type = MORAY_OPTION_REAL, MORAY_AT(moray_common, field)
#define ROBOT(name, field) REAL("robot", name, robot.field)
#define LINK(name, field) REAL("robot", name, geometry.field)
#define FROM_GEOMETRY "; from the geometry unless given"

static const moray_option robot_rows[] = {
    {.flag = "robot",
     .argument = "FILE",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(moray_common, robot_file),
     .help = "INI file with the robot and any other keys"},
    {.section = "robot",
     .key = "links",
     .flag = "links",
     .type = MORAY_OPTION_INT,
     MORAY_AT(moray_common, robot.links),
     SPAN(2, 1000),
     .help = "number of links N"},
    {.section = "problem",
     .key = "model",
     .flag = "model",
     .type = MORAY_OPTION_CHOICE,
     MORAY_AT(moray_common, model),
     .choices = models,
     .help = "control-oriented or first-principles (fp) model"},
    {.section = "problem",
     .key = "current",
     .flag = "current",
     .argument = "VX,VY",
     .type = MORAY_OPTION_PAIR,
     MORAY_AT(moray_common, current),
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
    {ROBOT("J_kg_m2", J), ABOVE(0), .unit = "kg m^2", .help = "moment of inertia of a link" FROM_GEOMETRY},
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
     .help = "rotational damping of the control-oriented model, first constant of (20)"},
    {ROBOT("rot_gain", rot_gain), AT_LEAST(0), .unit = "1/(m^2 s)",
     .help = "gain from joint offset to turning in the control-oriented model, second constant of (20)"},
    {ROBOT("k_p", k_p), AT_LEAST(0), .unit = "1/s^2", .help = "proportional gain of the joint controller (34)"},
    {ROBOT("k_d", k_d), AT_LEAST(0), .unit = "1/s", .help = "derivative gain of the joint controller (34)"},
};

static const moray_option solver_rows[] = {
    {.section = "solver",
     .key = "scheme",
     .flag = "scheme",
     .argument = "NAME",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(moray_common, scheme),
     .help =
         "collocation scheme: hermite-simpson, trapezoid, or lobatto, radau or gauss followed by its number of stages"},
    {.section = "solver",
     .key = "intervals",
     .flag = "intervals",
     .argument = "K",
     .type = MORAY_OPTION_INT,
     MORAY_AT(moray_common, intervals),
     SPAN(1, 100000),
     .help = "number of collocation intervals"},
    {REAL("solver", "tol", tol), .flag = "tol", SPAN(0, 1), .open = true, .help = "tolerance of the solver"},
    {.section = "solver",
     .key = "linear_solver",
     .type = MORAY_OPTION_CHOICE,
     MORAY_AT(moray_common, linear_solver),
     .choices = linear_solvers,
     .help = "factorisation inside Ipopt: our own, MUMPS, or an MA57 in libhsl.so"},
    {.flag = "json",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(moray_common, json),
     .help = "print one JSON object instead of tables"},
    {.flag = "out",
     .argument = "DIR",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(moray_common, out),
     .help = "write summary, trajectory, figures and report into this directory"},
    {.flag = "quiet", .type = MORAY_OPTION_BOOL, MORAY_AT(moray_common, quiet), .help = "show no progress"},
};

const moray_option *moray_robot_rows(int *n)
{
    *n = sizeof robot_rows / sizeof *robot_rows;
    return robot_rows;
}

const moray_option *moray_solver_rows(int *n)
{
    *n = sizeof solver_rows / sizeof *solver_rows;
    return solver_rows;
}

moray_common moray_common_defaults(void)
{
    moray_common common = {.robot = moray_robot_paper(),
                           .geometry = moray_link_geometry_paper(),
                           .model = MORAY_CONTROL_ORIENTED,
                           .scheme = "hermite-simpson",
                           .intervals = 40,
                           .tol = 1e-8};
    moray_robot *r = &common.robot;
    r->l = r->m = r->J = r->c_t = r->c_n = r->mu_n = r->lambda_1 = r->lambda_2 = r->lambda_3 = NAN;
    return common;
}

moray_status moray_common_make_robot(moray_common *common)
{
    moray_robot *given = &common->robot, made = common->robot;
    moray_robot_from_geometry(&made, &common->geometry);
    double *const to[] = {&made.l,    &made.m,        &made.J,        &made.c_t,     &made.c_n,
                          &made.mu_n, &made.lambda_1, &made.lambda_2, &made.lambda_3};
    const double from[] = {given->l,    given->m,        given->J,        given->c_t,     given->c_n,
                           given->mu_n, given->lambda_1, given->lambda_2, given->lambda_3};
    for (unsigned i = 0; i < sizeof from / sizeof *from; i++)
        if (!isnan(from[i]))
            *to[i] = from[i];
    *given = made;
    return moray_robot_check(&made);
}
