// SPDX-License-Identifier: MIT
//
// Headings, paths and turns are swum by the plant that is asked for: robot, model, current; each problem's own rows
// come behind.
#include "degree.h"
#include "reference_text.h"
#include "tap.h"

#include "moray/snake/trial.h"
#include "ocp/problem.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES, parameters = MORAY_STEERING_PARAMETERS, HEADING = 0, PATH, TURN, problems };
enum { plant_inputs = states + 1 + parameters + 1, MOST = 40 };

static const double current[2] = {0.05, -0.08};

static moray_steering_limits limits_of(void)
{
    return (moray_steering_limits){.theta_max = moray_between(1 * DEG, 40 * DEG),
                                   .omega = moray_between(1, 3),
                                   .delta = moray_between(10 * DEG, 80 * DEG),
                                   .offset = 0.05,
                                   .offset_rate = 0.04,
                                   .offset_acceleration = MORAY_INFINITY,
                                   .power = MORAY_INFINITY};
}

static moray_steering_problem problem_of(int which, const moray_plant_spec *plant, moray_model model, bool averaged,
                                         const moray_reference *reference, const moray_path *path)
{
    moray_steering_problem problem;
    const moray_heading_spec heading = {.robot = plant->robot,
                                        .model = model,
                                        .averaged = averaged,
                                        .current = {current[0], current[1]},
                                        .limits = limits_of(),
                                        .weight = {3, 0.5, 0.7},
                                        .reference = reference,
                                        .max_error = 2,
                                        .t0 = 1,
                                        .t1 = 5,
                                        .undulation = {0.04, -0.07}};
    const moray_path_spec along = {.robot = plant->robot,
                                   .model = model,
                                   .averaged = averaged,
                                   .current = {current[0], current[1]},
                                   .limits = limits_of(),
                                   .weight = {1, 0.01, 0.01},
                                   .path = path,
                                   .tube = MORAY_INFINITY,
                                   .reach = 2,
                                   .speed = 0.25};
    const moray_turn_spec turn = {.robot = plant->robot,
                                  .model = model,
                                  .averaged = averaged,
                                  .current = {current[0], current[1]},
                                  .limits = limits_of(),
                                  .heading = 1.2,
                                  .steering = 0.7,
                                  .shortest = 1,
                                  .longest = 9,
                                  .undulation = {0.04, -0.07}};
    CHECK_OK(which == HEADING ? moray_heading_new(&problem, &heading)
             : which == PATH  ? moray_path_problem_new(&problem, &along)
                              : moray_turn_new(&problem, &turn),
             "problem");
    return problem;
}

static void test_plant(int which, moray_model model, bool averaged)
{
    moray_reference reference = read_ok("ramps:0=10,10=60");
    moray_path path;
    moray_map plant;
    moray_plant_spec spec = {
        .robot = moray_robot_paper(), .joints = MORAY_JOINTS_STEERED, .current = {current[0], current[1]}};
    spec.robot.links = 5;
    CHECK_OK(moray_path_read(&path, "0,0 4,0", 1), "path");
    CHECK_OK(averaged                          ? moray_average_plant(&plant, &spec)
             : model == MORAY_CONTROL_ORIENTED ? moray_control_plant(&plant, &spec)
                                               : moray_fp_plant(&plant, &spec),
             "plant");
    moray_steering_problem problem = problem_of(which, &spec, model, averaged, &reference, &path);
    const moray_map *map = moray_steering_ocp(problem.steering)->phase[0].map;
    const int more = which == PATH;
    const double in[plant_inputs] = {0.4, 1.5, 0.2, 0.1, 0.2, 0.03, 0.02, -0.01, 0.005, 0.3, 2, 0.7, 3};
    double all[plant_inputs + 1], out[MOST], want[MOST], worst = 0;
    for (int k = 0; k < plant_inputs; k++)
        all[k <= states ? k : k + more] = in[k];
    all[states + 1] = more ? 1.4 : all[states + 1];
    if (CHECK(map->n_in == plant_inputs + more && map->n_out <= MOST, "%d numbers in, %d out", map->n_in, map->n_out)) {
        map->value(map->self, all, out);
        plant.value(plant.self, in, want);
        for (int r = 0; r < states; r++)
            worst = tap_worse(worst, fabs(out[r] - want[r]));
        CHECK_NEAR(worst, 0, 1e-12, "rates of the states");
        CHECK_NEAR(out[map->n_out - 1], want[plant.n_out - 1], 1e-12, "power last");
        const double effort = 0.005 * 0.005 / (0.05 * 0.05), swing = 0.04 * cos(6) - 0.07 * sin(6);
        const double error = 0.4 - swing - 25 * DEG;
        if (which == HEADING) {
            CHECK_NEAR(out[states], error, 1e-12, "heading off its reference");
            CHECK_NEAR(out[states + 1], 3 * error * error + 0.7 * effort, 1e-12, "weighted");
        } else if (which == TURN)
            CHECK_NEAR(out[states], effort, 1e-12, "effort of the steering");
    }
    moray_steering_problem_free(&problem);
    moray_map_release(&plant);
    moray_path_free(&path);
    moray_reference_free(&reference);
}

// A turn ends with the mean heading that is asked for, not turning; a heading's objective is a mean over its time.
static void test_ends(void)
{
    enum { q = 2 * states + 2, s = q + 2, inputs = s + parameters };
    moray_reference reference = read_ok("ramps:0=10,10=60");
    moray_plant_spec spec = {.robot = moray_robot_paper()};
    double in[inputs] = {[states] = 1, [q - 1] = 5, [q] = 6, [q + 1] = 10}, out[8];
    in[s + MORAY_STEERING_AMPLITUDE] = 0.05;
    in[s + MORAY_STEERING_OMEGA] = 2;
    in[s + MORAY_STEERING_DELTA] = 0.7;
    in[states + 1 + MORAY_STATE_THETA] = 1.1;
    in[states + 1 + MORAY_STATE_V_THETA] = 0.3;
    for (int which = HEADING; which <= TURN; which += TURN) {
        moray_steering_problem problem = problem_of(which, &spec, MORAY_CONTROL_ORIENTED, false, &reference, NULL);
        const moray_ocp *ocp = moray_steering_ocp(problem.steering);
        const moray_map *map = ocp->endpoint->map;
        if (CHECK(map->n_in == inputs && map->n_out <= 8, "%d numbers in, %d out", map->n_in, map->n_out)) {
            map->value(map->self, in, out);
            const double mean = 6 / 4.0 + 0.5 * 10 / 4.0, time = 4 + 0.7 * 6;
            CHECK_NEAR(out[0], which == HEADING ? mean : time, 1e-12, "objective");
            if (which == TURN) {
                CHECK_NEAR(out[3], 1.1 - 0.04 * cos(10) + 0.07 * sin(10), 1e-12, "mean heading");
                CHECK_NEAR(out[4], 0.3 - 2 * (-0.07 * cos(10) - 0.04 * sin(10)), 1e-12, "its rate");
                CHECK(ocp->e[2].lower == 1.2 && ocp->e[2].upper == 1.2, "is asked for");
                CHECK(ocp->e[3].lower == 0 && ocp->e[3].upper == 0, "without turning");
            }
        }
        moray_steering_problem_free(&problem);
    }
    moray_reference_free(&reference);
}

int main(void)
{
    for (int which = 0; which < problems; which++) {
        test_plant(which, MORAY_CONTROL_ORIENTED, false);
        test_plant(which, MORAY_CONTROL_ORIENTED, true);
        test_plant(which, MORAY_FIRST_PRINCIPLES, false);
    }
    test_ends();
    return tap_done();
}
