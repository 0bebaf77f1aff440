// SPDX-License-Identifier: MIT
//
// A control that goes to and fro from node to node is told from one that moves, and the family of the scheme changes,
// and back.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "ocp/refinement/family.h"
#include "ocp/refinement/refine.h"
#include "ocp/refinement/ringing.h"

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->x[0] * at->x[0] * at->x[0] + at->u[0];
    out->g[0] = at->x[0] * at->x[0] + at->u[0] * at->u[0];
}

static void cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_ocp *new_problem(void)
{
    const moray_phase_spec phase = {.name = "drift",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = drift,
                                    .tf = moray_fixed(50),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1.5)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1))};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "drift", .phases = 1, .phase = &phase, .endpoint = cost}),
             "problem");
    return ocp;
}

static moray_solution *solve(const moray_ocp *ocp, const char *scheme, int intervals)
{
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.scheme = scheme;
    settings.intervals = intervals;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), scheme);
    return solution;
}

// ---- What is ringing ----

// Control at time tau of 0..1, at the n-th node.
typedef double control_fn(double tau, int n);

static double set_and_find(moray_solution *solution, control_fn *control, int *found)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    double swing;
    for (int n = 0; n < layout->nodes; n++)
        if (layout->node[n].collocated)
            solution->iterate.x[layout->node[n].x + 1] = control(layout->node[n].tau, n);
    *found = moray_find_ringing(solution, &swing);
    return swing;
}

static double alternating(double tau, int n)
{
    (void)tau;
    return n % 2 ? 3 : -1;
}

static double alternating_by_less(double tau, int n)
{
    return n % 2 ? 3 : -1 + 3 * (tau > 0.25);
}

static double alternating_for_a_while(double tau, int n)
{
    return tau < 0.5 && n % 2 ? 3 : -1;
}

// From the first node on, a turn at each.
static double alternating_often(double tau, int n)
{
    (void)tau;
    return n > 8 ? -1 : n % 2 ? 3 : -1;
}

static double alternating_once_less(double tau, int n)
{
    (void)tau;
    return n > 7 ? 3 : n % 2 ? 3 : -1;
}

// To and fro every fourth node, and every fifth.
static double alternating_slowly(double tau, int n)
{
    (void)tau;
    return n / 4 % 2 ? 3 : -1;
}

static double alternating_more_slowly(double tau, int n)
{
    (void)tau;
    return n / 5 % 2 ? 3 : -1;
}

static double alternating_within_digits(double tau, int n)
{
    return tau + (n % 2 ? 0.004 : 0);
}

static double oscillating(double tau, int n)
{
    (void)n;
    return sin(6 * M_PI * tau);
}

static double switching(double tau, int n)
{
    (void)n;
    return tau > 0.1 ? -1 : 1;
}

