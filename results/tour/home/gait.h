// gait.h: the gait of an underwater snake robot of 10 links, by moray 0.2.0.
// Command: `export --from gait --set rate_hz=100 --name gait`
//
// Angles in rad, lengths in m, times in s. Joint i = 0..GAIT_JOINTS-1 from tail to head is at phi_i = theta_i - theta_{i+1},
// theta_i the angle of link i from the x axis, counterclockwise seen from above. The gait counts from t = 0.
//
// Nothing is allocated and nothing called: no library, not <math.h>. What a law keeps is in a state of the caller's. Sine and
// cosine are exact to 2e-16 in double and 2e-7 in float for angles below 1e4 rad; with float, keep t below some 1e3 s, or take
// whole periods away from it.
//
// GAIT_REAL is the type of all numbers: double, unless it is defined as float before this file is included.
//
//     gait_state state;
//     gait_start(&state);
//     every control step:  gait_joints(&state, t, phi, dphi, ddphi);
#ifndef GAIT_H
#define GAIT_H

#ifndef GAIT_REAL
#define GAIT_REAL double
#endif
typedef GAIT_REAL gait_real;

// ---- Arithmetic ----------------------------------------------------------------------------------------------------

#define GAIT_C(x) ((gait_real)(x))

// Whole number nearest to x, |x| < 2^30.
static inline long gait_nearest(gait_real x)
{
    return (long)(x < GAIT_C(0) ? x - GAIT_C(0.5) : x + GAIT_C(0.5));
}

// Angle within half a turn of 0.
static inline gait_real gait_wrap(gait_real angle)
{
    const gait_real turns = (gait_real)gait_nearest(angle * GAIT_C(0.15915494309189533577));
    return ((angle - turns * GAIT_C(6.28125)) - turns * GAIT_C(1.93500518798828125e-3)) - turns * GAIT_C(3.0199159819567529e-7);
}

static inline gait_real gait_clamp(gait_real x, gait_real limit)
{
    return x > limit ? limit : x < -limit ? -limit : x;
}

// Sine and cosine: the angle less quarter turns in four parts (Cody and Waite), then Taylor's polynomials on +-pi/4.
static inline void gait_turn(gait_real angle, gait_real *sine, gait_real *cosine)
{
    const long quarters = gait_nearest(angle * GAIT_C(0.63661977236758134308));
    const gait_real n = (gait_real)quarters;
    const gait_real r = (((angle - n * GAIT_C(1.5703125)) - n * GAIT_C(4.837512969970703125e-4)) -
                      n * GAIT_C(7.54978941586159635336e-8)) - n * GAIT_C(5.39030285815811905290e-15);
    const gait_real q = r * r;
    const gait_real s = r + r * q * (GAIT_C(-1.0 / 6) + q * (GAIT_C(1.0 / 120) + q * (GAIT_C(-1.0 / 5040) + q * (GAIT_C(1.0 / 362880) +
                     q * (GAIT_C(-1.0 / 39916800) + q * (GAIT_C(1.0 / 6227020800.0) + q * GAIT_C(-1.0 / 1307674368000.0)))))));
    const gait_real c = GAIT_C(1) + q * (GAIT_C(-0.5) + q * (GAIT_C(1.0 / 24) + q * (GAIT_C(-1.0 / 720) + q * (GAIT_C(1.0 / 40320) +
                     q * (GAIT_C(-1.0 / 3628800) + q * (GAIT_C(1.0 / 479001600) + q * (GAIT_C(-1.0 / 87178291200.0) +
                     q * GAIT_C(1.0 / 20922789888000.0))))))));
    const unsigned long quadrant = (unsigned long)quarters & 3ul;
    *sine = quadrant == 0 ? s : quadrant == 1 ? c : quadrant == 2 ? -s : -c;
    *cosine = quadrant == 0 ? c : quadrant == 1 ? -s : quadrant == 2 ? -c : s;
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

#define GAIT_JOINTS 9 // 
#define GAIT_HARMONICS 1 // of the gait
#define GAIT_OMEGA GAIT_C(2.6719981576461302) // frequency [rad/s]
#define GAIT_PERIOD GAIT_C(2.351493128541187) // [s]
#define GAIT_RAMP GAIT_C(2.351493128541187) // from the straight body to the gait [s]
#define GAIT_K_P GAIT_C(200) // joint controller (34) [1/s^2]
#define GAIT_K_D GAIT_C(50) // [1/s]

// Joint i: constant_i + sum over k of sine_ki sin(k omega t) + cosine_ki cos(k omega t) [rad].
static const gait_real gait_constant[GAIT_JOINTS] = {
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06),
    GAIT_C(-6.362511396154259e-06)
};
static const gait_real gait_sine[GAIT_HARMONICS][GAIT_JOINTS] = {
    {GAIT_C(0.3035126490677277), GAIT_C(0.18878036462751294), GAIT_C(-0.06867547718469193), GAIT_C(-0.2742106204255281),
     GAIT_C(-0.27243439792378465), GAIT_C(-0.06468968659694825), GAIT_C(0.19196234734584408), GAIT_C(0.3034851505620447),
     GAIT_C(0.18556417458408014)}
};
static const gait_real gait_cosine[GAIT_HARMONICS][GAIT_JOINTS] = {
    {GAIT_C(0), GAIT_C(0.2376592141601349), GAIT_C(0.2956410103107559), GAIT_C(0.1301094300577656),
     GAIT_C(-0.1337887400793302), GAIT_C(-0.29653865277919206), GAIT_C(-0.2350965447333991), GAIT_C(0.004085527192746416),
     GAIT_C(0.2401788193305951)}
};

