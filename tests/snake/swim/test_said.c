// SPDX-License-Identifier: MIT
//
// Robots and gaits as options and schedules say them: whole texts of what is refused, what a word leaves to keys, which
// robot is the paper's, and what is told of unequal links.
#include "arguments.h"
#include "degree.h"

#include "moray/snake/gait_input.h"
#include "moray/snake/options.h"

#include "results/folder.h"

typedef struct settings {
    moray_common common;
    moray_snake_options snake;
} settings;

static moray_status parse(settings *s, const char *const arguments[8])
{
    static const moray_option_group group = {&moray_snake_option_table, offsetof(settings, snake)};
    static const moray_program program = {.name = "test", .summary = "s", .groups = &group, .n_groups = 1};
    command_line line;
    moray_request request;
    command_set(&line, "test", arguments, 8);
    *s = (settings){.common = moray_common_default(), .snake = moray_snake_options_default()};
    return moray_app_parse(&program, line.argc, line.argv, s, &request);
}
#define PARSE(s, ...) parse((s), (const char *const[8]){__VA_ARGS__})

// ---- Gaits ---------------------------------------------------------------------------------------------------------

static void refuse_gait(const moray_gait_input *input, moray_model model, const char *says)
{
    const moray_robot robot = moray_robot_paper();
    moray_gait gait;
    const moray_status status = moray_gait_input_make(input, &robot, model, &gait);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
}

static void test_gaits(void)
{
    moray_gait_input input = moray_gait_input_default();
    input.phi0_m = 0.006;
    input.phi0 = 5 * DEG;
    refuse_gait(&input, MORAY_CONTROL_ORIENTED, "phi0_deg = 5 contradicts phi0_m = 0.006: give one of them");
    refuse_gait(&input, MORAY_FIRST_PRINCIPLES, "phi0_deg = 5 contradicts phi0_m = 0.006: give one of them");
    input.theta_max = 0;
    input.phi0_m = NAN;
    refuse_gait(&input, MORAY_CONTROL_ORIENTED,
                "phi0_deg = 5: is mapped in the ratio of the joint amplitudes, which this gait has not; give phi0_m");
    input.phi0_m = 0.006;
    input.phi0 = NAN;
    refuse_gait(&input, MORAY_FIRST_PRINCIPLES,
                "phi0_m = 0.006: is mapped in the ratio of the joint amplitudes, which this gait has not; give "
                "phi0_deg");
    input = moray_gait_input_default();
    input.alpha = 80 * DEG;
    refuse_gait(&input, MORAY_CONTROL_ORIENTED,
                "alpha_deg = 80: no link-angle amplitude below 90 deg belongs to it at delta_deg = 40, so it cannot be "
                "mapped to the control-oriented model");
    input.alpha = NAN;
    input.a = 0.2;
    refuse_gait(&input, MORAY_FIRST_PRINCIPLES,
                "a_m = 0.2: no link-angle amplitude below 90 deg belongs to it at delta_deg = 40, so it cannot be "
                "mapped to the first-principles model");
    char says[200];
    input.a = 2 * moray_robot_paper().l * cos(input.delta / 2); // links at right angles
    snprintf(
        says, sizeof says,
        "a_m = %.10g: no link-angle amplitude below 90 deg belongs to it at delta_deg = 40, so it cannot be mapped "
        "to the first-principles model",
        input.a);
    refuse_gait(&input, MORAY_FIRST_PRINCIPLES, says);
    input.a = 0.03;
    input.alpha = 10 * DEG;
    refuse_gait(&input, MORAY_CONTROL_ORIENTED, "alpha_deg = 10 contradicts a_m = 0.03: give one of them");
}

static void refuse_schedule(const char *text, int line, const char *says)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait_input first = moray_gait_input_default();
    moray_gait_change *change;
    char place[320];
    int n;
    put("schedule.csv", text);
    const moray_status status =
        moray_gait_schedule_read(in_root("schedule.csv"), &first, &robot, MORAY_CONTROL_ORIENTED, &change, &n);
    snprintf(place, sizeof place, "schedule.csv:%d", line);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says) && strstr(status.text, place) && !change && n == 0,
          "%s", status.text);
}

static void test_schedules(void)
{
    refuse_schedule("t_s,omega_deg_s\n0,100\n10,110\n5,120\n", 4,
                    "t_s = 5: must lie after that of the line before, 10");
    refuse_schedule("t_s,omega_deg_s\n10,110\n10,120\n", 3, "t_s = 10: must lie after that of the line before, 10");
    refuse_schedule("t_s,delta_deg,omega_deg_s\n0,40,fast\n", 2, "omega_deg_s = fast");
    refuse_schedule("t_s,omega_deg_s\n0,100\n,110\n", 3, "t_s is empty");
    refuse_schedule("delta_deg,omega_deg_s\n0,100\n", 1, "a schedule needs a column t_s");
    refuse_schedule("t_s,omega\n0,100\n", 1, "omega");
    refuse_schedule("t_s,alpha_deg\n0,10\n2,80\n", 3, "alpha_deg = 80: no link-angle amplitude below 90 deg");
}

