// SPDX-License-Identifier: MIT
//
// References: the table and the numbers of an independent implementation, and a classical Runge-Kutta integration at
// fixed step of the swimmer's rates, which shares nothing with src/sim and src/app.
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/snake/swim.h"
#include "moray/snake/trial.h"

#include "rk4.h"

enum { LINKS = 10, STATES = 2 * LINKS + 4, JOINTS = LINKS - 1 };

static const moray_model models[] = {MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED};

static moray_swimmer *make(moray_model model)
{
    const moray_robot robot = moray_robot_paper();
    moray_swimmer *swimmer = NULL;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    return swimmer;
}

static moray_gait gait_of(moray_model model, double theta_max_deg, double delta_deg)
{
    const moray_robot robot = moray_robot_paper();
    const double delta = delta_deg * DEG;
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(&robot, model, theta_max_deg * DEG, delta),
                        .omega = 120 * DEG,
                        .delta = delta};
}

static moray_swim_setup setup_of(moray_swimmer *swimmer, double V_x, double V_y)
{
    return (moray_swim_setup){.swimmer = swimmer, .current = {V_x, V_y}, .settings = moray_swim_settings_default()};
}

static moray_steady steady_of(const moray_swim_setup *setup, const moray_gait *gait, double start_heading)
{
    moray_steady steady = {0};
    CHECK_OK(moray_swim_steady(setup, gait, start_heading, &steady, NULL, 0), "steady swimming");
    return steady;
}

// ---- Reference: classical Runge-Kutta, x[STATES] is the joint work -------------------------------------------------

typedef struct reference {
    moray_swimmer *swimmer;
    const moray_gait *gait;
} reference;

static bool reference_rates(double t, const double *x, double *dx, void *self)
{
    const reference *r = self;
    double ubar[JOINTS], u[JOINTS], phi[JOINTS], v_phi[JOINTS];
    moray_swimmer_control(r->swimmer, r->gait, t, x, ubar);
    if (!moray_swimmer_rates(r->swimmer, x, ubar, dx, u))
        return false;
    moray_swimmer_joints(r->swimmer, x, phi, v_phi);
    dx[STATES] = 0;
    for (int i = 0; i < JOINTS; i++)
        dx[STATES] += u[i] * v_phi[i];
    return true;
}

static void reference_run(moray_swimmer *swimmer, const moray_gait *gait, double t0, double t1, int steps, double *x)
{
    reference r = {swimmer, gait};
    const moray_ode ode = {.n = STATES + 1, .rhs = reference_rates, .self = &r};
    const moray_integrator rk4 = {.run = rk4_run, .self = &steps};
    if (moray_failed(rk4_run(&rk4, &ode, t0, t1, x, NULL, 0, NULL, NULL)))
        x[0] = NAN;
}

// fmax that does not lose a NaN.
static double larger(double a, double b)
{
    return a >= b || isnan(a) ? a : b;
}

static double distance(const double *a, const double *b)
{
    double largest = 0;
    for (int i = 0; i < STATES; i++)
        largest = larger(largest, fabs(a[i] - b[i]));
    return largest;
}

// ---- Simulation -----------------------------------------------------------------------------------------------------

static void test_against_reference(moray_model model)
{
    moray_swimmer *swimmer = make(model);
    moray_swimmer_set_current(swimmer, 0.1, -0.05);
    moray_gait gait = gait_of(model, 20, 40);
    gait.offset = 0.1 * gait.amplitude;
    const moray_gait_change schedule[] = {{.t = 0.5, .gait = gait}};
    const moray_swim_plan plan = {.t0 = 0.7, .t1 = 3.2, .schedule = schedule, .n_changes = 1};
    const moray_sim_settings settings = moray_sim_settings_default();
    double x[STATES], y[STATES + 1] = {0}, energy;
    moray_swimmer_rest(swimmer, 0.3, 1, 2, x);
    memcpy(y, x, sizeof x);
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, &energy), "run");
    reference_run(swimmer, &gait, 0.7, 3.2, 5000, y);
    CHECK(distance(x, y) < 2e-8, "as a classical Runge-Kutta integration: %g", distance(x, y));
    CHECK_NEAR(energy, y[STATES], 2e-8, "joint work");
    moray_swimmer_free(swimmer);
}

