// SPDX-License-Identifier: MIT
//
// Heading feedback, tuned as the programs tune it, against an independent search: Nelder and Mead's simplex from twenty
// starts. Without an argument a short sine and two laws; with `sine`, `fig8` or `all`, Fig. 8 (its heading) and the
// sine of 30 deg and 60 s whole, all five laws (tests/studies/rivals.sh).
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/control/tuning.h"
#include "moray/snake/closed_loop.h"
#include "moray/snake/heading_law.h"
#include "moray/snake/trial.h"

enum { GAIN, FORWARD, LEAD, INTEGRAL, DERIVATIVE, NUMBERS };

static const moray_tuned_number numbers[NUMBERS] = {{MORAY_TUNED_LOGARITHMIC, 0.002, 20, 0},
                                                    {MORAY_TUNED_WITH_ZERO, 0, 20, 0.05},
                                                    {MORAY_TUNED_WITH_ZERO, 0, 8, 0.1},
                                                    {MORAY_TUNED_WITH_ZERO, 0, 20, 0.01},
                                                    {MORAY_TUNED_WITH_ZERO, 0, 5, 0.05}};

typedef struct pool { // where the rivals swim
    moray_robot robot;
    moray_straight_motion straight;
    moray_reference reference;
    double duration;
    unsigned law; // bits of the numbers that it has
} pool;

static void pool_new(pool *at, double theta_max, const char *reference, double duration)
{
    *at = (pool){.robot = moray_robot_paper(), .duration = duration};
    moray_gait gait = moray_gait_paper(&at->robot);
    gait.amplitude = moray_amplitude_from_theta_max(&at->robot, MORAY_FIRST_PRINCIPLES, theta_max, gait.delta);
    CHECK_OK(moray_straight_motion_find(&at->straight, &at->robot, MORAY_FIRST_PRINCIPLES, &gait), "straight");
    CHECK_OK(moray_reference_read(&at->reference, reference), "reference");
}

static double scale_of(const pool *at)
{
    const moray_gait other =
        moray_gait_map(&at->robot, &at->straight.gait, MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED);
    return -at->straight.gait.amplitude / other.amplitude; // erratum E3
}

static moray_swim_closed_loop swim(const pool *at, const double *gains)
{
    const double scale = scale_of(at);
    moray_feedback feedback = {.target = moray_heading_law_target,
                               .feed = moray_heading_law_feed,
                               .gain = scale * gains[GAIN],
                               .straight = &at->straight,
                               .offset = 0.015 * fabs(scale),
                               .offset_rate = 0.01 * fabs(scale),
                               .period = 0.1};
    moray_heading_law law = {.gains = {gains[GAIN], gains[FORWARD], gains[LEAD], gains[INTEGRAL], gains[DERIVATIVE]},
                             .reference = &at->reference,
                             .feedback = &feedback,
                             .scale = scale,
                             .smoothing = 0.5};
    feedback.self = &law;
    const moray_swim_controller controller = moray_feedback_controller(&feedback);
    const moray_swim_on_gait quick = {.steps = 24};
    double rate;
    const moray_swim_closed_loop_spec spec = {.robot = &at->robot,
                                              .straight = &at->straight,
                                              .heading = moray_reference_at(&at->reference, 0, &rate),
                                              .controller = &controller,
                                              .duration = at->duration,
                                              .intervals = (int)(10 * at->duration),
                                              .on_gait = &quick};
    moray_swim_closed_loop closed_loop = {0};
    if (moray_failed(moray_swim_closed_loop_run(&closed_loop, &spec)))
        moray_swim_closed_loop_free(&closed_loop);
    return closed_loop;
}

static void spread_out(const pool *at, const double *x, double gains[NUMBERS])
{
    for (int k = 0; k < NUMBERS; k++)
        gains[k] = at->law & 1u << k ? *x++ : 0;
}

// Mean square of the heading error.
static bool cost(void *self, const double *x, double *f)
{
    const pool *at = self;
    double gains[NUMBERS];
    spread_out(at, x, gains);
    moray_swim_closed_loop closed_loop = swim(at, gains);
    if (!closed_loop.swimmer)
        return false;
    const double rms = moray_swim_closed_loop_heading_score(&closed_loop, &at->straight, &at->reference).rms;
    *f = rms * rms;
    moray_swim_closed_loop_free(&closed_loop);
    return true;
}

// ---- An independent search -----------------------------------------------------------------------------------------

