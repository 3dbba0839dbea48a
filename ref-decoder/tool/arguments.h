/* arguments.h - command lines described by one table, from which both the parser (getopt_long) and
 * the help text are made.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ARGUMENTS_H
#define TED4_ARGUMENTS_H

#include <stdint.h>
#include <stdio.h>

enum { TED4_MAX_ARGUMENTS = 40 };

/* An option. ted4_arguments_next returns its index in the table. */
typedef struct {
    int letter;        /* 'o', or 0: long name only */
    const char *name;  /* "output" */
    const char *value; /* name of its value in the help text; NULL: the option takes no value */
    const char *text;  /* help, in one line of any length */
} ted4_argument;

typedef struct {
    const char *program; /* "ted4dec" */
    const char *usage;   /* "FILE.ted4 [options]" */
    const char *text;    /* what the program does; may have several lines */
    const ted4_argument *table;
    int n;                 /* at most TED4_MAX_ARGUMENTS */
    const char *end;       /* printed after the options: exit codes, examples */
    void (*more)(FILE *f); /* prints more text after end; NULL: nothing */
} ted4_command;

/* Every table contains these two options, -h and -V, which ted4_arguments_next handles itself. */
#define TED4_ARGUMENT_HELP             \
    {                                  \
        'h', "help", NULL, "this text" \
    }
#define TED4_ARGUMENT_VERSION                                                                 \
    {                                                                                         \
        'V', "version", NULL, "print the version, and which kernels are in use (TED4_KERNEL)" \
    }

enum { TED4_ARGUMENTS_END = -1, TED4_ARGUMENTS_BAD = -2, TED4_ARGUMENTS_DONE = -3 };

/* Returns the index in the table of the next option of the command line, and sets *value (NULL if
 * the option takes none). Otherwise returns TED4_ARGUMENTS_END if only operands are left, from
 * argv[optind] on; TED4_ARGUMENTS_DONE if the help text or the version was printed; or
 * TED4_ARGUMENTS_BAD, after a message on stderr, if an option is unknown, a value is missing, the
 * text cannot be printed, or TED4_KERNEL names kernels that this machine cannot run. */
int ted4_arguments_next(const ted4_command *c, int argc, char **argv, const char **value);
void ted4_arguments_help(const ted4_command *c, FILE *f);

enum { TED4_HELP_COLUMNS = 80 };
/* Prints the words of text, which line breaks and spaces separate, in lines of at most
 * TED4_HELP_COLUMNS. Lines after the first one are indented; the caller has printed so many columns
 * of the first one. */
void ted4_arguments_wrap(FILE *f, const char *text, int indent);

/* Reads all of text as a decimal integer within [low, high]. Returns 0, or -1. */
int ted4_arguments_number(const char *text, int64_t low, int64_t high, int64_t *out);
/* Reads n finite numbers separated by commas. Returns 0, or -1. */
int ted4_arguments_floats(const char *text, int n, float *out);

/* Prints "PROGRAM: --NAME: bad value VALUE; expected EXPECTED" on stderr. Returns the exit code of
 * wrong usage (cli.h). */
int ted4_arguments_bad(const char *program, const char *name, const char *value,
                       const char *expected);
/* Does the same for a value that must be an integer within [low, high]; INT64_MAX: no upper
 * bound. */
int ted4_arguments_bad_number(const char *program, const char *name, const char *value, int64_t low,
                              int64_t high);
/* The same for the name of a file to write, if it is "-": elsewhere that is standard
 * output. what: "file" or "folder". Returns 0 if it is another name. */
int ted4_arguments_bad_dash(const char *program, const char *name, const char *value,
                            const char *what);

#endif
