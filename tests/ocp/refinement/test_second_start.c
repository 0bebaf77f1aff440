// SPDX-License-Identifier: MIT
//
// The second start: what the dynamics do with controls beside the middle of their bounds, in closed form.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/refinement/second_start.h"

enum { PHASES = 2, NX = 2, NU = 4 };
static const double span[PHASES][2] = {{-1, 2}, {2, 3.5}}, start[PHASES][NX] = {{0.5, -3}, {40, 7}};
static bool defined;

// Of the time, the parameter and the first control; and its integral. Polynomials that four stages make no error of.
static void glide(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] + at->s[0] * 3 * at->t * at->t + (defined || creal(at->t) < 1 ? 0 : NAN);
    out->f[1] = at->x[0] + at->u[1] * at->u[2] + 0 * at->u[3];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0] + at->phase[1].xf[1];
}

static double exact(int p, int i, double t, const double *u, double s)
{
    const double t0 = span[p][0], since = t - t0, t03 = t0 * t0 * t0;
    if (i == 0)
        return start[p][0] + u[0] * since + s * (t * t * t - t03);
    return start[p][1] + start[p][0] * since + u[0] * since * since / 2 +
           s * ((t * t * t * t - t03 * t0) / 4 - t03 * since) + u[1] * u[2] * since;
}

// Widths of the controls' boxes, of which a tenth is to one side or the other, as far as there is room.
static moray_solution *begin(moray_ocp **ocp)
{
    const moray_bounds u[NU] = {moray_between(-1, 5), moray_between(-8, -2), moray_between(3, 3.1), moray_free()};
    moray_phase_spec phase = {.nx = NX, .nu = NU, .continuous = glide, .u = MORAY_BOUNDS(u[0], u[1], u[2], u[3])};
    moray_phase_spec phases[PHASES] = {phase, phase};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    for (int p = 0; p < PHASES; p++)
        phases[p].t0 = moray_fixed(span[p][0]), phases[p].tf = moray_fixed(span[p][1]);
    settings.max_iterations = 0;
    settings.intervals = 3;
    defined = true;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = PHASES,
                                                  .phase = phases,
                                                  .ns = 1,
                                                  .s = MORAY_BOUNDS(moray_between(0, 1)),
                                                  .endpoint = total}),
             "two phases");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    const struct transcription *t = solution->transcription;
    for (int p = 0; p < PHASES; p++)
        memcpy(solution->guess + t->layout.phase[p].node[0].x, start[p], sizeof start[p]);
    solution->guess[t->layout.s] = 0.25;
    return solution;
}

static void test_dynamics(void)
{
    moray_ocp *ocp = NULL;
    moray_guess guess;
    moray_solution *solution = begin(&ocp);
    const struct transcription *t = solution->transcription;
    CHECK_OK(moray_second_start(solution, &guess), "another start");
    CHECK(guess.s && guess.s[0] == 0.25, "with the parameters of the first");
    for (int p = 0; p < PHASES; p++) {
        const struct phase_layout *layout = &t->layout.phase[p];
        const moray_samples *samples = &guess.phase[p];
        const double *scale = t->nlp.x_scale + layout->node[1].x + NX,
                     *first = solution->guess + layout->node[1].x + NX;
        const double u[NU] = {first[0] + 0.1 / scale[0], first[1] - 0.1 / scale[1], 3.1, first[3] - 0.1 / scale[3]};
        CHECK(first[0] == 2 && first[1] == -5 && fabs(first[2] - 3.05) < 1e-12 && first[3] == 0, "beside the middle");
        CHECK(samples->n > 2 && samples->time[0] == span[p][0] && samples->time[samples->n - 1] == span[p][1],
              "over the whole phase");
        double worst = 0, off = 0;
        for (int k = 0; k < samples->n; k++) {
            for (int i = 0; i < NX; i++)
                worst = tap_worse(worst, fabs(samples->x[k * NX + i] - exact(p, i, samples->time[k], u, 0.25)));
            for (int r = 0; r < NU; r++)
                off = tap_worse(off, fabs(samples->u[k * NU + r] - u[r]));
        }
        CHECK(off < 1e-12, "controls beside theirs, one to one side, the next to the other: off by %.1e", off);
        CHECK(worst < 1e-10, "states where these lead: off by %.1e", worst);
    }
    moray_guess_free(&guess);
    defined = false;
    CHECK_OK(moray_second_start(solution, &guess), "functions that end on the way");
    CHECK(guess.phase == NULL, "are no start");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_dynamics();
    return tap_done();
}
