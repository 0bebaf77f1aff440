// SPDX-License-Identifier: MIT
#include "results/page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void moray_html_text(FILE *page, const char *text)
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
        case '"':
            fputs("&quot;", page);
            break;
        default:
            fputc(*c, page);
        }
}

void moray_html_element(FILE *page, const char *name, const char *text)
{
    fprintf(page, "<%s>", name);
    moray_html_text(page, text);
    fprintf(page, "</%s>", name);
}

void moray_html_paragraphs(FILE *page, const char *text)
{
    char *copy = strdup(text ? text : ""), *rest = NULL;
    for (char *line = copy ? strtok_r(copy, "\n", &rest) : NULL; line; line = strtok_r(NULL, "\n", &rest)) {
        moray_html_element(page, "p", line);
        fputc('\n', page);
    }
    free(copy);
}

static void write_cell(FILE *page, const moray_table_row *row, int j)
{
    char shown[32], full[32];
    const char *text = moray_table_cell(row, j, shown);
    if (row->text) {
        if (j == 0)
            fputs("<td class=\"words\">", page);
        else
            fputs("<td>", page);
        moray_html_text(page, text);
    } else if (isfinite(row->value[j])) {
        fprintf(page, "<td><data value=\"%s\">%s</data>", moray_number_text(row->value[j], full), text);
    } else {
        fprintf(page, "<td>%s", text);
    }
    fputs("</td>", page);
}

static void write_heads(FILE *page, const moray_table *table, bool units)
{
    bool headed = false;
    for (int j = 0; j < table->n_columns; j++)
        headed = headed || table->columns[j];
    if (!headed)
        return;
    fputs("<thead><tr><td></td>", page);
    for (int j = 0; j < table->n_columns; j++) {
        fputs("<th scope=\"col\">", page);
        moray_html_text(page, table->columns[j]);
        fputs("</th>", page);
    }
    fputs(units ? "<td></td></tr></thead>\n" : "</tr></thead>\n", page);
}

void moray_html_table(FILE *page, const moray_table *table)
{
    bool units = false;
    for (int i = 0; i < table->n_rows; i++)
        units = units || (table->rows[i].unit && *table->rows[i].unit);
    fputs("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"", page);
    moray_html_text(page, table->title ? table->title : "table");
    fputs("\">\n<table>\n", page);
    if (table->title)
        moray_html_element(page, "caption", table->title);
    write_heads(page, table, units);
    fputs("<tbody>\n", page);
    for (int i = 0; i < table->n_rows; i++) {
        fputs("<tr><th scope=\"row\">", page);
        moray_html_text(page, table->rows[i].label);
        fputs("</th>", page);
        for (int j = 0; j < table->n_columns; j++)
            write_cell(page, &table->rows[i], j);
        if (units) {
            fputs("<td class=\"unit\">", page);
            moray_html_text(page, table->rows[i].unit);
            fputs("</td>", page);
        }
        fputs("</tr>\n", page);
    }
    fputs("</tbody>\n</table>\n</div>\n", page);
}

// A line of a picture with a prefix at every id and at every reference to one.
static void write_with_own_ids(FILE *page, const char *line, int number)
{
    static const char *const marks[] = {" id=\"", " id='", "href='#", "href=\"#", "url(#"};
    while (*line) {
        const char *mark = NULL;
        for (size_t k = 0; k < sizeof marks / sizeof *marks && !mark; k++)
            if (strncmp(line, marks[k], strlen(marks[k])) == 0)
                mark = marks[k];
        if (mark) {
            fprintf(page, "%sf%d-", mark, number);
            line += strlen(mark);
        } else {
            fputc(*line++, page);
        }
    }
}

// The element around a picture, named as the picture is.
static void begin_figure(FILE *page, const char *svg)
{
    static const char mark[] = "aria-label=\"";
    const char *name = strstr(svg, mark), *end = name ? strchr(name + sizeof mark - 1, '"') : NULL;
    fputs("<figure class=\"picture\"", page);
    if (end)
        fprintf(page, " %.*s\"", (int)(end - name), name);
    fputs(">\n", page);
}

void moray_html_figure(FILE *page, FILE *picture, int number)
{
    char *line = NULL;
    size_t room = 0;
    bool begun = false;
    rewind(picture);
    while (getline(&line, &room, picture) >= 0) { // a page has no room for an XML declaration
        const bool begins = !begun && strncmp(line, "<svg", 4) == 0;
        if (begins)
            begin_figure(page, line);
        begun = begun || begins;
        if (begun)
            write_with_own_ids(page, line, number);
    }
    if (begun)
        fputs("</figure>\n", page);
    free(line);
}
