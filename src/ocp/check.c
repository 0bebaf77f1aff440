// SPDX-License-Identifier: MIT
//
// Derivatives of every function of a problem against differences of its values, with the names of what disagrees.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "ocp/names.h"
#include "ocp/probe.h"

enum { name_size = 60 };

// A function of the problem: phase p, or the endpoint where p < 0.
struct subject {
    const moray_ocp *ocp;
    int p;
    bool observed; // of the phase
    const moray_map *map;
    moray_bounds *box;
    double *points, *in, *out, *weight; // points over the whole box, and the one at hand
};

static void input_name(const struct subject *s, int i, char *text)
{
    if (s->p < 0)
        moray_endpoint_input_name(s->ocp, i, text, name_size);
    else
        moray_phase_input_name(s->ocp, s->p, i, text, name_size);
}

static void output_name(const struct subject *s, int i, char *text)
{
    if (s->p < 0)
        moray_endpoint_output_name(s->ocp, i, text, name_size);
    else if (s->observed)
        moray_function_entry_name("observation", "y", s->ocp->phase[s->p].observed.names, i, text, name_size);
    else
        moray_phase_output_name(s->ocp, s->p, i, text, name_size);
}

static const char *subject_name(const struct subject *s)
{
    return s->p < 0 ? "endpoint" : s->ocp->phase[s->p].name;
}

static void keep_jacobian(const struct subject *s, const moray_derivative_report *found,
                          moray_ocp_derivative_report *report)
{
    char row[name_size], col[name_size];
    if (found->jacobian_error <= report->jacobian_error)
        return;
    report->jacobian_error = isnan(found->jacobian_error) ? INFINITY : found->jacobian_error;
    output_name(s, found->jacobian_row, row);
    input_name(s, found->jacobian_col, col);
    snprintf(report->jacobian, sizeof report->jacobian, "%s%s: d (%s) / d (%s) is %.10g, by differences %.10g",
             s->p < 0 ? "" : "phase ", subject_name(s), row, col, found->jacobian_given, found->jacobian_reference);
}

// The output whose own second derivatives are wrong; -1 where none alone is.
static int wrong_output(struct subject *s, double error)
{
    int worst = -1;
    double most = error / 100;
    moray_derivative_report found;
    for (int i = 0; i < s->map->n_out; i++)
        s->weight[i] = 0;
    for (int i = 0; i < s->map->n_out; i++) {
        s->weight[i] = 1;
        if (!moray_failed(moray_check_derivatives(s->map, s->in, s->weight, &found)) &&
            !(found.hessian_error <= most)) {
            most = found.hessian_error;
            worst = i;
        }
        s->weight[i] = 0;
    }
    return worst;
}

static void keep_hessian(struct subject *s, const moray_derivative_report *found, moray_ocp_derivative_report *report)
{
    char what[name_size] = "weighted sum", row[name_size], col[name_size];
    moray_derivative_report shown = *found;
    if (found->hessian_error <= report->hessian_error)
        return;
    report->hessian_error = isnan(found->hessian_error) ? INFINITY : found->hessian_error;
    const int output = report->hessian_error > 1e-5 ? wrong_output(s, report->hessian_error) : -1;
    if (output >= 0) {
        output_name(s, output, what);
        s->weight[output] = 1;
        moray_check_derivatives(s->map, s->in, s->weight, &shown);
    }
    input_name(s, shown.hessian_row, row);
    input_name(s, shown.hessian_col, col);
    snprintf(report->hessian, sizeof report->hessian, "%s%s: d2 (%s) / d (%s) d (%s) is %.10g, by differences %.10g",
             s->p < 0 ? "" : "phase ", subject_name(s), what, row, col, shown.hessian_given, shown.hessian_reference);
}

static bool is_finite(const struct subject *s)
{
    s->map->value(s->map->self, s->in, s->out);
    for (int i = 0; i < s->map->n_out; i++)
        if (!isfinite(s->out[i]))
            return false;
    return true;
}

static const double step_part = 0.0200001; // of 1 + |.|: a little more than the largest step of moray_check_derivatives

// Where x is such a step away from a bound: `inwards` 1 from a lower one, -1 from an upper one.
static double step_from(double bound, int inwards)
{
    const double z = inwards * bound + step_part; // of inwards x = inwards bound + step_part (1 + |x|)
    return inwards * z / (z > 0 ? 1 - step_part : 1 + step_part);
}

// Inwards by the steps of the differences, as far as the box has room: beyond it functions need not exist.
static void keep_off_bounds(struct subject *s)
{
    for (int j = 0; j < s->map->n_in; j++) {
        const double low = step_from(s->box[j].lower, 1), high = step_from(s->box[j].upper, -1);
        if (low < high)
            s->in[j] = fmin(fmax(s->in[j], low), high);
    }
}

// A point where a function is not finite tells nothing of its derivatives and is passed over; all passed over is an
// error.
static moray_status check_at(struct subject *s, int point, int *checked, moray_ocp_derivative_report *report)
{
    moray_derivative_report found;
    s->in = s->points + point * s->map->n_in;
    keep_off_bounds(s);
    for (int i = 0; i < s->map->n_out; i++)
        s->weight[i] = 1 + 0.3 * cos(2.0 * i + point);
    if (!is_finite(s))
        return moray_ok();
    ++*checked;
    MORAY_TRY(moray_check_derivatives(s->map, s->in, s->weight, &found));
    keep_jacobian(s, &found, report);
    keep_hessian(s, &found, report);
    return moray_ok();
}

static moray_status check_subject(struct subject s, moray_ocp_derivative_report *report)
{
    int checked = 0;
    s.points = calloc((size_t)(moray_probe_points * s.map->n_in + 2 * s.map->n_out) + 1, sizeof *s.points);
    s.box = calloc((size_t)s.map->n_in + 1, sizeof *s.box);
    if (!s.points || !s.box) {
        free(s.points);
        free(s.box);
        return moray_error(MORAY_MEMORY, "no memory to check the derivatives of %s", subject_name(&s));
    }
    s.out = s.points + moray_probe_points * s.map->n_in;
    s.weight = s.out + s.map->n_out;
    if (s.p < 0) {
        moray_endpoint_points(s.ocp, 0, s.points);
        moray_endpoint_box(s.ocp, s.box);
    } else {
        moray_phase_points(s.ocp, &s.ocp->phase[s.p], 0, s.points);
        moray_phase_box(s.ocp, &s.ocp->phase[s.p], s.box);
    }
    moray_status status = moray_ok();
    for (int point = 0; point < moray_probe_points && !moray_failed(status); point++)
        status = check_at(&s, point, &checked, report);
    if (!moray_failed(status) && checked == 0)
        status = moray_error(MORAY_NUMERIC, "%s: its functions are not finite at any of %d points within the bounds",
                             subject_name(&s), moray_probe_points);
    free(s.points);
    free(s.box);
    return status;
}

moray_status moray_ocp_check_derivatives(const moray_ocp *ocp, moray_ocp_derivative_report *report)
{
    *report = (moray_ocp_derivative_report){.jacobian_error = -1, .hessian_error = -1};
    for (int p = 0; p < ocp->phases; p++) {
        const moray_map *observed = ocp->phase[p].observed.map;
        MORAY_TRY(check_subject((struct subject){.ocp = ocp, .p = p, .map = ocp->phase[p].map}, report));
        if (observed)
            MORAY_TRY(check_subject((struct subject){.ocp = ocp, .p = p, .observed = true, .map = observed}, report));
    }
    return check_subject((struct subject){.ocp = ocp, .p = -1, .map = ocp->endpoint->map}, report);
}
