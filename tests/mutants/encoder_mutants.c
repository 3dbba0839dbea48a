/* encoder_mutants.c - `make encoder-mutants`: faults are seeded into the reference encoder, one at
 * a time, and the test programs that the list names for each must find them. The format of the list
 * and of the results is that of the decoder's mutants (conformance/tool/mutant_list.h).
 *
 * All work is done in a copy of the tree, together with the build folder, so that make compiles
 * only what depends on the changed file, and the tree may change meanwhile. A mutant is killed if
 * one of its programs fails, crashes or does not end; the first one is recorded, with the test that
 * failed. Before all this, the unchanged programs have to pass, built and run in the same way.
 *
 * What a result depends on: a kill, on the code of the file and on that of the program that killed
 * it; anything else, on the whole encoder and on the programs.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "conformance/tool/mutant_list.h"
#include "conformance/tool/process.h"
#include "tool/arguments.h"

enum { USAGE = 3, LEAST_PERCENT = 95, LEAST_MUTANTS = 80, SLACK = 4 };

/* Address space of a program, so that a fault in a size does not take all memory. */
#define MOST_MEMORY ((uint64_t)16 << 30)

typedef struct {
    const char *folder; /* contains mutants.list, mutants.csv, MUTANTS.md */
    const char *build;  /* build folder, relative to the project's root */
    const char *make; /* make command with the variables of that build; NULL: nothing can be run */
    const char *only; /* only ids with this prefix; NULL: all */
    double timeout;   /* seconds per program */
    int check;        /* neither run nor write anything */
} options;

typedef struct {
    const options *o;
    conf_mutant_list list;
    char folder[CONF_PATH]; /* o->folder, absolute */
    char tree[CONF_PATH];   /* the copy, in which the campaign runs */
} campaign;

/* ---- what results depend on ---- */

static uint64_t program_code(const char *program)
{
    char file[CONF_PATH];

    conf_path(file, "tests/%s.c", program);
    return access(file, R_OK) == 0 ? conf_mutant_code_of(file) : 0;
}

/* Copies the next word of a line to word, and returns what is behind it, or NULL if there is no
 * word. */
static const char *next_word(const char *at, char word[CONF_MUTANT_LINE])
{
    const char *const first = at + strspn(at, " ");
    const size_t n = strcspn(first, " ");

    snprintf(word, CONF_MUTANT_LINE, "%.*s", (int)n, first);
    return n > 0 ? first + n : NULL;
}

static uint64_t ground(const conf_mutant_list *l, const conf_mutant *m)
{
    conf_bytes all = { NULL, 0, 0 };
    char word[CONF_MUTANT_LINE];
    uint64_t hash;

    if (strcmp(m->verdict, "killed") == 0)
        return program_code(m->vector);
    conf_print(&all, "%016" PRIx64, l->all);
    for (const char *at = m->programs; (at = next_word(at, word)) != NULL;)
        conf_print(&all, " %s %016" PRIx64, word, program_code(word));
    hash = conf_seed((const char *)all.data);
    conf_free(&all);
    return hash;
}

/* ---- the copy of the tree ---- */