// z: logarithms of the numbers, of those that may be zero with 1e-3 added.
static double at_z(pool *at, int n, const moray_tuned_number *number, const double *z)
{
    double x[NUMBERS], f;
    for (int k = 0; k < n; k++) {
        const double beyond = number[k].scale == MORAY_TUNED_LOGARITHMIC ? 0 : 1e-3;
        x[k] = fmin(fmax(exp(z[k]) - beyond, number[k].lower), number[k].upper);
    }
    return cost(at, x, &f) ? f : 1e3;
}

static void exchange(int n, double *a, double *b)
{
    for (int k = 0; k < n; k++) {
        const double keep = a[k];
        a[k] = b[k];
        b[k] = keep;
    }
}

// z[n], then f, of every corner; the best first.
static void sort(int n, double corner[][NUMBERS + 1])
{
    for (int i = 1; i <= n; i++)
        for (int j = i; j > 0 && corner[j][n] < corner[j - 1][n]; j--)
            exchange(n + 1, corner[j], corner[j - 1]);
}

static double along(pool *at, int n, const moray_tuned_number *number, const double *middle, const double *worst,
                    double factor, double *made)
{
    for (int k = 0; k < n; k++)
        made[k] = middle[k] + factor * (worst[k] - middle[k]);
    return made[n] = at_z(at, n, number, made);
}

static double simplex(pool *at, int n, const moray_tuned_number *number, const double *start, int evaluations)
{
    double corner[NUMBERS + 1][NUMBERS + 1], middle[NUMBERS], tried[NUMBERS + 1], further[NUMBERS + 1];
    for (int i = 0; i <= n; i++) {
        memcpy(corner[i], start, (size_t)n * sizeof *start);
        if (i > 0)
            corner[i][i - 1] += 0.5;
        corner[i][n] = at_z(at, n, number, corner[i]);
    }
    for (int used = n + 1; used < evaluations;) {
        sort(n, corner);
        double *worst = corner[n];
        for (int k = 0; k < n; k++) {
            middle[k] = 0;
            for (int i = 0; i < n; i++)
                middle[k] += corner[i][k] / n;
        }
        used += 2;
        if (along(at, n, number, middle, worst, -1, tried) < corner[0][n])
            along(at, n, number, middle, worst, -2, further);
        else if (tried[n] < corner[n - 1][n])
            further[n] = INFINITY;
        else
            along(at, n, number, middle, worst, 0.5, further);
        const double *better = further[n] < tried[n] ? further : tried;
        if (better[n] < worst[n]) {
            memcpy(worst, better, sizeof tried);
            continue;
        }
        for (int i = 1; i <= n; i++, used++) { // shrinks
            for (int k = 0; k < n; k++)
                corner[i][k] = 0.5 * (corner[0][k] + corner[i][k]);
            corner[i][n] = at_z(at, n, number, corner[i]);
        }
    }
    sort(n, corner);
    return corner[0][n];
}

// ---- One law -------------------------------------------------------------------------------------------------------

static int numbers_of(unsigned law, moray_tuned_number *number)
{
    int n = 0;
    for (int k = 0; k < NUMBERS; k++)
        if (law & 1u << k)
            number[n++] = numbers[k];
    return n;
}

// The law tuned from the subsets' gains too; returns its RMS error [rad].
static double tuned(pool *at, unsigned law, double (*subset)[NUMBERS], int n_subsets, double gains[NUMBERS],
                    const char *name)
{
    const int simplex_starts = tap_thorough() ? 20 : 2;
    moray_tuned_number number[NUMBERS];
    const int n = numbers_of(law, number);
    const moray_tuning_problem problem = {.n = n, .number = number, .cost = cost, .self = at};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double from[4 * NUMBERS], x[NUMBERS], best = INFINITY, *to = from;
    unsigned long long seed = 11 + law;
    at->law = law;
    settings.evaluations = 20;
    settings.jobs = 2;
    for (int i = 0; i < n_subsets; i++)
        for (int k = 0; k < NUMBERS; k++)
            if (law & 1u << k)
                *to++ = subset[i][k];
    CHECK_OK(moray_tune(&problem, &settings, from, n_subsets, x, &info), name);
    spread_out(at, x, gains);
    for (int start = 0; start < simplex_starts; start++) {
        double z[NUMBERS];
        for (int k = 0; k < n; k++)
            z[k] = tap_random(&seed, log(fmax(number[k].lower, 1e-3)), log(number[k].upper));
        best = fmin(best, simplex(at, n, number, z, 40 * n));
    }
    const double ours = sqrt(info.cost) / DEG, theirs = sqrt(best) / DEG;
    CHECK(ours <= 1.05 * theirs, "%s: %.5f deg, within 5 %% of the simplex' %.5f deg from %d starts", name, ours,
          theirs, simplex_starts);
    return ours;
}

