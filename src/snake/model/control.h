// SPDX-License-Identifier: MIT
//
// Control-oriented model (7)-(23): the parts that its ODE form is made of.
#ifndef SRC_SNAKE_MODEL_CONTROL_H
#define SRC_SNAKE_MODEL_CONTROL_H

#include "moray/snake/model.h"

// Coefficients of (13) and (16), with L = 2l (erratum E2).
typedef struct control_coefficients {
    double c_p, mu_p, c_n_hat, m_tilde;
} control_coefficients;

control_coefficients moray_control_coefficients_of(const moray_robot *robot);

// (23) with (16c) in place of (23h) (erratum E1), and (22) unless u is NULL. x and dx[2N+4], ubar and u[N-1],
// scratch[2(N-1)]. False where (16) is singular, that is h_1 of (17) is not positive.
bool moray_control_rates(const moray_robot *robot, const double current[2], const double *x, const double *ubar,
                         double *dx, double *u, double *scratch);

#endif
