/* run.c - see run.h. Each vector is copied into a folder of its own and given to the decoder twice;
 * both answers have to agree. If the decoder claims lenient mode, the second run of a vector that
 * is not invalid uses that mode, and a vector that has something to salvage gets a third run.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "judge_t.h"
#include "recipe.h"
#include "scratch.h"
#include "tool/clock.h"
#include "vector.h"

typedef enum { RUN_FIRST, RUN_SECOND, RUN_LENIENT } run_kind;

/* A vector that is being run. */
typedef struct {
    conf_process process;
    size_t entry;
    run_kind run;
    json_t *first;   /* answer of the first run; owned */
    conf_bytes file; /* owned */
    char folder[CONF_PATH], dump[CONF_PATH];
} slot;

typedef struct {
    conf_run_result *r;
    conf_process_options options[3]; /* one for each kind of run */
    conf_process **process;          /* [jobs] of the slots */
    char folder[CONF_PATH];          /* contains the folders of all slots; removed at the end */
    conf_recipes recipes;            /* for vectors made on demand; empty until one is needed */
} runner;

static json_t *ask_capabilities(runner *w)
{
    static const char *const argv[] = { "--ted4-capabilities", NULL };
    conf_process p;
    conf_process *list[1] = { &p };
    json_t *o;

    conf_process_start(&p, &w->options[0], argv);
    while (conf_process_wait(list, 1, 100) < 0)
        ;
    o = conf_judge_document(&p, &w->r->handshake);
    if (o != NULL && !conf_judge_capabilities(o, &w->r->handshake)) {
        json_decref(o);
        o = NULL;
    }
    conf_process_free(&p);
    return o;
}

static int right_hash(const conf_entry *e, const conf_bytes *b)
{
    char hash[CONF_HASH + 1];

    conf_hash(hash, b->data, b->size);
    return strcmp(hash, json_string_value(json_object_get(e->descriptor, "sha256"))) == 0;
}

/* Makes a vector of which only the recipe is stored. */
static int make_on_demand(runner *w, const conf_entry *e, conf_bytes *b)
{
    char path[CONF_PATH];

    if (w->recipes.n == 0) {
        conf_path(path, "%s/recipes", w->r->options->suite);
        conf_recipes_load(&w->recipes, path);
    }
    for (size_t i = 0; i < w->recipes.n; i++)
        if (strcmp(w->recipes.recipe[i].id, e->id) == 0) {
            conf_vector v;

            (void)conf_vector_make(&v, &w->recipes.recipe[i], w->r->options->suite);
            *b = v.file;
            json_decref(v.descriptor);
            return 1;
        }
    return 0;
}

/* Reads the file of an entry. Returns 0, with the verdict filled, if the vector cannot be run. */
static int fetch(runner *w, size_t i, conf_bytes *b)
{
    const conf_entry *e = &w->r->entry[i];
    conf_verdict *v = &w->r->verdict[i];
    const json_t *demand = json_object_get(e->descriptor, "demand");

    *v = (conf_verdict) { CONF_MISSING, "" };
    if (e->descriptor == NULL) {
        snprintf(v->reason, sizeof v->reason,
                 "there is no descriptor, or not the one that SUITE.json knows");
        return 0;
    }
    if (conf_judge_declines(w->r->capabilities, e->descriptor)) {
        *v = (conf_verdict) { CONF_DECLINED, "the decoder declines a feature or knob of it" };
        return 0;
    }
    if (!conf_read(e->file, b)) {
        if (demand != NULL &&
            (json_is_string(demand) ? !w->r->options->large : !w->r->options->demand)) {
            v->outcome = CONF_NOT_RUN;
            snprintf(v->reason, sizeof v->reason, "made on demand only (--%s)",
                     json_is_string(demand) ? "large" : "demand");
            return 0;
        }
        if (demand == NULL || !make_on_demand(w, e, b)) {
            snprintf(v->reason, sizeof v->reason, "the file is not there");
            return 0;
        }
    }
    if (!right_hash(e, b)) {
        snprintf(v->reason, sizeof v->reason, "the file is another one than its descriptor says");
        conf_free(b);
        return 0;
    }
    return 1;
}

