// SPDX-License-Identifier: MIT
//
// The tables of a run over time, read back and compared with what the solution says at the times that they name; and
// the figures of them. The linker leads the run's files and figures to the test's.
#include "tracks.h"

// ---- Tables --------------------------------------------------------------------------------------------------------

// The table that a function writes: names in one line; numbers[rows][columns].
typedef struct table {
    moray_csv csv;
    char names[400];
    double *number;
} table;

static void write_table(rig *r, moray_status (*write)(const app_run *run), const char *name, table *t)
{
    n_figures = 0;
    CHECK_OK(write(&r->run), name);
    CHECK(strcmp(file_name, name) == 0, "into %s", file_name);
    fclose(opened);
    CHECK_OK(moray_csv_read(&t->csv, path, "table"), "is read");
    t->names[0] = 0;
    t->number = calloc((size_t)(t->csv.rows * t->csv.columns), sizeof *t->number);
    for (int j = 0; j < t->csv.columns; j++)
        snprintf(t->names + strlen(t->names), sizeof t->names - strlen(t->names), "%s%s", j ? "," : "", t->csv.name[j]);
    for (int k = 0; k < t->csv.rows * t->csv.columns; k++)
        t->number[k] = strtod(t->csv.field[k], NULL);
}

static void table_free(table *t)
{
    free(t->number);
    moray_csv_free(&t->csv);
}

// Whether row k of the table has these numbers in some columns and none in all others.
static double off_row(const table *t, int k, double phase, double time, const int *column, const double *want, int n)
{
    const double *row = t->number + k * t->csv.columns;
    double worst = fmax(fabs(row[0] - phase), fabs(row[1] - time));
    for (int j = 2; j < t->csv.columns; j++) {
        double wanted = NAN;
        for (int i = 0; i < n; i++)
            wanted = column[i] == j ? want[i] : wanted;
        worst = tap_worse(worst, isnan(wanted) && isnan(row[j]) ? 0 : fabs(row[j] - wanted) / (1 + fabs(wanted)));
    }
    return worst;
}

// Columns of the entries of the two phases in trajectory.csv: those of the same name and unit are one.
static const int columns_of[2][5] = {{2, 3, 4, 5, 6}, {3, 7, 8}};
static const int entries_of[2] = {5, 3};

static void test_trajectory(rig *r)
{
    table t;
    write_table(r, moray_run_write_trajectory, "trajectory.csv", &t);
    CHECK(strcmp(t.names, "phase,t [h],a [m],b [m/s],c [m],force [N],flow [m s],way,force [kN]") == 0, "%s", t.names);
    double worst = 0, times = 0;
    int row = 0;
    for (int p = 0; p < 2; p++) {
        double node[200], at[5];
        const int nodes = moray_solution_nodes(r->run.solution, p, node, NULL), steps = 1 + (200 - 1) / (nodes - 1);
        for (int k = 0; k <= (nodes - 1) * steps && row < t.csv.rows; k++, row++) {
            const int from = k / steps, part = k % steps;
            const double time = t.number[row * t.csv.columns + 1];
            const double to = node[from] + (part ? part * (node[from + 1] - node[from]) / steps : 0);
            times = tap_worse(times, fabs(time - to));
            moray_solution_at(r->run.solution, p, to, at, at + phases[p].nx);
            worst = tap_worse(worst, off_row(&t, row, p + 1, to, columns_of[p], at, entries_of[p]));
        }
    }
    CHECK(row == t.csv.rows && row >= 402, "%d rows, %d", t.csv.rows, row);
    CHECK(worst < 1e-12 && times < 1e-12, "nodes and as many points between each two: %.1e, %.1e", worst, times);
    table_free(&t);
}

