// SPDX-License-Identifier: MIT
//
// What every input and output of a problem's functions is called, written out.
#include "tap.h"

#include <string.h>

#include "ocp/names.h"
#include "ocp/problem.h"

static void rates(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)data;
    for (int i = 0; i < 2; i++)
        out->f[i] = 0;
    for (int i = 0; i < 2; i++)
        out->c[i] = out->g[i] = 0;
}

static void fall(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)data;
    out->f[0] = out->c[0] = out->c[1] = 0;
}

static void watch(const moray_node *at, moray_num *y, const void *data)
{
    (void)at, (void)data;
    y[0] = y[1] = 0;
}

static void judge(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)at, (void)data;
    out->objective = out->e[0] = out->e[1] = 0;
}

// A phase whose entries have names, with controls at its ends; one of few names, with data at free times.
static moray_ocp *problem(bool named)
{
    static const char *const x[] = {"height", "speed"}, *const u[] = {"thrust"}, *const c[] = {"low", "high"},
                             *const s[] = {"mass", "area"}, *const e[] = {"meet", "land"},
                             *const y[] = {"radar", "eye"};
    static const double time[] = {1.5, 1.25, 1.75}, value[] = {1, NAN, 2, 3, NAN, 4};
    const moray_bounds near[] = {moray_between(-9, 9), moray_between(-9, 9)};
    const moray_phase_spec phase[] = {{.name = "up",
                                       .nx = 2,
                                       .nu = 1,
                                       .nc = 2,
                                       .c = MORAY_BOUNDS_OF(near),
                                       .nq = 2,
                                       .continuous = rates,
                                       .end_controls = true,
                                       .tf = moray_fixed(1),
                                       .x_names = named ? x : NULL,
                                       .u_names = named ? u : NULL,
                                       .c_names = named ? c : NULL},
                                      {.name = "down",
                                       .nx = 1,
                                       .nu = 2,
                                       .nc = 2,
                                       .c = MORAY_BOUNDS_OF(near),
                                       .continuous = fall,
                                       .t0 = moray_between(0, 1),
                                       .tf = moray_fixed(2),
                                       .observed = {.n = 3,
                                                    .ny = 2,
                                                    .time = time,
                                                    .value = value,
                                                    .observe = watch,
                                                    .names = named ? y : NULL,
                                                    .residual = MORAY_BOUNDS_OF(near),
                                                    .sum = moray_at_most(3)}}};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "flight",
                                                   .phases = 2,
                                                   .phase = phase,
                                                   .ns = 2,
                                                   .s_names = named ? s : NULL,
                                                   .ne = 2,
                                                   .e = MORAY_BOUNDS_OF(near),
                                                   .e_names = named ? e : NULL,
                                                   .endpoint = judge}),
             "flight");
    return ocp;
}

typedef void name_fn(const moray_ocp *ocp, int i, char *text, int size);

static void input_of_up(const moray_ocp *ocp, int i, char *text, int size)
{
    moray_phase_input_name(ocp, 0, i, text, size);
}

static void output_of_up(const moray_ocp *ocp, int i, char *text, int size)
{
    moray_phase_output_name(ocp, 0, i, text, size);
}

static void input_of_down(const moray_ocp *ocp, int i, char *text, int size)
{
    moray_phase_input_name(ocp, 1, i, text, size);
}

static void output_of_down(const moray_ocp *ocp, int i, char *text, int size)
{
    moray_phase_output_name(ocp, 1, i, text, size);
}

static void check_all(const moray_ocp *ocp, name_fn *name, const char *const *want, int n)
{
    for (int i = 0; i < n; i++) {
        char text[160] = "";
        name(ocp, i, text, sizeof text);
        CHECK(strcmp(text, want[i]) == 0, "%d is %s, and said to be %s", i, want[i], text);
    }
}

#define CHECK_ALL(ocp, name, ...)                                                                                      \
    check_all(ocp, name, (const char *const[]){__VA_ARGS__},                                                           \
              (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)))