// One run of two gaits is one run of each in series, but for the joint work, which starts again and has its say in the
// choice of steps. A step across the change would err by far more.
static void test_schedule(moray_model model)
{
    moray_swimmer *swimmer = make(model);
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_gait_change schedule[] = {{.t = 0, .gait = gait_of(model, 20, 40)},
                                          {.t = 1.7, .gait = gait_of(model, 10, 60)}};
    const moray_swim_plan both = {.t0 = 0, .t1 = 4, .schedule = schedule, .n_changes = 2};
    const moray_swim_plan first = {.t0 = 0, .t1 = 1.7, .schedule = schedule, .n_changes = 1};
    const moray_swim_plan second = {.t0 = 1.7, .t1 = 4, .schedule = schedule, .n_changes = 2};
    double x[STATES], y[STATES], z[STATES + 1] = {0}, energy, energy_1, energy_2;
    moray_swimmer_rest(swimmer, 0, 0, 0, x);
    memcpy(y, x, sizeof x);
    memcpy(z, x, sizeof x);
    CHECK_OK(moray_swim_run(swimmer, &settings, &both, x, &energy), "both gaits");
    CHECK_OK(moray_swim_run(swimmer, &settings, &first, y, &energy_1), "the first");
    CHECK_OK(moray_swim_run(swimmer, &settings, &second, y, &energy_2), "the second");
    CHECK(distance(x, y) < 1e-11, "a schedule is its runs in series: %g", distance(x, y));
    CHECK_NEAR(energy, energy_1 + energy_2, 1e-8, "and the joint work their sum");
    reference_run(swimmer, &schedule[0].gait, 0, 1.7, 4000, z);
    reference_run(swimmer, &schedule[1].gait, 1.7, 4, 4000, z);
    CHECK(distance(x, z) < 2e-8, "as the reference: %g", distance(x, z));
    moray_swimmer_free(swimmer);
}

// Sec. V-C, and what an independent implementation has of it: offsets in [40, 70] and [130, 160] s.
static void test_turning_manoeuvre(moray_model model, double heading_deg, double p_x, double p_y)
{
    moray_swimmer *swimmer = make(model);
    moray_swimmer_set_current(swimmer, 0.1, 0.1);
    const moray_gait straight = gait_of(model, 10, 40);
    moray_gait left = straight, right = straight;
    left.offset = (model == MORAY_CONTROL_ORIENTED ? 1 : -1) * straight.amplitude / 6; // erratum E3
    right.offset = -left.offset;
    const moray_gait_change schedule[] = {{0, straight}, {40, left}, {70, straight}, {130, right}, {160, straight}};
    enum { n = 33 };
    double times[n], x[STATES];
    for (int i = 0; i < n; i++)
        times[i] = i < n - 1 ? 127 + 3 * i / (n - 2.) : 190;
    moray_swim_track track;
    CHECK_OK(moray_swim_track_new(&track, swimmer, n), "track");
    moray_swimmer_rest(swimmer, 0, 0, 0, x);
    const moray_swim_plan plan = {.t1 = 190,
                                  .schedule = schedule,
                                  .n_changes = 5,
                                  .times = times,
                                  .n_times = n,
                                  .observe = moray_swim_track_add,
                                  .observer = &track};
    const moray_sim_settings settings = moray_sim_settings_default();
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, NULL), "turning manoeuvre");
    CHECK(track.n == n, "all samples taken: %d", track.n);
    double heading = 0;
    for (int i = 0; i < n - 2; i++)
        heading += track.pose[i].heading / (n - 2);
    CHECK_NEAR(heading / DEG, heading_deg, 0.05, "mean heading in deg over the period up to 130 s");
    // To one unit of the last digit printed: 38.2647, the limit of ever smaller tolerances, is printed as 38.27.
    CHECK_NEAR(track.pose[n - 1].p_x, p_x, 0.01, "p_x at 190 s");
    CHECK_NEAR(track.pose[n - 1].p_y, p_y, 0.01, "p_y at 190 s");
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
}

static void test_plans(void)
{
    moray_swimmer *swimmer = make(MORAY_CONTROL_ORIENTED);
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_gait_change schedule[] = {{0, gait_of(MORAY_CONTROL_ORIENTED, 10, 40)},
                                          {0, gait_of(MORAY_CONTROL_ORIENTED, 20, 40)}};
    const double times[] = {0.5, 2};
    double x[STATES];
    moray_swimmer_rest(swimmer, 0, 0, 0, x);
    moray_swim_plan plan = {.t0 = -1, .t1 = 1, .schedule = schedule, .n_changes = 1};
    moray_status status = moray_swim_run(swimmer, &settings, &plan, x, NULL);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "t0 = -1"), "no gait yet: %s", status.text);
    plan = (moray_swim_plan){.t1 = 1, .schedule = schedule, .n_changes = 2};
    status = moray_swim_run(swimmer, &settings, &plan, x, NULL);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "schedule[1].t = 0"), "two at once: %s", status.text);
    plan = (moray_swim_plan){.t1 = -1, .schedule = schedule, .n_changes = 1};
    status = moray_swim_run(swimmer, &settings, &plan, x, NULL);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "t1 = -1"), "back in time: %s", status.text);
    plan = (moray_swim_plan){.t1 = 1, .schedule = schedule, .n_changes = 1, .times = times, .n_times = 2};
    status = moray_swim_run(swimmer, &settings, &plan, x, NULL);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "times[1] = 2"), "sample too late: %s", status.text);
    moray_swim_track track;
    CHECK_OK(moray_swim_track_new(&track, swimmer, 1), "a track of one");
    plan = (moray_swim_plan){.t1 = 2,
                             .schedule = schedule,
                             .n_changes = 1,
                             .times = times,
                             .n_times = 2,
                             .observe = moray_swim_track_add,
                             .observer = &track};
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, NULL), "run");
    CHECK(track.n == 1 && track.t[0] == 0.5, "a full track takes no more: %d", track.n);
    moray_swim_track_free(&track);
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
}