static void test_nodes(rig *r)
{
    static const int multipliers_of[2][6] = {{2, 3, 4, 5, 6, 7}, {4, 8, 6}}, costates_of[2][3] = {{2, 3, 4}, {3, 5}};
    table t[2];
    write_table(r, moray_run_write_multipliers, "multipliers.csv", &t[0]);
    CHECK(n_figures == 0, "without figures");
    CHECK(strcmp(t[0].names, "phase,t [h],multiplier of c[0],multiplier of bounds of a,multiplier of bounds of b,"
                             "multiplier of bounds of c,multiplier of bounds of force,multiplier of bounds of flow,"
                             "multiplier of bounds of way") == 0,
          "%s", t[0].names);
    write_table(r, moray_run_write_costates, "costates.csv", &t[1]);
    CHECK(strcmp(t[1].names,
                 "phase,t [h],costate of a [J/m],costate of b [J/(m/s)],costate of c [J/m],costate of way [J]") == 0,
          "%s", t[1].names);
    double worst[2] = {0, 0}, most = 0;
    int row = 0;
    for (int p = 0; p < 2; p++) {
        const int nx = phases[p].nx, nu = phases[p].nu, nc = phases[p].nc;
        double node[100], costate[300], c[100], x[300], u[200], all[6];
        const int nodes = moray_solution_nodes(r->run.solution, p, node, costate);
        moray_solution_multipliers(r->run.solution, p, c, x, u);
        for (int k = 0; k < nodes; k++, row++) {
            int n = 0;
            for (int i = 0; i < nc; i++)
                all[n++] = c[k * nc + i];
            for (int i = 0; i < nx; i++)
                all[n++] = x[k * nx + i];
            for (int i = 0; i < nu; i++)
                all[n++] = u[k * nu + i];
            for (int i = 0; i < n; i++)
                most = fmax(most, fabs(all[i]));
            worst[0] = tap_worse(worst[0], off_row(&t[0], row, p + 1, node[k], multipliers_of[p], all, n));
            worst[1] = tap_worse(worst[1], off_row(&t[1], row, p + 1, node[k], costates_of[p], costate + k * nx, nx));
        }
    }
    CHECK(row == t[0].csv.rows && row == t[1].csv.rows, "a row a node: %d", row);
    CHECK(worst[0] < 1e-12 && worst[1] < 1e-12 && most > 0.1, "to %.1e and %.1e, some as large as %g", worst[0],
          worst[1], most);
    for (int k = 0; k < 2; k++)
        table_free(&t[k]);
}

// What `see` gives at a time of the second phase.
static double seen_by(const rig *r, double time, int j)
{
    double x[2], u[1];
    moray_solution_at(r->run.solution, 1, time, x, u);
    const double *s = moray_solution_parameters(r->run.solution);
    return j == 0 ? x[0] + 0.1 * time : x[1] - u[0] + 0.05 * s[0] - 0.3 * s[1];
}

static void test_residuals(rig *r)
{
    table t;
    write_table(r, moray_run_write_residuals, "residuals.csv", &t);
    CHECK(strcmp(t.names, "phase,t [h],y[0],y[0] predicted,y[0] residual,y[1],y[1] predicted,y[1] residual") == 0, "%s",
          t.names);
    CHECK(t.csv.rows == SEEN, "a row an observation: %d", t.csv.rows);
    double worst = 0;
    for (int k = 0; k < SEEN && k < t.csv.rows; k++) {
        static const int columns[] = {2, 3, 4, 5, 6, 7};
        double want[6];
        for (int j = 0; j < CHANNELS; j++) {
            const double value = seen[k * CHANNELS + j], told = seen_by(r, seen_at[k], j);
            want[3 * j] = value;
            want[3 * j + 1] = isnan(value) ? NAN : told;
            want[3 * j + 2] = value - told;
        }
        worst = tap_worse(worst, off_row(&t, k, 2, seen_at[k], columns, want, 6));
    }
    CHECK(worst < 1e-12, "seen, predicted, and what is left: %.1e", worst);
    CHECK(n_figures == CHANNELS, "%d figures", n_figures);
    for (int j = 0; j < CHANNELS; j++) {
        const drawn *d = figure_of(j ? "fit_2_2" : "fit_2_1");
        char title[100];
        snprintf(title, sizeof title, "hill: fit to y[%d] of down", j);
        CHECK(strcmp(d->title, title) == 0 && strcmp(d->x_label, "time [h]") == 0 && d->n == 2, "%s", d->title);
        CHECK(strncmp(d->y_label, title + 13, 4) == 0 && strlen(d->y_label) == 4, "%s", d->y_label);
        CHECK(d->points[0] == 401 && d->points[1] == SEEN && !d->marks[0] && d->marks[1], "a curve and points");
        double off = 0;
        for (int k = 0; k < 401; k++) {
            const double time = 2 + 1.5 * k / 400;
            off = tap_worse(off, fmax(fabs(d->x[0][k] - time), fabs(d->y[0][k] - seen_by(r, time, j))));
        }
        for (int k = 0; k < SEEN; k++)
            off = tap_worse(off, fabs(d->x[1][k] - seen_at[k]) + (isnan(seen[k * CHANNELS + j])
                                                                      ? !isnan(d->y[1][k])
                                                                      : fabs(d->y[1][k] - seen[k * CHANNELS + j])));
        CHECK(off < 1e-12, "what is predicted all along and what was seen: %.1e", off);
    }
    table_free(&t);
}

static void see_first(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] * at->x[0];
}

