// SPDX-License-Identifier: MIT
//
// Solves the textbook problems and sets the optimum beside what is published.
//   classics [name [scheme [intervals]]]
#include <stdio.h>
#include <stdlib.h>

#include "classics/classics.h"
#include "moray/sim.h"

static bool row(const struct classic *classic, int argc, char **argv)
{
    struct classic_result result;
    char diagnosis[600];
    moray_settings settings = classic_settings(classic);
    const moray_sim_settings sim_settings = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&sim_settings);
    if (argc > 2)
        settings.scheme = argv[2];
    if (argc > 3)
        settings.intervals = atoi(argv[3]);
    if (argc > 4)
        settings.tolerance = atof(argv[4]);
    if (argc > 5)
        settings.max_refinements = atoi(argv[5]);
    if (argc > 6)
        settings.print_level = atoi(argv[6]);
    const moray_status status =
        classic_solve(classic, &settings, &integrator, &result, diagnosis, (int)sizeof diagnosis);
    if (moray_failed(status)) {
        printf("%-22s %s\n", classic->name, status.text);
        return false;
    }
    const moray_certificate *c = &result.certificate;
    printf(
        "%-22s %14.10g %11s %9.1e %-7s %2d meshes %4d intervals %4d it %6.2f s  KKT %.0e mesh %.0e between %.0e re-sim "
        "%.0e %s\n",
        classic->name, result.value, classic->published, result.difference,
        !result.agrees      ? "DIFFERS"
        : classic->computed ? "agrees*"
                            : "agrees",
        result.meshes, result.intervals, result.iterations, result.seconds, c->kkt, c->mesh_error, c->between_nodes,
        c->resimulation,
        c->pass               ? "certified"
        : classic->fixed_mesh ? "(mesh as published)"
                              : "NOT CERTIFIED");
    if (result.outcome != MORAY_NLP_SOLVED)
        printf("%s", diagnosis);
    fflush(stdout);
    return result.agrees;
}

int main(int argc, char **argv)
{
    bool all = true;
    if (argc > 1) {
        const struct classic *classic = classic_find(argv[1]);
        if (!classic) {
            fprintf(stderr, "no problem %s\n", argv[1]);
            return 2;
        }
        return row(classic, argc, argv) ? 0 : 1;
    }
    for (const struct classic *const *c = classics; *c; c++)
        all = row(*c, argc, argv) && all;
    return all ? 0 : 1;
}
