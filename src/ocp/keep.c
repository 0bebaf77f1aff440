// SPDX-License-Identifier: MIT
//
// Solutions in files: a line of what it is, one of every phase's mesh, then a line for every variable (x, z_lower,
// z_upper) and for every constraint (lambda).
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/text.h"
#include "ocp/observe/sight.h"
#include "ocp/refinement/refine.h"

static const char *const families[] = {[MORAY_LOBATTO] = "lobatto", [MORAY_RADAU] = "radau", [MORAY_GAUSS] = "gauss"};

// Of the name of a problem that is kept: its first line, if not too long.
static int name_length(const moray_ocp *ocp)
{
    const size_t longest = 200, length = strcspn(ocp->name, "\n");
    return (int)(length < longest ? length : longest);
}

// ---- Saving ----

// Of the first phase: others say where theirs differs.
static moray_family family_of(const struct layout *layout)
{
    return layout->phase[0].mesh.method.family;
}

static void write_meshes(FILE *file, const struct layout *layout, const moray_ocp *ocp)
{
    for (int p = 0; p < layout->phases; p++) {
        const struct mesh *mesh = &layout->phase[p].mesh;
        const bool other = mesh->method.family != family_of(layout);
        fprintf(file, "phase %d %d %d %d intervals %d%s%s\n", ocp->phase[p].nx, ocp->phase[p].nu, ocp->phase[p].nc,
                ocp->phase[p].nq, mesh->intervals, other ? " " : "", other ? families[mesh->method.family] : "");
        for (int k = 0; k < mesh->intervals; k++)
            fprintf(file, "%d %.17g\n", mesh->stages[k], mesh->edge[k + 1]);
    }
}

void moray_solution_write(const moray_solution *solution, FILE *file)
{
    const struct transcription *t = solution->transcription;
    const moray_iterate *it = &solution->iterate;
    const locale_t before = moray_c_locale_begin();
    fprintf(file, MORAY_SOLUTION_MARK " 1 %.*s\nscheme %s phases %d parameters %d events %d\n", name_length(t->ocp),
            t->ocp->name, families[family_of(&t->layout)], t->ocp->phases, t->ocp->ns, t->ocp->ne);
    write_meshes(file, &t->layout, t->ocp);
    fprintf(file, "outcome %d iterations %d seconds %.17g\n", solution->info.outcome, solution->info.iterations,
            solution->info.seconds);
    fprintf(file, "objective %.17g variables %d constraints %d\n", it->objective, t->nlp.n, t->nlp.m);
    for (int j = 0; j < t->nlp.n; j++)
        fprintf(file, "%.17g %.17g %.17g\n", it->x[j], it->z_lower[j], it->z_upper[j]);
    for (int i = 0; i < t->nlp.m; i++)
        fprintf(file, "%.17g\n", it->lambda[i]);
    fprintf(file, "end\n");
    moray_c_locale_end(before);
}

moray_status moray_solution_save(const moray_solution *solution, const char *path)
{
    char temporary[4096];
    if (snprintf(temporary, sizeof temporary, "%s.part", path) >= (int)sizeof temporary)
        return moray_error(MORAY_INPUT, "the path %.60s... is too long", path);
    FILE *file = fopen(temporary, "w");
    if (!file)
        return moray_error(MORAY_IO, "%s: %s", temporary, strerror(errno));
    moray_solution_write(solution, file);
    const bool written = !ferror(file), closed = fclose(file) == 0;
    if (written && closed && rename(temporary, path) == 0)
        return moray_ok();
    const moray_status status = moray_error(MORAY_IO, "%s: %s", path, strerror(errno));
    remove(temporary);
    return status;
}

// ---- Loading ----

struct reader {
    moray_text text;
    const char *line; // the present one, from its first character that is no blank
};

static moray_status damaged(const struct reader *r, const char *expected)
{
    return moray_error(MORAY_INPUT, "%s, line %d: %s expected", moray_path_tail(r->text.path),
                       r->line ? r->text.at : r->text.n + 1, expected);
}

static moray_status next_line(struct reader *r)
{
    r->line = moray_text_next(&r->text);
    if (r->line)
        r->line += strspn(r->line, " \t");
    return r->line ? moray_ok() : damaged(r, "more");
}

static bool is_end(const char *text)
{
    return text[strspn(text, " \t")] == 0;
}

// A line of n numbers and nothing else.
static moray_status read_numbers(struct reader *r, int n, double *numbers)
{
    MORAY_TRY(next_line(r));
    const char *at = r->line;
    for (int i = 0; i < n; i++) {
        char *end;
        numbers[i] = strtod(at, &end);
        if (end == at || !isfinite(numbers[i]))
            return damaged(r, "a finite number");
        at = end;
    }
    return is_end(at) ? moray_ok() : damaged(r, n == 1 ? "one number" : "fewer numbers");
}