// In a table the samples know the current where they are, and the swimmer keeps the one that it was given.
static void test_water(void)
{
    char path[] = "/tmp/moray_swim_XXXXXX";
    const int made = mkstemp(path);
    FILE *file = made < 0 ? NULL : fdopen(made, "w");
    moray_water *water = NULL;
    moray_swim_track track;
    double V[2], x[STATES], times[] = {0, 1, 2}, worst = 0;
    if (!CHECK(file, "a file"))
        return;
    fputs("x_m,y_m,v_x_m_s,v_y_m_s\n-1,-1,0.1,-0.04\n-1,2,0.1,0.08\n2,-1,0.13,-0.04\n2,2,0.13,0.08\n", file);
    fclose(file);
    CHECK_OK(moray_water_read(&water, path), "table");
    remove(path);
    moray_swimmer *swimmer = make(MORAY_FIRST_PRINCIPLES);
    moray_swimmer_set_current(swimmer, 0.3, -0.2);
    CHECK_OK(moray_swim_track_new(&track, swimmer, 3), "track");
    const moray_gait_change change = {0, gait_of(MORAY_FIRST_PRINCIPLES, 20, 40)};
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_swim_on_gait how = {.steps = 40};
    const moray_swim_plan plan = {.t1 = 2,
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = times,
                                  .n_times = 3,
                                  .water = water,
                                  .observe = moray_swim_track_add,
                                  .observer = &track};
    for (int on_gait = 0; on_gait < 2; on_gait++) {
        track.n = 0;
        moray_swimmer_rest(swimmer, 0.4, 0.2, 0.3, x);
        CHECK_OK(on_gait ? moray_swim_run_on_gait(swimmer, &plan, &how, x, NULL)
                         : moray_swim_run(swimmer, &settings, &plan, x, NULL),
                 "run");
        for (int k = 0; k < track.n; k++) { // V = (0.11 + 0.01 x, 0.04 y)
            worst = tap_worse(worst, fabs(track.current[2 * k] - 0.11 - 0.01 * track.pose[k].p_x));
            worst = tap_worse(worst, fabs(track.current[2 * k + 1] - 0.04 * track.pose[k].p_y));
        }
        moray_swimmer_current(swimmer, V);
        CHECK(track.n == 3 && worst < 1e-12, "%d samples with their current, off by %.1e", track.n, worst);
        CHECK(V[0] == 0.3 && V[1] == -0.2, "its own current again: %g, %g", V[0], V[1]);
    }
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
    moray_water_free(water);
}

// ---- Numbers of an independent implementation ----------------------------------------------------------------------

static void test_straight_table(moray_model model, const double v_x[4])
{
    const double theta_deg[] = {10, 15, 20, 30}, times[] = {30, 45};
    moray_swimmer *swimmer = make(model);
    moray_swimmer_set_current(swimmer, 0.1, 0.1);
    for (int i = 0; i < 4; i++) {
        const moray_gait_change schedule[] = {{.t = 0, .gait = gait_of(model, theta_deg[i], 40)}};
        const moray_sim_settings settings = moray_sim_settings_default();
        double x[STATES];
        moray_swim_track track;
        CHECK_OK(moray_swim_track_new(&track, swimmer, 2), "track");
        const moray_swim_plan plan = {.t1 = 45,
                                      .schedule = schedule,
                                      .n_changes = 1,
                                      .times = times,
                                      .n_times = 2,
                                      .observe = moray_swim_track_add,
                                      .observer = &track};
        moray_swimmer_rest(swimmer, 0, 0, 0, x);
        CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, NULL), "45 s from rest");
        CHECK_NEAR((track.pose[1].p_x - track.pose[0].p_x) / 15, v_x[i], 0.003 * v_x[i], "mean v_x, last five periods");
        moray_swim_track_free(&track);
    }
    moray_swimmer_free(swimmer);
}

