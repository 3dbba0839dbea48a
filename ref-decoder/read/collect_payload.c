/* collect_payload.c - finds all errors of one payload that can be told apart.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/collect_payload.h"

#include <string.h>
#include "base/bytes.h"
#include "norm/limits.h"

/* An upper bound of the size of the elements of HEAD. */
enum { HEAD_BYTES = 128 };

ted4_error ted4_collect_error(ted4_collector *c)
{
    const ted4_error e = c->d.file.base.error;

    if (e.code != TED4_OK) {
        if (e.code != TED4_E_CON_CHUNK_ORDER || !c->disordered)
            ted4_find_error(c->f, e);
        c->d.file.base.error.code = TED4_OK;
        c->wrong = 1;
    }
    return e;
}

/* Returns 1 if the search may go on after n listed errors of a chunk; otherwise returns 0 and
 * reports that further errors are not listed. */
static int may_go_on(ted4_collector *c, const ted4_chunk_place *p, int n)
{
    if (n < TED4_COLLECT_MOST)
        return 1;
    ted4_find_advice(c->f, TED4_ADV_MORE, ted4_chunk_type[p->type], p->at, 0, 0, 0);
    return 0;
}

/* Returns the verdict on a payload that r has walked; bytes left over are an error. */
static ted4_error verdict(ted4_reader *r)
{
    ted4_require(&r->base, r->base.pos == r->end, TED4_E_CON_PAYLOAD_SIZE, r->base.pos);
    return r->base.error;
}

static void keep_name(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    const char **name = user;

    (void)offset;
    (void)index;
    (void)value;
    *name = element;
}

/* Walks HEAD and returns the verdict. *last is set to the name of the last element read, or to ""
 * if all elements are present and valid. */
static ted4_error walk_head(ted4_collector *c, const ted4_chunk_place *p, const char **last)
{
    const uint64_t most = ted4_limits_of(c->level)->file_bytes;
    ted4_reader r = ted4_decoder_reader(&c->d, p);
    ted4_header h;
    ted4_shape shape;

    memset(&h, 0, sizeof h);
    *last = "magic";
    r.base.trace = keep_name;
    r.base.trace_user = last;
    ted4_walk_header(&r.base, &h, &shape, c->level,
                     c->d.file_bytes < most ? c->d.file_bytes : most);
    if (r.base.error.code == TED4_OK)
        *last = "";
    return verdict(&r);
}

/* Tries values for the element at offset at until there is no error at that offset. Returns 1, or 0
 * if no such value is found. */
static int repair_head(ted4_collector *c, const ted4_chunk_place *p, size_t at)
{
    static const uint32_t wide[] = { 0, 1, 64, 0x3f800000 };

    for (unsigned width = 1; width <= 4 && width <= p->end - at; width *= 2) {
        const unsigned n = width == 1 ? 256 : sizeof wide / sizeof *wide;
        uint8_t keep[4];

        memcpy(keep, c->copy + at, width);
        for (unsigned i = 0; i < n; i++) {
            const uint32_t value = width == 1 ? i : wide[i];
            ted4_error e;
            const char *last;

            for (unsigned j = 0; j < width; j++)
                c->copy[at + j] = (uint8_t)(value >> 8 * j);
            e = walk_head(c, p, &last);
            if (*last == '\0' || e.offset > at)
                return 1;
        }
        memcpy(c->copy + at, keep, width);
    }
    return 0;
}

/* Lists the errors of HEAD. Then, if its values are valid, HEAD is decoded unrepaired and without
 * the bounds of a level. If max_work is exceeded, no other payload is checked. */
void ted4_collect_head(ted4_collector *c, const ted4_chunk_place *p)
{
    const size_t size = p->end - p->payload, kept = size < HEAD_BYTES ? size : HEAD_BYTES;
    uint8_t keep[HEAD_BYTES];
    const char *last;
    ted4_error e;

    c->head = 1;
    memcpy(keep, c->copy + p->payload, kept);
    for (int more = 1; more;) {
        e = walk_head(c, p, &last);
        c->d.file.base.error = e;
        (void)ted4_collect_error(c);
        c->head &= *last == '\0' || e.code == TED4_E_LVL_EXCEEDED;
        /* The offsets of the elements behind n_slices depend on its value. */
        more = *last != '\0' && e.code != TED4_E_CON_PAYLOAD_SIZE &&
               strcmp(last, "n_slices") != 0 && repair_head(c, p, e.offset);
    }
    memcpy(c->copy + p->payload, keep, kept);
    if (!c->head)
        return;
    c->d.s->level = TED4_LEVEL_UNBOUNDED;
    ted4_decoder_chunk(&c->d, p);
    if (c->d.file.base.error.code == TED4_E_LIMIT_WORK) {
        (void)ted4_collect_error(c);
        c->head = 0;
    }
    c->d.file.base.error.code = TED4_OK;
}

/* Value i of the networks is the bias b of a unit; sets the weights of that unit to 0. */
static void clear_unit(ted4_collector *c, size_t values_at, size_t i)
{
    const ted4_shape *s = &c->d.s->shape;

    for (int m = 0; m < TED4_MAX_SLICES; m++) {
        const ted4_net_shape *n = m == 0 ? &s->hyper : &s->slice[m];
        size_t at = n->first;

        for (unsigned l = 0; l < n->n_layers; l++) {
            const size_t in = n->dim[l], out = n->dim[l + 1], b = at + in * out;

            if (i >= b && i < b + out)
                memset(c->copy + values_at + 4 * (at + (i - b) * in), 0, 4 * in);
            at = b + out;
        }
    }
}

