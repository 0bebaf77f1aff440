// SPDX-License-Identifier: MIT
//
// Textbook problems of problems/classics for PSOPT: the same equations, limits and starts, its own derivatives, scaling
// and Hermite-Simpson scheme, and Ipopt as it calls it. 31 nodes and the middles between them are as many collocation
// points as 20 intervals of gauss3 or 30 of hermite-simpson have. How it is built: run.sh.
//
//   ./psopt_classics rayleigh      without a name: lists them
//
// Prints objective and the processor seconds from the first line of the problem to the solution.
#include <psopt.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <iostream>

static const int nodes = 31, most_states = 4;
static const double none = 1e3; // where a problem has no limit; PSOPT scales by its limits

struct limits {
    double low, up;
};

struct textbook {
    const char *name;
    int states, controls, paths, events;
    void (*rates)(const adouble *x, const adouble *u, adouble *f, adouble *path);
    adouble (*integrand)(const adouble *x, const adouble *u);       // or NULL
    adouble (*end)(const adouble *xf, const adouble &tf);           // or NULL
    limits x[most_states], u[2], path[2], tf;
    double x0[most_states];                                         // fixed
    struct {
        int state;
        double value;
    } xf[most_states];                                              // events - states of them
    double from[most_states], to[most_states], u_guess[2], tf_guess; // start: straight from, to
};

// ---- Rayleigh, mixed constraint ---------------------------------------------------------------------------------

static void rayleigh_rates(const adouble *x, const adouble *u, adouble *f, adouble *path)
{
    f[0] = x[1];
    f[1] = -x[0] + x[1] * (1.4 - 0.14 * x[1] * x[1]) + 4 * u[0];
    path[0] = u[0] + x[0] / 6;
}

static adouble rayleigh_integrand(const adouble *x, const adouble *u)
{
    return u[0] * u[0] + x[0] * x[0];
}

// ---- Two-link arm -----------------------------------------------------------------------------------------------

static void arm_rates(const adouble *x, const adouble *u, adouble *f, adouble *)
{
    const adouble s = sin(x[2]), c = cos(x[2]), d = 31. / 36 + 9. / 4 * s * s;
    f[0] = (s * (9. / 4 * c * x[0] * x[0] + 2 * x[1] * x[1]) + 4. / 3 * (u[0] - u[1]) - 3. / 2 * c * u[1]) / d;
    f[1] = -(s * (7. / 2 * x[0] * x[0] + 9. / 4 * c * x[1] * x[1]) - 7. / 3 * u[1] + 3. / 2 * c * (u[0] - u[1])) / d;
    f[2] = x[1] - x[0];
    f[3] = x[0];
}

static adouble final_time(const adouble *, const adouble &tf)
{
    return tf;
}

// ---- Brachistochrone to (2, 2), g = 9.8 ------------------------------------------------------------------------------

static void slide_rates(const adouble *x, const adouble *u, adouble *f, adouble *)
{
    f[0] = x[2] * sin(u[0]);
    f[1] = x[2] * cos(u[0]);
    f[2] = 9.8 * cos(u[0]);
}

// ---- Bryson-Denham, Breakwell ----------------------------------------------------------------------------------------

static void push_rates(const adouble *x, const adouble *u, adouble *f, adouble *)
{
    f[0] = x[1];
    f[1] = u[0];
}

static adouble push_integrand(const adouble *, const adouble *u)
{
    return u[0] * u[0] / 2;
}

// ---- Catalyst mixing --------------------------------------------------------------------------------------------------

static void react_rates(const adouble *x, const adouble *u, adouble *f, adouble *)
{
    f[0] = u[0] * (10 * x[1] - x[0]);
    f[1] = u[0] * (x[0] - 10 * x[1]) - (1 - u[0]) * x[1];
}

static adouble react_end(const adouble *xf, const adouble &)
{
    return xf[0] + xf[1] - 1;
}

// ---- Hypersensitive ----------------------------------------------------------------------------------------------------

static void drift_rates(const adouble *x, const adouble *u, adouble *f, adouble *)
{
    f[0] = -x[0] * x[0] * x[0] + u[0];
}

