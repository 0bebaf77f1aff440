// SPDX-License-Identifier: MIT
//
// One dialect: every reader takes the same forms and refuses the same faults, in whatever locale the process is.
#include "readers.h"

#include <locale.h>
#include <string.h>
#include <unistd.h>

// ---- Files: in a text, A and B stand for the names of the columns, @ for a NUL byte, ~ for 200000 blanks ----

static void put(const char *text, const struct reader *reader)
{
    FILE *file = fopen(file_name, "w");
    if (!file)
        exit(1);
    for (const char *c = text; *c; c++)
        if (*c == 'A' || *c == 'B')
            fputs(*c == 'A' ? reader->one : reader->other, file);
        else if (*c == '~')
            fprintf(file, "%200000s", "");
        else
            fputc(*c == '@' ? 0 : *c, file);
    if (fclose(file) != 0)
        exit(1);
}

static const char plain[] = "A,B\n0,1.5\n0.25,2\n1,3e0\n";

static const struct {
    const char *what, *text;
} good[] = {{"a byte-order mark", "\xEF\xBB\xBF"
                                  "A,B\n0,1.5\n0.25,2\n1,3e0\n"},
            {"CR LF", "A,B\r\n0,1.5\r\n0.25,2\r\n1,3e0\r\n"},
            {"CR alone", "A,B\r0,1.5\r0.25,2\r1,3e0\r"},
            {"no last end of line", "A,B\n0,1.5\n0.25,2\n1,3e0"},
            {"blanks around fields", " A , B \n0, 1.5\n\t0.25 ,2\t\n 1 , 3e0 \n"},
            {"blank lines", "\n \t\nA,B\n\n0,1.5\n0.25,2\n\n\n1,3e0\n\n"},
            {"comments", "# said, and more\nA,B\n0,1.5\n # \"said\n0.25,2\n1,3e0\n#"},
            {"quoted fields", "\"A\",\"B\"\n0,\"1.5\"\n \"0.25\" ,2\n1,3e0\n"},
            {"columns in another order", "B,A\n1.5,0\n2,0.25\n3e0,1\n"},
            {"other spellings of numbers", "A,B\n-0.0,+1.50\n25e-2,2.\n1E0,3\n"}},
  bad[] = {{"a doubled column", "A,B,B\n0,1,2\n1,2,3\n"},
           {"a name that only begins right", "A,Bm\n0,1\n1,2\n"},
           {"a name of other case or blanks", "A,B b\n0,1\n1,2\n"},
           {"a missing column", "B\n0\n1\n"},
           {"a column without a name", "A,B,\n0,1,\n1,2,\n"},
           {"a surplus field", "A,B\n0,1\n1,2,3\n"},
           {"a decimal comma", "A,B\n0,1\n0,5,2\n"},
           {"a comma at the end", "A,B\n0,1,\n1,2,\n"},
           {"a missing field", "A,B\n0,1\n1\n"},
           {"semicolons", "A;B\n0;1\n1;2\n"},
           {"a word", "A,B\n0,one\n1,2\n"},
           {"a number and more", "A,B\n0,1 2\n1,2\n"},
           {"a number and its unit", "A,B\n0,1m\n1,2\n"},
           {"a grouped number", "A,B\n0,1'000\n1,2\n"},
           {"not a number", "A,B\n0,nan\n1,2\n"},
           {"infinity", "A,B\n0,inf\n1,2\n"},
           {"too large a number", "A,B\n0,1e999\n1,2\n"},
           {"a hexadecimal number", "A,B\n0,0x10\n1,2\n"},
           {"a quote that does not close", "A,B\n0,\"1\n1,2\n"},
           {"text behind a quote", "A,B\n0,\"1\"2\n1,2\n"},
           {"a NUL byte", "A,B\n0,1@\n1,2\n"},
           {"UTF-16", "\xFF\xFE"
                      "A@,@B@\n@0@,@1@\n@1@,@2@\n@"},
           {"a line without end", "A,B\n0,1~\n1,2\n"},
           {"an empty file", ""},
           {"only names", "A,B\n"},
           {"only comments", "# A,B\n"}};

