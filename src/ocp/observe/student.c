// SPDX-License-Identifier: MIT
//
// Student's distribution of whole degrees of freedom by its finite series in theta = atan(t / sqrt(degrees))
// (Abramowitz and Stegun, 26.7.3 and 26.7.4).
#include <math.h>

#include "moray/fit.h"

static const double two_over_pi = 0.63661977236758134308, normal = 1.95996398454005423552;
enum { large = 100000, halvings = 60 }; // beyond: normal, to 1e-5

static double within(double theta, int degrees)
{
    const bool odd = degrees % 2;
    const double c = cos(theta);
    double term = odd ? c : 1, sum = 0;
    for (int k = odd ? 3 : 2; k <= degrees; k += 2) {
        sum += term;
        term *= c * c * (k - 1) / k;
    }
    return odd ? two_over_pi * (theta + sin(theta) * sum) : sin(theta) * sum;
}

double moray_student_95(int degrees)
{
    double low = 0, high = asin(1);
    if (degrees <= 0 || degrees > large)
        return normal;
    for (int i = 0; i < halvings; i++) {
        const double middle = (low + high) / 2;
        if (within(middle, degrees) < 0.95)
            low = middle;
        else
            high = middle;
    }
    return tan(low) * sqrt(degrees);
}
