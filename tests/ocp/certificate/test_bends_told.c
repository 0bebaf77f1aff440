// SPDX-License-Identifier: MIT
//
// How wrong a second derivative is told to be: of random parabolas, with one entry off by a known amount, in closed
// form; and nothing of right ones, however large the functions, or small their waves.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "base/dense.h"
#include "ocp/certificate/bends.h"
#include "ocp/certificate/sizes.h"

// Inputs of a phase: x, u, s, t; of the endpoint: x0, t0, xf, tf, q of both phases, and s.
enum { NX = 2, NU = 1, NC = 1, NQ = 1, IN = NX + NU + 2, OUT = NX + NC + NQ, PHASE_END = 2 * NX + 2 + NQ };
enum { END_IN = 2 * PHASE_END + 1, END_OUT = 2, MOST = END_IN, ENTRIES = MOST * (MOST + 1) / 2, DIRECTIONS = 3 };
static const double first_step = 0.05, least_room = 1e-3, small_part = 1e-2, tolerant = 1e-2;

// Outputs are offset + slope in + in Q in / 2.
struct parabolas {
    int n_in, n_out;
    double Q[OUT][MOST][MOST], slope[OUT][MOST], offset, off; // of the entry below
    int out, row, col;
};
static int jac_row[2][OUT * MOST], jac_col[2][OUT * MOST], hess_row[2][ENTRIES], hess_col[2][ENTRIES];

static void value(void *self, const double *in, double *out)
{
    const struct parabolas *p = self;
    for (int i = 0; i < p->n_out; i++) {
        out[i] = p->offset;
        for (int r = 0; r < p->n_in; r++) {
            out[i] += p->slope[i][r] * in[r];
            for (int c = 0; c < p->n_in; c++)
                out[i] += in[r] * p->Q[i][r][c] * in[c] / 2;
        }
    }
}

static void jacobian(void *self, const double *in, double *values)
{
    const struct parabolas *p = self;
    for (int i = 0; i < p->n_out; i++)
        for (int r = 0; r < p->n_in; r++) {
            double sum = p->slope[i][r];
            for (int c = 0; c < p->n_in; c++)
                sum += p->Q[i][r][c] * in[c];
            *values++ = sum;
        }
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    const struct parabolas *p = self;
    (void)in;
    for (int r = 0; r < p->n_in; r++)
        for (int c = 0; c <= r; c++) {
            double sum = r == p->row && c == p->col ? p->off * weight[p->out] : 0;
            for (int i = 0; i < p->n_out; i++)
                sum += weight[i] * p->Q[i][r][c];
            *values++ = sum;
        }
}

static moray_map map_of(struct parabolas *p, int which, unsigned long long *seed)
{
    int jac = 0, hess = 0;
    for (int i = 0; i < p->n_out; i++)
        for (int r = 0; r < p->n_in; r++) {
            jac_row[which][jac] = i, jac_col[which][jac++] = r;
            p->slope[i][r] = tap_random(seed, -1, 1);
            for (int c = 0; c <= r; c++)
                p->Q[i][r][c] = p->Q[i][c][r] = tap_random(seed, -1, 1);
        }
    for (int r = 0; r < p->n_in; r++)
        for (int c = 0; c <= r; c++)
            hess_row[which][hess] = r, hess_col[which][hess++] = c;
    return (moray_map){.self = p,
                       .n_in = p->n_in,
                       .n_out = p->n_out,
                       .jac = {jac, jac_row[which], jac_col[which]},
                       .hess = {hess, hess_row[which], hess_col[which]},
                       .value = value,
                       .jacobian = jacobian,
                       .hessian = hessian};
}

// ---- In closed form ----

struct point {
    const struct parabolas *p;
    const double *in, *size, *weight, *out_size;
    const moray_bounds *box;
    const int *column; // NULL: all are variables, the last but if `timeless`
    bool timeless;
    int seed;
    double matters;
};

