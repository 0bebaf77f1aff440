// SPDX-License-Identifier: MIT
//
// V(x, y, t) = sum_k w_k(t) S_k(x, y): a surface for every time of the table, weighed by the splines that are one at
// their time and zero at the others.
#include "moray/water.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/csv.h"
#include "base/number.h"
#include "moray/table.h"

enum { X, Y, T, AXES };

typedef struct axis {
    int n;
    double *at; // ascending
} axis;

struct moray_water {
    axis axis[AXES];
    bool moves[2][AXES];        // whether V_x, V_y change along an axis; else not by their last digits either
    moray_surface **surface[2]; // [times] of V_x, V_y
    moray_spline **weight;      // [times]; NULL where there is one time
};

void moray_water_free(moray_water *water)
{
    if (!water)
        return;
    for (int k = 0; k < water->axis[T].n; k++) {
        for (int c = 0; c < 2; c++)
            if (water->surface[c])
                moray_surface_free(water->surface[c][k]);
        if (water->weight)
            moray_spline_free(water->weight[k]);
    }
    for (int a = 0; a < AXES; a++)
        free(water->axis[a].at);
    free(water->surface[0]);
    free(water->surface[1]);
    free(water->weight);
    free(water);
}

// ---- Values --------------------------------------------------------------------------------------------------------

void moray_water_range(const moray_water *water, double low[3], double high[3])
{
    for (int a = 0; a < AXES; a++) {
        const axis *of = &water->axis[a];
        low[a] = a == T && of->n == 1 ? -INFINITY : of->at[0];
        high[a] = a == T && of->n == 1 ? INFINITY : of->at[of->n - 1];
    }
}

bool moray_water_covers(const moray_water *water, double x, double y, double t)
{
    const double at[AXES] = {x, y, t}, rounding = 1e-9;
    double low[AXES], high[AXES];
    moray_water_range(water, low, high);
    for (int a = 0; a < AXES; a++)
        if (!(at[a] >= low[a] - rounding && at[a] <= high[a] + rounding))
            return false;
    return true;
}

void moray_water_middle(const moray_water *water, double point[3])
{
    for (int a = 0; a < AXES; a++) {
        const axis *of = &water->axis[a];
        point[a] = 0.55 * of->at[0] + 0.45 * of->at[of->n - 1];
    }
}

// The place that a component is looked up at.
static void look_at(const moray_water *water, int c, const double in[AXES], double at[AXES])
{
    for (int a = 0; a < AXES; a++)
        at[a] = water->moves[c][a] ? in[a] : water->axis[a].at[0];
}

void moray_water_at(const moray_water *water, double x, double y, double t, double V[2])
{
    for (int c = 0; c < 2; c++) {
        double at[AXES];
        look_at(water, c, (double[]){x, y, t}, at);
        V[c] = 0;
        for (int k = 0; k < water->axis[T].n; k++)
            V[c] += (water->weight ? moray_spline_real(water->weight[k], at[T], NULL) : 1) *
                    moray_surface_real(water->surface[c][k], at[X], at[Y], NULL);
    }
}

// Derivatives along an axis that nothing changes along are nothing.
static void still(const moray_water *water, int c, double d[MORAY_WATER_SLOPES])
{
    static const int of[MORAY_WATER_SLOPES][2] = {{X, X}, {Y, Y}, {T, T}, {X, X}, {X, Y},
                                                  {Y, Y}, {X, T}, {Y, T}, {T, T}};
    for (int i = 0; i < MORAY_WATER_SLOPES; i++)
        if (!water->moves[c][of[i][0]] || !water->moves[c][of[i][1]])
            d[i] = 0;
}

