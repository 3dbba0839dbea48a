/* man.c - a manual page in mdoc(7). See pages.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "pages.h"
#include "ted4.h"

static const struct {
    const char *program, *name;
} NAMES[] = {
#define NAME(program, name) { program, name },
#define EXAMPLE(program, command, text)
#include "more.def"
#undef NAME
#undef EXAMPLE
};

static const struct {
    const char *program, *command, *text;
} EXAMPLES[] = {
#define NAME(program, name)
#define EXAMPLE(program, command, text) { program, command, text },
#include "more.def"
#undef NAME
#undef EXAMPLE
};

enum {
    N_NAMES = sizeof NAMES / sizeof NAMES[0],
    N_EXAMPLES = sizeof EXAMPLES / sizeof EXAMPLES[0]
};

static const char EXITS[] = "Exit codes: ";

static void put_text(FILE *f, const char *text)
{
    ted4_mdoc_text(f, text, strlen(text));
}

/* Writes the name of the page: a subcommand is joined to its program by a dash. */
static void put_page(FILE *f, const char *program, int (*letter)(int))
{
    for (const char *p = program; *p != '\0'; p++)
        fputc(*p == ' ' ? '-' : letter((unsigned char)*p), f);
}

static int same(int c)
{
    return c;
}

static void put_name(FILE *f, const ted4_command *c, const char *date)
{
    fprintf(f, ".Dd %s\n.Dt ", date);
    put_page(f, c->program, toupper);
    fputs(" 1\n.Os TED4 " TED4_VERSION "\n.Sh NAME\n.Nm ", f);
    put_page(f, c->program, same);
    for (size_t i = 0; i < N_NAMES; i++)
        if (strcmp(NAMES[i].program, c->program) == 0)
            fprintf(f, "\n.Nd %s\n", NAMES[i].name);
}

/* Writes an option or an operand of the usage. */
static void put_operand(FILE *f, const char *word, size_t n)
{
    const int is_option = word[0] == '-' && n > 1;

    fputs(is_option ? " Fl " : " Ar ", f);
    ted4_mdoc_word(f, word + is_option, n - (size_t)is_option);
}

/* Writes the usage up to a remark in parentheses. Returns the remark, or "". */
static const char *put_usage(FILE *f, const ted4_command *c)
{
    const char *p = c->usage;

    fprintf(f, ".Sh SYNOPSIS\n.Nm \"%s\"\n", c->program);
    while (*p != '\0' && *p != '(') {
        const size_t n = strcspn(p, " ");

        if (*p == '[' && n > 2 && p[n - 1] == ']') {
            fputs(".Op", f);
            put_operand(f, p + 1, n - 2);
            fputc('\n', f);
        } else if (n > 0) {
            fputs(p[0] == '-' ? ".Fl " : ".Ar ", f);
            ted4_mdoc_word(f, p + (p[0] == '-'), n - (p[0] == '-'));
            fputc('\n', f);
        }
        p += n + strspn(p + n, " ");
    }
    return p;
}

static void put_options(FILE *f, const ted4_command *c)
{
    fputs(".Sh OPTIONS\n.Bl -tag -width Ds\n", f);
    for (int i = 0; i < c->n; i++) {
        const ted4_argument *const a = &c->table[i];

        fputs(".It", f);
        if (a->letter != 0)
            fprintf(f, " Fl %c ,", a->letter);
        fprintf(f, " Fl -%s", a->name);
        if (a->value != NULL)
            put_operand(f, a->value, strlen(a->value));
        fputc('\n', f);
        put_text(f, a->text);
    }
    fputs(".El\n", f);
}

/* Where the next item of "0 fine, 1 file refused" begins: behind a comma, with a number. */
static const char *next_exit(const char *p, const char *end)
{
    for (; p < end; p++)
        if (*p == ',' && isdigit((unsigned char)p[1 + strspn(p + 1, " \n")]))
            return p;
    return end;
}

/* Writes the sentence of exit codes, a paragraph of n bytes, as a list. */
static void put_exits(FILE *f, const char *text, size_t n)
{
    const char *const end = text + n;
    const char *p = text + strlen(EXITS);

    fputs(".Sh EXIT STATUS\n.Bl -tag -width Ds\n", f);
    while (p < end) {
        const char *const next = next_exit(p, end);
        const size_t digits = strspn(p, "0123456789");

        fprintf(f, ".It %.*s\n", (int)digits, p);
        ted4_mdoc_text(f, p + digits, (size_t)(next - p) - digits);
        p = next < end ? next + 1 + strspn(next + 1, " \n") : end;
    }
    fputs(".El\n", f);
}

