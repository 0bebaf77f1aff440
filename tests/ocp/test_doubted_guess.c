// SPDX-License-Identifier: MIT
//
// A guess that stays where it starts does not size what moves far from there.
#include "tap.h"

#include <stdlib.h>

#include "moray/ocp.h"

#include "ocp/guess_sizes.h"

enum { place, slow, fast, states };
static const double span = 20, most = 0.5, gain = 3, decay = 40;

// Of two followers of a boxed place one hardly goes back on its own, the other at once.
static void follow(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[place] = at->u[0];
    out->f[slow] = gain * at->x[place];
    out->f[fast] = gain * at->x[place] - decay * at->x[fast];
    out->g[0] = at->x[slow] * at->x[slow] + at->x[fast] * at->x[fast];
}

static void integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

// Sizes of a problem's inputs where their guesses are constant.
static void check_sizes(const moray_phase_spec *phase, const double guess[states + 1], enum sized_by point,
                        const double expected[states + 1])
{
    const moray_ocp_spec spec = {.phases = 1, .phase = phase, .endpoint = integral};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    moray_ocp *ocp;
    double size[states + 1];
    settings.max_iterations = 0;
    settings.scheme = "radau3";
    settings.intervals = 5;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "problem");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    for (int n = 0; n < layout->nodes; n++)
        for (int r = 0; r < states + layout->node[n].collocated; r++)
            solution->iterate.x[layout->node[n].x + r] = guess[r];
    CHECK_OK(moray_choose_scales(t, solution->iterate.x, point), "the caches are of this point");
    moray_size_inputs(t, 0, solution->iterate.x, point, size);
    for (int r = 0; r <= states; r++)
        CHECK_NEAR(size[r] / expected[r], 1, 1e-12, point == by_guess ? "by causes and effects" : "as it was found");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_followers(const double guess[states + 1], enum sized_by point, const double expected[states + 1])
{
    const moray_phase_spec phase = {.nx = states,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = follow,
                                    .t0 = moray_fixed(2),
                                    .tf = moray_fixed(2 + span),
                                    .x = MORAY_BOUNDS(moray_between(-most, most), moray_free(), moray_free()),
                                    .x0 = MORAY_BOUNDS(moray_free(), moray_fixed(guess[slow]), moray_free())};
    check_sizes(&phase, guess, point, expected);
}

// The last state drives that before it, and so on.
static void drive(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 2 * at->x[1];
    out->f[1] = gain * at->x[2];
    out->f[2] = at->u[0];
    out->g[0] = at->x[0] * at->x[0];
}

static void test_chain(void)
{
    const moray_phase_spec phase = {.nx = states,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = drive,
                                    .tf = moray_fixed(span),
                                    .x = MORAY_BOUNDS(moray_free(), moray_free(), moray_between(-most, most))};
    const double second = gain * most * span, first = 2 * second * span;
    check_sizes(&phase, (double[]){1e-5, 1e-6, 1e-3, 1e-7}, by_guess, (double[]){first, second, most, most / span});
}

int main(void)
{
    const double by_place = gain * most * span, by_control = most / span;
    // The fast follower could not come to more than its cause allows, 1 / (1 + decay span) of by_place.
    const double steady = by_place / (1 + decay * span), tiny[] = {1e-5, 2e-6, 3e-5, 4e-6};
    test_followers(tiny, by_guess, (double[]){most, by_place, by_place, by_control});
    const double fair[] = {1e-5, by_place / 999, steady / 999, by_control / 999};
    test_followers(fair, by_guess, (double[]){most, fair[slow], fair[fast], fair[3]});
    const double less[] = {1e-5, by_place / 1001, steady / 999, by_control / 1001};
    test_followers(less, by_guess, (double[]){most, by_place, less[fast], by_control});
    test_followers(less, by_solution, (double[]){less[place], less[slow], less[fast], less[3]});
    test_followers(less, by_other_mesh, (double[]){most, less[slow], less[fast], less[3]});
    test_chain();
    return tap_done();
}
