// SPDX-License-Identifier: MIT
//
// The ladder of a job: every gait on models that it was not found on, and a gait that is optimised for several.
#include <stdlib.h>
#include <string.h>

#include "job.h"
#include "moray/number.h"

static moray_status refuse_name(const gait_job *job, const char *name)
{
    moray_rung rung[MORAY_RUNGS];
    char names[200] = "";
    moray_ladder(&job->snake.robot, rung);
    for (int k = 0; k < MORAY_RUNGS; k++)
        moray_text_add(names, sizeof names, "%s%s", k ? ", " : "", rung[k].name);
    return moray_error(MORAY_INPUT,
                       "over = %.60s: must be none or names of rungs with commas between, @VX,VY [m/s] behind those in "
                       "another current, or a file NAME.csv of scenarios: %s",
                       name, names);
}

// "NAME" in the current of the job, or "NAME@VX", and then "VY" is what stands behind the next comma.
static moray_status read_scenario(const gait_job *job, char *text, char **rest, scenario *at)
{
    char *x = strchr(text, '@'), *y = NULL;
    if (x) {
        *x++ = 0;
        y = strtok_r(NULL, ",", rest);
    }
    *at = (scenario){.rung = moray_rung_named(text), .current = {job->snake.current[0], job->snake.current[1]}};
    snprintf(at->name, sizeof at->name, x ? "%s@%s,%s" : "%s", text, x, y ? y : "");
    if (at->rung < 0 || (x && !(moray_number_read(x, &at->current[0]) && moray_number_read(y, &at->current[1]))))
        return refuse_name(job, at->name);
    return moray_ok();
}

// Those of a file, as identify leaves it: the job's robot with what the file says changed.
static moray_status read_file(const gait_job *job, const char *path, scenarios *over)
{
    const moray_unknowns base = {.robot = job->snake.robot, .current = {job->snake.current[0], job->snake.current[1]}};
    moray_unknowns world[MORAY_SCENARIOS];
    moray_world_name name[MORAY_SCENARIOS];
    int n;
    MORAY_TRY(moray_worlds_read(path, &base, MORAY_SCENARIOS - over->n, world, name, &n));
    for (int k = 0; k < n; k++) {
        scenario *at = &over->at[over->n++];
        *at = (scenario){
            .rung = -1, .read = true, .robot = world[k].robot, .current = {world[k].current[0], world[k].current[1]}};
        snprintf(at->name, sizeof at->name, "%.39s", name[k].text);
    }
    return moray_ok();
}

static bool is_file(const char *name)
{
    const size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".csv") == 0;
}

static bool same_scenario(const scenario *one, const scenario *other)
{
    return !one->read && !other->read && one->rung == other->rung && one->current[0] == other->current[0] &&
           one->current[1] == other->current[1];
}