/* Runs a shell command. Returns 1 on success. */
static int shell(const char *command)
{
    const int status = system(command);

    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static void enter_copy(campaign *c)
{
    const char *const tmp = getenv("TMPDIR");
    conf_bytes command = { NULL, 0, 0 };

    conf_path(c->tree, "%s/ted4mutants-XXXXXX", tmp != NULL ? tmp : "/tmp");
    if (mkdtemp(c->tree) == NULL)
        conf_die("%s: cannot be made", c->tree);
    conf_print(&command,
               "for e in *; do case $e in build*|out) ;; *) cp -a \"$e\" '%s' || exit 1 ;; esac; "
               "done; cp -a '%s' '%s'",
               c->tree, c->o->build, c->tree);
    if (!shell((const char *)command.data))
        conf_die("%s: the tree cannot be copied there", c->tree);
    conf_free(&command);
    if (chdir(c->tree) != 0)
        conf_die("%s: cannot be entered", c->tree);
}

static void remove_tree(const campaign *c)
{
    char command[CONF_PATH + 16];

    snprintf(command, sizeof command, "rm -rf '%s'", c->tree);
    (void)shell(command);
}

/* Shows the log of make, to help find the cause of a failure. */
static void show_log(void)
{
    conf_bytes log;

    if (conf_read("log", &log))
        fputs((const char *)log.data, stderr);
    conf_free(&log);
}

/* Makes programs: words, separated by spaces. Returns 1 on success. */
static int build(const campaign *c, const char *programs)
{
    conf_bytes command = { NULL, 0, 0 };
    char word[CONF_MUTANT_LINE];
    int good;

    conf_print(&command, "%s", c->o->make);
    for (const char *at = programs; (at = next_word(at, word)) != NULL;)
        conf_print(&command, " '%s/tests/%s'", c->o->build, word);
    conf_print(&command, " >log 2>&1");
    good = shell((const char *)command.data);
    conf_free(&command);
    return good;
}

/* Runs one test program. The caller frees p. */
static void run_program(const campaign *c, const char *name, conf_process *p)
{
    char program[CONF_PATH];
    const conf_process_options o = { "exec", "CMOCKA_MESSAGE_OUTPUT=STDOUT", c->o->timeout,
                                     MOST_MEMORY };
    const char *argv[] = { program, NULL };
    conf_process *one[1] = { p };

    conf_path(program, "%s/tests/%s", c->o->build, name);
    conf_process_start(p, &o, argv);
    while (conf_process_wait(one, 1, 100) < 0)
        ;
}

/* ---- verdicts ---- */

/* Sets the reason: the test that failed, or how the program ended. */
static void take_reason(conf_mutant *m, const conf_process *p)
{
    static const char failed[] = "[  FAILED  ] ";
    const char *const line = strstr((const char *)p->answer.data, failed);

    if (p->end == CONF_CRASHED)
        snprintf(m->by, sizeof m->by, "crash: signal %d", p->code);
    else if (p->end != CONF_ENDED)
        snprintf(m->by, sizeof m->by, "%s", p->end == CONF_HUNG ? "hang" : "endless output");
    else if (line != NULL)
        snprintf(m->by, sizeof m->by, "%.*s", (int)strcspn(line + strlen(failed), " :,\n"),
                 line + strlen(failed));
    else
        snprintf(m->by, sizeof m->by, "exit %d", p->code);
}

static void judge(const campaign *c, conf_mutant *m)
{
    char word[CONF_MUTANT_LINE];

    for (const char *at = m->programs;
         m->verdict[0] == '\0' && (at = next_word(at, word)) != NULL;) {
        conf_process p;

        run_program(c, word, &p);
        if (p.end != CONF_ENDED || p.code != 0) {
            snprintf(m->verdict, sizeof m->verdict, "killed");
            snprintf(m->vector, sizeof m->vector, "%.95s", word);
            take_reason(m, &p);
        }
        conf_process_free(&p);
    }
    if (m->verdict[0] == '\0')
        snprintf(m->verdict, sizeof m->verdict, "survived");
}

static int is_due(const campaign *c, const conf_mutant *m)
{
    return m->verdict[0] == '\0' &&
           (c->o->only == NULL || strncmp(m->id, c->o->only, strlen(c->o->only)) == 0);
}

/* Runs an unchanged program. With a time limit close to its run time, a slow run would be counted
 * as a kill. */
static void pass_unchanged(const campaign *c, const char *name)
{
    conf_process p;

    run_program(c, name, &p);
    if (p.end != CONF_ENDED || p.code != 0)
        conf_die("the unchanged %s does not pass: %s%s", name, (const char *)p.answer.data,
                 (const char *)p.complaint.data);
    if (strstr((const char *)p.answer.data, "[       OK ]") == NULL)
        conf_die("the unchanged %s passes no test", name);
    if (SLACK * p.ms > 1000 * c->o->timeout)
        conf_die("the unchanged %s takes %.0f s: mutants need a time limit of %d times that", name,
                 p.ms / 1000, SLACK);
    fprintf(stderr, "unchanged: %s passes in %.1f s\n", name, p.ms / 1000);
    conf_process_free(&p);
}

/* Makes and runs every unchanged program that due mutants name, each once. */
static void baseline(const campaign *c)
{
    conf_bytes done = { NULL, 0, 0 };
    char word[CONF_MUTANT_LINE], marked[CONF_MUTANT_LINE + 2];

    conf_print(&done, " ");
    for (size_t i = 0; i < c->list.n; i++) {
        const conf_mutant *const m = &c->list.m[i];

        for (const char *at = m->programs; is_due(c, m) && (at = next_word(at, word)) != NULL;) {
            snprintf(marked, sizeof marked, " %s ", word);
            if (strstr((const char *)done.data, marked) != NULL)
                continue;
            if (!build(c, word)) {
                show_log();
                conf_die("the unchanged %s cannot be built", word);
            }
            pass_unchanged(c, word);
            conf_print(&done, "%s ", word);
        }
    }
    conf_free(&done);
}

/* Changing a file, and changing it back, sets its time to now, so that make compiles all that
 * depends on it. */
static void try_one(const campaign *c, conf_mutant *m)
{
    conf_bytes original, changed = { NULL, 0, 0 };

    if (!conf_read(m->file, &original))
        conf_die("%s: cannot be read", m->file);
    (void)conf_mutant_apply(m, &changed);
    conf_write(m->file, changed.data, changed.size);
    if (build(c, m->programs)) {
        judge(c, m);
    } else {
        snprintf(m->verdict, sizeof m->verdict, "no compile");
        show_log();
    }
    conf_write(m->file, original.data, original.size);
    conf_free(&original);
    conf_free(&changed);
    conf_mutant_results_add(&c->list, m, c->folder);
    fprintf(stderr, "%s: %s %s %s\n", m->id, m->verdict, m->vector, m->by);
}

static size_t count_due(const campaign *c)
{
    size_t n = 0;

    for (size_t i = 0; i < c->list.n; i++)
        n += is_due(c, &c->list.m[i]);
    return n;
}

static void run_due(campaign *c)
{
    if (count_due(c) == 0)
        return;
    if (c->o->make == NULL)
        conf_die("--make is missing: make with the variables of the build (make encoder-mutants "
                 "has them)");
    enter_copy(c);
    baseline(c);
    for (size_t i = 0; i < c->list.n; i++)
        if (is_due(c, &c->list.m[i]))
            try_one(c, &c->list.m[i]);
    remove_tree(c);
}

/* ---- the page ---- */

static const char introduction[] =
    "# Mutants of the encoder\n\n"
    "`make encoder-mutants` seeds the faults of `mutants.list` into the reference encoder, one at\n"
    "a time, and runs the test programs that the list names for each. It first checks that the\n"
    "unchanged programs, built and run in the same way, pass. Results are kept in `mutants.csv`\n"
    "for as long as what they depend on is the same: a kill depends on the code of the changed\n"
    "file and of the program that killed the mutant, anything else on the whole encoder and on\n"
    "the named programs.\n";

/* Returns the length of the part of the id that names its area: all before the first hyphen. */
static size_t area_length(const conf_mutant *m)
{
    return strcspn(m->id, "-");
}

static int same_area(const conf_mutant *a, const conf_mutant *b)
{
    return area_length(a) == area_length(b) && strncmp(a->id, b->id, area_length(a)) == 0;
}

/* Prints a row per area, in the order of the list. */
static void print_areas(const conf_mutant_list *l, conf_bytes *b)
{
    conf_print(b, "\n## By area\n\n| area | mutants | killed | not run |\n|---|---|---|---|\n");
    for (size_t i = 0; i < l->n; i++) {
        size_t n = 0, killed = 0, not_run = 0, before = 0;

        for (size_t j = 0; j < l->n; j++) {
            if (!same_area(&l->m[i], &l->m[j]))
                continue;
            before += j < i;
            n++;
            killed += strcmp(l->m[j].verdict, "killed") == 0;
            not_run += l->m[j].verdict[0] == '\0';
        }
        if (before == 0)
            conf_print(b, "| %.*s | %zu | %zu | %zu |\n", (int)area_length(&l->m[i]), l->m[i].id, n,
                       killed, not_run);
    }
}

/* Prints a cell of a table, without the bar that would end the cell. */
static void print_cell(const char *text, conf_bytes *b)
{
    for (const char *c = text; *c != '\0'; c++)
        conf_print(b, *c == '|' ? "\\|" : "%c", *c);
}

static void print_others(const conf_mutant_list *l, conf_bytes *b)
{
    const size_t not_run = conf_mutant_count(l, "");

    conf_print(
        b, "\n## Not killed\n\n%s",
        conf_mutant_count(l, "killed") + not_run == l->n
            ? "none\n"
            : "| mutant | file | result | line | becomes | why |\n|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < l->n; i++) {
        const conf_mutant *const m = &l->m[i];

        if (strcmp(m->verdict, "killed") == 0 || m->verdict[0] == '\0')
            continue;
        conf_print(b, "| %s | %s | %s | `", m->id, m->file, m->verdict);
        print_cell(m->from, b);
        conf_print(b, "` | `");
        print_cell(m->to, b);
        conf_print(b, "` | ");
        print_cell(m->why, b);
        conf_print(b, " |\n");
    }
    conf_print(b, "\n## Not run\n\n%s", not_run == 0 ? "none\n" : "| mutant | file |\n|---|---|\n");
    for (size_t i = 0; i < l->n; i++)
        if (l->m[i].verdict[0] == '\0')
            conf_print(b, "| %s | %s |\n", l->m[i].id, l->m[i].file);
    conf_print(b, "\nFor each of the others, `mutants.csv` names the first program that killed it, "
                  "and the test\nthat failed.\n");
}

/* Writes the page. Returns 1 if enough mutants are killed. */
static int write_page(const campaign *c)
{
    const conf_mutant_list *const l = &c->list;
    const size_t killed = conf_mutant_count(l, "killed"),
                 survived = conf_mutant_count(l, "survived"), judged = killed + survived;
    const int good = judged == l->n && judged >= LEAST_MUTANTS &&
                     100 * killed >= LEAST_PERCENT * judged;
    conf_bytes b = { NULL, 0, 0 };
    char path[CONF_PATH];

    conf_print(&b, "%s\n", introduction);
    conf_mutant_print_counts(l, judged == l->n, &b);
    print_areas(l, &b);
    print_others(l, &b);
    conf_path(path, "%s/MUTANTS.md", c->folder);
    conf_write(path, b.data, b.size);
    conf_free(&b);
    printf("%zu mutants, %zu killed, %zu survived, %zu not judged: %s\n", l->n, killed, survived,
           l->n - judged, good ? "enough" : "not enough");
    return good;
}

/* ---- the program ---- */

static int run_campaign(const options *o)
{
    campaign c = { .o = o, .list = { .ground = ground } };
    char path[CONF_PATH], here[CONF_PATH];
    int good = 1;

    if (getcwd(here, sizeof here) == NULL)
        conf_die("the current folder has too long a name");
    conf_path(c.folder, "%s%s%s", o->folder[0] == '/' ? "" : here, o->folder[0] == '/' ? "" : "/",
              o->folder);
    conf_path(path, "%s/mutants.list", c.folder);
    conf_mutant_list_read(&c.list, path);
    for (size_t i = 0; i < c.list.n; i++)
        if (c.list.m[i].programs[strspn(c.list.m[i].programs, " ")] == '\0')
            conf_die("%s: %s: no program judges it", path, c.list.m[i].id);
    c.list.all = conf_mutant_code_of("$(find ref-encoder -name '*.[ch]' | LC_ALL=C sort)");
    conf_mutant_results_read(&c.list, c.folder);
    if (o->check) {
        printf("%zu mutants, %zu with a result that holds\n", c.list.n,
               c.list.n - conf_mutant_count(&c.list, ""));
    } else {
        run_due(&c);
        good = write_page(&c);
    }
    conf_mutant_list_free(&c.list);
    return !good;
}

enum { FOLDER, BUILD, MAKE, ONLY, TIMEOUT, CHECK, HELP, VERSION, OPTIONS };

static const ted4_argument table[OPTIONS] = {
    [FOLDER] = { 's', "folder", "DIR", "folder with mutants.list. Default tests/mutants" },
    [BUILD] = { 'b', "build", "DIR",
                "build folder that is copied, below the current one. Default build" },
    [MAKE] = { 0, "make", "CMD",
               "make, with the variables of that build; needed when something is to be run" },
    [ONLY] = { 0, "only", "ID", "mutants whose id begins so" },
    [TIMEOUT] = { 't', "timeout", "SECONDS", "for one program. Default 600" },
    [CHECK] = { 0, "check", NULL,
                "run and write nothing; does the list fit the sources, and how many results "
                "hold?" },
    [HELP] = TED4_ARGUMENT_HELP,
    [VERSION] = TED4_ARGUMENT_VERSION,
};

int main(int argc, char **argv)
{
    static const ted4_command command = {
        "encoder_mutants",
        "[options]",
        "Seeded faults in the encoder, which its tests have to find (make encoder-mutants).",
        table,
        OPTIONS,
        "Exit codes: 0 enough are killed, 1 not, 3 usage, a list that does not fit the sources, or "
        "unchanged programs that do not pass.\n",
        NULL
    };
    options o = { .folder = "tests/mutants", .build = "build", .timeout = 600 };
    const char *value;
    int64_t seconds;

    for (int i; (i = ted4_arguments_next(&command, argc, argv, &value)) != TED4_ARGUMENTS_END;)
        switch (i) {
        case TED4_ARGUMENTS_BAD: return USAGE;
        case TED4_ARGUMENTS_DONE: return 0;
        case FOLDER: o.folder = value; break;
        case BUILD: o.build = value; break;
        case MAKE: o.make = value; break;
        case ONLY: o.only = value; break;
        case CHECK: o.check = 1; break;
        default:
            if (ted4_arguments_number(value, 1, 86400, &seconds) != 0)
                conf_die("--timeout: no number, or out of range");
            o.timeout = (double)seconds;
        }
    if (optind < argc)
        conf_die("encoder_mutants takes no operand");
    return run_campaign(&o);
}
