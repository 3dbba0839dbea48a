/* breaks.c - `do ...`: applies one change to a file that is split into parts. Sizes and hashes are
 * updated, unless they are the thing to be broken.
 *     do patch ELEMENT VALUE [WIDTH]       sets the bytes of an element. WIDTH: their number; if it
 *                                          is absent, the element ends where the next one begins
 *     do patch-all NAME VALUE              sets every entry of an array
 *     do raise ELEMENT N                   adds N to an element
 *     do flip ELEMENT                      flips the lowest bit of the element's first byte
 *     do insert REF|end TYPE FLAGS N | text ... | hex XX...      inserts a chunk before another;
 *         its payload is N zeros, a text, or bytes
 *     do insert-many REF TYPE N            inserts N ancillary chunks without payload
 *     do drop REF; do repeat REF; do swap REF REF; do retype REF TYPE; do flags REF N; do type-byte
 *     REF I HEX
 *     do size REF N                        sets the size that the frame declares
 *     do hash REF                          flips one bit of the hash
 *     do grow REF N; do shrink REF N       adds or removes bytes at the payload's end
 *     do keep REF N                        keeps the first N bytes of the payload
 *     do payload REF HEX                   replaces the payload
 *     do tail REF HEX                      sets the payload's last bytes
 *     do set-bias NET LAYER UNIT B; do copy-position FROM TO
 *     do cut N | ELEMENT | chunk REF ...   ends the file at that offset; do append HEX
 *     do stream-grow | stream-set TILE SUB HEX; do stream-shrink TILE SUB N; do stream-patch TILE
 *     SUB OFFSET WIDTH VALUE
 *     do final TILE SUB [LANE]             adds 1 to the word that the coder reads last; with LANE,
 *                                          to the initial state of that lane
 *     do value REF INDEX PATTERN           sets a value of the blob in REF, for `do pack` only; the
 *                                          file itself does not change
 *     do pack REF WAY FAULT                packs the blob's values again, with a fault
 *     do blocks REF WORD...                packs them in blocks that the words spell out: blocks.h
 *     do tree GRID X:Y:Z ...; do pack REF coded [N]   see break_coded.h
 *     do pack-zeros REF N                  packs a blob of N bytes of zeros
 *     do inject TILE SUB SYMBOL value K | escape E low|high | ones N      see inject.h
 *     do symbol TYPE COMP ANCHOR K         sets a symbol that contradicts another one
 *
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"
#include "blocks.h"
#include "break_coded.h"
#include "inject.h"
#include "norm/coder.h"
#include "pack.h"
#include "stream.h"

/* Parses the hexadecimal digits from word i on. */
static void hex_bytes(const conf_line *l, int i, conf_bytes *out)
{
    for (; i < l->n; i++)
        for (const char *p = l->word[i]; p[0] != '\0' && p[1] != '\0'; p += 2) {
            const char two[3] = { p[0], p[1], '\0' };
            char *end;
            const uint8_t byte = (uint8_t)strtoul(two, &end, 16);

            if (*end != '\0')
                conf_line_bad(l, "no hexadecimal digits");
            conf_add(out, &byte, 1);
        }
}

static uint8_t *bytes_of(conf_stream *s, const conf_element *e)
{
    return e->chunk < 0 ? s->header + e->at : s->chunk[s->moved[e->chunk]].payload.data + e->at;
}

static unsigned width_of(const conf_line *l, const conf_element *e)
{
    static const char *const four[] = { "n_anchors", "tile_size",  "bank_rows", "step", "frames",
                                        "rate_num",  "rate_den",   "origin",    "nete", "netr",
                                        "bank",      "tile_index", "size" };
    static const char *const two[] = { "bank_dim", "deform_width", "head_width",   "hyper_width",
                                       "ar_width", "position",     "dynamic_prob", "offset_prob" };

    if (l->n > 4)
        return (unsigned)conf_line_number(l, 4, 1, 4);
    for (size_t i = 0; i < sizeof four / sizeof *four; i++)
        if (strcmp(e->name, four[i]) == 0)
            return 4;
    for (size_t i = 0; i < sizeof two / sizeof *two; i++)
        if (strcmp(e->name, two[i]) == 0)
            return 2;
    return 1;
}

