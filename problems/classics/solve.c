// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "classics.h"
#include "moray/clock.h"

enum { samples = CLASSIC_PARTS + 1, max_phases = 5, max_states = 8, max_controls = 4 };

// ---- Problems of one phase -----------------------------------------------------------------------------------------

moray_status classic_new(moray_ocp **ocp, const char *name, const moray_phase_spec *phase, moray_endpoint_fn *endpoint,
                         const void *data)
{
    const moray_ocp_spec spec = {.name = name, .phases = 1, .phase = phase, .endpoint = endpoint, .data = data};
    return moray_ocp_new(ocp, &spec);
}

void classic_final_time(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

void classic_first_integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

void classic_first_state(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = -at->phase[0].xf[0];
}

void classic_no_objective(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)at, (void)data;
    out->objective = 0;
}

double classic_start_on_data(const moray_observations *data, double tf, double tau, double *x)
{
    const double t = tau * tf;
    int k = 0;
    while (k + 2 < data->n && t >= data->time[k + 1])
        k++;
    const double part = fmax((t - data->time[k]) / (data->time[k + 1] - data->time[k]), 0);
    for (int i = 0; i < data->ny; i++) {
        const double left = data->value[k * data->ny + i], right = data->value[(k + 1) * data->ny + i];
        x[i] = left + part * (right - left);
    }
    return t;
}

// ---- Solving -------------------------------------------------------------------------------------------------------

struct start {
    moray_samples phase[max_phases];
    double time[max_phases][samples];
    double x[max_phases][samples * max_states], u[max_phases][samples * max_controls];
};

static double straight_start(const moray_samples *between, int nx, int nu, double tau, double *x, double *u)
{
    for (int i = 0; i < nx; i++)
        x[i] = between->x[i] + tau * (between->x[nx + i] - between->x[i]);
    for (int i = 0; i < nu; i++)
        u[i] = between->u[i] + tau * (between->u[nu + i] - between->u[i]);
    return between->time[1] * tau;
}

static void sample_start(const struct classic *classic, const moray_ocp *ocp, struct start *start)
{
    double x[max_states] = {0};
    for (int p = 0; p < moray_ocp_phases(ocp); p++) {
        int nx, nu;
        moray_ocp_widths(ocp, p, &nx, &nu);
        for (int k = 0; k < samples; k++) {
            const double tau = (double)k / CLASSIC_PARTS;
            double *u = start->u[p] + k * nu;
            start->time[p][k] = classic->start ? classic->start(p, tau, x, u, classic->data)
                                               : straight_start(classic->straight, nx, nu, tau, x, u);
            memcpy(start->x[p] + k * nx, x, (size_t)nx * sizeof *x);
        }
        start->phase[p] = (moray_samples){samples, start->time[p], start->x[p], start->u[p]};
    }
}

const char *classic_agreement(const struct classic *classic, const struct classic_result *result)
{
    if (result->outcome != MORAY_NLP_SOLVED)
        return "NOT SOLVED";
    if (!classic->published)
        return "solved";
    if (result->agrees && !classic->computed)
        return "agrees";
    if (result->better && (result->agrees || !classic->computed))
        return "better";
    return result->agrees ? "by the data" : "DIFFERS";
}

static moray_status solve_from_start(const struct classic *classic, const moray_ocp *ocp,
                                     const moray_settings *settings, moray_solution **solution)
{
    if (!classic->start && !classic->straight)
        return moray_solve(ocp, settings, NULL, solution);
    struct start *start = calloc(1, sizeof *start);
    if (!start)
        return moray_error(MORAY_MEMORY, "no memory for the start of %s", classic->name);
    sample_start(classic, ocp, start);
    const moray_guess guess = {.phase = start->phase, .s = classic->parameters};
    moray_status status = moray_solve(ocp, settings, &guess, solution);
    free(start);
    return status;
}

