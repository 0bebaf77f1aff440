// SPDX-License-Identifier: MIT
//
// Every allocation of transcription, scales, wider patterns, carried multipliers, sensitivities, fits and small solves
// fails once, each by itself: house/test_memory.c has them in whole runs, which take long.
#include "allocations.h"
#include "tap.h"

#include "moray/fit.h"
#include "moray/sensitivity.h"
#include "ocp/samples.h"
#include "ocp/solve_again.h"
#include "ocp/widen.h"

enum { phases = 2, most_intervals = 3 };

// Beyond where anybody looks at first, more depends on more.
static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] + (creal(at->x[0]) > 1e6 ? at->x[1] : 0);
    out->f[1] = at->u[1];
    out->c[0] = at->x[0] + at->u[0];
    out->g[0] = at->u[0] * at->u[0] + at->u[1] * at->u[1] + 1;
}

static void see(const moray_node *at, moray_num *seen, const void *data)
{
    (void)data;
    seen[0] = at->x[0] + (creal(at->x[0]) > 1e6 ? at->x[1] : 0);
}

static void pay(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *last = &at->phase[1];
    out->objective = at->phase[0].q[0] + last->q[0] + (creal(last->xf[0]) > 1e6 ? last->xf[1] * last->xf[1] : 0);
    out->objective += at->s[0] * at->s[0];
    if (last->u0)
        out->objective += last->u0[0] * last->u0[0] + last->uf[0] * last->uf[0];
}

static void see_first(const moray_node *at, moray_num *seen, const void *data)
{
    (void)data;
    seen[0] = at->x[0];
}

// Rich: with controls at the ends and data that move over the mesh.
static moray_status make(moray_ocp **ocp, bool rich)
{
    static const double time[] = {1.2, 1.5}, value[] = {0, 0};
    static const moray_bounds c[] = {{-50, 50}}, x0[] = {{0, 0}, {0, 0}}, xf[] = {{1, 1}, {-MORAY_INFINITY, 9}};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.nx = 2,
                                      .nu = 2,
                                      .nc = 1,
                                      .nq = 1,
                                      .continuous = go,
                                      .t0 = rich ? moray_between(0, 1) : moray_fixed(0),
                                      .tf = rich ? moray_between(1.5, 3) : moray_fixed(2),
                                      .x0 = MORAY_BOUNDS_OF(x0),
                                      .xf = MORAY_BOUNDS_OF(xf),
                                      .c = MORAY_BOUNDS_OF(c),
                                      .end_controls = rich};
    if (rich)
        phase[1].observed = (moray_observations){.n = 2, .ny = 1, .time = time, .value = value, .observe = see};
    return moray_ocp_new(ocp, &(moray_ocp_spec){.phases = phases, .phase = phase, .ns = 1, .endpoint = pay});
}

static moray_settings settings_of(const char *scheme, int intervals)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = intervals;
    return settings;
}

static moray_ocp *rich, *plain;
static moray_solution *coarse, *fine; // of the plain one

// ---- What is run ----

static moray_status guess(void)
{
    const int rows[phases] = {3, 4};
    struct samples samples[phases];
    moray_guess made;
    const moray_status status = moray_guess_allocate(&made, plain, rows, true, samples, NULL);
    if (!moray_failed(status))
        moray_guess_free(&made);
    return status;
}

static moray_status meshes(void)
{
    static const double edge[] = {0, 0.3, 1};
    struct mesh mesh = {0}, copy = {0};
    MORAY_TRY(guess());
    moray_status status = moray_mesh_of(&mesh, edge, 2, (struct method){MORAY_RADAU, 3});
    if (!moray_failed(status))
        status = moray_mesh_copy(&copy, &mesh);
    moray_mesh_free(&mesh);
    moray_mesh_free(&copy);
    return status;
}

static moray_status scheme(void)
{
    moray_scheme made;
    const moray_status status = moray_scheme_new(&made, MORAY_GAUSS, 3);
    if (!moray_failed(status))
        moray_scheme_free(&made);
    return status;
}

static moray_status transcribe_with(const moray_ocp *ocp, struct transcription **t)
{
    struct mesh mesh[phases] = {{.intervals = 0}, {.intervals = 0}};
    moray_status status = moray_ok();
    *t = NULL;
    for (int p = 0; p < phases && !moray_failed(status); p++) {
        status = moray_mesh_uniform(&mesh[p], most_intervals - p, (struct method){MORAY_GAUSS, 2 + p});
        mesh[p].t0 = 0.5, mesh[p].tf = 2;
    }
    if (!moray_failed(status))
        status = moray_transcription_new(t, ocp, mesh);
    for (int p = 0; p < phases; p++)
        moray_mesh_free(&mesh[p]);
    return status;
}

static moray_status transcribe(void)
{
    struct transcription *t;
    const moray_status status = transcribe_with(rich, &t);
    moray_transcription_free(t);
    return status;
}

static moray_status scales(void)
{
    return moray_choose_scales(coarse->transcription, coarse->iterate.x, true);
}

static moray_status carry(void)
{
    return moray_carry_multipliers(&(moray_guess){.from = coarse}, fine);
}

static struct transcription *shown; // at a point that shows more