// Of observations in both phases each has its own rows, columns and figures.
static void test_both(void)
{
    static const double at[] = {0.75, 1.5}, value[] = {0.3, 0.6};
    rig r;
    table t;
    seen_first = (moray_observations){.n = 2, .ny = 1, .time = at, .value = value, .observe = see_first};
    rig_new(&r, 0);
    write_table(&r, moray_run_write_residuals, "residuals.csv", &t);
    CHECK(t.csv.rows == 2 + SEEN && n_figures == 1 + CHANNELS, "%d rows, %d figures", t.csv.rows, n_figures);
    for (int k = 0; k < t.csv.rows; k++) {
        const double *row = t.number + k * t.csv.columns;
        CHECK(row[0] == (k < 2 ? 1 : 2) && row[1] == (k < 2 ? at[k] : seen_at[k - 2]), "row %d", k);
    }
    for (int k = 0; k < 2; k++)
        CHECK_NEAR(figure_of("fit_1_1")->y[1][k], value[k], 0, "seen in the first");
    for (int k = 0; k < SEEN; k++)
        CHECK_NEAR(figure_of("fit_2_1")->x[1][k], seen_at[k], 0, "when it was seen in the second");
    CHECK_NEAR(figure_of("fit_2_1")->y[1][2], seen[2 * CHANNELS], 0, "and what");
    table_free(&t);
    rig first = r; // alone
    first.spec.phases = 1;
    first.app.spec = &first.spec;
    first.run.app = &first.app;
    write_table(&first, moray_run_write_residuals, "residuals.csv", &t);
    CHECK(strcmp(t.names, "t [h],y[0],y[0] predicted,y[0] residual") == 0 && t.csv.rows == 2, "%s", t.names);
    CHECK(n_figures == 1 && strcmp(figure_of("fit_1")->title, "hill: fit to y[0]") == 0, "%s", figures[0].title);
    table_free(&t);
    rig_free(&r);
    seen_first = (moray_observations){0};
}

// By a map in place of the function.
static void see_inputs(void *self, const moray_num *in, moray_num *y)
{
    see(&(moray_node){in, in + 2, in + 3, in[5]}, y, self);
}

static moray_map inner;

// Writes before it reads, as a map may.
static void written_first(void *self, const double *in, double *y)
{
    y[0] = y[1] = -7;
    inner.value(self, in, y);
}

