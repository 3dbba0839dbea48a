/* mutants.c - see mutants.h and mutant_list.h. The changed file is compiled from a folder of its
 * own that comes first in the include path. If it is a header, all sources of the decoder that
 * include it are compiled too. The result is linked with the rest of ted4conf, and `ted4conf replay
 * --stop` runs the suite. A mutant is killed if the replay fails, crashes, hangs or gives up at a
 * vector, which is recorded. Mutants that do not compile are counted separately. Before all this,
 * the unchanged decoder, built and run in the same way, has to pass; otherwise a broken machine,
 * build or suite would appear to kill every mutant.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutants.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "mutant_list.h"
#include "process.h"

enum { LEAST_PERCENT = 95, LEAST_MUTANTS = 200, SLACK = 4 };

typedef struct {
    const conf_mutant_options *o;
    conf_mutant_list list;
} campaign;

/* Runs a shell command. Returns 1 on success. */
static int shell(const char *command)
{
    const int status = system(command);

    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Makes a new folder for a build. */
static void make_folder(char *folder)
{
    const char *tmp = getenv("TMPDIR");

    conf_path(folder, "%s/ted4mutant-XXXXXX", tmp != NULL ? tmp : "/tmp");
    if (mkdtemp(folder) == NULL)
        conf_die("%s: cannot be made", folder);
}

static void remove_folder(const char *folder)
{
    char command[CONF_PATH + 16];

    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    (void)shell(command);
}

/* Prints the log of compiling and linking, to help find the cause of a failure. */
static void show_log(const char *folder)
{
    char path[CONF_PATH];
    conf_bytes log;

    conf_path(path, "%s/log", folder);
    if (conf_read(path, &log))
        fputs((const char *)log.data, stderr);
    conf_free(&log);
}

/* Adds, as words for a shell, the sources that have to be compiled after a change to that file. */
static void add_sources(const campaign *c, const char *file, conf_bytes *b)
{
    if (strcmp(file + strlen(file) - 2, ".h") == 0)
        conf_print(b,
                   "(cd %s && grep -l '%s' ref-decoder/norm/*.d ref-decoder/read/*.d "
                   "ref-decoder/recon/*.d | sed 's/\\.d$/.c/'); ",
                   c->o->build, file);
    else
        conf_print(b, "echo %s; ", file);
}

/* Compiles the sources that depend on the n files in folder, and links the program. */
static int build(const campaign *c, const conf_mutant *m, size_t n, const char *folder)
{
    const char *const b = c->o->build;
    conf_bytes command = { NULL, 0, 0 };
    int good;

    conf_print(&command, "d='%s'; for s in $({ ", folder);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || strcmp(m[i].file, m[i - 1].file) != 0)
            add_sources(c, m[i].file, &command);
    conf_print(&command,
               "} | sort -u); do from=$s; [ -f \"$d/$s\" ] && from=$d/$s; %s -I\"$d/ref-decoder\" "
               "-Iref-decoder -Iref-encoder -w -c $from "
               "-o \"$d/$(echo $s | tr / _).o\" 2>>\"$d/log\" || exit 1; done; ",
               c->o->compile);
    conf_print(&command,
               "cc -fopenmp \"$d\"/*.o %s/conformance/tool/*.o %s/conformance/tolerance/class_t.o "
               "%s/tests/spec/eval_*.o "
               "$(ls %s/ref-decoder/tool/*.o | grep -v /ted4) %s/libted4enc.a %s/libted4render.a "
               "%s/libted4dec.a -o \"$d/ted4conf\" %s 2>>\"$d/log\"",
               b, b, b, b, b, b, b, c->o->libraries);
    good = shell((const char *)command.data);
    conf_free(&command);
    return good;
}

