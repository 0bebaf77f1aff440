// SPDX-License-Identifier: MIT
//
// The optimal-gait problem with its joints on a Fourier series: its ends, its limits, and its optimum
// against gaits and against simulated neighbours.
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "gait_ends.h"
#include "moray/snake/trial.h"

enum { LINKS = 5, JOINTS = LINKS - 1, HARMONICS = 2, COEFFICIENTS = JOINTS * (1 + 2 * HARMONICS) };

static unsigned long long seed = 23;

// in: [x0, t0, xf, tf, q, s]; a series has omega first and no amplitude.
static void test_endpoint(moray_gait_goal goal)
{
    enum { parameters = 7, inputs = 15 + parameters };
    struct gait_endpoint ends = {
        .nx = 6, .position = 1, .course = {0.6, 0.8}, .series = parameters, .goal = goal, .power = true, .speed = true};
    double in[inputs], out[1 + 4 + 4];
    CHECK(moray_gait_events(&ends) == 8, "%d events", moray_gait_events(&ends));
    for (int i = 0; i < inputs; i++)
        in[i] = tap_random(&seed, 0.3, 1.5);
    in[8] += 2;
    gait_ends(&ends, in, parameters, out);
    const double along = 0.6 * (in[8] - in[1]) + 0.8 * (in[9] - in[2]);
    CHECK_NEAR(out[0], goal == MORAY_GAIT_FASTEST ? -along / in[13] : in[14] / along, 1e-14, "the goal");
    CHECK_NEAR(out[6], in[15] * in[13], 1e-14, "omega T");
    CHECK_NEAR(out[7], in[14] / in[13], 1e-14, "mean power");
    CHECK_NEAR(out[8], along / in[13], 1e-14, "speed along the course");
    CHECK(moray_gait_power_event(&ends) == 6, "the power is event %d", moray_gait_power_event(&ends));
}

// ---- Optima --------------------------------------------------------------------------------------------------------

static moray_gait_problem_spec spec_of(moray_model model)
{
    moray_gait_problem_spec spec = {.robot = moray_robot_paper(),
                                    .model = model,
                                    .harmonics = HARMONICS,
                                    .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                               .omega = moray_between(30 * DEG, 360 * DEG),
                                               .delta = moray_between(15 * DEG, 90 * DEG),
                                               .offset = moray_between(-0.02, 0.02),
                                               .power = model == MORAY_CONTROL_ORIENTED ? 0.1 : 0.07,
                                               .joint_rate = MORAY_INFINITY,
                                               .joint_effort = MORAY_INFINITY,
                                               .link_angles = true}};
    spec.robot.links = LINKS;
    return spec;
}

struct optimum {
    moray_gait_problem *problem;
    moray_solution *solution;
    moray_gait_prediction prediction;
    moray_certificate certificate;
    double at[COEFFICIENTS];
    moray_series series;
    moray_steady swum;
};

static moray_settings settings_of(void)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "lobatto5", settings.intervals = 36, settings.barrier = 1e-4, settings.tolerance = 1e-9;
    return settings;
}

// Certified, and swum from rest.
static void finish(const moray_gait_problem_spec *spec, moray_test_rig *rig, struct optimum *o)
{
    const moray_nlp_outcome end = moray_solution_info(o->solution)->outcome;
    CHECK(end == MORAY_NLP_SOLVED, "%s", moray_nlp_outcome_text(end));
    const moray_integrator integrator = moray_sim_integrator(&rig->settings.sim);
    CHECK_OK(moray_certify(o->solution, &integrator, &o->certificate), "certificate");
    CHECK(o->certificate.kkt < 1e-6 && o->certificate.mesh_error < 1e-6 && o->certificate.resimulation < 1e-6,
          "KKT %.1e, mesh error %.1e, re-simulation %.1e", o->certificate.kkt, o->certificate.mesh_error,
          o->certificate.resimulation);
    o->prediction = moray_gait_problem_prediction(o->problem, o->solution);
    moray_gait gait = o->prediction.gait;
    if (spec->joints == MORAY_JOINTS_SERIES) {
        memcpy(o->at, moray_solution_parameters(o->solution) + 1, sizeof o->at);
        o->series = (moray_series){JOINTS, HARMONICS, o->at};
        gait.series = &o->series;
    }
    const moray_swim_setup setup = moray_test_rig_setup(rig, spec->model);
    CHECK_OK(moray_swim_steady(&setup, &gait, 0, &o->swum, NULL, 0), "swum");
    CHECK_NEAR(o->swum.speed, o->prediction.speed, 1e-5, "swum as fast as predicted");
    CHECK_NEAR(o->swum.power, o->prediction.power, 1e-5, "with the power predicted");
}

