// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simulate.h"

enum { PER_PERIOD = 60, MOST_SAMPLES = 5000000 }; // samples of a period that peaks are taken from, at least

// ---- What to simulate ----------------------------------------------------------------------------------------------

static moray_sim_settings settings_of(const simulate *run)
{
    moray_sim_settings settings = moray_sim_settings_default();
    if (run->integrator == SIMULATE_PAPER)
        settings = moray_sim_settings_paper();
    if (run->integrator == SIMULATE_TR_BDF2)
        settings.method = MORAY_SIM_TR_BDF2, settings.rtol = settings.atol = 1e-9;
    if (!isnan(run->rtol))
        settings.rtol = run->rtol;
    if (!isnan(run->atol))
        settings.atol = run->atol;
    return settings;
}

static moray_status read_schedule(const simulate *run, simulate_results *results)
{
    const moray_snake_options *snake = &run->snake;
    if (run->schedule_file[0]) {
        MORAY_TRY(moray_gait_schedule_read(run->schedule_file, &run->gait, &snake->robot, snake->model,
                                           &results->schedule, &results->n_changes));
    } else {
        moray_gait gait;
        MORAY_TRY(moray_gait_input_make(&run->gait, &snake->robot, snake->model, &gait));
        if (!(results->schedule = malloc(sizeof *results->schedule)))
            return moray_error(MORAY_MEMORY, "no memory for a gait");
        results->schedule[results->n_changes++] = (moray_gait_change){0, gait};
    }
    results->t1 = isnan(run->duration) ? results->schedule[results->n_changes - 1].t + 60 : run->duration;
    while (results->n_changes > 1 && results->schedule[results->n_changes - 1].t >= results->t1)
        results->n_changes--;
    return moray_ok();
}

const moray_gait *simulate_last_gait(const simulate_results *results)
{
    return &results->schedule[results->n_changes - 1].gait;
}

static simulate_window window_of(const simulate_results *results, int wanted)
{
    const double start = results->schedule[results->n_changes - 1].t, omega = simulate_last_gait(results)->omega;
    const double fit = omega > 0 ? floor((results->t1 - start) * omega / (2 * M_PI) * (1 + 1e-12)) : 0;
    const int periods = fit < wanted ? (int)fit : wanted;
    const double length = periods > 0 ? periods * 2 * M_PI / omega : results->t1 - start;
    return (simulate_window){fmax(results->t1 - length, start), results->t1, periods};
}

// ---- When to look --------------------------------------------------------------------------------------------------

// An output step is divided so that every period is seen often enough.
static int divisions(const simulate *run, const simulate_results *results)
{
    double fastest = 0;
    for (int i = 0; i < results->n_changes; i++)
        fastest = fmax(fastest, results->schedule[i].gait.omega);
    return (int)fmax(ceil(run->output_step * fastest * PER_PERIOD / (2 * M_PI) - 1e-9), 1);
}

// What the observer is given, and what it finds.
typedef struct {
    const simulate_results *plan;
    moray_swim_track *track;
    const bool *kept; // of each sample: goes into the track
    int next, n_joints;
    double last_t, last_heading, heading_sum, start_energy; // of the window
    double first_current[2], last_off[2], off_sum[2];       // integrals of what the current is off the first
    moray_pose start;
    double peak_effort, peak_link_angle, peak_effort_of_run, peak_load;
    double *phi; // room for joints and their rates
} lookout;

static double load_of(const lookout *at, const moray_swim_sample *sample)
{
    const moray_motor *motor = &moray_swimmer_robot(at->plan->swimmer)->motor;
    double load = 0;
    if (motor->lines == 0 || moray_swimmer_model(at->plan->swimmer) != MORAY_FIRST_PRINCIPLES)
        return 0;
    moray_swimmer_joints(at->plan->swimmer, sample->x, at->phi, at->phi + at->n_joints);
    for (int i = 0; i < at->n_joints; i++)
        load = fmax(load, moray_motor_load(motor, sample->u[i], at->phi[at->n_joints + i]));
    return load;
}

static void look_in_window(lookout *at, const moray_swim_sample *sample, double effort)
{
    const moray_pose *pose = &sample->pose;
    if (sample->t == at->plan->window.from) {
        at->start = *pose;
        at->start_energy = sample->energy;
        memcpy(at->first_current, sample->current, sizeof at->first_current);
    } else {
        at->heading_sum += (sample->t - at->last_t) * (pose->heading + at->last_heading) / 2;
    }
    for (int c = 0; c < 2; c++) {
        const double off = sample->current[c] - at->first_current[c];
        at->off_sum[c] += (sample->t - at->last_t) * (off + at->last_off[c]) / 2; // the first is not off
        at->last_off[c] = off;
    }
    at->last_t = sample->t;
    at->last_heading = pose->heading;
    at->peak_effort = fmax(at->peak_effort, effort);
    at->peak_load = fmax(at->peak_load, load_of(at, sample));
    at->peak_link_angle = fmax(at->peak_link_angle, pose->link_angle);
}

static bool look(const moray_swim_sample *sample, void *self)
{
    lookout *at = self;
    double effort = 0;
    for (int i = 0; i < at->n_joints; i++)
        effort = fmax(effort, fabs(sample->u[i]));
    at->peak_effort_of_run = fmax(at->peak_effort_of_run, effort);
    if (sample->t >= at->plan->window.from)
        look_in_window(at, sample, effort);
    return !at->kept[at->next++] || moray_swim_track_add(sample, at->track);
}

