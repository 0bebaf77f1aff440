// SPDX-License-Identifier: MIT
//
// Logs made ready: joints, standard deviations, what counts, where each run starts.
#include "snake/identify/identify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double per_period = 120, usual_step = 0.02;
enum { MOST_STEPS = 1000000 };
static const double least_noise = 1e-4; // of a channel's range: no instrument is better

static const char *const channel_names[MORAY_CHANNELS] = {"p_x", "p_y", "heading", "torque"};

const char *moray_channel_name(moray_channel_kind kind)
{
    return channel_names[kind];
}

static const double *channel_of(const moray_swim_log *log, moray_channel_kind kind, int joint, int *stride)
{
    *stride = kind == MORAY_CHANNEL_TORQUE ? log->joints : 1;
    switch (kind) {
    case MORAY_CHANNEL_X:
        return log->p_x;
    case MORAY_CHANNEL_Y:
        return log->p_y;
    case MORAY_CHANNEL_HEADING:
        return log->heading;
    default:
        return log->u ? log->u + joint : NULL;
    }
}

static int width_of(const moray_swim_log *log, moray_channel_kind kind)
{
    return kind == MORAY_CHANNEL_TORQUE ? log->joints : 1;
}

// ---- Standard deviations and first guesses --------------------------------------------------------------------------

static double range_of(const double *y, int n, int stride)
{
    double low = INFINITY, high = -INFINITY; // fmin and fmax pass over NaN
    for (int k = 0; k < n; k++)
        low = fmin(low, y[k * stride]), high = fmax(high, y[k * stride]);
    return high > low ? high - low : 1;
}

// From the scatter about splines, of both coordinates or all torques as one; the spline of one channel serves the
// guess.
static moray_status take_scatter(const moray_identify *v, struct run *run, moray_channel_kind kind, double d[3])
{
    const moray_swim_log *log = run->log;
    double sum = 0, least = 0;
    int freedom = 0, stride;
    for (int i = 0; i < width_of(log, kind); i++) {
        struct smooth s;
        const double *y = channel_of(log, kind, i, &stride);
        const moray_status status = moray_smooth_fit(&s, log->n, log->t, y, stride);
        if (!moray_failed(status)) {
            moray_smooth_at(&s, log->t[0], d);
            sum += s.noise * s.noise * s.freedom;
            freedom += s.freedom;
            least = fmax(least, least_noise * range_of(y, log->n, stride));
        }
        moray_smooth_free(&s);
        if (moray_failed(status))
            return moray_error(status.code, "log %s: %s: %.150s; leave the column out", log->name,
                               moray_channel_name(kind), status.text);
    }
    run->sigma[kind] = v->spec.sigma[kind];
    if (isnan(v->spec.sigma[kind])) {
        run->sigma[kind] = fmax(sqrt(sum / freedom), least);
        run->freedom[kind] = freedom;
    }
    return moray_ok();
}

static void share_position(struct run *run)
{
    if (run->freedom[MORAY_CHANNEL_X] == 0 || run->freedom[MORAY_CHANNEL_Y] == 0)
        return;
    const double both = sqrt((run->sigma[0] * run->sigma[0] + run->sigma[1] * run->sigma[1]) / 2);
    run->sigma[0] = run->sigma[1] = both;
}

static moray_status make_guess(const moray_identify *v, struct run *run)
{
    const moray_unknowns *world = &v->spec.start;
    const moray_swim_log *log = run->log;
    double d[MORAY_CHANNELS][3] = {{0}};
    int stride;
    for (int kind = 0; kind < MORAY_CHANNELS; kind++)
        if (channel_of(log, kind, 0, &stride) &&
            (kind != MORAY_CHANNEL_TORQUE || v->spec.model == MORAY_FIRST_PRINCIPLES))
            MORAY_TRY(take_scatter(v, run, kind, d[kind]));
    share_position(run);
    const double c = cos(world->camera_rotation), s = sin(world->camera_rotation);
    double *to = run->guess, velocity[2] = {0, 0};
    if (log->p_x) {
        to[MORAY_STATE_P_X] = c * d[0][0] + s * d[1][0] + world->camera[0];
        to[MORAY_STATE_P_Y] = -s * d[0][0] + c * d[1][0] + world->camera[1];
        velocity[0] = c * d[0][1] + s * d[1][1], velocity[1] = -s * d[0][1] + c * d[1][1];
    }
    if (log->heading) {
        to[MORAY_STATE_THETA] = d[MORAY_CHANNEL_HEADING][0] - world->heading_bias;
        to[MORAY_STATE_V_THETA] = d[MORAY_CHANNEL_HEADING][1];
    } else if (log->p_x) { // where it went
        to[MORAY_STATE_THETA] =
            atan2(log->p_y[log->n - 1] - log->p_y[0], log->p_x[log->n - 1] - log->p_x[0]) - world->camera_rotation;
        to[MORAY_STATE_THETA] =
            isfinite(to[MORAY_STATE_THETA]) ? to[MORAY_STATE_THETA] : atan2(velocity[1], velocity[0]);
    }
    const bool control = v->spec.model == MORAY_CONTROL_ORIENTED;
    const double h = control ? to[MORAY_STATE_THETA] : 0;
    to[MORAY_STATE_V_1] = cos(h) * velocity[0] + sin(h) * velocity[1];
    to[MORAY_STATE_V_2] = -sin(h) * velocity[0] + cos(h) * velocity[1];
    for (int i = MORAY_STATE_V_THETA; i <= MORAY_STATE_V_2 && v->spec.rest; i++)
        to[i] = 0;
    return moray_ok();
}

