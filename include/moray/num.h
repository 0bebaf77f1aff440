// SPDX-License-Identifier: MIT
//
// The number type of user functions, and what <tgmath.h> lacks for it. The library finds derivatives by the complex
// step: it puts a tiny imaginary part into one input and reads the derivative off the imaginary parts of the outputs.
// That is exact for everything analytic: + - * /, pow, exp, log, sqrt, sin, cos, tan, asin, acos, atan, sinh, cosh,
// tanh. Not analytic, and silently wrong: fabs (in <tgmath.h> the modulus), cabs, carg, conj, creal and cimag of
// anything that depends on the inputs. Comparisons need creal(a) < creal(b); the branch taken is the one
// differentiated. The functions below continue their real namesakes: they choose by the real part, so that value and
// derivative are those of the real function. Where they have a kink (moray_abs at 0) Newton's method may stall: a
// smooth form, such as sqrt(x * x + e * e), converges better.
#ifndef MORAY_NUM_H
#define MORAY_NUM_H

#include <complex.h>
#include <math.h>

#include "moray/export.h"

MORAY_BEGIN

typedef double complex moray_num;

static inline moray_num moray_abs(moray_num z)
{
    return creal(z) < 0 ? -z : z;
}

// -1, 0 or 1; derivative 0.
static inline moray_num moray_sign(moray_num z)
{
    return isnan(creal(z)) ? z : (creal(z) > 0) - (creal(z) < 0);
}

// A NaN wins, so that dependences are seen.
static inline moray_num moray_max(moray_num a, moray_num b)
{
    return isnan(creal(a)) || creal(a) >= creal(b) ? a : b;
}
static inline moray_num moray_min(moray_num a, moray_num b)
{
    return isnan(creal(a)) || creal(a) <= creal(b) ? a : b;
}

static inline moray_num moray_clamp(moray_num z, moray_num lower, moray_num upper)
{
    return moray_min(moray_max(z, lower), upper);
}

// z to a real power; of a negative z to a whole one only.
static inline moray_num moray_pow(moray_num z, double power)
{
    if (creal(z) > 0)
        return cpow(z, power);
    if (creal(z) == 0)
        return CMPLX(pow(0, power), power == 1 ? cimag(z) : power > 1 ? 0 : NAN);
    if (power != rint(power))
        return NAN;
    return fmod(power, 2) == 0 ? cpow(-z, power) : -cpow(-z, power);
}

// sqrt(x^2 + y^2); <tgmath.h> has it for real numbers only, as it has atan2.
static inline moray_num moray_hypot(moray_num x, moray_num y)
{
    return csqrt(x * x + y * y);
}

// Angle of the vector (x, y) in (-pi, pi]; the imaginary part to first order, which is all the complex step reads.
static inline moray_num moray_atan2(moray_num y, moray_num x)
{
    const double a = creal(x), b = creal(y);
    return CMPLX(atan2(b, a), (a * cimag(y) - b * cimag(x)) / (a * a + b * b));
}

MORAY_END

#endif
