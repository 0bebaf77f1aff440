// SPDX-License-Identifier: MIT
//
// Covariance of parameters where all is linear, against dense linear algebra: least squares with weights, values that
// are missing, parameters of other sizes, and constraints that are active or not.
#include "observe.h"

#include "dense.h"
#include "ocp/certificate/witness.h"

// Unknown is c = (x at 0, s): x = c0 + c1 t, y0 = x + c2 sin 3t, y1 = c3 (1 + t) / 1000 - x.
enum { unknowns = 4, n_times = 7, channels = 2 };
static const double all_times[n_times] = {0.2, 1.9, 0.5, 0.9, 1.1, 1.4, 0.75};
static const double all_values[n_times * channels] = {1.4, 0.7, 3.9, NAN, 2.6, -0.1, 2.7,
                                                      NAN, 2.2, 0.4, 2.2, 0.5, 3.1,  -0.4};
static const double all_weights[channels] = {2, 0.3};

static void row_of(int k, int j, double *row)
{
    const double t = all_times[k], sign = j ? -1 : 1;
    row[0] = sign, row[1] = sign * t, row[2] = j ? 0 : sin(3 * t), row[3] = j ? (1 + t) / 1000 : 0;
}

static void stay(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)data;
    out->f[0] = 0;
}

static void see_line(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] + at->s[1] * csin(3 * at->t);
    y[1] = at->s[2] * (1 + at->t) / 1000 - at->x[0];
}

static void event_of(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 0;
    out->e[0] = at->s[0] + 2 * at->s[1];
    out->e[1] = at->s[1] - at->s[2] / 500;
}

// What binds: bounds of c and of the events, and which of these hold at the optimum, in this order.
struct bound {
    const char *what;
    moray_bounds c[unknowns], e[2];
    bool active[unknowns + 2];
};

static const double of_event[2][unknowns] = {{0, 1, 2, 0}, {0, 0, 1, -1.0 / 500}};

// c by the normal equations and what is active, and the block[unknowns][unknowns] of the inverse; the weighted sum of
// squares.
static double least_squares(const struct bound *bound, double *c, double *block)
{
    int size = unknowns;
    double all[unknowns + 2], sum = 0;
    dense m = dense_zero(2 * unknowns + 2, 2 * unknowns + 2), b = dense_zero(2 * unknowns + 2, 2 * unknowns + 2);
    for (int i = 0; i < 2 * unknowns + 2; i++)
        DENSE(m, i, i) = i < unknowns ? 0 : 1, DENSE(b, i, i) = 1;
    dense right = dense_zero(2 * unknowns + 2, 1), product;
    for (int k = 0; k < n_times * channels; k++) {
        double row[unknowns];
        row_of(k / channels, k % channels, row);
        for (int i = 0; i < unknowns && !isnan(all_values[k]); i++) {
            right.at[i] += all_weights[k % channels] * row[i] * all_values[k];
            for (int j = 0; j < unknowns; j++)
                DENSE(m, i, j) += all_weights[k % channels] * row[i] * row[j];
        }
    }
    for (int k = 0; k < unknowns + 2; k++)
        if (bound->active[k]) {
            const moray_bounds *of = k < unknowns ? &bound->c[k] : &bound->e[k - unknowns];
            DENSE(m, size, size) = 0;
            for (int i = 0; i < unknowns; i++)
                DENSE(m, size, i) = DENSE(m, i, size) = k < unknowns ? i == k : of_event[k - unknowns][i];
            right.at[size++] = fabs(of->lower) < MORAY_INFINITY ? of->lower : of->upper;
        }
    dense_solve(m, b);
    product = dense_product(b, false, right, false);
    for (int i = 0; i < unknowns; i++)
        for (int j = 0; j < unknowns; j++)
            block[i * unknowns + j] = DENSE(b, i, j), all[i] = c[i] = product.at[i];
    for (int k = 0; k < n_times * channels; k++) {
        double row[unknowns], r = -all_values[k];
        row_of(k / channels, k % channels, row);
        for (int i = 0; i < unknowns; i++)
            r += row[i] * all[i];
        sum += isnan(r) ? 0 : all_weights[k % channels] * r * r;
    }
    dense_free(&m), dense_free(&b), dense_free(&right), dense_free(&product);
    return sum;
}

// Behind a phase whose data count for nothing, but as events that ask nothing.
static moray_ocp *line_within(const struct bound *bound)
{
    static const double other_time[] = {0.5, 0.25}, other_value[] = {3, 4};
    const moray_bounds one[] = {moray_fixed(1)};
    const moray_phase_spec phase[] = {
        {.name = "before",
         .nx = 1,
         .continuous = stay,
         .tf = moray_fixed(1),
         .x0 = MORAY_BOUNDS_OF(one),
         .observed =
             {.n = 2, .ny = 1, .time = other_time, .value = other_value, .observe = see_state, .events_only = true}},
        {.name = "line",
         .nx = 1,
         .continuous = grow,
         .tf = moray_fixed(2),
         .x0 = {bound->c, 1},
         .observed = {.n = n_times,
                      .ny = channels,
                      .time = all_times,
                      .value = all_values,
                      .weight = all_weights,
                      .observe = see_line}}};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "linear",
                                                   .phases = 2,
                                                   .phase = phase,
                                                   .ns = 3,
                                                   .ne = 2,
                                                   .s = {bound->c + 1, 3},
                                                   .e = {bound->e, 2},
                                                   .endpoint = event_of}),
             bound->what);
    return ocp;
}

