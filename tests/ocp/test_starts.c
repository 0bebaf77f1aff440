// SPDX-License-Identifier: MIT
//
// Problems as they are brought, without a guess: the bounds leave a start that is far off, or that leads nowhere.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "rk4.h"

static const int rk4_steps = 30;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

static void first_integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

// Solved, certified, and with the optimum; says so of the diagnosis, too, where `told` is not NULL.
static void check(const moray_ocp_spec *spec, double optimum, const char *told)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_certificate c = {0};
    moray_settings settings = moray_settings_default();
    settings.max_refinements = 10;
    CHECK_OK(moray_ocp_new(&ocp, spec), spec->name);
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), spec->name);
    if (solution) {
        const char *diagnosis = moray_solution_diagnosis(solution);
        CHECK_OK(moray_certify(solution, &rk4, &c), spec->name);
        CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "%s: %s", spec->name, diagnosis);
        CHECK_NEAR(moray_solution_objective(solution), optimum, 1e-6 * fabs(optimum), spec->name);
        CHECK(c.pass, "%s: %s", spec->name, c.why);
        CHECK(!told || strstr(diagnosis, told) != NULL, "%s is told: %s", spec->name, diagnosis);
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Rest to rest over 1000 m, integral of 1 + u^2, any final time and any u: nothing tells how long that lasts.
//      u = 6 d / T^2 (1 - 2 t / T), J = T + 12 d^2 / T^3, least at T^4 = 36 d^2 ----

static void haul(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = 1 + at->u[0] * at->u[0];
}

static void test_endless(void)
{
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = haul,
                                    .tf = moray_at_least(0),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1000), moray_fixed(0))};
    check(
        &(moray_ocp_spec){
            .name = "any final time, any control", .phases = 1, .phase = &phase, .endpoint = first_integral},
        4 * sqrt(6000) / 3, NULL);
}

// ---- A tank that is never empty: (x^2 / 2)' = u, least of u^2 and most of x^2 / 2. u = 1/2, J = -3/4 ----

static void fill(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] / at->x[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void fullest(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_num x = at->phase[0].xf[0];
    (void)data;
    out->objective = at->phase[0].q[0] - x * x / 2;
}

static void test_one_sided(void)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = fill,
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(moray_at_least(0)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1)),
                                    .u = MORAY_BOUNDS(moray_between(-8, 8))};
    check(
        &(moray_ocp_spec){
            .name = "an end of which a limit is all that is known", .phases = 1, .phase = &phase, .endpoint = fullest},
        -0.75, NULL);
}

// ---- A ball that is dropped from 1 m, leaves the ground with 0.8 of its speed, and is helped up to 1 m again, in any
//      two times, which from a straight guess shrink to nothing. The optimum was found with flights of 0.1 s or more
//      ----

static void fly(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] - 9.81;
    out->g[0] = at->u[0] * at->u[0];
}

static void bounce(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_phase_ends *down = &at->phase[0], *up = &at->phase[1];
    (void)data;
    out->objective = down->q[0] + up->q[0];
    out->e[0] = down->tf - up->t0;
    out->e[1] = up->x0[1] + 0.8 * down->xf[1];
}

static void test_bounce(void)
{
    const moray_bounds air[] = {moray_at_least(0), moray_free()}, top[] = {moray_fixed(1), moray_fixed(0)},
                       ground[] = {moray_fixed(0), moray_free()};
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.name = p == 0 ? "down" : "up",
                                      .nx = 2,
                                      .nu = 1,
                                      .nq = 1,
                                      .continuous = fly,
                                      .t0 = p == 0 ? moray_fixed(0) : moray_at_least(0),
                                      .tf = moray_at_least(0),
                                      .x = MORAY_BOUNDS_OF(air),
                                      .x0 = p == 0 ? MORAY_BOUNDS_OF(top) : MORAY_BOUNDS_OF(ground),
                                      .xf = p == 0 ? MORAY_BOUNDS_OF(ground) : MORAY_BOUNDS_OF(top)};
    check(&(moray_ocp_spec){.name = "two flights without a limit of time",
                            .phases = 2,
                            .phase = phase,
                            .endpoint = bounce,
                            .ne = 2,
                            .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0))},
          3.14622155, NULL);
}

// ---- A spin turned by 3 rad: on a straight guess along the axis to the other side no u moves it along that axis. u =
// 3,
//      J = 9 ----

static void turn(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->u[0] * at->x[1];
    out->f[1] = at->u[0] * at->x[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void test_symmetry(void)
{
    const double end = 3; // rad
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = turn,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(cos(end)), moray_free()),
                                    .u = MORAY_BOUNDS(moray_between(-20, 20))};
    check(&(moray_ocp_spec){.name = "a start from which no control moves anything",
                            .phases = 1,
                            .phase = &phase,
                            .endpoint = first_integral},
          end * end, NULL);
}