static void test_what_rings(void)
{
    moray_ocp *ocp = new_problem();
    moray_solution *solution = solve(ocp, "hermite-simpson", 50);
    const struct {
        control_fn *control;
        const char *name;
        double swing;
    } cases[] = {{alternating, "from bound to bound at every node", 1},
                 {alternating_by_less, "by a quarter of that after a quarter of the time", 0.25 + 0.75 / 4},
                 {alternating_for_a_while, "half of the time", 0.5},
                 {alternating_often, "eight times, each turn but the first from the node before", 7 / 100.},
                 {alternating_once_less, "seven times, which may be a coincidence", 0},
                 {alternating_slowly, "at every fourth node", 0.96},
                 {alternating_more_slowly, "at every fifth, which is no longer from node to node", 0},
                 {alternating_within_digits, "by less than a hundredth", 0},
                 {oscillating, "with the time", 0},
                 {switching, "once", 0}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        int found;
        const double swing = set_and_find(solution, cases[k].control, &found);
        CHECK(fabs(swing - cases[k].swing) < 0.02, "a control that moves %s: %.3f, expected %.3f", cases[k].name, swing,
              cases[k].swing);
        CHECK(found == (cases[k].swing > 0), "%s: %d", found ? "found" : "not found", found);
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Families ----

// As often as tells, by a fiftieth of the range.
static double alternating_soon(double tau, int n)
{
    return tau > 0.2 ? 100 * (tau > 0.6) : n % 2 ? 2 : -1;
}

struct change {
    moray_settings settings;
    moray_mesh_record history[4];
    struct mesh mesh;
    struct campaign c;
};

// After a mesh of `nodes` that Radau took over on, the best being that of Gauss from before.
static void begin(struct change *change, const moray_ocp *ocp, moray_solution *best, int nodes)
{
    *change = (struct change){.settings = best->settings};
    change->history[0].nodes = 40;
    change->history[0].changed_to = "radau3";
    change->history[1].nodes = nodes;
    change->c = (struct campaign){.ocp = ocp,
                                  .settings = &change->settings,
                                  .method = {MORAY_RADAU, 3},
                                  .left = {[MORAY_GAUSS] = true},
                                  .before = {{MORAY_GAUSS, 2}, "gauss2", 40},
                                  .meshes = &change->mesh,
                                  .history = change->history,
                                  .tried = 2,
                                  .best = best,
                                  .vain = 3};
    change->settings.mesh_tolerance = 1e-12;
}

static void test_back(void)
{
    moray_ocp *ocp = new_problem();
    moray_solution *best = solve(ocp, "gauss2", 20), *radau = solve(ocp, "radau3", 20), *last = best;
    struct change change;
    struct campaign *c = &change.c;
    begin(&change, ocp, best, 39);
    CHECK(!moray_is_no_better(c, true), "with fewer nodes than the family before: may yet do better");
    CHECK(moray_is_no_better(c, false), "no more meshes: no better");
    c->best = radau;
    CHECK(!moray_is_no_better(c, false), "the best is its own: better");
    begin(&change, ocp, best, 41);
    CHECK(moray_is_no_better(c, true), "with more nodes than the family before: no better");
    CHECK_OK(moray_go_back(c, &last), "back");
    CHECK(c->method.family == MORAY_GAUSS && c->method.stages == 2 && last == best && c->vain == 0,
          "family %d, %d stages", c->method.family, c->method.stages);
    CHECK(c->left[MORAY_RADAU] && !moray_is_no_better(c, false), "and not to and fro");
    CHECK(change.history[1].changed_to && strcmp(change.history[1].changed_to, "gauss2") == 0, "noted: %s",
          change.history[1].changed_to);
    CHECK(!moray_mesh_equal(&change.mesh, &best->transcription->layout.phase[0].mesh),
          "to the mesh that follows on the best: %d intervals", change.mesh.intervals);
    moray_campaign_free_meshes(c);
    moray_solution_free(best);
    moray_solution_free(radau);
    moray_ocp_free(ocp);
}

// Two meshes of Hermite-Simpson on which the control went to and fro all of the time, of these errors.
static bool leaves(const moray_ocp *ocp, moray_solution *last, double error_before, double error, const char *changed,
                   double swing)
{
    moray_settings settings = moray_settings_default();
    moray_mesh_record history[2] = {{.error = error_before, .seen = 1, .swing = swing, .changed_to = changed},
                                    {.error = error}};
    struct mesh mesh = {0};
    struct campaign c = {.ocp = ocp,
                         .settings = &settings,
                         .method = {MORAY_LOBATTO, 3},
                         .meshes = &mesh,
                         .history = history,
                         .tried = 2};
    settings.mesh_tolerance = 1e-6;
    settings.intervals = 10;
    CHECK_OK(moray_leave_ringing(&c, last), "looked at");
    CHECK((history[1].changed_to != NULL) == (history[1].ringing == 1) &&
              (c.method.family == MORAY_RADAU) == (history[1].ringing == 1),
          "what rings is noted where the family changes: %d", history[1].ringing);
    moray_campaign_free_meshes(&c);
    return history[1].changed_to != NULL;
}

static void test_leaving(void)
{
    moray_ocp *ocp = new_problem();
    moray_solution *last = solve(ocp, "hermite-simpson", 50);
    int found;
    const double swing = set_and_find(last, alternating, &found);
    CHECK(!leaves(ocp, last, 1, 1, NULL, 2.02 * swing),
          "a swing that is less than half of what it was is on its way out");
    CHECK(leaves(ocp, last, 1, 1, NULL, 1.98 * swing), "one that is more is not");
    CHECK(leaves(ocp, last, 1, 1, NULL, 1), "a family with which a control rings on mesh after mesh is left");
    CHECK(!leaves(ocp, last, 1, 1, "lobatto3", 1), "but what rang before the family changed does not count");
    CHECK(!leaves(ocp, last, 1, 5e-6, NULL, 1), "nor what rings where the error is nearly small enough");
    CHECK(!leaves(ocp, last, 5e-6, 1, NULL, 1), "or was");
    const double little = set_and_find(last, alternating_soon, &found);
    CHECK(found == 1 && little > 0 && little < 0.01 && !leaves(ocp, last, 1, 1, NULL, little),
          "nor for one of a hundredth of the range of a control: %g", little);
    set_and_find(last, switching, &found);
    CHECK(!leaves(ocp, last, 1, 1, NULL, 1), "nor is a family left that rings no more");
    moray_solution_free(last);
    moray_ocp_free(ocp);
}

// Bolza's problem: least integral of (1 - u^2)^2 + x^2, x' = u, x = 0 at both ends, has no best control but one that
// goes to and fro ever faster: it rings with every family.
static void bolza(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num u = at->u[0], off = 1 - u * u;
    out->f[0] = u;
    out->g[0] = off * off + at->x[0] * at->x[0];
}

// Radau takes over from Gauss, is worse, and may have no mesh as large as it needs next; Gauss may.
static void test_there_and_back(void)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = bolza,
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(moray_between(-1, 1)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-1.5, 1.5))};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    int meshes, there = -1, back = -1;
    settings.scheme = "gauss2";
    settings.intervals = 8;
    settings.max_refinements = 8;
    settings.max_variables = 140;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = cost}), "Bolza's problem");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const moray_mesh_record *tried = moray_solution_history(solution, &meshes);
    for (int k = 0; k < meshes; k++) {
        there = tried[k].changed_to && strcmp(tried[k].changed_to, "radau3") == 0 ? k : there;
        back = tried[k].changed_to && strcmp(tried[k].changed_to, "gauss2") == 0 ? k : back;
    }
    CHECK(there >= 0 && back > there && tried[back].error > tried[there].error,
          "left after mesh %d of %d, for a family that is worse, and back after %d", there, meshes, back);
    CHECK(back >= 0 && back + 1 < meshes && tried[back + 1].error < tried[there].error &&
              solution->transcription->layout.phase[0].mesh.method.family == MORAY_GAUSS,
          "the family of before goes on from where it was");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_what_rings();
    test_there_and_back();
    test_leaving();
    test_back();
    return tap_done();
}
