// SPDX-License-Identifier: MIT
//
// What of closed loops is drawn, number by number: gnuplot is a script of ours that keeps what it is told.
#include "degree.h"

#include "moray/snake/closed_loop.h"
#include "moray/snake/trial.h"

#include "results/folder.h"

enum { SAMPLES = 41 };

static moray_offset none(double t, const void *self)
{
    (void)t, (void)self;
    return (moray_offset){0};
}

static moray_swim_closed_loop sail(moray_model model, double heading)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, model);
    const moray_swim_controller controller = {.offset = none};
    const moray_swim_on_gait how = {.steps = 16};
    moray_straight_motion straight;
    moray_swim_closed_loop closed_loop;
    CHECK_OK(moray_straight_motion_find(&straight, &robot, model, &gait), "straight");
    const moray_swim_closed_loop_spec spec = {.robot = &robot,
                                              .straight = &straight,
                                              .heading = heading,
                                              .position = {2, -3},
                                              .controller = &controller,
                                              .duration = 4,
                                              .intervals = SAMPLES - 1,
                                              .on_gait = &how};
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &spec), "closed loop");
    return closed_loop;
}

typedef struct drawn {
    int n;
    double x[4 * SAMPLES], y[4 * SAMPLES];
} drawn;

// The points of a curve that gnuplot was told.
static drawn curve(const char *told, int number)
{
    char name[40];
    drawn found = {0};
    snprintf(name, sizeof name, "$curve%d << EOD\n", number);
    const char *at = strstr(told, name);
    for (at = at ? at + strlen(name) : "EOD"; strncmp(at, "EOD", 3) != 0 && found.n < 4 * SAMPLES;
         at = strchr(at, '\n') + 1)
        found.n += sscanf(at, "%lf %lf", &found.x[found.n], &found.y[found.n]) == 2 && *at != '\n';
    return found;
}

// ---- Joints --------------------------------------------------------------------------------------------------------

// Ten seconds either side of the largest offset, of joints first, middle and last and the offset.
static void check_joints(const moray_swim_closed_loop *closed_loop, double unit, int first, int n)
{
    moray_output *output = open_in("joints");
    CHECK_OK(moray_swim_closed_loop_draw_joints(output, closed_loop), "figure");
    moray_output_free(output);
    char *told = content("told");
    const moray_swim_track *track = &closed_loop->track;
    const int last = track->n_joints - 1, shown[] = {0, last / 2, last};
    double worst = 0, phi[2 * 20];
    for (int j = 0; j < 4; j++) {
        const drawn got = curve(told, j);
        if (!CHECK(got.n == n, "%d samples, %d expected", got.n, n))
            continue;
        for (int k = 0; k < n; k++) {
            moray_swimmer_joints(closed_loop->swimmer, track->x + (first + k) * track->n_states, phi, phi + last + 1);
            worst = tap_worse(worst, fabs(got.x[k] - track->t[first + k]));
            const double want = j < 3 ? phi[shown[j]] : closed_loop->offset[first + k];
            worst = tap_worse(worst, fabs(got.y[k] - want / unit));
        }
    }
    CHECK_NEAR(worst, 0, 1e-9, "times, joints and offset");
    CHECK(strstr(told, unit == DEG ? "joint angle [deg]" : "joint coordinate [cm]"), "in units of the model");
    free(told);
}

static void test_joints(moray_model model)
{
    const double unit = model == MORAY_CONTROL_ORIENTED ? 0.01 : DEG;
    moray_swim_closed_loop closed_loop = sail(model, 0.3);
    for (int k = 0; k < SAMPLES; k++) {
        closed_loop.track.t[k] = k;
        closed_loop.offset[k] = 1e-3 * sin(0.3 * k);
    }
    closed_loop.offset[15] = 0.01;
    closed_loop.offset[22] = -0.02;
    check_joints(&closed_loop, unit, 12, 21);
    closed_loop.offset[17] = 0.02; // as large, before
    check_joints(&closed_loop, unit, 7, 21);
    closed_loop.offset[5] = -0.03;
    check_joints(&closed_loop, unit, 0, 16);
    closed_loop.offset[38] = 0.04;
    check_joints(&closed_loop, unit, 28, 13);
    for (int k = 0; k < SAMPLES; k++)
        closed_loop.track.t[k] = 0.99 * k; // the tenth second lies between two samples
    check_joints(&closed_loop, unit, 27, 14);
    moray_swim_closed_loop_free(&closed_loop);
}

