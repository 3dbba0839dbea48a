/* mutant_list.c - see mutant_list.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutant_list.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "process.h"

enum { ROW = 2 * CONF_MUTANT_LINE, MAX_SECONDS = 60 };

static void strip(char *line)
{
    size_t n = strlen(line);

    while (n > 0 && (line[n - 1] == '\n' || line[n - 1] == '\r' || line[n - 1] == ' '))
        line[--n] = '\0';
}

static void begin(conf_mutant_list *l, const char *path, const char *line)
{
    conf_mutant *m;
    int n;

    l->m = realloc(l->m, (l->n + 1) * sizeof *l->m);
    if (l->m == NULL)
        conf_die("no memory");
    m = &l->m[l->n];
    memset(m, 0, sizeof *m);
    m->place = conf_place_named("");
    n = sscanf(line, "mutant %63s %199s", m->id, m->file);
    if (n < 1 || (n < 2 && l->n == 0))
        conf_die("%s: bad line: %s", path, line);
    if (n < 2) {
        memcpy(m->file, m[-1].file, sizeof m->file);
        memcpy(m->from, m[-1].from, sizeof m->from);
    }
    for (size_t i = 0; i < l->n; i++)
        if (strcmp(l->m[i].id, m->id) == 0)
            conf_die("%s: %s is there twice", path, m->id);
    l->n++;
}

static void take_text(char *to, const char *line)
{
    snprintf(to, CONF_MUTANT_LINE, "%s", line + (line[1] == ' ' ? 2 : 1));
}

static void take_place(conf_mutant *m, const char *path, const char *line)
{
    m->place = conf_place_named(line + 1 + strspn(line + 1, " "));
    if (m->place == NULL)
        conf_die("%s: %s: no such place: %s", path, m->id, line);
}

static void take_line(conf_mutant_list *l, const char *path, const char *line)
{
    conf_mutant *const m = l->n > 0 ? &l->m[l->n - 1] : NULL;

    if (strncmp(line, "mutant ", 7) == 0)
        begin(l, path, line);
    else if (m != NULL && line[0] == '<')
        take_text(m->from, line);
    else if (m != NULL && line[0] == '>')
        take_text(m->to, line);
    else if (m != NULL && line[0] == '@')
        take_place(m, path, line);
    else if (m != NULL && line[0] == '=')
        take_text(m->why, line);
    else if (m != NULL && line[0] == '!')
        take_text(m->programs, line);
    else if (line[0] != '#' && line[0] != '\0')
        conf_die("%s: bad line: %s", path, line);
}

int conf_mutant_apply(const conf_mutant *m, conf_bytes *out)
{
    conf_bytes in;
    int n = 0;

    if (!conf_read(m->file, &in))
        conf_die("%s: %s cannot be read", m->id, m->file);
    for (char *line = (char *)in.data, *next; *line != '\0'; line = next) {
        char *const end = strchr(line, '\n');
        const size_t indent = strspn(line, " \t"),
                     length = end != NULL ? (size_t)(end - line) : strlen(line);

        next = line + length + (end != NULL);
        if (length - indent == strlen(m->from) &&
            memcmp(line + indent, m->from, length - indent) == 0 && ++n == 1)
            conf_print(out, "%.*s%s\n", (int)indent, line, m->to);
        else
            conf_add(out, line, (size_t)(next - line));
    }
    conf_free(&in);
    return n;
}

void conf_mutant_list_read(conf_mutant_list *l, const char *path)
{
    char line[CONF_MUTANT_LINE];
    FILE *f = fopen(path, "r");

    if (f == NULL)
        conf_die("%s: cannot be read", path);
    while (fgets(line, sizeof line, f) != NULL) {
        strip(line);
        take_line(l, path, line);
    }
    fclose(f);
    for (size_t i = 0; i < l->n; i++) {
        conf_bytes changed = { NULL, 0, 0 };
        const int n = conf_mutant_apply(&l->m[i], &changed);

        if (n != 1)
            conf_die("%s: %s: its line is in %s %d times: %s", path, l->m[i].id, l->m[i].file, n,
                     l->m[i].from);
        conf_free(&changed);
    }
}

void conf_mutant_list_free(conf_mutant_list *l)
{
    free(l->m);
    conf_suite_free(l->vector, l->n_vectors);
    *l = (conf_mutant_list) { .m = NULL };
}

uint64_t conf_mutant_code_of(const char *files)
{
    char command[CONF_PATH];
    const char *none[] = { NULL };
    conf_process_options o = { command, "LC_ALL=C", MAX_SECONDS, 0 };
    conf_process p, *one[1] = { &p };
    uint64_t hash;

    conf_path(command, "exec awk -f bench/sources.awk %s", files);
    conf_process_start(&p, &o, none);
    while (conf_process_wait(one, 1, 100) < 0)
        ;
    if (p.end != CONF_ENDED || p.code != 0 || p.answer.size == 0)
        conf_die("%s: no code in it: %s", files, (const char *)p.complaint.data);
    hash = conf_seed((const char *)p.answer.data);
    conf_process_free(&p);
    return hash;
}

/* Returns a hash of a vector's hashes and of the expected answer: of its descriptor without the
 * members that only describe it. */
