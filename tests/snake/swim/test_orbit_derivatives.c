// SPDX-License-Identifier: MIT
//
// Floquet multipliers against differences of the period map that a classical Runge-Kutta method makes of the swimmer's
// rates; gradients against differences of orbits solved again.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/orbit.h"

#include "rk4.h"

enum { MOST_STATES = 24 };

static const char *const names[] = {"control-oriented", "first-principles"};

typedef struct sample {
    int links;
    double theta_max, omega, delta, offset; // [deg], [deg/s], [deg], of the amplitude
    double current[2], course;
    bool steered;
    double taper;
    bool motors;
} sample;

static const sample samples[] = {
    {10, 20, 120, 40, 0, {0, 0}, 0, true, 0, false},
    {10, 25, 150, 52, 0, {0.05, -0.08}, 0.4, true, -0.5, true},
    {10, 20, 120, 45, 0.2, {0, 0}, 0, false, 0, false}, // turns
    {3, 25, 150, 70, 0, {0.006, 0.004}, 0, true, 0, false},
    {3, 20, 200, 80, 0.1, {0, 0}, 1, false, 0.2, false}, // turns
};
enum { SAMPLES = sizeof samples / sizeof *samples };

// A case at work: its orbit, and a swimmer whose joints follow the gait exactly.
typedef struct rig {
    moray_robot robot;
    moray_model model;
    moray_orbit *orbit;
    moray_orbit_result found;
    moray_swimmer *swimmer;
} rig;

static rig rig_of(const sample *s, moray_model model)
{
    rig r = {.robot = moray_robot_paper(), .model = model};
    r.robot.links = s->links;
    if (s->motors) {
        const double speed[] = {0, 1, 2}, torque[] = {0.6, 0.5, 0};
        r.robot.motor =
            (moray_motor){.fitted = true, .forward = 0.8, .friction = 0.02, .smooth_rate = 0.3, .smooth_power = 0.05};
        CHECK_OK(moray_motor_set_table(&r.robot.motor, speed, torque, 3), "motors");
    }
    moray_orbit_spec spec = moray_orbit_spec_default(&r.robot, model);
    memcpy(spec.current, s->current, sizeof spec.current);
    spec.course = s->course;
    spec.steered = s->steered;
    spec.intervals = 24;
    moray_gait gait = {.amplitude = moray_amplitude_from_theta_max(&r.robot, model, s->theta_max * DEG, s->delta * DEG),
                       .omega = s->omega * DEG,
                       .delta = s->delta * DEG,
                       .taper = s->taper};
    gait.offset = s->offset * gait.amplitude;
    CHECK_OK(moray_orbit_new(&r.orbit, &spec), "orbit");
    CHECK_OK(moray_orbit_solve(r.orbit, &gait, &r.found), "found");
    CHECK_OK(moray_swimmer_new(&r.swimmer, &r.robot, model), "swimmer");
    moray_swimmer_set_current(r.swimmer, s->current[0], s->current[1]);
    printf("# %s, %d links, current %g, %g, %s\n", names[model], s->links, s->current[0], s->current[1],
           s->steered ? "steered" : "not steered");
    return r;
}

static void rig_free(rig *r)
{
    moray_orbit_free(r->orbit);
    moray_swimmer_free(r->swimmer);
}

// ---- Period map ----------------------------------------------------------------------------------------------------

static bool rates(double t, const double *x, double *dx, void *self)
{
    const rig *r = self;
    double ubar[MOST_STATES];
    moray_swimmer_control(r->swimmer, &r->found.gait, t, x, ubar);
    return moray_swimmer_rates(r->swimmer, x, ubar, dx, NULL);
}

// The plant's state (theta, p_x, p_y and rates) moved by d, in the swimmer's coordinates.
static void move(const rig *r, int state, double d, double *x)
{
    const int N = r->robot.links, half = state < 3 ? 0 : N + 2, which = state % 3;
    if (r->model == MORAY_CONTROL_ORIENTED || which > 0)
        x[half + N - 1 + which] += d;
    for (int i = 0; i < N && which == 0 && r->model == MORAY_FIRST_PRINCIPLES; i++)
        x[half + i] += d; // all links alike
}

static double read(const rig *r, int state, const double *x)
{
    const int N = r->robot.links, half = state < 3 ? 0 : N + 2, which = state % 3;
    if (r->model == MORAY_CONTROL_ORIENTED || which > 0)
        return x[half + N - 1 + which];
    double mean = 0;
    for (int i = 0; i < N; i++)
        mean += x[half + i] / N;
    return mean;
}

// After a period, from the orbit's start moved by d.
static void period_map(rig *r, const double *start, int state, double d, double end[6])
{
    int steps = 1200;
    const moray_ode ode = {.n = 2 * r->robot.links + 4, .rhs = rates, .self = r};
    const moray_integrator rk4 = {.run = rk4_run, .self = &steps};
    double x[MOST_STATES];
    memcpy(x, start, sizeof x);
    move(r, state, d, x);
    if (moray_failed(rk4_run(&rk4, &ode, 0, 2 * M_PI / r->found.gait.omega, x, NULL, 0, NULL, NULL)))
        x[0] = NAN;
    for (int k = 0; k < 6; k++)
        end[k] = read(r, k, x);
}

