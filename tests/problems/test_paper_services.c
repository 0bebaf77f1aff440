// SPDX-License-Identifier: MIT
//
// What studies are given: keeping, telling and writing, and the summary and report around them.
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "paper_desk.h"

static char directory[] = "/tmp/moray-paper-XXXXXX";

static void test_half_range(void)
{
    const double values[] = {3, 100, -1, 200, 2, -300, 5, 0};
    CHECK(paper_half_range(values, 2, 4) == 3, "half of largest less least of every second value");
    CHECK(paper_half_range(values + 1, 1, 1) == 0, "one value does not swing");
    double sine[361];
    for (int k = 0; k < 361; k++)
        sine[k] = 7 + 0.3 * sin(k * DEG + 1);
    CHECK_NEAR(paper_half_range(sine, 1, 361), 0.3, 2e-5, "amplitude about any mean");
}

static int released;

static void count_release(void *thing)
{
    free(thing);
    released++;
}

static void test_keeping(paper_desk *desk)
{
    paper *p = &desk->p;
    double *numbers;
    moray_swim_track *track;
    moray_swimmer *swimmer;
    CHECK_OK(paper_numbers(p, 5, &numbers), "numbers");
    CHECK(numbers[0] == 0 && numbers[4] == 0, "are zeros");
    CHECK_OK(paper_numbers(p, 0, &numbers), "none");
    CHECK_OK(paper_track(p, p->rig.swimmer[0], 3, &track), "a track");
    CHECK(track->capacity == 3 && track->n == 0, "is empty");
    CHECK_OK(paper_swimmer(p, p->robot, MORAY_FIRST_PRINCIPLES, PAPER_PRINTED, &swimmer), "a swimmer");
    CHECK_OK(paper_own(p, malloc(1), count_release), "a thing");
    const moray_status status = paper_own(p, NULL, count_release);
    CHECK(status.code == MORAY_MEMORY && strcmp(status.text, "test: no memory") == 0, "%s", status.text);
    CHECK(strcmp(paper_label(p, "%d links, %s", 10, "straight"), "10 links, straight") == 0, "a label");
    paper_release(p);
    CHECK(released == 1, "everything is released once: %d", released);
}

// The gait of the settings is that of (27), (33); an orbit in another current leaves the rig's swimmers in their own.
static void test_swimming(paper_desk *desk)
{
    paper *p = &desk->p;
    const double theta_max = 10 * DEG, delta = 40 * DEG, still[2] = {0, 0};
    CHECK_NEAR(paper_gait(p, MORAY_FIRST_PRINCIPLES, theta_max).amplitude, 2 * sin(delta / 2) * theta_max, 1e-15,
               "(27)");
    CHECK_NEAR(paper_gait(p, MORAY_CONTROL_ORIENTED, theta_max).amplitude, 0.14 * cos(delta / 2) * sin(theta_max),
               1e-15, "(33)");
    moray_steady steady[3];
    moray_swim_track *orbit;
    const moray_gait *gait = &p->gait[MORAY_CONTROL_ORIENTED];
    CHECK_OK(paper_orbit(p, MORAY_CONTROL_ORIENTED, gait, 11, &steady[0], &orbit), "in the current");
    CHECK(orbit->n == 11, "as many samples as asked for");
    CHECK_OK(paper_orbit_in(p, still, MORAY_CONTROL_ORIENTED, gait, 2, &steady[1], &orbit), "in still water");
    CHECK_NEAR(steady[1].v_x, steady[0].v_x - 0.1, 1e-6, "without its drift");
    double x[24] = {0}, dx[24], ubar[9] = {0};
    CHECK(moray_swimmer_rates(p->rig.swimmer[MORAY_CONTROL_ORIENTED], x, ubar, dx, NULL), "at rest");
    CHECK_NEAR(dx[22], p->robot->c_t / p->robot->m * 0.1, 1e-12, "the current takes the robot along again");
    paper_release(p);
}

static void test_telling(paper_desk *desk)
{
    paper *p = &desk->p;
    char title[] = "Title", label[] = "speed", column[] = "here";
    const moray_table_row row = {.label = label, .value = {1}};
    const moray_table table = {.title = title, .columns = {column}, .n_columns = 1, .rows = &row, .n_rows = 1};
    desk->telling = (paper_telling){0};
    CHECK_OK(paper_say(p, "One of %d.", 2), "a paragraph");
    CHECK_OK(paper_say(p, "Two."), "another");
    CHECK(strcmp(desk->telling.text, "One of 2.\nTwo.") == 0, "a line each: %zu bytes", strlen(desk->telling.text));
    CHECK_OK(paper_table(p, &table), "a table");
    title[0] = label[0] = column[0] = '?';
    const moray_table *kept = &desk->telling.table[0];
    CHECK(strcmp(kept->title, "Title") == 0 && strcmp(kept->columns[0], "here") == 0 &&
              strcmp(kept->rows[0].label, "speed") == 0 && kept->rows[0].unit == NULL && kept->rows[0].value[0] == 1,
          "the report keeps a copy");
    moray_status status = moray_ok();
    for (int k = 1; k <= PAPER_TABLES && !moray_failed(status); k++)
        status = paper_table(p, &table);
    CHECK(status.code == MORAY_INPUT && desk->telling.n_tables == PAPER_TABLES, "%s", status.text);
}

