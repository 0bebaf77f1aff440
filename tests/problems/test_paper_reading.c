// SPDX-License-Identifier: MIT
//
// A swimmer that reads the paper's misprints as they stand, against the paper's formulas as they stand.
#include "printed_model.h"
#include "degree.h"
#include "paper/reading.h"

static moray_swimmer *swimmer_of(const scene *s, moray_model model, paper_reading reading)
{
    moray_swimmer *swimmer;
    CHECK_OK(paper_reading_swimmer(&swimmer, &s->robot, model, reading), "a swimmer");
    moray_swimmer_set_current(swimmer, s->V[0], s->V[1]);
    return swimmer;
}

// dv_t by (23g), dv_n by (23h) or (16c), u by (22), with l or 2l for the l of (13).
static void formulas(const scene *s, paper_reading reading, double dv[2], double *u)
{
    const double L = reading & PAPER_L_PRINTED ? s->robot.l : 2 * s->robot.l, N = s->robot.links;
    const coefficients k = by_hand(&s->robot, L);
    const printed p = as_printed(s, L);
    double v_tr, v_nr;
    relative_velocity(s, &v_tr, &v_nr);
    const double bending = k.c_p * p.w + k.mu_p * p.z;
    const bool swapped = reading & PAPER_23H_PRINTED;
    dv[0] = p.h_1 * (p.h_2 * v_nr + p.h_3 * v_tr - N * k.m_tilde * bending);
    dv[1] = p.h_1 * (p.h_4 * (swapped ? v_nr : v_tr) + p.h_5 * (swapped ? v_tr : v_nr) - 2 * k.mu_p * p.s * bending);
    printed_forces(s, L, p, u);
}

static void check_reading(const scene *s, paper_reading reading)
{
    const int N = s->robot.links;
    double dx[MAX_STATES], u[MAX_LINKS], dv[2], want[MAX_LINKS];
    moray_swimmer *swimmer = swimmer_of(s, MORAY_CONTROL_ORIENTED, reading);
    CHECK(moray_swimmer_rates(swimmer, s->x, s->ubar, dx, u), "reading %d of %d links is regular", reading, N);
    formulas(s, reading, dv, want);
    CHECK_NEAR(relative_distance(2, dx + 2 * N + 2, dv), 0, 1e-10, "dv_t, dv_n as read");
    CHECK_NEAR(relative_distance(N - 1, u, want), 0, 1e-10, "joint forces as read");
    moray_swimmer_free(swimmer);
}

// (8) and (12) with l for L: links at half the distance, at twice the angle.
static void check_links(const scene *s)
{
    const int N = s->robot.links;
    double x[2][MAX_LINKS], y[2][MAX_LINKS], angle[2][MAX_LINKS], spacing_error = 0, angle_error = 0, largest = 0;
    const double theta = s->x[N - 1];
    moray_pose pose;
    for (int k = 0; k < 2; k++) {
        moray_swimmer *swimmer = swimmer_of(s, MORAY_CONTROL_ORIENTED, k ? PAPER_L_PRINTED : PAPER_CORRECTED);
        moray_swimmer_links(swimmer, s->x, x[k], y[k], angle[k]);
        pose = moray_swimmer_pose(swimmer, s->x);
        moray_swimmer_free(swimmer);
    }
    for (int i = 0; i < N; i++) {
        const double sum = (i > 0 ? s->x[i - 1] : 0) + (i < N - 1 ? s->x[i] : 0);
        const double shift = s->robot.l * (i - 0.5 * (N - 1)); // of a link's place along the body
        spacing_error =
            fmax(spacing_error, hypot(x[0][i] - x[1][i] - shift * cos(theta), y[0][i] - y[1][i] - shift * sin(theta)));
        angle_error = tap_worse(angle_error, fabs(angle[1][i] - theta - sum / (2 * s->robot.l)));
        largest = fmax(largest, fabs(sum / (2 * s->robot.l)));
    }
    CHECK_NEAR(spacing_error, 0, 1e-13, "(8) as printed puts the links half as far apart");
    CHECK_NEAR(angle_error, 0, 1e-13, "(12) as printed");
    CHECK_NEAR(pose.link_angle, largest, 1e-13, "largest link angle as printed");
}

static void check_first_principles(const scene *s)
{
    double dx[2][MAX_STATES];
    for (int k = 0; k < 2; k++) {
        moray_swimmer *swimmer = swimmer_of(s, MORAY_FIRST_PRINCIPLES, k ? PAPER_PRINTED : PAPER_CORRECTED);
        CHECK(moray_swimmer_rates(swimmer, s->x, s->ubar, dx[k], NULL), "regular");
        moray_swimmer_free(swimmer);
    }
    CHECK(relative_distance(2 * s->robot.links + 4, dx[0], dx[1]) == 0, "the first-principles model has no misprints");
}

int main(void)
{
    random_seed seed = 31;
    for (int k = 0; k < ROBOT_SIZES; k++)
        for (int trial = 0; trial < 3; trial++) {
            scene s = random_scene(&seed, robot_links[k]);
            for (int reading = PAPER_CORRECTED; reading <= PAPER_PRINTED; reading++)
                check_reading(&s, (paper_reading)reading);
            check_links(&s);
            check_first_principles(&s);
            shape_matrices_free(&s.shape);
        }
    return tap_done();
}
