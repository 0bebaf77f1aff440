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
    if (failed)
        snprintf(page->judged, sizeof page->judged, "Certificate failed for %d of %d gaits", failed, n);
    else
        snprintf(page->judged, sizeof page->judged, "Solved and certified: %d of %d gaits pass", n, n);
    page->section[0] =
        (moray_section){.title = "Certificate", .text = page->certificates, .tables = &page->table, .n_tables = 1};
}

// A length of the robot apart, across the course, the one that is recommended in front.
static moray_status make_scene(gait_job *job, gait_job_page *page)
{
    const moray_model model = job->snake.model;
    const stage *at = recommended(job);
    const double duration = 15, width = 2 * job->snake.geometry.a_e;
    const double apart = 6 * job->snake.robot.l, course = job->snake.course;
    char name[80], baseline[64];
    moray_swim_scene *scene = &page->scene;
    scene->scene.title = "The robot swimming";
    scene->scene.text = "Both from rest on the same water, simulated, side by side.";
    snprintf(name, sizeof name, "%s", gait_job_kind(job, at));
    if (!isnan(at->trial.steady[model].speed))
        MORAY_TRY(moray_swim_scene_gait(scene, name, &job->rig, &at->trial, model, duration, width,
                                        (double[]){-apart * sin(course), apart * cos(course)}));
    if (!isnan(job->paper.steady[model].speed))
        MORAY_TRY(moray_swim_scene_gait(scene, gait_job_baseline(job, baseline), &job->rig, &job->paper, model,
                                        duration, width, (double[]){0, 0}));
    return moray_ok();
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
    if (!moray_failed(status) || status.code != MORAY_MEMORY)
        return moray_ok(); // a gait that cannot be simulated is not shown
    moray_swim_scene_free(&page->scene);
    return status;
}
