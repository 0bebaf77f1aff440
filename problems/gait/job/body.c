// SPDX-License-Identifier: MIT
//
// Figures of the body of a robot on a gait.
#include <math.h>
#include <stdlib.h>

#include "figures.h"

enum { POINTS = GAIT_POINTS, SHAPES = 6 };

// The body at equal times of the period, one below the other, each where it is along its way.
static moray_status draw_shapes(const gait_period *v)
{
    const moray_robot *robot = moray_swimmer_robot(v->swimmer);
    const int N = robot->links;
    const double apart = 3 * robot->l;
    double *xy = malloc((size_t)(2 * SHAPES * 3 * N + 3 * N) * sizeof *xy),
           *links = xy ? xy + 2 * SHAPES * 3 * N : NULL;
    char title[80];
    moray_curve curves[SHAPES];
    if (!xy)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    for (int s = 0; s < SHAPES; s++) {
        const int k = s * (POINTS - 1) / SHAPES;
        double *x = xy + 2 * s * 3 * N, *y = x + 3 * N;
        moray_swimmer_links(v->swimmer, v->track->x + (size_t)k * (size_t)v->track->n_states, links, links + N,
                            links + 2 * N);
        for (int i = 0; i < 3 * N; i++) {
            const int link = i / 3, end = i % 3; // both ends, then a gap
            const double along = end == 2 ? NAN : (2 * end - 1) * moray_swimmer_half_length(v->swimmer, link);
            x[i] = links[link] + along * cos(links[2 * N + link]);
            y[i] = links[N + link] + along * sin(links[2 * N + link]) - s * apart;
        }
        curves[s] = (moray_curve){.x = x, .y = y, .n = 3 * N, .style = MORAY_CURVE_BODY, .colour = MORAY_COLOUR_BEST};
    }
    snprintf(title, sizeof title, "shapes of the body over a period, every %.2f s", v->track->t[(POINTS - 1) / SHAPES]);
    const moray_status status = gait_period_draw(v,
                                                 (moray_figure){.name = "shapes",
                                                                .title = title,
                                                                .x_label = "x [m]",
                                                                .y_label = "y [m], one below the other",
                                                                .equal_axes = true},
                                                 curves, SHAPES);
    free(xy);
    return status;
}

// Along the course, the mean over a period of what the water does to each link: by what acts along it, and by what acts
// across it, added mass included. Over all links and a period they add up to nothing.
static moray_status draw_thrust(const gait_period *v)
{
    enum { LINK, ALONG, ACROSS, BOTH, ROWS };
    const int N = v->joints + 1;
    const double course = v->job->snake.course;
    double *rows = calloc((size_t)(ROWS * N + 6 * N), sizeof *rows);
    if (!rows)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    double *along = rows + ROWS * N, *across = along + N, *places = across + N, *ubar = places + 3 * N;
    bool known = true;
    moray_swimmer_set_current(v->swimmer, v->track->current[0], v->track->current[1]);
    for (int k = 0; k < POINTS - 1 && known; k++) {
        const double *x = v->track->x + (size_t)k * (size_t)v->track->n_states;
        moray_swimmer_control(v->swimmer, v->gait, v->track->t[k], x, ubar);
        moray_swimmer_links(v->swimmer, x, places, places + N, places + 2 * N);
        known = moray_swimmer_water_forces(v->swimmer, x, ubar, along, across);
        for (int i = 0; i < N; i++) {
            const double angle = places[2 * N + i] - course;
            rows[LINK * N + i] = i + 1;
            rows[ALONG * N + i] += along[i] * cos(angle) / (POINTS - 1);
            rows[ACROSS * N + i] -= across[i] * sin(angle) / (POINTS - 1);
            rows[BOTH * N + i] = rows[ALONG * N + i] + rows[ACROSS * N + i];
        }
    }
    const moray_curve curves[] = {{.label = "by what acts across the link",
                                   .x = rows,
                                   .y = rows + ACROSS * N,
                                   .n = N,
                                   .style = MORAY_CURVE_MARKED,
                                   .colour = MORAY_COLOUR_SECOND},
                                  {.label = "by what acts along the link",
                                   .x = rows,
                                   .y = rows + ALONG * N,
                                   .n = N,
                                   .style = MORAY_CURVE_MARKED,
                                   .colour = MORAY_COLOUR_BASELINE},
                                  {.label = "both: thrust above 0, drag below",
                                   .x = rows,
                                   .y = rows + BOTH * N,
                                   .n = N,
                                   .style = MORAY_CURVE_MARKED,
                                   .colour = MORAY_COLOUR_BEST}};
    const moray_status status =
        known ? gait_period_draw(v,
                                 (moray_figure){.name = "thrust",
                                                .title = "thrust and drag along the body",
                                                .x_label = "link, 1 at the tail",
                                                .y_label = "mean force of the water along the course [N]"},
                                 curves, 3)
              : moray_ok();
    free(rows);
    return status;
}

moray_status gait_period_draw_body(const gait_period *v)
{
    MORAY_TRY(draw_shapes(v));
    return v->control ? moray_ok() : draw_thrust(v); // the control-oriented model knows no forces on single links
}
