// SPDX-License-Identifier: MIT
//
// Where the links are and how far they stand from the heading, in both models; what links and series are allowed.
#include <complex.h>
#include <string.h>

#include "random_robot.h"
#include "snake/model/fp_robot.h"
#include "snake/model/links.h"
#include "snake/model/model.h"
#include "snake/model/series.h"

enum { N = 5 };

// ---- Poses ---------------------------------------------------------------------------------------------------------

static void check_pose(const moray_robot *robot, const snake_model *model, const double *x)
{
    const bool control = model == &moray_control_model;
    const double theta = x[N - 1], *v = x + 2 * N + 2;
    double angle[N], mean = 0, most = 0, x_i[N], y_i[N], angle_i[N], middle[2] = {0}, worst = 0;
    for (int i = 0; i < N; i++) {
        const double before = i > 0 ? x[i - 1] : 0, after = i + 1 < N ? x[i] : 0;
        angle[i] = control ? (before + after) / (2 * (2 * robot->l)) : x[i];
        mean += control ? theta / N : x[i] / N;
    }
    for (int i = 0; i < N; i++) {
        const double off = control ? angle[i] : angle[i] - mean;
        most = off > most ? off : -off > most ? -off : most;
    }
    const moray_pose pose = model->pose(robot, x);
    CHECK_NEAR(pose.link_angle, most, 1e-14, "largest link angle");
    CHECK_NEAR(pose.heading, mean, 1e-14, "heading");
    CHECK(pose.p_x == x[N] && pose.p_y == x[N + 1], "position");
    const double complex along = control ? (v[0] + I * v[1]) * cexp(I * theta) : v[0] + I * v[1];
    CHECK_NEAR(pose.v_x, creal(along), 1e-14, "velocity along x");
    CHECK_NEAR(pose.v_y, cimag(along), 1e-14, "and along y");
    model->links(robot, x, x_i, y_i, angle_i);
    for (int i = 0; i < N; i++) {
        const moray_link link = moray_robot_link(robot, i);
        const double share = link.m / (N * robot->m);
        middle[0] += share * (x_i[i] + (control ? 0 : link.cm * cos(angle_i[i])));
        middle[1] += share * (y_i[i] + (control ? 0 : link.cm * sin(angle_i[i])));
        worst = tap_worse(worst, fabs(angle_i[i] - (control ? theta + angle[i] : angle[i])));
    }
    worst = tap_worse(worst, hypot(middle[0] - x[N], middle[1] - x[N + 1]));
    for (int i = 0; i + 1 < N; i++) {
        const double complex step = x_i[i + 1] - x_i[i] + I * (y_i[i + 1] - y_i[i]);
        const double l = moray_robot_link(robot, i).l, next = moray_robot_link(robot, i + 1).l;
        // links end where the next begin; of the other model they stand off by the joint, across
        const double complex want = control ? (2 * robot->l + I * x[i]) * cexp(I * theta)
                                            : l * cexp(I * angle_i[i]) + next * cexp(I * angle_i[i + 1]);
        worst = tap_worse(worst, cabs(step - want));
    }
    CHECK(worst < 1e-13, "links about their middle, each behind the other: %.1e", worst);
}

static void test_poses(void)
{
    random_seed seed = 31;
    moray_link link[N];
    for (int trial = 0; trial < 10; trial++) {
        double x[2 * N + 4];
        const moray_robot robot = random_robot(&seed, N), unequal = random_unequal_robot(&seed, N, link);
        random_vector(&seed, 1.3, 2 * N + 4, x);
        check_pose(&robot, &moray_control_model, x);
        check_pose(&robot, &moray_fp_model, x);
        check_pose(&unequal, &moray_fp_model, x);
    }
}

// Body and joints apart and together again, and at rest.
static void test_parts(const snake_model *model, bool control)
{
    random_seed seed = 7;
    double x[2 * N + 4], phi[N - 1], v_phi[N - 1], body[MORAY_BODY_STATES], again[2 * N + 4];
    random_vector(&seed, 1, 2 * N + 4, x);
    model->joints(N, x, phi, v_phi);
    model->body(N, x, body);
    model->assemble(N, phi, v_phi, body, again);
    CHECK(relative_distance(2 * N + 4, again, x) < 1e-14, "taken apart and put together");
    for (int i = 0; i < N - 1; i++) {
        CHECK(phi[i] == (control ? x[i] : x[i] - x[i + 1]), "joint");
        CHECK(v_phi[i] == (control ? x[N + 2 + i] : x[N + 2 + i] - x[N + 3 + i]), "its rate");
    }
    model->rest(N, 0.4, 2, -3, x);
    model->joints(N, x, phi, v_phi);
    model->body(N, x, body);
    const double want[MORAY_BODY_STATES] = {0.4, 2, -3, 0, 0, 0};
    for (int i = 0; i < MORAY_BODY_STATES; i++)
        CHECK_NEAR(body[i], want[i], 1e-15, "at rest");
    for (int i = 0; i < N - 1; i++)
        CHECK(phi[i] == 0 && v_phi[i] == 0, "and straight");
}

// ---- Links ---------------------------------------------------------------------------------------------------------