static void store(uint8_t *p, unsigned width, uint32_t v)
{
    for (unsigned i = 0; i < width; i++)
        p[i] = (uint8_t)(v >> 8 * i);
}

static void patch(conf_stream *s, const conf_line *l)
{
    const conf_element *const e = conf_stream_element(s, l, l->word[2]);

    store(bytes_of(s, e), width_of(l, e), (uint32_t)conf_line_number(l, 3, INT32_MIN, UINT32_MAX));
}

static void raise_element(conf_stream *s, const conf_line *l)
{
    const conf_element *const e = conf_stream_element(s, l, l->word[2]);
    const unsigned width = width_of(l, e);
    uint8_t *const p = bytes_of(s, e);
    uint32_t v = (uint32_t)conf_line_number(l, 3, INT32_MIN, UINT32_MAX);

    for (unsigned i = 0; i < width; i++)
        v += (uint32_t)p[i] << 8 * i;
    store(p, width, v);
}

static void patch_all(conf_stream *s, const conf_line *l)
{
    for (size_t i = 0; i < s->n_elements; i++)
        if (strcmp(s->element[i].name, l->word[2]) == 0)
            store(bytes_of(s, &s->element[i]), width_of(l, &s->element[i]),
                  (uint32_t)conf_line_number(l, 3, 0, UINT32_MAX));
}

static void flip(conf_stream *s, const conf_line *l)
{
    *bytes_of(s, conf_stream_element(s, l, l->word[2])) ^= 1;
}

static void cut(conf_stream *s, const conf_line *l)
{
    s->cut = (int64_t)conf_stream_where(s, l, 2);
}

static void append(conf_stream *s, const conf_line *l)
{
    hex_bytes(l, 2, &s->tail);
}

static void open_gap(conf_stream *s, int at)
{
    if (s->n == CONF_CHUNKS)
        conf_die("more than %d chunks", CONF_CHUNKS);
    memmove(&s->chunk[at + 1], &s->chunk[at], (size_t)(s->n++ - at) * sizeof *s->chunk);
    memset(&s->chunk[at], 0, sizeof *s->chunk);
    s->chunk[at].size = -1;
    for (int i = 0; i < CONF_CHUNKS; i++)
        s->moved[i] += s->moved[i] >= at;
}

static void insert(conf_stream *s, const conf_line *l)
{
    const int at = conf_word_is(l, 2, "end") ? s->n : conf_stream_chunk(s, l, l->word[2]);
    conf_chunk *c;

    if (l->n < 6 || strlen(l->word[3]) != 4)
        conf_line_bad(l, "insert REF TYPE FLAGS PAYLOAD");
    open_gap(s, at);
    c = &s->chunk[at];
    memcpy(c->type, l->word[3], 4);
    c->flags = (uint32_t)conf_line_number(l, 4, 0, UINT32_MAX);
    if (conf_word_is(l, 5, "text")) {
        const char *const text = strstr(l->rest, "text ") + 5;

        conf_print(&c->payload, "%s\n", text);
    } else if (conf_word_is(l, 5, "hex")) {
        hex_bytes(l, 6, &c->payload);
    } else {
        static const uint8_t zero[1 << 16];
        long long n = conf_line_number(l, 5, 0, 1 << 28);

        for (; n > 0; n -= (long long)sizeof zero)
            conf_add(&c->payload, zero, n < (long long)sizeof zero ? (size_t)n : sizeof zero);
    }
}

static void insert_many(conf_stream *s, const conf_line *l)
{
    for (long long n = conf_line_number(l, 4, 1, CONF_CHUNKS); n > 0; n--) {
        const int at = conf_stream_chunk(s, l, l->word[2]);

        open_gap(s, at);
        memcpy(s->chunk[at].type, l->word[3], 4);
    }
}

