// SPDX-License-Identifier: MIT
//
// Student's distribution against its density, integrated, and tables.
#include "tap.h"

#include "moray/fit.h"

// Of the density of t = sqrt(degrees) tan(theta), which is cos(theta)^(degrees - 1) but for a factor: the part within
// `end` of the middle, by Simpson's rule.
static double integral(int degrees, double end)
{
    enum { parts = 2000 };
    const double h = end / parts;
    double sum = 0;
    for (int k = 0; k < parts; k++)
        for (int i = 0; i < 3; i++)
            sum += h / 6 * (i == 1 ? 4 : 1) * pow(cos((k + 0.5 * i) * h), degrees - 1);
    return sum;
}

static void test_density(int degrees)
{
    char what[60];
    const double most = degrees > 1000 ? 12 / sqrt(degrees) : acos(0); // of theta, with nothing beyond
    snprintf(what, sizeof what, "95 %% of %d degrees", degrees);
    CHECK_NEAR(integral(degrees, atan(moray_student_95(degrees) / sqrt(degrees))) / integral(degrees, most), 0.95,
               2e-10, what);
}

static void test_table(void)
{
    CHECK_NEAR(moray_student_95(1), 12.7062047, 1e-6, "Student, 1 degree of freedom");
    CHECK_NEAR(moray_student_95(2), 4.3026527, 1e-6, "2");
    CHECK_NEAR(moray_student_95(30), 2.0422725, 1e-6, "30");
    CHECK_NEAR(moray_student_95(1001), 1.9623355, 1e-5, "1001");
    CHECK_NEAR(moray_student_95(0), 1.9599640, 1e-6, "normal");
}

int main(void)
{
    test_table();
    for (int degrees = 1; degrees < 12; degrees++)
        test_density(degrees);
    test_density(30), test_density(101), test_density(5000), test_density(99999), test_density(100000);
    const double normal = moray_student_95(0);
    CHECK_NEAR(erf(normal / sqrt(2)), 0.95, 1e-14, "the normal distribution");
    CHECK(moray_student_95(-3) == normal && moray_student_95(100001) == normal, "of no and of very many degrees");
    CHECK(moray_student_95(100000) - normal > 2.3e-5 && moray_student_95(100000) - normal < 2.5e-5,
          "to which it comes down: %g", moray_student_95(100000) - normal);
    return tap_done();
}
