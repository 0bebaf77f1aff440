// SPDX-License-Identifier: MIT
//
// Trials and ladders as they are told: summaries read back, tables label by label, the ladder's figure as gnuplot, a
// script of ours that keeps what it is told, has it.
#include "degree.h"

#include "moray/snake/budget.h"
#include "moray/snake/ladder.h"
#include "moray/snake/trial.h"

#include "results/folder.h"

static moray_json_file *read_back(moray_json *json)
{
    moray_json_file *file = NULL;
    FILE *out = fopen(in_root("told.json"), "w");
    CHECK_OK(moray_json_write(json, out), "written");
    fclose(out);
    CHECK_OK(moray_json_read(&file, in_root("told.json")), "read");
    moray_json_free(json);
    return file;
}

typedef struct {
    const char *place;
    double value; // NaN: none
} number;

static void check_numbers(const moray_json_file *file, const number *want, int n)
{
    for (int k = 0; k < n; k++) {
        const double got = moray_json_number_at(file, want[k].place);
        CHECK(isnan(want[k].value) ? isnan(got) : fabs(got - want[k].value) <= 1e-12 * fabs(want[k].value),
              "%s: %.15g, expected %.15g", want[k].place, got, want[k].value);
    }
}
#define CHECK_NUMBERS(file, ...)                                                                                       \
    check_numbers((file), (const number[]){__VA_ARGS__}, sizeof((const number[]){__VA_ARGS__}) / sizeof(number))

// ---- Trials --------------------------------------------------------------------------------------------------------

static moray_robot robot_of(double constant, double battery)
{
    moray_robot robot = moray_robot_paper();
    robot.supply.constant = constant;
    robot.supply.battery = battery;
    return robot;
}

static moray_gait_trial trial_of(double factor)
{
    const moray_steady one = {.speed = 0.25,
                              .v_x = 0.3 * factor,
                              .v_y = 0.1 * factor,
                              .power = 1.5 * factor,
                              .cost_of_transport = 6,
                              .peak_effort = 0.4 * factor,
                              .peak_link_angle = 25 * factor * DEG};
    moray_gait_trial trial = {.held = {true, true}, .steady = {one, one}};
    trial.steady[MORAY_CONTROL_ORIENTED].power = 2.5 * factor;
    trial.gait[MORAY_CONTROL_ORIENTED] =
        (moray_gait){.amplitude = 0.05, .omega = 110 * DEG, .delta = 35 * DEG, .offset = -0.012, .taper = 2e-5};
    trial.gait[MORAY_FIRST_PRINCIPLES] =
        (moray_gait){.amplitude = 13 * DEG, .omega = 120 * DEG, .delta = 40 * DEG, .offset = 1e-8, .taper = 2e-5};
    return trial;
}

static void test_gait_summary(void)
{
    const moray_robot robot = robot_of(0, 0);
    const moray_gait_trial trial = trial_of(1);
    moray_json *json = moray_json_new();
    moray_gait_to_json(json, "gait", &robot, trial.gait);
    moray_json_file *file = read_back(json);
    CHECK_NUMBERS(file, {"gait.a_m", 0.05}, {"gait.alpha_deg", 13},
                  {"gait.theta_max_deg", asin(0.05 / (0.14 * cos(17.5 * DEG))) / DEG}, {"gait.omega_deg_s", 110},
                  {"gait.delta_deg", 35}, {"gait.phi0_m", -0.012}, {"gait.phi0_deg", 1e-8 / DEG}, {"gait.taper", 2e-5});
    moray_json_file_free(file);
}

