// snake.h: the gait and the steering of an underwater snake robot of 10 links, by moray 0.2.0.
// Command: `export --from trials --law path --name snake`
//
// Angles in rad, lengths in m, times in s. Joint i = 0..SNAKE_JOINTS-1 from tail to head is at phi_i = theta_i - theta_{i+1},
// theta_i the angle of link i from the x axis, counterclockwise seen from above. The gait counts from t = 0.
//
// Nothing is allocated and nothing called: no library, not <math.h>. What a law keeps is in a state of the caller's. Sine and
// cosine are exact to 2e-16 in double and 2e-7 in float for angles below 1e4 rad; with float, keep t below some 1e3 s, or take
// whole periods away from it.
//
// SNAKE_REAL is the type of all numbers: double, unless it is defined as float before this file is included.
//
//     snake_state state;
//     snake_start(&state);
//     every SNAKE_LOOK:  snake_steer(&state, t, heading, x, y);
//     every control step:  snake_joints(&state, t, phi, dphi, ddphi);
#ifndef SNAKE_H
#define SNAKE_H

#ifndef SNAKE_REAL
#define SNAKE_REAL double
#endif
typedef SNAKE_REAL snake_real;

// ---- Arithmetic ----------------------------------------------------------------------------------------------------

#define SNAKE_C(x) ((snake_real)(x))

// Whole number nearest to x, |x| < 2^30.
static inline long snake_nearest(snake_real x)
{
    return (long)(x < SNAKE_C(0) ? x - SNAKE_C(0.5) : x + SNAKE_C(0.5));
}

// Angle within half a turn of 0.
static inline snake_real snake_wrap(snake_real angle)
{
    const snake_real turns = (snake_real)snake_nearest(angle * SNAKE_C(0.15915494309189533577));
    return ((angle - turns * SNAKE_C(6.28125)) - turns * SNAKE_C(1.93500518798828125e-3)) - turns * SNAKE_C(3.0199159819567529e-7);
}

static inline snake_real snake_clamp(snake_real x, snake_real limit)
{
    return x > limit ? limit : x < -limit ? -limit : x;
}

