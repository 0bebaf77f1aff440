// SPDX-License-Identifier: MIT
//
// The endpoint with what is observed: its values against the sums written out, its derivatives against differences and,
// as Gauss and Newton take them, against products of slopes by complex step; and where its entries stand.
#include "observe.h"

#include "dense.h"
#include "ocp/transcription.h"

enum { phases = 3, parameters = 3, base_out = 2, most_ny = 3 };

// ---- Losses ----

static void test_loss(void)
{
    static const struct {
        double z, loss, slope, curvature;
    } cases[] = {{0, 0, 0, 2},        {0.5, 0.25, 1, 2}, {-0.5, 0.25, -1, 2}, {1.5, 2.25, 3, 2},
                 {-1.5, 2.25, -3, 2}, {2, 3.75, 3, 0},   {-2, 3.75, -3, 0},   {11, 30.75, 3, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct observed huber = {.loss = MORAY_HUBER, .threshold = 1.5}, least = {.threshold = 1.5};
        const double z = cases[k].z;
        double slope, curvature, loss = moray_loss_at(&huber, z, &slope, &curvature);
        CHECK(loss == cases[k].loss && slope == cases[k].slope && curvature == cases[k].curvature,
              "Huber's loss at %g: %g, slope %g, curvature %g", z, loss, slope, curvature);
        loss = moray_loss_at(&least, z, &slope, &curvature);
        CHECK(loss == z * z && slope == 2 * z && curvature == 2, "square of %g, slope %g, curvature %g", z, slope,
              curvature);
    }
}

// ---- A problem ----

static void see_first(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] * at->x[1] + at->s[1] * at->t;
    y[1] = cexp(-at->x[1]) * at->s[0] + at->u[0] * at->u[0];
}

static void see_last(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] * at->u[1];
    y[1] = at->s[0] * at->s[1];
    y[2] = csin(at->x[0]) * at->t - at->s[2];
}

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
}

static void swing(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] - at->x[0];
}

static void tie(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->s[0] * at->phase[2].xf[0] + at->s[2] * at->s[2] + at->phase[1].tf;
    out->e[0] = at->phase[0].xf[1] * at->s[0];
}

struct form {
    moray_loss loss;
    bool apart[phases], residuals[phases], sum[phases]; // counted as events only; bounds of residuals and of their sum
};

static const int nx[phases] = {2, 1, 1}, nu[phases] = {1, 1, 2}, ny[phases] = {2, 0, 3}, n[phases] = {3, 0, 2};
static const double time_of[phases][3] = {{1.5, 1, 1.25}, {0}, {3, 4}};
static const double value_of[phases][6] = {{0.3, 1.1, NAN, 0.2, -0.7, 0.5}, {0}, {0.9, 3, NAN, -0.4, 0.1, 2}};
static const double weight_of[phases][most_ny] = {{2, 0.5}, {0}, {1.5, 4, 0}};
static moray_observe_fn *const see[phases] = {see_first, NULL, see_last};
static const double threshold[phases] = {0.4, 0, 0.9};

static moray_ocp *build(const struct form *form)
{
    const moray_bounds_list bounds[phases] = {MORAY_BOUNDS(moray_between(-3, 3), moray_at_most(2)),
                                              {0},
                                              MORAY_BOUNDS(moray_between(-1, 3), moray_at_most(2), moray_free())};
    moray_continuous_fn *const move[phases] = {swing, still, still};
    moray_phase_spec phase[phases];
    moray_ocp *ocp = NULL;
    for (int p = 0; p < phases; p++) {
        phase[p] = (moray_phase_spec){.nx = nx[p],
                                      .nu = nu[p],
                                      .continuous = move[p],
                                      .t0 = moray_fixed(p + 1),
                                      .tf = p == 1 ? moray_between(2.5, 3) : moray_fixed(p + 2)};
        if (see[p])
            phase[p].observed =
                (moray_observations){.n = n[p],
                                     .ny = ny[p],
                                     .time = time_of[p],
                                     .value = value_of[p],
                                     .weight = weight_of[p],
                                     .observe = see[p],
                                     .loss = form->loss,
                                     .threshold = threshold[p],
                                     .events_only = form->apart[p],
                                     .residual = form->residuals[p] ? bounds[p] : (moray_bounds_list){0},
                                     .sum = form->sum[p] ? moray_at_most(9) : (moray_bounds){0}};
    }
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = phases,
                                                   .phase = phase,
                                                   .ns = parameters,
                                                   .ne = 1,
                                                   .e = MORAY_BOUNDS(moray_at_most(1)),
                                                   .endpoint = tie}),
             "problem");
    return ocp;
}

