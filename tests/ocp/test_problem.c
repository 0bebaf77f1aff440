// SPDX-License-Identifier: MIT
//
// A problem as its spec becomes one: bounds, durations, meshes and names as they are taken over, whole texts of what is
// refused, and what a restart changes.
#include "tap.h"

#include <string.h>

#include "ocp/problem.h"

#define ENDLESS MORAY_INFINITY

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    for (int i = 0; i < 2; i++)
        out->f[i] = at->u[i];
    out->c[0] = at->x[0];
    out->g[0] = at->x[1];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
    out->e[0] = at->phase[0].x0[1];
}

static const moray_bounds any_two[] = {{-ENDLESS, ENDLESS}, {-ENDLESS, ENDLESS}};
static const moray_phase_spec usual = {
    .name = "leg", .nx = 2, .nu = 2, .nc = 1, .nq = 1, .continuous = go, .t0 = {0, 2}, .tf = {4, 9}, .c = {any_two, 1}};

static moray_ocp_spec spec_of(const moray_phase_spec *phase, int phases)
{
    return (moray_ocp_spec){
        .name = "task", .phases = phases, .phase = phase, .ne = 1, .e = {any_two, 1}, .endpoint = verdict};
}

static moray_ocp *make(const moray_phase_spec *phase, int phases)
{
    moray_ocp *ocp = NULL;
    const moray_ocp_spec spec = spec_of(phase, phases);
    CHECK_OK(moray_ocp_new(&ocp, &spec), "problem");
    return ocp;
}

static void spec_refused(moray_ocp_spec spec, const char *text)
{
    moray_ocp *ocp;
    const moray_status status = moray_ocp_new(&ocp, &spec);
    CHECK(status.code == MORAY_INPUT && !ocp && strcmp(status.text, text) == 0, "%s", status.text);
}

// As the second of two.
static void refused(moray_phase_spec phase, const char *text)
{
    moray_phase_spec both[] = {usual, phase};
    both[0].name = "before";
    spec_refused(spec_of(both, 2), text);
}

static bool same(moray_bounds b, double lower, double upper)
{
    return b.lower == lower && b.upper == upper;
}

// ---- Bounds ----

