// SPDX-License-Identifier: MIT
#include "tap.h"

#include <string.h>

#include "moray/scheme.h"
#include "ocp/legendre.h"

// The tables must integrate and differentiate polynomials exactly: A to degree s-1 at every point, b to order - 1.
static void test_exactness(moray_family family, int stages)
{
    moray_scheme k;
    moray_status status = moray_scheme_new(&k, family, stages);
    CHECK(!moray_failed(status), "family %d, %d stages", family, stages);
    double worst_A = 0, worst_b = 0, worst_defect = 0;
    for (int degree = 0; degree < k.order; degree++) {
        for (int i = 0; i < k.points; i++) {
            double integral = 0;
            for (int j = 0; j < k.points; j++)
                integral += k.A[i * k.points + j] * pow(k.node[j], degree);
            if (degree < stages)
                worst_A = tap_worse(worst_A, fabs(integral - pow(k.node[i], degree + 1) / (degree + 1)));
            if (i == k.points - 1)
                worst_b = tap_worse(worst_b, fabs(integral - 1.0 / (degree + 1)));
        }
        for (int i = 0; i < k.points - 1 && degree < stages; i++) {
            double defect = 0;
            for (int j = 0; j < k.points; j++)
                defect += k.P[i * k.points + j] * pow(k.node[j], degree + 1) -
                          k.Q[i * k.points + j] * (degree + 1) * pow(k.node[j], degree);
            worst_defect = tap_worse(worst_defect, fabs(defect));
        }
    }
    double beyond = -1.0 / (k.order + 1);
    for (int j = 0; j < k.points; j++)
        beyond += k.b[j] * pow(k.node[j], k.order);
    CHECK(stages > 6 || fabs(beyond) > 1e-9, "family %d, %d stages: no higher order than %d (%.1e)", family, stages,
          k.order, beyond);
    CHECK(worst_A < 2e-14 && worst_b < 2e-14 && worst_defect < 1e-12,
          "family %d, %d stages, order %d: exact on polynomials (A %.1e, b %.1e, defects %.1e)", family, stages,
          k.order, worst_A, worst_b, worst_defect);
    double rows = 0;
    for (int i = 0; i < k.points - 1; i++) {
        double sum = 0, largest = 0;
        for (int j = 0; j < k.points; j++) {
            sum += k.P[i * k.points + j];
            largest = fmax(largest, fabs(k.P[i * k.points + j]));
        }
        rows = tap_worse(rows, fmax(fabs(sum), fabs(largest - 1)));
    }
    CHECK(rows < 1e-12, "family %d, %d stages: defects of a constant vanish, coefficients at most 1 (%.1e)", family,
          stages, rows);
    moray_scheme_free(&k);
}

static void test_textbook_tables(void)
{
    moray_scheme k;
    CHECK_OK(moray_scheme_new(&k, MORAY_LOBATTO, 3), "Hermite-Simpson");
    const double simpson[] = {1. / 6, 2. / 3, 1. / 6}, middle[] = {5. / 24, 1. / 3, -1. / 24};
    for (int j = 0; j < 3; j++) {
        CHECK_NEAR(k.b[j], simpson[j], 1e-15, "Simpson's weights");
        CHECK_NEAR(k.A[3 + j], middle[j], 1e-15, "middle row of Lobatto IIIA");
    }
    moray_scheme_free(&k);
    CHECK_OK(moray_scheme_new(&k, MORAY_RADAU, 2), "Radau IIA");
    CHECK_NEAR(k.node[1], 1. / 3, 1e-15, "Radau point");
    CHECK_NEAR(k.A[3 + 1], 5. / 12, 1e-15, "Radau IIA a11");
    CHECK_NEAR(k.A[3 + 2], -1. / 12, 1e-15, "Radau IIA a12");
    moray_scheme_free(&k);
    CHECK_OK(moray_scheme_new(&k, MORAY_GAUSS, 1), "midpoint rule");
    CHECK_NEAR(k.node[1], 0.5, 1e-15, "midpoint");
    CHECK_NEAR(k.b[1], 1, 1e-15, "weight of the midpoint rule");
    moray_scheme_free(&k);
}

