// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_SWIM_ORBIT_H
#define SRC_SNAKE_SWIM_ORBIT_H

#include "moray/control/periodic_orbit.h"
#include "moray/snake/orbit.h"

// States of the plant with its joints on a gait, and parameters p of its orbit: those of the gait, then the period.
// What is found is the offset where the heading returns, else the turn a period, the w of the orbit.
enum { ORBIT_STATES = 6, ORBIT_GAIT = 5, ORBIT_PARAMETERS = ORBIT_GAIT + 1 };
enum { ORBIT_OMEGA = 1, ORBIT_OFFSET = 3, ORBIT_PERIOD = ORBIT_GAIT };
enum { ORBIT_INPUTS = ORBIT_STATES + ORBIT_GAIT + 1 };     // of the plant
enum { ORBIT_ENDS = 2 * ORBIT_STATES + ORBIT_PARAMETERS }; // inputs of the closing conditions, without w

// Where the largest joint effort was sampled, or the largest share of a line of what the motors give.
typedef struct orbit_peak {
    double time, size;
    int joint, line;
    bool negative; // the effort is, or the share
} orbit_peak;

struct moray_orbit {
    moray_orbit_spec spec; // without the scheme's name
    moray_map plant;       // with the power of the joints
    moray_map efforts;     // the same with efforts and motors of the joints, once they are asked for
    moray_map closing;
    moray_periodic_orbit *engine;
    moray_swimmer *swimmer;   // shows the orbit as simulations do
    double *x, *dx, *u, *phi; // the swimmer's state and rates, efforts; phi, v_phi, ubar of the gait
    moray_gait gait;
    bool found;
    orbit_peak peak, load; // of efforts, of motors
};

// Makes orbit->plant or, with efforts, orbit->efforts. Error: that of moray_fp_plant.
moray_status moray_orbit_plant(const moray_orbit *orbit, bool efforts, moray_map *plant);

// How the orbit closes: p(0) = 0; heading, rate of turn and velocity through the water return, turned; no displacement
// across the course. Uses orbit->spec. Error: MORAY_MEMORY.
moray_status moray_orbit_closing(moray_orbit *orbit);

// The turn a period, 0 where the heading returns.
double moray_orbit_turn(const moray_orbit *orbit);

// Error: MORAY_INPUT when there is no orbit.
moray_status moray_orbit_check_found(const moray_orbit *orbit);

// The swimmer on the orbit at time t; points into the orbit. Energy counts from t = 0. Error: MORAY_NUMERIC.
moray_status moray_orbit_sample(moray_orbit *orbit, double t, moray_swim_sample *sample);

// moray_orbit_solve with nothing but means in result->steady. Peaks and the mean heading are moray_orbit_measure's.
moray_status moray_orbit_find(moray_orbit *orbit, const moray_gait *gait, moray_orbit_result *result);

// Adds the mean heading, and peaks over samples of every degree; sets orbit->peak and orbit->load. Error:
// MORAY_NUMERIC, after which there is no orbit.
moray_status moray_orbit_measure(moray_orbit *orbit, moray_steady *steady);

// Rescales gait->omega, as moray_orbit_match_power does, until the mean power (else the speed) is `target`; nothing but
// means in *steady, and gait->offset stays. Error: that of moray_orbit_match_power; MORAY_INPUT (target).
moray_status moray_orbit_match(moray_orbit *orbit, moray_gait *gait, bool power, double target, moray_steady *steady);

// Whether a robot swims the orbit. Nobody swims one that deviations leave; one that they leave by less than a
// thousandth a period is swum for the time that a comparison needs, as the heading is in a current. Error:
// MORAY_NOT_SOLVED, and those of moray_orbit_floquet.
moray_status moray_orbit_stays(moray_orbit *orbit);

// Means over the period.
moray_steady moray_orbit_means(moray_orbit *orbit);

#endif
