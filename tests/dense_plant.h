// SPDX-License-Identifier: MIT
//
// The control-oriented model as the paper prints it, for the tests: dense matrices of Sec. III-A, joint forces from
// (22) with the matrices of (18), accelerations from (16b), (16c), (17), all for complex arguments. With L = 2l for l
// (erratum E2) and (16c) for (23h) (erratum E1).
#ifndef TESTS_DENSE_PLANT_H
#define TESTS_DENSE_PLANT_H

#include <complex.h>
#include <string.h>

#include "dense.h"
#include "moray/snake/plant.h"
#include "random_robot.h"

enum {
    DENSE_LINKS = MAX_LINKS,
    DENSE_HARMONICS = 2,
    DENSE_INPUTS = (1 + 2 * DENSE_HARMONICS) * DENSE_LINKS + 8,
    DENSE_OUTPUTS = 4 * DENSE_LINKS + 8
};

typedef double complex num;

typedef struct dense_plant {
    moray_plant_spec spec;
    int N, n; // links, joints
    shape_matrices shape;
} dense_plant;

static dense_plant dense_plant_new(const moray_plant_spec *spec)
{
    const int N = spec->robot.links;
    return (dense_plant){.spec = *spec, .N = N, .n = N - 1, .shape = shape_matrices_new(N)};
}

// out = m v, or m^T v
static void apply(dense m, bool transposed, const num *v, num *out)
{
    const int rows = transposed ? m.cols : m.rows, cols = transposed ? m.rows : m.cols;
    for (int i = 0; i < rows; i++) {
        out[i] = 0;
        for (int j = 0; j < cols; j++)
            out[i] += (transposed ? DENSE(m, j, i) : DENSE(m, i, j)) * v[j];
    }
}

