// SPDX-License-Identifier: MIT
#include "results/results.h"

#include <stdlib.h>
#include <string.h>

static void escape(FILE *page, const char *text)
{
    for (const char *c = text ? text : ""; *c; c++)
        switch (*c) {
        case '&':
            fputs("&amp;", page);
            break;
        case '<':
            fputs("&lt;", page);
            break;
        case '>':
            fputs("&gt;", page);
            break;
        default:
            fputc(*c, page);
        }
}

static void element(FILE *page, const char *name, const char *text)
{
    fprintf(page, "<%s>", name);
    escape(page, text);
    fprintf(page, "</%s>", name);
}

static void write_table(FILE *page, const moray_table *table)
{
    char text[32];
    fputs("<table>\n", page);
    if (table->title)
        element(page, "caption", table->title);
    fputs("<tr><th></th>", page);
    for (int j = 0; j < table->n_columns; j++)
        element(page, "th", table->columns[j]);
    fputs("<th></th></tr>\n", page);
    for (int i = 0; i < table->n_rows; i++) {
        const moray_table_row *row = &table->rows[i];
        fputs("<tr>", page);
        element(page, "th", row->label);
        for (int j = 0; j < table->n_columns; j++)
            element(page, "td", moray_table_cell(row, j, text));
        element(page, "th", row->unit);
        fputs("</tr>\n", page);
    }
    fputs("</table>\n", page);
}

// The picture from "<svg" on: a page has no room for an XML declaration.
static void embed(FILE *page, FILE *picture)
{
    char line[4096];
    bool begun = false;
    fputs("<figure>\n", page);
    rewind(picture);
    while (fgets(line, sizeof line, picture)) {
        begun = begun || strncmp(line, "<svg", 4) == 0;
        if (begun)
            fputs(line, page);
    }
    fputs("</figure>\n", page);
}

// An argument as a shell reads it.
static void write_argument(FILE *page, const char *argument)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+./:,@%";
    const bool quoted = !*argument || argument[strspn(argument, plain)];
    if (quoted)
        fputc('\'', page);
    for (const char *c = argument; *c; c++)
        if (*c == '\'')
            fputs("'\\''", page);
        else
            escape(page, (char[]){*c, 0});
    if (quoted)
        fputc('\'', page);
}

static const moray_section *section_of(const moray_report *report, const char *file)
{
    for (int i = 0; i < report->n_sections; i++)
        if (strncmp(file, report->sections[i].figures, strlen(report->sections[i].figures)) == 0)
            return &report->sections[i];
    return NULL;
}

// The figures of one section, or of none.
static void write_figures(FILE *page, const moray_output *output, const moray_report *report,
                          const moray_section *section)
{
    for (int i = 0; moray_output_name(output, i); i++) {
        const char *name = moray_output_name(output, i);
        if (strstr(name, ".svg") && section_of(report, name) == section)
            embed(page, moray_output_stream(output, i));
    }
}

static void write_paragraphs(FILE *page, const char *text)
{
    fputs("<p>", page);
    for (; *text; text++)
        if (*text == '\n')
            fputs("</p>\n<p>", page);
        else
            escape(page, (char[]){*text, 0});
    fputs("</p>\n", page);
}

static void write_section(FILE *page, const moray_output *output, const moray_report *report,
                          const moray_section *section)
{
    element(page, "h2", section->title);
    fputc('\n', page);
    if (section->text)
        write_paragraphs(page, section->text);
    for (int i = 0; i < section->n_tables; i++)
        write_table(page, &section->tables[i]);
    write_figures(page, output, report, section);
}

static void write_page(FILE *page, const moray_output *output, const moray_report *report)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n", page);
    element(page, "title", report->title);
    fputs(
        "\n<style>\nbody { font: 16px/1.5 sans-serif; max-width: 48em; margin: 2em auto; padding: 0 1em; color: #222; "
        "background: #fff }\n"
        "table { border-collapse: collapse; margin: 1.5em 0 } caption { text-align: left; font-weight: bold }\n"
        "th { font-weight: normal; text-align: left } td { text-align: right; font-variant-numeric: tabular-nums }\n"
        "th, td { padding: 0.2em 1em 0.2em 0; border-bottom: 1px solid #ddd }\n"
        "figure { margin: 1.5em 0 } svg { max-width: 100%; height: auto }\n"
        "pre { background: #f4f4f4; padding: 0.7em; white-space: pre-wrap }\n</style>\n</head>\n<body>\n",
        page);
    element(page, "h1", report->title);
    if (report->text)
        element(page, "p", report->text);
    for (int i = 0; i < report->n_tables; i++)
        write_table(page, &report->tables[i]);
    write_figures(page, output, report, NULL);
    for (int i = 0; i < report->n_sections; i++)
        write_section(page, output, report, &report->sections[i]);
    fputs("<h2>Made by</h2>\n<pre>", page);
    for (int i = 0; i < report->argc; i++) {
        fputs(i ? " " : "", page);
        write_argument(page, report->argv[i]);
    }
    fputs("</pre>\n</body>\n</html>\n", page);
}

moray_status moray_output_report(moray_output *output, const moray_report *report)
{
    FILE *page;
    MORAY_TRY(moray_output_file(output, "report.html", &page));
    write_page(page, output, report);
    return moray_ok();
}