/* Returns 1 if the current run of a slot uses lenient mode. */
static int lenient(const runner *w, const slot *s)
{
    return s->run == RUN_LENIENT ||
           (s->run == RUN_SECOND && conf_judge_lenient(w->r->capabilities) &&
            !conf_expects(w->r->entry[s->entry].descriptor, "invalid"));
}

/* Removes the files that decoders have left in the folder of --dump. */
static void empty(const char *folder)
{
    char path[CONF_PATH];
    size_t n;
    char **name = conf_list(folder, "", &n);

    for (size_t i = 0; i < n; i++) {
        conf_path(path, "%s/%s", folder, name[i]);
        unlink(path);
    }
    conf_list_free(name, n);
}

static void start(runner *w, slot *s)
{
    const conf_entry *e = &w->r->entry[s->entry];
    char file[CONF_PATH], queries[CONF_PATH], knob[64];
    const char *argv[16] = { "--ted4-run", file, "--tiers", "T0,T1,T2,T3,T4,T5" }, *name;
    json_t *value, *knobs = json_object_get(e->descriptor, "knobs");
    int n = 4;

    conf_path(file, "%s/input.ted4", s->folder);
    conf_path(queries, "%s/queries.json", s->folder);
    if (json_array_size(json_object_get(e->descriptor, "queries")) > 0) {
        argv[n++] = "--queries";
        argv[n++] = queries;
    }
    json_object_foreach(knobs, name, value)
    {
        if (!conf_has_knob(w->r->capabilities, name))
            continue; /* an invalid file is refused without the knob, too */
        snprintf(knob, sizeof knob, "%s=%lld", name, (long long)json_integer_value(value));
        argv[n++] = "--knob";
        argv[n++] = knob;
    }
    if (s->dump[0] != '\0') {
        empty(s->dump);
        argv[n++] = "--dump";
        argv[n++] = s->dump;
    }
    if (lenient(w, s)) {
        argv[n++] = "--mode";
        argv[n++] = "lenient";
    }
    argv[n] = NULL;
    conf_process_start(&s->process, &w->options[s->run], argv);
}

/* Copies the file and the queries into a new folder. The slot takes over *b. */
static void prepare(runner *w, slot *s, const conf_bytes *b)
{
    const json_t *const d = w->r->entry[s->entry].descriptor, *const queries =
                                                                  json_object_get(d, "queries");
    char path[CONF_PATH];

    s->file = *b;
    conf_path(s->folder, "%s/%zu", w->folder, s->entry);
    conf_path(path, "%s/input.ted4", s->folder);
    conf_write(path, b->data, b->size);
    chmod(path, 0444);
    conf_path(path, "%s/queries.json", s->folder);
    if (json_array_size(queries) > 0 && json_dump_file(queries, path, JSON_COMPACT) != 0)
        conf_die("%s cannot be written", path);
    if (conf_class_t_asked(w->r->capabilities, d)) {
        conf_path(s->dump, "%s/dump", s->folder);
        conf_make_folder(s->dump);
    }
}

static void clear(slot *s)
{
    char path[CONF_PATH];

    if (s->dump[0] != '\0') {
        empty(s->dump);
        rmdir(s->dump);
    }
    conf_path(path, "%s/input.ted4", s->folder);
    unlink(path);
    conf_path(path, "%s/queries.json", s->folder);
    unlink(path);
    rmdir(s->folder);
    conf_free(&s->file);
    json_decref(s->first);
    s->first = NULL;
}

static void tell(const runner *w, size_t i)
{
    const conf_verdict *v = &w->r->verdict[i];

    if ((v->outcome == CONF_PASS || v->outcome == CONF_DECLINED || v->outcome == CONF_NOT_RUN) ||
        w->r->options->quiet)
        return;
    fprintf(stderr, "%s: %s: %s\n", conf_outcome_name[v->outcome], w->r->entry[i].id, v->reason);
}