static void test_steady_summary(void)
{
    moray_robot robot = robot_of(0.5, 30);
    moray_gait_trial trial = trial_of(1);
    moray_json *json = moray_json_new();
    const double course = 0.4, along = 0.3 * cos(course) + 0.1 * sin(course);
    trial.held[MORAY_CONTROL_ORIENTED] = false;
    trial.why[MORAY_CONTROL_ORIENTED] = moray_error(MORAY_NOT_SOLVED, "it drifts");
    robot.motor.fitted = true;
    moray_steady_to_json(json, "fp", &robot, MORAY_FIRST_PRINCIPLES, &trial, course);
    moray_steady_to_json(json, "control", &robot, MORAY_CONTROL_ORIENTED, &trial, course);
    robot = robot_of(0, 0);
    moray_steady_to_json(json, "bare", &robot, MORAY_FIRST_PRINCIPLES, &trial, course);
    moray_json_file *file = read_back(json);
    CHECK_NUMBERS(file, {"fp.speed_m_s", 0.25}, {"fp.course_speed_m_s", along}, {"fp.power_W", 1.5},
                  {"fp.cost_of_transport_J_m", 6}, {"fp.course_cost_J_m", 1.5 / along}, {"fp.peak_torque_N_m", 0.4},
                  {"fp.peak_force_N", NAN}, {"fp.max_link_angle_deg", 25}, {"fp.whole.joints_or_motors_W", 1.5},
                  {"fp.whole.constant_W", 0.5}, {"fp.whole.power_W", 2}, {"fp.whole.cost_of_transport_J_m", 8},
                  {"fp.whole.course_cost_J_m", 2 / along}, {"fp.whole.endurance_h", 15},
                  {"fp.whole.range_m", 15 * 3600 * along});
    CHECK_NUMBERS(file, {"control.course_speed_m_s", NAN}, {"control.power_W", 2.5}, {"control.course_cost_J_m", NAN},
                  {"control.peak_force_N", 0.4}, {"control.peak_torque_N_m", NAN}, {"control.whole.power_W", 3},
                  {"control.whole.range_m", NAN}, {"bare.power_W", 1.5});
    CHECK(strcmp(moray_json_text_at(file, "fp.model"), "fp") == 0 &&
              strcmp(moray_json_text_at(file, "control.model"), "control") == 0,
          "models");
    CHECK(strcmp(moray_json_text_at(file, "fp.power_is"), "mean power at the motors") == 0 &&
              strcmp(moray_json_text_at(file, "control.power_is"), "mean joint power") == 0 &&
              !moray_json_text_at(file, "bare.power_is"),
          "where power is counted, with motors");
    CHECK(!moray_json_text_at(file, "fp.course_not_held") &&
              strcmp(moray_json_text_at(file, "control.course_not_held"), "it drifts") == 0,
          "why no course is held");
    CHECK(moray_json_count_at(file, "bare.whole") == -1, "no budget where there is none to tell");
    moray_json_file_free(file);
}

typedef struct {
    const char *label, *unit;
    double first, second;
} line;

static void check_rows(const moray_table_row *rows, int n, const line *want, int wanted)
{
    CHECK(n == wanted, "%d rows, expected %d", n, wanted);
    for (int k = 0; k < n && k < wanted; k++) {
        const double of[] = {want[k].first, want[k].second};
        CHECK(strcmp(rows[k].label, want[k].label) == 0 && strcmp(rows[k].unit, want[k].unit) == 0, "%s [%s]: %s [%s]",
              want[k].label, want[k].unit, rows[k].label, rows[k].unit);
        for (int j = 0; j < 2; j++)
            CHECK(isnan(of[j]) ? isnan(rows[k].value[j]) : fabs(rows[k].value[j] - of[j]) <= 1e-12 * fabs(of[j]),
                  "%s, %d: %.15g, expected %.15g", want[k].label, j, rows[k].value[j], of[j]);
    }
}
#define CHECK_ROWS(rows, n, ...)                                                                                       \
    check_rows((rows), (n), (const line[]){__VA_ARGS__}, sizeof((const line[]){__VA_ARGS__}) / sizeof(line))

