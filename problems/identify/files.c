// SPDX-License-Identifier: MIT
#include <math.h>
#include <stddef.h>
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

// Keys of [robot] for all links alike, where the links have theirs.
static bool is_of_all(const char *line, size_t length)
{
    static const char *const keys[] = {"l_m",  "m_kg",     "J_kg_m2",  "c_t",     "c_n",
                                       "mu_n", "lambda_1", "lambda_2", "lambda_3"};
    for (unsigned k = 0; k < sizeof keys / sizeof *keys; k++)
        if (strlen(keys[k]) == length && strncmp(keys[k], line, length) == 0)
            return true;
    return false;
}

static void write_estimates(const identify *run, FILE *file)
{
    char number[32];
    bool mass = false, inertia = false;
    for (int k = 0; k < run->n; k++) {
        const char *key = key_of(run->unknown[k]);
        if (!key)
            continue;
        const bool of_each = run->world.robot.link && is_of_all(key, strlen(key));
        mass = mass || strcmp(key, "m_kg") == 0;
        inertia = inertia || strcmp(key, "J_kg_m2") == 0;
        fprintf(file, "%s%s = %s", of_each ? "; mean of the links: " : "", key,
                moray_number_text(run->at[0].value[k], number));
        if (run->info.held[k])
            fprintf(file, " ; at its bound\n");
        else if (isfinite(run->info.error[k]))
            fprintf(file, " ; +- %.2g\n", identify_half_width(run, &run->info, k));
        else
            fprintf(file, " ; not determined\n");
    }
    if (mass && !inertia && !run->world.robot.link) // which the mass alone would change
        fprintf(file, "J_kg_m2 = %s\n", moray_number_text(run->world.robot.J, number));
}

static bool is_estimated(const identify *run, const char *line)
{
    const size_t length = strcspn(line, " =");
    if (run->world.robot.link && is_of_all(line, length))
        return true;
    for (int k = 0; k < run->n; k++) {
        const char *key = key_of(run->unknown[k]);
        if (key && strlen(key) == length && strncmp(key, line, length) == 0)
            return true;
    }
    return false;
}

// Lines of a section of the settings, but for what was estimated or stands in [links].
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

// Over as many lines as INI files want.
static void write_list(const char *key, const double *value, int n, FILE *file)
{
    const int in_a_line = 6;
    char number[32];
    fprintf(file, "%s =", key);
    for (int i = 0; i < n; i++)
        fprintf(file, "%s %s", i == 0 ? "" : i % in_a_line ? "," : ",\n   ", moray_number_text(value[i], number));
    fprintf(file, "\n");
}

// Every link as it was found: the coefficients of all moved in the ratios that they have.
static void write_links(const identify *run, FILE *file)
{
    static const struct {
        const char *key;
        size_t at;
    } lists[] = {{"link_length_m", offsetof(moray_link, l)},        {"link_m_kg", offsetof(moray_link, m)},
                 {"link_J_kg_m2", offsetof(moray_link, J)},         {"link_c_t", offsetof(moray_link, c_t)},
                 {"link_c_n", offsetof(moray_link, c_n)},           {"link_mu_n", offsetof(moray_link, mu_n)},
                 {"link_lambda_1", offsetof(moray_link, lambda_1)}, {"link_lambda_2", offsetof(moray_link, lambda_2)},
                 {"link_lambda_3", offsetof(moray_link, lambda_3)}, {"link_cm_m", offsetof(moray_link, cm)},
                 {"link_cb_m", offsetof(moray_link, cb)},           {"fin_c_t", offsetof(moray_link, fin_c_t)},
                 {"fin_c_n", offsetof(moray_link, fin_c_n)},        {"fin_mu_n", offsetof(moray_link, fin_mu_n)},
                 {"fin_at_m", offsetof(moray_link, fin_at)}};
    const moray_link_lists *given = &run->snake.lists;
    const int N = run->world.robot.links;
    double value[MORAY_MOST_LINKS];
    fprintf(file, "\n[links]\n");
    for (unsigned k = 0; k < sizeof lists / sizeof *lists; k++) {
        for (int i = 0; i < N; i++) {
            const moray_link link = moray_robot_link(&run->world.robot, i);
            value[i] = *(const double *)((const char *)&link + lists[k].at) * (k == 0 ? 2 : 1);
        }
        write_list(lists[k].key, value, N, file);
    }
    if (!isnan(given->a_e[0]))
        write_list("link_a_e_m", given->a_e, N, file);
    if (!isnan(given->b_e[0]))
        write_list("link_b_e_m", given->b_e, N, file);
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
    if (w->robot.link)
        write_links(run, file);
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
