// SPDX-License-Identifier: MIT
#include "results/figure.h"

#include "base/number.h"

#include <string.h>
#include <stdlib.h>

// A text in gnuplot's single quotes, where only the quote itself and a line's end mean something; quotes are appended
// in double ones, for gnuplot cannot read two of them doubled.
void moray_figure_quote(FILE *script, const char *text)
{
    fputc('\'', script);
    for (const char *c = text ? text : ""; *c; c++)
        if (*c == '\'')
            fputs("'.\"'\".'", script);
        else
            fputc((unsigned char)*c < ' ' ? ' ' : *c, script);
    fputc('\'', script);
}

void moray_figure_set_text(FILE *script, const char *what, const char *text)
{
    fprintf(script, "set %s ", what);
    moray_figure_quote(script, text);
    fputc('\n', script);
}

static void write_script(FILE *script, const moray_figure *figure)
{
    const locale_t before = moray_c_locale_begin();
    moray_figure_axes(script, figure);
    moray_figure_data(script, figure);
    moray_figure_plot(script, figure);
    moray_c_locale_end(before);
}

// An attribute's or an element's text.
static void write_escaped(FILE *picture, const char *text)
{
    for (; *text; text++)
        if (*text == '&' || *text == '<' || *text == '"')
            fprintf(picture, "&#%d;", *text);
        else
            fputc(*text, picture);
}

// Behind "<svg ": what a reader of the screen is told, and where time runs along the axis.
static void write_attributes(const moray_figure *figure, FILE *picture)
{
    const moray_figure_layout at = moray_figure_lay_out(figure);
    double time[2];
    fputs("role=\"img\" aria-label=\"", picture);
    write_escaped(picture, figure->title ? figure->title : figure->name);
    fputs("\" ", picture);
    if (moray_figure_time(figure, time))
        fprintf(picture, "data-time=\"%.9g %.9g %g %g %g %g\" ", time[0], time[1], at.left, at.width - at.right, at.top,
                at.height - at.bottom);
}

// Gnuplot's picture with a title of ours in place of its own. Error: MORAY_IO where it is not whole.
static moray_status finish(const moray_figure *figure, FILE *raw, FILE *picture)
{
    char *line = NULL;
    size_t room = 0;
    bool begun = false, ended = false;
    rewind(raw);
    while (getline(&line, &room, raw) >= 0) {
        char *own = strstr(line, "<title>Gnuplot</title>");
        if (!begun && strncmp(line, "<svg ", 5) == 0) {
            begun = true;
            fputs("<svg ", picture);
            write_attributes(figure, picture);
            fputs(line + 5, picture);
        } else if (own) {
            fputs("<title>", picture);
            write_escaped(picture, figure->title ? figure->title : figure->name);
            fputs("</title>\n", picture);
        } else if (strncmp(line, "<desc>", 6) != 0) {
            fputs(line, picture);
        }
        ended = ended || strstr(line, "</svg>");
    }
    free(line);
    if (begun && ended)
        return moray_ok();
    return moray_error(MORAY_IO, "figure %s not drawn: gnuplot: the picture is not whole", figure->name);
}

moray_status moray_output_figure(moray_output *output, const moray_figure *figure)
{
    char name[200];
    FILE *picture, *script, *raw;
    snprintf(name, sizeof name, "%s.svg", figure->name);
    MORAY_TRY(moray_output_file(output, name, &picture));
    script = tmpfile();
    raw = tmpfile();
    moray_status status = moray_ok();
    if (script && raw) {
        write_script(script, figure);
        status = moray_gnuplot(figure->name, script, raw, moray_output_gnuplot_hangs(output));
    } else {
        status = moray_error(MORAY_IO, "figure %s not drawn: no temporary file", figure->name);
    }
    if (!moray_failed(status))
        status = finish(figure, raw, picture);
    if (script)
        fclose(script);
    if (raw)
        fclose(raw);
    if (moray_failed(status))
        moray_output_drop(output);
    return status;
}
