// SPDX-License-Identifier: MIT
//
// Gains in a current: by the orbit where the simulation from rest came to it, else simulated; and what holds no course.
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "snake/swim/orbit.h"

static const moray_model model = MORAY_FIRST_PRINCIPLES;

static moray_gait gait_of(double theta_max, double delta)
{
    const moray_robot robot = moray_robot_paper();
    return (moray_gait){
        .amplitude = moray_amplitude_from_theta_max(&robot, model, theta_max, delta), .omega = 1.8, .delta = delta};
}

static moray_test_rig rig_of(double v_x, double v_y, double course)
{
    const moray_robot robot = moray_robot_paper();
    moray_test_rig rig;
    CHECK_OK(moray_test_rig_new(&rig, &robot, (double[]){v_x, v_y}, course), "rig");
    return rig;
}

// Both gains, on the one orbit.
static void on_orbit(const moray_test_rig *rig, const moray_gait *gait, const moray_steady *base, double percent[2])
{
    moray_orbit_spec spec = moray_orbit_spec_default(moray_swimmer_robot(rig->swimmer[model]), model);
    moray_orbit *orbit;
    moray_orbit_result found;
    moray_steady steady;
    memcpy(spec.current, rig->current, sizeof spec.current);
    spec.course = rig->course;
    CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
    CHECK_OK(moray_orbit_find(orbit, gait, &found), "found");
    moray_gait matched = *gait;
    CHECK_OK(moray_orbit_match(orbit, &matched, true, base->power, &steady), "power");
    percent[0] = 100 * (steady.speed / base->speed - 1);
    matched = *gait;
    CHECK_OK(moray_orbit_match(orbit, &matched, false, base->speed, &steady), "speed");
    percent[1] = 100 * (steady.power / base->power - 1);
    moray_orbit_free(orbit);
}

static void simulated(const moray_test_rig *rig, const moray_gait *gait, const moray_steady *base, double percent[2])
{
    const moray_swim_setup setup = moray_test_rig_setup(rig, model);
    moray_gait matched = *gait;
    moray_steady steady;
    CHECK_OK(moray_swim_match_power(&setup, &matched, rig->course, base->power, &steady), "power");
    percent[0] = 100 * (steady.speed / base->speed - 1);
    matched = *gait;
    CHECK_OK(moray_swim_match_speed(&setup, &matched, rig->course, base->speed, &steady), "speed");
    percent[1] = 100 * (steady.power / base->power - 1);
}

static void check_gain(const moray_test_rig *rig, const moray_gait_trial *trial, const moray_gait_trial *baseline,
                       const double percent[2], const char *what)
{
    const moray_gait_gain gain = moray_gait_gain_over(rig, trial, baseline);
    CHECK_NEAR(gain.speed_percent_at_equal_power, percent[0], 1e-8, what);
    CHECK_NEAR(gain.power_percent_at_equal_speed, percent[1], 1e-8, what);
}

// The digits beyond those that are matched tell the one from the other.
static void test_proof(void)
{
    moray_test_rig rig = rig_of(0.04, -0.03, 0.3);
    moray_gait_trial trial = {.gait = {[MORAY_FIRST_PRINCIPLES] = gait_of(0.3, 0.8)}}, baseline = {0};
    moray_steady *swum = &trial.steady[model];
    double orbit[2], from_rest[2];
    CHECK_OK(moray_gait_trial_swim(&rig, model, &trial), "swum");
    CHECK(trial.held[model], "on course");
    baseline.steady[model] = (moray_steady){.power = 1.3 * swum->power, .speed = 0.9 * swum->speed};
    on_orbit(&rig, &trial.gait[model], &baseline.steady[model], orbit);
    simulated(&rig, &trial.gait[model], &baseline.steady[model], from_rest);
    CHECK(fabs(orbit[0] - from_rest[0]) > 1e-7 && fabs(orbit[1] - from_rest[1]) > 1e-7, "they differ by %g and %g %%",
          orbit[0] - from_rest[0], orbit[1] - from_rest[1]);
    check_gain(&rig, &trial, &baseline, orbit, "by the orbit that was swum");
    double *const told[] = {&swum->speed, &swum->power};
    for (int k = 0; k < 2; k++) {
        const double kept = *told[k];
        *told[k] *= 1 + 1e-4;
        check_gain(&rig, &trial, &baseline, from_rest, k ? "not with another power" : "not with another speed");
        *told[k] = kept;
    }
    moray_test_rig_free(&rig);
}