static moray_status widen(void)
{
    int found;
    return moray_widen_patterns(shown, &found);
}

static moray_status errors(void)
{
    double error[most_intervals];
    return moray_solution_interval_errors(coarse, 0, error);
}

static moray_status sensitivities(void)
{
    const moray_ocp *const displaced[] = {plain, plain, plain, plain};
    moray_sensitivity *s;
    moray_solution *predicted = NULL;
    MORAY_TRY(moray_sensitivity_new(&s, coarse));
    moray_status status = moray_sensitivity_by(s, displaced, 1e-3);
    if (!moray_failed(status))
        status = moray_sensitivity_predict(s, plain, 1e-3, &predicted);
    moray_solution_free(predicted);
    moray_sensitivity_free(s);
    return status;
}

// Scales that are far off, and room inside a bound.
static moray_status solve_again(void)
{
    const struct transcription *t = fine->transcription;
    MORAY_TRY(moray_choose_scales(fine->transcription, fine->iterate.x, true));
    fine->transcription->scale[t->layout.phase[0].q] = 1e-6;
    fine->iterate.g[t->layout.phase[0].node[1].path] = 50 - 1e-3 * fine->iterate.objective;
    fine->iterate.lambda[t->layout.phase[0].node[1].path] = 0.2;
    fine->info.outcome = MORAY_NLP_SOLVED;
    return moray_solve_again(fine);
}

static moray_status solve(void)
{
    moray_solution *solution = NULL;
    const moray_settings settings = settings_of("gauss2,radau3", 1);
    const moray_status status = moray_solve(plain, &settings, NULL, &solution);
    moray_solution_free(solution);
    return status;
}

// On the mesh of a solution.
static moray_status solve_on(void)
{
    moray_solution *solution = NULL;
    moray_settings settings = settings_of("radau2", 0);
    const moray_guess from = moray_guess_from_solution(coarse);
    const moray_status status = moray_solve(plain, &settings, &from, &solution);
    moray_solution_free(solution);
    return status;
}

static void decay(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->s[0] - at->x[0];
}

static void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)at, (void)data;
    out->objective = 0;
}

static moray_solution *fitted;

static moray_status confidence(void)
{
    moray_fit fit;
    const moray_status status = moray_fit_new(&fit, fitted, false);
    moray_fit_free(&fit);
    return status;
}

static moray_status solve_fit(moray_ocp **ocp)
{
    static const double time[] = {0.2, 0.5, 0.9}, value[] = {0.3, 0.6, 0.7};
    const moray_settings settings = settings_of("radau2", 2);
    const moray_phase_spec phase = {.nx = 1,
                                    .continuous = decay,
                                    .tf = moray_fixed(1),
                                    .observed = {.n = 3, .ny = 1, .time = time, .value = value, .observe = see_first}};
    MORAY_TRY(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .endpoint = nothing}));
    return moray_solve(*ocp, &settings, NULL, &fitted);
}

static moray_status read_data(void)
{
    static const char *const names[] = {"a", "b"};
    moray_data data;
    const moray_status status = moray_data_read(&data, names, 2, 0, 1, "test_ocp_memory.csv");
    moray_data_free(&data);
    return status;
}

static void write_data(void)
{
    FILE *file = fopen("test_ocp_memory.csv", "w");
    fprintf(file, "t,a,b\n0.5,1,2\n0.7,3,4\n");
    fclose(file);
}

int main(void)
{
    moray_ocp *line;
    CHECK_OK(make(&rich, true), "a problem with controls at the ends and data");
    CHECK_OK(make(&plain, false), "one without");
    const moray_settings settings[] = {settings_of("radau2", 2), settings_of("radau2", 3)};
    CHECK_OK(moray_solve(plain, &settings[0], NULL, &coarse), "solved");
    CHECK_OK(moray_solve(plain, &settings[1], NULL, &fine), "on a finer mesh");
    fail_each("guess and meshes", false, meshes);
    fail_each("transcription", false, transcribe);
    fail_each("scheme", false, scheme);
    fail_each("scales", false, scales);
    fail_each("multipliers", false, carry);
    fail_each("errors of intervals", false, errors);
    fail_each("sensitivities", true, sensitivities);
    fail_each("a second solve", false, solve_again);
    fail_each("a solve", false, solve);
    fail_each("a solve on another's mesh", false, solve_on);
    CHECK_OK(solve_fit(&line), "a fit");
    fail_each("its confidence", true, confidence);
    moray_solution_free(fitted);
    moray_ocp_free(line);
    write_data();
    fail_each("data from a file", false, read_data);
    remove("test_ocp_memory.csv");
    CHECK_OK(transcribe_with(rich, &shown), "transcribed");
    double there[200];
    for (int j = 0; j < shown->nlp.n && j < 200; j++)
        there[j] = 3e6;
    CHECK(moray_transcription_values(shown, there) && shown->nlp.n <= 200, "where more shows");
    fail_each("wider patterns", false, widen);
    moray_transcription_free(shown);
    moray_solution_free(coarse);
    moray_solution_free(fine);
    moray_ocp_free(plain);
    moray_ocp_free(rich);
    return tap_done();
}
