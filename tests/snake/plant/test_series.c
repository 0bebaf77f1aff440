// SPDX-License-Identifier: MIT
//
// Free motions of the joints: the first-principles plants with free joints and with joints on a series against a
// complex step through the swimmer's equations; series against gaits, on the plants and between the models.
#include <stdlib.h>
#include <string.h>

#include "fp_complex.h"
#include "moray/snake/plant.h"
#include "random_robot.h"

enum { HARMONICS = 2, MOST_INPUTS = 8 + (1 + 2 * HARMONICS) * MAX_LINKS, MOST_OUTPUTS = 6 + 5 * MAX_LINKS + 1 };

typedef double complex num;

static random_seed seed = 11;

static fp_link_z links[MAX_LINKS]; // at the reference's point
static num dtheta[MAX_LINKS];

// ---- The reference -------------------------------------------------------------------------------------------------

// phi, phi', phi'' of the input, and where mean angle and its rate stand in it and in the state.
typedef struct joints {
    num phi[3][MAX_LINKS];
    int angle, rate;
} joints;

static joints joints_of(const moray_plant_spec *spec, const num *in)
{
    const int n = spec->robot.links - 1;
    const num omega = in[6], *c = in + 7, t = in[6 + moray_plant_sizes(spec).ns];
    joints j = {.angle = 0, .rate = 3};
    if (spec->joints == MORAY_JOINTS_FREE) {
        for (int rank = 0; rank < 3; rank++)
            memcpy(j.phi[rank], in + rank * (n + 3), (size_t)n * sizeof *in);
        j.angle = n;
        j.rate = 2 * n + 3;
        return j;
    }
    for (int i = 0; i < n; i++) {
        j.phi[0][i] = c[i];
        for (int k = 1; k <= spec->harmonics; k++) {
            const num p = c[n * (2 * k - 1) + i], q = c[2 * n * k + i], w = k * omega;
            j.phi[0][i] += p * csin(w * t) + q * ccos(w * t);
            j.phi[1][i] += w * (p * ccos(w * t) - q * csin(w * t));
            j.phi[2][i] -= w * w * (p * csin(w * t) + q * ccos(w * t));
        }
    }
    return j;
}

static void reference(void *self, const num *in, num *out)
{
    const moray_plant_spec *spec = self;
    const int N = spec->robot.links, n = N - 1;
    const joints j = joints_of(spec, in);
    num theta[MAX_LINKS], ddtheta[MAX_LINKS], ddp[2], u[MAX_LINKS], mean = 0;
    moray_fp_angles_z(N, in[j.angle], j.phi[0], theta);
    moray_fp_angles_z(N, in[j.rate], j.phi[1], dtheta);
    fp_part part[MAX_LINKS];
    const fp_robot robot = moray_fp_robot_of(&spec->robot, part);
    const fp_motion_z motion = {theta, dtheta, in[j.rate + 1], in[j.rate + 2], j.phi[2]};
    fp_balance_z balance;
    moray_fp_accelerations_z(&robot, spec->current, &motion, links, &balance, ddtheta, ddp);
    const num power = moray_fp_torques_z(&robot, &motion, links, ddtheta, u);
    for (int i = 0; i < N; i++)
        mean += ddtheta[i] / N;
    const num rates[] = {mean, ddp[0], ddp[1]};
    for (int i = 0; i < n && j.angle > 0; i++) {
        out[i] = j.phi[1][i];
        out[n + 3 + i] = j.phi[2][i];
    }
    memcpy(out + j.angle, in + j.rate, 3 * sizeof *out);
    memcpy(out + j.rate, rates, sizeof rates);
    num *next = out + moray_plant_sizes(spec).nx;
    for (int i = 0; i < n && spec->path_forces; i++)
        *next++ = u[i];
    for (int i = 0; i < N && spec->path_angles; i++)
        *next++ = theta[i] - in[j.angle];
    for (int i = 0; i < n && spec->path_rates; i++)
        *next++ = j.phi[1][i];
    *next = power;
}

// ---- Plants against it ---------------------------------------------------------------------------------------------

static void random_input(const moray_plant_spec *spec, int n_in, double *in)
{
    random_vector(&seed, 0.4, n_in, in);
    if (spec->joints == MORAY_JOINTS_SERIES)
        in[6] = tap_random(&seed, 1, 3);
    in[n_in - 1] = tap_random(&seed, 0, 3);
}

