// SPDX-License-Identifier: MIT
//
// User functions as maps: what stands where among inputs and outputs, in complex and in real numbers, of two phases of
// different sizes; and functions that are finite at a late one of the points that are tried alone, or at none.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "ocp/probe.h"

enum { phases = 2, ns = 2, most = 40 };
static const int nx[phases] = {2, 1}, nu[phases] = {1, 3}, nc[phases] = {1, 2}, nq[phases] = {2, 1};

// Every input weighs differently in every output: input i of a list that begins at `first`, in output j.
static double weigh(int first, int i, int j)
{
    return 1 + (first + i) * 0.5 + 0.25 * j * (first + i + 1);
}

enum {
    of_x = 0,
    of_u = 5,
    of_s = 10,
    of_t = 15,
    of_x0 = 20,
    of_t0 = 25,
    of_xf = 30,
    of_tf = 35,
    of_q = 40,
    of_u0 = 45,
    of_uf = 50,
    of_next = 40
}; // the next phase's lists begin so much later

// ---- Complex ----

static moray_num sum(const moray_num *list, int n, int first, int j)
{
    moray_num total = 0;
    for (int i = 0; i < n; i++)
        total += weigh(first, i, j) * list[i];
    return total;
}

static moray_num of_node(const moray_node *at, int p, int j)
{
    return sum(at->x, nx[p], of_x, j) + sum(at->u, nu[p], of_u, j) + sum(at->s, ns, of_s, j) +
           weigh(of_t, 0, j) * at->t;
}

static void go(const moray_node *at, moray_rates *out, int p)
{
    for (int i = 0; i < nx[p]; i++)
        out->f[i] = of_node(at, p, i);
    for (int i = 0; i < nc[p]; i++)
        out->c[i] = of_node(at, p, 3 + i);
    for (int i = 0; i < nq[p]; i++)
        out->g[i] = of_node(at, p, 6 + i);
}

static void go_first(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    go(at, out, 0);
}

static void go_second(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    go(at, out, 1);
}

static moray_num of_ends(const moray_ends *at, int j)
{
    moray_num total = sum(at->s, ns, of_s, j);
    for (int p = 0; p < phases; p++) {
        const moray_phase_ends *end = &at->phase[p];
        const int later = p * of_next;
        total += sum(end->x0, nx[p], of_x0 + later, j) + weigh(of_t0 + later, 0, j) * end->t0 +
                 sum(end->xf, nx[p], of_xf + later, j) + weigh(of_tf + later, 0, j) * end->tf +
                 sum(end->q, nq[p], of_q + later, j);
        if (end->u0)
            total += sum(end->u0, nu[p], of_u0 + later, j) + sum(end->uf, nu[p], of_uf + later, j);
    }
    return total;
}

static void close(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = of_ends(at, 0);
    for (int i = 0; i < 2; i++)
        out->e[i] = of_ends(at, 1 + i);
}

static void watch(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    for (int j = 0; j < 2; j++)
        y[j] = of_node(at, 1, 9 + j);
}

// ---- The same in real numbers ----

static double real_sum(const double *list, int n, int first, int j)
{
    double total = 0;
    for (int i = 0; i < n; i++)
        total += weigh(first, i, j) * list[i];
    return total;
}

static double of_real_node(const moray_real_node *at, int p, int j)
{
    return real_sum(at->x, nx[p], of_x, j) + real_sum(at->u, nu[p], of_u, j) + real_sum(at->s, ns, of_s, j) +
           weigh(of_t, 0, j) * at->t;
}

static void real_go_second(const moray_real_node *at, moray_real_rates *out, const void *data)
{
    (void)data;
    for (int i = 0; i < nx[1]; i++)
        out->f[i] = of_real_node(at, 1, i);
    for (int i = 0; i < nc[1]; i++)
        out->c[i] = of_real_node(at, 1, 3 + i);
    for (int i = 0; i < nq[1]; i++)
        out->g[i] = of_real_node(at, 1, 6 + i);
}

