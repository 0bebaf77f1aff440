// SPDX-License-Identifier: MIT
//
// What a summary leaves in a store: which of its numbers, under which names; and which of two answers stays.
#include "tap.h"

#include <string.h>

#include "sweep/sweep.h"

static moray_sweep_spec spec = {.objective = "cost"};
static const struct grid grid = {.spec = &spec, .points = 3};

static bool add(struct store *store, const struct record *attempt, const char *found)
{
    struct record record = *attempt;
    bool better = false;
    CHECK_OK(moray_json_on_one_line(found, &record.found, &record.read), "a summary");
    CHECK_OK(moray_store_add(store, &record, &better), "is taken in");
    free(record.found);
    record.found = NULL, record.reason = NULL;
    moray_record_free(&record);
    return better;
}

static double number(const struct store *store, const char *name, long point)
{
    for (int k = 0; k < store->n; k++)
        if (strcmp(store->name[k], name) == 0)
            return store->value[k][point];
    return INFINITY; // no such column
}

// Lower by more than a millionth of what was there, or a number where there was none.
static void test_rounding(void)
{
    static const struct {
        double before, after;
        bool better;
    } cases[] = {{-2, -2 - 1e-6, false}, {-2, -2 - 3e-6, true}, {-2, -2 + 1e-6, false},   {2, 2 - 1e-6, false},
                 {2, 2 - 3e-6, true},    {0, 0, false},         {0, -1e-300, true},       {NAN, 5, true},
                 {NAN, NAN, false},      {3, NAN, false},       {-1e6, -1e6 - 0.5, false}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct store store;
        char text[2][60];
        const double both[2] = {cases[k].before, cases[k].after};
        for (int i = 0; i < 2; i++)
            snprintf(text[i], sizeof text[i], isnan(both[i]) ? "{}" : "{\"cost\": %.17g}", both[i]);
        CHECK_OK(moray_store_new(&store, &grid), "a store");
        add(&store, &(const struct record){.task = {.point = 2, .start = -1}}, text[0]);
        CHECK(add(&store, &(const struct record){.task = {.point = 2, .start = 1}}, text[1]) == cases[k].better,
              "%s after %s", text[1], text[0]);
        const double kept = both[cases[k].better], other = both[!cases[k].better];
        CHECK(store.objective[2] == kept || (isnan(kept) && isnan(store.objective[2])), "which is kept");
        CHECK(store.other[2] == other || (isnan(other) && isnan(store.other[2])), "and the other one beside it");
        CHECK(store.start[2] == (cases[k].better ? 1 : -1), "with where it began");
        moray_store_free(&store);
    }
}

// A failure, another, a solution, and a third failure.
static void test_failures(void)
{
    struct store store;
    char reason[] = "far off";
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    const struct record failed = {
        .task = {.point = 1, .start = 2}, .code = MORAY_NOT_SOLVED, .seconds = 0.5, .reason = reason};
    const struct record again = {.task = {.point = 1, .start = -1}, .code = MORAY_INPUT, .seconds = 2};
    const struct record solved = {.task = {.point = 1, .start = 0, .round = 2}, .code = MORAY_OK, .seconds = 8};
    CHECK(add(&store, &failed, "{\"cost\": -7, \"left\": 3}"), "a failure is better than nothing");
    CHECK(store.state[1] == POINT_FAILED && store.code[1] == MORAY_NOT_SOLVED && store.start[1] == 2 &&
              store.round[1] == 0 && strcmp(store.reason[1], "far off") == 0,
          "with its reason");
    CHECK(store.objective[1] == -7 && number(&store, "left", 1) == 3 && isnan(number(&store, "left", 0)),
          "and its numbers");
    CHECK(!add(&store, &again, "{\"cost\": -9}"), "another one is no better");
    CHECK(store.code[1] == MORAY_NOT_SOLVED && store.objective[1] == -7 && store.seconds[1] == 2.5 &&
              isnan(store.other[1]),
          "and takes time alone: %g", store.seconds[1]);
    CHECK(add(&store, &solved, "{\"cost\": 4, \"right\": 1}"), "a solution is better than a failure");
    CHECK(store.state[1] == POINT_SOLVED && store.code[1] == MORAY_OK && store.start[1] == 0 && store.round[1] == 2 &&
              strcmp(store.reason[1], "") == 0 && store.objective[1] == 4 && isnan(store.other[1]),
          "whatever it costs");
    CHECK(isnan(number(&store, "left", 1)) && number(&store, "right", 1) == 1, "and its numbers replace the others");
    CHECK(!add(&store, &failed, "{\"cost\": -7}") && store.state[1] == POINT_SOLVED && isnan(store.other[1]) &&
              store.seconds[1] == 11,
          "a failure does not come back: %g s", store.seconds[1]);
    CHECK(store.state[0] == POINT_UNTRIED && store.state[2] == POINT_UNTRIED && store.seconds[0] == 0, "nor elsewhere");
    moray_store_free(&store);
}

