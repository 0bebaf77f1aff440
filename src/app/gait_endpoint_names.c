// SPDX-License-Identifier: MIT
#include "app/gait_endpoint.h"

void gait_endpoint_names(const struct gait_endpoint *e, const char **name)
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
