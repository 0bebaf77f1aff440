// SPDX-License-Identifier: MIT
//
// What a study of the paper is given, made by hand: no output, no JSON, no progress.
#ifndef TESTS_PROBLEMS_PAPER_DESK_H
#define TESTS_PROBLEMS_PAPER_DESK_H

#include "paper/main.h"
#include "tap.h"

typedef struct paper_desk {
    paper_settings settings;
    paper_telling telling;
    paper p;
} paper_desk;

// theta_max in degrees; delta is 2 pi/(N-1).
static inline void paper_desk_open(paper_desk *desk, const moray_robot *robot, double V_x, double V_y, double theta_max)
{
    *desk = (paper_desk){.settings = {.common = moray_common_default(),
                                      .snake = moray_snake_options_default(),
                                      .theta_max = theta_max * DEG,
                                      .omega = 120 * DEG,
                                      .delta = 2 * M_PI / (robot->links - 1)}};
    desk->settings.snake.robot = *robot;
    desk->settings.common.json = true; // nothing to standard output, which is the test's
    paper *p = &desk->p;
    *p = (paper){
        .settings = &desk->settings, .robot = &desk->settings.snake.robot, .study = "test", .telling = &desk->telling};
    for (int model = 0; model < 2; model++) {
        p->gait[model] = (moray_gait){.omega = desk->settings.omega, .delta = desk->settings.delta};
        p->gait[model] = paper_gait(p, (moray_model)model, desk->settings.theta_max);
    }
    CHECK_OK(moray_test_rig_new(&p->rig, robot, (const double[]){V_x, V_y}, 0), "a rig");
}

static inline void paper_desk_close(paper_desk *desk)
{
    moray_test_rig_free(&desk->p.rig);
    paper_release(&desk->p);
}

static inline moray_robot paper_robot_of(int N)
{
    moray_robot robot = moray_robot_paper();
    robot.links = N;
    return robot;
}

#endif