moray_status gait_job_scenarios(const gait_job *job, scenarios *over)
{
    char text[MORAY_PATH_SIZE], *rest = NULL;
    *over = (scenarios){0};
    if (strcmp(job->over, "none") == 0)
        return moray_ok();
    strcpy(text, job->over);
    for (char *name = strtok_r(text, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
        if (over->n == MORAY_SCENARIOS)
            return moray_error(MORAY_INPUT, "over = %.200s: more than %d names", job->over, MORAY_SCENARIOS);
        if (is_file(name)) {
            MORAY_TRY(read_file(job, name, over));
            continue;
        }
        scenario *at = &over->at[over->n];
        MORAY_TRY(read_scenario(job, name, &rest, at));
        for (int k = 0; k < over->n; k++)
            if (same_scenario(at, &over->at[k]))
                return moray_error(MORAY_INPUT, "over = %.200s: %s stands there twice", job->over, at->name);
        over->n++;
    }
    return moray_ok();
}

unsigned gait_job_found_on(const gait_job *job, moray_model model)
{
    const unsigned own = moray_rung_of(&job->snake.robot);
    return model == MORAY_FIRST_PRINCIPLES && own ? own | MORAY_RUNG_CHANGES : 0;
}

static bool climbs(const stage *at)
{
    return at->trial.gait[MORAY_FIRST_PRINCIPLES].omega > 0 && !at->left_out;
}

moray_status gait_job_climb(const gait_job *job, stage *const *at, int n)
{
    enum { most = 128 };
    moray_gait gait[most];
    int gaits = 0;
    for (int k = 0; k < n && gaits < most; k++)
        if (climbs(at[k]))
            gait[gaits++] = at[k]->trial.gait[MORAY_FIRST_PRINCIPLES];
    const moray_ladder_spec spec = {.robot = job->snake.robot,
                                    .current = {job->snake.current[0], job->snake.current[1]},
                                    .course = job->snake.course,
                                    .baseline = job->paper.gait[MORAY_FIRST_PRINCIPLES],
                                    .gait = gait,
                                    .gaits = gaits,
                                    .settings = job->rig.settings,
                                    .jobs = job->jobs};
    moray_ticker_show(&job->ticker, "%s: %d gaits on the ladder of models", job->name, gaits);
    moray_ladder_row *row = calloc((size_t)gaits * MORAY_RUNGS + 1, sizeof *row), *next = row;
    if (!row)
        return moray_error(MORAY_MEMORY, "no memory for %d ladders", gaits);
    const moray_status status = moray_ladder_climb(&spec, row);
    for (int k = 0; k < n && next < row + gaits * MORAY_RUNGS; k++) {
        if (!climbs(at[k]))
            continue;
        memcpy(at[k]->ladder, next, sizeof at[k]->ladder);
        next += MORAY_RUNGS;
    }
    free(row);
    return status;
}

// ---- One gait for several models -----------------------------------------------------------------------------------

// The scenarios, with an orbit on each and what the baseline makes there.
typedef struct {
    scenarios *over;
    moray_rung rung[MORAY_RUNGS]; // the whole ladder
    moray_orbit *orbit[MORAY_SCENARIOS];
    moray_gait_scenario scenario[MORAY_SCENARIOS];
} scenario_set;

static void set_free(scenario_set *set)
{
    for (int k = 0; k < set->over->n; k++)
        moray_orbit_free(set->orbit[k]);
}

static moray_status make_scenario(gait_job *job, scenario_set *set, int k)
{
    const scenario *it = &set->over->at[k];
    const moray_robot *robot = it->read ? &it->robot : &set->rung[it->rung].robot;
    moray_orbit_spec spec = moray_orbit_spec_default(robot, MORAY_FIRST_PRINCIPLES);
    moray_orbit_result baseline;
    stage at = {.model = MORAY_FIRST_PRINCIPLES};
    memcpy(spec.current, it->current, sizeof spec.current);
    spec.course = job->snake.course;
    spec.scheme = job->common.scheme;
    spec.intervals = job->common.intervals;
    MORAY_TRY(moray_orbit_new(&set->orbit[k], &spec));
    const moray_status status = moray_orbit_solve(set->orbit[k], &job->paper.gait[MORAY_FIRST_PRINCIPLES], &baseline);
    if (moray_failed(status))
        return moray_error(status.code, "the baseline on %s: %s", it->name, status.text);
    at.power = baseline.steady.power;
    memcpy(at.taper, job->taper, sizeof at.taper);
    set->scenario[k] = (moray_gait_scenario){it->name, gait_job_spec(job, &at, MORAY_GAIT_FASTEST, it->current),
                                             baseline.steady.speed};
    set->scenario[k].problem.robot = *robot;
    return moray_ok();
}

// From the orbits of a gait, on each model at the baseline's power.
static moray_status solve_from(gait_job *job, stage *at, void *self, const moray_gait *from, moray_solution **solution)
{
    scenario_set *set = self;
    const moray_settings settings = gait_job_settings(job);
    moray_gait gait[MORAY_SCENARIOS];
    moray_swim_track orbit[MORAY_SCENARIOS] = {0};
    moray_status status = moray_ok();
    for (int k = 0; k < set->over->n && !moray_failed(status); k++) {
        moray_orbit_result found;
        gait[k] = *from;
        status = moray_orbit_match_power(set->orbit[k], &gait[k], set->scenario[k].problem.limits.power, &found);
        if (!moray_failed(status))
            status = moray_orbit_track(set->orbit[k], 101, &orbit[k]);
        if (!moray_failed(status))
            gait[k] = found.gait;
    }
    if (!moray_failed(status))
        status = moray_gait_over_solve(at->over, &settings, gait, orbit, solution);
    for (int k = 0; k < set->over->n; k++)
        moray_swim_track_free(&orbit[k]);
    return status;
}

static moray_status solve_all(gait_job *job, scenario_set *set, const gait_starts *known, stage *at)
{
    MORAY_TRY(gait_job_begin_starts(at, known->n + job->random_starts));
    const moray_status status = gait_job_try_starts(job, at, known, job->random_starts, solve_from, set);
    if (moray_interrupted())
        return moray_error(MORAY_INTERRUPTED, "interrupted while optimising; nothing is written");
    MORAY_TRY(status);
    if (moray_solution_info(at->solution)->outcome != MORAY_NLP_SOLVED)
        return moray_solution_failure(at->solution);
    return moray_ok();
}

static bool is_own(const gait_job *job, const scenario *at)
{
    const double *V = job->snake.current;
    const moray_robot *own = &job->snake.robot, *its = &at->robot;
    const bool same = at->read
                          ? its->c_t == own->c_t && its->c_n == own->c_n && its->mu_n == own->mu_n && its->m == own->m
                          : moray_rung_of(own) >> at->rung & 1;
    return same && at->current[0] == V[0] && at->current[1] == V[1];
}

// omega is that of the user's own model and current, where it is one of them, and else that which uses the power
// allowed there.
static void choose_omega(const gait_job *job, const scenario_set *set, stage *at)
{
    at->phase = 0;
    for (int k = 0; k < set->over->n; k++)
        if (is_own(job, &set->over->at[k]))
            at->phase = k;
    at->prediction = moray_gait_over_prediction(at->over, at->solution, at->phase);
    if ((is_own(job, &set->over->at[at->phase]) && isnan(job->power)) || !isfinite(at->power))
        return;
    const moray_swim_setup setup = moray_test_rig_setup(&job->rig, MORAY_FIRST_PRINCIPLES);
    moray_gait gait = at->prediction.gait;
    moray_steady steady;
    if (!moray_failed(moray_swim_match_power(&setup, &gait, job->snake.course, at->power, &steady)))
        at->prediction.gait.omega = fmin(fmax(gait.omega, job->omega[0]), job->omega[1]);
}

// A gait that is not certified is left out for the first-principles optimum. Where the gains on the models oppose one
// another the best is the baseline itself, with more active constraints than there are directions.
static moray_status check_gain(const gait_job *job, const stage *at)
{
    const double nothing = 5e-4, gain = moray_gait_over_gain(at->solution);
    if (at->certificate.pass)
        return moray_ok();
    if (gain >= nothing)
        return moray_error(MORAY_NOT_SOLVED, "the gait that gains %+.2f %% on all of %.100s is not certified: %.120s",
                           100 * gain, job->over, at->certificate.why);
    return moray_error(
        MORAY_NOT_SOLVED,
        "no gait was found that gains on all of %.150s, and what was found, %+.2f %%, is not certified: KKT %.1e",
        job->over, 100 * gain, at->certificate.kkt);
}

static moray_status optimise(gait_job *job, scenario_set *set, const gait_starts *known)
{
    stage *at = &job->ladder;
    moray_ladder(&job->snake.robot, set->rung);
    for (int k = 0; k < set->over->n; k++)
        MORAY_TRY(make_scenario(job, set, k));
    MORAY_TRY(moray_gait_over_new(&at->over, set->scenario, set->over->n, (moray_over_goal)job->over_goal));
    MORAY_TRY(solve_all(job, set, known, at));
    for (int k = 0; k < set->over->n; k++)
        set->over->at[k].gain =
            moray_gait_over_prediction(at->over, at->solution, k).speed / set->scenario[k].speed - 1;
    choose_omega(job, set, at);
    MORAY_TRY(gait_job_prove(job, &at, 1));
    return check_gain(job, at);
}

moray_status gait_job_over(gait_job *job, const gait_starts *known)
{
    stage *at = &job->ladder;
    scenario_set set = {.over = &job->scenarios};
    MORAY_TRY(gait_job_scenarios(job, &job->scenarios));
    *at = (stage){.model = MORAY_FIRST_PRINCIPLES,
                  .power = last_stage(job)->power,
                  .speed = last_stage(job)->speed,
                  .taper = {job->taper[0], job->taper[1]}};
    for (int k = 0; k < set.over->n; k++)
        at->found_on |= set.over->at[k].read ? moray_rung_of(&set.over->at[k].robot) : 1u << set.over->at[k].rung;
    if (at->found_on & moray_rung_of(&job->snake.robot))
        at->found_on |= MORAY_RUNG_CHANGES;
    if (moray_failed(job->no_paper[MORAY_FIRST_PRINCIPLES]))
        return moray_error(MORAY_NOT_SOLVED, "there is no baseline to gain over: %s",
                           job->no_paper[MORAY_FIRST_PRINCIPLES].text);
    const moray_status status = optimise(job, &set, known);
    set_free(&set);
    return status;
}
