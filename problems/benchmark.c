// SPDX-License-Identifier: MIT
//
// What the solver costs: where the time of a solve goes, how it grows with the mesh and the robot, and how near it is
// to a floor of arithmetic, memory and calls. Times are the processor's, medians of several measurements in this run.
#include "benchmark/benchmark.h"

static const char *const parts[] = {"all",       "s1",    "problems", "classics",   "states",
                                    "intervals", "links", "horizon",  "simulation", NULL};
static const char *const unused[] = {"scheme", "intervals", "tol", "ipopt.KEY", NULL};

static const moray_option options[] = {
    MORAY_ROW(
        CHOICE, benchmark, part, "benchmark", "part", .flag = "part", .argument = "NAME", .choices = parts,
        .help =
            "what to measure: a programme that other tools can be given, optimal gaits, textbook problems, growth over "
            "states, over intervals, over links and over the horizon of heading tracking, simulation"),
    MORAY_ROW(INT, benchmark, repeats, "benchmark", "repeats", .min = 1, .max = 1000,
              .help = "measurements of each, of which the median counts"),
    MORAY_ROW(INT, benchmark, most_states, "benchmark", "most_states", .min = 10, .max = 500,
              .help = "where growth over states ends"),
    MORAY_ROW(INT, benchmark, most_intervals, "benchmark", "most_intervals", .min = 10, .max = 5000,
              .help = "where growth over intervals ends; textbook problems that begin with more are left out"),
    MORAY_ROW(INT, benchmark, most_links, "benchmark", "most_links", .min = 5, .max = 200,
              .help = "where growth over links ends"),
    MORAY_ROW(INT, benchmark, most_seconds, "benchmark", "most_seconds", .min = 60, .max = 3600,
              .help = "where growth over the horizon ends"),
};

static const moray_program program = {
    .name = "benchmark",
    .summary = "Measures what solving and simulating cost, where the time goes and how it grows, and beside it what "
               "solving costs "
               "with MUMPS.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .without = unused,
};

#define ON_GAIT(plant) .model = plant, .joints = MORAY_JOINTS_ON_GAIT, .scheme = "lobatto5", .intervals = 12
#define CLOSED_LOOP                                                                                                    \
    .model = MORAY_CONTROL_ORIENTED, .joints = MORAY_JOINTS_CLOSED_LOOP, .scheme = "lobatto5", .intervals = 12,        \
    .barrier = 1e-4 // the paper's gait is far from the optimum

static bool wanted(const benchmark *run, enum part part)
{
    return run->part == ALL || run->part == (int)part;
}

static moray_status add_case(benchmark *run, const char *name, const subject of)
{
    named_cost *to = &run->cases[run->n_cases];
    moray_ticker_show(&run->ticker, "benchmark: %s", name);
    to->name = name;
    MORAY_TRY(measure(&of, run->common.linear_solver, run->repeats, &to->cost));
    MORAY_TRY(measure(&of, MORAY_LINEAR_MUMPS, run->repeats, &to->mumps));
    run->n_cases++;
    return moray_ok();
}

static moray_status measure_s1(benchmark *run)
{
    s1_case s1 = {0};
    return add_case(run, "S1", s1_subject(&s1));
}

static moray_status measure_problems(benchmark *run)
{
    static const gait_case cases[] = {
        {.name = "max_speed, control-oriented", .links = 10, ON_GAIT(MORAY_CONTROL_ORIENTED)},
        {.name = "max_speed, control-oriented, closed loop", .links = 10, CLOSED_LOOP},
        {.name = "max_speed, first-principles", .links = 10, ON_GAIT(MORAY_FIRST_PRINCIPLES)},
        {.name = "min_energy, control-oriented",
         .links = 10,
         ON_GAIT(MORAY_CONTROL_ORIENTED),
         .goal = MORAY_GAIT_THRIFTIEST},
        {.name = "min_energy, first-principles",
         .links = 10,
         ON_GAIT(MORAY_FIRST_PRINCIPLES),
         .goal = MORAY_GAIT_THRIFTIEST},
    };
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        gait_case one = cases[k];
        MORAY_TRY(add_case(run, one.name, gait_case_subject(&one)));
    }
    return moray_ok();
}

static moray_status measure_classics(benchmark *run)
{
    for (int k = 0; classics[k]; k++) {
        classic_case one = {.classic = classics[k]};
        if (classic_settings(one.classic).intervals <= run->most_intervals)
            MORAY_TRY(add_case(run, one.classic->name, classic_subject(&one)));
    }
    return moray_ok();
}

static growth *add_growth(benchmark *run, const char *name, const char *over)
{
    growth *g = &run->growths[run->n_growths++];
    *g = (growth){.name = name, .over = over};
    return g;
}

static moray_status add_point(benchmark *run, growth *g, int size, const subject of)
{
    moray_ticker_show(&run->ticker, "benchmark: %s, %d %s", g->name, size, g->over);
    MORAY_TRY(measure(&of, run->common.linear_solver, run->repeats, &g->cost[g->n]));
    g->size[g->n++] = size;
    return moray_ok();
}