// ---- State ---------------------------------------------------------------------------------------------------------

// What the law of steering keeps from one call to the next; the caller's.
typedef struct gait_state {
    gait_real since, value, slope;  // of the joint offset: at that time, and how it moves from there [s], [rad], [rad/s]
    gait_real integral;             // of the law
    gait_real heading, rate;        // filtered [rad], [rad/s]
    gait_real along;                // the path [m]
    int begun;
} gait_state;

// Before the first call: no offset, at the start of the path.
static inline void gait_start(gait_state *state)
{
    state->since = state->value = state->slope = state->integral = GAIT_C(0);
    state->heading = state->rate = state->along = GAIT_C(0);
    state->begun = 0;
}

// Joint offset that the law has commanded for the time t, and its rate.
static inline gait_real gait_offset(const gait_state *state, gait_real t)
{
    return state->value + state->slope * (t - state->since);
}

// ---- Gait ----------------------------------------------------------------------------------------------------------

// Amplitude of the ramp-in: 0 at t = 0, 1 from the end of the ramp on, with two continuous derivatives.
static inline void gait_ramp(gait_real t, gait_real ramp[3])
{
    const gait_real length = GAIT_RAMP, x = length > GAIT_C(0) ? t / length : GAIT_C(1);
    ramp[0] = x <= GAIT_C(0) ? GAIT_C(0) : GAIT_C(1);
    ramp[1] = ramp[2] = GAIT_C(0);
    if (x <= GAIT_C(0) || x >= GAIT_C(1))
        return;
    ramp[0] = x * x * x * (GAIT_C(10) + x * (GAIT_C(6) * x - GAIT_C(15)));
    ramp[1] = GAIT_C(30) * x * x * (GAIT_C(1) - x) * (GAIT_C(1) - x) / length;
    ramp[2] = GAIT_C(60) * x * (GAIT_C(1) - x) * (GAIT_C(1) - GAIT_C(2) * x) / (length * length);
}

// Angle [rad], rate [rad/s] and acceleration [rad/s^2] wanted of every joint at t.
static inline void gait_joints(const gait_state *state, gait_real t, gait_real phi[GAIT_JOINTS], gait_real dphi[GAIT_JOINTS],
                            gait_real ddphi[GAIT_JOINTS])
{
    const gait_real offset = gait_offset(state, t);
    gait_real sine[GAIT_HARMONICS], cosine[GAIT_HARMONICS], ramp[3];
    int i, k;
    gait_ramp(t, ramp);
    for (k = 0; k < GAIT_HARMONICS; k++)
        gait_turn((gait_real)(k + 1) * (GAIT_OMEGA * t), &sine[k], &cosine[k]);
    for (i = 0; i < GAIT_JOINTS; i++) {
        gait_real w = gait_constant[i], dw = GAIT_C(0), ddw = GAIT_C(0);
        for (k = 0; k < GAIT_HARMONICS; k++) {
            const gait_real rate = (gait_real)(k + 1) * GAIT_OMEGA, p = gait_sine[k][i], q = gait_cosine[k][i];
            w += p * sine[k] + q * cosine[k];
            dw += rate * (p * cosine[k] - q * sine[k]);
            ddw -= rate * rate * (p * sine[k] + q * cosine[k]);
        }
        phi[i] = ramp[0] * w + offset;
        dphi[i] = ramp[1] * w + ramp[0] * dw + state->slope;
        ddphi[i] = ramp[2] * w + GAIT_C(2) * ramp[1] * dw + ramp[0] * ddw;
    }
}

// Joint accelerations that bring measured joints to the gait, (34): ubar = phi_ref'' + k_d e' + k_p e [rad/s^2].
static inline void gait_control(const gait_state *state, gait_real t, const gait_real measured[GAIT_JOINTS],
                             const gait_real measured_rate[GAIT_JOINTS], gait_real ubar[GAIT_JOINTS])
{
    gait_real phi[GAIT_JOINTS], dphi[GAIT_JOINTS];
    int i;
    gait_joints(state, t, phi, dphi, ubar);
    for (i = 0; i < GAIT_JOINTS; i++)
        ubar[i] += GAIT_K_D * (dphi[i] - measured_rate[i]) + GAIT_K_P * (phi[i] - measured[i]);
}

#endif
