// SPDX-License-Identifier: MIT
#include "ocp/refinement/ringing.h"

#include <math.h>

#include "ocp/hold.h"

static const double noticeable = 0.01;    // of a control's range
enum { least_turns = 8, most_apart = 4 }; // turns that are no coincidence, and the nodes from one to the next

// The control along the nodes as they come.
struct run {
    double last;     // control at the last node but for small steps
    bool rises;      // how it got there
    int since;       // nodes since the last turn
    int turns;       // one soon after another
    double turned;   // when it last did
    double area;     // of these turns: how far times how long
    double swinging; // area of all runs of turns that were no coincidence
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

static void end_run(struct run *run)
{
    if (run->turns >= least_turns)
        run->swinging += run->area;
    run->turns = 0;
    run->area = 0;
}

static void turn(struct run *run, double tau, double u)
{
    if (run->since > most_apart)
        end_run(run);
    else
        run->area += fabs(u - run->last) * (tau - run->turned);
    run->turns++;
    run->rises = !run->rises;
    run->since = 0;
    run->turned = tau;
}

static void pass(struct run *run, double tau, double u, double least)
{
    run->since++;
    if (!(fabs(u - run->last) > least))
        return;
    if ((u > run->last) != run->rises)
        turn(run, tau, u);
    run->last = u;
}

static double swing_of(const moray_solution *solution, int p, int control)
{
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    const double range = range_of(solution, p, control);
    struct run run = {.last = NAN};
    for (int n = 0; n < layout->nodes; n++) {
        if (!layout->node[n].collocated)
            continue;
        const double u = control_at(solution, p, control, n);
        if (isnan(run.last))
            run.last = u;
        pass(&run, layout->node[n].tau, u, noticeable * range);
    }
    end_run(&run);
    return range > 0 ? run.swinging / range : 0;
}

int moray_find_ringing(const moray_solution *solution, double *swing)
{
    const moray_ocp *ocp = solution->transcription->ocp;
    int found = 0;
    *swing = 0;
    for (int p = 0, first = 1; p < ocp->phases; first += ocp->phase[p++].nu)
        for (int control = 0; control < ocp->phase[p].nu; control++) {
            const double here = moray_is_held(&ocp->phase[p], control) ? 0 : swing_of(solution, p, control);
            if (here > *swing) {
                *swing = here;
                found = first + control;
            }
        }
    return found;
}