static void test_delta_table(moray_model model, const double speed[6])
{
    const double delta_deg[] = {20, 30, 40, 50, 60, 80};
    moray_swimmer *swimmer = make(model);
    const moray_swim_setup setup = setup_of(swimmer, 0, 0);
    for (int i = 0; i < 6; i++) {
        const moray_gait gait = gait_of(model, 20, delta_deg[i]);
        CHECK_NEAR(steady_of(&setup, &gait, 0).speed, speed[i], 5.5e-4, "speed in still water, over delta");
    }
    moray_swimmer_free(swimmer);
}

static void test_still_water(void)
{
    moray_swimmer *swimmer = make(MORAY_FIRST_PRINCIPLES);
    moray_swim_setup setup = setup_of(swimmer, 0, 0);
    moray_gait gait = gait_of(MORAY_FIRST_PRINCIPLES, 20, 40);
    moray_steady steady = steady_of(&setup, &gait, 0);
    CHECK_NEAR(steady.speed, 0.2293, 1e-4, "first-principles speed");
    CHECK_NEAR(steady.power, 0.2646, 1e-4, "first-principles power");
    CHECK_NEAR(steady.peak_effort, 0.403, 6e-4, "first-principles peak torque");
    CHECK_NEAR(steady.cost_of_transport, 0.2646 / 0.2293, 1e-3, "first-principles cost of transport");
    CHECK(!steady.turning && fabs(steady.heading_drift) < 1e-9, "no turn in still water: %g", steady.heading_drift);
    moray_swimmer_free(swimmer);
    swimmer = setup.swimmer = make(MORAY_CONTROL_ORIENTED);
    gait = gait_of(MORAY_CONTROL_ORIENTED, 20, 40);
    steady = steady_of(&setup, &gait, 0.5);
    CHECK_NEAR(steady.speed, 0.2574, 0.003 * 0.2574, "control-oriented speed");
    CHECK_NEAR(steady.power, 0.397, 5e-4, "control-oriented power");
    CHECK_NEAR(steady.heading, 0.5, 1e-9, "control-oriented heading");
    CHECK_NEAR(atan2(steady.v_y, steady.v_x), 0.5, 1e-9, "swims where it looks");
    moray_swimmer_free(swimmer);
}

// ---- Steady swimming ------------------------------------------------------------------------------------------------

// Against the reference: means and peaks of the period after `settling` periods from rest. The faster the gait, the
// more periods it takes to settle.
static void test_steady(moray_model model, double omega_deg, int settling)
{
    enum { steps = 720 };
    moray_swimmer *swimmer = make(model);
    const moray_swim_setup setup = setup_of(swimmer, 0.05, 0);
    moray_gait gait = gait_of(model, 20, 40);
    gait.omega = omega_deg * DEG;
    const double T = 2 * M_PI / gait.omega, start = settling * T;
    const moray_steady steady = steady_of(&setup, &gait, 0.2);
    double x[STATES + 1] = {0}, peak_effort = 0, peak_angle = 0, heading = 0;
    moray_swimmer_rest(swimmer, 0.2, 0, 0, x);
    reference_run(swimmer, &gait, 0, start, settling * 3 * steps, x);
    const moray_pose first = moray_swimmer_pose(swimmer, x);
    const double energy = x[STATES];
    for (int k = 0; k < steps; k++) {
        double ubar[JOINTS], u[JOINTS], dx[STATES];
        const moray_pose pose = moray_swimmer_pose(swimmer, x);
        moray_swimmer_control(swimmer, &gait, start + T * k / steps, x, ubar);
        moray_swimmer_rates(swimmer, x, ubar, dx, u);
        for (int i = 0; i < JOINTS; i++)
            peak_effort = fmax(peak_effort, fabs(u[i]));
        peak_angle = fmax(peak_angle, pose.link_angle);
        heading += pose.heading / steps;
        reference_run(swimmer, &gait, start + T * k / steps, start + T * (k + 1) / steps, 3, x);
    }
    const moray_pose last = moray_swimmer_pose(swimmer, x);
    const double v_x = (last.p_x - first.p_x) / T, v_y = (last.p_y - first.p_y) / T;
    CHECK_NEAR(steady.speed, hypot(v_x - 0.05, v_y), 3e-7 * steady.speed, "speed through the water");
    CHECK_NEAR(steady.power, (x[STATES] - energy) / T, 3e-7 * steady.power, "power");
    CHECK_NEAR(steady.peak_effort, peak_effort, 1e-4 * peak_effort, "peak effort");
    CHECK_NEAR(steady.peak_link_angle, peak_angle, 1e-4 * peak_angle, "peak link angle");
    // What agreement leaves; and the turn in the current, over the periods between.
    const double slack = 3e-7 * steady.speed + (model == MORAY_FIRST_PRINCIPLES ? 1e-4 : 0);
    CHECK_NEAR(steady.heading, heading, slack, "mean heading");
    CHECK_NEAR(steady.heading_drift, (last.heading - first.heading) / T, 1e-8, "heading drift");
    CHECK_NEAR(steady.v_x, v_x, slack, "v_x");
    CHECK_NEAR(steady.v_y, v_y, slack, "v_y");
    CHECK_NEAR(moray_course_speed(&steady, 0.4), v_x * cos(0.4) + v_y * sin(0.4), slack, "course speed");
    moray_swimmer_free(swimmer);
}

