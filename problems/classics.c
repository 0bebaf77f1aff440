// SPDX-License-Identifier: MIT
//
// Textbook problems whose optimum is published, solved from the textbook's start and set beside what was printed.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "classics/picture.h"
#include "moray/app/run.h"
#include "moray/sim.h"

enum { most = 64, diagnosis_size = 600 }; // problems, characters

typedef struct classics_run {
    moray_common common;
    int refinements; // -1: each problem's own
    bool chosen[most];
    moray_ticker ticker;
    const char *solving;
} classics_run;

static const char own_scheme[] = "recommended";

static const moray_option options[] = {
    MORAY_ROW(
        INT, classics_run, refinements, "solver", "refinements", .flag = "refinements", .min = -1,
        .max = CLASSIC_MOST_MESHES - 1,
        .help = "finer meshes tried until the certificate passes; -1: 20, but none where a value belongs to its mesh"),
};

static classics_run defaults(void)
{
    classics_run run = {.common = moray_common_default(), .refinements = -1};
    strcpy(run.common.scheme, own_scheme);
    run.common.intervals = 0;
    run.common.tol = NAN;
    return run;
}

// ---- Solving -------------------------------------------------------------------------------------------------------

struct line {
    const struct classic *classic;
    moray_settings settings;
    struct classic_result result;
    char diagnosis[diagnosis_size];
};

static bool show_iteration(void *observer, const moray_progress *at)
{
    const classics_run *run = observer;
    moray_ticker_show(&run->ticker, "%s: iteration %d, objective %.6g, violation %.1e", run->solving, at->iteration,
                      at->objective, at->infeasibility);
    return !moray_interrupted();
}

static moray_status view(const struct classic *classic, const moray_ocp *ocp, const moray_solution *solution,
                         void *self)
{
    const classics_run *run = self;
    if (!run->common.output)
        return moray_ok();
    return moray_app_drawn(&run->common, "classics", classic_draw(classic, ocp, solution, run->common.output));
}

static moray_status solve(classics_run *run, struct line *line)
{
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    line->settings = classic_settings(line->classic);
    if (strcmp(run->common.scheme, own_scheme) != 0)
        line->settings.scheme = run->common.scheme;
    if (run->common.intervals > 0)
        line->settings.intervals = run->common.intervals;
    if (!isnan(run->common.tol))
        line->settings.tolerance = run->common.tol;
    line->settings.linear_solver = run->common.linear_solver;
    line->settings.ipopt = run->common.ipopt.at;
    line->settings.n_ipopt = run->common.ipopt.n;
    if (run->refinements >= 0)
        line->settings.max_refinements = run->refinements;
    line->settings.progress = show_iteration;
    line->settings.observer = run;
    run->solving = line->classic->name;
    moray_status status =
        classic_solve_viewed(line->classic, &line->settings, &integrator, &(classic_viewer){view, run}, &line->result,
                             line->diagnosis, (int)sizeof line->diagnosis);
    moray_ticker_end(&run->ticker);
    return status;
}

// ---- Showing -------------------------------------------------------------------------------------------------------

static const char *published(const struct classic *classic)
{
    return classic->published ? classic->published : "-";
}

static void print_head(void)
{
    printf("%-21s %14s %11s %10s %-11s %5s %8s  %-27s certificate\n", "problem", "optimum", "published", "difference",
           "", "iter.", "time", "intervals, mesh by mesh");
}

// "20 23 31": intervals of every mesh tried.
static void history_text(const struct classic_result *r, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int k = 0; k < r->meshes && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, k ? " %d" : "%d", r->mesh[k].intervals);
}

static void print_line(const struct line *line)
{
    const struct classic_result *r = &line->result;
    const moray_certificate *c = &r->certificate;
    char failed[500], difference[32] = "-", history[100];
    snprintf(failed, sizeof failed, "%s%s", line->classic->fixed_mesh ? "fixed mesh: " : "FAILS: ", c->why);
    if (!isnan(r->difference))
        snprintf(difference, sizeof difference, "%.1e", r->difference);
    history_text(r, history, sizeof history);
    printf("%-21s %14.10g %11s %10s %-11s %5d %6.2f s  %-27s %s\n", line->classic->name, r->value,
           published(line->classic), difference, classic_agreement(line->classic, r), r->iterations, r->seconds,
           history, c->pass ? "passes" : failed);
    if (r->outcome != MORAY_NLP_SOLVED)
        printf("    %s", line->diagnosis);
    fflush(stdout);
}

