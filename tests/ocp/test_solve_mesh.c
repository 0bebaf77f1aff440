// SPDX-License-Identifier: MIT
//
// A solve on one mesh of a campaign that is made by hand: when it starts warm, what time is left to it, and what is
// told of it.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/refinement/campaign.h"

enum { phases = 2, most_records = 40 };

// x' = u from 0 to 1 in a time of 1, where u <= 1.5 and u is to be 4 - 3 x: at its limit, then below.
static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num off = at->u[0] + 3 * at->x[0] - 4;
    out->f[0] = at->u[0];
    out->g[0] = off * off;
}

static void pay(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + 2 * at->phase[1].q[0];
    for (int k = 0; k < 3; k++)
        out->e[k] = at->phase[k % 2].xf[0];
}

static void see(const moray_node *at, moray_num *seen, const void *data)
{
    (void)data;
    seen[0] = at->x[0];
}

enum kind { plain, holding, with_data };

static moray_ocp *make(enum kind kind)
{
    static const moray_bounds u = {-1, 1.5}, x0 = {0, 0}, xf = {1, 1}, free = {-MORAY_INFINITY, MORAY_INFINITY};
    static const bool held[] = {true};
    static const double time[] = {0.4}, value[] = {0.5};
    const moray_bounds e[] = {free, free, free};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.nx = 1,
                                      .nu = 1,
                                      .nq = 1,
                                      .continuous = go,
                                      .tf = moray_fixed(1),
                                      .x0 = {&x0, 1},
                                      .xf = {&xf, 1},
                                      .u = {&u, 1}};
    if (kind == holding)
        phase[1].held = held, phase[1].intervals = 4;
    if (kind == with_data) {
        phase[1].tf = moray_between(0.9, 1.1);
        phase[1].observed =
            (moray_observations){.n = 1, .ny = 1, .time = time, .value = value, .observe = see, .events_only = true};
    }
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp,
                           &(moray_ocp_spec){
                               .phases = phases, .phase = phase, .ne = 3, .e = MORAY_BOUNDS_OF(e), .endpoint = pay}),
             "a problem");
    return ocp;
}

// ---- A campaign ----

struct trial {
    moray_settings settings;
    struct campaign c;
    moray_solution *solution;
    int lines;  // of progress
    double far; // from feasible in the first line
};

static bool stop(void *observer, const moray_progress *progress)
{
    (void)progress;
    return *(const bool *)observer;
}

static void begin(struct trial *trial, const moray_ocp *ocp)
{
    *trial = (struct trial){.settings = moray_settings_default()};
    struct campaign *c = &trial->c;
    c->ocp = ocp;
    c->settings = &trial->settings;
    c->meshes = calloc(phases, sizeof *c->meshes);
    c->history = calloc(most_records, sizeof *c->history);
    c->iterations = calloc(1, sizeof *c->iterations);
    for (int p = 0; p < phases; p++)
        CHECK_OK(moray_mesh_uniform(&c->meshes[p], 4, (struct method){MORAY_RADAU, 3}), "mesh");
}

static void run(struct trial *trial, const moray_guess *guess)
{
    struct campaign *c = &trial->c;
    c->iterations->progress = trial->settings.progress;
    c->iterations->observer = trial->settings.observer;
    CHECK_OK(moray_campaign_solve_widened(c, guess, &trial->solution), "solved");
    trial->lines = c->iterations->n;
    trial->far = trial->lines > 0 ? c->iterations->at[0].infeasibility : NAN;
}

static void end(struct trial *trial)
{
    moray_campaign_free_meshes(&trial->c);
    free(trial->c.meshes);
    free(trial->c.history);
    moray_iterations_free(trial->c.iterations);
    if (trial->solution)
        moray_campaign_drop(trial->solution);
}

// ---- Warm or not ----

