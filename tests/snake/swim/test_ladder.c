// SPDX-License-Identifier: MIT
//
// The ladder: rungs against robots made by hand, gains against simulations from rest, processes against none, verdicts
// by cases.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/ladder.h"
#include "moray/snake/options.h"
#include "moray/snake/trial.h"

// The robot that the command line gives with these keys of [robot].
static moray_robot set(char **argv, int argc)
{
    struct {
        moray_common common;
        moray_snake_options snake;
    } settings = {moray_common_default(), moray_snake_options_default()};
    const moray_option_group group = {&moray_snake_option_table, sizeof(moray_common)};
    const moray_program program = {.name = "test", .groups = &group, .n_groups = 1};
    moray_request request;
    CHECK_OK(moray_app_parse(&program, argc, argv, &settings, &request), argv[argc - 1]);
    return settings.snake.robot;
}

static bool same_robot(const moray_robot *a, const moray_robot *b)
{
    const moray_hydrodynamics *h = &a->hydro, *g = &b->hydro;
    return a->links == b->links && a->l == b->l && a->m == b->m && a->J == b->J && a->c_t == b->c_t &&
           a->c_n == b->c_n && a->mu_n == b->mu_n && a->lambda_1 == b->lambda_1 && a->lambda_2 == b->lambda_2 &&
           a->lambda_3 == b->lambda_3 && h->rotation == g->rotation && h->drag == g->drag &&
           h->added_mass == g->added_mass && h->frame == g->frame && h->pieces == g->pieces;
}

static void check_rungs(void)
{
    static const char *const models[][2] = {{"paper", "pieces=1"},
                                            {"split2", "pieces=2"},
                                            {"split3", "pieces=3"},
                                            {"split5", "pieces=5"},
                                            {"strip", "rotation=strip"},
                                            {"quadratic", "drag=quadratic"},
                                            {"consistent", "hydrodynamics=consistent"}};
    static const char *const changes[][4] = {{"c_n"}, {"c_t"}, {"mu_n"}, {"lambda_1", "lambda_2", "lambda_3"}};
    const moray_robot paper = moray_robot_paper();
    const double values[][3] = {
        {paper.c_n}, {paper.c_t}, {paper.mu_n}, {paper.lambda_1, paper.lambda_2, paper.lambda_3}};
    moray_rung rung[MORAY_RUNGS];
    moray_ladder(&paper, rung);
    for (int k = 0; k < 7; k++) {
        char text[64], *argv[] = {"test", "--set", text};
        snprintf(text, sizeof text, "%s", models[k][1]);
        const moray_robot by_hand = set(argv, 3);
        CHECK(strcmp(rung[k].name, models[k][0]) == 0 && same_robot(&rung[k].robot, &by_hand), "%s is --set %s",
              rung[k].name, text);
        CHECK(moray_rung_of(&by_hand) == 1u << k, "and known again");
    }
    for (int c = 0; c < 4; c++)
        for (int less = 0; less < 2; less++) {
            const int k = 7 + 2 * c + less;
            char text[3][64], *argv[] = {"test", "--set", text[0], "--set", text[1], "--set", text[2]};
            int n = 0;
            for (; n < 3 && changes[c][n]; n++)
                snprintf(text[n], sizeof *text, "%s=%.17g", changes[c][n], values[c][n] * (less ? 0.8 : 1.2));
            const moray_robot by_hand = set(argv, 1 + 2 * n);
            CHECK(same_robot(&rung[k].robot, &by_hand) && moray_rung_named(rung[k].name) == k, "%s is --set %s",
                  rung[k].name, text[0]);
        }
    CHECK(moray_rung_named("strips") == -1, "no such rung");
}

static moray_gait gait_of(const moray_robot *robot, double theta_max, double omega, double delta)
{
    return (moray_gait){.amplitude =
                            moray_amplitude_from_theta_max(robot, MORAY_FIRST_PRINCIPLES, theta_max * DEG, delta * DEG),
                        .omega = omega * DEG,
                        .delta = delta * DEG};
}

static moray_ladder_spec spec_of(const moray_robot *robot, const moray_gait *gait, int gaits, int jobs)
{
    const moray_gait baseline = gait_of(robot, 20, 120, 40);
    return (moray_ladder_spec){.robot = *robot,
                               .baseline = baseline,
                               .gait = gait,
                               .gaits = gaits,
                               .settings = moray_swim_settings_default(),
                               .jobs = jobs};
}

static bool same_rows(const moray_ladder_row *one, const moray_ladder_row *other, int n)
{
    for (int k = 0; k < n; k++)
        if (one[k].model != other[k].model || one[k].speed != other[k].speed || one[k].power != other[k].power ||
            one[k].gain_percent != other[k].gain_percent || one[k].omega != other[k].omega)
            return false;
    return true;
}