static moray_solution *solve_line(const moray_ocp *ocp)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "gauss3", settings.intervals = 3, settings.tolerance = 1e-11;
    return solve(ocp, &settings, NULL);
}

static void check_fit(const moray_solution *solution, const struct bound *bound, bool known)
{
    double c[unknowns], block[unknowns * unknowns], worst = 0, off = 0, within = 0;
    const double sum = least_squares(bound, c, block);
    moray_fit fit;
    int free_ones = unknowns;
    for (int k = 0; k < unknowns + 2; k++)
        free_ones -= bound->active[k];
    CHECK_OK(moray_fit_new(&fit, solution, known), "fit");
    CHECK(fit.ns == 3 && fit.observations == 12 && fit.freedom == free_ones && fit.undetermined == 0,
          "%s: %d observations, %d free, %d open", bound->what, fit.observations, fit.freedom, fit.undetermined);
    CHECK(strcmp(fit.names, "") == 0, "so that none is named");
    const double variance = known ? 1 : sum / (12 - free_ones);
    CHECK_RELATIVE(fit.variance, variance, 1e-6, "variance");
    CHECK_RELATIVE(fit.sum, sum, 1e-6, "sum of squares");
    for (int i = 0; i < 3; i++) {
        const double own = sqrt(fmax(variance * block[(i + 1) * (unknowns + 1)], 0));
        const double half = moray_student_95(known ? 0 : 12 - free_ones) * own, size = i == 2 ? 500 : 1;
        off = tap_worse(off, fabs(fit.value[i] - c[i + 1]) / size);
        within = tap_worse(within, fabs(fit.lower[i] - (c[i + 1] - half)) / size);
        within = tap_worse(within, fabs(fit.upper[i] - (c[i + 1] + half)) / size);
        within = tap_worse(within, fabs(fit.error[i] - own) / size);
        for (int j = 0; j < 3; j++)
            worst = tap_worse(worst, fabs(fit.covariance[i * 3 + j] - variance * block[(i + 1) * unknowns + j + 1]) /
                                         size / (j == 2 ? 500 : 1));
    }
    CHECK(off < 1e-6, "%s: parameters as by the normal equations: %.1e", bound->what, off);
    CHECK(worst < 1e-7, "%s: covariance: %.1e", bound->what, worst);
    CHECK(within < 1e-5, "%s: errors and intervals: %.1e", bound->what, within);
    moray_fit_free(&fit);
}

#define FREE                                                                                                           \
    {                                                                                                                  \
        -MORAY_INFINITY, MORAY_INFINITY                                                                                \
    }

static void test_bounds(void)
{
    const struct bound cases[] = {
        {"nothing binds", {FREE, FREE, FREE, FREE}, {FREE, FREE}, {false}},
        {"a start that is known", {{1.5, 1.5}, FREE, FREE, FREE}, {FREE, FREE}, {true}},
        {"a parameter that is known", {FREE, FREE, {0.4, 0.4}, FREE}, {FREE, FREE}, {false, false, true}},
        {"one at its most", {FREE, {-MORAY_INFINITY, 0.7}, FREE, FREE}, {FREE, FREE}, {false, true}},
        {"one at its least", {FREE, {3, MORAY_INFINITY}, FREE, FREE}, {FREE, FREE}, {false, true}},
        {"the last at its least",
         {FREE, FREE, FREE, {2100, MORAY_INFINITY}},
         {FREE, FREE},
         {false, false, false, true}},
        {"an event at its most",
         {FREE, FREE, FREE, FREE},
         {{-MORAY_INFINITY, 1}, FREE},
         {false, false, false, false, true}},
        {"an event at its least",
         {FREE, FREE, FREE, FREE},
         {FREE, {-1, MORAY_INFINITY}},
         {false, false, false, false, false, true}},
        {"events off their bounds", {FREE, FREE, FREE, FREE}, {{-50, 50}, {-60, 70}}, {false}},
        {"two of them", {FREE, FREE, FREE, FREE}, {{1, 1}, {-1, -1}}, {false, false, false, false, true, true}},
        {"an event and a bound",
         {FREE, FREE, FREE, {2100, MORAY_INFINITY}},
         {{-MORAY_INFINITY, 1}, FREE},
         {false, false, false, true, true}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        moray_ocp *ocp = line_within(&cases[k]);
        moray_solution *solution = solve_line(ocp);
        check_fit(solution, &cases[k], false);
        check_fit(solution, &cases[k], true);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// An equation that the best line meets by itself: it has no multiplier, and leaves a direction less.
static void test_idle_equation(void)
{
    struct bound bound = {"an equation that costs nothing", {FREE, FREE, FREE, FREE}, {FREE, FREE}, {false}};
    double c[unknowns], block[unknowns * unknowns];
    least_squares(&bound, c, block);
    bound.e[0] = moray_fixed(c[1] + 2 * c[2]);
    bound.active[unknowns] = true;
    moray_ocp *ocp = line_within(&bound);
    moray_solution *solution = solve_line(ocp);
    check_fit(solution, &bound, false);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_bounds();
    test_idle_equation();
    return tap_done();
}