/* Returns 1 if the answers are equal. T5 of a decoder of class T is ignored, because its records
 * may differ from run to run. */
static int same_answer(const runner *w, const slot *s, const json_t *answer)
{
    json_t *a, *b;
    int same = json_equal(answer, s->first);

    if (same || !conf_class_t_asked(w->r->capabilities, w->r->entry[s->entry].descriptor))
        return same;
    a = json_deep_copy(answer);
    b = json_deep_copy(s->first);
    json_object_del(json_object_get(a, "tiers"), "T5");
    json_object_del(json_object_get(b, "tiers"), "T5");
    same = json_equal(a, b);
    json_decref(a);
    json_decref(b);
    return same;
}

/* Judges an answer by the expectation for this kind of run. */
static void judge(runner *w, const slot *s, const json_t *answer, conf_verdict *v)
{
    const json_t *const d = w->r->entry[s->entry].descriptor;
    const double now = ted4_clock();

    if (s->run != RUN_SECOND)
        conf_judge(w->r->capabilities, d, answer, v);
    else if (!same_answer(w, s, answer))
        *v = (conf_verdict) { CONF_FAIL, "" };
    if (v->outcome != CONF_PASS && s->run == RUN_SECOND)
        snprintf(v->reason, sizeof v->reason, "%s",
                 lenient(w, s) ? "lenient mode gave another answer" : "two runs gave two answers");
    if (v->outcome == CONF_PASS && s->run == RUN_FIRST &&
        json_is_object(json_object_get(answer, "salvage")))
        *v = (conf_verdict) { CONF_FAIL, "salvages something in strict mode (R-DEC-003)" };
    if (v->outcome == CONF_PASS && s->run == RUN_LENIENT)
        conf_judge_salvage(w->r->capabilities, d, answer, v);
    if (v->outcome == CONF_PASS && conf_class_t_asked(w->r->capabilities, d)) {
        conf_judge_class_t(&s->file, d, answer, s->dump, v);
        conf_process_excuse(w->process, w->r->options->jobs, ted4_clock() - now);
    }
}

/* Sets the next run of a slot that has passed its last one. Returns 0 if there is none. */
static int next_run(const runner *w, slot *s)
{
    if (s->run == RUN_FIRST && !w->r->options->once)
        s->run = RUN_SECOND;
    else if (s->run != RUN_LENIENT && conf_judge_lenient(w->r->capabilities) &&
             json_object_get(w->r->entry[s->entry].descriptor, "salvage") != NULL)
        s->run = RUN_LENIENT;
    else
        return 0;
    return 1;
}

/* Takes the answer of a run that has ended. Returns 1 if the slot has another run. */
static int take(runner *w, slot *s)
{
    conf_verdict *v = &w->r->verdict[s->entry];
    json_t *answer = conf_judge_document(&s->process, v);

    w->r->ms[s->entry] += s->process.ms;
    conf_process_free(&s->process);
    if (answer != NULL)
        judge(w, s, answer, v);
    if (s->run == RUN_FIRST)
        s->first = answer;
    else
        json_decref(answer);
    if (answer != NULL && v->outcome == CONF_PASS && next_run(w, s)) {
        start(w, s);
        return 1;
    }
    clear(s);
    tell(w, s->entry);
    return 0;
}

/* Fills a slot with the next vector that can be run. Returns 0 if there is none. */
static int fill(runner *w, slot *s, size_t *next)
{
    while (*next < w->r->n) {
        conf_bytes b;
        const size_t i = (*next)++;

        if (!fetch(w, i, &b)) {
            tell(w, i);
            continue;
        }
        memset(s, 0, sizeof *s);
        s->entry = i;
        prepare(w, s, &b);
        start(w, s);
        return 1;
    }
    return 0;
}

