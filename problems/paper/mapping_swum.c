// SPDX-License-Identifier: MIT
//
// Propositions 1 and 2 on simulated motion.
#include "mapping.h"

enum { POINTS = 721 };

// One period of the gait of a model of the robot with N links, in still water: the joints do not feel it.
static moray_status swim(paper *p, moray_model model, const swum_amplitudes *s, moray_swimmer **swimmer,
                         moray_swim_track **orbit)
{
    moray_robot robot = *p->robot;
    moray_swim_setup setup = moray_test_rig_setup(&p->rig, model);
    robot.links = s->N;
    MORAY_TRY(paper_swimmer(p, &robot, model, p->settings->reading, swimmer));
    setup.swimmer = *swimmer;
    setup.current[0] = setup.current[1] = 0;
    const moray_gait gait = {
        .amplitude = model == MORAY_CONTROL_ORIENTED ? s->a : s->alpha, .omega = p->settings->omega, .delta = s->delta};
    return paper_orbit_of(p, &setup, &gait, POINTS, NULL, orbit);
}

// First-principles model: theta_i - heading of every link, link by link, angle[N * POINTS].
static void link_angles(const moray_swim_track *orbit, int N, double *angle)
{
    double heading = 0;
    for (int k = 0; k < POINTS - 1; k++)
        heading += orbit->pose[k].heading / (POINTS - 1);
    for (int i = 0; i < N; i++)
        for (int k = 0; k < POINTS; k++)
            angle[i * POINTS + k] = orbit->x[k * orbit->n_states + i] - heading;
}

// One sample of (1) or (28) at the joint whose links begin at angle and angle + POINTS.
static double joint_of(const double *angle, double l, bool distance)
{
    return distance ? l * (sin(angle[0]) + sin(angle[POINTS])) : angle[0] - angle[POINTS];
}

static double mean_joint_amplitude(const double *angle, int N, double l, bool distance)
{
    double joint[POINTS], mean = 0;
    for (int i = 0; i < N - 1; i++) {
        for (int k = 0; k < POINTS; k++)
            joint[k] = joint_of(angle + i * POINTS + k, l, distance);
        mean += paper_half_range(joint, 1, POINTS) / (N - 1);
    }
    return mean;
}

static moray_status measure_first_principles(paper *p, swum_amplitudes *s)
{
    moray_swimmer *swimmer;
    moray_swim_track *orbit;
    double *angle;
    MORAY_TRY(swim(p, MORAY_FIRST_PRINCIPLES, s, &swimmer, &orbit));
    MORAY_TRY(paper_numbers(p, (size_t)(s->N * POINTS), &angle));
    link_angles(orbit, s->N, angle);
    s->joint_angle = mean_joint_amplitude(angle, s->N, p->robot->l, false);
    s->joint_distance = mean_joint_amplitude(angle, s->N, p->robot->l, true);
    s->link_least = INFINITY;
    for (int i = 0; i < s->N; i++) {
        const double amplitude = paper_half_range(angle + i * POINTS, 1, POINTS);
        s->link_least = fmin(s->link_least, amplitude);
        s->link_largest = fmax(s->link_largest, amplitude);
        s->link_mean += amplitude / s->N;
    }
    return moray_ok();
}

// The link angles (12) are asked of the swimmer, which reads the paper as it was told to.
static moray_status measure_control_oriented(paper *p, swum_amplitudes *s)
{
    const int N = s->N;
    moray_swimmer *swimmer;
    moray_swim_track *orbit;
    double *angle, *links;
    MORAY_TRY(swim(p, MORAY_CONTROL_ORIENTED, s, &swimmer, &orbit));
    MORAY_TRY(paper_numbers(p, (size_t)(N * POINTS), &angle));
    MORAY_TRY(paper_numbers(p, (size_t)(3 * N), &links));
    for (int k = 0; k < POINTS; k++) {
        moray_swimmer_links(swimmer, orbit->x + k * orbit->n_states, links, links + N, links + 2 * N);
        for (int i = 0; i < N; i++)
            angle[i * POINTS + k] = links[2 * N + i] - orbit->pose[k].heading;
    }
    for (int i = 0; i < N - 1; i++)
        s->joint_coordinate += paper_half_range(orbit->x + i, orbit->n_states, POINTS) / (N - 1);
    for (int i = 0; i < N; i++) {
        const bool end = i == 0 || i == N - 1;
        *(end ? &s->end_angle : &s->inner_angle) += paper_half_range(angle + i * POINTS, 1, POINTS) / (end ? 2 : N - 2);
    }
    return moray_ok();
}