static bool present(const char *name)
{
    char path[80];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    return access(path, R_OK) == 0;
}

// The text of a file, to be freed.
static char *content(const char *name)
{
    char path[80], *text = calloc(1, 4000000);
    snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *file = fopen(path, "r");
    if (file) {
        text[fread(text, 1, 3999999, file)] = 0;
        fclose(file);
    }
    return text;
}

static void test_writing(paper_desk *desk)
{
    paper *p = &desk->p;
    const double values[] = {1, 2};
    const moray_column column = {.name = "x", .unit = "m", .values = values};
    const moray_curve curve = {.label = "c", .x = values, .y = values, .n = 2};
    const paper_study study[] = {{"test", "a study", NULL}, {"none", "a failed one", NULL}};
    const paper_chapter chapters[] = {
        {.study = &study[0], .telling = desk->telling, .status = moray_ok()},
        {.study = &study[1], .telling = {0}, .status = moray_error(MORAY_NUMERIC, "broken")}};
    CHECK_OK(paper_csv(p, NULL, &column, 1, 2), "without --out");
    CHECK_OK(paper_figure(p, &(moray_figure){.name = "wave", .curves = &curve, .n_curves = 1}), "nothing is written");
    CHECK_OK(moray_output_open(&p->output, directory), "an output");
    CHECK_OK(paper_csv(p, NULL, &column, 1, 2), "a file");
    CHECK_OK(paper_csv(p, "more", &column, 1, 2), "another");
    CHECK(paper_csv(p, "more", &column, 1, 2).code == MORAY_INPUT, "the same again is refused");
    CHECK_OK(paper_figure(p, &(moray_figure){.name = "wave", .title = "Waves", .curves = &curve, .n_curves = 1}),
             "a figure");
    p->json = moray_json_new();
    paper_json_head(p->json, p->settings);
    paper_json_end(p->json, chapters[1].status);
    desk->settings.common.output = p->output;
    desk->settings.common.json = false;
    CHECK_OK(paper_report(p, chapters, 2), "summary, report, commit");
    desk->settings.common.json = true;
    moray_json_free(p->json);
    moray_output_free(p->output);
    CHECK(present("test.csv") && present("test_more.csv") && present("test_wave.svg"), "files bear the study's name");
    char *summary = content("summary.json"), *page = content("report.html");
    CHECK(strstr(summary, "\"done\":\tfalse") && strstr(summary, "\"why\":\t\"broken\""), "why a study failed");
    CHECK(strstr(summary, "\"current_m_s\"") && strstr(summary, "\"reading\":\t\"corrected\""), "what was run");
    CHECK(strstr(page, ">test: a study</h2>") && strstr(page, "<p>One of 2.</p>") && strstr(page, ">Waves<") &&
              strstr(page, "<caption>Title</caption>"),
          "the study's section");
    CHECK(strstr(page, ">none: a failed one</h2>") && strstr(page, "<p>Not done: broken</p>"), "the failed one's");
    free(summary);
    free(page);
}

static void test_wrapping(void)
{
    char text[1000] = "", printed[1200] = "";
    for (int k = 0; k < 60; k++)
        strcat(text, k % 7 ? "word " : "longerword ");
    strcat(text, "end");
    FILE *file = fmemopen(printed, sizeof printed, "w");
    paper_print_wrapped(text, file);
    fclose(file);
    size_t longest = 0, words = 0;
    for (const char *line = printed; *line; line += strcspn(line, "\n") + 1)
        longest = strcspn(line, "\n") > longest ? strcspn(line, "\n") : longest;
    for (char *word = strtok(printed, " \n"); word; word = strtok(NULL, " \n"))
        words++;
    CHECK(longest <= 100 && longest > 80, "lines of at most 100 columns, and filled: %zu", longest);
    CHECK(words == 61, "no word is lost: %zu", words);
}

int main(void)
{
    char remove[64];
    paper_desk desk;
    const moray_robot robot = moray_robot_paper();
    if (!mkdtemp(directory))
        return 1;
    paper_desk_open(&desk, &robot, 0.1, 0.1, 20);
    test_half_range();
    test_keeping(&desk);
    test_swimming(&desk);
    test_telling(&desk);
    test_writing(&desk);
    test_wrapping();
    paper_desk_close(&desk);
    snprintf(remove, sizeof remove, "rm -r %s", directory);
    CHECK(system(remove) == 0, "clean up");
    return tap_done();
}
