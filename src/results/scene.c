// SPDX-License-Identifier: MIT
#include "results/page.h"

#include <math.h>
#include <string.h>

// JSON inside a script element: "</" must not occur in it.
static void write_string(FILE *page, const char *text)
{
    fputc('"', page);
    for (const char *c = text ? text : ""; *c; c++)
        if ((unsigned char)*c < ' ' || *c == '"' || *c == '\\' || *c == '<')
            fprintf(page, "\\u%04x", (unsigned)*c);
        else
            fputc(*c, page);
    fputc('"', page);
}

// To a tenth of a millimetre, or of a milliradian: more than a screen shows.
static void write_numbers(FILE *page, const double *values, int n, int digits)
{
    const double none = 0.5 * pow(10, -digits);
    fputc('[', page);
    for (int i = 0; i < n; i++) {
        const double value = isfinite(values[i]) && fabs(values[i]) > none ? values[i] : 0;
        fprintf(page, "%s%.*f", i ? "," : "", value == 0 ? 0 : digits, value);
    }
    fputc(']', page);
}

static void write_rows(FILE *page, const char *name, const double *values, int rows, int width)
{
    fprintf(page, ",\"%s\":[", name);
    for (int k = 0; k < rows; k++) {
        fputs(k ? ",\n" : "", page);
        write_numbers(page, values + (size_t)k * (size_t)width, width, 4);
    }
    fputc(']', page);
}

// Of the page's style sheet: .body0, .body1, ...
static int colour_of(const moray_scene *scene, int k)
{
    const moray_colour colour = scene->bodies[k].colour;
    return colour == MORAY_COLOUR_BY_NUMBER ? k : (int)colour - (int)MORAY_COLOUR_BEST;
}

static void write_body(FILE *page, const moray_scene *scene, const moray_scene_body *body, int colour)
{
    fputs("{\"name\":", page);
    write_string(page, body->name);
    fprintf(page, ",\"colour\":%d,\"length\":%.4f,\"width\":%.4f", colour, body->length, body->width);
    if (body->lengths) {
        fputs(",\"lengths\":", page);
        write_numbers(page, body->lengths, body->links, 4);
    }
    write_rows(page, "at", body->at, scene->frames, 3 * body->links);
    if (body->effort)
        write_rows(page, "effort", body->effort, scene->frames, body->links - 1);
    if (body->force)
        write_rows(page, "force", body->force, scene->frames, 2 * body->links);
    fputs("}\n", page);
}

static void write_asked(FILE *page, const moray_scene *scene)
{
    fputs(",\"asked\":[", page);
    for (int i = 0; i < scene->n_asked; i++) {
        fputs(i ? "," : "", page);
        write_numbers(page, (double[]){scene->asked_x[i], scene->asked_y[i]}, 2, 3);
    }
    fputs("]", page);
}

static void write_channels(FILE *page, const moray_scene *scene)
{
    fputs(",\"channels\":[", page);
    for (int k = 0; k < scene->n_channels; k++) {
        fputs(k ? ",{\"name\":" : "{\"name\":", page);
        write_string(page, scene->channels[k].name);
        fputs(",\"unit\":", page);
        write_string(page, scene->channels[k].unit);
        fputs(",\"values\":", page);
        write_numbers(page, scene->channels[k].values, scene->frames, 4);
        fputc('}', page);
    }
    fputs("]", page);
}

static void write_data(FILE *page, const moray_scene *scene)
{
    fputs("<script type=\"application/json\" id=\"scene-data\">\n{\"title\":", page);
    write_string(page, scene->title);
    fputs(",\"current\":", page);
    write_numbers(page, scene->current, 2, 4);
    fputs(",\"t\":", page);
    write_numbers(page, scene->t, scene->frames, 4);
    if (scene->n_asked)
        write_asked(page, scene);
    write_channels(page, scene);
    fputs(",\"bodies\":[", page);
    for (int k = 0; k < scene->n_bodies; k++) {
        fputs(k ? "," : "", page);
        write_body(page, scene, &scene->bodies[k], colour_of(scene, k));
    }
    fputs("]}\n</script>\n", page);
}

static void write_key(FILE *page, const moray_scene *scene)
{
    bool effort = false, force = false;
    fputs("<ul class=\"key\">\n", page);
    for (int k = 0; k < scene->n_bodies; k++) {
        fprintf(page,
                "<li><svg viewBox=\"0 0 20 8\" aria-hidden=\"true\"><line class=\"body%d\" x1=\"4\" y1=\"4\" x2=\"16\" "
                "y2=\"4\" stroke-width=\"6\" stroke-linecap=\"round\"/></svg>",
                colour_of(scene, k));
        moray_html_text(page, scene->bodies[k].name);
        fputs("</li>\n", page);
        effort = effort || scene->bodies[k].effort;
        force = force || scene->bodies[k].force;
    }
    if (effort) {
        fputs("<li>", page);
        moray_html_text(page, scene->effort);
        fputs(" in the joints: one way <span class=\"bar\"></span> the other</li>\n", page);
    }
    if (force)
        fputs("<li>lines from the links: drag of the water</li>\n", page);
    if (scene->n_asked)
        fputs("<li>dashed: what is asked for</li>\n", page);
    fputs("</ul>\n", page);
}

void moray_html_scene(FILE *page, const moray_scene *scene)
{
    fputs("<section id=\"scene\" hidden aria-labelledby=\"scene-title\">\n<h2 id=\"scene-title\">", page);
    moray_html_text(page, scene->title);
    fputs("</h2>\n", page);
    moray_html_paragraphs(page, scene->text);
    fputs("<div id=\"stage\" class=\"stage\" tabindex=\"0\" role=\"group\" aria-label=\"Animation; space plays and "
          "pauses\"></div>\n"
          "<div class=\"controls\">\n<button type=\"button\" id=\"scene-play\">Play</button>\n"
          "<button type=\"button\" id=\"scene-back\" aria-label=\"One frame back\">&lsaquo;</button>\n"
          "<button type=\"button\" id=\"scene-on\" aria-label=\"One frame on\">&rsaquo;</button>\n"
          "<input type=\"range\" id=\"scene-scrub\" aria-label=\"Time\">\n"
          "<output id=\"scene-clock\" aria-live=\"off\"></output>\n"
          "<label>Speed <select id=\"scene-speed\"><option value=\"0.25\">quarter</option><option "
          "value=\"0.5\">half</option><option value=\"1\" selected>real</option><option value=\"2\">double</option>"
          "<option value=\"4\">fourfold</option><option value=\"10\">tenfold</option></select></label>\n"
          "<label><input type=\"checkbox\" id=\"scene-follow\"> Follow</label>\n</div>\n"
          "<p id=\"scene-told\" aria-live=\"off\"></p>\n",
          page);
    write_key(page, scene);
    fputs(
        "<p class=\"hint\">Keys, once the picture is clicked or reached by Tab: space plays and pauses, left and right "
        "step, + and - change the speed, Home and End, f follows. To scale; the grid is fixed to the "
        "ground.</p>\n</section>\n",
        page);
    write_data(page, scene);
}
