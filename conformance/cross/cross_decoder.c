/* cross_decoder.c - our decoder for the matrix of builds (conformance/CROSS.md): one program that
 * needs C's library, zlib, Jansson and xxHash alone.
 *     cross_decoder --ted4-...     the driver contract of conformance/README.md, as ted4dec answers
 *                                  it
 *     cross_decoder SUITE          judges every vector of SUITE/SUITE.json, in one process, as
 *                                  ted4conf would; files made on demand have to be there, but for
 *                                  large ones.
 * Prints the class claimed, a line a failure, the counts, and two hashes (XXH3-128): tier-e of all
 * verdicts and of T0 to T4, and, where class X is claimed, class-x of all T5. Two builds agree when
 * these are equal. On stderr: each vector before it is judged, so that a crash has a name. Exit
 * code: 0 all pass, 1 not, 3 no such suite.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "answer.h"
#include "judge.h"
#include "ted4.h"
#include "tool/contract.h"

typedef struct {
    const char *suite;
    json_t *capabilities;       /* owned */
    conf_bytes tier_e, class_x; /* owned: one line a vector, its answer as JSON */
    size_t n_run, n_bad;
} session;

static const char *text_of(const json_t *o, const char *key)
{
    const char *const s = json_string_value(json_object_get(o, key));

    return s != NULL ? s : "";
}

/* The vector's file as the manifest knows it: 1, or 0: missing, or another one. */
static int read_vector(const session *s, const json_t *entry, conf_bytes *file)
{
    char path[CONF_PATH], hash[CONF_HASH + 1];

    conf_path(path, "%s/vectors/%s/%s.ted4", s->suite, text_of(entry, "folder"),
              text_of(entry, "id"));
    if (!conf_read(path, file))
        return 0;
    conf_hash(hash, file->data, file->size);
    return strcmp(hash, text_of(entry, "sha256")) == 0;
}

/* Its descriptor, owned; NULL: missing, or another one. */
static json_t *read_descriptor(const session *s, const json_t *entry)
{
    char path[CONF_PATH], hash[CONF_HASH + 1];
    conf_bytes text;
    json_t *d = NULL;

    conf_path(path, "%s/vectors/%s/%s.json", s->suite, text_of(entry, "folder"),
              text_of(entry, "id"));
    if (!conf_read(path, &text))
        return NULL;
    conf_hash(hash, text.data, text.size);
    hash[CONF_SHORT_HASH] = '\0';
    if (strcmp(hash, text_of(entry, "json")) == 0)
        d = json_loadb((const char *)text.data, text.size, 0, NULL);
    conf_free(&text);
    return d;
}

static void add_line(conf_bytes *b, const char *id, const json_t *o)
{
    char *const text = json_dumps(o, JSON_COMPACT | JSON_SORT_KEYS | JSON_ENCODE_ANY);

    conf_print(b, "%s %s\n", id, text != NULL ? text : "-");
    free(text);
}

/* Takes tiers apart: T5 belongs to class X, everything else to Tier E. */
static void keep_records(session *s, const char *id, json_t *tiers)
{
    if (tiers == NULL)
        return;
    add_line(&s->class_x, id, json_object_get(tiers, "T5"));
    json_object_del(tiers, "T5");
}

static void ask(session *s, const char *id, const json_t *d, const conf_bytes *file,
                conf_verdict *v)
{
    const int lenient = json_object_get(d, "salvage") != NULL;
    json_t *const answer = (lenient ? conf_answer_lenient : conf_answer)(
        file, json_object_get(d, "queries"), conf_knobs_of(d));

    conf_judge(s->capabilities, d, answer, v);
    if (lenient && v->outcome == CONF_PASS)
        conf_judge_salvage(s->capabilities, d, answer, v);
    keep_records(s, id, json_object_get(answer, "tiers"));
    keep_records(s, id, json_object_get(json_object_get(answer, "salvage"), "tiers"));
    add_line(&s->tier_e, id, answer);
    json_decref(answer);
}

static void judge(session *s, const json_t *entry)
{
    const char *const id = text_of(entry, "id");
    conf_bytes file = { NULL, 0, 0 };
    conf_verdict v = { CONF_MISSING, "no such file, or another one than in the manifest" };
    json_t *d;

    fprintf(stderr, "at %s\n", id);
    fflush(stderr);
    d = read_descriptor(s, entry);
    if (d != NULL && read_vector(s, entry, &file))
        ask(s, id, d, &file, &v);
    s->n_run++;
    if (v.outcome != CONF_PASS) {
        s->n_bad++;
        printf("fail %s: %s: %s\n", id, conf_outcome_name[v.outcome], v.reason);
    }
    conf_free(&file);
    json_decref(d);
}

static void print_hash(const char *name, const conf_bytes *b)
{
    XXH128_canonical_t canonical;
    char hex[33];

    XXH128_canonicalFromHash(&canonical, XXH3_128bits(b->data, b->size));
    conf_hex(hex, canonical.digest, sizeof canonical.digest);
    printf("%s %s\n", name, hex);
}

static int judge_all(const char *suite)
{
    const int strict = ted4_recon_class_x();
    session s = { .suite = suite };
    char path[CONF_PATH];
    json_t *manifest, *list;

    s.capabilities = json_pack("{s:i, s:[s,s,s,s,s,s], s:o, s:[], s:[s,s]}", "max_level", 31,
                               "tiers", "T0", "T1", "T2", "T3", "T4", "T5", "class",
                               strict ? json_string("X") : json_null(), "declines", "knobs",
                               "max_alloc_total", "max_work");
    conf_path(path, "%s/SUITE.json", suite);
    manifest = json_load_file(path, 0, NULL);
    list = json_object_get(manifest, "vector");
    if (json_array_size(list) == 0)
        conf_die("%s: no manifest", path);
    printf("class %s\n", strict ? "X" : "none");
    for (size_t i = 0; i < json_array_size(list); i++)
        if (!json_is_string(json_object_get(json_array_get(list, i), "demand")))
            judge(&s, json_array_get(list, i));
    printf("vectors %zu passed %zu failed %zu\n", s.n_run, s.n_run - s.n_bad, s.n_bad);
    print_hash("tier-e", &s.tier_e);
    if (strict)
        print_hash("class-x", &s.class_x);
    conf_free(&s.tier_e);
    conf_free(&s.class_x);
    json_decref(s.capabilities);
    json_decref(manifest);
    return s.n_bad > 0;
}

int main(int argc, char **argv)
{
    if (ted4_contract_asked(argc, argv))
        return ted4_contract(argc, argv);
    if (argc == 2)
        return judge_all(argv[1]);
    fputs("usage: cross_decoder SUITE | --ted4-capabilities | --ted4-run FILE ...\n", stderr);
    return 3;
}