static void test_middles(void)
{
    static const struct {
        moray_bounds bounds;
        double middle;
    } cases[] = {
        {{-2, 6}, 2},   {{-ENDLESS, 3}, 3}, {{-1e15, 3}, 3},    {{-0.9e15, 3}, -0.45e15 + 1.5}, {{2, ENDLESS}, 2},
        {{2, 1e15}, 2}, {{-1e16, 1e17}, 0}, {{-1e15, 1e15}, 0}, {{-ENDLESS, ENDLESS}, 0},       {{1e16, 1e17}, 1e16},
        {{-7, -7}, -7}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        CHECK(moray_bounds_middle(cases[k].bounds) == cases[k].middle, "of [%g, %g]: %g", cases[k].bounds.lower,
              cases[k].bounds.upper, moray_bounds_middle(cases[k].bounds));
    CHECK(moray_bounds_are_fixed(moray_fixed(3)) && !moray_bounds_are_fixed(moray_between(3, 4)), "fixed or not");
}

static void test_ends(void)
{
    const moray_bounds x[] = {{-3, 5}, {0, 8}}, x0[] = {{-9, 2}, {1, 3}}, xf[] = {{4, 9}, {8, 8}},
                       u[] = {{1, 2}, {-6, 6}}, u0[] = {{0, 1}, {-5, 7}}, uf[] = {{2, 2}, {-8, -6}};
    moray_phase_spec phase = usual;
    phase.x = (moray_bounds_list){x, 2}, phase.x0 = (moray_bounds_list){x0, 2}, phase.xf = (moray_bounds_list){xf, 2};
    phase.u = (moray_bounds_list){u, 2}, phase.u0 = (moray_bounds_list){u0, 2}, phase.uf = (moray_bounds_list){uf, 2};
    moray_ocp *ocp = make(&phase, 1);
    const struct phase *p = &ocp->phase[0];
    CHECK(same(p->x[0], -3, 5) && same(p->x[1], 0, 8) && same(p->u[0], 1, 2) && same(p->u[1], -6, 6), "as given");
    CHECK(same(p->x0[0], -3, 2) && same(p->x0[1], 1, 3), "the first state within those of all states");
    CHECK(same(p->xf[0], 4, 5) && same(p->xf[1], 8, 8), "the last too");
    CHECK(same(p->u0[0], 1, 1) && same(p->u0[1], -5, 6), "the first control");
    CHECK(same(p->uf[0], 2, 2) && same(p->uf[1], -6, -6), "the last");
    CHECK(same(p->q[0], -ENDLESS, ENDLESS) && p->bounds_end_controls && !p->end_controls, "what is not given is free");
    moray_ocp_free(ocp);
    const moray_bounds away[] = {{1, 3}, {8.5, 9}};
    moray_phase_spec wrong = phase;
    wrong.x0 = (moray_bounds_list){away, 2};
    refused(wrong, "x0[1] of leg: [8.5, 9] does not meet the bounds [0, 8] of x");
    wrong = phase, wrong.xf = (moray_bounds_list){away, 2};
    refused(wrong, "xf[1] of leg: [8.5, 9] does not meet the bounds [0, 8] of x");
    wrong = phase, wrong.u0 = (moray_bounds_list){away, 2};
    refused(wrong, "u0[1] of leg: [8.5, 9] does not meet the bounds [-6, 6] of u");
    wrong = phase, wrong.uf = (moray_bounds_list){away, 2};
    refused(wrong, "uf[1] of leg: [8.5, 9] does not meet the bounds [-6, 6] of u");
}

static void test_lists(void)
{
    static const char *const names[] = {"way", "speed"};
    const moray_bounds back[] = {{0, 1}, {2, -3}}, undefined[] = {{0, 1}, {0, NAN}}, low[] = {{NAN, 1}};
    moray_phase_spec phase = usual;
    phase.x = (moray_bounds_list){back, 2};
    refused(phase, "x[1] of leg: lower bound 2 is above upper bound -3");
    phase.x_names = names;
    refused(phase, "x[1] speed of leg: lower bound 2 is above upper bound -3");
    phase = usual, phase.u = (moray_bounds_list){undefined, 2};
    refused(phase, "u[1] of leg: a bound is not a number");
    phase = usual, phase.c = (moray_bounds_list){low, 1};
    refused(phase, "c[0] of leg: a bound is not a number");
    phase = usual, phase.q = (moray_bounds_list){back, 2};
    refused(phase, "q of leg: 2 bounds given, 1 needed");
    phase = usual, phase.u0 = (moray_bounds_list){back, 1};
    refused(phase, "u0 of leg: 1 bounds given, 2 needed");
    phase = usual, phase.c.n = 0;
    refused(phase, "c of leg: 0 bounds given, 1 needed");
    phase = usual, phase.t0 = moray_fixed(NAN);
    refused(phase, "t0[0] of leg: a bound is not a number");
    phase = usual, phase.tf = moray_between(9, 8);
    refused(phase, "tf[0] of leg: lower bound 9 is above upper bound 8");
    phase = usual, phase.t0 = phase.tf = moray_fixed(4);
    moray_ocp_free(make(&phase, 1)); // of no length, if need be
}

static void test_counts(void)
{
    const moray_map map = {.n_in = 5, .n_out = 4}, less = {.n_in = 5, .n_out = 3};
    moray_phase_spec phase = usual;
    phase.nx = 0, refused(phase, "phase leg: nx 0, nu 2, nc 1, nq 1; nx must be positive, none negative");
    phase = usual, phase.nu = -1;
    refused(phase, "phase leg: nx 2, nu -1, nc 1, nq 1; nx must be positive, none negative");
    phase = usual, phase.nc = -1;
    refused(phase, "phase leg: nx 2, nu 2, nc -1, nq 1; nx must be positive, none negative");
    phase = usual, phase.nq = -1;
    refused(phase, "phase leg: nx 2, nu 2, nc 1, nq -1; nx must be positive, none negative");
    phase = usual, phase.continuous = NULL;
    refused(phase, "phase leg: needs a continuous function or a map, and only one");
    phase.map = &less;
    refused(phase, "phase leg: the map has 5 inputs and 3 outputs, the phase 5 and 4");
    phase = usual, phase.map = &map;
    refused(phase, "phase leg: needs a continuous function or a map, and only one");
    moray_ocp_spec spec = spec_of(&usual, 1);
    spec.ns = -1, spec_refused(spec, "problem task: 1 phases, ns -1, ne 1; there must be a phase, none negative");
    spec.ns = 0, spec.ne = -1;
    spec_refused(spec, "problem task: 1 phases, ns 0, ne -1; there must be a phase, none negative");
    spec = spec_of(&usual, 0);
    spec_refused(spec, "problem task: 0 phases, ns 0, ne 1; there must be a phase, none negative");
    const moray_map ends = {.n_in = 7, .n_out = 3};
    spec = spec_of(&usual, 1), spec.endpoint_map = &ends;
    spec_refused(spec, "problem task: needs an endpoint function or a map, and only one");
    spec.endpoint = NULL;
    spec_refused(spec, "problem task: the endpoint map has 7 inputs and 3 outputs, needs 7 and 2");
}

// ---- Durations ----

static const struct length {
    moray_bounds t0, tf, duration, has[3]; // what t0, tf and the duration are then
} lengths[] = {
    {{0, 10}, {8, 8}, {2, 5}, {{3, 6}, {8, 8}, {2, 5}}},
    {{4, 5}, {8, 8}, {2, 5}, {{4, 5}, {8, 8}, {2, 5}}},
    {{-ENDLESS, 4}, {8, 8}, {3, 5}, {{3, 4}, {8, 8}, {3, 5}}},
    {{1, 1}, {2, 20}, {3, 7}, {{1, 1}, {4, 8}, {3, 7}}},
    {{-1, -1}, {4, 5}, {3, 7}, {{-1, -1}, {4, 5}, {3, 7}}},
    {{1, 1}, {0, 20}, {-3, 5}, {{1, 1}, {1, 6}, {0, 5}}},
    {{1, 1}, {4, 4}, {2, 5}, {{1, 1}, {4, 4}, {2, 5}}},
    // as long as rounding lets it be, which the end does not lead back to the start by
    {{0.89, 0.89}, {3.05, 3.05}, {3.05 - 0.89, 3.05 - 0.89}, {{0.89, 0.89}, {3.05, 3.05}, {3.05 - 0.89, 3.05 - 0.89}}},
    {{0.46, 0.46}, {3.3, 3.3}, {3.3 - 0.46, 3.3 - 0.46}, {{0.46, 0.46}, {3.3, 3.3}, {3.3 - 0.46, 3.3 - 0.46}}},
    {{0, 3}, {2, 9}, {1, 5}, {{0, 3}, {2, 9}, {1, 5}}},
    {{0, 1}, {2, 3}, {3, 9}, {{0, 1}, {2, 3}, {3, 9}}},     // just meets
    {{0, 1}, {2, 3}, {0.5, 1}, {{0, 1}, {2, 3}, {0.5, 1}}}, // just meets
    {{0, 1}, {0, 9}, {-2, 0}, {{0, 1}, {0, 9}, {0, 0}}},
    {{0, 1}, {0, 9}, {0, 4}, {{0, 1}, {0, 9}, {0, 4}}},
};

static void test_lengths(void)
{
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        moray_phase_spec phase = usual;
        phase.t0 = lengths[k].t0, phase.tf = lengths[k].tf, phase.duration = lengths[k].duration;
        moray_ocp *ocp = make(&phase, 1);
        const moray_bounds *has = lengths[k].has, got[] = {ocp->phase[0].t0, ocp->phase[0].tf, ocp->phase[0].duration};
        for (int i = 0; i < 3; i++)
            CHECK(same(got[i], has[i].lower, has[i].upper), "case %zu, %d: [%g, %g]", k, i, got[i].lower, got[i].upper);
        CHECK(ocp->phase[0].has_duration, "case %zu: it has a duration", k);
        moray_ocp_free(ocp);
    }
    moray_ocp *ocp = make(&usual, 1);
    CHECK(!ocp->phase[0].has_duration && same(ocp->phase[0].duration, 0, ENDLESS), "none: any, forwards");
    moray_ocp_free(ocp);
    moray_phase_spec phase = usual;
    phase.t0 = moray_between(0, 1), phase.tf = moray_between(2, 3), phase.duration = moray_between(3.5, 9);
    refused(phase, "phase leg: duration in [3.5, 9] does not meet t0 in [0, 1] and tf in [2, 3]");
    phase.duration = moray_between(0.25, 0.5);
    refused(phase, "phase leg: duration in [0.25, 0.5] does not meet t0 in [0, 1] and tf in [2, 3]");
    phase.duration = moray_between(-2, -0.5);
    refused(phase, "phase leg: duration of at most -0.5: must not be negative");
    phase.duration = moray_between(2, 1);
    refused(phase, "duration[0] of leg: lower bound 2 is above upper bound 1");
    phase = usual, phase.t0 = moray_between(5, 6), phase.tf = moray_between(3, 4);
    refused(phase, "phase leg: ends by 4, before it may begin at 5");
}