static double error_along(const struct point *at, int which)
{
    const struct parabolas *p = at->p;
    double way[MOST], bend = 0, moved = 0;
    for (int j = 0; j < p->n_in; j++) {
        const double entry = moray_dense_entry(j, MORAY_DENSE_BENDS + DIRECTIONS * at->seed + which);
        const double behind = at->in[j] - at->box[j].lower, ahead = at->box[j].upper - at->in[j];
        const double room = behind < ahead ? behind : ahead, whole = fabs(entry) * at->size[j];
        const double reach = room < first_step * whole ? room / first_step : whole;
        const bool still = at->column ? at->column[j] < 0 : at->timeless && j == p->n_in - 1;
        way[j] = still || reach <= least_room * at->size[j] ? 0 : copysign(reach, entry);
    }
    for (int i = 0; i < p->n_out; i++) {
        moved += fabs(at->weight[i]) * at->out_size[i];
        for (int r = 0; r < p->n_in; r++)
            for (int c = 0; c < p->n_in; c++)
                bend += at->weight[i] * p->Q[i][r][c] * way[r] * way[c];
    }
    const double off = (p->row == p->col ? 1 : 2) * p->off * at->weight[p->out] * way[p->row] * way[p->col];
    return fabs(off) / (fabs(bend) + at->matters + small_part * moved);
}

// Of the three the one in the middle.
static double error_at(const struct point *at)
{
    const double e[] = {error_along(at, 0), error_along(at, 1), error_along(at, 2)};
    return fmax(fmin(e[0], e[1]), fmin(fmax(e[0], e[1]), e[2]));
}

struct worst {
    double value;
    char where[200];
};

static void expect_phase(const struct witness *w, const struct parabolas *p, int phase, struct worst *worst)
{
    const struct transcription *t = w->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[phase];
    const double *lambda = w->solution->iterate.lambda, T = t->phase[phase].tf - t->phase[phase].t0;
    double lambda_f[100 * NX];
    moray_dynamics_multipliers(t, phase, lambda, lambda_f);
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        if (!node->collocated)
            continue;
        const double weight[OUT] = {lambda_f[n * NX], lambda_f[n * NX + 1], lambda[node->path],
                                    -T * node->weight * lambda[layout->integral_row]};
        const double error = error_at(&(struct point){.p = p,
                                                      .in = t->phase[phase].in + n * IN,
                                                      .size = w->phase[phase].size,
                                                      .weight = weight,
                                                      .out_size = w->phase[phase].out_size,
                                                      .box = w->phase[phase].box,
                                                      .timeless = phase == 0,
                                                      .seed = n,
                                                      .matters = node->weight * moray_witness_objective(w)});
        if (!(tolerant * error > worst->value))
            continue;
        worst->value = tolerant * error;
        snprintf(worst->where, sizeof worst->where, "a second derivative in phase %s at t = %.6g",
                 phase ? "after" : "before", t->phase[phase].t0 + T * node->tau);
    }
}

static void expect_end(const struct witness *w, const struct parabolas *p, struct worst *worst)
{
    const struct transcription *t = w->solution->transcription;
    const double weight[END_OUT] = {1, w->solution->iterate.lambda[t->layout.events]};
    const double error = tolerant * error_at(&(struct point){.p = p,
                                                             .in = t->end_in,
                                                             .size = w->end_size,
                                                             .weight = weight,
                                                             .out_size = w->end_out_size,
                                                             .box = w->end_box,
                                                             .column = t->end_column,
                                                             .matters = moray_witness_objective(w)});
    if (error > worst->value)
        *worst = (struct worst){error, "a second derivative of the endpoint"};
}

// ---- The problem ----

struct problem {
    struct parabolas phase[2], end;
    moray_map map[2], end_map;
    moray_ocp *ocp;
    moray_solution *solution;
    struct witness w;
};

static void set_iterate(moray_solution *solution, unsigned long long *seed)
{
    const struct transcription *t = solution->transcription;
    for (int p = 0; p < 2; p++)
        for (int n = 0; n < t->layout.phase[p].nodes; n++) {
            const struct node *node = &t->layout.phase[p].node[n];
            double *x = solution->iterate.x + node->x;
            x[0] = tap_random(seed, -1, 1);
            x[1] = n % 3 == 0 ? 2 : n % 3 == 1 ? 2 - tap_random(seed, 0.005, 0.02) : tap_random(seed, 0, 1.5);
            if (node->collocated)
                x[2] = tap_random(seed, -3, 3);
        }
    solution->iterate.x[t->layout.phase[0].q] = -1;
    solution->iterate.x[t->layout.phase[1].q] = 2;
    solution->iterate.x[t->layout.phase[1].tf] = 6;
    solution->iterate.x[t->layout.s] = -1.7;
    for (int i = 0; i < t->nlp.m; i++)
        solution->iterate.lambda[i] = tap_random(seed, -2, 1);
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
}