// ---- A pendulum with its rod's equation differentiated once: index 2, which Hermite-Simpson does not hold. In angles
//      it is a = 9.81 sin + u, from the side to rest below ----

static void swing(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num x = at->x[0], y = at->x[1], v = at->x[2], w = at->x[3], force = at->u[0], u = at->u[1];
    (void)data;
    out->f[0] = v;
    out->f[1] = w;
    out->f[2] = -force * x - u * y;
    out->f[3] = -9.81 - force * y + u * x;
    out->c[0] = x * v + y * w;
    out->g[0] = u * u;
}

static void turn_down(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] - 9.81 * sin(at->x[0]);
    out->g[0] = at->u[0] * at->u[0];
}

static double optimum_in_angles(void)
{
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = turn_down,
                                    .tf = moray_fixed(3),
                                    .x0 = MORAY_BOUNDS(moray_fixed(acos(-1.0) / 2), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0))};
    const moray_ocp_spec spec = {.name = "angles", .phases = 1, .phase = &phase, .endpoint = first_integral};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_refinements = 10;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "angles");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "angles");
    const double optimum = moray_solution_objective(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return optimum;
}

static void test_higher_index(void)
{
    const moray_phase_spec phase = {
        .name = "rod",
        .nx = 4,
        .nu = 2,
        .nc = 1,
        .nq = 1,
        .continuous = swing,
        .tf = moray_fixed(3),
        .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0), moray_fixed(0), moray_fixed(0)),
        .xf = MORAY_BOUNDS(moray_fixed(0), moray_between(-2, 0), moray_fixed(0), moray_free()),
        .c = MORAY_BOUNDS(moray_fixed(0))};
    check(&(moray_ocp_spec){.name = "index 2", .phases = 1, .phase = &phase, .endpoint = first_integral},
          optimum_in_angles(), "The path constraint c[0] of phase rod is an equation in which no control stands");
}

// ---- A nutrient that is taken up at half speed at 1e-4, in a box of 25 or of 3e-4: the solver's scales must not be
// those
//      of the wide box, nor the steps by which the certificate asks ----

static void feed(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] - at->x[0] / (1e-4 + at->x[0]);
    out->g[0] = at->u[0] * at->u[0];
}

static void test_wide_box(void)
{
    static const double wide[] = {3e-4, 25};
    for (int k = 0; k < 2; k++) {
        const moray_phase_spec phase = {.nx = 1,
                                        .nu = 1,
                                        .nq = 1,
                                        .continuous = feed,
                                        .tf = moray_fixed(1e-3),
                                        .x = MORAY_BOUNDS(moray_between(0, wide[k])),
                                        .x0 = MORAY_BOUNDS(moray_fixed(1e-5)),
                                        .xf = MORAY_BOUNDS(moray_at_least(2e-4)),
                                        .u = MORAY_BOUNDS(moray_between(0, 2))};
        check(
            &(moray_ocp_spec){
                .name = k ? "a wide box" : "a box that fits", .phases = 1, .phase = &phase, .endpoint = first_integral},
            3.605256e-4, NULL);
    }
}

// ---- Most utility of 1e12 that bears 5 % a year and is spent in 50 years, at a discount of 3 %: what is spent grows
// by
//      2 % a year. Rounding in the fortune is more than 1e-4 in its units ----

static void spend(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0.05 * at->x[0] - at->u[0];
    out->g[0] = -exp(-0.03 * at->t) * log(at->u[0]);
}

static void test_fortune(void)
{
    const double all = 1 - exp(-1.5), first = 0.03 * 1e12 / all;
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = spend,
                                    .tf = moray_fixed(50),
                                    .x = MORAY_BOUNDS(moray_at_least(0)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1e12)),
                                    .u = MORAY_BOUNDS(moray_at_least(1e6))};
    check(&(moray_ocp_spec){.name = "a fortune", .phases = 1, .phase = &phase, .endpoint = first_integral},
          -(log(first) * all / 0.03 + 0.02 / 0.0009 * (1 - exp(-1.5) * 2.5)), NULL);
}

// ---- Nothing bounds the final time, but a state that always moves by 2 a unit of time has a way of 10 ----

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = 2 + 0 * at->x[0];
    out->g[0] = 1e-6 * at->u[0] * at->u[0];
}

static bool stop_at_once(void *observer, const moray_progress *progress)
{
    (void)observer, (void)progress;
    return false;
}

static void test_start_by_pace(void)
{
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = drift,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_at_least(0),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_free(), moray_fixed(10)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1))};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    double t0, tf;
    settings.scheme = "radau3";
    settings.progress = stop_at_once;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = first_integral}), "drift");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "stopped at the start");
    moray_solution_times(solution, 0, &t0, &tf);
    CHECK(tf >= 5 && tf < 10, "the start lasts as long as the way does, if in round numbers: %g", tf);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_start_by_pace();
    test_fortune();
    test_wide_box();
    test_endless();
    test_one_sided();
    test_bounce();
    test_symmetry();
    test_higher_index();
    return tap_done();
}
