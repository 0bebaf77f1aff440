// SPDX-License-Identifier: MIT
#include "results/page.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

// ---- What was asked ------------------------------------------------------------------------------------------------

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
            moray_html_text(page, (char[]){*c, 0});
    if (quoted)
        fputc('\'', page);
}

// How many arguments tell only where and how the results are shown: they change none.
static int about_showing(const char *argument)
{
    if (strcmp(argument, "--out") == 0)
        return 2;
    return strcmp(argument, "--json") == 0 || strcmp(argument, "--quiet") == 0 || strncmp(argument, "--out=", 6) == 0;
}

// Without the places where the program and its results happen to be.
static void write_command(FILE *page, const moray_report *report)
{
    fputs("<pre>", page);
    for (int i = 0; i < report->argc;) {
        const int skip = i > 0 ? about_showing(report->argv[i]) : 0;
        const char *argument = report->argv[i], *slash = i == 0 ? strrchr(argument, '/') : NULL;
        if (!skip) {
            fputs(i ? " " : "", page);
            write_argument(page, slash ? slash + 1 : argument);
        }
        i += skip ? skip : 1;
    }
    fputs("</pre>\n", page);
}

// SOURCE_DATE_EPOCH, where it is set, makes pages that do not differ from day to day.
static void write_date(FILE *page)
{
    const char *given = getenv("SOURCE_DATE_EPOCH");
    const time_t now = given ? (time_t)strtoll(given, NULL, 10) : time(NULL);
    struct tm day;
    char text[64] = "";
    if (gmtime_r(&now, &day))
        strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &day);
    fprintf(page, "<dt>date</dt><dd>%s</dd>\n", text);
}

static void write_links(FILE *page, const moray_output *output)
{
    fputs("<dt>files</dt><dd>", page);
    for (int i = 0, n = 0; moray_output_name(output, i); i++) {
        const char *name = moray_output_name(output, i);
        if (strstr(name, ".svg") || strcmp(name, "report.html") == 0)
            continue;
        fputs(n++ ? ", <a href=\"" : "<a href=\"", page);
        moray_html_text(page, name);
        fputs("\">", page);
        moray_html_text(page, name);
        fputs("</a>", page);
    }
    fputs("</dd>\n", page);
}

static void write_words(FILE *page, const moray_meaning *words)
{
    if (!words)
        return;
    fputs("<section aria-labelledby=\"words\">\n<h2 id=\"words\">Names on this page</h2>\n<dl class=\"facts\">\n",
          page);
    for (; words->name; words++) {
        moray_html_element(page, "dt", words->name);
        moray_html_element(page, "dd", words->meaning);
        fputc('\n', page);
    }
    fputs("</dl>\n</section>\n", page);
}

static void write_asked(FILE *page, const moray_output *output, const moray_report *report)
{
    fputs("<section aria-labelledby=\"asked\">\n<h2 id=\"asked\">What was asked</h2>\n", page);
    moray_html_paragraphs(page, report->asked);
    write_command(page, report);
    fputs("<dl class=\"facts\">\n", page);
    write_date(page);
    fprintf(page, "<dt>version</dt><dd>moray %s</dd>\n", moray_version());
    write_links(page, output);
    fputs("</dl>\n", page);
    if (report->configuration) {
        fputs("<details><summary>Configuration, every key</summary>\n<pre>", page);
        moray_html_text(page, report->configuration);
        fputs("</pre></details>\n", page);
    }
    fputs("</section>\n", page);
}

// ---- What was found ------------------------------------------------------------------------------------------------

static const moray_section *section_of(const moray_report *report, const char *file)
{
    for (int i = 0; i < report->n_sections; i++) {
        const char *figures = report->sections[i].figures;
        if (figures && strncmp(file, figures, strlen(figures)) == 0)
            return &report->sections[i];
    }
    return NULL;
}

// The figures of one section, or of none.
static void write_figures(FILE *page, const moray_output *output, const moray_report *report,
                          const moray_section *section)
{
    bool any = false;
    for (int i = 0; moray_output_name(output, i); i++) {
        const char *name = moray_output_name(output, i);
        if (!strstr(name, ".svg") || section_of(report, name) != section)
            continue;
        fputs(any ? "" : "<div class=\"pictures\">\n", page);
        moray_html_figure(page, moray_output_stream(output, i), i);
        any = true;
    }
    fputs(any ? "</div>\n" : "", page);
}

