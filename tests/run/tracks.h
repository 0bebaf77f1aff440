// SPDX-License-Identifier: MIT
//
// A run of a problem of two phases, whose files and figures the linker leads to the test.
#ifndef TESTS_RUN_TRACKS_H
#define TESTS_RUN_TRACKS_H

#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "base/csv.h"
#include "run/fit.h"

// ---- Files and figures ---------------------------------------------------------------------------------------------

enum { FIGURES = 20, CURVES = 4, POINTS = 600 };

typedef struct drawn {
    char name[60], title[100], x_label[40], y_label[60], label[CURVES][80];
    int n, points[CURVES];
    bool marks[CURVES];
    double x[CURVES][POINTS], y[CURVES][POINTS];
} drawn;

static drawn figures[FIGURES];
static int n_figures;
static char path[] = "/tmp/moray_tracks_XXXXXX", file_name[60];
static FILE *opened;

moray_status __wrap_moray_output_file(moray_output *output, const char *name, FILE **file);
moray_status __wrap_moray_output_figure(moray_output *output, const moray_figure *figure);

moray_status __wrap_moray_output_file(moray_output *output, const char *name, FILE **file)
{
    (void)output;
    snprintf(file_name, sizeof file_name, "%s", name);
    *file = opened = fopen(path, "w");
    return moray_ok();
}

moray_status __wrap_moray_output_figure(moray_output *output, const moray_figure *figure)
{
    (void)output;
    if (n_figures == FIGURES)
        return moray_error(MORAY_INPUT, "too many figures");
    drawn *d = &figures[n_figures++];
    *d = (drawn){.n = figure->n_curves};
    snprintf(d->name, sizeof d->name, "%s", figure->name);
    snprintf(d->title, sizeof d->title, "%s", figure->title);
    snprintf(d->x_label, sizeof d->x_label, "%s", figure->x_label);
    snprintf(d->y_label, sizeof d->y_label, "%s", figure->y_label);
    for (int k = 0; k < d->n && k < CURVES; k++) {
        const moray_curve *curve = &figure->curves[k];
        const int stride = curve->stride ? curve->stride : 1;
        snprintf(d->label[k], sizeof d->label[k], "%s", curve->label);
        d->points[k] = curve->n;
        d->marks[k] = curve->style == MORAY_CURVE_POINTS;
        for (int i = 0; i < curve->n && i < POINTS; i++) {
            d->x[k][i] = curve->x[i * stride];
            d->y[k][i] = curve->y[i * stride];
        }
    }
    return moray_ok();
}

static inline const drawn *figure_of(const char *name)
{
    for (int k = 0; k < n_figures; k++)
        if (strcmp(figures[k].name, name) == 0)
            return &figures[k];
    static const drawn none;
    CHECK(false, "no figure %s", name);
    return &none;
}

// ---- What is solved ------------------------------------------------------------------------------------------------

enum { SEEN = 3, CHANNELS = 2 };
static const double seen_at[SEEN] = {2.1, 2.6, 3.3}, seen[SEEN * CHANNELS] = {0.9, -0.2, NAN, 0.1, 0.7, 0.4};

// Three states, two controls, of which one is limited together with a state.
static void climb(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] - 0.3 * at->x[0];
    out->f[2] = at->u[1] + 0.2 * at->x[1] * at->s[0];
    out->c[0] = at->u[0] + 0.1 * at->x[2];
    out->g[0] = at->u[0] * at->u[0] + 0.7 * at->u[1] * at->u[1];
}

static void glide(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] - 0.5 * at->x[0];
    out->f[1] = at->x[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] + 0.1 * at->t;
    y[1] = at->x[1] - at->u[0] + 0.05 * at->s[0] - 0.3 * at->s[1];
}

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0] + (at->s[0] - 0.4) * (at->s[0] - 0.4) +
                     (at->s[1] + 0.7) * (at->s[1] + 0.7);
    out->e[0] = at->phase[1].x0[0] - at->phase[0].xf[1];
}

static const char *const x_one[] = {"a", "b", "c"}, *const u_one[] = {"force", "flow"}, *const x_two[] = {"b", "way"},
                         *const u_two[] = {"force"};
static const char *const x_units[] = {"m", "m/s", "m"}, *const u_units[] = {"N", "m s"},
                         *const x_units_two[] = {"m/s", NULL}, *const u_units_two[] = {"kN"};

static moray_phase_spec phases[2];
static moray_observations seen_first; // of the first phase; none as a rule

typedef struct rig {
    moray_ocp_spec spec;
    moray_app app;
    app_run run;
} rig;

static const moray_app_units both[] = {{.x = x_units, .u = u_units}, {.x = x_units_two, .u = u_units_two}};

// The bounds are the problem's own once it is made.
static void rig_new(rig *r, int refinements)
{
    phases[0] = (moray_phase_spec){.name = "up/hill",
                                   .nx = 3,
                                   .nu = 2,
                                   .nc = 1,
                                   .nq = 1,
                                   .continuous = climb,
                                   .t0 = moray_fixed(0.5),
                                   .tf = moray_fixed(2),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0.1), moray_fixed(-0.2)),
                                   .xf = MORAY_BOUNDS(moray_fixed(1), moray_free(), moray_fixed(0.8)),
                                   .u = MORAY_BOUNDS(moray_between(-5, 5), moray_between(-0.2, 0.7)),
                                   .c = MORAY_BOUNDS(moray_between(-3, 1.1)),
                                   .x_names = x_one,
                                   .u_names = u_one,
                                   .observed = seen_first};
    phases[1] =
        (moray_phase_spec){.name = "down",
                           .nx = 2,
                           .nu = 1,
                           .nq = 1,
                           .continuous = glide,
                           .t0 = moray_fixed(2),
                           .tf = moray_fixed(3.5),
                           .xf = MORAY_BOUNDS(moray_fixed(0.2), moray_free()),
                           .x0 = MORAY_BOUNDS(moray_free(), moray_fixed(0)),
                           .x_names = x_two,
                           .u_names = u_two,
                           .observed = {.n = SEEN, .ny = CHANNELS, .time = seen_at, .value = seen, .observe = see}};
    r->spec = (moray_ocp_spec){.name = "hill",
                               .phases = 2,
                               .phase = phases,
                               .ns = 2,
                               .ne = 1,
                               .e = MORAY_BOUNDS(moray_fixed(0)),
                               .endpoint = ends};
    r->app = (moray_app){.spec = &r->spec, .units = both, .time_unit = "h", .objective_unit = "J"};
    r->run = (app_run){.app = &r->app, .name = "hill"};
    moray_settings settings = moray_settings_default();
    settings.intervals = 3;
    settings.max_refinements = refinements;
    settings.mesh_tolerance = 1e-9;
    CHECK_OK(moray_ocp_new(&r->run.ocp, &r->spec), "a problem");
    CHECK_OK(moray_solve(r->run.ocp, &settings, NULL, &r->run.solution), "solved");
}

static void rig_free(rig *r)
{
    moray_solution_free(r->run.solution);
    moray_ocp_free(r->run.ocp);
}

#endif