static moray_status transcribe(struct transcription **t, const moray_ocp *ocp, struct method method)
{
    struct mesh mesh[phases];
    for (int p = 0; p < phases; p++)
        CHECK_OK(moray_mesh_uniform(&mesh[p], 2, method), "mesh");
    const moray_status status = moray_transcription_new(t, ocp, mesh);
    for (int p = 0; p < phases; p++)
        moray_mesh_free(&mesh[p]);
    return status;
}

// ---- The same, written out ----

// Inputs of the endpoint [x0, t0, xf, tf of each phase, s] and then [x, u] of each time.
static int place_of(int p, int k)
{
    int at = 0;
    for (int i = 0; i < phases; i++)
        at += 2 * nx[i] + 2;
    at += parameters;
    for (int i = 0; i < p; i++)
        at += n[i] * (nx[i] + nu[i]);
    return at + k * (nx[p] + nu[p]);
}

enum { first_parameter = 2 * (2 + 1 + 1) + 2 * phases, all_in = first_parameter + parameters + 3 * 3 + 2 * 3 };

// y of a time, and its slope by an input of the endpoint by complex step, or by none (-1).
static void observe(int p, int k, const double *in, int by, double *y)
{
    moray_num x[3], s[parameters], seen[most_ny];
    const double step = 1e-30;
    for (int i = 0; i < nx[p] + nu[p]; i++)
        x[i] = in[place_of(p, k) + i] + (place_of(p, k) + i == by ? step * I : 0);
    for (int i = 0; i < parameters; i++)
        s[i] = in[first_parameter + i] + (first_parameter + i == by ? step * I : 0);
    see[p](&(moray_node){.x = x, .u = x + nx[p], .s = s, .t = time_of[p][k]}, seen, NULL);
    for (int j = 0; j < ny[p]; j++)
        y[j] = by < 0 ? creal(seen[j]) : cimag(seen[j]) / step;
}

static double loss_of(const struct form *form, int p, int j, double residual, double *curvature)
{
    const double z = sqrt(weight_of[p][j]) * fabs(residual), d = threshold[p];
    const bool far = form->loss == MORAY_HUBER && z > d;
    *curvature = far ? 0 : 2 * weight_of[p][j];
    return far ? d * (2 * z - d) : z * z;
}

// out[base_out + events], and how many.
static int write_out(const struct form *form, const double *in, double *out)
{
    const double *s = in + first_parameter;
    int at = base_out;
    out[0] = s[0] * in[10 + 2] + s[2] * s[2] + in[6 + 3];
    out[1] = in[4] * s[0];
    for (int p = 0; p < phases; p++) {
        double sum = 0, curvature, y[most_ny];
        for (int k = 0; k < n[p]; k++) {
            observe(p, k, in, -1, y);
            for (int j = 0; j < ny[p]; j++) {
                const double residual = y[j] - value_of[p][k * ny[p] + j];
                sum += isnan(residual) ? 0 : loss_of(form, p, j, residual, &curvature);
                if (form->residuals[p] && !isnan(residual))
                    out[at++] = residual;
            }
        }
        out[0] += form->apart[p] ? 0 : sum;
        if (form->sum[p])
            out[at++] = sum;
    }
    return at;
}

// Adds to m[all_in][all_in] the products of slopes of phase p's residuals, times curvature of their losses and `times`.
static void add_products(const struct form *form, int p, const double *in, double times, dense m)
{
    for (int k = 0; k < n[p]; k++) {
        double y[most_ny], slope[all_in][most_ny], curvature;
        observe(p, k, in, -1, y);
        for (int i = 0; i < all_in; i++)
            observe(p, k, in, i, slope[i]);
        for (int j = 0; j < ny[p]; j++) {
            const double residual = y[j] - value_of[p][k * ny[p] + j];
            if (isnan(residual))
                continue;
            loss_of(form, p, j, residual, &curvature);
            for (int a = 0; a < all_in; a++)
                for (int b = 0; b < all_in; b++)
                    DENSE(m, a, b) += times * curvature * slope[a][j] * slope[b][j];
        }
    }
}