static void meshes_to_json(moray_json *json, const struct classic_result *r)
{
    moray_json_open_list(json, "meshes");
    for (int k = 0; k < r->meshes; k++) {
        moray_json_open(json, NULL);
        moray_json_text(json, "status", moray_nlp_outcome_text(r->mesh[k].outcome));
        moray_json_text(json, "linear_solver", moray_linear_solver_text(r->mesh[k].linear_solver));
        moray_json_members(json,
                           MORAY_MEMBERS({"intervals", r->mesh[k].intervals}, {"nodes", r->mesh[k].nodes},
                                         {"iterations", r->mesh[k].iterations}, {"mesh_error", r->mesh[k].error}));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void line_to_json(moray_json *json, const struct line *line)
{
    const struct classic_result *r = &line->result;
    const char *printed = line->classic->published;
    moray_json_open(json, line->classic->name);
    moray_json_text(json, "title", line->classic->title);
    moray_json_text(json, "source", line->classic->source);
    moray_json_text(json, "scheme", line->settings.scheme);
    moray_json_members(json, MORAY_MEMBERS({"intervals", line->settings.intervals}, {"optimum", r->value},
                                           {"published", printed ? strtod(printed, NULL) : NAN},
                                           {"difference", r->difference}));
    moray_json_text(json, "verdict", classic_agreement(line->classic, r));
    moray_json_open(json, "solver");
    moray_json_text(json, "status", moray_nlp_outcome_text(r->outcome));
    moray_json_number(json, "iterations", r->iterations);
    moray_json_number(json, "time_s", r->seconds);
    meshes_to_json(json, r);
    moray_json_close(json);
    moray_certificate_to_json(json, &r->certificate);
    moray_json_close(json);
}

struct lines {
    const struct line *line;
    int n;
};

static void summarise(const void *found, moray_json *json)
{
    const struct lines *lines = found;
    moray_json_open(json, "problems");
    for (int i = 0; i < lines->n; i++)
        line_to_json(json, &lines->line[i]);
    moray_json_close(json);
}

// What the page says of one problem, and its figure.
struct part {
    char text[1200], figures[80], optimum[60], row[90];
};

static void describe(const struct line *line, struct part *part, moray_section *section, moray_table_row *optimum,
                     moray_table_row *cost)
{
    const struct classic_result *r = &line->result;
    const char *verdict = classic_agreement(line->classic, r);
    char meshes[100];
    history_text(r, meshes, sizeof meshes);
    snprintf(part->optimum, sizeof part->optimum, "%.10g, published %s: %s", r->value, published(line->classic),
             verdict);
    snprintf(part->figures, sizeof part->figures, "%s.", line->classic->name);
    snprintf(part->text, sizeof part->text,
             "moray classics %s. Source: %s. Optimum %s. %s, %d iterations on meshes of %s intervals. Certificate: "
             "%s%.400s.\n",
             line->classic->name, line->classic->source, part->optimum, line->settings.scheme, r->iterations, meshes,
             r->certificate.pass ? "pass" : "FAIL: ", r->certificate.pass ? "" : r->certificate.why);
    *section = (moray_section){.title = line->classic->title, .text = part->text, .figures = part->figures};
    snprintf(part->row, sizeof part->row, "%s; %s", part->optimum, r->certificate.pass ? "certified" : "NOT certified");
    *optimum = (moray_table_row){.label = line->classic->title, .text = part->row};
    *cost = (moray_table_row){.label = line->classic->title,
                              .value = {r->iterations, r->seconds, r->mesh[r->meshes - 1].intervals}};
}

// "40 of 44 problems have the optimum that is published, or a better one" into text; whether all have.
static moray_judgement agree(const struct line *lines, int n, char *text, size_t size)
{
    int bad = 0;
    for (int i = 0; i < n; i++) {
        const char *verdict = classic_agreement(lines[i].classic, &lines[i].result);
        bad += strcmp(verdict, "DIFFERS") == 0 || strcmp(verdict, "NOT SOLVED") == 0;
    }
    snprintf(text, size, "%d of %d solved to what is published, or better", n - bad, n);
    return bad ? MORAY_JUDGED_FAIL : MORAY_JUDGED_PASS;
}

static moray_status report_all(const classics_run *run, const struct line *lines, int n)
{
    static struct part parts[most]; // large
    moray_table_row optima[most], costs[most];
    moray_section sections[most];
    char judged[80];
    for (int i = 0; i < n; i++)
        describe(&lines[i], &parts[i], &sections[i], &optima[i], &costs[i]);
    const moray_table tables[] = {
        {.title = "Optima beside what is published", .n_columns = 1, .rows = optima, .n_rows = n},
        {.title = "What they cost",
         .columns = {"iterations", "time [s]", "intervals"},
         .n_columns = 3,
         .rows = costs,
         .n_rows = n}};
    const moray_report report = {
        .title = "Textbook problems",
        .judgement = agree(lines, n, judged, sizeof judged),
        .judged = judged,
        .text = "Each from the textbook's start, its optimum beside what was printed; by the data: as the data of the "
                "textbook give it, which is not what it printed.",
        .tables = tables,
        .n_tables = 2,
        .sections = sections,
        .n_sections = n};
    return moray_app_show(&run->common, &(moray_results){.name = "classics",
                                                         .found = &(struct lines){lines, n},
                                                         .summary = summarise,
                                                         .report = &report});
}

// ---- The program ---------------------------------------------------------------------------------------------------

static moray_status judge(const struct line *lines, int n)
{
    int differ = 0, unsolved = 0;
    for (int i = 0; i < n; i++) {
        if (lines[i].result.outcome == MORAY_NLP_INTERRUPTED)
            return moray_error(MORAY_INTERRUPTED, "interrupted at %s", lines[i].classic->name);
        const char *verdict = classic_agreement(lines[i].classic, &lines[i].result);
        differ += strcmp(verdict, "DIFFERS") == 0;
        unsolved += strcmp(verdict, "NOT SOLVED") == 0;
    }
    if (differ + unsolved)
        return moray_error(MORAY_NOT_SOLVED, "%d of %d not solved, %d differ from what is published", unsolved, n,
                           differ);
    return moray_ok();
}

static moray_status work(classics_run *run, struct line *lines)
{
    int n = 0;
    if (!run->common.json)
        print_head();
    moray_interrupt_begin();
    for (int i = 0; classics[i] && !moray_interrupted(); i++) {
        if (!run->chosen[i])
            continue;
        lines[n].classic = classics[i];
        MORAY_TRY(solve(run, &lines[n]));
        if (!run->common.json)
            print_line(&lines[n]);
        n++;
    }
    moray_interrupt_end();
    MORAY_TRY(report_all(run, lines, n));
    return judge(lines, n);
}

int main(int argc, char **argv)
{
    static moray_word word[most];
    static struct line lines[most];
    int n = 0, exit_code;
    for (; n < most && classics[n]; n++)
        word[n] = (moray_word){.name = classics[n]->name, .help = classics[n]->title};
    const moray_words words = {
        .noun = "problem", .word = word, .n = n, .all = "all", .offset = offsetof(classics_run, chosen)};
    const moray_program program = {
        .name = "classics",
        .summary = "Solves textbook problems of optimal control and sets the optimum beside what is published. Scheme, "
                   "intervals and tolerance are each problem's own unless given.",
        .options = options,
        .n_options = sizeof options / sizeof *options,
        .words = &words};
    classics_run run = defaults();
    if (!moray_app_start(&program, argc, argv, &run, &exit_code))
        return exit_code;
    run.ticker = moray_ticker_start(stderr, run.common.quiet);
    return moray_app_end(&program, &run, work(&run, lines));
}