// Strokes as long as the links, each followed by a NaN; the first robot and the last about where the track begins and
// ends.
static void check_outline(const moray_swimmer *swimmer, const moray_swim_track *track)
{
    const double l = moray_swimmer_robot(swimmer)->l;
    double *x, *y, worst = 0;
    int n;
    CHECK_OK(moray_swim_outline(track, swimmer, &x, &y, &n), "outline");
    CHECK(n >= 2 * 3 * LINKS && n % (3 * LINKS) == 0, "%d points of %d links", n, LINKS);
    for (int k = 0; k < n; k += 3) {
        worst = larger(worst, fabs(hypot(x[k + 1] - x[k], y[k + 1] - y[k]) - 2 * l));
        CHECK(isnan(x[k + 2]) && isnan(y[k + 2]), "a gap");
    }
    CHECK(worst < 1e-12, "strokes of a link's length: %.1e", worst);
    for (int last = 0; last < 2; last++) {
        const moray_pose *pose = &track->pose[last ? track->n - 1 : 0];
        const int first = last ? n - 3 * LINKS : 0;
        double middle[2] = {0, 0};
        for (int k = first; k < first + 3 * LINKS; k += 3) {
            middle[0] += (x[k] + x[k + 1]) / (2 * LINKS);
            middle[1] += (y[k] + y[k + 1]) / (2 * LINKS);
        }
        CHECK_NEAR(middle[0], pose->p_x, 1e-9, "about where it is: x");
        CHECK_NEAR(middle[1], pose->p_y, 1e-9, "y");
    }
    free(x);
}

static void test_orbit(moray_model model)
{
    enum { points = 26 };
    moray_swimmer *swimmer = make(model);
    const moray_swim_setup setup = setup_of(swimmer, 0.1, 0.1);
    const moray_gait gait = gait_of(model, 20, 40);
    const double T = 2 * M_PI / gait.omega;
    moray_steady steady;
    moray_swim_track orbit;
    CHECK_OK(moray_swim_steady(&setup, &gait, 0, &steady, &orbit, points), "steady swimming");
    CHECK(orbit.n == points && orbit.n_states == STATES && orbit.n_joints == JOINTS, "size of the orbit");
    CHECK(orbit.t[0] == 0 && orbit.energy[0] == 0 && orbit.pose[0].p_x == 0 && orbit.x[LINKS + 1] == 0, "origin");
    CHECK_NEAR(orbit.t[points - 1], T, 1e-12, "a period long");
    CHECK_NEAR(orbit.pose[points - 1].p_x, steady.v_x * T, 1e-12, "displacement");
    CHECK_NEAR(orbit.energy[points - 1], steady.power * T, 1e-12, "joint work");
    double worst_joint = 0, worst_effort = 0, largest_effort = 0, x[STATES + 1] = {0};
    for (int k = 0; k < points; k++) {
        double phi[JOINTS], v_phi[JOINTS], ref[JOINTS], dref[JOINTS], ddref[JOINTS], ubar[JOINTS], u[JOINTS],
            dx[STATES];
        const double *row = orbit.x + k * STATES;
        moray_swimmer_joints(swimmer, row, phi, v_phi);
        moray_gait_reference(&gait, JOINTS, T * k / (points - 1), ref, dref, ddref);
        moray_swimmer_control(swimmer, &gait, T * k / (points - 1), row, ubar);
        moray_swimmer_rates(swimmer, row, ubar, dx, u);
        for (int i = 0; i < JOINTS; i++) {
            worst_joint = larger(worst_joint, fabs(phi[i] - ref[i]) + fabs(v_phi[i] - dref[i]));
            worst_effort = larger(worst_effort, fabs(orbit.u[k * JOINTS + i] - u[i]));
            largest_effort = larger(largest_effort, fabs(u[i]));
        }
    }
    CHECK(worst_joint < 1e-8, "the joints are on the gait, in phase: %g", worst_joint);
    CHECK(worst_effort < 1e-9, "the efforts belong to the states: %g", worst_effort);
    CHECK(largest_effort <= steady.peak_effort + 1e-9, "no effort above the peak: %g", largest_effort);
    check_outline(swimmer, &orbit);
    memcpy(x, orbit.x, STATES * sizeof *x);
    reference_run(swimmer, &gait, 0, T, 4000, x);
    const double end = distance(x, orbit.x + (points - 1) * STATES);
    CHECK(end < 2e-8, "the reference runs from the first point to the last: %g", end);
    moray_swim_track_free(&orbit);
    moray_swimmer_free(swimmer);
}

