// SPDX-License-Identifier: MIT
//
// Periodic orbits against steady swimming as simulated from rest, in closed loop and with all states, which shares the
// models' rates with them but not the plants, the collocation or Newton's method.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "moray/snake/orbit.h"

static const moray_model models[] = {MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES};
static const char *const names[] = {"control-oriented", "first-principles"};

static moray_robot robot_of(int links)
{
    moray_robot robot = moray_robot_paper();
    robot.links = links;
    return robot;
}

static moray_gait gait_of(const moray_robot *robot, moray_model model, double theta_max, double omega, double delta)
{
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(robot, model, theta_max * DEG, delta * DEG),
                        .omega = omega * DEG,
                        .delta = delta * DEG};
}

// One case: who swims how, in what current, on what course.
typedef struct closed_loop {
    int links;
    double theta_max, omega, delta, offset; // [deg], [deg/s], [deg], of the amplitude
    double current[2], course;
    bool steered;
} closed_loop;

static const closed_loop closed_loops[] = {
    {10, 20, 120, 40, 0, {0, 0}, 0, true},          {10, 10, 240, 55, 0, {0, 0}, 0.7, true},
    {10, 30, 60, 80, 0, {0, 0}, -2, true},          {10, 20, 120, 40, 0, {0.1, 0.1}, 0, true},
    {10, 20, 150, 52, 0, {-0.05, 0.08}, 0.4, true}, {10, 20, 120, 40, 0, {0, -0.15}, 0, false},
    {3, 20, 120, 80, 0, {0, 0}, 0, true},           {3, 30, 200, 60, 0, {0.004, 0.006}, 0, true},
    {10, 20, 120, 40, 1.0 / 6, {0, 0}, 0.3, false}, {3, 25, 150, 70, 0.3, {0, 0}, 0, false},
};

static moray_orbit_spec spec_of(const closed_loop *v, const moray_robot *robot, moray_model model)
{
    moray_orbit_spec spec = moray_orbit_spec_default(robot, model);
    memcpy(spec.current, v->current, sizeof spec.current);
    spec.course = v->course;
    spec.steered = v->steered;
    return spec;
}

// Steady swimming from rest, on the course where one can be held.
static moray_steady simulate(const closed_loop *v, const moray_robot *robot, moray_model model, const moray_gait *gait)
{
    moray_test_rig rig;
    moray_steady steady = {.speed = NAN, .power = NAN};
    CHECK_OK(moray_test_rig_new(&rig, robot, v->current, v->course), "rig");
    moray_swim_setup setup = moray_test_rig_setup(&rig, model);
    setup.settings.agreement = 1e-9;
    if (v->offset == 0)
        CHECK_OK(moray_swim_hold_course(&setup, gait, v->course, &steady), "swum on the course");
    else
        CHECK_OK(moray_swim_steady(&setup, gait, 0, &steady, NULL, 0), "swum in circles");
    moray_test_rig_free(&rig);
    return steady;
}

static double angle_between(double a, double b)
{
    return remainder(a - b, 2 * M_PI);
}

static void test_against_simulation(const closed_loop *v, moray_model model)
{
    const moray_robot robot = robot_of(v->links);
    const moray_orbit_spec spec = spec_of(v, &robot, model);
    moray_gait gait = gait_of(&robot, model, v->theta_max, v->omega, v->delta);
    moray_orbit *orbit = NULL;
    moray_orbit_result found;
    gait.offset = v->offset * gait.amplitude;
    printf("# %s, %d links, %g deg, %g deg/s, %g deg, current %g, %g\n", names[model], v->links, v->theta_max, v->omega,
           v->delta, v->current[0], v->current[1]);
    CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
    CHECK_OK(moray_orbit_solve(orbit, &gait, &found), "found");
    moray_orbit_free(orbit);
    const moray_steady *at = &found.steady, swum = simulate(v, &robot, model, &found.gait);
    CHECK(found.residual <= 1e-11, "defects %.1e after %d iterations", found.residual, found.iterations);
    CHECK_NEAR(at->speed, swum.speed, 1e-6 * swum.speed, "speed");
    CHECK_NEAR(at->power, swum.power, 1e-6 * swum.power, "power");
    CHECK_NEAR(at->cost_of_transport, swum.cost_of_transport, 1e-6 * swum.cost_of_transport, "cost of transport");
    CHECK_NEAR(at->peak_effort, swum.peak_effort, 1e-6 * swum.peak_effort, "peak effort");
    CHECK_NEAR(at->peak_link_angle, swum.peak_link_angle, 1e-6, "peak link angle");
    CHECK_NEAR(at->heading_drift, swum.heading_drift, 1e-6, "turning rate");
    CHECK(at->turning == swum.turning, "%s", at->turning ? "turning" : "not turning");
    CHECK_NEAR(at->v_y * cos(v->course) - at->v_x * sin(v->course), 0, 1e-11, "no motion across the course");
    if (v->offset != 0)
        return;
    CHECK_NEAR(moray_course_speed(at, v->course), moray_course_speed(&swum, v->course), 1e-6, "speed along the course");
    CHECK_NEAR(angle_between(at->heading, swum.heading), 0, 2e-6, "heading"); // a course is held to 1e-6
    CHECK(!v->steered || at->heading_drift == 0 || fabs(at->heading_drift) < 1e-11, "the heading returns");
}

