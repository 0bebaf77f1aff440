// SPDX-License-Identifier: MIT
//
// The equations of a periodic orbit: their slopes against differences, where parameters, the period and a further
// quantity are found of a plant that time drives; and a plant without parameters against its closed form.
#include "tap.h"

#include <string.h>

#include "control/orbit_system.h"
#include "moray/num.h"

// ---- Slopes --------------------------------------------------------------------------------------------------------

enum { NX = 2, NS = 2, NW = 1, UNKNOWN = 400 };

// x, v; stiffness, force.
static void driven(void *self, const moray_num *in, moray_num *out)
{
    const moray_num *x = in, *s = in + NX, t = in[NX + NS];
    (void)self;
    out[0] = x[1];
    out[1] = s[1] * csin(2 * t) - s[0] * x[0] * x[0] * x[0] - 0.2 * x[1] * t;
}

// Of x(0), x(T), s, T, w.
static void turned(void *self, const moray_num *in, moray_num *out)
{
    const moray_num *start = in, *end = in + NX, *s = in + 2 * NX, T = in[2 * NX + NS], w = in[2 * NX + NS + 1];
    (void)self;
    out[0] = end[0] * ccos(w) - end[1] * csin(w) - start[0];
    out[1] = end[0] * csin(w) + end[1] * ccos(w) - start[1];
    out[2] = start[1] - 0.1 * w * T;
    out[3] = s[1] * T - 2;
    out[4] = start[0] * s[0] + w;
}

// The largest difference between the slopes and central differences of the equations.
static double worst_slope(orbit_system *system, double *z)
{
    static double up[UNKNOWN], down[UNKNOWN], slope[UNKNOWN * UNKNOWN];
    const moray_pattern *pattern = &system->jacobian.pattern;
    const int n = system->unknowns;
    double worst = 0;
    moray_orbit_residual(system, z, up);
    moray_orbit_slopes(system, z);
    memset(slope, 0, sizeof slope);
    for (int e = 0; e < pattern->nnz; e++)
        slope[pattern->row[e] * n + pattern->col[e]] = system->values[e];
    for (int j = 0; j < n; j++) {
        const double at = z[j], h = 1e-5;
        z[j] = at + h;
        const bool above = moray_orbit_residual(system, z, up);
        z[j] = at - h;
        const bool below = moray_orbit_residual(system, z, down);
        z[j] = at;
        for (int i = 0; i < n; i++)
            worst = tap_worse(worst, fabs(slope[i * n + j] - (up[i] - down[i]) / (2 * h)));
        if (!above || !below)
            return INFINITY;
    }
    return worst;
}

// The largest difference between a weighted sum's slopes by the given parameters and central differences of it, added
// to what was there; a parameter that is found has none.
static double worst_by_parameters(orbit_system *system, double *z)
{
    enum { BEFORE = 3 };
    static double weight[UNKNOWN], up[UNKNOWN], down[UNKNOWN];
    const double h = 1e-5, factor = 1.7;
    unsigned long long seed = 5;
    double by[NS + 1], worst = 0;
    for (int i = 0; i < system->unknowns; i++)
        weight[i] = tap_random(&seed, 0.5, 2);
    for (int k = 0; k <= NS; k++)
        by[k] = BEFORE;
    moray_orbit_residual(system, z, up);
    moray_orbit_slopes(system, z);
    moray_orbit_by_parameters(system, weight, factor, by);
    for (int k = 0; k <= NS; k++) {
        const double at = system->p[k];
        double slope = BEFORE;
        system->p[k] = at + h;
        moray_orbit_residual(system, z, up);
        system->p[k] = at - h;
        moray_orbit_residual(system, z, down);
        system->p[k] = at;
        for (int i = 0; i < system->unknowns; i++)
            slope += factor * weight[i] * (up[i] - down[i]) / (2 * h);
        worst = tap_worse(worst, fabs(by[k] - (system->column[k] < 0 ? slope : 0)));
    }
    return worst;
}

