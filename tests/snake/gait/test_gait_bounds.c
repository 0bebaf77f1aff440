// SPDX-License-Identifier: MIT
//
// What a gait problem bounds, under which name: events, path, parameters and times; whole texts of what it refuses.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/gait_over.h"
#include "moray/snake/gait_search.h"
#include "snake/gait/problem.h"

enum { LINKS = 5, JOINTS = LINKS - 1 };

static moray_gait_problem_spec spec_of(moray_model model)
{
    moray_gait_problem_spec spec = {.robot = moray_robot_paper(),
                                    .model = model,
                                    .limits = {.theta_max = moray_between(5 * DEG, 20 * DEG),
                                               .omega = moray_between(0.5, 6),
                                               .delta = moray_between(0.3, 1.5),
                                               .power = MORAY_INFINITY,
                                               .joint_rate = MORAY_INFINITY,
                                               .joint_effort = MORAY_INFINITY}};
    spec.robot.links = LINKS;
    return spec;
}

static moray_gait_problem *problem_of(const moray_gait_problem_spec *spec)
{
    moray_gait_problem *problem = NULL;
    CHECK_OK(moray_gait_problem_new(&problem, spec), "problem");
    if (!problem)
        exit(1);
    return problem;
}

typedef struct {
    const char *name;
    double lower, upper;
} expected;

static void check_bounds(const moray_bounds *bounds, double lower, double upper, const char *what)
{
    CHECK(fabs(bounds->lower - lower) <= 1e-14 * fabs(lower) && fabs(bounds->upper - upper) <= 1e-14 * fabs(upper),
          "%s: %.17g to %.17g, expected %.17g to %.17g", what, bounds->lower, bounds->upper, lower, upper);
}

// Names and bounds in order.
static void check_list(const moray_bounds *at, const char *const *name, int n, const expected *want, int wanted)
{
    CHECK(n == wanted, "%d, expected %d", n, wanted);
    for (int k = 0; k < n && k < wanted; k++) {
        CHECK(strcmp(name[k], want[k].name) == 0, "%d: %s, expected %s", k, name[k], want[k].name);
        check_bounds(&at[k], want[k].lower, want[k].upper, want[k].name);
    }
}
#define CHECK_EVENTS(problem, ...)                                                                                     \
    check_list((problem)->e.at, (problem)->names, (problem)->e.n, (const expected[]){__VA_ARGS__},                     \
               sizeof((const expected[]){__VA_ARGS__}) / sizeof(expected))
#define RETURNS                                                                                                        \
    {"periodicity 1", 0, 0}, {"periodicity 2", 0, 0}, {"periodicity 3", 0, 0}, {"periodicity 4", 0, 0},                \
        {"way across the course", 0, 0},                                                                               \
    {                                                                                                                  \
        "omega T", 2 * M_PI, 2 * M_PI                                                                                  \
    }

static const double none = MORAY_INFINITY;

// ---- Events --------------------------------------------------------------------------------------------------------

static void test_events_fp(void)
{
    const double most = 20 * DEG;
    moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    moray_gait_problem *problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", 5 * DEG, most});
    moray_gait_problem_free(problem);
    spec.limits.taper = moray_between(-0.4, 0.3);
    spec.limits.offset = moray_between(-0.1, 0.2);
    spec.limits.power = 0.7;
    spec.limits.joint_rate = 2.5;
    spec.limits.course_speed = 0.06;
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", 5 * DEG, most}, {"theta_max of the head", -none, most * most},
                 {"theta_max of the tail", -none, most * most}, {"power", -none, 0.7},
                 {"joint rate of the head", -none, 2.5}, {"joint rate of the tail", -none, 2.5},
                 {"course speed", 0.06, none});
    moray_gait_problem_free(problem);
    spec.limits.taper = moray_between(-0.4, 0);
    spec.limits.course_speed = 0;
    spec.goal = MORAY_GAIT_THRIFTIEST;
    spec.robot.supply.rate = 1.5;
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", 5 * DEG, most}, {"theta_max of the tail", -none, most * most},
                 {"power", -none, 0.7}, {"joint rate", -none, 1.5}, {"course speed", 1e-3, none});
    moray_gait_problem_free(problem);
    spec.limits.taper = moray_between(0, 0.4);
    spec.limits.course_speed = 0.02;
    spec.limits.power = none;
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", 5 * DEG, most}, {"theta_max of the head", -none, most * most},
                 {"joint rate", -none, 1.5}, {"course speed", 0.02, none});
    moray_gait_problem_free(problem);
}