static void solve_gait(const moray_gait_problem_spec *spec, moray_test_rig *rig, struct optimum *o)
{
    const moray_gait start = {.amplitude = 0.04, .omega = 120 * DEG, .delta = 60 * DEG};
    const moray_gait gait = moray_gait_map(&spec->robot, &start, MORAY_CONTROL_ORIENTED, spec->model);
    const moray_swim_setup setup = moray_test_rig_setup(rig, spec->model);
    const moray_settings settings = settings_of();
    moray_swim_track orbit;
    CHECK_OK(moray_swim_steady(&setup, &gait, 0, &o->swum, &orbit, 101), "a start");
    CHECK_OK(moray_gait_problem_new(&o->problem, spec), "problem of the gait");
    CHECK_OK(moray_gait_problem_solve(o->problem, &settings, &gait, &orbit, &o->solution), "gait solved");
    moray_swim_track_free(&orbit);
    finish(spec, rig, o);
}

static void solve_series(const moray_gait_problem_spec *spec, moray_test_rig *rig, const struct optimum *from,
                         struct optimum *o)
{
    double s[1 + COEFFICIENTS];
    const moray_settings settings = settings_of();
    s[0] = from->prediction.gait.omega;
    moray_series_of_gait(&from->prediction.gait, JOINTS, HARMONICS, s + 1);
    CHECK_OK(moray_gait_problem_new(&o->problem, spec), "problem of the series");
    CHECK_OK(moray_gait_problem_continue(o->problem, &settings, from->solution, s, &o->solution), "series solved");
    finish(spec, rig, o);
    CHECK(o->at[2 * JOINTS] == 0, "time starts with the first joint's first harmonic");
}

static void release(struct optimum *o)
{
    moray_solution_free(o->solution);
    moray_gait_problem_free(o->problem);
}

static void test_derivatives(const moray_gait_problem *problem)
{
    moray_ocp_derivative_report report;
    CHECK_OK(moray_ocp_check_derivatives(moray_gait_problem_ocp(problem), &report), "derivatives");
    CHECK(report.jacobian_error < 1e-8 && report.hessian_error < 1e-6, "%s; %s", report.jacobian, report.hessian);
}

// Neighbours of an optimum, at its power and by simulation, are slower.
static void test_neighbours(const moray_gait_problem_spec *spec, const moray_test_rig *rig, const struct optimum *o)
{
    const moray_swim_setup setup = moray_test_rig_setup(rig, spec->model);
    double beside[COEFFICIENTS];
    moray_steady steady;
    for (int k = 0; k < 4; k++) {
        const moray_series series = {JOINTS, HARMONICS, beside};
        moray_gait gait = {.omega = o->prediction.gait.omega, .series = &series};
        memcpy(beside, o->at, sizeof beside);
        for (int i = JOINTS; i < 3 * JOINTS; i++) // the offset and even harmonics would turn it
            beside[i] += tap_random(&seed, -1, 1) * 0.05 * fabs(o->at[JOINTS]);
        CHECK_OK(moray_swim_match_power(&setup, &gait, 0, o->swum.power, &steady), "at the same power");
        CHECK(steady.speed < o->swum.speed, "a motion beside it is %.3f %% slower",
              100 * (1 - steady.speed / o->swum.speed));
    }
}

// What knows only the gait (25) says so.
static void test_series_refused(const struct optimum *gait, const struct optimum *series, const moray_test_rig *rig)
{
    const moray_settings settings = moray_settings_default();
    moray_gait more = gait->prediction.gait;
    moray_gait_trial trial;
    moray_solution *solution = NULL;
    moray_swim_track track = {0};
    moray_status status = moray_gait_problem_solve(series->problem, &settings, &more, &track, &solution);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "does not start from a gait"), "%s", status.text);
    more.series = &series->series;
    status = moray_gait_problem_solve(gait->problem, &settings, &more, &track, &solution);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "the start of an optimisation takes"), "%s", status.text);
    status = moray_gait_trial_run(rig, &more, MORAY_FIRST_PRINCIPLES, &trial);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "a trial on both models takes"), "%s", status.text);
}