static void drop(conf_stream *s, int at)
{
    conf_free(&s->chunk[at].payload);
    memmove(&s->chunk[at], &s->chunk[at + 1], (size_t)(--s->n - at) * sizeof *s->chunk);
    for (int i = 0; i < CONF_CHUNKS; i++)
        s->moved[i] = s->moved[i] == at ? -1 : s->moved[i] - (s->moved[i] > at);
}

static void repeat(conf_stream *s, int at)
{
    open_gap(s, at + 1);
    s->chunk[at + 1] = s->chunk[at];
    memset(&s->chunk[at + 1].payload, 0, sizeof s->chunk[at].payload);
    conf_add(&s->chunk[at + 1].payload, s->chunk[at].payload.data, s->chunk[at].payload.size);
}

static void swap(conf_stream *s, int a, int b)
{
    const conf_chunk c = s->chunk[a];

    s->chunk[a] = s->chunk[b];
    s->chunk[b] = c;
    for (int i = 0; i < CONF_CHUNKS; i++)
        s->moved[i] = s->moved[i] == a ? b : s->moved[i] == b ? a : s->moved[i];
}

static void tail(conf_stream *s, const conf_line *l)
{
    conf_bytes *const p = &s->chunk[conf_stream_chunk(s, l, l->word[2])].payload;
    conf_bytes more = { NULL, 0, 0 };

    hex_bytes(l, 3, &more);
    conf_remove(p, p->size - more.size, more.size);
    conf_add(p, more.data, more.size);
    conf_free(&more);
}

/* Sets a bias in a file whose NETE is raw. */
static void set_bias(conf_stream *s, const conf_line *l)
{
    conf_bytes *const p = &s->chunk[conf_stream_chunk(s, l, "NETE")].payload;
    int scale;
    const size_t index = conf_bias_index(s->build, l, 2, &scale);
    const float v = ldexpf((float)conf_line_number(l, 5, INT32_MIN, INT32_MAX), -scale);

    ted4_store32(p->data + s->build->scene->shape.n_units + 1 + 4 * index, ted4_float_bits(v));
}

static void tree(conf_stream *s, const conf_line *l)
{
    conf_coded_tree(&s->chunk[conf_stream_chunk(s, l, "POSN")].payload, l);
}

static void copy_position(conf_stream *s, const conf_line *l)
{
    uint8_t *const p = s->chunk[conf_stream_chunk(s, l, "POSN")].payload.data;
    const long long last = s->build->head.n_anchors - 1;

    memcpy(p + 6 * conf_line_number(l, 3, 0, last), p + 6 * conf_line_number(l, 2, 0, last), 6);
}

/* Executes a line that changes one chunk. Returns 1, or 0 if it is another kind of line. */
static int chunk_line(conf_stream *s, const conf_line *l, const char *what)
{
    static const char *const word[] = {
        "drop", "repeat", "swap",   "retype",  "flags",     "size",
        "hash", "grow",   "shrink", "payload", "type-byte", "keep"
    };
    size_t way = 0;

    while (way < sizeof word / sizeof *word && strcmp(word[way], what) != 0)
        way++;
    if (way == sizeof word / sizeof *word)
        return 0;

    const int at = conf_stream_chunk(s, l, l->word[2]);
    conf_chunk *c = &s->chunk[at];

    switch (way) {
    case 0: drop(s, at); break;
    case 1: repeat(s, at); break;
    case 2: swap(s, at, conf_stream_chunk(s, l, l->word[3])); break;
    case 3: memcpy(c->type, l->word[3], 4); break;
    case 4: c->flags = (uint32_t)conf_line_number(l, 3, 0, UINT32_MAX); break;
    case 5: c->size = conf_line_number(l, 3, 0, UINT32_MAX); break;
    case 6: c->bad_hash = 1; break;
    case 7:
        for (long long n = conf_line_number(l, 3, 1, 1 << 20); n > 0; n--)
            conf_add(&c->payload, "", 1);
        break;
    case 8:
        conf_remove(&c->payload,
                    c->payload.size - (size_t)conf_line_number(l, 3, 1, (long long)c->payload.size),
                    (size_t)conf_line_number(l, 3, 1, (long long)c->payload.size));
        break;
    case 9:
        conf_free(&c->payload);
        hex_bytes(l, 3, &c->payload);
        break;
    case 11:
        conf_remove(&c->payload, (size_t)conf_line_number(l, 3, 0, (long long)c->payload.size),
                    c->payload.size -
                        (size_t)conf_line_number(l, 3, 0, (long long)c->payload.size));
        break;
    default:
        c->type[conf_line_number(l, 3, 0, 3)] =
            (uint8_t)strtoul(l->n > 4 ? l->word[4] : "", NULL, 16);
    }
    return 1;
}

