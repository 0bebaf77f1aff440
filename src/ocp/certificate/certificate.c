// SPDX-License-Identifier: MIT
//
// What a solution is worth, measured apart from the solver that found it.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "ocp/certificate/bends.h"
#include "ocp/certificate/certify.h"
#include "ocp/certificate/curvature.h"
#include "ocp/certificate/differences.h"
#include "ocp/names.h"
#include "ocp/certificate/optimality.h"
#include "ocp/certificate/sizes.h"
#include "ocp/certificate/unseen.h"

static const double no_length = 1e-5; // of a phase, relative to the longest: what a barrier leaves of none
enum { where_size = 300, good_stages = 4 };

// What was found, and where it is worst.
struct verdict {
    const moray_solution *solution;
    moray_certificate *c;
    struct finding mesh, between, shooting, drift, constant, unseen,
        jumps; // constant: drift of the phases where it should be 0
    struct optimality optimality;
    char derivative[where_size], second[200];
};

void moray_find(struct finding *finding, double value, int p, double time)
{
    if (value > finding->value || isnan(value))
        *finding = (struct finding){isnan(value) ? INFINITY : value, p, time};
}

// ---- Numbers ----

// Of a phase as a whole, where its intervals have most of it.
static moray_status look_for_unseen(struct verdict *v, const struct witness *w, struct examiner *e)
{
    struct unseen u;
    MORAY_TRY(moray_unseen_new(&u, e));
    const struct phase_layout *layout = &v->solution->transcription->layout.phase[e->p];
    struct finding most = {.value = -1}, jump = {.value = -1};
    double sum = 0, all_jumps = 0;
    for (int k = 0; k < layout->mesh.intervals; k++) {
        double where, jumps;
        const struct interval *interval = &layout->interval[k];
        const double here = moray_unseen_interval(&u, interval, moray_witness_objective(w), &jumps, &where);
        const struct phase_cache *cache = moray_witness_cache(w, e->p);
        const double start = cache->t0 + (cache->tf - cache->t0) * layout->mesh.edge[k];
        sum += here;
        all_jumps += jumps;
        moray_find(&most, here, e->p, start + (cache->tf - cache->t0) * where * interval->width);
        moray_find(&jump, jumps, e->p, start);
    }
    moray_find(&v->unseen, sum, most.p, most.time);
    moray_find(&v->jumps, all_jumps, jump.p, jump.time);
    moray_unseen_free(&u);
    return moray_ok();
}

static moray_status examine_phase(struct verdict *v, const struct witness *w, int p, const moray_integrator *integrator)
{
    struct examiner e;
    MORAY_TRY(moray_examiner_new(&e, w, p));
    const struct transcription *t = v->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int k = 0; k < layout->mesh.intervals; k++) {
        double outside = 0;
        const double T = t->phase[p].tf - t->phase[p].t0,
                     error = moray_examiner_interval(&e, &layout->interval[k], &outside);
        const double middle = t->phase[p].t0 + T * (layout->mesh.edge[k] + layout->mesh.edge[k + 1]) / 2;
        moray_find(&v->mesh, error, p, middle);
        moray_find(&v->between, outside, p, middle);
    }
    moray_status status = look_for_unseen(v, w, &e);
    if (!moray_failed(status))
        status = moray_resimulate(&e, integrator, &v->shooting, &v->c->composed);
    moray_examiner_free(&e);
    return status;
}

// Where functions change with time they may jump, and the Hamiltonian with them, between nodes.
static moray_status question_hamiltonian(struct verdict *v, const struct witness *w, int p)
{
    struct finding drift = {.value = -1};
    bool autonomous;
    const struct phase *phase = &v->solution->transcription->ocp->phase[p];
    if (phase->observed.n > 0 || phase->n_held > 0) // data and held controls make it jump
        return moray_ok();
    MORAY_TRY(moray_hamiltonian_drift(w, p, &drift, &autonomous));
    if (autonomous)
        moray_find(&v->constant, drift.value, drift.p, drift.time);
    moray_find(&v->drift, drift.value, drift.p, drift.time);
    return moray_ok();
}

static moray_status question_witness(struct verdict *v, const struct witness *w, const moray_integrator *integrator)
{
    MORAY_TRY(moray_compare_columns(w, &v->c->derivatives, &v->c->untold, v->derivative, where_size));
    MORAY_TRY(moray_measure_optimality(w, &v->optimality));
    MORAY_TRY(moray_measure_curvature(w, &v->c->curvature, NULL));
    for (int p = 0; p < v->solution->transcription->ocp->phases; p++)
        MORAY_TRY(question_hamiltonian(v, w, p));
    MORAY_TRY(moray_difference_solution(w, &v->c->directions));
    MORAY_TRY(moray_difference_bends(w, &v->c->directions, v->second, sizeof v->second));
    for (int p = 0; p < v->solution->transcription->ocp->phases; p++)
        MORAY_TRY(examine_phase(v, w, p, integrator));
    return moray_ok();
}

static moray_status gather(struct verdict *v, const moray_integrator *integrator)
{
    struct witness w;
    MORAY_TRY(moray_witness_new(&w, v->solution));
    moray_status status = question_witness(v, &w, integrator);
    moray_witness_free(&w);
    MORAY_TRY(status);
    v->c->kkt = fmax(fmax(v->optimality.improvement, v->optimality.feasibility), v->optimality.told);
    v->c->gap = v->optimality.gap;
    v->c->mesh_error = v->mesh.value;
    v->c->between_nodes = v->between.value;
    v->c->resimulation = v->shooting.value;
    v->c->unseen = fmax(v->unseen.value, v->jumps.value);
    v->c->hamiltonian = v->drift.value < 0 ? NAN : v->drift.value;
    return moray_ok();
}

