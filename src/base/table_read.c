// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/csv.h"
#include "base/number.h"
#include "base/table.h"

// Columns of a file, one behind the other: number[n][rows], owned.
struct columns {
    int rows;
    double *number;
};

static moray_status take(const moray_csv *csv, const char *const *names, int n, struct columns *c)
{
    c->rows = csv->rows;
    c->number = calloc((size_t)n * (size_t)csv->rows, sizeof *c->number);
    if (!c->number)
        return moray_error(MORAY_MEMORY, "no memory for a table of %d lines", csv->rows);
    for (int j = 0; j < n; j++) {
        int column;
        MORAY_TRY(moray_csv_find_quantity(csv, names[j], &column));
        for (int row = 0; row < csv->rows; row++)
            MORAY_TRY(moray_csv_number(csv, row, column, &c->number[j * csv->rows + row]));
    }
    return moray_ok();
}

static moray_status check_ascending(const moray_csv *csv, const struct columns *c)
{
    for (int row = 1; row < c->rows; row++)
        if (!(c->number[row] > c->number[row - 1]))
            return moray_csv_error(
                csv, row, moray_error(MORAY_INPUT, "%g does not come after %g", c->number[row], c->number[row - 1]));
    return moray_ok();
}

moray_status moray_spline_read(moray_spline **spline, const char *path, const char *x, const char *y,
                               moray_table_ends ends, moray_table_outside outside)
{
    const char *const names[] = {x, y};
    struct columns c = {0};
    moray_csv csv;
    *spline = NULL;
    moray_status status = moray_csv_read(&csv, path, "table");
    if (!moray_failed(status))
        status = take(&csv, names, 2, &c);
    if (!moray_failed(status))
        status = check_ascending(&csv, &c);
    if (!moray_failed(status))
        status = moray_spline_new(spline, c.rows, c.number, c.number + c.rows, ends, outside);
    free(c.number);
    moray_csv_free(&csv);
    return status;
}

// ---- Surfaces ----

// Sorts, and leaves each number once. Returns how many.
static int distinct(double *x, int n)
{
    int kept = 0;
    qsort(x, (size_t)n, sizeof *x, moray_by_value);
    for (int i = 0; i < n; i++)
        if (kept == 0 || x[i] != x[kept - 1])
            x[kept++] = x[i];
    return kept;
}

static int place(const double *x, int n, double value)
{
    const double *at = bsearch(&value, x, (size_t)n, sizeof *x, moray_by_value);
    return (int)(at - x);
}

// grid: [x of rows][y of rows][z of the grid]
static moray_status fill_grid(const moray_csv *csv, const struct columns *c, double *grid, int *nx, int *ny)
{
    const int rows = c->rows;
    double *x = grid, *y = grid + rows, *z = grid + 2 * rows;
    memcpy(grid, c->number, 2 * (size_t)rows * sizeof *grid);
    *nx = distinct(x, rows);
    *ny = distinct(y, rows);
    if ((double)*nx * *ny > rows)
        return moray_csv_error(csv, -1,
                               moray_error(MORAY_INPUT, "%d points do not fill a grid of %d x %d", rows, *nx, *ny));
    for (int k = 0; k < rows; k++)
        z[k] = NAN;
    for (int row = 0; row < rows; row++) {
        double *at = &z[place(x, *nx, c->number[row]) * *ny + place(y, *ny, c->number[rows + row])];
        if (!isnan(*at))
            return moray_csv_error(
                csv, row,
                moray_error(MORAY_INPUT, "the point (%g, %g) stands twice", c->number[row], c->number[rows + row]));
        *at = c->number[2 * rows + row];
    }
    return moray_ok();
}

moray_status moray_surface_read(moray_surface **surface, const char *path, const char *x, const char *y, const char *z,
                                moray_table_ends ends, moray_table_outside outside)
{
    const char *const names[] = {x, y, z};
    struct columns c = {0};
    double *grid = NULL;
    moray_csv csv;
    *surface = NULL;
    moray_status status = moray_csv_read(&csv, path, "table");
    if (!moray_failed(status))
        status = take(&csv, names, 3, &c);
    if (!moray_failed(status)) {
        int nx = 0, ny = 0;
        grid = calloc(3 * (size_t)c.rows, sizeof *grid);
        status = grid ? fill_grid(&csv, &c, grid, &nx, &ny) : moray_error(MORAY_MEMORY, "no memory for the table");
        if (!moray_failed(status))
            status = moray_surface_new(surface, nx, grid, ny, grid + c.rows, grid + 2 * c.rows, ends, outside);
    }
    free(grid);
    free(c.number);
    moray_csv_free(&csv);
    return status;
}
