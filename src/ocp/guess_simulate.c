// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/samples.h"

enum { usual_samples = 100 };

struct simulation {
    const moray_ocp *ocp;
    int p;
    moray_control_fn *control;
    void *self;
    const moray_integrator *integrator;
    double *in, *out; // of the phase's map
};

static void control_at(const struct simulation *s, double t, const double *x, double *u)
{
    const struct phase *phase = &s->ocp->phase[s->p];
    if (s->control && phase->nu > 0)
        s->control(s->p, t, x, u, s->self);
    for (int i = 0; i < phase->nu && !s->control; i++)
        u[i] = moray_bounds_middle(phase->u[i]);
}

static bool rates(double t, const double *x, double *dx, void *self)
{
    struct simulation *s = self;
    const struct phase *phase = &s->ocp->phase[s->p];
    memcpy(s->in, x, (size_t)phase->nx * sizeof *x);
    control_at(s, t, x, s->in + phase->nx);
    s->in[phase->map->n_in - 1] = t;
    phase->map->value(phase->map->self, s->in, s->out);
    memcpy(dx, s->out, (size_t)phase->nx * sizeof *dx);
    for (int r = 0; r < phase->nx; r++)
        if (!isfinite(dx[r]))
            return false;
    return true;
}

// The samples' times are set; x starts in the first row.
static moray_status run_phase(struct simulation *s, int rows, const struct samples *samples)
{
    const struct phase *phase = &s->ocp->phase[s->p];
    const moray_ode ode = {phase->nx, rates, s};
    for (int k = 0; k < rows; k++) {
        double *x = samples->x + k * phase->nx;
        if (k > 0) {
            memcpy(x, x - phase->nx, (size_t)phase->nx * sizeof *x);
            const moray_status status =
                s->integrator->run(s->integrator, &ode, samples->time[k - 1], samples->time[k], x, NULL, 0, NULL, NULL);
            if (moray_failed(status))
                return moray_error(status.code, "guess of phase %s: %s", phase->name, status.text);
        }
        control_at(s, samples->time[k], x, samples->u + k * phase->nu);
    }
    return moray_ok();
}

static moray_status check_drive(const moray_ocp *ocp, int p, const moray_drive *drive)
{
    const struct phase *phase = &ocp->phase[p];
    if (!isfinite(drive->t0) || !isfinite(drive->tf) || drive->tf < drive->t0)
        return moray_error(MORAY_INPUT, "guess of phase %s: from t = %g to %g", phase->name, drive->t0, drive->tf);
    if (drive->samples < 0 || drive->samples == 1)
        return moray_error(MORAY_INPUT, "guess of phase %s: samples = %d: must be 0 or at least 2", phase->name,
                           drive->samples);
    if (!drive->x0 && (p == 0 || ocp->phase[p - 1].nx != phase->nx))
        return moray_error(MORAY_INPUT, "guess of phase %s: needs x0, for %s", phase->name,
                           p == 0 ? "it is the first" : "the phase before has other states");
    return moray_ok();
}

static moray_status simulate_phases(const moray_ocp *ocp, const moray_drive *drive, const int *rows,
                                    const struct samples *phase, const double *parameters, struct simulation s)
{
    for (s.p = 0; s.p < ocp->phases; s.p++) {
        const struct phase *here = &ocp->phase[s.p];
        const int nx = here->nx, last = rows[s.p] - 1;
        const double *x0 = drive[s.p].x0 ? drive[s.p].x0 : phase[s.p - 1].x + (rows[s.p - 1] - 1) * nx;
        memcpy(phase[s.p].x, x0, (size_t)nx * sizeof *x0);
        for (int k = 0; k <= last; k++)
            phase[s.p].time[k] = drive[s.p].t0 + (drive[s.p].tf - drive[s.p].t0) * k / last;
        s.in = calloc((size_t)(here->map->n_in + here->map->n_out), sizeof *s.in);
        if (!s.in)
            return moray_error(MORAY_MEMORY, "no memory to simulate phase %s", here->name);
        s.out = s.in + here->map->n_in;
        memcpy(s.in + nx + here->nu, parameters, (size_t)ocp->ns * sizeof *s.in);
        const moray_status status = run_phase(&s, rows[s.p], &phase[s.p]);
        free(s.in);
        MORAY_TRY(status);
    }
    return moray_ok();
}

moray_status moray_guess_simulate(moray_guess *guess, const moray_ocp *ocp, const moray_drive *drive, const double *s,
                                  moray_control_fn *control, void *self, const moray_integrator *integrator)
{
    *guess = (moray_guess){0};
    for (int p = 0; p < ocp->phases; p++)
        MORAY_TRY(check_drive(ocp, p, &drive[p]));
    int *rows = calloc((size_t)ocp->phases, sizeof *rows);
    struct samples *phase = calloc((size_t)ocp->phases, sizeof *phase);
    double *parameters;
    moray_status status = moray_error(MORAY_MEMORY, "no memory for a guess");
    for (int p = 0; rows && p < ocp->phases; p++)
        rows[p] = drive[p].samples ? drive[p].samples : usual_samples;
    if (rows && phase)
        status = moray_guess_allocate(guess, ocp, rows, true, phase, &parameters);
    if (!moray_failed(status)) {
        memcpy(parameters, s, (size_t)ocp->ns * sizeof *s);
        const struct simulation simulation = {ocp, 0, control, self, integrator, NULL, NULL};
        status = simulate_phases(ocp, drive, rows, phase, parameters, simulation);
    }
    free(rows);
    free(phase);
    if (moray_failed(status))
        moray_guess_free(guess);
    return status;
}