void moray_water_slopes(const moray_water *water, double x, double y, double t, double V[2],
                        double d[2][MORAY_WATER_SLOPES])
{
    memset(d, 0, 2 * sizeof *d);
    for (int c = 0; c < 2; c++) {
        double at[AXES];
        look_at(water, c, (double[]){x, y, t}, at);
        V[c] = 0;
        for (int k = 0; k < water->axis[T].n; k++) {
            double dw[2] = {0, 0}, s[5]; // x, y, xx, xy, yy
            const double w = water->weight ? moray_spline_real(water->weight[k], at[T], dw) : 1;
            const double value = moray_surface_real(water->surface[c][k], at[X], at[Y], s);
            const double add[MORAY_WATER_SLOPES] = {w * s[0], w * s[1],     dw[0] * value, w * s[2],     w * s[3],
                                                    w * s[4], dw[0] * s[0], dw[0] * s[1],  dw[1] * value};
            V[c] += w * value;
            for (int i = 0; i < MORAY_WATER_SLOPES; i++)
                d[c][i] += add[i];
        }
        still(water, c, d[c]);
    }
}

void moray_water_at_complex(const moray_water *water, moray_num x, moray_num y, moray_num t, moray_num V[2])
{
    for (int c = 0; c < 2; c++) {
        const bool *moves = water->moves[c];
        const moray_num at[AXES] = {moves[X] ? x : water->axis[X].at[0], moves[Y] ? y : water->axis[Y].at[0],
                                    moves[T] ? t : water->axis[T].at[0]};
        V[c] = 0;
        for (int k = 0; k < water->axis[T].n; k++)
            V[c] += (water->weight ? moray_spline_at(water->weight[k], at[T]) : 1) *
                    moray_surface_at(water->surface[c][k], at[X], at[Y]);
    }
}

// ---- From a table --------------------------------------------------------------------------------------------------

// The different numbers of a column.
static moray_status find_axis(const double *rows, int n, int columns, int column, axis *of)
{
    of->at = calloc((size_t)n, sizeof *of->at);
    if (!of->at)
        return moray_error(MORAY_MEMORY, "no memory for a current of %d points", n);
    for (int i = 0; i < n; i++)
        of->at[i] = rows[i * columns + column];
    qsort(of->at, (size_t)n, sizeof *of->at, moray_by_value);
    for (int i = 0; i < n; i++)
        if (i == 0 || of->at[i] != of->at[of->n - 1])
            of->at[of->n++] = of->at[i];
    return moray_ok();
}

static int place_on(const axis *of, double value)
{
    const double *found = bsearch(&value, of->at, (size_t)of->n, sizeof value, moray_by_value);
    return (int)(found - of->at);
}

// Sorts the rows [x, y, (t,) v_x, v_y], no fewer than points, into grid[component][t][x][y]: where none stands twice,
// none is missing.
static moray_status fill_grid(const moray_water *water, const moray_csv *csv, const double *rows, int columns,
                              double *grid)
{
    const axis *a = water->axis;
    const int per_time = a[X].n * a[Y].n, all = per_time * a[T].n;
    for (int i = 0; i < csv->rows; i++) {
        const double *row = rows + i * columns;
        const int k = columns == 5 ? place_on(&a[T], row[2]) : 0;
        const int at = k * per_time + place_on(&a[X], row[0]) * a[Y].n + place_on(&a[Y], row[1]);
        if (!isnan(grid[at]))
            return moray_csv_error(csv, i, moray_error(MORAY_INPUT, "the point (%g, %g) stands twice", row[0], row[1]));
        for (int c = 0; c < 2; c++)
            grid[c * all + at] = row[columns - 2 + c];
    }
    return moray_ok();
}

// Whether grid[component][t][x][y] changes along the axis.
static bool changes(const moray_water *water, const double *grid, int c, int a)
{
    const axis *of = water->axis;
    const int stride[AXES] = {of[Y].n, 1, of[X].n * of[Y].n}, all = of[X].n * of[Y].n * of[T].n;
    for (int at = 0; at < all; at++) {
        const int first = at - at / stride[a] % of[a].n * stride[a];
        if (grid[c * all + at] != grid[c * all + first])
            return true;
    }
    return false;
}

static moray_status make_surfaces(moray_water *water, const double *grid)
{
    const axis *a = water->axis;
    const int per_time = a[X].n * a[Y].n, times = a[T].n;
    for (int c = 0; c < 2; c++) {
        water->surface[c] = calloc((size_t)times, sizeof *water->surface[c]);
        for (int k = 0; k < times && water->surface[c]; k++)
            MORAY_TRY(moray_surface_new(&water->surface[c][k], a[X].n, a[X].at, a[Y].n, a[Y].at,
                                        grid + (c * times + k) * per_time, MORAY_NOT_A_KNOT, MORAY_LINEAR));
    }
    return water->surface[0] && water->surface[1] ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a current");
}

