// SPDX-License-Identifier: MIT
//
// Effects between the nodes that these do not tell, and jumps along the way, against sums over their closed forms at an
// iterate set by hand.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"

#include "base/dense.h"
#include "ocp/certificate/unseen.h"

enum { NX = 3, NU = 2, NC = 1, NQ = 2, OUT = NX + NC + NQ, PARAMETER = NX + NU, INTERVALS = 3 };
enum { G0 = NX + NC, G1 };
static const double inset = 1e-6, resolved = 0.1, mesh[] = {0, 0.2, 0.7, 1}, spans[2][2] = {{6, 7.5}, {2, 5}};

// What is tried: the sides of the states that bounds leave no room on, a kink on the trajectory, and sizes of controls.
struct trial {
    const char *scheme;
    bool blocked[2]; // behind, ahead
    double kink, size[NU];
    moray_bounds u[NU];
    bool undefined; // with the least controls
};
static bool begun; // before that all is defined

static double path(int i, double t)
{
    return i == 0 ? 1 + 2 * (t - 2) : i == 1 ? 6 : -4;
}

static double steered(int r, double t)
{
    return r == 0 ? 0.2 + 0.3 * (t - 2) : 0.5 - 0.1 * (t - 2);
}

static void ride(const moray_node *at, moray_rates *out, const struct trial *trial, const moray_num *u)
{
    const double t = creal(at->t);
    const moray_num off[] = {at->x[0] - path(0, t), at->x[1] - path(1, t), at->x[2] - path(2, t)};
    const bool undefined = trial->undefined && begun && creal(u[1]) < -0.2;
    out->f[0] = 2 + (2 + sin(9 * t)) * off[0];
    out->f[1] = (u[0] - steered(0, t)) * cos(7 * t);
    out->f[2] = undefined ? NAN : -0.4 * off[2];
    out->c[0] = begun && fabs(off[0]) + fabs(u[0] - steered(0, t)) > 1e-9 ? NAN : 1e3; // which has no price
    out->g[0] = u[1] * sin(8 * t) - 3 * off[1] * cos(5 * t) + trial->kink * moray_abs(off[0]);
    out->g[1] = 4 * (at->s[0] - 1) * cos(6 * t) + off[2];
}

static void driven(const moray_node *at, moray_rates *out, const void *data)
{
    ride(at, out, data, at->u);
}

static void adrift(const moray_node *at, moray_rates *out, const void *data)
{
    const double t = creal(at->t);
    ride(at, out, data, (moray_num[]){steered(0, t), steered(1, t)});
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0] - at->phase[1].q[1];
}

// ---- Closed forms ----

static void effect(const struct trial *trial, const struct unseen *u, int kind, int side, double t, double *out)
{
    const double *way = u->direction;
    const bool driven_by = u->kinds == MORAY_UNSEEN_KINDS;
    memset(out, 0, OUT * sizeof *out);
    if (kind == along_states) {
        out[0] = (2 + sin(9 * t)) * way[0];
        out[2] = -0.4 * way[2];
        out[G0] = -3 * way[1] * cos(5 * t) + side * trial->kink * fabs(way[0]);
        out[G1] = 4 * way[PARAMETER - (driven_by ? 0 : NU)] * cos(6 * t) + way[2];
    } else {
        const double *control = u->control[kind == high_control];
        out[0] = 2;
        out[1] = driven_by ? (control[0] - steered(0, t)) * cos(7 * t) : 0;
        out[G0] = (driven_by ? control[1] : steered(1, t)) * sin(8 * t);
    }
}

static double cost(const double *price, const double *one, const double *other, const double *spread)
{
    double sum = 0;
    for (int i = 0; i < OUT; i++)
        sum += price[i] * fmax(fabs(one[i] - other[i]) - resolved * spread[i], 0);
    return sum;
}

// Of the sides with room the one that costs less; without any what is told.
static void choose(const struct trial *trial, const struct unseen *u, int kind, double t, const double *price,
                   const double *told, double *out)
{
    static const double nothing[OUT];
    double least = INFINITY, here[OUT];
    memcpy(out, told ? told : nothing, OUT * sizeof *out);
    for (int side = -1; side <= 1; side += 2) {
        effect(trial, u, kind, side, t, here);
        const double costs = cost(price, here, told ? told : nothing, nothing);
        if ((kind == along_states && trial->blocked[side > 0]) || costs >= least)
            continue;
        least = costs;
        memcpy(out, here, sizeof here);
    }
}

static double lagrange(const moray_scheme *scheme, int j, double tau)
{
    double product = 1;
    for (int k = scheme->first; k <= scheme->last; k++)
        product *= k == j ? 1 : (tau - scheme->node[k]) / (scheme->node[j] - scheme->node[k]);
    return product;
}

// One kind on one interval: its sum over the points between, and its largest, with where it is.
struct sum {
    double all, most, where;
};

