// SPDX-License-Identifier: MIT
//
// Guesses from comma-separated values with a line of names, or from solution files.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/csv.h"
#include "ocp/samples.h"
#include "ocp/solution.h"

// "v [m/s]" is v; but "x[2]" is itself.
static void cut_unit(char *name)
{
    char *unit = strstr(name, " [");
    if (unit)
        *unit = 0;
}

// Columns of the time, states and controls of a phase in place[1 + nx + nu].
static moray_status match_phase(const moray_csv *t, const moray_ocp *ocp, int p, int *place)
{
    const struct phase *phase = &ocp->phase[p];
    char name[120] = "t";
    for (int i = 0; i < 1 + phase->nx + phase->nu; i++) {
        const bool state = i - 1 < phase->nx;
        const int entry = state ? i - 1 : i - 1 - phase->nx;
        const char *const *names = state ? phase->x_names : phase->u_names;
        if (i > 0 && names)
            snprintf(name, sizeof name, "%s", names[entry]);
        else if (i > 0)
            snprintf(name, sizeof name, "%s[%d]", state ? "x" : "u", entry);
        place[i] = moray_csv_find(t, name);
        if (place[i] < 0)
            return moray_error(MORAY_INPUT, "%s: no column %s, which phase %s needs", moray_path_tail(t->text.path),
                               name, phase->name);
    }
    return moray_ok();
}

// Phase of every line, from 0; all 0 where there is no such column. Error: MORAY_INPUT.
static moray_status read_phases(const moray_csv *t, const moray_ocp *ocp, int column, int *phase)
{
    for (int row = 0; column >= 0 && row < t->rows; row++) {
        double number;
        MORAY_TRY(moray_csv_number(t, row, column, &number));
        phase[row] = number >= 1 && number <= ocp->phases ? (int)number - 1 : 0;
        if (phase[row] + 1 != number)
            return moray_csv_error(
                t, row,
                moray_error(MORAY_INPUT, "phase = %g: must be a whole number from 1 to %d", number, ocp->phases));
    }
    return moray_ok();
}

static moray_status copy_row(const moray_csv *t, const struct phase *phase, int row, const int *place, int k,
                             struct samples *samples)
{
    const int nx = phase->nx, nu = phase->nu;
    MORAY_TRY(moray_csv_number(t, row, place[0], &samples->time[k]));
    for (int i = 0; i < nx; i++)
        MORAY_TRY(moray_csv_number(t, row, place[1 + i], &samples->x[k * nx + i]));
    for (int i = 0; i < nu; i++)
        MORAY_TRY(moray_csv_number(t, row, place[1 + nx + i], &samples->u[k * nu + i]));
    if (k > 0 && samples->time[k] < samples->time[k - 1])
        return moray_csv_error(t, row,
                               moray_error(MORAY_INPUT, "t = %g comes after %g: times must ascend", samples->time[k],
                                           samples->time[k - 1]));
    return moray_ok();
}

static moray_status copy_phase(const moray_csv *t, const moray_ocp *ocp, int p, const int *phase, const int *place,
                               struct samples *samples)
{
    for (int row = 0, k = 0; row < t->rows; row++)
        if (phase[row] == p)
            MORAY_TRY(copy_row(t, &ocp->phase[p], row, place, k++, samples));
    return moray_ok();
}

static moray_status fill_phases(const moray_csv *t, const moray_ocp *ocp, const int *phase, const int *rows,
                                moray_guess *guess)
{
    int widest = 0;
    for (int p = 0; p < ocp->phases; p++)
        widest = ocp->phase[p].nx + ocp->phase[p].nu > widest ? ocp->phase[p].nx + ocp->phase[p].nu : widest;
    struct samples *samples = calloc((size_t)ocp->phases, sizeof *samples);
    int *place = calloc((size_t)widest + 1, sizeof *place);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for %s", moray_path_tail(t->text.path));
    if (samples && place)
        status = moray_guess_allocate(guess, ocp, rows, false, samples, NULL);
    for (int p = 0; p < ocp->phases && !moray_failed(status); p++) {
        status = match_phase(t, ocp, p, place);
        if (!moray_failed(status))
            status = copy_phase(t, ocp, p, phase, place, &samples[p]);
    }
    free(samples);
    free(place);
    return status;
}

static moray_status fill_guess_from(const moray_csv *t, const moray_ocp *ocp, moray_guess *guess)
{
    const int column = ocp->phases > 1 ? moray_csv_find(t, "phase") : -1;
    if (ocp->phases > 1 && column < 0)
        return moray_error(MORAY_INPUT, "%s: no column phase, which a problem of %d phases needs",
                           moray_path_tail(t->text.path), ocp->phases);
    int *rows = calloc((size_t)ocp->phases + (size_t)t->rows, sizeof *rows);
    if (!rows)
        return moray_error(MORAY_MEMORY, "no memory for %s", moray_path_tail(t->text.path));
    int *phase = rows + ocp->phases;
    moray_status status = read_phases(t, ocp, column, phase);
    for (int row = 0; row < t->rows && !moray_failed(status); row++)
        rows[phase[row]]++;
    for (int p = 0; p < ocp->phases && !moray_failed(status); p++)
        if (rows[p] == 0)
            status = moray_error(MORAY_INPUT, "%s: no line of phase %d, %s", moray_path_tail(t->text.path), p + 1,
                                 ocp->phase[p].name);
    if (!moray_failed(status))
        status = fill_phases(t, ocp, phase, rows, guess);
    free(rows);
    return status;
}

static bool is_solution(const char *path)
{
    char start[32] = "";
    FILE *file = fopen(path, "r");
    const bool read = file && fgets(start, sizeof start, file);
    if (file)
        fclose(file);
    return read && strstr(start, MORAY_SOLUTION_MARK);
}

static moray_status read_solution(moray_guess *guess, const moray_ocp *ocp, const char *path)
{
    moray_solution *solution;
    MORAY_TRY(moray_solution_load(&solution, ocp, NULL, path));
    *guess = moray_guess_from_solution(solution);
    guess->owned = solution;
    return moray_ok();
}

static moray_status read_samples(moray_guess *guess, const moray_ocp *ocp, const char *path)
{
    moray_csv t;
    moray_status status = moray_csv_read(&t, path, "guess");
    for (int j = 0; j < t.columns; j++)
        cut_unit(t.name[j]);
    if (!moray_failed(status))
        status = moray_csv_check_names(&t);
    if (!moray_failed(status))
        status = fill_guess_from(&t, ocp, guess);
    if (moray_failed(status))
        moray_guess_free(guess);
    moray_csv_free(&t);
    return status;
}

moray_status moray_guess_read(moray_guess *guess, const moray_ocp *ocp, const char *path)
{
    *guess = (moray_guess){0};
    return is_solution(path) ? read_solution(guess, ocp, path) : read_samples(guess, ocp, path);
}