static void test_mapped(rig *r)
{
    const double probe[6] = {0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
    moray_map map;
    CHECK_OK(moray_map_from_complex(&map, 6, CHANNELS, see_inputs, NULL, NULL, probe), "a map");
    inner = map;
    map.value = written_first;
    phases[1].observed.map = &map;
    phases[1].observed.observe = NULL;
    test_residuals(r);
    phases[1].observed.map = NULL;
    phases[1].observed.observe = see;
    moray_map_release(&map);
}

// ---- Figures -------------------------------------------------------------------------------------------------------

static void check_curve(const rig *r, const drawn *d, int k, int p, int entry)
{
    double worst = 0, at[5];
    for (int i = 0; i < d->points[k]; i++) {
        moray_solution_at(r->run.solution, p, d->x[k][i], at, at + phases[p].nx);
        worst = tap_worse(worst, fabs(d->y[k][i] - at[entry]));
    }
    CHECK(worst < 1e-12 && d->points[k] > 200 && d->x[k][0] == (p ? 2 : 0.5) &&
              fabs(d->x[k][d->points[k] - 1] - (p ? 3.5 : 2)) < 1e-12,
          "%s: curve %d is entry %d over its phase: %.1e", d->name, k, entry, worst);
}

static void test_figures(rig *r)
{
    static const struct {
        const char *name, *title, *y_label, *label[2];
        int p, n, entry[2];
    } want[] = {
        {"states_1_up-hill", "hill: states of up/hill", "states [m]", {"a", "c"}, 0, 2, {0, 2}},
        {"states_1_up-hill_2", "hill: states of up/hill", "b [m/s]", {"b"}, 0, 1, {1}},
        {"controls_1_up-hill", "hill: controls of up/hill", "force [N]", {"force"}, 0, 1, {3}},
        {"controls_1_up-hill_2", "hill: controls of up/hill", "flow [m s]", {"flow"}, 0, 1, {4}},
        {"states_2_down", "hill: states of down", "b [m/s]", {"b"}, 1, 1, {0}},
        {"states_2_down_2", "hill: states of down", "way", {"way"}, 1, 1, {1}},
        {"controls_2_down", "hill: controls of down", "force [kN]", {"force"}, 1, 1, {2}},
    };
    table t;
    write_table(r, moray_run_write_trajectory, "trajectory.csv", &t);
    CHECK(n_figures == 7, "%d figures", n_figures);
    for (size_t k = 0; k < sizeof want / sizeof *want; k++) {
        const drawn *d = figure_of(want[k].name);
        CHECK(strcmp(d->title, want[k].title) == 0 && strcmp(d->y_label, want[k].y_label) == 0, "%s: %s, %s",
              want[k].name, d->title, d->y_label);
        CHECK(strcmp(d->x_label, "time [h]") == 0 && d->n == want[k].n, "%s, %d curves", d->x_label, d->n);
        for (int i = 0; i < want[k].n && i < d->n; i++) {
            CHECK(strcmp(d->label[i], want[k].label[i]) == 0, "%s", d->label[i]);
            check_curve(r, d, i, want[k].p, want[k].entry[i]);
        }
    }
    table_free(&t);
}

// The first phase alone, without names, and with some of the units.
static void test_plain(const rig *r)
{
    rig one = *r;
    moray_phase_spec only = phases[0];
    table t;
    only.x_names = only.u_names = NULL;
    only.name = NULL;
    one.spec.phases = 1;
    one.spec.phase = &only;
    one.app = (moray_app){.spec = &one.spec};
    one.run.app = &one.app;
    one.run.name = "plain";
    const struct {
        moray_app_units units;
        const char *objective, *names;
    } cases[] = {
        {{0}, NULL, "t,costate of x[0],costate of x[1],costate of x[2]"},
        {{.x = x_units}, NULL, "t,costate of x[0] [1/m],costate of x[1] [1/(m/s)],costate of x[2] [1/m]"},
        {{.u = u_units}, "J", "t,costate of x[0] [J],costate of x[1] [J],costate of x[2] [J]"},
    };
    for (int k = 0; k < 3; k++) {
        one.app.units = k ? &cases[k].units : NULL;
        one.app.objective_unit = cases[k].objective;
        write_table(&one, moray_run_write_costates, "costates.csv", &t);
        CHECK(strcmp(t.names, cases[k].names) == 0, "%s", t.names);
        table_free(&t);
    }
    write_table(&one, moray_run_write_trajectory, "trajectory.csv", &t);
    CHECK(strcmp(t.names, "t,x[0],x[1],x[2],u[0] [N],u[1] [m s]") == 0, "%s", t.names);
    const drawn *states = figure_of("states"), *controls = figure_of("controls"), *more = figure_of("controls_2");
    CHECK(n_figures == 3 && states->n == 3 && controls->n == 1 && more->n == 1, "of three states, of each control");
    CHECK(strcmp(states->y_label, "states") == 0 && strcmp(controls->y_label, "u[0] [N]") == 0 &&
              strcmp(states->title, "plain: states") == 0 && strcmp(states->x_label, "time") == 0,
          "%s, %s, %s, %s", states->y_label, controls->y_label, states->title, states->x_label);
    for (int i = 0; i < 3; i++)
        check_curve(r, states, i, 0, i);
    table_free(&t);
    write_table(&one, moray_run_write_multipliers, "multipliers.csv", &t);
    CHECK(strcmp(t.names,
                 "t,multiplier of c[0],multiplier of bounds of x[0],multiplier of bounds of x[1],"
                 "multiplier of bounds of x[2],multiplier of bounds of u[0],multiplier of bounds of u[1]") == 0,
          "%s", t.names);
    table_free(&t);
}

// Into a folder whose path leaves just room enough, and one of one letter more.
static void test_room(const rig *r)
{
    moray_common given = moray_common_default();
    char kept[MORAY_PATH_SIZE];
    for (int more = 0; more < 2; more++) {
        const size_t length = MORAY_PATH_SIZE - strlen("/b.iterate") - 1 + (size_t)more;
        memset(given.out, 'a', length);
        given.out[length] = 0;
        given.output = (moray_output *)(void *)&given; // which the linker leads to the test
        opened = NULL;
        const moray_status status = moray_iterate_keep(&given, "b", r->run.solution, kept);
        CHECK(status.code == (more ? MORAY_INPUT : MORAY_OK), "%.60s", status.text);
        if (opened)
            fclose(opened);
    }
}

int main(void)
{
    rig r;
    close(mkstemp(path));
    rig_new(&r, 0);
    test_trajectory(&r);
    test_nodes(&r);
    test_residuals(&r);
    test_mapped(&r);
    test_figures(&r);
    test_plain(&r);
    test_room(&r);
    rig_free(&r);
    test_both();
    unlink(path);
    return tap_done();
}