static void set_substream(conf_bytes *p, size_t at, size_t size, size_t size_at, const conf_line *l)
{
    conf_bytes more = { NULL, 0, 0 };

    hex_bytes(l, 4, &more);
    conf_remove(p, at, size);
    conf_insert(p, at, more.data, more.size);
    ted4_store32(p->data + size_at, (uint32_t)more.size);
    conf_free(&more);
}

/* Changes the state of the lane if there is one (lane >= 0), else the last word, or the low half of
 * the state if there are no words. */
static void spoil_final(uint8_t *substream, size_t size, long long lane)
{
    if (lane >= 0)
        ted4_store32(substream + 4 * lane, ted4_load32(substream + 4 * lane) + 1);
    else if (size > 4)
        ted4_store16(substream + size - 2, (uint16_t)(ted4_load16(substream + size - 2) + 1));
    else
        ted4_store32(substream, ted4_load32(substream) + 1);
}

static int stream_line(conf_stream *s, const conf_line *l, const char *what)
{
    size_t size, size_at, at;

    if (strncmp(what, "stream-", 7) != 0 && strcmp(what, "final") != 0)
        return 0;

    const int chunk = conf_stream_chunk(s, l, l->word[2]);
    conf_bytes *const p = &s->chunk[chunk].payload;
    conf_bytes more = { NULL, 0, 0 };

    at = conf_stream_substream(s, chunk, (unsigned)conf_line_number(l, 3, 0, 99), &size, &size_at);
    if (strcmp(what, "stream-grow") == 0) {
        hex_bytes(l, 4, &more);
        conf_insert(p, at + size, more.data, more.size);
        ted4_store32(p->data + size_at, (uint32_t)(size + more.size));
        conf_free(&more);
    } else if (strcmp(what, "stream-shrink") == 0) {
        const size_t n = (size_t)conf_line_number(l, 4, 1, (long long)size);

        conf_remove(p, at + size - n, n);
        ted4_store32(p->data + size_at, (uint32_t)(size - n));
    } else if (strcmp(what, "stream-set") == 0) {
        set_substream(p, at, size, size_at, l);
    } else if (strcmp(what, "final") == 0) {
        spoil_final(p->data + at, size, l->n > 4 ? conf_line_number(l, 4, 0, 63) : -1);
    } else {
        store(p->data + at + (size_t)conf_line_number(l, 4, 0, (long long)size - 1),
              (unsigned)conf_line_number(l, 5, 1, 4),
              (uint32_t)conf_line_number(l, 6, 0, UINT32_MAX));
    }
    return 1;
}

static ted4_blob *blob_of(const conf_build *b, const conf_line *l)
{
    return conf_word_is(l, 2, "NETE")   ? &b->scene->nete
           : conf_word_is(l, 2, "NETR") ? &b->scene->netr
                                        : &b->scene->bank;
}

static void value(const conf_build *b, const conf_line *l)
{
    const ted4_blob *blob = blob_of(b, l);

    blob->values[conf_line_number(l, 3, 0, (long long)blob->n - 1)] = conf_word_float(l, 4);
}

