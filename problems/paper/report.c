// SPDX-License-Identifier: MIT
#include <string.h>

#include "main.h"

void paper_print_wrapped(const char *text, FILE *file)
{
    const int last_column = 100;
    int column = 0;
    while (*text) {
        const int word = (int)strcspn(text, " ");
        if (column > 0 && column + 1 + word > last_column) {
            fputc('\n', file);
            column = 0;
        } else if (column > 0) {
            fputc(' ', file);
            column++;
        }
        fwrite(text, 1, (size_t)word, file);
        column += word;
        text += word + (text[word] == ' ');
    }
    fputc('\n', file);
}

void paper_json_head(moray_json *json, const paper_settings *settings)
{
    moray_json_text(json, "problem", "paper");
    moray_json_text(json, "version", moray_version());
    moray_json_object(json, "robot", MORAY_MEMBERS({"links", settings->snake.robot.links}));
    moray_json_numbers(json, "current_m_s", settings->snake.current, 2);
    moray_json_text(json, "reading", paper_reading_names[settings->reading]);
    moray_json_object(json, "gait",
                      MORAY_MEMBERS({"theta_max_deg", settings->theta_max / DEG},
                                    {"omega_deg_s", settings->omega / DEG}, {"delta_deg", settings->delta / DEG}));
}

void paper_json_end(moray_json *json, moray_status status)
{
    moray_json_bool(json, "done", !moray_failed(status));
    if (moray_failed(status))
        moray_json_text(json, "why", status.text);
}

// The paper's gait on both of its models. What cannot be swum, as with some misprints, is not shown.
static moray_status make_scene(const paper *p, moray_swim_scene *scene)
{
    static const char *const names[] = {"control-oriented model", "first-principles model"};
    const double apart = 8 * p->robot->l;
    moray_gait_trial trial;
    scene->scene.title = "The gait on both models";
    scene->scene.text = "The same gait from rest on the same water, simulated, side by side.";
    if (moray_failed(moray_gait_trial_run(&p->rig, &p->gait[MORAY_CONTROL_ORIENTED], MORAY_CONTROL_ORIENTED, &trial)))
        return moray_ok();
    for (int model = 1; model >= 0; model--) {
        const moray_swim_look look = {.name = names[model],
                                      .colour = model ? MORAY_COLOUR_BEST : MORAY_COLOUR_BASELINE,
                                      .width = 2 * p->settings->snake.geometry.a_e,
                                      .aside = {0, model ? 0 : -apart}};
        const moray_status status = moray_swim_scene_gait(scene, &look, &p->rig, &trial, (moray_model)model, 15);
        if (status.code == MORAY_MEMORY)
            return status;
    }
    for (int k = 0; k < scene->scene.n_bodies; k++)
        scene->body[k].effort = NULL; // newton on one, newton metres on the other
    return moray_ok();
}

static void judge(const paper_chapter *chapters, int n, moray_report *report, char *text, size_t size)
{
    int done = 0;
    for (int i = 0; i < n; i++)
        done += !moray_failed(chapters[i].status);
    snprintf(text, size, "%d of %d studies done", done, n);
    report->judged = text;
    report->judgement = done == n ? MORAY_JUDGED_PASS : MORAY_JUDGED_FAIL;
}

moray_status paper_report(const paper *p, const paper_chapter *chapters, int n)
{
    const moray_snake_options *snake = &p->settings->snake;
    moray_section section[PAPER_STUDIES];
    char title[PAPER_STUDIES][200], failed[PAPER_STUDIES][400], text[200], judged[60];
    moray_swim_scene scene = {0};
    for (int i = 0; i < n; i++) {
        const paper_chapter *chapter = &chapters[i];
        snprintf(title[i], sizeof title[i], "%s: %s", chapter->study->name, chapter->study->summary);
        snprintf(failed[i], sizeof failed[i], "Not done: %s", chapter->status.text);
        section[i] = (moray_section){.title = title[i],
                                     .text = moray_failed(chapter->status) ? failed[i] : chapter->telling.text,
                                     .figures = chapter->study->name,
                                     .tables = chapter->telling.table,
                                     .n_tables = chapter->telling.n_tables};
    }
    snprintf(text, sizeof text, "%d links, current (%g, %g) m/s, theta_max %g deg, omega %g deg/s, delta %g deg",
             snake->robot.links, snake->current[0], snake->current[1], p->settings->theta_max / DEG,
             p->settings->omega / DEG, p->settings->delta / DEG);
    moray_report report = {.title = "A control-oriented model of underwater snake robots exposed to currents",
                           .text = text,
                           .scene = &scene.scene,
                           .sections = section,
                           .n_sections = n};
    judge(chapters, n, &report, judged, sizeof judged);
    moray_status status = p->settings->common.output ? make_scene(p, &scene) : moray_ok();
    if (!moray_failed(status))
        status =
            moray_app_show(&p->settings->common, &(moray_results){.name = "paper", .json = p->json, .report = &report});
    moray_swim_scene_free(&scene);
    return status;
}
