// SPDX-License-Identifier: MIT
//
// What simulators refuse, on either side of every bound, and what they say where they can go no further.
#include "tap.h"

#include <string.h>

#include "moray/sim.h"
#include "sim/sim_version.h"
#include "sim/times.h"

static void says(moray_status status, moray_code code, const char *text)
{
    CHECK(status.code == code && strcmp(status.text, text) == 0, "%s, not %s", status.text, text);
}

static void test_settings(void)
{
    moray_sim_settings s = moray_sim_settings_default();
    s.rtol = 1e-14;
    CHECK_OK(moray_sim_settings_check(&s), "least rtol");
    s.rtol = 0.9e-14;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "rtol = 9e-15: must be at least 1e-14 and below 1");
    s.rtol = 1;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "rtol = 1: must be at least 1e-14 and below 1");
    s.rtol = 0.99;
    CHECK_OK(moray_sim_settings_check(&s), "most rtol");
    s.atol = 0;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "atol = 0: must be finite and above 0");
    s.atol = INFINITY;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "atol = inf: must be finite and above 0");
    s.atol = -1;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "atol = -1: must be finite and above 0");
    s.atol = 1e-300;
    s.max_step = -1;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "max_step = -1: must be finite and at least 0 (no limit)");
    s.max_step = INFINITY;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "max_step = inf: must be finite and at least 0 (no limit)");
    s.max_step = 1e-300;
    s.max_steps = 0;
    says(moray_sim_settings_check(&s), MORAY_INPUT, "max_steps = 0: must be at least 1");
    s.max_steps = 1;
    CHECK_OK(moray_sim_settings_check(&s), "one step");
    for (int method = -1; method <= 3; method++) {
        s.method = (moray_sim_method)method;
        CHECK(moray_failed(moray_sim_settings_check(&s)) == (method < 0 || method > 2), "method %d", method);
    }
}

static void test_times(void)
{
    CHECK_OK(moray_sim_check_times(2, 2, (double[]){2, 2}, 2), "no way, twice");
    CHECK_OK(moray_sim_check_times(-1, 2, (double[]){-1, 0.5, 0.5, 2}, 4), "from end to end");
    says(moray_sim_check_times(2, 1.5, NULL, 0), MORAY_INPUT,
         "simulation from t0 = 2 to t1 = 1.5: must be finite, t1 not before t0");
    CHECK(moray_failed(moray_sim_check_times(0, INFINITY, NULL, 0)), "an end that is not finite");
    CHECK(moray_failed(moray_sim_check_times(-INFINITY, 0, NULL, 0)), "nor a start");
    says(moray_sim_check_times(-1, 2, (double[]){-1.5}, 1), MORAY_INPUT, "times[0] = -1.5: must lie between -1 and 2");
    says(moray_sim_check_times(-1, 2, (double[]){0, 0.5, 0.25}, 3), MORAY_INPUT,
         "times[2] = 0.25: must lie between 0.5 and 2");
    says(moray_sim_check_times(-1, 2, (double[]){0, 2.5}, 2), MORAY_INPUT, "times[1] = 2.5: must lie between 0 and 2");
}

// One of three slopes is not finite once the time is 1.
static bool one_of_three(double t, const double *x, double *dx, void *self)
{
    (void)x;
    for (int i = 0; i < 3; i++)
        dx[i] = t >= 1 && i == *(int *)self ? INFINITY : 1;
    return true;
}

// x' = x^2 from 1 is gone at 1.
static bool explosion(double t, const double *x, double *dx, void *self)
{
    (void)t, (void)self;
    dx[0] = x[0] * x[0];
    return true;
}

static void test_states(moray_sim_method method)
{
    moray_sim_settings settings = moray_sim_settings_default();
    settings.method = method;
    settings.rtol = settings.atol = 1e-6;
    for (int i = 0; i < 3; i++) {
        moray_sim *sim;
        double x[3] = {1, 2, 3};
        CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 3, .rhs = one_of_three, .self = &i}, &settings), "new");
        x[i] = NAN;
        char text[100];
        snprintf(text, sizeof text, "simulation cannot start at t = 0.5: x[%d] = nan", i);
        says(moray_sim_start(sim, 0.5, x), MORAY_NUMERIC, text);
        x[i] = i + 1;
        CHECK_OK(moray_sim_start(sim, 0, x), "start");
        const moray_status status = moray_sim_advance(sim, 2);
        CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "outside its domain or not finite"), "slope %d: %s",
              i, status.text);
        CHECK_NEAR(moray_sim_time(sim), 1, 1e-6, "up to there");
        for (int k = 0; k < 3; k++)
            CHECK_NEAR(moray_sim_state(sim)[k], k + 2, 1e-5, "state");
        moray_sim_free(sim);
    }
    moray_sim *sim;
    CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = explosion}, &settings), "new");
    CHECK_OK(moray_sim_start(sim, 0, (double[]){1}), "start");
    const moray_status status = moray_sim_advance(sim, 2);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "with ever shorter steps"), "no way on: %s", status.text);
    moray_sim_free(sim);
}

