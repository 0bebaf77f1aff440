// SPDX-License-Identifier: MIT
//
// The control-oriented model averaged over a period of the gait, as a map. With phi = a sin(psi + (i-1) delta) + phi_0
// the means of the features over psi are
//   s: (N-1) phi_0     q: a^2 Q_1 / 2 + phi_0^2 Q_0     w: a^2 omega W     z: 0
// for B = A Dbar has entries of which only the antisymmetric part, 1 - (k-j)/N, survives, and in w alone. To second
// order in a the wave of s also drives one of v_n, which works back on the means: <s v_n> and <s dv_n> below, from
//   mt N dv_n + N c_n v_n = 2 kappa s,     kappa = mu_p dv_t + c_p v_tr,
// and in the invariant frame one of v_theta with it, dv_n + v_theta v_t for dv_n.
#include <complex.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "snake/model/control_body.h"
#include "snake/plant/series.h"
#include "snake/plant/average.h"

enum { states = MORAY_STEERING_STATES, STEERING = states, AMPLITUDE, OMEGA, DELTA, TIME, inputs };

struct moray_average {
    control_body body;
    const moray_water *water; // NULL: uniform
    int n;                    // joints
    double Q_0, G_0;          // |A^T e|^2 and e^T G e, G = (D D^T)^{-1}
};

// What depends on delta alone: means of quadratic forms of the wave, per a^2 (and omega).
typedef struct wave {
    double complex Q_1, W, G_1, sigma; // |A^T wave|^2, thrust, wave^T G wave, |sum of the wave|^2
} wave;

// Sum along the m-th diagonal of G, of entries j (N - k) / N for j <= k.
static double gram_diagonal(int N, int m)
{
    const double K = N - 1 - m; // entries: sum over j = 1..K of j (K + 1 - j)
    return K * (K + 1) * (K + 2) / (6 * N);
}

static wave wave_of(const moray_average *self, double complex delta)
{
    const int n = self->n, N = n + 1;
    wave out = {.Q_1 = 2 + (n - 1) * (2 + 2 * cos(delta)), .sigma = n};
    const double complex turn = 2 * cos(delta); // cos((m+1) delta) = turn cos(m delta) - cos((m-1) delta), sin likewise
    double complex c = cos(delta), c_before = 1, s = sin(delta), s_before = 0;
    out.G_1 = gram_diagonal(N, 0);
    for (int m = 1; m < n; m++) {
        out.W -= (n - m) * (1 - (double)m / N) * s;
        out.G_1 += 2 * gram_diagonal(N, m) * c;
        out.sigma += 2 * (n - m) * c;
        const double complex c_next = turn * c - c_before, s_next = turn * s - s_before;
        c_before = c, c = c_next;
        s_before = s, s = s_next;
    }
    return out;
}

typedef struct means {
    double complex s, q, w, v_tr, v_nr;
    double complex push; // of the wave on dv_t, in the invariant frame
} means;

// Invariant frame: per wave of s, that of v_theta is h = turning v_tr / (damping + i omega) and that of v_n has, beside
// what kappa drives, e = -mt v_t h / (c_n + i omega mt); real and imaginary parts apart.
typedef struct wagging {
    double complex h_r, h_i, e_r, e_i, share; // share: of kappa in <v_theta v_n>, per |wave of s|^2
} wagging;

static wagging wagging_of(const control_body *b, double complex omega, double complex v_tr, double complex v_t)
{
    const double complex slow = b->turning * v_tr / (b->damping * b->damping + omega * omega);
    const double complex D = b->c_n * b->c_n + b->mt * b->mt * omega * omega, lag = omega * b->mt;
    wagging out = {.h_r = slow * b->damping, .h_i = -slow * omega};
    out.e_r = -b->mt * v_t * (out.h_r * b->c_n + out.h_i * lag) / D;
    out.e_i = -b->mt * v_t * (out.h_i * b->c_n - out.h_r * lag) / D;
    out.share = 2 * (out.h_r * b->c_n - out.h_i * lag) / (b->N * D);
    return out;
}

// Mean accelerations by the averaged (15b), (15c), linear in them; the wave's part is `lift` kappa, with lift =
// 2 a^2 sigma (c_p c_n + mu_p mt omega^2) / (N (c_n^2 + mt^2 omega^2)).
static void accelerations(const control_body *b, const means *y, double complex lift, double complex *dv_t,
                          double complex *dv_n)
{
    const double complex coupling = 2 * b->mu_p * y->s;
    const double complex M_tt = b->N * b->m - lift * b->mu_p, M_nn = b->N * b->mt;
    const double complex f_t = -b->c_p * y->w + 2 * b->c_p * y->s * y->v_nr -
                               (b->N * b->c_t + b->ch_n * y->q - lift * b->c_p) * y->v_tr + y->push;
    const double complex f_n = 2 * b->c_p * y->s * y->v_tr - b->N * b->c_n * y->v_nr;
    const double complex determinant = M_tt * M_nn - coupling * coupling;
    *dv_t = (M_nn * f_t + coupling * f_n) / determinant;
    *dv_n = (M_tt * f_n + coupling * f_t) / determinant;
}