static void run_all(runner *w)
{
    const int jobs = w->r->options->jobs;
    slot *s = conf_alloc((size_t)jobs, sizeof *s);
    size_t next = 0;
    int busy = 0;

    w->process = conf_alloc((size_t)jobs, sizeof *w->process);
    for (int i = 0; i < jobs; i++) {
        w->process[i] = &s[i].process;
        busy += fill(w, &s[i], &next);
    }
    while (busy > 0) {
        const int i = conf_process_wait(w->process, jobs, 100);

        if (i >= 0 && !take(w, &s[i]) && !fill(w, &s[i], &next))
            busy--;
    }
    free(w->process);
    free(s);
}

/* Returns a text of the manifest, or "" if it has none. */
static const char *listed_text(const json_t *listed, const char *key)
{
    const char *const s = json_string_value(json_object_get(listed, key));

    return s != NULL ? s : "";
}

/* Returns 1 if both have the same member, or neither has it. */
static int same_member(const json_t *a, const char *key, const json_t *b, const char *other)
{
    const json_t *const x = json_object_get(a, key), *const y = json_object_get(b, other);

    return x == y || json_equal(x, y);
}

/* Returns 1 if this is the descriptor that the manifest lists, by its hash. The members that both
 * contain also have to agree, which checks the manifest itself. */
static int as_published(const json_t *listed, const conf_entry *e)
{
    const json_t *const d = e->descriptor;

    return strcmp(listed_text(listed, "json"), e->hash) == 0 &&
           same_member(listed, "folder", d, "category") &&
           same_member(listed, "bytes", d, "bytes") && same_member(listed, "sha256", d, "sha256") &&
           same_member(listed, "demand", d, "demand");
}

/* Returns the manifest's entry of a vector, borrowed, or NULL. */
static const json_t *listed_as(const json_t *list, const char *id)
{
    for (size_t i = 0; i < json_array_size(list); i++)
        if (strcmp(listed_text(json_array_get(list, i), "id"), id) == 0)
            return json_array_get(list, i);
    return NULL;
}

static void add_missing(conf_run_result *r, const json_t *list, size_t n_found)
{
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *const id = listed_text(json_array_get(list, i), "id");
        size_t j = 0;

        while (j < n_found && strcmp(r->entry[j].id, id) != 0)
            j++;
        if (j < n_found)
            continue;
        r->entry = realloc(r->entry, (r->n + 1) * sizeof *r->entry);
        if (r->entry == NULL)
            conf_die("no memory");
        memset(&r->entry[r->n], 0, sizeof *r->entry);
        snprintf(r->entry[r->n++].id, sizeof r->entry->id, "%s", id);
    }
}

/* Descriptors have to be those of SUITE.json, and, unless a list selects vectors, all vectors of
 * SUITE.json have to exist. */
static void hold_to_manifest(conf_run_result *r)
{
    char path[CONF_PATH];
    json_error_t why;
    json_t *manifest;
    const json_t *list;

    conf_path(path, "%s/SUITE.json", r->options->suite);
    manifest = json_load_file(path, 0, &why);
    if (manifest == NULL)
        conf_die("%s: line %d: %s", path, why.line, why.text);
    list = json_object_get(manifest, "vector");
    for (size_t i = 0; i < json_array_size(list); i++)
        if (listed_text(json_array_get(list, i), "id")[0] == '\0')
            conf_die("%s: vector %zu has no id", path, i);
    for (size_t i = 0; i < r->n; i++) {
        const json_t *const listed = listed_as(list, r->entry[i].id);

        if (r->entry[i].descriptor != NULL &&
            (listed == NULL || !as_published(listed, &r->entry[i]))) {
            json_decref(r->entry[i].descriptor);
            r->entry[i].descriptor = NULL;
        }
    }
    if (r->options->list == NULL)
        add_missing(r, list, r->n);
    json_decref(manifest);
}

