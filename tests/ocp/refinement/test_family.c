// SPDX-License-Identifier: MIT
//
// Which family takes over, for which control or equation of several phases, and on which meshes.
#include "tap.h"

#include <string.h>

#include "ocp/refinement/family.h"
#include "ocp/refinement/ringing.h"

enum { PHASES = 2, NX = 2 };
static const int controls[PHASES] = {2, 3}, equations[PHASES] = {3, 2};

// Path constraints: of states and controls; of controls alone; of states; of the time and a state; of a parameter.
static void first(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = at->u[1];
    out->c[0] = at->x[1] + at->u[1];
    out->c[1] = at->u[0];
    out->c[2] = at->x[1] * at->x[0];
}

static void second(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] + at->u[2];
    out->f[1] = at->u[1];
    out->c[0] = at->t + at->s[0];
    out->c[1] = at->t + at->x[0];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0] + at->phase[1].xf[1];
}

// Which of the path constraints are equations.
struct asked {
    bool first[3], second[2];
};

static moray_solution *begin(moray_ocp **ocp, const struct asked *asked)
{
    moray_bounds c[PHASES][3];
    for (int i = 0; i < 3; i++) {
        c[0][i] = asked->first[i] ? moray_fixed(0) : moray_between(-9, 9);
        c[1][i] = i < 2 && asked->second[i] ? moray_fixed(0) : moray_between(-9, 9);
    }
    const moray_phase_spec phases[PHASES] = {{.nx = NX,
                                              .nu = 2,
                                              .nc = 3,
                                              .continuous = first,
                                              .tf = moray_fixed(1),
                                              .c = MORAY_BOUNDS(c[0][0], c[0][1], c[0][2])},
                                             {.nx = NX,
                                              .nu = 3,
                                              .nc = 2,
                                              .continuous = second,
                                              .t0 = moray_fixed(1),
                                              .tf = moray_fixed(2),
                                              .c = MORAY_BOUNDS(c[1][0], c[1][1])}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 40;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = PHASES, .phase = phases, .ns = 1, .endpoint = total}),
             "two phases");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    memset(solution->iterate.x, 0, (size_t)solution->transcription->nlp.n * sizeof(double));
    solution->info.outcome = MORAY_NLP_SOLVED;
    return solution;
}

// A campaign after `tried` meshes.
struct state {
    moray_settings settings;
    moray_mesh_record history[4];
    struct mesh meshes[PHASES];
    struct method own[PHASES];
    struct campaign c;
};

static struct campaign *campaign(struct state *s, const moray_ocp *ocp, int tried)
{
    *s = (struct state){.settings = moray_settings_default()};
    s->settings.intervals = 7;
    s->settings.scheme = "hermite-simpson";
    s->c = (struct campaign){.ocp = ocp,
                             .settings = &s->settings,
                             .method = {MORAY_LOBATTO, 3},
                             .own = s->own,
                             .meshes = s->meshes,
                             .history = s->history,
                             .tried = tried,
                             .vain = 2};
    return &s->c;
}

static void check_meshes(struct state *s, int intervals, moray_family family)
{
    for (int p = 0; p < PHASES; p++) {
        const struct mesh *mesh = &s->meshes[p];
        const bool own = s->own[p].stages > 0;
        CHECK(mesh->intervals == intervals && mesh->method.family == (own ? s->own[p].family : family) &&
                  mesh->stages[0] == (own ? s->own[p].stages : 3),
              "phase %d: %d intervals of family %d, %d stages", p, mesh->intervals, (int)mesh->method.family,
              mesh->stages[0]);
    }
    moray_campaign_free_meshes(&s->c);
}

// ---- Ringing ----

// The control of a phase goes to and fro on the last two of three meshes, but 1.
static void ring(moray_solution *solution, int p, int control)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    for (int n = 0; n < layout->nodes; n++)
        if (layout->node[n].collocated)
            solution->iterate.x[layout->node[n].x + NX + control] = n % 2;
}

static void test_ringing(const moray_ocp *ocp, moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    for (int p = 0, number = 0; p < PHASES; p++)
        for (int k = 0; k < controls[p]; k++)
            for (int own = -1; own < PHASES; own++) {
                struct state s;
                struct campaign *c = campaign(&s, ocp, 3);
                memset(solution->iterate.x, 0, (size_t)t->nlp.n * sizeof(double));
                ring(solution, p, k);
                number += own < 0;
                s.history[1] = (moray_mesh_record){.error = 1, .seen = number, .swing = 1};
                s.history[2] = (moray_mesh_record){.error = 1, .nodes = 62};
                if (own >= 0)
                    s.own[own] = (struct method){MORAY_GAUSS, 2};
                CHECK_OK(moray_leave_ringing(c, solution), "looked at");
                CHECK(s.history[2].seen == number, "control %d of phase %d is number %d: %d", k, p, number,
                      s.history[2].seen);
                CHECK((s.history[2].changed_to != NULL) == (own != p), "a phase of its own scheme keeps it");
                if (own == p)
                    continue;
                CHECK(s.history[2].ringing == number && !strcmp(s.history[2].changed_to, "radau3"), "noted");
                CHECK(c->before.method.family == MORAY_LOBATTO && c->before.method.stages == 3 &&
                          c->before.nodes == 62 && !strcmp(c->before.scheme, "hermite-simpson"),
                      "and what was before: %s, %d nodes", c->before.scheme, c->before.nodes);
                CHECK(c->left[MORAY_LOBATTO] && !c->left[MORAY_RADAU] && !c->left[MORAY_GAUSS] && c->vain == 0,
                      "one family is left");
                check_meshes(&s, 7, MORAY_RADAU);
            }
}