/* do pack, do blocks */
static void pack(conf_stream *s, const conf_build *b, const conf_line *l)
{
    const int chunk = conf_stream_chunk(s, l, l->word[2]);
    conf_bytes *const p = &s->chunk[chunk].payload;
    const int spelt = conf_word_is(l, 1, "blocks");
    const int way = !spelt && l->n > 3 ? conf_pack_way_of(l->word[3]) : -1,
              fault = !spelt && l->n > 4 ? conf_pack_fault_of(l->word[4]) : -1;
    ted4_blob *blob = blob_of(b, l);
    const size_t head = conf_word_is(l, 2, "NETE") ? b->scene->shape.n_units : 0;
    const size_t n = (size_t)blob->n;
    uint8_t *bytes;

    if (conf_word_is(l, 3, "coded")) {
        conf_coded_blob(p, head, b->scene, blob, l);
        return;
    }
    if (!spelt && (way < 0 || fault < 0))
        conf_line_bad(l, "pack REF WAY FAULT");
    bytes = conf_alloc(n, 4);
    conf_shuffle(bytes, blob->values, n);
    conf_remove(p, head, p->size - head);
    conf_add(p, "\1", 1);
    if (spelt)
        conf_blocks(p, l, 3, bytes, 4 * n);
    else
        conf_pack(p, bytes, 4 * n, (conf_pack_way)way, (conf_pack_fault)fault);
    free(bytes);
}

static void pack_zeros(conf_stream *s, const conf_line *l)
{
    conf_bytes *const p = &s->chunk[conf_stream_chunk(s, l, l->word[2])].payload;
    const size_t n = (size_t)conf_line_number(l, 3, 1, 1 << 26);
    uint8_t *bytes = conf_alloc(n, 1);

    conf_remove(p, 0, p->size);
    conf_add(p, "\1", 1);
    conf_pack(p, bytes, n, CONF_PACK_DYNAMIC, CONF_PACK_GOOD);
    free(bytes);
}

static void recode(conf_stream *s, const conf_build *b, int chunk, unsigned tile,
                   const conf_injection *what)
{
    conf_free(&s->chunk[chunk].payload);
    conf_inject(&s->chunk[chunk].payload, b->scene, tile, what);
}

static void inject(conf_stream *s, const conf_build *b, const conf_line *l)
{
    conf_injection j = { .substream = (unsigned)conf_line_number(l, 3, 0, 99),
                         .symbol = (size_t)conf_line_number(l, 4, 0, 1 << 20) };

    j.way = conf_word_is(l, 5, "value")    ? CONF_INJECT_VALUE
            : conf_word_is(l, 5, "escape") ? CONF_INJECT_ESCAPE
                                           : CONF_INJECT_ONES;
    j.value = conf_line_number(l, 6, -(1LL << 40), 1LL << 40);
    j.high = conf_word_is(l, 7, "high");
    recode(s, b, conf_stream_chunk(s, l, l->word[2]), (unsigned)atoi(l->word[2] + 4), &j);
}

static void symbol(conf_stream *s, conf_build *b, const conf_line *l)
{
    static const conf_injection nothing = { .way = CONF_INJECT_NOTHING };
    const size_t anchor = (size_t)conf_line_number(l, 4, 0, b->head.n_anchors - 1);
    const unsigned tile = (unsigned)(anchor / b->head.tile_size);
    char ref[16];

    b->scene->symbol[conf_word_type(l, 2)]
                    [(size_t)conf_line_number(l, 3, 0, 1000) * b->head.n_anchors + anchor] =
        (int16_t)conf_line_number(l, 5, -32767, 32767);
    snprintf(ref, sizeof ref, "TILE%u", tile);
    recode(s, b, conf_stream_chunk(s, l, ref), tile, &nothing);
}