// ---- Robots --------------------------------------------------------------------------------------------------------

// Keys that say what is the paper's go before a word that says otherwise.
static void test_keys(void)
{
    static const char *const keys[] = {"rotation=paper", "drag=linear", "added_mass=paper", "frame=paper"};
    for (int k = 0; k < 4; k++) {
        settings s;
        CHECK_OK(PARSE(&s, "--hydrodynamics", "consistent", "--set", keys[k]), keys[k]);
        const moray_hydrodynamics *is = &s.snake.robot.hydro;
        moray_hydrodynamics want = moray_hydrodynamics_consistent();
        want.rotation = k == 0 ? MORAY_ROTATION_PAPER : want.rotation;
        want.drag = k == 1 ? MORAY_DRAG_LINEAR : want.drag;
        want.added_mass = k == 2 ? MORAY_ADDED_MASS_PAPER : want.added_mass;
        want.frame = k == 3 ? MORAY_FRAME_PAPER : want.frame;
        CHECK(is->rotation == want.rotation && is->drag == want.drag && is->added_mass == want.added_mass &&
                  is->frame == want.frame,
              "%s alone", keys[k]);
    }
}

// A coefficient may be off by rounding, 1e-9 of itself.
static void test_the_papers(void)
{
    const moray_robot paper = moray_robot_paper();
    const struct {
        const char *key;
        double value;
    } of[] = {{"l_m", paper.l},
              {"m_kg", paper.m},
              {"J_kg_m2", paper.J},
              {"c_t", paper.c_t},
              {"c_n", paper.c_n},
              {"mu_n", paper.mu_n},
              {"lambda_1", paper.lambda_1},
              {"lambda_2", paper.lambda_2},
              {"lambda_3", paper.lambda_3}};
    for (unsigned k = 0; k < sizeof of / sizeof *of; k++) {
        static const double off[] = {-2e-9, -5e-10, 5e-10, 2e-9};
        for (int j = 0; j < 4; j++) {
            settings s;
            char text[64], inertia[64];
            snprintf(text, sizeof text, "%s=%.17g", of[k].key, of[k].value * (1 + off[j]));
            snprintf(inertia, sizeof inertia, "J_kg_m2=%.17g", paper.J * (k == 2 ? 1 + off[j] : 1));
            CHECK_OK(PARSE(&s, "--set", text, "--set", inertia), text);
            CHECK(s.snake.not_tuned == (j == 0 || j == 3), "%s, off by %g of itself", text, off[j]);
        }
    }
}

static void test_texts(void)
{
    char text[MORAY_LINKS_TEXT];
    settings s;
    CHECK_OK(PARSE(&s, "--links", "6"), "six links");
    CHECK(strcmp(moray_snake_links_text(&s.snake.robot, text), "6 links") == 0, "%s", text);
    CHECK_OK(PARSE(&s, "--links", "3", "--set", "link_length_m=0.1,0.2,0.24", "--set", "link_m_kg=1,2,4.5"), "unequal");
    s.snake.robot.motor.fitted = true;
    moray_snake_links_text(&s.snake.robot, text);
    CHECK(strcmp(text, "3 unequal links (the control-oriented model swims the nearest equal robot: as long, as heavy, "
                       "with as much drag and added mass in all, links of 0.18 m and 2.5 kg) with motors (the "
                       "control-oriented model, whose joints are not rotary, has none)") == 0,
          "%s", text);
    const moray_status status = PARSE(&s, "--links", "3", "--set", "link_m_kg=2");
    CHECK(status.code == MORAY_INPUT &&
              strstr(status.text, "link_m_kg: 1 numbers where the robot has links = 3: must be one for each link, from "
                                  "link 1, the tail, on (k*X for k alike)"),
          "%s", status.text);
}