// in = [theta, p_x, p_y, v_theta, v_t, v_n, phi_0, phi_0', phi_0'', a, omega, delta, t]
void moray_average_rates(void *context, const double complex *in, double complex *out)
{
    const moray_average *self = context;
    const control_body *b = &self->body;
    const double complex c = cos(in[MORAY_STATE_THETA]), s = sin(in[MORAY_STATE_THETA]),
                         v_theta = in[MORAY_STATE_V_THETA], v_t = in[MORAY_STATE_V_1], v_n = in[MORAY_STATE_V_2];
    const double complex phi_0 = in[MORAY_STATE_PHI_0], v_phi_0 = in[MORAY_STATE_V_PHI_0], dv_phi_0 = in[STEERING];
    const double complex a2 = in[AMPLITUDE] * in[AMPLITUDE], omega = in[OMEGA];
    const wave of = wave_of(self, in[DELTA]);
    double complex V[2] = {b->V_x, b->V_y};
    if (self->water)
        moray_water_at_complex(self->water, in[MORAY_STATE_P_X], in[MORAY_STATE_P_Y], in[TIME], V);
    means y = {.s = self->n * phi_0,
               .q = a2 * of.Q_1 / 2 + phi_0 * phi_0 * self->Q_0,
               .w = a2 * omega * of.W,
               .v_tr = v_t - (V[0] * c + V[1] * s),
               .v_nr = v_n - (-V[0] * s + V[1] * c)};
    const double complex lift = 2 * a2 * of.sigma * (b->c_p * b->c_n + b->mu_p * b->mt * omega * omega) /
                                (b->N * (b->c_n * b->c_n + b->mt * b->mt * omega * omega));
    const double complex square = a2 * of.sigma; // of the wave of s
    wagging wag = {0};
    if (b->frame != 0) {
        wag = wagging_of(b, omega, y.v_tr, v_t);
        y.push = square * (b->mu_p * (v_t * wag.h_r - omega * wag.e_i) + b->c_p * wag.e_r);
    }
    double complex dv_t, dv_n;
    accelerations(b, &y, lift, &dv_t, &dv_n);
    const double complex kappa = b->mu_p * dv_t + b->c_p * y.v_tr;
    out[MORAY_STATE_THETA] = v_theta;
    out[MORAY_STATE_P_X] = v_t * c - v_n * s;
    out[MORAY_STATE_P_Y] = v_t * s + v_n * c;
    out[MORAY_STATE_V_THETA] = b->turning * y.v_tr * y.s - b->damping * v_theta; // (20)
    out[MORAY_STATE_V_1] = dv_t;
    out[MORAY_STATE_V_2] = dv_n;
    if (b->frame != 0) {
        out[MORAY_STATE_V_1] +=
            v_theta * v_n + square / 2 * (wag.share * kappa + wag.h_r * wag.e_r + wag.h_i * wag.e_i);
        out[MORAY_STATE_V_2] -= v_theta * v_t;
    }
    out[MORAY_STATE_PHI_0] = v_phi_0;
    out[MORAY_STATE_V_PHI_0] = dv_phi_0;
    out[states] = b->c_n * (a2 * omega * omega * of.G_1 / 2 + v_phi_0 * v_phi_0 * self->G_0) +
                  b->mt * self->G_0 * v_phi_0 * dv_phi_0 + kappa * y.w;
}

moray_status moray_average_new(moray_average **result, const moray_plant_spec *spec)
{
    *result = NULL;
    MORAY_TRY(moray_plant_check(spec, false));
    if (spec->joints != MORAY_JOINTS_STEERED || spec->path_forces || spec->path_angles)
        return moray_error(MORAY_INPUT, "the averaged plant is steered and has no path outputs");
    moray_average *self = calloc(1, sizeof *self);
    if (!self)
        return moray_error(MORAY_MEMORY, "no memory for an averaged plant");
    const int N = spec->robot.links;
    *self = (moray_average){
        .body = moray_body_of(&spec->robot, spec->current), .water = spec->water, .n = N - 1, .Q_0 = 4 * N - 6};
    self->G_0 = N * ((double)N * N - 1) / 12; // sum of k (N - k) / 2, the solution of D D^T x = e
    *result = self;
    return moray_ok();
}

moray_status moray_average_plant(moray_map *map, const moray_plant_spec *spec)
{
    double probe[inputs] = {0.1, 0, 0, 0.2, 0.2, 0.05, 0.01, 0.003, 0.002, 0.04, 2, 0.7, 0.4};
    moray_average *self;
    *map = (moray_map){0};
    MORAY_TRY(moray_average_new(&self, spec));
    if (spec->water) {
        double middle[3];
        moray_water_middle(spec->water, middle);
        probe[MORAY_STATE_P_X] = middle[0];
        probe[MORAY_STATE_P_Y] = middle[1];
        probe[TIME] = middle[2];
    }
    return moray_map_from_complex(map, inputs, states + 1, moray_average_rates, self, free, probe);
}
