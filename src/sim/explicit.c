// SPDX-License-Identifier: MIT
//
// RK8(7)13M without a library around it: simulations are the larger part of what the programs do, and on two dozen
// states ARKODE's vector operations and step control cost as much as the right-hand side. ARKODE with the same tableau
// is the check (MORAY_SIM_ARKODE).
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/prince_dormand.h"
#include "sim/sim.h"

static const double safety = 0.9, most_growth = 6, least_growth = 0.2, past = 0.04; // past: weight of the last error
static const double exponent = 1.0 / (PD_EMBEDDED_ORDER + 1);
enum { most_rejections = 60 };

struct explicit_method {
    double step;         // to be tried next; 0: to be chosen
    double error_before; // of the last accepted step, relative to the tolerance
    double *x, *slope;   // trial state [n]; slopes of the stages, [PD_STAGES][n]
};

static bool build(moray_sim *sim)
{
    struct explicit_method *m = calloc(1, sizeof *m);
    sim->method_self = m;
    if (m)
        m->x = calloc((size_t)(PD_STAGES + 1) * sim->ode.n, sizeof *m->x);
    if (!m || !m->x)
        return false;
    m->slope = m->x + sim->ode.n;
    return true;
}

static void release(moray_sim *sim)
{
    struct explicit_method *m = sim->method_self;
    if (m)
        free(m->x);
    free(m);
}

static moray_status restart(moray_sim *sim)
{
    struct explicit_method *m = sim->method_self;
    m->step = 0;
    m->error_before = 1;
    return moray_ok();
}

static double tolerance(const moray_sim *sim, int i)
{
    return sim->settings.rtol * fabs(sim->x[i]) + sim->settings.atol;
}

// Largest of v[n] relative to the tolerances: a mean would let one state of many be worse than asked for.
static double norm_of(const moray_sim *sim, const double *v)
{
    double largest = 0;
    for (int i = 0; i < sim->ode.n; i++)
        largest = fmax(largest, fabs(v[i]) / tolerance(sim, i));
    return largest;
}

static void add(int n, double factor, const double *v, double *to)
{
    for (int i = 0; i < n; i++)
        to[i] += factor * v[i];
}

// The first step from how fast state and slope change (Hairer, Norsett and Wanner, II.4): an Euler step tells the
// latter.
static double first_step(moray_sim *sim, struct explicit_method *m, double longest)
{
    const int n = sim->ode.n;
    double *slope = m->slope + n;
    const double size = norm_of(sim, sim->x), rate = norm_of(sim, m->slope);
    const double euler = fmin(size > 1e-5 && rate > 1e-5 ? 0.01 * size / rate : 1e-6, longest);
    memcpy(m->x, sim->x, (size_t)n * sizeof *m->x);
    add(n, euler, m->slope, m->x);
    if (!moray_sim_rhs(sim, sim->t + euler, m->x, slope))
        return euler;
    add(n, -1, m->slope, slope);
    const double curvature = fmax(norm_of(sim, slope) / euler, rate);
    const double step = curvature > 1e-15 ? pow(0.01 / curvature, exponent) : 1e-6;
    return fmin(fmin(100 * euler, step), longest);
}

// The trial state a step ahead, in m->x, and its error relative to the tolerance; infinite where a stage is outside the
// domain.
static double try_step(moray_sim *sim, struct explicit_method *m, double h)
{
    const int n = sim->ode.n;
    for (int s = 1; s < PD_STAGES; s++) {
        memcpy(m->x, sim->x, (size_t)n * sizeof *m->x);
        for (int j = 0; j < s; j++)
            if (pd_a[s][j] != 0)
                add(n, h * pd_a[s][j], m->slope + j * n, m->x);
        if (!moray_sim_rhs(sim, sim->t + pd_c[s] * h, m->x, m->slope + s * n))
            return INFINITY;
    }
    double *error = m->slope + n; // pd_b and pd_embedded do not use stages 2 to 5
    memcpy(m->x, sim->x, (size_t)n * sizeof *m->x);
    memset(error, 0, (size_t)n * sizeof *error);
    for (int s = 0; s < PD_STAGES; s++) {
        if (pd_b[s] != 0)
            add(n, h * pd_b[s], m->slope + s * n, m->x);
        if (pd_b[s] != pd_embedded[s])
            add(n, h * (pd_b[s] - pd_embedded[s]), m->slope + s * n, error);
    }
    const double size = norm_of(sim, error);
    return isfinite(size) ? size : INFINITY;
}

// A step that ends at the stop, or leaves a way that is worth a step of its own.
static double fit(const moray_sim *sim, double step, double longest)
{
    if (sim->settings.max_step > 0)
        step = fmin(step, sim->settings.max_step);
    return step >= longest ? longest : 2 * step > longest ? longest / 2 : step;
}

static void keep(moray_sim *sim, struct explicit_method *m, double h, double stop, double error, bool rejected)
{
    const double growth = safety * pow(fmax(error, 1e-10), past * 0.75 - exponent) * pow(m->error_before, past);
    const double next = h * fmax(least_growth, fmin(growth, rejected ? 1 : most_growth));
    const bool arrived = h >= stop - sim->t;
    moray_sim_accept(sim, arrived ? stop : sim->t + h, m->x);
    m->step = arrived ? fmax(next, m->step) : next; // a step cut short by a stop says little of the next
    m->error_before = fmax(error, 1e-4);
}

static moray_status step(moray_sim *sim, double stop)
{
    struct explicit_method *m = sim->method_self;
    const double longest = stop - sim->t, least = 1e3 * DBL_EPSILON * fmax(fabs(sim->t), longest);
    if (!moray_sim_rhs(sim, sim->t, sim->x, m->slope))
        return moray_sim_stuck(sim, stop, SIM_ERROR_TEST);
    if (m->step == 0)
        m->step = first_step(sim, m, longest);
    double h = fit(sim, m->step, longest);
    for (int rejections = 0; rejections < most_rejections && (h > least || h == longest); rejections++) {
        const double error = try_step(sim, m, h);
        if (error <= 1) {
            keep(sim, m, h, stop, error, rejections > 0);
            return moray_ok();
        }
        if (isfinite(error))
            sim->outside = false;
        m->step = h *= isfinite(error) ? fmax(least_growth, safety * pow(error, -exponent)) : 0.25;
    }
    return moray_sim_stuck(sim, stop, SIM_ERROR_TEST);
}

const sim_method moray_sim_explicit = {build, release, restart, step};
