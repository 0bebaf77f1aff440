// SPDX-License-Identifier: MIT
#include "ocp/ringing.h"

#include <math.h>

#include "ocp/hold.h"

static const double noticeable = 0.01;    // of a control's range
enum { least_turns = 8, most_apart = 4 }; // turns that are no coincidence, and the nodes from one to the next

// The control along the nodes as they come.
struct run {
    double last; // control at the last node but for small steps
    bool rises;  // how it got there
    int since;   // nodes since the last turn
    int turns;
};

static double control_at(const moray_solution *solution, int p, int control, int n)
{
    const struct transcription *t = solution->transcription;
    return solution->iterate.x[t->layout.phase[p].node[n].x + t->ocp->phase[p].nx + control];
}

static double range_of(const moray_solution *solution, int p, int control)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    double least = INFINITY, most = -INFINITY;
    for (int n = 0; n < layout->nodes; n++)
        if (layout->node[n].collocated) {
            least = fmin(least, control_at(solution, p, control, n));
            most = fmax(most, control_at(solution, p, control, n));
        }
    return most - least;
}

static void pass(struct run *run, double u, double least)
{
    run->since++;
    if (!(fabs(u - run->last) > least))
        return;
    if ((u > run->last) != run->rises) {
        run->turns = run->since <= most_apart ? run->turns + 1 : 1;
        run->rises = !run->rises;
        run->since = 0;
    }
    run->last = u;
}

static bool rings(const moray_solution *solution, int p, int control)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    const double least = noticeable * range_of(solution, p, control);
    struct run run = {.last = NAN};
    for (int n = 0; n < layout->nodes && run.turns < least_turns; n++) {
        if (!layout->node[n].collocated)
            continue;
        if (isnan(run.last))
            run.last = control_at(solution, p, control, n);
        pass(&run, control_at(solution, p, control, n), least);
    }
    return run.turns >= least_turns;
}

int moray_find_ringing(const moray_solution *solution)
{
    const moray_ocp *ocp = solution->transcription->ocp;
    for (int p = 0, first = 1; p < ocp->phases; first += ocp->phase[p++].nu)
        for (int control = 0; control < ocp->phase[p].nu; control++)
            if (!moray_is_held(&ocp->phase[p], control) && rings(solution, p, control))
                return first + control;
    return 0;
}