/* Writes n bytes of text as lines that are not to be filled. */
static void put_lines(FILE *f, const char *text, size_t n)
{
    fputs(".Bd -literal\n", f);
    ted4_mdoc_literal(f, text, n);
    fputs(".Ed\n", f);
}

/* Writes a paragraph of n bytes. Behind a first line that ends in a colon, lines are not filled. */
static void put_table(FILE *f, const char *text, size_t n)
{
    const size_t first = strcspn(text, "\n");
    const int is_table = first < n && text[first - 1] == ':';

    fputs(".Pp\n", f);
    ted4_mdoc_text(f, text, is_table ? first : n);
    if (is_table)
        put_lines(f, text + first + 1, n - first - 1);
}

/* Writes the examples of a paragraph of n bytes that begins with "Examples:". */
static void put_given_examples(FILE *f, const char *text, size_t n)
{
    const size_t heading = strcspn(text, ":\n");
    const size_t skip = heading + 1 + strspn(text + heading + 1, "\n");

    if (skip < n)
        put_lines(f, text + skip, n - skip);
}

enum { TAIL_TABLES, TAIL_EXITS, TAIL_EXAMPLES };

static int kind_of(const char *paragraph)
{
    return strncmp(paragraph, EXITS, strlen(EXITS)) == 0 ? TAIL_EXITS
           : strncmp(paragraph, "Example", 7) == 0       ? TAIL_EXAMPLES
                                                         : TAIL_TABLES;
}

/* Writes those paragraphs of tail, what the help text has behind the options, that are of a kind.
 */
static void put_tail(FILE *f, const char *tail, int kind)
{
    static void (*const put[])(FILE * f, const char *text, size_t n) = {
        [TAIL_TABLES] = put_table, [TAIL_EXITS] = put_exits, [TAIL_EXAMPLES] = put_given_examples
    };

    for (const char *p = tail + strspn(tail, "\n"); *p != '\0';) {
        const char *const gap = strstr(p, "\n\n");
        const size_t n = gap != NULL ? (size_t)(gap - p) : strlen(p);

        if (kind_of(p) == kind)
            put[kind](f, p, n);
        p += n + strspn(p + n, "\n");
    }
}

/* Writes the examples of more.def, behind those of the help text. */
static void put_examples(FILE *f, const ted4_command *c, const char *tail)
{
    const char *gap = "";

    fputs(".Sh EXAMPLES\n", f);
    put_tail(f, tail, TAIL_EXAMPLES);
    for (size_t i = 0; i < N_EXAMPLES; i++) {
        if (strcmp(EXAMPLES[i].program, c->program) != 0)
            continue;
        fputs(gap, f);
        gap = ".Pp\n";
        put_text(f, EXAMPLES[i].text);
        fputs(".Dl ", f);
        ted4_mdoc_literal(f, EXAMPLES[i].command, strlen(EXAMPLES[i].command));
    }
}

/* Writes references to the pages of all other programs. */
static void put_see_also(FILE *f, const ted4_command *c)
{
    const char *before = ".Sh SEE ALSO\n";

    for (size_t i = 0; i < N_NAMES; i++) {
        if (strcmp(NAMES[i].program, c->program) == 0 || strchr(NAMES[i].program, ' ') != NULL)
            continue;
        fprintf(f, "%s.Xr %s 1", before, NAMES[i].program);
        before = " ,\n";
    }
    fputc('\n', f);
}

void ted4_pages_man(const ted4_command *c, const char *date, FILE *f)
{
    char *tail = NULL;
    size_t size;
    FILE *const m = open_memstream(&tail, &size);

    if (m == NULL)
        abort();
    fputs(c->end, m);
    if (c->more != NULL)
        c->more(m);
    fclose(m);

    put_name(f, c, date);
    const char *const remark = put_usage(f, c);

    fputs(".Sh DESCRIPTION\n", f);
    put_text(f, c->text);
    if (*remark != '\0') {
        fputs(".Pp\n", f);
        put_text(f, remark);
    }
    put_options(f, c);
    put_tail(f, tail, TAIL_TABLES);
    fputs(".Sh ENVIRONMENT\n.Bl -tag -width Ds\n.It Ev TED4_KERNEL\n"
          "Chooses slower kernels than the best that the machine has:\n"
          ".Cm plain , v1 , v3\nor\n.Cm v4\non x86-64,\n.Cm plain\nor\n.Cm neon\non aarch64.\n"
          "Decoding gives the same bytes with all of them.\n"
          "Trainings, and drawn pictures at times, differ slightly with\n.Cm plain\nand\n.Cm v1\n"
          "on x86-64, which have no fused multiply-add.\n.El\n",
          f);
    put_tail(f, tail, TAIL_EXITS);
    put_examples(f, c, tail);
    put_see_also(f, c);
    free(tail);
}