// ---- Meshes, holds, names ----

static void test_meshes(void)
{
    double mesh[] = {0, 0.125, 0.5, 1};
    const bool held[] = {false, true};
    moray_phase_spec phase = usual;
    phase.mesh = mesh, phase.intervals = 3, phase.held = held, phase.scheme = "radau3";
    moray_ocp *ocp = make(&phase, 1);
    for (int k = 0; k < 4; k++)
        CHECK(ocp->phase[0].mesh[k] == mesh[k] && ocp->phase[0].mesh != mesh, "edge %d is copied", k);
    CHECK(ocp->phase[0].intervals == 3 && ocp->phase[0].n_held == 1 && ocp->phase[0].held[0] == 1, "one is held");
    CHECK(ocp->phase[0].method.family == MORAY_RADAU && ocp->phase[0].method.stages == 3, "a scheme of its own");
    moray_ocp_free(ocp);
    mesh[3] = 0.75, refused(phase, "phase leg: the mesh goes from 0 to 0.75: must be 0 to 1");
    mesh[3] = 1, mesh[0] = 0.0625, refused(phase, "phase leg: the mesh goes from 0.0625 to 1: must be 0 to 1");
    mesh[0] = 0, mesh[1] = 0.5, refused(phase, "phase leg: mesh[2] = 0.5 after 0.5: must ascend");
    mesh[1] = NAN, refused(phase, "phase leg: mesh[1] = nan after 0: must ascend");
    phase.intervals = 0, refused(phase, "phase leg: a mesh of 0 intervals");
    phase.mesh = NULL, phase.intervals = -2, refused(phase, "phase leg: a mesh of -2 intervals");
    phase.intervals = 0;
    refused(phase, "phase leg: holds controls over its own intervals, and gives neither intervals nor a mesh");
    phase = usual, phase.scheme = "euler";
    moray_phase_spec both[] = {usual, phase};
    both[0].name = "before";
    moray_ocp *none;
    const moray_ocp_spec spec = spec_of(both, 2);
    const moray_status status = moray_ocp_new(&none, &spec);
    CHECK(status.code == MORAY_INPUT && strncmp(status.text, "phase leg: ", 11) == 0 && strstr(status.text, "euler"),
          "%s", status.text);
}