static double symmetric_difference(dense want, const int *row, const int *col, const double *value, int nnz)
{
    double worst = 0;
    dense got = dense_zero(all_in, all_in);
    for (int e = 0; e < nnz; e++) {
        DENSE(got, row[e], col[e]) += value[e];
        if (row[e] != col[e])
            DENSE(got, col[e], row[e]) += value[e];
    }
    for (int i = 0; i < all_in * all_in; i++)
        worst = tap_worse(worst, fabs(got.at[i] - want.at[i]));
    dense_free(&got);
    return worst;
}

// ---- Checks ----

static void test_values(const struct form *form, struct transcription *t, const double *in)
{
    double want[40], got[40] = {0}, worst = 0;
    const int outputs = write_out(form, in, want);
    CHECK(t->endpoint->n_in == all_in && t->endpoint->n_out == outputs, "%d inputs, %d outputs", t->endpoint->n_in,
          t->endpoint->n_out);
    t->endpoint->value(t->endpoint->self, in, got);
    for (int i = 0; i < outputs; i++)
        worst = tap_worse(worst, fabs(got[i] - want[i]));
    CHECK(worst < 1e-13, "objective, event, residuals and sums: %.1e", worst);
    for (int p = 0; p < phases; p++)
        for (int k = 0; k < n[p]; k++) {
            double y[most_ny];
            const double *seen = moray_fit_predict(t->fit, p, k, in);
            observe(p, k, in, -1, y);
            for (int j = 0; j < ny[p]; j++)
                CHECK_NEAR(seen[j], y[j], 1e-14, "predicted");
        }
}

static void test_gauss_newton(const struct form *form, struct transcription *t, const double *in)
{
    const moray_map *map = t->endpoint;
    dense want = dense_zero(all_in, all_in);
    double weight[40], *value = calloc((size_t)map->hess.nnz, sizeof *value);
    for (int i = 0; i < map->n_out; i++)
        weight[i] = 1.3 * cos(i) + 0.2;
    DENSE(want, first_parameter, 12) = DENSE(want, 12, first_parameter) = weight[0];
    DENSE(want, first_parameter + 2, first_parameter + 2) = 2 * weight[0];
    DENSE(want, first_parameter, 4) = DENSE(want, 4, first_parameter) = weight[1];
    int at = base_out;
    for (int p = 0; p < phases; p++) {
        for (int k = 0; k < n[p] * ny[p]; k++)
            at += form->residuals[p] && !isnan(value_of[p][k]);
        add_products(form, p, in, (form->apart[p] ? 0 : weight[0]) + (form->sum[p] ? weight[at++] : 0), want);
    }
    moray_fit_be_gauss_newton(t, true);
    map->hessian(map->self, in, weight, value);
    const double worst = symmetric_difference(want, map->hess.row, map->hess.col, value, map->hess.nnz);
    CHECK(t->gauss_newton && worst < 1e-9, "second derivatives of Gauss and Newton: %.1e", worst);
    moray_fit_be_gauss_newton(t, false);
    CHECK(!t->gauss_newton, "and back");
    free(value);
    dense_free(&want);
}

static void test_information(const struct form *form, struct transcription *t, const double *in)
{
    const int entries = moray_fit_information(t->fit, in, NULL, NULL, NULL);
    int *row = calloc(2 * (size_t)entries, sizeof *row), *col = row + entries, of_order = 0;
    double *value = calloc((size_t)entries, sizeof *value);
    dense want = dense_zero(all_in, all_in);
    for (int p = 0; p < phases; p++)
        if (!form->apart[p])
            add_products(form, p, in, 0.5, want);
    CHECK(moray_fit_information(t->fit, in, row, col, value) == entries, "%d entries", entries);
    const double worst = symmetric_difference(want, row, col, value, entries);
    CHECK(worst < 1e-12, "information: %.1e", worst);
    for (int e = 0; e < entries; e++)
        of_order += (row[e] >= first_parameter) && (col[e] >= first_parameter) && row[e] < all_in && col[e] < all_in;
    CHECK(of_order == entries, "of parameters and what is seen");
    free(row), free(value);
    dense_free(&want);
}

