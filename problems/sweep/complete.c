// SPDX-License-Identifier: MIT
//
// A command line that has been read: what of it has to go together, and what it left open.
#include <stdio.h>
#include <string.h>

#include "sweep/arguments.h"
#include "sweep/point.h"

static bool is_varied(const sweep_arguments *a, const char *key)
{
    bool found = false;
    for (int k = 0; k < a->axes; k++)
        found = found || strcmp(a->axis[k].key, key) == 0;
    for (int r = 0; r < a->ranges; r++)
        found = found || strcmp(a->range[r].key, key) == 0;
    return found;
}

static bool is_given(const sweep_arguments *a, const char *flag)
{
    bool found = false;
    for (int k = 0; k < a->rest_n; k++)
        found = found || strncmp(a->rest[k], flag, strlen(flag)) == 0;
    return found;
}

// By its components or by its speed and direction, not by a mixture of both, nor of what is varied and what is not.
static moray_status check_current(const sweep_arguments *a)
{
    const bool speed = is_varied(a, CURRENT_SPEED), direction = is_varied(a, CURRENT_DEG);
    const char *component = is_varied(a, CURRENT_X) ? CURRENT_X : is_varied(a, CURRENT_Y) ? CURRENT_Y : NULL;
    if (direction && !speed)
        return moray_error(MORAY_INPUT,
                           CURRENT_DEG " is the direction of a current whose speed is missing: give " CURRENT_SPEED
                                       " too, one value of it for all as " CURRENT_SPEED "=0.1");
    if (speed && component)
        return moray_error(MORAY_INPUT,
                           CURRENT_SPEED " and %s: a current is given by its speed and direction or by its "
                                         "components, not both",
                           component);
    if ((speed || component) && is_given(a, "--current"))
        return moray_error(MORAY_INPUT,
                           "%s and --current: one of them, and the other component as one value of "
                           "its own, as " CURRENT_X "=0.1",
                           speed ? CURRENT_SPEED : component);
    return moray_ok();
}

moray_status sweep_complete(sweep_arguments *a)
{
    if (!a->program)
        return moray_error(MORAY_INPUT, "which program is to be swept? --help lists them");
    MORAY_TRY(check_current(a));
    if (!a->objective)
        a->objective = a->program->objective;
    if (a->file)
        return moray_ok();
    char name[80], *copy;
    snprintf(name, sizeof name, "%s.nc", a->program->name);
    MORAY_TRY(sweep_copy_of(a, name, &copy));
    a->file = copy;
    return moray_ok();
}