/* Runs the suite with the program in folder. The caller frees p. */
static void replay(const campaign *c, const char *folder, conf_process *p)
{
    const conf_process_options o = { "exec", "TED4_KERNEL=plain", c->o->timeout,
                                     (uint64_t)4 << 30 };
    char program[CONF_PATH];
    const char *argv[] = { program,
                           "replay",
                           "--stop",
                           "--names",
                           "--ways",
                           "--suite",
                           c->o->vectors != NULL ? c->o->vectors : c->o->suite,
                           NULL };
    conf_process *one[1] = { p };

    conf_path(program, "%s/ted4conf", folder);
    conf_process_start(p, &o, argv);
    while (conf_process_wait(one, 1, 100) < 0)
        ;
}

/* Sets the reason, as text that may stand in a CSV field and in a table. */
static void take_reason(conf_mutant *m, const char *how, const char *text)
{
    snprintf(m->by, sizeof m->by, "%s%.120s", how, text);
    m->by[strcspn(m->by, "\n")] = '\0';
    for (char *c = m->by; *c != '\0'; c++)
        if (*c == ',' || *c == '"' || *c == '|')
            *c = ' ';
}

/* survived: the whole suite has passed; killed: something went wrong at a vector. Anything else is
 * not a result, and ends the program. */
static void judge(conf_mutant *m, conf_process *p)
{
    char how[32] = "", *said = (char *)p->complaint.data, *rest, *line, *id;

    if (p->end == CONF_ENDED && p->code == 0) {
        snprintf(m->verdict, sizeof m->verdict, "survived");
        return;
    }
    if (p->end != CONF_ENDED)
        snprintf(how, sizeof how, "%s ",
                 p->end == CONF_CRASHED ? "crash"
                 : p->end == CONF_HUNG  ? "hang"
                                        : "endless output");
    else if (p->code != 1)
        snprintf(how, sizeof how, "exit %d ", p->code);
    for (line = strtok_r((char *)p->answer.data, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest))
        if (strncmp(line, "at ", 3) == 0)
            snprintf(m->vector, sizeof m->vector, "%s", line + 3);
        else if (how[0] == '\0' && (id = strstr(line, m->vector)) != NULL &&
                 strncmp(id + strlen(m->vector), ": ", 2) == 0)
            said = id + strlen(m->vector) + 2;
    if (m->vector[0] == '\0' || (p->end == CONF_CRASHED && p->code == SIGKILL))
        conf_die("%s: the runner was ended, or came to no vector: %s%s", m->id, how, said);
    snprintf(m->verdict, sizeof m->verdict, "killed");
    take_reason(m, how, said);
}

static void put_file(const char *folder, const char *file, const conf_bytes *b)
{
    char path[CONF_PATH];

    conf_path(path, "%s/%s", folder, file);
    conf_write(path, b->data, b->size);
}

/* Builds and runs the unchanged program, made of all files that have mutants. With a time limit
 * close to its run time, a slow run would be counted as a kill. */
static void baseline(const campaign *c)
{
    char folder[CONF_PATH];
    conf_process p;

    make_folder(folder);
    for (size_t i = 0; i < c->list.n; i++) {
        conf_bytes b;

        if (conf_read(c->list.m[i].file, &b))
            put_file(folder, c->list.m[i].file, &b);
        conf_free(&b);
    }
    if (!build(c, c->list.m, c->list.n, folder)) {
        show_log(folder);
        conf_die("the unchanged program cannot be built in the way of mutants");
    }
    replay(c, folder, &p);
    if (p.end != CONF_ENDED || p.code != 0)
        conf_die("the unchanged program does not pass: %s%s", (const char *)p.answer.data,
                 (const char *)p.complaint.data);
    if (SLACK * p.ms > 1000 * c->o->timeout)
        conf_die("the unchanged program takes %.0f s: mutants need a time limit of %d times that",
                 p.ms / 1000, SLACK);
    fprintf(stderr, "unchanged: passes in %.1f s\n", p.ms / 1000);
    conf_process_free(&p);
    remove_folder(folder);
}