// Entries where outputs depend on inputs by what the functions say, each once; those between parameters are shared.
static void test_pattern(const struct form *form, const moray_map *map)
{
    static const int variables[phases] = {3, 0, 2}, slopes[phases][most_ny] = {{3, 3}, {0}, {2, 2, 2}};
    static const bool by_parameter[phases][parameters] = {{true, true, false}, {0}, {true, true, true}};
    const int of_ends = 3, first = 9, last = 4, shared = 3; // pairs: of a time of either phase, and of parameters
    bool known[parameters] = {true, false, true};           // of the objective, from its own function
    int want = 6, twice = 0;
    for (int p = 0; p < phases; p++) {
        want += (!form->apart[p] + form->sum[p]) * n[p] * variables[p];
        for (int i = 0; i < parameters; i++) {
            want += by_parameter[p][i] * (form->sum[p] + (!form->apart[p] && !known[i]));
            known[i] = known[i] || (!form->apart[p] && by_parameter[p][i]);
        }
        for (int k = 0; k < n[p] * ny[p]; k++)
            want += form->residuals[p] && !isnan(value_of[p][k]) ? slopes[p][k % ny[p]] : 0;
    }
    for (int a = 0; a < map->jac.nnz; a++)
        for (int b = 0; b < a; b++)
            twice += map->jac.row[a] == map->jac.row[b] && map->jac.col[a] == map->jac.col[b];
    CHECK(twice == 0 && map->jac.nnz == want, "%d slopes, expected %d, %d of them twice", map->jac.nnz, want, twice);
    CHECK(map->hess.nnz == of_ends + 3 * first + 2 * last + shared, "%d second derivatives", map->hess.nnz);
}

static void test_form(const struct form *form)
{
    struct transcription *t;
    unsigned long long random = 3;
    double in[all_in];
    moray_ocp *ocp = build(form);
    CHECK_OK(transcribe(&t, ocp, (struct method){MORAY_LOBATTO, 3}), "transcription");
    test_map(t->endpoint);
    for (int trial = 0; trial < 3; trial++) {
        for (int i = 0; i < all_in; i++)
            in[i] = tap_random(&random, -2, 2);
        test_values(form, t, in);
        test_gauss_newton(form, t, in);
        test_information(form, t, in);
    }
    test_pattern(form, t->endpoint);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

static void see_parameters(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->s[0] * at->s[1] * at->t;
    y[1] = at->s[1];
}

// Where parameters alone are seen there is nothing else, and all times share one entry of each.
static void test_parameters(void)
{
    const moray_phase_spec phase = {
        .nx = 1,
        .nu = 1,
        .continuous = still,
        .tf = moray_fixed(4),
        .observed = {.n = 3, .ny = 2, .time = time_of[0], .value = value_of[0], .observe = see_parameters}};
    struct transcription *t;
    struct mesh mesh;
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 2, .endpoint = nothing}),
             "parameters alone");
    CHECK_OK(moray_mesh_uniform(&mesh, 2, (struct method){MORAY_GAUSS, 2}), "mesh");
    CHECK_OK(moray_transcription_new(&t, ocp, &mesh), "transcription");
    test_map(t->endpoint);
    CHECK(t->endpoint->jac.nnz == 2 && t->endpoint->hess.nnz == 3, "%d slopes, %d second derivatives",
          t->endpoint->jac.nnz, t->endpoint->hess.nnz);
    moray_transcription_free(t);
    moray_mesh_free(&mesh);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_parameters();
    test_loss();
    for (int k = 0; k < 32; k++)
        test_form(&(struct form){.loss = k & 1 ? MORAY_HUBER : MORAY_LEAST_SQUARES,
                                 .apart = {k & 2, false, k & 4},
                                 .residuals = {k & 8, false, k & 16},
                                 .sum = {k & 4, false, k & 8}});
    return tap_done();
}