// Slopes are those at z, whatever was looked at before; of the plant all entries, whatever stood there.
static void check_dense(orbit_system *system, double *z)
{
    static double F[UNKNOWN];
    enum { ENTRIES = NX * (NX + NS + 1) };
    const double at[NX] = {0.7, -0.4}, t = 0.6;
    double slope[ENTRIES], before = 0;
    for (int k = 0; k < ENTRIES; k++)
        slope[k] = NAN;
    moray_orbit_plant_slope(system, at, t, slope);
    const double *s = system->p, cube = at[0] * at[0] * at[0];
    const double dense[ENTRIES] = {[1] = 1,    [NX + NS + 1] = -3 * s[0] * at[0] * at[0], -0.2 * t, -cube,
                                   sin(2 * t), 2 * s[1] * cos(2 * t) - 0.2 * at[1]};
    for (int k = 0; k < ENTRIES; k++)
        CHECK_NEAR(slope[k], dense[k], 1e-13, "slope of the plant");
    for (int round = 0; round < 2; round++) {
        double sum = 0;
        moray_orbit_residual(system, z, F);
        for (int k = 0; k < system->n_found && round; k++)
            system->p[system->found[k]] = 77; // as if others had been tried since
        moray_orbit_slopes(system, z);
        for (int e = 0; e < system->jacobian.pattern.nnz; e++)
            sum += system->values[e] * (1 + e % 7);
        CHECK(round == 0 || sum == before, "the slopes at z: %g, %g", sum, before);
        before = sum;
    }
    const double period = system->p[NS];
    const int column = system->column[NS];
    for (int k = 0; k < 2; k++) {
        *(column < 0 ? &system->p[NS] : &z[column]) = k ? -1 : 0;
        CHECK(!moray_orbit_residual(system, z, F), "no orbit has a period of %d", -k);
    }
    *(column < 0 ? &system->p[NS] : &z[column]) = period;
    CHECK(moray_orbit_residual(system, z, F), "but of %g", period);
}

static void test_slopes(void)
{
    static const int found[][2] = {{0, 1}, {0, NS}, {1, NS}}; // stiffness, force, period
    const double probe[] = {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.35};
    for (int k = 0; k < 3; k++) {
        moray_map plant, closing;
        orbit_system system;
        unsigned long long seed = 3;
        double z[UNKNOWN];
        CHECK_OK(moray_map_from_complex(&plant, NX + NS + 1, NX, driven, NULL, NULL, probe), "plant");
        CHECK_OK(moray_map_from_complex(&closing, 2 * NX + NS + 1 + NW, NX + 2 + NW, turned, NULL, NULL, probe),
                 "closing");
        const moray_periodic_orbit_spec spec = {.nx = NX,
                                                .ns = NS,
                                                .nw = NW,
                                                .plant = &plant,
                                                .closing = &closing,
                                                .found = found[k],
                                                .n_found = 2,
                                                .scheme = "lobatto5",
                                                .intervals = 3};
        CHECK_OK(moray_orbit_system_new(&system, &spec), "system");
        for (int i = 0; i < system.unknowns; i++)
            z[i] = tap_random(&seed, 0.5, 2);
        for (int i = 0; i <= NS; i++)
            system.p[i] = 1.1 + 0.2 * i; // those that are given
        const double worst = worst_slope(&system, z);
        CHECK(worst < 1e-8, "slopes where parameters %d and %d are found: off by %.1e", found[k][0], found[k][1],
              worst);
        const double given = worst_by_parameters(&system, z);
        CHECK(given < 1e-8, "and by the one that is given: off by %.1e", given);
        check_dense(&system, z);
        moray_orbit_system_free(&system);
        moray_map_release(&plant);
        moray_map_release(&closing);
    }
}

// ---- Without parameters: x' = cos t - x, x = (cos t + sin t) / 2 ----------------------------------------------------

static void lag(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = ccos(in[1]) - in[0];
}

