// SPDX-License-Identifier: MIT
//
// One gait for several scenarios: certificate, what the optimum makes against the ladder, which shares neither the
// programme nor its derivatives with it, one scenario against the gait problem, refusals.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/gait_over.h"
#include "moray/snake/ladder.h"
#include "moray/snake/orbit.h"
#include "moray/snake/trial.h"

enum { MOST = 3 };
static const double still[2] = {0, 0};

typedef struct {
    moray_robot robot;
    moray_rung rung[MORAY_RUNGS];
    moray_gait baseline;
    int n;
    moray_orbit *orbit[MOST];
    moray_gait_scenario scenario[MOST];
} set;

// Scenarios of rungs, at the baseline's power there.
static void make_set(set *s, const char *const *names, int n, double theta_max, const double current[2])
{
    s->robot = moray_robot_paper();
    s->n = n;
    const moray_gait paper = moray_gait_paper(&s->robot);
    s->baseline = moray_gait_map(&s->robot, &paper, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    moray_ladder(&s->robot, s->rung);
    for (int k = 0; k < n; k++) {
        const moray_robot *robot = &s->rung[moray_rung_named(names[k])].robot;
        moray_orbit_spec spec = moray_orbit_spec_default(robot, MORAY_FIRST_PRINCIPLES);
        memcpy(spec.current, current, sizeof spec.current);
        moray_orbit_result found;
        CHECK_OK(moray_orbit_new(&s->orbit[k], &spec), names[k]);
        CHECK_OK(moray_orbit_solve(s->orbit[k], &s->baseline, &found), "the baseline");
        s->scenario[k] =
            (moray_gait_scenario){.name = names[k],
                                  .problem = {.robot = *robot,
                                              .model = MORAY_FIRST_PRINCIPLES,
                                              .joints = MORAY_JOINTS_ON_GAIT,
                                              .current = {current[0], current[1]},
                                              .limits = {.theta_max = moray_between(1 * DEG, theta_max * DEG),
                                                         .omega = moray_between(30 * DEG, 360 * DEG),
                                                         .delta = moray_between(15 * DEG, 90 * DEG),
                                                         .offset = moray_between(-0.2, 0.2),
                                                         .taper = moray_fixed(0),
                                                         .power = found.steady.power,
                                                         .joint_rate = MORAY_INFINITY,
                                                         .joint_effort = MORAY_INFINITY}},
                                  .speed = found.steady.speed};
    }
}

static void free_set(set *s)
{
    for (int k = 0; k < s->n; k++)
        moray_orbit_free(s->orbit[k]);
}

static moray_solution *solve(set *s, const moray_gait_over *over)
{
    moray_settings settings = moray_settings_default();
    moray_gait gait[MOST];
    moray_swim_track track[MOST];
    moray_solution *solution = NULL;
    settings.scheme = "lobatto5";
    settings.intervals = 12;
    settings.max_refinements = 4;
    settings.barrier = 1e-4;
    for (int k = 0; k < s->n; k++) {
        moray_orbit_result found;
        gait[k] = s->baseline;
        CHECK_OK(moray_orbit_match_power(s->orbit[k], &gait[k], s->scenario[k].problem.limits.power, &found), "start");
        CHECK_OK(moray_orbit_track(s->orbit[k], 51, &track[k]), "its orbit");
    }
    CHECK_OK(moray_gait_over_solve(over, &settings, gait, track, &solution), "solving");
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "solved");
    for (int k = 0; k < s->n; k++)
        moray_swim_track_free(&track[k]);
    return solution;
}

// The gains that the ladder finds for the gait are the predicted ones; returns the mean.
static double check_on_ladder(const set *s, const moray_gait_over *over, const moray_solution *solution, double *worst)
{
    const moray_gait gait = moray_gait_over_prediction(over, solution, 0).gait;
    const moray_ladder_spec spec = {.robot = s->robot,
                                    .baseline = s->baseline,
                                    .gait = &gait,
                                    .gaits = 1,
                                    .settings = moray_swim_settings_default()};
    moray_ladder_row row[MORAY_RUNGS];
    double mean = 0;
    CHECK_OK(moray_ladder_climb(&spec, row), "the ladder");
    *worst = INFINITY;
    for (int k = 0; k < s->n; k++) {
        const moray_gait_prediction predicted = moray_gait_over_prediction(over, solution, k);
        const moray_ladder_row *rung = &row[moray_rung_named(s->scenario[k].name)];
        const double gain = 100 * (predicted.speed / s->scenario[k].speed - 1);
        CHECK_NEAR(gain, rung->gain_percent, 1e-4, s->scenario[k].name);
        CHECK_NEAR(predicted.gait.omega, rung->omega, 1e-5, "its omega");
        CHECK_NEAR(predicted.power, rung->power, 1e-7, "its power");
        *worst = fmin(*worst, rung->gain_percent);
        mean += rung->gain_percent / s->n;
    }
    return mean;
}

