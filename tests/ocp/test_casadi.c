// SPDX-License-Identifier: MIT
//
// Functions of a shared object after CasADi's C convention: derivatives, a textbook problem, errors. Argument: the
// object.
#include "tap.h"

#include <dlfcn.h>
#include <string.h>

#include "moray/casadi.h"
#include "moray/ocp.h"
#include "moray/sim.h"

static const char *object;
static const double gravity = 9.80665, across = 10, down = 5;

// From rest down a cycloid of radius r, x = r (a - sin a), y = r (1 - cos a), in the time a sqrt(r / g).
static double published(void)
{
    double low = 1e-3, high = 2 * 3.14159;
    for (int k = 0; k < 100; k++) {
        const double a = (low + high) / 2, ratio = (a - sin(a)) / (1 - cos(a));
        *(ratio < across / down ? &low : &high) = a;
    }
    return low * sqrt(down / (1 - cos(low)) / gravity);
}

static void arrive(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

// The time that is found with the dynamics of this map; NaN, and why, when there is none.
static double descend(const moray_map *map, char *why, size_t size)
{
    const moray_phase_spec phase = {.name = "wire",
                                    .nx = 3,
                                    .nu = 1,
                                    .map = map,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_between(0.1, 10),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(10), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(10), moray_fixed(5), moray_free()),
                                    .u = MORAY_BOUNDS(moray_between(0, 3.14159))};
    const moray_ocp_spec spec = {.name = "brachistochrone", .phases = 1, .phase = &phase, .endpoint = arrive};
    moray_settings settings = moray_settings_default();
    settings.max_refinements = 10;
    const moray_sim_settings sim = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim);
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    double time = NAN;
    moray_status status = moray_ocp_new(&ocp, &spec);
    if (!moray_failed(status))
        status = moray_solve(ocp, &settings, NULL, &solution);
    if (!moray_failed(status)) {
        moray_certificate certificate;
        status = moray_certify(solution, &integrator, &certificate);
        if (!moray_failed(status) && certificate.pass)
            time = moray_solution_objective(solution);
    }
    snprintf(why, size, "%s", status.text);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return time;
}

static void test_function(const char *name, double hessian_error)
{
    const moray_casadi_spec spec = {.path = object, .name = name, .n_in = 5, .probe = (double[]){1, 2, 3, 0.7, 0}};
    const double in[] = {0.3, -1.2, 2.5, 0.8, 0.1}, weight[] = {1.5, -0.7, 0.4};
    moray_map map;
    moray_derivative_report report = {0};
    char why[300] = "";
    const moray_status status = moray_map_from_casadi(&map, &spec);
    if (!CHECK(!moray_failed(status), "%s is a map: %s", name, status.text))
        return;
    CHECK(map.n_in == 5 && map.n_out == 3, "%s: %d inputs, %d outputs", name, map.n_in, map.n_out);
    CHECK(map.jac.nnz == 5, "%s: %d entries of the Jacobian, as the file has them", name, map.jac.nnz);
    CHECK(!moray_failed(moray_check_derivatives(&map, in, weight, &report)), "%s: differences can be taken", name);
    CHECK(report.jacobian_error < 1e-8, "%s: Jacobian to %.1e", name, report.jacobian_error);
    CHECK(report.hessian_error < hessian_error, "%s: Hessian to %.1e", name, report.hessian_error);
    const double time = descend(&map, why, sizeof why);
    CHECK(fabs(time - published()) < 1e-6 * published(), "%s: certified, in %.7f s; the cycloid %.7f s %s", name, time,
          published(), why);
    moray_map_release(&map);
}

static void test_places(void)
{
    const int place[] = {3, 1, 0, 2};
    const moray_casadi_spec spec = {.path = object, .name = "wire", .place = place};
    const double in[] = {2, 0, 0.5, 0};
    double out[3];
    moray_map map;
    moray_derivative_report report = {0};
    CHECK(!moray_failed(moray_map_from_casadi(&map, &spec)), "inputs in another order");
    map.value(map.self, in, out);
    CHECK(out[0] == 2 * sin(0.5), "are the same function: %g", out[0]);
    CHECK(!moray_failed(moray_check_derivatives(&map, in, out, &report)) && report.hessian_error < 1e-8 &&
              report.jacobian_error < 1e-8,
          "with its derivatives, to %.1e and %.1e", report.jacobian_error, report.hessian_error);
    moray_map_release(&map);
}

static void test_scalar(void)
{
    const moray_casadi_spec spec = {.path = object, .name = "square"};
    moray_map map;
    double out, slope;
    CHECK(!moray_failed(moray_map_from_casadi(&map, &spec)) && map.n_in == 1,
          "a function without any more: a scalar of one");
    map.value(map.self, (double[]){-3}, &out);
    map.jacobian(map.self, (double[]){-3}, &slope);
    CHECK(out == 9 && fabs(slope + 6) < 1e-8, "its value %g and slope %g", out, slope);
    map.value(map.self, (double[]){-10}, &out);
    CHECK(isnan(out), "NaN where it fails");
    moray_map_release(&map);
}

static void test_refusal(const char *path, const char *name, const int *place, moray_code code, const char *text)
{
    const moray_casadi_spec spec = {.path = path, .name = name, .place = place};
    moray_map map;
    const moray_status status = moray_map_from_casadi(&map, &spec);
    CHECK(status.code == code && strstr(status.text, text), "refused: %s", status.text);
    CHECK(!map.release, "and nothing is left");
}

int main(int argc, char **argv)
{
    object = argc > 1 ? argv[1] : "";
    test_function("wire", 1e-8);
    test_function("half", 1e-6);
    test_function("bare", 1e-4);
    test_places();
    test_scalar();
    test_refusal("/nowhere.so", "wire", NULL, MORAY_IO, "/nowhere.so: cannot be loaded");
    test_refusal(object, "wired", NULL, MORAY_INPUT, "no function wired");
    test_refusal(object, "crooked", NULL, MORAY_INPUT, "crooked_sparsity_in(0)");
    test_refusal(object, "hollow", NULL, MORAY_INPUT, "hollow_sparsity_in(0)");
    test_refusal(object, "odd", NULL, MORAY_INPUT, "result 0 of jac_odd is 3 by 1: must be 3 by 3");
    test_refusal(object, "wire", (int[]){0, 1, 1, 2}, MORAY_INPUT, "place 2 of wire is 1");
    void *kept = dlopen(object, RTLD_NOW);
    int (*balance)(void);
    *(void **)&balance = dlsym(kept, "wire_balance");
    CHECK(balance() == 0, "what was taken, held or checked out is given back: %d", balance());
    dlclose(kept);
    return tap_done();
}