static void test_names(void)
{
    static const char found[] =
        "{\"cost\": 1, \"yes\": true, \"no\": false, \"word\": \"w\", \"null\": null, \"deep\": {\"er\": {\"n\": -4}},"
        " \"list\": [{\"name\": \"b\", \"model\": \"a\", \"n\": 5}, {\"key\": \"k\", \"n\": 6}, {\"n\": 7},"
        " {\"problem\": \"p\", \"key\": 3, \"n\": 8}], \"plain\": [9, [10, 11]]}";
    static const struct {
        const char *name;
        double value;
    } numbers[] = {{"cost", 1},       {"yes", 1},      {"no", 0},         {"deep.er.n", -4},
                   {"list.a.n", 5},   {"list.k.n", 6}, {"list.2.n", 7},   {"list.p.n", 8},
                   {"list.p.key", 3}, {"plain.0", 9},  {"plain.1.0", 10}, {"plain.1.1", 11}};
    enum { n = sizeof numbers / sizeof *numbers };
    const struct record record = {.task = {.point = 1, .start = -1}};
    struct store store;
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    CHECK(add(&store, &record, found) && store.n == n, "%d numbers", store.n);
    for (int k = 0; k < n; k++)
        CHECK(number(&store, numbers[k].name, 1) == numbers[k].value && isnan(number(&store, numbers[k].name, 2)),
              "%s is %g", numbers[k].name, numbers[k].value);
    moray_store_free(&store);

    static const char *const keep[] = {"list.*", "d*n"};
    spec.keep = keep, spec.keeps = 2, spec.objective = "deep.er.n";
    CHECK_OK(moray_store_new(&store, &grid), "a store");
    CHECK(add(&store, &record, found) && store.n == 6, "of which the file has %d that it is to have", store.n);
    CHECK(number(&store, "list.p.n", 1) == 8 && number(&store, "deep.er.n", 1) == -4 && store.objective[1] == -4,
          "by either pattern");
    spec.keeps = 1;
    const struct record next = {.task = {.point = 2, .start = -1}};
    CHECK(add(&store, &next, found) && isnan(number(&store, "deep.er.n", 2)) && store.objective[2] == -4,
          "what is to be lowered is known where it is not kept, too");
    spec.keep = NULL, spec.keeps = 0, spec.objective = NULL;
    CHECK(add(&store, &(const struct record){.task = {.start = -1}}, found) && isnan(store.objective[0]),
          "nothing is where nothing is named");
    spec.objective = "cost";
    moray_store_free(&store);
}

// Lists of more than 64 are series, not numbers; and names have an end.
static void test_sizes(void)
{
    struct store store;
    const struct record record = {.task = {.point = 0, .start = -1}};
    for (int n = 64; n <= 65; n++) {
        char text[400] = "{\"a\": [";
        for (int k = 0; k < n; k++)
            snprintf(text + strlen(text), sizeof text - strlen(text), k ? ", %d" : "%d", k);
        strcat(text, "], \"b\": 1}");
        CHECK_OK(moray_store_new(&store, &grid), "a store");
        add(&store, &record, text);
        CHECK(store.n == (n == 64 ? 65 : 1) && number(&store, "b", 0) == 1, "of a list of %d: %d", n, store.n);
        CHECK(n > 64 || number(&store, "a.63", 0) == 63, "the last of it");
        moray_store_free(&store);
    }
    for (int length = 253; length <= 254; length++) { // behind "a."
        char text[400], name[260] = "a.";
        memset(name + 2, 'x', (size_t)length);
        name[length + 2] = 0;
        snprintf(text, sizeof text, "{\"a\": {\"%s\": 3}, \"b\": 1}", name + 2);
        CHECK_OK(moray_store_new(&store, &grid), "a store");
        add(&store, &record, text);
        CHECK(number(&store, name, 0) == (length == 253 ? 3 : INFINITY) && number(&store, "b", 0) == 1,
              "a name of %d characters", length + 2);
        moray_store_free(&store);
    }
}

// Points that fill whole pages of memory, behind which there is none of theirs.
static void test_pages(void)
{
    static const struct grid pages = {.spec = &spec, .points = 512};
    const struct record record = {.task = {.point = 511, .start = -1}};
    struct store store;
    CHECK_OK(moray_store_new(&store, &pages), "a store");
    CHECK(add(&store, &record, "{\"a\": 4}") && number(&store, "a", 511) == 4 && isnan(number(&store, "a", 510)),
          "the last point");
    moray_store_free(&store);
    CHECK(!store.reason && !store.value && store.n == 0, "is freed");
}

int main(void)
{
    test_rounding();
    test_failures();
    test_names();
    test_sizes();
    test_pages();
    return tap_done();
}
