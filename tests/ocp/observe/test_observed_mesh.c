// SPDX-License-Identifier: MIT
//
// The edges that a mesh gets where something is observed, against meshes written by hand.
#include "tap.h"

#include <string.h>

#include "ocp/observe/observed.h"

static void test_observed_at(void)
{
    double time[] = {2.5, 3, 1, 5};
    struct phase phase = {.t0 = moray_fixed(1), .tf = moray_fixed(5), .observed = {.n = 3, .time = time}};
    const double tau[] = {0.375, 0.5, 0};
    for (int k = 0; k < 3; k++) {
        CHECK(moray_is_observed_at(&phase, tau[k] + 0.9e-9) && moray_is_observed_at(&phase, tau[k] - 0.9e-9),
              "observed about %g", tau[k]);
        CHECK(!moray_is_observed_at(&phase, tau[k] + 1.1e-9) && !moray_is_observed_at(&phase, tau[k] - 1.1e-9),
              "but not far from %g", tau[k]);
    }
    CHECK(moray_is_observed_at(&phase, 1e-9), "on the limit, too");
    CHECK(!moray_is_observed_at(&phase, 1), "the fourth time is none of three");
    phase.tf = moray_between(5, 6);
    CHECK(!moray_is_observed_at(&phase, 0), "nowhere, where data move");
}

enum { most_edges = 9 };

// A mesh before, data in a phase from 2 to 10, by their place in it, and the mesh afterwards: edges, and of its
// intervals those before that they come from.
struct cut {
    const char *what;
    int intervals, data, after;
    double edge[most_edges], tau[most_edges], cut[most_edges];
    int from[most_edges];
    const double *given; // the user's mesh of two intervals, or NULL
    bool held;           // with controls held over two halves or those
};

static void test_cut(const struct cut *c)
{
    struct mesh mesh;
    double time[most_edges], given[3];
    int held[] = {0}, right = 0;
    for (int k = 0; k < c->data; k++)
        time[k] = 2 + 8 * c->tau[k];
    struct phase phase = {.t0 = moray_fixed(2),
                          .tf = moray_fixed(10),
                          .observed = {.n = c->data, .time = time},
                          .intervals = 2,
                          .held = held,
                          .n_held = c->held};
    if (c->given)
        phase.mesh = memcpy(given, c->given, sizeof given);
    CHECK_OK(moray_mesh_of(&mesh, c->edge, c->intervals, (struct method){MORAY_RADAU, 3}), "mesh");
    for (int k = 0; k < c->intervals; k++)
        mesh.stages[k] = 2 + k, mesh.raised_from[k] = 0.5 + k, mesh.past[k] = (enum mesh_past)(k % 3);
    CHECK_OK(moray_cut_at_observations(&mesh, &phase), "cut");
    for (int k = 0; k < c->after && k < mesh.intervals; k++)
        right += mesh.edge[k] == c->cut[k] && mesh.edge[k + 1] == c->cut[k + 1] && mesh.stages[k] == 2 + c->from[k] &&
                 mesh.raised_from[k] == 0.5 + c->from[k] && mesh.past[k] == (enum mesh_past)(c->from[k] % 3);
    CHECK(mesh.intervals == c->after && right == c->after && mesh.method.family == MORAY_RADAU &&
              mesh.method.stages == 3,
          "%s: %d intervals, %d as they should be of %d", c->what, mesh.intervals, right, c->after);
    moray_mesh_free(&mesh);
}

static const double near_edge[] = {0, 0.25 + 0x1p-31, 1}, far_edge[] = {0, 0.25 + 0x1p-29, 1};
static const struct cut cuts[] = {
    {"no data", 3, 0, 3, {0, 0.25, 0.75, 1}, {0}, {0, 0.25, 0.75, 1}, {0, 1, 2}, NULL, false},
    {"in the middle", 3, 1, 4, {0, 0.25, 0.75, 1}, {0.5}, {0, 0.25, 0.5, 0.75, 1}, {0, 1, 1, 2}, NULL, false},
    {"in the first", 3, 1, 4, {0, 0.25, 0.75, 1}, {0.125}, {0, 0.125, 0.25, 0.75, 1}, {0, 0, 1, 2}, NULL, false},
    {"in the last", 3, 1, 4, {0, 0.25, 0.75, 1}, {0.875}, {0, 0.25, 0.75, 0.875, 1}, {0, 1, 2, 2}, NULL, false},
    {"behind an edge", 3, 1, 3, {0, 0.25, 0.75, 1}, {0.3125}, {0, 0.3125, 0.75, 1}, {0, 1, 2}, NULL, false},
    {"before an edge", 3, 1, 3, {0, 0.25, 0.75, 1}, {0.6875}, {0, 0.25, 0.6875, 1}, {0, 1, 2}, NULL, false},
    {"a quarter behind it", 3, 1, 4, {0, 0.25, 0.75, 1}, {0.375}, {0, 0.25, 0.375, 0.75, 1}, {0, 1, 1, 2}, NULL, false},
    {"a quarter before it", 3, 1, 4, {0, 0.25, 0.75, 1}, {0.625}, {0, 0.25, 0.625, 0.75, 1}, {0, 1, 1, 2}, NULL, false},
    {"near the ends, which stay",
     3,
     2,
     5,
     {0, 0.25, 0.75, 1},
     {0.984375, 0.015625},
     {0, 0.015625, 0.25, 0.75, 0.984375, 1},
     {0, 0, 1, 2, 2},
     NULL,
     false},
    {"on edges and ends, or all but",
     3,
     6,
     3,
     {0, 0.25, 0.75, 1},
     {0, 0.25, 0.25 + 0x1p-31, 0.75 - 0x1p-31, 1 - 0x1p-31, 1},
     {0, 0.25, 0.75, 1},
     {0, 1, 2},
     NULL,
     false},
    {"beside an edge, which moves by little",
     3,
     2,
     3,
     {0, 0.25, 0.75, 1},
     {0.25 + 0x1p-29, 0.75 - 0x1p-29},
     {0, 0.25 + 0x1p-29, 0.75 - 0x1p-29, 1},
     {0, 1, 2},
     NULL,
     false},
    {"behind an edge that is of another datum",
     3,
     2,
     4,
     {0, 0.25, 0.75, 1},
     {0.3125, 0.34375},
     {0, 0.3125, 0.34375, 0.75, 1},
     {0, 1, 1, 2},
     NULL,
     false},
    {"behind the user's edge",
     3,
     1,
     4,
     {0, 0.25, 0.75, 1},
     {0.3125},
     {0, 0.25, 0.3125, 0.75, 1},
     {0, 1, 1, 2},
     near_edge,
     false},
    {"behind an edge that is not the user's",
     3,
     2,
     3,
     {0, 0.25, 0.75, 1},
     {0.3125, 0.6875},
     {0, 0.3125, 0.6875, 1},
     {0, 1, 2},
     far_edge,
     false},
    {"before an edge that is the user's last",
     3,
     1,
     4,
     {0, 0.5, 1 - 0x1p-31, 1},
     {0.9375},
     {0, 0.5, 0.9375, 1 - 0x1p-31, 1},
     {0, 1, 1, 2},
     far_edge,
     false},
    {"where controls are held",
     4,
     2,
     5,
     {0, 0.25, 0.5, 0.75, 1},
     {0.53125, 0.78125},
     {0, 0.25, 0.5, 0.53125, 0.78125, 1},
     {0, 1, 2, 2, 3},
     NULL,
     true},
    {"four in one interval",
     1,
     4,
     5,
     {0, 1},
     {0.5, 0.375, 0.75, 0.625},
     {0, 0.375, 0.5, 0.625, 0.75, 1},
     {0, 0, 0, 0, 0},
     NULL,
     false},
};

