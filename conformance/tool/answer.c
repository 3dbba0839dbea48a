/* answer.c - see answer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "answer.h"

#include <string.h>
#include "tool/tier_hash.h"

static json_t *records(const ted4_scene *s, const json_t *queries)
{
    json_t     *answer = json_array();
    ted4_recon *recon = NULL;

    if (json_array_size(queries) > 0 && ted4_recon_new(&recon, s, NULL) != TED4_OK)
        conf_die("no memory");
    for (size_t i = 0; i < json_array_size(queries); i++) {
        const json_t *const q = json_array_get(queries, i);
        ted4_query          query;
        ted4_gaussians      g;
        ted4_status         verdict;

        query.num = (uint32_t)json_integer_value(json_array_get(json_object_get(q, "t"), 0));
        query.den = (uint32_t)json_integer_value(json_array_get(json_object_get(q, "t"), 1));
        for (size_t j = 0; j < 3; j++)
            query.camera[j] = (float)json_number_value(json_array_get(json_object_get(q, "cam"), j));
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

static json_t *tiers(const conf_bytes *file, const ted4_scene *s, const json_t *queries)
{
    json_t    *o = json_object();
    ted4_error e;

    for (int t = 0; t < 5; t++) {
        ted4_tier_hash *const h = ted4_tier_hash_new(NULL);
        const char            name[3] = { 'T', (char)('0' + t), '\0' };

        if (h == NULL || (t == 0 ? ted4_dump_syntax(file->data, file->size, NULL, ted4_tier_hash_add, h, &e)
                                 : ted4_dump_tier(s, t, NULL, ted4_tier_hash_add, h)) != TED4_OK)
            conf_die("no memory");
        json_object_set_new(o, name, ted4_tier_hash_end(h));
    }
    json_object_set_new(o, "T5", records(s, queries));
    return o;
}

json_t *conf_answer(const conf_bytes *file, const json_t *queries, uint64_t max_bytes)
{
    static const char *const name[] = { "valid", "invalid", "limit", "unsupported", "io" };
    ted4_options o;
    ted4_error   e = { TED4_OK, 0 };
    ted4_scene  *s;
    ted4_verdict verdict;
    json_t      *answer;

    memset(&o, 0, sizeof o);
    o.max_bytes = max_bytes;
    (void)ted4_decode(file->data, file->size, &o, &s, &e);
    verdict = ted4_status_verdict(e.code);
    answer = json_pack("{s:s}", "result", name[verdict]);
    if (e.code == TED4_OK)
        json_object_set_new(answer, "tiers", tiers(file, s, queries));
    else
        json_object_set_new(answer, "error", json_string(ted4_status_id(e.code)));
    if (verdict == TED4_INVALID || verdict == TED4_UNSUPPORTED)
        json_object_set_new(answer, "offset", json_integer((json_int_t)e.offset));
    ted4_scene_free(s);
    return answer;
}
