// SPDX-License-Identifier: MIT
//
// The experiment to swim next: its information by a log of the gait that is written here, and the best of the gaits
// that were drawn.
#include "swum_logs.h"

#include "moray/snake/instruments.h"

enum { EVALUATIONS = 18, DRAWN = EVALUATIONS / 3 };

typedef struct scene {
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    moray_estimate at;
    moray_information known;
} scene;

static void begin(scene *of, moray_model model, bool positions)
{
    static const char *const names[] = {"c_t", "c_n", "current_x", "current_y"};
    swum_logs(model, swum_noise(), of->log);
    for (int k = 0; k < SWUM_LOGS && !positions; k++)
        of->log[k].p_x = of->log[k].p_y = NULL;
    swum_choose(&of->s, model, names, 4);
    of->s.spec.huber = 1.5;
    of->s.spec.rest = true;
    of->s.spec.sigma[MORAY_CHANNEL_HEADING] = NAN;
    CHECK_OK(moray_identify_new(&of->v, &of->s.spec, of->log, SWUM_LOGS), "new");
    moray_identify_start(of->v, 0, &of->at);
    CHECK_OK(moray_identify_information(of->v, &of->at, &of->known), "what is known");
}

static void end(scene *of)
{
    moray_identify_free(of->v);
    swum_free(of->log);
}

static moray_design_spec box(moray_model model)
{
    const double size = model == MORAY_CONTROL_ORIENTED ? 0.6 : 1;
    return (moray_design_spec){.lower = {0.2 * size, 1, 0.5, -0.1},
                               .upper = {0.8 * size, 3, 1.5, 0.2},
                               .most_rate = INFINITY,
                               .duration = 3.3,
                               .evaluations = EVALUATIONS};
}

// What a log of the gait from rest would add: as many rows in its time as the first log has, 20 at least.
static void by_hand(const scene *of, const moray_gait *gait, double duration, int rows, moray_information *sum)
{
    const moray_swim_log *like = &of->log[0];
    moray_identify_spec spec = of->s.spec;
    moray_swim_log log = {.name = "by hand", .joints = 2};
    moray_estimate at = of->at;
    moray_identify *v;
    moray_information more;
    double *room = calloc((size_t)rows * 8, sizeof *room), rates[4];
    log.n = rows;
    log.line = calloc((size_t)rows, sizeof *log.line);
    log.t = room, log.phi = room + rows, log.u = like->u ? room + 3 * rows : NULL;
    log.p_x = like->p_x ? room + 5 * rows : NULL, log.p_y = like->p_y ? room + 6 * rows : NULL;
    log.heading = room + 7 * rows;
    for (int k = 0; k < rows; k++) {
        log.t[k] = k * (duration / (rows - 1));
        moray_gait_reference(gait, 2, log.t[k], log.phi + 2 * k, rates, rates + 2);
    }
    for (int kind = 0; kind < MORAY_CHANNELS; kind++)
        spec.sigma[kind] = moray_identify_sigma(of->v, 0, (moray_channel_kind)kind);
    if (!like->p_x)
        spec.sigma[0] = spec.sigma[1] = 1;
    if (!like->u)
        spec.sigma[3] = 1;
    spec.huber = 0;
    spec.rest = false;
    spec.step = 2 * M_PI / gait->omega / 40;
    spec.joints = MORAY_LOGGED_GAIT;
    memset(at.first, 0, sizeof at.first);
    CHECK_OK(moray_identify_new(&v, &spec, &log, 1), "by hand");
    CHECK_OK(moray_identify_information(v, &at, &more), "by hand");
    *sum = of->known;
    for (int k = 0; k < 16; k++)
        sum->matrix[k] += more.matrix[k];
    CHECK_OK(moray_information_examine(sum), "in sum");
    moray_identify_free(v);
    free(log.line);
    free(room);
}

static double worth(const moray_information *info, bool least)
{
    double product = 1, smallest = INFINITY;
    for (int k = 0; k < info->n; k++) {
        product *= 1 + info->value[k];
        smallest = info->value[k] < smallest ? info->value[k] : smallest;
    }
    return least ? smallest : product;
}

static void check_sum(const moray_information *got, const moray_information *want)
{
    double worst = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            worst = tap_worse(worst, fabs(got->matrix[i * 4 + j] - want->matrix[i * 4 + j]) /
                                         sqrt(want->matrix[i * 5] * want->matrix[j * 5]));
    CHECK(worst < 1e-6, "the information of the logs and of the gait: %.1e off", worst);
    CHECK(got->rank == want->rank && fabs(got->error[0] / want->error[0] - 1) < 1e-5, "errors after it, %g",
          got->error[0]);
}

