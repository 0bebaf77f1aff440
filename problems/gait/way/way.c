// SPDX-License-Identifier: MIT
#include <string.h>

#include "way.h"

static const double sharp = 1e-3; // radius of the corners [m]: no place lies in one

// ---- Steady swimming in a current ----------------------------------------------------------------------------------

// Along the course, or no way at all.
static moray_status swim(const way_job *run, const moray_gait *gait, const double current[2], double course,
                         moray_steady *steady)
{
    moray_orbit_spec spec = moray_orbit_spec_default(&run->job.snake.robot, run->job.snake.model);
    moray_orbit *orbit;
    moray_orbit_result found;
    memcpy(spec.current, current, sizeof spec.current);
    spec.course = course;
    MORAY_TRY(moray_orbit_new(&orbit, &spec));
    const moray_status status = moray_orbit_solve(orbit, gait, &found);
    moray_orbit_free(orbit);
    *steady = found.steady;
    if (!moray_failed(status) && !(moray_course_speed(steady, course) > 0))
        return moray_error(MORAY_NOT_SOLVED, "the gait makes no way along the course");
    return status;
}

static moray_status meet(const way_job *run, const way_place *place, double t, double current[2])
{
    if (!moray_water_covers(run->water, place->x, place->y, t))
        return moray_error(MORAY_INPUT,
                           "--water %.120s: the way is at (%.4g, %.4g) m at t = %.4g s, outside of the table",
                           run->water_file, place->x, place->y, t);
    moray_water_at(run->water, place->x, place->y, t, current);
    return moray_ok();
}

static double share_of(const way_job *run)
{
    return run->path.length / run->places;
}

// Counts a share of the way.
static void count(const way_job *run, double speed, double power, way_total *sum)
{
    const double seconds = share_of(run) / speed;
    sum->time += seconds;
    sum->work += seconds * (power + run->job.snake.robot.supply.constant);
}

// From a place on, begun at a time, on one gait or (NULL) those of the places; NaN where it does not come through. The
// middle of a share is reached at the speed of the one before.
static way_total march(const way_job *run, const moray_gait *gait, int from, double start)
{
    const way_total never = {NAN, NAN};
    way_total sum = {start, 0};
    moray_steady steady;
    double V[2], speed = INFINITY;
    for (int k = from; k < run->places; k++) {
        const way_place *place = &run->place[k];
        for (int pass = k > from; pass < 2; pass++) { // the first speed is not known before
            if (moray_failed(meet(run, place, sum.time + share_of(run) / 2 / speed, V)) ||
                moray_failed(swim(run, gait ? gait : &place->at.prediction.gait, V, place->course, &steady)))
                return never;
            speed = moray_course_speed(&steady, place->course);
        }
        count(run, speed, steady.power, &sum);
    }
    return sum;
}

// ---- Gaits of the places -------------------------------------------------------------------------------------------

// The gait of least work per metre, a second of time counting at its price besides.
static moray_status optimise(way_job *run, way_place *place, const moray_gait *before)
{
    gait_job *job = &run->job;
    double *constant = &job->snake.robot.supply.constant;
    const double own = *constant;
    const gait_starts known = {.gait = {*before, job->paper.gait[job->snake.model]}, .n = 2};
    memcpy(job->snake.current, place->current, sizeof place->current);
    job->snake.course = place->course;
    MORAY_TRY(gait_job_demand(job, job->snake.model, &place->at));
    *constant = fmax(own + place->price, 0);
    const moray_status status = gait_job_optimise(job, &place->at, &known);
    *constant = own;
    if (status.code == MORAY_NOT_SOLVED)
        return moray_error(MORAY_NOT_SOLVED, "at (%.4g, %.4g) m, %.4g s: %.220s", place->x, place->y, place->t,
                           status.text);
    return status;
}

// Fills place[places], whose prices are set.
static moray_status follow(way_job *run, way_place *place, way_total *sum)
{
    gait_job *job = &run->job;
    moray_gait gait = job->paper.gait[job->snake.model];
    moray_steady steady;
    double speed = INFINITY;
    *sum = (way_total){0, 0};
    if (!moray_failed(swim(run, &gait, run->place[0].current, run->place[0].course, &steady)))
        speed = moray_course_speed(&steady, run->place[0].course);
    for (int k = 0; k < run->places; k++, place++) {
        moray_ticker_count(&job->ticker, k, run->places, "%s: the way", job->name);
        for (int pass = k > 0; pass < 2; pass++) { // as march
            gait_job_stage_free(&place->at);
            place->at = (stage){0};
            place->t = sum->time + share_of(run) / 2 / speed;
            MORAY_TRY(meet(run, place, place->t, place->current));
            MORAY_TRY(optimise(run, place, &gait));
            gait = place->at.prediction.gait;
            speed = place->at.prediction.course_speed;
        }
        count(run, speed, place->at.prediction.power, sum);
        place->left = sum->time;
    }
    return moray_ok();
}

// ---- Water that changes with time ----------------------------------------------------------------------------------