// Times of the samples: the divided output steps, and the ends of the window. Returns how many.
static int choose_times(const simulate *run, const simulate_results *results, int n, int divided, double *times,
                        bool *kept)
{
    const double from = results->window.from, step = run->output_step / divided;
    int k = 0;
    for (int i = 0; i < n; i++) {
        const double t = i * step;
        if (from < t && times[k - 1] < from) {
            times[k] = from;
            kept[k++] = false;
        }
        times[k] = t;
        kept[k++] = i % divided == 0;
    }
    if (times[k - 1] < from) {
        times[k] = from;
        kept[k++] = false;
    }
    times[k] = results->t1;
    kept[k++] = true;
    return k;
}

// ---- What came of it -----------------------------------------------------------------------------------------------

static void conclude(const simulate *run, const lookout *seen, simulate_results *results)
{
    const double span = results->window.to - results->window.from;
    double *V = results->current;
    for (int c = 0; c < 2; c++)
        V[c] = seen->first_current[c] + seen->off_sum[c] / span;
    results->v_x = (results->end.p_x - seen->start.p_x) / span;
    results->v_y = (results->end.p_y - seen->start.p_y) / span;
    results->speed = hypot(results->v_x - V[0], results->v_y - V[1]);
    results->course_speed = results->v_x * cos(run->snake.course) + results->v_y * sin(run->snake.course);
    results->power = (results->energy - seen->start_energy) / span;
    results->cost_of_transport = results->speed > 0 ? results->power / results->speed : INFINITY;
    results->heading = seen->heading_sum / span;
    results->peak_effort = seen->peak_effort;
    results->peak_load = seen->peak_load;
    results->budget = moray_budget_of(&run->snake.robot, results->power, results->speed, results->course_speed);
    results->peak_link_angle = seen->peak_link_angle;
    results->peak_effort_of_run = seen->peak_effort_of_run;
}

static moray_status swim(const simulate *run, simulate_results *results, double *times, bool *kept, int n, int divided)
{
    lookout seen = {.plan = results,
                    .track = &results->track,
                    .kept = kept,
                    .n_joints = run->snake.robot.links - 1,
                    .phi = times + n + 2 + moray_swimmer_states(results->swimmer)};
    const moray_swim_plan plan = {.t1 = results->t1,
                                  .schedule = results->schedule,
                                  .n_changes = results->n_changes,
                                  .times = times,
                                  .water = results->water,
                                  .n_times = choose_times(run, results, n, divided, times, kept),
                                  .observe = look,
                                  .observer = &seen,
                                  .statistics = &results->statistics};
    double *x = times + n + 2;
    moray_swimmer_set_current(results->swimmer, run->snake.current[0], run->snake.current[1]);
    moray_swimmer_rest(results->swimmer, run->heading, run->position[0], run->position[1], x);
    MORAY_TRY(moray_swim_run(results->swimmer, &results->sim, &plan, x, &results->energy));
    results->end = moray_swimmer_pose(results->swimmer, x);
    conclude(run, &seen, results);
    return moray_ok();
}

static moray_status allot(const simulate *run, simulate_results *results)
{
    const int divided = divisions(run, results);
    const double steps = ceil(results->t1 / run->output_step * (1 - 1e-12));
    if (steps * divided > MOST_SAMPLES)
        return moray_error(MORAY_INPUT,
                           "output_step_s = %g: %g s in steps of it and of a %dth of the shortest period need %.3g "
                           "samples; there may be %d",
                           run->output_step, results->t1, PER_PERIOD, steps * divided, MOST_SAMPLES);
    const int n = (int)ceil(results->t1 / run->output_step * divided * (1 - 1e-12));
    MORAY_TRY(moray_swim_track_new(&results->track, results->swimmer, (n + divided - 1) / divided + 1));
    double *times = malloc((size_t)(n + 2 + 2 * moray_swimmer_states(results->swimmer)) * sizeof *times);
    bool *kept = malloc((size_t)(n + 2) * sizeof *kept);
    const moray_status status = times && kept ? swim(run, results, times, kept, n, divided)
                                              : moray_error(MORAY_MEMORY, "no memory for %d samples", n);
    free(kept);
    free(times);
    return status;
}

// Whether the control-oriented model turns: by an offset of a gait, or in a current across the start heading.
static bool turns(const simulate *run, const simulate_results *results)
{
    const double *V = run->snake.current, nothing = 1e-12;
    bool offset = fabs(V[1] * cos(run->heading) - V[0] * sin(run->heading)) > nothing;
    for (int k = 0; k < results->n_changes; k++)
        offset = offset || results->schedule[k].gait.offset != 0;
    return (offset || results->water) && run->snake.model == MORAY_CONTROL_ORIENTED;
}

moray_status simulate_run(const simulate *run, simulate_results *results)
{
    results->run = run;
    results->sim = settings_of(run);
    MORAY_TRY(moray_sim_settings_check(&results->sim));
    MORAY_TRY(read_schedule(run, results));
    if (run->water_file[0]) {
        if (run->snake.current[0] != 0 || run->snake.current[1] != 0)
            return moray_error(MORAY_INPUT, "--water and --current: give one of them");
        MORAY_TRY(moray_water_read(&results->water, run->water_file));
    }
    if (turns(run, results))
        MORAY_TRY(moray_snake_turning(&run->snake));
    results->window = window_of(results, run->periods);
    MORAY_TRY(moray_swimmer_new(&results->swimmer, &run->snake.robot, run->snake.model));
    return allot(run, results);
}

void simulate_release(simulate_results *results)
{
    moray_water_free(results->water);
    moray_swim_track_free(&results->track);
    moray_swimmer_free(results->swimmer);
    free(results->schedule);
    *results = (simulate_results){0};
}
