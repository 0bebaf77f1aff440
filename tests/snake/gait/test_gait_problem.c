// SPDX-License-Identifier: MIT
//
// The optimal-gait problem: its ends, the default optimum, its independence of mesh, scheme and form, its
// limits.
#include "tap.h"

#include <string.h>

#include "gait_ends.h"
#include "gait_optimum.h"

// Squares of the ends' link-angle amplitudes, mean power, rate amplitudes, speed; in: [x0, t0, xf, tf, q, s].
static void check_optional_events(const struct gait_endpoint *ends, const double *in, const double *out)
{
    moray_robot robot = moray_robot_paper();
    robot.links = ends->links;
    const moray_gait gait = moray_gait_from_parameters(in + 15);
    const double sides[] = {ends->head ? 1 : -1, -1};
    const int n = ends->head + ends->tail, rates = n == 2 ? 2 : 1;
    int row = 0;
    for (int k = 0; k < n; k++, row++) {
        const double angle =
            moray_theta_max_of_link(&robot, (moray_model)ends->revolute, &gait, sides[k] > 0 ? robot.links : 1);
        CHECK_RELATIVE(out[row], pow(ends->revolute ? angle : sin(angle), 2), 1e-13, "link-angle amplitude of an end");
    }
    if (!ends->power)
        return;
    CHECK_NEAR(out[row], in[14] / in[13], 1e-14, "mean power");
    row++;
    for (int k = 0; k < rates; k++, row++)
        CHECK_NEAR(out[row], in[15] * in[16] * (1 + (n ? sides[k] * in[19] : 0)), 1e-14, "rate amplitude");
    CHECK_NEAR(out[row], (0.6 * (in[8] - in[1]) + 0.8 * (in[9] - in[2])) / in[13], 1e-14, "speed along the course");
}

static void test_endpoint(bool revolute, bool limits, moray_gait_goal goal, bool head, bool tail)
{
    struct gait_endpoint ends = {.nx = 6,
                                 .position = 1,
                                 .course = {0.6, 0.8},
                                 .revolute = revolute,
                                 .L = 0.14,
                                 .links = 7,
                                 .head = head,
                                 .tail = tail,
                                 .goal = goal,
                                 .power = limits,
                                 .rate = limits,
                                 .speed = limits};
    unsigned long long seed = 3;
    double in[20], out[20];
    const int ends_bounded = head + tail, rates = head && tail ? 2 : 1;
    CHECK(moray_gait_events(&ends) == 4 + 3 + ends_bounded + limits * (2 + rates), "%d events",
          moray_gait_events(&ends));
    for (int i = 0; i < 20; i++)
        in[i] = tap_random(&seed, 0.3, 1.5);
    in[8] += 2; // work per distance wants some way made
    in[15] *= revolute ? 1 : 0.02;
    gait_ends(&ends, in, 5, out);
    const double dx = in[8] - in[1], dy = in[9] - in[2], along = 0.6 * dx + 0.8 * dy;
    CHECK_NEAR(out[0], goal == MORAY_GAIT_FASTEST ? -along / in[13] : in[14] / along, 1e-14, "the goal");
    CHECK_NEAR(out[5], 0.6 * dy - 0.8 * dx, 1e-14, "displacement across the course");
    CHECK_NEAR(out[6], in[16] * in[13], 1e-14, "omega T");
    CHECK_NEAR(out[7], in[15] / (revolute ? 2 * sin(in[17] / 2) : 0.14 * cos(in[17] / 2)), 1e-14, "(27) or (33)");
    check_optional_events(&ends, in, out + 8);
}

static double paper_power(moray_model model)
{
    return model == MORAY_CONTROL_ORIENTED ? 0.3972 : 0.2646; // an independent implementation
}

