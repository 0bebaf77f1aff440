// SPDX-License-Identifier: MIT
//
// All optima of the gait within limits: local searches from many starts and a global one, each point of them a periodic
// orbit found by Newton's method; every optimum polished by collocation and proved by simulation.
#include "gait/search_gait/search_gait.h"

static const char *const goals[] = {"speed", "economy", NULL};

#define CHOICE(name, where, field, list, text)                                                                         \
    {                                                                                                                  \
        .section = where, .key = name, .type = MORAY_OPTION_CHOICE, MORAY_AT(search_gait, field), .choices = list,     \
        .help = text                                                                                                   \
    }

static const moray_option own[] = {
    GAIT_LIMIT("power_W", power, "W",
               "mean power of the joints, or at the terminals of their motors; by default what the paper's gait uses "
               "in the same model and current, or with the "
               "goal economy none"),
    GAIT_LIMIT("speed_m_s", speed, "m/s",
               "least speed along the course; by default none, or with the goal economy what the paper's gait makes"),
    CHOICE("goal", "problem", goal, goals,
           "largest speed along the course, or least work of joints or motors per distance along it"),
    CHOICE("local", "solver", local_method, search_gait_locals, "method of the searches from each start"),
    CHOICE("global", "solver", global_method, search_gait_globals, "method of the global search"),
    MORAY_ROW(INT, search_gait, global_orbits, "solver", "global_orbits", .min = 1, .max = 1000000,
              .help = "orbits that the global search may solve"),
    MORAY_ROW(INT, search_gait, seed, "solver", "seed", .min = 1, .max = 1e9,
              .help = "of the random starts and of isres"),
};

// Finer than that of one optimum's program: the mesh suits every gait within the limits. A limit on the effort is kept
// at the nodes.
enum { USUAL_INTERVALS = 20, EFFORT_INTERVALS = 60 };

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

static moray_status work(gait_job *job)
{
    search_gait *run = (search_gait *)job;
    complete(run);
    return search_gait_run(run);
}

static moray_status report(gait_job *job)
{
    return search_gait_report((search_gait *)job);
}

static moray_status certified(const gait_job *job)
{
    const search_gait *run = (const search_gait *)job;
    for (int k = 0; k < run->shown; k++) {
        char what[32];
        snprintf(what, sizeof what, "optimum %d", k + 1);
        MORAY_TRY(gait_job_certified(job, what, &run->optimum[k].at));
    }
    return moray_ok();
}

static void release(gait_job *job)
{
    search_gait *run = (search_gait *)job;
    for (int k = 0; k < run->shown; k++)
        gait_job_stage_free(&run->optimum[k].at);
    moray_gait_search_free(run->search);
}

static const gait_program program = {
    .name = "search_gait",
    .summary = "Searches for all optima of the gait of an underwater snake robot, from many starts and globally, and "
               "polishes each by collocation.",
    .options = own,
    .n_options = sizeof own / sizeof *own,
    .power = NAN,
    .speed = NAN,
    .work = work,
    .report = report,
    .certified = certified,
    .release = release};

int main(int argc, char **argv)
{
    static search_gait run; // large
    run = (search_gait){.job = gait_job_defaults(&program), .global_method = 1, .global_orbits = 400, .seed = 1};
    run.job.random_starts = 40;
    run.job.common.intervals = USUAL_INTERVALS;
    return gait_job_main(&program, &run.job, argc, argv);
}