static void difference(rig *r, double M[6][6])
{
    const double h = 1e-3;
    moray_swim_track track;
    double start[MOST_STATES] = {0}, end[4][6];
    CHECK_OK(moray_orbit_track(r->orbit, 2, &track), "track");
    memcpy(start, track.x, (size_t)track.n_states * sizeof *start);
    moray_swim_track_free(&track);
    for (int j = 0; j < 6; j++) {
        const double at[] = {h, -h, 2 * h, -2 * h};
        for (int k = 0; k < 4; k++)
            period_map(r, start, j, at[k], end[k]);
        for (int i = 0; i < 6; i++)
            M[i][j] = (8 * (end[0][i] - end[1][i]) - (end[2][i] - end[3][i])) / (12 * h);
    }
}

// det(A - lambda), by elimination.
static double complex determinant(int n, double complex A[6][6], double complex lambda)
{
    double complex det = 1;
    for (int i = 0; i < n; i++)
        A[i][i] -= lambda;
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            pivot = cabs(A[i][k]) > cabs(A[pivot][k]) ? i : pivot;
        for (int j = 0; j < n && pivot != k; j++) {
            const double complex kept = A[k][j];
            A[k][j] = A[pivot][j];
            A[pivot][j] = kept;
        }
        det *= pivot == k ? A[k][k] : -A[k][k];
        for (int i = k + 1; i < n && A[k][k] != 0; i++)
            for (int j = n - 1; j >= k; j--)
                A[i][j] -= A[i][k] / A[k][k] * A[k][j];
    }
    return det;
}

// First-principles velocities after a turn are compared turned back.
static void turn_back(const rig *r, double M[6][6], double complex turned[6][6])
{
    const bool turns = r->model == MORAY_FIRST_PRINCIPLES && r->found.steady.turning;
    const double turn = turns ? r->found.steady.heading_drift * 2 * M_PI / r->found.gait.omega : 0;
    for (int j = 0; j < 6; j++) {
        for (int i = 0; i < 6; i++)
            turned[i][j] = M[i][j];
        for (int i = 1; i < 6; i += 3) {
            turned[i][j] = cos(turn) * M[i][j] + sin(turn) * M[i + 1][j];
            turned[i + 1][j] = cos(turn) * M[i + 1][j] - sin(turn) * M[i][j];
        }
    }
}

static void test_floquet(const sample *s, moray_model model)
{
    rig r = rig_of(s, model);
    moray_floquet floquet;
    double M[6][6], worst = 0, residual = 0;
    CHECK_OK(moray_orbit_floquet(r.orbit, &floquet), "multipliers");
    difference(&r, M);
    for (int k = 0; k < 36; k++) {
        const double error = fabs(floquet.monodromy[k / 6][k % 6] - M[k / 6][k % 6]);
        worst = tap_worse(worst, error);
    }
    CHECK(worst < 2e-7, "monodromy matrix as differences of the period map: %.1e", worst);
    for (int k = 2; k < 6; k++) {
        double complex A[6][6], rest[6][6];
        static const int kept[] = {0, 3, 4, 5};
        turn_back(&r, M, A);
        for (int i = 0; i < 16; i++)
            rest[i / 4][i % 4] = A[kept[i / 4]][kept[i % 4]];
        residual = tap_worse(residual, cabs(determinant(4, rest, floquet.multiplier[k])));
    }
    CHECK(residual < 1e-7, "multipliers are roots of its characteristic polynomial: %.1e", residual);
    const bool still = s->current[0] == 0 && s->current[1] == 0;
    CHECK(floquet.multiplier[0] == 1 && floquet.multiplier[1] == 1 && floquet.mode[1] == MORAY_MODE_TRANSLATION,
          "displacements stay");
    if (still)
        CHECK(floquet.mode[2] == MORAY_MODE_ROTATION && cabs(floquet.multiplier[2] - 1) < 1e-7,
              "in still water a rotation stays: |lambda - 1| = %.1e", cabs(floquet.multiplier[2] - 1));
    else
        CHECK(floquet.mode[2] == MORAY_MODE_OTHER, "in a current a rotation need not stay");
    CHECK(floquet.mode[3] == MORAY_MODE_OTHER && floquet.largest == cabs(floquet.multiplier[still ? 3 : 2]) &&
              cabs(floquet.multiplier[4]) >= cabs(floquet.multiplier[5]),
          "the largest of the others: %.9f", floquet.largest);
    CHECK(floquet.stable == (floquet.largest < 1 - 1e-9) && (!still || floquet.stable), "%s",
          floquet.stable ? "stable" : "not stable");
    rig_free(&r);
}