// ---- Items ---------------------------------------------------------------------------------------------------------

// The longest delay that an estimate may have: what is read before is not swum.
static double longest_delay(const moray_identify *v, bool ahead)
{
    double most = 0;
    for (int k = 0; k < 2; k++) { // that of the joints moves what is swum, not what is read
        static const char *const names[] = {"position_delay", "heading_delay"};
        const int unknown = moray_unknown_named(names[k]);
        moray_unknowns world = v->spec.start;
        double low = *moray_unknown_at(unknown, &world), high = low;
        for (int i = 0; i < v->spec.n; i++)
            if (v->unknown[i] == unknown)
                low = v->lower[i], high = v->upper[i];
        most = fmax(most, ahead ? -low : high);
    }
    return most;
}

static moray_status list_items(const moray_identify *v, struct run *run)
{
    const moray_swim_log *log = run->log;
    const double from = log->t[0] + longest_delay(v, false), to = log->t[log->n - 1] - longest_delay(v, true);
    const int most = log->n * (3 + log->joints);
    int stride;
    run->item = calloc((size_t)most, sizeof *run->item);
    if (!run->item)
        return moray_error(MORAY_MEMORY, "no memory for a log of %d rows", log->n);
    for (int row = 0; row < log->n; row++)
        for (int kind = 0; kind < MORAY_CHANNELS; kind++)
            for (int i = 0; i < width_of(log, kind); i++) {
                const double *y = channel_of(log, kind, i, &stride);
                const bool counts = y && (kind != MORAY_CHANNEL_TORQUE || v->spec.model == MORAY_FIRST_PRINCIPLES);
                if (counts && !isnan(y[row * stride]) && log->t[row] >= from && log->t[row] <= to)
                    run->item[run->items++] = (struct item){row, i, kind, y[row * stride], run->sigma[kind]};
            }
    if (run->items == 0)
        return moray_error(MORAY_INPUT, "log %s: no measurement that the %s model can be compared with", log->name,
                           moray_model_name(v->spec.model));
    return moray_ok();
}

static moray_status make_grid(const moray_identify *v, struct run *run)
{
    const double length = run->log->t[run->log->n - 1] - run->log->t[0];
    double h = v->spec.step;
    if (!(h > 0))
        h = run->motion.on_gait ? 2 * M_PI / run->motion.gait.omega / per_period : usual_step;
    const double steps = fmax(ceil(length / h), 1);
    if (!(steps <= MOST_STEPS))
        return moray_error(MORAY_INPUT, "log %s: %.6g s in steps of %.3g s are %.3g steps: must be at most %d",
                           run->log->name, length, h, steps, MOST_STEPS);
    run->steps = (int)steps;
    run->h = length / run->steps;
    run->grid = calloc(((size_t)run->steps + 1) * 2 * FIRST, sizeof *run->grid);
    return run->grid ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d steps", run->steps);
}

static moray_status make_run(moray_identify *v, struct run *run, const moray_swim_log *log)
{
    run->log = log;
    if (log->joints != v->spec.start.robot.links - 1)
        return moray_error(MORAY_INPUT, "log %s: %d joints, but the robot has %d links", log->name, log->joints,
                           v->spec.start.robot.links);
    const bool control = v->spec.model == MORAY_CONTROL_ORIENTED;
    MORAY_TRY(moray_motion_new(&run->motion, log, control ? MORAY_LOGGED_GAIT : v->spec.joints));
    MORAY_TRY(make_guess(v, run));
    MORAY_TRY(list_items(v, run));
    v->items += run->items;
    return make_grid(v, run);
}

// ---- The whole -----------------------------------------------------------------------------------------------------

