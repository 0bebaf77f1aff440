// SPDX-License-Identifier: MIT
//
// The number type of user functions, and what <tgmath.h> lacks for it. The library finds derivatives by the complex
// step: it puts a tiny imaginary part into one input and reads the derivative off the imaginary parts of the outputs.
// That is exact for everything analytic: + - * /, pow of what is positive (else moray_pow), exp, log, sqrt, sin, cos,
// tan, asin, acos, atan, sinh, cosh, tanh. Not analytic, and silently wrong: fabs (in <tgmath.h> the modulus), cabs,
// carg, conj, creal and cimag of anything that depends on the inputs. Comparisons need creal(a) < creal(b); the branch
// taken is the one differentiated. The functions below continue their real namesakes: they choose by the real part, so
// that value and derivative are those of the real function. Where they have a kink (moray_abs at 0) Newton's method may
// stall: a smooth form, such as sqrt(x * x + e * e), converges better.
//
// In C++ moray_num is std::complex<double>, of the same form in memory; user functions then call the functions of
// <complex>.
#ifndef MORAY_NUM_H
#define MORAY_NUM_H

#ifdef __cplusplus

#include <cmath>
#include <complex>

typedef std::complex<double> moray_num;

static inline double moray_real(const moray_num &z)
{
    return z.real();
}
static inline double moray_imag(const moray_num &z)
{
    return z.imag();
}
static inline moray_num moray_complex(double real, double imaginary)
{
    return moray_num(real, imaginary);
}
static inline moray_num moray_complex_pow(const moray_num &z, double power)
{
    return std::pow(z, power);
}
static inline moray_num moray_complex_sqrt(const moray_num &z)
{
    return std::sqrt(z);
}
static inline moray_num moray_complex_exp(const moray_num &z)
{
    return std::exp(z);
}
static inline moray_num moray_complex_sin(const moray_num &z)
{
    return std::sin(z);
}
static inline moray_num moray_complex_cos(const moray_num &z)
{
    return std::cos(z);
}

#else

#include <complex.h>
#include <math.h>

typedef double complex moray_num;

static inline double moray_real(moray_num z)
{
    return creal(z);
}
static inline double moray_imag(moray_num z)
{
    return cimag(z);
}
// As CMPLX, which C99 and clang lack: real + imaginary * I would spoil infinities.
static inline moray_num moray_complex(double real, double imaginary)
{
    const union {
        double part[2];
        moray_num z;
    } number = {{real, imaginary}};
    return number.z;
}
static inline moray_num moray_complex_pow(moray_num z, double power)
{
    return cpow(z, power);
}
static inline moray_num moray_complex_sqrt(moray_num z)
{
    return csqrt(z);
}
static inline moray_num moray_complex_exp(moray_num z)
{
    return cexp(z);
}
static inline moray_num moray_complex_sin(moray_num z)
{
    return csin(z);
}
static inline moray_num moray_complex_cos(moray_num z)
{
    return ccos(z);
}

#endif

static inline moray_num moray_abs(moray_num z)
{
    return moray_real(z) < 0 ? -z : z;
}

// -1, 0 or 1; derivative 0.
static inline moray_num moray_sign(moray_num z)
{
    const double x = moray_real(z);
    return x != x ? z : moray_complex((x > 0) - (x < 0), 0);
}

// A NaN wins, so that dependences are seen.
static inline moray_num moray_max(moray_num a, moray_num b)
{
    return moray_real(a) != moray_real(a) || moray_real(a) >= moray_real(b) ? a : b;
}
static inline moray_num moray_min(moray_num a, moray_num b)
{
    return moray_real(a) != moray_real(a) || moray_real(a) <= moray_real(b) ? a : b;
}

static inline moray_num moray_clamp(moray_num z, moray_num lower, moray_num upper)
{
    return moray_min(moray_max(z, lower), upper);
}

// Whether the imaginary part is a step: so small beside `size` that its square is lost in the rounding of the value.
static inline int moray_is_step(moray_num z, double size)
{
    return fabs(moray_imag(z)) < 1e-9 * size;
}

// sin, cos, exp and sqrt as <tgmath.h> has them, several times quicker for a complex step: one real function, or two,
// give what the complex ones work out from eight.
static inline moray_num moray_sin(moray_num z)
{
    const double x = moray_real(z), sine = sin(x), slope = cos(x); // before the question: one call for moray_cos too
    return moray_is_step(z, 1) ? moray_complex(sine, slope * moray_imag(z)) : moray_complex_sin(z);
}
static inline moray_num moray_cos(moray_num z)
{
    const double x = moray_real(z), cosine = cos(x), slope = -sin(x);
    return moray_is_step(z, 1) ? moray_complex(cosine, slope * moray_imag(z)) : moray_complex_cos(z);
}
static inline moray_num moray_exp(moray_num z)
{
    if (!moray_is_step(z, 1))
        return moray_complex_exp(z);
    const double value = exp(moray_real(z));
    return moray_complex(value, value * moray_imag(z));
}
static inline moray_num moray_sqrt(moray_num z)
{
    const double x = moray_real(z);
    if (!(x > 0 && moray_is_step(z, x)))
        return moray_complex_sqrt(z);
    const double root = sqrt(x);
    return moray_complex(root, moray_imag(z) / (2 * root));
}

// z to a real power; of a negative z to a whole one only.
static inline moray_num moray_pow(moray_num z, double power)
{
    const double x = moray_real(z);
    if (x > 0 && power != 0 && moray_is_step(z, x)) {
        const double value = pow(x, power);
        return moray_complex(value, power * value / x * moray_imag(z));
    }
    if (x > 0 || power == 0)
        return power == 0 ? moray_complex(1, 0) : moray_complex_pow(z, power);
    if (x == 0)
        return moray_complex(pow(0, power), power == 1 ? moray_imag(z) : power > 1 ? 0 : NAN);
    if (power != rint(power))
        return moray_complex(NAN, NAN);
    return fmod(power, 2) == 0 ? moray_complex_pow(-z, power) : -moray_complex_pow(-z, power);
}

// sqrt(x^2 + y^2); <tgmath.h> has it for real numbers only, as it has atan2.
static inline moray_num moray_hypot(moray_num x, moray_num y)
{
    return moray_sqrt(x * x + y * y);
}

// Angle of the vector (x, y) in (-pi, pi]; the imaginary part to first order, which is all the complex step reads.
static inline moray_num moray_atan2(moray_num y, moray_num x)
{
    const double a = moray_real(x), b = moray_real(y);
    return moray_complex(atan2(b, a), (a * moray_imag(y) - b * moray_imag(x)) / (a * a + b * b));
}

#endif
