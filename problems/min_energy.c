// SPDX-License-Identifier: MIT
//
// The gait of least work per distance along a course, of the joints or, with [motor] and [battery], of motors and what
// the robot draws besides, at or above a speed: optimised on the control-oriented
// model, from there on the first-principles model, and proved by simulating both. Through water that is not uniform one
// gait for each place of a way.
#include "gait/way/way.h"

static const moray_option options[] = {
    GAIT_LIMIT("speed_m_s", speed, "m/s",
               "least speed along the course; by default what the paper's gait makes in the same model and current"),
    GAIT_LIMIT("power_W", power, "W", "mean power of the joints, or at the terminals of their motors"),
    MORAY_ROW(TEXT, way_job, water_file, "problem", "water", .flag = "water", .argument = "FILE",
              .help = "CSV file of a current over place and time in place of the uniform one: a grid of x_m, y_m, "
                      "v_x_m_s, v_y_m_s and, where it changes, t_s; with --way"),
    MORAY_ROW(TEXT, way_job, way_text, "problem", "way", .flag = "way", .argument = "TEXT",
              .help =
                  "waypoints X,Y X,Y ... in m, or a CSV file with the columns x_m,y_m, through which the robot goes "
                  "from t = 0: a gait for each place, without speed_m_s at any speed"),
    MORAY_ROW(INT, way_job, places, "problem", "places", .min = 1, .max = WAY_PLACES,
              .help = "equal shares of the way, each with a gait of its own"),
};

static moray_status work(gait_job *job)
{
    return way_given((way_job *)job) ? way_work(job) : gait_job_work(job);
}

static moray_status report(gait_job *job)
{
    return way_given((way_job *)job) ? way_report(job) : gait_job_report(job);
}

static moray_status certified(const gait_job *job)
{
    return way_given((const way_job *)job) ? way_certified(job) : gait_job_certified(job, NULL, recommended(job));
}

static const gait_program program = {
    .name = "min_energy",
    .summary = "Optimises the gait of an underwater snake robot for the least work per distance "
               "along a course, of the joints or all told, at or above a speed, and proves "
               "it on the first-principles model.",
    .goal = MORAY_GAIT_THRIFTIEST,
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .power = INFINITY,
    .speed = NAN,
    .continues = true,
    .work = work,
    .report = report,
    .certified = certified,
    .release = way_release};

int main(int argc, char **argv)
{
    static way_job run; // large
    run = (way_job){.job = gait_job_defaults(&program), .places = 8};
    return gait_job_main(&program, &run.job, argc, argv);
}
