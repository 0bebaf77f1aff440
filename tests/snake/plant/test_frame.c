// SPDX-License-Identifier: MIT
//
// Erratum E7: in a current the speed through the water of the control-oriented model, on a steady turn, depends on the
// heading as the paper has (15b), (15c), and is one number with the turning of the frame.
#include "tap.h"

#include <string.h>

#include "moray/snake/plant.h"
#include "rk4.h"

#define DEG (M_PI / 180)

enum { STATES = 6, INPUTS = 12 };

typedef struct turn {
    const moray_map *map;
    moray_gait gait;
    double current[2];
} turn;

static bool rates(double t, const double *x, double *dx, void *self)
{
    const turn *on = self;
    double in[INPUTS] = {[6] = on->gait.amplitude, on->gait.omega, on->gait.delta, on->gait.offset, 0, t};
    memcpy(in, x, STATES * sizeof *x);
    on->map->value(on->map->self, in, dx);                              // with the power behind the state
    dx[STATES] = hypot(dx[1] - on->current[0], dx[2] - on->current[1]); // the way through the water instead
    return true;
}

// Least and largest mean speed through the water over periods of the gait, in a full turn after `start` periods.
static void turn_speeds(turn *on, int start, double speed[2])
{
    const double T = 2 * M_PI / on->gait.omega;
    const moray_ode ode = {.n = STATES + 1, .rhs = rates, .self = on};
    int steps = 200;
    const moray_integrator rk4 = {.run = rk4_run, .self = &steps};
    double x[STATES + 1] = {0}, heading = 0;
    speed[0] = INFINITY;
    speed[1] = 0;
    for (int k = 0; k <= start || fabs(x[0] - heading) < 360 * DEG; k++) {
        x[STATES] = 0;
        rk4_run(&rk4, &ode, k * T, (k + 1) * T, x, NULL, 0, NULL, NULL);
        heading = k <= start ? x[0] : heading;
        speed[0] = k < start ? speed[0] : fmin(speed[0], x[STATES] / T);
        speed[1] = k < start ? speed[1] : fmax(speed[1], x[STATES] / T);
    }
}

static void swim(moray_frame frame, double V, double speed[2])
{
    moray_plant_spec spec = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_ON_GAIT, .current = {V, V}};
    spec.robot.hydro.frame = frame;
    const double a = moray_amplitude_from_theta_max(&spec.robot, MORAY_CONTROL_ORIENTED, 20 * DEG, 40 * DEG);
    moray_map map;
    CHECK_OK(moray_control_plant(&map, &spec), "plant");
    const moray_gait gait = {.amplitude = a, .omega = 120 * DEG, .delta = 40 * DEG, .offset = a / 3};
    turn_speeds(&(turn){&map, gait, {V, V}}, 30, speed);
    moray_map_release(&map);
}

int main(void)
{
    double still[2], paper[2], invariant[2];
    swim(MORAY_FRAME_PAPER, 0.1, paper);
    CHECK_NEAR(paper[0], 0.236, 5e-4, "as printed: least speed on a turn in (0.1, 0.1) m/s");
    CHECK_NEAR(paper[1], 0.277, 5e-4, "and largest");
    swim(MORAY_FRAME_INVARIANT, 0.1, invariant);
    CHECK_NEAR(invariant[0], 0.2537, 5e-5, "invariant: the speed there");
    CHECK_NEAR(invariant[1] - invariant[0], 0, 1e-8, "is constant");
    swim(MORAY_FRAME_INVARIANT, 0, still);
    CHECK_NEAR(still[0], invariant[0], 1e-8, "and that in still water");
    return tap_done();
}