// Sizes up to `most`, of the links or the intervals.
static moray_status measure_growth(benchmark *run, const gait_case *of, const char *over, const int *sizes, int most)
{
    growth *g = add_growth(run, of->name, over);
    for (; *sizes && *sizes <= most; sizes++) {
        gait_case one = *of;
        *(over[0] == 'l' ? &one.links : &one.intervals) = *sizes;
        MORAY_TRY(add_point(run, g, *sizes, gait_case_subject(&one)));
    }
    return moray_ok();
}

static const int interval_sizes[] = {10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 0};
static const int link_sizes[] = {5, 10, 20, 50, 100, 200, 0};
// In closed loop, 2N+4 states of which every one is coupled to all others.
static const int most_links_in_loop = 20, most_intervals_in_loop = 200;

static int at_most(int value, int most)
{
    return value < most ? value : most;
}

static moray_status measure_states(benchmark *run)
{
    static const int sizes[] = {10, 20, 50, 100, 200, 500, 0};
    growth *g = add_growth(run, "chain of masses", "states");
    for (const int *states = sizes; *states && *states <= run->most_states; states++) {
        chain_case one = {.states = *states};
        MORAY_TRY(add_point(run, g, *states, chain_subject(&one)));
    }
    return moray_ok();
}

static moray_status measure_intervals(benchmark *run)
{
    const gait_case on_gait = {.name = "max_speed, control-oriented",
                               .links = 10,
                               .model = MORAY_CONTROL_ORIENTED,
                               .joints = MORAY_JOINTS_ON_GAIT,
                               .scheme = "hermite-simpson"};
    gait_case closed_loop = on_gait;
    closed_loop.name = "max_speed, control-oriented, closed loop";
    closed_loop.joints = MORAY_JOINTS_CLOSED_LOOP;
    MORAY_TRY(measure_growth(run, &on_gait, "intervals", interval_sizes, run->most_intervals));
    return measure_growth(run, &closed_loop, "intervals", interval_sizes,
                          at_most(run->most_intervals, most_intervals_in_loop));
}

static moray_status measure_links(benchmark *run)
{
    const gait_case on_gait = {.name = "max_speed, control-oriented", ON_GAIT(MORAY_CONTROL_ORIENTED)};
    const gait_case closed_loop = {.name = "max_speed, control-oriented, closed loop", CLOSED_LOOP};
    MORAY_TRY(measure_growth(run, &on_gait, "links", link_sizes, run->most_links));
    return measure_growth(run, &closed_loop, "links", link_sizes, at_most(run->most_links, most_links_in_loop));
}

static moray_status measure_horizon_of(benchmark *run, const char *name, moray_model model)
{
    static const int horizons[] = {60, 120, 240, 600, 1200, 3600, 0};
    growth *g = add_growth(run, name, "seconds");
    for (const int *seconds = horizons; *seconds && *seconds <= run->most_seconds; seconds++) {
        horizon_case one = {.model = model, .seconds = *seconds};
        MORAY_TRY(add_point(run, g, *seconds, horizon_subject(&one)));
    }
    return moray_ok();
}

static moray_status measure_horizon(benchmark *run)
{
    MORAY_TRY(measure_horizon_of(run, "heading_tracking, control-oriented", MORAY_CONTROL_ORIENTED));
    return measure_horizon_of(run, "heading_tracking, first-principles", MORAY_FIRST_PRINCIPLES);
}

static moray_status measure_simulation(benchmark *run)
{
    simulated *s = &run->simulation;
    for (const int *links = link_sizes; *links && *links <= run->most_links; links++) {
        moray_ticker_show(&run->ticker, "benchmark: simulation, %d links", *links);
        for (int model = 0; model < 2; model++)
            MORAY_TRY(simulation_rate((moray_model)model, *links, run->repeats, &s->rate[model][s->n]));
        s->links[s->n++] = *links;
    }
    return moray_ok();
}

static moray_status work(benchmark *run)
{
    static const struct {
        enum part part;
        moray_status (*measure)(benchmark *);
    } all[] = {{S1, measure_s1},           {PROBLEMS, measure_problems},    {CLASSICS, measure_classics},
               {STATES, measure_states},   {INTERVALS, measure_intervals},  {LINKS, measure_links},
               {HORIZON, measure_horizon}, {SIMULATION, measure_simulation}};
    moray_status status = machine_measure(&run->machine);
    run->ticker = moray_ticker_start(stderr, run->common.quiet);
    for (unsigned k = 0; k < sizeof all / sizeof *all && !moray_failed(status); k++)
        if (wanted(run, all[k].part))
            status = all[k].measure(run);
    moray_ticker_end(&run->ticker);
    return moray_failed(status) ? status : benchmark_report(run);
}

int main(int argc, char **argv)
{
    static benchmark run;
    int exit_code;
    run = (benchmark){.common = moray_common_default(),
                      .repeats = 5,
                      .most_states = 500,
                      .most_intervals = 1000,
                      .most_links = 100,
                      .most_seconds = 600};
    if (!moray_app_start(&program, argc, argv, &run, &exit_code))
        return exit_code;
    return moray_app_end(&program, &run, work(&run));
}
