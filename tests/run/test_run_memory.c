// SPDX-License-Identifier: MIT
//
// Every allocation of what a run writes, draws and shows fails once, each by itself. The linker leads the run's files
// and figures to the test's.
#include "tracks.h"

#include "allocations.h"

static rig r;

static moray_status written(moray_status (*write)(const app_run *run))
{
    opened = NULL;
    n_figures = 0;
    const moray_status status = write(&r.run);
    if (opened)
        fclose(opened);
    return status;
}

static moray_status trajectory(void)
{
    return written(moray_run_write_trajectory);
}

static moray_status costates(void)
{
    return written(moray_run_write_costates);
}

static moray_status multipliers(void)
{
    return written(moray_run_write_multipliers);
}

static moray_status residuals(void)
{
    return written(moray_run_write_residuals);
}

static moray_status draw(void)
{
    n_figures = 0;
    return moray_solution_draw(r.run.solution, 1e-9, "h", NULL);
}

static moray_status tables(void)
{
    run_tables t;
    MORAY_TRY(moray_run_tables_new(&t, &r.run));
    moray_run_tables_free(&t);
    return moray_ok();
}

static moray_status fit(void)
{
    r.run.fitted = false;
    const moray_status status = moray_run_fit(&r.run);
    moray_fit_free(&r.run.fit);
    return status;
}

int main(void)
{
    close(mkstemp(path));
    rig_new(&r, 0);
    fail_each("trajectory.csv", false, trajectory);
    fail_each("costates.csv", false, costates);
    fail_each("multipliers.csv", false, multipliers);
    fail_each("residuals.csv", false, residuals);
    fail_each("figures of a solve", false, draw);
    fail_each("tables", false, tables);
    fail_each("a fit", false, fit);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    rig_free(&r);
    unlink(path);
    return tap_done();
}