// How far the point is from where the drag has a kink: a link, or a place on it, that does not move through the water,
// and a strip at whose end the velocity changes sign.
static double clearance(moray_plant_spec *spec, int n_in, const double *in)
{
    num z[MOST_INPUTS], out[MOST_OUTPUTS];
    double least = INFINITY;
    for (int i = 0; i < n_in; i++)
        z[i] = in[i];
    reference(spec, z, out);
    for (int i = 0; i < spec->robot.links; i++) {
        const double x = creal(links[i].v.x) - spec->current[0], y = creal(links[i].v.y) - spec->current[1];
        const double c = creal(links[i].c), s = creal(links[i].s), w = creal(dtheta[i]), a = c * y - s * x;
        const int pieces = spec->robot.hydro.pieces;
        least = fmin(least, fmin(fabs(w), fmin(fabs(c * x + s * y), fabs(a))));
        least = fmin(least, fabs(fabs(a) - fabs(w) * spec->robot.l));
        for (int j = 0; j < pieces; j++)
            least = fmin(least, fabs(a + w * spec->robot.l * (2 * j + 1 - pieces) / pieces));
    }
    return least;
}

// Largest difference, relative to the largest entry, of sparse values with those of another pattern.
static double disagreement(const moray_pattern *one, const double *values, const moray_pattern *other,
                           const double *others)
{
    static double difference[MOST_INPUTS][MOST_INPUTS];
    double worst = 0, size = 0;
    memset(difference, 0, sizeof difference);
    for (int k = 0; k < one->nnz; k++)
        difference[one->row[k]][one->col[k]] += values[k];
    for (int k = 0; k < other->nnz; k++) {
        difference[other->row[k]][other->col[k]] -= others[k];
        size = fmax(size, fabs(others[k]));
    }
    for (int i = 0; i < MOST_INPUTS; i++)
        for (int j = 0; j < MOST_INPUTS; j++)
            worst = fabs(difference[i][j]) <= worst ? worst : fabs(difference[i][j]);
    return worst / size;
}

// The same of a Hessian and central differences of order eight of the gradient of weight . out by complex step.
static double hessian_error(const moray_map *map, const double *hessian, const moray_map *want, const double *at,
                            const double *weight)
{
    static const double coefficient[] = {0, 4. / 5, -1. / 5, 4. / 105, -1. / 280};
    static double difference[MOST_INPUTS][MOST_INPUTS], jacobian[MOST_INPUTS * MOST_INPUTS];
    const double step = 1e-4;
    double in[MOST_INPUTS], worst = 0, size = 0;
    memcpy(in, at, (size_t)map->n_in * sizeof *in);
    memset(difference, 0, sizeof difference);
    for (int col = 0; col < map->n_in; col++)
        for (int way = -4; way <= 4; way++) {
            in[col] = at[col] + way * step;
            want->jacobian(want->self, in, jacobian);
            const double share = (way < 0 ? -1 : 1) * coefficient[abs(way)] / step;
            for (int k = 0; k < want->jac.nnz; k++)
                difference[want->jac.col[k]][col] += share * weight[want->jac.row[k]] * jacobian[k];
            in[col] = at[col];
        }
    for (int i = 0; i < map->n_in; i++)
        for (int j = 0; j <= i; j++)
            size = fmax(size, fabs(difference[i][j]));
    for (int k = 0; k < map->hess.nnz; k++)
        difference[map->hess.row[k]][map->hess.col[k]] -= hessian[k];
    for (int i = 0; i < map->n_in; i++)
        for (int j = 0; j <= i; j++)
            worst = fabs(difference[i][j]) <= worst ? worst : fabs(difference[i][j]);
    return worst / size;
}

static void compare(const char *name, moray_plant_spec *spec, const moray_map *map, const moray_map *want)
{
    static double values[2][MOST_INPUTS * MOST_INPUTS];
    double in[MOST_INPUTS], out[2][MOST_OUTPUTS], weight[MOST_OUTPUTS];
    do
        random_input(spec, map->n_in, in);
    while (clearance(spec, map->n_in, in) < 1e-3 * spec->robot.links); // beyond the steps of hessian_error
    random_vector(&seed, 1, map->n_out, weight);
    map->value(map->self, in, out[0]);
    want->value(want->self, in, out[1]);
    const double off = relative_distance(map->n_out, out[0], out[1]);
    CHECK(off < 1e-13, "N = %d, %s: values within %.1e", spec->robot.links, name, off);
    map->jacobian(map->self, in, values[0]);
    want->jacobian(want->self, in, values[1]);
    const double slope = disagreement(&map->jac, values[0], &want->jac, values[1]);
    CHECK(slope < 1e-13, "N = %d, %s: Jacobian within %.1e of complex step", spec->robot.links, name, slope);
    map->hessian(map->self, in, weight, values[0]);
    const double curve = hessian_error(map, values[0], want, in, weight);
    CHECK(curve < 1e-10, "N = %d, %s: Hessian within %.1e of complex step's differences", spec->robot.links, name,
          curve);
}

