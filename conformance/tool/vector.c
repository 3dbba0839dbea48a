/* vector.c - see vector.h. Offsets that a recipe expects are computed from the file's own layout,
 * never taken from the decoder.
 *     category CATEGORY/AREA               folder of the vector
 *     intent TEXT; rules R-...; bug TYPE EFFECT; knob NAME VALUE
 *     query NUM/DEN X Y Z                  repeated; a valid vector without a query gets three
 *     demand [large]                       only the descriptor is stored
 *     kept                                 the file is stored, not made: it is the result of a
 *                                          training, which not every machine can reproduce
 *     expect valid | invalid ID at WHERE | unsupported ID at WHERE | limit ID
 *     also limit                           a decoder may report a limit before that error
 *     expect-query I ID                    query I has no result
 *     salvage TILES [ID at PLACE]          the result of a lenient decoder: the first tiles, and
 *                                          the first error in the order of the file, if it is not
 *                                          the expected one. Every vector of the category tolerant
 *                                          has this line
 * SPDX-License-Identifier: BSD-2-Clause */
#include "vector.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "answer.h"
#include "features.h"
#include "salvage.h"
#include "stream.h"
#include "tool/sha256.h"

/* Returns 1 if a decoder returns records for the vector. */
static int has_records(const conf_recipe *r)
{
    const conf_line *const expect = conf_line_find(r, "expect"), *const saved =
                                                                     conf_line_find(r, "salvage");

    return expect == NULL || conf_word_is(expect, 1, "valid") ||
           (saved != NULL && !conf_word_is(saved, 1, "0"));
}

static json_t *queries_of(const conf_recipe *r)
{
    json_t *o = json_array();

    for (size_t i = 0; i < r->n; i++) {
        const conf_line *const l = &r->line[i];
        unsigned long long num, den;
        float c[3];

        if (!conf_word_is(l, 0, "query"))
            continue;
        if (l->n != 5 || sscanf(l->word[1], "%llu/%llu", &num, &den) != 2)
            conf_line_bad(l, "query NUM/DEN X Y Z");
        for (int j = 0; j < 3; j++)
            c[j] = conf_word_float(l, 2 + j);
        json_array_append_new(o, json_pack("{s:[I,I], s:[f,f,f]}", "t", (json_int_t)num,
                                           (json_int_t)den, "cam", (double)c[0], (double)c[1],
                                           (double)c[2]));
    }
    if (json_array_size(o) == 0 && has_records(r)) {
        json_array_append_new(o,
                              json_pack("{s:[i,i], s:[f,f,f]}", "t", 0, 1, "cam", 0.0, 0.0, 0.0));
        json_array_append_new(o, json_pack("{s:[i,i], s:[f,f,f]}", "t", 1, 2, "cam", 0.5, -0.25,
                                           -2.0));
        json_array_append_new(o, json_pack("{s:[i,i], s:[f,f,f]}", "t", 1, 1, "cam", -3.0, 1.0,
                                           0.125));
    }
    return o;
}

static json_t *rules_of(const conf_recipe *r)
{
    json_t *o = json_array();

    for (size_t i = 0; i < r->n; i++)
        for (int j = 1; conf_word_is(&r->line[i], 0, "rules") && j < r->line[i].n; j++)
            json_array_append_new(o, json_string(r->line[i].word[j]));
    return o;
}

/* Returns the "knobs" of the descriptor, or NULL. */
static json_t *knob_of(const conf_recipe *r)
{
    const conf_line *const l = conf_line_find(r, "knob");

    if (l == NULL)
        return NULL;
    if (!conf_word_is(l, 1, "max_alloc_total") && !conf_word_is(l, 1, "max_work"))
        conf_line_bad(l, "no such knob");
    return json_pack("{s:I}", l->word[1], (json_int_t)conf_line_number(l, 2, 1, 1LL << 40));
}

static json_t *hashes(const conf_bytes *file, json_t *descriptor)
{
    XXH128_canonical_t canonical;
    uint8_t sha[TED4_SHA256_SIZE];
    ted4_sha256 h;
    char text[2 * TED4_SHA256_SIZE + 1];

    ted4_sha256_init(&h);
    ted4_sha256_add(&h, file->data, file->size);
    ted4_sha256_end(&h, sha);
    conf_hex(text, sha, sizeof sha);
    json_object_set_new(descriptor, "sha256", json_string(text));
    XXH128_canonicalFromHash(&canonical, XXH3_128bits(file->data, file->size));
    conf_hex(text, canonical.digest, sizeof canonical.digest);
    json_object_set_new(descriptor, "xxh3", json_string(text));
    return descriptor;
}

