// SPDX-License-Identifier: MIT
//
// What stands between a swimmer and who steers it: sensors that are noisy, slow, late and now and then silent, and
// actuators that are late and slow.
#ifndef MORAY_SNAKE_INSTRUMENTS_H
#define MORAY_SNAKE_INSTRUMENTS_H

#include "moray/export.h"
#include "moray/snake/controllers.h"

MORAY_BEGIN

// All zero: perfect, at every look of the controller.
typedef struct moray_sensors {
    double heading;     // standard deviation of the compass in the head link [rad]
    double joints;      // of every joint angle, by which the mean heading follows from the head's [rad]
    double position;    // of either coordinate [m]
    bool gyro;          // the rate of the mean heading is measured too, by a gyro and the joints
    double rate;        // standard deviation of it [rad/s]
    double sampling;    // between two readings [s]
    double delay;       // of a reading until it is to be had [s]
    double drop_out;    // chance of a reading to be lost
    unsigned long seed; // the same seed, the same errors
} moray_sensors;

typedef struct moray_actuators {
    double dead_time; // [s], to whole periods of the controller
    double rate;      // of the offset at most [m/s or rad/s]; 0: no limit
    double torque;    // of every joint at most [N m], first-principles model; 0: no limit. The swimmer's, not seen here
} moray_actuators;

// The newest reading to be had.
typedef struct moray_reading {
    double t, heading, p_x, p_y; // when it was taken, what it says
    bool fresh;                  // for the first time
    double rate;                 // of the heading without its undulation [rad/s]; NaN without a gyro
} moray_reading;

typedef struct moray_instruments moray_instruments;

// Around a controller, which measures; it is shown samples whose pose is the newest reading, the undulation of the
// straight motion brought to the present, without state and efforts. All of it must outlive the instruments. Error:
// MORAY_INPUT, MORAY_MEMORY. Free with moray_instruments_free.
MORAY_API moray_status moray_instruments_new(moray_instruments **instruments, const moray_sensors *sensors,
                                             const moray_actuators *actuators, const moray_straight_motion *straight,
                                             int links, const moray_swim_controller *controller);
MORAY_API void moray_instruments_free(moray_instruments *instruments);
MORAY_API moray_swim_controller moray_instruments_controller(moray_instruments *instruments);
MORAY_API const moray_reading *moray_instruments_reading(const moray_instruments *instruments);

// Repeatable random numbers: uniform in [0, 1), and of the standard normal distribution. *seed goes on.
MORAY_API double moray_random(unsigned long *seed);
MORAY_API double moray_random_normal(unsigned long *seed);

MORAY_END

#endif
