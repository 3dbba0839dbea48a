/* fz_editor.c - what an editor may do to a valid file without decoding it (spec 3.5, 5.2): drop,
 * insert, double or move ancillary chunks. Up to three bytes after the chunk ENDS select the
 * operation and the place. Claims: the edited file is valid, and has the same hash, the same tiers
 * T1 to T4, and the same T0 apart from these chunks; only the bounds of 13.1 that depend on the
 * file's size can forbid it. Such a chunk before HEAD is refused with con.chunk-order, one after
 * ENDS with con.trailing.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include <xxhash.h>
#include "base/bytes.h"
#include "harness.h"
#include "fix_hashes.h"
#include "norm/limits.h"
#include "read/container.h"

enum {
    TAIL = 3,
    MOST_PAYLOAD = 32,
    FRAME = TED4_FRAME_HEAD_SIZE + TED4_FRAME_HASH_SIZE,
    TIERS = 5
};
enum { DROP, PUT_IN, TWICE, MOVE, DROP_UNSAFE, WAYS };

static const ted4_options options = { .max_bytes = FUZZ_MAX_BYTES };

/* A file that is being written. */
typedef struct {
    uint8_t *data; /* owned */
    size_t size;
} edited;

static void add(edited *e, const uint8_t *from, size_t size)
{
    memcpy(e->data + e->size, from, size);
    e->size += size;
}

/* Inserts an ancillary chunk: one of unknown type, or META with any text. */
static void put_in(edited *e, uint8_t what)
{
    static const char *const type[] = { "META", "xtra", "abcD", "Tile" };
    uint8_t chunk[FRAME + MOST_PAYLOAD] = { 0 };
    const unsigned n = what % MOST_PAYLOAD;

    memcpy(chunk, type[what & 3], 4);
    ted4_store32(chunk + 4, what & 4 ? 2 : 0);
    ted4_store32(chunk + 8, n);
    memset(chunk + TED4_FRAME_HEAD_SIZE, what, n);
    add(e, chunk, FRAME + n);
}

/* Returns the edited copy of the file. place: number of the chunk that is edited, or before which a
 * chunk is inserted. *changed: 0 if there is no such chunk. */
static edited edit(const uint8_t *data, size_t size, int way, unsigned place, uint8_t what,
                   int *changed)
{
    edited e = { malloc(2 * size + FRAME + MOST_PAYLOAD), 0 };
    size_t kept_at = 0, kept = 0; /* the chunk that moves: offset and bytes in data; goes before
                                     ENDS at the latest */
    unsigned i = 0;
    ted4_reader r;

    fuzz_require(e.data != NULL, "memory");
    *changed = 0;
    ted4_reader_init(&r, data, TED4_FILE_HEADER_SIZE, size, 1);
    add(&e, data, TED4_FILE_HEADER_SIZE);
    for (; r.base.pos < size; i++) {
        const ted4_chunk_place p = ted4_container_next(&r);
        const size_t whole = p.end + TED4_FRAME_HASH_SIZE - p.at;
        const int mine = p.type == TED4_CHUNKS &&
                         (way == DROP_UNSAFE ? (data[p.at + 4] & 2) == 0 : i >= place);

        if (way == PUT_IN && i == place) {
            put_in(&e, what);
            *changed = 1;
        }
        if (kept > 0 && (i > place + what % 4u || p.type == TED4_ENDS)) {
            add(&e, data + kept_at, kept);
            kept = 0;
        }
        if (mine && way == MOVE && !*changed) {
            kept_at = p.at;
            kept = whole;
        } else if (!mine || (way != DROP && way != DROP_UNSAFE)) {
            add(&e, data + p.at, whole);
        }
        if (mine && way == TWICE && !*changed)
            add(&e, data + p.at, whole);
        *changed |= mine;
    }
    ted4_fix_hashes(e.data, e.size);
    return e;
}

static void mix(void *user, const void *bytes, size_t size)
{
    XXH64_hash_t *h = user;

    *h = XXH3_64bits_withSeed(bytes, size, *h);
}

/* T0 without ancillary chunks, and without offsets. */
typedef struct {
    XXH64_hash_t hash;
    int skip;
} parsed;

