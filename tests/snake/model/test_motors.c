// SPDX-License-Identifier: MIT
//
// Motors term by term and their limits on either side; joints of limited torque in a motion whose inertia is written
// out.
#include "moray/snake/motor.h"
#include "random_robot.h"
#include "snake/model/torque.h"

#include <string.h>

static moray_motor made(void)
{
    return (moray_motor){.fitted = true,
                         .forward = 0.7,
                         .backward = 0.4,
                         .friction = 0.3,
                         .viscous = 0.2,
                         .copper = 0.6,
                         .smooth_rate = 0.5,
                         .smooth_power = 0.25,
                         .lines = 3,
                         .torque = {2, 2.5, 4},
                         .slope = {0, 0.9, 2.5}};
}

static double at_the_motor(const moray_motor *m, double u, double v)
{
    return u + m->friction * v / hypot(v, m->smooth_rate) + m->viscous * v;
}

// Power p at the gear: half of what is lost either way, and what tells the ways apart, smoothed.
static void test_terms(void)
{
    const moray_motor m = made(), none = {.fitted = false, .friction = 3, .copper = 2};
    random_seed seed = 5;
    double worst = 0;
    int reached[3] = {0};
    for (int k = 0; k < 300; k++) {
        const double u = tap_random(&seed, -3, 3), v = tap_random(&seed, -3, 3);
        const double u_m = at_the_motor(&m, u, v), p = u_m * v, size = hypot(p, m.smooth_power) - m.smooth_power;
        const double power = (p + size) / 2 / m.forward + (p - size) / 2 * m.backward + m.copper * u_m * u_m;
        double load = 0;
        int at = 0;
        for (int line = 0; line < 3; line++) {
            const double u_line = fabs(u_m + m.slope[line] * v) / m.torque[line];
            at = u_line > load ? line : at;
            load = u_line > load ? u_line : load;
        }
        reached[at]++;
        worst = tap_worse(worst, fabs(moray_motor_torque(&m, u, v) - u_m));
        worst = tap_worse(worst, fabs(moray_motor_power(&m, u, v) - power));
        worst = tap_worse(worst, fabs(moray_motor_load(&m, u, v) - load));
        worst = tap_worse(worst, fabs(moray_motor_torque(&none, u, v) - u));
        worst = tap_worse(worst, fabs(moray_motor_power(&none, u, v) - u * v));
        worst = tap_worse(worst, fabs(moray_motor_load(&none, u, v)));
    }
    CHECK(worst < 1e-13, "torque, power and load: %.1e", worst);
    CHECK(reached[0] && reached[1] && reached[2], "each line limits somewhere: %d, %d, %d", reached[0], reached[1],
          reached[2]);
}

static void test_table(void)
{
    const double speed[] = {0, 1, 3, 4}, torque[] = {5, 4.5, 2.5, 0};
    moray_motor m = {.fitted = true};
    CHECK_OK(moray_motor_set_table(&m, speed, torque, 4), "a table");
    CHECK(m.lines == 3 && m.slope[0] == 0.5 && m.slope[1] == 1 && m.slope[2] == 2.5, "slopes %g, %g, %g", m.slope[0],
          m.slope[1], m.slope[2]);
    CHECK(m.torque[0] == 5 && m.torque[1] == 5.5 && m.torque[2] == 10, "at rest %g, %g, %g", m.torque[0], m.torque[1],
          m.torque[2]);
    CHECK_OK(moray_motor_set_table(&m, speed, (const double[]){3, 3, 3, 3}, 4), "as much at any speed");
    CHECK_OK(moray_motor_set_table(&m, speed, (const double[]){4, 3, 1, 0}, 4), "a straight line of three");
    CHECK_OK(moray_motor_set_table(&m, (const double[]){0, 2}, (const double[]){3, 1}, 2), "two points");
    CHECK(m.lines == 1 && m.slope[0] == 1 && m.torque[0] == 3, "are one line");
    const moray_status one = moray_motor_set_table(&m, speed, torque, 1);
    CHECK(strcmp(one.text, "a motor's table of 1 points: must have 2 to 9") == 0, "%s", one.text);
    double many[10], falling[10];
    for (int k = 0; k < 10; k++)
        many[k] = k, falling[k] = 100 - k * k;
    CHECK_OK(moray_motor_set_table(&m, many, falling, 9), "nine points");
    const moray_status status = moray_motor_set_table(&m, many, falling, 10);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "a motor's table of 10 points: must have 2 to 9") == 0,
          "%s", status.text);
}

// ---- What is allowed -----------------------------------------------------------------------------------------------

typedef struct field {
    double *of;
    const char *text;
    double least, most;
    bool open;
} field;

static void check_field(const moray_motor *motor, const field *f)
{
    const double kept = *f->of, values[] = {f->least, f->most, f->least - 0.01, f->most + 0.01, NAN, INFINITY};
    for (int k = 0; k < 6; k++) {
        *f->of = values[k];
        const bool good = k == 0 ? !f->open : k == 1 && isfinite(f->most);
        const moray_status status = moray_motor_check(motor);
        char text[120];
        snprintf(text, sizeof text, "motor: %s = %g: must be %s %g and at most %g", f->text, values[k],
                 f->open ? "above" : "at least", f->least, f->most);
        CHECK(good ? !moray_failed(status) : status.code == MORAY_INPUT && strcmp(status.text, text) == 0,
              "%s = %g: \"%s\"", f->text, values[k], status.text);
    }
    *f->of = kept;
}

