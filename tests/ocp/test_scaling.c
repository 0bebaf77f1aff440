// SPDX-License-Identifier: MIT
//
// A problem has the same optimum in whatever units it is written.
#include "tap.h"

#include <stdlib.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "ocp/solution.h"
#include "ocp/solve_again.h"
#include "rk4.h"

static const int rk4_steps = 40;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

// What a metre, a second and a kilogram are in the units of a problem.
struct units {
    const char *name;
    double m, s, kg;
    bool tiny; // numbers far below 1, which the solver's tolerance does not see: the certificate must
};
static const struct units si = {"m, s, kg", 1, 1, 1, false};
static const struct units others[] = {{"mm, ms, g", 1e3, 1e3, 1e3, false},
                                      {"km, h, t", 1e-3, 1 / 3600., 1e-3, false},
                                      {"um, us, mg", 1e6, 1e6, 1e6, false},
                                      {"Mm, days, kt", 1e-6, 1 / 86400., 1e-6, true}};
enum { count = sizeof others / sizeof *others };

static double force(const struct units *in)
{
    return in->kg * in->m / (in->s * in->s);
}

static double energy(const struct units *in)
{
    return force(in) * in->m;
}

// ---- A sledge with drag and a limited power, over a distance with the least work and time; its mass has a price ----

static void slide(const moray_node *at, moray_rates *out, const void *data)
{
    const struct units *in = data;
    const double drag = 0.3 * in->kg / in->m;
    const moray_num v = at->x[1], thrust = at->u[0];
    out->f[0] = v;
    out->f[1] = (thrust - drag * v * v) / at->s[0];
    out->c[0] = thrust * v;
    out->g[0] = thrust * thrust / (2 * in->kg / in->s); // losses of the motor
}

static void arrive(const moray_ends *at, moray_end_values *out, const void *data)
{
    const struct units *in = data;
    const moray_phase_ends *end = &at->phase[0];
    const double price = 40 * energy(in) / in->s, worth = 900 * energy(in) * in->kg;
    out->objective = end->q[0] + price * end->tf + worth / at->s[0];
    out->e[0] = at->s[0] * end->xf[1] * end->xf[1] / 2; // left when it arrives
}

static moray_ocp *sledge(const struct units *in)
{
    const double speed = in->m / in->s, power = energy(in) / in->s;
    const moray_phase_spec phase = {.name = "track",
                                    .nx = 2,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = slide,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_between(2 * in->s, 100 * in->s),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0.1 * speed)),
                                    .xf = MORAY_BOUNDS(moray_fixed(50 * in->m), moray_free()),
                                    .u = MORAY_BOUNDS(moray_between(-20 * force(in), 30 * force(in))),
                                    .c = MORAY_BOUNDS(moray_at_most(100 * power))};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "sledge",
                                                   .phases = 1,
                                                   .phase = &phase,
                                                   .ns = 1,
                                                   .s = MORAY_BOUNDS(moray_between(5 * in->kg, 50 * in->kg)),
                                                   .ne = 1,
                                                   .e = MORAY_BOUNDS(moray_at_most(10 * energy(in))),
                                                   .endpoint = arrive,
                                                   .data = in}),
             "sledge");
    return ocp;
}

// ---- In all units ----

struct found {
    bool solved;
    double objective; // in J
    int iterations;
    moray_certificate certificate;
};

static struct found solve(const struct units *in)
{
    moray_ocp *ocp = sledge(in);
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 200;
    moray_solution *solution = NULL;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), in->name);
    const moray_nlp_info *info = moray_solution_info(solution);
    struct found found = {
        info->outcome == MORAY_NLP_SOLVED, moray_solution_objective(solution) / energy(in), info->iterations, {0}};
    CHECK_OK(moray_certify(solution, &rk4, &found.certificate), "certificate");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return found;
}

// ---- Rows that are no defects: divided by their largest slope ----

static void level(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
}

static void ends_of(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
    out->e[0] = 40 * at->phase[0].xf[0];
    out->e[1] = 0.25 * at->phase[0].xf[0];
    out->e[2] = 3 * at->phase[0].xf[0] * at->phase[0].xf[0];
}

