// SPDX-License-Identifier: MIT
//
// Inside the report: what its page is made of.
#ifndef SRC_RESULTS_PAGE_H
#define SRC_RESULTS_PAGE_H

#include "results/results.h"

// The lines of page.css and page.js, each ending with NULL; made by embed.sh.
extern const char *const moray_page_css[], *const moray_page_js[];

// Text with what HTML means by &, < and > taken from it; quotes too, so that it may stand in an attribute.
void moray_html_text(FILE *page, const char *text);
// <NAME>text</NAME>; a paragraph for each line of the text.
void moray_html_element(FILE *page, const char *name, const char *text);
void moray_html_paragraphs(FILE *page, const char *text);
void moray_html_table(FILE *page, const moray_table *table);

// The picture of a figure from "<svg" on, its ids made its own by the number.
void moray_html_figure(FILE *page, FILE *picture, int number);

// The scene with its controls and its data, hidden until the script shows it.
void moray_html_scene(FILE *page, const moray_scene *scene);

#endif