static json_t *expected(const conf_recipe *r, const conf_stream *s)
{
    const conf_line *const l = conf_line_find(r, "expect");
    json_t *o;

    if (l == NULL || conf_word_is(l, 1, "valid"))
        return json_pack("{s:s}", "result", "valid");
    if (l->n < 3)
        conf_line_bad(l, "an identifier is missing");
    o = json_pack("{s:s, s:s}", "result", l->word[1], "error", l->word[2]);
    if (conf_line_find(r, "also") != NULL)
        json_object_set_new(o, "also_ok", json_pack("[s]", conf_line_find(r, "also")->word[1]));
    if (!conf_word_is(l, 1, "limit")) {
        if (!conf_word_is(l, 3, "at"))
            conf_line_bad(l, "the place is missing");
        json_object_set_new(o, "offset", json_integer((json_int_t)conf_stream_where(s, l, 4)));
    }
    return o;
}

/* Checks that the answers to queries fail where the recipe expects it, and nowhere else. */
static int queries_agree(const conf_recipe *r, const json_t *tiers)
{
    const json_t *const t5 = json_object_get(tiers, "T5");
    const char *want[64] = { NULL };

    for (size_t i = 0; i < r->n; i++)
        if (conf_word_is(&r->line[i], 0, "expect-query"))
            want[conf_line_number(&r->line[i], 1, 0, 63)] = r->line[i].word[2];
    for (size_t i = 0; i < json_array_size(t5) && i < 64; i++) {
        const char *const got = json_string_value(json_object_get(json_array_get(t5, i), "error"));

        if ((got == NULL) != (want[i] == NULL) || (got != NULL && strcmp(got, want[i]) != 0))
            return 0;
    }
    return 1;
}

/* Checks the answer without its tiers, and what is salvaged, against the expectation. */
static int agrees(const conf_recipe *r, json_t *answer, json_t *descriptor)
{
    const json_t *const expect = json_object_get(descriptor, "expect"), *const saved =
                                                                            json_object_get(
                                                                                descriptor,
                                                                                "salvage");
    json_t *tiers = json_incref(json_object_get(answer, "tiers")), *strict = json_deep_copy(expect);
    int good;

    json_object_del(answer, "tiers");
    json_object_del(strict, "also_ok");
    if (json_is_object(saved))
        json_object_set(strict, "salvage", json_object_get(descriptor, "salvage"));
    good = json_equal(strict, answer) && queries_agree(r, tiers);
    if (!good) {
        char *const want = json_dumps(strict, JSON_COMPACT), *const got =
                                                                 json_dumps(answer, JSON_COMPACT);
        char *const t5 = json_dumps(json_object_get(tiers, "T5"), JSON_COMPACT);

        fprintf(stderr, "ted4conf: %s: %s: expected %s, decoder says %s %s\n", r->file, r->id, want,
                got, t5 != NULL && strstr(t5, "error") ? t5 : "");
        free(want);
        free(got);
        free(t5);
    }
    json_decref(strict);
    if (tiers != NULL)
        json_object_set_new(descriptor, "tiers", tiers);
    return good;
}

static void read_kept(conf_build *b, const conf_recipe *r, const char *suite, conf_bytes *file)
{
    char path[CONF_PATH];
    ted4_error e;

    conf_path(path, "%s/vectors/%s/%s.ted4", suite, conf_line_find(r, "category")->word[1], r->id);
    if (!conf_read(path, file))
        conf_die("%s: cannot be read", path);
    memset(b, 0, sizeof *b);
    if (ted4_decode(file->data, file->size, NULL, &b->scene, &e) != TED4_OK)
        conf_die("%s: %s", path, ted4_status_id(e.code));
    b->head = b->scene->head;
}

/* Makes the file, and the stream in its final state. valid: filled with the file before it was
 * broken; the caller frees it. */
static void make_file(conf_vector *v, conf_build *b, conf_stream *s, const conf_recipe *r,
                      const char *suite, conf_bytes *valid)
{
    if (conf_line_find(r, "kept") != NULL)
        read_kept(b, r, suite, valid);
    else
        conf_build_file(b, r, valid);
    conf_stream_open(s, valid, b);
    for (size_t i = 0; i < r->n; i++)
        if (conf_word_is(&r->line[i], 0, "do"))
            conf_stream_do(s, b, &r->line[i]);
    conf_stream_join(s, &v->file);
}