static void test_rows(void)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .continuous = level,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(moray_between(-1, 1)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1))};
    moray_ocp *ocp;
    moray_solution *solution;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                   .phase = &phase,
                                                   .endpoint = ends_of,
                                                   .ne = 3,
                                                   .e = MORAY_BOUNDS(moray_between(-30, 30), moray_between(-9, 9),
                                                                     moray_between(-9, 9))}),
             "rows");
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 1;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    const struct transcription *t = solution->transcription;
    CHECK_NEAR(t->nlp.g_scale[t->layout.events], 1 / 40., 1e-12, "a slope of 40");
    CHECK_NEAR(t->nlp.g_scale[t->layout.events + 1], 4, 1e-12, "a slope of 1/4, in any units");
    CHECK_NEAR(t->nlp.g_scale[t->layout.events + 2], 1, 1e-12, "none at the guess");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Parameters and times: by their boxes, else by the guess, a time from the other end of its phase ----

static void nothing_of(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static void test_parameters(void)
{
    static const double guess[] = {-250, 250, -0.5, 0.5, 0, 1, -3};
    static const double size[] = {250, 250, 8, 9, 1, 1, 3};
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .continuous = level,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1))};
    moray_ocp *ocp;
    moray_solution *solution;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 1;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                   .phase = &phase,
                                                   .endpoint = nothing_of,
                                                   .ns = 7,
                                                   .s = MORAY_BOUNDS(moray_free(), moray_free(), moray_between(-8, 2),
                                                                     moray_between(-8, 9), moray_free(),
                                                                     moray_between(0, 1), moray_at_most(-1))}),
             "parameters");
    CHECK_OK(moray_solve(ocp, &settings, &(moray_guess){.s = guess}, &solution), "begun");
    const struct transcription *t = solution->transcription;
    for (int k = 0; k < 7; k++)
        CHECK_NEAR(t->nlp.x_scale[t->layout.s + k] * size[k], 1, 1e-12, "a parameter's box, else its guess, else 1");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- The objective: divided by its largest slope, as far as a factor of 1e12 either way ----

static void slope_of(const moray_ends *at, moray_end_values *out, const void *data)
{
    out->objective = *(const double *)data * at->phase[0].xf[0];
}

static void test_objective(void)
{
    static const double slopes[] = {1, 40, 3e11, 1e14, 1e-3, 2e-11, 1e-14};
    static const double scales[] = {1, 1 / 40., 1 / 3e11, 1e-12, 1e3, 0.5e11, 1e12};
    for (unsigned k = 0; k < sizeof slopes / sizeof *slopes; k++) {
        const moray_phase_spec phase = {.nx = 1,
                                        .nu = 1,
                                        .continuous = level,
                                        .t0 = moray_fixed(0),
                                        .tf = moray_fixed(1),
                                        .x = MORAY_BOUNDS(moray_between(-1, 1)),
                                        .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                        .u = MORAY_BOUNDS(moray_between(-1, 1))};
        moray_ocp *ocp;
        moray_solution *solution;
        moray_settings settings = moray_settings_default();
        settings.max_iterations = 1;
        CHECK_OK(moray_ocp_new(
                     &ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = slope_of, .data = &slopes[k]}),
                 "an objective");
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
        const double scale = solution->transcription->nlp.f_scale;
        CHECK(fabs(scale / scales[k] - 1) < 1e-12, "a slope of %g has the scale %g: %g", slopes[k], scales[k], scale);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// ---- Integrals: by their guess, but where that is next to nothing of what they may come to ----

struct effort {
    double unit, idle; // of the effort, and what is spent without any, of a unit
};

static void spend(const moray_node *at, moray_rates *out, const void *data)
{
    const struct effort *effort = data;
    out->f[0] = at->u[0];
    out->g[0] = effort->unit * (at->u[0] * at->u[0] + effort->idle);
}

static void spent(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

// The scale of the integral, in the unit of the effort, at a guess that is the middle of the control's bounds.
static double scale_of(struct effort effort, double lowest)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = spend,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(moray_between(-5, 5)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(lowest, 3))};
    moray_ocp *ocp;
    moray_solution *solution;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = spent, .data = &effort}),
             "an integral");
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 1;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    const struct transcription *t = solution->transcription;
    const double scale = effort.unit * t->nlp.x_scale[t->layout.phase[0].q];
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return scale;
}

static void test_integrals(void)
{
    static const double units[] = {1, 1e-9, 1e9};
    for (int k = 0; k < 3; k++) {
        CHECK_RELATIVE(scale_of((struct effort){units[k], 0}, 1), 1 / 4., 1e-9, "that of its guess, in any unit");
        CHECK_RELATIVE(scale_of((struct effort){units[k], 1e-8}, -3), 1 / 9., 1e-6, "at rest, of what it may come to");
    }
}

// Thousands of bounds of which each holds a little back, and rows with a bound on one side alone.
static void dose(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->c[0] = at->x[0] + at->u[0];
    out->g[0] = at->u[0] * at->u[0] + 2 - at->u[0];
}