static void try_one(const campaign *c, conf_mutant *m)
{
    char folder[CONF_PATH];
    conf_bytes changed = { NULL, 0, 0 };
    conf_process p;

    make_folder(folder);
    (void)conf_mutant_apply(m, &changed);
    put_file(folder, m->file, &changed);
    conf_free(&changed);
    if (!build(c, m, 1, folder)) {
        snprintf(m->verdict, sizeof m->verdict, "no compile");
    } else {
        replay(c, folder, &p);
        judge(m, &p);
        conf_process_free(&p);
    }
    remove_folder(folder);
    conf_mutant_results_add(&c->list, m, c->o->suite);
    fprintf(stderr, "%s: %s %s %s\n", m->id, m->verdict, m->vector, m->by);
}

static int is_due(const campaign *c, const conf_mutant *m)
{
    return m->verdict[0] == '\0' &&
           (c->o->only == NULL || strncmp(m->id, c->o->only, strlen(c->o->only)) == 0);
}

/* Starts one process per job. Each process tries every jobs-th mutant that has no result. */
static void work(const campaign *c)
{
    int status, bad = 0;

    for (int j = 0; j < c->o->jobs; j++) {
        const pid_t pid = fork();
        int turn = 0;

        if (pid < 0)
            conf_die("fork");
        if (pid > 0)
            continue;
        for (size_t i = 0; i < c->list.n; i++)
            if (is_due(c, &c->list.m[i]) && turn++ % c->o->jobs == j)
                try_one(c, &c->list.m[i]);
        _exit(0);
    }
    while (wait(&status) > 0)
        bad |= !WIFEXITED(status) || WEXITSTATUS(status) != 0;
    if (bad)
        conf_die("not all mutants could be run");
}

/* Prints the mutants without a result, one line per file, in the order of the list. */
static void print_waiting(const conf_mutant_list *l, conf_bytes *b)
{
    for (size_t i = 0; i < l->n; i++) {
        size_t first = 0;

        if (l->m[i].verdict[0] != '\0')
            continue;
        while (l->m[first].verdict[0] != '\0' || strcmp(l->m[first].file, l->m[i].file) != 0)
            first++;
        if (first < i)
            continue;
        conf_print(b, "* %s:", l->m[i].file);
        for (size_t j = i; j < l->n; j++)
            if (l->m[j].verdict[0] == '\0' && strcmp(l->m[j].file, l->m[i].file) == 0)
                conf_print(b, " %s", l->m[j].id);
        conf_print(b, "\n");
    }
    if (conf_mutant_count(l, "") == 0)
        conf_print(b, "none\n");
}

/* Prints a cell of a table, without the bar that would end the cell. */
static void print_cell(const char *text, conf_bytes *b)
{
    for (const char *c = text; *c != '\0'; c++)
        conf_print(b, *c == '|' ? "\\|" : "%c", *c);
}

static void print_survivor(const conf_mutant *m, conf_bytes *b)
{
    conf_print(b, "| %s | %s | %s | `", m->id, m->file, m->verdict);
    print_cell(m->from, b);
    conf_print(b, "` | `");
    print_cell(m->to, b);
    conf_print(b, "` | ");
    print_cell(m->why, b);
    conf_print(b, " |\n");
}