/* Says why the decoder does not conform, if the reason is not a vector. */
static void give_reason(conf_run_result *r)
{
    const char *const lacks = conf_judge_lacks(r->capabilities);

    if (r->capabilities == NULL)
        snprintf(r->reason, sizeof r->reason, "%s", r->handshake.reason);
    else if (r->valid_passed == 0)
        snprintf(r->reason, sizeof r->reason, "no valid stream decoded");
    else if (lacks != NULL)
        snprintf(r->reason, sizeof r->reason, "%s is not claimed (R-DMP-070)", lacks);
}

static void sum_up(conf_run_result *r)
{
    for (size_t i = 0; i < r->n; i++) {
        r->count[r->verdict[i].outcome]++;
        r->valid_passed += r->verdict[i].outcome == CONF_PASS &&
                           conf_expects(r->entry[i].descriptor, "valid");
    }
    give_reason(r);
    r->passed = r->reason[0] == '\0' &&
                r->count[CONF_FAIL] + r->count[CONF_NO_ANSWER] + r->count[CONF_MISSING] == 0;
}

/* Ends the program if a report cannot be written, or would replace another one, before a run of
 * minutes would be in vain. */
static void try_reports(const conf_run_options *o)
{
    static const char *const option[] = { "--json", "--junit", "--html" };
    const char *const path[] = { o->json, o->junit, o->html };

    for (size_t i = 0; i < sizeof path / sizeof *path; i++) {
        if (path[i] == NULL)
            continue;
        for (size_t j = 0; j < i; j++)
            if (path[j] != NULL && strcmp(path[i], path[j]) == 0)
                conf_die("%s and %s: both are %s", option[j], option[i], path[i]);
        conf_write_try(path[i]);
    }
}

static void write_reports(const conf_run_result *r)
{
    printf("%s: %zu passed, %zu failed, %zu without answer, %zu missing, %zu declined, %zu not "
           "run: %s%s%s\n",
           r->capabilities != NULL ? json_string_value(json_object_get(r->capabilities, "name"))
                                   : r->options->decoder,
           r->count[CONF_PASS], r->count[CONF_FAIL], r->count[CONF_NO_ANSWER],
           r->count[CONF_MISSING], r->count[CONF_DECLINED], r->count[CONF_NOT_RUN],
           r->passed ? "conforms" : "does not conform", r->reason[0] != '\0' ? ": " : "",
           r->reason);
    if (r->options->json != NULL)
        conf_run_write_json(r);
    if (r->options->junit != NULL)
        conf_run_write_junit(r);
    if (r->options->html != NULL)
        conf_run_write_html(r);
}

int conf_run(const conf_run_options *o)
{
    conf_run_result r = { .options = o };
    runner w = { .r = &r };
    char vectors[CONF_PATH];

    try_reports(o);
    conf_path(vectors, "%s/vectors", o->suite);
    r.entry = conf_suite_load(vectors, o->list, &r.n);
    hold_to_manifest(&r);
    r.verdict = conf_alloc(r.n, sizeof *r.verdict);
    r.ms = conf_alloc(r.n, sizeof *r.ms);
    for (int i = RUN_FIRST; i <= RUN_LENIENT; i++)
        w.options[i] = (conf_process_options) { o->decoder, i == RUN_SECOND ? o->second : NULL,
                                                o->timeout, o->memory };
    conf_scratch_make(w.folder);
    r.capabilities = ask_capabilities(&w);
    if (r.capabilities != NULL)
        run_all(&w);
    for (size_t i = 0; r.capabilities == NULL && i < r.n; i++)
        r.verdict[i] = (conf_verdict) { CONF_NO_ANSWER, "no capabilities" };
    conf_scratch_remove();
    sum_up(&r);
    write_reports(&r);
    json_decref(r.capabilities);
    conf_suite_free(r.entry, r.n);
    if (w.recipes.n > 0)
        conf_recipes_free(&w.recipes);
    free(r.verdict);
    free(r.ms);
    return !r.passed;
}
