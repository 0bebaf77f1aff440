// SPDX-License-Identifier: MIT
//
// (13) prints c_p off the diagonal of a matrix that is subtracted; (11), from which it follows, has c_t - c_n there,
// and (14) has +c_p.
#include "errata.h"

// First entry of Dbar v, whose mean is zero and whose entries less the next are v.
static double first_of_dbar(int N, const double *v)
{
    double sum = 0;
    for (int j = 0; j < N - 1; j++)
        sum += (N - 1 - j) * v[j] / N;
    return sum;
}

tangential_force tangential_force_of(const moray_robot *robot, const double current[2], const double *x,
                                     const double *ubar, double dv_n)
{
    const int N = robot->links;
    const double L = 2 * robot->l, c_p = (robot->c_n - robot->c_t) / (2 * L), mu_p = robot->mu_n / (2 * L);
    const double *phi = x, *v_phi = x + N + 2, c = cos(x[N - 1]), s = sin(x[N - 1]);
    const double v_tr = x[2 * N + 2] - (current[0] * c + current[1] * s);
    const double v_nr = x[2 * N + 3] - (current[1] * c - current[0] * s);
    double bend_rate = first_of_dbar(N, v_phi), bend_acceleration = first_of_dbar(N, ubar);
    tangential_force f = {0};
    for (int i = 0; i < N; i++) {
        const double across = (i > 0 ? phi[i - 1] : 0) + (i < N - 1 ? phi[i] : 0);
        f.added_mass += mu_p * across * (dv_n - bend_acceleration);
        f.c_p += c_p * across * (v_nr - bend_rate);
        f.drag -= (robot->c_t + robot->c_n / (4 * L * L) * across * across) * v_tr;
        bend_rate -= i < N - 1 ? v_phi[i] : 0;
        bend_acceleration -= i < N - 1 ? ubar[i] : 0;
    }
    return f;
}

enum { POINTS = 361 };

// Means over a period of the corrected model's steady swimming; mass_times_acceleration: of N m dv_t.
static moray_status mean_forces(paper *p, tangential_force *mean, double *mass_times_acceleration)
{
    const int N = p->robot->links, n = 2 * N + 4;
    const moray_gait *gait = &p->gait[MORAY_CONTROL_ORIENTED];
    moray_swim_setup setup = moray_test_rig_setup(&p->rig, MORAY_CONTROL_ORIENTED);
    moray_swim_track *orbit;
    double *ubar;
    MORAY_TRY(paper_swimmer(p, p->robot, MORAY_CONTROL_ORIENTED, PAPER_CORRECTED, &setup.swimmer));
    MORAY_TRY(paper_orbit_of(p, &setup, gait, POINTS, NULL, &orbit));
    MORAY_TRY(paper_numbers(p, (size_t)(N + n), &ubar));
    *mean = (tangential_force){0};
    *mass_times_acceleration = 0;
    for (int k = 0; k < POINTS - 1; k++) {
        const double *x = orbit->x + k * n;
        double *dx = ubar + N;
        moray_swimmer_control(setup.swimmer, gait, orbit->t[k], x, ubar);
        if (!moray_swimmer_rates(setup.swimmer, x, ubar, dx, NULL))
            return moray_error(MORAY_NUMERIC, "the control-oriented model is singular at t = %g", orbit->t[k]);
        const tangential_force f = tangential_force_of(p->robot, p->rig.current, x, ubar, dx[2 * N + 3]);
        mean->added_mass += f.added_mass / (POINTS - 1);
        mean->c_p += f.c_p / (POINTS - 1);
        mean->drag += f.drag / (POINTS - 1);
        *mass_times_acceleration += N * p->robot->m * dx[2 * N + 2] / (POINTS - 1);
    }
    return moray_ok();
}

moray_status erratum_force_sign(paper *p)
{
    tangential_force f;
    double needed;
    MORAY_TRY(mean_forces(p, &f, &needed));
    const double sum = f.added_mass + f.c_p + f.drag, printed = f.added_mass - f.c_p + f.drag;
    const moray_table_row rows[] = {
        {.label = "term in c_p", .value = {-f.c_p, f.c_p}, .unit = "N"},
        {.label = "term in mu_p", .value = {f.added_mass, f.added_mass}, .unit = "N"},
        {.label = "drag, c_t and c_n^", .value = {f.drag, f.drag}, .unit = "N"},
        {.label = "sum", .value = {printed, sum}, .unit = "N"},
        {.label = "sum less N m dv_t/dt", .value = {printed - needed, sum - needed}, .unit = "N"},
    };
    moray_json_object(p->json, "equation_13",
                      MORAY_MEMBERS({"c_p_term_corrected_N", f.c_p}, {"sum_printed_N", printed},
                                    {"sum_corrected_N", sum}, {"residual_corrected_N", sum - needed}));
    return paper_rows(p,
                      "(13) has -c_p off the diagonal where (11) and (14) have +c_p: mean tangential "
                      "force in steady swimming",
                      PAPER_HEADS("(13) as printed", "(14a)"), rows, 5);
}
