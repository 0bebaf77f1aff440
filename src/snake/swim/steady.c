// SPDX-License-Identifier: MIT
#include "snake/swim/steady.h"

#include <math.h>
#include <stddef.h>

#include "snake/swim/closed_loop_plant.h"

static const double TREND = 1e-5; // largest relative change of speed and power a period that counts as steady
static const double SLOW = 1e-3;  // speeds [m/s] and powers [W] below agree absolutely

moray_swim_settings moray_swim_settings_default(void)
{
    return (moray_swim_settings){.sim = moray_sim_settings_default(), .agreement = 1e-7, .max_periods = 200};
}

static moray_status check(const moray_swim_setup *setup, const moray_gait *gait, double start_heading)
{
    const moray_swim_settings *settings = &setup->settings;
    if (!(gait->omega > 0 && isfinite(gait->omega)))
        return moray_error(MORAY_INPUT, "omega = %g: a steady gait needs a finite omega above 0", gait->omega);
    if (!isfinite(gait->amplitude) || !isfinite(gait->delta) || !isfinite(gait->offset) || !isfinite(gait->taper))
        return moray_error(MORAY_INPUT, "gait amplitude = %g, delta = %g, offset = %g, taper = %g: must be finite",
                           gait->amplitude, gait->delta, gait->offset, gait->taper);
    if (!isfinite(start_heading) || !isfinite(setup->current[0]) || !isfinite(setup->current[1]))
        return moray_error(MORAY_INPUT, "start heading = %g, current = (%g, %g): must be finite", start_heading,
                           setup->current[0], setup->current[1]);
    if (!(settings->agreement > 0 && settings->agreement < 1))
        return moray_error(MORAY_INPUT, "agreement = %g: must lie between 0 and 1", settings->agreement);
    if (settings->max_periods < 3)
        return moray_error(MORAY_INPUT, "max_periods = %d: must be at least 3", settings->max_periods);
    return moray_ok();
}

// A swimmer on its way, at the end of a whole number of periods.
typedef struct {
    const moray_swim_setup *setup;
    swim_plant *plant;
    moray_sim *sim;
    double period;
} closed_loop;

// Velocities, power and heading drift of the period since the earlier sample, from its ends.
static void means(const closed_loop *v, const moray_swim_sample *from, const moray_swim_sample *to,
                  moray_steady *steady)
{
    const double *V = v->setup->current, T = v->period;
    steady->v_x = (to->pose.p_x - from->pose.p_x) / T;
    steady->v_y = (to->pose.p_y - from->pose.p_y) / T;
    steady->speed = hypot(steady->v_x - V[0], steady->v_y - V[1]);
    steady->power = (to->energy - from->energy) / T;
    steady->cost_of_transport = steady->speed > 0 ? steady->power / steady->speed : INFINITY;
    steady->heading_drift = (to->pose.heading - from->pose.heading) / T;
    steady->turning = fabs(steady->heading_drift * T) > TURNING;
}

static moray_status advance(closed_loop *v, double t, moray_swim_sample *now)
{
    MORAY_TRY(moray_sim_advance(v->sim, t));
    *now = moray_swim_plant_sample(v->plant, t, moray_sim_state(v->sim));
    return moray_ok();
}

static double change(double now, double before)
{
    return (now - before) / fmax(fabs(now), SLOW);
}

steady_changes moray_steady_changes(const moray_steady *before, const moray_steady *now, const steady_changes *earlier)
{
    const double speed = change(now->speed, before->speed), power = change(now->power, before->power);
    return (steady_changes){speed, power, fmax(fabs(speed - earlier->speed), fabs(power - earlier->power))};
}

bool moray_steady_settled(const steady_changes *now, double agreement)
{
    const double largest = fmax(fabs(now->speed), fabs(now->power));
    return largest < agreement || (largest < TREND && now->bend < agreement);
}

// Whole periods until two agree; `steady` holds the last one's means.
static moray_status settle(closed_loop *v, int min_periods, moray_steady *steady, moray_swim_sample *now)
{
    const moray_swim_settings *settings = &v->setup->settings;
    steady_changes last = {.speed = INFINITY, .power = INFINITY};
    MORAY_TRY(advance(v, 0, now));
    for (int k = 1; k < settings->max_periods; k++) {
        const moray_swim_sample start = *now;
        const moray_steady before = *steady;
        MORAY_TRY(advance(v, k * v->period, now));
        means(v, &start, now, steady);
        steady->periods = k;
        last = moray_steady_changes(&before, steady, &last);
        if (k > 1 && k + 1 >= min_periods && moray_steady_settled(&last, settings->agreement))
            return moray_ok();
    }
    return moray_error(MORAY_NOT_SOLVED,
                       "not steady after %d periods: speed %.6g m/s still changes by %.2g of itself a period, power "
                       "%.6g W by %.2g; the heading drifts at %.3g rad/s%s",
                       settings->max_periods, steady->speed, last.speed, steady->power, last.power,
                       steady->heading_drift, steady->turning ? ": the gait turns" : "");
}