static void test_names(void)
{
    const char *x[] = {"way", "speed"}, *u[] = {"push", "turn"}, *c[] = {"near"}, *e[] = {"meet"};
    moray_phase_spec phase[] = {usual, usual};
    phase[0].name = phase[1].name = NULL;
    phase[1].x_names = x, phase[1].u_names = u, phase[1].c_names = c;
    moray_ocp_spec spec = spec_of(phase, 2);
    spec.e_names = e, spec.name = NULL;
    moray_ocp *ocp = NULL, *single;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "names");
    const struct phase *p = &ocp->phase[1];
    x[1] = u[0] = c[0] = e[0] = "gone";
    CHECK(strcmp(p->x_names[0], "way") == 0 && strcmp(p->x_names[1], "speed") == 0 &&
              strcmp(p->u_names[0], "push") == 0 && strcmp(p->u_names[1], "turn") == 0 &&
              strcmp(p->c_names[0], "near") == 0 && strcmp(ocp->e_names[0], "meet") == 0,
          "are copied");
    CHECK(!ocp->phase[0].x_names && strcmp(ocp->name, "problem") == 0, "or there are none");
    CHECK(strcmp(ocp->phase[0].name, "1") == 0 && strcmp(p->name, "2") == 0, "several phases have numbers");
    int nx, nu;
    moray_ocp_widths(ocp, 1, &nx, &nu);
    CHECK(moray_ocp_phases(ocp) == 2 && nx == 2 && nu == 2, "widths");
    moray_ocp_free(ocp);
    single = make(phase, 1);
    CHECK(strcmp(single->phase[0].name, "phase") == 0, "one has none");
    moray_ocp_free(single);
}

// ---- Observations ----

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0], y[1] = at->x[1];
}