// A cold start is moved off its bounds, and so off a solution.
static bool is_warm(const struct trial *trial)
{
    CHECK(trial->far < 1e-6 || trial->far > 1e-3, "either way: %.1e", trial->far);
    return trial->far < 1e-6;
}

static moray_solution *solve(const moray_ocp *ocp)
{
    moray_solution *solution;
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.intervals = 4;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    solution->history[0].error = 1e-3;
    return solution;
}

static bool warm_from(const moray_ocp *ocp, const moray_solution *from, bool along_time)
{
    struct trial trial;
    begin(&trial, ocp);
    const moray_guess guess = {.from = from, .along_time = along_time};
    run(&trial, &guess);
    CHECK(moray_is_solved(trial.solution), "solved");
    const bool warm = is_warm(&trial);
    CHECK(!warm || trial.solution->info.iterations <= 3, "with its multipliers in %d iterations",
          trial.solution->info.iterations);
    end(&trial);
    return warm;
}

static void test_warm(void)
{
    static const struct {
        double error;
        bool warm;
    } errors[] = {{0.9e-2, true}, {1e-2, false}, {1.1e-2, false}, {NAN, false}, {0, true}};
    static const struct {
        moray_nlp_outcome outcome;
        bool warm;
    } outcomes[] = {{MORAY_NLP_SOLVED, true},
                    {MORAY_NLP_ACCEPTABLE, true},
                    {MORAY_NLP_STALLED, false},
                    {MORAY_NLP_ITERATION_LIMIT, false}};
    moray_ocp *ocp = make(plain), *other = make(plain);
    moray_solution *from = solve(ocp);
    for (int k = 0; k < 5; k++) {
        from->history[0].error = errors[k].error;
        CHECK(warm_from(ocp, from, false) == errors[k].warm, "from an error of %g", errors[k].error);
    }
    from->history[0].error = 1e-3;
    for (int k = 0; k < 4; k++) {
        from->info.outcome = outcomes[k].outcome;
        CHECK(warm_from(ocp, from, false) == outcomes[k].warm, "from what is %s",
              moray_nlp_outcome_text(outcomes[k].outcome));
    }
    from->info.outcome = MORAY_NLP_SOLVED;
    CHECK(!warm_from(other, from, false), "not from another problem");
    struct trial trial;
    begin(&trial, ocp);
    run(&trial, NULL);
    CHECK(!is_warm(&trial), "nor from nothing");
    end(&trial);
    moray_solution_free(from);
    moray_ocp_free(ocp);
    moray_ocp_free(other);
    for (int kind = holding; kind <= with_data; kind++) {
        ocp = make((enum kind)kind);
        from = solve(ocp);
        CHECK(!warm_from(ocp, from, false), "nor where a phase has rows of its own");
        moray_solution_free(from);
        moray_ocp_free(ocp);
    }
}

// What did not get anywhere warm is begun again cold, unless it was stopped.
static void test_again(void)
{
    static bool go_on = true, halt = false;
    moray_ocp *ocp = make(plain);
    moray_solution *from = solve(ocp);
    const moray_guess guess = moray_guess_from_solution(from);
    for (int k = 0; k < 4; k++) {
        const bool warm = k % 2, halted = k / 2;
        struct trial trial;
        begin(&trial, ocp);
        from->iterate.x[from->transcription->layout.phase[0].node[2].x] += 0.1; // so that there is something to do
        trial.settings.max_iterations = 0;
        trial.settings.progress = stop;
        trial.settings.observer = halted ? &halt : &go_on;
        run(&trial, warm ? &guess : NULL);
        CHECK(trial.lines == (warm && !halted ? 2 : 1), "%s: begun %d times", warm ? "warm" : "cold", trial.lines);
        CHECK(trial.solution->info.outcome == (halted ? MORAY_NLP_INTERRUPTED : MORAY_NLP_ITERATION_LIMIT), "%s",
              moray_nlp_outcome_text(trial.solution->info.outcome));
        end(&trial);
    }
    moray_solution_free(from);
    moray_ocp_free(ocp);
}