// What a second later at the end of each share costs on the rest of the way, into the prices of again[places].
static void set_prices(way_job *run)
{
    const double apart = 0.5; // [s]
    for (int k = 0; k < run->places; k++) {
        const way_place *of = &run->place[k];
        const double later = march(run, NULL, k + 1, of->left + apart).work,
                     sooner = march(run, NULL, k + 1, of->left - apart).work, price = (later - sooner) / (2 * apart);
        run->again[k] = (way_place){.along = of->along, .x = of->x, .y = of->y, .course = of->course};
        run->again[k].price = isfinite(price) ? price : 0;
    }
}

static void free_places(way_place *place, int n)
{
    for (int k = 0; k < n; k++)
        gait_job_stage_free(&place[k].at);
}

static void take_again(way_job *run)
{
    for (int k = 0; k < run->places; k++) {
        gait_job_stage_free(&run->place[k].at);
        run->place[k] = run->again[k];
        run->again[k].at = (stage){0};
    }
}

// To hurry or to wait pays where the current turns: with what time is worth at each place the gaits are found anew, as
// long as the whole work falls.
static moray_status allow_for_time(way_job *run)
{
    enum { passes = 5 };
    const double enough = 1e-3;
    double low[3], high[3];
    moray_water_range(run->water, low, high);
    for (int pass = 0; pass < passes && isfinite(high[2]); pass++) {
        way_total sum;
        set_prices(run);
        const moray_status status = follow(run, run->again, &sum);
        if (status.code == MORAY_INTERRUPTED)
            return status;
        if (moray_failed(status) || !(sum.work < run->own.work))
            break;
        const bool little = sum.work > (1 - enough) * run->own.work;
        take_again(run);
        run->own = sum;
        if (little)
            break;
    }
    free_places(run->again, run->places);
    return moray_ok();
}

// ---- Proof ---------------------------------------------------------------------------------------------------------

static moray_status prove(way_job *run)
{
    const gait_job *job = &run->job;
    for (int k = 0; k < run->places; k++) {
        way_place *place = &run->place[k];
        moray_swim_setup setup = moray_test_rig_setup(&job->rig, job->snake.model);
        MORAY_TRY(gait_job_certify(job, &place->at));
        memcpy(setup.current, place->current, sizeof setup.current);
        if (moray_failed(moray_swim_hold_course(&setup, &place->at.prediction.gait, place->course, &place->swum)))
            place->swum.power = NAN;
    }
    return moray_ok();
}

static void compare(way_job *run)
{
    run->one = (way_total){NAN, NAN};
    for (int k = 0; k < run->places; k++) {
        const way_total kept = march(run, &run->place[k].at.prediction.gait, 0, 0);
        if (kept.work < run->one.work || isnan(run->one.work)) {
            run->one = kept;
            run->best = k;
        }
    }
    run->paper = march(run, &run->job.paper.gait[run->job.snake.model], 0, 0);
}

// ---- The whole -----------------------------------------------------------------------------------------------------

static moray_status check(const way_job *run)
{
    const gait_job *job = &run->job;
    if (!run->water_file[0] || !run->way_text[0])
        return moray_error(MORAY_INPUT, "--water FILE and --way 'X,Y X,Y ...': a way through water needs both");
    if (job->snake.current[0] != 0 || job->snake.current[1] != 0)
        return moray_error(MORAY_INPUT, "--water and --current: give one of them");
    if (job->from_file[0] || job->solution_file[0])
        return moray_error(MORAY_INPUT, "--continue and --solution are of one gait, --way has one for each place");
    return moray_ok();
}

static moray_status place_all(way_job *run)
{
    MORAY_TRY(moray_path_read(&run->path, run->way_text, sharp));
    for (int k = 0; k < run->places; k++) {
        way_place *place = &run->place[k];
        place->along = share_of(run) * (k + 0.5);
        const moray_path_point at = moray_path_at(&run->path, place->along);
        place->x = creal(at.x), place->y = creal(at.y), place->course = creal(at.course);
        MORAY_TRY(meet(run, place, 0, place->current));
    }
    return moray_ok();
}

moray_status way_work(gait_job *job)
{
    way_job *run = (way_job *)job;
    MORAY_TRY(check(run));
    MORAY_TRY(moray_water_read(&run->water, run->water_file));
    MORAY_TRY(place_all(run));
    job->speed = isnan(job->speed) ? INFINITY : job->speed;
    memcpy(job->snake.current, run->place[0].current, sizeof job->snake.current);
    job->snake.course = run->place[0].course;
    MORAY_TRY(gait_job_prepare(job));
    MORAY_TRY(follow(run, run->place, &run->own));
    MORAY_TRY(allow_for_time(run));
    MORAY_TRY(prove(run));
    compare(run);
    return moray_ok();
}

moray_status way_certified(const gait_job *job)
{
    const way_job *run = (const way_job *)job;
    for (int k = 0; k < run->places; k++) {
        char what[80];
        snprintf(what, sizeof what, "gait at %.4g m of the way", run->place[k].along);
        MORAY_TRY(gait_job_certified(job, what, &run->place[k].at));
    }
    return moray_ok();
}

void way_release(gait_job *job)
{
    way_job *run = (way_job *)job;
    free_places(run->place, run->places);
    free_places(run->again, run->places);
    moray_path_free(&run->path);
    moray_water_free(run->water);
}