// "moray-solution 1" and the name of the problem.
static moray_status read_name(struct reader *r, const moray_ocp *ocp)
{
    int version, used = 0;
    MORAY_TRY(next_line(r));
    if (sscanf(r->line, MORAY_SOLUTION_MARK " %d %n", &version, &used) != 1 || version != 1)
        return damaged(r, MORAY_SOLUTION_MARK " 1");
    const char *name = r->line + used;
    if ((int)strlen(name) != name_length(ocp) || strncmp(name, ocp->name, strlen(name)) != 0)
        return moray_error(MORAY_INPUT, "%s: is of problem %.80s, not of %.80s", moray_path_tail(r->text.path), name,
                           ocp->name);
    return moray_ok();
}

static bool find_family(const char *name, moray_family *family)
{
    for (int f = MORAY_LOBATTO; f <= MORAY_GAUSS; f++)
        if (strcmp(name, families[f]) == 0) {
            *family = (moray_family)f;
            return true;
        }
    return false;
}

static moray_status read_head(struct reader *r, const moray_ocp *ocp, moray_family *family)
{
    char scheme[20];
    int phases, parameters, events, used = 0;
    MORAY_TRY(read_name(r, ocp));
    MORAY_TRY(next_line(r));
    if (sscanf(r->line, "scheme %19s phases %d parameters %d events %d%n", scheme, &phases, &parameters, &events,
               &used) != 4 ||
        !is_end(r->line + used))
        return damaged(r, "scheme, phases, parameters and events");
    if (phases != ocp->phases || parameters != ocp->ns || events != ocp->ne)
        return moray_error(MORAY_INPUT, "%s: has %d phases, %d parameters and %d events; problem %s has %d, %d and %d",
                           moray_path_tail(r->text.path), phases, parameters, events, ocp->name, ocp->phases, ocp->ns,
                           ocp->ne);
    return find_family(scheme, family) ? moray_ok() : damaged(r, "scheme lobatto, radau or gauss");
}

static moray_status read_mesh(struct reader *r, const struct phase *phase, moray_family family, struct mesh *mesh)
{
    char own[20] = "";
    int nx, nu, nc, nq, intervals, used = 0;
    MORAY_TRY(next_line(r));
    if (sscanf(r->line, "phase %d %d %d %d intervals %d%n %19s%n", &nx, &nu, &nc, &nq, &intervals, &used, own, &used) <
            5 ||
        !is_end(r->line + used) || intervals < 1 || intervals > 1000000 || (own[0] && !find_family(own, &family)))
        return damaged(r, "phase nx nu nc nq intervals k");
    if (nx != phase->nx || nu != phase->nu || nc != phase->nc || nq != phase->nq)
        return moray_error(MORAY_INPUT,
                           "%s: a phase of %d states, %d controls, %d path constraints and %d integrals; phase %s has "
                           "%d, %d, %d and %d",
                           moray_path_tail(r->text.path), nx, nu, nc, nq, phase->name, phase->nx, phase->nu, phase->nc,
                           phase->nq);
    MORAY_TRY(moray_mesh_new(mesh, intervals));
    mesh->method.family = family;
    for (int k = 0; k < intervals; k++) {
        double numbers[2];
        MORAY_TRY(read_numbers(r, 2, numbers));
        const bool allowed = numbers[0] >= 1 && numbers[0] <= MORAY_MAX_STAGES && numbers[0] == floor(numbers[0]);
        mesh->stages[k] = allowed ? (int)numbers[0] : 0;
        mesh->edge[k + 1] = numbers[1];
        if (!allowed || !(mesh->edge[k + 1] > mesh->edge[k]))
            return damaged(r, "stages and a later end of the interval");
    }
    return mesh->edge[intervals] == 1 ? moray_ok() : damaged(r, "1 as the end of the last interval");
}

static moray_status read_transcription(struct reader *r, const moray_ocp *ocp, moray_solution *solution)
{
    moray_family family = MORAY_LOBATTO;
    MORAY_TRY(read_head(r, ocp, &family));
    struct mesh *meshes = calloc((size_t)ocp->phases, sizeof *meshes);
    moray_status status = meshes ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d meshes", ocp->phases);
    for (int p = 0; p < ocp->phases && !moray_failed(status); p++)
        status = read_mesh(r, &ocp->phase[p], family, &meshes[p]);
    if (!moray_failed(status))
        status = moray_transcription_new(&solution->transcription, ocp, meshes);
    for (int p = 0; meshes && p < ocp->phases; p++)
        moray_mesh_free(&meshes[p]);
    free(meshes);
    return moray_failed(status) ? status : moray_allocate_iterate(solution);
}

