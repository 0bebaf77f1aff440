// SPDX-License-Identifier: MIT
//
// The words of report.html, and the robots swimming in it.
#include <math.h>
#include <string.h>

#include "job.h"

static void ask(const gait_job *job, gait_job_page *page)
{
    const moray_snake_options *snake = &job->snake;
    const stage *at = last_stage(job);
    char links[MORAY_LINKS_TEXT];
    snprintf(page->asked, sizeof page->asked, "A robot of %s in a current of (%g, %g) m/s, course %g deg",
             moray_snake_links_text(&snake->robot, links), snake->current[0], snake->current[1], snake->course / DEG);
    if (isfinite(at->power))
        moray_text_add(page->asked, sizeof page->asked, "; %s at most %.4g W on the %s model",
                       moray_power_label(&snake->robot, at->model), at->power, moray_model_name(at->model));
    if (at->speed > 0)
        moray_text_add(page->asked, sizeof page->asked, "; at least %.4g m/s along the course on the %s model",
                       at->speed, moray_model_name(at->model));
    moray_text_add(page->asked, sizeof page->asked, ".");
}

// Which gait is recommended, then each in turn: a loss is told with the same weight as a gain.
static void say(const gait_job *job, gait_job_page *page)
{
    const stage *at[GAIT_STAGES];
    const int n = gait_job_stages(job, at);
    char text[GAIT_TEXT] = "";
    gait_job_headline(job, text);
    moray_text_add(page->text, sizeof page->text, "%s\n", text);
    for (int k = 0; k < n; k++) {
        gait_job_say_stage(job, at[k], text);
        moray_text_add(page->text, sizeof page->text, "%s\n", text);
    }
}

static void certify(const gait_job *job, gait_job_page *page)
{
    static const char *const labels[] = {"optimality and feasibility (KKT)", "error of the dynamics between nodes",
                                         "violation of limits between nodes", "re-simulation of each interval",
                                         "derivatives against differences"};
    enum { rows = sizeof labels / sizeof *labels };
    _Static_assert(rows == sizeof page->rows / sizeof *page->rows, "a row for each number");
    const stage *at[GAIT_STAGES];
    const int n = gait_job_stages(job, at);
    char text[GAIT_TEXT];
    int failed = 0;
    page->table = (moray_table){.title = "Certificates: relative errors, computed apart from the solver",
                                .n_columns = n,
                                .rows = page->rows,
                                .n_rows = rows};
    for (int i = 0; i < rows; i++)
        page->rows[i].label = labels[i];
    for (int k = 0; k < n; k++) {
        const moray_certificate *c = &at[k]->certificate;
        const double values[rows] = {c->kkt, c->mesh_error, c->between_nodes, c->resimulation, c->derivatives};
        for (int i = 0; i < rows; i++)
            page->rows[i].value[k] = values[i];
        page->table.columns[k] = gait_job_kind(job, at[k]);
        failed += !c->pass;
        moray_certificate_line(c, text, sizeof text);
        moray_text_add(page->certificates, sizeof page->certificates, "The %s. %s\n", gait_job_kind(job, at[k]), text);
    }
    page->pass = recommended(job)->certificate.pass;
    gait_job_judge(n - failed, n, page->judged);
    page->section[0] =
        (moray_section){.title = "Certificate", .text = page->certificates, .tables = &page->table, .n_tables = 1};
}

moray_status gait_job_scene_add(const gait_job *job, moray_swim_scene *scene, const char *name, moray_colour colour,
                                const moray_gait_trial *trial, int place, double seconds)
{
    const moray_model model = job->snake.model;
    const double apart = 6 * place * job->snake.robot.l, course = job->snake.course;
    if (isnan(trial->steady[model].speed))
        return moray_ok();
    const moray_swim_look look = {.name = name,
                                  .colour = colour,
                                  .width = 2 * job->snake.geometry.a_e,
                                  .aside = {-apart * sin(course), apart * cos(course)}};
    const moray_status status = moray_swim_scene_gait(scene, &look, &job->rig, trial, model, seconds);
    return status.code == MORAY_MEMORY ? status : moray_ok();
}

// The one that is recommended in front.
static moray_status make_scene(gait_job *job, gait_job_page *page)
{
    const stage *at = recommended(job);
    char baseline[64];
    moray_swim_scene *scene = &page->scene;
    scene->scene.title = "The robot swimming";
    scene->scene.text = "Both from rest on the same water, simulated, side by side.";
    MORAY_TRY(gait_job_scene_add(job, scene, gait_job_kind(job, at), gait_job_colour(job, at), &at->trial, 1,
                                 GAIT_SHOWN_SECONDS));
    return gait_job_scene_add(job, scene, gait_job_baseline(job, baseline), MORAY_COLOUR_BASELINE, &job->paper, 0,
                              GAIT_SHOWN_SECONDS);
}

moray_status gait_job_page_new(gait_job *job, gait_job_page *page)
{
    *page = (gait_job_page){0};
    ask(job, page);
    say(job, page);
    certify(job, page);
    if (!job->common.output)
        return moray_ok();
    const moray_status status = make_scene(job, page);
    if (moray_failed(status))
        moray_swim_scene_free(&page->scene);
    return status;
}

moray_status gait_job_publish(const gait_job *job, const gait_job_shown *shown, int passed, int n,
                              const moray_report *report)
{
    moray_swim_scene scene = {0};
    char judged[80];
    moray_report page = *report;
    page.judgement = gait_job_judge(passed, n, judged);
    page.judged = judged;
    page.scene = &scene.scene;
    moray_status status = job->common.output ? shown->scene(job, &scene) : moray_ok();
    if (!moray_failed(status))
        status = moray_app_show(&job->common, &(moray_results){.name = job->name,
                                                               .found = job,
                                                               .summary = shown->summary,
                                                               .print = shown->print,
                                                               .write = shown->write,
                                                               .draw = shown->draw,
                                                               .report = &page});
    moray_swim_scene_free(&scene);
    return status;
}
