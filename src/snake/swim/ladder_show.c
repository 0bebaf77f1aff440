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
    snprintf(text, 32, value < 0.005 ? "%.2f" : "%+.2f", fabs(value) < 0.005 ? 0 : value);
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

moray_status moray_ladder_draw(moray_output *output, const moray_ladder_row *const *ladders, const char *const *names,
                               const moray_colour *colours, int n)
{
    double gain[MORAY_LADDER_DRAWN][MORAY_RUNGS], row[MORAY_RUNGS];
    const char *rungs[MORAY_RUNGS];
    moray_curve curves[MORAY_LADDER_DRAWN];
    bool any = false;
    if (n > MORAY_LADDER_DRAWN)
        return moray_error(MORAY_INPUT, "a figure of %d gaits on the ladder: at most %d", n, MORAY_LADDER_DRAWN);
    for (int k = 0; k < n; k++) {
        for (int r = 0; r < MORAY_RUNGS; r++) {
            row[r] = r;
            rungs[r] = ladders[0][r].model;
            gain[k][r] = ladders[k][r].gain_percent;
            any = any || isfinite(gain[k][r]);
        }
        curves[k] = (moray_curve){.label = names[k],
                                  .x = gain[k],
                                  .y = row,
                                  .n = MORAY_RUNGS,
                                  .style = MORAY_CURVE_POINTS,
                                  .colour = colours ? colours[k] : MORAY_COLOUR_BY_NUMBER};
    }
    if (!any)
        return moray_ok();
    return moray_output_figure(output, &(moray_figure){.name = "ladder",
                                                       .title = "Gain on the ladder of models",
                                                       .x_label = "gain in speed at the power of the paper's gait [%]",
                                                       .y_label = "",
                                                       .y_names = rungs,
                                                       .n_y_names = MORAY_RUNGS,
                                                       .curves = curves,
                                                       .n_curves = n});
}

const moray_meaning *moray_ladder_words(void)
{
    static const moray_meaning words[] = {
        {"control opt.", "the gait optimised on the control-oriented model"},
        {"first-pr. opt.", "the gait optimised on the first-principles model"},
        {"ladder opt.", "the gait optimised for its worst gain over several models of the ladder"},
        {"paper", "the paper's first-principles model"},
        {"split2, split3, split5", "the same with every link cut into 2, 3 or 5 rigid pieces"},
        {"strip", "drag and added mass distributed along the link, so that its rotation meets them too"},
        {"quadratic", "drag by the square of the speed"},
        {"consistent", "strips, both drags, and added mass in a form that does not depend on who looks"},
        {"c_n+20, c_n-20", "the coefficient of drag across the link 20 % up, down"},
        {"c_t+20, c_t-20", "that of drag along the link"},
        {"mu_n+20, mu_n-20", "added mass across the link"},
        {"lambda+20, lambda-20", "the torques of the water on a rotating link"},
        {NULL, NULL}};
    return words;
}