static void test_optima(moray_model model)
{
    moray_gait_problem_spec spec = spec_of(model);
    moray_test_rig rig;
    struct optimum gait, series, wide;
    CHECK_OK(moray_test_rig_new(&rig, &spec.robot, spec.current, 0), "rig");
    solve_gait(&spec, &rig, &gait);
    CHECK_NEAR(gait.swum.peak_link_angle / DEG, 20, 0.02, "the links of the gait reach their limit, as simulated");
    spec.joints = MORAY_JOINTS_SERIES;
    solve_series(&spec, &rig, &gait, &series);
    CHECK_NEAR(series.swum.peak_link_angle / DEG, 20, 0.02, "and so do those of the series");
    CHECK(series.prediction.speed > 1.002 * gait.prediction.speed, "which gains: %.5f after %.5f m/s",
          series.prediction.speed, gait.prediction.speed);
    CHECK_NEAR(series.prediction.power, spec.limits.power, 1e-7, "at the same power");
    test_derivatives(series.problem);
    test_series_refused(&gait, &series, &rig);
    spec.limits.theta_max.upper = 80 * DEG;
    solve_series(&spec, &rig, &gait, &wide);
    CHECK(wide.prediction.speed > series.prediction.speed && wide.swum.peak_link_angle < 79 * DEG,
          "faster still where the links may: %.5f m/s, %.4g deg", wide.prediction.speed,
          wide.swum.peak_link_angle / DEG);
    if (model == MORAY_FIRST_PRINCIPLES)
        test_neighbours(&spec, &rig, &wide);
    release(&gait);
    release(&series);
    release(&wide);
    moray_test_rig_free(&rig);
}

// Limits of rate and effort, as simulated.
static void test_limits(void)
{
    moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    moray_test_rig rig;
    struct optimum gait, slow, weak;
    CHECK_OK(moray_test_rig_new(&rig, &spec.robot, spec.current, 0), "rig");
    solve_gait(&spec, &rig, &gait);
    spec.joints = MORAY_JOINTS_SERIES;
    spec.limits.joint_rate = 0.6 * gait.prediction.gait.amplitude * gait.prediction.gait.omega;
    solve_series(&spec, &rig, &gait, &slow);
    const moray_gait motion = {.omega = slow.prediction.gait.omega, .series = &slow.series};
    double phi[3][JOINTS], fastest = 0;
    for (int k = 0; k < 720; k++) {
        moray_gait_reference(&motion, JOINTS, k * DEG / 2 / motion.omega, phi[0], phi[1], phi[2]);
        for (int i = 0; i < JOINTS; i++)
            fastest = fmax(fastest, fabs(phi[1][i]));
    }
    CHECK_RELATIVE(fastest, spec.limits.joint_rate, 1e-3, "joint rate at its limit");
    spec.limits.joint_rate = MORAY_INFINITY;
    spec.limits.joint_effort = 0.7 * gait.swum.peak_effort;
    solve_series(&spec, &rig, &gait, &weak);
    CHECK_RELATIVE(weak.swum.peak_effort, spec.limits.joint_effort, 1e-3, "torque at its limit, as simulated");
    release(&gait);
    release(&slow);
    release(&weak);
    moray_test_rig_free(&rig);
}

static void test_refusals(void)
{
    moray_gait_problem *problem;
    moray_gait_problem_spec spec = spec_of(MORAY_FIRST_PRINCIPLES);
    spec.joints = MORAY_JOINTS_SERIES;
    spec.harmonics = 0;
    const moray_status status = moray_gait_problem_new(&problem, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "harmonics = 0") && !problem, "refused: %s", status.text);
}

int main(void)
{
    test_endpoint(MORAY_GAIT_FASTEST);
    test_endpoint(MORAY_GAIT_THRIFTIEST);
    test_optima(MORAY_FIRST_PRINCIPLES);
    if (tap_thorough()) {
        test_optima(MORAY_CONTROL_ORIENTED);
        test_limits();
    }
    test_refusals();
    return tap_done();
}
