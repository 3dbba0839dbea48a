/* mutants.c - see mutants.h. A mutant is one textual change to one source file:
 *     mutant ID FILE
 *     < the line as it is, without its indentation
 *     > the line as it becomes
 * The changed file is compiled from a folder of its own that comes first among the include paths; a changed header takes all of the decoder's
 * sources with it that include it. Then `ted4conf replay --stop`, linked with these objects, goes through the suite: killed means that it
 * fails, crashes, hangs, or does not compile (which counts apart). A row of mutants.csv is kept for as long as the mutant's text is the same.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutants.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "process.h"

enum { MAX_MUTANTS = 1000, LINE = 400, LEAST_PERCENT = 95, LEAST_MUTANTS = 200 };

typedef struct {
    char id[64], file[200], from[LINE], to[LINE];
    char verdict[32];           /* "" : no result yet; "killed", "survived", "no compile" */
    char by[LINE];              /* what the replay said */
} mutant;

typedef struct {
    const conf_mutant_options *o;
    mutant *m;
    size_t  n;
} list;

static void strip(char *line)
{
    size_t n = strlen(line);

    while (n > 0 && (line[n - 1] == '\n' || line[n - 1] == '\r' || line[n - 1] == ' '))
        line[--n] = '\0';
}

static void read_list(list *l)
{
    char  path[CONF_PATH], line[LINE];
    FILE *f;

    conf_path(path, "%s/mutants.list", l->o->suite);
    f = fopen(path, "r");
    if (f == NULL)
        conf_die("%s: cannot be read", path);
    l->m = conf_alloc(MAX_MUTANTS, sizeof *l->m);
    while (fgets(line, sizeof line, f) != NULL) {
        strip(line);
        if (strncmp(line, "mutant ", 7) == 0) {
            if (l->n == MAX_MUTANTS || sscanf(line, "mutant %63s %199s", l->m[l->n].id, l->m[l->n].file) != 2)
                conf_die("%s: bad line: %s", path, line);
            l->n++;
        } else if (l->n > 0 && line[0] == '<' && line[1] == ' ') {
            memcpy(l->m[l->n - 1].from, line + 2, strlen(line + 2) + 1);
        } else if (l->n > 0 && line[0] == '>') {
            memcpy(l->m[l->n - 1].to, line + (line[1] == ' ' ? 2 : 1), strlen(line + (line[1] == ' ' ? 2 : 1)) + 1);
        } else if (line[0] != '#' && line[0] != '\0') {
            conf_die("%s: bad line: %s", path, line);
        }
    }
    fclose(f);
}

/* What a result depends on, besides the suite: the mutant's text. */
static unsigned long long key_of(const mutant *m)
{
    char text[3 * LINE];

    snprintf(text, sizeof text, "%s|%s|%s", m->file, m->from, m->to);
    return conf_seed(text);
}

static void csv_path(const list *l, char *path)
{
    conf_path(path, "%s/mutants.csv", l->o->suite);
}

/* ID,KEY,VERDICT,BY: later rows win. */
static void read_results(list *l)
{
    char  path[CONF_PATH], line[2 * LINE], id[64], verdict[32];
    FILE *f;

    csv_path(l, path);
    f = fopen(path, "r");
    while (f != NULL && fgets(line, sizeof line, f) != NULL) {
        unsigned long long key;
        int                at = 0;

        strip(line);
        if (sscanf(line, "%63[^,],%llx,%31[^,],%n", id, &key, verdict, &at) < 3)
            continue;
        for (size_t i = 0; i < l->n; i++)
            if (strcmp(l->m[i].id, id) == 0 && key_of(&l->m[i]) == key) {
                snprintf(l->m[i].verdict, sizeof l->m[i].verdict, "%s", verdict);
                snprintf(l->m[i].by, sizeof l->m[i].by, "%s", at > 0 ? line + at : "");
            }
    }
    if (f != NULL)
        fclose(f);
}

static void add_result(const list *l, const mutant *m)
{
    char  path[CONF_PATH], row[2 * LINE];
    FILE *f;

    csv_path(l, path);
    f = fopen(path, "a");
    snprintf(row, sizeof row, "%s,%016llx,%s,%s\n", m->id, key_of(m), m->verdict, m->by);
    if (f == NULL || fputs(row, f) == EOF || fclose(f) != 0)
        conf_die("%s: cannot be written", path);
}

