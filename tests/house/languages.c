// SPDX-License-Identifier: MIT
//
// A user's problem with moray_atan2 and moray_pow, in the least of the languages that moray's headers serve: C99
// without extensions. The shortest way by the angle: minimise the integral of theta^2 + |r|^1.5 / 10 of a point that
// goes from (1, 1) to (1, -1) in 2 s at a free speed, whose derivatives are checked against differences.
#include <complex.h>
#include <math.h>
#include <stdio.h>

#include <moray/moray.h>

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num x = at->x[0], y = at->x[1], theta = moray_atan2(y, x), r = moray_hypot(x, y);
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = at->u[1];
    out->g[0] = moray_pow(theta, 2) + moray_pow(r, 1.5) / 10 + moray_pow(at->u[0], 2) + moray_pow(at->u[1], 2);
}

static void cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static int solve(const moray_ocp *ocp)
{
    const moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    moray_ocp_derivative_report report = {1, 1, "", ""};
    moray_status status = moray_ocp_check_derivatives(ocp, &report);
    if (!moray_failed(status))
        status = moray_solve(ocp, &settings, NULL, &solution);
    const int solved = !moray_failed(status) && moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED;
    const int right = report.jacobian_error < 1e-6 && report.hessian_error < 1e-4;
    if (!right || !solved)
        printf("%s\n%s\n%s\n", status.text, report.jacobian, report.hessian);
    moray_solution_free(solution);
    return right && solved;
}

// Where the complex numbers of two parts could go wrong: infinities, zeros with a sign, powers at and below zero.
static int numbers(void)
{
    const moray_num z = moray_complex(INFINITY, NAN), zero = moray_complex(0, 1e-30);
    return isinf(moray_real(z)) && isnan(moray_imag(z)) && signbit(moray_imag(moray_complex(0, -0.0))) &&
           moray_real(moray_pow(zero, 0)) == 1 && moray_imag(moray_pow(zero, 0)) == 0 &&
           moray_imag(moray_pow(zero, 1)) == 1e-30 && moray_imag(moray_pow(zero, 2)) == 0 &&
           fabs(moray_real(moray_pow(moray_complex(-2, 0), 3)) + 8) < 1e-14 &&
           isnan(moray_imag(moray_pow(moray_complex(NAN, 0), 1.5))) &&
           fabs(moray_imag(moray_atan2(moray_complex(1, 1e-30), 2)) - 0.4e-30) < 1e-44;
}

int main(void)
{
    const moray_bounds x0[] = {{1, 1}, {1, 1}}, xf[] = {{1, 1}, {-1, -1}}, u[] = {{-9, 9}, {-9, 9}};
    moray_phase_spec phase = {.name = "go", .nx = 2, .nu = 2, .nq = 1, .continuous = go, .t0 = {0, 0}, .tf = {2, 2}};
    phase.x0 = MORAY_BOUNDS_OF(x0);
    phase.xf = MORAY_BOUNDS_OF(xf);
    phase.u = MORAY_BOUNDS_OF(u);
    const moray_ocp_spec spec = {.name = "languages", .phases = 1, .phase = &phase, .endpoint = cost};
    moray_ocp *ocp = NULL;
    const int good = !moray_failed(moray_ocp_new(&ocp, &spec)) && solve(ocp);
    moray_ocp_free(ocp);
    return good && numbers() ? 0 : 1;
}