static void test_default(void)
{
    moray_gait_problem_spec spec = default_spec(MORAY_CONTROL_ORIENTED, paper_power(MORAY_CONTROL_ORIENTED));
    const struct outcome base = solve(&spec, "lobatto5", 12);
    const moray_gait *gait = &base.prediction.gait;
    CHECK_NEAR(base.prediction.speed, 0.2597, 1e-4, "speed on the control-oriented model");
    CHECK_NEAR(gait->delta / DEG, 34.9, 0.1, "delta");
    CHECK_NEAR(gait->omega / DEG, 104.3, 0.1, "omega");
    CHECK_NEAR(moray_theta_max_from_amplitude(&spec.robot, spec.model, gait->amplitude, gait->delta) / DEG, 20, 1e-5,
               "theta_max at its bound");
    CHECK_NEAR(base.prediction.power, paper_power(spec.model), 1e-7, "power at its limit");
    CHECK(base.certificate.pass, "certificate: KKT %.1e, mesh %.1e, between nodes %.1e, re-simulation %.1e",
          base.certificate.kkt, base.certificate.mesh_error, base.certificate.between_nodes,
          base.certificate.resimulation);
    const struct outcome fine = solve(&spec, "lobatto5", 24);
    CHECK_NEAR(fine.prediction.speed, base.prediction.speed, 1e-5, "twice the intervals");
    const struct outcome radau = solve(&spec, "radau4", 24);
    CHECK_NEAR(radau.prediction.speed, base.prediction.speed, 1e-7, "another family of schemes");
    spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    const struct outcome closed = solve(&spec, "lobatto5", 12);
    CHECK_NEAR(closed.prediction.speed, base.prediction.speed, 1e-8, "24 states and six agree on the speed");
    CHECK_NEAR(closed.prediction.gait.delta, gait->delta, 1e-6, "and on the gait");
}

static void test_current_and_limits(void)
{
    moray_gait_problem_spec spec = default_spec(MORAY_CONTROL_ORIENTED, paper_power(MORAY_CONTROL_ORIENTED));
    const struct outcome still = solve(&spec, "lobatto5", 12);
    spec.current[0] = 0.05, spec.current[1] = 0.1, spec.course = 20 * DEG;
    const struct outcome drift = solve(&spec, "lobatto5", 12);
    CHECK_NEAR(drift.prediction.v_y * cos(spec.course) - drift.prediction.v_x * sin(spec.course), 0, 1e-9,
               "no motion across the course in a current");
    CHECK_NEAR(drift.prediction.course_speed, hypot(drift.prediction.v_x, drift.prediction.v_y), 1e-9, "course speed");
    CHECK_NEAR(drift.prediction.speed, still.prediction.speed, 5e-3,
               "speed through the water as in still water, nearly");
    spec = default_spec(MORAY_CONTROL_ORIENTED, MORAY_INFINITY);
    spec.limits.joint_rate = 0.08;
    const struct outcome rate = solve(&spec, "lobatto5", 12);
    CHECK_NEAR(rate.prediction.gait.amplitude * rate.prediction.gait.omega, 0.08, 1e-8, "joint rate at its limit");
    spec.limits.joint_rate = MORAY_INFINITY;
    spec.limits.joint_effort = 1.5;
    const struct outcome coarse = solve(&spec, "lobatto5", 12);
    CHECK(!coarse.certificate.pass && coarse.certificate.between_nodes > 1e-4, // its limit
          "the certificate sees a limit passed between the nodes of a coarse mesh: %.1e",
          coarse.certificate.between_nodes);
    const struct outcome force = solve(&spec, "lobatto5", 80);
    CHECK(force.certificate.pass, "and passes a finer one: %s", force.certificate.why);
    moray_test_rig rig;
    moray_steady steady;
    CHECK_OK(moray_test_rig_new(&rig, &spec.robot, spec.current, 0), "rig");
    const moray_swim_setup setup = moray_test_rig_setup(&rig, spec.model);
    CHECK_OK(moray_swim_steady(&setup, &force.prediction.gait, 0, &steady, NULL, 0), "simulated");
    CHECK_NEAR(steady.peak_effort, 1.5, 3e-4, "joint force at its limit, as simulated");
    moray_test_rig_free(&rig);
}

