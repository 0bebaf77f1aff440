// SPDX-License-Identifier: MIT
//
// The maps of the control-oriented model against the dense model and its derivatives.
#include "dense_derivatives.h"

static const char *const form_names[] = {"on the gait", "closed loop", "free", "steered", "series"};

// A map, its dense counterpart, a point, and what either says there.
typedef struct fixture {
    moray_plant_spec spec;
    dense_plant dense;
    moray_map map;
    char name[80];
    double in[DENSE_INPUTS], weight[DENSE_OUTPUTS];
    double values[DENSE_OUTPUTS * DENSE_INPUTS];
    grid got, want;
} fixture;

static fixture *fixture_new(int links, int form, bool forces, bool angles)
{
    static fixture f;
    f.spec = random_spec(links, (moray_joints)form, forces, angles);
    f.dense = dense_plant_new(&f.spec);
    snprintf(f.name, sizeof f.name, "N = %d, %s%s%s", links, form_names[form], forces ? ", forces" : "",
             angles ? ", angles" : "");
    CHECK_OK(moray_control_plant(&f.map, &f.spec), f.name);
    random_point(&f.spec, f.map.n_in, f.in);
    for (int i = 0; i < f.map.n_out; i++)
        f.weight[i] = draw(-1, 1);
    return &f;
}

static void fixture_release(fixture *f)
{
    moray_map_release(&f->map);
    shape_matrices_free(&f->dense.shape);
}

static void check_values(fixture *f)
{
    double out[DENSE_OUTPUTS], worst = 0;
    num in[DENSE_INPUTS], want[DENSE_OUTPUTS];
    for (int k = 0; k < f->map.n_in; k++)
        in[k] = f->in[k];
    f->map.value(f->map.self, f->in, out);
    dense_value(&f->dense, in, want);
    for (int i = 0; i < f->map.n_out; i++) {
        const double error = fabs(out[i] - creal(want[i])) / (1 + fabs(creal(want[i])));
        worst = error <= worst ? worst : error;
    }
    CHECK(worst < 1e-13, "%s: values within %.1e", f->name, worst);
}

static void check_jacobian(fixture *f)
{
    const int rows = f->map.n_out, cols = f->map.n_in;
    f->map.jacobian(f->map.self, f->in, f->values);
    CHECK(spread(&f->map.jac, f->values, false, &f->got), "%s: no entry of the Jacobian stands twice", f->name);
    dense_jacobian(&f->dense, cols, rows, f->in, &f->want);
    const double error = disagreement(&f->spec, rows, cols, false, &f->got, &f->want);
    CHECK(error < 1e-13, "%s: Jacobian within %.1e", f->name, error);
}

static void check_hessian(fixture *f)
{
    const int n = f->map.n_in;
    f->map.hessian(f->map.self, f->in, f->weight, f->values);
    CHECK(spread(&f->map.hess, f->values, true, &f->got), "%s: Hessian lower, no entry twice", f->name);
    dense_hessian(&f->dense, n, f->map.n_out, f->in, f->weight, &f->want);
    const double error = disagreement(&f->spec, n, n, true, &f->got, &f->want);
    CHECK(error < 1e-11, "%s: Hessian within %.1e", f->name, error);
}

static void test_against_dense(int links, int form, bool forces, bool angles)
{
    fixture *f = fixture_new(links, form, forces, angles);
    for (int point = 0; point < 3; point++) {
        random_point(&f->spec, f->map.n_in, f->in);
        check_values(f);
        check_jacobian(f);
        check_hessian(f);
    }
    fixture_release(f);
}

// The number of entries of the pattern where |m| is not above `noise` (lower: or m^T), and that of other entries where
// it is.
typedef struct misfit {
    int idle, missing;
} misfit;

static misfit pattern_misfit(const moray_pattern *pattern, int rows, int cols, double noise, const grid *m)
{
    static grid in_pattern;
    misfit count = {0, 0};
    memset(&in_pattern, 0, sizeof in_pattern);
    for (int k = 0; k < pattern->nnz; k++) {
        in_pattern.at[pattern->row[k]][pattern->col[k]] = 1;
        count.idle += fabs(m->at[pattern->row[k]][pattern->col[k]]) <= noise;
    }
    const bool lower = rows == cols;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < cols && !(lower && j > i); j++)
            count.missing += in_pattern.at[i][j] == 0 && fabs(m->at[i][j]) > noise;
    return count;
}

static void test_patterns(int links, int form, bool path)
{
    fixture *f = fixture_new(links, form, path, path);
    dense_jacobian(&f->dense, f->map.n_in, f->map.n_out, f->in, &f->want); // zeros are exact
    misfit count = pattern_misfit(&f->map.jac, f->map.n_out, f->map.n_in, 0, &f->want);
    CHECK(count.idle == 0 && count.missing == 0, "%s: of %d Jacobian entries %d idle, %d missing", f->name,
          f->map.jac.nnz, count.idle, count.missing);
    dense_hessian(&f->dense, f->map.n_in, f->map.n_out, f->in, f->weight, &f->want);
    count = pattern_misfit(&f->map.hess, f->map.n_in, f->map.n_in, 1e-9, &f->want);
    CHECK(count.idle == 0 && count.missing == 0, "%s: of %d Hessian entries %d idle, %d missing", f->name,
          f->map.hess.nnz, count.idle, count.missing);
    fixture_release(f);
}

