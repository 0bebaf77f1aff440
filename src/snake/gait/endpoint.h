// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_GAIT_ENDPOINT_H
#define SRC_SNAKE_GAIT_ENDPOINT_H

#include "moray/snake/gait_problem.h"

// The ends of the optimal-gait problem. Objective: minus the speed along the course,
// or the work of joints or motors, and of the constant power, per distance along it. Events: periodicity of every state
// but the position, displacement across the course [m], omega T [rad], amplitude in the middle of the body as bounded
// by moray_gait_amplitude_bounds, its square for the last and the first link where the taper may be positive and
// negative; then where limited mean power [W], largest rate amplitude (of the last joint, of the first), speed along
// the course [m/s], largest link angles (12) to the left and the right [rad] of a control-oriented gait.
struct gait_endpoint {
    int nx, position; // states; first of p_x, p_y
    double course[2]; // unit vector
    bool revolute;    // amplitude by (27), else by (33) with links of length L
    double L;
    int links;
    int series;      // parameters of a series, omega the first, which has no amplitude; 0: those of a gait
    bool head, tail; // a taper above and below 0 is allowed
    moray_gait_goal goal;
    bool power, rate, speed;
    bool left, right; // link angles are bounded to this side: the offset may turn them there, or nowhere
    double constant;  // power that is drawn whatever the joints do [W]
};

enum { GAIT_OPTIONAL_EVENTS = 15 }; // events behind the first nx, at most

// The endpoint function of moray_ocp_spec; data is a struct gait_endpoint.
void moray_gait_ends(const moray_ends *at, moray_end_values *out, const void *data);

int moray_gait_events(const struct gait_endpoint *endpoint);      // how many
int moray_gait_power_event(const struct gait_endpoint *endpoint); // place of the mean power among them

typedef char gait_name[40];

// What the events are called, name[moray_gait_events(endpoint)], and as many texts.
void moray_gait_event_names(const struct gait_endpoint *endpoint, gait_name *text, const char **name);

// What the n path outputs are called: joint efforts if any, then what the motors' supply allows by so many lines,
// angles of the links, rates of the joints. name[n] into text[n].
void moray_gait_path_names(int n, int efforts, int lines, int links, gait_name *text, const char **name);

// Bounds of the amplitude event for a range of theta_max: (33) a / (L cos(delta/2)) = sin theta_max, or
// (27) alpha / (2 sin(delta/2)) = theta_max.
moray_bounds moray_gait_amplitude_bounds(const struct gait_endpoint *endpoint, moray_bounds theta_max);

#endif