// issue: the first-principles optimum beats the paper's gait there at equal power; simulation confirms it.
static void test_first_principles(void)
{
    const moray_gait_problem_spec spec = default_spec(MORAY_FIRST_PRINCIPLES, paper_power(MORAY_FIRST_PRINCIPLES));
    const struct outcome best = solve(&spec, "lobatto5", 12);
    CHECK(best.certificate.pass, "certificate");
    CHECK(best.prediction.speed > 1.039 * 0.2293, "faster than the paper's gait at its power: %.5f m/s",
          best.prediction.speed);
    moray_test_rig rig;
    moray_steady steady;
    CHECK_OK(moray_test_rig_new(&rig, &spec.robot, spec.current, 0), "rig");
    const moray_swim_setup setup = moray_test_rig_setup(&rig, spec.model);
    CHECK_OK(moray_swim_steady(&setup, &best.prediction.gait, 0, &steady, NULL, 0), "simulated");
    CHECK_NEAR(steady.speed, best.prediction.speed, 1e-5, "simulated speed");
    CHECK_NEAR(steady.power, best.prediction.power, 1e-5, "simulated power");
    moray_test_rig_free(&rig);
}

// The two goals are each other's mirror: the thriftiest gait at the speed of the fastest has its power and is it.
static void test_goals_agree(moray_model model)
{
    moray_gait_problem_spec spec = default_spec(model, paper_power(model));
    const struct outcome fastest = solve(&spec, "lobatto5", 12);
    spec.goal = MORAY_GAIT_THRIFTIEST;
    spec.limits.power = MORAY_INFINITY;
    spec.limits.course_speed = fastest.prediction.course_speed;
    const struct outcome thriftiest = solve(&spec, "lobatto5", 12);
    CHECK(thriftiest.certificate.pass, "certificate: KKT %.1e", thriftiest.certificate.kkt);
    CHECK_NEAR(thriftiest.prediction.course_speed, fastest.prediction.course_speed, 1e-7, "at the speed asked for");
    CHECK_NEAR(thriftiest.prediction.power, paper_power(model), 1e-6, "thriftiest at the fastest's speed: its power");
    CHECK_NEAR(thriftiest.prediction.gait.delta, fastest.prediction.gait.delta, 1e-4, "and its gait");
    spec.limits.course_speed = 0.05;
    const struct outcome slow = solve(&spec, "lobatto5", 12);
    CHECK(slow.prediction.course_speed >= 0.05 - 1e-7 &&
              slow.prediction.power / slow.prediction.speed <
                  0.5 * thriftiest.prediction.power / thriftiest.prediction.speed,
          "slower and far thriftier: %.4g J/m at %.4g m/s", slow.prediction.power / slow.prediction.speed,
          slow.prediction.speed);
}

// By simulation: no gait beside the thriftiest needs less power at the same speed.
static void test_thriftiest_by_simulation(void)
{
    moray_gait_problem_spec spec = default_spec(MORAY_FIRST_PRINCIPLES, MORAY_INFINITY);
    spec.goal = MORAY_GAIT_THRIFTIEST;
    spec.limits.course_speed = 0.2293;
    const struct outcome best = solve(&spec, "lobatto5", 12);
    moray_test_rig rig;
    moray_steady steady;
    CHECK_OK(moray_test_rig_new(&rig, &spec.robot, spec.current, 0), "rig");
    const moray_swim_setup setup = moray_test_rig_setup(&rig, spec.model);
    CHECK_OK(moray_swim_steady(&setup, &best.prediction.gait, 0, &steady, NULL, 0), "simulated");
    CHECK_NEAR(steady.power, best.prediction.power, 1e-5, "simulated power");
    for (int k = 0; k < 3; k++) {
        moray_gait gait = best.prediction.gait;
        gait.delta += (k == 0 ? 2 : k == 1 ? -2 : 0) * DEG;
        gait.amplitude = moray_amplitude_from_theta_max(&spec.robot, spec.model, (k == 2 ? 19 : 20) * DEG, gait.delta);
        CHECK_OK(moray_swim_match_speed(&setup, &gait, 0, best.prediction.speed, &steady), "at the same speed");
        CHECK(steady.power > best.prediction.power * 1.0005, "a gait beside it needs %.3f %% more power",
              100 * (steady.power / best.prediction.power - 1));
    }
    moray_test_rig_free(&rig);
}