static uint64_t hash_of(const conf_entry *vector)
{
    static const char *const said[] = {
        "features", "intent", "license", "origin", "rules", "since"
    };
    json_t *const d = json_copy(vector->descriptor);
    char *text;
    uint64_t hash;

    for (size_t i = 0; i < sizeof said / sizeof *said; i++)
        (void)json_object_del(d, said[i]);
    text = json_dumps(d, JSON_SORT_KEYS | JSON_COMPACT);
    if (text == NULL)
        conf_die("no memory");
    hash = conf_seed(text);
    free(text);
    json_decref(d);
    return hash;
}

/* Hashes the files that have mutants, and what only other places than the first use. */
static void hash_files(conf_mutant_list *l)
{
    for (size_t i = 0; i < l->n; i++) {
        for (size_t j = 0; j < i && l->m[i].code == 0; j++)
            if (strcmp(l->m[i].file, l->m[j].file) == 0)
                l->m[i].code = l->m[j].code;
        if (l->m[i].code == 0)
            l->m[i].code = conf_mutant_code_of(l->m[i].file);
        if (l->beyond == 0 && l->m[i].place->name[0] != '\0')
            l->beyond = conf_mutant_code_of("ref-decoder/kernel/*.[ch] "
                                            "ref-decoder/tool/thread*.[ch] " CONF_PRINTED_INFLATE
                                            " " CONF_ANNEX_L);
    }
}

static void hash_vectors(conf_mutant_list *l, const char *suite)
{
    conf_bytes all = { NULL, 0, 0 };
    char folder[CONF_PATH];

    conf_path(folder, "%s/vectors", suite);
    l->vector = conf_suite_load(folder, NULL, &l->n_vectors);
    conf_print(&all, "%016" PRIx64,
               conf_mutant_code_of(
                   "ref-decoder/base/*.[ch] ref-decoder/norm/*.[ch] ref-decoder/read/*.[ch] "
                   "ref-decoder/recon/*.[ch]"));
    for (size_t i = 0; i < l->n_vectors; i++)
        conf_print(&all, "%016" PRIx64, hash_of(&l->vector[i]));
    l->all = conf_seed((const char *)all.data);
    conf_free(&all);
}

/* Returns 0 if the vector that killed the mutant no longer exists. */
static uint64_t ground_of_vectors(const conf_mutant_list *l, const conf_mutant *m)
{
    if (strcmp(m->verdict, "killed") != 0)
        return l->all;
    for (size_t i = 0; i < l->n_vectors; i++)
        if (strcmp(l->vector[i].id, m->vector) == 0)
            return hash_of(&l->vector[i]);
    return 0;
}

/* Returns 0 if what killed the mutant no longer exists. */
static uint64_t key_of(const conf_mutant_list *l, const conf_mutant *m)
{
    const uint64_t ground = l->ground != NULL ? l->ground(l, m) : ground_of_vectors(l, m);
    conf_bytes text = { NULL, 0, 0 };
    uint64_t key;

    conf_print(&text, "%s|%s|%s|%016" PRIx64 "|%s|%016" PRIx64, m->file, m->from, m->to, m->code,
               m->verdict, ground);
    if (m->place->name[0] != '\0')
        conf_print(&text, "|%s", m->place->name);
    if (m->place->name[0] != '\0' && strcmp(m->verdict, "killed") != 0)
        conf_print(&text, "|%016" PRIx64, l->beyond);
    key = ground == 0 ? 0 : conf_seed((const char *)text.data);
    conf_free(&text);
    return key;
}