// A gait that turns so slowly that speed and power change by nearly the same from period to period is not steady
// either.
static void test_slow_turn(void)
{
    moray_swimmer *swimmer = make(MORAY_FIRST_PRINCIPLES);
    moray_swim_setup setup = setup_of(swimmer, 0.1, 0.2);
    moray_gait gait = gait_of(MORAY_FIRST_PRINCIPLES, 20, 40);
    gait.offset = 5e-3 * gait.amplitude;
    moray_steady steady;
    const moray_status status = moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0);
    CHECK(status.code == MORAY_NOT_SOLVED, "a slow turn in a current: %s", status.text);
    moray_swimmer_free(swimmer);
}

static void test_turning_gait(moray_model model)
{
    moray_swimmer *swimmer = make(model);
    moray_swim_setup setup = setup_of(swimmer, 0, 0);
    moray_gait gait = gait_of(model, 20, 40);
    gait.offset = gait.amplitude / 6;
    moray_steady steady = steady_of(&setup, &gait, 0);
    CHECK(steady.turning, "an offset turns: %g rad/s", steady.heading_drift);
    CHECK((steady.heading_drift > 0) == (model == MORAY_CONTROL_ORIENTED), "erratum E3: %g", steady.heading_drift);
    CHECK_NEAR(hypot(steady.v_x, steady.v_y), steady.speed, 1e-12, "speed is that through the water");
    moray_status status = moray_swim_hold_course(&setup, &gait, 0, &steady);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "turns at"), "holds no course: %s", status.text);
    setup.current[0] = 0.1;
    setup.settings.max_periods = 40;
    status = moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "the gait turns"), "no steady state in a current: %s",
          status.text);
    moray_swimmer_free(swimmer);
}

static void test_steady_errors(void)
{
    moray_swimmer *swimmer = make(MORAY_CONTROL_ORIENTED);
    moray_swim_setup setup = setup_of(swimmer, 0, 0);
    moray_gait gait = gait_of(MORAY_CONTROL_ORIENTED, 20, 40);
    moray_steady steady;
    moray_swim_track orbit;
    moray_status status = moray_swim_steady(&setup, &gait, 0, &steady, &orbit, 1);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "points = 1"), "orbit of a point: %s", status.text);
    setup.settings.max_periods = 4;
    status = moray_swim_steady(&setup, &gait, 0, &steady, &orbit, 10);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "4 periods"), "too few periods: %s", status.text);
    CHECK(!orbit.x, "no orbit after an error");
    gait.omega = 0;
    status = moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "omega = 0"), "no frequency: %s", status.text);
    gait.omega = 2;
    gait.delta = NAN;
    CHECK(moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0).code == MORAY_INPUT, "delta NaN");
    gait.delta = 1;
    CHECK(moray_swim_steady(&setup, &gait, INFINITY, &steady, NULL, 0).code == MORAY_INPUT, "infinite heading");
    setup.settings.max_periods = 2;
    CHECK(moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0).code == MORAY_INPUT, "max_periods 2");
    setup.settings = moray_swim_settings_default();
    setup.settings.agreement = 0;
    CHECK(moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0).code == MORAY_INPUT, "agreement 0");
    setup.settings = moray_swim_settings_default();
    gait.amplitude = 0;
    steady = steady_of(&setup, &gait, 0);
    CHECK(steady.speed == 0 && steady.power == 0 && isinf(steady.cost_of_transport), "a stiff robot rests");
    moray_swimmer_free(swimmer);
}

// ---- Course, power, speed -------------------------------------------------------------------------------------------