// The same, whose first question after the third has no answer where that is asked for.
typedef struct interrupted {
    int asked, refused;
    bool outside;
} interrupted;

static bool interrupted_explosion(double t, const double *x, double *dx, void *self)
{
    interrupted *e = self;
    explosion(t, x, dx, NULL);
    return ++e->asked != e->refused && !(e->outside && t > 0.5);
}

// What once had no answer, but had one with a shorter step, or before the simulation began anew, is not why it stops.
static void test_forgotten(moray_sim_method method)
{
    moray_sim_settings settings = moray_sim_settings_default();
    settings.method = method;
    settings.rtol = settings.atol = 1e-4;
    for (int k = 0; k < 2; k++) {
        interrupted e = {.refused = k ? 0 : 4, .outside = k};
        moray_sim *sim;
        CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = interrupted_explosion, .self = &e}, &settings), "new");
        CHECK_OK(moray_sim_start(sim, 0, (double[]){1}), "start");
        if (k) {
            const moray_status first = moray_sim_advance(sim, 2);
            CHECK(strstr(first.text, "outside its domain or not finite") != NULL, "%s", first.text);
            e.outside = false;
            CHECK_OK(moray_sim_start(sim, 0, (double[]){1}), "start anew");
        }
        const moray_status status = moray_sim_advance(sim, 2);
        CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "with ever shorter steps"), "%s", status.text);
        moray_sim_free(sim);
    }
}

// A slope that no step from 0 is short enough for; at first it has no answers.
static bool endless(double t, const double *x, double *dx, void *self)
{
    (void)x;
    dx[0] = t > 0 ? 100 / t : 0;
    return t == 0 || *(const bool *)self;
}

// What has had no answer before the simulation began anew is not why its first step fails.
static void test_anew(moray_sim_method method)
{
    bool answers = false;
    moray_sim_settings settings = moray_sim_settings_default();
    moray_sim *sim;
    settings.method = method;
    settings.rtol = settings.atol = 1e-4;
    CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = endless, .self = &answers}, &settings), "new");
    for (; CHECK(!moray_failed(moray_sim_start(sim, 0, (double[]){1})), "start"); answers = true) {
        const moray_status status = moray_sim_advance(sim, 1);
        CHECK(status.code == MORAY_NUMERIC &&
                  strstr(status.text, answers ? "with ever shorter steps" : "outside its domain or not finite"),
              "%s", status.text);
        if (answers)
            break;
    }
    moray_sim_free(sim);
}

// No slope but past 0.5, and there up to 1 and down from it by much.
static bool torn(double t, const double *x, double *dx, void *self)
{
    (void)self;
    dx[0] = t <= 0.5 ? 0 : x[0] > 1 - 1e-12 ? -1e15 : 2e15;
    return true;
}

static void test_torn(void)
{
    const moray_sim_settings settings = {.method = MORAY_SIM_TR_BDF2, .rtol = 1e-6, .atol = 1e-6, .max_steps = 1000};
    moray_sim *sim;
    CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = torn}, &settings), "new");
    CHECK_OK(moray_sim_start(sim, 0, (double[]){1}), "start");
    CHECK_OK(moray_sim_advance(sim, 0.5), "to where it is torn");
    says(moray_sim_advance(sim, 1), MORAY_NUMERIC,
         "simulation stopped at t = 0.5 on its way to 1: the stage equations do not converge with ever shorter steps "
         "(singular right-hand side?)");
    moray_sim_free(sim);
}

static void test_version(void)
{
    char version[32] = "none", none[2] = "x";
    moray_sundials_version(version, sizeof version);
    CHECK(version[0] >= '1' && version[0] <= '9' && strchr(version, '.'), "SUNDIALS %s", version);
    moray_sundials_version(none, sizeof none);
    CHECK(none[0] == 0, "a version that has no room is empty: %c", none[0]);
}

int main(void)
{
    test_version();
    test_torn();
    test_settings();
    test_times();
    for (int method = MORAY_SIM_EXPLICIT; method <= MORAY_SIM_TR_BDF2; method++)
        test_states((moray_sim_method)method);
    for (int method = MORAY_SIM_EXPLICIT; method <= MORAY_SIM_TR_BDF2; method++)
        test_forgotten((moray_sim_method)method);
    test_anew(MORAY_SIM_EXPLICIT);
    test_anew(MORAY_SIM_ARKODE);
    return tap_done();
}
