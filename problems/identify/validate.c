// SPDX-License-Identifier: MIT
//
// A held-out log: where it starts from its first quarter, by the identified robot; the rest as predicted.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "identify.h"

static const double first_part = 0.25;

// A log that measures nothing after a time: the joints stay.
static moray_status cut_copy(const moray_swim_log *log, double until, moray_swim_log *cut, double **room)
{
    const size_t n = (size_t)log->n, width = n * (size_t)log->joints;
    *cut = *log;
    if (!(*room = malloc((3 * n + width) * sizeof **room)))
        return moray_error(MORAY_MEMORY, "no memory for a log of %d rows", log->n);
    double *const to[] = {*room, *room + n, *room + 2 * n, *room + 3 * n};
    const double *from[] = {log->p_x, log->p_y, log->heading, log->u};
    double **field[] = {&cut->p_x, &cut->p_y, &cut->heading, &cut->u};
    for (int c = 0; c < 4; c++) {
        const size_t per_row = c < 3 ? 1 : (size_t)log->joints;
        if (!from[c])
            continue;
        for (size_t k = 0; k < n * per_row; k++)
            to[c][k] = log->t[k / per_row] > until ? NAN : from[c][k];
        *field[c] = to[c];
    }
    return moray_ok();
}

static void add_up(const moray_identify_fit *fit, double until, held_out *found)
{
    double sum[MORAY_CHANNELS] = {0};
    int n[MORAY_CHANNELS] = {0};
    for (int k = 0; k < fit->n; k++) {
        const moray_residual_point *p = &fit->point[k];
        const moray_channel_kind kind = fit->channel[p->channel].kind;
        if (p->t <= until)
            continue;
        sum[kind] += pow(remainder(p->observed - p->predicted, kind == MORAY_CHANNEL_HEADING ? 2 * M_PI : 1e9), 2);
        n[kind]++;
        found->sigma[kind] = p->sigma;
    }
    for (int kind = 0; kind < MORAY_CHANNELS; kind++)
        found->rms[kind] = n[kind] ? sqrt(sum[kind] / n[kind]) : NAN;
}

// From the first and the last positions of the rest; means of some, against noise.
static void speeds(const moray_identify_fit *fit, double until, held_out *found)
{
    double at[2][2][2] = {{{0}}}, time[2] = {0}; // [measured, predicted][begin, end][x, y]
    int from[2] = {-1, -1}, to[2] = {-1, -1};
    for (int k = 0; k < fit->n; k++) {
        const moray_channel_kind kind = fit->channel[fit->point[k].channel].kind;
        if (kind > MORAY_CHANNEL_Y || fit->point[k].t <= until)
            continue;
        from[kind] = from[kind] < 0 ? k : from[kind];
        to[kind] = k;
    }
    found->measured = found->predicted = NAN;
    if (from[0] < 0 || from[1] < 0)
        return;
    const int some = (int)fmin(to[0] - from[0], to[1] - from[1]) / 5;
    if (some < 1)
        return;
    for (int axis = 0; axis < 2; axis++)
        for (int k = 0; k < some; k++)
            for (int end = 0; end < 2; end++) {
                const moray_residual_point *p = &fit->point[end ? to[axis] - k : from[axis] + k];
                at[0][end][axis] += p->observed / some;
                at[1][end][axis] += p->predicted / some;
                time[end] += p->t / some / 2;
            }
    found->measured = hypot(at[0][1][0] - at[0][0][0], at[0][1][1] - at[0][0][1]) / (time[1] - time[0]);
    found->predicted = hypot(at[1][1][0] - at[1][0][0], at[1][1][1] - at[1][0][1]) / (time[1] - time[0]);
}

// The whole log against the robot from the first state found.
static moray_status compare(const moray_swim_log *log, const moray_identify_spec *spec, moray_estimate *at,
                            double until, held_out *found)
{
    moray_identify *whole;
    moray_identify_fit fit = {0};
    MORAY_TRY(moray_identify_new(&whole, spec, log, 1));
    const moray_status status = moray_identify_residuals(whole, at, &fit);
    if (!moray_failed(status)) {
        add_up(&fit, until, found);
        speeds(&fit, until, found);
    }
    moray_identify_fit_free(&fit);
    moray_identify_free(whole);
    return status;
}

moray_status identify_validate(const identify *run, int k, held_out *found)
{
    const moray_swim_log *log = &run->held[k];
    const double until = log->t[0] + first_part * (log->t[log->n - 1] - log->t[0]);
    moray_identify_spec spec = identify_spec(run);
    const double value = run->at[0].value[0], lower = value - 1e-9 * (1 + fabs(value)),
                 upper = value + 1e-9 * (1 + fabs(value));
    moray_identify *first = NULL;
    moray_estimate at;
    moray_swim_log cut;
    double *room = NULL;
    *found = (held_out){.seconds = until - log->t[0]};
    spec.start = run->world;
    spec.n = 1; // one unknown that cannot move: only the first state does
    spec.lower = &lower;
    spec.upper = &upper;
    moray_status status = cut_copy(log, until, &cut, &room);
    if (!moray_failed(status))
        status = moray_identify_new(&first, &spec, &cut, 1);
    if (!moray_failed(status)) {
        moray_identify_start(first, 0, &at);
        status = moray_identify_solve(first, &at);
    }
    if (!moray_failed(status))
        status = compare(log, &spec, &at, until, found);
    moray_identify_free(first);
    free(room);
    return status;
}
