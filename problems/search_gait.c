// SPDX-License-Identifier: MIT
//
// All optima of the gait within limits: local searches from many starts and a global one, each point of them a periodic
// orbit found by Newton's method; every optimum polished by collocation and proved by simulation.
#include "parts/search_gait.h"

#include <stdlib.h>
#include <string.h>

static const char *const goals[] = {"speed", "economy", NULL};

#define CHOICE(name, where, field, list, text)                                                                         \
    {                                                                                                                  \
        .section = where, .key = name, .type = MORAY_OPTION_CHOICE, MORAY_AT(search_gait, field), .choices = list,     \
        .help = text                                                                                                   \
    }

static const moray_option own[] = {
    GAIT_LIMIT("power_W", power, "W",
               "mean joint power; by default what the paper's gait uses in the same model and current, or with the "
               "goal economy none"),
    GAIT_LIMIT("speed_m_s", speed, "m/s",
               "least speed along the course; by default none, or with the goal economy what the paper's gait makes"),
    CHOICE("goal", "problem", goal, goals, "largest speed along the course, or least joint work per distance along it"),
    CHOICE("local", "solver", local_method, search_gait_locals, "method of the searches from each start"),
    CHOICE("global", "solver", global_method, search_gait_globals, "method of the global search"),
    {.section = "solver",
     .key = "global_orbits",
     .type = MORAY_OPTION_INT,
     MORAY_AT(search_gait, global_orbits),
     .min = 1,
     .max = 1000000,
     .help = "orbits that the global search may solve"},
    {.section = "solver",
     .key = "seed",
     .type = MORAY_OPTION_INT,
     MORAY_AT(search_gait, seed),
     .min = 1,
     .max = 1e9,
     .help = "of the random starts and of isres"},
};
enum { N_OWN = sizeof own / sizeof *own };

// Finer than that of one optimum's program: the mesh suits every gait within the limits. A limit on the effort is kept
// at the nodes.
enum { USUAL_INTERVALS = 20, EFFORT_INTERVALS = 60 };

static search_gait *defaults(void)
{
    search_gait *run = calloc(1, sizeof *run);
    if (!run)
        return NULL;
    run->job = gait_job_defaults(&(gait_program){.name = "search_gait", .power = NAN, .speed = NAN});
    run->job.common.intervals = USUAL_INTERVALS;
    run->job.random_starts = 40;
    run->global_method = 1;
    run->global_orbits = 400;
    run->seed = 1;
    return run;
}

// Defaults that depend on others: the paper's gait sets the power to the one goal and the speed to the other.
static void complete(search_gait *run)
{
    run->job.goal = (moray_gait_goal)run->goal;
    if (isfinite(run->job.joint_effort) && run->job.common.intervals == USUAL_INTERVALS)
        run->job.common.intervals = EFFORT_INTERVALS;
    if (search_gait_fastest(run) && isnan(run->job.speed))
        run->job.speed = INFINITY;
    else if (!search_gait_fastest(run) && isnan(run->job.power))
        run->job.power = INFINITY;
}

static bool certified(const search_gait *run)
{
    for (int k = 0; k < run->shown; k++)
        if (!run->optimum[k].at.certificate.pass)
            return false;
    return true;
}

static void release(search_gait *run)
{
    for (int k = 0; k < run->shown; k++)
        gait_job_stage_free(&run->optimum[k].at);
    moray_gait_search_free(run->search);
    gait_job_free(&run->job);
    free(run);
}

int main(int argc, char **argv)
{
    moray_option options[GAIT_JOB_OPTIONS + N_OWN];
    memcpy(options, gait_job_options, sizeof gait_job_options);
    memcpy(options + GAIT_JOB_OPTIONS, own, sizeof own);
    const moray_program app = {.name = "search_gait",
                               .summary = "Searches for all optima of the gait of an underwater snake robot, from many "
                                          "starts and globally, and polishes each by collocation.",
                               .options = options,
                               .n_options = GAIT_JOB_OPTIONS + N_OWN};
    search_gait *run = defaults();
    int exit_code = MORAY_EXIT_NOT_SOLVED;
    if (!run)
        return exit_code;
    if (!moray_app_start(&app, argc, argv, run, &exit_code)) {
        free(run);
        return exit_code;
    }
    complete(run);
    run->job.ticker = moray_ticker_start(stderr, run->job.common.quiet);
    moray_interrupt_begin();
    moray_status status = search_gait_run(run);
    if (!moray_failed(status))
        status = search_gait_report(run);
    moray_interrupt_end();
    moray_ticker_end(&run->job.ticker);
    exit_code = moray_app_end(&app, run, status);
    if (exit_code == MORAY_EXIT_SOLVED && !certified(run))
        exit_code = MORAY_EXIT_CERTIFICATE;
    release(run);
    return exit_code;
}