static moray_status check(const moray_identify_spec *spec, int logs)
{
    moray_unknowns world = spec->start;
    if (spec->n < 1 || spec->n > MORAY_MOST_UNKNOWNS)
        return moray_error(MORAY_INPUT, "%d unknowns: must be 1 to %d", spec->n, MORAY_MOST_UNKNOWNS);
    if (logs < 1 || logs > MORAY_IDENTIFY_RUNS)
        return moray_error(MORAY_INPUT, "%d logs: must be 1 to %d", logs, MORAY_IDENTIFY_RUNS);
    for (int k = 0; k < spec->n; k++) {
        const char *name = moray_unknown_name(spec->unknown[k]);
        const double value = *moray_unknown_at(spec->unknown[k], &world);
        if (!moray_unknown_applies(spec->unknown[k], &spec->start.robot, spec->model))
            return moray_error(MORAY_INPUT, "%s: the %s model with this hydrodynamics does not feel it", name,
                               moray_model_name(spec->model));
        if (!(spec->lower[k] < spec->upper[k]) || !(value >= spec->lower[k] && value <= spec->upper[k]))
            return moray_error(MORAY_INPUT, "%s = %g at the start: must be within its bounds, %g to %g", name, value,
                               spec->lower[k], spec->upper[k]);
    }
    return moray_robot_check(&spec->start.robot);
}

static void take_spec(moray_identify *v, const moray_identify_spec *spec)
{
    v->spec = *spec;
    for (int k = 0; k < spec->n; k++) {
        const struct unknown *u = &moray_unknown_table[spec->unknown[k]];
        const double value = *moray_unknown_at(spec->unknown[k], &v->spec.start);
        v->unknown[k] = spec->unknown[k];
        v->lower[k] = spec->lower[k];
        v->upper[k] = spec->upper[k];
        v->scale[k] = u->offset ? u->scale : value > 0 ? value : spec->upper[k] - spec->lower[k];
    }
    v->spec.unknown = v->unknown;
    v->spec.lower = v->lower;
    v->spec.upper = v->upper;
}

static moray_status make_room(moray_identify *v)
{
    const int links = v->spec.start.robot.links;
    const size_t m = (size_t)v->columns, stride = (size_t)v->spec.n + FIRST, states = 2 * (size_t)links + 4;
    size_t most = 0;
    for (int r = 0; r < v->runs; r++)
        most = (size_t)v->run[r].items > most ? (size_t)v->run[r].items : most;
    v->x = calloc(2 * states + 4 * (size_t)links + most * (4 + stride) + 2 * m * m + 2 * m, sizeof *v->x);
    if (!v->x)
        return moray_error(MORAY_MEMORY, "no memory for %d measurements", v->items);
    v->dx = v->x + states;
    v->joint = v->dx + states;
    v->up = v->joint + 4 * links;
    v->down = v->up + most;
    v->here = v->down + most;
    v->residual = v->here + most;
    v->jacobian = v->residual + most;
    v->normal = v->jacobian + most * stride;
    v->work = v->normal + m * m;
    v->gradient = v->work + m * m;
    v->step = v->gradient + m;
    return moray_ok();
}

static moray_status make(moray_identify *v, const moray_swim_log *log, int logs)
{
    v->run = calloc((size_t)logs, sizeof *v->run);
    if (!v->run)
        return moray_error(MORAY_MEMORY, "no memory for %d logs", logs);
    for (v->runs = 0; v->runs < logs;) {
        struct run *run = &v->run[v->runs++];
        MORAY_TRY(make_run(v, run, &log[v->runs - 1]));
    }
    v->columns = v->spec.n + FIRST * logs;
    MORAY_TRY(make_room(v));
    return moray_swimmer_new(&v->swimmer, &v->spec.start.robot, v->spec.model);
}

moray_status moray_identify_new(moray_identify **identify, const moray_identify_spec *spec, const moray_swim_log *log,
                                int logs)
{
    *identify = NULL;
    MORAY_TRY(check(spec, logs));
    moray_identify *v = calloc(1, sizeof *v);
    if (!v)
        return moray_error(MORAY_MEMORY, "no memory to identify a robot");
    take_spec(v, spec);
    const moray_status status = make(v, log, logs);
    if (moray_failed(status))
        moray_identify_free(v);
    else
        *identify = v;
    return status;
}

void moray_identify_free(moray_identify *v)
{
    if (!v)
        return;
    for (int r = 0; r < v->runs; r++) {
        moray_motion_free(&v->run[r].motion);
        free(v->run[r].item);
        free(v->run[r].grid);
    }
    free(v->run);
    free(v->x);
    moray_swimmer_free(v->swimmer);
    free(v);
}

const char *moray_identify_joints(const moray_identify *v, int run)
{
    return v->run[run].motion.text;
}

bool moray_identify_gait(const moray_identify *v, int run, moray_gait *gait, double *shift)
{
    *gait = v->run[run].motion.gait;
    *shift = v->run[run].motion.shift;
    return v->run[run].motion.on_gait;
}

double moray_identify_sigma(const moray_identify *v, int run, moray_channel_kind kind)
{
    return v->run[run].sigma[kind];
}
