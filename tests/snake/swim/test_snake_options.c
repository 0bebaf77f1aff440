// SPDX-License-Identifier: MIT
#include "arguments.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/snake/options.h"
#include "sound_table.h"

typedef struct settings {
    moray_common common;
    moray_snake_options snake;
} settings;

static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(settings, snake)}};
static const moray_program program = {.name = "test", .summary = "s", .groups = groups, .n_groups = 1};
static char path[] = "/tmp/moray-robot-XXXXXX";

static moray_status parse(settings *s, const char *const arguments[8])
{
    command_line line;
    command_set(&line, "test", arguments, 8);
    moray_request request;
    *s = (settings){.common = moray_common_default(), .snake = moray_snake_options_default()};
    return moray_app_parse(&program, line.argc, line.argv, s, &request);
}
#define PARSE(s, ...) parse((s), (const char *const[8]){__VA_ARGS__})

static void write_file(const char *text)
{
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
}

static bool same_robot(const moray_robot *a, const moray_robot *b)
{
    return a->links == b->links &&
           memcmp(&a->l, &b->l, offsetof(moray_robot, hydro) - offsetof(moray_robot, l)) == 0 && // doubles only
           memcmp(&a->hydro, &b->hydro, sizeof a->hydro) == 0;                                   // int only
}

static void test_robot(void)
{
    settings s;
    const moray_robot paper = moray_robot_paper();
    CHECK_OK(PARSE(&s, NULL), "no arguments");
    CHECK(same_robot(&s.snake.robot, &paper), "the default is the paper's robot");
    CHECK_OK(PARSE(&s, "--set", "C_D=1", "--set", "length_m=0.2", "--set", "m_kg=3", "--set", "c_t=0"), "a mix");
    CHECK_NEAR(s.snake.robot.c_n, 1000 * 1 * 2 * 0.03 * 0.1, 1e-12, "c_n = rho C_D 2 b_e l from the geometry");
    CHECK(s.snake.robot.l == 0.1, "l is half of length_m: %g", s.snake.robot.l);
    CHECK(s.snake.robot.m == 3 && s.snake.robot.c_t == 0, "direct keys override the geometry");
    CHECK_NEAR(s.snake.robot.J, 3 * (0.2 * 0.2 / 12 + 0.05 * 0.05 / 4), 1e-15, "J is that of the mass given");
    write_file("[robot]\nlinks=3\nl_m=0.1\nm_kg=1\nJ_kg_m2=2\nc_t=3\nc_n=4\nmu_n=5\nlambda_1=6\nlambda_2=7\n"
               "lambda_3=8\nrot_damping=9\nrot_gain=10\nk_p=11\nk_d=12\n");
    CHECK_OK(PARSE(&s, "--robot", path), "all direct keys");
    const moray_robot direct = {.links = 3,
                                .l = 0.1,
                                .m = 1,
                                .J = 2,
                                .c_t = 3,
                                .c_n = 4,
                                .mu_n = 5,
                                .lambda_1 = 6,
                                .lambda_2 = 7,
                                .lambda_3 = 8,
                                .rot_damping = 9,
                                .rot_gain = 10,
                                .k_p = 11,
                                .k_d = 12,
                                .hydro = {.pieces = 1}};
    CHECK(same_robot(&s.snake.robot, &direct), "each direct key reaches its field");
}

static void check_refused(const char *says, const char *one, const char *other)
{
    settings s;
    const moray_status status = PARSE(&s, "--links", "3", "--set", one, "--set", other);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says), "%s", status.text);
}

