// SPDX-License-Identifier: MIT
//
// Gaits found by searching over solved orbits against those of collocation with Ipopt, which has derivatives, linear
// algebra and method of its own and shares the plants and the mesh.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/gait_search.h"
#include "moray/snake/trial.h"

// What the paper's gait uses (an independent implementation).
static const double paper_power[] = {0.3972, 0.2646};
static const char *const names[] = {"control-oriented", "first-principles"};

static moray_gait_problem_spec spec_of(moray_model model)
{
    const bool revolute = model == MORAY_FIRST_PRINCIPLES;
    return (moray_gait_problem_spec){
        .robot = moray_robot_paper(),
        .model = model,
        .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                   .omega = moray_between(30 * DEG, 360 * DEG),
                   .delta = moray_between(15 * DEG, 90 * DEG),
                   .offset = revolute ? moray_between(-10 * DEG, 10 * DEG) : moray_between(-0.02, 0.02),
                   .power = paper_power[model],
                   .joint_rate = MORAY_INFINITY,
                   .joint_effort = MORAY_INFINITY}};
}

static moray_gait gait_of(const moray_gait_problem_spec *spec, double theta_max, double omega, double delta)
{
    return (moray_gait){.amplitude =
                            moray_amplitude_from_theta_max(&spec->robot, spec->model, theta_max * DEG, delta * DEG),
                        .omega = omega * DEG,
                        .delta = delta * DEG};
}

// A search's end and the collocation's from there on.
typedef struct ends {
    moray_gait gait;
    moray_orbit_result orbit;
    moray_search_info info;
    moray_gait_prediction prediction;
    double theta_max; // [deg]
} ends;

static void polish(const moray_gait_problem_spec *spec, moray_orbit *orbit, int intervals, ends *e)
{
    moray_settings settings = moray_settings_default();
    moray_gait_problem *problem = NULL;
    moray_solution *solution = NULL;
    moray_swim_track track;
    settings.scheme = "lobatto5", settings.intervals = intervals, settings.barrier = 1e-4, settings.tolerance = 1e-9;
    CHECK_OK(moray_orbit_track(orbit, 101, &track), "track");
    CHECK_OK(moray_gait_problem_new(&problem, spec), "problem");
    const moray_status status = moray_gait_problem_solve(problem, &settings, &e->gait, &track, &solution);
    CHECK(!moray_failed(status) && moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED,
          "collocation from there: %s", status.text);
    e->prediction = moray_gait_problem_prediction(problem, solution);
    moray_solution_free(solution);
    moray_gait_problem_free(problem);
    moray_swim_track_free(&track);
}

static ends search_from(const moray_gait_problem_spec *spec, moray_gait start, const char *what, int intervals)
{
    const moray_search_settings settings = moray_search_settings_default();
    moray_gait_search *search = NULL;
    ends e = {.gait = start};
    CHECK_OK(moray_gait_search_new(&search, spec, "lobatto5", intervals), what);
    CHECK_OK(moray_gait_search_run(search, &settings, &e.gait, &e.orbit, &e.info), what);
    CHECK(e.info.outcome == MORAY_SEARCH_CONVERGED && e.info.violation <= 1e-9, "%s, %s: %s after %d orbits",
          names[spec->model], what, moray_search_outcome_text(e.info.outcome), e.info.evaluations);
    e.theta_max = moray_theta_max_from_amplitude(&spec->robot, spec->model, e.gait.amplitude, e.gait.delta) / DEG;
    polish(spec, moray_gait_search_orbit(search), intervals, &e);
    moray_gait_search_free(search);
    return e;
}

