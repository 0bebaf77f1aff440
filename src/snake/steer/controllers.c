// SPDX-License-Identifier: MIT
#include "moray/snake/controllers.h"

#include <math.h>
#include <string.h>

#include "moray/snake/orbit.h"
#include "snake/steer/problems.h"

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

static void read_orbit(moray_straight_motion *straight, const moray_robot *robot, const moray_orbit_result *found,
                       const moray_swim_track *track)
{
    double mean;
    analyse(track, &mean, straight->undulation);
    straight->speed = found->steady.speed;
    straight->power = found->steady.power;
    moray_state_body(straight->model, robot->links, track->x, straight->body);
    straight->body[MORAY_STATE_THETA] -= mean;
    if (straight->model == MORAY_FIRST_PRINCIPLES) // else the velocity is in the body's frame
        turn(-mean, straight->body + MORAY_STATE_V_1);
    straight->body[MORAY_STATE_P_X] = straight->body[MORAY_STATE_P_Y] = 0;
}

moray_status moray_straight_motion_find(moray_straight_motion *straight, const moray_robot *robot, moray_model model,
                                        const moray_gait *gait)
{
    moray_orbit_spec spec = moray_orbit_spec_default(robot, model);
    moray_orbit *orbit;
    moray_orbit_result found;
    moray_swim_track track = {0};
    *straight = (moray_straight_motion){.model = model, .gait = *gait};
    straight->gait.offset = straight->gait.offset_rate = straight->gait.offset_acceleration = 0;
    spec.steered = false;
    MORAY_TRY(moray_orbit_new(&orbit, &spec));
    moray_status status = moray_orbit_solve(orbit, &straight->gait, &found);
    if (!moray_failed(status))
        status = moray_orbit_track(orbit, samples + 1, &track);
    if (!moray_failed(status))
        read_orbit(straight, robot, &found, &track);
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

void moray_straight_motion_start(const moray_straight_motion *straight, double heading, const double current[2],
                                 double state[MORAY_STEERING_STATES])
{
    double water[2] = {current[0], current[1]};
    memset(state, 0, MORAY_STEERING_STATES * sizeof *state);
    memcpy(state, straight->body, sizeof straight->body);
    state[MORAY_STATE_THETA] += heading;
    if (straight->model == MORAY_FIRST_PRINCIPLES)
        turn(heading, state + MORAY_STATE_V_1);
    else
        turn(-state[0], water);
    state[MORAY_STATE_V_1] += water[0];
    state[MORAY_STATE_V_2] += water[1];
}

void moray_steering_current(const moray_water *water, const double current[2], double x, double y, double t,
                            double V[2])
{
    memcpy(V, current, 2 * sizeof *V);
    if (water)
        moray_water_at(water, x, y, t, V);
}

double moray_straight_motion_heading(const moray_straight_motion *straight, double t, double heading)
{
    const double phase = straight->gait.omega * t;
    return heading - straight->undulation[0] * cos(phase) - straight->undulation[1] * sin(phase);
}

// ---- Plans made ----------------------------------------------------------------------------------------------------

void moray_steering_plan_free(moray_steering_plan *plan)
{
    moray_solution_free(plan->solution);
    moray_steering_problem_free(&plan->problem);
    *plan = (moray_steering_plan){0};
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

moray_swim_controller moray_plan_controller(moray_plan *plan)
{
    return (moray_swim_controller){.offset = blind, .self = plan};
}

// ---- Feedback ------------------------------------------------------------------------------------------------------

static moray_offset straight(double t, const void *self)
{
    const moray_feedback *feedback = self;
    return (moray_offset){.value = feedback->value + feedback->slope * (t - feedback->from), .rate = feedback->slope};
}

static double clamp(double value, double limit)
{
    return fmin(fmax(value, -limit), limit);
}

static moray_status measure(const moray_swim_sample *sample, void *self)
{
    moray_feedback *feedback = self;
    const double t = sample->t, heading = moray_straight_motion_heading(feedback->straight, t, sample->pose.heading);
    double wanted = feedback->gain * remainder(feedback->target(sample, feedback->self) - heading, 2 * M_PI);
    if (feedback->feed)
        wanted += feedback->feed(sample, t + feedback->period, feedback->self);
    feedback->value = straight(t, feedback).value;
    feedback->from = t;
    feedback->slope =
        clamp((clamp(wanted, feedback->offset) - feedback->value) / feedback->period, feedback->offset_rate);
    return moray_ok();
}

moray_swim_controller moray_feedback_controller(moray_feedback *feedback)
{
    return (moray_swim_controller){
        .offset = straight, .measure = measure, .period = feedback->period, .self = feedback};
}
