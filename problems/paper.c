// SPDX-License-Identifier: MIT
//
// The paper, to be run: its figures, propositions and properties as studies on both models.
#include "paper/main.h"

static const paper_study studies[] = {
    {"straight", "straight motion with growing amplitude: Fig. 7", paper_straight},
    {"turning", "turning there and back: Fig. 8", paper_turning},
    {"linearising", "the linearising control law (22)", paper_linearising},
    {"ground", "the ground robot as a special case", paper_ground},
    {"eel", "eel-like motion, the paper's future work", paper_eel},
    {"fit", "constants of the rotational dynamics (20) for the given robot", paper_fit},
    {"mapping", "joint amplitudes: Fig. 6 and Propositions 1 and 2", paper_mapping},
    {"forces", "force terms I-VIII of (6): what propels, and what cancels (Property 1, Fig. 2, Remark 3)",
     paper_forces},
    {"links", "how the links move and what the fluid does to them (Properties 2 and 4)", paper_links},
    {"offset", "turning rate by joint offset and by speed (Property 3)", paper_offset},
    {"errata", "the misprints of the paper, swum as printed and as corrected (E1-E4 and the sign in (13))",
     paper_errata},
};
enum { N_STUDIES = sizeof studies / sizeof *studies };
_Static_assert((int)N_STUDIES <= (int)PAPER_STUDIES, "paper_settings has room for every study");

_Static_assert(sizeof(paper_reading) == sizeof(int), "choices are stored as int");

static const moray_option options[] = {
    MORAY_ROW(
        CHOICE, paper_settings, reading, "problem", "reading", .choices = paper_reading_names,
        .help =
            "equations of the control-oriented model: corrected; with (23h) as printed (erratum E1); with l of (8), "
            "(12), (13) as printed (E2); with both"),
    {.flag = "as-printed",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(paper_settings, as_printed),
     .help = "as --set reading=printed"},
    MORAY_ROW(REAL, paper_settings, theta_max, "problem", "theta_max_deg", .min = 0, .max = 90, .open = true,
              .unit = "deg", .help = "link-angle amplitude of (24), where a study does not vary it"),
    MORAY_ROW(REAL, paper_settings, omega, "problem", "omega_deg_s", .min = 0, .max = 3600, .open = true,
              .unit = "deg/s", .help = "gait frequency, where a study does not vary it"),
    MORAY_ROW(REAL, paper_settings, delta, "problem", "delta_deg", .min = 0, .max = 180, .open = true, .unit = "deg",
              .help = "phase shift between joints; 360/(N-1) unless given"),
    MORAY_ROW(TEXT, paper_settings, write_ini, "problem", "write_ini", .argument = "FILE",
              .help = "study fit: the robot's INI file, to write the fitted constants into"),
};

static paper_settings defaults(void)
{
    paper_settings settings = {.common = moray_common_default(),
                               .snake = moray_snake_options_default(),
                               .theta_max = 20 * DEG,
                               .omega = 120 * DEG,
                               .delta = NAN};
    settings.snake.current[0] = settings.snake.current[1] = 0.1;
    return settings;
}

static moray_status check_write_ini(const paper_settings *settings)
{
    for (int i = 0; i < N_STUDIES; i++)
        if (studies[i].run == paper_fit && !settings->chosen[i] && settings->write_ini[0])
            return moray_error(MORAY_INPUT, "write_ini = %.100s: is for the study fit, which is not named",
                               settings->write_ini);
    return moray_ok();
}

// --as-printed; delta, which by Assumption 2 is 2 pi/(N-1).
// The paper's robot has equal links, and so have its equations in all studies but the fit.
static moray_status check_links(const paper_settings *settings)
{
    for (int i = 0; i < (int)N_STUDIES && settings->snake.robot.link; i++)
        if (settings->chosen[i] && studies[i].run != paper_fit)
            return moray_error(MORAY_INPUT, "[links]: %s is of the paper's equations, which know equal links only",
                               studies[i].name);
    return moray_ok();
}

static moray_status complete(paper_settings *settings)
{
    MORAY_TRY(check_links(settings));
    if (settings->as_printed)
        settings->reading = PAPER_PRINTED;
    const int N = settings->snake.robot.links;
    if (!isnan(settings->delta))
        return moray_ok();
    settings->delta = 2 * M_PI / (N - 1);
    if (N > 3)
        return moray_ok();
    return moray_error(MORAY_INPUT,
                       "links = %d: with delta = 2 pi/(N-1) = %g deg the joints do not move; set delta_deg", N,
                       settings->delta / DEG);
}

