// SPDX-License-Identifier: MIT
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/csv.h"
#include "base/number.h"
#include "moray/angle.h"
#include "moray/snake/heading.h"

void moray_reference_free(moray_reference *reference)
{
    free(reference->time);
    *reference = (moray_reference){0};
}

// Adds a point; time and heading are one block, heading behind the room for times.
static moray_status add(moray_reference *reference, int *room, double t, double heading)
{
    if (!isfinite(t) || !isfinite(heading))
        return moray_error(MORAY_INPUT, "reference: t = %g s, heading = %g deg: must be finite", t, heading);
    if (reference->n > 0 && t < reference->time[reference->n - 1])
        return moray_error(MORAY_INPUT, "reference: t = %g s comes after %g s: times must ascend", t,
                           reference->time[reference->n - 1]);
    if (reference->n == *room) {
        const int larger = 2 * *room + 16;
        double *block = malloc(2 * (size_t)larger * sizeof *block);
        if (!block)
            return moray_error(MORAY_MEMORY, "no memory for a reference of %d points", larger);
        for (int k = 0; k < reference->n; k++) {
            block[k] = reference->time[k];
            block[larger + k] = reference->heading[k];
        }
        free(reference->time);
        reference->time = block;
        reference->heading = block + larger;
        *room = larger;
    }
    reference->time[reference->n] = t;
    reference->heading[reference->n++] = heading * MORAY_DEGREE;
    return moray_ok();
}

// "T=H,T=H,...": points, or steps between them.
static moray_status read_points(moray_reference *reference, const char *text, bool steps)
{
    int room = 0;
    double before = 0;
    for (const char *at = text; *at;) {
        double t, heading;
        int used = 0;
        if (sscanf(at, " %lf = %lf %n", &t, &heading, &used) != 2 || used == 0 || (at[used] && at[used] != ','))
            return moray_error(MORAY_INPUT, "reference: '%.60s': must be T=H,T=H,... with times in s, headings in deg",
                               at);
        if (steps)
            MORAY_TRY(add(reference, &room, t, before));
        MORAY_TRY(add(reference, &room, t, heading));
        before = heading;
        at += used + (at[used] == ',');
    }
    if (reference->n == 0)
        return moray_error(MORAY_INPUT, "reference: no points: must be T=H,T=H,...");
    return moray_ok();
}

static moray_status read_sine(moray_reference *reference, const char *text)
{
    int used = 0;
    if (sscanf(text, " %lf , %lf %n", &reference->amplitude, &reference->period, &used) != 2 || text[used] ||
        !isfinite(reference->amplitude) || !isfinite(reference->period) || reference->period <= 0)
        return moray_error(MORAY_INPUT, "reference: sine:%.60s: must be AMPLITUDE,PERIOD in deg and s, PERIOD above 0",
                           text);
    reference->amplitude *= MORAY_DEGREE;
    return moray_ok();
}

static moray_status read_rows(moray_reference *reference, const moray_csv *csv)
{
    static const char *const names[] = {"t_s", "heading_deg"};
    int column[2], room = 0;
    MORAY_TRY(moray_csv_match(csv, names, 2, column));
    for (int row = 0; row < csv->rows; row++) {
        double t, heading;
        MORAY_TRY(moray_csv_number(csv, row, column[0], &t));
        MORAY_TRY(moray_csv_number(csv, row, column[1], &heading));
        const moray_status status = add(reference, &room, t, heading);
        if (moray_failed(status))
            return moray_csv_error(csv, row, status);
    }
    return moray_ok();
}

static moray_status read_file(moray_reference *reference, const char *path)
{
    moray_csv csv;
    if (access(path, R_OK) != 0)
        return moray_error(MORAY_IO,
                           "reference %.120s: neither steps:, ramps:, sine: nor a file that can be opened: %s", path,
                           strerror(errno));
    moray_status status = moray_csv_read(&csv, path, "reference");
    if (!moray_failed(status))
        status = read_rows(reference, &csv);
    moray_csv_free(&csv);
    return status;
}

moray_status moray_reference_read(moray_reference *reference, const char *text)
{
    *reference = (moray_reference){0};
    const locale_t before = moray_c_locale_begin();
    moray_status status = strncmp(text, "steps:", 6) == 0   ? read_points(reference, text + 6, true)
                          : strncmp(text, "ramps:", 6) == 0 ? read_points(reference, text + 6, false)
                          : strncmp(text, "sine:", 5) == 0  ? read_sine(reference, text + 5)
                                                            : read_file(reference, text);
    moray_c_locale_end(before);
    if (moray_failed(status))
        moray_reference_free(reference);
    return status;
}

double moray_reference_at(const moray_reference *reference, double t, double *rate)
{
    const double *time = reference->time, *heading = reference->heading;
    const int n = reference->n;
    *rate = 0;
    if (n == 0) {
        const double omega = 2 * M_PI / reference->period;
        *rate = reference->amplitude * omega * cos(omega * t);
        return reference->amplitude * sin(omega * t);
    }
    int low = 0, high = n; // the points before t are 0..low-1
    while (low < high) {
        const int middle = (low + high) / 2;
        if (time[middle] < t)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == 0 || low == n)
        return heading[low == 0 ? 0 : n - 1];
    *rate = (heading[low] - heading[low - 1]) / (time[low] - time[low - 1]);
    return heading[low - 1] + *rate * (t - time[low - 1]);
}

double moray_reference_fastest(const moray_reference *reference, double t0, double t1)
{
    if (reference->n == 0)
        return fabs(reference->amplitude) * 2 * M_PI / reference->period;
    double fastest = 0, rate;
    for (int k = 1; k < reference->n; k++) {
        const double from = fmax(reference->time[k - 1], t0), to = fmin(reference->time[k], t1);
        if (to > from) {
            moray_reference_at(reference, to, &rate);
            fastest = fmax(fastest, fabs(rate));
        }
    }
    return fastest;
}

// Sum over the jumps within (t0, t1), and the corners where they are few, of their distance to the nearest of k equal
// intervals' ends, per interval.
static double misfit(const moray_reference *reference, double t0, double t1, int k)
{
    const int few = 50;
    double sum = 0;
    for (int i = 0; i < reference->n; i++) {
        const double t = reference->time[i], at = (t - t0) / (t1 - t0) * k;
        const bool jumps = i > 0 && t == reference->time[i - 1];
        if ((jumps || reference->n <= few) && t > t0 && t < t1)
            sum += fabs(at - round(at));
    }
    return sum;
}

int moray_reference_intervals(const moray_reference *reference, double t0, double t1, int least)
{
    int best = least;
    for (int k = least + 1; k <= (int)(1.3 * least); k++)
        if (misfit(reference, t0, t1, k) < misfit(reference, t0, t1, best) - 1e-9)
            best = k;
    return best;
}
