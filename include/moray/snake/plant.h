// SPDX-License-Identifier: MIT
//
// The models as maps with exact derivatives, which is how they meet the transcription.
#ifndef MORAY_SNAKE_PLANT_H
#define MORAY_SNAKE_PLANT_H

#include "moray/export.h"
#include "moray/map.h"
#include "moray/snake/model.h"
#include "moray/water.h"

MORAY_BEGIN

// ---- Control-oriented model as maps with analytic derivatives (for the transcription) ------------------------------
//
// in  = [state x, controls u, parameters s, time t]
// out = [f: state derivative | c: path outputs | g: power sum u_i v_phi,i of the joints in W; with motors of the
//        first-principles model that at their terminals]
// path outputs c, each block only when asked for: joint forces u_i of (22) in N (N-1), then link angles theta_i of (12)
// (N).

typedef enum {
    MORAY_JOINTS_ON_GAIT,     // x = (theta, p_x, p_y, v_theta, v_t, v_n), s = (a, omega, delta, phi_0, taper); no u
    MORAY_JOINTS_CLOSED_LOOP, // x of (21), s = (a, omega, delta, phi_0, taper), ubar from (34); no u
    MORAY_JOINTS_FREE,        // x of (21), u = ubar (N-1); no s
    MORAY_JOINTS_STEERED, // on a gait without taper, with a moving offset, fed forward: x = (theta, p_x, p_y, v_theta,
                          // v_t, v_n, phi_0, phi_0'), u = phi_0'', s = (a, omega, delta)
    MORAY_JOINTS_SERIES   // x as on the gait, s = (omega, coefficients as in moray_series); no u
} moray_joints;

typedef struct moray_plant_spec {
    moray_robot robot;
    moray_joints joints;
    double current[2];             // V_x, V_y [m/s]
    const moray_water *water;      // in place of it, as it is at (p_x, p_y) and t; must outlive the map; NULL: uniform
    bool path_forces, path_angles; // blocks of c wanted
    bool path_supply;              // and, with the motors of the first-principles model, behind the efforts u_m + slope
                                   // phi_i' of every line of these, all joints of one line after the other
    bool path_rates;               // and, joints on a series only, behind them the joint rates phi_i' (N-1)
    int harmonics;                 // of a series, 1..MORAY_SERIES_HARMONICS
} moray_plant_spec;

// Sizes of the map that moray_control_plant makes.
typedef struct moray_plant_size {
    int nx, nu, ns, nc, nq;
} moray_plant_size;
MORAY_API moray_plant_size moray_plant_sizes(const moray_plant_spec *spec);

// Error: MORAY_INPUT (robot; path_supply, path_rates where they cannot be had), MORAY_MEMORY. The map owns all it
// needs; release with moray_map_release.
MORAY_API moray_status moray_control_plant(moray_map *map, const moray_plant_spec *spec);

// The first-principles model in the same form, for all but MORAY_JOINTS_CLOSED_LOOP, with alpha in place of a:
// x = (mean link angle, p_x, p_y, and their rates), steered phi_0 and phi_0' too, free phi before each of the two
// threes as in (21); c: joint torques [N m], then theta_i minus their mean. Exact Jacobians and Hessians by complex
// step or, free and of a series, by the adjoint. Errors and ownership as above.
MORAY_API moray_status moray_fp_plant(moray_map *map, const moray_plant_spec *spec);

// The control-oriented model averaged over a period of the gait, to second order in a, in the form of
// MORAY_JOINTS_STEERED without path outputs: the undulation is gone, so that a mesh need only resolve the turning.
// Derivatives, errors and ownership as of moray_fp_plant.
MORAY_API moray_status moray_average_plant(moray_map *map, const moray_plant_spec *spec);

MORAY_END

#endif
