// SPDX-License-Identifier: MIT
//
// Tables of text: fields with and without quotes, columns by name, numbers, and what is refused, by its line.
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "base/csv.h"

static char path[] = "/tmp/moray-csv-XXXXXX";

static moray_status read_text(moray_csv *csv, const char *text)
{
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
    return moray_csv_read(csv, path, "table");
}

static bool ends_in(const char *text, const char *end)
{
    return strlen(text) >= strlen(end) && strcmp(text + strlen(text) - strlen(end), end) == 0;
}

static const char *field(const moray_csv *csv, int row, int column)
{
    return csv->field[row * csv->columns + column];
}

static void test_fields(void)
{
    moray_csv csv;
    CHECK_OK(
        read_text(&csv, "\n  a , \"b, c\" ,\t\"q\"\"\",d [m/s]\n1,2,3,4\n\n \"x\"\"y\" ,  two words\t,,\"\"\"\"\n"),
        "read");
    CHECK(csv.columns == 4 && csv.rows == 2, "%d columns, %d rows", csv.columns, csv.rows);
    CHECK(csv.names_line == 2 && csv.line[0] == 3 && csv.line[1] == 5, "in lines %d, %d, %d", csv.names_line,
          csv.line[0], csv.line[1]);
    static const char *const names[] = {"a", "b, c", "q\"", "d [m/s]"}, *const row[] = {"x\"y", "two words", "", "\""};
    for (int j = 0; j < 4; j++) {
        CHECK(strcmp(csv.name[j], names[j]) == 0, "column %s", csv.name[j]);
        CHECK(strcmp(field(&csv, 1, j), row[j]) == 0, "field %s", field(&csv, 1, j));
        CHECK(moray_csv_find(&csv, names[j]) == j, "is found");
    }
    int column;
    CHECK(moray_csv_find(&csv, "d") == -1 && moray_csv_find(&csv, "A") == -1, "by the whole name");
    CHECK_OK(moray_csv_find_quantity(&csv, "d", &column), "a quantity");
    CHECK(column == 3, "without its unit: %d", column);
    CHECK_OK(moray_csv_find_quantity(&csv, "a", &column), "a quantity that has none");
    CHECK(column == 0, "is found: %d", column);
    CHECK(moray_csv_find_quantity(&csv, "b", &column).code == MORAY_INPUT, "but not by a part of its name");
    moray_csv_free(&csv);
    moray_csv_free(&csv);
}

static void test_numbers(void)
{
    moray_csv csv;
    double one, numbers[6];
    CHECK_OK(read_text(&csv, "x,y,z\n1,-2e3,0.5\n4,5,six\n7, 8 ,\n"), "read");
    const int wanted[] = {1, 0};
    CHECK_OK(moray_csv_numbers(&csv, wanted, 2, numbers), "two columns");
    const double want[] = {-2000, 1, 5, 4, 8, 7};
    for (int k = 0; k < 6; k++)
        CHECK(numbers[k] == want[k], "in the order asked for: %g", numbers[k]);
    CHECK_OK(moray_csv_number(&csv, 0, 2, &one), "one of them");
    CHECK(one == 0.5, "%g", one);
    moray_status status = moray_csv_number(&csv, 1, 2, &one);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":3: z = six: not a finite number"), "%s", status.text);
    status = moray_csv_number(&csv, 2, 2, &one);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":4: z = (empty): not"), "%s", status.text);
    CHECK(moray_csv_numbers(&csv, (const int[]){0, 2}, 2, numbers).code == MORAY_INPUT, "in any of the columns");
    moray_csv_free(&csv);
}

static void test_match(void)
{
    static const char *const names[] = {"y", "x"};
    moray_csv csv;
    int column[2];
    CHECK_OK(read_text(&csv, "x,y\n1,2\n"), "read");
    CHECK_OK(moray_csv_match(&csv, names, 2, column), "both");
    CHECK(column[0] == 1 && column[1] == 0, "in any order: %d, %d", column[0], column[1]);
    moray_csv_free(&csv);
    CHECK_OK(read_text(&csv, "y,z,x\n1,2,3\n"), "read");
    moray_status status = moray_csv_match(&csv, names, 2, column);
    CHECK(status.code == MORAY_INPUT && ends_in(status.text, ":1: unknown column z: the columns must be y,x"), "%s",
          status.text);
    moray_csv_free(&csv);
    CHECK_OK(read_text(&csv, "y\n1\n"), "read");
    status = moray_csv_match(&csv, names, 2, column);
    CHECK(status.code == MORAY_INPUT && ends_in(status.text, ":1: no column x: the columns must be y,x"), "%s",
          status.text);
    static const char *const long_names[] = {"y", "of_thirty_characters_and_no_less",
                                             "of_forty_characters_and_a_few_more_than",
                                             "of_fifty_characters_and_then_what_remains_to_see", "last"};
    status = moray_csv_match(&csv, long_names, 5, (int[5]){0});
    char list[200], said[300];
    snprintf(list, sizeof list, "y,%s,%s,%s", long_names[1], long_names[2], long_names[3]);
    list[99] = 0; // of its room
    snprintf(said, sizeof said, ":1: no column %s: the columns must be %s", long_names[1], list);
    CHECK(status.code == MORAY_INPUT && ends_in(status.text, said), "as far as there is room: %s", status.text);
    moray_csv_free(&csv);
}

static void test_refused(void)
{
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"", "needs a line of names and a line of values"},
        {"a,b\n", "needs a line of names and a line of values"},
        {"a,b\n1,2\n3\n", ":3: 1 field, but line 1 names 2 columns"},
        {"a,b\n1,2,3\n", ":2: 3 fields, but line 1 names 2 columns"},
        {"a,\n1,2\n", ":1: column 2 has no name"},
        {",b\n1,2\n", ":1: column 1 has no name"},
        {"a,b,a\n1,2,3\n", ":1: column a is named twice"},
        {"a,\"b\n1,2\n", ":1: field 2: quotes must surround the whole field"},
        {"a,b\n1,2\"\n", ":2: field 2: quotes"},
        {"a,b\n\"1\"x,2\n", ":2: field 1: quotes"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        moray_csv csv;
        const moray_status status = read_text(&csv, cases[k].text);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, cases[k].says), "%s", status.text);
        moray_csv_free(&csv);
    }
    moray_csv csv;
    CHECK(moray_csv_read(&csv, "/tmp/moray-no-such-table", "table").code == MORAY_IO, "no file");
    moray_csv_free(&csv);
}

int main(void)
{
    const int handle = mkstemp(path);
    if (handle < 0)
        return 1;
    close(handle);
    test_fields();
    test_numbers();
    test_match();
    test_refused();
    unlink(path);
    return tap_done();
}
