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

// Sizes where states and control are guessed to be as small as `rest` all along.
static void check_sizes(const double guess[states + 1], bool found, const double expected[states + 1])
{
    const moray_phase_spec phase = {.nx = states,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = follow,
                                    .t0 = moray_fixed(2),
                                    .tf = moray_fixed(2 + span),
                                    .x = MORAY_BOUNDS(moray_between(-most, most), moray_free(), moray_free()),
                                    .x0 = MORAY_BOUNDS(moray_free(), moray_fixed(guess[slow]), moray_free())};
    const moray_ocp_spec spec = {.phases = 1, .phase = &phase, .endpoint = integral};
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
    CHECK_OK(moray_choose_scales(t, solution->iterate.x, found), "the caches are of this point");
    moray_size_inputs(t, 0, solution->iterate.x, found, size);
    for (int r = 0; r <= states; r++)
        CHECK_NEAR(size[r] / expected[r], 1, 1e-12, found ? "as it was found" : "by causes and effects");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    const double by_place = gain * most * span, by_control = most / span;
    // The fast follower could not come to more than its cause allows, 1 / (1 + decay span) of by_place.
    const double steady = by_place / (1 + decay * span), tiny[] = {1e-5, 2e-6, 3e-5, 4e-6};
    check_sizes(tiny, false, (double[]){most, by_place, tiny[fast] * 1e3 < steady ? by_place : tiny[fast], by_control});
    const double fair[] = {1e-5, by_place / 999, steady / 999, by_control / 999};
    check_sizes(fair, false, (double[]){most, fair[slow], fair[fast], fair[3]});
    const double less[] = {1e-5, by_place / 1001, steady / 999, by_control / 1001};
    check_sizes(less, false, (double[]){most, by_place, less[fast], by_control});
    check_sizes(less, true, (double[]){less[place] * 1e3 < most && less[place] > 1e-6 * most ? less[place] : most,
                                       less[slow], less[fast], less[3]});
    return tap_done();
}