static void test_checks(void)
{
    moray_motor m = made();
    const field fields[] = {
        {&m.forward, "forward efficiency", 0, 1, true},      {&m.backward, "backward efficiency", 0, 1, false},
        {&m.friction, "friction", 0, INFINITY, false},       {&m.viscous, "viscous friction", 0, INFINITY, false},
        {&m.copper, "copper", 0, INFINITY, false},           {&m.smooth_rate, "smooth_rate", 0, INFINITY, true},
        {&m.smooth_power, "smooth_power", 0, INFINITY, true}};
    CHECK_OK(moray_motor_check(&m), "as made");
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++)
        check_field(&m, &fields[k]);
    m.lines = MORAY_MOTOR_LINES;
    for (int k = 3; k < m.lines; k++)
        m.torque[k] = 1;
    CHECK_OK(moray_motor_check(&m), "as many lines as there is room for");
    m.torque[4] = INFINITY;
    CHECK(moray_motor_check(&m).code == MORAY_INPUT, "a line without a limit is none");
    moray_supply supply = {.constant = 0, .battery = 0, .rate = 0};
    CHECK_OK(moray_supply_check(&supply), "no supply");
    supply.rate = INFINITY;
    CHECK_OK(moray_supply_check(&supply), "any joint rate");
    supply.battery = INFINITY;
    const moray_status status = moray_supply_check(&supply);
    CHECK(strcmp(status.text, "supply: battery = inf Wh: must be finite and at least 0") == 0, "%s", status.text);
    moray_robot robot = moray_robot_paper();
    CHECK_OK(moray_robot_check(&robot), "a robot");
    robot.supply = supply;
    const moray_status of_robot = moray_robot_check(&robot);
    CHECK(strcmp(of_robot.text, status.text) == 0, "as of the robot that it feeds: %s", of_robot.text);
}

// ---- Limited torque ------------------------------------------------------------------------------------------------

enum { JOINTS = 3 };

typedef struct motion {
    double A[JOINTS][JOINTS], b[JOINTS];
    int calls, fails; // the call that fails
} motion;

static bool efforts(void *self, const double *ubar, double *u)
{
    motion *m = self;
    for (int i = 0; i < JOINTS; i++) {
        u[i] = m->b[i];
        for (int j = 0; j < JOINTS; j++)
            u[i] += m->A[i][j] * ubar[j];
    }
    return ++m->calls != m->fails;
}

static motion inertia(void)
{
    return (motion){{{2, 0.5, -0.3}, {0.4, 1.5, 0.2}, {0.1, -0.6, 3}}, {0.2, -0.1, 0.4}, 0, 0};
}

// What is wanted, cut off on either side, is what the changed accelerations take.
static void check_limit(const double wanted[JOINTS], double most)
{
    double room[TORQUE_ROOM(JOINTS)], ubar[JOINTS], u[JOINTS], got[JOINTS], cut[JOINTS];
    const torque_limit limit = {JOINTS, most, room};
    motion m = inertia();
    memcpy(ubar, wanted, sizeof ubar);
    efforts(&m, wanted, u);
    bool beyond = false;
    for (int i = 0; i < JOINTS; i++) {
        cut[i] = u[i] > most ? most : u[i] < -most ? -most : u[i];
        beyond = beyond || cut[i] != u[i];
    }
    CHECK(moray_torque_limited(&limit, efforts, &m, ubar), "limited to %g", most);
    CHECK(beyond || memcmp(ubar, wanted, sizeof ubar) == 0, "what is not beyond stays");
    efforts(&m, ubar, got);
    for (int i = 0; i < JOINTS; i++)
        CHECK_NEAR(got[i], cut[i], 1e-13, "effort");
}

static void test_limited(void)
{
    random_seed seed = 8;
    for (int k = 0; k < 40; k++) {
        double wanted[JOINTS];
        random_vector(&seed, 3, JOINTS, wanted);
        check_limit(wanted, tap_random(&seed, 0.5, 4));
    }
    check_limit((const double[]){-1, -1, -1}, 1.5); // beyond below alone
    check_limit((const double[]){1.5, 1, 0.5}, 3);  // beyond above alone
    check_limit((const double[]){0, 0, 0}, 0.4);    // exactly at the limit
    for (int fails = 1; fails <= JOINTS + 1; fails++) {
        double room[TORQUE_ROOM(JOINTS)], ubar[JOINTS] = {3, 2, 1};
        const torque_limit limit = {JOINTS, 0.5, room};
        motion m = inertia();
        m.fails = fails;
        CHECK(!moray_torque_limited(&limit, efforts, &m, ubar) && m.calls == fails, "refused in call %d", fails);
    }
    double room[TORQUE_ROOM(JOINTS)], ubar[JOINTS] = {3, 2, 1};
    const torque_limit limit = {JOINTS, 0.5, room};
    motion m = {{{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}, {1, 1, 1}, 0, 0};
    CHECK(!moray_torque_limited(&limit, efforts, &m, ubar), "a joint without inertia");
    const torque_limit exact = {JOINTS, 4, room};
    CHECK(moray_torque_limited(&exact, efforts, &m, ubar) && ubar[0] == 3, "which does not matter at the limit itself");
}

int main(void)
{
    test_terms();
    test_table();
    test_checks();
    test_limited();
    return tap_done();
}
