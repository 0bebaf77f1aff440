// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <strings.h>

#include "base/csv.h"
#include "moray/fit.h"

static moray_status read_value(const moray_csv *csv, int row, int column, double *value)
{
    const char *text = csv->field[(size_t)row * (size_t)csv->columns + (size_t)column];
    *value = NAN;
    return *text == 0 || strcasecmp(text, "nan") == 0 ? moray_ok() : moray_csv_number(csv, row, column, value);
}

static moray_status check_time(const moray_csv *csv, const moray_data *data, int row, double t0, double tf)
{
    const double t = data->time[row];
    if (!(t >= t0 && t <= tf))
        return moray_csv_error(csv, row,
                               moray_error(MORAY_INPUT, "t = %.9g is not within the phase, [%g, %g]", t, t0, tf));
    if (row > 0 && !(t > data->time[row - 1]))
        return moray_csv_error(csv, row,
                               moray_error(MORAY_INPUT, "t = %.9g %s the line before, at %.9g", t,
                                           t == data->time[row - 1] ? "stands twice, here and in" : "comes before",
                                           data->time[row - 1]));
    return moray_ok();
}

static moray_status take(const moray_csv *csv, moray_data *data, const char *const *names, double t0, double tf,
                         int *column)
{
    int time;
    MORAY_TRY(moray_csv_find_quantity(csv, "t", &time));
    for (int j = 0; j < data->ny; j++)
        MORAY_TRY(moray_csv_find_quantity(csv, names[j], &column[j]));
    for (int row = 0; row < data->n; row++) {
        MORAY_TRY(moray_csv_number(csv, row, time, &data->time[row]));
        MORAY_TRY(check_time(csv, data, row, t0, tf));
        for (int j = 0; j < data->ny; j++)
            MORAY_TRY(read_value(csv, row, column[j], &data->value[row * data->ny + j]));
    }
    return moray_ok();
}

moray_status moray_data_read(moray_data *data, const char *const *names, int ny, double t0, double tf, const char *path)
{
    moray_csv csv;
    *data = (moray_data){.ny = ny};
    moray_status status = moray_csv_read(&csv, path, "data");
    if (!moray_failed(status)) {
        data->n = csv.rows;
        data->time = calloc((size_t)csv.rows + 1, sizeof *data->time);
        data->value = calloc((size_t)csv.rows * (size_t)ny + 1, sizeof *data->value);
        int *column = calloc((size_t)ny + 1, sizeof *column);
        status = data->time && data->value && column ? take(&csv, data, names, t0, tf, column)
                                                     : moray_error(MORAY_MEMORY, "no memory for the data of %s", path);
        free(column);
    }
    moray_csv_free(&csv);
    return status;
}

void moray_data_free(moray_data *data)
{
    free(data->time);
    free(data->value);
    *data = (moray_data){0};
}
