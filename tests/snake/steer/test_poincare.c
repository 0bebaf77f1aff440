// SPDX-License-Identifier: MIT
//
// Multipliers of the stroboscopic map against how fast a simulated deviation dies away, with all joints simulated.
#include "degree.h"
#include "tap.h"

#include <complex.h>

#include "moray/snake/closed_loop.h"
#include "moray/snake/poincare.h"
#include "moray/snake/trial.h"

static double ahead(const moray_swim_sample *sample, void *self)
{
    (void)sample, (void)self;
    return 0;
}

// Ratio of the heading's deviation from one period to the next, long after a start at 3 deg.
static double simulated(const moray_robot *robot, const moray_straight_motion *straight, double gain, int looks)
{
    const double period = 2 * M_PI / straight->gait.omega, far = 1e3;
    const int from = 4, to = 8;
    moray_pose pose[2][10];
    for (int run = 0; run < 2; run++) {
        moray_feedback feedback = {.target = ahead,
                                   .gain = gain,
                                   .straight = straight,
                                   .offset = far,
                                   .offset_rate = far,
                                   .period = period / looks};
        const moray_swim_controller controller = moray_feedback_controller(&feedback);
        const moray_swim_closed_loop_spec spec = {.robot = robot,
                                                  .straight = straight,
                                                  .heading = run * 3 * DEG,
                                                  .controller = &controller,
                                                  .duration = to * period,
                                                  .intervals = to,
                                                  .tolerance = 1e-10};
        moray_swim_closed_loop closed_loop;
        CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &spec), "simulated");
        for (int k = 0; k <= to; k++)
            pose[run][k] = closed_loop.track.pose[k];
        moray_swim_closed_loop_free(&closed_loop);
    }
    return pow((pose[1][to].heading - pose[0][to].heading) / (pose[1][from].heading - pose[0][from].heading),
               1.0 / (to - from));
}

static void test_model(moray_model model)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, model);
    const double sign = model == MORAY_CONTROL_ORIENTED ? 1 : -1, gain = sign * 0.35 * gait.amplitude; // erratum E3
    moray_straight_motion straight;
    moray_num open[MORAY_POINCARE_STATES], steered[MORAY_POINCARE_STATES], line[MORAY_POINCARE_STATES];
    CHECK_OK(moray_straight_motion_find(&straight, &robot, model, &gait), "straight");
    moray_poincare_spec spec = {.robot = &robot, .straight = &straight, .looks = 30};
    CHECK_OK(moray_poincare_multipliers(&spec, open), "nobody steers");
    CHECK(cabs(open[0] - 1) < 1e-4 && cabs(open[1] - 1) < 1e-4 && cabs(open[2]) < 0.9,
          "heading and place are neutral: %.5f, %.5f, then %.3f", cabs(open[0]), cabs(open[1]), cabs(open[2]));
    spec.gain = gain;
    CHECK_OK(moray_poincare_multipliers(&spec, steered), "feedback of the heading");
    CHECK(cabs(steered[0] - 1) < 1e-4 && cabs(steered[1]) < 0.99, "only the place is neutral");
    CHECK_NEAR(creal(steered[1]), simulated(&robot, &straight, gain, spec.looks), 5e-3, "as a deviation dies away");
    spec.lookahead = 3;
    CHECK_OK(moray_poincare_multipliers(&spec, line), "line of sight");
    CHECK(cabs(line[0]) < 0.995, "brings the place back too: %.4f", cabs(line[0]));
    spec.looks = 8;
    CHECK_OK(moray_poincare_multipliers(&spec, line), "as few looks as there may be");
    spec.lookahead = -1;
    CHECK(moray_poincare_multipliers(&spec, line).code == MORAY_INPUT, "no lookahead behind");
    spec.lookahead = 0;
    spec.gain = -gain;
    const moray_status status = moray_poincare_multipliers(&spec, line);
    if (model == MORAY_CONTROL_ORIENTED) // whose straight swimming the gain does not see
        CHECK(!moray_failed(status) && cabs(line[0]) > 1.01, "a gain that turns away: %.3f", cabs(line[0]));
    else
        CHECK(status.code == MORAY_NOT_SOLVED, "a gain that turns away never comes back: %s", status.text);
    spec.looks = 4;
    CHECK(moray_poincare_multipliers(&spec, line).code == MORAY_INPUT, "too few looks are refused");
}

int main(void)
{
    test_model(MORAY_CONTROL_ORIENTED);
    test_model(MORAY_FIRST_PRINCIPLES);
    return tap_done();
}
