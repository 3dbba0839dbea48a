/* judge_t.c - see judge_t.h. class_t.h computes the thresholds anew for every query whose records
 * differ in any bit from those of class X.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "judge_t.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include "../tolerance/class_t.h"
#include "tool/tier_hash.h"

/* The records of a decoder for one vector. */
typedef struct {
    const conf_bytes *file;
    class_t *stream; /* NULL until the first query that needs it */
    const char *folder;
} records_case;

static const char *text_of(const json_t *o, const char *key)
{
    const char *const s = json_string_value(json_object_get(o, key));

    return s != NULL ? s : "";
}

int conf_class_t_asked(const json_t *capabilities, const json_t *d)
{
    return strcmp(text_of(capabilities, "class"), "T") == 0 && conf_expects(d, "valid") &&
           json_array_size(json_object_get(d, "queries")) > 0;
}

static class_t_query query_of(const json_t *o)
{
    class_t_query q;

    q.num = (uint32_t)json_integer_value(json_array_get(json_object_get(o, "t"), 0));
    q.den = (uint32_t)json_integer_value(json_array_get(json_object_get(o, "t"), 1));
    for (size_t i = 0; i < 3; i++)
        q.camera[i] = (float)json_number_value(json_array_get(json_object_get(o, "cam"), i));
    return q;
}

/* Returns 1 if the dumped records have the hash that the answer gives. */
static int is_that(const conf_bytes *records, const json_t *got)
{
    ted4_tier_hash *const h = ted4_tier_hash_new(NULL);
    json_t *hash;
    int same;

    if (h == NULL)
        conf_die("no memory");
    ted4_tier_hash_add(h, records->data, records->size);
    hash = ted4_tier_hash_end(h);
    same = conf_same_hash(hash, got);
    json_decref(hash);
    return same;
}

/* Returns the problem with the records of a query, or NULL. want: the answer of class X. */
static const char *judge_records(records_case *c, size_t i, const json_t *query, const json_t *want,
                                 const json_t *got)
{
    const class_t_query q = query_of(query);
    struct stat file;
    conf_bytes records;
    char path[CONF_PATH];
    const char *why = "the file that --dump has left is not what the answer says";
    uint64_t offset;

    conf_path(path, "%s/T5-%zu.bin", c->folder, i);
    if (lstat(path, &file) != 0 || !S_ISREG(file.st_mode))
        return "--dump has left no file";
    if (file.st_size != json_integer_value(json_object_get(want, "bytes")) ||
        !conf_read(path, &records))
        return "not as many records as in class X";
    if (is_that(&records, got)) {
        if (c->stream == NULL)
            c->stream = class_t_open(c->file->data, c->file->size, &why, &offset);
        if (c->stream == NULL)
            conf_die("%s: the printed code says %s", path,
                     why != NULL ? why : "that there is no memory");
        why = class_t_judge(c->stream, &q, records.data, records.size);
    }
    conf_free(&records);
    return strcmp(why, "kept") == 0 ? NULL : why;
}

/* Returns the problem with the answer to a query, or NULL. want: the answer of class X. */
static const char *judge_query(records_case *c, size_t i, const json_t *query, const json_t *want,
                               const json_t *got)
{
    const char *const none = text_of(want, "error"), *const error = text_of(got, "error");

    if (strcmp(none, error) == 0 && none[0] != '\0')
        return NULL;
    if (strcmp(none, "rec.non-finite") == 0 && conf_same_hash(got, got))
        return NULL; /* R-TOL-006: these records are not judged */
    if (none[0] != '\0')
        return "should have no result";
    if (error[0] != '\0')
        return "should have a result";
    return conf_same_hash(want, got) ? NULL : judge_records(c, i, query, want, got);
}

void conf_judge_class_t(const conf_bytes *file, const json_t *d, const json_t *answer,
                        const char *folder, conf_verdict *v)
{
    const json_t *const queries = json_object_get(d, "queries"), *const want = json_object_get(
                                                                     json_object_get(d, "tiers"),
                                                                     "T5");
    const json_t *const got = json_object_get(json_object_get(answer, "tiers"), "T5");
    records_case c = { file, NULL, folder };
    const char *why = NULL;

    if (json_array_size(got) != json_array_size(queries)) {
        snprintf(v->reason, sizeof v->reason, "T5: %zu results for %zu queries",
                 json_array_size(got), json_array_size(queries));
        v->outcome = CONF_FAIL;
    }
    for (size_t i = 0; v->outcome == CONF_PASS && i < json_array_size(queries); i++) {
        why = judge_query(&c, i, json_array_get(queries, i), json_array_get(want, i),
                          json_array_get(got, i));
        if (why != NULL) {
            snprintf(v->reason, sizeof v->reason, "T5: query %zu: class T: %s", i, why);
            v->outcome = CONF_FAIL;
        }
    }
    class_t_close(c.stream);
}