static struct sum expect(const struct trial *trial, const struct unseen *u, int kind, int p, int k, const double *price)
{
    const struct interval *interval = &u->e->solution->transcription->layout.phase[p].interval[k];
    const moray_scheme *scheme = interval->scheme;
    const double start = spans[p][0], T = spans[p][1] - start, width = mesh[k + 1] - mesh[k];
    const int points = (int)ceil(512 * width);
    double at_nodes[MORAY_MAX_STAGES + 2][OUT], low[OUT], high[OUT], spread[OUT];
    for (int j = scheme->first; j <= scheme->last; j++) {
        const double tau = fmin(fmax(scheme->node[j], inset), 1 - inset);
        choose(trial, u, kind, start + T * (mesh[k] + width * tau), price, NULL, at_nodes[j]);
        for (int i = 0; i < OUT; i++) {
            low[i] = j == scheme->first ? at_nodes[j][i] : fmin(low[i], at_nodes[j][i]);
            high[i] = j == scheme->first ? at_nodes[j][i] : fmax(high[i], at_nodes[j][i]);
            spread[i] = high[i] - low[i];
        }
    }
    for (int i = 0; i < OUT; i++)
        if (price[i] > 0 && !(trial->undefined && kind == low_control))
            CHECK_RELATIVE(u->spread[kind][i], spread[i], 1e-8, "how far effects at the nodes differ");
    struct sum sum = {0, 0, 0.5};
    for (int point = 0; point < points && !(trial->undefined && kind == low_control); point++) {
        const double tau = (point + 0.5) / points;
        double told[OUT] = {0}, here[OUT];
        for (int j = scheme->first; j <= scheme->last; j++)
            for (int i = 0; i < OUT; i++)
                told[i] += lagrange(scheme, j, tau) * at_nodes[j][i];
        choose(trial, u, kind, start + T * (mesh[k] + width * tau), price, told, here);
        const double costs = cost(price, here, told, spread);
        sum.all += costs * T * width / points;
        if (costs > sum.most)
            sum.most = costs, sum.where = tau;
    }
    return sum;
}

// ---- The iterate ----

