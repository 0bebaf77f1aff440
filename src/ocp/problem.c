// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/names.h"
#include "ocp/observe/observed.h"
#include "ocp/probe.h"

double moray_bounds_middle(moray_bounds bounds)
{
    const bool below = bounds.lower > -MORAY_ENDLESS, above = bounds.upper < MORAY_ENDLESS;
    return below && above ? (bounds.lower + bounds.upper) / 2 : below ? bounds.lower : above ? bounds.upper : 0;
}

bool moray_bounds_are_fixed(moray_bounds bounds)
{
    return bounds.lower == bounds.upper;
}

static void *own(moray_ocp *ocp, size_t size)
{
    if (ocp->n_owned == ocp->owned_room) {
        const int room = 2 * ocp->owned_room + 16;
        void **larger = realloc(ocp->owned, (size_t)room * sizeof *larger);
        if (!larger)
            return NULL;
        ocp->owned = larger;
        ocp->owned_room = room;
    }
    void *block = calloc(1, size + 1);
    if (block)
        ocp->owned[ocp->n_owned++] = block;
    return block;
}

static const char *copy_text(moray_ocp *ocp, const char *text)
{
    char *copy = own(ocp, text ? strlen(text) : 0);
    return copy ? strcpy(copy, text ? text : "") : NULL;
}

static moray_status no_memory(void)
{
    return moray_error(MORAY_MEMORY, "no memory for the problem");
}

static moray_status copy_names(moray_ocp *ocp, const char *const *names, int n, const char ***copy)
{
    *copy = NULL;
    if (!names || n == 0)
        return moray_ok();
    *copy = own(ocp, (size_t)n * sizeof **copy);
    for (int i = 0; *copy && i < n; i++)
        if (!((*copy)[i] = copy_text(ocp, names[i])))
            return no_memory();
    return *copy ? moray_ok() : no_memory();
}

// `what` and `where` name the list in errors: bounds x0 of phase "wire".
struct place {
    const char *what, *where;
};

static moray_status check_bounds(struct place place, const char *name, int i, moray_bounds b)
{
    if (isnan(b.lower) || isnan(b.upper))
        return moray_error(MORAY_INPUT, "%s[%d]%s%s of %s: a bound is not a number", place.what, i, name ? " " : "",
                           name ? name : "", place.where);
    if (b.lower > b.upper)
        return moray_error(MORAY_INPUT, "%s[%d]%s%s of %s: lower bound %g is above upper bound %g", place.what, i,
                           name ? " " : "", name ? name : "", place.where, b.lower, b.upper);
    return moray_ok();
}

static moray_status copy_bounds(moray_ocp *ocp, struct place place, moray_bounds_list list, int n,
                                const char *const *names, bool required, moray_bounds **copy)
{
    *copy = own(ocp, (size_t)n * sizeof **copy);
    if (!*copy)
        return no_memory();
    if (list.n != n && (list.n != 0 || required))
        return moray_error(MORAY_INPUT, "%s of %s: %d bounds given, %d needed", place.what, place.where, list.n, n);
    for (int i = 0; i < n; i++) {
        (*copy)[i] = list.n ? list.at[i] : moray_free();
        MORAY_TRY(check_bounds(place, names ? names[i] : NULL, i, (*copy)[i]));
    }
    return moray_ok();
}

// x0 and xf narrow x, u0 and uf narrow u.
static moray_status narrow(struct place place, const moray_bounds *along, int n, moray_bounds *end)
{
    for (int i = 0; i < n; i++) {
        const moray_bounds given = end[i];
        end[i].lower = fmax(given.lower, along[i].lower);
        end[i].upper = fmin(given.upper, along[i].upper);
        if (end[i].lower > end[i].upper)
            return moray_error(MORAY_INPUT, "%s[%d] of %s: [%g, %g] does not meet the bounds [%g, %g] of %c",
                               place.what, i, place.where, given.lower, given.upper, along[i].lower, along[i].upper,
                               place.what[0]);
    }
    return moray_ok();
}