// Of several that ring alike the first.
static void test_first(moray_solution *solution)
{
    double swing = -1;
    memset(solution->iterate.x, 0, (size_t)solution->transcription->nlp.n * sizeof(double));
    CHECK(moray_find_ringing(solution, &swing) == 0 && swing == 0, "none rings where all stand still: %g", swing);
    ring(solution, 0, 1), ring(solution, 1, 0), ring(solution, 1, 2);
    CHECK(moray_find_ringing(solution, &swing) == 2, "the second control is the first");
    CHECK_NEAR(swing, 1, 0.05, "which does all of the time");
}

// Where the first meshes are those of a guess, their number is that of the history, and so is the scheme; after Radau
// comes Gauss, after both none.
static void test_next(const moray_ocp *ocp, moray_solution *solution)
{
    static const int all[] = {31, 2, 1};
    for (int k = 0; k < 3; k++)
        for (int left = 0; left < 3; left++) {
            struct state s;
            struct campaign *c = campaign(&s, ocp, 3);
            const moray_guess guess = moray_guess_from_solution(solution);
            ring(solution, 0, 0);
            s.settings.intervals = 0;
            c->guess = &guess;
            c->own = NULL;
            c->left[MORAY_RADAU] = left > 0, c->left[MORAY_GAUSS] = left > 1;
            s.history[0] = (moray_mesh_record){.intervals = all[k], .changed_to = left == 1 ? "radau5" : NULL};
            s.history[1] = (moray_mesh_record){.error = 1, .seen = 1, .swing = 1};
            s.history[2] = (moray_mesh_record){.error = 1};
            CHECK_OK(moray_leave_ringing(c, solution), "looked at");
            CHECK((s.history[2].ringing == 1) == (left < 2), "after both none");
            if (left == 2)
                continue;
            CHECK(!strcmp(s.history[2].changed_to, left ? "gauss3" : "radau3"), "to %s", s.history[2].changed_to);
            CHECK(!strcmp(c->before.scheme, left ? "radau5" : solution->settings.scheme), "from %s", c->before.scheme);
            check_meshes(&s, all[k] > 3 ? all[k] / PHASES : 1, left ? MORAY_GAUSS : MORAY_RADAU);
        }
}

// ---- Equations ----

static void check_equation(const struct asked *asked, int own, moray_family family, int equation)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, asked);
    struct state s;
    struct campaign *c = campaign(&s, ocp, 1);
    moray_mesh_record *kept = solution->history;
    bool changed = equation == 0;
    c->method.family = family;
    if (own >= 0)
        s.own[own] = (struct method){MORAY_GAUSS, 2};
    CHECK_OK(moray_leave_higher_index(c, solution, &changed), "looked at");
    CHECK(changed == (equation > 0), "%s", changed ? "changed" : "not changed");
    if (changed) {
        CHECK(c->tried == 2 && s.history[1].equation == equation && !strcmp(s.history[1].changed_to, "radau3"),
              "for equation %d, expected %d", s.history[1].equation, equation);
        CHECK(isnan(s.history[1].error) && s.history[1].dependences == 0, "of a mesh that was not solved");
        CHECK(c->left[MORAY_LOBATTO] && c->before.nodes == s.history[1].nodes, "what was before is noted");
        check_meshes(&s, 7, MORAY_RADAU);
    }
    solution->history = kept;
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_equations(void)
{
    const struct asked none = {{false}, {false}}, states = {.first = {false, false, true}}, mixed = {.first = {true}},
                       of_controls = {.first = {false, true}}, of_time = {.second = {true}},
                       later = {.first = {true, true}, .second = {true, true}};
    check_equation(&none, -1, MORAY_LOBATTO, 0);
    check_equation(&states, -1, MORAY_LOBATTO, 3);
    check_equation(&states, 0, MORAY_LOBATTO, 0);
    check_equation(&states, 1, MORAY_LOBATTO, 3);
    check_equation(&states, -1, MORAY_RADAU, 0);
    check_equation(&mixed, -1, MORAY_LOBATTO, 0);
    check_equation(&of_controls, -1, MORAY_LOBATTO, 0);
    check_equation(&of_time, -1, MORAY_LOBATTO, 0);
    check_equation(&later, -1, MORAY_LOBATTO, equations[0] + 2);
    check_equation(&later, 1, MORAY_LOBATTO, 0);
}

int main(void)
{
    const struct asked none = {{false}, {false}};
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp, &none);
    test_ringing(ocp, solution);
    test_first(solution);
    memset(solution->iterate.x, 0, (size_t)solution->transcription->nlp.n * sizeof(double));
    test_next(ocp, solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    test_equations();
    return tap_done();
}