// All states of the swimmer, set on the orbit, return after a period in closed loop; and the track tells the work.
static void test_return(moray_model model)
{
    enum { points = 9 };
    const moray_robot robot = robot_of(10);
    const closed_loop v = {.current = {0.06, -0.04}, .course = 0.5, .steered = true};
    const moray_orbit_spec spec = spec_of(&v, &robot, model);
    const moray_gait gait = gait_of(&robot, model, 25, 150, 50);
    const moray_sim_settings settings = {.rtol = 1e-11, .atol = 1e-12, .max_steps = 1000000};
    moray_orbit *orbit;
    moray_orbit_result found;
    moray_swim_track track, swum;
    moray_swimmer *swimmer;
    double x[24], away = 0, energy;
    CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
    CHECK_OK(moray_orbit_solve(orbit, &gait, &found), "found");
    CHECK_OK(moray_orbit_track(orbit, points, &track), "track");
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    CHECK_OK(moray_swim_track_new(&swum, swimmer, points), "track of the simulation");
    moray_swimmer_set_current(swimmer, v.current[0], v.current[1]);
    memcpy(x, track.x, sizeof x);
    const moray_gait_change change = {0, found.gait};
    const moray_swim_plan plan = {.t1 = 2 * M_PI / gait.omega,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = track.t,
                                  .n_times = points,
                                  .observe = moray_swim_track_add,
                                  .observer = &swum};
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, &energy), "one period simulated");
    for (int k = 0; k < points * 24; k++)
        away = tap_worse(away, fabs(track.x[k] - swum.x[k]));
    CHECK(track.n == points && swum.n == points && away < 1e-7, "%s: the simulation stays on the orbit: %.1e",
          names[model], away);
    for (int k = 0; k < 24; k++) // the position, 10 and 11, moves on
        away = tap_worse(away, k / 2 == 5 ? 0 : fabs(track.x[k] - x[k]));
    CHECK(away < 1e-7, "and returns: %.1e", away);
    away = 0;
    for (int k = 0; k < points * 9; k++)
        away = tap_worse(away, fabs(track.u[k] - swum.u[k]));
    CHECK(away < 1e-5, "joint efforts on the way: %.1e", away);
    CHECK_NEAR(track.energy[points / 2], swum.energy[points / 2], 1e-7, "joint work half way");
    CHECK_NEAR(track.energy[points - 1], energy, 1e-7, "joint work");
    CHECK_NEAR(track.pose[points - 1].p_x, swum.pose[points - 1].p_x, 1e-8, "position");
    moray_swim_track_free(&track);
    moray_swim_track_free(&swum);
    moray_swimmer_free(swimmer);
    moray_orbit_free(orbit);
}

// The numbers of an independent implementation; other schemes and meshes give them too.
static void test_schemes(void)
{
    const struct {
        const char *scheme;
        int intervals;
        double within;
    } meshes[] = {{"lobatto5", 24, 1e-9}, {"radau4", 16, 5e-9}, {"gauss3", 24, 1e-9}, {"hermite-simpson", 120, 1e-9}};
    const moray_robot robot = robot_of(10);
    const moray_gait gait = gait_of(&robot, MORAY_FIRST_PRINCIPLES, 20, 120, 40);
    moray_orbit_spec spec = moray_orbit_spec_default(&robot, MORAY_FIRST_PRINCIPLES);
    moray_orbit_result base, other;
    moray_orbit *orbit;
    CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
    CHECK_OK(moray_orbit_solve(orbit, &gait, &base), "found");
    moray_orbit_free(orbit);
    CHECK_NEAR(base.steady.speed, 0.2293, 5e-5, "speed of the paper's gait");
    CHECK_NEAR(base.steady.power, 0.2646, 5e-5, "its power");
    CHECK_NEAR(base.steady.peak_effort, 0.403, 5e-4, "its peak torque");
    for (int k = 0; k < 4; k++) {
        spec.scheme = meshes[k].scheme;
        spec.intervals = meshes[k].intervals;
        CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
        CHECK_OK(moray_orbit_solve(orbit, &gait, &other), spec.scheme);
        CHECK_NEAR(other.steady.speed, base.steady.speed, meshes[k].within, "speed");
        CHECK_NEAR(other.steady.power, base.steady.power, meshes[k].within, "power");
        moray_orbit_free(orbit);
    }
}