// A taper of 1e-6 counts, an offset of 1e-9 too; less is rounding.
static void test_gait_rows(void)
{
    const moray_robot robot = robot_of(0, 0);
    moray_gait_trial one = trial_of(1), other = trial_of(1);
    const moray_gait_trial *const trials[] = {&one, &other};
    moray_table_row rows[MORAY_TRIAL_ROWS];
    other.gait[MORAY_CONTROL_ORIENTED].taper = 5e-7;
    other.gait[MORAY_FIRST_PRINCIPLES].offset = -5e-10;
    other.gait[MORAY_CONTROL_ORIENTED].offset = 1e-9;
    const double theta = asin(0.05 / (0.14 * cos(17.5 * DEG))) / DEG;
    const moray_gait *gait = &one.gait[MORAY_FIRST_PRINCIPLES];
    const double head = moray_theta_max_of_link(&robot, MORAY_FIRST_PRINCIPLES, gait, 10) / DEG,
                 tail = moray_theta_max_of_link(&robot, MORAY_FIRST_PRINCIPLES, gait, 1) / DEG;
    CHECK_ROWS(rows, moray_gait_rows(&robot, trials, 2, rows), {"theta_max, amplitude of (24)", "deg", theta, theta},
               {"omega, frequency", "deg/s", 110, 110}, {"delta, phase shift", "deg", 35, 35},
               {"a, by (33)", "cm", 5, 5}, {"alpha, by (27)", "deg", 13, 13},
               {"phi_0, control-oriented", "cm", -1.2, 100 * 1e-9}, {"phi_0, first-principles", "deg", 1e-8 / DEG, 0},
               {"taper of the amplitude", "", 2e-5, 0}, {"theta_max of the head, by (27)", "deg", head, head},
               {"theta_max of the tail, by (27)", "deg", tail, tail});
    one.gait[MORAY_CONTROL_ORIENTED].taper = 0;
    CHECK(moray_gait_rows(&robot, trials, 2, rows) == 7, "no taper, no rows of it");
    one.gait[MORAY_CONTROL_ORIENTED].taper = 1e-6;
    one.gait[MORAY_FIRST_PRINCIPLES].offset = -1e-9;
    CHECK(moray_gait_rows(&robot, trials, 2, rows) == 10 && rows[7].value[0] == 1e-6 && rows[6].value[0] == -1e-9 / DEG,
          "the least taper and offset that are told: %g, %g", rows[7].value[0], rows[6].value[0]);
}

static void test_steady_rows(void)
{
    moray_robot robot = robot_of(0, 0);
    const moray_gait_trial one = trial_of(1), other = trial_of(2);
    const moray_gait_trial *const trials[] = {&one, &other};
    moray_table_row rows[MORAY_TRIAL_ROWS];
    CHECK_ROWS(rows, moray_steady_rows(&robot, MORAY_CONTROL_ORIENTED, trials, 2, 0, rows),
               {"speed through the water", "m/s", 0.25, 0.25}, {"speed along the course", "m/s", 0.3, 0.6},
               {"mean joint power", "W", 2.5, 5}, {"cost of transport", "J/m", 6, 6},
               {"peak joint force", "N", 0.4, 0.8}, {"largest link angle from heading", "deg", 25, 50},
               {"joint work along the course", "J/m", 2.5 / 0.3, 5 / 0.6});
    robot.supply.constant = 0.5;
    int n = moray_steady_rows(&robot, MORAY_FIRST_PRINCIPLES, trials, 2, 0, rows);
    CHECK(strcmp(rows[4].label, "peak joint torque") == 0 && strcmp(rows[4].unit, "N m") == 0, "torques");
    CHECK_ROWS(rows + 7, n - 7, {"whole power, with electronics and hotel load", "W", 2, 3.5},
               {"whole work along the course", "J/m", 2 / 0.3, 3.5 / 0.6});
    robot.supply.battery = 7;
    n = moray_steady_rows(&robot, MORAY_FIRST_PRINCIPLES, trials, 2, 0, rows);
    CHECK_ROWS(rows + 7, n - 7, {"whole power, with electronics and hotel load", "W", 2, 3.5},
               {"whole work along the course", "J/m", 2 / 0.3, 3.5 / 0.6}, {"endurance of the battery", "h", 3.5, 2},
               {"range along the course", "km", 3.5 * 3.6 * 0.3, 2 * 3.6 * 0.6});
}

// ---- Ladders -------------------------------------------------------------------------------------------------------

// With one more behind the last, which nobody looks at.
enum { ROOM = MORAY_RUNGS + 1 };
static void make_ladder(moray_ladder_row row[ROOM], double sign, const char *const *models)
{
    for (int k = 0; k < MORAY_RUNGS; k++)
        row[k] = (moray_ladder_row){models[k], sign * (1 + k), 0.2 + 0.01 * k, 1 + 0.1 * k, (100 + k) * DEG, {0}};
    row[MORAY_RUNGS] =
        (moray_ladder_row){"beyond", NAN, NAN, NAN, NAN, moray_error(MORAY_NOT_SOLVED, "there is no such rung")};
    row[4] = (moray_ladder_row){models[4], NAN, NAN, NAN, NAN, moray_error(MORAY_NOT_SOLVED, "no way")};
}

static const char *const models[MORAY_RUNGS] = {"a", "b", "c", "d", "e", "f", "g", "h",
                                                "i", "j", "k", "l", "m", "n", "o"},
                         *const others[MORAY_RUNGS] = {"A", "B", "C", "D", "E", "F", "G", "H",
                                                       "I", "J", "K", "L", "M", "N", "O"};

