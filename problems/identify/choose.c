// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "identify.h"
#include "moray/number.h"

static const double wide = 5; // coefficients lie within so many times of where they start, unless told

// Words for several.
static const struct {
    const char *word, *names;
} groups[] = {{"current", "current_x,current_y"},
              {"lambda", "lambda_1,lambda_2,lambda_3"},
              {"camera", "camera_rotation,camera_x,camera_y"},
              {"delays", "position_delay,heading_delay"}};

static moray_status refuse(const char *name)
{
    char all[400] = "";
    for (unsigned g = 0; g < sizeof groups / sizeof *groups; g++)
        moray_text_add(all, sizeof all, "%s, ", groups[g].word);
    for (int k = 0; moray_unknown_name(k); k++)
        moray_text_add(all, sizeof all, "%s%s", k ? ", " : "", moray_unknown_name(k));
    return moray_error(MORAY_INPUT, "estimate: %.40s: must be of %s", name, all);
}

static moray_status add_name(identify *run, const char *name)
{
    const int unknown = moray_unknown_named(name);
    if (unknown < 0)
        return refuse(name);
    for (int k = 0; k < run->n; k++)
        if (run->unknown[k] == unknown)
            return moray_error(MORAY_INPUT, "estimate: %s stands there twice", name);
    run->unknown[run->n++] = unknown;
    return moray_ok();
}

static moray_status add_names(identify *run, const char *names)
{
    char text[LIST_SIZE], *rest = NULL;
    snprintf(text, sizeof text, "%s", names);
    for (char *name = strtok_r(text, ", ", &rest); name; name = strtok_r(NULL, ", ", &rest)) {
        const char *group = NULL;
        for (unsigned g = 0; g < sizeof groups / sizeof *groups; g++)
            if (strcmp(groups[g].word, name) == 0)
                group = groups[g].names;
        MORAY_TRY(group ? add_names(run, group) : add_name(run, name));
    }
    return moray_ok();
}

static moray_unknowns start_of(const identify *run)
{
    return (moray_unknowns){.robot = run->snake.robot, .current = {run->snake.current[0], run->snake.current[1]}};
}

// Where nothing is told.
static void default_bounds(const identify *run, int unknown, double *lower, double *upper)
{
    moray_unknowns start = start_of(run);
    const double value = *moray_unknown_at(unknown, &start);
    const char *name = moray_unknown_name(unknown);
    if (unknown < moray_unknown_named("current_x"))
        *lower = value / wide, *upper = value > 0 ? value * wide : 1;
    else if (strstr(name, "delay"))
        *lower = strcmp(name, "joint_delay") ? 0 : -0.5, *upper = 0.5;
    else if (strstr(name, "camera_") == name && strcmp(name, "camera_rotation"))
        *lower = value - 100, *upper = value + 100;
    else if (strstr(name, "current"))
        *lower = value - 0.5, *upper = value + 0.5;
    else
        *lower = -M_PI, *upper = M_PI;
}

// "KEY=LOW:HIGH,...", in units as shown.
static moray_status read_bounds(identify *run)
{
    char text[LIST_SIZE], *rest = NULL;
    snprintf(text, sizeof text, "%s", run->bounds);
    for (char *item = strtok_r(text, ", ", &rest); item; item = strtok_r(NULL, ", ", &rest)) {
        char *value = strchr(item, '='), *middle = value ? strchr(value, ':') : NULL;
        if (!value || !middle)
            return moray_error(MORAY_INPUT, "bounds: %.60s: must be KEY=LOW:HIGH with commas between", item);
        *value++ = *middle++ = 0;
        const int unknown = moray_unknown_named(item);
        int k = 0;
        while (k < run->n && run->unknown[k] != unknown)
            k++;
        if (k == run->n)
            return moray_error(MORAY_INPUT, "bounds: %.60s: is not among what is estimated", item);
        double scale;
        identify_unit(unknown, &scale);
        if (!moray_number_read(value, &run->lower[k]) || !moray_number_read(middle, &run->upper[k]) ||
            !(run->lower[k] < run->upper[k]))
            return moray_error(MORAY_INPUT, "bounds: %.40s=%.40s:%.40s: must be two numbers, the lower first", item,
                               value, middle);
        run->lower[k] *= scale;
        run->upper[k] *= scale;
    }
    return moray_ok();
}

const char *identify_unit(int unknown, double *scale)
{
    const char *unit = moray_unknown_unit(unknown);
    const bool angle = strcmp(unit, "rad") == 0;
    *scale = angle ? DEG : 1;
    return angle ? "deg" : unit;
}

moray_status identify_choose(identify *run)
{
    const bool control = run->snake.model == MORAY_CONTROL_ORIENTED;
    const char *usual = control ? "c_t,c_n,rot_damping,rot_gain,current" : "c_t,c_n,mu_n,current";
    MORAY_TRY(add_names(run, run->estimate[0] ? run->estimate : usual));
    for (int k = 0; k < run->n; k++)
        default_bounds(run, run->unknown[k], &run->lower[k], &run->upper[k]);
    return read_bounds(run);
}

moray_identify_spec identify_spec(const identify *run)
{
    return (moray_identify_spec){.model = run->snake.model,
                                 .start = start_of(run),
                                 .unknown = run->unknown,
                                 .n = run->n,
                                 .lower = run->lower,
                                 .upper = run->upper,
                                 .sigma = {run->position, run->position, run->heading, run->torque},
                                 .huber = run->loss == LOSS_HUBER ? run->huber : 0,
                                 .rest = run->rest,
                                 .joints = (moray_logged_joints)run->joints,
                                 .step = run->step,
                                 .max_iterations = 60};
}