// Where an offset turns the links to a side, their angles are bounded there.
static void test_events_control(void)
{
    const double most = 20 * DEG, sine = sin(most);
    moray_gait_problem_spec spec = spec_of(MORAY_CONTROL_ORIENTED);
    moray_gait_problem *problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", sin(5 * DEG), sine});
    moray_gait_problem_free(problem);
    spec.limits.offset = moray_between(-0.01, 0);
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", sin(5 * DEG), sine},
                 {"end link of the head, to the right", -none, most}, {"link of the head, to the right", -none, most});
    moray_gait_problem_free(problem);
    spec.limits.offset = moray_between(0, 0.01);
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", sin(5 * DEG), sine},
                 {"end link of the head, to the left", -none, most}, {"link of the head, to the left", -none, most});
    moray_gait_problem_free(problem);
    spec.limits.offset = moray_fixed(0);
    spec.limits.link_angles = true;
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", sin(5 * DEG), 1}, {"end link of the head, to the left", -none, most},
                 {"link of the head, to the left", -none, most});
    moray_gait_problem_free(problem);
    spec.limits.offset = moray_between(-0.02, 0.01);
    spec.limits.taper = moray_between(-0.4, 0.3);
    spec.limits.power = 0.9;
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", sin(5 * DEG), 1}, {"theta_max of the head", -none, 1},
                 {"theta_max of the tail", -none, 1}, {"power", -none, 0.9},
                 {"end link of the head, to the left", -none, most},
                 {"end link of the head, to the right", -none, most}, {"link of the head, to the left", -none, most},
                 {"link of the head, to the right", -none, most}, {"end link of the tail, to the left", -none, most},
                 {"end link of the tail, to the right", -none, most}, {"link of the tail, to the left", -none, most},
                 {"link of the tail, to the right", -none, most});
    moray_gait_problem_free(problem);
    spec.limits.taper = moray_between(-0.4, 0);
    spec.limits.link_angles = false;
    spec.limits.offset = moray_between(0.001, 0.01);
    problem = problem_of(&spec);
    CHECK_EVENTS(problem, RETURNS, {"theta_max", sin(5 * DEG), sine}, {"theta_max of the tail", -none, sine * sine},
                 {"power", -none, 0.9}, {"end link of the tail, to the left", -none, most},
                 {"link of the tail, to the left", -none, most});
    moray_gait_problem_free(problem);
}

// ---- Path, start and times -----------------------------------------------------------------------------------------

// `count` outputs from `first` on are within `most`, by the name `what` and their numbers.
static int check_path(const moray_gait_problem *problem, int first, int count, const char *what, double most)
{
    for (int k = 0; k < count && first + k < problem->phase.nc; k++) {
        char name[40];
        snprintf(name, sizeof name, "%s %d", what, k + 1);
        check_bounds(&problem->phase.c.at[first + k], -most, most, name);
        CHECK(strcmp(problem->phase.c_names[first + k], name) == 0, "%s, not %s", problem->phase.c_names[first + k],
              name);
    }
    return first + count;
}