// Places on a link, on either side exactly at their end and beyond.
static void test_places(void)
{
    static const struct {
        const char *name, *place;
        double most; // in half lengths
    } of[] = {{"cm", "its ends", 1}, {"cb", "its ends", 1}, {"fin_at", "two lengths of its middle", 4}};
    moray_robot robot = moray_robot_paper();
    moray_link link[3];
    robot.links = 3;
    robot.l = 0.25;
    robot.link = link;
    for (int k = 0; k < 3; k++)
        for (int side = -1; side <= 1; side += 2)
            for (int beyond = 0; beyond < 2; beyond++) {
                for (int i = 0; i < 3; i++)
                    link[i] = (moray_link){1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0};
                double *const places[] = {&link[1].cm, &link[1].cb, &link[1].fin_at};
                *places[k] = side * (of[k].most + 0.5 * beyond);
                const moray_status status = moray_links_check(&robot);
                char text[160];
                snprintf(text, sizeof text, "link 2: %s = %g m from its middle: must be within %s, %g to %g m",
                         of[k].name, *places[k] * robot.l, of[k].place, -of[k].most * robot.l, of[k].most * robot.l);
                CHECK(beyond ? status.code == MORAY_INPUT && strcmp(status.text, text) == 0 : !moray_failed(status),
                      "%s at %g: \"%s\"", of[k].name, *places[k], status.text);
            }
}

static void test_coefficients(void)
{
    static const char *const names[] = {"l",        "m",        "J",        "c_t",     "c_n",     "mu_n",
                                        "lambda_1", "lambda_2", "lambda_3", "fin_c_t", "fin_c_n", "fin_mu_n"};
    moray_robot robot = moray_robot_paper();
    moray_link link[3];
    robot.links = 3;
    robot.link = link;
    for (int k = 0; k < 12; k++) {
        static const double values[] = {0, -1, NAN, INFINITY};
        for (int v = 0; v < 4; v++) {
            for (int i = 0; i < 3; i++)
                link[i] = (moray_link){1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 1, 0};
            double *const fields[] = {&link[2].l,        &link[2].m,       &link[2].J,        &link[2].c_t,
                                      &link[2].c_n,      &link[2].mu_n,    &link[2].lambda_1, &link[2].lambda_2,
                                      &link[2].lambda_3, &link[2].fin_c_t, &link[2].fin_c_n,  &link[2].fin_mu_n};
            *fields[k] = values[v];
            const moray_status status = moray_links_check(&robot);
            char begin[60];
            snprintf(begin, sizeof begin, "link 3: %s = ", names[k]);
            CHECK(v == 0 && k > 2 ? !moray_failed(status)
                                  : status.code == MORAY_INPUT && strstr(status.text, begin) == status.text &&
                                        strstr(status.text, k > 2 ? "finite and at least 0" : "finite and above 0"),
                  "%s = %g: \"%s\"", names[k], values[v], status.text);
        }
    }
}

// The part of a link that is even about its centre of buoyancy reaches to the nearer end.
static void test_even_part(void)
{
    random_seed seed = 12;
    moray_link link[N];
    fp_part part[N];
    int before = 0;
    const moray_robot robot = random_unequal_robot(&seed, N, link);
    moray_fp_robot_of(&robot, part);
    for (int i = 0; i < N; i++) {
        const moray_link it = moray_robot_link(&robot, i);
        const double to_front = it.l - it.cb, to_rear = it.l + it.cb;
        CHECK_NEAR(part[i].half, to_front < to_rear ? to_front : to_rear, 1e-15, "to the nearer end");
        before += it.cb < 0;
    }
    CHECK(before > 0 && before < N, "on either side of the middle: %d", before);
}

// ---- Series --------------------------------------------------------------------------------------------------------

// Mirrored in time, the wave runs the other way: mean angles stay, waves change sign with the shift between joints.
static void test_direction(void)
{
    enum { n = 4, K = 2, coefficients = n * (1 + 2 * K) };
    const moray_robot robot = moray_robot_paper();
    double at[2][coefficients], out[2][coefficients];
    for (int way = 0; way < 2; way++) {
        for (int i = 0; i < n; i++) {
            at[way][i] = 0.002 * (i + 1);
            for (int k = 1; k <= K; k++) {
                const double complex z = 0.03 / k * cexp(I * (way ? -1 : 1) * (0.4 + 0.8 * k * i));
                at[way][series_place(n, k, i)] = creal(z);
                at[way][series_place(n, k, i) + n] = cimag(z);
            }
        }
        const moray_series series = {n, K, at[way]};
        moray_series_to_first_principles(&robot, &series, out[way]);
    }
    for (int i = 0; i < n; i++) {
        CHECK(out[0][i] < 0 && fabs(out[1][i] / out[0][i] - 1) < 1e-12, "mean angle %g, %g", out[0][i], out[1][i]);
        for (int k = 1; k <= K; k++) {
            const int p = series_place(n, k, i), q = p + n;
            CHECK_NEAR(hypot(out[1][p], out[1][q]), hypot(out[0][p], out[0][q]), 1e-12, "amplitude of a harmonic");
        }
    }
}

int main(void)
{
    test_poses();
    test_parts(&moray_control_model, true);
    test_parts(&moray_fp_model, false);
    test_places();
    test_coefficients();
    test_even_part();
    test_direction();
    return tap_done();
}
