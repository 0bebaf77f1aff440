// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "app/gait_endpoint.h"

void gait_event_names(const struct gait_endpoint *e, const char **name)
{
    for (int r = 0; r < e->nx - 2; r++)
        *name++ = "periodicity";
    *name++ = "way across the course";
    *name++ = "omega T";
    *name++ = "theta_max";
    if (e->head)
        *name++ = "theta_max of the head";
    if (e->tail)
        *name++ = "theta_max of the tail";
    if (e->power)
        *name++ = "power";
    for (int k = 0; k < (e->head && e->tail ? 2 : 1) && e->rate; k++)
        *name++ = "joint rate";
    if (e->speed)
        *name++ = "course speed";
}

void gait_path_names(int n, int efforts, gait_name *text, const char **name)
{
    for (int i = 0; i < n; i++) {
        const bool effort = i < efforts;
        snprintf(text[i], sizeof *text, "%s %d", effort ? "joint effort" : "link angle",
                 i + 1 - (effort ? 0 : efforts));
        name[i] = text[i];
    }
}
