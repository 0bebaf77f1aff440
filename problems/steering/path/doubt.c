// SPDX-License-Identifier: MIT
//
// What a path has that no certificate can pass: places where its nearest point jumps, or its curvature does.
#include <stdlib.h>

#include "path.h"

// The plan at t: along[0] the distance along the path, across how far to the left of it.
static double across_at(const path_job *job, const moray_solution *solution, double t, double *along)
{
    double x[MORAY_STEERING_STATES], u[2];
    moray_solution_at(solution, 0, t, x, u);
    const moray_path_point at = moray_path_at(&job->planned, u[1]);
    const double c = cos(creal(at.course)), s = sin(creal(at.course));
    *along = u[1];
    return c * (x[MORAY_STATE_P_Y] - creal(at.y)) - s * (x[MORAY_STATE_P_X] - creal(at.x));
}

// The arc of the least radius that the plan cuts by as much as its radius or nearly, and how far inside it passes [m];
// NULL: none. Beyond the centre of an arc no point of it is the nearest.
static const moray_path_piece *cut_corner(const path_job *job, const moray_solution *solution, double *inside)
{
    enum { points = 4000 };
    const double nearly = 0.8;
    const moray_path_piece *corner = NULL;
    double t0, t1;
    moray_solution_times(solution, 0, &t0, &t1);
    for (int k = 0; k <= points; k++) {
        double along;
        const double across = across_at(job, solution, t0 + (t1 - t0) * k / points, &along);
        for (int i = 0; i < job->planned.n; i++) {
            const moray_path_piece *arc = &job->planned.piece[i];
            const double reach = 1 / fabs(arc->curvature); // of a leg infinite
            if (arc->curvature * across < nearly || along < arc->start - reach ||
                along > arc->start + arc->length + reach || (corner && fabs(corner->curvature) > fabs(arc->curvature)))
                continue;
            if (corner != arc)
                *inside = 0;
            corner = arc;
            *inside = fmax(*inside, fabs(across));
        }
    }
    return corner;
}

// The node nearest to an end of an arc, by the distance along the path; its time.
static double nearest_node(const path_job *job, const moray_solution *solution, double *t)
{
    const int n = moray_solution_nodes(solution, 0, NULL, NULL);
    double *time = malloc((size_t)n * sizeof *time), nearest = INFINITY;
    if (!time)
        return INFINITY;
    moray_solution_nodes(solution, 0, time, NULL);
    for (int k = 0; k < n; k++) {
        double along;
        across_at(job, solution, time[k], &along);
        for (int i = 1; i < job->planned.n; i++) {
            const moray_path_piece *piece = &job->planned.piece[i];
            const double off = fabs(along - piece->start);
            if (off >= nearest || piece->sharpness != 0 || piece[-1].sharpness != 0)
                continue;
            nearest = off;
            *t = time[k];
        }
    }
    free(time);
    return nearest;
}

void path_doubt(const steer_job *steer, moray_model model, char *text, size_t size)
{
    const path_job *job = (const path_job *)steer;
    const moray_solution *solution = steer->plan[model].solution;
    const double close = 1e-3;
    double inside = 0, t = 0;
    const moray_path_piece *corner = cut_corner(job, solution, &inside);
    if (corner)
        moray_text_add(
            text, size,
            "; it passes %.3g m inside of the corner behind leg %d, of radius_m = %.3g: the nearest point of "
            "the path jumps there",
            inside, corner->leg, 1 / fabs(corner->curvature));
    const double off = nearest_node(job, solution, &t);
    if (!corner && off < close)
        moray_text_add(
            text, size,
            "; its node at t = %.4g s is %.2g m from where a leg meets an arc, and the path's curvature jumps", t, off);
}
