// SPDX-License-Identifier: MIT
//
// What the program does around the studies.
#ifndef PROBLEMS_PAPER_MAIN_H
#define PROBLEMS_PAPER_MAIN_H

#include <stdio.h>

#include "paper.h"

typedef struct paper_study {
    const char *name, *summary;
    paper_run *run;
} paper_study;

// A study of this run, and how it ended.
typedef struct paper_chapter {
    const paper_study *study;
    paper_telling telling;
    moray_status status;
} paper_chapter;

extern const char *const paper_reading_names[]; // by paper_reading, NULL-terminated

void paper_release(paper *p); // all that p owns

void paper_print_wrapped(const char *text, FILE *file); // a paragraph in lines of at most 100 columns

// The summary around the objects of the studies: what was run before them, and the end of each.
void paper_json_head(moray_json *json, const paper_settings *settings);
void paper_json_end(moray_json *json, moray_status status);

// summary.json and report.html with --out, --json. Error: MORAY_IO, MORAY_MEMORY.
moray_status paper_report(const paper *p, const paper_chapter *chapters, int n);

#endif