// A head current keeps the first-principles robot on its heading, a following one turns it away.
static void test_stability(void)
{
    const sample head = {10, 20, 120, 40, 0, {-0.1, 0}, 0, true, 0, false},
                 following = {10, 20, 120, 40, 0, {0.1, 0}, 0, true, 0, false};
    moray_floquet floquet;
    rig r = rig_of(&head, MORAY_FIRST_PRINCIPLES);
    CHECK_OK(moray_orbit_floquet(r.orbit, &floquet), "multipliers");
    CHECK(floquet.stable && floquet.largest > 1 - 1e-4, "stable, barely: 1 - %.1e", 1 - floquet.largest);
    rig_free(&r);
    r = rig_of(&following, MORAY_FIRST_PRINCIPLES);
    CHECK_OK(moray_orbit_floquet(r.orbit, &floquet), "multipliers");
    CHECK(!floquet.stable && floquet.largest < 1 + 1e-4, "unstable, barely: 1 + %.1e", floquet.largest - 1);
    rig_free(&r);
}

// By how much a head current of V draws deviations in over a period.
static double margin_in(double V, bool *stable)
{
    const sample head = {10, 20, 120, 40, 0, {-V, 0}, 0, true, 0, false};
    moray_floquet floquet;
    rig r = rig_of(&head, MORAY_FIRST_PRINCIPLES);
    CHECK_OK(moray_orbit_floquet(r.orbit, &floquet), "multipliers");
    rig_free(&r);
    *stable = floquet.stable;
    return 1 - floquet.largest;
}

// In proportion to a small current, until what is left says nothing.
static void test_weak_current(void)
{
    bool stable, barely;
    const double firm = margin_in(1e-4, &stable), weak = margin_in(1e-6, &barely);
    CHECK_NEAR(weak / firm, 0.01, 1e-3, "a hundredth of the current, a hundredth of the margin");
    CHECK(firm > 1e-9 && stable, "stable by %.1e", firm);
    CHECK(weak > 0 && weak < 1e-9 && !barely, "by %.1e it is not told to be stable", weak);
}

// ---- Gradients -----------------------------------------------------------------------------------------------------

enum { QUANTITIES = 5 };
static const char *const quantity[QUANTITIES] = {"course speed", "power", "peak effort", "steering", "peak load"};

static void read_quantities(const sample *s, const moray_orbit_result *found, double *q)
{
    q[0] = moray_course_speed(&found->steady, s->course);
    q[1] = found->steady.power;
    q[2] = found->steady.peak_effort;
    q[4] = found->peak_load;
    q[3] = s->steered ? found->gait.offset : found->steady.heading_drift * 2 * M_PI / found->gait.omega;
}

// Fourth-order differences; `to` steps of the parameter, of its own size.
static void orbit_differences(rig *r, const sample *s, int parameter, double *slope)
{
    static const double steps[] = {1, -1, 2, -2};
    double q[4][QUANTITIES] = {{0}}, h = 0;
    for (int k = 0; k < 4; k++) {
        moray_gait gait = r->found.gait;
        double *const all[] = {&gait.amplitude, &gait.omega, &gait.delta, &gait.offset, &gait.taper};
        h = 1e-4 * (parameter == 3 ? gait.amplitude : parameter == 4 ? 1 : *all[parameter]);
        *all[parameter] += steps[k] * h;
        moray_orbit_result found;
        CHECK_OK(moray_orbit_solve(r->orbit, &gait, &found), "solved again");
        read_quantities(s, &found, q[k]);
    }
    for (int i = 0; i < QUANTITIES; i++)
        slope[i] = (8 * (q[0][i] - q[1][i]) - (q[2][i] - q[3][i])) / (12 * h);
}

static void test_gradients(const sample *s, moray_model model)
{
    static const char *const parameters[] = {"amplitude", "omega", "delta", "offset", "taper"};
    rig r = rig_of(s, model);
    moray_orbit_gradient gradient;
    CHECK_OK(moray_orbit_gradients(r.orbit, &gradient), "gradients");
    const double *const given[QUANTITIES] = {gradient.course_speed, gradient.power, gradient.peak_effort,
                                             gradient.steering, gradient.peak_load};
    const bool loaded = s->motors && model == MORAY_FIRST_PRINCIPLES;
    CHECK((r.found.peak_load > 0) == loaded, "motors: the largest share of what they give is %g", r.found.peak_load);
    for (int p = 0; p < 5; p++) {
        double slope[QUANTITIES];
        if (p == 3 && s->steered) {
            CHECK(given[0][p] == 0 && given[1][p] == 0 && given[2][p] == 0 && given[3][p] == 0,
                  "an offset that is found is no parameter");
            continue;
        }
        orbit_differences(&r, s, p, slope);
        for (int q = 0; q < QUANTITIES; q++)
            CHECK(fabs(given[q][p] - slope[q]) <= 1e-6 * (1 + fabs(slope[q])), "d %s / d %s = %.9g, differences %.9g",
                  quantity[q], parameters[p], given[q][p], slope[q]);
    }
    rig_free(&r);
}

int main(void)
{
    for (int model = 0; model < 2; model++)
        for (int k = 0; k < SAMPLES; k++) {
            test_floquet(&samples[k], (moray_model)model);
            test_gradients(&samples[k], (moray_model)model);
        }
    test_stability();
    test_weak_current();
    return tap_done();
}