static void test_ladder_summary(void)
{
    moray_ladder_row row[ROOM];
    moray_json *json = moray_json_new();
    make_ladder(row, -1, models);
    moray_ladder_to_json(json, row);
    moray_json_number(json, "behind", 7);
    moray_json_file *file = read_back(json);
    CHECK(moray_json_count_at(file, "ladder") == MORAY_RUNGS && moray_json_number_at(file, "behind") == 7,
          "every rung, and what comes behind them");
    for (int k = 0; k < MORAY_RUNGS; k++) {
        static const char *const keys[] = {"gain_percent_at_equal_power", "speed_m_s", "power_W", "omega_deg_s"};
        const double want[] = {row[k].gain_percent, row[k].speed, row[k].power, row[k].omega / DEG};
        char place[80];
        for (int j = 0; j < 4; j++) {
            snprintf(place, sizeof place, "ladder.%d.%s", k, keys[j]);
            check_numbers(file, &(number){place, want[j]}, 1);
        }
        snprintf(place, sizeof place, "ladder.%d.model", k);
        CHECK(strcmp(moray_json_text_at(file, place), models[k]) == 0, "%s", place);
        snprintf(place, sizeof place, "ladder.%d.left_out", k);
        const char *why = moray_json_text_at(file, place);
        CHECK(k == 4 ? why && strcmp(why, "no way") == 0 : !why, "%s", place);
    }
    moray_json_file_free(file);
}

static void test_counts(void)
{
    moray_ladder_row row[ROOM];
    make_ladder(row, 1, models);
    row[2].gain_percent = 0.05; // no win yet
    row[3].gain_percent = -6;
    moray_ladder_count count = moray_ladder_counted(row, 1 | 1 << 3 | 1 << 6);
    CHECK(count.n == 14 && count.wins == 12 && count.wins_elsewhere == 10 && !count.complete, "%d, %d wins, %d others",
          count.n, count.wins, count.wins_elsewhere);
    CHECK(count.least == -6 && count.most == 15, "from %g to %g", count.least, count.most);
    row[4].gain_percent = 0.051;
    count = moray_ladder_counted(row, 0);
    CHECK(count.n == 15 && count.wins == 13 && count.wins_elsewhere == 13 && count.complete, "all: %d", count.wins);
    char text[300] = "";
    for (int k = 0; k < MORAY_RUNGS; k++) {
        row[k].gain_percent = NAN;
        row[k].why = moray_error(MORAY_NOT_SOLVED, "reason %d", k);
    }
    moray_ladder_verdict(row, 0, text, sizeof text);
    CHECK(strcmp(text, "is compared on none of 15: reason 0") == 0, "%s", text);
    text[0] = 0;
    make_ladder(row, -1, models);
    row[4].gain_percent = -0.006;
    moray_ladder_verdict(row, 0, text, sizeof text);
    CHECK(strcmp(text, "wins on 0 of 15, from -15.00 to -0.01 %") == 0, "%s", text);
    text[0] = 0;
    row[4].gain_percent = 0.005;
    moray_ladder_verdict(row, 0, text, sizeof text);
    CHECK(strcmp(text, "wins on 0 of 15, from -15.00 to +0.01 %") == 0, "%s", text);
}

static void test_ladder_rows(void)
{
    moray_ladder_row one[ROOM], other[ROOM];
    const moray_ladder_row *const ladders[] = {one, other, one};
    moray_table_row rows[ROOM] = {[MORAY_RUNGS] = {.label = "behind"}};
    make_ladder(one, 1, models);
    make_ladder(other, -2, others);
    one[6].gain_percent = 0.005;
    other[7].gain_percent = -0.0049;
    CHECK(moray_ladder_rows(ladders, 2, rows) == MORAY_RUNGS && strcmp(rows[MORAY_RUNGS].label, "behind") == 0,
          "a row of every rung");
    for (int k = 0; k < MORAY_RUNGS; k++)
        CHECK(strcmp(rows[k].label, models[k]) == 0 && rows[k].value[2] == 0 &&
                  (k == 4 ? isnan(rows[k].value[0]) : rows[k].value[0] == one[k].gain_percent) &&
                  (k == 4   ? isnan(rows[k].value[1])
                   : k == 7 ? rows[k].value[1] == 0
                            : rows[k].value[1] == other[k].gain_percent),
              "%s: %g, %g %%", rows[k].label, rows[k].value[0], rows[k].value[1]);
    CHECK(moray_ladder_rows(NULL, 0, rows) == MORAY_RUNGS && !rows[3].label, "of no gait");
}

