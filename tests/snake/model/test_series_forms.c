// SPDX-License-Identifier: MIT
//
// Series from gaits, their bases against differences, series of one joint and of no motion, and what of a swimmer is
// refused or told.
#include <string.h>

#include "moray/snake/motor.h"
#include "random_robot.h"
#include "snake/model/fp_robot.h"
#include "snake/model/series.h"

enum { JOINTS = 3, MOST = JOINTS * 9 };

// Of fewer, as many and more harmonics than the gait's own series: what it is at any time, as far as they reach.
static void test_of_gait(void)
{
    random_seed seed = 2;
    double own[JOINTS * 5], at[MOST];
    random_vector(&seed, 0.3, JOINTS * 5, own);
    const moray_series series = {JOINTS, 2, own};
    const moray_gait gait = {
        .amplitude = 0.4, .omega = 2, .delta = 0.7, .offset = -0.05, .taper = 0.3, .series = &series};
    for (int with = 0; with < 2; with++)
        for (int harmonics = 1; harmonics <= 4; harmonics++) {
            moray_gait of = gait;
            double worst = 0;
            of.series = with ? &series : NULL;
            at[JOINTS * (1 + 2 * harmonics) - 1] = NAN;
            moray_series_of_gait(&of, JOINTS, harmonics, at);
            for (int i = 0; i < JOINTS; i++) {
                const double a = 0.4 * (1 + 0.3 * (i - 1));
                worst = tap_worse(worst, fabs(at[i] - (with ? own[i] : 0) + 0.05));
                for (int k = 1; k <= harmonics; k++) {
                    const bool has = with && k <= 2;
                    const int p = JOINTS * (2 * k - 1) + i, q = p + JOINTS;
                    worst = tap_worse(worst, fabs(at[p] - (has ? own[p] : 0) - (k == 1 ? a * cos(0.7 * i) : 0)));
                    worst = tap_worse(worst, fabs(at[q] - (has ? own[q] : 0) - (k == 1 ? a * sin(0.7 * i) : 0)));
                }
            }
            CHECK(worst < 1e-15, "%d harmonics of a gait %s a series: %.1e", harmonics, with ? "with" : "without",
                  worst);
        }
}

// One joint's p sin(k omega t) + q cos(k omega t), its rate or its acceleration.
static double wave(int k, int rank, double omega, double t, double p, double q)
{
    const double r = k * omega, s = sin(r * t), c = cos(r * t);
    return rank == 0 ? p * s + q * c : rank == 1 ? r * (p * c - q * s) : -r * r * (p * s + q * c);
}

// Derivatives by omega and t, at p or at q alone, as central differences have them.
static void test_basis(void)
{
    const double omega = 1.7, t = 0.6, h = 1e-3;
    double worst = 0;
    for (int k = 1; k <= 3; k++) {
        series_pair basis[SERIES_RANKS][SERIES_DERIVATIVES];
        moray_series_basis(k, omega, t, basis);
        for (int rank = 0; rank < SERIES_RANKS; rank++)
            for (int of_q = 0; of_q < 2; of_q++) {
                double f[5][5];
                for (int i = -2; i <= 2; i++)
                    for (int j = -2; j <= 2; j++)
                        f[i + 2][j + 2] = wave(k, rank, omega + i * h, t + j * h, !of_q, of_q);
                const double by_omega = (8 * (f[3][2] - f[1][2]) - (f[4][2] - f[0][2])) / (12 * h);
                const double by_t = (8 * (f[2][3] - f[2][1]) - (f[2][4] - f[2][0])) / (12 * h);
                const double omega_omega =
                    (16 * (f[3][2] + f[1][2]) - (f[4][2] + f[0][2]) - 30 * f[2][2]) / (12 * h * h);
                const double t_t = (16 * (f[2][3] + f[2][1]) - (f[2][4] + f[2][0]) - 30 * f[2][2]) / (12 * h * h);
                const double omega_t =
                    (16 * (f[3][3] - f[3][1] - f[1][3] + f[1][1]) - (f[4][4] - f[4][0] - f[0][4] + f[0][0])) /
                    (48 * h * h);
                const struct {
                    int which;
                    double want;
                } all[] = {{SERIES_WAVE, f[2][2]},    {SERIES_OMEGA, by_omega},
                           {SERIES_T, by_t},          {SERIES_OMEGA_OMEGA, omega_omega},
                           {SERIES_OMEGA_T, omega_t}, {SERIES_T_T, t_t}};
                for (int d = 0; d < 6; d++) {
                    const series_pair got = basis[rank][all[d].which];
                    worst = tap_worse(worst, fabs((of_q ? got.q : got.p) - all[d].want) / (1 + fabs(all[d].want)));
                }
            }
    }
    CHECK(worst < 1e-7, "derivatives of waves: %.1e", worst);
}