static void check_phase(const moray_gait_problem *problem, int position)
{
    const moray_phase_spec *phase = &problem->phase;
    const moray_bounds *omega = &problem->spec.limits.omega;
    check_bounds(&phase->t0, 0, 0, "start");
    check_bounds(&phase->tf, 1.8 * M_PI / omega->upper, 2.2 * M_PI / omega->lower, "end");
    CHECK(phase->x0.n == phase->nx && problem->endpoint.position == position, "%d states, the place from %d on",
          phase->nx, problem->endpoint.position);
    for (int i = 0; i < phase->nx; i++)
        if (i == position || i == position + 1)
            check_bounds(&phase->x0.at[i], 0, 0, "begins at the origin");
        else
            check_bounds(&phase->x0.at[i], -none, none, "any");
}

static void test_path(void)
{
    moray_gait_problem_spec spec = spec_of(MORAY_CONTROL_ORIENTED);
    spec.limits.joint_effort = 0.3;
    moray_gait_problem *problem = problem_of(&spec);
    check_phase(problem, 1);
    CHECK(check_path(problem, 0, JOINTS, "joint effort", 0.3) == problem->phase.nc, "efforts");
    moray_gait_problem_free(problem);
    spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    spec.limits.link_angles = true;
    problem = problem_of(&spec);
    check_phase(problem, JOINTS + 1);
    int at = check_path(problem, 0, JOINTS, "joint effort", 0.3);
    at = check_path(problem, at, LINKS, "link angle", 20 * DEG);
    CHECK(at == problem->phase.nc, "efforts and angles: %d of %d", at, problem->phase.nc);
    moray_gait_problem_free(problem);
    spec = spec_of(MORAY_FIRST_PRINCIPLES);
    const double speed[] = {0, 2, 5}, torque[] = {0.9, 0.7, 0};
    spec.robot.motor.fitted = true;
    spec.robot.motor.forward = 0.8;
    spec.robot.motor.smooth_rate = spec.robot.motor.smooth_power = 0.1;
    CHECK_OK(moray_motor_set_table(&spec.robot.motor, speed, torque, 3), "motor");
    spec.limits.joint_effort = 0.4;
    spec.limits.joint_rate = 3;
    spec.limits.link_angles = true;
    problem = problem_of(&spec);
    check_phase(problem, 1);
    const moray_motor *motor = &spec.robot.motor;
    CHECK(motor->lines == 2 && motor->torque[0] != motor->torque[1], "two lines: %g, %g", motor->torque[0],
          motor->torque[1]);
    at = check_path(problem, 0, JOINTS, "joint effort", 0.4);
    for (int k = 0; k < 2 * JOINTS && at + k < problem->phase.nc; k++)
        check_bounds(&problem->phase.c.at[at + k], -motor->torque[k / JOINTS], motor->torque[k / JOINTS], "supply");
    CHECK(strcmp(problem->phase.c_names[at + JOINTS], "supply 5") == 0, "%s", problem->phase.c_names[at + JOINTS]);
    at = check_path(problem, at + 2 * JOINTS, LINKS, "link angle", 20 * DEG);
    CHECK(at == problem->phase.nc, "efforts, supply and angles: %d of %d", at, problem->phase.nc);
    moray_gait_problem_free(problem);
}

// ---- Parameters ----------------------------------------------------------------------------------------------------

static void test_parameters(void)
{
    for (int model = 0; model < 2; model++)
        for (int angles = 0; angles < 2; angles++) {
            moray_gait_problem_spec spec = spec_of((moray_model)model);
            spec.limits.offset = moray_between(-0.02, 0.05);
            spec.limits.taper = moray_between(-0.4, 0.3);
            spec.limits.link_angles = angles;
            moray_gait_problem *problem = problem_of(&spec);
            const double swing = model == MORAY_CONTROL_ORIENTED ? 2 * spec.robot.l * sin(20 * DEG) : 40 * DEG;
            CHECK(problem->s.n == MORAY_GAIT_PARAMETERS, "%d parameters", problem->s.n);
            check_bounds(&problem->s.at[0], 0, angles ? 2 * swing : swing, "amplitude");
            check_bounds(&problem->s.at[1], 0.5, 6, "omega");
            check_bounds(&problem->s.at[2], 0.3, 1.5, "delta");
            check_bounds(&problem->s.at[3], -0.02, 0.05, "offset");
            check_bounds(&problem->s.at[4], -0.4, 0.3, "taper");
            moray_gait_problem_free(problem);
        }
}

