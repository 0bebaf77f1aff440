// SPDX-License-Identifier: MIT
#include "base/number.h"
#include "results/results.h"

#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

// Okabe and Ito's palette in order of contrast on white, without its yellow; dashes differ as well.
static const struct {
    const char *colour, *dash;
    int marker;
} looks[] = {
    {"#0072B2", "solid", 7},       {"#D55E00", "(14,6)", 5}, {"#009E73", "(3,5)", 9},
    {"#000000", "(14,5,3,5)", 6},  {"#CC79A7", "(7,4)", 4},  {"#E69F00", "(14,4,3,4,3,4)", 8},
    {"#56B4E9", "(20,4,7,4)", 11},
};
enum { N_LOOKS = sizeof looks / sizeof *looks };

// A text in gnuplot's single quotes, where only the quote itself and a line's end mean something; quotes are appended
// in double ones, for gnuplot cannot read two of them doubled.
static void quote(FILE *script, const char *text)
{
    fputc('\'', script);
    for (const char *c = text ? text : ""; *c; c++)
        if (*c == '\'')
            fputs("'.\"'\".'", script);
        else
            fputc((unsigned char)*c < ' ' ? ' ' : *c, script);
    fputc('\'', script);
}

static void set_text(FILE *script, const char *what, const char *text)
{
    fprintf(script, "set %s ", what);
    quote(script, text);
    fputc('\n', script);
}

// A blank line interrupts the curve; so does a NaN.
static void write_data(FILE *script, const moray_curve *curve, int number)
{
    char x[32], y[32];
    const int stride = curve->stride ? curve->stride : 1;
    fprintf(script, "$curve%d << EOD\n", number);
    for (size_t i = 0; i < (size_t)curve->n; i++) {
        const double at_x = curve->x[i * stride], at_y = curve->y[i * stride];
        if (isfinite(at_x) && isfinite(at_y))
            fprintf(script, "%s %s\n", moray_number_text(at_x, x), moray_number_text(at_y, y));
        else
            fputc('\n', script);
    }
    fputs("EOD\n", script);
}

static void write_curve(FILE *script, const moray_curve *curve, int number)
{
    const int look = number % N_LOOKS, every = curve->n > 15 ? curve->n / 15 : 1;
    fprintf(script, "%s$curve%d using 1:2 ", number ? ", " : "plot ", number);
    switch (curve->style) {
    case MORAY_CURVE_LINE:
        fprintf(script, "with lines lw 2 dt %s", looks[look].dash);
        break;
    case MORAY_CURVE_MARKED:
        fprintf(script, "with linespoints lw 2 ps 0.7 dt %s pt %d pi -%d", looks[look].dash, looks[look].marker, every);
        break;
    case MORAY_CURVE_POINTS:
        fprintf(script, "with points ps 0.7 pt %d", looks[look].marker);
        break;
    }
    fprintf(script, " lc rgb '%s' title ", looks[look].colour);
    quote(script, curve->label);
}

static void widen_to(double value, double range[2])
{
    range[0] = fmin(range[0], value); // NaN stays out
    range[1] = fmax(range[1], value);
}

// What is drawn along an axis, 0 for x; {INFINITY, -INFINITY} where there is nothing.
static void range_along(const moray_figure *figure, int axis, double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int k = 0; k < figure->n_curves; k++) {
        const moray_curve *curve = &figure->curves[k];
        const size_t stride = curve->stride ? (size_t)curve->stride : 1;
        for (size_t i = 0; i < (size_t)curve->n; i++)
            widen_to((axis ? curve->y : curve->x)[i * stride], range);
    }
}

// The same scale on both axes, and a picture no flatter or slimmer than 4:1 around whatever is drawn.
static void write_equal_axes(FILE *script, const moray_figure *figure)
{
    double range[2][2];
    for (int axis = 0; axis < 2; axis++)
        range_along(figure, axis, range[axis]);
    const double width = range[0][1] - range[0][0], height = range[1][1] - range[1][0];
    fputs("set size ratio -1\n", script);
    if (!(isfinite(width) && isfinite(height)))
        return;
    for (int axis = 0; axis < 2; axis++) {
        const double middle = (range[axis][0] + range[axis][1]) / 2, own = axis ? height : width;
        const double half = fmax(0.53 * own, 0.125 * (axis ? width : height));
        if (half > 0)
            fprintf(script, "set %crange [%.17g:%.17g]\n", axis ? 'y' : 'x', middle - half, middle + half);
    }
}

