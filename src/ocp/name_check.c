// SPDX-License-Identifier: MIT
//
// Names stand in messages and as columns of files: each must be one line, and no two of a scope the same.
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "ocp/names.h"

enum { longest = 100 };

// A list of names of one kind, called letter[i] where they have none.
struct list {
    const char *kind, *letter;
    const char **names;
    int n;
};

static moray_status check_name(const char *kind, const char *where, int i, const char *name)
{
    const size_t length = strlen(name);
    if (length == 0)
        return moray_error(MORAY_INPUT, "%s %d of %s: its name is empty", kind, i, where);
    if (length > longest)
        return moray_error(MORAY_INPUT, "%s %d of %s: its name %.40s... is longer than %d bytes", kind, i, where, name,
                           (int)longest);
    for (const char *c = name; *c; c++)
        if (iscntrl((unsigned char)*c))
            return moray_error(MORAY_INPUT, "%s %d of %s: its name holds a control character, byte %d", kind, i, where,
                               (int)(c - name) + 1);
    if (name[0] == ' ' || name[length - 1] == ' ' || strstr(name, " ["))
        return moray_error(MORAY_INPUT, "%s %d of %s: its name \"%s\" %s", kind, i, where, name,
                           strstr(name, " [") ? "holds \" [\", which begins a unit" : "begins or ends with a blank");
    return moray_ok();
}

static void name_of(const struct list *list, int i, char name[longest + 1])
{
    if (list->names)
        snprintf(name, longest + 1, "%s", list->names[i]);
    else
        snprintf(name, longest + 1, "%s[%d]", list->letter, i);
}

// The i-th name against those of the list before it, and all of `other`.
static moray_status check_distinct(const struct list *list, int i, const struct list *other, const char *where)
{
    char name[longest + 1], earlier[longest + 1];
    name_of(list, i, name);
    for (int k = 0; k < i; k++) {
        name_of(list, k, earlier);
        if (strcmp(name, earlier) == 0)
            return moray_error(MORAY_INPUT, "%ss %d and %d of %s are both named %s", list->kind, k, i, where, name);
    }
    for (int k = 0; other && k < other->n; k++) {
        name_of(other, k, earlier);
        if (strcmp(name, earlier) == 0)
            return moray_error(MORAY_INPUT, "%s %d and %s %d of %s are both named %s", other->kind, k, list->kind, i,
                               where, name);
    }
    return moray_ok();
}

static moray_status check_list(const struct list *list, const struct list *other, const char *where)
{
    for (int i = 0; i < list->n; i++) {
        if (list->names)
            MORAY_TRY(check_name(list->kind, where, i, list->names[i]));
        MORAY_TRY(check_distinct(list, i, other, where));
    }
    return moray_ok();
}

// Files have columns of these names themselves.
static moray_status check_reserved(const struct list *list, const char *where, bool phases)
{
    for (int i = 0; list->names && i < list->n; i++)
        if (strcmp(list->names[i], "t") == 0 || (phases && strcmp(list->names[i], "phase") == 0))
            return moray_error(MORAY_INPUT, "%s %d of %s is named %s, as is the column of the %s in files", list->kind,
                               i, where, list->names[i], *list->names[i] == 't' ? "time" : "phases");
    return moray_ok();
}

static moray_status check_phase(const struct phase *phase, bool several)
{
    const struct list x = {"state", "x", phase->x_names, phase->nx}, u = {"control", "u", phase->u_names, phase->nu},
                      c = {"path constraint", "c", phase->c_names, phase->nc},
                      y = {"observation", "y", phase->observed.names, phase->observed.ny};
    char where[2 * longest];
    snprintf(where, sizeof where, "phase %s", phase->name);
    MORAY_TRY(check_list(&x, NULL, where));
    MORAY_TRY(check_list(&u, &x, where));
    MORAY_TRY(check_list(&c, NULL, where));
    MORAY_TRY(check_list(&y, NULL, where));
    MORAY_TRY(check_reserved(&x, where, several));
    return check_reserved(&u, where, several);
}

moray_status moray_check_names(const moray_ocp *ocp)
{
    const struct list s = {"parameter", "s", ocp->s_names, ocp->ns}, e = {"event", "e", ocp->e_names, ocp->ne};
    char where[2 * longest];
    MORAY_TRY(check_name("problem", "moray_ocp_new", 0, ocp->name));
    snprintf(where, sizeof where, "problem %s", ocp->name);
    MORAY_TRY(check_list(&s, NULL, where));
    MORAY_TRY(check_list(&e, NULL, where));
    for (int p = 0; p < ocp->phases; p++) {
        MORAY_TRY(check_name("phase", where, p, ocp->phase[p].name));
        for (int k = 0; k < p; k++)
            if (strcmp(ocp->phase[k].name, ocp->phase[p].name) == 0)
                return moray_error(MORAY_INPUT, "phases %d and %d of %s are both named %s", k, p, where,
                                   ocp->phase[p].name);
        MORAY_TRY(check_phase(&ocp->phase[p], ocp->phases > 1));
    }
    return moray_ok();
}
