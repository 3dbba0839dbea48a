/* validate.c - spec 3.6: ted4_validate(): the strict decoder's verdict, then what collect.c or advise.c find.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "base/bytes.h"
#include "read/finding.h"

static const char *const rules_of[TED4_N_STATUS] = {
#define TED4_FINDING_ERROR(status, rules) [TED4_##status] = rules,
#define TED4_FINDING_ADVICE(name, id, severity, rules, text)
#include "read/findings.def"
#undef TED4_FINDING_ERROR
#undef TED4_FINDING_ADVICE
};

static const struct {
    const char   *id, *rules, *text;
    ted4_severity severity;
} advice[TED4_N_ADVICE] = {
#define TED4_FINDING_ERROR(status, rules)
#define TED4_FINDING_ADVICE(name, id, severity, rules, text) { id, rules, text, TED4_##severity },
#include "read/findings.def"
#undef TED4_FINDING_ERROR
#undef TED4_FINDING_ADVICE
};

/* The name of a known type, or NULL. */
static const char *known_type(const uint8_t *type)
{
    for (int i = 0; i < TED4_CHUNKS; i++)
        if (memcmp(type, ted4_chunk_type[i], 4) == 0)
            return ted4_chunk_type[i];
    return NULL;
}

/* Type of the known chunk that holds the byte at an offset, or NULL. Sizes are not to be trusted. Errors come nearly in order of the file: the search goes on
 * where the last one has ended. */
static const char *chunk_at(ted4_findings *f, size_t offset)
{
    const size_t frame = TED4_FRAME_HEAD_SIZE + TED4_FRAME_HASH_SIZE;
    size_t       at = f->chunk > 0 && f->chunk <= offset ? f->chunk : TED4_FILE_HEADER_SIZE;

    while (f->size - at >= TED4_FRAME_HEAD_SIZE) {
        const uint32_t size = ted4_load32(f->data + at + 8);

        f->chunk = at;
        if (f->size - at < frame || f->size - at - frame < size || offset - at < frame + size)
            return known_type(f->data + at);
        at += frame + size;
    }
    return NULL;
}

static void give_error(ted4_findings *f, ted4_error e)
{
    ted4_finding x;

    memset(&x, 0, sizeof x);
    x.severity = TED4_ERROR;
    x.id = ted4_status_id(e.code);
    x.rules = rules_of[e.code];
    x.text = ted4_status_text(e.code);
    x.where = e.offset >= TED4_FILE_HEADER_SIZE && e.offset < f->size ? chunk_at(f, e.offset) : NULL;
    x.offset = e.offset;
    f->sink(f->user, &x);
}

void ted4_find_error(ted4_findings *f, ted4_error e)
{
    if (e.code == f->verdict.code && e.offset == f->verdict.offset)
        f->found = 1;
    else
        give_error(f, e);
}

void ted4_find_advice(ted4_findings *f, ted4_advice what, const char *where,
                      size_t offset, unsigned n_values, int64_t a, int64_t b)
{
    ted4_finding x;

    memset(&x, 0, sizeof x);
    x.severity = advice[what].severity;
    x.id = advice[what].id;
    x.rules = advice[what].rules;
    x.text = advice[what].text;
    x.where = where;
    x.offset = offset;
    x.n_values = n_values;
    x.value[0] = a;
    x.value[1] = b;
    f->sink(f->user, &x);
}

ted4_status ted4_validate(const void *data, size_t size, const ted4_options *o,
                          ted4_finding_sink *sink, void *user)
{
    ted4_findings f;
    ted4_options  quiet;
    ted4_scene   *s;
    ted4_status   verdict;

    memset(&quiet, 0, sizeof quiet);
    if (o != NULL)
        quiet = *o;
    quiet.trace = NULL;
    memset(&f, 0, sizeof f);
    f.data = data;
    f.size = size;
    f.sink = sink;
    f.user = user;
    verdict = ted4_decode(data, size, &quiet, &s, &f.verdict);
    if (verdict == TED4_OK)
        verdict = ted4_advise(&f, s, &quiet);
    else
        give_error(&f, f.verdict);
    if (verdict != f.verdict.code)          /* valid, but there was no memory for advice */
        give_error(&f, (ted4_error){ verdict, 0 });
    else if (ted4_status_verdict(verdict) == TED4_INVALID
             && ted4_collect(&f, &quiet) != TED4_OK)
        give_error(&f, (ted4_error){ TED4_E_LIMIT_MEMORY, 0 });
    ted4_scene_free(s);
    return verdict;
}
