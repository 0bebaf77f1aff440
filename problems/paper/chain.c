// SPDX-License-Identifier: MIT
#include "chain.h"

#include <stdlib.h>
#include <string.h>

// The last sample is the first of the next period.
double chain_mean(const double *values)
{
    double sum = 0;
    for (int k = 0; k < CHAIN_PERIOD; k++)
        sum += values[k];
    return sum / CHAIN_PERIOD;
}

double chain_heading_swing(const chain *c)
{
    return paper_half_range(&c->orbit->pose[0].heading, sizeof(moray_pose) / sizeof(double), CHAIN_POINTS);
}

static double mean_heading(const moray_swim_track *orbit)
{
    double sum = 0;
    for (int k = 0; k < CHAIN_PERIOD; k++)
        sum += orbit->pose[k].heading;
    return sum / CHAIN_PERIOD;
}

// A vector of the global frame in one turned by psi.
static void turn(double psi, const double global[2], double turned[2])
{
    turned[0] = cos(psi) * global[0] + sin(psi) * global[1];
    turned[1] = cos(psi) * global[1] - sin(psi) * global[0];
}

// Half a link l (cos theta, sin theta) and its derivatives in time.
static void half_link(double l, const double theta[3], double x[3], double y[3])
{
    const double c = cos(theta[0]), s = sin(theta[0]), w = theta[1];
    x[0] = l * c;
    y[0] = l * s;
    x[1] = -l * s * w;
    y[1] = l * c * w;
    x[2] = -l * (s * theta[2] + c * w * w);
    y[2] = l * (c * theta[2] - s * w * w);
}

// Adds half a link to the end of the chain so far.
static void grow(const double half[3], double end[3])
{
    for (int d = 0; d < 3; d++)
        end[d] += half[d];
}

// Links from their angles: each begins where the one before ends, and their mean is the given centre of mass.
static void place(int N, double l, const double p_x[3], const double p_y[3], chain_link *link)
{
    double end_x[3] = {0}, end_y[3] = {0}, half_x[3], half_y[3], mean_x[3] = {0}, mean_y[3] = {0};
    for (int i = 0; i < N; i++) {
        half_link(l, link[i].theta, half_x, half_y);
        grow(half_x, end_x);
        grow(half_y, end_y);
        memcpy(link[i].x, end_x, sizeof end_x);
        memcpy(link[i].y, end_y, sizeof end_y);
        grow(half_x, end_x);
        grow(half_y, end_y);
        for (int d = 0; d < 3; d++) {
            mean_x[d] += link[i].x[d] / N;
            mean_y[d] += link[i].y[d] / N;
        }
    }
    for (int i = 0; i < N; i++)
        for (int d = 0; d < 3; d++) {
            link[i].x[d] += p_x[d] - mean_x[d];
            link[i].y[d] += p_y[d] - mean_y[d];
        }
}

// State x and its rates dx as links in a frame turned by psi.
static void read_state(const moray_robot *robot, double psi, const double *x, const double *dx, chain_link *link,
                       double *force)
{
    const int N = robot->links, half = N + 2;
    double p_x[3], p_y[3], turned[2];
    const double *derivative[3] = {x, x + half, dx + half};
    for (int d = 0; d < 3; d++) {
        turn(psi, derivative[d] + N, turned);
        p_x[d] = turned[0];
        p_y[d] = turned[1];
        for (int i = 0; i < N; i++)
            link[i].theta[d] = derivative[d][i] - (d == 0 ? psi : 0);
    }
    place(N, robot->l, p_x, p_y, link);
    *force = N * robot->m * p_x[2];
}

static moray_status read_orbit(paper *p, const moray_gait *gait, chain *c)
{
    moray_swimmer *swimmer = p->rig.swimmer[MORAY_FIRST_PRINCIPLES];
    const int N = p->robot->links, n = moray_swimmer_states(swimmer);
    double *ubar;
    MORAY_TRY(paper_numbers(p, (size_t)(n + N), &ubar));
    for (int k = 0; k < CHAIN_POINTS; k++) {
        const double *x = c->orbit->x + k * n;
        double *dx = ubar + N;
        moray_swimmer_control(swimmer, gait, c->orbit->t[k], x, ubar);
        if (!moray_swimmer_rates(swimmer, x, ubar, dx, NULL))
            return moray_error(MORAY_NUMERIC, "the first-principles model is singular at t = %g", c->orbit->t[k]);
        read_state(p->robot, c->heading, x, dx, c->link + k * N, &c->force[k]);
    }
    return moray_ok();
}

moray_status chain_swim(paper *p, const double current[2], const moray_gait *gait, chain *c)
{
    moray_swim_track *orbit;
    MORAY_TRY(paper_orbit_in(p, current, MORAY_FIRST_PRINCIPLES, gait, CHAIN_POINTS, NULL, &orbit));
    *c = (chain){.N = p->robot->links, .orbit = orbit, .heading = mean_heading(orbit)};
    turn(c->heading, current, c->current);
    c->link = calloc((size_t)(CHAIN_POINTS * c->N), sizeof *c->link);
    MORAY_TRY(paper_own(p, c->link, free));
    MORAY_TRY(paper_numbers(p, CHAIN_POINTS, &c->force));
    moray_swimmer *swimmer = p->rig.swimmer[MORAY_FIRST_PRINCIPLES];
    moray_swimmer_set_current(swimmer, current[0], current[1]);
    const moray_status status = read_orbit(p, gait, c);
    moray_swimmer_set_current(swimmer, p->rig.current[0], p->rig.current[1]);
    return status;
}