static void test_cuts(void)
{
    for (size_t k = 0; k < sizeof cuts / sizeof *cuts; k++)
        test_cut(&cuts[k]);
}

// Edges exactly 1e-9 from a datum on either side, of a mesh about 0 where that can be said without rounding.
static void test_limit(void)
{
    static const double edge[] = {-1, 0, 1}, shifted[] = {-1, 1e-9, 1};
    double time[] = {-1e-9, 1e-9, 0.125}, given[3];
    struct phase phase = {
        .t0 = moray_fixed(0), .tf = moray_fixed(1), .intervals = 2, .observed = {.n = 2, .time = time}};
    struct mesh mesh;
    CHECK_OK(moray_mesh_of(&mesh, edge, 2, (struct method){MORAY_RADAU, 3}), "mesh");
    CHECK_OK(moray_cut_at_observations(&mesh, &phase), "cut");
    CHECK(mesh.intervals == 2 && mesh.edge[1] == 0, "the datum has its edge");
    phase.mesh = memcpy(given, shifted, sizeof given);
    phase.observed.n = 1, time[0] = 0.125;
    CHECK_OK(moray_cut_at_observations(&mesh, &phase), "cut");
    CHECK(mesh.intervals == 3 && mesh.edge[1] == 0 && mesh.edge[2] == 0.125, "the user's edge stays");
    moray_mesh_free(&mesh);
}

static void test_moving(void)
{
    double time[] = {2.5};
    const struct phase phase = {.t0 = moray_fixed(2), .tf = moray_between(3, 4), .observed = {.n = 1, .time = time}};
    struct mesh mesh;
    CHECK_OK(moray_mesh_uniform(&mesh, 3, (struct method){MORAY_RADAU, 3}), "mesh");
    CHECK_OK(moray_cut_at_observations(&mesh, &phase), "no cut");
    CHECK(mesh.intervals == 3, "where data move the mesh stays");
    moray_mesh_free(&mesh);
}

// Nodes in the middle of intervals are none of data.
static void test_node(void)
{
    double time[] = {6, 2, 10, 4};
    struct phase legs[] = {
        {.t0 = moray_fixed(0), .tf = moray_fixed(1)},
        {.nx = 1, .t0 = moray_fixed(2), .tf = moray_fixed(10), .observed = {.n = 4, .ny = 1, .time = time}}};
    struct node node[] = {{.tau = 0},   {.tau = 0.125}, {.tau = 0.25}, {.tau = 0.3},
                          {.tau = 0.4}, {.tau = 0.5},   {.tau = 0.75}, {.tau = 1}};
    struct interval interval[] = {{.first = 0}, {.first = 2}, {.first = 5}};
    struct phase_layout phase[] = {{.nodes = 0},
                                   {.mesh = {.intervals = 3}, .nodes = 8, .node = node, .interval = interval}};
    const struct layout layout = {.phases = 2, .phase = phase};
    const moray_ocp ocp = {.phases = 2, .phase = legs};
    static const int want[] = {5, 0, 7, 2};
    for (int k = 0; k < 4; k++)
        CHECK(moray_observed_node(&layout, &ocp, 1, k) == &node[want[k]], "t = %g at node %d", time[k], want[k]);
    node[2].tau = 0.5 - 0x1p-31, node[5].tau = 0.5 + 0x1p-31;
    CHECK(moray_observed_node(&layout, &ocp, 1, 0) == &node[2], "of two edges that are as near the first");
}

int main(void)
{
    test_observed_at();
    test_cuts();
    test_limit();
    test_moving();
    test_node();
    return tap_done();
}