static void test_links(void)
{
    settings s;
    const moray_robot paper = moray_robot_paper();
    CHECK_OK(
        PARSE(&s, "--set", "link_length_m=10*0.14", "--set", "link_b_e_m=0.03,8*0.03,0.03", "--set", "fin_c_n=10*0"),
        "equal links as lists");
    CHECK(same_robot(&s.snake.robot, &paper) && !s.snake.robot.link, "are the equal robot");
    write_file("[robot]\nlinks=3\nC_D=1\n[links]\nlink_length_m = 0.1, ; tail\n  ; and\n  0.14,\n\n  0.2\n"
               "link_m_kg=1,2,3\nlink_cm_m=2*0,-0.05\nfin_c_n=7,2*0\nfin_at_m=-0.06,0,0\n");
    CHECK_OK(PARSE(&s, "--robot", path), "lists, one over several lines");
    const moray_link tail = moray_robot_link(&s.snake.robot, 0), head = moray_robot_link(&s.snake.robot, 2);
    CHECK_NEAR(tail.l, 0.05, 1e-15, "half the tail");
    CHECK_NEAR(head.l, 0.1, 1e-15, "half the head");
    CHECK_NEAR(head.m, 3, 1e-14, "its mass");
    CHECK_NEAR(head.J, 3 * (0.2 * 0.2 / 12 + 0.05 * 0.05 / 4), 1e-15, "its inertia from mass and geometry");
    CHECK_NEAR(head.c_n, 1000 * 1 * 2 * 0.03 * 0.1, 1e-14, "its drag from the geometry");
    CHECK_NEAR(head.cm, -0.05, 1e-15, "its centre of mass");
    CHECK_NEAR(tail.fin_c_n, 7, 1e-14, "the tail's fin");
    CHECK_NEAR(tail.fin_at, -0.06, 1e-15, "and its place");
    CHECK_NEAR(s.snake.robot.m, 2, 1e-15, "the equal robot has the mean mass");
    CHECK(s.snake.not_tuned, "the constants of (20) are not tuned for it");
    check_refused("link_c_n: 2 numbers where the robot has links = 3", "link_c_n=1,2", "c_t=1");
    check_refused("link_c_n: is given for all links by c_n, too", "link_c_n=1,2,3", "c_n=1");
    check_refused("link_length_m = 0,1,2: must be at most 1000 numbers by commas", "link_length_m=0,1,2", "c_t=1");
    check_refused("link_m_kg = 1,-2,3: must be", "link_m_kg=1,-2,3", "c_t=1");
    check_refused("link_m_kg = 1,,3: must be", "link_m_kg=1,,3", "c_t=1");
    check_refused("link_m_kg = 0*1,3: must be", "link_m_kg=0*1,3", "c_t=1");
    check_refused("link_m_kg = 1,nan,3: must be", "link_m_kg=1,nan,3", "c_t=1");
    check_refused("link 2: cm = 0.08 m from its middle: must be within its ends, -0.07 to 0.07 m", "link_cm_m=0,0.08,0",
                  "c_t=1");
    check_refused("link 1: fin_at = -0.3 m from its middle: must be within two lengths", "fin_at_m=-0.3,0,0",
                  "fin_c_n=1,0,0");
    write_file("[robot]\nlinks=2\n[links]\nlink_m_kg=1,\n");
    CHECK(PARSE(&s, "--robot", path).code == MORAY_INPUT, "a list that does not end");
    write_file("[robot]\nlinks=2\n[links]\nlink_m_kg=1,\n2\nlink_m_kg=1,2\n");
    CHECK(PARSE(&s, "--robot", path).code == MORAY_INPUT, "a list given twice");
}

static void check_motor_refused(const char *says, const char *one, const char *other)
{
    settings s;
    const moray_status status = PARSE(&s, "--set", one, "--set", other);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says), "%s", status.text);
}

static void test_motor(void)
{
    settings s;
    CHECK_OK(PARSE(&s, "--set", "hotel_W=2", "--set", "motor_idle_W=0.1", "--set", "battery_Wh=30"), "a battery");
    CHECK(!s.snake.robot.motor.fitted, "is no motor");
    CHECK_NEAR(s.snake.robot.supply.constant, 2.9, 1e-15, "hotel load and the electronics of nine motors");
    CHECK_OK(PARSE(&s, "--set", "motor_efficiency=0.8"), "a gear");
    const moray_motor *motor = &s.snake.robot.motor;
    CHECK(motor->fitted && motor->forward == 0.8 && motor->backward == 0, "gives nothing back unless it is said");
    CHECK_OK(PARSE(&s, "--set", "motor_friction_N_m=0.1"), "friction alone");
    CHECK(motor->fitted && motor->forward == 1 && motor->backward == 1, "has the joints' power otherwise");
    CHECK_OK(PARSE(&s, "--set", "motor_speed_deg_s=0,180", "--set", "motor_torque_N_m=3,0"), "a line");
    CHECK_NEAR(motor->slope[0], 3 / M_PI, 1e-15, "by speeds in deg/s");
    check_motor_refused("2 and 1 numbers: must be as many", "motor_speed_deg_s=0,1", "motor_torque_N_m=1");
    check_motor_refused("must have 2 to 9", "motor_speed_deg_s=0", "motor_torque_N_m=1");
    check_motor_refused("must be concave", "motor_speed_deg_s=0,1,2", "motor_torque_N_m=3,1,0");
    check_motor_refused("motor_efficiency = 1.5: must be", "motor_efficiency=1.5", "hotel_W=1");
    check_motor_refused("motor_back_efficiency = -1: must be", "motor_back_efficiency=-1", "hotel_W=1");
    check_motor_refused("battery_Wh = 0: must be", "battery_Wh=0", "hotel_W=1");
}