// Each list reaches its field of every link, and no link behind the last.
static void test_lists(void)
{
    static const char *const keys[] = {"link_length_m", "link_m_kg",     "link_J_kg_m2",  "link_c_t",      "link_c_n",
                                       "link_mu_n",     "link_lambda_1", "link_lambda_2", "link_lambda_3", "link_cm_m",
                                       "link_cb_m",     "fin_c_t",       "fin_c_n",       "fin_mu_n",      "fin_at_m"};
    enum { lists = sizeof keys / sizeof *keys };
    char text[4000] = "[robot]\nlinks=3\n[links]\n";
    settings s;
    for (int k = 0; k < lists; k++) {
        const double least = (k ? 0 : 1) + 0.001 * (k + 20); // long enough for the places along the link
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s=%g,%g,%g\n", keys[k], least, least + 0.021,
                 least + 0.042);
    }
    put("robot.ini", text);
    CHECK_OK(PARSE(&s, "--robot", in_root("robot.ini")), "all lists");
    for (int i = 0; i < 3; i++) {
        const moray_link link = moray_robot_link(&s.snake.robot, i);
        const double is[lists] = {2 * link.l, link.m,        link.J,        link.c_t,      link.c_n,
                                  link.mu_n,  link.lambda_1, link.lambda_2, link.lambda_3, link.cm,
                                  link.cb,    link.fin_c_t,  link.fin_c_n,  link.fin_mu_n, link.fin_at};
        for (int k = 0; k < lists; k++)
            CHECK_NEAR(is[k], (k ? 0 : 1) + 0.001 * (k + 20 + 21 * i), 1e-15, keys[k]);
    }
    CHECK(s.snake.link[3].l == 0 && s.snake.link[3].m == 0, "no fourth link");
}

static double at(const moray_json_file *file, const char *list, const char *key)
{
    char place[80];
    snprintf(place, sizeof place, "robot.%s.%s", list, key);
    return moray_json_number_at(file, place);
}

static void check_link(const moray_json_file *file, const char *list, const moray_link *link)
{
    const struct {
        const char *key;
        double value;
    } of[] = {{"length_m", 2 * link->l},    {"m_kg", link->m},
              {"J_kg_m2", link->J},         {"c_t", link->c_t},
              {"c_n", link->c_n},           {"mu_n", link->mu_n},
              {"lambda_1", link->lambda_1}, {"lambda_2", link->lambda_2},
              {"lambda_3", link->lambda_3}, {"cm_m", link->cm},
              {"cb_m", link->cb},           {"fin_c_t", link->fin_c_t},
              {"fin_c_n", link->fin_c_n},   {"fin_mu_n", link->fin_mu_n},
              {"fin_at_m", link->fin_at}};
    for (unsigned k = 0; k < sizeof of / sizeof *of; k++)
        CHECK(at(file, list, of[k].key) == of[k].value, "%s of %s: %.17g, expected %.17g", of[k].key, list,
              at(file, list, of[k].key), of[k].value);
}

static void test_summary(void)
{
    moray_robot robot = moray_robot_paper();
    robot.links = 3;
    moray_link link[3];
    for (int i = 0; i < 3; i++)
        link[i] =
            (moray_link){0.05 + 0.01 * i, 1 + i,     0.1 + 0.1 * i, 0.3 + i, 0.4 + i,       0.5 + i, 0.6 + i, 0.7 + i,
                         0.8 + i,         0.002 * i, -0.003 * i,    1.1 + i, 1.2 + 0.5 * i, 1.3 + i, 0.01 * i};
    moray_robot_from_links(&robot, link);
    moray_snake_options options = {.robot = robot, .model = MORAY_FIRST_PRINCIPLES, .current = {0.03, -0.07}};
    moray_json *json = moray_json_new();
    moray_json_file *file = NULL;
    moray_snake_to_json(json, &options);
    moray_json_number(json, "behind", 5);
    FILE *out = fopen(in_root("robot.json"), "w");
    CHECK_OK(moray_json_write(json, out), "written");
    fclose(out);
    moray_json_free(json);
    CHECK_OK(moray_json_read(&file, in_root("robot.json")), "read");
    CHECK(strcmp(moray_json_text_at(file, "model"), "fp") == 0 && moray_json_number_at(file, "robot.links") == 3 &&
              moray_json_number_at(file, "current_m_s.0") == 0.03 &&
              moray_json_number_at(file, "current_m_s.1") == -0.07 && moray_json_number_at(file, "behind") == 5,
          "model, links and current");
    CHECK(moray_json_count_at(file, "robot.link") == 3, "every link");
    for (int i = 0; i < 3; i++) {
        const moray_link is = moray_robot_link(&robot, i);
        char list[20];
        snprintf(list, sizeof list, "link.%d", i);
        check_link(file, list, &is);
    }
    robot.link = NULL;
    const moray_link mean = moray_robot_link(&robot, 0);
    check_link(file, "nearest_equal_link", &mean);
    moray_json_file_free(file);
}

int main(void)
{
    if (!enter())
        return 1;
    test_gaits();
    test_schedules();
    test_keys();
    test_the_papers();
    test_texts();
    test_lists();
    test_summary();
    leave();
    return tap_done();
}
