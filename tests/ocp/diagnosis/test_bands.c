// SPDX-License-Identifier: MIT
//
// Every column and row of a programme is in one band, at its place, and stands where its bounds say.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/diagnosis/bands.h"

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    for (int i = 0; i < 2; i++)
        out->f[i] = at->u[i] + at->u[2];
    for (int i = 0; i < 2; i++)
        out->c[i] = at->x[i];
    for (int i = 0; i < 2; i++)
        out->g[i] = at->u[i];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->s[0];
    out->e[0] = at->phase[0].xf[0];
    out->e[1] = at->phase[1].xf[1];
}

static moray_solution *begin(moray_ocp **ocp, const char *scheme)
{
    const moray_bounds some = moray_between(-9, 9);
    const moray_phase_spec base = {.nx = 2,
                                   .nu = 3,
                                   .nc = 2,
                                   .nq = 2,
                                   .continuous = drift,
                                   .t0 = moray_between(0, 2),
                                   .tf = moray_between(1, 3),
                                   .duration = moray_between(0.5, 2),
                                   .c = MORAY_BOUNDS(some, some)};
    moray_phase_spec phase[] = {base, base};
    static const char *const x_names[] = {"way", "speed"}, *const u_names[] = {"push", "pull", "lift"};
    phase[0].name = "out", phase[1].name = "home";
    phase[1].x_names = x_names, phase[1].u_names = u_names;
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = scheme;
    settings.intervals = 3;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2,
                                                  .phase = phase,
                                                  .ns = 2,
                                                  .s = MORAY_BOUNDS(some, some),
                                                  .ne = 2,
                                                  .e = MORAY_BOUNDS(some, some),
                                                  .endpoint = verdict}),
             "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

struct tally {
    const moray_solution *solution;
    int columns[400], rows[400], bands;
};

// Which of a node's columns, by the layout of x and u at it, a member of a band must be.
static void count(const struct band *band, void *self)
{
    struct tally *tally = self;
    const struct transcription *t = tally->solution->transcription;
    tally->bands++;
    for (int n = 0; n < moray_band_members(t, band); n++) {
        const int member = moray_band_member(t, band, n);
        if (member != absent)
            (band->rows ? tally->rows : tally->columns)[member]++;
    }
}

static void test_all(const char *scheme)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, scheme);
    struct tally tally = {.solution = solution};
    const moray_nlp *nlp = &tally.solution->transcription->nlp;
    moray_visit_bands(tally.solution->transcription, count, &tally);
    int odd = 0;
    for (int j = 0; j < 400; j++)
        odd += (tally.columns[j] != (j < nlp->n)) + (tally.rows[j] != (j < nlp->m));
    CHECK(odd == 0, "%s: %d columns and rows, of %d and %d, are not in one band", scheme, odd, nlp->n, nlp->m);
    CHECK(tally.bands == 2 * (2 + 3 + 2 + 2 + 2 + 1 + 4) + 4, "%d bands", tally.bands);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_names(void)
{
    static const struct {
        struct band band;
        const char *name;
    } named[] = {{{band_state, false, 1, 1}, "state speed of phase home"},
                 {{band_state, false, 0, 1}, "state x[1] of phase out"},
                 {{band_control, false, 1, 0}, "control push of phase home"},
                 {{band_control, false, 1, 2}, "control lift of phase home"},
                 {{band_path, true, 0, 1}, "path constraint c[1] of phase out"},
                 {{band_dynamics, true, 1, 0}, "dynamics of state way of phase home"}};
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, "radau3");
    char text[200];
    for (size_t k = 0; k < sizeof named / sizeof *named; k++) {
        moray_band_name(solution, &named[k].band, text, sizeof text);
        CHECK(strcmp(text, named[k].name) == 0, "\"%s\" is \"%s\"", text, named[k].name);
    }
    const struct transcription *t = solution->transcription;
    const struct band column = {band_single, false, -1, t->layout.s + 1},
                      row = {band_single, true, -1, t->layout.events + 1};
    moray_band_name(solution, &column, text, sizeof text);
    CHECK(strstr(text, "s[1]"), "a parameter is \"%s\"", text);
    moray_band_name(solution, &row, text, sizeof text);
    CHECK(strstr(text, "e[1]"), "an event is \"%s\"", text);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// By the scaled distance, less than 1e-5.
static void test_standing(void)
{
    static const struct {
        double value, lower, upper, scale;
        bool fixed, at_lower, at_upper;
    } cases[] = {{1, 0, 2, 1, false, false, false},
                 {0.9e-5, 0, 2, 1, false, true, false},
                 {1.1e-5, 0, 2, 1, false, false, false},
                 {1.1e-5, 0, 2, 0.5, false, true, false},
                 {0.9e-5, 0, 2, 2, false, false, false},
                 {2 - 0.9e-5, 0, 2, 1, false, false, true},
                 {2 - 1.1e-5, 0, 2, 1, false, false, false},
                 {2 - 1.1e-5, 0, 2, 0.5, false, false, true},
                 {-1, 0, 2, 1, false, true, false},
                 {3, 0, 2, 1, false, false, true},
                 {2, 2, 2, 1, true, true, true},
                 {-1e30, -MORAY_INFINITY, 2, 1, false, false, false},
                 {1e30, 0, MORAY_INFINITY, 1, false, false, false}};
    enum { i = 5, most = 400 };
    static double lower[most], upper[most], scale[most];
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, "radau3");
    moray_nlp *nlp = &solution->transcription->nlp;
    const moray_nlp before = *nlp;
    nlp->x_lower = nlp->g_lower = lower, nlp->x_upper = nlp->g_upper = upper, nlp->x_scale = nlp->g_scale = scale;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int row = 0; row < 2; row++) {
            *(row ? &solution->iterate.g[i] : &solution->iterate.x[i]) = cases[k].value;
            lower[i] = cases[k].lower, upper[i] = cases[k].upper, scale[i] = cases[k].scale;
            const struct standing s = moray_standing_of(solution, row, i);
            CHECK(s.value == cases[k].value && s.lower == cases[k].lower && s.upper == cases[k].upper &&
                      s.scale == cases[k].scale && s.fixed == cases[k].fixed && s.at_lower == cases[k].at_lower &&
                      s.at_upper == cases[k].at_upper,
                  "case %zu of a %s: fixed %d, at its bounds %d %d", k, row ? "row" : "column", s.fixed, s.at_lower,
                  s.at_upper);
        }
    nlp->x_scale = NULL;
    CHECK(moray_standing_of(solution, false, i).scale == 1, "without scales: 1");
    *nlp = before;
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_all("lobatto3");
    test_all("radau3");
    test_all("gauss2");
    test_names();
    test_standing();
    return tap_done();
}
