/* answer.c - see answer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "answer.h"

#include <string.h>
#include "tool/tier_hash.h"

static json_t *records(const ted4_scene *s, const json_t *queries)
{
    json_t *answer = json_array();
    ted4_recon *recon = NULL;

    if (json_array_size(queries) > 0 && ted4_recon_new(&recon, s, NULL) != TED4_OK)
        conf_die("no memory");
    for (size_t i = 0; i < json_array_size(queries); i++) {
        const json_t *const q = json_array_get(queries, i);
        ted4_query query;
        ted4_gaussians g;
        ted4_status verdict;

        query.num = (uint32_t)json_integer_value(json_array_get(json_object_get(q, "t"), 0));
        query.den = (uint32_t)json_integer_value(json_array_get(json_object_get(q, "t"), 1));
        for (size_t j = 0; j < 3; j++)
            query.camera[j] =
                (float)json_number_value(json_array_get(json_object_get(q, "cam"), j));
        verdict = ted4_recon_query(recon, &query, NULL, &g);
        if (verdict != TED4_OK) {
            json_array_append_new(answer, json_pack("{s:s}", "error", ted4_status_id(verdict)));
            continue;
        }

        ted4_tier_hash *const h = ted4_tier_hash_new(NULL);

        if (h == NULL)
            conf_die("no memory");
        ted4_tier_records(&g, ted4_tier_hash_add, h);
        json_array_append_new(answer, ted4_tier_hash_end(h));
    }
    ted4_recon_free(recon);
    return answer;
}

json_t *conf_tiers(const conf_bytes *file, const ted4_scene *s, const json_t *queries)
{
    json_t *o = json_object();
    ted4_error e;

    for (int t = file == NULL; t < 5; t++) {
        ted4_tier_hash *const h = ted4_tier_hash_new(NULL);
        const char name[3] = { 'T', (char)('0' + t), '\0' };

        if (h == NULL ||
            (t == 0 ? ted4_dump_syntax(file->data, file->size, NULL, ted4_tier_hash_add, h, &e)
                    : ted4_dump_tier(s, t, NULL, ted4_tier_hash_add, h)) != TED4_OK)
            conf_die("no memory");
        json_object_set_new(o, name, ted4_tier_hash_end(h));
    }
    json_object_set_new(o, "T5", records(s, queries));
    return o;
}

json_t *conf_salvaged(const ted4_scene *s, const ted4_salvage *what, const json_t *queries)
{
    ted4_info info;
    char hash[2 * sizeof info.hash + 1];

    ted4_scene_info(s, &info);
    conf_hex(hash, info.hash, sizeof info.hash);
    return json_pack("{s:I, s:I, s:I, s:I, s:s, s:I, s:s, s:o}", "tiles", (json_int_t)what->n_tiles,
                     "tiles_declared", (json_int_t)what->tiles_declared, "anchors",
                     (json_int_t)info.n_anchors, "anchors_declared",
                     (json_int_t)what->anchors_declared, "error", ted4_status_id(what->stop.code),
                     "offset", (json_int_t)what->stop.offset, "hash", hash, "tiers",
                     conf_tiers(NULL, s, queries));
}

/* s: the decoded part of the file, or NULL if nothing was decoded. Frees s. */
static json_t *answer_of(const conf_bytes *file, ted4_scene *s, const ted4_salvage *what,
                         const json_t *queries)
{
    const ted4_verdict verdict = ted4_status_verdict(what->verdict.code);
    json_t *const answer = json_pack("{s:s}", "result", ted4_verdict_name(verdict));

    if (what->verdict.code == TED4_OK)
        json_object_set_new(answer, "tiers", conf_tiers(file, s, queries));
    else
        json_object_set_new(answer, "error", json_string(ted4_status_id(what->verdict.code)));
    if (verdict == TED4_INVALID || verdict == TED4_UNSUPPORTED)
        json_object_set_new(answer, "offset", json_integer((json_int_t)what->verdict.offset));
    if (what->verdict.code != TED4_OK && s != NULL)
        json_object_set_new(answer, "salvage", conf_salvaged(s, what, queries));
    ted4_scene_free(s);
    return answer;
}

conf_knobs conf_knobs_of(const json_t *descriptor)
{
    const json_t *const knobs = json_object_get(descriptor, "knobs");

    return (conf_knobs) { (uint64_t)json_integer_value(json_object_get(knobs, "max_alloc_total")),
                          (uint64_t)json_integer_value(json_object_get(knobs, "max_work")) };
}

json_t *conf_answer(const conf_bytes *file, const json_t *queries, conf_knobs knobs)
{
    const ted4_options o = { .max_bytes = knobs.memory, .max_work = knobs.work };
    ted4_salvage what = { .verdict = { TED4_OK, 0 } };
    ted4_scene *s;

    (void)ted4_decode(file->data, file->size, &o, &s, &what.verdict);
    return answer_of(file, s, &what, queries);
}

json_t *conf_answer_lenient(const conf_bytes *file, const json_t *queries, conf_knobs knobs)
{
    const ted4_options o = { .max_bytes = knobs.memory, .max_work = knobs.work };
    ted4_salvage what;
    ted4_scene *s;

    (void)ted4_decode_lenient(file->data, file->size, &o, &s, &what);
    return answer_of(file, s, &what, queries);
}