// As much of the axis as is used, not whole decades; within three decades, numbers at 1, 2 and 5 of each.
static void write_log_axis(FILE *script, const moray_figure *figure, int axis)
{
    static const double steps[] = {1, 2, 5};
    const double margin = 1.1;
    const char name = axis ? 'y' : 'x';
    double range[2];
    range_along(figure, axis, range);
    fprintf(script, "set logscale %c\n", name);
    if (!(range[0] > 0 && isfinite(range[1])))
        return;
    fprintf(script, "set %crange [%.17g:%.17g]\n", name, range[0] / margin, range[1] * margin);
    if (range[1] > 1e3 * range[0])
        return;
    const double first = pow(10, floor(log10(range[0])));
    fprintf(script, "set %ctics (%g", name, first);
    for (double decade = first; decade <= range[1]; decade *= 10)
        for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
            fprintf(script, ", %g", steps[k] * decade);
    fputs(")\n", script);
}

static void write_script(FILE *script, const moray_figure *figure)
{
    const int usual = 4, extra = figure->n_curves > usual ? 18 * (figure->n_curves - usual) : 0; // room for the key
    const locale_t before = moray_c_locale_begin();
    fprintf(script, "set terminal svg noenhanced size 720,%d font 'Helvetica,13' background '#ffffff'\n", 440 + extra);
    fputs("set grid lc rgb '#d0d0d0' lt 1 lw 0.5\nset border 3\nset tics nomirror\nset key outside below height 1\n"
          "set offsets graph 0, graph 0, graph 0.03, graph 0.03\n",
          script);
    if (figure->log_x)
        write_log_axis(script, figure, 0);
    if (figure->log_y)
        write_log_axis(script, figure, 1);
    if (figure->equal_axes)
        write_equal_axes(script, figure);
    set_text(script, "title", figure->title);
    set_text(script, "xlabel", figure->x_label);
    set_text(script, "ylabel", figure->y_label);
    for (int i = 0; i < figure->n_curves; i++)
        write_data(script, &figure->curves[i], i);
    for (int i = 0; i < figure->n_curves; i++)
        write_curve(script, &figure->curves[i], i);
    fputc('\n', script);
    moray_c_locale_end(before);
}

// Runs gnuplot from script to picture, both as open files, so that no path passes through it. Returns 0 or errno, and
// gnuplot's exit status.
static int run_gnuplot(FILE *script, FILE *picture, FILE *complaints, int *exit_status)
{
    posix_spawn_file_actions_t files;
    char *const arguments[] = {"gnuplot", "-d", "-", NULL};
    pid_t process;
    int failed = posix_spawn_file_actions_init(&files);
    if (failed)
        return failed;
    posix_spawn_file_actions_adddup2(&files, fileno(script), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, fileno(picture), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, fileno(complaints), STDERR_FILENO);
    failed = posix_spawnp(&process, "gnuplot", &files, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    while (!failed && waitpid(process, exit_status, 0) < 0)
        failed = errno == EINTR ? 0 : errno;
    return failed;
}

// The first line that is not blank.
static void first_line(FILE *file, char *line, int size)
{
    rewind(file);
    while (fgets(line, size, file)) {
        line[strcspn(line, "\r\n")] = 0;
        if (line[strspn(line, " \t^")])
            return;
    }
    snprintf(line, (size_t)size, "no message");
}

static moray_status draw(const moray_figure *figure, FILE *script, FILE *picture, FILE *complaints)
{
    char line[120];
    int exit_status = 0;
    write_script(script, figure);
    rewind(script);
    const int failed = run_gnuplot(script, picture, complaints, &exit_status);
    if (failed)
        return moray_error(MORAY_IO, "figure %s not drawn: gnuplot: %s", figure->name, strerror(failed));
    if (exit_status != 0 || fseek(picture, 0, SEEK_END) || ftell(picture) == 0) {
        first_line(complaints, line, sizeof line);
        return moray_error(MORAY_IO, "figure %s not drawn: gnuplot: %s", figure->name, line);
    }
    return moray_ok();
}

moray_status moray_output_figure(moray_output *output, const moray_figure *figure)
{
    char name[200];
    FILE *picture, *script, *complaints;
    snprintf(name, sizeof name, "%s.svg", figure->name);
    MORAY_TRY(moray_output_file(output, name, &picture));
    script = tmpfile();
    complaints = tmpfile();
    moray_status status = script && complaints
                              ? draw(figure, script, picture, complaints)
                              : moray_error(MORAY_IO, "figure %s not drawn: no temporary file", figure->name);
    if (script)
        fclose(script);
    if (complaints)
        fclose(complaints);
    if (moray_failed(status))
        moray_output_drop(output);
    return status;
}
