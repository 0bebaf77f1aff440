// SPDX-License-Identifier: MIT
//
// The running sums of shape.c against the matrices built by definition.
#include "dense.h"
#include "random_robot.h"
#include "snake/model/shape.h"

typedef void product(int N, const double *v, double *out);

static void check_product(int N, const char *name, product *fast, dense matrix, bool transposed)
{
    random_seed seed = (random_seed)N;
    double v[MAX_LINKS], out[MAX_LINKS + 1], expected[MAX_LINKS];
    const int n_out = transposed ? matrix.cols : matrix.rows;
    double worst = 0;
    for (int trial = 0; trial < 5; trial++) {
        random_vector(&seed, 1, N - 1, v);
        v[N - 1] = NAN; // nobody reads
        out[n_out] = 1234;
        fast(N, v, out);
        dense_apply(matrix, transposed, v, expected);
        for (int i = 0; i < n_out; i++)
            worst = tap_worse(worst, fabs(out[i] - expected[i]));
    }
    CHECK_NEAR(worst, 0, 1e-13 * N, name);
    CHECK(out[n_out] == 1234, "%s: writes %d entries for N = %d", name, n_out, N);
}

static void check_products(int N)
{
    shape_matrices s = shape_matrices_new(N);
    check_product(N, "Dbar v", moray_shape_dbar, s.Dbar, false);
    check_product(N, "A Dbar v", moray_shape_a_dbar, s.A_Dbar, false);
    check_product(N, "(A Dbar)^T v", moray_shape_a_dbar_transposed, s.A_Dbar, true);
    check_product(N, "(D D^T)^{-1} v", moray_shape_gram_inverse, s.gram_inverse, false);
    check_product(N, "A D^T v", moray_shape_a_dt, s.A_Dt, false);
    check_product(N, "A^T v", moray_shape_at, s.A, true);
    shape_matrices_free(&s);
}

// D Dbar = I, and A D^T is antisymmetric: the two facts the equations of motion lean on.
static void check_identities(int N)
{
    shape_matrices s = shape_matrices_new(N);
    dense D_Dbar = dense_product(s.D, false, s.Dbar, false);
    double inverse = 0, antisymmetry = 0;
    for (int i = 0; i < N - 1; i++)
        for (int j = 0; j < N - 1; j++) {
            inverse = tap_worse(inverse, fabs(DENSE(D_Dbar, i, j) - (i == j)));
            antisymmetry = tap_worse(antisymmetry, fabs(DENSE(s.A_Dt, i, j) + DENSE(s.A_Dt, j, i)));
        }
    CHECK_NEAR(inverse, 0, 1e-14 * N, "D Dbar = I");
    CHECK(antisymmetry == 0, "A D^T is antisymmetric for N = %d", N);
    dense_free(&D_Dbar);
    shape_matrices_free(&s);
}

int main(void)
{
    for (int k = 0; k < ROBOT_SIZES; k++) {
        check_products(robot_links[k]);
        check_identities(robot_links[k]);
    }
    return tap_done();
}