moray_status classic_first_solution(const struct classic *classic, const moray_settings *settings, moray_ocp **ocp,
                                    moray_solution **solution)
{
    *ocp = NULL;
    *solution = NULL;
    MORAY_TRY(classic->build(ocp, classic->data));
    return solve_from_start(classic, *ocp, settings, solution);
}

// Whether value becomes the printed decimal number when rounded or cut to its digits.
static bool agrees_with(double value, const char *printed)
{
    const char *point = strchr(printed, '.'), *exponent = strchr(printed, 'e');
    const double digits = point ? (double)strcspn(point + 1, "e") : 0;
    const double unit = pow(10, (exponent ? strtod(exponent + 1, NULL) : 0) - digits), slack = 1e-6 * unit;
    const double beyond = copysign(1, value) * (value - strtod(printed, NULL));
    return beyond >= -unit / 2 - slack && beyond < unit + slack;
}

static void judge(const struct classic *classic, struct classic_result *result)
{
    const char *expected = classic->computed ? classic->computed : classic->published;
    result->difference = classic->published ? result->value - strtod(classic->published, NULL) : NAN;
    result->agrees = expected && result->outcome == MORAY_NLP_SOLVED && agrees_with(result->value, expected);
    if (classic->closed_form != 0)
        result->agrees =
            result->agrees && fabs(result->value - classic->closed_form) <= 1e-7 * fabs(classic->closed_form);
}

moray_settings classic_settings(const struct classic *classic)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = classic->scheme ? classic->scheme : "gauss3";
    settings.intervals = classic->intervals > 0 ? classic->intervals : 20;
    settings.tolerance = classic->tolerance > 0 ? classic->tolerance : 1e-10;
    settings.mesh_tolerance = classic->mesh_tolerance > 0 ? classic->mesh_tolerance : 1e-6;
    settings.max_refinements = classic->fixed_mesh ? 0 : 20;
    return settings;
}

static void read_solution(const struct classic *classic, const moray_solution *solution, struct classic_result *result)
{
    const moray_mesh_record *mesh = moray_solution_history(solution, &result->meshes);
    if (result->meshes > CLASSIC_MOST_MESHES)
        result->meshes = CLASSIC_MOST_MESHES;
    result->outcome = moray_solution_info(solution)->outcome;
    for (int k = 0; k < result->meshes; k++) {
        result->mesh[k] = mesh[k];
        result->iterations += mesh[k].iterations;
    }
    result->value = classic->maximised ? -moray_solution_objective(solution) : moray_solution_objective(solution);
    judge(classic, result);
}

moray_status classic_solve(const struct classic *classic, const moray_settings *settings,
                           const moray_integrator *integrator, struct classic_result *result, char *diagnosis, int size)
{
    return classic_solve_viewed(classic, settings, integrator, NULL, result, diagnosis, size);
}

moray_status classic_solve_viewed(const struct classic *classic, const moray_settings *settings,
                                  const moray_integrator *integrator, const classic_viewer *viewer,
                                  struct classic_result *result, char *diagnosis, int size)
{
    const double start = moray_processor_clock();
    *result = (struct classic_result){0};
    moray_ocp *ocp;
    moray_solution *solution;
    moray_status status = classic_first_solution(classic, settings, &ocp, &solution);
    result->seconds = moray_processor_clock() - start;
    if (!moray_failed(status)) {
        read_solution(classic, solution, result);
        if (diagnosis)
            snprintf(diagnosis, (size_t)size, "%s", moray_solution_diagnosis(solution));
        status = moray_certify(solution, integrator, &result->certificate);
        if (status.code == MORAY_NUMERIC) { // what is found leaves its domain when it is simulated: no certificate
            result->certificate.resimulation = INFINITY;
            result->certificate.pass = false;
            status = moray_ok();
        }
        result->better =
            result->certificate.pass && (classic->maximised ? result->difference > 0 : result->difference < 0);
    }
    if (!moray_failed(status) && viewer && result->outcome == MORAY_NLP_SOLVED)
        status = viewer->view(classic, ocp, solution, viewer->self);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return status;
}
