// SPDX-License-Identifier: MIT
#include "ocp/refinement/second_start.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double off_centre = 0.1; // of a control's size
enum { steps = 10 };                  // of the integration, between two of its samples
enum { stages = 4 };                  // of the classical method of Runge and Kutta

// Fixed steps suffice: what comes of them is a guess.
static moray_status run_steps(const moray_integrator *self, const moray_ode *ode, double t0, double t1, double *x,
                              const double *times, int n_times, moray_ode_observer *observe, void *observer)
{
    static const double reach[stages] = {0, 0.5, 0.5, 1}, weight[stages] = {1, 2, 2, 1};
    const int n = ode->n;
    const double h = (t1 - t0) / steps;
    double *y = calloc(3 * (size_t)n, sizeof *y);
    (void)self, (void)times, (void)n_times, (void)observe, (void)observer;
    if (!y)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %d states", n);
    double *sum = y + n, *slope = sum + n;
    bool ok = true;
    for (int k = 0; k < steps && ok; k++) {
        memset(sum, 0, 2 * (size_t)n * sizeof *sum); // and slopes
        for (int s = 0; s < stages && ok; s++) {
            for (int r = 0; r < n; r++)
                y[r] = x[r] + h * reach[s] * slope[r];
            ok = ode->rhs(t0 + (k + reach[s]) * h, y, slope, ode->self);
            for (int r = 0; r < n; r++)
                sum[r] += weight[s] * slope[r] / 6;
        }
        for (int r = 0; r < n; r++)
            x[r] += h * sum[r];
    }
    free(y);
    return ok ? moray_ok() : moray_error(MORAY_NUMERIC, "not finite near t = %g", t0);
}

struct driver {
    const moray_solution *failed;
};

// One side for a control, the other for the next.
static void drive_off_centre(int p, double t, const double *x, double *u, void *self)
{
    const moray_solution *failed = ((const struct driver *)self)->failed;
    const struct transcription *transcription = failed->transcription;
    const struct phase *phase = &transcription->ocp->phase[p];
    const int first = transcription->layout.phase[p].node[1].x + phase->nx; // which every scheme collocates
    (void)t, (void)x;
    for (int r = 0; r < phase->nu; r++) {
        const double size = 1 / transcription->nlp.x_scale[first + r];
        const double beside = failed->guess[first + r] + (r % 2 ? -1 : 1) * off_centre * size;
        u[r] = fmin(fmax(beside, phase->u[r].lower), phase->u[r].upper);
    }
}

moray_status moray_second_start(const moray_solution *failed, moray_guess *guess)
{
    static const moray_integrator integrator = {run_steps, NULL};
    const struct transcription *t = failed->transcription;
    struct driver driver = {failed};
    moray_drive *drive = calloc((size_t)t->ocp->phases, sizeof *drive);
    *guess = (moray_guess){0};
    if (!drive)
        return moray_error(MORAY_MEMORY, "no memory for %d phases", t->ocp->phases);
    for (int p = 0; p < t->ocp->phases; p++) {
        moray_layout_span(&t->layout, t->ocp, failed->guess, p, &drive[p].t0, &drive[p].tf);
        drive[p].x0 = failed->guess + t->layout.phase[p].node[0].x;
    }
    const moray_status status =
        moray_guess_simulate(guess, t->ocp, drive, failed->guess + t->layout.s, drive_off_centre, &driver, &integrator);
    free(drive);
    return status.code == MORAY_MEMORY ? status : moray_ok();
}