static void test_laws(pool *at, bool all)
{
    static const unsigned p = 1 << GAIN, forward = p | 1 << FORWARD, pid = p | 1 << INTEGRAL | 1 << DERIVATIVE,
                          ahead = p | 1 << LEAD, every = forward | pid | ahead;
    double gains[4][NUMBERS], most[NUMBERS];
    const double one = tuned(at, p, NULL, 0, gains[0], "P");
    const double two = tuned(at, forward, gains, 1, gains[1], "P, rate fed forward");
    CHECK(two <= one, "no worse than P: %.5f deg", two);
    if (!all)
        return;
    const double three = tuned(at, pid, gains, 1, gains[2], "PID");
    const double four = tuned(at, ahead, gains, 1, gains[3], "P ahead");
    CHECK(three <= one && four <= one, "nor these: %.5f deg, %.5f deg", three, four);
    const double five = tuned(at, every, gains + 1, 3, most, "PID ahead, rate fed forward");
    CHECK(five <= fmin(two, fmin(three, four)), "and all together no worse than any: %.5f deg", five);
}

// An integral without a bound would take long to come back from a turn that the offset's limit makes slow.
static void test_windup(void)
{
    pool at;
    pool_new(&at, 20 * DEG, "steps:2=60", 40);
    const double gains[NUMBERS] = {[GAIN] = 0.05, [INTEGRAL] = 0.05};
    moray_swim_closed_loop closed_loop = swim(&at, gains);
    double most = 0;
    for (int k = 0; k < closed_loop.track.n; k++)
        most = fmax(most, moray_straight_motion_heading(&at.straight, closed_loop.track.t[k],
                                                        closed_loop.track.pose[k].heading));
    CHECK(most > 60 * DEG && most < 75 * DEG, "a step of 60 deg is overshot to %.1f deg only", most / DEG);
    moray_swim_closed_loop_free(&closed_loop);
    moray_reference_free(&at.reference);
}

// The offset of Sec. V-C.
static moray_offset fig8_offset(double t, const void *self)
{
    const double sixth = ((const moray_straight_motion *)self)->gait.amplitude / 6;
    return (moray_offset){.value = t >= 40 && t < 70 ? -sixth : t >= 130 && t < 160 ? sixth : 0};
}

static moray_status look(const moray_swim_sample *sample, void *self) // the simulation stops here
{
    (void)sample, (void)self;
    return moray_ok();
}

// Its heading as the reference.
static void make_fig8(pool *at)
{
    const moray_swim_controller controller = {fig8_offset, look, 10, &at->straight};
    const moray_swim_on_gait how = {.steps = 48};
    const moray_swim_closed_loop_spec spec = {.robot = &at->robot,
                                              .straight = &at->straight,
                                              .controller = &controller,
                                              .duration = at->duration,
                                              .intervals = (int)(20 * at->duration),
                                              .on_gait = &how};
    moray_swim_closed_loop closed_loop;
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &spec), "Fig. 8");
    const int n = closed_loop.track.n;
    moray_reference_free(&at->reference);
    at->reference = (moray_reference){.n = n, .time = malloc(2 * (size_t)n * sizeof(double))};
    at->reference.heading = at->reference.time + n;
    for (int k = 0; k < n; k++) {
        at->reference.time[k] = closed_loop.track.t[k];
        at->reference.heading[k] =
            moray_straight_motion_heading(&at->straight, closed_loop.track.t[k], closed_loop.track.pose[k].heading);
    }
    moray_swim_closed_loop_free(&closed_loop);
}

int main(int argc, char **argv)
{
    const bool all = argc > 1;
    pool at;
    const bool fig8 = argc > 1 && strcmp(argv[1], "sine") != 0;
    test_windup();
    pool_new(&at, 20 * DEG, "sine:30,60", all ? 100 : tap_thorough() ? 15 : 5);
    if (!fig8 || strcmp(argv[1], "all") == 0)
        test_laws(&at, all);
    moray_reference_free(&at.reference);
    if (fig8) {
        pool_new(&at, 10 * DEG, "steps:0=0", 190);
        make_fig8(&at);
        test_laws(&at, all);
        moray_reference_free(&at.reference);
    }
    return tap_done();
}
