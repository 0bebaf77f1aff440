// SPDX-License-Identifier: MIT
#include "nlp/ipopt_options.h"

#include <math.h>
#include <string.h>

static const double usual_violation = 1e-4; // Ipopt's own

// Whether several variables stand in a quarter of all constraints or more, as parameters and end times do. work[n].
static bool has_dense_columns(const moray_nlp *nlp, double *work)
{
    enum { several = 3 };
    int dense = 0;
    memset(work, 0, (size_t)nlp->n * sizeof *work);
    for (int k = 0; k < nlp->nnz_jac; k++)
        dense += (int)++work[nlp->jac_col[k]] == nlp->m / 4;
    return dense >= several;
}

static bool set_linear_solver(IpoptProblem problem, const moray_nlp *nlp, moray_linear_solver solver, double *work)
{
    if (solver == MORAY_LINEAR_MORAY &&
        // Our solutions are refined where they need it, in their own scale; what Ipopt finds wanting it still refines.
        !AddIpoptIntOption(problem, (char *)"min_refinement_steps", 0))
        return false;
    if (solver != MORAY_LINEAR_MUMPS)
        return AddIpoptStrOption(problem, (char *)"linear_solver", (char *)"ma57") &&
               AddIpoptStrOption(problem, (char *)"linear_system_scaling", (char *)"none") &&
               AddIpoptNumOption(problem, (char *)"ma57_pivtolmax", 0.1) &&
               // Four digits more than with its own 1e-8, and no slower: what fails is mostly repaired within its
               // front.
               AddIpoptNumOption(problem, (char *)"ma57_pivtol", 1e-4);
    bool ok = AddIpoptStrOption(problem, (char *)"linear_solver", (char *)"mumps");
    // MUMPS's own choice moves large entries of long programmes to the diagonal and fills the factor: 60 times slower.
    ok = ok && AddIpoptIntOption(problem, (char *)"mumps_permuting_scaling", 0);
    // Its nested dissection cannot cut what a few variables hold together: 30 times slower than minimum degree that
    // sets dense rows apart.
    if (has_dense_columns(nlp, work))
        ok = ok && AddIpoptIntOption(problem, (char *)"mumps_pivot_order", 6);
    return ok;
}

// Ipopt's limit of violations in the user's units, 1e-4, is below rounding where those are small ones: of rows that are
// scaled the tolerance counts.
static bool set_violation(IpoptProblem problem, const moray_nlp *nlp, double tolerance)
{
    double largest = 0;
    for (int i = 0; i < nlp->m && nlp->g_scale; i++)
        largest = fmax(largest, tolerance / nlp->g_scale[i]);
    return largest <= usual_violation ||
           (AddIpoptNumOption(problem, (char *)"constr_viol_tol", largest) &&
            AddIpoptNumOption(problem, (char *)"acceptable_constr_viol_tol", fmax(100 * largest, 1e-2)));
}

bool moray_ipopt_set_options(IpoptProblem problem, const moray_nlp *nlp, const moray_nlp_settings *settings,
                             moray_linear_solver solver, double *work)
{
    // 3.11 declares its option texts as char * but only reads them.
    bool ok = AddIpoptNumOption(problem, (char *)"tol", settings->tolerance);
    ok = ok && set_violation(problem, nlp, settings->tolerance);
    ok = ok && AddIpoptIntOption(problem, (char *)"max_iter", settings->max_iterations);
    if (settings->max_cpu_seconds > 0)
        ok = ok && AddIpoptNumOption(problem, (char *)"max_cpu_time", settings->max_cpu_seconds);
    ok = ok && AddIpoptIntOption(problem, (char *)"print_level", 0);               // standard output is the caller's
    ok = ok && AddIpoptStrOption(problem, (char *)"option_file_name", (char *)""); // none, not even ./ipopt.opt
    ok = ok && AddIpoptStrOption(problem, (char *)"sb", (char *)"yes");            // no banner
    if (settings->barrier > 0)
        ok = ok && AddIpoptNumOption(problem, (char *)"mu_init", settings->barrier);
    ok = ok && AddIpoptNumOption(problem, (char *)"bound_relax_factor", 0); // ours are relaxed in their own sizes
    ok = ok && set_linear_solver(problem, nlp, solver, work);
    if (nlp->x_scale || nlp->g_scale || nlp->f_scale != 0) {
        ok = ok && AddIpoptStrOption(problem, (char *)"nlp_scaling_method", (char *)"user-scaling");
        ok = ok && SetIpoptProblemScaling(problem, nlp->f_scale != 0 ? nlp->f_scale : 1, moray_for_ipopt(nlp->x_scale),
                                          moray_for_ipopt(nlp->g_scale));
    }
    if (settings->warm) {
        static const char *const pushes[] = {"warm_start_bound_push", "warm_start_bound_frac",
                                             "warm_start_slack_bound_push", "warm_start_slack_bound_frac",
                                             "warm_start_mult_bound_push"};
        ok = ok && AddIpoptStrOption(problem, (char *)"warm_start_init_point", (char *)"yes");
        for (unsigned i = 0; i < sizeof pushes / sizeof *pushes; i++)
            ok = ok && AddIpoptNumOption(problem, moray_for_ipopt(pushes[i]), 1e-9);
    }
    return ok;
}