static moray_status narrow_ends(struct phase *phase)
{
    MORAY_TRY(narrow((struct place){"x0", phase->name}, phase->x, phase->nx, phase->x0));
    MORAY_TRY(narrow((struct place){"xf", phase->name}, phase->x, phase->nx, phase->xf));
    MORAY_TRY(narrow((struct place){"u0", phase->name}, phase->u, phase->nu, phase->u0));
    return narrow((struct place){"uf", phase->name}, phase->u, phase->nu, phase->uf);
}

static moray_status check_phase(const struct phase *phase, const moray_phase_spec *spec)
{
    if (spec->nx < 1 || spec->nu < 0 || spec->nc < 0 || spec->nq < 0)
        return moray_error(MORAY_INPUT, "phase %s: nx %d, nu %d, nc %d, nq %d; nx must be positive, none negative",
                           phase->name, spec->nx, spec->nu, spec->nc, spec->nq);
    if (!!spec->continuous + !!spec->continuous_real + !!spec->map != 1)
        return moray_error(MORAY_INPUT, "phase %s: needs a continuous function or a map, and only one", phase->name);
    const int in = moray_phase_inputs(phase), out = spec->nx + spec->nc + spec->nq;
    if (spec->map && (spec->map->n_in != in || spec->map->n_out != out))
        return moray_error(MORAY_INPUT, "phase %s: the map has %d inputs and %d outputs, the phase %d and %d",
                           phase->name, spec->map->n_in, spec->map->n_out, in, out);
    if (spec->tf.upper < spec->t0.lower)
        return moray_error(MORAY_INPUT, "phase %s: ends by %g, before it may begin at %g", phase->name, spec->tf.upper,
                           spec->t0.lower);
    return moray_ok();
}

// A duration that is given narrows what one fixed time leaves of the other. Two free ones have a row for it.
static moray_status take_duration(struct phase *phase, moray_bounds duration)
{
    phase->has_duration = duration.lower != 0 || duration.upper != 0;
    phase->duration = phase->has_duration ? duration : moray_at_least(0);
    if (!phase->has_duration)
        return moray_ok();
    MORAY_TRY(check_bounds((struct place){"duration", phase->name}, NULL, 0, duration));
    phase->duration.lower = fmax(duration.lower, 0);
    if (duration.upper < 0)
        return moray_error(MORAY_INPUT, "phase %s: duration of at most %g: must not be negative", phase->name,
                           duration.upper);
    const moray_bounds t0 = phase->t0, tf = phase->tf, d = phase->duration;
    if (tf.upper - t0.lower < d.lower || tf.lower - t0.upper > d.upper)
        return moray_error(MORAY_INPUT,
                           "phase %s: duration in [%g, %g] does not meet t0 in [%g, %g] and tf in [%g, %g]",
                           phase->name, d.lower, d.upper, t0.lower, t0.upper, tf.lower, tf.upper);
    if (moray_bounds_are_fixed(t0) && !moray_bounds_are_fixed(tf))
        phase->tf = moray_between(fmax(tf.lower, t0.lower + d.lower), fmin(tf.upper, t0.lower + d.upper));
    else if (moray_bounds_are_fixed(tf) && !moray_bounds_are_fixed(t0))
        phase->t0 = moray_between(fmax(t0.lower, tf.lower - d.upper), fmin(t0.upper, tf.lower - d.lower));
    return moray_ok();
}

static moray_status take_scheme(struct phase *phase, const char *name)
{
    const moray_status status =
        name ? moray_scheme_parse(name, &phase->method.family, &phase->method.stages) : moray_ok();
    return moray_failed(status) ? moray_error(status.code, "phase %s: %s", phase->name, status.text) : status;
}

