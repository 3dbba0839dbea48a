/* advise_meta.c - checks ancillary chunks: whether the type is registered (spec 16.3), and whether
 * META is as spec 5.2 says.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/advise_parts.h"

#include <string.h>
#include "base/bytes.h"

enum { META_FLAGS = 2 };

/* Returns the size of the UTF-8 character at p, 1 to 4 bytes, or 0 if it is not well-formed or is a
 * control character. left > 0 bytes follow from p on. */
static size_t utf8_character(const uint8_t *p, size_t left)
{
    static const uint32_t least[5] = { 0, 0, 0x80, 0x800, 0x10000 };
    const size_t n = p[0] < 0x80       ? 1
                     : p[0] >> 5 == 6  ? 2
                     : p[0] >> 4 == 14 ? 3
                     : p[0] >> 3 == 30 ? 4
                                       : 0;
    uint32_t c;

    if (n == 0 || n > left)
        return 0;
    c = n == 1 ? p[0] : p[0] & (0x7fu >> n);
    for (size_t i = 1; i < n; i++) {
        if (p[i] >> 6 != 2)
            return 0;
        c = c << 6 | (p[i] & 63);
    }
    return c >= least[n] && c < 0x110000 && (c < 0xd800 || c > 0xdfff) && c >= ' ' && c != 0x7f ? n
                                                                                                : 0;
}

/* Returns the offset of the LF that ends the line at offset at, or 0 if that is not a valid line.
 * *key is set to the number of bytes before the first '='. */
static size_t line_end(const uint8_t *data, size_t at, size_t end, size_t *key)
{
    size_t i = at;

    *key = 0;
    while (i < end && data[i] != '\n') {
        const size_t n = utf8_character(data + i, end - i);

        if (n == 0)
            return 0;
        if (data[i] == '=' && *key == 0)
            *key = i - at;
        i += n;
    }
    return i<end && * key> 0 ? i : 0;
}

/* Lines of META, all of them valid. */
typedef struct {
    const uint8_t *data;
    size_t *at;            /* [n], offsets */
    size_t *order, *spare; /* [n]: line numbers, sorted by key, then by position; scratch memory */
    uint8_t *again;        /* [n], 1: an earlier line has the same key */
    size_t n;
} lines;

/* Compares the keys of lines a and b. Returns a number below, equal to or above 0, as memcmp. */
static int compare(const lines *l, size_t a, size_t b)
{
    const uint8_t *p = l->data + l->at[a], *q = l->data + l->at[b];

    while (*p == *q && *p != '=') {
        p++;
        q++;
    }
    return (int)*p - (int)*q;
}

/* Merges order[first .. middle - 1] and order[middle .. end - 1] into spare. */
static void merge(const lines *l, size_t first, size_t middle, size_t end)
{
    size_t i = first, j = middle;

    for (size_t k = first; k < end; k++)
        l->spare[k] = j == end || (i < middle && compare(l, l->order[i], l->order[j]) <= 0)
                          ? l->order[i++]
                          : l->order[j++];
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Sorts the lines and fills again. Merge sort is used because no text makes it slow. */
static void find_again(lines *l)
{
    for (size_t i = 0; i < l->n; i++)
        l->order[i] = i;
    for (size_t width = 1; width < l->n; width *= 2) {
        size_t *const merged = l->spare;

        for (size_t i = 0; i < l->n; i += 2 * width)
            merge(l, i, least(i + width, l->n), least(i + 2 * width, l->n));
        l->spare = l->order;
        l->order = merged;
    }
    for (size_t i = 1; i < l->n; i++)
        l->again[l->order[i]] = compare(l, l->order[i - 1], l->order[i]) == 0;
}

/* Returns the number of valid lines at the beginning of a payload. *end is set to the offset behind
 * them, and at[], unless NULL, to the offsets at which they begin. */
static size_t right_lines(const ted4_findings *f, const ted4_chunk_place *p, size_t *at,
                          size_t *end)
{
    size_t n = 0, key;

    for (*end = p->payload; *end < p->end; n++) {
        const size_t lf = line_end(f->data, *end, p->end, &key);

        if (lf == 0)
            break;
        if (at != NULL)
            at[n] = *end;
        *end = lf + 1;
    }
    return n;
}

static void advise_text(ted4_findings *f, const ted4_chunk_place *p, ted4_arena *a)
{
    lines l = { .data = f->data };
    size_t end;

    l.n = right_lines(f, p, NULL, &end);
    l.at = ted4_arena_alloc(a, l.n, 3 * sizeof *l.at);
    l.again = ted4_arena_alloc(a, l.n, 1);
    if (l.at != NULL && l.again != NULL) {
        (void)right_lines(f, p, l.at, &end);
        l.order = l.at + l.n;
        l.spare = l.order + l.n;
        find_again(&l);
        for (size_t i = 0; i < l.n; i++)
            if (l.again[i])
                ted4_find_advice(f, TED4_ADV_META_KEY, "META", l.at[i], 0, 0, 0);
        if (end < p->end)
            ted4_find_advice(f, TED4_ADV_META_TEXT, "META", end, 0, 0, 0);
    } else {
        f->starved = 1;
    }
    ted4_arena_release(a, l.at);
    ted4_arena_release(a, l.again);
}

int ted4_advise_ancillary(ted4_findings *f, const ted4_chunk_place *p, ted4_arena *a)
{
    const uint8_t *type = f->data + p->at;
    const uint32_t flags = ted4_load32(type + 4);

    if (memcmp(type, "META", 4) == 0) {
        if (flags != META_FLAGS)
            ted4_find_advice(f, TED4_ADV_META_FLAGS, "META", p->at + 4, 1, flags, 0);
        advise_text(f, p, a);
        return 0;
    }
    if (memcmp(type, "CAMS", 4) == 0 || memcmp(type, "THMB", 4) == 0) {
        if (flags != 0)
            ted4_find_advice(f, TED4_ADV_CHUNK_FLAGS, NULL, p->at + 4, 1, flags, 0);
        return 1;
    }
    ted4_find_advice(f, type[0] == 'x' ? TED4_ADV_PRIVATE : TED4_ADV_CHUNK, NULL, p->at, 2, flags,
                     (int64_t)(p->end - p->payload));
    return 0;
}