static void check_certificate(const moray_solution *solution)
{
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&settings);
    moray_certificate certificate;
    CHECK_OK(moray_certify(solution, &integrator, &certificate), "certificate");
    CHECK(certificate.pass && certificate.derivatives < 1e-7, "passes, with derivatives right to %.1e",
          certificate.derivatives);
}

static void check_over(const char *const *names, int n)
{
    moray_gait_over *over[2] = {NULL};
    moray_solution *solution[2];
    double worst[2], mean[2];
    set s;
    make_set(&s, names, n, 20, still);
    for (int goal = MORAY_OVER_WORST; goal <= (int)MORAY_OVER_MEAN; goal++) {
        CHECK_OK(moray_gait_over_new(&over[goal], s.scenario, n, (moray_over_goal)goal), "the programme");
        solution[goal] = solve(&s, over[goal]);
        check_certificate(solution[goal]);
        mean[goal] = check_on_ladder(&s, over[goal], solution[goal], &worst[goal]);
        CHECK_NEAR(100 * moray_gait_over_gain(solution[goal]), goal == MORAY_OVER_WORST ? worst[goal] : mean[goal],
                   1e-4, "what was maximised");
    }
    CHECK(worst[0] >= worst[1] - 1e-4, "the best worst gain %.4f is none worse than that of the best mean, %.4f",
          worst[0], worst[1]);
    CHECK(mean[1] >= mean[0] - 1e-4, "nor the best mean %.4f than that of the best worst, %.4f", mean[1], mean[0]);
    for (int goal = 0; goal < 2; goal++) {
        moray_solution_free(solution[goal]);
        moray_gait_over_free(over[goal]);
    }
    free_set(&s);
}

// One scenario is the optimal-gait problem.
static void check_one(void)
{
    moray_gait_over *over;
    set s;
    make_set(&s, (const char *const[]){"paper"}, 1, 20, still);
    CHECK_OK(moray_gait_over_new(&over, s.scenario, 1, MORAY_OVER_WORST), "the programme");
    moray_solution *solution = solve(&s, over);
    CHECK_NEAR(100 * moray_gait_over_gain(solution), 4.029, 5e-3, "over the paper's model alone");
    CHECK_NEAR(moray_gait_over_prediction(over, solution, 0).gait.delta / DEG, 51.33, 0.01,
               "with the delta of max_speed");
    moray_solution_free(solution);
    moray_gait_over_free(over);
    free_set(&s);
}

// In a current what is gained is speed through the water: as the orbit of the gait found has it.
static void check_current(void)
{
    const double current[2] = {0.03, -0.08};
    moray_gait_over *over;
    moray_orbit_result found;
    set s;
    make_set(&s, (const char *const[]){"paper"}, 1, 20, current);
    CHECK_OK(moray_gait_over_new(&over, s.scenario, 1, MORAY_OVER_WORST), "the programme in a current");
    moray_solution *solution = solve(&s, over);
    const moray_gait gait = moray_gait_over_prediction(over, solution, 0).gait;
    CHECK_OK(moray_orbit_solve(s.orbit[0], &gait, &found), "orbit of the gait found");
    CHECK_NEAR(100 * moray_gait_over_gain(solution), 100 * (found.steady.speed / s.scenario[0].speed - 1), 1e-4,
               "gain in speed through the water [%]");
    CHECK_NEAR(found.steady.power, s.scenario[0].problem.limits.power, 1e-7, "at the baseline's power");
    moray_solution_free(solution);
    moray_gait_over_free(over);
    free_set(&s);
}

static void check_refusals(void)
{
    moray_gait_over *over;
    set s;
    make_set(&s, (const char *const[]){"paper", "strip"}, 2, 20, still);
    CHECK(moray_gait_over_new(&over, s.scenario, 0, MORAY_OVER_WORST).code == MORAY_INPUT && !over, "no scenario");
    s.scenario[1].speed = 0;
    CHECK(moray_gait_over_new(&over, s.scenario, 2, MORAY_OVER_WORST).code == MORAY_INPUT && !over, "no speed");
    s.scenario[1].speed = 0.2;
    s.scenario[1].problem.model = MORAY_CONTROL_ORIENTED;
    CHECK(moray_gait_over_new(&over, s.scenario, 2, MORAY_OVER_WORST).code == MORAY_INPUT && !over, "two models");
    free_set(&s);
}

int main(void)
{
    check_over((const char *const[]){"paper", "strip", "consistent"}, 3);
    check_one();
    check_current();
    check_refusals();
    return tap_done();
}