static moray_status prepare(paper *p, const paper_settings *settings)
{
    *p = (paper){.settings = settings,
                 .robot = &settings->snake.robot,
                 .output = settings->common.output,
                 .ticker = moray_ticker_start(stderr, settings->common.quiet)};
    for (int model = 0; model < 2; model++) {
        p->gait[model] = (moray_gait){.omega = settings->omega, .delta = settings->delta};
        p->gait[model] = paper_gait(p, (moray_model)model, settings->theta_max);
    }
    MORAY_TRY(moray_test_rig_new(&p->rig, p->robot, settings->snake.current, 0));
    moray_swimmer_free(p->rig.swimmer[MORAY_CONTROL_ORIENTED]); // the rig reads no misprints
    MORAY_TRY(paper_reading_swimmer(&p->rig.swimmer[MORAY_CONTROL_ORIENTED], p->robot, MORAY_CONTROL_ORIENTED,
                                    settings->reading));
    moray_swimmer_set_current(p->rig.swimmer[MORAY_CONTROL_ORIENTED], settings->snake.current[0],
                              settings->snake.current[1]);
    p->rig.settings.sim.max_steps = 20000; // between samples; a misprint can make motion without end
    p->json = moray_json_new();
    paper_json_head(p->json, settings);
    return moray_ok();
}

// The study's object is closed at the end whatever it left open in it.
static void run_study(paper *p, const paper_study *study, paper_chapter *chapter)
{
    const int depth = moray_json_depth(p->json);
    *chapter = (paper_chapter){.study = study};
    p->study = study->name;
    p->telling = &chapter->telling;
    if (!p->settings->common.json)
        printf("---- %s: %s\n\n", study->name, study->summary);
    paper_progress(p, "%s", study->summary);
    moray_json_open(p->json, study->name);
    chapter->status = study->run(p);
    moray_ticker_end(&p->ticker);
    if (moray_failed(chapter->status))
        fprintf(stderr, "paper: %s: %s\n", study->name, chapter->status.text);
    while (moray_json_depth(p->json) > depth + 1)
        moray_json_close(p->json);
    paper_json_end(p->json, chapter->status);
    moray_json_close(p->json);
}

static moray_status finish(const paper *p, const paper_chapter *chapters, int n)
{
    int failed = 0;
    for (int i = 0; i < n; i++)
        failed += moray_failed(chapters[i].status);
    MORAY_TRY(paper_report(p, chapters, n));
    if (failed)
        return moray_error(MORAY_NOT_SOLVED, "%d of %d studies failed", failed, n);
    return moray_ok();
}

static moray_status work(paper *p)
{
    paper_chapter chapters[N_STUDIES];
    int n = 0;
    moray_json_open(p->json, "studies");
    for (int i = 0; i < N_STUDIES; i++)
        if (p->settings->chosen[i])
            run_study(p, &studies[i], &chapters[n++]);
    moray_json_close(p->json);
    return finish(p, chapters, n);
}

int main(int argc, char **argv)
{
    moray_word word[N_STUDIES];
    for (int i = 0; i < N_STUDIES; i++)
        word[i] = (moray_word){.name = studies[i].name, .help = studies[i].summary};
    const moray_words words = {
        .noun = "study", .word = word, .n = N_STUDIES, .all = "all", .offset = offsetof(paper_settings, chosen)};
    static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(paper_settings, snake)}};
    static const char *const without[] = {"model", "course",        "scheme",    "intervals",
                                          "tol",   "linear_solver", "ipopt.KEY", NULL};
    const moray_program program = {
        .name = "paper",
        .summary = "Runs studies of the paper on both of its models and shows them beside what it claims.",
        .options = options,
        .n_options = sizeof options / sizeof *options,
        .groups = groups,
        .n_groups = 1,
        .words = &words,
        .without = without};
    paper_settings settings = defaults();
    paper p = {0};
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &settings, &exit_code))
        return exit_code;
    moray_status status = check_write_ini(&settings);
    if (!moray_failed(status))
        status = complete(&settings);
    if (!moray_failed(status))
        status = prepare(&p, &settings);
    if (!moray_failed(status))
        status = work(&p);
    exit_code = moray_app_end(&program, &settings, status);
    moray_json_free(p.json);
    moray_test_rig_free(&p.rig);
    paper_release(&p);
    return exit_code;
}
