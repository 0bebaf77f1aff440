// SPDX-License-Identifier: MIT
#include <unistd.h>

#include "fit.h"

// ---- Robot file ----------------------------------------------------------------------------------------------------

// The constants alone into a file that is there; all of the robot into one that is not.
moray_status paper_fit_write(const paper *p, const paper_constants *c)
{
    const moray_robot *robot = p->robot;
    const struct {
        const char *key;
        double value;
    } all[] = {{"rot_damping", c->damping},
               {"rot_gain", c->gain},
               {"links", robot->links},
               {"l_m", robot->l},
               {"m_kg", robot->m},
               {"J_kg_m2", robot->J},
               {"c_t", robot->c_t},
               {"c_n", robot->c_n},
               {"mu_n", robot->mu_n},
               {"lambda_1", robot->lambda_1},
               {"lambda_2", robot->lambda_2},
               {"lambda_3", robot->lambda_3},
               {"k_p", robot->k_p},
               {"k_d", robot->k_d}};
    enum { n = sizeof all / sizeof *all };
    moray_ini_entry entries[n];
    char text[n][64], number[32];
    for (int i = 0; i < n; i++) {
        if (i < 2)
            snprintf(text[i], sizeof text[i], "%.6g  ; fitted by the program paper", all[i].value);
        else
            snprintf(text[i], sizeof text[i], "%s", moray_number_text(all[i].value, number));
        entries[i] = (moray_ini_entry){all[i].key, text[i]};
    }
    const char *file = p->settings->write_ini;
    return moray_ini_set(file, "robot", entries, access(file, F_OK) == 0 ? 2 : n);
}

// ---- Telling -------------------------------------------------------------------------------------------------------

static void json_constants(moray_json *json, const char *key, const paper_constants *c)
{
    moray_json_object(json, key,
                      MORAY_MEMBERS({"rot_damping", c->damping}, {"rot_gain", c->gain}, {"rms_deg", c->rms},
                                    {"largest_deg", c->largest}));
}

// The ratio of the constants sets how fast the robot turns; the damping only how soon it does.
static moray_status say_how_sure(paper *p, const paper_fitting *fit)
{
    const bool vague = fmax(fit->slower.rms, fit->faster.rms) < 1.3 * fit->best.rms;
    MORAY_TRY(paper_say(p, "Half or twice of rot_damping at the same ratio of the constants is %.3g or %.3g deg off%s.",
                        fit->slower.rms, fit->faster.rms,
                        vague ? ": the manoeuvre determines the ratio, and rot_damping hardly" : ""));
    if (!fit->damping_at_end)
        return moray_ok();
    return paper_say(p, "rot_damping is at the end of the range that was searched: within it none is the best.");
}

moray_status paper_fit_tell(paper *p, const paper_fitting *fit)
{
    const paper_constants *a = &fit->given, *b = &fit->best;
    const moray_table_row rows[] = {
        {.label = "rot_damping", .value = {a->damping, b->damping, 100 * (a->damping / b->damping - 1)}, .unit = "1/s"},
        {.label = "rot_gain", .value = {a->gain, b->gain, 100 * (a->gain / b->gain - 1)}, .unit = "1/(m^2 s)"},
        {.label = "rot_gain/rot_damping",
         .value = {a->gain / a->damping, b->gain / b->damping,
                   100 * (a->gain / a->damping / (b->gain / b->damping) - 1)},
         .unit = "1/m^2"},
        {.label = "mean heading off by, root mean square", .value = {a->rms, b->rms, NAN}, .unit = "deg"},
        {.label = "mean heading off by, at most", .value = {a->largest, b->largest, NAN}, .unit = "deg"},
    };
    json_constants(p->json, "given", a);
    json_constants(p->json, "fitted", b);
    json_constants(p->json, "half_damping", &fit->slower);
    json_constants(p->json, "twice_damping", &fit->faster);
    moray_json_number(p->json, "trials", fit->tried);
    MORAY_TRY(paper_rows(p, "Constants of the rotational dynamics (20)",
                         PAPER_HEADS("given", "fitted", "given from fitted [%]"), rows, 5));
    MORAY_TRY(paper_say(p,
                        "Fitted to the heading of the first-principles model, on average over a period, in the "
                        "manoeuvre of Sec. V-C at %g deg/s, its times scaled to the period; %d links, %d trials.",
                        p->settings->omega / DEG, p->robot->links, fit->tried));
    return say_how_sure(p, fit);
}

moray_status paper_fit_draw(paper *p, const paper_fitting *fit, const double *given)
{
    static const char *const labels[] = {"first-principles", "control-oriented, fitted constants",
                                         "control-oriented, given constants"};
    const moray_column columns[] = {{"t", "s", fit->times, 1},
                                    {"heading first-principles", "deg", fit->target, 1},
                                    {"heading fitted", "deg", fit->trial, 1},
                                    {"heading given", "deg", given, 1}};
    return paper_draw(p, &(paper_graph){NULL, "Heading in a manoeuvre, mean over the last period", "time [s]",
                                        "heading [deg]", columns, 4, fit->n, .labels = labels});
}
