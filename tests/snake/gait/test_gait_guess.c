// SPDX-License-Identifier: MIT
//
// Where searches for gaits begin, by solves of no iteration: on the orbits given, with the gaits' parameters, and, for
// several scenarios, with the least of the gains that the orbits show.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "snake/gait/over.h"

enum { N = 3, LINKS = 4, STATES = 2 * LINKS + 4, INTERVALS = 4 };
static const double T = 2.5;     // of all orbits [s]
static const double just = 1e-9; // behind where an interval begins, where a solution is what the guess is there [s]

static moray_gait_problem_spec spec_of(int k)
{
    moray_gait_problem_spec spec = {.robot = moray_robot_paper(),
                                    .model = MORAY_FIRST_PRINCIPLES,
                                    .current = {0.03 * k, -0.05 * k},
                                    .limits = {.theta_max = moray_between(5 * DEG, 35 * DEG),
                                               .omega = moray_between(0.5, 9),
                                               .delta = moray_between(0.2, 1.5),
                                               .offset = moray_between(-0.3, 0.4),
                                               .taper = moray_between(-0.6, 0.7),
                                               .power = MORAY_INFINITY,
                                               .joint_rate = MORAY_INFINITY,
                                               .joint_effort = MORAY_INFINITY}};
    spec.robot.links = LINKS;
    return spec;
}

static moray_gait gait_of(int k)
{
    return (moray_gait){.amplitude = 0.3 + 0.01 * k,
                        .omega = 2 * M_PI / T + 0.1 * k,
                        .delta = 0.7 - 0.1 * k,
                        .offset = 0.05 - 0.03 * k,
                        .taper = 0.1 * k - 0.15};
}

// States on straight lines of their own, from a start at the origin.
static double state(int k, int i, double t)
{
    const double start = i >= LINKS && i < LINKS + 2 ? 0 : 0.1 * sin(1.3 * i + k);
    return start + 0.02 * t * (i + 1 + k);
}

// The distance is as the pose has it, and another one than the states'.
static moray_swim_track track_of(int k, const double way[2])
{
    const moray_gait_problem_spec spec = spec_of(k);
    const int points = 2 * INTERVALS * (k + 1) + 1;
    moray_swimmer *swimmer;
    moray_swim_track track;
    CHECK_OK(moray_swimmer_new(&swimmer, &spec.robot, spec.model), "swimmer");
    CHECK_OK(moray_swim_track_new(&track, swimmer, points), "track");
    for (int p = 0; p < points; p++) {
        const double part = (double)p / (points - 1), u[LINKS - 1] = {0};
        double x[STATES];
        for (int i = 0; i < STATES; i++)
            x[i] = state(k, i, T * part);
        const moray_swim_sample sample = {
            .t = T * part, .x = x, .u = u, .pose = {.p_x = 0.7 + way[0] * part, .p_y = way[1] * part - 0.4}};
        CHECK(moray_swim_track_add(&sample, &track), "sample");
    }
    moray_swimmer_free(swimmer);
    return track;
}

static moray_settings no_iteration(int intervals)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "hermite-simpson";
    settings.intervals = intervals;
    settings.max_iterations = 0;
    settings.max_refinements = 0;
    return settings;
}

// What a phase begins with where its intervals do, from the samples of orbit k.
static double off_orbit(const moray_solution *solution, int phase, int k)
{
    double worst = 0;
    for (int p = 0; p < INTERVALS; p++) {
        const double t = T * p / INTERVALS;
        double full[STATES], want[MORAY_BODY_STATES], x[MORAY_BODY_STATES];
        for (int i = 0; i < STATES; i++)
            full[i] = state(k, i, t);
        moray_state_body(MORAY_FIRST_PRINCIPLES, LINKS, full, want);
        moray_solution_at(solution, phase, t + just, x, NULL);
        for (int i = 0; i < MORAY_BODY_STATES; i++)
            worst = tap_worse(worst, fabs(x[i] - want[i]));
    }
    return worst;
}

// From what the first solution shows at these times, on which its intervals need not agree.
static double off_solution(const moray_solution *solution, const moray_solution *first, int intervals)
{
    double worst = 0, x[MORAY_BODY_STATES], want[MORAY_BODY_STATES];
    for (int p = 0; p < intervals; p++) {
        const double t = T * p / intervals;
        moray_solution_at(first, 0, t, want, NULL);
        moray_solution_at(solution, 0, t + just, x, NULL);
        for (int i = 0; i < MORAY_BODY_STATES; i++)
            worst = tap_worse(worst, fabs(x[i] - want[i]));
    }
    return worst;
}