static moray_status read_iterate(struct reader *r, moray_solution *solution)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    moray_iterate *it = &solution->iterate;
    int outcome, n, m, used = 0;
    MORAY_TRY(next_line(r));
    if (sscanf(r->line, "outcome %d iterations %d seconds %lf%n", &outcome, &solution->info.iterations,
               &solution->info.seconds, &used) != 3 ||
        !is_end(r->line + used) || outcome < MORAY_NLP_SOLVED || outcome > MORAY_NLP_INVALID ||
        solution->info.iterations < 0 || !isfinite(solution->info.seconds))
        return damaged(r, "outcome, iterations and seconds");
    solution->info.outcome = (moray_nlp_outcome)outcome;
    MORAY_TRY(next_line(r));
    if (sscanf(r->line, "objective %lf variables %d constraints %d%n", &it->objective, &n, &m, &used) != 3 ||
        !is_end(r->line + used) || !isfinite(it->objective))
        return damaged(r, "objective, variables and constraints");
    if (n != nlp->n || m != nlp->m)
        return moray_error(MORAY_INPUT, "%s: has %d variables and %d constraints, the problem %d and %d on this mesh",
                           moray_path_tail(r->text.path), n, m, nlp->n, nlp->m);
    for (int j = 0; j < n; j++) {
        double numbers[3];
        MORAY_TRY(read_numbers(r, 3, numbers));
        it->x[j] = numbers[0], it->z_lower[j] = numbers[1], it->z_upper[j] = numbers[2];
    }
    for (int i = 0; i < m; i++)
        MORAY_TRY(read_numbers(r, 1, &it->lambda[i]));
    MORAY_TRY(next_line(r));
    if (strncmp(r->line, "end", 3) != 0 || !is_end(r->line + 3))
        return damaged(r, "the end");
    return moray_text_next(&r->text) ? damaged(r, "nothing after the end") : moray_ok();
}

moray_status moray_complete_solution(moray_solution *solution)
{
    struct transcription *t = solution->transcription;
    double error = NAN;
    memcpy(solution->guess, solution->iterate.x, (size_t)t->nlp.n * sizeof *solution->guess);
    if (!moray_transcription_jacobians(t, solution->iterate.x))
        return moray_error(MORAY_NUMERIC, "at this solution, %s", t->failure.text);
    solution->history = calloc(1, sizeof *solution->history);
    if (!solution->history)
        return moray_error(MORAY_MEMORY, "no memory for a history");
    if (moray_is_solved(solution))
        MORAY_TRY(moray_refine(solution, solution->settings.mesh_tolerance, NULL, &error));
    solution->history[solution->meshes++] = moray_record_of(solution, error);
    moray_diagnose(solution);
    return moray_ok();
}

// Data that move are seen in intervals that the times in the file tell: the same columns and rows.
static moray_status place_data(moray_solution *solution)
{
    struct transcription *old = solution->transcription;
    const moray_ocp *ocp = old->ocp;
    struct mesh *meshes = calloc((size_t)ocp->phases, sizeof *meshes);
    if (!meshes)
        return moray_error(MORAY_MEMORY, "no memory for %d meshes", ocp->phases);
    for (int p = 0; p < ocp->phases; p++)
        meshes[p] = old->layout.phase[p].mesh;
    moray_status status = moray_ok();
    if (!moray_transcription_values(old, solution->iterate.x))
        status = moray_error(MORAY_NUMERIC, "at this solution, %s", old->failure.text);
    else if (moray_sights_left(old, meshes)) {
        status = moray_transcription_new(&solution->transcription, ocp, meshes);
        moray_transcription_free(old);
    }
    free(meshes);
    return status;
}

static moray_status load(moray_solution *solution, const moray_ocp *ocp, const char *path)
{
    struct reader reader;
    moray_status status = moray_text_read(&reader.text, path, "solution");
    if (!moray_failed(status))
        status = read_transcription(&reader, ocp, solution);
    if (!moray_failed(status))
        status = read_iterate(&reader, solution);
    moray_text_free(&reader.text);
    if (!moray_failed(status))
        status = place_data(solution);
    return moray_failed(status) ? status : moray_complete_solution(solution);
}

moray_status moray_solution_load(moray_solution **result, const moray_ocp *ocp, const moray_settings *settings,
                                 const char *path)
{
    *result = NULL;
    moray_solution *solution = calloc(1, sizeof *solution);
    if (!solution)
        return moray_error(MORAY_MEMORY, "no memory for a solution");
    solution->settings = settings ? *settings : moray_settings_default();
    const locale_t before = moray_c_locale_begin();
    const moray_status status = load(solution, ocp, path);
    moray_c_locale_end(before);
    if (moray_failed(status))
        moray_solution_free(solution);
    else
        *result = solution;
    return status;
}