static moray_solution *solve_doses(moray_ocp **ocp, const moray_settings *settings)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .nc = 1,
                                    .continuous = dose,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(0, 0.25)),
                                    .c = MORAY_BOUNDS(moray_at_least(-1))};
    moray_solution *solution;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = spent}), "problem");
    CHECK_OK(moray_solve(*ocp, settings, NULL, &solution), "solve");
    return solution;
}

static void test_many_bounds(void)
{
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp;
    moray_certificate c;
    settings.intervals = 2000;
    settings.tolerance = 5e-7;
    moray_solution *solution = solve_doses(&ocp, &settings);
    CHECK_OK(moray_certify(solution, &rk4, &c), "certificate");
    CHECK(c.gap < MORAY_LIMIT_GAP, "what the barrier leaves at all of them adds up to %.1e of the objective", c.gap);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static bool follows(double after, double before)
{
    return after >= before && after < before + 900;
}

// What was spent before has what was spent again added to it.
static void check_spent(const moray_nlp_info *before, const moray_nlp_info *after)
{
    CHECK(follows(after->seconds, before->seconds) && follows(after->cpu_seconds, before->cpu_seconds) &&
              follows(after->evaluation_seconds, before->evaluation_seconds) &&
              follows(after->linear_seconds, before->linear_seconds),
          "seconds add up: %g, %g, %g, %g", after->seconds, after->cpu_seconds, after->evaluation_seconds,
          after->linear_seconds);
    for (int k = 0; k < 5; k++)
        CHECK(follows(after->evaluations[k], before->evaluations[k]) &&
                  follows(after->evaluation_by[k], before->evaluation_by[k]),
              "and so do evaluations: %d in %g s", after->evaluations[k], after->evaluation_by[k]);
}

// A solution in which a multiplier of 1 times the slack of its row is as much of the objective as the certificate
// allows: in a row of the dynamics, which are equations, or of a path constraint. *more: the iterations that follow.
static void solve_with_gap(bool equation, int *more)
{
    const moray_settings settings = moray_settings_default();
    moray_ocp *ocp;
    moray_solution *solution = solve_doses(&ocp, &settings);
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    const int row = equation ? layout->interval[0].defect : layout->node[1].path, first = solution->info.iterations;
    solution->iterate.lambda[row] = -1;
    solution->iterate.g[row] =
        solution->transcription->nlp.g_lower[row] + MORAY_LIMIT_GAP * fabs(solution->iterate.objective);
    const moray_nlp_info before = {.seconds = 1000,
                                   .cpu_seconds = 2000,
                                   .evaluation_seconds = 3000,
                                   .linear_seconds = 4000,
                                   .evaluations = {10000, 20000, 30000, 40000, 50000},
                                   .evaluation_by = {5000, 6000, 7000, 8000, 9000},
                                   .outcome = solution->info.outcome,
                                   .iterations = first};
    solution->info = before;
    CHECK_OK(moray_solve_again(solution), "again where the solver stopped well inside");
    *more = solution->info.iterations - first;
    check_spent(&before, &solution->info);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_equations_have_no_inside(void)
{
    int more;
    solve_with_gap(false, &more);
    CHECK(more > 0, "well inside a limit it is solved again: %d iterations", more);
    solve_with_gap(true, &more);
    CHECK(more == 0, "what is left of an equation is no room inside it: %d iterations", more);
}

int main(void)
{
    test_equations_have_no_inside();
    test_rows();
    test_parameters();
    test_objective();
    test_integrals();
    test_many_bounds();
    const struct found reference = solve(&si);
    CHECK(reference.solved, "in %s: optimum %.9g after %d iterations", si.name, reference.objective,
          reference.iterations);
    for (int k = 0; k < count; k++) {
        const struct found found = solve(&others[k]);
        const moray_certificate *c = &found.certificate, *same = &reference.certificate;
        const bool optimal = c->kkt <= MORAY_LIMIT_KKT && c->gap <= MORAY_LIMIT_GAP && c->curvature == 0;
        const bool right = found.solved && fabs(found.objective / reference.objective - 1) < 1e-7;
        CHECK(right || others[k].tiny, "in %s: the same optimum, %.10g, after %d iterations", others[k].name,
              found.objective, found.iterations);
        CHECK(right == optimal, "in %s: which has no unit: KKT %.1e, gap %.1e", others[k].name, c->kkt, c->gap);
        if (right)
            CHECK_RELATIVE(c->hamiltonian, same->hamiltonian, 1e-4, "the same drift of the Hamiltonian");
    }
    return tap_done();
}