// From the heading found, the reference drifts across the course only as the heading drift makes it.
static void test_course(moray_model model)
{
    enum { settling = 24, per_period = 1500 };
    const double course = 0.3;
    moray_swimmer *swimmer = make(model);
    const moray_swim_setup setup = setup_of(swimmer, 0.05, 0.15);
    const moray_gait gait = gait_of(model, 20, 40);
    const double T = 2 * M_PI / gait.omega;
    moray_steady steady;
    CHECK_OK(moray_swim_hold_course(&setup, &gait, course, &steady), "course held");
    CHECK_NEAR(atan2(steady.v_y, steady.v_x), course, 1e-6, "ground track");
    double x[STATES + 1] = {0};
    moray_swimmer_rest(swimmer, steady.start_heading, 0, 0, x);
    reference_run(swimmer, &gait, 0, settling * T, settling * per_period, x);
    const moray_pose from = moray_swimmer_pose(swimmer, x);
    reference_run(swimmer, &gait, settling * T, (settling + 1) * T, per_period, x);
    const moray_pose to = moray_swimmer_pose(swimmer, x);
    const double v_x = (to.p_x - from.p_x) / T, v_y = (to.p_y - from.p_y) / T;
    const double across = v_y * cos(course) - v_x * sin(course), along = v_x * cos(course) + v_y * sin(course);
    const double turned = steady.heading_drift * (settling + 1 - steady.periods) * T;
    const double crab = course - atan2(steady.v_y - 0.15, steady.v_x - 0.05);
    CHECK(fabs(turned) < 1e-3, "the heading drifts by %g in 16 periods", turned);
    CHECK_NEAR(across, steady.speed * turned * cos(crab), 1e-6, "velocity across the course");
    CHECK_NEAR(along, moray_course_speed(&steady, course), 1e-6 + fabs(steady.speed * turned), "and along it");
    moray_swimmer_free(swimmer);
}

static void test_course_errors(moray_model model)
{
    moray_swimmer *swimmer = make(model);
    moray_swim_setup setup = setup_of(swimmer, 0, 0.3);
    moray_gait gait = gait_of(model, 20, 40);
    moray_steady steady;
    moray_status status = moray_swim_hold_course(&setup, &gait, 0, &steady);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "U = 0.2") && strstr(status.text, "W = 0.3 m/s"),
          "cross current too strong: %s", status.text);
    setup = setup_of(swimmer, 0, -0.3);
    status = moray_swim_hold_course(&setup, &gait, 0, &steady);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "U = 0.2") && strstr(status.text, "W = -0.3 m/s"),
          "and to the other side: %s", status.text);
    setup = setup_of(swimmer, -0.4, 0);
    status = moray_swim_hold_course(&setup, &gait, 0, &steady);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "-0.4 m/s along"), "driven astern: %s", status.text);
    status = moray_swim_match_power(&setup, &gait, 0, -1, &steady);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "-1 W"), "negative power: %s", status.text);
    setup = setup_of(swimmer, 0, 0);
    gait.amplitude = 0;
    status = moray_swim_match_speed(&setup, &gait, 0, 0.2, &steady);
    CHECK(status.code == MORAY_NOT_SOLVED, "a stiff robot makes no way: %s", status.text);
    moray_swimmer_free(swimmer);
}

static void test_match(moray_model model)
{
    const double course = 0.2;
    moray_swimmer *swimmer = make(model);
    const moray_swim_setup setup = setup_of(swimmer, 0.1, 0.1);
    const moray_gait first = gait_of(model, 20, 40), second = gait_of(model, 15, 50);
    moray_steady target, matched;
    CHECK_OK(moray_swim_hold_course(&setup, &first, course, &target), "first gait");
    moray_gait gait = second;
    CHECK_OK(moray_swim_match_power(&setup, &gait, course, target.power, &matched), "equal power");
    CHECK_NEAR(matched.power, target.power, 1.1e-6 * target.power, "power matched");
    CHECK_NEAR(atan2(matched.v_y, matched.v_x), course, 1e-6, "on course");
    CHECK(gait.amplitude == second.amplitude && gait.delta == second.delta && gait.omega != second.omega,
          "only omega is changed: %g to %g", second.omega, gait.omega);
    const moray_steady again = steady_of(&setup, &gait, matched.start_heading);
    CHECK_NEAR(again.power, matched.power, 1e-6 * target.power, "the result is that of the gait returned: power");
    CHECK_NEAR(again.speed, matched.speed, 1e-6, "speed");
    gait = second;
    CHECK_OK(moray_swim_match_speed(&setup, &gait, course, target.speed, &matched), "equal speed");
    CHECK_NEAR(matched.speed, target.speed, 1.1e-6 * target.speed, "speed matched");
    gait = first;
    gait.omega = 1.3;
    CHECK_OK(moray_swim_match_power(&setup, &gait, course, target.power, &matched), "the first gait's own power");
    CHECK_NEAR(gait.omega, first.omega, 2e-6 * first.omega, "is found at its own omega");
    moray_swimmer_free(swimmer);
}