static void test_hydrodynamics(void)
{
    settings s;
    const moray_hydrodynamics paper = moray_robot_paper().hydro, consistent = moray_hydrodynamics_consistent();
    moray_hydrodynamics mixed = consistent;
    mixed.drag = MORAY_DRAG_LINEAR;
    CHECK_OK(PARSE(&s, "--hydrodynamics", "paper"), "the paper's");
    CHECK(memcmp(&s.snake.robot.hydro, &paper, sizeof paper) == 0, "is the default");
    CHECK_OK(PARSE(&s, "--hydrodynamics", "consistent"), "one word");
    CHECK(memcmp(&s.snake.robot.hydro, &consistent, sizeof consistent) == 0, "sets all");
    CHECK_OK(PARSE(&s, "--set", "drag=linear", "--hydrodynamics", "consistent"), "a word and a key");
    CHECK(memcmp(&s.snake.robot.hydro, &mixed, sizeof mixed) == 0, "the key goes before the word, in any order");
    write_file("[robot]\nrotation=strip\ndrag=both\nadded_mass=invariant\nframe=invariant\n");
    CHECK_OK(PARSE(&s, "--robot", path), "four keys");
    CHECK(memcmp(&s.snake.robot.hydro, &consistent, sizeof consistent) == 0, "each key reaches its field");
    CHECK_OK(PARSE(&s, "--set", "pieces=3"), "links in three pieces");
    CHECK(s.snake.robot.hydro.pieces == 3, "pieces");
    CHECK(PARSE(&s, "--set", "pieces=3", "--set", "rotation=strip").code == MORAY_INPUT, "a strip is not cut");
}

// The constants of (20) are the paper's for its robot alone.
static void test_turning(void)
{
    static const char *const others[] = {"links=6",    "m_kg=0.5",       "length_m=0.2",
                                         "a_e_m=0.04", "rho_kg_m3=1025", "c_n=3"};
    settings s;
    CHECK_OK(PARSE(&s, "--set", "m_kg=0.65973445725385655"), "the paper's robot, with its own mass given");
    CHECK_OK(moray_snake_turning(&s.snake), "has the constants of the paper");
    for (unsigned i = 0; i < sizeof others / sizeof *others; i++) {
        CHECK_OK(PARSE(&s, "--set", others[i]), others[i]);
        const moray_status status = moray_snake_turning(&s.snake);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, "paper fit --set write_ini="), "%s: has not: %s",
              others[i], status.text);
        CHECK_OK(PARSE(&s, "--set", others[i], "--set", "rot_gain=30"), "one is not both");
        CHECK(s.snake.not_tuned && s.snake.robot.rot_gain == 30, "one given");
        CHECK(s.snake.robot.rot_damping == moray_robot_paper().rot_damping, "the other is the paper's");
        CHECK_OK(PARSE(&s, "--set", others[i], "--set", "rot_gain=30", "--set", "rot_damping=1"), "both");
        CHECK_OK(moray_snake_turning(&s.snake), "are taken");
    }
}

static void test_words(void)
{
    settings s;
    CHECK_OK(PARSE(&s, "--model", "complex", "--current", "-0.1,0.2", "--course=45"), "model, current, course");
    CHECK(s.snake.model == MORAY_FIRST_PRINCIPLES, "complex is another word for fp");
    CHECK(s.snake.current[0] == -0.1 && s.snake.current[1] == 0.2, "current %g,%g", s.snake.current[0],
          s.snake.current[1]);
    CHECK_NEAR(s.snake.course, M_PI / 4, 1e-15, "course in degrees");
    moray_status status = PARSE(&s, "--set", "rho_kg_m3=1e308");
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "m = inf: must be finite"), "the robot is checked: %s",
          status.text);
    write_file("[robot]\nlinks = 6\nm_kg = 2\n[problem]\nmodel = complex\n");
    CHECK_OK(PARSE(&s, "--config", path), "--config reads any key");
    CHECK(s.snake.robot.links == 6 && s.snake.robot.m == 2 && s.snake.model == MORAY_FIRST_PRINCIPLES, "they are set");
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    CHECK_OK(moray_app_help(&program, &s, file), "help");
    fclose(file);
    const char *told = strstr(text, "complex");
    CHECK(told && !strstr(told + 1, "complex"), "--help tells the other word once");
    free(text);
}

int main(void)
{
    settings s;
    const int file = mkstemp(path);
    if (file < 0)
        return 1;
    close(file);
    test_robot();
    test_links();
    test_motor();
    test_hydrodynamics();
    test_turning();
    test_words();
    CHECK_OK(PARSE(&s, NULL), "defaults");
    check_sound_table(&program, &s, sizeof s);
    unlink(path);
    return tap_done();
}