static void test_sizes(void)
{
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_ON_GAIT};
    moray_plant_size size = moray_plant_sizes(&spec);
    CHECK(size.nx == 6 && size.nu == 0 && size.ns == 5 && size.nc == 0 && size.nq == 1, "sizes on the gait");
    spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    spec.path_forces = true;
    size = moray_plant_sizes(&spec);
    CHECK(size.nx == 24 && size.nu == 0 && size.ns == 5 && size.nc == 9 && size.nq == 1, "sizes in closed loop");
    spec.joints = MORAY_JOINTS_FREE;
    spec.path_angles = true;
    size = moray_plant_sizes(&spec);
    CHECK(size.nx == 24 && size.nu == 9 && size.ns == 0 && size.nc == 19 && size.nq == 1, "sizes of the free form");
    spec.joints = MORAY_JOINTS_STEERED;
    size = moray_plant_sizes(&spec);
    CHECK(size.nx == 8 && size.nu == 1 && size.ns == 3 && size.nc == 19 && size.nq == 1, "sizes of the steered form");
    spec.joints = MORAY_JOINTS_SERIES;
    spec.harmonics = 3;
    spec.path_rates = true;
    size = moray_plant_sizes(&spec);
    CHECK(size.nx == 6 && size.nu == 0 && size.ns == 64 && size.nc == 28 && size.nq == 1, "sizes of a series");
    spec.path_rates = false;
    spec.joints = MORAY_JOINTS_FREE;
    moray_map map;
    CHECK_OK(moray_control_plant(&map, &spec), "the map");
    CHECK(map.n_in == 24 + 9 + 1 && map.n_out == 24 + 19 + 1, "the map has these sizes and t");
    moray_map_release(&map);
    moray_map_release(&map);
    CHECK(!map.self && !map.jac.row && !map.hess.row, "released twice");
}

static void test_bad_robot(void)
{
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_FREE};
    spec.robot.links = 1;
    moray_map map;
    const moray_status status = moray_control_plant(&map, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "links = 1"), "one link: %s", status.text);
    moray_map_release(&map);
    CHECK(!map.self, "nothing is left of a map that was not made");
}

// The answers at a point do not depend on where the map was asked what before.
static void test_any_order(int form)
{
    fixture *f = fixture_new(10, form, true, true);
    double fresh[DENSE_OUTPUTS], again[DENSE_OUTPUTS], other[DENSE_INPUTS];
    static double jacobian[DENSE_OUTPUTS * DENSE_INPUTS], hessian[DENSE_INPUTS * DENSE_INPUTS];
    const size_t jac_size = (size_t)f->map.jac.nnz * sizeof(double),
                 hess_size = (size_t)f->map.hess.nnz * sizeof(double);
    random_point(&f->spec, f->map.n_in, other);
    f->map.value(f->map.self, f->in, fresh);
    f->map.jacobian(f->map.self, f->in, jacobian);
    f->map.hessian(f->map.self, f->in, f->weight, hessian);
    f->map.value(f->map.self, other, again);
    f->map.hessian(f->map.self, f->in, f->weight, f->values);
    CHECK(memcmp(hessian, f->values, hess_size) == 0, "%s: Hessian first", f->name);
    f->map.hessian(f->map.self, other, f->weight, f->values);
    f->map.jacobian(f->map.self, f->in, f->values);
    CHECK(memcmp(jacobian, f->values, jac_size) == 0, "%s: Jacobian after another Hessian", f->name);
    f->map.jacobian(f->map.self, other, f->values);
    f->map.value(f->map.self, f->in, again);
    CHECK(memcmp(fresh, again, (size_t)f->map.n_out * sizeof *fresh) == 0, "%s: value after another Jacobian", f->name);
    fixture_release(f);
}

int main(void)
{
    test_sizes();
    test_bad_robot();
    for (int form = 0; form <= MORAY_JOINTS_SERIES; form++) {
        for (int k = 0; k < ROBOT_SIZES; k++) {
            if (form == MORAY_JOINTS_SERIES && robot_links[k] > 5) // their dense Hessians take long
                break;
            test_against_dense(robot_links[k], form, false, false);
            test_against_dense(robot_links[k], form, true, true);
            if (robot_links[k] > 2) { // with two links A Dbar is zero and delta moves nothing
                test_patterns(robot_links[k], form, false);
                test_patterns(robot_links[k], form, true);
            }
        }
        test_against_dense(5, form, true, false);
        test_against_dense(5, form, false, true);
        test_any_order(form);
    }
    return tap_done();
}
