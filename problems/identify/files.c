// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "identify.h"

// The key of an unknown of the robot in its INI file; NULL where it is none of the robot's.
static const char *key_of(int unknown)
{
    const char *name = moray_unknown_name(unknown);
    if (unknown >= moray_unknown_named("current_x"))
        return NULL;
    return strcmp(name, "m") == 0 ? "m_kg" : strcmp(name, "J") == 0 ? "J_kg_m2" : name;
}

static void write_estimates(const identify *run, FILE *file)
{
    char number[32];
    bool mass = false, inertia = false;
    for (int k = 0; k < run->n; k++) {
        const char *key = key_of(run->unknown[k]);
        if (!key)
            continue;
        mass = mass || strcmp(key, "m_kg") == 0;
        inertia = inertia || strcmp(key, "J_kg_m2") == 0;
        fprintf(file, "%s = %s", key, moray_number_text(run->at[0].value[k], number));
        if (run->info.held[k])
            fprintf(file, " ; at its bound\n");
        else if (isfinite(run->info.error[k]))
            fprintf(file, " ; +- %.2g\n", identify_half_width(run, &run->info, k));
        else
            fprintf(file, " ; not determined\n");
    }
    if (mass && !inertia) // which the mass alone would change
        fprintf(file, "J_kg_m2 = %s\n", moray_number_text(run->world.robot.J, number));
}

static bool is_estimated(const identify *run, const char *line)
{
    const size_t length = strcspn(line, " =");
    for (int k = 0; k < run->n; k++) {
        const char *key = key_of(run->unknown[k]);
        if (key && strlen(key) == length && strncmp(key, line, length) == 0)
            return true;
    }
    return false;
}

// Lines of a section of the settings, but for what was estimated.
static void write_kept(const identify *run, const char *section, FILE *file)
{
    char begin[40];
    snprintf(begin, sizeof begin, "\n[%s]\n", section);
    const char *at = run->common.ini ? strstr(run->common.ini, begin) : NULL;
    for (at = at ? at + strlen(begin) : ""; *at && *at != '[' && *at != '\n';) {
        const int length = (int)strcspn(at, "\n");
        if (*at != ';' && !is_estimated(run, at))
            fprintf(file, "%.*s\n", length, at);
        at += length + (at[length] == '\n');
    }
}

static void write_robot(const identify *run, FILE *file)
{
    const moray_unknowns *w = &run->world;
    fprintf(file, "; A robot identified by the %s model from", moray_model_name(run->snake.model));
    for (int k = 0; k < run->n_logs; k++)
        fprintf(file, " %s", run->log[k].name);
    fprintf(file, "; residuals: %s.\n", run->fit.simple ? "FAIL, the model is too simple" : "pass");
    fprintf(
        file,
        "; Beside it: --current %.6g,%.6g m/s; heading bias %.4g deg, camera turned by %.4g deg; delays of position "
        "%.4g s, heading %.4g s, joints %.4g s.\n",
        w->current[0], w->current[1], w->heading_bias / DEG, w->camera_rotation / DEG, w->position_delay,
        w->heading_delay, w->joint_delay);
    fprintf(file, "[robot]\n");
    write_kept(run, "robot", file);
    write_estimates(run, file);
    fprintf(file, "\n[motor]\n");
    write_kept(run, "motor", file);
    fprintf(file, "\n[battery]\n");
    write_kept(run, "battery", file);
}

static void write_scenarios(const identify *run, FILE *file)
{
    moray_unknowns world[MORAY_SCENARIOS];
    int physical[MORAY_MOST_UNKNOWNS], n = 0;
    for (int k = 0; k < run->n; k++) // what a gait depends on
        if (run->unknown[k] <= moray_unknown_named("current_y"))
            physical[n++] = run->unknown[k];
    const int worlds =
        moray_identify_worlds(run->fitted, &run->at[0], &run->info, run->inflation, 1 + 2 * run->axes, world);
    moray_worlds_write(world, worlds, physical, n, file);
}

static void write_residuals(const identify *run, FILE *file)
{
    fprintf(file, "log,line,t [s],channel,joint,observed,predicted,sigma\n");
    for (int k = 0; k < run->fit.n; k++) {
        const moray_residual_point *p = &run->fit.point[k];
        const moray_channel_fit *c = &run->fit.channel[p->channel];
        char observed[32], predicted[32];
        fprintf(file, "%s,%d,%.10g,%s,%d,%s,%s,%.6g\n", run->log[p->run].name, run->log[p->run].line[p->row], p->t,
                moray_channel_name(c->kind), c->kind == MORAY_CHANNEL_TORQUE ? c->joint + 1 : 0,
                moray_number_text(p->observed, observed), moray_number_text(p->predicted, predicted), p->sigma);
    }
}

moray_status identify_write(const void *found, moray_output *output)
{
    FILE *file;
    MORAY_TRY(moray_output_file(output, "robot.ini", &file));
    write_robot(found, file);
    MORAY_TRY(moray_output_file(output, "scenarios.csv", &file));
    write_scenarios(found, file);
    MORAY_TRY(moray_output_file(output, "residuals.csv", &file));
    write_residuals(found, file);
    return moray_ok();
}