static adouble drift_integrand(const adouble *x, const adouble *u)
{
    return (x[0] * x[0] + u[0] * u[0]) / 2;
}

// ---- Moon lander ---------------------------------------------------------------------------------------------------------

static void descend_rates(const adouble *x, const adouble *u, adouble *f, adouble *)
{
    f[0] = x[1];
    f[1] = -1 + u[0] / x[2];
    f[2] = -u[0] / 2.349;
}

static adouble descend_integrand(const adouble *, const adouble *u)
{
    return u[0];
}

static const textbook all[] = {
    {"rayleigh", 2, 1, 1, 2, rayleigh_rates, rayleigh_integrand, NULL,
     {{-10, 10}, {-10, 10}}, {{-10, 10}}, {{-100, 0}}, {4.5, 4.5}, {-5, -5}, {},
     {-5, -5}, {-5, -5}, {0}, 4.5},
    {"two-link-arm", 4, 2, 0, 8, arm_rates, NULL, final_time,
     {{-2, 2}, {-2, 2}, {-2, 2}, {-2, 2}}, {{-1, 1}, {-1, 1}}, {}, {1, 10}, {0, 0, 0.5, 0},
     {{0, 0}, {1, 0}, {2, 0.5}, {3, 0.522}}, {0, 0, 0.5, 0}, {0, 0, 0.5, 0.522}, {0, 0}, 5.5},
    {"brachistochrone-near", 3, 1, 0, 5, slide_rates, NULL, final_time,
     {{0, 20}, {0, 20}, {0, 20}}, {{0, M_PI}}, {}, {0, 10}, {0, 0, 0}, {{0, 2}, {1, 2}},
     {0, 0, 0}, {2, 2, 6.2609903}, {M_PI / 4}, 0.9035079},
    {"bryson-denham", 2, 1, 0, 4, push_rates, push_integrand, NULL,
     {{-10, 1. / 9}, {-10, 10}}, {{-none, none}}, {}, {1, 1}, {0, 1}, {{0, 0}, {1, -1}},
     {0, 1}, {0, -1}, {0}, 1},
    {"breakwell", 2, 1, 0, 4, push_rates, push_integrand, NULL,
     {{-10, 0.1}, {-10, 10}}, {{-none, none}}, {}, {1, 1}, {0, 1}, {{0, 0}, {1, -1}},
     {0, 1}, {0, -1}, {0}, 1},
    {"catalyst-mixing", 2, 1, 0, 2, react_rates, NULL, react_end,
     {{0, 1}, {0, 1}}, {{0, 1}}, {}, {1, 1}, {1, 0}, {}, {1, 0}, {1, 0}, {0}, 1},
    {"hypersensitive", 1, 1, 0, 2, drift_rates, drift_integrand, NULL,
     {{-10, 10}}, {{-10, 10}}, {}, {50, 50}, {1.5}, {{0, 1}}, {1.5}, {1}, {0}, 50},
    {"moon-lander", 3, 1, 0, 5, descend_rates, descend_integrand, NULL,
     {{-20, 20}, {-20, 20}, {0.01, 1}}, {{0, 1.227}}, {}, {0, none}, {1, -0.783, 1}, {{0, 0}, {1, 0}},
     {1, -0.783, 1}, {0, 0, 0.01}, {1.227 / 2}, 1.5},
};

static const textbook *chosen;

static adouble endpoint_cost(adouble *, adouble *xf, adouble *, adouble &, adouble &tf, adouble *, int, Workspace *)
{
    return chosen->end ? chosen->end(xf, tf) : adouble(0);
}

static adouble integrand_cost(adouble *x, adouble *u, adouble *, adouble &, adouble *, int, Workspace *)
{
    return chosen->integrand ? chosen->integrand(x, u) : adouble(0);
}

static void dae(adouble *f, adouble *path, adouble *x, adouble *u, adouble *, adouble &, adouble *, int, Workspace *)
{
    chosen->rates(x, u, f, path);
}