// ---- Paths ---------------------------------------------------------------------------------------------------------

static void widen(const drawn *d, double range[2][2])
{
    for (int k = 0; k < d->n; k++) {
        range[0][0] = fmin(range[0][0], d->x[k]), range[0][1] = fmax(range[0][1], d->x[k]);
        range[1][0] = fmin(range[1][0], d->y[k]), range[1][1] = fmax(range[1][1], d->y[k]);
    }
}

// Curve after curve: the path that is to be followed, each way, the last one's robot; and the current beside the upper
// left of them all, its tip at 0.5 of its length of a tenth of what is drawn, its barbs at 0.2, 0.15 aside.
static void test_path(const double current[2], bool high)
{
    static const double barbs[][2] = {{-0.5, 0}, {0.5, 0}, {0.2, 0.15}, {0.5, 0}, {0.2, -0.15}};
    const double to_x[] = {1.5, NAN, 4.5}, to_y[] = {-3.5, NAN, high ? 9.0 : -3.2};
    const moray_curve path = {.label = "asked for", .x = to_x, .y = to_y, .n = 3};
    const char *const labels[] = {"one", "two"};
    const moray_colour colours[] = {MORAY_COLOUR_BEST, MORAY_COLOUR_SECOND};
    moray_swim_closed_loop both[] = {sail(MORAY_CONTROL_ORIENTED, 0.3), sail(MORAY_FIRST_PRINCIPLES, -2)};
    moray_output *output = open_in("path");
    CHECK_OK(moray_swim_closed_loop_draw_path(output, both, labels, colours, 2, current, &path), "figure");
    moray_output_free(output);
    char *told = content("told");
    double worst = 0, range[2][2] = {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}};
    const drawn asked = curve(told, 0);
    CHECK(asked.n == 2 && asked.x[1] == 4.5, "what is to be followed");
    widen(&asked, range);
    for (int c = 0; c < 2; c++) {
        const drawn way = curve(told, 1 + c);
        CHECK(way.n == SAMPLES, "a way of %d samples", way.n);
        for (int k = 0; k < way.n; k++)
            worst = tap_worse(worst, hypot(way.x[k] - both[c].track.pose[k].p_x, way.y[k] - both[c].track.pose[k].p_y));
        widen(&way, range);
    }
    CHECK_NEAR(worst, 0, 1e-12, "the ways, in order");
    const drawn robot = curve(told, 3), arrow = curve(told, 4);
    CHECK(robot.n > 10 && hypot(robot.x[0] - both[1].track.pose[SAMPLES - 1].p_x,
                                robot.y[0] - both[1].track.pose[SAMPLES - 1].p_y) < 2,
          "the robot where the last one ends");
    widen(&robot, range);
    const double speed = hypot(current[0], current[1]), c = current[0] / speed, s = current[1] / speed;
    const double width = range[0][1] - range[0][0], height = range[1][1] - range[1][0];
    const double size = 0.1 * (width > height ? width : height);
    CHECK((height > width) == high, "%g m wide, %g m high", width, height);
    worst = arrow.n == 5 ? 0 : INFINITY;
    for (int k = 0; k < arrow.n && k < 5; k++)
        worst = tap_worse(worst, hypot(arrow.x[k] - range[0][0] - size * (0.6 + c * barbs[k][0] - s * barbs[k][1]),
                                       arrow.y[k] - range[1][1] - size * (0.6 + s * barbs[k][0] + c * barbs[k][1])));
    CHECK_NEAR(worst, 0, 1e-9, "the current as an arrow");
    CHECK(strstr(told, "current, 0.25 m/s"), "with its speed");
    free(told);
    for (int k = 0; k < 2; k++)
        moray_swim_closed_loop_free(&both[k]);
}

int main(void)
{
    if (!enter())
        return 1;
    stand_in();
    test_joints(MORAY_CONTROL_ORIENTED);
    test_joints(MORAY_FIRST_PRINCIPLES);
    test_path((double[]){0.15, -0.2}, false);
    test_path((double[]){-0.25, 0}, true);
    leave();
    return tap_done();
}
