// SPDX-License-Identifier: MIT
#include <string.h>

#include "main.h"

void paper_print_wrapped(const char *text, FILE *file)
{
    const int last_column = 100;
    int column = 0;
    while (*text) {
        const int word = (int)strcspn(text, " ");
        if (column > 0 && column + 1 + word > last_column) {
            fputc('\n', file);
            column = 0;
        } else if (column > 0) {
            fputc(' ', file);
            column++;
        }
        fwrite(text, 1, (size_t)word, file);
        column += word;
        text += word + (text[word] == ' ');
    }
    fputc('\n', file);
}

void paper_json_head(moray_json *json, const paper_settings *settings)
{
    moray_json_text(json, "problem", "paper");
    moray_json_text(json, "version", moray_version());
    moray_json_object(json, "robot", MORAY_MEMBERS({"links", settings->snake.robot.links}));
    moray_json_numbers(json, "current_m_s", settings->snake.current, 2);
    moray_json_text(json, "reading", paper_reading_names[settings->reading]);
    moray_json_object(json, "gait",
                      MORAY_MEMBERS({"theta_max_deg", settings->theta_max / DEG},
                                    {"omega_deg_s", settings->omega / DEG}, {"delta_deg", settings->delta / DEG}));
}

void paper_json_end(moray_json *json, moray_status status)
{
    moray_json_bool(json, "done", !moray_failed(status));
    if (moray_failed(status))
        moray_json_text(json, "why", status.text);
}

moray_status paper_report(const paper *p, const paper_chapter *chapters, int n)
{
    const moray_snake_options *snake = &p->settings->snake;
    moray_section section[PAPER_STUDIES];
    char title[PAPER_STUDIES][80], failed[PAPER_STUDIES][400], text[200];
    for (int i = 0; i < n; i++) {
        const paper_chapter *chapter = &chapters[i];
        snprintf(title[i], sizeof title[i], "%s: %s", chapter->study->name, chapter->study->summary);
        snprintf(failed[i], sizeof failed[i], "Not done: %s", chapter->status.text);
        section[i] = (moray_section){.title = title[i],
                                     .text = moray_failed(chapter->status) ? failed[i] : chapter->telling.text,
                                     .figures = chapter->study->name,
                                     .tables = chapter->telling.table,
                                     .n_tables = chapter->telling.n_tables};
    }
    snprintf(text, sizeof text, "%d links, current (%g, %g) m/s, theta_max %g deg, omega %g deg/s, delta %g deg",
             snake->robot.links, snake->current[0], snake->current[1], p->settings->theta_max / DEG,
             p->settings->omega / DEG, p->settings->delta / DEG);
    const moray_report report = {.title = "A control-oriented model of underwater snake robots exposed to currents",
                                 .text = text,
                                 .sections = section,
                                 .n_sections = n};
    return moray_app_show(&p->settings->common, &(moray_results){.name = "paper", .json = p->json, .report = &report});
}
