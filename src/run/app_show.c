// SPDX-License-Identifier: MIT
#include <unistd.h>

#include "moray/app/program.h"
#include "run/versions.h"

moray_status moray_app_drawn(const moray_common *common, const char *name, moray_status drawn)
{
    if (drawn.code == MORAY_MEMORY || drawn.code == MORAY_INTERRUPTED)
        return drawn;
    (void)common;
    if (moray_failed(drawn)) // told under --quiet too: a file that was asked for is missing
        fprintf(stderr, "%s: no figure: %s\n", name, drawn.text);
    return moray_ok();
}

static moray_status write_files(const moray_common *common, const moray_results *results, const moray_json *json)
{
    FILE *file;
    MORAY_TRY(moray_output_file(common->output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(moray_write_ini(common));
    if (results->write)
        MORAY_TRY(results->write(results->found, common->output));
    if (results->draw)
        MORAY_TRY(moray_app_drawn(common, results->name, results->draw(results->found, common->output)));
    if (results->report) {
        moray_report report = *results->report;
        report.argc = common->argc;
        report.argv = common->argv;
        report.configuration = common->ini;
        MORAY_TRY(moray_output_report(common->output, &report));
    }
    return moray_output_commit(common->output);
}

static moray_status show(const moray_common *common, const moray_results *results, const moray_json *json)
{
    if (common->output) {
        MORAY_TRY(write_files(common, results, json));
        if (results->report && !common->quiet && isatty(STDERR_FILENO))
            fprintf(stderr, "%s: %s/report.html shows it\n", results->name, common->out);
    }
    if (common->json)
        return moray_json_write(json, stdout);
    if (results->print)
        results->print(results->found, results->report);
    return moray_ok();
}

moray_status moray_app_show(const moray_common *common, const moray_results *results)
{
    if (results->json)
        return show(common, results, results->json);
    moray_json *json = moray_json_new();
    moray_json_text(json, "problem", results->name);
    moray_json_text(json, "version", moray_version());
    results->summary(results->found, json);
    const moray_status status = show(common, results, json);
    moray_json_free(json);
    return status;
}
