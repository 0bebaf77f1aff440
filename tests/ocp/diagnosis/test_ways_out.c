// SPDX-License-Identifier: MIT
//
// What a diagnosis suggests at a point set by hand, of two parameters and one event: the bound that stands in the way
// most, what ran away, another tolerance or another guess.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/solution.h"

enum { NS = 3 };
static double slope[2]; // of the event, along the first two parameters
static double x_scale[100], g_scale[100];

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0] + at->s[2];
    out->e[0] = slope[0] * at->s[0] + slope[1] * at->s[1];
}

// The first two parameters between 0 and 1, the third free.
static moray_solution *begin(moray_ocp **ocp, moray_bounds event)
{
    static const char *const names[] = {"one", "two", "three"}, *const goal[] = {"goal"};
    const moray_phase_spec phase = {
        .nx = 1, .continuous = still, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 2;
    slope[0] = 1, slope[1] = 0.5; // both count
    CHECK_OK(
        moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1,
                                             .phase = &phase,
                                             .ns = NS,
                                             .s = MORAY_BOUNDS(moray_between(0, 1), moray_between(0, 1), moray_free()),
                                             .s_names = names,
                                             .ne = 1,
                                             .e = MORAY_BOUNDS(event),
                                             .e_names = goal,
                                             .endpoint = ends}),
        "parameters");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    struct transcription *t = solution->transcription;
    memset(solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    for (int i = 0; i < 100; i++)
        x_scale[i] = g_scale[i] = 1;
    t->nlp.x_scale = x_scale, t->nlp.g_scale = g_scale;
    solution->info.outcome = MORAY_NLP_INFEASIBLE;
    return solution;
}

static void end(moray_solution *solution, moray_ocp *ocp)
{
    solution->transcription->nlp.x_scale = solution->transcription->nlp.g_scale = NULL;
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void check(moray_solution *solution, const char *told)
{
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
    moray_diagnose(solution);
    const char *said = strstr(moray_solution_diagnosis(solution), "Try: ");
    CHECK(said && !strcmp(said, told), "%s expected %s", said ? said : "nothing", told);
}

static const char elsewhere[] =
    "Try: another guess; no bound stands in the way, yet from here the violation does not shrink.\n";

// The event is to be `off` less than it is; each parameter is at one of its bounds, and would go the other way.
static void test_bounds(moray_bounds event, double scale)
{
    static const double slopes[][2] = {{3, -1}, {-1, 3}, {2, 2.5}, {-4, -1}, {2, 2}};
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, event);
    const struct layout *layout = &solution->transcription->layout;
    x_scale[layout->s + 1] = scale;
    g_scale[layout->events] = 1 / scale;
    for (int k = 0; k < 5; k++)
        for (int at = 0; at < 4; at++) {
            const int place[] = {at % 2, at / 2};
            double most = 0;
            char told[200];
            slope[0] = slopes[k][0], slope[1] = slopes[k][1];
            for (int j = 0; j < 2; j++)
                solution->iterate.x[layout->s + j] = place[j];
            const double value = slope[0] * place[0] + slope[1] * place[1];
            const double off = value < event.lower   ? value - event.lower
                               : value > event.upper ? value - event.upper
                                                     : 0;
            snprintf(told, sizeof told, "%s", elsewhere);
            for (int j = 0; j < 2; j++) {
                const double outward = -off * slope[j] / (scale * scale) / (j == 1 ? scale : 1);
                if (place[j] ? outward > 0 : outward < 0)
                    if (fabs(outward) > most) {
                        most = fabs(outward);
                        snprintf(told, sizeof told,
                                 "Try: a looser %s bound for parameter %s; of all bounds, the violation would give way "
                                 "to it most.\n",
                                 place[j] ? "upper" : "lower", j ? "two" : "one");
                    }
            }
            if (event.lower < event.upper && off != 0 && fabs(off) / scale > most)
                snprintf(told, sizeof told,
                         "Try: a looser %s bound for event goal; of all bounds, the violation would give way to it "
                         "most.\n",
                         off < 0 ? "lower" : "upper");
            check(solution, told);
        }
    end(solution, ocp);
}

static void test_runaway(void)
{
    static const struct {
        double value, guess, scale;
        const char *told;
    } cases[] = {
        {1.1e4, 20, 1, "Try: an upper bound for parameter three, which went to 1.1e+04 from a guess of at most 20.\n"},
        {-2.5e4, -3, 1, "Try: a lower bound for parameter three, which went to -2.5e+04 from a guess of at most 3.\n"},
        {0.99e4, 0, 1, NULL},
        {-0.99e4, 0, 1, NULL},
        {1.1e6, 0, 0.01, "Try: an upper bound for parameter three, which went to 1.1e+06 from a guess of at most 0.\n"},
        {0.9e6, 0, 0.01, NULL},
        {11, -0.5, 1e3, "Try: an upper bound for parameter three, which went to 11 from a guess of at most 0.5.\n"}};
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, moray_fixed(9));
    const struct layout *layout = &solution->transcription->layout;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        solution->iterate.x[layout->s] = solution->iterate.x[layout->s + 1] = 0.5;
        solution->iterate.x[layout->s + 2] = cases[k].value;
        solution->guess[layout->s + 2] = cases[k].guess;
        x_scale[layout->s + 2] = cases[k].scale;
        check(solution, cases[k].told ? cases[k].told : elsewhere);
    }
    x_scale[layout->s] = 2e4; // one that is bounded, however far it is
    solution->iterate.x[layout->s + 2] = 0;
    check(solution, elsewhere);
    end(solution, ocp);
}

static void test_otherwise(void)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, moray_fixed(0.75));
    double *s = solution->iterate.x + solution->transcription->layout.s;
    solution->settings.tolerance = 3e-8;
    solution->settings.max_iterations = 31;
    s[0] = s[1] = 0.5;
    check(solution, "Try: tolerance = 3e-06; rounding in the functions hides anything finer.\n");
    s[0] = 0.5 - 0.9e-6;
    check(solution, "Try: tolerance = 3e-06; rounding in the functions hides anything finer.\n");
    solution->settings.tolerance = 1e-9;
    check(solution, "Try: tolerance = 1e-06; rounding in the functions hides anything finer.\n");
    s[0] = 0.5 - 1.1e-6;
    check(solution, elsewhere);
    solution->info.outcome = MORAY_NLP_ITERATION_LIMIT;
    check(solution, "Try: more than max_iterations = 31, from this solution as the guess.\n");
    s[0] = 0, s[1] = 0; // at bounds, which are not yet to blame
    check(solution, "Try: more than max_iterations = 31, from this solution as the guess.\n");
    end(solution, ocp);
}

int main(void)
{
    for (int k = 0; k < 2; k++) {
        const double scale = k ? 4 : 1;
        test_bounds(moray_fixed(9), scale);
        test_bounds(moray_fixed(-9), scale);
        test_bounds(moray_at_least(9), scale);
        test_bounds(moray_between(-90, -9), scale);
    }
    test_runaway();
    test_otherwise();
    return tap_done();
}