// omega, an offset of each joint, and coefficients of which the first sine is none.
static void test_series(moray_model model)
{
    moray_gait_problem_spec spec = spec_of(model);
    const double swing = model == MORAY_CONTROL_ORIENTED ? 4 * spec.robot.l * sin(20 * DEG) : 80 * DEG;
    spec.joints = MORAY_JOINTS_SERIES;
    spec.harmonics = 2;
    spec.limits.offset = moray_between(-0.02, 0.05);
    spec.limits.joint_rate = 1.2;
    moray_gait_problem *problem = problem_of(&spec);
    CHECK(problem->s.n == 1 + 5 * JOINTS, "%d parameters", problem->s.n);
    check_bounds(&problem->s.at[0], 0.5, 6, "omega");
    for (int i = 1; i < problem->s.n; i++)
        if (i <= JOINTS)
            check_bounds(&problem->s.at[i], -0.02, 0.05, "offset");
        else if (i == 1 + 2 * JOINTS)
            check_bounds(&problem->s.at[i], 0, 0, "when time starts");
        else
            check_bounds(&problem->s.at[i], -swing, swing, "coefficient");
    const int at =
        check_path(problem, check_path(problem, 0, LINKS, "link angle", 20 * DEG), JOINTS, "joint rate", 1.2);
    CHECK(at == problem->phase.nc, "angles and rates: %d of %d", at, problem->phase.nc);
    CHECK_EVENTS(problem, RETURNS);
    moray_gait_problem_free(problem);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refuse(const moray_gait_problem_spec *spec, const char *says)
{
    moray_gait_problem *problem;
    const moray_status status = moray_gait_problem_new(&problem, spec);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && !problem, "refused: %s", status.text);
}

static void test_refused(void)
{
    for (int k = 0; k < 3; k++) {
        moray_gait_problem_spec bad = spec_of(MORAY_CONTROL_ORIENTED);
        char says[200];
        bad.current[0] = 0.1, bad.current[1] = 0.2, bad.course = 0.3;
        *(k < 2 ? &bad.current[k] : &bad.course) = NAN;
        snprintf(says, sizeof says, "current = %g,%g, course = %g: must be finite", bad.current[0], bad.current[1],
                 bad.course);
        refuse(&bad, says);
    }
    moray_gait_problem_spec bad = spec_of(MORAY_FIRST_PRINCIPLES);
    bad.joints = MORAY_JOINTS_CLOSED_LOOP;
    refuse(&bad, "joints: the first-principles model has none in closed loop");
    bad.joints = MORAY_JOINTS_FREE;
    refuse(&bad, "joints = free: an optimal gait has its joints on the gait, on a series or in closed loop");
    bad = spec_of(MORAY_FIRST_PRINCIPLES), bad.limits.offset = moray_between(-1, 91 * DEG);
    refuse(&bad, "phi0_deg = -57.2958:91: must be a range lo:hi within -90:90");
    bad = spec_of(MORAY_CONTROL_ORIENTED), bad.robot.l = 0.25, bad.limits.offset = moray_between(-0.1, 0.3);
    refuse(&bad, "phi0_m = -0.1:0.3: must be a range lo:hi within -0.25:0.25");
    bad = spec_of(MORAY_CONTROL_ORIENTED), bad.limits.joint_rate = 0;
    refuse(&bad, "joint_rate = 0: must be above 0, or none");
    bad = spec_of(MORAY_CONTROL_ORIENTED), bad.limits.joint_effort = -2;
    refuse(&bad, "joint_effort = -2: must be above 0, or none");
    bad = spec_of(MORAY_CONTROL_ORIENTED), bad.limits.course_speed = INFINITY;
    refuse(&bad, "speed_m_s = inf: must be finite and above 0, or none");
    moray_gait_problem_spec good = spec_of(MORAY_CONTROL_ORIENTED);
    good.robot.links = 3;
    good.limits.taper = moray_between(-1, 1);
    moray_gait_problem_free(problem_of(&good));
    good.robot.links = 2;
    good.limits.taper = moray_fixed(0);
    moray_gait_problem_free(problem_of(&good));
}