static void draw(const moray_design_spec *spec, unsigned long *seed, double x[MORAY_DESIGNED])
{
    for (int i = 0; i < MORAY_DESIGNED; i++)
        x[i] = spec->lower[i] + moray_random(seed) * (spec->upper[i] - spec->lower[i]);
}

// Not worse than any that was drawn, and not merely the first.
static void check_best(const scene *of, moray_design_spec spec, int rows)
{
    moray_gait gait;
    moray_information after, want;
    unsigned long seed = 1;
    double first = NAN, best = -INFINITY;
    CHECK_OK(moray_identify_design(of->v, &of->at, &of->known, &spec, &gait, &after), "design");
    by_hand(of, &gait, spec.duration, rows, &want);
    check_sum(&after, &want);
    CHECK(gait.amplitude >= spec.lower[0] && gait.amplitude <= spec.upper[0] && gait.omega >= spec.lower[1] &&
              gait.omega <= spec.upper[1] && gait.delta >= spec.lower[2] && gait.delta <= spec.upper[2] &&
              gait.offset >= spec.lower[3] && gait.offset <= spec.upper[3] && gait.taper == 0,
          "within the box: %g, %g, %g, %g", gait.amplitude, gait.omega, gait.delta, gait.offset);
    CHECK(gait.amplitude * gait.omega <= spec.most_rate, "joints are not faster than %g", spec.most_rate);
    for (int k = 0; k < DRAWN; k++) {
        double x[MORAY_DESIGNED];
        draw(&spec, &seed, x);
        if (x[0] * x[1] > spec.most_rate)
            continue;
        by_hand(of, &(moray_gait){.amplitude = x[0], .omega = x[1], .delta = x[2], .offset = x[3]}, spec.duration, rows,
                &want);
        const double it = worth(&want, spec.least);
        first = isnan(first) ? it : first;
        best = it > best ? it : best;
    }
    const double found = worth(&after, spec.least);
    CHECK(found > (1 - 1e-6) * best && found > 1.01 * first, "worth %.4g, of those drawn %.4g, of the first %.4g",
          found, best, first);
}

static void test_best(void)
{
    for (int model = 0; model < 2; model++) {
        scene of;
        begin(&of, (moray_model)model, true);
        moray_design_spec spec = box((moray_model)model);
        check_best(&of, spec, 27); // in steps of the first log's
        spec.least = true;
        check_best(&of, spec, 27);
        spec.duration = 2.25;
        spec.most_rate = 1.2 * spec.upper[0];
        check_best(&of, spec, 20);
        end(&of);
    }
}

// What the logs do not measure the experiment does not either.
static void test_channels(void)
{
    scene of;
    moray_gait gait;
    moray_information after, want;
    begin(&of, MORAY_FIRST_PRINCIPLES, false);
    const moray_design_spec spec = box(MORAY_FIRST_PRINCIPLES);
    CHECK_OK(moray_identify_design(of.v, &of.at, &of.known, &spec, &gait, &after), "design");
    by_hand(&of, &gait, spec.duration, 27, &want);
    check_sum(&after, &want);
    end(&of);
}

static void test_refusals(void)
{
    scene of;
    moray_gait gait;
    moray_information after;
    begin(&of, MORAY_FIRST_PRINCIPLES, true);
    moray_design_spec spec = box(MORAY_FIRST_PRINCIPLES);
    spec.most_rate = 0.1;
    moray_status status = moray_identify_design(of.v, &of.at, &of.known, &spec, &gait, &after);
    CHECK(status.code == MORAY_NOT_SOLVED &&
              strcmp(status.text, "no gait within the limits of the experiment can be swum") == 0,
          "%s", status.text);
    spec.most_rate = INFINITY;
    for (int k = 0; k < 4; k++)
        of.known.held[k] = true;
    status = moray_identify_design(of.v, &of.at, &of.known, &spec, &gait, &after);
    CHECK(status.code == MORAY_NOT_SOLVED &&
              strcmp(status.text,
                     "every unknown is at one of its bounds: no experiment tells more; widen the bounds") == 0,
          "%s", status.text);
    end(&of);
}

int main(void)
{
    test_best();
    test_channels();
    test_refusals();
    return tap_done();
}