moray_status swum_amplitudes_of(paper *p, int N, double theta_max, double delta, swum_amplitudes *s)
{
    *s = (swum_amplitudes){.N = N, .theta_max = theta_max, .delta = delta};
    s->alpha = moray_amplitude_from_theta_max(p->robot, MORAY_FIRST_PRINCIPLES, theta_max, delta);
    s->a = moray_amplitude_from_theta_max(p->robot, MORAY_CONTROL_ORIENTED, theta_max, delta);
    paper_progress(p, "%d links, theta_max %.0f deg, delta %.0f deg", N, theta_max / DEG, delta / DEG);
    MORAY_TRY(measure_first_principles(p, s));
    return measure_control_oriented(p, s);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { MOST = 16 };

// theta_max, delta and N varied one at a time.
static moray_status swim_all(paper *p, swum_amplitudes *s, int *n)
{
    static const double angles[] = {10, 15, 20, 30}, shifts[] = {20, 30, 60, 80};
    static const int links[] = {5, 8, 15, 20};
    const int N = p->robot->links;
    *n = 0;
    for (int k = 0; k < 4; k++)
        MORAY_TRY(swum_amplitudes_of(p, N, angles[k] * DEG, p->settings->delta, &s[(*n)++]));
    for (int k = 0; k < 4; k++)
        MORAY_TRY(swum_amplitudes_of(p, N, p->settings->theta_max, shifts[k] * DEG, &s[(*n)++]));
    for (int k = 0; k < 4; k++)
        MORAY_TRY(swum_amplitudes_of(p, links[k], p->settings->theta_max, 2 * M_PI / (links[k] - 1), &s[(*n)++]));
    return moray_ok();
}

static void json_swum(moray_json *json, const swum_amplitudes *s, int n)
{
    moray_json_open_list(json, "swum");
    for (int k = 0; k < n; k++) {
        moray_json_open(json, NULL);
        moray_json_members(json, MORAY_MEMBERS({"links", s[k].N}, {"theta_max_deg", s[k].theta_max / DEG},
                                               {"delta_deg", s[k].delta / DEG}, {"alpha_27_deg", s[k].alpha / DEG},
                                               {"joint_angle_deg", s[k].joint_angle / DEG}));
        moray_json_numbers(json, "link_angle_rad", (const double[]){s[k].link_least, s[k].link_mean, s[k].link_largest},
                           3);
        moray_json_members(json, MORAY_MEMBERS({"a_33_m", s[k].a}, {"joint_coordinate_m", s[k].joint_coordinate},
                                               {"joint_distance_m", s[k].joint_distance},
                                               {"link_angle_12_inner_deg", s[k].inner_angle / DEG},
                                               {"link_angle_12_end_deg", s[k].end_angle / DEG}));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static moray_status conclude(paper *p, const swum_amplitudes *s, int n)
{
    double joints = 0, mean = 0, least = 0, largest = 0;
    for (int k = 0; k < n; k++) {
        joints = fmax(joints, fabs(s[k].joint_angle / s[k].alpha - 1));
        joints = fmax(joints, fabs(s[k].joint_coordinate / s[k].a - 1));
        if (s[k].delta < 2 * M_PI / (s[k].N - 1) - 1e-9) // the body is shorter than the wave
            continue;
        mean = fmax(mean, fabs(s[k].link_mean / s[k].theta_max - 1));
        least = fmin(least, s[k].link_least / s[k].theta_max - 1);
        largest = fmax(largest, s[k].link_largest / s[k].theta_max - 1);
    }
    MORAY_TRY(paper_say(p,
                        "Propositions 1 and 2: the joints swing by (27) and (33) to within %.2g %%. As long as a wave "
                        "fits on the body, the links swing by theta_max in their mean to within %.2g %%, each by %.0f "
                        "to +%.0f %% of it, since the heading swings along.",
                        100 * joints, 100 * mean, 100 * least, 100 * largest));
    return paper_say(p,
                     "The control-oriented model knows its link angles by (12) only: with (33) and L = 2l that is "
                     "cos^2(delta/2) sin theta_max inside the body (l for L would make it twice that: erratum E2) and "
                     "about half as much at its ends.");
}

moray_status show_swum_amplitudes(paper *p)
{
    swum_amplitudes s[MOST];
    moray_table_row first[MOST], second[MOST];
    int n;
    MORAY_TRY(swim_all(p, s, &n));
    for (int k = 0; k < n; k++) {
        const char *label =
            paper_label(p, "N %d, delta %.3g deg, theta_max %.3g deg", s[k].N, s[k].delta / DEG, s[k].theta_max / DEG);
        first[k] = (moray_table_row){.label = label,
                                     .value = {s[k].alpha / DEG, s[k].joint_angle / DEG, s[k].link_least / DEG,
                                               s[k].link_mean / DEG, s[k].link_largest / DEG},
                                     .unit = "deg"};
        second[k] = (moray_table_row){.label = label,
                                      .value = {100 * s[k].a, 100 * s[k].joint_coordinate, 100 * s[k].joint_distance,
                                                s[k].inner_angle / DEG, s[k].end_angle / DEG}};
    }
    MORAY_TRY(paper_rows(p, "Proposition 1: amplitudes swum by the first-principles model",
                         PAPER_HEADS("(27)", "joints", "least link", "mean link", "largest link"), first, n));
    MORAY_TRY(paper_rows(p,
                         "Proposition 2: amplitudes swum by the control-oriented model, with the joint "
                         "distance (28) of the first-principles model's links beside them",
                         PAPER_HEADS("(33) [cm]", "joints [cm]", "(28) [cm]", "(12) inner [deg]", "(12) ends [deg]"),
                         second, n));
    json_swum(p->json, s, n);
    return conclude(p, s, n);
}
