/* shells.c - options for the completion of command lines by shells. See pages.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "pages.h"

/* Is the value of an option, of this name in the help text, the path of a file or folder? */
static int is_path(const char *value)
{
    return strstr(value, "FILE") != NULL || strstr(value, "DIR") != NULL ||
           strstr(value, "FOLDER") != NULL;
}

enum { ANY, WITH_PATH, WITH_OTHER };

static int kind_of(const ted4_argument *a)
{
    return a->value == NULL ? ANY : is_path(a->value) ? WITH_PATH : WITH_OTHER;
}

/* Writes options of a kind, each with its letter; ANY: all options. */
static void put_list(FILE *f, const ted4_command *c, int kind)
{
    const char *blank = "";

    for (int i = 0; i < c->n; i++) {
        const ted4_argument *const a = &c->table[i];

        if (kind != ANY && kind_of(a) != kind)
            continue;
        fprintf(f, "%s--%s", blank, a->name);
        if (a->letter != 0)
            fprintf(f, " -%c", a->letter);
        blank = " ";
    }
}

void ted4_pages_bash(const ted4_command *c, FILE *f)
{
    fprintf(f, "    \"%s\")\n        options='", c->program);
    put_list(f, c, ANY);
    fputs("'\n        paths='", f);
    put_list(f, c, WITH_PATH);
    fputs("'\n        others='", f);
    put_list(f, c, WITH_OTHER);
    fputs("' ;;\n", f);
}

/* Writes text within single quotes, with a backslash before each of the special characters. */
static void put_quoted(FILE *f, const char *text, const char *special, const char *quote)
{
    for (; *text != '\0'; text++) {
        if (*text == '\'') {
            fputs(quote, f);
            continue;
        }
        if (strchr(special, *text) != NULL)
            fputc('\\', f);
        fputc(*text, f);
    }
}

static void put_zsh_option(const ted4_argument *a, FILE *f)
{
    const char *const equals = a->value != NULL ? "=" : "";

    fputs(" \\\n            ", f);
    if (a->letter != 0)
        fprintf(f, "'(-%c --%s)'{-%c%s,--%s%s}'[", a->letter, a->name, a->letter,
                a->value != NULL ? "+" : "", a->name, equals);
    else
        fprintf(f, "'%s--%s%s[", a->value != NULL ? "*" : "", a->name, equals);
    put_quoted(f, a->text, "[]\\", "'\\''");
    fputc(']', f);
    if (a->value != NULL) {
        fputc(':', f);
        put_quoted(f, a->value, ":\\", "'\\''");
        fputs(is_path(a->value) ? ":_files" : ": ", f);
    }
    fputc('\'', f);
}

void ted4_pages_zsh(const ted4_command *c, FILE *f)
{
    fprintf(f, "    \"%s\")\n        _arguments -s -S", c->program);
    for (int i = 0; i < c->n; i++)
        put_zsh_option(&c->table[i], f);
    fputs(" \\\n            '*:file:_files' ;;\n", f);
}

void ted4_pages_fish(const ted4_command *c, FILE *f)
{
    const char *const subcommand = strchr(c->program, ' ');
    const int length = (int)strcspn(c->program, " ");

    for (int i = 0; i < c->n; i++) {
        const ted4_argument *const a = &c->table[i];

        fprintf(f, "complete -c %.*s", length, c->program);
        if (subcommand != NULL)
            fprintf(f, " -n '__fish_seen_subcommand_from %s'", subcommand + 1);
        if (a->letter != 0)
            fprintf(f, " -s %c", a->letter);
        fprintf(f, " -l %s%s -d '", a->name,
                a->value == NULL    ? ""
                : is_path(a->value) ? " -r -F"
                                    : " -x");
        put_quoted(f, a->text, "\\", "\\'");
        fputs("'\n", f);
    }
}
