// SPDX-License-Identifier: MIT
#include "links.h"

// Components of a vector across and along a link.
static void split(const chain_link *link, double x, double y, double part[DIRECTIONS])
{
    const double c = cos(link->theta[0]), s = sin(link->theta[0]);
    part[NORMAL] = c * y - s * x;
    part[TANGENTIAL] = c * x + s * y;
}

void link_force(const moray_robot *robot, const double current[2], const chain_link *link, double force[DIRECTIONS])
{
    double velocity[DIRECTIONS], acceleration[DIRECTIONS], water[DIRECTIONS];
    split(link, link->x[1] - current[0], link->y[1] - current[1], velocity);
    split(link, link->x[2], link->y[2], acceleration);
    split(link, current[0], current[1], water);
    force[TANGENTIAL] = -robot->c_t * velocity[TANGENTIAL];
    force[NORMAL] = -robot->c_n * velocity[NORMAL] - robot->mu_n * acceleration[NORMAL] -
                    robot->mu_n * link->theta[1] * water[TANGENTIAL];
}

// (4)
static double torque(const moray_robot *robot, const chain_link *link)
{
    const double w = link->theta[1];
    return -robot->lambda_1 * link->theta[2] - robot->lambda_2 * w - robot->lambda_3 * w * fabs(w);
}

// In the frame that goes with the water.
static double kinetic_energy(const moray_robot *robot, const chain *c, int k)
{
    double energy = 0;
    for (int i = 0; i < c->N; i++) {
        const chain_link *link = &c->link[k * c->N + i];
        const double v_x = link->x[1] - c->current[0], v_y = link->y[1] - c->current[1], w = link->theta[1];
        energy += robot->m / 2 * (v_x * v_x + v_y * v_y) + robot->J / 2 * w * w;
    }
    return energy;
}

static void add_sample(const moray_robot *robot, const chain *c, int k, double dt, link_work *w)
{
    for (int i = 0; i < c->N; i++) {
        const chain_link *link = &c->link[k * c->N + i];
        double force[DIRECTIONS], velocity[DIRECTIONS];
        link_force(robot, c->current, link, force);
        split(link, link->x[1] - c->current[0], link->y[1] - c->current[1], velocity);
        for (int d = 0; d < DIRECTIONS; d++)
            w->of_link[d][i] += force[d] * velocity[d] * dt;
        w->force[NORMAL] -= force[NORMAL] * sin(link->theta[0]) / CHAIN_PERIOD;
        w->force[TANGENTIAL] += force[TANGENTIAL] * cos(link->theta[0]) / CHAIN_PERIOD;
        w->torque_work += torque(robot, link) * link->theta[1] * dt;
    }
}

moray_status link_work_of(paper *p, const chain *c, link_work *w)
{
    const moray_swim_track *orbit = c->orbit;
    *w = (link_work){.joint_work = orbit->energy[CHAIN_PERIOD] - orbit->energy[0]};
    for (int d = 0; d < DIRECTIONS; d++)
        MORAY_TRY(paper_numbers(p, (size_t)c->N, &w->of_link[d]));
    for (int k = 0; k < CHAIN_PERIOD; k++)
        add_sample(p->robot, c, k, (orbit->t[CHAIN_PERIOD] - orbit->t[0]) / CHAIN_PERIOD, w);
    for (int d = 0; d < DIRECTIONS; d++)
        for (int i = 0; i < c->N; i++)
            w->work[d] += w->of_link[d][i];
    w->residual = w->joint_work + w->work[NORMAL] + w->work[TANGENTIAL] + w->torque_work -
                  (kinetic_energy(p->robot, c, CHAIN_PERIOD) - kinetic_energy(p->robot, c, 0));
    return moray_ok();
}
