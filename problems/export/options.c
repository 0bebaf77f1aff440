// SPDX-License-Identifier: MIT
#include "export.h"

#define EXPORT_NUMBER(field, part, name, low, high, in, text)                                                          \
    MORAY_ROW(REAL, export_job, field, part, name, .min = low, .max = high, .unit = in, .help = text)

static const char *const laws[] = {
    [EXPORT_NONE] = "none", [EXPORT_HEADING] = "heading", [EXPORT_PATH] = "path", [EXPORT_PLAN] = "plan", NULL};
_Static_assert(sizeof(export_law) == sizeof(int), "choices are stored as int");

static const moray_option options[] = {
    MORAY_ROW(RUN, export_job, from, "problem", "from", .flag = "from", .argument = "DIR",
              .help = "folder of a run (its --out), whose gait, robot and law of steering are taken; what is given "
                      "besides comes first"),
    MORAY_ROW(TEXT, export_job, name, "export", "name", .flag = "name", .argument = "NAME",
              .help = "what files and the names in the C header begin with: small letters, digits and _"),
    EXPORT_NUMBER(rate, "export", "rate_hz", 1, 1e5, "1/s",
                  "control rate of the tables; their step is the nearest to it that divides the period"),
    MORAY_ROW(INT, export_job, ramp, "export", "ramp_periods", .min = 0, .max = 100,
              .help = "periods in which the straight body comes to the gait; 0: at once"),
    MORAY_ROW(CHOICE, export_job, law, "steering", "law", .flag = "law", .choices = laws,
              .help = "steering: a heading that the caller gives (P, PI, PID), a path (line of sight, with integral "
                      "action), a plan phi_0(t) with heading feedback; that of the run unless given"),
    MORAY_ROW(INT, export_job, trial, "steering", "trial", .min = 0, .max = 1000,
              .help = "which law of the run, counted as in its summary; 0: its best of that kind"),
    EXPORT_NUMBER(gains.proportional, "steering", "gain_m_rad", 0, 1e4, "m/rad",
                  "joint offset of the control-oriented model per heading error"),
    EXPORT_NUMBER(gains.forward, "steering", "forward_m_s_rad", 0, 1e4, "m s/rad", "per rate of the target, likewise"),
    EXPORT_NUMBER(gains.lead, "steering", "lead_s", 0, 1000, "s", "how far ahead the caller's target is to be"),
    EXPORT_NUMBER(gains.integral, "steering", "integral_1_s", 0, 1e4, "1/s", "integral action, over the gain"),
    EXPORT_NUMBER(gains.derivative, "steering", "derivative_s", 0, 1e4, "s", "derivative action, over the gain"),
    EXPORT_NUMBER(smoothing, "steering", "smoothing_s", 1e-6, 1000, "s", "of the heading whose rate that is"),
    EXPORT_NUMBER(lookahead, "steering", "lookahead_m", 1e-6, 1e4, "m", "of the line of sight"),
    EXPORT_NUMBER(ahead, "steering", "ahead_m", 0, 1e4, "m", "along the path, where its course is taken"),
    EXPORT_NUMBER(sight_integral, "steering", "integral_m_s", 0, 1e4, "m/s", "integral action of the line of sight"),
    EXPORT_NUMBER(look, "steering", "look_s", 1e-6, 100, "s", "between two calls of the law"),
    MORAY_ROW(TEXT, export_job, plan_file, "steering", "plan", .flag = "plan", .argument = "FILE",
              .help = "CSV file with the columns t, phi_0 and heading (s, rad), such as trajectory.csv of a run that "
                      "steers: that of the run unless given"),
    MORAY_ROW(TEXT, export_job, path_text, "problem", "path", .flag = "path", .argument = "TEXT",
              .help = "waypoints X,Y X,Y ... in m, or a CSV file with the columns x_m,y_m"),
    EXPORT_NUMBER(radius, "problem", "radius_m", 1e-3, 1e4, "m", "of the arcs that join the legs"),
    EXPORT_NUMBER(offset, "problem", "phi0_max_m", 1e-6, 0.5, "m",
                  "largest joint offset of the control-oriented model; of the robot in the ratio of amplitudes"),
    EXPORT_NUMBER(offset_rate, "problem", "phi0_rate_m_s", 1e-6, 10, "m/s", "largest rate of it, likewise"),
    MORAY_GAIT_OPTIONS(export_job, gait),
};

static const char *const without[] = {"model", "current", "course", "scheme", "intervals", "tol", NULL};
static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(export_job, snake)}};
const moray_program export_program = {
    .name = "export",
    .summary =
        "Takes a gait and a law of steering home to a robot: tables at its control rate, a C header without heap "
        "or library, URDF and MuJoCo XML.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .groups = groups,
    .n_groups = 1,
    .without = without,
};

export_job export_defaults(void)
{
    export_job job = {.common = moray_common_default(),
                      .snake = moray_snake_options_default(),
                      .gait = moray_gait_input_default(),
                      .name = "snake",
                      .rate = 100,
                      .ramp = 1,
                      .law = -1,
                      .gains = {NAN, NAN, NAN, NAN, NAN},
                      .lookahead = NAN,
                      .ahead = NAN,
                      .sight_integral = NAN,
                      .look = 0.1,
                      .smoothing = 0.5,
                      .offset = 0.015,
                      .offset_rate = 0.01,
                      .radius = 3};
    job.snake.model = MORAY_FIRST_PRINCIPLES;
    job.gait.omega = job.gait.delta = NAN;
    job.gait.taper = NAN;
    return job;
}
