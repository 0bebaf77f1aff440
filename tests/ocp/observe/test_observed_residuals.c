// SPDX-License-Identifier: MIT
//
// Residuals of a solution: which they are, in which order, and what their channels are called.
#include "observe.h"

static void fall(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->t;
}

static void see_twice(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = 3 * at->x[0];
    y[1] = at->s[0] - at->t;
}

static const double times[2][3] = {{0.5, 0.25, 1}, {2, 1.5}};
static const double values[2][6] = {{1, 2, NAN, 3, 4, NAN}, {5, 6, 7, 8}};
static const double weights[2][2] = {{0.5, 2}, {3, 0}};
static const char *const channels[] = {"height", "clock"};

static moray_solution *solve_two(moray_ocp **ocp)
{
    const moray_bounds start[2][1] = {{moray_fixed(2)}, {moray_fixed(-1)}};
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.nx = 1,
                                      .continuous = fall,
                                      .t0 = moray_fixed(p),
                                      .tf = moray_fixed(p + 1),
                                      .x0 = MORAY_BOUNDS_OF(start[p]),
                                      .observed = {.n = 3 - p,
                                                   .ny = 2,
                                                   .time = times[p],
                                                   .value = values[p],
                                                   .weight = weights[p],
                                                   .observe = see_twice,
                                                   .names = p ? channels : NULL}};
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .ns = 1, .endpoint = nothing}),
             "two phases");
    return solve(*ocp, &settings, NULL);
}

// The states are 2 + t^2 / 2 and -1 + (t^2 - 1) / 2, and s the weighted mean of clocks, of which the last weigh
// nothing.
static void test_residuals(const moray_solution *solution)
{
    static const struct {
        int phase, row, channel;
    } want[] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 2, 0}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}};
    enum { all = sizeof want / sizeof *want };
    const double s = ((2 + 0.5) + (3 + 0.25)) / 2;
    moray_residual got[all];
    CHECK(moray_solution_residuals(solution, NULL) == all && moray_solution_residuals(solution, got) == all,
          "those that are there, asked for or counted");
    for (int i = 0; i < all; i++) {
        const int p = want[i].phase, k = want[i].row, j = want[i].channel;
        const double t = times[p][k], x = p ? -1 + (t * t - 1) / 2 : 2 + t * t / 2;
        CHECK(got[i].phase == p && got[i].row == k && got[i].channel == j && got[i].time == t &&
                  got[i].observed == values[p][2 * k + j] && got[i].weight == weights[p][j],
              "residual %d: phase %d, time %d, channel %d", i, got[i].phase, got[i].row, got[i].channel);
        CHECK_NEAR(got[i].predicted, j ? s - t : 3 * x, 1e-7, "what is predicted");
    }
}

static void check_name(const moray_solution *solution, int phase, int channel, int size, const char *expected)
{
    char text[20];
    moray_observation_name(solution, phase, channel, text, size);
    CHECK(strcmp(text, expected) == 0, "channel %d of phase %d: %s", channel, phase, text);
}

int main(void)
{
    moray_ocp *ocp;
    moray_solution *solution = solve_two(&ocp);
    test_residuals(solution);
    check_name(solution, 0, 0, 20, "y[0]");
    check_name(solution, 0, 1, 20, "y[1]");
    check_name(solution, 1, 0, 20, "height");
    check_name(solution, 1, 1, 20, "clock");
    check_name(solution, 1, 0, 4, "hei");
    check_name(solution, 0, 1, 3, "y[");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return tap_done();
}
