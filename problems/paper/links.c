// SPDX-License-Identifier: MIT
//
// Properties 2 and 4: what the links do, and what the fluid does to them.
#include "links.h"

// ---- Displacement --------------------------------------------------------------------------------------------------

// Places of the links in sample k, less the mean motion, in a frame turned by `course`.
static void place(paper *p, moray_model model, const moray_swim_track *orbit, const double velocity[2], double course,
                  int k, double *scratch, link_paths *paths)
{
    const int N = paths->N;
    moray_swimmer_links(p->rig.swimmer[model], orbit->x + k * orbit->n_states, scratch, scratch + N, scratch + 2 * N);
    for (int i = 0; i < N; i++) {
        const double x = scratch[i] - velocity[0] * orbit->t[k], y = scratch[N + i] - velocity[1] * orbit->t[k];
        paths->along[i * CHAIN_POINTS + k] = cos(course) * x + sin(course) * y;
        paths->across[i * CHAIN_POINTS + k] = cos(course) * y - sin(course) * x;
    }
}

// Puts values about their mean; returns the mean.
static double centre(double *values)
{
    const double mean = chain_mean(values);
    for (int k = 0; k < CHAIN_POINTS; k++)
        values[k] -= mean;
    return mean;
}

moray_status link_paths_of(paper *p, moray_model model, link_paths *paths)
{
    const int N = p->robot->links;
    const double *V = p->rig.current;
    moray_steady steady;
    moray_swim_track *orbit;
    double *scratch;
    MORAY_TRY(paper_orbit(p, model, &p->gait[model], CHAIN_POINTS, &steady, &orbit));
    *paths = (link_paths){.N = N};
    MORAY_TRY(paper_numbers(p, (size_t)(N * CHAIN_POINTS), &paths->along));
    MORAY_TRY(paper_numbers(p, (size_t)(N * CHAIN_POINTS), &paths->across));
    MORAY_TRY(paper_numbers(p, (size_t)N, &paths->along_amplitude));
    MORAY_TRY(paper_numbers(p, (size_t)N, &paths->across_amplitude));
    MORAY_TRY(paper_numbers(p, (size_t)N, &paths->station));
    MORAY_TRY(paper_numbers(p, (size_t)(3 * N), &scratch));
    const double velocity[2] = {steady.v_x, steady.v_y}, course = atan2(velocity[1] - V[1], velocity[0] - V[0]);
    for (int k = 0; k < CHAIN_POINTS; k++)
        place(p, model, orbit, velocity, course, k, scratch, paths);
    for (int i = 0; i < N; i++) {
        double *along = paths->along + i * CHAIN_POINTS, *across = paths->across + i * CHAIN_POINTS;
        paths->station[i] = centre(along);
        centre(across);
        paths->along_amplitude[i] = paper_half_range(along, 1, CHAIN_POINTS);
        paths->across_amplitude[i] = paper_half_range(across, 1, CHAIN_POINTS);
    }
    return moray_ok();
}

static double mean(const double *values, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += values[i];
    return sum / n;
}

static double largest(const double *values, int n)
{
    double found = values[0];
    for (int i = 1; i < n; i++)
        found = fmax(found, values[i]);
    return found;
}

static moray_status show_displacement(paper *p, const link_paths paths[2])
{
    moray_table_row rows[2];
    for (int model = 0; model < 2; model++) {
        const double *across = paths[model].across_amplitude, *along = paths[model].along_amplitude;
        const int N = paths[model].N;
        rows[model] =
            (moray_table_row){.label = moray_model_name(model),
                              .value = {1000 * mean(across, N), 1000 * largest(across, N), 1000 * mean(along, N),
                                        1000 * largest(along, N), mean(across, N) / mean(along, N)}};
        moray_json_open(p->json, model == MORAY_CONTROL_ORIENTED ? "control" : "fp");
        moray_json_numbers(p->json, "normal_amplitude_m", across, N);
        moray_json_numbers(p->json, "tangential_amplitude_m", along, N);
        moray_json_close(p->json);
    }
    return paper_rows(p, "Property 4: amplitude of the links about the mean motion",
                      PAPER_HEADS("across, mean [mm]", "largest", "along, mean [mm]", "largest", "across : along"),
                      rows, 2);
}

static moray_status draw_amplitudes(paper *p, const link_paths paths[2], const double *number)
{
    const link_paths *fp = &paths[MORAY_FIRST_PRINCIPLES], *control = &paths[MORAY_CONTROL_ORIENTED];
    const moray_column columns[] = {{"link", NULL, number, 1},
                                    {"across, first-principles", "m", fp->across_amplitude, 1},
                                    {"along, first-principles", "m", fp->along_amplitude, 1},
                                    {"across, control-oriented", "m", control->across_amplitude, 1},
                                    {"along, control-oriented", "m", control->along_amplitude, 1}};
    return paper_draw(p, &(paper_graph){"amplitudes", "Property 4: amplitude of the links about the mean motion",
                                        "link", "amplitude [m]", columns, 5, fp->N, .style = MORAY_CURVE_MARKED});
}