// Three links in a current along the course: slowly swum they stay on their orbit, faster they leave it. With too few
// periods to settle in, nothing but orbits gives a gain.
static void test_stability(void)
{
    const double omega[2] = {0.39, 1.5};
    moray_robot robot = moray_robot_paper();
    robot.links = 3;
    moray_test_rig rig;
    moray_gait_trial trial[2] = {{.held = {false}}};
    moray_orbit_spec spec = moray_orbit_spec_default(&robot, model);
    moray_orbit *orbit;
    CHECK_OK(moray_test_rig_new(&rig, &robot, (double[]){0.222364, -0.005}, 0), "rig");
    rig.settings.max_periods = 3;
    memcpy(spec.current, rig.current, sizeof spec.current);
    CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
    for (int k = 0; k < 2; k++) {
        moray_orbit_result found;
        trial[k].gait[model] = (moray_gait){.amplitude = 0.81, .omega = omega[k], .delta = 0.6, .taper = -0.4};
        CHECK_OK(moray_orbit_find(orbit, &trial[k].gait[model], &found), "found");
        CHECK(moray_failed(moray_orbit_stays(orbit)) == (k == 1), "at %g rad/s %s", omega[k], k ? "left" : "kept");
        trial[k].steady[model] = found.steady;
    }
    for (int k = 0; k < 4; k++) {
        const moray_gait_gain gain = moray_gait_gain_over(&rig, &trial[k / 2], &trial[k % 2]);
        const bool none = isnan(gain.speed_percent_at_equal_power) && isnan(gain.power_percent_at_equal_speed);
        CHECK(none == (k > 0), "from %g to %g rad/s: gain %g %%: %s", omega[k / 2], omega[k % 2],
              gain.speed_percent_at_equal_power, gain.why_no_speed.text);
    }
    moray_orbit_free(orbit);
    moray_test_rig_free(&rig);
}

// Where the current is too strong across the course the gait swims straight, begun along it.
static void test_not_held(void)
{
    moray_test_rig rig = rig_of(0, 0.5, 0.3);
    moray_gait_trial trial = {.gait = {[MORAY_FIRST_PRINCIPLES] = gait_of(0.3, 0.8)}};
    CHECK_OK(moray_gait_trial_swim(&rig, model, &trial), "swum");
    CHECK(!trial.held[model] && trial.why[model].code == MORAY_NOT_SOLVED && trial.steady[model].start_heading == 0.3,
          "no course: %s", trial.why[model].text);
    CHECK(trial.steady[model].speed > 0.1 && trial.steady[model].peak_effort > 0, "but it swims");
    moray_test_rig_free(&rig);
}

// Integrated so coarsely that headings scatter by more than what counts as on course, a course is refused or held.
static void test_scatter(void)
{
    moray_test_rig rig = rig_of(0, 0, 0);
    moray_swim_setup setup = moray_test_rig_setup(&rig, model);
    int refused = 0;
    setup.settings.sim = moray_sim_settings_paper();
    setup.settings.sim.rtol = setup.settings.sim.atol = 1e-3;
    setup.settings.agreement = 0.01;
    for (int k = 0; k < 4; k++) { // and its mirror image
        const double side = k % 2 ? -1 : 1, course = side * (k < 2 ? 0.2 : 0.3);
        moray_gait gait = gait_of(0.3, 0.8);
        moray_steady steady;
        gait.amplitude *= side;
        setup.current[0] = 0.04;
        setup.current[1] = side * 0.06;
        const moray_status status = moray_swim_hold_course(&setup, &gait, course, &steady);
        refused += status.code == MORAY_NOT_SOLVED;
        CHECK(moray_failed(status) || fabs(atan2(steady.v_y, steady.v_x) - course) < 2e-6,
              "held at %.3g rad, off by %.2g: %s", course, atan2(steady.v_y, steady.v_x) - course, status.text);
    }
    CHECK(refused > 0, "%d of 4 refused", refused);
    moray_test_rig_free(&rig);
}

// Velocities through the water return, turned where their axes do not turn with the body.
static void test_closing(moray_model of)
{
    moray_orbit orbit = {.spec = {.model = of, .steered = false, .current = {0.3, -0.2}, .course = 0.4}};
    unsigned long long seed = 4;
    double in[ORBIT_ENDS + 1], out[ORBIT_STATES + 1];
    CHECK_OK(moray_orbit_closing(&orbit), "closing");
    for (int i = 0; i <= ORBIT_ENDS; i++)
        in[i] = tap_random(&seed, -1, 1);
    orbit.closing.value(orbit.closing.self, in, out);
    const double *x0 = in, *xT = in + ORBIT_STATES, turn = in[ORBIT_ENDS];
    const bool control = of == MORAY_CONTROL_ORIENTED;
    double began[2], ended[2];
    for (int end = 0; end < 2; end++) {
        const double *x = end ? xT : x0, angle = control ? x[0] : 0, c = cos(angle), s = sin(angle);
        (end ? ended : began)[0] = x[4] - 0.3 * c + 0.2 * s;
        (end ? ended : began)[1] = x[5] + 0.2 * c + 0.3 * s;
    }
    const double lag = control ? 0 : turn, c = cos(lag), s = sin(lag);
    const double want[] = {x0[1],
                           x0[2],
                           xT[0] - x0[0] - turn,
                           xT[3] - x0[3],
                           ended[0] - c * began[0] + s * began[1],
                           ended[1] - s * began[0] - c * began[1],
                           (xT[2] - x0[2]) * cos(0.4) - (xT[1] - x0[1]) * sin(0.4)};
    for (int i = 0; i <= ORBIT_STATES; i++)
        CHECK_NEAR(out[i], want[i], 1e-14, "condition");
    moray_map_release(&orbit.closing);
}

int main(void)
{
    test_closing(MORAY_CONTROL_ORIENTED);
    test_closing(MORAY_FIRST_PRINCIPLES);
    test_proof();
    test_stability();
    test_not_held();
    test_scatter();
    return tap_done();
}