static moray_status copy_mesh(moray_ocp *ocp, struct phase *phase, const moray_phase_spec *spec)
{
    const int n = spec->intervals;
    if (n < 0 || (spec->mesh && n < 1))
        return moray_error(MORAY_INPUT, "phase %s: a mesh of %d intervals", phase->name, n);
    phase->intervals = n;
    if (!spec->mesh)
        return moray_ok();
    for (int k = 0; k < n; k++)
        if (!(spec->mesh[k + 1] > spec->mesh[k]))
            return moray_error(MORAY_INPUT, "phase %s: mesh[%d] = %g after %g: must ascend", phase->name, k + 1,
                               spec->mesh[k + 1], spec->mesh[k]);
    if (spec->mesh[0] != 0 || spec->mesh[n] != 1)
        return moray_error(MORAY_INPUT, "phase %s: the mesh goes from %g to %g: must be 0 to 1", phase->name,
                           spec->mesh[0], spec->mesh[n]);
    phase->mesh = own(ocp, ((size_t)n + 1) * sizeof *phase->mesh);
    if (!phase->mesh)
        return no_memory();
    memcpy(phase->mesh, spec->mesh, ((size_t)n + 1) * sizeof *phase->mesh);
    return moray_ok();
}

static moray_status copy_numbers(moray_ocp *ocp, const double *from, int n, double **copy)
{
    *copy = own(ocp, (size_t)n * sizeof **copy);
    for (int i = 0; *copy && i < n; i++)
        (*copy)[i] = from ? from[i] : 1;
    return *copy ? moray_ok() : no_memory();
}

static moray_status copy_observed(moray_ocp *ocp, struct phase *phase, const moray_observations *given)
{
    if (given->n == 0)
        return moray_ok();
    MORAY_TRY(moray_check_observations(phase, given));
    moray_hold_observations(phase, given);
    struct observed *o = &phase->observed;
    *o = (struct observed){.n = given->n,
                           .ny = given->ny,
                           .map = given->map,
                           .observe = given->observe,
                           .loss = given->loss,
                           .threshold = given->threshold,
                           .sum = given->sum,
                           .has_sum = given->sum.lower != 0 || given->sum.upper != 0,
                           .events_only = given->events_only};
    MORAY_TRY(copy_names(ocp, given->names, given->ny, &o->names));
    MORAY_TRY(check_bounds((struct place){"sum of observations", phase->name}, NULL, 0, given->sum));
    if (given->residual.n > 0)
        MORAY_TRY(copy_bounds(ocp, (struct place){"residual", phase->name}, given->residual, given->ny, o->names, true,
                              &o->residual));
    MORAY_TRY(copy_numbers(ocp, given->time, given->n, &o->time));
    MORAY_TRY(copy_numbers(ocp, given->value, given->n * given->ny, &o->value));
    return copy_numbers(ocp, given->weight, given->ny, &o->weight);
}

static moray_status copy_held(moray_ocp *ocp, struct phase *phase, const moray_phase_spec *spec)
{
    phase->held = own(ocp, (size_t)spec->nu * sizeof *phase->held);
    if (!phase->held)
        return no_memory();
    for (int r = 0; r < spec->nu && spec->held; r++)
        if (spec->held[r])
            phase->held[phase->n_held++] = r;
    if (phase->n_held > 0 && phase->intervals == 0)
        return moray_error(MORAY_INPUT,
                           "phase %s: holds controls over its own intervals, and gives neither intervals "
                           "nor a mesh",
                           phase->name);
    return moray_ok();
}

// Several without a name are told apart by their numbers.
static const char *copy_phase_name(moray_ocp *ocp, const moray_phase_spec *spec, int p)
{
    char number[12];
    snprintf(number, sizeof number, "%d", p + 1);
    return copy_text(ocp, spec->name ? spec->name : ocp->phases > 1 ? number : "phase");
}

