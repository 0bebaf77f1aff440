// SPDX-License-Identifier: MIT
#include <math.h>

#include "identify.h"

static void estimates(const identify *run, moray_json *json)
{
    moray_json_open_list(json, "estimates");
    for (int k = 0; k < run->n; k++) {
        double scale;
        const char *unit = identify_unit(run->unknown[k], &scale);
        const double value = run->at[0].value[k], half = identify_half_width(run, &run->info, k);
        const bool known = isfinite(half) && !run->info.held[k];
        moray_json_open(json, NULL);
        moray_json_text(json, "name", moray_unknown_name(run->unknown[k]));
        moray_json_text(json, "unit", unit);
        moray_json_members(json,
                           MORAY_MEMBERS({"value", value / scale}, {"lower", known ? (value - half) / scale : NAN},
                                         {"upper", known ? (value + half) / scale : NAN},
                                         {"standard_error", known ? half / moray_student_95(0) / scale : NAN}));
        moray_json_bool(json, "determined", isfinite(half));
        moray_json_bool(json, "at_bound", run->info.held[k]);
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void channels(const identify *run, moray_json *json)
{
    moray_json_open_list(json, "channels");
    for (int k = 0; k < run->fit.channels; k++) {
        const moray_channel_fit *c = &run->fit.channel[k];
        moray_json_open(json, NULL);
        moray_json_text(json, "log", run->log[c->run].name);
        moray_json_text(json, "channel", moray_channel_name(c->kind));
        if (c->kind == MORAY_CHANNEL_TORQUE)
            moray_json_number(json, "joint", c->joint + 1);
        moray_json_members(json,
                           MORAY_MEMBERS({"readings", c->n}, {"sigma", c->sigma}, {"rms_over_sigma", c->rms},
                                         {"lag_1", c->lag}, {"ljung_box", c->portmanteau}, {"outliers", c->outliers}));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void held(const identify *run, moray_json *json)
{
    moray_json_open_list(json, "held_out");
    for (int k = 0; k < run->n_held; k++) {
        const held_out *h = &run->validation[k];
        moray_json_open(json, NULL);
        moray_json_text(json, "log", run->held[k].name);
        moray_json_members(json, MORAY_MEMBERS({"position_rms_m", hypot(h->rms[0], h->rms[1])},
                                               {"heading_rms_deg", h->rms[MORAY_CHANNEL_HEADING] / DEG},
                                               {"torque_rms_N_m", h->rms[MORAY_CHANNEL_TORQUE]},
                                               {"speed_m_s", h->measured}, {"predicted_speed_m_s", h->predicted}));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void next(const identify *run, moray_json *json)
{
    if (!run->design)
        return;
    moray_json_open(json, "next_experiment");
    moray_json_members(json, MORAY_MEMBERS({"alpha_deg", run->next.amplitude / DEG},
                                           {"omega_deg_s", run->next.omega / DEG}, {"delta_deg", run->next.delta / DEG},
                                           {"phi0_deg", run->next.offset / DEG}, {"duration_s", run->duration}));
    moray_json_open_list(json, "standard_errors");
    for (int k = 0; k < run->n; k++) {
        double scale;
        identify_unit(run->unknown[k], &scale);
        moray_json_open(json, NULL);
        moray_json_text(json, "name", moray_unknown_name(run->unknown[k]));
        moray_json_members(json, MORAY_MEMBERS({"before", run->inflation * run->info.error[k] / scale},
                                               {"after", run->inflation * run->after.error[k] / scale}));
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_close(json);
}

void identify_summary(const void *found, moray_json *json)
{
    const identify *run = found;
    char open[900];
    moray_snake_to_json(json, &run->snake);
    estimates(run, json);
    moray_information_open(&run->info, run->unknown, open, sizeof open);
    moray_json_text(json, "not_determined", open);
    moray_json_numbers(json, "eigenvalues", run->info.value, run->n);
    channels(run, json);
    held(run, json);
    next(run, json);
    moray_json_object(json, "search",
                      MORAY_MEMBERS({"starts", run->starts}, {"at_best", run->best_starts},
                                    {"iterations", run->at[0].iterations}, {"cost", run->at[0].cost}));
    moray_json_open(json, "residuals");
    moray_json_bool(json, "pass", identify_certified(run));
    moray_json_members(json, MORAY_MEMBERS({"measurements", run->fit.n}, {"freedom", run->fit.freedom},
                                           {"chi2", run->fit.chi2}, {"chi2_limit", run->fit.limit},
                                           {"inflation", run->inflation}));
    moray_json_text(json, "verdict", run->fit.verdict);
    moray_json_close(json);
}