// In a current work is counted by the way made good over ground.
static void test_thriftiest_in_current(void)
{
    moray_gait_problem_spec spec = default_spec(MORAY_CONTROL_ORIENTED, MORAY_INFINITY);
    spec.goal = MORAY_GAIT_THRIFTIEST;
    spec.current[0] = -0.08;
    const struct outcome head = solve(&spec, "lobatto5", 12);
    CHECK(head.prediction.gait.omega > 40 * DEG && head.prediction.course_speed > 0.03,
          "against a current it does not pay to be slow: %.4g m/s over ground, omega %.4g deg/s",
          head.prediction.course_speed, head.prediction.gait.omega / DEG);
    spec.current[0] = 0.08;
    const struct outcome tail = solve(&spec, "lobatto5", 12);
    CHECK_NEAR(tail.prediction.gait.omega, 30 * DEG, 1e-5, "with it, it does");
}

// A taper takes nothing from links that may all swing alike, and gains where they need not.
static void test_taper(moray_model model)
{
    moray_gait_problem_spec spec = default_spec(model, paper_power(model));
    const moray_gait near = {.amplitude = 0.045, .omega = 140 * DEG, .delta = 48 * DEG}; // there are other optima
    const struct outcome alike = solve_from(&spec, &near, "lobatto5", 12);
    spec.limits.taper = moray_between(-1, 1);
    const struct outcome bounded = solve_from(&spec, &near, "lobatto5", 12);
    CHECK_NEAR(bounded.prediction.gait.taper, 0, 1e-5, "no taper where every link swings as far as it may");
    CHECK_NEAR(bounded.prediction.speed, alike.prediction.speed, 1e-7, "so no speed gained");
    spec.limits.theta_max.upper = 60 * DEG;
    const struct outcome eel = solve_from(&spec, &near, "lobatto5", 12);
    spec.limits.taper = moray_fixed(0);
    const struct outcome wide = solve_from(&spec, &near, "lobatto5", 12);
    CHECK(eel.certificate.pass && eel.prediction.gait.taper < -0.05 &&
              eel.prediction.speed > 1.002 * wide.prediction.speed,
          "where they need not, the tail swings most: taper %.4g, %.4g m/s against %.4g m/s", eel.prediction.gait.taper,
          eel.prediction.speed, wide.prediction.speed);
    moray_test_rig rig;
    moray_steady steady;
    CHECK_OK(moray_test_rig_new(&rig, &spec.robot, spec.current, 0), "rig");
    const moray_swim_setup setup = moray_test_rig_setup(&rig, model);
    CHECK_OK(moray_swim_steady(&setup, &eel.prediction.gait, 0, &steady, NULL, 0), "simulated");
    CHECK_NEAR(steady.speed, eel.prediction.speed, 1e-5, "simulated speed");
    CHECK_NEAR(steady.power, eel.prediction.power, 1e-5, "simulated power");
    moray_test_rig_free(&rig);
}

// A tapered gait at its limits: of the largest link angle and of the largest joint rate.
static void test_taper_limits(moray_model model, double taper)
{
    moray_gait_problem_spec spec = default_spec(model, MORAY_INFINITY);
    spec.limits.taper = moray_fixed(taper);
    spec.limits.joint_rate = model == MORAY_CONTROL_ORIENTED ? 0.1 : 0.6;
    const struct outcome end = solve(&spec, "lobatto5", 12);
    const moray_gait *gait = &end.prediction.gait;
    const int link = taper > 0 ? spec.robot.links : 1;
    CHECK_NEAR(moray_theta_max_of_link(&spec.robot, model, gait, link) / DEG, 20, 1e-4, "largest link angle");
    CHECK_NEAR(gait->amplitude * gait->omega * (1 + fabs(taper)), spec.limits.joint_rate, 1e-8, "largest joint rate");
}

// The multiplier of the power limit is what a watt more is worth.
static void test_power_price(moray_model model)
{
    const double power = paper_power(model), step = 0.01 * power;
    moray_gait_problem_spec spec = default_spec(model, power);
    const struct outcome here = solve(&spec, "lobatto5", 12);
    spec.limits.power = power + step;
    const struct outcome more = solve(&spec, "lobatto5", 12);
    spec.limits.power = power - step;
    const struct outcome less = solve(&spec, "lobatto5", 12);
    CHECK_RELATIVE(here.prediction.power_price,
                   (more.prediction.course_speed - less.prediction.course_speed) / (2 * step), 1e-4, "speed per power");
    spec.limits.power = MORAY_INFINITY;
    CHECK_NEAR(solve(&spec, "lobatto5", 20).prediction.power_price, 0, 0, "no limit, no price");
}