static void test_table(const struct reader *reader)
{
    double wanted = 0, found;
    put(plain, reader);
    CHECK_OK(reader->read(&wanted), reader->name);
    CHECK(wanted != 0 && isfinite(wanted), "%s: %g", reader->name, wanted);
    for (unsigned i = 0; i < sizeof good / sizeof *good; i++) {
        put(good[i].text, reader);
        found = 0;
        const moray_status status = reader->read(&found);
        CHECK(!moray_failed(status) && found == wanted, "%s with %s: %s", reader->name, good[i].what, status.text);
    }
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++) {
        put(bad[i].text, reader);
        const moray_status status = reader->read(&found);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, file_name), "%s with %s: %s", reader->name, bad[i].what,
              status.text);
    }
    put("A,B\n0,1\n2,1\n1,2\n", reader);
    const moray_status status = reader->read(&found);
    CHECK(!reader->ascends || (status.code == MORAY_INPUT && strstr(status.text, ":4: ")),
          "%s with times that descend: %s", reader->name, status.text);
    unlink(file_name);
    CHECK(reader->read(&found).code == MORAY_IO, "%s that is not there", reader->name);
}

// ---- INI files ----

static void test_ini(void)
{
    static const struct reader ini = {.name = "INI"};
    static const char *const forms[] = {
        "[test]\naa = 1.5\nbb = 2\n",        "\xEF\xBB\xBF[test]\naa = 1.5\nbb = 2\n",
        "[test]\r\naa = 1.5\r\nbb = 2\r\n",  "[test]\raa = 1.5\rbb = 2\r",
        "\n[test]\n\n\taa=1.5\n bb  =  2",   "# said\n[test]\n; more\naa = 1.5 ; so\nbb = 2\n",
        "[test]\naa = 15e-1\nbb = +2.0 \t\n"};
    static const char *const faults[] = {"[test]\naa = 1,5\n",
                                         "[test]\naa = 1\naa = 1\n",
                                         "[test]\naa = 0x10\n",
                                         "[test]\naa = nan\n",
                                         "[test]\naa = 1 2\n",
                                         "[test]\naa = 1@\n",
                                         "[test]\naa\n",
                                         "[test]\naa = 1~x\n",
                                         "[test]\naa =\n",
                                         "[test]\raa = 1\raz\r",
                                         "aa = 1\n",
                                         "[test\naa = 1\n"};
    for (unsigned i = 0; i < sizeof forms / sizeof *forms; i++) {
        double found;
        put(forms[i], &ini);
        const moray_status status = read_ini(&found);
        CHECK(!moray_failed(status) && found == 6.5, "INI form %u: %g, %s", i + 1, found, status.text);
    }
    for (unsigned i = 0; i < sizeof faults / sizeof *faults; i++) {
        double found;
        put(faults[i], &ini);
        const moray_status status = read_ini(&found);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, file_name), "INI fault %u: %s", i + 1, status.text);
    }
    unlink(file_name);
}

// ---- A host with another locale ----

static void test_locale(void)
{
    if (system("localedef --no-archive -i de_DE -f UTF-8 ./de_DE.UTF-8 >test_readers.log 2>&1") != 0 ||
        setenv("LOCPATH", ".", 1) != 0 || !setlocale(LC_ALL, "de_DE.UTF-8") || strtod("1,5", NULL) != 1.5) {
        CHECK(true, "decimal commas of the host # SKIP no localedef");
        return;
    }
    for (int i = 0; i < n_readers; i++)
        test_table(&readers[i]);
    test_ini();
    char number[32];
    CHECK(strcmp(moray_number_text(1.5, number), "1.5") == 0, "numbers of results: %s", number);
    moray_solution *solution = NULL, *loaded = NULL;
    const moray_settings s = moray_settings_default();
    CHECK_OK(moray_solve(ocp, &s, NULL, &solution), "solved in that locale");
    CHECK_OK(moray_solution_save(solution, file_name), "saved in that locale");
    setlocale(LC_ALL, "C");
    CHECK_OK(moray_solution_load(&loaded, ocp, &s, file_name), "loaded in another");
    CHECK(moray_solution_objective(loaded) == moray_solution_objective(solution), "the same");
    moray_solution_free(loaded);
    moray_solution_free(solution);
    unlink(file_name);
}

int main(void)
{
    char directory[] = "/tmp/moray-readers-XXXXXX";
    if (!mkdtemp(directory) || chdir(directory) != 0)
        return 1;
    make_problem();
    for (int i = 0; i < n_readers; i++)
        test_table(&readers[i]);
    test_ini();
    test_locale();
    moray_ocp_free(ocp);
    char command[100];
    snprintf(command, sizeof command, "rm -r %s", directory);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left");
    return tap_done();
}
