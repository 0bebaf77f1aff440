// SPDX-License-Identifier: MIT
//
// moray from C++: the problem of Bryson and Denham (optimum 4 at l = 1/9) through functions of doubles and through
// functions of std::complex, and a steady swimmer.
#include <cmath>
#include <cstdio>

#include <moray/moray.h>
#include <moray/snake.h>

static int run = 0, failed = 0;

static void check(bool good, const char *what)
{
    std::printf("%sok %d - %s\n", good ? "" : "not ", ++run, what);
    failed += !good;
}

static void push_real(const moray_real_node *at, moray_real_rates *out, const void *data)
{
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->c[0] = at->x[0] - *static_cast<const double *>(data);
    out->g[0] = at->u[0] * at->u[0] / 2;
}
static void effort_real(const moray_real_ends *at, moray_real_end_values *out, const void *)
{
    out->objective = at->phase[0].q[0];
}

// The same with the functions of num.h, and one of <complex>: exp(log(u^2)) = u^2.
static void push(const moray_node *at, moray_rates *out, const void *data)
{
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->c[0] = moray_max(at->x[0], -1) - *static_cast<const double *>(data);
    out->g[0] = moray_pow(at->u[0], 2) * std::exp(-std::log(moray_num(2)));
}
static void effort(const moray_ends *at, moray_end_values *out, const void *)
{
    out->objective = at->phase[0].q[0];
}

static bool optimum_is_4(moray_ocp_spec &spec)
{
    moray_ocp *ocp = nullptr;
    moray_solution *solution = nullptr;
    moray_settings settings = moray_settings_default();
    settings.intervals = 30;
    settings.max_refinements = 10;
    moray_certificate certificate = {};
    moray_status status = moray_ocp_new(&ocp, &spec);
    if (!moray_failed(status))
        status = moray_solve(ocp, &settings, nullptr, &solution);
    if (!moray_failed(status)) {
        const moray_sim_settings sim = moray_sim_settings_default();
        const moray_integrator integrator = moray_sim_integrator(&sim);
        status = moray_certify(solution, &integrator, &certificate);
    }
    bool good = !moray_failed(status) && certificate.pass;
    if (good) {
        double x[2], u[1];
        moray_solution_at(solution, 0, 0.5, x, u);
        good = std::fabs(moray_solution_objective(solution) - 4) < 2e-6 && std::fabs(x[0] - 1.0 / 9) < 1e-5;
    }
    if (!good)
        std::printf("# %s\n", moray_failed(status) ? status.text : moray_solution_diagnosis(solution));
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return good;
}

static void bryson_denham()
{
    const double l = 1.0 / 9;
    const moray_bounds x0[] = {moray_fixed(0), moray_fixed(1)}, xf[] = {moray_fixed(0), moray_fixed(-1)};
    const moray_bounds u[] = {moray_between(-100, 100)}, c[] = {moray_at_most(0)};
    moray_phase_spec phase = {};
    phase.name = "turn";
    phase.nx = 2;
    phase.nu = phase.nc = phase.nq = 1;
    phase.t0 = moray_fixed(0);
    phase.tf = moray_fixed(1);
    phase.x0 = MORAY_BOUNDS_OF(x0);
    phase.xf = MORAY_BOUNDS_OF(xf);
    phase.u = MORAY_BOUNDS_OF(u);
    phase.c = MORAY_BOUNDS_OF(c);
    moray_ocp_spec spec = {};
    spec.name = "cplusplus";
    spec.phases = 1;
    spec.phase = &phase;
    spec.data = &l;

    phase.continuous_real = push_real;
    spec.endpoint_real = effort_real;
    check(optimum_is_4(spec), "functions of double: optimum 4, certified");
    phase.continuous_real = nullptr;
    spec.endpoint_real = nullptr;
    phase.continuous = push;
    spec.endpoint = effort;
    check(optimum_is_4(spec), "functions of std::complex: optimum 4, certified");
}

// A rotation has the eigenvalues exp(+-i angle).
static void complex_numbers()
{
    const double angle = 0.3, A[] = {std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)};
    moray_num lambda[2];
    const moray_status status = moray_eigenvalues(2, A, lambda);
    check(!moray_failed(status) && std::abs(lambda[0] - std::polar(1.0, angle)) < 1e-14, "complex numbers come back");
}

static void swimmer()
{
    const moray_robot robot = moray_robot_paper();
    const moray_orbit_spec spec = moray_orbit_spec_default(&robot, MORAY_CONTROL_ORIENTED);
    const moray_gait gait = moray_gait_paper(&robot);
    moray_orbit *orbit = nullptr;
    moray_orbit_result result;
    moray_floquet floquet;
    const bool good = !moray_failed(moray_orbit_new(&orbit, &spec)) &&
                      !moray_failed(moray_orbit_solve(orbit, &gait, &result)) &&
                      !moray_failed(moray_orbit_floquet(orbit, &floquet));
    check(good && result.steady.speed > 0.01 && std::abs(floquet.multiplier[0] - 1.0) < 1e-6,
          "a robot swims; displacements stay as they are");
    moray_orbit_free(orbit);
}

int main()
{
    bryson_denham();
    complex_numbers();
    swimmer();
    std::printf("1..%d\n", run);
    return failed != 0;
}
