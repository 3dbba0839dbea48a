/* arguments.h - command lines from one table: parsing (getopt_long) and the help text are made from
 * the same lines.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ARGUMENTS_H
#define TED4_ARGUMENTS_H

#include <stdint.h>
#include <stdio.h>

enum { TED4_MAX_ARGUMENTS = 40 };

/* An option. Its place in the table is the number that ted4_arguments_next returns. */
typedef struct {
    int letter;        /* 'o', or 0: long name only */
    const char *name;  /* "output" */
    const char *value; /* what the help calls its value; NULL: it takes none */
    const char *text;  /* one line of help */
} ted4_argument;

typedef struct {
    const char *program; /* "ted4dec" */
    const char *usage;   /* "FILE.ted4 [options]" */
    const char *text;    /* what it does; more lines may follow */
    const ted4_argument *table;
    int n;                 /* at most TED4_MAX_ARGUMENTS */
    const char *end;       /* printed after the options: exit codes, examples */
    void (*more)(FILE *f); /* prints what follows that; NULL: nothing */
} ted4_command;

/* Every table has these two, -h and -V: ted4_arguments_next answers them itself. */
#define TED4_ARGUMENT_HELP             \
    {                                  \
        'h', "help", NULL, "this text" \
    }
#define TED4_ARGUMENT_VERSION                                                                 \
    {                                                                                         \
        'V', "version", NULL, "print the version, and which kernels are in use (TED4_KERNEL)" \
    }

enum { TED4_ARGUMENTS_END = -1, TED4_ARGUMENTS_BAD = -2, TED4_ARGUMENTS_DONE = -3 };

/* Next option of the command line: its place in the table, with *value set (NULL if it takes none);
 * TED4_ARGUMENTS_END: only operands are left, from argv[optind] on; TED4_ARGUMENTS_BAD: unknown
 * option or missing value, or kernels in the environment that this machine does not have, already
 * said on stderr; TED4_ARGUMENTS_DONE: help or version was printed. */
int ted4_arguments_next(const ted4_command *c, int argc, char **argv, const char **value);
void ted4_arguments_help(const ted4_command *c, FILE *f);

/* Whole text as a number within [low, high]: 0, or -1. */
int ted4_arguments_number(const char *text, int64_t low, int64_t high, int64_t *out);
/* n finite numbers with commas between: 0, or -1. */
int ted4_arguments_floats(const char *text, int n, float *out);

#endif
