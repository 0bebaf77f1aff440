// SPDX-License-Identifier: MIT
#include "moray/helm.h"

#include <math.h>
#include <string.h>

#include "moray/orbit.h"

// ---- Straight swimming ---------------------------------------------------------------------------------------------

enum { samples = 72 };

// First harmonic and mean of the heading over a period of equidistant samples, turning aside.
static void analyse(const moray_swim_track *track, double *mean, double undulation[2])
{
    const double turn = track->pose[samples].heading - track->pose[0].heading;
    *mean = undulation[0] = undulation[1] = 0;
    for (int k = 0; k < samples; k++) {
        const double phase = 2 * M_PI * k / samples, heading = track->pose[k].heading - turn * k / samples;
        *mean += heading / samples;
        undulation[0] += 2 * heading * cos(phase) / samples;
        undulation[1] += 2 * heading * sin(phase) / samples;
    }
}

// Turns a vector by an angle.
static void turn(double angle, double v[2])
{
    const double c = cos(angle), s = sin(angle), x = v[0];
    v[0] = c * x - s * v[1];
    v[1] = s * x + c * v[1];
}

static void read_orbit(moray_cruise *cruise, const moray_robot *robot, const moray_orbit_result *found,
                       const moray_swim_track *track)
{
    double mean;
    analyse(track, &mean, cruise->undulation);
    cruise->speed = found->steady.speed;
    cruise->power = found->steady.power;
    moray_state_body(cruise->model, robot->links, track->x, cruise->body);
    cruise->body[0] -= mean;
    if (cruise->model == MORAY_FIRST_PRINCIPLES) // else the velocity is in the body's frame
        turn(-mean, cruise->body + 4);
    cruise->body[1] = cruise->body[2] = 0;
}

moray_status moray_cruise_find(moray_cruise *cruise, const moray_robot *robot, moray_model model,
                               const moray_gait *gait)
{
    moray_orbit_spec spec = moray_orbit_spec_default(robot, model);
    moray_orbit *orbit;
    moray_orbit_result found;
    moray_swim_track track = {0};
    *cruise = (moray_cruise){.model = model, .gait = *gait};
    cruise->gait.offset = cruise->gait.offset_rate = cruise->gait.offset_acceleration = 0;
    spec.steered = false;
    MORAY_TRY(moray_orbit_new(&orbit, &spec));
    moray_status status = moray_orbit_solve(orbit, &cruise->gait, &found);
    if (!moray_failed(status))
        status = moray_orbit_track(orbit, samples + 1, &track);
    if (!moray_failed(status))
        read_orbit(cruise, robot, &found, &track);
    moray_swim_track_free(&track);
    moray_orbit_free(orbit);
    return status;
}

moray_status moray_turn_rate(const moray_robot *robot, moray_model model, const moray_gait *gait, double *rate)
{
    moray_orbit_spec spec = moray_orbit_spec_default(robot, model);
    moray_orbit *orbit;
    moray_orbit_result found;
    spec.steered = false;
    MORAY_TRY(moray_orbit_new(&orbit, &spec));
    const moray_status status = moray_orbit_solve(orbit, gait, &found);
    *rate = moray_failed(status) ? NAN : found.steady.heading_drift;
    moray_orbit_free(orbit);
    return status;
}

void moray_cruise_start(const moray_cruise *cruise, double heading, const double current[2],
                        double state[MORAY_STEERING_STATES])
{
    double water[2] = {current[0], current[1]};
    memset(state, 0, MORAY_STEERING_STATES * sizeof *state);
    memcpy(state, cruise->body, sizeof cruise->body);
    state[0] += heading;
    if (cruise->model == MORAY_FIRST_PRINCIPLES)
        turn(heading, state + 4);
    else
        turn(-state[0], water);
    state[4] += water[0];
    state[5] += water[1];
}

double moray_cruise_heading(const moray_cruise *cruise, double t, double heading)
{
    const double phase = cruise->gait.omega * t;
    return heading - cruise->undulation[0] * cos(phase) - cruise->undulation[1] * sin(phase);
}

// ---- Plans carried out ---------------------------------------------------------------------------------------------

moray_offset moray_plan_offset(const moray_plan *plan, double t)
{
    moray_offset offset = moray_steering_offset(plan->solution, t);
    offset.value *= plan->scale;
    offset.rate *= plan->scale;
    offset.acceleration *= plan->scale;
    return offset;
}

static moray_offset blind(double t, const void *self)
{
    return moray_plan_offset(self, t);
}

moray_helm moray_plan_helm(const moray_plan *plan)
{
    return (moray_helm){.offset = blind, .self = (void *)plan};
}

// ---- Feedback ------------------------------------------------------------------------------------------------------

static moray_offset straight(double t, const void *self)
{
    const moray_pilot *pilot = self;
    return (moray_offset){.value = pilot->value + pilot->slope * (t - pilot->from), .rate = pilot->slope};
}

static double clamp(double value, double limit)
{
    return fmin(fmax(value, -limit), limit);
}

static void look(const moray_swim_sample *sample, void *self)
{
    moray_pilot *pilot = self;
    const double t = sample->t, heading = moray_cruise_heading(pilot->cruise, t, sample->pose.heading);
    double wanted = pilot->gain * remainder(pilot->target(sample, pilot->self) - heading, 2 * M_PI);
    if (pilot->feed)
        wanted += pilot->feed(sample, t + pilot->period, pilot->self);
    pilot->value = straight(t, pilot).value;
    pilot->from = t;
    pilot->slope = clamp((clamp(wanted, pilot->offset) - pilot->value) / pilot->period, pilot->offset_rate);
}

moray_helm moray_pilot_helm(moray_pilot *pilot)
{
    return (moray_helm){.offset = straight, .look = look, .period = pilot->period, .self = pilot};
}
