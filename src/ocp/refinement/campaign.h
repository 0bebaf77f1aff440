// SPDX-License-Identifier: MIT
//
// A solve, mesh after mesh: what stays between them, and the solve on one of them.
#ifndef SRC_OCP_CAMPAIGN_H
#define SRC_OCP_CAMPAIGN_H

#include "ocp/solution.h"

enum { most_escapes = 2 };   // from saddles
enum { most_restarts = 3 };  // of the first mesh: another scheme, another start, other scales
enum { most_moves = 8 };     // of data into other intervals, in all
enum { most_widenings = 8 }; // in all: each needs a place where a function depends on what it did not elsewhere

// The family that was left.
struct left_family {
    struct method method;
    const char *scheme;
    int nodes; // of its last mesh; 0: none was left, or it is back
};

struct campaign {
    const moray_ocp *ocp;
    const moray_settings *settings;
    const moray_guess *guess;   // of the user; NULL: from the bounds
    struct method method;       // of phases that have none of their own
    struct method *own;         // [phases], which stay; stages 0: none
    bool left[MORAY_GAUSS + 1]; // families that showed themselves wrong for the problem
    struct left_family before;  // the last of them
    struct mesh *meshes;
    moray_mesh_record *history; // becomes the solution's, as does
    struct iterations *iterations;
    int tried, widenings, escapes, moves, restarts;
    double spent;         // of the processor, in the solver
    moray_solution *best; // of the solved ones that of the least error; often the last
    double best_error;
    int vain; // meshes since
};

// Solves on the meshes in c. A start that was not a solution may lead nowhere: then with another scheme where one is
// called for, and from another start where no guess was given. Or to a saddle, as one of symmetry does: that is left.
// Error: those of moray_solve.
moray_status moray_campaign_solve(struct campaign *c, const moray_guess *guess, moray_solution **result);

// Solves on the meshes in c, and again from there where a function turns out to depend on more than its patterns know,
// or data have left their intervals. Error: those of moray_solve.
moray_status moray_campaign_solve_widened(struct campaign *c, const moray_guess *guess, moray_solution **result);

// Notes a mesh with its error in the history, which the solution shows and the campaign owns.
void moray_campaign_record(struct campaign *c, moray_solution *solution, double error, int dependences);

// Frees a solution but for the history and the iterations.
void moray_campaign_drop(moray_solution *solution);

// The first mesh of phase p: what the phase asks for itself, or of equal intervals. Error: MORAY_MEMORY.
moray_status moray_campaign_first_mesh(const struct campaign *c, int p, int intervals);
void moray_campaign_free_meshes(struct campaign *c);

struct method moray_campaign_method(const struct campaign *c, int p); // of new meshes of phase p

#endif
