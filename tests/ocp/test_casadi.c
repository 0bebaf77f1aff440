// SPDX-License-Identifier: MIT
//
// A textbook problem whose dynamics are functions of a shared object after CasADi's C convention, with all, some and no
// derivatives. Argument: the object.
#include "tap.h"

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

static void test_descent(const char *name)
{
    const moray_casadi_spec spec = {.path = object, .name = name, .n_in = 5, .probe = (double[]){1, 2, 3, 0.7, 0}};
    moray_map map;
    char why[300] = "";
    CHECK_OK(moray_map_from_casadi(&map, &spec), name);
    const double time = descend(&map, why, sizeof why);
    CHECK(fabs(time - published()) < 1e-6 * published(), "%s: certified, in %.7f s; the cycloid %.7f s %s", name, time,
          published(), why);
    moray_map_release(&map);
}

int main(int argc, char **argv)
{
    object = argc > 1 ? argv[1] : "";
    test_descent("wire");
    test_descent("half");
    test_descent("bare");
    return tap_done();
}