static void begin(struct problem *b, double offset, unsigned long long *seed)
{
    const moray_bounds none = moray_free();
    moray_settings settings = moray_settings_default();
    *b = (struct problem){.phase = {{IN, OUT, .offset = offset}, {IN, OUT, .offset = offset}},
                          .end = {END_IN, END_OUT, .offset = offset}};
    for (int p = 0; p < 2; p++)
        b->map[p] = map_of(&b->phase[p], 0, seed);
    b->end_map = map_of(&b->end, 1, seed);
    moray_phase_spec phase = {.name = "before",
                              .nx = NX,
                              .nu = NU,
                              .nc = NC,
                              .nq = NQ,
                              .map = &b->map[0],
                              .tf = moray_fixed(3),
                              .x = MORAY_BOUNDS(none, moray_at_most(2)),
                              .c = MORAY_BOUNDS(none)};
    moray_phase_spec phases[2] = {phase, phase};
    phases[1].name = "after", phases[1].map = &b->map[1];
    phases[1].t0 = moray_fixed(3), phases[1].tf = moray_between(3, 40);
    settings.max_iterations = 0;
    settings.intervals = 3;
    settings.scheme = "radau3";
    CHECK_OK(
        moray_ocp_new(
            &b->ocp,
            &(moray_ocp_spec){
                .phases = 2, .phase = phases, .ns = 1, .ne = 1, .e = MORAY_BOUNDS(none), .endpoint_map = &b->end_map}),
        "parabolas");
    CHECK_OK(moray_solve(b->ocp, &settings, NULL, &b->solution), "begun");
    set_iterate(b->solution, seed);
    CHECK_OK(moray_witness_of_sizes(&b->w, b->solution), "sizes");
}

static void end(struct problem *b)
{
    moray_witness_free(&b->w);
    moray_solution_free(b->solution);
    moray_ocp_free(b->ocp);
}

// One entry off, of a phase or of the endpoint.
static void test_off(struct problem *b, int of, unsigned long long *seed)
{
    struct parabolas *p = of < 2 ? &b->phase[of] : &b->end;
    struct worst worst = {0};
    double found = 0;
    char where[200] = "";
    p->out = (int)tap_random(seed, 0, p->n_out);
    p->row = (int)tap_random(seed, 0, p->n_in);
    p->col = (int)tap_random(seed, 0, p->row + 1);
    p->off = tap_random(seed, 1, 4) * (tap_random(seed, -1, 1) < 0 ? -1 : 1);
    for (int k = 0; k < 2; k++)
        expect_phase(&b->w, &b->phase[k], k, &worst);
    expect_end(&b->w, &b->end, &worst);
    CHECK_OK(moray_difference_bends(&b->w, &found, where, sizeof where), "bends");
    CHECK(fabs(found - worst.value) <= 1e-4 * worst.value + 1e-9,
          "entry %d, %d of output %d is wrong by %.9g, not %.9g", p->row, p->col, p->out, found, worst.value);
    CHECK(worst.value == 0 || !strcmp(where, worst.where), "in %s, expected %s", where, worst.where);
    double larger = 2 * worst.value + 1;
    CHECK_OK(moray_difference_bends(&b->w, &larger, where, sizeof where), "bends");
    CHECK(larger == 2 * worst.value + 1, "what is worse already stays");
    p->off = 0;
}

int main(void)
{
    unsigned long long seed = 17;
    struct problem b;
    for (int problem = 0; problem < 4; problem++) {
        begin(&b, 0, &seed);
        for (int trial = 0; trial < 30; trial++)
            test_off(&b, trial % 3, &seed);
        end(&b);
    }
    for (double large = 1e6; large <= 1e12; large *= 100)
        for (int sign = -1; sign <= 1; sign += 2) {
            double found = 0;
            char where[200] = "";
            begin(&b, sign * large, &seed);
            CHECK_OK(moray_difference_bends(&b.w, &found, where, sizeof where), "bends");
            CHECK(found == 0 && !*where, "beside %g nothing is told: %g, %s", sign * large, found, where);
            end(&b);
        }
    return tap_done();
}