static void check_words(const conf_recipe *r)
{
    static const char *const name[] = { "also",   "category", "intent", "rules",        "bug",
                                        "query",  "knob",     "expect", "expect-query", "do",
                                        "demand", "kept",     "salvage" };

    for (size_t i = 0; i < r->n; i++) {
        int known = conf_is_scene_line(&r->line[i]);

        for (size_t j = 0; j < sizeof name / sizeof *name; j++)
            known |= conf_word_is(&r->line[i], 0, name[j]);
        if (!known)
            conf_line_bad(&r->line[i], "unknown word");
    }
    if (conf_line_find(r, "intent") == NULL || conf_line_find(r, "category") == NULL ||
        conf_line_find(r, "rules") == NULL)
        conf_die("%s: %s: category, intent or rules are missing", r->file, r->id);
    if (conf_word_is(conf_line_find(r, "category"), 1, "tolerant") !=
        (conf_line_find(r, "salvage") != NULL))
        conf_die("%s: %s: salvage belongs to the category tolerant", r->file, r->id);
}

/* Returns 1 if every decoder has to refuse the file, whatever parts of the format the decoder
 * supports. */
static int refused(const conf_recipe *r)
{
    const conf_line *const l = conf_line_find(r, "expect");

    return l != NULL && !conf_word_is(l, 1, "valid") && !conf_word_is(l, 1, "limit");
}

int conf_vector_make(conf_vector *v, const conf_recipe *r, const char *suite)
{
    const conf_line *const bug = conf_line_find(r, "bug"),
                           *const saved = conf_line_find(r, "salvage"),
                           *const demand = conf_line_find(r, "demand");
    json_t *const knobs = knob_of(r);
    conf_bytes valid;
    conf_stream s;
    conf_build b;
    json_t *d, *answer;
    char name[128];
    int good;

    memset(v, 0, sizeof *v);
    check_words(r);
    make_file(v, &b, &s, r, suite, &valid);
    snprintf(v->folder, sizeof v->folder, "%s", conf_line_find(r, "category")->word[1]);
    snprintf(name, sizeof name, "%s.ted4", r->id);
    d = v->descriptor = json_pack("{s:s, s:i, s:s, s:s, s:I, s:s, s:s, s:i}", "id", r->id, "schema",
                                  1, "category", v->folder, "file", name, "bytes",
                                  (json_int_t)v->file.size, "status", "active", "profile",
                                  v->file.size > 10 && v->file.data[10] == 1 ? "Compact" : "Main",
                                  "level", v->file.size > 11 ? v->file.data[11] : 0);
    hashes(&v->file, d);
    json_object_set_new(d, "features", refused(r) ? json_array() : conf_features(b.scene));
    json_object_set_new(d, "rules", rules_of(r));
    json_object_set_new(d, "intent", json_string(conf_line_find(r, "intent")->rest));
    if (bug != NULL)
        json_object_set_new(d, "bug",
                            json_pack("{s:s, s:s}", "type", bug->word[1], "effect",
                                      bug->n > 2 ? bug->word[2] : ""));
    json_object_set_new(d, "queries", queries_of(r));
    if (knobs != NULL)
        json_object_set_new(d, "knobs", knobs);
    json_object_set_new(d, "expect", expected(r, &s));
    if (saved != NULL)
        json_object_set_new(d, "salvage",
                            conf_salvage(saved, &valid, &s, json_object_get(d, "expect"),
                                         json_object_get(d, "queries")));
    if (demand != NULL)
        json_object_set_new(d, "demand",
                            conf_word_is(demand, 1, "large") ? json_string("large") : json_true());
    json_object_set_new(d, "origin", json_pack("{s:s}", "recipe", r->file));
    json_object_set_new(d, "license", json_string("CC0-1.0"));
    answer = (saved != NULL ? conf_answer_lenient : conf_answer)(
        &v->file, json_object_get(d, "queries"), conf_knobs_of(d));
    good = agrees(r, answer, d);
    json_decref(answer);
    conf_free(&valid);
    conf_stream_close(&s);
    conf_build_end(&b);
    return good;
}

void conf_vector_free(conf_vector *v)
{
    conf_free(&v->file);
    json_decref(v->descriptor);
}