static void test_named(void)
{
    moray_ocp *ocp = problem(true);
    CHECK_ALL(ocp, input_of_up, "state height", "state speed", "control thrust", "parameter mass", "parameter area",
              "time");
    CHECK_ALL(ocp, output_of_up, "dynamics of state height", "dynamics of state speed", "path constraint low",
              "path constraint high", "integrand g[0]", "integrand g[1]");
    CHECK_ALL(ocp, moray_endpoint_input_name, "initial state height of phase up", "initial state speed of phase up",
              "initial time of phase up", "final state height of phase up", "final state speed of phase up",
              "final time of phase up", "integral q[0] of phase up", "integral q[1] of phase up",
              "initial control thrust of phase up", "final control thrust of phase up",
              "initial state x[0] of phase down", "initial time of phase down", "final state x[0] of phase down",
              "final time of phase down", "parameter mass", "parameter area",
              "state x[0] of phase down observed at t = 1.5", "control u[0] of phase down observed at t = 1.5",
              "control u[1] of phase down observed at t = 1.5", "state x[0] of phase down observed at t = 1.25",
              "control u[0] of phase down observed at t = 1.25", "control u[1] of phase down observed at t = 1.25",
              "state x[0] of phase down observed at t = 1.75");
    CHECK_ALL(ocp, moray_endpoint_output_name, "objective", "event meet", "event land",
              "residual radar of phase down at t = 1.5", "residual radar of phase down at t = 1.25",
              "residual eye of phase down at t = 1.25", "residual eye of phase down at t = 1.75",
              "sum of the observations of phase down");
    moray_ocp_free(ocp);
}

static void test_numbered(void)
{
    moray_ocp *ocp = problem(false);
    CHECK_ALL(ocp, input_of_down, "state x[0]", "control u[0]", "control u[1]", "parameter s[0]", "parameter s[1]",
              "time");
    CHECK_ALL(ocp, output_of_up, "dynamics of state x[0]", "dynamics of state x[1]", "path constraint c[0]",
              "path constraint c[1]", "integrand g[0]", "integrand g[1]");
    CHECK_ALL(ocp, output_of_down, "dynamics of state x[0]", "path constraint c[0]", "path constraint c[1]");
    CHECK_ALL(ocp, moray_endpoint_input_name, "initial state x[0] of phase up", "initial state x[1] of phase up",
              "initial time of phase up", "final state x[0] of phase up", "final state x[1] of phase up",
              "final time of phase up", "integral q[0] of phase up", "integral q[1] of phase up",
              "initial control u[0] of phase up", "final control u[0] of phase up", "initial state x[0] of phase down",
              "initial time of phase down", "final state x[0] of phase down", "final time of phase down",
              "parameter s[0]", "parameter s[1]");
    CHECK_ALL(ocp, moray_endpoint_output_name, "objective", "event e[0]", "event e[1]",
              "residual y[0] of phase down at t = 1.5");
    moray_ocp_free(ocp);
}

// Data of two phases: those of the first come first.
static void see_one(const moray_node *at, moray_num *y, const void *data)
{
    (void)at, (void)data;
    y[0] = 0;
}

static void test_both_observed(void)
{
    static const double time[] = {1.5, 1.25, 1.75}, value[] = {1, 2, 3, 4, 5, 6};
    const moray_bounds near[] = {moray_between(-9, 9), moray_between(-9, 9)};
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.name = p ? "down" : "up",
                                      .nx = 1,
                                      .nu = 2 * p,
                                      .nc = 2,
                                      .c = MORAY_BOUNDS_OF(near),
                                      .continuous = fall,
                                      .t0 = moray_between(0, 1),
                                      .tf = moray_fixed(2),
                                      .observed = {.n = p ? 3 : 2,
                                                   .ny = 1 + p,
                                                   .time = time,
                                                   .value = value,
                                                   .observe = p ? watch : see_one,
                                                   .residual = {near, 1 + p},
                                                   .sum = moray_at_most(3)}};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp,
                           &(moray_ocp_spec){
                               .phases = 2, .phase = phase, .ne = 2, .e = MORAY_BOUNDS_OF(near), .endpoint = judge}),
             "both observed");
    CHECK_ALL(ocp, moray_endpoint_input_name, "initial state x[0] of phase up", "initial time of phase up",
              "final state x[0] of phase up", "final time of phase up", "initial state x[0] of phase down",
              "initial time of phase down", "final state x[0] of phase down", "final time of phase down",
              "state x[0] of phase up observed at t = 1.5", "state x[0] of phase up observed at t = 1.25",
              "state x[0] of phase down observed at t = 1.5", "control u[0] of phase down observed at t = 1.5",
              "control u[1] of phase down observed at t = 1.5", "state x[0] of phase down observed at t = 1.25");
    CHECK_ALL(ocp, moray_endpoint_output_name, "objective", "event e[0]", "event e[1]",
              "residual y[0] of phase up at t = 1.5", "residual y[0] of phase up at t = 1.25",
              "sum of the observations of phase up", "residual y[0] of phase down at t = 1.5",
              "residual y[1] of phase down at t = 1.5", "residual y[0] of phase down at t = 1.25",
              "residual y[1] of phase down at t = 1.25", "residual y[0] of phase down at t = 1.75",
              "residual y[1] of phase down at t = 1.75", "sum of the observations of phase down");
    moray_ocp_free(ocp);
}

int main(void)
{
    test_named();
    test_numbered();
    test_both_observed();
    return tap_done();
}