// Ipopt lets limits go by 1e-8 of themselves.
static void check_agreement(const moray_gait_problem_spec *spec, const ends *e)
{
    const double within = 1e-7;
    const moray_gait *mine = &e->gait, *theirs = &e->prediction.gait;
    CHECK_NEAR(moray_course_speed(&e->orbit.steady, spec->course), e->prediction.course_speed, within,
               "speed as by collocation");
    CHECK_NEAR(e->orbit.steady.power, e->prediction.power, within, "power as by collocation");
    CHECK_NEAR(mine->amplitude, theirs->amplitude, 1e-5, "amplitude");
    CHECK_NEAR(mine->omega, theirs->omega, 1e-4, "omega");
    CHECK_NEAR(mine->delta, theirs->delta, 1e-4, "delta");
    CHECK_NEAR(mine->offset, theirs->offset, 1e-6, "offset");
}

static void test_defaults(void)
{
    moray_gait_problem_spec spec = spec_of(MORAY_CONTROL_ORIENTED);
    ends e = search_from(&spec, gait_of(&spec, 20, 120, 40), "from the paper's gait", 12);
    check_agreement(&spec, &e);
    CHECK_NEAR(e.orbit.steady.speed, 0.2597, 1e-4, "speed");
    CHECK_NEAR(e.gait.delta / DEG, 34.9, 0.1, "delta");
    spec = spec_of(MORAY_FIRST_PRINCIPLES);
    e = search_from(&spec, gait_of(&spec, 20, 120, 40), "from the paper's gait", 12);
    check_agreement(&spec, &e);
    CHECK_NEAR(e.orbit.steady.speed, 0.23856, 2e-5, "speed, 4.03 % above the paper's gait");
    CHECK_NEAR(e.theta_max, 20, 1e-6, "theta_max at its limit");
    const double best = e.orbit.steady.speed;
    e = search_from(&spec, gait_of(&spec, 15, 300, 80), "from short and quick waves", 12);
    check_agreement(&spec, &e);
    CHECK(e.gait.delta > 80 * DEG && e.orbit.steady.speed < best - 1e-3, "another optimum at delta = %.2f deg: %.5f",
          e.gait.delta / DEG, e.orbit.steady.speed);
    spec.limits.theta_max.upper = 60 * DEG;
    e = search_from(&spec, gait_of(&spec, 50, 100, 30), "with large amplitudes", 12);
    check_agreement(&spec, &e);
    CHECK_NEAR(e.orbit.steady.speed / 0.229322, 1.1099, 5e-4, "speed, 10.99 % above the paper's gait");
    CHECK_NEAR(e.theta_max, 31.35, 0.02, "theta_max within its limits");
}

static void test_limits(moray_model model)
{
    const bool revolute = model == MORAY_FIRST_PRINCIPLES;
    moray_gait_problem_spec spec = spec_of(model);
    spec.limits.joint_rate = revolute ? 0.5 : 0.08;
    ends e = search_from(&spec, gait_of(&spec, 10, 100, 50), "joint rate limited", 12);
    check_agreement(&spec, &e);
    CHECK_NEAR(e.gait.amplitude * e.gait.omega, spec.limits.joint_rate, 1e-8, "joint rate at its limit");
    spec = spec_of(model);
    spec.goal = MORAY_GAIT_THRIFTIEST;
    spec.limits.power = MORAY_INFINITY;
    spec.limits.course_speed = 0.2;
    e = search_from(&spec, gait_of(&spec, 20, 120, 40), "least work per distance at 0.2 m/s", 12);
    check_agreement(&spec, &e);
    CHECK_NEAR(e.orbit.steady.speed, 0.2, 1e-8, "speed at its limit");
    CHECK_NEAR(e.info.objective, e.prediction.power / e.prediction.course_speed, 1e-6, "work per distance");
    spec = spec_of(model);
    spec.current[0] = 0.05, spec.current[1] = 0.08, spec.course = 20 * DEG;
    e = search_from(&spec, gait_of(&spec, 20, 120, 40), "in a current", 12);
    check_agreement(&spec, &e);
}

// The search limits the effort at every degree, collocation at the nodes of its mesh.
static void test_effort(void)
{
    moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    spec.limits.joint_effort = 0.3;
    const ends e = search_from(&spec, gait_of(&spec, 15, 120, 50), "joint torque limited", 60);
    CHECK_NEAR(e.orbit.steady.peak_effort, 0.3, 1e-8, "torque at its limit");
    CHECK_NEAR(e.orbit.steady.speed, e.prediction.speed, 2e-5, "speed as by collocation");
}