/* Executes a line that needs only the stream. Returns 1, or 0 if it is another kind of line. */
static int plain_line(conf_stream *s, const conf_line *l, const char *what)
{
    static const struct {
        const char *word;
        void (*run)(conf_stream *s, const conf_line *l);
    } table[] = {
        { "patch", patch },
        { "patch-all", patch_all },
        { "raise", raise_element },
        { "flip", flip },
        { "insert", insert },
        { "insert-many", insert_many },
        { "cut", cut },
        { "append", append },
        { "tail", tail },
        { "set-bias", set_bias },
        { "copy-position", copy_position },
        { "tree", tree },
        { "pack-zeros", pack_zeros },
    };

    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strcmp(table[i].word, what) == 0) {
            table[i].run(s, l);
            return 1;
        }
    return 0;
}

void conf_stream_do(conf_stream *s, conf_build *b, const conf_line *l)
{
    const char *const what = l->n > 1 ? l->word[1] : "";

    if (strcmp(what, "value") == 0)
        value(b, l);
    else if (strcmp(what, "pack") == 0 || strcmp(what, "blocks") == 0)
        pack(s, b, l);
    else if (strcmp(what, "inject") == 0)
        inject(s, b, l);
    else if (strcmp(what, "symbol") == 0)
        symbol(s, b, l);
    else if (!plain_line(s, l, what) && !chunk_line(s, l, what) && !stream_line(s, l, what))
        conf_line_bad(l, "does nothing that is known");
}

static size_t plus(const conf_line *l, int i)
{
    return i < l->n ? (size_t)conf_line_number(l, i, INT32_MIN, INT32_MAX) : 0;
}

size_t conf_stream_where(const conf_stream *s, const conf_line *l, int i)
{
    size_t size, size_at;

    if (i >= l->n)
        conf_line_bad(l, "a place is missing");
    if (l->word[i][0] >= '0' && l->word[i][0] <= '9')
        return (size_t)conf_line_number(l, i, 0, UINT32_MAX);
    if (strncmp(l->word[i], "size", 4) == 0 && (l->word[i][4] == '\0' || l->word[i][4] == '-')) {
        conf_bytes file;
        size_t n;

        conf_stream_join(s, &file);
        n = file.size - strtoul(l->word[i][4] == '-' ? l->word[i] + 5 : "0", NULL, 10);
        conf_free(&file);
        return n;
    }
    if (conf_word_is(l, i, "chunk"))
        return conf_stream_place(s, conf_stream_chunk(s, l, l->word[i + 1])) + plus(l, i + 2);
    if (conf_word_is(l, i, "last")) {
        const int chunk = conf_stream_chunk(s, l, l->word[i + 1]);

        return conf_stream_place(s, chunk) + TED4_FRAME_HEAD_SIZE + s->chunk[chunk].payload.size -
               (size_t)conf_line_number(l, i + 2, 0, INT32_MAX);
    }
    if (conf_word_is(l, i, "bias")) {
        int scale;
        const size_t index = conf_bias_index(s->build, l, i + 1, &scale);

        return conf_stream_place(s, conf_stream_chunk(s, l, "NETE")) + TED4_FRAME_HEAD_SIZE +
               s->build->scene->shape.n_units + 1 + 4 * index;
    }
    if (conf_word_is(l, i, "payload"))
        return conf_stream_place(s, conf_stream_chunk(s, l, l->word[i + 1])) +
               TED4_FRAME_HEAD_SIZE + plus(l, i + 2);
    if (conf_word_is(l, i, "stream")) {
        const int chunk = conf_stream_chunk(s, l, l->word[i + 1]);

        return conf_stream_place(s, chunk) + TED4_FRAME_HEAD_SIZE +
               conf_stream_substream(s, chunk, (unsigned)conf_line_number(l, i + 2, 0, 99), &size,
                                     &size_at) +
               plus(l, i + 3);
    }

    const conf_element *const e = conf_stream_element(s, l, l->word[i]);

    return e->chunk < 0 ? e->at
                        : conf_stream_place(s, s->moved[e->chunk]) + TED4_FRAME_HEAD_SIZE + e->at +
                              plus(l, i + 1);
}