static void element(void *user, size_t offset, const char *name, int64_t index, int64_t value)
{
    parsed *p = user;
    const int64_t what[2] = { index, value };

    (void)offset;
    if (strcmp(name, "chunk_type") == 0) {
        const uint32_t type = (uint32_t)value;
        uint8_t bytes[4];

        ted4_store32(bytes, type);
        p->skip = 1;
        for (int i = 0; i < TED4_CHUNKS; i++)
            p->skip &= memcmp(bytes, ted4_chunk_type[i], 4) != 0;
    }
    if (p->skip)
        return;
    mix(&p->hash, name, strlen(name));
    mix(&p->hash, what, sizeof what);
}

static void same_tiers(const ted4_scene *a, const ted4_scene *b)
{
    for (int tier = 1; tier < TIERS; tier++) {
        XXH64_hash_t x = 0, y = 0;

        fuzz_require(ted4_dump_tier(a, tier, NULL, mix, &x) == TED4_OK &&
                         ted4_dump_tier(b, tier, NULL, mix, &y) == TED4_OK,
                     "tiers");
        fuzz_require(x == y, "the same tiers");
    }
    fuzz_require(memcmp(a->hash, b->hash, sizeof a->hash) == 0, "the same integers");
}

/* Decodes a file. *p: what was parsed. */
static ted4_scene *decode(const uint8_t *data, size_t size, parsed *p, ted4_error *e)
{
    ted4_options o = options;
    ted4_scene *s = NULL;

    *p = (parsed) { 0, 0 };
    o.trace = element;
    o.trace_user = p;
    (void)ted4_decode(data, size, &o, &s, e);
    return s;
}

static void check(const ted4_scene *s, const parsed *p, const edited *e)
{
    const ted4_limits *const l = ted4_limits_of(s->level);
    ted4_error verdict;
    parsed q;
    ted4_scene *other = decode(e->data, e->size, &q, &verdict);

    fuzz_require((other != NULL) == ted4_limits_hold(l, &s->head, &s->shape, e->size),
                 "valid, unless its size is not for its level");
    fuzz_require(other != NULL || verdict.code == TED4_E_LVL_EXCEEDED, "the level");
    if (other != NULL) {
        fuzz_require(p->hash == q.hash, "the same elements");
        same_tiers(s, other);
    }
    ted4_scene_free(other);
}

/* Puts a chunk before HEAD, or after ENDS. */
static void misplace(const uint8_t *data, size_t size, uint8_t what)
{
    edited e = { malloc(size + FRAME + MOST_PAYLOAD), 0 };
    const int behind = what & 8;
    ted4_error verdict;
    parsed p;

    fuzz_require(e.data != NULL, "memory");
    add(&e, data, behind ? size : TED4_FILE_HEADER_SIZE);
    put_in(&e, what);
    if (!behind)
        add(&e, data + TED4_FILE_HEADER_SIZE, size - TED4_FILE_HEADER_SIZE);
    ted4_fix_hashes(e.data, e.size);
    fuzz_require(decode(e.data, e.size, &p, &verdict) == NULL, "refused");
    if (e.size <= ted4_limits_of(data[11])->file_bytes)
        fuzz_require(behind ? verdict.code == TED4_E_CON_TRAILING && verdict.offset == size
                            : verdict.code == TED4_E_CON_CHUNK_ORDER &&
                                  verdict.offset == TED4_FILE_HEADER_SIZE,
                     "chunks between HEAD and ENDS only");
    free(e.data);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t n = ted4_without_tail(data, size, TAIL);
    fuzz_source in = { data + n, data + size };
    const int way = fuzz_u8(&in) % WAYS;
    const uint8_t place = fuzz_u8(&in), what = fuzz_u8(&in);
    ted4_error verdict;
    parsed p;
    int changed;
    ted4_scene *s = decode(data, n, &p, &verdict);

    if (s == NULL)
        return 0;
    misplace(data, n, what);
    for (int i = 0; i < WAYS; i++) {
        edited e = edit(data, n, (way + i) % WAYS, 1 + place % 8u, what, &changed);

        fuzz_require(changed || (e.size == n && memcmp(e.data, data, n) == 0),
                     "unchanged when there is nothing to change");
        if (changed)
            check(s, &p, &e);
        free(e.data);
    }
    ted4_scene_free(s);
    return 0;
}
