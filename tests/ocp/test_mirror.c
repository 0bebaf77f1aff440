// SPDX-License-Identifier: MIT
//
// A problem does not know which way its axes point. With any of its states, controls, parameters, path constraints,
// integrals and events counted the other way it takes the same steps to the same answer, and its certificate says the
// same: whatever looks at a size must look at its modulus.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "rk4.h"

// A cart on a rough slope that is steeper where it is far out: from rest at 0.3 to rest at -1.1 under a limited thrust
// and speed, quickly and with little work; the slope is as steep as it is chosen, in
// ten-thousandths.
enum { PLACE, SPEED, THRUST, STEEP, FAST, WORK, AT_REST, AXES };
typedef struct axes {
    double sign[AXES];
} axes;

static void roll(const moray_node *at, moray_rates *out, const void *data)
{
    const double *sign = ((const axes *)data)->sign;
    const moray_num x = sign[PLACE] * at->x[0], v = sign[SPEED] * at->x[1], u = sign[THRUST] * at->u[0],
                    steep = 1e-4 * sign[STEEP] * at->s[0];
    out->f[0] = sign[PLACE] * v;
    out->f[1] = sign[SPEED] * (u - 0.3 * v - (steep + 0.4 * x) * x);
    out->c[0] = sign[FAST] * (v + 0.1 * u);
    out->g[0] = sign[WORK] * (u * u + 0.05 * v * v);
}

static void arrive(const moray_ends *at, moray_end_values *out, const void *data)
{
    const double *sign = ((const axes *)data)->sign;
    const moray_num steep = 1e-4 * sign[STEEP] * at->s[0];
    out->objective = at->phase[0].tf + 0.2 * sign[WORK] * at->phase[0].q[0] + 0.3 * (steep + 0.6) * (steep + 0.6);
    out->e[0] = sign[AT_REST] * (at->phase[0].xf[1] * sign[SPEED] + 0.01 * at->phase[0].xf[0] * sign[PLACE] + 0.011);
}

static moray_bounds along(double sign, double lower, double upper)
{
    return sign > 0 ? moray_between(lower, upper) : moray_between(-upper, -lower);
}

typedef struct answer {
    double objective, place;
    int iterations, meshes;
    moray_certificate certificate;
} answer;

static const int steps = 40;
static const moray_integrator rk4 = {rk4_run, &steps};

static answer solve(const axes *turned, const char *scheme)
{
    const double *sign = turned->sign;
    const moray_phase_spec cart = {.name = "cart",
                                   .nx = 2,
                                   .nu = 1,
                                   .nc = 1,
                                   .nq = 1,
                                   .continuous = roll,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_between(0.5, 9),
                                   .x = MORAY_BOUNDS(moray_free(), along(sign[SPEED], -3, 0.5)),
                                   .x0 = MORAY_BOUNDS(moray_fixed(sign[PLACE] * 0.3), moray_fixed(0)),
                                   .xf = MORAY_BOUNDS(moray_fixed(sign[PLACE] * -1.1), along(sign[SPEED], -0.2, 0.4)),
                                   .u = MORAY_BOUNDS(along(sign[THRUST], -2.5, 1.5)),
                                   .c = MORAY_BOUNDS(along(sign[FAST], -0.9, MORAY_INFINITY))};
    const moray_ocp_spec spec = {.name = "cart",
                                 .phases = 1,
                                 .phase = &cart,
                                 .ns = 1,
                                 .ne = 1,
                                 .s = MORAY_BOUNDS(moray_free()),
                                 .e = MORAY_BOUNDS(moray_fixed(0)),
                                 .endpoint = arrive,
                                 .data = turned};
    const double time[] = {0, 1, 3},
                 x[] = {sign[PLACE] * 0.3, 0, sign[PLACE] * -0.2, sign[SPEED] * -0.8, sign[PLACE] * -1.1, 0},
                 u[] = {sign[THRUST] * -1.2, sign[THRUST] * -0.1, sign[THRUST] * 1}, s[] = {sign[STEEP] * -9e3};
    const moray_samples samples = {3, time, x, u};
    const moray_guess guess = {.phase = &samples, .s = s};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    moray_ocp *ocp = NULL;
    answer found = {0};
    settings.scheme = scheme;
    settings.intervals = 12;
    settings.max_refinements = 20;
    CHECK_OK(moray_ocp_new(&ocp, &spec), scheme);
    CHECK_OK(moray_solve(ocp, &settings, &guess, &solution), scheme);
    if (solution) {
        double end[2];
        CHECK_OK(moray_certify(solution, &rk4, &found.certificate), scheme);
        found.objective = moray_solution_objective(solution);
        found.iterations = moray_solution_info(solution)->iterations;
        moray_solution_history(solution, &found.meshes);
        moray_solution_at(solution, 0, 1, end, NULL);
        found.place = sign[PLACE] * end[0];
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return found;
}

// little: what rounding leaves of it.
static void check_number(double one, double other, double little, const char *what, const char *scheme, int turned)
{
    const double most = 1e-6 * fmax(fabs(one), fabs(other)) + little;
    CHECK((isnan(one) && isnan(other)) || fabs(one - other) <= most, "%s, axes turned %x: %s %.3e, and %.3e", scheme,
          (unsigned)turned, what, one, other);
}

static void test_mirror(const char *scheme)
{
    const axes as_it_is = {{1, 1, 1, 1, 1, 1, 1}};
    const answer one = solve(&as_it_is, scheme);
    CHECK(one.certificate.pass, "%s: %s", scheme, one.certificate.why);
    for (int k = 0; k < AXES + 2; k++) {
        const int turned = k < AXES ? 1 << k : k == AXES ? 0x7f : 0x2d; // one of them, all, some
        axes other = as_it_is;
        for (int i = 0; i < AXES; i++)
            other.sign[i] = turned >> i & 1 ? -1 : 1;
        const answer found = solve(&other, scheme);
        const moray_certificate *a = &one.certificate, *b = &found.certificate;
        CHECK(found.iterations == one.iterations && found.meshes == one.meshes,
              "%s, axes turned %x: %d iterations, %d meshes, not %d and %d", scheme, (unsigned)turned, found.iterations,
              found.meshes, one.iterations, one.meshes);
        CHECK(fabs(found.objective - one.objective) < 1e-12 && fabs(found.place - one.place) < 1e-10,
              "%s, axes turned %x: objective %.15g, not %.15g", scheme, (unsigned)turned, found.objective,
              one.objective);
        check_number(a->kkt, b->kkt, 1e-12, "KKT", scheme, turned);
        check_number(a->mesh_error, b->mesh_error, 1e-12, "mesh error", scheme, turned);
        check_number(a->between_nodes, b->between_nodes, 1e-12, "between nodes", scheme, turned);
        check_number(a->resimulation, b->resimulation, 1e-12, "re-simulation", scheme, turned);
        check_number(a->gap, b->gap, 1e-12, "gap", scheme, turned);
        check_number(a->curvature, b->curvature, 1e-12, "curvature", scheme, turned);
        check_number(a->unseen, b->unseen, 1e-9, "unseen", scheme, turned);
        check_number(a->hamiltonian, b->hamiltonian, 1e-12, "Hamiltonian", scheme, turned);
    }
}

int main(void)
{
    test_mirror("hermite-simpson");
    test_mirror("radau3");
    test_mirror("lobatto5");
    return tap_done();
}