// Nodes ascend from 0 to 1, however many there are; those of Lobatto and Gauss lie alike from both ends.
static void test_order_of_nodes(moray_family family, int stages)
{
    moray_scheme k;
    CHECK_OK(moray_scheme_new(&k, family, stages), "scheme");
    int wrong = k.node[0] != 0 || k.node[k.points - 1] != 1;
    double odd = 0;
    for (int j = 1; j < k.points; j++)
        wrong += !(k.node[j] > k.node[j - 1]);
    for (int j = 0; j < k.points; j++)
        odd = tap_worse(odd, fabs(k.node[j] + k.node[k.points - 1 - j] - 1));
    CHECK(wrong == 0, "family %d, %d stages: %d nodes out of order", family, stages, wrong);
    CHECK(family == MORAY_RADAU || odd < 1e-14, "as far from either end, to %.1e", odd);
    moray_scheme_free(&k);
}

// Whatever was there before.
static void test_ends_of_lobatto(void)
{
    for (int s = 2; s < 5; s++) {
        double node[5] = {9, 9, 9, 9, 9};
        moray_legendre_lobatto(s, node);
        CHECK(node[0] == 0 && node[s - 1] == 1 && node[s] == 9, "%d points from 0 to 1", s);
    }
}

static void test_legendre_polynomials(void)
{
    for (int k = 1; k < 10; k++) {
        const double t = k / 10.0, x = 2 * t - 1;
        const double want[] = {1, x, (3 * x * x - 1) / 2, (5 * x * x - 3) * x / 2, ((35 * x * x - 30) * x * x + 3) / 8};
        for (int n = 0; n < 5; n++)
            CHECK_NEAR(moray_legendre_value(n, t), want[n], 1e-15, "Legendre's polynomial on [0, 1]");
    }
}

static void test_names(void)
{
    moray_family family;
    int stages;
    CHECK(!moray_failed(moray_scheme_parse("hermite-simpson", &family, &stages)) && family == MORAY_LOBATTO &&
              stages == 3,
          "hermite-simpson is Lobatto with 3 stages");
    CHECK(!moray_failed(moray_scheme_parse("radau12", &family, &stages)) && family == MORAY_RADAU && stages == 12,
          "radau12");
    const char *bad[] = {"", "simpson", "lobatto", "lobatto1", "radau0", "gauss65", "gauss3x", "trapezoid2", "radau-3"};
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++) {
        moray_status status = moray_scheme_parse(bad[i], &family, &stages);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, "scheme = "), "\"%s\" is refused", bad[i]);
    }
    moray_scheme scheme;
    CHECK(moray_scheme_new(&scheme, MORAY_LOBATTO, 1).code == MORAY_INPUT, "Lobatto needs two stages");
}

int main(void)
{
    for (int stages = 1; stages <= 20; stages++)
        for (int family = 0; family < 3; family++)
            if (family != MORAY_LOBATTO || stages > 1)
                test_exactness((moray_family)family, stages);
    for (int stages = 2; stages <= MORAY_MAX_STAGES; stages++)
        for (int family = MORAY_LOBATTO; family <= MORAY_GAUSS; family++)
            test_order_of_nodes((moray_family)family, stages);
    static const int wild[] = {49, 50, 61, 62}; // where a step of Newton's method left the interval
    for (int k = 0; k < 4; k++)
        test_exactness(MORAY_RADAU, wild[k]);
    test_exactness(MORAY_RADAU, MORAY_MAX_STAGES);
    test_exactness(MORAY_LOBATTO, MORAY_MAX_STAGES);
    test_exactness(MORAY_GAUSS, MORAY_MAX_STAGES);
    test_textbook_tables();
    test_ends_of_lobatto();
    test_legendre_polynomials();
    test_names();
    return tap_done();
}