static moray_status copy_phase(moray_ocp *ocp, const moray_phase_spec *spec, int p)
{
    struct phase *phase = &ocp->phase[p];
    phase->name = copy_phase_name(ocp, spec, p);
    if (!phase->name)
        return no_memory();
    phase->nx = spec->nx, phase->nu = spec->nu, phase->nc = spec->nc, phase->nq = spec->nq, phase->ns = ocp->ns;
    phase->map = spec->map;
    phase->t0 = spec->t0, phase->tf = spec->tf;
    phase->end_controls = spec->end_controls, phase->bounds_end_controls = spec->u0.n > 0 || spec->uf.n > 0;
    MORAY_TRY(check_phase(phase, spec));
    MORAY_TRY(check_bounds((struct place){"t0", phase->name}, NULL, 0, spec->t0));
    MORAY_TRY(check_bounds((struct place){"tf", phase->name}, NULL, 0, spec->tf));
    MORAY_TRY(take_duration(phase, spec->duration));
    MORAY_TRY(take_scheme(phase, spec->scheme));
    MORAY_TRY(copy_mesh(ocp, phase, spec));
    MORAY_TRY(copy_held(ocp, phase, spec));
    MORAY_TRY(copy_names(ocp, spec->x_names, spec->nx, &phase->x_names));
    MORAY_TRY(copy_names(ocp, spec->u_names, spec->nu, &phase->u_names));
    MORAY_TRY(copy_names(ocp, spec->c_names, spec->nc, &phase->c_names));
    const struct {
        const char *what;
        moray_bounds_list list;
        int n;
        const char **names;
        bool required;
        moray_bounds **copy;
    } lists[] = {{"x", spec->x, spec->nx, phase->x_names, false, &phase->x},
                 {"x0", spec->x0, spec->nx, phase->x_names, false, &phase->x0},
                 {"xf", spec->xf, spec->nx, phase->x_names, false, &phase->xf},
                 {"u", spec->u, spec->nu, phase->u_names, false, &phase->u},
                 {"u0", spec->u0, spec->nu, phase->u_names, false, &phase->u0},
                 {"uf", spec->uf, spec->nu, phase->u_names, false, &phase->uf},
                 {"c", spec->c, spec->nc, phase->c_names, true, &phase->c},
                 {"q", spec->q, spec->nq, NULL, false, &phase->q}};
    for (unsigned i = 0; i < sizeof lists / sizeof *lists; i++)
        MORAY_TRY(copy_bounds(ocp, (struct place){lists[i].what, phase->name}, lists[i].list, lists[i].n,
                              lists[i].names, lists[i].required, lists[i].copy));
    MORAY_TRY(narrow_ends(phase));
    return copy_observed(ocp, phase, &spec->observed);
}