static void set_iterate(moray_solution *solution)
{
    struct transcription *t = solution->transcription;
    unsigned long long seed = 11;
    memset(solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    for (int p = 0; p < 2; p++)
        for (int n = 0; n < t->layout.phase[p].nodes; n++) {
            const struct node *node = &t->layout.phase[p].node[n];
            const double time = spans[p][0] + (spans[p][1] - spans[p][0]) * node->tau;
            for (int i = 0; i < NX; i++)
                solution->iterate.x[node->x + i] = path(i, time);
            for (int r = 0; r < NU && p == 1 && node->collocated; r++)
                solution->iterate.x[node->x + NX + r] = steered(r, time);
        }
    solution->iterate.x[t->layout.s] = 1;
    for (int i = 0; i < t->nlp.m; i++)
        solution->iterate.lambda[i] = tap_random(&seed, -2, 1);
    CHECK(moray_transcription_jacobians(t, solution->iterate.x), "finite");
}

static void check_controls(const struct trial *trial, const struct unseen *u)
{
    const struct phase_layout *layout = &u->e->solution->transcription->layout.phase[1];
    for (int r = 0; r < NU; r++) {
        double low = 0, high = 0;
        for (int n = layout->nodes - 1, first = 1; n >= 0; n--)
            if (layout->node[n].collocated) {
                const double here = steered(r, 2 + 3 * layout->node[n].tau);
                low = first ? here : fmin(low, here), high = first ? here : fmax(high, here);
                first = 0;
            }
        const double apart = fmax(high - low, trial->size[r]), middle = (high + low) / 2;
        CHECK_RELATIVE(u->control[0][r], fmax(trial->u[r].lower, middle - apart / 2), 1e-12, "the least control");
        CHECK_RELATIVE(u->control[1][r], fmin(trial->u[r].upper, middle + apart / 2), 1e-12, "the largest");
    }
}

static void check_direction(const struct unseen *u, const double *size, int nu)
{
    for (int j = 0; j < NX + nu + 1; j++) {
        const bool control = j >= NX && j < NX + nu;
        CHECK_RELATIVE(u->direction[j], control ? 0 : size[j] * moray_dense_entry(j, MORAY_DENSE_UNSEEN), 1e-14,
                       "states and parameters move, each by its size");
    }
}

static void find_prices(const struct unseen *u, int p, int k, double *price)
{
    const moray_solution *solution = u->e->solution;
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    double costate[200 * NX];
    moray_solution_nodes(solution, p, NULL, costate);
    memset(price, 0, OUT * sizeof *price);
    for (int j = 0; j < layout->interval[k].scheme->points; j++)
        for (int i = 0; i < NX; i++)
            price[i] = tap_worse(price[i], fabs(costate[(layout->interval[k].first + j) * NX + i]));
    for (int m = 0; m < NQ; m++)
        price[G0 + m] = fabs(solution->iterate.lambda[layout->integral_row + m]);
    for (int i = 0; i < OUT; i++)
        CHECK_RELATIVE(u->price[i], price[i], 1e-14, "what an output costs at most on the interval");
}

static void check_interval(const struct trial *trial, struct unseen *u, int p, int k)
{
    static const double objective = 2.5;
    const struct interval *interval = &u->e->solution->transcription->layout.phase[p].interval[k];
    double jumps = -1, where = -1, price[OUT];
    const double found = moray_unseen_interval(u, interval, objective, &jumps, &where);
    find_prices(u, p, k, price);
    struct sum worst = {0}, largest = {0, 0, 0.5};
    for (int kind = along_states; kind < u->kinds; kind++) {
        const struct sum sum = expect(trial, u, kind, p, k, price);
        worst.all = sum.all > worst.all ? sum.all : worst.all;
        largest = sum.most > largest.most ? sum : largest;
    }
    CHECK_RELATIVE(found, worst.all / objective, 1e-8, "what the nodes do not tell, of the worst kind");
    CHECK(fabs(where - largest.where) < 1e-12 || largest.most < 1e-9, "most of it at %g, expected %g", where,
          largest.where); // anywhere where all is rounding
    CHECK(fabs(jumps) < 1e-8, "nothing jumps: %g", jumps);
    CHECK(moray_unseen_interval(u, interval, objective, NULL, &where) == found, "the same without jumps");
}

static void check_phase(const struct trial *trial, const struct witness *w, int p)
{
    struct examiner e;
    struct unseen u;
    CHECK_OK(moray_examiner_new(&e, w, p), "examiner");
    CHECK_OK(moray_unseen_new(&u, &e), "effects");
    CHECK(u.kinds == (p ? MORAY_UNSEEN_KINDS : high_control), "%d kinds", u.kinds);
    check_direction(&u, w->phase[p].size, p ? NU : 0);
    if (p == 1)
        check_controls(trial, &u);
    for (int k = 0; k < INTERVALS; k++)
        check_interval(trial, &u, p, k);
    moray_unseen_free(&u);
    moray_examiner_free(&e);
}

static void test_effects(const struct trial *trial)
{
    moray_bounds x[] = {moray_free(), moray_free(), moray_free()};
    for (int side = -1; side <= 1; side += 2) // of the second state behind, of the third ahead
        if (trial->blocked[side > 0]) {
            const int i = side < 0 ? 1 : 2;
            const bool up = side * moray_dense_entry(i, MORAY_DENSE_UNSEEN) > 0;
            x[i] = up ? moray_at_most(path(i, 0)) : moray_at_least(path(i, 0));
        }
    const moray_bounds none = moray_free();
    const moray_phase_spec phases[] = {{.nx = NX,
                                        .nc = NC,
                                        .nq = NQ,
                                        .continuous = adrift,
                                        .t0 = moray_fixed(spans[0][0]),
                                        .tf = moray_fixed(spans[0][1]),
                                        .mesh = mesh,
                                        .intervals = INTERVALS,
                                        .x = MORAY_BOUNDS(x[0], x[1], x[2]),
                                        .c = MORAY_BOUNDS(none)},
                                       {.nx = NX,
                                        .nu = NU,
                                        .nc = NC,
                                        .nq = NQ,
                                        .continuous = driven,
                                        .t0 = moray_fixed(spans[1][0]),
                                        .tf = moray_fixed(spans[1][1]),
                                        .mesh = mesh,
                                        .intervals = INTERVALS,
                                        .x = MORAY_BOUNDS(x[0], x[1], x[2]),
                                        .u = MORAY_BOUNDS(trial->u[0], trial->u[1]),
                                        .c = MORAY_BOUNDS(none)}};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    begun = false;
    settings.max_iterations = 0;
    settings.scheme = trial->scheme;
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phases, .ns = 1, .endpoint = total, .data = trial}),
        trial->scheme);
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    begun = true;
    set_iterate(solution);
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    memcpy(w.phase[1].size + NX, trial->size, sizeof trial->size);
    for (int p = 0; p < 2; p++)
        check_phase(trial, &w, p);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    const moray_bounds wide = moray_between(-30, 40), near = moray_between(0, 2);
    const struct trial trials[] = {
        {"radau3", {false, false}, 0, {5, 0.01}, {near, wide}, false},
        {"gauss2", {false, false}, 0.7, {0.01, 3}, {wide, near}, false},
        {"hermite-simpson", {true, false}, 0.7, {2, 4}, {wide, near}, false},
        {"radau4", {false, true}, 0.7, {4, 2}, {near, wide}, false},
        {"radau3", {true, true}, -0.3, {8, 1}, {wide, wide}, false},
        {"gauss3", {false, false}, -0.3, {1, 4}, {wide, wide}, true},
    };
    for (size_t k = 0; k < sizeof trials / sizeof *trials; k++)
        test_effects(&trials[k]);
    return tap_done();
}
