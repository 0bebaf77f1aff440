// SPDX-License-Identifier: MIT
//
// The C header: what it is, its numbers, and the parts of C that the gait and the law need.
#include "export.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "parts.h"

// ---- Text ----------------------------------------------------------------------------------------------------------

typedef struct writer {
    FILE *file;
    char name[EXPORT_NAME], capitals[EXPORT_NAME];
} writer;

static void put(const writer *w, const char *text)
{
    for (const char *c = text; *c; c++)
        if (*c == '@' || *c == '$')
            fputs(*c == '@' ? w->name : w->capitals, w->file);
        else
            fputc(*c, w->file);
}

static void put_part(const writer *w, const char *const *lines)
{
    for (; *lines; lines++)
        put(w, *lines);
}

static void put_number(const writer *w, double value)
{
    char text[32];
    put(w, "$_C(");
    fprintf(w->file, "%s)", moray_number_text(value, text));
}

// #define of a real number, with what it is.
static void define(const writer *w, const char *key, double value, const char *what)
{
    put(w, "#define $_");
    fprintf(w->file, "%s ", key);
    put_number(w, value);
    fprintf(w->file, " // %s\n", what);
}

static void define_whole(const writer *w, const char *key, int value, const char *what)
{
    put(w, "#define $_");
    fprintf(w->file, "%s %d // %s\n", key, value, what);
}

// Rows of numbers in braces.
static void put_rows(const writer *w, const double *values, int rows, int columns)
{
    for (int k = 0; k < rows; k++) {
        fputs(columns > 1 ? "    {" : "    ", w->file);
        for (int i = 0; i < columns; i++) {
            put_number(w, values[k * columns + i]);
            fputs(i + 1 < columns ? (i % 4 == 3 ? ",\n     " : ", ") : "", w->file);
        }
        fprintf(w->file, "%s%s\n", columns > 1 ? "}" : "", k + 1 < rows ? "," : "");
    }
}

// ---- The head ------------------------------------------------------------------------------------------------------

static const char intent[] =
    "// Angles in rad, lengths in m, times in s. Joint i = 0..$_JOINTS-1 from tail to head is at phi_i = theta_i - "
    "theta_{i+1},\n"
    "// theta_i the angle of link i from the x axis, counterclockwise seen from above. The gait counts from t = 0.\n"
    "//\n"
    "// Nothing is allocated and nothing called: no library, not <math.h>. What a law keeps is in a state of the "
    "caller's. Sine and\n"
    "// cosine are exact to 2e-16 in double and 2e-7 in float for angles below 1e4 rad; with float, keep t below some "
    "1e3 s, or take\n"
    "// whole periods away from it.\n"
    "//\n"
    "// $_REAL is the type of all numbers: double, unless it is defined as float before this file is included.\n"
    "//\n";

static void put_use(const writer *w, export_law law)
{
    static const char *const calls[] = {
        [EXPORT_HEADING] = "@_steer(&state, t, heading, target, target_rate);",
        [EXPORT_PATH] = "@_steer(&state, t, heading, x, y);",
        [EXPORT_PLAN] = "@_steer(&state, t, heading);",
    };
    put(w, "//     @_state state;\n//     @_start(&state);\n");
    if (law != EXPORT_NONE) {
        put(w, "//     every $_LOOK:  ");
        put(w, calls[law]);
        fputc('\n', w->file);
    }
    put(w, "//     every control step:  @_joints(&state, t, phi, dphi, ddphi);\n");
}