static double of_real_ends(const moray_real_ends *at, int j)
{
    double total = real_sum(at->s, ns, of_s, j);
    for (int p = 0; p < phases; p++) {
        const moray_real_phase_ends *end = &at->phase[p];
        const int later = p * of_next;
        total += real_sum(end->x0, nx[p], of_x0 + later, j) + weigh(of_t0 + later, 0, j) * end->t0 +
                 real_sum(end->xf, nx[p], of_xf + later, j) + weigh(of_tf + later, 0, j) * end->tf +
                 real_sum(end->q, nq[p], of_q + later, j);
        if (end->u0)
            total += real_sum(end->u0, nu[p], of_u0 + later, j) + real_sum(end->uf, nu[p], of_uf + later, j);
    }
    return total;
}

static void real_close(const moray_real_ends *at, moray_real_end_values *out, const void *data)
{
    (void)data;
    out->objective = of_real_ends(at, 0);
    for (int i = 0; i < 2; i++)
        out->e[i] = of_real_ends(at, 1 + i);
}

// ---- Where everything stands ----

static moray_ocp *problem(bool real, int with_controls)
{
    static const double time[] = {0.5}, value[] = {0, 0};
    const moray_bounds any[] = {moray_free(), moray_free(), moray_free()};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.nx = nx[p],
                                      .nu = nu[p],
                                      .nc = nc[p],
                                      .nq = nq[p],
                                      .continuous = p == 0 ? go_first
                                                    : real ? NULL
                                                           : go_second,
                                      .continuous_real = p && real ? real_go_second : NULL,
                                      .tf = moray_fixed(1),
                                      .c = {any, nc[p]},
                                      .end_controls = p == with_controls};
    phase[1].observed = (moray_observations){.n = 1, .ny = 2, .time = time, .value = value, .observe = watch};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = phases,
                                                   .phase = phase,
                                                   .ns = ns,
                                                   .ne = 2,
                                                   .e = {any, 2},
                                                   .endpoint = real ? NULL : close,
                                                   .endpoint_real = real ? real_close : NULL}),
             "problem");
    return ocp;
}

static double take(const double **in, int n, int first, int j)
{
    const double total = real_sum(*in, n, first, j);
    *in += n;
    return total;
}

static double node_wanted(const double *in, int p, int j)
{
    return take(&in, nx[p], of_x, j) + take(&in, nu[p], of_u, j) + take(&in, ns, of_s, j) + weigh(of_t, 0, j) * in[0];
}

static double ends_wanted(const double *in, int with_controls, int j)
{
    double total = 0;
    for (int p = 0; p < phases; p++) {
        const int later = p * of_next;
        total += take(&in, nx[p], of_x0 + later, j), total += take(&in, 1, of_t0 + later, j);
        total += take(&in, nx[p], of_xf + later, j), total += take(&in, 1, of_tf + later, j);
        total += take(&in, nq[p], of_q + later, j);
        if (p == with_controls)
            total += take(&in, nu[p], of_u0 + later, j), total += take(&in, nu[p], of_uf + later, j);
    }
    return total + take(&in, ns, of_s, j);
}

