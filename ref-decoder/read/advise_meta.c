/* advise_meta.c - ancillary chunks: is the type registered (spec 16.3), and is META what spec 5.2 says?
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "base/bytes.h"
#include "read/finding.h"

enum { META_FLAGS = 2 };

/* Bytes of the UTF-8 character at p, 1 to 4; 0: none that is well-formed and no control character. */
static size_t utf8_character(const uint8_t *p, size_t left)
{
    static const uint32_t least[5] = { 0, 0, 0x80, 0x800, 0x10000 };
    const size_t n = p[0] < 0x80 ? 1 : p[0] >> 5 == 6 ? 2 : p[0] >> 4 == 14 ? 3 : p[0] >> 3 == 30 ? 4 : 0;
    uint32_t     c;

    if (n == 0 || n > left)
        return 0;
    c = n == 1 ? p[0] : p[0] & (0x7fu >> n);
    for (size_t i = 1; i < n; i++) {
        if (p[i] >> 6 != 2)
            return 0;
        c = c << 6 | (p[i] & 63);
    }
    return c >= least[n] && c < 0x110000 && (c < 0xd800 || c > 0xdfff) && c >= ' ' && c != 0x7f ? n : 0;
}

/* A line from at on: offset of its LF, or 0 when it is none. *key: bytes before the first '='. */
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
    return i < end && *key > 0 ? i : 0;
}

/* Does a key of the lines from first to before at stand at at? Lines there are right. */
static int known_key(const uint8_t *data, size_t first, size_t at, size_t key)
{
    while (first < at) {
        if (memcmp(data + first, data + at, key + 1) == 0)      /* with its '=' */
            return 1;
        first = (size_t)((const uint8_t *)memchr(data + first, '\n', at - first) - data) + 1;
    }
    return 0;
}

static void advise_text(ted4_findings *f, const ted4_chunk_place *p)
{
    for (size_t at = p->payload, key; at < p->end;) {
        const size_t end = line_end(f->data, at, p->end, &key);

        if (end == 0) {
            ted4_find_advice(f, TED4_ADV_META_TEXT, "META", at, 0, 0, 0);
            return;
        }
        if (known_key(f->data, p->payload, at, key))
            ted4_find_advice(f, TED4_ADV_META_KEY, "META", at, 0, 0, 0);
        at = end + 1;
    }
}

void ted4_advise_ancillary(ted4_findings *f, const ted4_chunk_place *p)
{
    const uint8_t *type = f->data + p->at;
    const uint32_t flags = ted4_load32(type + 4);

    if (memcmp(type, "META", 4) == 0) {
        if (flags != META_FLAGS)
            ted4_find_advice(f, TED4_ADV_META_FLAGS, "META", p->at + 4, 1, flags, 0);
        advise_text(f, p);
    } else {
        ted4_find_advice(f, type[0] == 'x' ? TED4_ADV_PRIVATE : TED4_ADV_CHUNK, NULL, p->at, 2, flags,
                         (int64_t)(p->end - p->payload));
    }
}