static void write_section(FILE *page, const moray_output *output, const moray_report *report,
                          const moray_section *section)
{
    const int number = (int)(section - report->sections) + 1;
    fprintf(page, "<section aria-labelledby=\"part%d\">\n<h2 id=\"part%d\">", number, number);
    moray_html_text(page, section->title);
    fputs("</h2>\n", page);
    moray_html_paragraphs(page, section->text);
    for (int i = 0; i < section->n_tables; i++)
        moray_html_table(page, &section->tables[i]);
    write_figures(page, output, report, section);
    fputs("</section>\n", page);
}

// Where there are many parts, the way to each.
static void write_contents(FILE *page, const moray_report *report)
{
    const int few = 4;
    if (report->n_sections < few)
        return;
    fputs("<nav aria-label=\"Contents\">\n<ul class=\"contents\">\n", page);
    for (int i = 0; i < report->n_sections; i++) {
        fprintf(page, "<li><a href=\"#part%d\">", i + 1);
        moray_html_text(page, report->sections[i].title);
        fputs("</a></li>\n", page);
    }
    fputs("</ul>\n</nav>\n", page);
}

static void write_judgement(FILE *page, const moray_report *report)
{
    static const char *const classes[] = {[MORAY_JUDGED_PASS] = " pass", [MORAY_JUDGED_FAIL] = " fail"};
    if (!report->judged)
        return;
    fprintf(page, "<p class=\"judged%s\">", report->judgement ? classes[report->judgement] : "");
    moray_html_text(page, report->judged);
    fputs("</p>\n", page);
}

static bool has_figures(const moray_output *output, const moray_report *report)
{
    for (int i = 0; moray_output_name(output, i); i++)
        if (strstr(moray_output_name(output, i), ".svg") && !section_of(report, moray_output_name(output, i)))
            return true;
    return false;
}

// What belongs to no part.
static void write_results(FILE *page, const moray_output *output, const moray_report *report)
{
    if (report->n_tables == 0 && !has_figures(output, report))
        return;
    fputs("<section aria-labelledby=\"results\">\n<h2 id=\"results\">Results</h2>\n", page);
    for (int i = 0; i < report->n_tables; i++)
        moray_html_table(page, &report->tables[i]);
    write_figures(page, output, report, NULL);
    fputs("</section>\n", page);
}

// ---- The page ------------------------------------------------------------------------------------------------------

static void write_lines(FILE *page, const char *element, const char *const *lines)
{
    fprintf(page, "<%s>\n", element);
    for (; *lines; lines++)
        fputs(*lines, page);
    fprintf(page, "</%s>\n", element);
}

static bool has_scene(const moray_report *report)
{
    return report->scene && report->scene->frames > 1;
}

// What it comes to; then the robots, so that they are seen at once; then the rest of the text.
static void write_verdict(FILE *page, const moray_report *report)
{
    const char *rest = has_scene(report) && report->text ? strchr(report->text, '\n') : NULL;
    char *first = rest ? strndup(report->text, (size_t)(rest - report->text)) : NULL;
    fputs("<div id=\"found\" class=\"verdict\">\n", page);
    moray_html_paragraphs(page, first ? first : report->text);
    fputs("</div>\n", page);
    if (has_scene(report))
        moray_html_scene(page, report->scene);
    if (first && rest[strspn(rest, "\n")]) {
        fputs("<div class=\"verdict\">\n", page);
        moray_html_paragraphs(page, rest);
        fputs("</div>\n", page);
    }
    free(first);
}

static void write_page(FILE *page, const moray_output *output, const moray_report *report)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" "
          "href=\"data:,\">\n",
          page);
    moray_html_element(page, "title", report->title);
    fputc('\n', page);
    write_lines(page, "style", moray_page_css);
    fputs("</head>\n<body>\n<a class=\"skip\" href=\"#found\">To the results</a>\n<main>\n", page);
    moray_html_element(page, "h1", report->title);
    fputc('\n', page);
    write_judgement(page, report);
    write_verdict(page, report);
    write_contents(page, report);
    write_results(page, output, report);
    for (int i = 0; i < report->n_sections; i++)
        write_section(page, output, report, &report->sections[i]);
    write_words(page, report->words);
    write_asked(page, output, report);
    fputs("</main>\n", page);
    if (has_scene(report))
        write_lines(page, "script", moray_page_js);
    fputs("</body>\n</html>\n", page);
}

moray_status moray_output_report(moray_output *output, const moray_report *report)
{
    FILE *page;
    MORAY_TRY(moray_output_file(output, "report.html", &page));
    write_page(page, output, report);
    return moray_ok();
}