static void refuse_over(const moray_gait_scenario *scenario, int n, const char *says)
{
    moray_gait_over *over;
    const moray_status status = moray_gait_over_new(&over, scenario, n, MORAY_OVER_MEAN);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && !over, "refused: %s", status.text);
}

static void test_over(void)
{
    static char names[MORAY_SCENARIOS + 1][8];
    moray_gait_scenario scenario[MORAY_SCENARIOS + 1];
    moray_gait_over *over;
    for (int k = 0; k <= MORAY_SCENARIOS; k++) {
        snprintf(names[k], sizeof names[k], "no %d", k + 1);
        scenario[k] = (moray_gait_scenario){names[k], spec_of(MORAY_CONTROL_ORIENTED), 0.2};
    }
    refuse_over(scenario, 0, "0 scenarios: must be 1 to 16");
    refuse_over(scenario, 17, "17 scenarios: must be 1 to 16");
    CHECK_OK(moray_gait_over_new(&over, scenario, MORAY_SCENARIOS, MORAY_OVER_WORST), "as many as there may be");
    moray_gait_over_free(over);
    static const double speeds[] = {0, -1, INFINITY, NAN};
    for (int k = 0; k < 4; k++) {
        char says[200];
        scenario[1].speed = speeds[k];
        snprintf(says, sizeof says, "scenario no 2: speed of the baseline = %g m/s: must be finite and above 0",
                 speeds[k]);
        refuse_over(scenario, 2, says);
    }
    scenario[1].speed = 0.2;
    scenario[2].problem.model = MORAY_FIRST_PRINCIPLES;
    refuse_over(scenario, 3, "scenario no 3: all have their joints on the gait, and the same model");
    scenario[0].problem.joints = MORAY_JOINTS_CLOSED_LOOP;
    refuse_over(scenario, 1, "scenario no 1: all have their joints on the gait, and the same model");
}

// In still water the heading returns without an offset only; in any current it may need one.
static void test_search(void)
{
    static const double currents[][2] = {{0, 0}, {0.05, 0}, {0, -0.05}};
    for (int side = -1; side <= 1; side += 2)
        for (int k = 0; k < 3; k++) {
            moray_gait_problem_spec spec = spec_of(MORAY_CONTROL_ORIENTED);
            moray_gait_search *search;
            spec.limits.offset = side < 0 ? moray_between(-0.02, -0.001) : moray_between(0.001, 0.02);
            memcpy(spec.current, currents[k], sizeof spec.current);
            const moray_status status = moray_gait_search_new(&search, &spec, "lobatto5", 12);
            CHECK(moray_failed(status) == (k == 0) && !search == (k == 0), "in (%g, %g) m/s: %s", currents[k][0],
                  currents[k][1], status.text);
            moray_gait_search_free(search);
        }
    moray_gait_problem_spec spec = spec_of(MORAY_CONTROL_ORIENTED);
    moray_gait_search *search;
    spec.limits.taper = moray_between(0, 0.25);
    const moray_status status = moray_gait_search_new(&search, &spec, "lobatto5", 12);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "taper = 0:0.25: a search knows gaits without one") == 0,
          "%s", status.text);
}

int main(void)
{
    test_search();
    test_events_fp();
    test_events_control();
    test_path();
    test_parameters();
    test_series(MORAY_CONTROL_ORIENTED);
    test_series(MORAY_FIRST_PRINCIPLES);
    test_refused();
    test_over();
    return tap_done();
}