static void check_times(const moray_solution *solution, int phase)
{
    double t0, tf;
    moray_solution_times(solution, phase, &t0, &tf);
    CHECK(t0 == 0, "begins at 0");
    CHECK_NEAR(tf, T, 1e-12, "over the period");
}

static void check_over(moray_over_goal goal, int worst)
{
    const double speed[N] = {0.2, 0.35, 0.3}, gains[N] = {worst == 0 ? 0.1 : 0.5, worst == 1 ? 0.15 : 0.4, 0.3};
    moray_gait_scenario scenario[N];
    moray_swim_track track[N];
    moray_gait gait[N];
    moray_gait_over *over = NULL;
    moray_solution *solution = NULL;
    const moray_settings settings = no_iteration(INTERVALS);
    static const char *const names[N] = {"first", "second", "third"};
    for (int k = 0; k < N; k++) {
        const moray_gait_problem_spec spec = spec_of(k);
        const double swum = (1 + gains[k]) * speed[k] * T, *V = spec.current;
        scenario[k] = (moray_gait_scenario){names[k], spec, speed[k]};
        track[k] = track_of(k, (double[]){0.6 * swum + V[0] * T, -0.8 * swum + V[1] * T});
        gait[k] = gait_of(k);
    }
    CHECK_OK(moray_gait_over_new(&over, scenario, N, goal), "over scenarios");
    CHECK_OK(moray_gait_over_solve(over, &settings, gait, track, &solution), "no iteration");
    const double *s = moray_solution_parameters(solution);
    double want[] = {
        gait[0].amplitude, gait[0].omega,  gait[1].omega,  gait[2].omega, gait[0].delta,
        gait[0].offset,    gait[1].offset, gait[2].offset, gait[0].taper, fmin(fmin(gains[0], gains[1]), gains[2])};
    for (int i = 0; i < over->ns; i++)
        CHECK_NEAR(s[i], want[i], 1e-12, over->name[i]);
    for (int k = 0; k < N; k++) {
        check_times(solution, k);
        CHECK_NEAR(off_orbit(solution, k, k), 0, 1e-7, names[k]);
        moray_swim_track_free(&track[k]);
    }
    moray_solution_free(solution);
    moray_gait_over_free(over);
}

// From an orbit, and from there on with other parameters on a finer mesh.
static void check_one(int finer)
{
    const moray_gait_problem_spec spec = spec_of(1);
    const moray_gait gait = gait_of(1);
    moray_swim_track track = track_of(1, (double[]){0.3, 0.1});
    moray_gait_problem *problem = NULL;
    moray_solution *first = NULL, *next = NULL;
    moray_settings settings = no_iteration(INTERVALS);
    double s[] = {0.25, 2.2, 0.5, -0.07, 0.2}, own[MORAY_GAIT_PARAMETERS];
    CHECK_OK(moray_gait_problem_new(&problem, &spec), "problem");
    CHECK_OK(moray_gait_problem_solve(problem, &settings, &gait, &track, &first), "from the orbit");
    check_times(first, 0);
    CHECK_NEAR(off_orbit(first, 0, 1), 0, 1e-7, "on the orbit");
    moray_gait_to_parameters(&gait, own);
    for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++)
        CHECK_NEAR(moray_solution_parameters(first)[i], own[i], 1e-12, "the gait's parameters");
    settings.intervals = finer;
    CHECK_OK(moray_gait_problem_continue(problem, &settings, first, s, &next), "from there");
    check_times(next, 0);
    CHECK_NEAR(off_solution(next, first, finer), 0, 1e-7, "where the one before was");
    for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++)
        CHECK_NEAR(moray_solution_parameters(next)[i], s[i], 1e-12, "parameters given");
    moray_solution_free(next);
    moray_solution_free(first);
    moray_swim_track_free(&track);
    moray_gait_problem_free(problem);
}

int main(void)
{
    check_one(INTERVALS);
    check_one(2 * INTERVALS);
    for (int worst = 0; worst < N; worst++)
        check_over(MORAY_OVER_WORST, worst);
    check_over(MORAY_OVER_MEAN, 0);
    return tap_done();
}