static moray_status copy_spec(moray_ocp *ocp, const moray_ocp_spec *spec)
{
    ocp->name = copy_text(ocp, spec->name ? spec->name : "problem");
    ocp->phases = spec->phases, ocp->ns = spec->ns, ocp->ne = spec->ne, ocp->data = spec->data;
    ocp->endpoint_fn = spec->endpoint;
    ocp->endpoint_real_fn = spec->endpoint_real;
    ocp->endpoint = own(ocp, sizeof *ocp->endpoint);
    if (!ocp->name || !ocp->endpoint)
        return no_memory();
    *ocp->endpoint = (struct endpoint){.map = spec->endpoint_map};
    if (spec->phases < 1 || spec->ns < 0 || spec->ne < 0)
        return moray_error(MORAY_INPUT, "problem %s: %d phases, ns %d, ne %d; there must be a phase, none negative",
                           ocp->name, spec->phases, spec->ns, spec->ne);
    if (!!spec->endpoint + !!spec->endpoint_real + !!spec->endpoint_map != 1)
        return moray_error(MORAY_INPUT, "problem %s: needs an endpoint function or a map, and only one", ocp->name);
    MORAY_TRY(copy_names(ocp, spec->s_names, spec->ns, &ocp->s_names));
    MORAY_TRY(copy_names(ocp, spec->e_names, spec->ne, &ocp->e_names));
    MORAY_TRY(copy_bounds(ocp, (struct place){"s", ocp->name}, spec->s, spec->ns, ocp->s_names, false, &ocp->s));
    MORAY_TRY(copy_bounds(ocp, (struct place){"e", ocp->name}, spec->e, spec->ne, ocp->e_names, true, &ocp->e));
    ocp->phase = own(ocp, (size_t)spec->phases * sizeof *ocp->phase);
    ocp->ends = own(ocp, (size_t)spec->phases * sizeof *ocp->ends);
    ocp->real_ends = own(ocp, (size_t)spec->phases * sizeof *ocp->real_ends);
    if (!ocp->phase || !ocp->ends || !ocp->real_ends)
        return no_memory();
    for (int p = 0; p < spec->phases; p++)
        MORAY_TRY(copy_phase(ocp, &spec->phase[p], p));
    const int inputs = moray_endpoint_inputs(ocp);
    if (spec->endpoint_map && (spec->endpoint_map->n_in != inputs || spec->endpoint_map->n_out != 1 + spec->ne))
        return moray_error(MORAY_INPUT, "problem %s: the endpoint map has %d inputs and %d outputs, needs %d and %d",
                           ocp->name, spec->endpoint_map->n_in, spec->endpoint_map->n_out, inputs, 1 + spec->ne);
    return moray_ok();
}

moray_status moray_ocp_new(moray_ocp **result, const moray_ocp_spec *spec)
{
    *result = NULL;
    moray_ocp *ocp = calloc(1, sizeof *ocp);
    if (!ocp)
        return no_memory();
    moray_status status = copy_spec(ocp, spec);
    if (!moray_failed(status))
        status = moray_check_names(ocp);
    if (!moray_failed(status))
        status = moray_wrap_functions(ocp, spec);
    if (moray_failed(status))
        moray_ocp_free(ocp);
    else
        *result = ocp;
    return status;
}

void moray_ocp_free(moray_ocp *ocp)
{
    if (!ocp)
        return;
    moray_unwrap_functions(ocp);
    for (int i = 0; i < ocp->n_owned; i++)
        free(ocp->owned[i]);
    free(ocp->owned);
    free(ocp);
}

moray_status moray_ocp_restart(moray_ocp *ocp, double t, double length, const double *x)
{
    struct phase *phase = &ocp->phase[0];
    if (ocp->phases != 1)
        return moray_error(MORAY_INPUT, "problem %s: has %d phases: must be 1", ocp->name, ocp->phases);
    if (!isfinite(t) || !(length >= 0 && isfinite(length)))
        return moray_error(MORAY_INPUT, "problem %s: start at %g, length %g: must be finite, the length not negative",
                           ocp->name, t, length);
    for (int i = 0; i < phase->nx; i++)
        if (!isfinite(x[i]))
            return moray_error(MORAY_INPUT, "problem %s: start of x[%d] is not finite", ocp->name, i);
    if (length == 0 && phase->tf.upper < t)
        return moray_error(MORAY_INPUT, "problem %s: ends by %g, before its start at %g", ocp->name, phase->tf.upper,
                           t);
    phase->t0 = moray_fixed(t);
    if (length > 0)
        phase->tf = moray_fixed(t + length);
    for (int i = 0; i < phase->nx; i++)
        phase->x0[i] = moray_fixed(x[i]);
    return moray_ok();
}

int moray_ocp_phases(const moray_ocp *ocp)
{
    return ocp->phases;
}

void moray_ocp_widths(const moray_ocp *ocp, int phase, int *nx, int *nu)
{
    *nx = ocp->phase[phase].nx;
    *nu = ocp->phase[phase].nu;
}