static ted4_error walk_nete(ted4_collector *c, const ted4_chunk_place *p)
{
    ted4_reader r = ted4_decoder_reader(&c->d, p);

    ted4_walk_nete(&r.base, c->d.s, &c->d.prior);
    return verdict(&r);
}

/* Sets the value at which error e was found to 0. Returns 1, or 0 if the blob, whose values begin
 * at values_at, is not raw. */
static int repair_value(ted4_collector *c, size_t values_at, ted4_error e)
{
    if (c->copy[values_at - 1] != TED4_BLOB_RAW)
        return 0;
    ted4_store32(c->copy + e.offset, 0);
    return 1;
}

static int repair_nete(ted4_collector *c, const ted4_chunk_place *p, ted4_error e)
{
    const size_t values_at = p->payload + c->d.s->shape.n_units + 1;

    if (e.code ==
        TED4_E_NET_SHIFT) { /* the lowest valid shift; TED4_MAX_SHIFT is valid for every unit */
        c->copy[e.offset] = 0;
        while (walk_nete(c, p).offset == e.offset)
            c->copy[e.offset]++;
        return 1;
    }
    if (e.code != TED4_E_NET_VALUE && e.code != TED4_E_NET_WEIGHT_RANGE &&
        e.code != TED4_E_NET_ACCUMULATOR)
        return 0;
    if (!repair_value(c, values_at, e))
        return 0;
    if (e.code == TED4_E_NET_ACCUMULATOR)
        clear_unit(c, values_at, (e.offset - values_at) / 4);
    return 1;
}

void ted4_collect_nete(ted4_collector *c, const ted4_chunk_place *p)
{
    ted4_error e;

    ted4_decoder_chunk(&c->d, p);
    e = ted4_collect_error(c);
    c->nete = e.code == TED4_OK;
    for (int n = 1; e.code != TED4_OK && repair_nete(c, p, e) && may_go_on(c, p, n); n++) {
        c->d.file.base.error = walk_nete(c, p);
        e = ted4_collect_error(c);
    }
}

void ted4_collect_blob(ted4_collector *c, const ted4_chunk_place *p, const char *element,
                       ted4_blob *b)
{
    ted4_error e;

    ted4_decoder_chunk(&c->d, p);
    e = ted4_collect_error(c);
    for (int n = 1;
         e.code == TED4_E_NET_VALUE && repair_value(c, p->payload + 1, e) && may_go_on(c, p, n);
         n++) {
        ted4_reader r = ted4_decoder_reader(&c->d, p);

        ted4_walk_blob(&r.base, element, c->d.s, b);
        c->d.file.base.error = verdict(&r);
        e = ted4_collect_error(c);
    }
}

/* Walks the anchors from first on, which follow an anchor with an error, as if there were no
 * others. */
static ted4_error walk_rest(ted4_collector *c, const ted4_chunk_place *p, size_t first)
{
    ted4_reader r = ted4_decoder_reader(&c->d, p);
    ted4_scene part = *c->d.s;

    part.head.n_anchors -= (uint32_t)first;
    part.position += 3 * first;
    r.base.pos += 6 * first;
    ted4_walk_positions(&r.base, &part);
    return verdict(&r);
}

void ted4_collect_positions(ted4_collector *c, const ted4_chunk_place *p)
{
    ted4_error e;

    ted4_decoder_chunk(&c->d, p);
    e = ted4_collect_error(c);
    if (e.code == TED4_E_CON_CHUNK_ORDER) { /* BANK is missing; positions do not depend on it */
        c->d.s->shape.n_bank = 0;
        ted4_decoder_chunk(&c->d, p);
        e = ted4_collect_error(c);
    }
    c->posn = e.code == TED4_OK;
    if (c->d.s->profile != TED4_PROFILE_MAIN) /* one substream: nothing behind an error is known */
        return;
    for (int n = 1; e.code >= TED4_E_POS_VALUE && e.code <= TED4_E_POS_ORDER && may_go_on(c, p, n);
         n++) {
        const size_t anchor = (e.offset - p->payload) / 6;

        c->d.file.base.error = walk_rest(c, p, anchor + (e.code != TED4_E_POS_ORDER));
        e = ted4_collect_error(c);
    }
}

void ted4_collect_tile(ted4_collector *c, const ted4_chunk_place *p)
{
    const unsigned number = c->n_tile_chunks++;
    int guessed = 0; /* 1: an index or probability was repaired, which may cause other errors */
    ted4_error e;

    if (number >= c->d.s->shape.n_tiles) {
        ted4_fail(&c->d.file.base.error, TED4_E_CON_CHUNK_ORDER, p->at);
        (void)ted4_collect_error(c);
        return;
    }
    if (!c->nete || !c->posn)
        return;
    do {
        c->d.n_tiles = number;
        ted4_decoder_chunk(&c->d, p);
        e = c->d.file.base.error;
        if (e.code == TED4_E_ENT_TILE_INDEX)
            ted4_store32(c->copy + e.offset, number);
        else if (e.code == TED4_E_ENT_PROB)
            ted4_store16(c->copy + e.offset, 1);
        else if (guessed)
            c->d.file.base.error.code = TED4_OK;
        guessed = 1;
        (void)ted4_collect_error(c);
    } while (e.code == TED4_E_ENT_TILE_INDEX || e.code == TED4_E_ENT_PROB);
}