// A long body: what cancels along it leaves slopes of rounding, by which nothing may be scaled.
static void test_many_links(void)
{
    static const int links[] = {20, 50, 100};
    for (int k = 0; k < 3; k++) {
        moray_gait_problem_spec spec = default_spec(MORAY_CONTROL_ORIENTED, MORAY_INFINITY);
        spec.robot.links = links[k];
        spec.limits.delta = moray_between(1 * DEG, 90 * DEG);
        spec.limits.omega = moray_between(30 * DEG, 150 * DEG);
        const struct outcome end = solve(&spec, "lobatto5", 16);
        CHECK(end.iterations < 40, "%d links in %d iterations", links[k], end.iterations);
        CHECK(end.certificate.pass, "%d links: %s", links[k], end.certificate.why);
    }
}

// Limits along the stroke are as many bounds as a mesh has nodes: more of them do not lead the solver astray.
static void test_fine_meshes(moray_joints joints)
{
    moray_gait_problem_spec spec = default_spec(MORAY_CONTROL_ORIENTED, paper_power(MORAY_CONTROL_ORIENTED));
    spec.joints = joints;
    const struct outcome coarse = solve(&spec, "lobatto5", 12), fine = solve(&spec, "lobatto5", 200);
    CHECK(fine.iterations < 2 * coarse.iterations, "%d iterations on 200 intervals, %d on 12", fine.iterations,
          coarse.iterations);
    CHECK(fine.certificate.pass, "certificate: %s", fine.certificate.why);
}

static void refuses(moray_gait_problem_spec spec, const char *text)
{
    moray_gait_problem *problem;
    const moray_status status = moray_gait_problem_new(&problem, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, text) && !problem, "refused: %s", status.text);
}

static void test_refusals(void)
{
    const moray_gait_problem_spec good = default_spec(MORAY_CONTROL_ORIENTED, 1);
    moray_gait_problem_spec spec = good;
    spec.limits.delta = moray_between(1, 0.5);
    refuses(spec, "delta_deg = ");
    spec = good, spec.limits.taper = moray_between(-1.5, 0);
    refuses(spec, "taper = -1.5:0: must be a range lo:hi within -1:1");
    spec = good, spec.limits.taper = moray_between(-0.5, 0), spec.robot.links = 2;
    refuses(spec, "taper = -0.5:0: must be a range lo:hi within 0:0");
    spec = good, spec.limits.power = -1;
    refuses(spec, "power_W = -1");
    spec = good, spec.limits.theta_max.upper = NAN;
    refuses(spec, "theta_max_deg");
    spec = good, spec.limits.course_speed = -0.1;
    refuses(spec, "speed_m_s = -0.1");
    spec = good, spec.current[0] = INFINITY;
    refuses(spec, "current = inf");
    spec = good, spec.joints = MORAY_JOINTS_FREE;
    refuses(spec, "joints");
    spec = good, spec.robot.links = 1;
    refuses(spec, "links = 1");
}

int main(void)
{
    for (int k = 0; k < 32; k++)
        test_endpoint(k & 1, k & 2, k & 4 ? MORAY_GAIT_THRIFTIEST : MORAY_GAIT_FASTEST, k & 8, k & 16);
    test_default();
    test_current_and_limits();
    test_many_links();
    test_fine_meshes(MORAY_JOINTS_ON_GAIT);
    test_first_principles();
    test_goals_agree(MORAY_CONTROL_ORIENTED);
    test_goals_agree(MORAY_FIRST_PRINCIPLES);
    for (int model = 0; model < 2; model++)
        test_taper_limits((moray_model)model, 0.5);
    for (int model = 0; model < 2 && tap_thorough(); model++) {
        test_power_price((moray_model)model);
        test_taper((moray_model)model);
        test_taper_limits((moray_model)model, -0.8);
    }
    if (tap_thorough()) {
        test_thriftiest_by_simulation();
        test_thriftiest_in_current();
    }
    test_refusals();
    return tap_done();
}