// Sine and cosine: the angle less quarter turns in four parts (Cody and Waite), then Taylor's polynomials on +-pi/4.
static inline void snake_turn(snake_real angle, snake_real *sine, snake_real *cosine)
{
    const long quarters = snake_nearest(angle * SNAKE_C(0.63661977236758134308));
    const snake_real n = (snake_real)quarters;
    const snake_real r = (((angle - n * SNAKE_C(1.5703125)) - n * SNAKE_C(4.837512969970703125e-4)) -
                      n * SNAKE_C(7.54978941586159635336e-8)) - n * SNAKE_C(5.39030285815811905290e-15);
    const snake_real q = r * r;
    const snake_real s = r + r * q * (SNAKE_C(-1.0 / 6) + q * (SNAKE_C(1.0 / 120) + q * (SNAKE_C(-1.0 / 5040) + q * (SNAKE_C(1.0 / 362880) +
                     q * (SNAKE_C(-1.0 / 39916800) + q * (SNAKE_C(1.0 / 6227020800.0) + q * SNAKE_C(-1.0 / 1307674368000.0)))))));
    const snake_real c = SNAKE_C(1) + q * (SNAKE_C(-0.5) + q * (SNAKE_C(1.0 / 24) + q * (SNAKE_C(-1.0 / 720) + q * (SNAKE_C(1.0 / 40320) +
                     q * (SNAKE_C(-1.0 / 3628800) + q * (SNAKE_C(1.0 / 479001600) + q * (SNAKE_C(-1.0 / 87178291200.0) +
                     q * SNAKE_C(1.0 / 20922789888000.0))))))));
    const unsigned long quadrant = (unsigned long)quarters & 3ul;
    *sine = quadrant == 0 ? s : quadrant == 1 ? c : quadrant == 2 ? -s : -c;
    *cosine = quadrant == 0 ? c : quadrant == 1 ? -s : quadrant == 2 ? -c : s;
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

#define SNAKE_JOINTS 9 // 
#define SNAKE_HARMONICS 1 // of the gait
#define SNAKE_OMEGA SNAKE_C(2.0943951023931953) // frequency [rad/s]
#define SNAKE_PERIOD SNAKE_C(3) // [s]
#define SNAKE_RAMP SNAKE_C(3) // from the straight body to the gait [s]
#define SNAKE_K_P SNAKE_C(200) // joint controller (34) [1/s^2]
#define SNAKE_K_D SNAKE_C(50) // [1/s]

// Joint i: constant_i + sum over k of sine_ki sin(k omega t) + cosine_ki cos(k omega t) [rad].
static const snake_real snake_constant[SNAKE_JOINTS] = {
    SNAKE_C(0),
    SNAKE_C(0),
    SNAKE_C(0),
    SNAKE_C(0),
    SNAKE_C(0),
    SNAKE_C(0),
    SNAKE_C(0),
    SNAKE_C(0),
    SNAKE_C(0)
};
static const snake_real snake_sine[SNAKE_HARMONICS][SNAKE_JOINTS] = {
    {SNAKE_C(0.2387751043670331), SNAKE_C(0.18291234185551972), SNAKE_C(0.04146286174556641), SNAKE_C(-0.11938755218351649),
     SNAKE_C(-0.2243752036010861), SNAKE_C(-0.22437520360108612), SNAKE_C(-0.11938755218351665), SNAKE_C(0.04146286174556631),
     SNAKE_C(0.18291234185551966)}
};
static const snake_real snake_cosine[SNAKE_HARMONICS][SNAKE_JOINTS] = {
    {SNAKE_C(0), SNAKE_C(0.15348167858873915), SNAKE_C(0.23514757400695332), SNAKE_C(0.20678530617313132),
     SNAKE_C(0.0816658954182142), SNAKE_C(-0.08166589541821415), SNAKE_C(-0.20678530617313123), SNAKE_C(-0.23514757400695335),
     SNAKE_C(-0.1534816785887392)}
};

// ---- State ---------------------------------------------------------------------------------------------------------

// What the law of steering keeps from one call to the next; the caller's.
typedef struct snake_state {
    snake_real since, value, slope;  // of the joint offset: at that time, and how it moves from there [s], [rad], [rad/s]
    snake_real integral;             // of the law
    snake_real heading, rate;        // filtered [rad], [rad/s]
    snake_real along;                // the path [m]
    int begun;
} snake_state;

// Before the first call: no offset, at the start of the path.
static inline void snake_start(snake_state *state)
{
    state->since = state->value = state->slope = state->integral = SNAKE_C(0);
    state->heading = state->rate = state->along = SNAKE_C(0);
    state->begun = 0;
}

// Joint offset that the law has commanded for the time t, and its rate.
static inline snake_real snake_offset(const snake_state *state, snake_real t)
{
    return state->value + state->slope * (t - state->since);
}

// ---- Gait ----------------------------------------------------------------------------------------------------------

// Amplitude of the ramp-in: 0 at t = 0, 1 from the end of the ramp on, with two continuous derivatives.
static inline void snake_ramp(snake_real t, snake_real ramp[3])
{
    const snake_real length = SNAKE_RAMP, x = length > SNAKE_C(0) ? t / length : SNAKE_C(1);
    ramp[0] = x <= SNAKE_C(0) ? SNAKE_C(0) : SNAKE_C(1);
    ramp[1] = ramp[2] = SNAKE_C(0);
    if (x <= SNAKE_C(0) || x >= SNAKE_C(1))
        return;
    ramp[0] = x * x * x * (SNAKE_C(10) + x * (SNAKE_C(6) * x - SNAKE_C(15)));
    ramp[1] = SNAKE_C(30) * x * x * (SNAKE_C(1) - x) * (SNAKE_C(1) - x) / length;
    ramp[2] = SNAKE_C(60) * x * (SNAKE_C(1) - x) * (SNAKE_C(1) - SNAKE_C(2) * x) / (length * length);
}

// Angle [rad], rate [rad/s] and acceleration [rad/s^2] wanted of every joint at t.
static inline void snake_joints(const snake_state *state, snake_real t, snake_real phi[SNAKE_JOINTS], snake_real dphi[SNAKE_JOINTS],
                            snake_real ddphi[SNAKE_JOINTS])
{
    const snake_real offset = snake_offset(state, t);
    snake_real sine[SNAKE_HARMONICS], cosine[SNAKE_HARMONICS], ramp[3];
    int i, k;
    snake_ramp(t, ramp);
    for (k = 0; k < SNAKE_HARMONICS; k++)
        snake_turn((snake_real)(k + 1) * (SNAKE_OMEGA * t), &sine[k], &cosine[k]);
    for (i = 0; i < SNAKE_JOINTS; i++) {
        snake_real w = snake_constant[i], dw = SNAKE_C(0), ddw = SNAKE_C(0);
        for (k = 0; k < SNAKE_HARMONICS; k++) {
            const snake_real rate = (snake_real)(k + 1) * SNAKE_OMEGA, p = snake_sine[k][i], q = snake_cosine[k][i];
            w += p * sine[k] + q * cosine[k];
            dw += rate * (p * cosine[k] - q * sine[k]);
            ddw -= rate * rate * (p * sine[k] + q * cosine[k]);
        }
        phi[i] = ramp[0] * w + offset;
        dphi[i] = ramp[1] * w + ramp[0] * dw + state->slope;
        ddphi[i] = ramp[2] * w + SNAKE_C(2) * ramp[1] * dw + ramp[0] * ddw;
    }
}

// Joint accelerations that bring measured joints to the gait, (34): ubar = phi_ref'' + k_d e' + k_p e [rad/s^2].
static inline void snake_control(const snake_state *state, snake_real t, const snake_real measured[SNAKE_JOINTS],
                             const snake_real measured_rate[SNAKE_JOINTS], snake_real ubar[SNAKE_JOINTS])
{
    snake_real phi[SNAKE_JOINTS], dphi[SNAKE_JOINTS];
    int i;
    snake_joints(state, t, phi, dphi, ubar);
    for (i = 0; i < SNAKE_JOINTS; i++)
        ubar[i] += SNAKE_K_D * (dphi[i] - measured_rate[i]) + SNAKE_K_P * (phi[i] - measured[i]);
}

// The law of steering; offsets are of the joints [rad].
#define SNAKE_LOOK SNAKE_C(0.1) // time between two calls [s]
#define SNAKE_OFFSET_MAX SNAKE_C(0.07960031124104465) // [rad]
#define SNAKE_OFFSET_RATE_MAX SNAKE_C(0.05306687416069644) // [rad/s]
#define SNAKE_SWING_COS SNAKE_C(0.07603648430176917) // what the gait swings the mean heading by: cosine [rad]
#define SNAKE_SWING_SIN SNAKE_C(0.016170891739412007) // and sine of omega t [rad]
#define SNAKE_GAIN SNAKE_C(-3.48624457858512) // [rad/rad]; a positive offset turns the robot clockwise
#define SNAKE_SIGHT SNAKE_C(1.0903234277014333) // lookahead [m]
#define SNAKE_SIGHT_INTEGRAL SNAKE_C(0.10262865298898459) // sigma [m/s]
#define SNAKE_AHEAD SNAKE_C(0.20978328825319045) // along the path, where its course is taken [m]
#define SNAKE_PIECES 3 // of the path
#define SNAKE_LENGTH SNAKE_C(11.141592653589793) // [m]
#define SNAKE_RADIUS SNAKE_C(2) // of its arcs [m]

// Distance along the path where a piece begins [m], x, y [m], course [rad] there, curvature [1/m].
static const snake_real snake_path[SNAKE_PIECES][5] = {
    {SNAKE_C(0), SNAKE_C(0), SNAKE_C(0), SNAKE_C(0),
     SNAKE_C(0)}
    ,
    {SNAKE_C(4), SNAKE_C(4), SNAKE_C(0), SNAKE_C(0),
     SNAKE_C(0.5)}
    ,
    {SNAKE_C(7.141592653589793), SNAKE_C(6), SNAKE_C(1.9999999999999998), SNAKE_C(1.5707963267948966),
     SNAKE_C(0)}
};

// ---- Steering ------------------------------------------------------------------------------------------------------

// Mean link angle less what the gait swings it by.
static inline snake_real snake_straight(snake_real t, snake_real heading)
{
    snake_real sine, cosine;
    snake_turn(SNAKE_OMEGA * t, &sine, &cosine);
    return heading - SNAKE_SWING_COS * cosine - SNAKE_SWING_SIN * sine;
}

// Sends the offset on its way to what is wanted, within its limits, until the next call.
static inline void snake_hold(snake_state *state, snake_real t, snake_real wanted)
{
    state->value = snake_offset(state, t);
    state->since = t;
    state->slope = snake_clamp((snake_clamp(wanted, SNAKE_OFFSET_MAX) - state->value) / SNAKE_LOOK, SNAKE_OFFSET_RATE_MAX);
}

// arctan by that of at most tan(pi/8) in size and a rational function (Cephes).
static inline snake_real snake_arctan(snake_real x)
{
    const snake_real size = x < SNAKE_C(0) ? -x : x;
    const int far = size > SNAKE_C(2.41421356237309504880), middle = !far && size > SNAKE_C(0.41421356237309504880);
    const snake_real r = far ? SNAKE_C(-1) / size : middle ? (size - SNAKE_C(1)) / (size + SNAKE_C(1)) : size;
    const snake_real z = r * r;
    const snake_real over = ((((SNAKE_C(-8.750608600031904122785e-1) * z - SNAKE_C(1.615753718733365076637e1)) * z -
                           SNAKE_C(7.500855792314704667340e1)) * z - SNAKE_C(1.228866684490136173410e2)) * z -
                         SNAKE_C(6.485021904942025371773e1));
    const snake_real under = (((((z + SNAKE_C(2.485846490142306297962e1)) * z + SNAKE_C(1.650270098316988542046e2)) * z +
                            SNAKE_C(4.328810604912902668951e2)) * z + SNAKE_C(4.853903996359136964868e2)) * z +
                          SNAKE_C(1.945506571482613964425e2));
    const snake_real angle = (far ? SNAKE_C(1.57079632679489661923) : middle ? SNAKE_C(0.78539816339744830962) : SNAKE_C(0)) + r +
                         r * z * over / under;
    return x < SNAKE_C(0) ? -angle : angle;
}

// Point of the path at a distance along it: x, y [m], course [rad], curvature [1/m]. Straight on behind its ends.
static inline void snake_path_at(snake_real along, snake_real point[4])
{
    snake_real s, c, s0, c0, from, turned;
    int k = 0;
    while (k + 1 < SNAKE_PIECES && along >= snake_path[k + 1][0])
        k++;
    from = along < SNAKE_C(0) ? SNAKE_C(0) : along > SNAKE_LENGTH ? SNAKE_LENGTH - snake_path[k][0] : along - snake_path[k][0];
    turned = snake_path[k][3] + snake_path[k][4] * from;
    snake_turn(turned, &s, &c);
    snake_turn(snake_path[k][3], &s0, &c0);
    point[0] = snake_path[k][1] + (snake_path[k][4] != SNAKE_C(0) ? (s - s0) / snake_path[k][4] : from * c);
    point[1] = snake_path[k][2] - (snake_path[k][4] != SNAKE_C(0) ? (c - c0) / snake_path[k][4] : -from * s);
    point[2] = turned;
    point[3] = snake_path[k][4];
    if (along >= SNAKE_C(0) && along <= SNAKE_LENGTH)
        return;
    from = along < SNAKE_C(0) ? along : along - SNAKE_LENGTH;
    point[0] += from * c;
    point[1] += from * s;
    point[3] = SNAKE_C(0);
}

// How far (x, y) lies to the left of the path [m], near where it was last.
static inline snake_real snake_across(snake_state *state, snake_real x, snake_real y)
{
    const snake_real longest = SNAKE_C(0.5) * SNAKE_RADIUS, exact = SNAKE_RADIUS * (sizeof(snake_real) < 8 ? SNAKE_C(1e-6) : SNAKE_C(1e-10));
    snake_real across = SNAKE_C(0), point[4], s, c, ahead, stretch, step;
    int k;
    for (k = 0; k < 100; k++) {
        snake_path_at(state->along, point);
        snake_turn(point[2], &s, &c);
        ahead = c * (x - point[0]) + s * (y - point[1]);
        across = c * (y - point[1]) - s * (x - point[0]);
        stretch = SNAKE_C(1) - point[3] * across;
        step = ahead / (stretch < SNAKE_C(0.2) ? SNAKE_C(0.2) : stretch);
        state->along += snake_clamp(step, longest);
        if (step < exact && step > -exact)
            break;
    }
    return across;
}

// Every SNAKE_LOOK seconds: heading is the mean of all link angles [rad], x and y the centre of mass in the frame of the
// path [m]. Line of sight theta = course(along + SNAKE_AHEAD) - arctan((e + sigma y) / SNAKE_SIGHT), with integral action y.
// At the end of the path state->along passes SNAKE_LENGTH.
static inline void snake_steer(snake_state *state, snake_real t, snake_real heading, snake_real x, snake_real y)
{
    const snake_real across = snake_across(state, x, y), bent = across + SNAKE_SIGHT_INTEGRAL * state->integral;
    snake_real point[4], target;
    snake_path_at(state->along + SNAKE_AHEAD, point);
    state->integral += SNAKE_LOOK * SNAKE_SIGHT * across / (bent * bent + SNAKE_SIGHT * SNAKE_SIGHT);
    target = point[2] - snake_arctan(bent / SNAKE_SIGHT);
    snake_hold(state, t, SNAKE_GAIN * snake_wrap(target - snake_straight(t, heading)));
}

#endif