static void test_observations(void)
{
    const char *names[] = {"radar", "eye"};
    double time[] = {3, 2.5, 3.5}, value[] = {1, 2, 3, NAN, 5, 6}, weight[] = {4, 0.5};
    moray_bounds residual[] = {{-1, 2}, {-3, 4}};
    const moray_observations plain = {.n = 3, .ny = 2, .time = time, .value = value, .observe = see};
    moray_phase_spec phase[] = {usual, usual};
    phase[0].name = "before", phase[0].observed = phase[1].observed = plain;
    moray_observations *full = &phase[1].observed;
    full->names = names, full->weight = weight, full->residual = (moray_bounds_list){residual, 2};
    full->loss = MORAY_HUBER, full->threshold = 1.5, full->sum = moray_between(0, 7), full->events_only = true;
    moray_ocp *ocp = make(phase, 2);
    const struct observed *one = &ocp->phase[0].observed, *other = &ocp->phase[1].observed;
    time[1] = value[2] = value[5] = weight[1] = 77, names[1] = "gone", residual[1] = moray_fixed(77);
    CHECK(one->n == 3 && one->ny == 2 && one->time[1] == 2.5 && one->time[2] == 3.5 && one->value[2] == 3 &&
              one->value[5] == 6 && isnan(one->value[3]),
          "times and values are copied");
    CHECK(one->weight[0] == 1 && one->weight[1] == 1 && !one->names && !one->residual && !one->has_sum &&
              !one->events_only && one->loss == MORAY_LEAST_SQUARES,
          "the rest is as usual");
    CHECK(other->weight[0] == 4 && other->weight[1] == 0.5 && strcmp(other->names[1], "eye") == 0 &&
              same(other->residual[0], -1, 2) && same(other->residual[1], -3, 4) && other->has_sum &&
              same(other->sum, 0, 7) && other->events_only && other->loss == MORAY_HUBER && other->threshold == 1.5,
          "or as given");
    moray_ocp_free(ocp);
    time[1] = 2.5, names[1] = "eye", residual[1] = moray_between(4, -3);
    refused(phase[1], "residual[1] eye of leg: lower bound 4 is above upper bound -3");
    residual[1] = moray_free(), full->sum = moray_between(-2, 0);
    ocp = make(phase, 2);
    CHECK(ocp->phase[1].observed.has_sum && same(ocp->phase[1].observed.sum, -2, 0), "bounds with one that is 0");
    moray_ocp_free(ocp);
    full->sum = moray_between(3, 2);
    refused(phase[1], "sum of observations[0] of leg: lower bound 3 is above upper bound 2");
    full->sum = moray_between(0, 7), full->residual.n = 1;
    refused(phase[1], "residual of leg: 1 bounds given, 2 needed");
}

// ---- Restart ----

static void restart_refused(moray_ocp *ocp, double t, double length, double second, const char *text)
{
    const double x[] = {1, second};
    const moray_status status = moray_ocp_restart(ocp, t, length, x);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "%s", status.text);
    CHECK(same(ocp->phase[0].t0, 0, 2) && same(ocp->phase[0].tf, 4, 9) && same(ocp->phase[0].x0[0], -ENDLESS, ENDLESS),
          "nothing has changed");
}

static void test_restart(void)
{
    moray_ocp *ocp = make(&usual, 1);
    const double x[] = {7, -8};
    restart_refused(ocp, INFINITY, 1, 2,
                    "problem task: start at inf, length 1: must be finite, the length not negative");
    restart_refused(ocp, 1, -1, 2, "problem task: start at 1, length -1: must be finite, the length not negative");
    restart_refused(ocp, 1, NAN, 2, "problem task: start at 1, length nan: must be finite, the length not negative");
    restart_refused(ocp, 1, INFINITY, 2,
                    "problem task: start at 1, length inf: must be finite, the length not negative");
    restart_refused(ocp, 1, 1, NAN, "problem task: start of x[1] is not finite");
    restart_refused(ocp, 9.5, 0, 2, "problem task: ends by 9, before its start at 9.5");
    CHECK_OK(moray_ocp_restart(ocp, 9, 0, x), "as late as may be");
    CHECK(same(ocp->phase[0].t0, 9, 9) && same(ocp->phase[0].tf, 4, 9), "the end is left");
    CHECK(same(ocp->phase[0].x0[0], 7, 7) && same(ocp->phase[0].x0[1], -8, -8), "from this state");
    CHECK_OK(moray_ocp_restart(ocp, 10, 0.5, x), "for a time");
    CHECK(same(ocp->phase[0].t0, 10, 10) && same(ocp->phase[0].tf, 10.5, 10.5), "the end moves with the start");
    moray_ocp_free(ocp);
}

int main(void)
{
    test_middles();
    test_ends();
    test_lists();
    test_counts();
    test_lengths();
    test_meshes();
    test_names();
    test_observations();
    test_restart();
    return tap_done();
}
