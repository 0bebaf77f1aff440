// SPDX-License-Identifier: MIT
#include "moray/snake/ladder.h"

#include <math.h>

#include "moray/angle.h"

static const double A_WIN = 0.05; // [%]

moray_ladder_count moray_ladder_counted(const moray_ladder_row row[MORAY_RUNGS], unsigned found_on)
{
    moray_ladder_count count = {.least = NAN, .most = NAN};
    for (int k = 0; k < MORAY_RUNGS; k++) {
        const double gain = row[k].gain_percent;
        if (isnan(gain))
            continue;
        count.n++;
        count.wins += gain > A_WIN;
        count.wins_elsewhere += gain > A_WIN && !(found_on >> k & 1);
        count.least = fmin(count.least, gain); // fmin of a NaN and a number is the number
        count.most = fmax(count.most, gain);
    }
    count.complete = count.n == MORAY_RUNGS;
    return count;
}

static void say_left_out(const moray_ladder_row row[MORAY_RUNGS], char *text, size_t size)
{
    const char *before = "; left out: ";
    for (int k = 0; k < MORAY_RUNGS; k++) {
        if (!isnan(row[k].gain_percent))
            continue;
        moray_text_add(text, size, "%s%s (%.120s)", before, row[k].model, row[k].why.text);
        before = ", ";
    }
}

// "+1.30", and "0.00" without a sign.
static const char *signed_text(double value, char text[32])
{
    snprintf(text, 32, fabs(value) < 0.005 ? "%.2f" : "%+.2f", fabs(value) < 0.005 ? 0 : value);
    return text;
}

static bool several(unsigned found_on)
{
    const unsigned models = found_on & ~(unsigned)MORAY_RUNG_CHANGES;
    return models & (models - 1);
}

void moray_ladder_verdict(const moray_ladder_row row[MORAY_RUNGS], unsigned found_on, char *text, size_t size)
{
    const moray_ladder_count count = moray_ladder_counted(row, found_on);
    char least[32], most[32];
    if (count.n == 0) {
        moray_text_add(text, size, "is compared on none of %d: %s", MORAY_RUNGS, row[0].why.text);
        return;
    }
    if (count.wins == count.n)
        moray_text_add(text, size, "wins on all %d", count.n);
    else if (count.wins > 0 && count.wins_elsewhere == 0)
        moray_text_add(text, size, "wins only on the model%s it was found on, %d of %d", several(found_on) ? "s" : "",
                       count.wins, count.n);
    else
        moray_text_add(text, size, "wins on %d of %d", count.wins, count.n);
    moray_text_add(text, size, ", from %s to %s %%", signed_text(count.least, least), signed_text(count.most, most));
    say_left_out(row, text, size);
}

void moray_ladder_to_json(moray_json *json, const moray_ladder_row row[MORAY_RUNGS])
{
    moray_json_open_list(json, "ladder");
    for (int k = 0; k < MORAY_RUNGS; k++) {
        moray_json_open(json, NULL);
        moray_json_text(json, "model", row[k].model);
        moray_json_number(json, "gain_percent_at_equal_power", row[k].gain_percent);
        moray_json_number(json, "speed_m_s", row[k].speed);
        moray_json_number(json, "power_W", row[k].power);
        moray_json_number(json, "omega_deg_s", row[k].omega / MORAY_DEGREE);
        if (moray_failed(row[k].why))
            moray_json_text(json, "left_out", row[k].why.text);
        moray_json_close(json);
    }
    moray_json_close(json);
}

int moray_ladder_rows(const moray_ladder_row *const *ladders, int n, moray_table_row rows[MORAY_RUNGS])
{
    for (int k = 0; k < MORAY_RUNGS; k++) {
        rows[k] = (moray_table_row){.label = n > 0 ? ladders[0][k].model : NULL, .unit = "%"};
        for (int g = 0; g < n; g++)
            rows[k].value[g] = fabs(ladders[g][k].gain_percent) < 0.005 ? 0 : ladders[g][k].gain_percent;
    }
    return MORAY_RUNGS;
}
