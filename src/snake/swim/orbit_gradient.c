// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/swim/orbit.h"

static double omega_of(const moray_orbit *orbit)
{
    return moray_periodic_orbit_parameters(orbit->engine)[ORBIT_OMEGA];
}

// By the gait: the period T = 2 pi / omega is no parameter of its own.
static void by_gait(const moray_orbit *orbit, const double by[ORBIT_PARAMETERS], double factor, double gradient[5])
{
    const double omega = omega_of(orbit);
    for (int k = 0; k < ORBIT_GAIT; k++)
        gradient[k] = factor * by[k];
    gradient[ORBIT_OMEGA] -= factor * by[ORBIT_PERIOD] * 2 * M_PI / (omega * omega);
}

static moray_status course_speed_gradient(moray_orbit *orbit, double gradient[5])
{
    const double T = 2 * M_PI / omega_of(orbit), course[2] = {cos(orbit->spec.course), sin(orbit->spec.course)};
    double by[ORBIT_PARAMETERS], slope[ORBIT_ENDS + 1] = {0}, x0[ORBIT_STATES], xT[ORBIT_STATES];
    moray_periodic_orbit_state(orbit->engine, 0, x0);
    moray_periodic_orbit_state(orbit->engine, T, xT);
    for (int k = 0; k < 2; k++) {
        slope[1 + k] = -course[k] / T;
        slope[ORBIT_STATES + 1 + k] = course[k] / T;
        slope[2 * ORBIT_STATES + ORBIT_PERIOD] -= course[k] * (xT[1 + k] - x0[1 + k]) / (T * T);
    }
    MORAY_TRY(moray_periodic_orbit_ends_gradient(orbit->engine, slope, by));
    by_gait(orbit, by, 1, gradient);
    return moray_ok();
}

static moray_status power_gradient(moray_orbit *orbit, double gradient[5])
{
    double by[ORBIT_PARAMETERS];
    MORAY_TRY(moray_periodic_orbit_mean_gradient(orbit->engine, orbit->plant.n_out - 1, by));
    by_gait(orbit, by, 1, gradient);
    return moray_ok();
}

static moray_status steering_gradient(moray_orbit *orbit, double gradient[5])
{
    double by[ORBIT_PARAMETERS], slope[ORBIT_ENDS + 1] = {0};
    slope[orbit->spec.steered ? 2 * ORBIT_STATES + ORBIT_OFFSET : ORBIT_ENDS] = 1;
    MORAY_TRY(moray_periodic_orbit_ends_gradient(orbit->engine, slope, by));
    by_gait(orbit, by, 1, gradient);
    return moray_ok();
}

// Derivatives of a path output by the plant's inputs at the time of a peak. The orbit's own plant has none, each of
// which would cost as much as a rate of the state at every node.
static moray_status output_slope(moray_orbit *orbit, const orbit_peak *peak, int output, double slope[ORBIT_INPUTS])
{
    const moray_map *plant = &orbit->efforts;
    const moray_pattern *pattern = &plant->jac;
    double in[ORBIT_INPUTS];
    if (!plant->value)
        MORAY_TRY(moray_orbit_plant(orbit, true, &orbit->efforts));
    double *values = malloc((size_t)(pattern->nnz + 1) * sizeof *values);
    if (!values)
        return moray_error(MORAY_MEMORY, "no memory for %d derivatives", pattern->nnz);
    moray_periodic_orbit_state(orbit->engine, peak->time, in);
    memcpy(in + ORBIT_STATES, moray_periodic_orbit_parameters(orbit->engine), ORBIT_GAIT * sizeof *in);
    in[ORBIT_INPUTS - 1] = peak->time;
    plant->jacobian(plant->self, in, values);
    memset(slope, 0, ORBIT_INPUTS * sizeof *slope);
    for (int e = 0; e < pattern->nnz; e++)
        if (pattern->row[e] == ORBIT_STATES + output)
            slope[pattern->col[e]] = values[e];
    free(values);
    return moray_ok();
}

// At the phase of the largest sample; how that phase shifts with the gait has no say where it is a maximum.
static moray_status peak_gradient(moray_orbit *orbit, const orbit_peak *peak, int output, double unit,
                                  double gradient[5])
{
    double by[ORBIT_PARAMETERS], slope[ORBIT_INPUTS];
    MORAY_TRY(output_slope(orbit, peak, output, slope));
    MORAY_TRY(moray_periodic_orbit_point_gradient(orbit->engine, slope, peak->time, by));
    by_gait(orbit, by, (peak->negative ? -1 : 1) / unit, gradient);
    return moray_ok();
}

static moray_status peak_load_gradient(moray_orbit *orbit, double gradient[5])
{
    const orbit_peak *load = &orbit->load;
    const int joints = orbit->spec.robot.links - 1;
    memset(gradient, 0, 5 * sizeof *gradient);
    if (load->size == 0)
        return moray_ok();
    return peak_gradient(orbit, load, joints * (1 + load->line) + load->joint,
                         orbit->spec.robot.motor.torque[load->line], gradient);
}

moray_status moray_orbit_gradients(moray_orbit *orbit, moray_orbit_gradient *gradient)
{
    MORAY_TRY(moray_orbit_check_found(orbit));
    MORAY_TRY(course_speed_gradient(orbit, gradient->course_speed));
    MORAY_TRY(power_gradient(orbit, gradient->power));
    MORAY_TRY(peak_gradient(orbit, &orbit->peak, orbit->peak.joint, 1, gradient->peak_effort));
    MORAY_TRY(peak_load_gradient(orbit, gradient->peak_load));
    return steering_gradient(orbit, gradient->steering);
}
