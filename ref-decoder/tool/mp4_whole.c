/* mp4_whole.c - see mp4_whole.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mp4_whole.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>

/* A box begins with its size, of which it is a part, and four letters; if the size is LONG_FOLLOWS,
 * the real one comes behind the letters. */
enum { SHORT_HEAD = 8, LONG_HEAD = 16, LONG_FOLLOWS = 1 };

static uint64_t big_endian(const uint8_t *bytes, int n)
{
    uint64_t value = 0;

    for (int i = 0; i < n; i++)
        value = value << 8 | bytes[i];
    return value;
}

/* Reads the head of the box at the present place. Returns the size of the box, or 0 if there is no
 * whole head, or a size that its writer has not filled in. */
static uint64_t read_head(FILE *f, char letters[4])
{
    uint8_t head[LONG_HEAD];
    uint64_t size;

    if (fread(head, 1, SHORT_HEAD, f) != SHORT_HEAD)
        return 0;
    memcpy(letters, head + 4, 4);
    size = big_endian(head, 4);
    if (size != LONG_FOLLOWS)
        return size >= SHORT_HEAD ? size : 0;
    if (fread(head + SHORT_HEAD, 1, SHORT_HEAD, f) != SHORT_HEAD)
        return 0;
    size = big_endian(head + SHORT_HEAD, 8);
    return size >= LONG_HEAD ? size : 0;
}

int ted4_mp4_is_whole(const char *path)
{
    FILE *const f = fopen(path, "rb");
    const off_t end = f != NULL && fseeko(f, 0, SEEK_END) == 0 ? ftello(f) : -1;
    int has_pictures = 0, has_list = 0;
    off_t at = 0;

    while (at < end) {
        char letters[4];
        const uint64_t size = fseeko(f, at, SEEK_SET) == 0 ? read_head(f, letters) : 0;

        if (size == 0 || size > (uint64_t)(end - at))
            break;
        has_pictures = has_pictures || memcmp(letters, "mdat", 4) == 0;
        has_list = has_list || memcmp(letters, "moov", 4) == 0;
        at += (off_t)size;
    }
    if (f != NULL)
        fclose(f);
    return at == end && has_pictures && has_list;
}