// Moved on along time, a start is warm but its barrier that of the settings.
static void test_barrier(void)
{
    int iterations[2][2];
    moray_ocp *ocp = make(plain);
    moray_solution *from = solve(ocp);
    for (int along = 0; along < 2; along++)
        for (int high = 0; high < 2; high++) {
            struct trial trial;
            begin(&trial, ocp);
            trial.settings.barrier = high ? 0.1 : 1e-8;
            run(&trial, &(moray_guess){.from = from, .along_time = along});
            iterations[along][high] = trial.solution->info.iterations;
            CHECK(is_warm(&trial), "warm");
            end(&trial);
        }
    CHECK(iterations[0][0] == iterations[0][1], "no matter what the settings have");
    CHECK(iterations[1][0] < iterations[1][1], "which matters along time: %d, %d", iterations[1][0], iterations[1][1]);
    moray_solution_free(from);
    moray_ocp_free(ocp);
}

// ---- Time and scales ----

static void test_settings(void)
{
    static const struct {
        double most, spent, left;
    } cases[] = {{100, 30, 70}, {40, 39.5, 0.5}, {10, 30, 1e-3}, {0, 30, 0}, {30, 30, 1e-3}};
    moray_ocp *ocp = make(plain);
    for (int k = 0; k < 5; k++) {
        struct trial trial;
        begin(&trial, ocp);
        trial.settings.max_cpu_seconds = cases[k].most;
        trial.c.spent = cases[k].spent;
        trial.settings.own_scaling = k % 2;
        run(&trial, NULL);
        const moray_solution *solution = trial.solution;
        CHECK_NEAR(solution->settings.max_cpu_seconds, cases[k].left, 1e-12, "seconds that are left");
        CHECK(trial.c.spent == cases[k].spent + solution->info.cpu_seconds, "and what was spent");
        CHECK((solution->transcription->nlp.x_scale != NULL) == k % 2, "scales of our own or of the solver's");
        CHECK(solution->iterations == trial.c.iterations && !solution->history, "the campaign's iterations");
        end(&trial);
    }
    moray_ocp_free(ocp);
}

// ---- Records ----

static void test_record(void)
{
    moray_ocp *ocp = make(plain);
    struct trial trial;
    begin(&trial, ocp);
    moray_mesh_free(&trial.c.meshes[1]);
    CHECK_OK(moray_mesh_uniform(&trial.c.meshes[1], 7, (struct method){MORAY_RADAU, 2}), "a finer mesh");
    run(&trial, NULL);
    moray_solution *solution = trial.solution;
    solution->info.iterations = 5, solution->info.seconds = 2.5, solution->iterate.objective = -3;
    solution->info.outcome = MORAY_NLP_ACCEPTABLE, solution->info.linear_solver = MORAY_LINEAR_MUMPS;
    trial.c.tried = 2;
    moray_campaign_record(&trial.c, solution, 0.125, 4);
    const moray_mesh_record *record = &trial.c.history[2];
    CHECK(record->intervals == 4 + 7 && record->nodes == 13 + 15 && record->variables == 2 * (13 + 15),
          "%d intervals, %d nodes, %d variables", record->intervals, record->nodes, record->variables);
    CHECK(record->outcome == MORAY_NLP_ACCEPTABLE && record->linear_solver == MORAY_LINEAR_MUMPS &&
              record->iterations == 5 && record->seconds == 2.5 && record->error == 0.125 && record->objective == -3 &&
              record->dependences == 4 && record->seen == 0 && !record->changed_to,
          "and what the solver told");
    CHECK(trial.c.tried == 3 && solution->meshes == 3 && solution->history == trial.c.history, "three were tried");
    CHECK(trial.c.history[1].nodes == 0 && trial.c.history[3].nodes == 0, "of which the others are as they were");
    end(&trial);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_warm();
    test_again();
    test_barrier();
    test_settings();
    test_record();
    return tap_done();
}
