// SPDX-License-Identifier: MIT
//
// Whether what is left is noise: its sum of squares, and its correlation in time.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/results.h"
#include "snake/identify/identify.h"

enum { LAGS = 10 };
static const double small = 0.5;                       // of the noise: what is less is correlated as it likes
static const double far_out = 5, one_in_1000 = 3.0902; // of the normal distribution

// What a sum of squares of so many degrees of freedom exceeds by chance in one of 1000 (Wilson & Hilferty 1931).
static double chi_square_limit(int freedom)
{
    const double k = freedom, root = 1 - 2 / (9 * k) + one_in_1000 * sqrt(2 / (9 * k));
    return k * root * root * root;
}

// The same where the standard deviations were taken from the log: their own uncertainty counts too.
static double limit_of(const moray_identify *v, int freedom)
{
    double known = 0;
    for (int r = 0; r < v->runs; r++)
        for (int kind = 0; kind < MORAY_CHANNELS; kind++)
            known += v->run[r].freedom[kind];
    if (known == 0)
        return chi_square_limit(freedom);
    return freedom * (1 + one_in_1000 * sqrt(2.0 / freedom + 2 / known));
}

// ---- Channels ------------------------------------------------------------------------------------------------------

// Neighbours that are both no outliers are correlated; r[n] in time.
static void correlate(const double *r, int n, moray_channel_fit *c)
{
    double square = 0, mean = 0;
    c->portmanteau = 0;
    c->limit = chi_square_limit(LAGS);
    for (int k = 0; k < n; k++)
        mean += fmax(-far_out, fmin(far_out, r[k])) / n;
    for (int k = 0; k < n; k++)
        square += pow(fmax(-far_out, fmin(far_out, r[k])) - mean, 2);
    for (int lag = 1; lag <= LAGS && lag < n && square > 0; lag++) {
        double sum = 0;
        for (int k = lag; k < n; k++)
            sum += (fmax(-far_out, fmin(far_out, r[k])) - mean) * (fmax(-far_out, fmin(far_out, r[k - lag])) - mean);
        const double rho = sum / square;
        c->lag = lag == 1 ? rho : c->lag;
        c->portmanteau += (double)n * (n + 2) * rho * rho / (n - lag);
    }
}

static void describe(moray_channel_fit *c, const double *r, const int *row)
{
    double square = 0, most = -1;
    for (int k = 0; k < c->n; k++) {
        square += r[k] * r[k];
        c->outliers += fabs(r[k]) > far_out;
        if (fabs(r[k]) > most)
            most = fabs(r[k]), c->worst = row[k];
    }
    c->rms = sqrt(square / c->n);
    correlate(r, c->n, c);
}

// One channel of a run: its points go behind those of the channels before.
static void add_channel(const moray_identify *v, int r, moray_channel_kind kind, int joint, const double *residual,
                        moray_identify_fit *fit, double *own, int *row)
{
    const struct run *run = &v->run[r];
    moray_channel_fit *c = &fit->channel[fit->channels];
    *c = (moray_channel_fit){.run = r, .kind = kind, .joint = joint, .sigma = run->sigma[kind]};
    for (int k = 0; k < run->items; k++) {
        const struct item *item = &run->item[k];
        if (item->kind != kind || item->joint != joint)
            continue;
        own[c->n] = -residual[k];
        row[c->n++] = item->row;
        fit->point[fit->n++] = (moray_residual_point){.t = run->log->t[item->row],
                                                      .observed = item->observed,
                                                      .predicted = item->observed + residual[k] * item->sigma,
                                                      .sigma = item->sigma,
                                                      .run = r,
                                                      .row = item->row,
                                                      .channel = fit->channels};
    }
    if (c->n == 0)
        return;
    describe(c, own, row);
    fit->channels++;
}

// ---- The verdict ---------------------------------------------------------------------------------------------------

static void judge(const moray_identify *v, moray_identify_fit *fit)
{
    double sum = 0;
    int outliers = 0, worst = -1, counted = 0;
    for (int k = 0; k < fit->channels; k++) {
        outliers += fit->channel[k].outliers;
        if (fit->channel[k].rms < small)
            continue;
        sum += fit->channel[k].portmanteau;
        counted++;
        if (worst < 0 || fit->channel[k].portmanteau > fit->channel[worst].portmanteau)
            worst = k;
    }
    const double limit = chi_square_limit(LAGS * (counted > 0 ? counted : 1));
    const bool large = fit->chi2 > fit->limit, coloured = worst >= 0 && sum > limit;
    const moray_channel_fit *at = coloured ? &fit->channel[worst] : NULL;
    fit->simple = coloured || (large && outliers == 0);
    fit->verdict[0] = 0;
    moray_text_add(fit->verdict, sizeof fit->verdict, "chi^2 %.4g of %d degrees of freedom (by chance at most %.4g); ",
                   fit->chi2, fit->freedom, fit->limit);
    if (coloured)
        moray_text_add(
            fit->verdict, sizeof fit->verdict,
            "residuals are no noise: neighbours in %s of %.40s are correlated by %.2f. The model is too simple, "
            "or a sensor is not as told.",
            moray_channel_name(at->kind), v->run[at->run].log->name, at->lag);
    else
        moray_text_add(fit->verdict, sizeof fit->verdict, "residuals are white%s.",
                       !large     ? ""
                       : outliers ? ", but some are far out: outliers (--loss huber)"
                                  : ", but larger than told");
}

moray_status moray_identify_residuals(const moray_identify *v, const moray_estimate *at, moray_identify_fit *fit)
{
    const int joints = v->spec.start.robot.links - 1;
    *fit = (moray_identify_fit){0};
    fit->channel = calloc((size_t)v->runs * (3 + (size_t)joints), sizeof *fit->channel);
    fit->point = calloc((size_t)v->items, sizeof *fit->point);
    double *own = calloc(2 * (size_t)v->items, sizeof *own);
    int *row = calloc((size_t)v->items, sizeof *row), varied = 0;
    bool good = fit->channel && fit->point && own && row;
    moray_status status = good ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d residuals", v->items);
    for (int r = 0; r < v->runs && good; r++) {
        double *residual = own + v->items;
        if (!(good = moray_identify_residual(v, r, at, residual, NULL)))
            status = moray_error(MORAY_NUMERIC, "log %s cannot be swum", v->run[r].log->name);
        for (int k = 0; k < v->run[r].items && good; k++)
            fit->chi2 += residual[k] * residual[k];
        for (int kind = 0; kind < MORAY_CHANNELS && good; kind++)
            for (int i = 0; i < (kind == MORAY_CHANNEL_TORQUE ? joints : 1); i++)
                add_channel(v, r, kind, i, residual, fit, own, row);
    }
    free(own);
    free(row);
    for (int i = 0; i < FIRST; i++)
        varied += moray_identify_first_varies(v, i);
    fit->freedom = fit->n - v->spec.n - varied * v->runs;
    if (!good)
        return status;
    if (fit->freedom < 1)
        return moray_error(MORAY_INPUT,
                           "%d measurements are no more than the %d unknowns and the %d first states of the logs",
                           fit->n, v->spec.n, varied * v->runs);
    fit->limit = limit_of(v, fit->freedom);
    judge(v, fit);
    return status;
}

void moray_identify_fit_free(moray_identify_fit *fit)
{
    free(fit->channel);
    free(fit->point);
    *fit = (moray_identify_fit){0};
}