static moray_status make_weights(moray_water *water)
{
    const axis *t = &water->axis[T];
    if (t->n == 1)
        return moray_ok();
    double *one = calloc((size_t)t->n, sizeof *one);
    water->weight = calloc((size_t)t->n, sizeof *water->weight);
    moray_status status =
        one && water->weight ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a current of %d times", t->n);
    for (int k = 0; k < t->n && !moray_failed(status); k++) {
        one[k] = 1;
        status = moray_spline_new(&water->weight[k], t->n, t->at, one, MORAY_NOT_A_KNOT, MORAY_LINEAR);
        one[k] = 0;
    }
    free(one);
    return status;
}

static moray_status make(moray_water *water, const moray_csv *csv, const double *rows, int columns)
{
    for (int a = 0; a < AXES; a++)
        if (a < T || columns == 5)
            MORAY_TRY(find_axis(rows, csv->rows, columns, a, &water->axis[a]));
        else
            MORAY_TRY(find_axis((double[]){0}, 1, 1, 0, &water->axis[a]));
    for (int a = 0; a < T; a++)
        if (water->axis[a].n < 2)
            return moray_error(MORAY_INPUT, "water %.120s: %s must have two places or more",
                               moray_path_tail(csv->text.path), a == X ? "x_m" : "y_m");
    const size_t all = 2 * (size_t)water->axis[X].n * (size_t)water->axis[Y].n * (size_t)water->axis[T].n;
    if (all > 2 * (size_t)csv->rows)
        return moray_error(MORAY_INPUT, "water %.120s: %d points, where a grid of %d x %d x %d has more",
                           moray_path_tail(csv->text.path), csv->rows, water->axis[X].n, water->axis[Y].n,
                           water->axis[T].n);
    double *grid = malloc(all * sizeof *grid);
    if (!grid)
        return moray_error(MORAY_MEMORY, "no memory for a current of %d points", csv->rows);
    for (size_t k = 0; k < all; k++)
        grid[k] = NAN;
    moray_status status = fill_grid(water, csv, rows, columns, grid);
    for (int k = 0; k < 2 * AXES && !moray_failed(status); k++)
        water->moves[k / AXES][k % AXES] = changes(water, grid, k / AXES, k % AXES);
    if (!moray_failed(status))
        status = make_surfaces(water, grid);
    free(grid);
    return moray_failed(status) ? status : make_weights(water);
}

moray_status moray_water_read(moray_water **result, const char *path)
{
    static const char *const still[] = {"x_m", "y_m", "v_x_m_s", "v_y_m_s"};
    static const char *const moving[] = {"x_m", "y_m", "t_s", "v_x_m_s", "v_y_m_s"};
    moray_csv csv;
    int column[5];
    double *rows = NULL;
    moray_water *water = NULL;
    *result = NULL;
    moray_status status = moray_csv_read(&csv, path, "water");
    const int columns = !moray_failed(status) && moray_csv_find(&csv, "t_s") >= 0 ? 5 : 4;
    if (!moray_failed(status))
        status = moray_csv_match(&csv, columns == 5 ? moving : still, columns, column);
    if (!moray_failed(status)) {
        water = calloc(1, sizeof *water);
        rows = malloc((size_t)csv.rows * (size_t)columns * sizeof *rows);
        if (!water || !rows)
            status = moray_error(MORAY_MEMORY, "no memory for a current of %d points", csv.rows);
    }
    if (!moray_failed(status))
        status = moray_csv_numbers(&csv, column, columns, rows);
    if (!moray_failed(status))
        status = make(water, &csv, rows, columns);
    free(rows);
    moray_csv_free(&csv);
    if (moray_failed(status)) {
        moray_water_free(water);
        return status;
    }
    *result = water;
    return moray_ok();
}
