/* finding.c - reports an error or something doubtful, with its place, the rule that it breaks and a
 * text.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/finding.h"

#include <string.h>
#include "base/bytes.h"
#include "norm/coder.h"
#include "norm/limits.h"
#include "norm/prior.h"
#include "norm/syntax.h"
#include "read/reader.h"

/* Most errors break one rule. Where an error has several, which_rule() returns the index of the
 * one that is broken. */
static const char *const rules_of[TED4_N_STATUS][3] = {
#define TED4_FINDING_ERROR(status, ...) [TED4_##status] = { __VA_ARGS__ },
#define TED4_FINDING_ADVICE(name, id, severity, rule, text)
#include "read/findings.def"
#undef TED4_FINDING_ERROR
#undef TED4_FINDING_ADVICE
};

static const struct {
    const char *id, *rule, *text;
    ted4_severity severity;
} advice[TED4_N_ADVICE] = {
#define TED4_FINDING_ERROR(status, ...)
#define TED4_FINDING_ADVICE(name, id, severity, rule, text) { id, rule, text, TED4_##severity },
#include "read/findings.def"
#undef TED4_FINDING_ERROR
#undef TED4_FINDING_ADVICE
};

/* Returns the name of a known chunk type, or NULL. */
static const char *known_type(const uint8_t *type)
{
    for (int i = 0; i < TED4_CHUNKS; i++)
        if (memcmp(type, ted4_chunk_type[i], 4) == 0)
            return ted4_chunk_type[i];
    return NULL;
}

/* Returns the type of the chunk that holds the byte at offset, or NULL if it is not a known type.
 * Chunk sizes in the file may be wrong. Since errors are found nearly in the order of the file, the
 * search begins at the chunk where the last one ended. */
static const char *chunk_at(ted4_findings *f, size_t offset)
{
    const size_t frame = TED4_FRAME_HEAD_SIZE + TED4_FRAME_HASH_SIZE;
    size_t at = f->chunk > 0 && f->chunk <= offset ? f->chunk : TED4_FILE_HEADER_SIZE;

    while (f->size - at >= TED4_FRAME_HEAD_SIZE) {
        const uint32_t size = ted4_load32(f->data + at + 8);

        f->chunk = at;
        if (f->size - at < frame || f->size - at - frame < size || offset - at < frame + size)
            return known_type(f->data + at);
        at += frame + size;
    }
    return NULL;
}

/* Returns the index of the rule that con.payload-size breaks in the chunk that chunk_at() has
 * found, of the given type: R-NET-009 for the values of a raw blob; R-ENT-003 for the sizes of
 * substreams, if all of these are present; otherwise R-CON-011. If a chunk after HEAD has this
 * error, HEAD is valid. */
static unsigned payload_rule(const ted4_findings *f, size_t offset, const char *type)
{
    enum { ELEMENTS, SIZES, VALUES };
    const size_t payload = f->chunk + TED4_FRAME_HEAD_SIZE, at = offset - payload,
                 left = ted4_load32(f->data + f->chunk + 8) - at;
    ted4_header h;
    ted4_shape shape;
    ted4_reader r;

    if (type != ted4_chunk_type[TED4_NETE] && type != ted4_chunk_type[TED4_NETR] &&
        type != ted4_chunk_type[TED4_BANK] && type != ted4_chunk_type[TED4_TILE])
        return ELEMENTS;
    memset(&h, 0, sizeof h);
    memset(&shape, 0, sizeof shape);
    ted4_reader_init(&r, f->data, TED4_FILE_HEADER_SIZE + TED4_FRAME_HEAD_SIZE, f->size, 1);
    ted4_walk_header(&r.base, &h, &shape, TED4_LEVEL_UNBOUNDED, UINT64_MAX);
    if (type == ted4_chunk_type[TED4_TILE])
        return at == 4u + 2u * h.temporal_mask + 12u * h.offset_mask &&
                       left >= 4 * shape.n_substreams
                   ? SIZES
                   : ELEMENTS;
    return at > (type == ted4_chunk_type[TED4_NETE] ? shape.n_units : 0) ? VALUES : ELEMENTS;
}

/* Returns the index, in rules_of, of the rule that error e breaks in a chunk of the given type
 * (NULL: not in a chunk of a known type). */
static unsigned which_rule(const ted4_findings *f, ted4_error e, const char *type)
{
    switch (e.code) {
    case TED4_E_CON_RESERVED: /* known chunks: only flags can be wrong */ return type != NULL;
    case TED4_E_CON_PAYLOAD_SIZE: return payload_rule(f, e.offset, type);
    case TED4_E_NET_SHIFT: /* 1: a shift in the legal range that is not valid for the unit */
        return f->data[e.offset] <= TED4_MAX_SHIFT;
    default: return 0;
    }
}

void ted4_give_error(ted4_findings *f, ted4_error e)
{
    ted4_finding x;

    memset(&x, 0, sizeof x);
    x.severity = TED4_ERROR;
    x.id = ted4_status_id(e.code);
    x.text = ted4_status_text(e.code);
    x.where = e.offset >= TED4_FILE_HEADER_SIZE && e.offset < f->size ? chunk_at(f, e.offset)
                                                                      : NULL;
    x.rule = rules_of[e.code][which_rule(f, e, x.where)];
    x.offset = e.offset;
    f->sink(f->user, &x);
}

void ted4_find_error(ted4_findings *f, ted4_error e)
{
    if (e.code == TED4_E_LIMIT_MEMORY)
        f->starved = 1;
    else if (e.code == f->verdict.code && e.offset == f->verdict.offset)
        f->found = 1;
    else
        ted4_give_error(f, e);
}

void ted4_find_advice(ted4_findings *f, ted4_advice what, const char *where, size_t offset,
                      unsigned n_values, int64_t a, int64_t b)
{
    ted4_finding x;

    memset(&x, 0, sizeof x);
    x.severity = advice[what].severity;
    x.id = advice[what].id;
    x.rule = advice[what].rule;
    x.text = advice[what].text;
    x.where = where;
    x.offset = offset;
    x.n_values = n_values;
    x.value[0] = a;
    x.value[1] = b;
    f->sink(f->user, &x);
}