// What the motors of the first-principles model give, and how fast they turn, limits a search as it does collocation.
static void test_motors(void)
{
    const double speed[] = {0, 2}, torque[] = {0.5, 0};
    moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    spec.robot.motor = (moray_motor){
        .fitted = true, .forward = 0.8, .backward = 0.2, .friction = 0.01, .smooth_rate = 0.1, .smooth_power = 0.02};
    CHECK_OK(moray_motor_set_table(&spec.robot.motor, speed, torque, 2), "line");
    spec.limits.power = MORAY_INFINITY;
    spec.limits.delta = moray_fixed(50 * DEG); // along which there are several optima
    ends e = search_from(&spec, gait_of(&spec, 15, 70, 50), "a motor's line", 60);
    CHECK_NEAR(e.orbit.peak_load, 1, 1e-8, "all that the motors give");
    CHECK_NEAR(e.orbit.steady.speed, e.prediction.speed, 1e-4, "speed as by collocation");
    spec.robot.supply.rate = 0.7 * e.gait.amplitude * e.gait.omega;
    e = search_from(&spec, gait_of(&spec, 15, 70, 50), "a motor's speed", 60);
    CHECK_NEAR(e.gait.amplitude * e.gait.omega, spec.robot.supply.rate, 1e-8, "as fast as the motors turn");
    CHECK_NEAR(e.orbit.steady.speed, e.prediction.speed, 1e-4, "speed as by collocation");
    spec.model = MORAY_CONTROL_ORIENTED; // whose joints have no motors
    spec.limits.offset = moray_between(-0.02, 0.02);
    spec.limits.power = paper_power[0];
    e = search_from(&spec, gait_of(&spec, 20, 120, 40), "no motors", 12);
    check_agreement(&spec, &e);
}

// A global method meets the best of the optima that local searches find.
static void test_global(void)
{
    const moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    moray_search_settings settings = moray_search_settings_default();
    moray_gait_search *search;
    moray_gait gait = gait_of(&spec, 15, 300, 80); // in the wrong valley
    moray_orbit_result orbit;
    moray_search_info info;
    settings.method = MORAY_SEARCH_MLSL;
    settings.max_evaluations = 300;
    settings.x_tolerance = 1e-6;
    CHECK_OK(moray_gait_search_new(&search, &spec, "lobatto5", 12), "search");
    CHECK_OK(moray_gait_search_run(search, &settings, &gait, &orbit, &info), "global search");
    CHECK_NEAR(orbit.steady.speed, 0.23856, 2e-5, "best of the optima");
    CHECK(info.violation <= 1e-9 && info.evaluations <= 300, "in %d orbits, violation %.1e", info.evaluations,
          info.violation);
    moray_gait_search_free(search);
}

static void refuses(moray_gait_problem_spec spec, const char *text)
{
    moray_gait_search *search;
    const moray_status status = moray_gait_search_new(&search, &spec, "lobatto5", 12);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, text) && !search, "refused: %s", status.text);
}

static void test_refusals(void)
{
    const moray_gait_problem_spec good = spec_of(MORAY_CONTROL_ORIENTED);
    moray_gait_problem_spec spec = good;
    spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    refuses(spec, "joints");
    spec = good, spec.limits.link_angles = true;
    refuses(spec, "link_angles");
    spec = good, spec.limits.offset = moray_between(0.001, 0.02);
    refuses(spec, "phi0 = 0.001:0.02");
    spec = good, spec.limits.delta = moray_between(1, 0.5);
    refuses(spec, "delta_deg = ");
    moray_gait_search_free(NULL);
}

int main(void)
{
    test_defaults();
    test_limits(MORAY_CONTROL_ORIENTED);
    test_limits(MORAY_FIRST_PRINCIPLES);
    test_effort();
    test_motors();
    test_global();
    test_refusals();
    return tap_done();
}