static void test_places(bool real, int with_controls)
{
    moray_ocp *ocp = problem(real, with_controls);
    double in[most], out[most];
    for (int i = 0; i < most; i++)
        in[i] = 1 + i * i % 13 + i / 16.;
    for (int p = 0; p < phases; p++) {
        const moray_map *map = ocp->phase[p].map;
        CHECK(map->n_in == nx[p] + nu[p] + ns + 1 && map->n_out == nx[p] + nc[p] + nq[p], "sizes of phase %d", p);
        map->value(map->self, in, out);
        for (int i = 0; i < map->n_out; i++) {
            const int j = i < nx[p] ? i : i < nx[p] + nc[p] ? 3 + i - nx[p] : 6 + i - nx[p] - nc[p];
            CHECK_RELATIVE(out[i], node_wanted(in, p, j), 1e-12, "an output of a phase");
        }
        CHECK(moray_phase_is_differenced(&ocp->phase[p]) == (p == 1 && real), "by differences or not");
    }
    const moray_map *seen = ocp->phase[1].observed.map, *end = ocp->endpoint->map;
    seen->value(seen->self, in, out);
    for (int j = 0; j < 2; j++)
        CHECK_RELATIVE(out[j], node_wanted(in, 1, 9 + j), 1e-12, "what is observed");
    CHECK(end->n_in == moray_endpoint_inputs(ocp) && end->n_out == 3, "sizes of the endpoint");
    end->value(end->self, in, out);
    for (int j = 0; j < 3; j++)
        CHECK_RELATIVE(out[j], ends_wanted(in, with_controls, j), 1e-12, "an output of the endpoint");
    moray_ocp_free(ocp);
}

// ---- Finite at one point of many ----

enum where { nowhere, in_phase, in_end, in_seen };
struct region {
    enum where where;
    double target;
};

static double unless_near(const void *data, enum where where, moray_num value)
{
    const struct region *region = data;
    return where == region->where && fabs(creal(value) - region->target) > 1e-3 ? NAN : 1;
}

static void narrow(const moray_node *at, moray_rates *out, const void *data)
{
    out->f[0] = at->u[0] * unless_near(data, in_phase, at->u[0]);
}

static void narrow_end(const moray_ends *at, moray_end_values *out, const void *data)
{
    out->objective = at->phase[0].xf[0] * unless_near(data, in_end, at->phase[0].xf[0]);
}

static void narrow_seen(const moray_node *at, moray_num *y, const void *data)
{
    y[0] = at->x[0] * unless_near(data, in_seen, at->u[0]);
}

static moray_status narrow_problem(moray_ocp **ocp, const struct region *region)
{
    static const double time[] = {0.5}, value[] = {0};
    const moray_phase_spec phase = {
        .name = "leg",
        .nx = 1,
        .nu = 1,
        .continuous = narrow,
        .tf = moray_fixed(1),
        .x = MORAY_BOUNDS(moray_between(-30, 20)),
        .u = MORAY_BOUNDS(moray_between(-20, 30)),
        .observed = {.n = 1, .ny = 1, .time = time, .value = value, .observe = narrow_seen}};
    return moray_ocp_new(
        ocp, &(moray_ocp_spec){.name = "task", .phases = 1, .phase = &phase, .endpoint = narrow_end, .data = region});
}

// trial: of the point at which alone a function is finite; eight are tried.
static void test_trial(enum where where, int trial)
{
    static const char *const begins[] = {"", "phase leg: output 0", "endpoint of task: output 0",
                                         "observations of phase leg: output 0"};
    struct region region = {nowhere, 0};
    moray_ocp *ocp, *again = NULL;
    double in[8];
    CHECK_OK(narrow_problem(&ocp, &region), "finite everywhere");
    if (where == in_end)
        moray_endpoint_probe(ocp, trial, in);
    else
        moray_phase_probe(ocp, &ocp->phase[0], trial, in);
    const struct region there = {where, where == in_end ? in[2] : in[1]};
    const moray_status status = narrow_problem(&again, &there);
    CHECK(trial < 8
              ? !moray_failed(status)
              : status.code == MORAY_INPUT && !again && strncmp(status.text, begins[where], strlen(begins[where])) == 0,
          "finite at point %d: %s", trial, status.text);
    moray_ocp_free(again);
    moray_ocp_free(ocp);
}

int main(void)
{
    for (int real = 0; real < 2; real++)
        for (int with_controls = -1; with_controls < phases; with_controls++)
            test_places(real, with_controls);
    for (int where = in_phase; where <= in_seen; where++)
        for (int trial = 0; trial <= 8; trial++)
            test_trial((enum where)where, trial);
    return tap_done();
}