// The paths of all links, each at its place on the body.
static moray_status draw_paths(paper *p, const link_paths paths[2])
{
    enum { ROW = CHAIN_POINTS + 1 }; // a path and a gap
    const int n = paths[0].N * ROW;
    moray_curve curves[2];
    double *at;
    MORAY_TRY(paper_numbers(p, (size_t)(4 * n), &at));
    for (int c = 0; c < 2; c++) {
        const int model = c == 0 ? MORAY_FIRST_PRINCIPLES : MORAY_CONTROL_ORIENTED;
        double *x = at + 2 * c * n, *y = x + n;
        for (int k = 0; k < n; k++) {
            const int i = k / ROW, sample = k % ROW;
            const bool gap = sample == CHAIN_POINTS;
            x[k] = gap ? NAN : paths[model].station[i] + paths[model].along[i * CHAIN_POINTS + sample];
            y[k] = gap ? NAN : paths[model].across[i * CHAIN_POINTS + sample];
        }
        curves[c] = (moray_curve){.label = moray_model_name(model), .x = x, .y = y, .n = n};
    }
    return paper_figure(p, &(moray_figure){.name = "paths",
                                           .title = "Property 4: paths of the links about the mean motion",
                                           .x_label = "along [m]",
                                           .y_label = "across [m]",
                                           .curves = curves,
                                           .n_curves = 2});
}

// ---- Work ----------------------------------------------------------------------------------------------------------

static void json_work(moray_json *json, const link_work *w)
{
    moray_json_object(json, "work",
                      MORAY_MEMBERS({"normal_J", w->work[NORMAL]}, {"tangential_J", w->work[TANGENTIAL]},
                                    {"torque_J", w->torque_work}, {"joints_J", w->joint_work},
                                    {"residual_J", w->residual}, {"normal_forward_force_N", w->force[NORMAL]},
                                    {"tangential_forward_force_N", w->force[TANGENTIAL]}));
}

static moray_status show_work(paper *p, const link_work *w)
{
    const double all = w->joint_work / 100;
    const moray_table_row rows[] = {
        {.label = "forces across the links",
         .value = {w->force[NORMAL], 1000 * w->work[NORMAL], w->work[NORMAL] / all}},
        {.label = "forces along the links",
         .value = {w->force[TANGENTIAL], 1000 * w->work[TANGENTIAL], w->work[TANGENTIAL] / all}},
        {.label = "torques (4)", .value = {NAN, 1000 * w->torque_work, w->torque_work / all}},
        {.label = "joints", .value = {NAN, 1000 * w->joint_work, 100}},
        {.label = "balance", .value = {NAN, 1000 * w->residual, w->residual / all}},
    };
    json_work(p->json, w);
    return paper_rows(p, "Property 2: means over a period, first-principles model",
                      PAPER_HEADS("forward force [N]", "work [mJ]", "of the joints' [%]"), rows,
                      sizeof rows / sizeof *rows);
}

static moray_status draw_work(paper *p, const link_work *w, const double *number)
{
    const moray_column columns[] = {{"link", NULL, number, 1},
                                    {"across the link", "J", w->of_link[NORMAL], 1},
                                    {"along the link", "J", w->of_link[TANGENTIAL], 1}};
    return paper_draw(p, &(paper_graph){"work", "Property 2: work of the fluid forces on each link over a period",
                                        "link", "work [J]", columns, 3, p->robot->links, .style = MORAY_CURVE_MARKED});
}

// ---- The study -----------------------------------------------------------------------------------------------------

moray_status paper_links(paper *p)
{
    const int N = p->robot->links;
    link_paths paths[2];
    link_work w;
    chain c;
    double *number;
    MORAY_TRY(paper_numbers(p, (size_t)N, &number));
    for (int i = 0; i < N; i++)
        number[i] = i + 1;
    for (int model = 0; model < 2; model++)
        MORAY_TRY(link_paths_of(p, (moray_model)model, &paths[model]));
    MORAY_TRY(show_displacement(p, paths));
    MORAY_TRY(draw_amplitudes(p, paths, number));
    MORAY_TRY(draw_paths(p, paths));
    MORAY_TRY(chain_swim(p, p->rig.current, &p->gait[MORAY_FIRST_PRINCIPLES], &c));
    MORAY_TRY(link_work_of(p, &c, &w));
    MORAY_TRY(show_work(p, &w));
    MORAY_TRY(draw_work(p, &w, number));
    return paper_say(p,
                     "Property 2: the forces across the links push forward with %.3g N in the mean, those along them "
                     "with %.3g N; the former take %.1f %% of the joints' work.",
                     w.force[NORMAL], w.force[TANGENTIAL], -100 * w.work[NORMAL] / w.joint_work);
}
