// SPDX-License-Identifier: MIT
//
// Functions of a shared object after CasADi's C convention: values, derivatives, errors. Argument: the object.
#include "tap.h"

#include <dlfcn.h>
#include <string.h>

#include "moray/casadi.h"

static const char *object;

static void test_function(const char *name, double hessian_error)
{
    const moray_casadi_spec spec = {.path = object, .name = name, .n_in = 5, .probe = (double[]){1, 2, 3, 0.7, 0}};
    const double in[] = {0.3, -1.2, 2.5, 0.8, 0.1}, weight[] = {1.5, -0.7, 0.4};
    moray_map map;
    moray_derivative_report report = {0};
    const moray_status status = moray_map_from_casadi(&map, &spec);
    if (!CHECK(!moray_failed(status), "%s is a map: %s", name, status.text))
        return;
    CHECK(map.n_in == 5 && map.n_out == 3, "%s: %d inputs, %d outputs", name, map.n_in, map.n_out);
    CHECK(map.jac.nnz == 5, "%s: %d entries of the Jacobian, as the file has them", name, map.jac.nnz);
    CHECK(!moray_failed(moray_check_derivatives(&map, in, weight, &report)), "%s: differences can be taken", name);
    CHECK(report.jacobian_error < 1e-8, "%s: Jacobian to %.1e", name, report.jacobian_error);
    CHECK(report.hessian_error < hessian_error, "%s: Hessian to %.1e", name, report.hessian_error);
    moray_map_release(&map);
}

