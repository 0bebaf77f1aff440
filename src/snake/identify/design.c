// SPDX-License-Identifier: MIT
//
// Which experiment tells most: the gait whose log adds most to what is known. A run is swum by the identified robot and
// read by instruments as those of the logs; its information is added to theirs, and to a little that is known before
// (every unknown within its scale), so that what the logs leave open counts but is not worth everything.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/search.h"
#include "moray/snake/instruments.h"
#include "snake/identify/identify.h"
#include "snake/identify/log.h"

static const double before = 1; // information of every unknown over its scale
enum { COARSE = 40 };           // steps a period: information needs no more

struct search {
    const moray_identify *of;
    const moray_estimate *at;
    const moray_information *known;
    const moray_design_spec *spec;
    moray_swim_log log; // whose joints are written anew for every gait
};

static moray_gait gait_of(const double x[MORAY_DESIGNED])
{
    return (moray_gait){.amplitude = x[0], .omega = x[1], .delta = x[2], .offset = x[3]};
}

// ---- Information of a gait -----------------------------------------------------------------------------------------

static void write_joints(const struct search *s, const moray_gait *gait)
{
    const int joints = s->log.joints;
    double rates[2 * MORAY_MOST_LINKS];
    for (int k = 0; k < s->log.n; k++)
        moray_gait_reference(gait, joints, s->log.t[k], s->log.phi + k * joints, rates, rates + joints);
}

static moray_identify_spec spec_of(const struct search *s, const moray_gait *gait)
{
    moray_identify_spec spec = s->of->spec;
    for (int kind = 0; kind < MORAY_CHANNELS; kind++)
        spec.sigma[kind] = s->of->run[0].sigma[kind];
    spec.joints = MORAY_LOGGED_GAIT;
    spec.step = 2 * M_PI / gait->omega / COARSE;
    spec.rest = false;
    spec.huber = 0; // what would be read is not known: no residual of it is an outlier
    return spec;
}

static moray_status information_of(const struct search *s, const moray_gait *gait, moray_information *info)
{
    const moray_identify_spec spec = spec_of(s, gait);
    moray_identify *one;
    moray_estimate at = *s->at;
    write_joints(s, gait);
    MORAY_TRY(moray_identify_new(&one, &spec, &s->log, 1));
    memset(at.first, 0, sizeof at.first); // at rest, where the log begins
    const moray_status status = moray_identify_information(one, &at, info);
    moray_identify_free(one);
    return status;
}

static moray_status add_information(const struct search *s, const moray_gait *gait, moray_information *sum)
{
    moray_information more;
    MORAY_TRY(information_of(s, gait, &more));
    *sum = *s->known;
    for (int k = 0; k < sum->n * sum->n; k++)
        sum->matrix[k] += more.matrix[k];
    return moray_information_examine(sum);
}

// ---- The search ----------------------------------------------------------------------------------------------------

static double worth(const moray_information *info, bool least)
{
    double sum = 0;
    int used = 0;
    for (int k = 0; k < info->n; k++)
        used += !info->held[k];
    for (int k = 0; k < used; k++)
        sum += log(fmax(info->value[k], 0) + before);
    return least ? log(fmax(info->value[used - 1], 0) + before) : sum;
}

static bool evaluate(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    const struct search *s = self;
    const moray_gait gait = gait_of(x);
    moray_information sum;
    (void)c, (void)gradient, (void)jacobian;
    if (gait.amplitude * gait.omega > s->spec->most_rate || moray_failed(add_information(s, &gait, &sum)))
        return false;
    *f = -worth(&sum, s->spec->least);
    return isfinite(*f);
}

static void draw(const moray_design_spec *spec, unsigned long *seed, double x[MORAY_DESIGNED])
{
    for (int i = 0; i < MORAY_DESIGNED; i++)
        x[i] = spec->lower[i] + moray_random(seed) * (spec->upper[i] - spec->lower[i]);
}

static moray_status search(struct search *s, double x[MORAY_DESIGNED])
{
    const moray_design_spec *spec = s->spec;
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info found;
    unsigned long seed = 1;
    double best = INFINITY, tried[MORAY_DESIGNED], f;
    for (int k = 0; k < spec->evaluations / 3; k++) {
        draw(spec, &seed, tried);
        if (evaluate(s, tried, &f, NULL, NULL, NULL) && f < best) {
            best = f;
            memcpy(x, tried, sizeof tried);
        }
    }
    if (!isfinite(best))
        return moray_error(MORAY_NOT_SOLVED, "no gait within the limits of the experiment can be swum");
    settings.method = MORAY_SEARCH_BOBYQA;
    settings.max_evaluations = spec->evaluations - spec->evaluations / 3;
    settings.x_tolerance = 1e-3;
    return moray_search(
        &(moray_search_problem){
            .n = MORAY_DESIGNED, .lower = spec->lower, .upper = spec->upper, .self = s, .evaluate = evaluate},
        &settings, x, &found);
}

static moray_status make_log(const moray_identify *v, const moray_design_spec *spec, moray_swim_log *log)
{
    const moray_swim_log *like = v->run[0].log;
    const double usual = (like->t[like->n - 1] - like->t[0]) / (like->n - 1);
    const int n = (int)fmin(spec->duration / usual, 100000) + 1;
    MORAY_TRY(moray_swim_log_new(log, n < 20 ? 20 : n, like->joints));
    double *room = log->phi + (size_t)log->n * (size_t)log->joints;
    for (int k = 0; k < log->n; k++)
        log->t[k] = spec->duration * k / (log->n - 1);
    log->u = like->u ? room : NULL;
    room += (size_t)log->n * (size_t)log->joints;
    log->p_x = like->p_x ? room : NULL;
    log->p_y = like->p_y ? room + log->n : NULL;
    log->heading = like->heading ? room + 2 * log->n : NULL;
    snprintf(log->name, sizeof log->name, "experiment");
    return moray_ok();
}

moray_status moray_identify_design(const moray_identify *v, const moray_estimate *at, const moray_information *known,
                                   const moray_design_spec *spec, moray_gait *gait, moray_information *after)
{
    struct search s = {.of = v, .at = at, .known = known, .spec = spec};
    double x[MORAY_DESIGNED];
    int used = 0;
    for (int k = 0; k < known->n; k++)
        used += !known->held[k];
    if (used == 0)
        return moray_error(MORAY_NOT_SOLVED,
                           "every unknown is at one of its bounds: no experiment tells more; widen the bounds");
    moray_status status = make_log(v, spec, &s.log);
    if (!moray_failed(status))
        status = search(&s, x);
    if (!moray_failed(status)) {
        *gait = gait_of(x);
        status = add_information(&s, gait, after);
    }
    moray_swim_log_free(&s.log);
    return status;
}
