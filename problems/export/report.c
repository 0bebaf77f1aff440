// SPDX-License-Identifier: MIT
#include "export.h"

#include <math.h>
#include <string.h>

static const char *const law_words[] = {
    [EXPORT_NONE] = "none", [EXPORT_HEADING] = "heading", [EXPORT_PATH] = "path", [EXPORT_PLAN] = "plan"};

// ---- The command ---------------------------------------------------------------------------------------------------

static int about_showing(const char *argument)
{
    if (strcmp(argument, "--out") == 0)
        return 2;
    return strcmp(argument, "--json") == 0 || strcmp(argument, "--quiet") == 0 || strncmp(argument, "--out=", 6) == 0;
}

void export_command(const export_job *job, char *text, size_t size)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+./:,@%";
    *text = 0;
    moray_text_add(text, size, "export");
    for (int i = 1; i < job->common.argc;) {
        const char *argument = job->common.argv[i];
        const int skip = about_showing(argument);
        const char *quote = *argument && !argument[strspn(argument, plain)] ? "" : "'";
        if (!skip)
            moray_text_add(text, size, " %s%s%s", quote, argument, quote);
        i += skip ? skip : 1;
    }
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == '`')
            *c = ' ';
}

// ---- Table and JSON ------------------------------------------------------------------------------------------------

enum { ROWS = 24 };

static void add(moray_table *table, moray_table_row *rows, const char *label, double value, const char *unit)
{
    rows[table->n_rows++] = (moray_table_row){.label = label, .value = {value}, .unit = unit};
}

static void gait_rows(const export_found *found, moray_table *table, moray_table_row *rows)
{
    const moray_gait *gait = &found->gait;
    const bool series = gait->series != NULL;
    if (!series) {
        add(table, rows, "alpha, joint amplitude", gait->amplitude / DEG, "deg");
        add(table, rows, "delta, phase shift", gait->delta / DEG, "deg");
        add(table, rows, "phi_0, joint offset", gait->offset / DEG, "deg");
        add(table, rows, "taper", gait->taper, NULL);
    } else
        add(table, rows, "harmonics", found->wave.harmonics, NULL);
    add(table, rows, "omega, frequency", gait->omega / DEG, "deg/s");
    add(table, rows, "period", found->period, "s");
    add(table, rows, "step of the tables", found->step, "s");
    add(table, rows, "ramp-in", found->job->ramp * found->period, "s");
    add(table, rows, "largest joint angle", found->peak_angle / DEG, "deg");
    add(table, rows, "largest joint rate", found->peak_rate / DEG, "deg/s");
    add(table, rows, "largest joint acceleration", found->peak_acceleration / DEG, "deg/s^2");
}

static void law_rows(const export_found *found, moray_table *table, moray_table_row *rows)
{
    const moray_heading_gains *gains = &found->gains;
    add(table, rows, "largest joint offset", found->offset / DEG, "deg");
    add(table, rows, "largest rate of it", found->offset_rate / DEG, "deg/s");
    add(table, rows, "gain", found->scale * gains->proportional, "rad/rad");
    if (found->law == EXPORT_PATH) {
        add(table, rows, "lookahead", found->lookahead, "m");
        add(table, rows, "course taken ahead", found->ahead, "m");
        add(table, rows, "integral action", found->sight_integral, "m/s");
        add(table, rows, "length of the path", found->path.length, "m");
        return;
    }
    add(table, rows, "forward", found->scale * gains->forward, "rad s/rad");
    add(table, rows, "integral", gains->integral, "1/s");
    add(table, rows, "derivative", gains->derivative, "s");
    if (found->law == EXPORT_PLAN)
        add(table, rows, "length of the plan", (found->n_plan - 1) * found->job->look, "s");
    else
        add(table, rows, "lead of the target", gains->lead, "s");
}

static void summarise(const void *of, moray_json *json)
{
    const export_found *found = of;
    const moray_gait gaits[2] = {
        moray_gait_map(&found->job->snake.robot, &found->gait, MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED),
        found->gait};
    moray_json_object(json, "robot", MORAY_MEMBERS({"links", found->job->snake.robot.links}));
    moray_json_text(json, "from", found->job->from[0] ? found->job->from : NULL);
    if (!found->gait.series)
        moray_gait_to_json(json, "gait", &found->job->snake.robot, gaits);
    moray_json_members(json, MORAY_MEMBERS({"harmonics", found->wave.harmonics}, {"period_s", found->period},
                                           {"step_s", found->step}, {"ramp_s", found->job->ramp * found->period},
                                           {"peak_angle_deg", found->peak_angle / DEG},
                                           {"peak_rate_deg_s", found->peak_rate / DEG},
                                           {"peak_acceleration_deg_s2", found->peak_acceleration / DEG}));
    moray_json_text(json, "law", law_words[found->law]);
    if (found->law == EXPORT_NONE)
        return;
    moray_json_object(
        json, "steering",
        MORAY_MEMBERS({"gain_m_rad", found->gains.proportional}, {"forward_m_s_rad", found->gains.forward},
                      {"lead_s", found->gains.lead}, {"integral_1_s", found->gains.integral},
                      {"derivative_s", found->gains.derivative}, {"lookahead_m", found->lookahead},
                      {"ahead_m", found->ahead}, {"integral_m_s", found->sight_integral}, {"scale_rad_m", found->scale},
                      {"offset_max_deg", found->offset / DEG}, {"offset_rate_max_deg_s", found->offset_rate / DEG}));
}

// ---- All -----------------------------------------------------------------------------------------------------------

static void print(const void *of, const moray_report *report)
{
    (void)of;
    moray_tables_print(report->tables, report->n_tables, stdout);
    printf("%s\n", report->text);
}

static moray_status write_files(const void *of, moray_output *output)
{
    MORAY_TRY(export_tables(of, output));
    MORAY_TRY(export_header(of, output));
    return export_robot(of, output);
}

moray_status export_report(const export_found *found)
{
    const export_job *job = found->job;
    moray_table_row rows[2][ROWS];
    moray_table tables[2] = {{.title = "Gait, revolute joints", .n_columns = 1, .rows = rows[0]},
                             {.title = "Steering", .n_columns = 1, .rows = rows[1]}};
    char text[400] = "";
    gait_rows(found, &tables[0], rows[0]);
    if (found->law != EXPORT_NONE)
        law_rows(found, &tables[1], rows[1]);
    if (job->common.out[0])
        moray_text_add(
            text, sizeof text,
            "Written: gait.csv, a period in %.0f steps%s; %s.h for C; %s.urdf and %s.xml (MuJoCo) of the robot.",
            found->period / found->step, job->ramp > 0 ? "; ramp.csv, the way there" : "", job->name, job->name,
            job->name);
    else
        moray_text_add(text, sizeof text, "Nothing is written: --out DIR says where the files are to go.");
    const moray_report report = {.title = "export: a controller to take home",
                                 .text = text,
                                 .tables = tables,
                                 .n_tables = found->law == EXPORT_NONE ? 1 : 2};
    return moray_app_show(&job->common, &(moray_results){.name = "export",
                                                         .found = found,
                                                         .summary = summarise,
                                                         .print = print,
                                                         .write = write_files,
                                                         .report = &report});
}