static void rest(double t, double *x, const void *self)
{
    (void)t, (void)self;
    x[0] = 0;
}

static void test_no_parameters(void)
{
    const moray_closing_condition returns = {MORAY_CLOSE_RETURNS, 0, 0};
    const moray_periodic_orbit_guess guess = {.state = rest};
    const double probe[] = {0.3, 0.4}, T = 2 * M_PI;
    moray_map plant, closing;
    moray_periodic_orbit *orbit;
    moray_periodic_orbit_info info;
    double M, worst = 0;
    CHECK_OK(moray_map_from_complex(&plant, 2, 1, lag, NULL, NULL, probe), "plant");
    CHECK_OK(moray_closing_map(&closing, 1, 0, &returns, 1), "closing conditions");
    const moray_periodic_orbit_spec spec = {
        .nx = 1, .plant = &plant, .closing = &closing, .scheme = "lobatto5", .intervals = 20};
    if (CHECK(!moray_failed(moray_periodic_orbit_new(&orbit, &spec)), "a plant may be without parameters")) {
        CHECK_OK(moray_periodic_orbit_solve(orbit, &T, &guess, &info), "found");
        for (int k = 0; k <= 50; k++) {
            const double t = T * k / 50;
            double x;
            moray_periodic_orbit_state(orbit, t, &x);
            worst = tap_worse(worst, fabs(x - (cos(t) + sin(t)) / 2));
        }
        CHECK(worst < 1e-8, "the lagging motion: %.1e", worst);
        CHECK_OK(moray_periodic_orbit_monodromy(orbit, &M), "monodromy");
        CHECK_RELATIVE(M, exp(-T), 1e-9, "what is left of a deviation after a period");
    }
    moray_periodic_orbit_free(orbit);
    moray_map_release(&plant);
    moray_map_release(&closing);
}

// ---- Closing conditions --------------------------------------------------------------------------------------------

// Of different kinds and states, at each place of the list; and what is refused, by whole messages.
static void test_conditions(void)
{
    static const moray_closing_condition all[3] = {
        {MORAY_CLOSE_STARTS, 2, 0.5}, {MORAY_CLOSE_RETURNS, 0, -1}, {MORAY_CLOSE_STARTS, 1, 7}};
    const double ends[] = {2, 10, 20, 7, 14, 23, 0.1, 1}; // x(0), x(T), s, T
    for (int first = 0; first < 3; first++) {
        moray_closing_condition list[3];
        double out[3], slope[4], dense[3][8] = {{0}};
        moray_map map;
        for (int k = 0; k < 3; k++)
            list[k] = all[(first + k) % 3];
        CHECK_OK(moray_closing_map(&map, 3, 1, list, 3), "conditions");
        CHECK(map.n_in == 8 && map.n_out == 3 && map.jac.nnz == 4, "%d slopes", map.jac.nnz);
        map.value(map.self, ends, out);
        map.jacobian(map.self, ends, slope);
        for (int e = 0; e < map.jac.nnz; e++)
            dense[map.jac.row[e]][map.jac.col[e]] += slope[e];
        for (int k = 0; k < 3; k++) {
            const int state = list[k].state;
            const bool returns = list[k].kind == MORAY_CLOSE_RETURNS;
            const double at = returns ? ends[3 + state] - ends[state] : ends[state];
            CHECK(out[k] == at - list[k].value, "condition %d: %g", k, out[k]);
            for (int c = 0; c < 8; c++)
                CHECK(dense[k][c] == (c == state                  ? (returns ? -1 : 1)
                                      : returns && c == 3 + state ? 1
                                                                  : 0),
                      "its slope %d: %g", c, dense[k][c]);
        }
        moray_map_release(&map);
        for (int k = 0; k < 3; k++)
            for (int side = 0; side < 2; side++) {
                char says[100];
                const int right = list[k].state;
                list[k].state = side ? 3 : -1;
                const moray_status status = moray_closing_map(&map, 3, 1, list, 3);
                snprintf(says, sizeof says, "closing condition %d is of state %d: must be 0 to 2", k, list[k].state);
                CHECK(status.code == MORAY_INPUT && !map.self && strcmp(status.text, says) == 0, "%s", status.text);
                list[k].state = right;
            }
    }
    static const int sizes[][3] = {{0, 0, 1}, {1, -1, 1}, {1, 0, 0}};
    for (int k = 0; k < 3; k++) {
        char says[120];
        moray_map map;
        const moray_closing_condition one = {MORAY_CLOSE_STARTS, 0, 0};
        const moray_status status = moray_closing_map(&map, sizes[k][0], sizes[k][1], &one, sizes[k][2]);
        snprintf(says, sizeof says, "%d closing conditions of %d states and %d parameters: must be at least 1, 1, 0",
                 sizes[k][2], sizes[k][0], sizes[k][1]);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
    }
}

