// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "snake/gait/endpoint.h"

// As moray_gait_ends orders them.
static void link_angle_names(const struct gait_endpoint *e, gait_name *text, const char **name)
{
    static const char *const to[] = {"right", "left"};
    for (int tail = e->tail && !e->head; tail <= e->tail; tail++)
        for (int joints = 1; joints <= 2 && joints < e->links; joints++)
            for (int left = e->left; left >= !e->right; left--, text++) {
                snprintf(*text, sizeof *text, "%s of the %s, to the %s", joints == 1 ? "end link" : "link",
                         tail ? "tail" : "head", to[left]);
                *name++ = *text;
            }
}

void moray_gait_event_names(const struct gait_endpoint *e, gait_name *text, const char **name)
{
    for (int r = 0; r < e->nx - 2; r++) {
        snprintf(text[r], sizeof *text, "periodicity %d", r + 1);
        *name++ = text[r];
    }
    *name++ = "way across the course";
    *name++ = "omega T";
    if (!e->series)
        *name++ = "theta_max";
    if (e->head)
        *name++ = "theta_max of the head";
    if (e->tail)
        *name++ = "theta_max of the tail";
    if (e->power)
        *name++ = "power";
    if (e->rate && e->head && e->tail)
        *name++ = "joint rate of the head";
    if (e->rate)
        *name++ = e->head && e->tail ? "joint rate of the tail" : "joint rate";
    if (e->speed)
        *name++ = "course speed";
    if (e->left || e->right)
        link_angle_names(e, text + e->nx, name);
}

void moray_gait_path_names(int n, int efforts, int lines, int links, gait_name *text, const char **name)
{
    const struct {
        const char *what;
        int count;
    } kinds[] = {{"joint effort", efforts}, {"supply", lines * (links - 1)}, {"link angle", links}, {"joint rate", n}};
    int i = 0;
    for (size_t kind = 0; kind < sizeof kinds / sizeof *kinds; kind++)
        for (int k = 0; k < kinds[kind].count && i < n; k++, i++) {
            snprintf(text[i], sizeof *text, "%s %d", kinds[kind].what, k + 1);
            name[i] = text[i];
        }
}
