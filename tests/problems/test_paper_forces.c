// SPDX-License-Identifier: MIT
//
// Studies of the force terms (6) and of the work on the links: against the model's own accelerations, the link forces
// in the link's directions, differences in time, and the balances of momentum and energy.
#include "paper_desk.h"
#include "paper/errata.h"
#include "paper/forces.h"
#include "paper/links.h"
#include "random_robot.h"

static chain_link random_link(random_seed *seed)
{
    chain_link link;
    random_vector(seed, 2, 3, link.theta);
    random_vector(seed, 2, 3, link.x);
    random_vector(seed, 2, 3, link.y);
    return link;
}

// The matrices (3) of the terms of (6) against the forces across and along the link, in any state.
static void check_terms_of_link(void)
{
    random_seed seed = 6;
    double error = 0;
    for (int trial = 0; trial < 100; trial++) {
        const moray_robot robot = random_robot(&seed, 2);
        const chain_link link = random_link(&seed);
        double V[2], term[TERMS], force[DIRECTIONS], sum = 0;
        random_vector(&seed, 1, 2, V);
        force_terms_of_link(&robot, V, &link, term);
        link_force(&robot, V, &link, force);
        for (int j = 0; j < TERMS; j++)
            sum += term[j];
        error =
            tap_worse(error, fabs(sum - (cos(link.theta[0]) * force[TANGENTIAL] - sin(link.theta[0]) * force[NORMAL])));
    }
    CHECK_NEAR(error, 0, 1e-13, "terms I-VIII add up to the force along x");
}