// The first of several that an array holds: those behind have no say.
static void test_first_conditions(void)
{
    const moray_closing_condition all[] = {
        {MORAY_CLOSE_RETURNS, 1, 3}, {MORAY_CLOSE_STARTS, 0, 0.5}, {MORAY_CLOSE_RETURNS, 0, 0}};
    const double ends[] = {2, 10, 7, 14, 1}; // x(0), x(T), T
    double out[2], slope[3];
    moray_map map;
    CHECK_OK(moray_closing_map(&map, 2, 0, all, 2), "two of three conditions");
    if (CHECK(map.jac.nnz == 3 && map.n_out == 2, "one that returns has two slopes, one that starts has one: %d",
              map.jac.nnz)) {
        map.value(map.self, ends, out);
        map.jacobian(map.self, ends, slope);
        CHECK(out[0] == 14 - 10 - 3 && out[1] == 2 - 0.5, "14 - 10 is not 3 by %g, 2 not 0.5 by %g", out[0], out[1]);
        CHECK(slope[0] == -1 && slope[1] == 1 && slope[2] == 1 && map.jac.col[0] == 1 && map.jac.col[1] == 3 &&
                  map.jac.col[2] == 0,
              "slopes by x(0) and x(T)");
    }
    moray_map_release(&map);
}

// Where nothing is found the equations end with those of how it closes, and what stands behind them stays.
static void test_beyond(void)
{
    static const moray_closing_condition both[] = {{MORAY_CLOSE_RETURNS, 0, 0}, {MORAY_CLOSE_RETURNS, 1, 0}};
    const double probe[] = {0.3, 0.4, 0.5, 0.6, 0.7};
    moray_map plant, closing;
    orbit_system system;
    double z[UNKNOWN], F[UNKNOWN];
    CHECK_OK(moray_map_from_complex(&plant, NX + NS + 1, NX, driven, NULL, NULL, probe), "plant");
    CHECK_OK(moray_closing_map(&closing, NX, NS, both, NX), "closing");
    const moray_periodic_orbit_spec spec = {
        .nx = NX, .ns = NS, .plant = &plant, .closing = &closing, .scheme = "radau2", .intervals = 3};
    CHECK_OK(moray_orbit_system_new(&system, &spec), "system");
    for (int i = 0; i < UNKNOWN; i++)
        z[i] = 0.1 * i, F[i] = 7;
    for (int i = 0; i <= NS; i++)
        system.p[i] = 1.1;
    CHECK(moray_orbit_residual(&system, z, F) && system.unknowns == system.nodes * NX, "%d equations", system.unknowns);
    int changed = 0;
    for (int i = 0; i < UNKNOWN; i++)
        changed += F[i] != 7;
    CHECK(changed == system.unknowns && F[system.unknowns] == 7, "%d of them", changed);
    moray_orbit_system_free(&system);
    moray_map_release(&plant);
    moray_map_release(&closing);
}

int main(void)
{
    test_beyond();
    test_slopes();
    test_no_parameters();
    test_conditions();
    test_first_conditions();
    return tap_done();
}