static void put_head(const writer *w, const export_found *found)
{
    char command[2000];
    export_command(found->job, command, sizeof command);
    put(w, "// @.h: ");
    fprintf(w->file, "the gait%s of an underwater snake robot of %d links, by moray %s.\n",
            found->law == EXPORT_NONE ? "" : " and the steering", found->job->snake.robot.links, moray_version());
    fprintf(w->file, "// Command: `%s`\n//\n", command);
    put(w, intent);
    put_use(w, found->law);
    put(w, "#ifndef $_H\n#define $_H\n\n#ifndef $_REAL\n#define $_REAL double\n#endif\ntypedef $_REAL @_real;\n");
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

static void put_gait_numbers(const writer *w, const export_found *found)
{
    const moray_series *wave = &found->wave;
    const moray_robot *robot = &found->job->snake.robot;
    const int n = wave->joints, block = 2 * n;
    define_whole(w, "JOINTS", n, "");
    define_whole(w, "HARMONICS", wave->harmonics, "of the gait");
    define(w, "OMEGA", found->gait.omega, "frequency [rad/s]");
    define(w, "PERIOD", found->period, "[s]");
    define(w, "RAMP", found->job->ramp * found->period, "from the straight body to the gait [s]");
    define(w, "K_P", robot->k_p, "joint controller (34) [1/s^2]");
    define(w, "K_D", robot->k_d, "[1/s]");
    put(w, "\n// Joint i: constant_i + sum over k of sine_ki sin(k omega t) + cosine_ki cos(k omega t) [rad].\n"
           "static const @_real @_constant[$_JOINTS] = {\n");
    put_rows(w, wave->at, n, 1);
    for (int which = 0; which < 2; which++) {
        put(w, which ? "};\nstatic const @_real @_cosine[$_HARMONICS][$_JOINTS] = {\n"
                     : "};\nstatic const @_real @_sine[$_HARMONICS][$_JOINTS] = {\n");
        for (int k = 0; k < wave->harmonics; k++) {
            put_rows(w, wave->at + n + k * block + which * n, 1, n);
            if (k + 1 < wave->harmonics)
                put(w, "    ,\n");
        }
    }
    put(w, "};\n");
}

static void put_law_numbers(const writer *w, const export_found *found)
{
    const double gain = found->scale * found->gains.proportional;
    put(w, "\n// The law of steering; offsets are of the joints [rad].\n");
    define(w, "LOOK", found->job->look, "time between two calls [s]");
    define(w, "OFFSET_MAX", found->offset, "[rad]");
    define(w, "OFFSET_RATE_MAX", found->offset_rate, "[rad/s]");
    define(w, "SWING_COS", found->straight.undulation[0], "what the gait swings the mean heading by: cosine [rad]");
    define(w, "SWING_SIN", found->straight.undulation[1], "and sine of omega t [rad]");
    define(w, "GAIN", gain, "[rad/rad]; a positive offset turns the robot clockwise");
    if (found->law == EXPORT_PATH) {
        define(w, "SIGHT", found->lookahead, "lookahead [m]");
        define(w, "SIGHT_INTEGRAL", found->sight_integral, "sigma [m/s]");
        define(w, "AHEAD", found->ahead, "along the path, where its course is taken [m]");
        return;
    }
    define(w, "GAIN_FORWARD", found->scale * found->gains.forward, "of the target's rate [rad s/rad]");
    define(w, "GAIN_INTEGRAL", gain * found->gains.integral, "[rad/(rad s)]");
    define(w, "GAIN_DERIVATIVE", gain * found->gains.derivative, "[rad s/rad]");
    define(w, "FILTER", 1 - exp(-found->job->look / found->job->smoothing), "of the heading whose rate is taken");
    if (found->law == EXPORT_HEADING)
        define(w, "LEAD", found->gains.lead, "how far ahead the target is to be [s]");
}

static void put_path(const writer *w, const export_found *found)
{
    const moray_path *path = &found->path;
    define_whole(w, "PIECES", path->n, "of the path");
    define(w, "LENGTH", path->length, "[m]");
    define(w, "RADIUS", path->radius, "of its arcs [m]");
    put(w, "\n// Distance along the path where a piece begins [m], x, y [m], course [rad] there, curvature [1/m].\n"
           "static const @_real @_path[$_PIECES][5] = {\n");
    for (int k = 0; k < path->n; k++) {
        const moray_path_piece *piece = &path->piece[k];
        const double row[5] = {piece->start, piece->x, piece->y, piece->course, piece->curvature};
        put_rows(w, row, 1, 5);
        if (k + 1 < path->n)
            put(w, "    ,\n");
    }
    put(w, "};\n");
}

static void put_plan(const writer *w, const export_found *found)
{
    define_whole(w, "PLAN", found->n_plan, "rows of the plan");
    put(w, "\n// Every $_LOOK seconds from t = 0: joint offset [rad], heading without its swing [rad].\n"
           "static const @_real @_plan[$_PLAN][2] = {\n");
    put_rows(w, found->plan, found->n_plan, 2);
    put(w, "};\n");
}

// ---- All -----------------------------------------------------------------------------------------------------------

static void put_law(const writer *w, const export_found *found)
{
    put_law_numbers(w, found);
    if (found->law == EXPORT_PATH)
        put_path(w, found);
    if (found->law == EXPORT_PLAN)
        put_plan(w, found);
    put_part(w, export_steer);
    if (found->law != EXPORT_PATH)
        put_part(w, export_heading);
    put_part(w, found->law == EXPORT_PATH      ? export_path_law
                : found->law == EXPORT_HEADING ? export_heading_law
                                               : export_plan_law);
}

moray_status export_header(const export_found *found, moray_output *output)
{
    char file_name[EXPORT_NAME + 4];
    writer w = {0};
    strcpy(w.name, found->job->name);
    for (int k = 0; w.name[k]; k++)
        w.capitals[k] = (char)toupper((unsigned char)w.name[k]);
    snprintf(file_name, sizeof file_name, "%s.h", w.name);
    MORAY_TRY(moray_output_file(output, file_name, &w.file));
    put_head(&w, found);
    put_part(&w, export_arithmetic);
    put(&w, "\n// ---- Numbers ---------------------------------------------------------------------------------------"
            "----------------\n\n");
    put_gait_numbers(&w, found);
    put_part(&w, export_gait);
    if (found->law != EXPORT_NONE)
        put_law(&w, found);
    put(&w, "\n#endif\n");
    return moray_ok();
}