static void print_mutants(const conf_mutant_list *l, conf_bytes *b)
{
    conf_print(
        b, "## Survivors\n\n%s",
        conf_mutant_count(l, "survived") + conf_mutant_count(l, "no compile") == 0
            ? "none\n"
            : "| mutant | file | result | line | becomes | why |\n|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < l->n; i++)
        if (strcmp(l->m[i].verdict, "survived") == 0 || strcmp(l->m[i].verdict, "no compile") == 0)
            print_survivor(&l->m[i], b);
    conf_print(b, "\n## Not run since what their results depend on has changed\n\n");
    print_waiting(l, b);
    conf_print(b, "\n## Killed\n\n`mutants.csv` names the first vector that killed each of the "
                  "others, and says what was\nwrong with the answer.\n");
}

static const char introduction[] =
    "# Mutants\n\n"
    "`make conformance-mutants` seeds the faults of `mutants.list` into the reference decoder,\n"
    "one at a time, and runs each changed decoder over the published vectors. It first checks\n"
    "that the unchanged program, built and run in the same way, passes. The plain kernels are\n"
    "used, so that `norm/` is what is tested. Results are kept in `mutants.csv` for as long as\n"
    "what they depend on is the same ([README](README.md#mutants)); `ted4conf mutants --check`\n"
    "says how many still hold.\n";

static int write_report(const campaign *c)
{
    const conf_mutant_list *l = &c->list;
    const size_t killed = conf_mutant_count(l, "killed"),
                 survived = conf_mutant_count(l, "survived"), judged = killed + survived;
    const int good = judged >= LEAST_MUTANTS && 100 * killed >= LEAST_PERCENT * judged &&
                     judged == l->n;
    conf_bytes b = { NULL, 0, 0 };
    char path[CONF_PATH], share[16] = "";

    /* Kills stay valid longer than survivals, so that the share of a part of the list would be too
     * high. */
    if (judged == l->n && judged > 0)
        snprintf(share, sizeof share, " (%.1f %%)", 100.0 * (double)killed / (double)judged);
    conf_print(&b,
               "%s\n| | |\n|---|---|\n| mutants | %zu |\n| judged | %zu |\n| killed | %zu%s |\n"
               "| survived | %zu |\n| do not compile | %zu |\n| not run | %zu |\n\n",
               introduction, l->n, judged, killed, share, survived,
               conf_mutant_count(l, "no compile"), conf_mutant_count(l, ""));
    print_mutants(l, &b);
    conf_path(path, "%s/MUTANTS.md", c->o->suite);
    conf_write(path, b.data, b.size);
    conf_free(&b);
    printf("%zu mutants, %zu killed, %zu survived, %zu not judged: %s\n", l->n, killed, survived,
           l->n - judged, good ? "enough" : "not enough");
    return good;
}

/* Checks the list of changes that were tried and are equivalent: each needs a reason, and must
 * still be possible. */
static void check_equivalents(const char *suite)
{
    conf_mutant_list l = { .m = NULL };
    char path[CONF_PATH];

    conf_path(path, "%s/mutants-equivalent.list", suite);
    conf_mutant_list_read(&l, path);
    for (size_t i = 0; i < l.n; i++)
        if (l.m[i].why[0] == '\0')
            conf_die("%s: %s: why?", path, l.m[i].id);
    conf_mutant_list_free(&l);
}

/* Runs all mutants that need a result, after the unchanged program. */
static void run_due(campaign *c)
{
    for (size_t i = 0; i < c->list.n; i++)
        if (is_due(c, &c->list.m[i])) {
            if (c->o->compile == NULL)
                conf_die("--compile is missing: the decoder's compiler and flags (make "
                         "conformance-mutants has them)");
            baseline(c);
            work(c);
            conf_mutant_results_read(&c->list, c->o->suite);
            return;
        }
}

int conf_mutants(const conf_mutant_options *o)
{
    campaign c = { .o = o };
    char path[CONF_PATH];
    int good = 1;

    conf_path(path, "%s/mutants.list", o->suite);
    conf_mutant_list_read(&c.list, path);
    check_equivalents(o->suite);
    conf_mutant_results_read(&c.list, o->suite);
    if (o->check) {
        printf("%zu mutants, %zu with a result that holds\n", c.list.n,
               c.list.n - conf_mutant_count(&c.list, ""));
    } else {
        run_due(&c);
        good = write_report(&c);
    }
    conf_mutant_list_free(&c.list);
    return !good;
}