static void test_derivatives(int n_links, moray_joints form, bool path, moray_hydrodynamics hydro)
{
    const bool series = form == MORAY_JOINTS_SERIES;
    moray_plant_spec spec = {.robot = random_robot(&seed, n_links),
                             .joints = form,
                             .current = {0.3, -0.2},
                             .path_forces = path,
                             .path_angles = path,
                             .path_rates = path && series,
                             .harmonics = HARMONICS};
    spec.robot.hydro = hydro;
    moray_map map, want;
    double probe[MOST_INPUTS];
    CHECK_OK(moray_fp_plant(&map, &spec), "plant");
    random_input(&spec, map.n_in, probe);
    CHECK_OK(moray_map_from_complex(&want, map.n_in, map.n_out, reference, &spec, NULL, probe), "reference");
    for (int trial = 0; trial < 3; trial++)
        compare(series ? "series" : "free", &spec, &map, &want);
    moray_map_release(&map);
    moray_map_release(&want);
}

// ---- Series of gaits -----------------------------------------------------------------------------------------------

static moray_gait random_gait(moray_model model)
{
    moray_gait gait = {.omega = tap_random(&seed, 1, 3),
                       .delta = tap_random(&seed, 0.4, 1.4),
                       .offset = 0.01,
                       .taper = tap_random(&seed, -0.6, 0.6)};
    const moray_robot robot = moray_robot_paper();
    gait.amplitude = moray_amplitude_from_theta_max(&robot, model, 0.3, gait.delta);
    return gait;
}

// A gait and its series are one motion on a plant, for any number of harmonics.
static void test_gait_on_plants(moray_model model, int harmonics)
{
    moray_plant_spec spec = {.robot = moray_robot_paper(), .path_angles = true, .harmonics = harmonics};
    moray_map gait_map, series_map;
    double in[12] = {0.2, 1, -1, 0.3, 0.2, -0.1}, out[2][6 + 10 + 1], long_in[8 + 9 * 7] = {0};
    const moray_gait gait = random_gait(model);
    const double s[] = {gait.amplitude, gait.omega, gait.delta, gait.offset, gait.taper, 0.7};
    moray_status (*make)(moray_map *, const moray_plant_spec *) =
        model == MORAY_CONTROL_ORIENTED ? moray_control_plant : moray_fp_plant;
    CHECK_OK(make(&gait_map, &spec), "plant on the gait");
    spec.joints = MORAY_JOINTS_SERIES;
    CHECK_OK(make(&series_map, &spec), "plant on the series");
    memcpy(long_in, in, 6 * sizeof *in);
    memcpy(in + 6, s, sizeof s);
    long_in[6] = gait.omega;
    long_in[series_map.n_in - 1] = 0.7;
    moray_series_of_gait(&gait, 9, harmonics, long_in + 7);
    gait_map.value(gait_map.self, in, out[0]);
    series_map.value(series_map.self, long_in, out[1]);
    const double off = relative_distance(gait_map.n_out, out[1], out[0]);
    CHECK(off < 1e-13, "model %d, %d harmonics: gait and series agree to %.1e", model, harmonics, off);
    moray_map_release(&gait_map);
    moray_map_release(&series_map);
}

// What swims adds the series to the gait; phi' and phi'' are the derivatives.
static void test_reference(void)
{
    enum { n = 4, coefficients = n * 5 };
    double at[coefficients], folded[coefficients], longer[n * 7], phi[7][3][n];
    random_vector(&seed, 0.3, coefficients, at);
    const moray_series series = {n, 2, at};
    moray_gait gait = {.amplitude = 0.2, .omega = 1.7, .delta = 0.6, .offset = 0.05, .taper = 0.3, .series = &series};
    moray_series_of_gait(&gait, n, 2, folded);
    moray_series_of_gait(&gait, n, 3, longer);
    CHECK(memcmp(longer, folded, sizeof folded) == 0 && longer[coefficients] == 0, "more harmonics are empty");
    const moray_series all = {n, 2, folded};
    const moray_gait bare = {.omega = 1.7, .series = &all};
    const double t = 0.9, h = 1e-3;
    for (int k = 0; k < 7; k++)
        moray_gait_reference(&gait, n, t + (k - 3) * h, phi[k][0], phi[k][1], phi[k][2]);
    double again[3][n], worst = 0;
    moray_gait_reference(&bare, n, t, again[0], again[1], again[2]);
    CHECK(relative_distance(3 * n, again[0], phi[3][0]) < 1e-14, "a gait with a series as one series");
    for (int rank = 0; rank < 2; rank++)
        for (int i = 0; i < n; i++) {
            const double slope = (45 * (phi[4][rank][i] - phi[2][rank][i]) - 9 * (phi[5][rank][i] - phi[1][rank][i]) +
                                  phi[6][rank][i] - phi[0][rank][i]) /
                                 (60 * h);
            worst = tap_worse(worst, fabs(slope - phi[3][rank + 1][i]));
        }
    CHECK(worst < 1e-11, "phi' and phi'' are derivatives: %.1e", worst);
}