// Where a search begins does not change where it ends.
static void test_starts(void)
{
    const moray_robot robot = robot_of(10);
    moray_orbit_spec spec = moray_orbit_spec_default(&robot, MORAY_FIRST_PRINCIPLES);
    moray_orbit *fresh, *used;
    moray_orbit_result one, other;
    unsigned long long seed = 11;
    double worst = 0;
    int failed = 0;
    spec.current[1] = 0.03;
    CHECK_OK(moray_orbit_new(&used, &spec), "orbit");
    for (int k = 0; k < 40; k++) {
        const moray_gait gait = gait_of(&robot, spec.model, tap_random(&seed, 10, 60), tap_random(&seed, 60, 360),
                                        tap_random(&seed, 20, 90));
        CHECK_OK(moray_orbit_new(&fresh, &spec), "orbit");
        const moray_status from_glide = moray_orbit_solve(fresh, &gait, &one);
        const moray_status from_last = moray_orbit_solve(used, &gait, &other);
        failed += moray_failed(from_glide) != moray_failed(from_last);
        if (!moray_failed(from_glide) && !moray_failed(from_last))
            worst =
                fmax(worst, fabs(one.steady.speed - other.steady.speed) + fabs(one.gait.offset - other.gait.offset));
        moray_orbit_free(fresh);
    }
    CHECK(failed == 0 && worst < 1e-11, "from a glide and from another gait's orbit: %.1e", worst);
    moray_orbit_free(used);
}

// Where the defects are down to rounding the slopes of an earlier point tell nothing more, as here.
static void test_rounding(void)
{
    enum { gaits = 100 };
    const moray_robot robot = robot_of(10);
    moray_orbit_spec spec = moray_orbit_spec_default(&robot, MORAY_CONTROL_ORIENTED);
    int failed = 0;
    spec.steered = false;
    for (int k = 0; k < gaits; k++) {
        const moray_gait gait = {.amplitude = 0.045680313869238411,
                                 .omega = 1.8104619281263352 * (1 + k * 1e-15),
                                 .delta = 0.60896561614929201};
        moray_orbit_result found;
        moray_orbit *orbit;
        failed += moray_failed(moray_orbit_new(&orbit, &spec)) || moray_failed(moray_orbit_solve(orbit, &gait, &found));
        moray_orbit_free(orbit);
    }
    CHECK(failed == 0, "%d of %d gaits have no orbit", failed, gaits);
}

static void refuses(moray_orbit_spec spec, const char *text)
{
    moray_orbit *orbit;
    const moray_status status = moray_orbit_new(&orbit, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, text) && !orbit, "refused: %s", status.text);
}

static void refuses_gait(moray_orbit *orbit, moray_gait gait, moray_code code, const char *text)
{
    moray_orbit_result found;
    moray_orbit_gradient gradient;
    moray_swim_track track;
    const moray_status status = moray_orbit_solve(orbit, &gait, &found);
    CHECK(status.code == code && strstr(status.text, text), "refused: %s", status.text);
    CHECK(moray_orbit_gradients(orbit, &gradient).code == MORAY_INPUT, "and no derivatives");
    CHECK(moray_orbit_track(orbit, 9, &track).code == MORAY_INPUT && !track.t, "nor a track");
}

static void test_refusals(void)
{
    const moray_robot robot = robot_of(10);
    const moray_orbit_spec good = moray_orbit_spec_default(&robot, MORAY_FIRST_PRINCIPLES);
    moray_orbit_spec spec = good;
    moray_floquet floquet;
    moray_orbit *orbit;
    spec.intervals = 0;
    refuses(spec, "intervals = 0");
    spec = good, spec.scheme = "euler";
    refuses(spec, "scheme = euler");
    spec = good, spec.current[1] = NAN;
    refuses(spec, "current = 0,nan");
    spec = good, spec.robot.links = 1;
    refuses(spec, "links = 1");
    spec = good, spec.current[1] = 0.5;
    CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
    CHECK(moray_orbit_floquet(orbit, &floquet).code == MORAY_INPUT, "no orbit yet, no multipliers");
    moray_gait gait = gait_of(&robot, good.model, 20, 120, 40);
    refuses_gait(orbit, gait, MORAY_NOT_SOLVED, "in a current of (0, 0.5) m/s");
    gait.taper = NAN;
    refuses_gait(orbit, gait, MORAY_INPUT, "taper = nan");
    const moray_series series = {9, 1, (const double[27]){0}};
    gait = (moray_gait){.amplitude = 0.1, .omega = 1, .series = &series};
    refuses_gait(orbit, gait, MORAY_INPUT, "a series of 1 harmonics in 9 joints: an orbit takes");
    gait = (moray_gait){.amplitude = 0.1, .omega = -1};
    refuses_gait(orbit, gait, MORAY_INPUT, "omega = -1");
    gait = (moray_gait){.amplitude = INFINITY, .omega = 1};
    refuses_gait(orbit, gait, MORAY_INPUT, "amplitude = inf");
    moray_orbit_free(orbit);
    moray_orbit_free(NULL);
}

int main(void)
{
    for (int model = 0; model < 2; model++) {
        for (unsigned k = 0; k < sizeof closed_loops / sizeof *closed_loops; k++)
            test_against_simulation(&closed_loops[k], models[model]);
        test_return(models[model]);
    }
    test_schemes();
    test_starts();
    test_rounding();
    test_refusals();
    return tap_done();
}