// ---- Judgement ----

static void fail(struct verdict *v, const char *what, double value, double limit, const char *where)
{
    if (v->c->pass)
        snprintf(v->c->why, sizeof v->c->why, "%s: %.2g, where %.2g is allowed%s%s", what, value, limit,
                 *where ? "; " : "", where);
    v->c->pass = false;
}

static void judge(struct verdict *v, const char *what, double value, double limit, const char *where)
{
    if (!(value <= limit))
        fail(v, what, value, limit, where);
}

static void judge_finding(struct verdict *v, const char *what, const struct finding *f, double limit)
{
    char where[where_size];
    snprintf(where, sizeof where, "phase %.100s near t = %.6g", v->solution->transcription->ocp->phase[f->p].name,
             f->time);
    judge(v, what, f->value, limit, where);
}

static void judge_optimality(struct verdict *v)
{
    const struct transcription *t = v->solution->transcription;
    const struct optimality *o = &v->optimality;
    const double *x = v->solution->iterate.x;
    char where[where_size] = "", name[200] = "";
    if (o->row >= t->nlp.m)
        moray_layout_column_name(&t->layout, t->ocp, x, o->row - t->nlp.m, name, sizeof name);
    else if (o->row >= 0)
        moray_layout_row_name(&t->layout, t->ocp, x, o->row, name, sizeof name);
    judge(v, "the objective that is told differs from that of the trajectory, relative to its size", o->told,
          MORAY_LIMIT_KKT, "");
    judge(v, "constraints are violated, relative to their size", o->feasibility, MORAY_LIMIT_KKT, name);
    if (o->column >= 0) {
        moray_layout_column_name(&t->layout, t->ocp, x, o->column, name, sizeof name);
        snprintf(where, sizeof where, "most by %s", name);
    }
    judge(v, "the objective could still improve, relative to its size", o->improvement, MORAY_LIMIT_KKT, where);
    judge(v, "multipliers times slacks, relative to the objective's size", o->gap, MORAY_LIMIT_GAP,
          "the solver stopped inside the constraints");
    if (!isnan(v->c->curvature))
        judge(v, "the Lagrangian bends down along the active constraints", v->c->curvature, MORAY_LIMIT_CURVATURE,
              "a saddle or a maximum");
}

// Whether costates at the nodes are of an order that makes the Hamiltonian a judge.
static bool has_good_costates(const moray_solution *solution)
{
    const struct layout *layout = &solution->transcription->layout;
    for (int p = 0; p < layout->phases; p++)
        for (int k = 0; k < layout->phase[p].mesh.intervals; k++) {
            const moray_scheme *scheme = layout->phase[p].interval[k].scheme;
            if (scheme->family == MORAY_LOBATTO && scheme->stages < good_stages)
                return false;
        }
    return true;
}

static void judge_all(struct verdict *v)
{
    const moray_settings *settings = &v->solution->settings;
    const double loose = violation_slack * settings->mesh_tolerance;
    judge(v, "derivatives in use differ from differences of the functions", v->c->derivatives, MORAY_LIMIT_DERIVATIVES,
          v->derivative);
    judge(v, "derivatives of the programme differ from differences along directions", v->c->directions,
          MORAY_LIMIT_DIRECTIONS, *v->second ? v->second : "a second derivative, or a kink");
    judge_optimality(v);
    judge_finding(v, "error of the dynamics between the nodes", &v->mesh, settings->mesh_tolerance);
    judge_finding(v, "violation of limits between the nodes", &v->between, loose);
    judge_finding(v, "difference to a re-simulation of an interval", &v->shooting, loose);
    judge_finding(v, "effects between the nodes that none of them tells", &v->unseen, MORAY_LIMIT_UNSEEN);
    judge_finding(v, "functions jump with a state, which no derivative tells (give each side a phase)", &v->jumps,
                  MORAY_LIMIT_UNSEEN);
    if (has_good_costates(v->solution))
        judge_finding(v, "drift of the Hamiltonian", &v->constant, MORAY_LIMIT_HAMILTONIAN);
}

// A phase without length has no dynamics: none of its numbers says anything.
static bool all_have_length(struct verdict *v)
{
    const struct transcription *t = v->solution->transcription;
    double longest = 0;
    for (int p = 0; p < t->ocp->phases; p++)
        longest = fmax(longest, fabs(t->phase[p].tf - t->phase[p].t0));
    for (int p = 0; p < t->ocp->phases; p++)
        if (!(t->phase[p].tf - t->phase[p].t0 > no_length * longest)) {
            snprintf(v->c->why, sizeof v->c->why, "phase %.100s has no length: it goes from t = %.9g to %.9g",
                     t->ocp->phase[p].name, t->phase[p].t0, t->phase[p].tf);
            return false;
        }
    return true;
}

moray_status moray_certify(const moray_solution *solution, const moray_integrator *integrator,
                           moray_certificate *certificate)
{
    struct verdict v = {.solution = solution, .c = certificate, .drift = {.value = -1}};
    *certificate = (moray_certificate){.pass = true, .mesh_limit = solution->settings.mesh_tolerance};
    if (!moray_transcription_jacobians(solution->transcription, solution->iterate.x))
        return moray_error(MORAY_NUMERIC, "at the solution, %s", solution->transcription->failure.text);
    if (!all_have_length(&v)) {
        certificate->pass = false;
        certificate->kkt = certificate->mesh_error = certificate->between_nodes = certificate->resimulation = NAN;
        certificate->derivatives = certificate->directions = certificate->hamiltonian = certificate->composed = NAN;
        certificate->gap = certificate->curvature = certificate->untold = certificate->unseen = NAN;
        return moray_ok();
    }
    MORAY_TRY(gather(&v, integrator));
    judge_all(&v);
    return moray_ok();
}
