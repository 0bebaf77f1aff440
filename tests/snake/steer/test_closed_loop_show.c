// SPDX-License-Identifier: MIT
//
// What figure and file of a closed loop hold: an arrow where there is a current, a row of every sample.
#include "moray/snake/closed_loop.h"
#include "moray/snake/trial.h"

#include "results/folder.h"

enum { SAMPLES = 6 };

static moray_swim_closed_loop sail(const double current[2])
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait gait = moray_gait_paper(&robot);
    moray_straight_motion straight;
    moray_swim_closed_loop closed_loop;
    CHECK_OK(moray_straight_motion_find(&straight, &robot, MORAY_CONTROL_ORIENTED, &gait), "straight");
    const moray_swim_closed_loop_spec plan = {.robot = &robot,
                                              .straight = &straight,
                                              .heading = 0.4,
                                              .current = {current[0], current[1]},
                                              .duration = 1,
                                              .intervals = SAMPLES - 1,
                                              .tolerance = 1e-6};
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &plan), "closed loop");
    return closed_loop;
}

// Along an axis or across it, a current is drawn, with its speed; still water is not.
static void test_arrow(void)
{
    static const double currents[][2] = {{0, 0}, {0.1, 0}, {0, -0.1}, {0.06, 0.08}};
    const char *const label = "the robot's way";
    const moray_colour colour = MORAY_COLOUR_BEST;
    for (int k = 0; k < 4; k++) {
        moray_swim_closed_loop closed_loop = sail(currents[k]);
        moray_output *output = open_in("drawn");
        CHECK_OK(moray_swim_closed_loop_draw_path(output, &closed_loop, &label, &colour, 1, currents[k], NULL),
                 "figure");
        CHECK_OK(moray_output_commit(output), "commit");
        char *svg = content("drawn/path.svg");
        CHECK(strstr(svg, "way</text>") && !strstr(svg, "current, 0.1 m/s") == (k == 0), "%g m/s along x, %g along y",
              currents[k][0], currents[k][1]);
        free(svg);
        moray_output_free(output);
        moray_swim_closed_loop_free(&closed_loop);
    }
}

// The numbers of a row: time, heading, place and velocity over ground, offset, work.
static bool is_row(const moray_swim_closed_loop *closed_loop, int k, const char *line)
{
    const moray_pose *pose = &closed_loop->track.pose[k];
    const double want[] = {
        closed_loop->track.t[k],     pose->heading, pose->p_x, pose->p_y, pose->v_x, pose->v_y, closed_loop->offset[k],
        closed_loop->track.energy[k]};
    bool same = true;
    for (unsigned j = 0; j < sizeof want / sizeof *want; j++) {
        char *end;
        const double is = strtod(line, &end);
        same = same && is == want[j] && *end == (j < 7 ? ',' : '\n');
        line = end + 1;
    }
    return same;
}

static void test_rows(void)
{
    moray_swim_closed_loop closed_loop = sail((double[]){0.02, 0.03});
    moray_output *output = open_in("written");
    CHECK_OK(moray_swim_closed_loop_write(output, &closed_loop), "file");
    CHECK_OK(moray_output_commit(output), "commit");
    char *text = content("written/trajectory.csv"), *line = text;
    const char *const names = "t [s],heading [rad],p_x [m],p_y [m],v_x [m/s],v_y [m/s],phi_0 [m],energy [J]\n";
    CHECK(strncmp(text, names, strlen(names)) == 0, "names and units: %.100s", text);
    int rows = 0;
    while ((line = strchr(line, '\n')) && *++line)
        rows += rows < SAMPLES && is_row(&closed_loop, rows, line) ? 1 : SAMPLES;
    CHECK(rows == SAMPLES, "a row of every sample, as it was swum");
    free(text);
    moray_output_free(output);
    moray_swim_closed_loop_free(&closed_loop);
}

// Three joints and the offset, where the robot steers most.
static void test_joints(void)
{
    moray_swim_closed_loop closed_loop = sail((double[]){0, 0});
    moray_output *output = open_in("joints");
    CHECK_OK(moray_swim_closed_loop_draw_joints(output, &closed_loop), "figure");
    CHECK_OK(moray_output_commit(output), "commit");
    char *svg = content("joints/joints.svg");
    static const char *const labels[] = {"joint at the tail", "in the middle", "at the head", "offset"};
    for (int k = 0; k < 4; k++)
        CHECK(strstr(svg, labels[k]), "%s is drawn", labels[k]);
    free(svg);
    moray_output_free(output);
    moray_swim_closed_loop_free(&closed_loop);
}

int main(void)
{
    if (!enter())
        return 1;
    test_arrow();
    test_rows();
    test_joints();
    leave();
    return tap_done();
}