static void test_places(void)
{
    const int order[] = {3, 1, 0, 2};
    const moray_casadi_spec spec = {.path = object, .name = "wire", .place = order};
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

enum { INPUTS = 10, RESULTS = 9 };
static const int places[] = {6, 1, 2, 5, 3, 0, 8, 7};

// Arguments a, 2 by 2 of which the diagonal is there, b and c; of the second result, 3 by 2, but row 1 of column 0.
static void couple(const double *in, double *out)
{
    const double a00 = in[6], a11 = in[5], b[] = {in[3], in[0], in[8]}, c = in[7];
    memset(out, 0, RESULTS * sizeof *out);
    out[0] = a00 * b[0];
    out[1] = exp(b[1]) * a11;
    out[3] = a00 * a11 * b[1];
    out[8] = b[2] * c;
}

// H [n][n] of the weighted results, lower.
static void bend(const double *in, const double *weight, double H[INPUTS][INPUTS])
{
    const double a00 = in[6], a11 = in[5], b1 = in[0];
    memset(H, 0, INPUTS * sizeof *H);
    H[0][0] = weight[1] * exp(b1) * a11;
    H[5][0] = weight[1] * exp(b1) + weight[3] * a00;
    H[6][0] = weight[3] * a11;
    H[6][3] = weight[0];
    H[6][5] = weight[3] * b1;
    H[8][7] = weight[8];
}

static void check_bends(const moray_map *map, const double *in, const double *weight, double error, const char *name)
{
    double H[INPUTS][INPUTS], values[INPUTS * INPUTS];
    bend(in, weight, H);
    map->hessian(map->self, in, weight, values);
    for (int k = 0; k < map->hess.nnz; k++) {
        const int row = map->hess.row[k], col = map->hess.col[k];
        CHECK(fabs(values[k] - H[row][col]) <= error * (1 + fabs(H[row][col])), "%s: second derivative (%d, %d) is %g",
              name, row, col, values[k]);
        H[row][col] = 0;
    }
    for (int k = 0; k < INPUTS * INPUTS; k++)
        CHECK(H[k / INPUTS][k % INPUTS] == 0, "%s: (%d, %d) is in the pattern", name, k / INPUTS, k % INPUTS);
}

// Among more inputs than it has, in another order; what has no part in the function may be anything.
static void test_couple(const char *name, double hessian_error)
{
    static const double points[][INPUTS] = {{0.4, NAN, NAN, 0.7, NAN, -1.3, 2.1, 0.6, -0.3, NAN},
                                            {1, NAN, NAN, 1, NAN, 1, 1, 1, 1, NAN},
                                            {-1, NAN, NAN, -1, NAN, -1, -1, -1, -1, NAN},
                                            {0.4, NAN, NAN, 1e4, NAN, -1e4, 1e4, -1e4, 1e4, NAN}};
    static const double weight[] = {1.5, -0.7, NAN, 0.4, NAN, NAN, NAN, NAN, 0.9};
    const moray_casadi_spec spec = {.path = object, .name = name, .n_in = INPUTS, .place = places};
    double out[RESULTS], told[RESULTS];
    moray_map map;
    CHECK_OK(moray_map_from_casadi(&map, &spec), name);
    CHECK(map.n_in == INPUTS && map.n_out == RESULTS, "%s: %d inputs, %d outputs", name, map.n_in, map.n_out);
    for (size_t k = 0; k < sizeof points / sizeof *points; k++) {
        memset(out, 0xff, sizeof out);
        map.value(map.self, points[k], out);
        couple(points[k], told);
        for (int i = 0; i < RESULTS; i++)
            CHECK(out[i] == told[i], "%s: output %d is %g", name, i, out[i]);
        check_bends(&map, points[k], weight, hessian_error, name);
    }
    const double in[INPUTS] = {0.4, 0, 0, 0.7, 0, -1.3, 2.1, 0.6, -0.3, 0}, weights[RESULTS] = {1.5, -0.7, 0, 0.4};
    moray_derivative_report report = {0};
    CHECK(map.jac.nnz == 9 && !moray_failed(moray_check_derivatives(&map, in, weights, &report)) &&
              report.jacobian_error < 1e-8,
          "%s: %d slopes, to %.1e", name, map.jac.nnz, report.jacobian_error);
    moray_map_release(&map);
}

// A Jacobian that takes no results needs none, nor does a Hessian, whatever its weights.
static void test_calls(void *file, const char *name, const char *counter, bool bends)
{
    const moray_casadi_spec spec = {.path = object, .name = name};
    const double in[8] = {0}, weight[RESULTS] = {1, 2, 3};
    double values[9];
    int (*calls)(void);
    moray_map map;
    *(void **)&calls = dlsym(file, counter);
    CHECK_OK(moray_map_from_casadi(&map, &spec), name);
    const int before = calls();
    map.jacobian(map.self, in, values);
    if (bends)
        map.hessian(map.self, in, weight, values);
    CHECK(calls() == before, "derivatives from the arguments alone call for no results: %d", calls() - before);
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
    int (*balance)(void);
    object = argc > 1 ? argv[1] : "";
    void *file = dlopen(object, RTLD_NOW); // so that it stays, with what it counts
    *(void **)&balance = dlsym(file, "wire_balance");
    test_function("wire", 1e-8);
    test_function("half", 1e-6);
    test_function("bare", 1e-4);
    test_places();
    test_couple("couple", 1e-12);
    test_couple("lame", 1e-7);
    test_calls(file, "lame", "lame_calls", false);
    test_calls(file, "wire", "wire_calls", true);
    test_scalar();
    test_refusal("/nowhere.so", "wire", NULL, MORAY_IO, "/nowhere.so: cannot be loaded");
    test_refusal(object, "wired", NULL, MORAY_INPUT, "no function wired");
    test_refusal(object, "crooked", NULL, MORAY_INPUT, "crooked_sparsity_in(0)");
    test_refusal(object, "hollow", NULL, MORAY_INPUT, "hollow_sparsity_in(0)");
    test_refusal(object, "odd", NULL, MORAY_INPUT, "result 0 of jac_odd is 3 by 1: must be 3 by 3");
    test_refusal(object, "wire", (int[]){0, 1, 1, 2}, MORAY_INPUT, "place 2 of wire is 1: must be from 0 to 3");
    test_refusal(object, "wire", (int[]){0, 1, 2, 4}, MORAY_INPUT, "place 3 of wire is 4");
    test_refusal(object, "wire", (int[]){-1, 1, 2, 3}, MORAY_INPUT, "place 0 of wire is -1");
    CHECK(balance() == 0, "what was taken, held or checked out is given back: %d", balance());
    dlclose(file);
    CHECK(!dlopen(object, RTLD_NOW | RTLD_NOLOAD), "no map holds the object");
    return tap_done();
}
