// SPDX-License-Identifier: MIT
#include "swim.h"

moray_status paper_swim_at(paper *p, const paper_swim_plan *plan, const double *times, int n, moray_swim_track **track)
{
    moray_swimmer *swimmer = plan->swimmer ? plan->swimmer : p->rig.swimmer[plan->model];
    double *x;
    MORAY_TRY(paper_track(p, swimmer, n, track));
    MORAY_TRY(paper_numbers(p, (size_t)moray_swimmer_states(swimmer), &x));
    moray_swimmer_rest(swimmer, 0, 0, plan->p_y, x);
    const moray_swim_plan swim = {.t1 = times[n - 1],
                                  .schedule = plan->schedule,
                                  .n_changes = plan->n_changes,
                                  .times = times,
                                  .n_times = n,
                                  .observe = moray_swim_track_add,
                                  .observer = *track};
    return moray_swim_run(swimmer, &p->rig.settings.sim, &swim, x, NULL);
}

moray_status paper_swim(paper *p, const paper_swim_plan *plan, double duration, double step, moray_swim_track **track)
{
    const int n = (int)lround(duration / step) + 1;
    double *times;
    MORAY_TRY(paper_numbers(p, (size_t)n, &times));
    for (int k = 0; k < n; k++)
        times[k] = duration * k / (n - 1);
    return paper_swim_at(p, plan, times, n, track);
}

moray_status paper_mean_velocity(paper *p, const paper_swim_plan *plan, double duration, int n_periods, double *v_x)
{
    const double span = n_periods * 2 * M_PI / plan->schedule[0].gait.omega, times[] = {duration - span, duration};
    moray_swim_track *track;
    MORAY_TRY(paper_swim_at(p, plan, times, 2, &track));
    *v_x = (track->pose[1].p_x - track->pose[0].p_x) / span;
    return moray_ok();
}

double paper_mean_heading(const moray_swim_track *track, double t, double period)
{
    const double tolerance = 1e-9;
    double sum = 0, span = 0;
    for (int k = 1; k < track->n; k++) {
        const double from = track->t[k - 1], to = track->t[k];
        if (from < t - period - tolerance || to > t + tolerance)
            continue;
        sum += (track->pose[k - 1].heading + track->pose[k].heading) / 2 * (to - from);
        span += to - from;
    }
    return sum / span;
}

moray_status paper_series(paper *p, const moray_swim_track *track, paper_quantity quantity, double **values)
{
    MORAY_TRY(paper_numbers(p, (size_t)track->n, values));
    for (int k = 0; k < track->n; k++) {
        const moray_pose *pose = &track->pose[k];
        const double of[] = {[PAPER_P_X] = pose->p_x,
                             [PAPER_P_Y] = pose->p_y,
                             [PAPER_V_X] = pose->v_x,
                             [PAPER_V_Y] = pose->v_y,
                             [PAPER_HEADING_DEG] = pose->heading / DEG};
        (*values)[k] = of[quantity];
    }
    return moray_ok();
}

const moray_model paper_model_order[2] = {MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED};

moray_curve paper_model_curve(moray_model model, const double *x, const double *y, int n)
{
    return (moray_curve){.label = moray_model_name(model),
                         .x = x,
                         .y = y,
                         .n = n,
                         .style = n < 30 ? MORAY_CURVE_MARKED : MORAY_CURVE_LINE};
}

moray_status paper_compare(paper *p, const char *name, const char *title, const char *x_label, const char *y_label,
                           const double *x, const double *const y[2], int n)
{
    moray_curve curves[2];
    for (int k = 0; k < 2; k++)
        curves[k] = paper_model_curve(paper_model_order[k], x, y[paper_model_order[k]], n);
    return paper_figure(
        p, &(moray_figure){
               .name = name, .title = title, .x_label = x_label, .y_label = y_label, .curves = curves, .n_curves = 2});
}

moray_status paper_pair_of(paper *p, moray_swim_track *const track[2], paper_pair *pair)
{
    *pair = (paper_pair){.t = track[0]->t, .n = track[0]->n};
    for (int q = 0; q < PAPER_QUANTITIES; q++)
        for (int model = 0; model < 2; model++)
            MORAY_TRY(paper_series(p, track[model], (paper_quantity)q, &pair->of[q][model]));
    return moray_ok();
}

moray_status paper_pair_csv(paper *p, const paper_pair *pair, int n_quantities)
{
    static const char *const names[PAPER_QUANTITIES][2] = {
        {"p_x", "m"}, {"p_y", "m"}, {"v_x", "m/s"}, {"v_y", "m/s"}, {"heading", "deg"}};
    moray_column columns[1 + 2 * PAPER_QUANTITIES] = {{.name = "t", .unit = "s", .values = pair->t}};
    for (int k = 0; k < 2 * n_quantities; k++)
        columns[1 + k] = (moray_column){.name = paper_label(p, "%s %s", names[k / 2][0], moray_model_name(k % 2)),
                                        .unit = names[k / 2][1],
                                        .values = pair->of[k / 2][k % 2]};
    return paper_csv(p, NULL, columns, 1 + 2 * n_quantities, pair->n);
}

moray_status paper_pair_over_time(paper *p, const paper_pair *pair, paper_quantity quantity, const char *name,
                                  const char *title, const char *y_label)
{
    const double *const y[2] = {pair->of[quantity][0], pair->of[quantity][1]};
    return paper_compare(p, name, title, "time [s]", y_label, pair->t, y, pair->n);
}

moray_status paper_pair_position(paper *p, const paper_pair *pair, const char *title, const moray_curve *points)
{
    moray_curve curves[3];
    for (int k = 0; k < 2; k++) {
        const moray_model model = paper_model_order[k];
        curves[k] = paper_model_curve(model, pair->of[PAPER_P_X][model], pair->of[PAPER_P_Y][model], pair->n);
    }
    if (points)
        curves[2] = *points;
    return paper_figure(p, &(moray_figure){.name = "position",
                                           .title = title,
                                           .x_label = "p_x [m]",
                                           .y_label = "p_y [m]",
                                           .equal_axes = true,
                                           .curves = curves,
                                           .n_curves = points ? 3 : 2});
}