static void events(adouble *e, adouble *x0, adouble *xf, adouble *, adouble &, adouble &, adouble *, int, Workspace *)
{
    for (int k = 0; k < chosen->states; k++)
        *e++ = x0[k];
    for (int k = 0; k < chosen->events - chosen->states; k++)
        *e++ = xf[chosen->xf[k].state];
}

static void linkages(adouble *, adouble *, Workspace *)
{
}

static void set_limits(Phases &phase)
{
    const textbook &p = *chosen;
    for (int k = 0; k < p.states; k++) {
        phase.bounds.lower.states(k) = p.x[k].low;
        phase.bounds.upper.states(k) = p.x[k].up;
        phase.bounds.lower.events(k) = phase.bounds.upper.events(k) = p.x0[k];
    }
    for (int k = 0; k < p.events - p.states; k++)
        phase.bounds.lower.events(p.states + k) = phase.bounds.upper.events(p.states + k) = p.xf[k].value;
    for (int k = 0; k < p.controls; k++) {
        phase.bounds.lower.controls(k) = p.u[k].low;
        phase.bounds.upper.controls(k) = p.u[k].up;
    }
    for (int k = 0; k < p.paths; k++) {
        phase.bounds.lower.path(k) = p.path[k].low;
        phase.bounds.upper.path(k) = p.path[k].up;
    }
    phase.bounds.lower.StartTime = phase.bounds.upper.StartTime = 0;
    phase.bounds.lower.EndTime = p.tf.low;
    phase.bounds.upper.EndTime = p.tf.up;
}

static void set_guess(Phases &phase)
{
    MatrixXd x = zeros(chosen->states, nodes), u = zeros(chosen->controls, nodes);
    for (int i = 0; i < nodes; i++) {
        for (int k = 0; k < chosen->states; k++)
            x(k, i) = chosen->from[k] + (chosen->to[k] - chosen->from[k]) * i / (nodes - 1);
        for (int k = 0; k < chosen->controls; k++)
            u(k, i) = chosen->u_guess[k];
    }
    phase.guess.states = x;
    phase.guess.controls = u;
    phase.guess.time = linspace(0, chosen->tf_guess, nodes);
}

static int solve()
{
    const std::clock_t begin = std::clock();
    Alg algorithm;
    Sol solution;
    Prob problem;
    problem.name = chosen->name;
    problem.outfilename = "psopt.txt";
    problem.nphases = 1;
    problem.nlinkages = 0;
    psopt_level1_setup(problem);
    problem.phases(1).nstates = chosen->states;
    problem.phases(1).ncontrols = chosen->controls;
    problem.phases(1).nevents = chosen->events;
    problem.phases(1).npath = chosen->paths;
    problem.phases(1).nodes << nodes;
    psopt_level2_setup(problem, algorithm);
    set_limits(problem.phases(1));
    set_guess(problem.phases(1));
    problem.integrand_cost = &integrand_cost;
    problem.endpoint_cost = &endpoint_cost;
    problem.dae = &dae;
    problem.events = &events;
    problem.linkages = &linkages;
    algorithm.nlp_method = "IPOPT";
    algorithm.scaling = "automatic";
    algorithm.derivatives = "automatic";
    algorithm.collocation_method = "Hermite-Simpson";
    algorithm.nlp_iter_max = 1000;
    algorithm.nlp_tolerance = 1e-8;
    algorithm.print_level = 0;
    psopt(solution, problem, algorithm);
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    std::cout.precision(10);
    std::cout << "objective " << solution.get_cost() << "\nseconds " << seconds << "\nsolved "
              << !solution.error_flag << "\n";
    return solution.error_flag;
}

int main(int argc, char **argv)
{
    for (const textbook &one : all) {
        if (argc < 2)
            std::cout << one.name << "\n";
        else if (!std::strcmp(argv[1], one.name))
            chosen = &one;
    }
    if (argc < 2)
        return 0;
    if (!chosen) {
        std::cerr << "no problem " << argv[1] << " here; without a name they are listed\n";
        return 2;
    }
    return solve();
}
