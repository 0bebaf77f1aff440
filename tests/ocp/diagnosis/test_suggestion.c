// SPDX-License-Identifier: MIT
//
// What a diagnosis suggests, by what it counts: functions that are not finite as often as a test wants, variables that
// run as far as it wants, texts as long as an error has room for.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/solution.h"

// ---- A cart x' = v, v' = u whose functions are not finite when told ----

static int spoilt; // evaluations to come

static void value(void *self, const double *in, double *out)
{
    const double *of_place = self;
    out[0] = in[1];
    out[1] = spoilt > 0 ? NAN : in[2];
    out[2] = *of_place * in[0];
    spoilt -= spoilt > 0;
}

static void jacobian(void *self, const double *in, double *values)
{
    (void)in;
    values[0] = 1;
    values[1] = 1;
    values[2] = *(const double *)self;
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in, (void)weight, (void)values;
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

// The iterations after which the next point is spoilt.
static bool spoil(void *observer, const moray_progress *progress)
{
    const int *times = observer;
    if (progress->iteration >= 1 && progress->iteration <= *times)
        spoilt = 1;
    return true;
}

typedef struct ride {
    double of_place; // in the integrand: below 0 it goes for ever
    moray_bounds end, force;
    int spoilt, iterations;
    const char *state;
    const moray_guess *guess;
} ride;

static moray_solution *run(moray_ocp **ocp, const ride *at)
{
    static int jr[] = {0, 1, 2}, jc[] = {1, 2, 0};
    const char *x_names[] = {at->state ? at->state : "place", "speed"};
    double of_place = at->of_place;
    int times = at->spoilt;
    const moray_map map = {.self = &of_place,
                           .n_in = 4,
                           .n_out = 3,
                           .jac = {3, jr, jc},
                           .value = value,
                           .jacobian = jacobian,
                           .hessian = hessian};
    const moray_phase_spec phase = {.name = "cart",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .map = &map,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(at->end, moray_fixed(0)),
                                    .u = MORAY_BOUNDS(at->force),
                                    .x_names = x_names};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.max_iterations = at->iterations;
    settings.intervals = 10;
    settings.progress = spoil;
    settings.observer = &times;
    spoilt = 0;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.name = "cart", .phases = 1, .phase = &phase, .endpoint = total}),
             "cart");
    CHECK_OK(moray_solve(*ocp, &settings, at->guess, &solution), "runs");
    return solution;
}

static bool says(const moray_solution *solution, const char *text)
{
    return strstr(moray_solution_diagnosis(solution), text) != NULL;
}