static void take_row(conf_mutant_list *l, const char *row)
{
    conf_mutant given = { .id = "" };
    uint64_t key;
    int at = 0;

    /* The vector may be empty, which %[ does not match. */
    if (sscanf(row, "%63[^,],%" SCNx64 ",%15[^,],%n", given.id, &key, given.verdict, &at) < 3 ||
        at == 0)
        return;
    if (sscanf(row + at, "%95[^,]", given.vector) == 1)
        at += (int)strlen(given.vector);
    if (row[at] != ',')
        return;
    for (size_t i = 0; i < l->n; i++) {
        conf_mutant *const m = &l->m[i];
        conf_mutant with = *m;

        if (strcmp(m->id, given.id) != 0)
            continue;
        memcpy(with.verdict, given.verdict, sizeof with.verdict);
        memcpy(with.vector, given.vector, sizeof with.vector);
        snprintf(with.by, sizeof with.by, "%s", row + at + 1);
        if (key != 0 && key_of(l, &with) == key)
            *m = with;
    }
}

void conf_mutant_results_read(conf_mutant_list *l, const char *suite)
{
    char path[CONF_PATH], row[ROW];
    FILE *f;

    hash_files(l);
    if (l->ground == NULL && l->vector == NULL)
        hash_vectors(l, suite);
    conf_path(path, "%s/mutants.csv", suite);
    f = fopen(path, "r");
    while (f != NULL && fgets(row, sizeof row, f) != NULL) {
        strip(row);
        take_row(l, row);
    }
    if (f != NULL)
        fclose(f);
}

static void print_row(const conf_mutant_list *l, const conf_mutant *m, conf_bytes *b)
{
    conf_print(b, "%s,%016" PRIx64 ",%s,%s,%s\n", m->id, key_of(l, m), m->verdict, m->vector,
               m->by);
}

void conf_mutant_results_add(const conf_mutant_list *l, const conf_mutant *m, const char *suite)
{
    conf_bytes row = { NULL, 0, 0 };
    char path[CONF_PATH];
    FILE *f;

    print_row(l, m, &row);
    conf_path(path, "%s/mutants.csv", suite);
    f = fopen(path, "a");
    /* One write, since several processes append. */
    if (f == NULL || fputs((const char *)row.data, f) == EOF || fclose(f) != 0)
        conf_die("%s: cannot be written", path);
    conf_free(&row);
}

void conf_mutant_results_keep(const conf_mutant_list *l, const char *suite)
{
    conf_bytes rows = { NULL, 0, 0 };
    char path[CONF_PATH];

    for (size_t i = 0; i < l->n; i++)
        if (l->m[i].verdict[0] != '\0')
            print_row(l, &l->m[i], &rows);
    conf_path(path, "%s/mutants.csv", suite);
    if (rows.size > 0)
        conf_write(path, rows.data, rows.size);
    conf_free(&rows);
}

size_t conf_mutant_count(const conf_mutant_list *l, const char *verdict)
{
    size_t n = 0;

    for (size_t i = 0; i < l->n; i++)
        n += strcmp(l->m[i].verdict, verdict) == 0;
    return n;
}

void conf_mutant_print_counts(const conf_mutant_list *l, int complete, conf_bytes *out)
{
    const size_t killed = conf_mutant_count(l, "killed"),
                 survived = conf_mutant_count(l, "survived"), judged = killed + survived;
    char share[16] = "";

    if (complete && judged > 0)
        snprintf(share, sizeof share, " (%.1f %%)", 100.0 * (double)killed / (double)judged);
    conf_print(out,
               "| | |\n|---|---|\n| mutants | %zu |\n| judged | %zu |\n| killed | %zu%s |\n"
               "| survived | %zu |\n| do not compile | %zu |\n| not run | %zu |\n",
               l->n, judged, killed, share, survived, conf_mutant_count(l, "no compile"),
               conf_mutant_count(l, ""));
}