// f'(t) of periodic samples by differences of order 8.
static double slope(const chain_link *link, int N, int k, size_t offset, double h)
{
    static const double weight[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
    double sum = 0;
    for (int d = 1; d <= 4; d++) {
        const char *after = (const char *)&link[(k + d) * N], *before = (const char *)&link[(k - d) * N];
        sum += weight[d - 1] * (*(const double *)(after + offset) - *(const double *)(before + offset)) / h;
    }
    return sum;
}

// Places of the links against the swimmer's own, their derivatives against differences in time.
static void check_kinematics(const paper *p, const chain *c)
{
    const int N = c->N;
    const double h = c->orbit->t[1] - c->orbit->t[0], ch = cos(c->heading), sh = sin(c->heading);
    double x[MAX_LINKS], y[MAX_LINKS], angle[MAX_LINKS], place = 0, velocity = 0, acceleration = 0;
    for (int k = 4; k < CHAIN_POINTS - 4; k += 7) {
        moray_swimmer_links(p->rig.swimmer[MORAY_FIRST_PRINCIPLES], c->orbit->x + k * c->orbit->n_states, x, y, angle);
        for (int i = 0; i < N; i++) {
            const chain_link *link = &c->link[k * N + i], *all = &c->link[i];
            place = tap_worse(place, fabs(link->x[0] - (ch * x[i] + sh * y[i])));
            place = tap_worse(place, fabs(link->y[0] - (ch * y[i] - sh * x[i])));
            place = tap_worse(place, fabs(link->theta[0] - (angle[i] - c->heading)));
            for (int d = 1; d < 3; d++) {
                double *worst = d == 1 ? &velocity : &acceleration;
                const size_t back = (size_t)(d - 1) * sizeof(double);
                *worst = fmax(*worst, fabs(link->x[d] - slope(all, N, k, offsetof(chain_link, x) + back, h)));
                *worst = fmax(*worst, fabs(link->y[d] - slope(all, N, k, offsetof(chain_link, y) + back, h)));
                *worst = fmax(*worst, fabs(link->theta[d] - slope(all, N, k, offsetof(chain_link, theta) + back, h)));
            }
        }
    }
    CHECK_NEAR(place, 0, 1e-13, "places and angles of the links, turned by the heading [m, rad]");
    CHECK_NEAR(velocity, 0, 1e-7, "velocities against differences of the places");
    CHECK_NEAR(acceleration, 0, 1e-7, "accelerations against differences of the velocities");
}

static void check_forces(paper *p, chain *c, force_terms *f)
{
    double sum = 0, of_links = 0;
    CHECK_OK(chain_swim(p, p->rig.current, &p->gait[MORAY_FIRST_PRINCIPLES], c), "steady swimming");
    CHECK_OK(force_terms_of(p, c, f), "terms");
    check_kinematics(p, c);
    CHECK_NEAR(f->residual, 0, 1e-9, "I + ... + VIII = N m p_x'' at every time [N]");
    CHECK(f->residual > 0, "which are two different computations");
    for (int j = 0; j < TERMS; j++) {
        double mean = 0;
        sum += f->mean[j];
        for (int i = 0; i < c->N; i++)
            mean += f->of_link[j * c->N + i];
        of_links = tap_worse(of_links, fabs(mean - f->mean[j]));
    }
    CHECK_NEAR(of_links, 0, 1e-13, "means of the links add up to the means of the terms [N]");
    CHECK_NEAR(sum / f->thrust, 0, 1e-5, "in steady swimming the means balance");
}

// Sums to zero in still water: what the body gains it loses.
static void check_work(paper *p, const chain *c)
{
    link_work w;
    CHECK_OK(link_work_of(p, c, &w), "work");
    CHECK_NEAR(w.residual / w.joint_work, 0, 1e-6, "joints, fluid and kinetic energy balance");
    CHECK(w.joint_work > 0 && w.work[TANGENTIAL] < 0 && w.torque_work < 0, "drag takes what the joints give");
    CHECK_NEAR((w.force[NORMAL] + w.force[TANGENTIAL]) / w.force[NORMAL], 0, 1e-5, "thrust and drag balance");
    CHECK(w.force[NORMAL] > 0, "Property 2: the forces across the links push forward: %g N", w.force[NORMAL]);
}

static void check_still_water(void)
{
    paper_desk desk;
    chain c;
    force_terms f;
    const moray_robot robot = moray_robot_paper();
    paper_desk_open(&desk, &robot, 0, 0, 20);
    check_forces(&desk.p, &c, &f);
    check_work(&desk.p, &c);
    CHECK(f.share[3] > 0.99, "Property 1: term IV is the propulsion: %g of it", f.share[3]);
    CHECK(fabs(f.share[0]) < 0.01, "Property 1: term I is not significant: %g", f.share[0]);
    CHECK(f.peak[4] == 0 && f.peak[5] == 0 && f.peak[6] == 0 && f.peak[7] == 0, "without current V-VIII are zero");
    CHECK_NEAR(f.cancelled[2], 0, 1e-12, "drag of equal signs does not cancel");
    paper_desk_close(&desk);
}

static void check_current(int N, double V_x, double V_y, double theta_max)
{
    paper_desk desk;
    chain c;
    force_terms f;
    const moray_robot robot = paper_robot_of(N);
    paper_desk_open(&desk, &robot, V_x, V_y, theta_max);
    check_forces(&desk.p, &c, &f);
    check_work(&desk.p, &c);
    CHECK(f.mean[6] * V_x > 0, "term VII acts in the direction of V_x: %g N", f.mean[6]);
    const double cancelling = fabs(f.share[4]) + fabs(f.share[5]) + fabs(f.share[7]);
    CHECK(cancelling < 1e-3, "Property 1: in the mean V, VI, VIII come to nothing: %g", cancelling);
    paper_desk_close(&desk);
}

// Amplitudes of the links across and along: in the control-oriented model all links go along with the body (9).
static void check_paths(void)
{
    paper_desk desk;
    link_paths paths[2];
    const moray_robot robot = moray_robot_paper();
    paper_desk_open(&desk, &robot, 0.1, 0.1, 20);
    double spread = 0, ratio = INFINITY;
    for (int model = 0; model < 2; model++)
        CHECK_OK(link_paths_of(&desk.p, (moray_model)model, &paths[model]), "paths");
    for (int i = 0; i < robot.links; i++) {
        const link_paths *rigid = &paths[MORAY_CONTROL_ORIENTED], *chain_of = &paths[MORAY_FIRST_PRINCIPLES];
        spread = tap_worse(spread, fabs(rigid->along_amplitude[i] - rigid->along_amplitude[0]));
        ratio = fmin(ratio, chain_of->across_amplitude[i] / chain_of->along_amplitude[i]);
    }
    CHECK_NEAR(spread, 0, 1e-9, "(9): the links share their motion along");
    CHECK(ratio > 5, "Property 4: the links move across, at least %g times as far as along", ratio);
    paper_desk_close(&desk);
}

// (14a), part by part, against the acceleration (15b) that the swimmer solves for.
static void check_tangential_force(void)
{
    random_seed seed = 14;
    double error = 0;
    for (int k = 0; k < ROBOT_SIZES; k++) {
        const int N = robot_links[k];
        const moray_robot robot = random_robot(&seed, N);
        double V[2], x[MAX_STATES], ubar[MAX_LINKS], dx[MAX_STATES];
        moray_swimmer *swimmer;
        random_vector(&seed, 1, 2, V);
        random_vector(&seed, 0.3, 2 * N + 4, x);
        random_vector(&seed, 3, N - 1, ubar);
        CHECK_OK(moray_swimmer_new(&swimmer, &robot, MORAY_CONTROL_ORIENTED), "a swimmer");
        moray_swimmer_set_current(swimmer, V[0], V[1]);
        CHECK(moray_swimmer_rates(swimmer, x, ubar, dx, NULL), "regular");
        const tangential_force f = tangential_force_of(&robot, V, x, ubar, dx[2 * N + 3]);
        error = tap_worse(error, fabs(f.added_mass + f.c_p + f.drag - N * robot.m * dx[2 * N + 2]));
        moray_swimmer_free(swimmer);
    }
    CHECK_NEAR(error, 0, 1e-12, "(14a) adds up to N m dv_t [N]");
}

int main(void)
{
    check_terms_of_link();
    check_tangential_force();
    check_still_water();
    check_current(10, 0.1, 0.1, 20);
    check_current(7, -0.05, 0.03, 15);
    check_current(14, 0.08, -0.12, 12);
    check_paths();
    return tap_done();
}