// ---- Gains: at the baseline's power and speed, not at the gait's own ----

static void test_equal_power(void)
{
    const moray_robot robot = moray_robot_paper();
    const moray_model model = MORAY_FIRST_PRINCIPLES;
    const double still[2] = {0, 0};
    moray_test_rig rig;
    moray_gait_trial trial = {0}, baseline = {0};
    CHECK_OK(moray_test_rig_new(&rig, &robot, still, 0), "rig");
    baseline.gait[model] = gait_of(model, 20, 40);
    trial.gait[model] = gait_of(model, 15, 55);
    trial.gait[model].omega = 90 * DEG;
    CHECK_OK(moray_gait_trial_swim(&rig, model, &baseline), "baseline");
    CHECK_OK(moray_gait_trial_swim(&rig, model, &trial), "gait");
    const moray_gait_gain gain = moray_gait_gain_over(&rig, &trial, &baseline);
    const moray_steady *base = &baseline.steady[model];
    const moray_swim_setup setup = moray_test_rig_setup(&rig, model);
    moray_gait gait = trial.gait[model];
    gait.omega = gain.omega_at_equal_power;
    moray_steady swum = steady_of(&setup, &gait, 0);
    CHECK_NEAR(swum.power, base->power, 1e-5 * base->power, "at the omega that is told the power is the baseline's");
    CHECK_NEAR(gain.speed_percent_at_equal_power, 100 * (swum.speed / base->speed - 1), 1e-3, "and there the gain");
    gait.omega = gain.omega_at_equal_speed;
    swum = steady_of(&setup, &gait, 0);
    CHECK_NEAR(swum.speed, base->speed, 1e-5 * base->speed, "at the other omega the speed is");
    CHECK_NEAR(gain.power_percent_at_equal_speed, 100 * (swum.power / base->power - 1), 1e-3, "and there the saving");
    CHECK(fabs(trial.steady[model].power / base->power - 1) > 0.3, "far from the power of the gait as it is");
    // From rest, means over the period before, of 4 s.
    double time[13], speed[13];
    CHECK_OK(moray_gait_trial_speeds(&rig, &trial, model, 36, 13, time, speed), "from rest");
    CHECK_NEAR(time[12], 36, 1e-12, "times up to the horizon");
    CHECK(speed[0] == 0 && speed[1] > 0 && speed[1] < speed[2], "from 0 on: %g, %g m/s", speed[1], speed[2]);
    CHECK_NEAR(speed[12], trial.steady[model].speed, 1e-3 * speed[12], "to the steady speed");
    moray_test_rig_free(&rig);
    double turned[13];
    CHECK_OK(moray_test_rig_new(&rig, &robot, still, 60 * DEG), "a rig with another course");
    CHECK_OK(moray_gait_trial_swim(&rig, model, &trial), "gait");
    CHECK_OK(moray_gait_trial_speeds(&rig, &trial, model, 36, 13, time, turned), "from rest");
    double differ = 0;
    for (int k = 0; k < 13; k++)
        differ = tap_worse(differ, fabs(turned[k] - speed[k]));
    CHECK_NEAR(differ, 0, 1e-6, "as fast on that course, from rest on");
    moray_test_rig_free(&rig);
}

int main(void)
{
    test_straight_table(MORAY_FIRST_PRINCIPLES, (const double[]){0.2083, 0.2784, 0.3290, 0.3794});
    test_straight_table(MORAY_CONTROL_ORIENTED, (const double[]){0.2127, 0.2931, 0.3573, 0.4373});
    test_delta_table(MORAY_FIRST_PRINCIPLES, (const double[]){0.163, 0.237, 0.229, 0.192, 0.153, 0.106});
    test_delta_table(MORAY_CONTROL_ORIENTED, (const double[]){0.423, 0.343, 0.257, 0.196, 0.159, 0.106});
    test_still_water();
    test_turning_manoeuvre(MORAY_FIRST_PRINCIPLES, 26.2, 38.27, 23.22);
    test_turning_manoeuvre(MORAY_CONTROL_ORIENTED, 25.3, 39.10, 23.27);
    test_plans();
    test_water();
    test_steady_errors();
    test_slow_turn();
    test_equal_power();
    for (int i = 0; i < 2; i++) {
        test_against_reference(models[i]);
        test_schedule(models[i]);
        test_steady(models[i], 120, 13);
        test_steady(models[i], 480, 35);
        test_orbit(models[i]);
        test_turning_gait(models[i]);
        test_course(models[i]);
        test_course_errors(models[i]);
        test_match(models[i]);
    }
    return tap_done();
}