// Paper-notes, section 6: its table to 0.1 points.
static void check_notes(void)
{
    static const struct {
        double theta_max, omega, delta, gain[5]; // paper, split2, split3, split5
    } notes[] = {{20, 153.7, 51.33, {4.03, 1.09, 0.62, 0.39}},
                 {20, 240, 86.6, {3.25, -14.9, -17.1, -18.1}},
                 {31.35, 110, 50.65, {10.99, 1.83, 0.52, -0.12}},
                 {20, 104.3, 34.93, {-5.07, -4.24, -4.10, -4.03}}};
    enum { gaits = 4 };
    const moray_robot robot = moray_robot_paper();
    moray_gait gait[gaits];
    static moray_ladder_row alone[gaits * MORAY_RUNGS], row[gaits * MORAY_RUNGS];
    for (int g = 0; g < gaits; g++)
        gait[g] = gait_of(&robot, notes[g].theta_max, notes[g].omega, notes[g].delta);
    moray_ladder_spec spec = spec_of(&robot, gait, gaits, 1);
    CHECK_OK(moray_ladder_climb(&spec, alone), "by one process");
    spec.jobs = 3;
    CHECK_OK(moray_ladder_climb(&spec, row), "by three");
    CHECK(same_rows(alone, row, gaits * MORAY_RUNGS), "bit for bit the same");
    for (int g = 0; g < gaits; g++)
        for (int k = 0; k < 4; k++)
            CHECK_NEAR(row[g * MORAY_RUNGS + k].gain_percent, notes[g].gain[k], 0.1, row[k].model);
    moray_test_rig rig;
    moray_steady steady;
    moray_rung rung[MORAY_RUNGS];
    moray_ladder(&robot, rung);
    const int consistent = moray_rung_named("consistent");
    CHECK_OK(moray_test_rig_new(&rig, &rung[consistent].robot, (double[]){0, 0}, 0), "rig");
    const moray_swim_setup setup = moray_test_rig_setup(&rig, MORAY_FIRST_PRINCIPLES);
    CHECK_OK(moray_swim_match_power(&setup, &gait[0], 0, row[consistent].power, &steady), "from rest");
    CHECK_NEAR(row[consistent].speed, steady.speed, 1e-6, "speed on the consistent rung, from rest");
    moray_test_rig_free(&rig);
}

// A current that the baseline cannot stem leaves every rung out, with its reason.
static void check_left_out(void)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait gait = gait_of(&robot, 20, 150, 50);
    moray_ladder_spec spec = spec_of(&robot, &gait, 1, 0);
    moray_ladder_row row[MORAY_RUNGS];
    char text[500] = "It ";
    spec.current[1] = 0.5;
    CHECK_OK(moray_ladder_climb(&spec, row), "no error");
    CHECK(isnan(row[0].gain_percent) && moray_failed(row[0].why), "left out: %s", row[0].why.text);
    moray_ladder_verdict(row, 1, text, sizeof text);
    CHECK(strncmp(text, "It is compared on none of 15: the baseline: ", 44) == 0, "%s", text);
}

static void verdict_of(double first, double others, int without, unsigned found_on, const char *expected)
{
    moray_ladder_row row[MORAY_RUNGS];
    char text[500] = "";
    for (int k = 0; k < MORAY_RUNGS; k++)
        row[k] = (moray_ladder_row){.model = "rung", .gain_percent = k == 0 ? first : others};
    if (without >= 0) {
        row[without].gain_percent = NAN;
        row[without].why = moray_error(MORAY_NOT_SOLVED, "why");
    }
    moray_ladder_verdict(row, found_on, text, sizeof text);
    CHECK(strcmp(text, expected) == 0, "%s", text);
}

// Gains to either side of nothing, with what rounds to it; two ladders beside each other.
static void check_table(void)
{
    static const double gain[] = {-3, 0.0049, -0.0049, 0.0051, -0.0051, 2}, shown[] = {-3, 0, 0, 0.0051, -0.0051, 2};
    moray_ladder_row one[MORAY_RUNGS], other[MORAY_RUNGS];
    const moray_ladder_row *const ladders[] = {one, other};
    moray_table_row rows[MORAY_RUNGS];
    for (int k = 0; k < MORAY_RUNGS; k++) {
        one[k] = (moray_ladder_row){.model = k % 2 ? "odd" : "even", .gain_percent = gain[k % 6]};
        other[k] = (moray_ladder_row){.model = "other", .gain_percent = k == 1 ? NAN : -7.0 - k};
    }
    CHECK(moray_ladder_rows(ladders, 2, rows) == MORAY_RUNGS, "a row each");
    for (int k = 0; k < MORAY_RUNGS; k++) {
        CHECK(strcmp(rows[k].label, k % 2 ? "odd" : "even") == 0 && strcmp(rows[k].unit, "%") == 0, "label");
        CHECK(rows[k].value[0] == shown[k % 6], "gain %g: %g", one[k].gain_percent, rows[k].value[0]);
        CHECK(k == 1 ? isnan(rows[k].value[1]) : rows[k].value[1] == -7 - k, "the other's");
    }
}

int main(void)
{
    check_rungs();
    check_notes();
    check_left_out();
    check_table();
    verdict_of(4.03, 1.3, -1, 1, "wins on all 15, from +1.30 to +4.03 %");
    verdict_of(4.03, -1.3, -1, 1, "wins only on the model it was found on, 1 of 15, from -1.30 to +4.03 %");
    verdict_of(4.03, -1.3, -1, 3, "wins only on the models it was found on, 1 of 15, from -1.30 to +4.03 %");
    verdict_of(4.03, -1.3, -1, 1 | MORAY_RUNG_CHANGES,
               "wins only on the model it was found on, 1 of 15, from -1.30 to +4.03 %");
    verdict_of(4.03, -1.3, -1, 2, "wins on 1 of 15, from -1.30 to +4.03 %");
    verdict_of(-0.001, -1.3, -1, 1, "wins on 0 of 15, from -1.30 to 0.00 %");
    verdict_of(-1, 2, 3, 0, "wins on 13 of 14, from -1.00 to +2.00 %; left out: rung (why)");
    return tap_done();
}