// One period more, sampled finely: peaks, mean heading, orbit.
static moray_status measure(closed_loop *v, moray_swim_sample *now, moray_steady *steady, moray_swim_track *orbit,
                            int points)
{
    const int stride = (FINEST + points - 2) / (points - 1), fine = stride * (points - 1);
    const double start = steady->periods * v->period;
    const moray_swim_sample first = *now;
    double heading = 0;
    steady->peak_effort = steady->peak_link_angle = 0;
    for (int k = 0; k <= fine; k++) {
        MORAY_TRY(advance(v, k < fine ? start + v->period * k / fine : (steady->periods + 1) * v->period, now));
        for (int i = 0; i < v->plant->n_joints; i++)
            steady->peak_effort = fmax(steady->peak_effort, fabs(now->u[i]));
        steady->peak_link_angle = fmax(steady->peak_link_angle, now->pose.link_angle);
        heading += (k == 0 || k == fine ? 0.5 : 1) * now->pose.heading / fine;
        if (orbit && k % stride == 0)
            moray_swim_track_add(now, orbit);
    }
    means(v, &first, now, steady);
    steady->heading = heading;
    steady->periods++;
    return moray_ok();
}

// Time, position (both models: states N and N+1) and work count from the first sample.
static void shift_to_origin(moray_swim_track *orbit, int links)
{
    const double t = orbit->t[0], energy = orbit->energy[0], p_x = orbit->pose[0].p_x, p_y = orbit->pose[0].p_y;
    for (int k = 0; k < orbit->n; k++) {
        double *x = orbit->x + (size_t)k * orbit->n_states;
        orbit->t[k] -= t;
        orbit->energy[k] -= energy;
        orbit->pose[k].p_x = x[links] -= p_x;
        orbit->pose[k].p_y = x[links + 1] -= p_y;
    }
}

static moray_status sail(closed_loop *v, int min_periods, moray_steady *steady, moray_swim_track *orbit, int points)
{
    moray_swim_sample now;
    moray_swimmer_rest(v->plant->swimmer, steady->start_heading, 0, 0, v->plant->x);
    MORAY_TRY(moray_sim_start(v->sim, 0, v->plant->x));
    MORAY_TRY(settle(v, min_periods, steady, &now));
    MORAY_TRY(measure(v, &now, steady, orbit, points));
    if (orbit)
        shift_to_origin(orbit, moray_swimmer_robot(v->plant->swimmer)->links);
    return moray_ok();
}

static moray_status with_plant(const moray_swim_setup *setup, swim_plant *plant, int min_periods, moray_steady *steady,
                               moray_swim_track *orbit, int points)
{
    closed_loop v = {.setup = setup, .plant = plant, .period = 2 * M_PI / plant->gait.omega};
    const moray_ode ode = moray_swim_plant_ode(plant);
    MORAY_TRY(moray_sim_new(&v.sim, &ode, &setup->settings.sim));
    const moray_status status = sail(&v, min_periods, steady, orbit, points);
    moray_sim_free(v.sim);
    return status;
}

moray_status moray_swim_settle(const moray_swim_setup *setup, const moray_gait *gait, double start_heading,
                               int min_periods, moray_steady *steady, moray_swim_track *orbit, int points)
{
    *steady = (moray_steady){.start_heading = start_heading};
    MORAY_TRY(check(setup, gait, start_heading));
    moray_swimmer_set_current(setup->swimmer, setup->current[0], setup->current[1]);
    swim_plant plant;
    MORAY_TRY(moray_swim_plant_new(&plant, setup->swimmer, gait));
    const moray_status status = with_plant(setup, &plant, min_periods, steady, orbit, points);
    moray_swim_plant_free(&plant);
    return status;
}

moray_status moray_swim_steady(const moray_swim_setup *setup, const moray_gait *gait, double start_heading,
                               moray_steady *steady, moray_swim_track *orbit, int points)
{
    if (!orbit)
        return moray_swim_settle(setup, gait, start_heading, 0, steady, NULL, 2);
    *orbit = (moray_swim_track){0};
    if (points < 2)
        return moray_error(MORAY_INPUT, "points = %d: an orbit has at least 2", points);
    MORAY_TRY(moray_swim_track_new(orbit, setup->swimmer, points));
    const moray_status status = moray_swim_settle(setup, gait, start_heading, 0, steady, orbit, points);
    if (moray_failed(status))
        moray_swim_track_free(orbit);
    return status;
}

double moray_course_speed(const moray_steady *steady, double course)
{
    return steady->v_x * cos(course) + steady->v_y * sin(course);
}