static num inner(int n, const num *x, const num *y)
{
    num sum = 0;
    for (int i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

// phi, v_phi, ubar and theta, v_theta, v_t, v_n of the input, and where the latter stand in the state.
typedef struct dense_state {
    num phi[DENSE_LINKS], v_phi[DENSE_LINKS], ubar[DENSE_LINKS];
    num theta, v_theta, v_t, v_n;
    int at_theta, at_v_theta;
} dense_state;

// phi_i, phi_i' and phi_i'' of a series with s = (omega, coefficients as in moray_series), joint i from 0.
static void dense_series(int n, int harmonics, const num *s, num t, int i, num motion[3])
{
    const num omega = s[0], *c = s + 1;
    motion[0] = c[i];
    motion[1] = motion[2] = 0;
    for (int k = 1; k <= harmonics; k++) {
        const num p = c[n * (2 * k - 1) + i], q = c[n * 2 * k + i];
        motion[0] += p * csin(k * omega * t) + q * ccos(k * omega * t);
        motion[1] += k * omega * (p * ccos(k * omega * t) - q * csin(k * omega * t));
        motion[2] -= k * k * omega * omega * (p * csin(k * omega * t) + q * ccos(k * omega * t));
    }
}

static dense_state dense_unpack(const dense_plant *self, const num *in)
{
    dense_state x = {.at_theta = 0, .at_v_theta = 3};
    const moray_plant_size size = moray_plant_sizes(&self->spec);
    const num *s = in + size.nx + size.nu, t = s[size.ns];
    const int n = self->n;
    const bool steered = self->spec.joints == MORAY_JOINTS_STEERED;
    const bool series = self->spec.joints == MORAY_JOINTS_SERIES;
    const bool on_gait = steered || series || self->spec.joints == MORAY_JOINTS_ON_GAIT;
    if (!on_gait) {
        x.at_theta = n;
        x.at_v_theta = 2 * n + 3;
    }
    for (int i = 0; i < n; i++) {
        num ref = 0, dref = 0, ddref = 0; // (25)
        if (series) {
            num motion[3];
            dense_series(n, self->spec.harmonics, s, t, i, motion);
            ref = motion[0], dref = motion[1], ddref = motion[2];
        } else if (self->spec.joints != MORAY_JOINTS_FREE) {
            const num argument = s[1] * t + i * s[2];
            const num taper = steered ? 0 : s[4];
            const num a = s[0] * (1 + taper * (n > 1 ? (2.0 * i - (n - 1)) / (n - 1) : 0));
            ref = a * csin(argument) + (steered ? in[6] : s[3]);
            dref = a * s[1] * ccos(argument) + (steered ? in[7] : 0);
            ddref = -a * s[1] * s[1] * csin(argument) + (steered ? in[8] : 0);
        }
        x.phi[i] = on_gait ? ref : in[i];
        x.v_phi[i] = on_gait ? dref : in[n + 3 + i];
        x.ubar[i] =
            ddref + self->spec.robot.k_d * (dref - x.v_phi[i]) + self->spec.robot.k_p * (ref - x.phi[i]); // (34)
        if (self->spec.joints == MORAY_JOINTS_FREE)
            x.ubar[i] = in[size.nx + i];
    }
    x.theta = in[x.at_theta];
    x.v_theta = in[x.at_v_theta];
    x.v_t = in[x.at_v_theta + 1];
    x.v_n = in[x.at_v_theta + 2];
    return x;
}

typedef struct dense_rates {
    num dv_theta, dv_t, dv_n, u[DENSE_LINKS];
} dense_rates;

static dense_rates dense_dynamics(const dense_plant *self, const dense_state *x)
{
    const moray_robot *r = &self->spec.robot;
    const int N = self->N, n = self->n;
    const double L = 2 * r->l, m = r->m, mt = r->m + r->mu_n;
    const double c_p = (r->c_n - r->c_t) / (2 * L), mu_p = r->mu_n / (2 * L), ch = r->c_n / (4 * L * L); // (13)
    const num v_tr = x->v_t - (self->spec.current[0] * ccos(x->theta) + self->spec.current[1] * csin(x->theta));
    const num v_nr = x->v_n - (-self->spec.current[0] * csin(x->theta) + self->spec.current[1] * ccos(x->theta));
    num across[DENSE_LINKS], bent[DENSE_LINKS], moved[DENSE_LINKS], pushed[DENSE_LINKS], s = 0;
    for (int i = 0; i < n; i++)
        s += x->phi[i];
    apply(self->shape.A, true, x->phi, across);
    apply(self->shape.A_Dt, false, x->phi, bent);
    apply(self->shape.A_Dbar, false, x->v_phi, moved);
    apply(self->shape.A_Dbar, false, x->ubar, pushed);
    const num squares = inner(N, across, across);
    const num by_v = inner(n, x->phi, moved), by_ubar = inner(n, x->phi, pushed);
    const num h_1 = 1 / (N * N * m * mt - 4 * mu_p * mu_p * s * s); // (17)
    const num h_2 = 2 * N * s * (c_p * mt - r->c_n * mu_p);         // (16b)
    const num h_3 = 4 * c_p * mu_p * s * s - N * N * mt * r->c_t - N * mt * ch * squares;
    const num h_4 = 2 * s * (N * c_p * m - N * r->c_t * mu_p - ch * mu_p * squares); // (16c)
    const num h_5 = 4 * c_p * mu_p * s * s - N * N * m * r->c_n;
    dense_rates rates = {.dv_theta = -r->rot_damping * x->v_theta + r->rot_gain / (N - 1) * v_tr * s, // (20)
                         .dv_t = h_1 * (h_2 * v_nr + h_3 * v_tr - c_p * N * mt * by_v - mu_p * N * mt * by_ubar),
                         .dv_n = h_1 *
                                 (h_4 * v_tr + h_5 * v_nr - 2 * c_p * mu_p * s * by_v - 2 * mu_p * mu_p * s * by_ubar)};
    if (r->hydro.frame == MORAY_FRAME_INVARIANT) { // erratum E7
        rates.dv_t += x->v_theta * x->v_n;
        rates.dv_n -= x->v_theta * x->v_t;
    }
    const num K = 2 * N * mu_p * h_1 * s * (r->c_n * mu_p - mt * c_p) * v_nr +
                  N * mt * h_1 * (N * mu_p * r->c_t + ch * mu_p * squares - N * m * c_p) * v_tr;
    num force[DENSE_LINKS] = {0};
    for (int i = 0; i < n; i++) // (18)
        force[i] = mt * x->ubar[i] + N * mt * mu_p * mu_p * h_1 * bent[i] * by_ubar + r->c_n * x->v_phi[i] +
                   N * mt * c_p * mu_p * h_1 * bent[i] * by_v + K * bent[i];
    apply(self->shape.gram_inverse, false, force, rates.u); // (22)
    return rates;
}

static void dense_value(const dense_plant *self, const num *in, num *out)
{
    const dense_state x = dense_unpack(self, in);
    const dense_rates rates = dense_dynamics(self, &x);
    const int n = self->n, theta = x.at_theta, v_theta = x.at_v_theta;
    if (self->spec.joints == MORAY_JOINTS_STEERED) {
        out[6] = in[7];
        out[7] = in[8];
    } else if (theta > 0)
        for (int i = 0; i < n; i++) {
            out[i] = x.v_phi[i];
            out[n + 3 + i] = x.ubar[i];
        }
    out[theta] = x.v_theta;
    out[theta + 1] = x.v_t * ccos(x.theta) - x.v_n * csin(x.theta);
    out[theta + 2] = x.v_t * csin(x.theta) + x.v_n * ccos(x.theta);
    out[v_theta] = rates.dv_theta;
    out[v_theta + 1] = rates.dv_t;
    out[v_theta + 2] = rates.dv_n;
    num angles[DENSE_LINKS], *next = out + moray_plant_sizes(&self->spec).nx;
    for (int i = 0; i < n && self->spec.path_forces; i++)
        *next++ = rates.u[i];
    apply(self->shape.A, true, x.phi, angles); // (12)
    for (int i = 0; i <= n && self->spec.path_angles; i++)
        *next++ = angles[i] / (4 * self->spec.robot.l);
    for (int i = 0; i < n && self->spec.path_rates; i++)
        *next++ = x.v_phi[i];
    *next = inner(n, rates.u, x.v_phi);
}

#endif
