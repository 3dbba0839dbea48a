/* pages.h - manual pages and shell completion, written from the tables from which programs make
 * their help text.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PAGES_H
#define TED4_PAGES_H

#include <stdio.h>

#include "tool/arguments.h"

/* Writes the manual page of the program in mdoc(7). date: as in "November 21, 2026". */
void ted4_pages_man(const ted4_command *c, const char *date, FILE *f);

/* Write what one shell needs to know of the program's options: a branch of bash's case command, a
 * branch of zsh's case command, or commands of fish. */
void ted4_pages_bash(const ted4_command *c, FILE *f);
void ted4_pages_zsh(const ted4_command *c, FILE *f);
void ted4_pages_fish(const ted4_command *c, FILE *f);

/* Writes n bytes of text as mdoc: each sentence begins a line of at most 78 columns. */
void ted4_mdoc_text(FILE *f, const char *text, size_t n);
/* Writes n bytes of text as lines to be printed as they are. */
void ted4_mdoc_literal(FILE *f, const char *text, size_t n);
/* Writes n bytes of text, a single word, as an argument of a macro. */
void ted4_mdoc_word(FILE *f, const char *text, size_t n);

#endif
