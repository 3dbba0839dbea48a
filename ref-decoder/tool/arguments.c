/* arguments.c - see arguments.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "arguments.h"

#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/level.h"
#include "cli.h"
#include "similar.h"
#include "ted4.h"

/* getopt_long returns this number plus the index of the option for a long option. */
enum { FIRST_LONG = 256 };

static void make_getopt(const ted4_command *c, struct option *longs, char *letters)
{
    char *p = letters;

    for (int i = 0; i < c->n; i++) {
        const ted4_argument *const a = &c->table[i];

        longs[i] = (struct option) { a->name, a->value != NULL ? required_argument : no_argument,
                                     NULL, FIRST_LONG + i };
        if (a->letter != 0) {
            *p++ = (char)a->letter;
            if (a->value != NULL)
                *p++ = ':';
        }
    }
    longs[c->n] = (struct option) { NULL, 0, NULL, 0 };
    *p = '\0';
}

static int answer(const ted4_command *c, int i)
{
    if (c->table[i].letter == 'h')
        ted4_arguments_help(c, stdout);
    else if (c->table[i].letter == 'V' && ted4_cli_kernels(c->program) != 0)
        return TED4_ARGUMENTS_BAD;
    else if (c->table[i].letter == 'V')
        printf("%s " TED4_VERSION " (specification " TED4_SPEC_VERSION "), kernels %s\n",
               c->program, ted4_level_name(ted4_level_wanted()));
    else
        return i;
    return ted4_cli_end(c->program, TED4_EXIT_FINE) == TED4_EXIT_FINE ? TED4_ARGUMENTS_DONE
                                                                      : TED4_ARGUMENTS_BAD;
}

/* Suggests a similar option after getopt has refused one and printed its message. */
static void suggest(const ted4_command *c, const char *word)
{
    if (strncmp(word, "--", 2) != 0)
        return;

    ted4_similar s = ted4_similar_to(word + 2, strcspn(word + 2, "="));

    for (int i = 0; i < c->n; i++)
        ted4_similar_try(&s, c->table[i].name);
    if (s.best != NULL && s.distance > 0)
        fprintf(stderr, "%s: did you mean --%s?\n", c->program, s.best);
}

int ted4_arguments_next(const ted4_command *c, int argc, char **argv, const char **value)
{
    struct option longs[TED4_MAX_ARGUMENTS + 1];
    char letters[2 * TED4_MAX_ARGUMENTS + 1];

    ted4_cli_begin();
    make_getopt(c, longs, letters);
    const int found = getopt_long(argc, argv, letters, longs, NULL);

    *value = optarg;
    if (found == -1)
        return ted4_cli_kernels(c->program) == 0 ? TED4_ARGUMENTS_END : TED4_ARGUMENTS_BAD;
    if (found >= FIRST_LONG)
        return answer(c, found - FIRST_LONG);
    for (int i = 0; i < c->n; i++)
        if (c->table[i].letter == found)
            return answer(c, i);
    if (optopt == 0 && optind > 1)
        suggest(c, argv[optind - 1]);
    return TED4_ARGUMENTS_BAD;
}

void ted4_arguments_wrap(FILE *f, const char *text, int indent)
{
    int column = indent;

    for (text += strspn(text, " \n"); *text != '\0'; text += strspn(text, " \n")) {
        const int n = (int)strcspn(text, " \n");

        if (column > indent && column + 1 + n > TED4_HELP_COLUMNS) {
            fprintf(f, "\n%*s", indent, "");
            column = indent;
        }
        if (column > indent)
            fputc(' ', f);
        column += n + (column > indent);
        fprintf(f, "%.*s", n, text);
        text += n;
    }
    fputc('\n', f);
}

void ted4_arguments_help(const ted4_command *c, FILE *f)
{
    int widest = 0;

    for (int i = 0; i < c->n; i++) {
        const ted4_argument *const a = &c->table[i];
        const int width = (int)(strlen(a->name) + (a->value != NULL ? strlen(a->value) + 1 : 0));

        widest = width > widest ? width : widest;
    }
    fprintf(f, "Usage: %s %s\n", c->program, c->usage);
    ted4_arguments_wrap(f, c->text, 0);
    fputc('\n', f);
    for (int i = 0; i < c->n; i++) {
        const ted4_argument *const a = &c->table[i];
        const char *const gap = a->value != NULL ? " " : "";
        const char *const value = a->value != NULL ? a->value : "";
        const int width = (int)(strlen(a->name) + strlen(gap) + strlen(value));

        if (a->letter != 0)
            fprintf(f, "  -%c, ", a->letter);
        else
            fputs("      ", f);
        fprintf(f, "--%s%s%s%*s  ", a->name, gap, value, widest - width, "");
        ted4_arguments_wrap(f, a->text, widest + 10);
    }
    fprintf(f, "\n%s", c->end);
    if (c->more != NULL)
        c->more(f);
}

int ted4_arguments_number(const char *text, int64_t low, int64_t high, int64_t *out)
{
    char *end;

    errno = 0;
    *out = strtoll(text, &end, 10);
    return errno == 0 && end != text && *end == '\0' && *out >= low && *out <= high ? 0 : -1;
}

int ted4_arguments_floats(const char *text, int n, float *out)
{
    for (int i = 0; i < n; i++) {
        char *end;

        out[i] = strtof(text, &end);
        if (end == text || !isfinite(out[i]) || *end != (i + 1 < n ? ',' : '\0'))
            return -1;
        text = end + 1;
    }
    return 0;
}

int ted4_arguments_bad(const char *program, const char *name, const char *value,
                       const char *expected)
{
    fprintf(stderr, "%s: --%s: bad value %s; expected %s\n", program, name, value, expected);
    return TED4_EXIT_TOOL;
}

int ted4_arguments_bad_dash(const char *program, const char *name, const char *value,
                            const char *what)
{
    char expected[100];

    if (strcmp(value, "-") != 0)
        return 0;
    snprintf(expected, sizeof expected, "a %s name (./- names such a %s)", what, what);
    return ted4_arguments_bad(program, name, value, expected);
}

int ted4_arguments_bad_number(const char *program, const char *name, const char *value, int64_t low,
                              int64_t high)
{
    char expected[100];

    if (high == INT64_MAX)
        snprintf(expected, sizeof expected, "a whole number from %" PRId64 " on", low);
    else
        snprintf(expected, sizeof expected, "a whole number from %" PRId64 " to %" PRId64, low,
                 high);
    return ted4_arguments_bad(program, name, value, expected);
}