// To the first-principles model the series of a gait goes as the gait does.
static void test_gait_between_models(double taper, double tolerance)
{
    enum { n = 9, coefficients = n * 7 };
    const moray_robot robot = moray_robot_paper();
    double at[coefficients], mapped[coefficients], want[coefficients];
    moray_gait gait = random_gait(MORAY_CONTROL_ORIENTED);
    gait.taper = taper;
    const moray_series series = {n, 3, at};
    moray_series_of_gait(&gait, n, 3, at);
    moray_series_to_first_principles(&robot, &series, mapped);
    const moray_gait image = moray_gait_map(&robot, &gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    moray_series_of_gait(&image, n, 3, want);
    const double off = relative_distance(coefficients, mapped, want);
    CHECK(off < tolerance, "taper %g: mapped as the gait, to %.1e", taper, off);
}

// The wave of link angles behind both sorts of joint angles is one: by (29) and by (1), a quarter of a period apart.
static void test_link_angles(void)
{
    enum { n = 6, K = 3 };
    const moray_robot robot = moray_robot_paper();
    const double small = 1e-4, l = robot.l;
    double co[n * 7] = {0}, fp[n * 7], want[n * 7] = {0};
    for (int k = 1; k <= K; k++) { // theta_i = small sin(k (psi - i delta_k) - ..): any wave, both ways
        for (int i = 0; i < n; i++) {
            const double complex one = small / k * cexp(I * (k + 0.7 * k * i)), next = one * cexp(I * 0.7 * k);
            const double complex sum = l * (one + next), difference = (one - next) * cpow(I, k); // a quarter later
            co[n * (2 * k - 1) + i] = creal(sum);
            co[n * 2 * k + i] = cimag(sum);
            want[n * (2 * k - 1) + i] = creal(difference);
            want[n * 2 * k + i] = cimag(difference);
        }
    }
    const moray_series series = {n, K, co};
    moray_series_to_first_principles(&robot, &series, fp);
    CHECK(relative_distance(n * 7, fp, want) < 1e-7, "same link angles on both models: %.1e",
          relative_distance(n * 7, fp, want));
}

int main(void)
{
    for (int k = 0; k < ROBOT_SIZES; k++)
        for (int path = 0; path < 2; path++) {
            test_derivatives(robot_links[k], MORAY_JOINTS_FREE, path, hydro_variant(0));
            if (robot_links[k] <= 10) // more take long
                test_derivatives(robot_links[k], MORAY_JOINTS_SERIES, path, hydro_variant(0));
        }
    for (int variant = 1; variant < HYDRO_VARIANTS; variant++) {
        test_derivatives(2 + variant % 4, MORAY_JOINTS_FREE, true, hydro_variant(variant));
        test_derivatives(2 + variant % 3, MORAY_JOINTS_SERIES, true, hydro_variant(variant));
    }
    test_derivatives(20, MORAY_JOINTS_FREE, true, moray_hydrodynamics_consistent());
    for (int harmonics = 1; harmonics <= 3; harmonics += 2) {
        test_gait_on_plants(MORAY_CONTROL_ORIENTED, harmonics);
        test_gait_on_plants(MORAY_FIRST_PRINCIPLES, harmonics);
    }
    test_reference();
    test_gait_between_models(0, 1e-12);
    test_gait_between_models(0.5, 2e-3); // the mean amplitude of the links for that of the middle
    test_link_angles();
    moray_map map;
    const moray_plant_spec none = {.robot = moray_robot_paper(), .joints = MORAY_JOINTS_SERIES};
    CHECK(moray_control_plant(&map, &none).code == MORAY_INPUT, "no harmonics are refused");
    return tap_done();
}