// ---- The figure ----------------------------------------------------------------------------------------------------

static void check_points(const char *told, int curve, const moray_ladder_row *row)
{
    char name[40];
    int n = 0;
    snprintf(name, sizeof name, "$curve%d << EOD\n", curve);
    const char *at = strstr(told, name);
    for (at = at ? at + strlen(name) : "EOD"; strncmp(at, "EOD", 3) != 0; at = strchr(at, '\n') + 1) {
        double x, y;
        if (sscanf(at, "%lf %lf", &x, &y) != 2 || *at == '\n' || isnan(x))
            continue;
        CHECK(y >= 0 && y < MORAY_RUNGS && fabs(x - row[(int)y].gain_percent) < 1e-9, "rung %g: %g %%", y, x);
        n++;
    }
    CHECK(n == 14, "%d points", n);
}

// The last colour before the name.
static void copy_hue(const char *told, const char *name, char hue[8])
{
    static const char *const mark = "lc rgb '";
    hue[0] = 0;
    for (; *told && strncmp(told, name, strlen(name)) != 0; told++)
        if (strncmp(told, mark, strlen(mark)) == 0)
            snprintf(hue, 8, "%.7s", told + strlen(mark));
}

static moray_status draw(const moray_ladder_row *const *ladders, const char *const *names, const moray_colour *colours,
                         int n)
{
    moray_output *output = open_in("ladder");
    unlink(in_root("told"));
    const moray_status status = moray_ladder_draw(output, ladders, names, colours, n);
    moray_output_free(output);
    return status;
}

static void test_figure(void)
{
    moray_ladder_row one[ROOM], other[ROOM];
    const moray_ladder_row *const ladders[9] = {one, other, one, one, one, one, one, one, one};
    const char *const names[9] = {"first gait", "second gait", "c", "d", "e", "f", "g", "h", "i"};
    const moray_colour colours[] = {MORAY_COLOUR_BEST, MORAY_COLOUR_BASELINE};
    make_ladder(one, 1, models);
    make_ladder(other, -2, others);
    CHECK_OK(draw(ladders, names, NULL, 2), "figure");
    char *told = content("told");
    check_points(told, 0, one);
    check_points(told, 1, other);
    const char *const first = strstr(told, "first gait"), *const second = strstr(told, "second gait");
    CHECK(first && second && first < second, "each by its name");
    CHECK(strstr(told, "set ytics ('a' 0, 'b' 1, 'c' 2") || strstr(told, "set ytics (\"a\" 0, \"b\" 1, \"c\" 2"),
          "rungs by the first one's names");
    const moray_colour turned[] = {colours[1], colours[0]};
    char hue[2][2][8];
    for (int k = 0; k < 2; k++) {
        CHECK_OK(draw(ladders, names, k ? turned : colours, 2), "in colours");
        char *coloured = content("told");
        for (int g = 0; g < 2; g++)
            copy_hue(coloured, names[g], hue[k][g]);
        free(coloured);
    }
    CHECK(strcmp(hue[0][0], hue[0][1]) != 0 && strcmp(hue[0][0], hue[1][1]) == 0 && strcmp(hue[0][1], hue[1][0]) == 0,
          "each in its own: %s, %s; %s, %s", hue[0][0], hue[0][1], hue[1][0], hue[1][1]);
    free(told);
    CHECK_OK(draw(ladders, names, NULL, MORAY_LADDER_DRAWN), "as many as there may be");
    const moray_status status = draw(ladders, names, NULL, MORAY_LADDER_DRAWN + 1);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "a figure of 9 gaits on the ladder: at most 8") == 0, "%s",
          status.text);
    for (int k = 0; k < MORAY_RUNGS; k++)
        one[k].gain_percent = other[k].gain_percent = NAN;
    CHECK_OK(draw(ladders, names, NULL, 2), "nothing to draw");
    CHECK(holds("told", ""), "is not drawn");
    other[MORAY_RUNGS - 1].gain_percent = 3;
    CHECK_OK(draw(ladders, names, NULL, 2), "one number");
    CHECK(!holds("told", ""), "is");
}

int main(void)
{
    if (!enter())
        return 1;
    test_gait_summary();
    test_steady_summary();
    test_gait_rows();
    test_steady_rows();
    test_ladder_summary();
    test_counts();
    test_ladder_rows();
    stand_in();
    test_figure();
    leave();
    return tap_done();
}
