// SPDX-License-Identifier: MIT
//
// Second derivatives by differences where a function bends otherwise near a trajectory than around it.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "base/dense.h"
#include "ocp/certificate/bends.h"
#include "ocp/probe.h"

// Least integral of u^2 + D(y), x' = u from 0 to 1, y' = 0 from 0, where D'' = 2 bend (1 - exp(-(y / dip)^2)).
struct dip {
    double bend;
    bool right; // the Hessian
    int side;   // of 0 on which a plain parabola is defined, in place of the dip; its wrong Hessian is none. 0: the dip
};
static const double dip = 1e-4;

static void dip_value(void *self, const double *in, double *out)
{
    const struct dip *of = self;
    const double bend = of->bend, y = in[1], u = in[2], z = y / dip;
    out[0] = u;
    out[1] = 0;
    out[2] = u * u + bend * (y * y - dip * (y * sqrt(M_PI) * erf(z) + dip * expm1(-z * z)));
    if (of->side)
        out[2] = of->side * y < 0 ? NAN : u * u + bend * y * y;
}

static void dip_jacobian(void *self, const double *in, double *values)
{
    const struct dip *of = self;
    const double bend = of->bend, y = in[1];
    values[0] = 1;
    values[1] = 2 * in[2];
    values[2] = bend * (2 * y - (of->side ? 0 : dip * sqrt(M_PI) * erf(y / dip)));
}

static void dip_hessian(void *self, const double *in, const double *weight, double *values)
{
    const struct dip *of = self;
    const double z = in[1] / dip;
    values[0] = 2 * weight[2];
    const double around = of->side ? 0 : 1, here = of->side ? 1 : -expm1(-z * z);
    values[1] = 2 * of->bend * (of->right ? here : around) * weight[2];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void test_dip(double bend, bool right, int side)
{
    static int row[] = {0, 2, 2}, col[] = {2, 2, 1}, both[] = {2, 1};
    struct dip self = {bend, right, side};
    const moray_map map = {.n_in = 4,
                           .n_out = 3,
                           .jac = {.nnz = 3, .row = row, .col = col},
                           .hess = {.nnz = 2, .row = both, .col = both},
                           .value = dip_value,
                           .jacobian = dip_jacobian,
                           .hessian = dip_hessian,
                           .self = &self};
    const moray_phase_spec phase = {.name = "dip",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .map = &map,
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(moray_between(-2, 2), moray_between(-1, 1)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1), moray_free())};
    const moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    double bends = 0;
    char where[200] = "";
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = total}), "a dip");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_difference_bends(&w, &bends, where, sizeof where), "bends");
    if (right)
        CHECK(bends < 1e-6, "bend %g around: known to be what it is here: %.1e, %s", bend, bends, where);
    else
        CHECK(bends > MORAY_LIMIT_DIRECTIONS, "bend %g: known to be what it is not here: %.1e, %s", bend, bends, where);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- In how many directions ----

// Of the parameters: with a parabola that no derivative knows, defined (once it matters) where their product has a
// sign.
static struct {
    int a, b, sign;
    double parabola;
} part;
enum { PARAMETERS = 4 };

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

static void parabola(const moray_ends *at, moray_end_values *out, const void *data)
{
    const double a = creal(at->s[part.a]), b = creal(at->s[part.b]);
    (void)data;
    out->objective = part.sign * a * b < 0 ? NAN : part.parabola * (a * a + b * b);
    for (int k = 0; k < PARAMETERS; k++)
        out->objective += at->s[k];
}

// Of the three directions at the endpoint, those in which both parameters go the same way.
static int alike(const moray_ocp *ocp, int a, int b)
{
    const int first = moray_endpoint_inputs(ocp) - PARAMETERS;
    int count = 0;
    for (int which = 0; which < 3; which++)
        count += moray_dense_entry(first + a, MORAY_DENSE_BENDS + which) *
                     moray_dense_entry(first + b, MORAY_DENSE_BENDS + which) >
                 0;
    return count;
}

// What only one direction shows may be its own; two are believed.
static void test_directions(double much)
{
    const moray_phase_spec phase = {
        .nx = 1, .continuous = still, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    int one = 0, two = 0;
    settings.max_iterations = 0;
    part.sign = 0, part.parabola = 0;
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = PARAMETERS, .endpoint = parabola}),
        "four parameters");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    part.parabola = much;
    for (int k = 0; k < 2 * PARAMETERS * PARAMETERS; k++) {
        struct witness w;
        double bends = 0;
        char where[200] = "";
        part.a = k / 2 % PARAMETERS, part.b = k / 2 / PARAMETERS, part.sign = 0;
        const int same = alike(ocp, part.a, part.b), shown = k % 2 ? same : 3 - same;
        if (part.a >= part.b || shown == 0 || shown == 3)
            continue;
        CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
        part.sign = k % 2 ? 1 : -1;
        CHECK_OK(moray_difference_bends(&w, &bends, where, sizeof where), "bends");
        CHECK((bends > MORAY_LIMIT_DIRECTIONS) == (shown == 2), "%g in %d directions: %.1e", much, shown, bends);
        one += shown == 1, two += shown == 2;
        moray_witness_free(&w);
    }
    CHECK(one > 0 && two > 0, "%d times in one, %d times in two", one, two);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_directions(40);
    test_directions(-40);
    for (int sign = -1; sign <= 1; sign += 2) {
        test_dip(3 * sign, true, 0);
        test_dip(3 * sign, false, 0);
        test_dip(3, true, sign);
        test_dip(-3, true, sign);
        test_dip(3, false, sign);
        test_dip(-3, false, sign);
    }
    return tap_done();
}