/* The file with its one line changed, below folder; 0: the line is not there exactly once. */
static int write_changed(const mutant *m, const char *folder)
{
    conf_bytes  in, out = { NULL, 0, 0 };
    char        path[CONF_PATH];
    int         n = 0;

    if (!conf_read(m->file, &in))
        return 0;
    for (char *line = (char *)in.data, *next; *line != '\0'; line = next) {
        char *const  end = strchr(line, '\n');
        const size_t indent = strspn(line, " \t"), length = end != NULL ? (size_t)(end - line) : strlen(line);

        next = line + length + (end != NULL);
        if (length - indent == strlen(m->from) && memcmp(line + indent, m->from, length - indent) == 0 && ++n == 1)
            conf_print(&out, "%.*s%s\n", (int)indent, line, m->to);
        else
            conf_add(&out, line, (size_t)(next - line));
    }
    conf_path(path, "%s/%s", folder, m->file);
    conf_write(path, out.data, out.size);
    conf_free(&in);
    conf_free(&out);
    return n == 1;
}

/* A shell command; 1: it went well. */
static int shell(const char *command)
{
    const int status = system(command);

    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Compiles what the change touches into folder, and links. */
static int build(const list *l, const mutant *m, const char *folder)
{
    const int  header = strcmp(m->file + strlen(m->file) - 2, ".h") == 0;
    conf_bytes c = { NULL, 0, 0 };
    int        good;

    conf_print(&c, "cd . && d='%s'; for s in ", folder);
    if (header)
        conf_print(&c, "$(cd %s && grep -l '%s' ref-decoder/norm/*.d ref-decoder/read/*.d ref-decoder/recon/*.d | sed 's/\\.d$/.c/')",
                   l->o->build, m->file);
    else
        conf_print(&c, "%s", m->file);
    conf_print(&c, "; do from=$s; [ -f \"$d/$s\" ] && from=$d/$s; %s -I\"$d/ref-decoder\" -Iref-decoder -Iref-encoder -w -c $from "
               "-o \"$d/$(echo $s | tr / _).o\" 2>>\"$d/log\" || exit 1; done; ", l->o->compile);
    conf_print(&c, "cc -fopenmp \"$d\"/*.o %s/conformance/tool/*.o %s/conformance/tolerance/class_t.o %s/tests/spec/eval_*.o "
               "$(ls %s/ref-decoder/tool/*.o | grep -v /ted4) %s/libted4enc.a %s/libted4dec.a -o \"$d/ted4conf\" %s 2>>\"$d/log\"",
               l->o->build, l->o->build, l->o->build, l->o->build, l->o->build, l->o->build, l->o->libraries);
    good = shell((const char *)c.data);
    conf_free(&c);
    return good;
}

/* First line that the replay printed, or what it said on stderr, as a CSV field. */
static void take_reason(mutant *m, const conf_process *p)
{
    snprintf(m->by, sizeof m->by, "%s%.120s", p->end == CONF_CRASHED ? "crash " : p->end == CONF_HUNG ? "hang " : "",
             (const char *)(p->answer.size > 0 ? p->answer.data : p->complaint.data));
    for (char *c = m->by; *c != '\0'; c++) {
        if (*c == '\n') {
            *c = '\0';
            break;
        }
        if (*c == ',' || *c == '"' || *c == '|')
            *c = ' ';
    }
}

static void replay(const list *l, mutant *m, const char *folder)
{
    const conf_process_options o = { "exec", "TED4_KERNEL=plain", l->o->timeout, (uint64_t)4 << 30 };
    char          program[CONF_PATH];
    const char   *argv[] = { program, "replay", "--stop", "--suite", l->o->vectors != NULL ? l->o->vectors : l->o->suite, NULL };
    conf_process  p, *one[1] = { &p };

    conf_path(program, "%s/ted4conf", folder);
    conf_process_start(&p, &o, argv);
    while (conf_process_wait(one, 1, 100) < 0)
        ;
    snprintf(m->verdict, sizeof m->verdict, "%s", p.end == CONF_ENDED && p.code == 0 ? "survived" : "killed");
    take_reason(m, &p);
    conf_process_free(&p);
}

static void try_one(const list *l, mutant *m)
{
    const char *tmp = getenv("TMPDIR");
    char        folder[CONF_PATH], command[CONF_PATH + 16];

    conf_path(folder, "%s/ted4mutant-XXXXXX", tmp != NULL ? tmp : "/tmp");
    if (mkdtemp(folder) == NULL)
        conf_die("%s: cannot be made", folder);
    if (!write_changed(m, folder))
        snprintf(m->verdict, sizeof m->verdict, "stale");
    else if (!build(l, m, folder))
        snprintf(m->verdict, sizeof m->verdict, "no compile");
    else
        replay(l, m, folder);
    add_result(l, m);
    fprintf(stderr, "%s: %s %s\n", m->id, m->verdict, m->by);
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    (void)shell(command);
}

/* Every jobs-th mutant without result, in a process of its own. */
static void work(const list *l)
{
    for (int j = 0; j < l->o->jobs; j++) {
        const pid_t pid = fork();
        int         turn = 0;

        if (pid < 0)
            conf_die("fork");
        if (pid > 0)
            continue;
        for (size_t i = 0; i < l->n; i++)
            if (l->m[i].verdict[0] == '\0' && (l->o->only == NULL || strncmp(l->m[i].id, l->o->only, strlen(l->o->only)) == 0)
                && turn++ % l->o->jobs == j)
                try_one(l, &l->m[i]);
        _exit(0);
    }
    while (wait(NULL) > 0)
        ;
}

static size_t count(const list *l, const char *verdict)
{
    size_t n = 0;

    for (size_t i = 0; i < l->n; i++)
        n += strcmp(l->m[i].verdict, verdict) == 0;
    return n;
}

static int write_report(const list *l)
{
    const size_t killed = count(l, "killed"), survived = count(l, "survived"), judged = killed + survived;
    conf_bytes   b = { NULL, 0, 0 };
    char         path[CONF_PATH];
    const int    good = judged >= LEAST_MUTANTS && 100 * killed >= LEAST_PERCENT * judged && judged == l->n;

    conf_print(&b, "# Mutants\n\nFaults seeded into the reference decoder, one at a time (`mutants.list`), against the published vectors alone: `make "
               "conformance-mutants`.\nThe plain kernels are used, so that `norm/` is what is tested. Results are kept in `mutants.csv` and found again as long as "
               "a mutant's text is the same.\n\n| | |\n|---|---|\n| mutants | %zu |\n| judged | %zu |\n| killed | %zu (%.1f %%) |\n| survived | %zu |\n"
               "| do not compile, or stale | %zu |\n| not run yet | %zu |\n\n", l->n, judged, killed,
               judged > 0 ? 100.0 * (double)killed / (double)judged : 0.0, survived, count(l, "no compile") + count(l, "stale"), count(l, ""));
    conf_print(&b, "## Survivors\n\n");
    for (size_t i = 0; i < l->n; i++)
        if (strcmp(l->m[i].verdict, "survived") == 0 || strcmp(l->m[i].verdict, "no compile") == 0 || strcmp(l->m[i].verdict, "stale") == 0)
            conf_print(&b, "* %s (%s, %s): `%s` for `%s`\n", l->m[i].id, l->m[i].file, l->m[i].verdict, l->m[i].to, l->m[i].from);
    conf_print(&b, "\n## Killed, and by what first\n\n| mutant | file | by |\n|---|---|---|\n");
    for (size_t i = 0; i < l->n; i++)
        if (strcmp(l->m[i].verdict, "killed") == 0)
            conf_print(&b, "| %s | %s | %s |\n", l->m[i].id, l->m[i].file, l->m[i].by);
    conf_path(path, "%s/MUTANTS.md", l->o->suite);
    conf_write(path, b.data, b.size);
    conf_free(&b);
    printf("%zu mutants, %zu killed, %zu survived, %zu not judged: %s\n", l->n, killed, survived, l->n - judged,
           good ? "enough" : "not enough");
    return good;
}

int conf_mutants(const conf_mutant_options *o)
{
    list l = { .o = o };
    int  good;

    read_list(&l);
    read_results(&l);
    work(&l);
    read_results(&l);
    good = write_report(&l);
    free(l.m);
    return !good;
}