// One joint has no neighbour and no motion no wave: mapped to the other model both are numbers.
static void test_mapped(void)
{
    const moray_robot robot = moray_robot_paper();
    double at[5] = {0.01, 0.02, 0.005, 0.001, 0.002}, out[JOINTS * 5];
    moray_series one = {1, 2, at};
    moray_series_to_first_principles(&robot, &one, out);
    for (int k = 0; k < 5; k++)
        CHECK(out[k] == 0, "of a joint alone the wave has no shift: %g", out[k]);
    const double nothing[JOINTS * 5] = {0};
    moray_series none = {JOINTS, 2, nothing};
    moray_series_to_first_principles(&robot, &none, out);
    for (int k = 0; k < JOINTS * 5; k++)
        CHECK(out[k] == 0, "no motion stays none: %g", out[k]);
}

// What a harmonic becomes depends on itself and on the mean amplitude of the first, of the joints that there are.
static void test_mapped_apart(void)
{
    enum { n = 4, all = n * 5 };
    const moray_robot robot = moray_robot_paper();
    double at[all], less[all], out[2][all];
    for (int k = 0; k < all; k++)
        at[k] = less[k] = 0.02 + 0.03 * cos(1 + 2.1 * k);
    for (int k = 3 * n; k < all; k++)
        less[k] = 0;
    const moray_series both = {n, 2, at}, first = {n, 2, less};
    moray_series_to_first_principles(&robot, &both, out[0]);
    moray_series_to_first_principles(&robot, &first, out[1]);
    for (int k = 0; k < 3 * n; k++)
        CHECK(out[0][k] == out[1][k] && out[0][k] != 0, "coefficient %d: %g", k, out[0][k]);
}

// ---- Swimmers ------------------------------------------------------------------------------------------------------

static void is(moray_status status, const char *text)
{
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "\"%s\", expected \"%s\"", status.text, text);
}

static void test_swimmers(void)
{
    random_seed seed = 3;
    moray_link link[4];
    const moray_robot unequal = random_unequal_robot(&seed, 4, link);
    moray_robot other = unequal;
    other.links = 3;
    for (int model = 0; model < 2; model++) {
        const bool first = model == MORAY_FIRST_PRINCIPLES;
        moray_swimmer *swimmer;
        double V[2];
        moray_robot robot = unequal;
        robot.link = first ? unequal.link : NULL;
        CHECK_OK(moray_swimmer_new(&swimmer, &robot, (moray_model)model), "swimmer");
        is(moray_swimmer_set_robot(swimmer, &other), "links = 3: the swimmer was made for 4");
        moray_swimmer_set_current(swimmer, 0.3, -0.1);
        moray_swimmer_current(swimmer, V);
        CHECK(V[0] == 0.3 && V[1] == -0.1, "current %g, %g", V[0], V[1]);
        for (int i = 0; i < 4; i++)
            CHECK(moray_swimmer_half_length(swimmer, i) == (first ? moray_robot_link(&robot, i).l : robot.l),
                  "half a link");
        is(moray_swimmer_set_torque(swimmer, -0.5), "torque = -0.5 N m: must be at least 0");
        is(moray_swimmer_set_torque(swimmer, NAN), "torque = nan N m: must be at least 0");
        CHECK_OK(moray_swimmer_set_torque(swimmer, 0), "no limit");
        if (first)
            CHECK_OK(moray_swimmer_set_torque(swimmer, 0.25), "a limit");
        else
            is(moray_swimmer_set_torque(swimmer, 0.25), "torque = 0.25 N m: the control-oriented model has no torques");
        CHECK(moray_swimmer_torque(swimmer) == (first ? 0.25 : 0), "which is told");
        CHECK(strcmp(moray_model_name((moray_model)model), first ? "first-principles" : "control-oriented") == 0,
              "by its name");
        moray_swimmer_free(swimmer);
    }
}

// What links have more or less than the mean of all adds up to nothing; an equal one has no more than it.
static void test_parts(void)
{
    random_seed seed = 6;
    moray_link link[4];
    fp_part part[4];
    const moray_robot unequal = random_unequal_robot(&seed, 4, link), equal = random_robot(&seed, 4);
    double uneven = 0, weight = 0, most = 0;
    moray_fp_robot_of(&unequal, part);
    for (int i = 0; i < 4; i++) {
        uneven += part[i].uneven;
        weight += part[i].weight;
        most = fmax(most, fabs(part[i].uneven));
    }
    CHECK(most > 0.01 && fabs(uneven) < 1e-14, "moments of inertia beside their mean: %.1e", uneven);
    CHECK_NEAR(weight, 4, 1e-14, "masses in means");
    moray_fp_robot_of(&equal, part);
    CHECK(part[0].uneven == 0 && part[0].weight == 1 && part[0].plain, "an equal link");
}

int main(void)
{
    test_of_gait();
    test_basis();
    test_mapped();
    test_mapped_apart();
    test_swimmers();
    test_parts();
    return tap_done();
}
