// SPDX-License-Identifier: MIT
//
// Inside the application layer: the rows of one program, and what the command line and the INI file do with them.
#ifndef SRC_OPTIONS_OPTIONS_H
#define SRC_OPTIONS_OPTIONS_H

#include "moray/app/options.h"

// The program's rows followed by those of its groups and of moray_common, all from the start of its settings.
typedef struct moray_options {
    const moray_option *row;
    int n;
    const moray_words *words;   // NULL: none
    const char *program;        // its name
    const char *const *without; // as of moray_program
    moray_option *own;          // the rows, where they were put together
} moray_options;

// Error: MORAY_MEMORY. Free own with free().
moray_status moray_options_new(moray_options *options, const moray_program *program);

extern const moray_option_table moray_common_table; // the rows of moray_common

// The row with this key; NULL when there is none, and the error that then names the nearest key.
const moray_option *moray_option_find(const moray_options *options, const char *key);
moray_status moray_option_unknown(const moray_options *options, const char *key);

// The error for a flag, "--" before it, or a key that other programs have and this one has no use for; else ok.
moray_status moray_option_unused(const moray_options *options, const char *name);

// The row for ipopt.KEY, where the program has one; `text` begins with the key.
const moray_option *moray_option_find_ipopt(const moray_options *options, const char *text);

// Sets one option of Ipopt, given as KEY=VALUE, in the list; a later value takes the place of an earlier one. Error:
// MORAY_INPUT naming it.
moray_status moray_ipopt_list_set(moray_ipopt_list *list, const char *text);
bool moray_ipopt_list_has(const moray_ipopt_list *list, const char *key);

// Number of characters to insert, delete or replace to make b of a; texts beyond 63 bytes are infinitely far (INT_MAX).
int moray_edit_distance(const char *a, const char *b);
bool moray_is_near(int distance, const char *text); // near enough to be suggested for text

// Reads text into the row's destination. `name` is the option as the user wrote it, for the message.
// Error: MORAY_INPUT "name = text: must be ...".
moray_status moray_option_read(const moray_option *row, const char *name, const char *text, void *settings);

// The allowed interval in the row's unit, and the factor from that unit to the stored one.
void moray_option_bounds(const moray_option *row, double *min, double *max);
double moray_option_scale(const moray_option *row);

// A number in the row's unit that reads back as the same stored double, or one beside it where none does.
void moray_option_show_exactly(const moray_option *row, double value, char text[32]);

// Lists. Reading is false where the text is none; writing gives lines of an INI file that read back as the same.
bool moray_list_read(const moray_option *row, const char *text, double *to);
int moray_list_length(const double *list, int most);
void moray_list_write(const moray_option *row, const double *list, FILE *file);

enum { MORAY_SHOWN_SIZE = 200 };

// What is allowed, as in "must be ..."; and the present value, false when there is none to show.
void moray_option_allowed(const moray_option *row, char text[MORAY_SHOWN_SIZE]);
bool moray_option_default(const moray_option *row, const void *settings, char text[MORAY_SHOWN_SIZE]);

// What --help says of a row (what it is; what is allowed; its present value), the name of its argument, what it says of
// the flags that no table has, and at the end.
enum { MORAY_TEXT_SIZE = 700 };
void moray_option_text(const moray_option *row, const void *settings, char text[MORAY_TEXT_SIZE]);
const char *moray_option_argument(const moray_option *row);
typedef struct moray_fixed_flag {
    const char *flag, *argument, *help;
} moray_fixed_flag;
extern const moray_fixed_flag moray_fixed_flags[]; // ends with a zeroed one
extern const char *const moray_help_notes[];       // ends with NULL

// Whether the word is on the list, and the error that then names the nearest one.
bool moray_word_known(const moray_words *words, const char *name);
moray_status moray_word_unknown(const moray_words *words, const char *name);

// Marks a known word, or all, as given. Error of the check: MORAY_INPUT when none is.
void moray_word_mark(const moray_words *words, const char *name, void *settings);
moray_status moray_words_check(const moray_words *words, const void *settings);

// What the command line said, in its order; by_flag tells --flag VALUE from --set KEY=VALUE. A word has no row.
typedef struct moray_assignment {
    const moray_option *row;
    bool by_flag;
    const char *value;
} moray_assignment;

typedef struct moray_arguments {
    moray_assignment *item;
    int n;
    moray_request request;
} moray_arguments;

// Values point into argv. Error: MORAY_INPUT, MORAY_MEMORY. free(item) in any case.
moray_status moray_arguments_read(moray_arguments *arguments, const moray_options *options, int argc, char **argv);

// Writes [run], which names the program and its words, and every key with its value; given[n] tells the rows that have
// one. Then, when all is finished, what the others have become, as comments.
void moray_options_write(const moray_options *options, const void *settings, FILE *file, bool *given);
void moray_options_write_rest(const moray_options *options, const void *settings, FILE *file, const bool *given);

// moray_app_parse that also writes both to *ini, to be freed with free(), where --out is given; else NULL.
moray_status moray_options_parse(const moray_program *program, int argc, char **argv, void *settings,
                                 moray_request *request, char **ini);

// Sets the keys that the INI file of the row, or that of its run, gives. Error: MORAY_INPUT or MORAY_IO, with file and
// line.
moray_status moray_ini_read(const moray_options *options, const moray_option *from, const char *given, void *settings);

#endif
