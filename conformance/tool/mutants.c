/* mutants.c - see mutants.h, mutant_list.h and mutant_build.h. A mutant is killed if the replay of
 * the suite fails, crashes, hangs or gives up at a vector, which is recorded. Mutants that do not
 * compile are counted separately, and so are those for kernels that this machine cannot run. Before
 * all this, the unchanged decoder, built and run in the same way and at the same place, has to
 * pass; otherwise a broken machine, build or suite would appear to kill every mutant.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutants.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "mutant_build.h"

enum { LEAST_PERCENT = 95, LEAST_MUTANTS = 200, SLACK = 4 };

typedef struct {
    const conf_mutant_options *o;
    conf_mutant_list list;
} campaign;

/* Sets the reason, as words that may stand in a CSV field and in a table. */
static void take_reason(conf_mutant *m, const char *how, const char *text)
{
    snprintf(m->by, sizeof m->by, "%s%.120s", how, text);
    m->by[strcspn(m->by, "\n")] = '\0';

    char *to = m->by;

    for (const char *c = m->by; *c != '\0'; c++) {
        const char next = strchr(",\"|", *c) != NULL ? ' ' : *c;

        if (next != ' ' || (to > m->by && to[-1] != ' '))
            *to++ = next;
    }
    *to = '\0';
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

static const char *place_name(const conf_place *place)
{
    return place->name[0] != '\0' ? place->name : "plain";
}

/* Builds and runs the unchanged program, made of all files that have mutants at that place. With a
 * time limit close to its run time, a slow run would be counted as a kill. */
static void baseline(const campaign *c, const conf_place *place)
{
    char folder[CONF_PATH];
    conf_process p;

    conf_mutant_folder(folder);
    for (size_t i = 0; i < c->list.n; i++) {
        conf_bytes b;

        if (c->list.m[i].place != place)
            continue;
        if (conf_read(c->list.m[i].file, &b))
            conf_mutant_put(folder, c->list.m[i].file, &b);
        conf_free(&b);
    }
    if (!conf_mutant_build(c->o, place, c->list.m, c->list.n, folder)) {
        conf_mutant_show_log(folder);
        conf_die("the unchanged program cannot be built in the way of mutants");
    }
    conf_mutant_replay(c->o, place, folder, &p);
    if (p.end != CONF_ENDED || p.code != 0)
        conf_die("the unchanged program does not pass: %s%s", (const char *)p.answer.data,
                 (const char *)p.complaint.data);
    if (SLACK * p.ms > 1000 * c->o->timeout)
        conf_die("the unchanged program takes %.0f s: mutants need a time limit of %d times that",
                 p.ms / 1000, SLACK);
    fprintf(stderr, "unchanged, %s: passes in %.1f s\n", place_name(place), p.ms / 1000);
    conf_process_free(&p);
    conf_mutant_folder_remove(folder);
}

static void try_one(const campaign *c, conf_mutant *m)
{
    char folder[CONF_PATH];
    conf_bytes changed = { NULL, 0, 0 };
    conf_process p;

    conf_mutant_folder(folder);
    (void)conf_mutant_apply(m, &changed);
    conf_mutant_put(folder, m->file, &changed);
    conf_free(&changed);
    if (!conf_mutant_build(c->o, m->place, m, 1, folder)) {
        snprintf(m->verdict, sizeof m->verdict, "no compile");
    } else {
        conf_mutant_replay(c->o, m->place, folder, &p);
        judge(m, &p);
        conf_process_free(&p);
    }
    conf_mutant_folder_remove(folder);
    conf_mutant_results_add(&c->list, m, c->o->suite);
    fprintf(stderr, "%s: %s %s %s\n", m->id, m->verdict, m->vector, m->by);
}

static int is_due(const campaign *c, const conf_mutant *m)
{
    return m->verdict[0] == '\0' && conf_place_is_here(m->place) &&
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

/* Returns 1 if the mutant has no result, and cannot be judged on this machine (here = 0), or can be
 * (here = 1). */
static int waits(const conf_mutant *m, int here)
{
    return m->verdict[0] == '\0' && conf_place_is_here(m->place) == here;
}

static size_t count_waiting(const conf_mutant_list *l, int here)
{
    size_t n = 0;

    for (size_t i = 0; i < l->n; i++)
        n += waits(&l->m[i], here) ? 1 : 0;
    return n;
}

/* Prints the mutants without a result, one line per file and place, in the order of the list. */
static void print_waiting(const conf_mutant_list *l, int here, conf_bytes *b)
{
    for (size_t i = 0; i < l->n; i++) {
        const conf_mutant *m = &l->m[i], *first = l->m;

        if (!waits(m, here))
            continue;
        while (!waits(first, here) || strcmp(first->file, m->file) != 0 || first->place != m->place)
            first++;
        if (first < m)
            continue;
        conf_print(b, "* %s", m->file);
        if (!here)
            conf_print(b, ", for %s", m->place->needs);
        conf_print(b, ":");
        for (; m < l->m + l->n; m++)
            if (waits(m, here) && strcmp(m->file, first->file) == 0 && m->place == first->place)
                conf_print(b, " %s", m->id);
        conf_print(b, "\n");
    }
    if (count_waiting(l, here) == 0)
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
    conf_print(b, "| %s | %s | %s | %s | `", m->id, m->file, place_name(m->place), m->verdict);
    print_cell(m->from, b);
    conf_print(b, "` | `");
    print_cell(m->to, b);
    conf_print(b, "` | ");
    print_cell(m->why, b);
    conf_print(b, " |\n");
}

static void print_mutants(const conf_mutant_list *l, conf_bytes *b)
{
    conf_print(b, "## Survivors\n\n%s",
               conf_mutant_count(l, "survived") + conf_mutant_count(l, "no compile") == 0
                   ? "none\n"
                   : "| mutant | file | place | result | line | becomes | why |\n"
                     "|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < l->n; i++)
        if (strcmp(l->m[i].verdict, "survived") == 0 || strcmp(l->m[i].verdict, "no compile") == 0)
            print_survivor(&l->m[i], b);
    conf_print(b, "\n## Not run because their inputs have changed\n\n");
    print_waiting(l, 1, b);
    conf_print(b, "\n## Not run because the machine lacks the kernels\n\n");
    print_waiting(l, 0, b);
    conf_print(b, "\n## Killed\n\n`mutants.csv` names the first vector that killed each of the "
                  "others, and says what was\nwrong with the answer.\n");
}

static const char introduction[] =
    "# Mutants\n\n"
    "`make conformance-mutants` seeds the faults of `mutants.list` into the reference decoder,\n"
    "one at a time, and runs each changed decoder over the published vectors. It first checks\n"
    "that the unchanged program, built and run in the same way, passes. A mutant is judged at one\n"
    "place ([README](README.md#mutants)): plain kernels and one thread unless the list names\n"
    "kernels for vectors, threads, or the DEFLATE decoder that annex L prints. Results are kept\n"
    "in `mutants.csv` for as long as their inputs are the same; `ted4conf mutants --check`\n"
    "says how many still hold.\n";

/* Prints how many mutants of each place were killed, of those that were judged. */
static void print_places(const conf_mutant_list *l, conf_bytes *b)
{
    const conf_place *place;

    conf_print(b, "| place | mutants | killed | survived |\n|---|---|---|---|\n");
    for (int i = 0; (place = conf_place_at(i)) != NULL; i++) {
        size_t n = 0, killed = 0, survived = 0;

        for (size_t j = 0; j < l->n; j++) {
            if (l->m[j].place != place)
                continue;
            n++;
            killed += strcmp(l->m[j].verdict, "killed") == 0;
            survived += strcmp(l->m[j].verdict, "survived") == 0;
        }
        if (n > 0)
            conf_print(b, "| %s | %zu | %zu | %zu |\n", place_name(place), n, killed, survived);
    }
    conf_print(b, "\n");
}

static int write_report(const campaign *c)
{
    const conf_mutant_list *l = &c->list;
    const size_t killed = conf_mutant_count(l, "killed"),
                 survived = conf_mutant_count(l, "survived"), judged = killed + survived,
                 lacking = count_waiting(l, 0);
    const int good = judged >= LEAST_MUTANTS && 100 * killed >= LEAST_PERCENT * judged &&
                     judged + lacking == l->n;
    conf_bytes b = { NULL, 0, 0 };
    char path[CONF_PATH];

    conf_print(&b, "%s\n", introduction);
    conf_mutant_print_counts(l, judged + lacking == l->n, &b);
    conf_print(&b, "\n");
    print_places(l, &b);
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

/* Returns 1 if a mutant that is judged there needs a result. */
static int is_due_at(const campaign *c, const conf_place *place)
{
    for (size_t i = 0; i < c->list.n; i++)
        if (c->list.m[i].place == place && is_due(c, &c->list.m[i]))
            return 1;
    return 0;
}

/* Runs all mutants that need a result, after the unchanged program at each of their places. */
static void run_due(campaign *c)
{
    const conf_place *place;
    int due = 0;

    for (int i = 0; (place = conf_place_at(i)) != NULL; i++) {
        if (!is_due_at(c, place))
            continue;
        if (c->o->compile == NULL)
            conf_die("--compile is missing: the decoder's compiler and flags (make "
                     "conformance-mutants has them)");
        baseline(c, place);
        due = 1;
    }
    if (due) {
        work(c);
        conf_mutant_results_read(&c->list, c->o->suite);
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
        conf_mutant_results_keep(&c.list, o->suite);
        good = write_report(&c);
    }
    conf_mutant_list_free(&c.list);
    return !good;
}