// Where it ran out of iterations, of which half were lost so; a solver that gave up had no need of as many.
static void test_not_finite(void)
{
    bool fewer = false, half = false, more = false;
    moray_ocp *ocp;
    for (int k = 0; k <= 9; k++) {
        const ride endless = {
            .of_place = -1, .end = moray_free(), .force = moray_free(), .spoilt = k, .iterations = 10};
        moray_solution *solution = run(&ocp, &endless);
        const int failures = solution->transcription->failures;
        CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_ITERATION_LIMIT &&
                  moray_solution_info(solution)->iterations == 10,
              "out of iterations");
        CHECK(says(solution, "Try: bounds that keep the functions in their domain. Last, dynamics of state speed") ==
                  (failures >= 5),
              "of ten iterations %d not finite: %s", failures, strstr(moray_solution_diagnosis(solution), "Try: "));
        fewer |= failures == 4, half |= failures == 5, more |= failures > 5;
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    CHECK(fewer && half && more, "fewer than half, half, more");
    const ride too_far = {.end = moray_fixed(1), .force = moray_between(-1, 1), .spoilt = 1, .iterations = 500};
    moray_solution *solution = run(&ocp, &too_far);
    CHECK(moray_solution_info(solution)->outcome != MORAY_NLP_ITERATION_LIMIT && !moray_is_solved(solution) &&
              moray_solution_info(solution)->iterations > 2 * solution->transcription->failures,
          "gave up after %d iterations, %d not finite", moray_solution_info(solution)->iterations,
          solution->transcription->failures);
    CHECK(says(solution, "Try: bounds that keep the functions in their domain."), "which counts then");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- What runs away ----

static void test_how_far(double of_place)
{
    const double time[] = {0, 0.5, 1}, x[6] = {0}, u[] = {-70, 0, 30};
    const moray_samples samples = {3, time, x, u};
    const ride endless = {.of_place = of_place,
                          .end = moray_free(),
                          .force = moray_free(),
                          .iterations = 100,
                          .guess = &(moray_guess){.phase = &samples}};
    moray_ocp *ocp;
    double node[100], low = 0, high = 0, told = 0, guessed = 0;
    char side[20] = "";
    moray_solution *solution = run(&ocp, &endless);
    const int nodes = moray_solution_nodes(solution, 0, NULL, NULL);
    moray_solution_nodes(solution, 0, node, NULL);
    for (int n = 0; n < nodes; n++) {
        double force;
        moray_solution_at(solution, 0, node[n], NULL, &force);
        low = fmin(low, force), high = fmax(high, force);
    }
    const char *line = strstr(moray_solution_diagnosis(solution), "Try: ");
    CHECK(line && sscanf(line,
                         "Try: a%*[n ]%19s bound for control u[0] of phase cart, which went to %lf from a guess of at "
                         "most %lf.",
                         side, &told, &guessed) == 3,
          "%s", line ? line : "nothing");
    printf("# from %g to %g\n", low, high);
    const double furthest = high > -low ? high : low;
    CHECK(strcmp(side, furthest > 0 ? "upper" : "lower") == 0, "an end on that side");
    CHECK_NEAR(told, furthest, 0.01 * fabs(furthest), "the largest force");
    CHECK_NEAR(guessed, 70, 0.5, "the largest of the guess");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void gain(const moray_ends *at, moray_end_values *out, const void *data)
{
    const double *share = data;
    out->objective = -share[0] * at->s[0] - share[1] * at->s[1];
}

static void rest(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->x[0];
}

// Named is what went furthest, and of two that went as far the first.
static void test_runs_furthest(void)
{
    static const double share[][2] = {{1, 1}, {1, 2}, {2, 1}, {-1, -1}};
    static const char *const texts[] = {
        "Try: an upper bound for parameter here, ", "Try: an upper bound for parameter there, ",
        "Try: an upper bound for parameter here, ", "Try: a lower bound for parameter here, "};
    static const char *const s_names[] = {"here", "there"};
    const moray_phase_spec phase = {
        .name = "still", .nx = 1, .continuous = rest, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(1))};
    const moray_settings settings = moray_settings_default();
    for (int k = 0; k < 4; k++) {
        const moray_ocp_spec spec = {.name = "still",
                                     .phases = 1,
                                     .phase = &phase,
                                     .ns = 2,
                                     .s_names = s_names,
                                     .endpoint = gain,
                                     .data = share[k]};
        moray_ocp *ocp;
        moray_solution *solution = NULL;
        CHECK_OK(moray_ocp_new(&ocp, &spec), "still");
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "runs");
        CHECK(!moray_is_solved(solution) && says(solution, texts[k]), "%s",
              strstr(moray_solution_diagnosis(solution), "Try: "));
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// ---- As an error ----

// A diagnosis that the text of an error just holds is whole there; of one that is longer by a byte lines are left out.
static void test_length(void)
{
    enum { most = sizeof((moray_status *)0)->text - 1 };
    bool just = false, beyond = false;
    char name[90] = "";
    for (size_t k = 0; k + 1 < sizeof name; k++) {
        moray_ocp *ocp;
        name[k] = 'x';
        const ride short_of = {.of_place = -1, .end = moray_free(), .force = moray_free(), .state = name};
        moray_solution *solution = run(&ocp, &short_of);
        const size_t length = strlen(moray_solution_diagnosis(solution));
        const moray_status failure = moray_solution_failure(solution);
        if (length == most || length == most + 1)
            CHECK((strstr(failure.text, "Furthest from the guess: ") != NULL) == (length == most), "%zu bytes: %s",
                  length, failure.text);
        just |= length == most, beyond |= length == most + 1;
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    CHECK(just && beyond, "both were met");
}

int main(void)
{
    test_not_finite();
    test_how_far(-1);
    test_how_far(1);
    test_runs_furthest();
    test_length();
    return tap_done();
}
