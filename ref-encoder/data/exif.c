/* exif.c - reads the orientation of the camera from EXIF. See image_file.h.
 * An APP1 payload holds "Exif", two zeros and a TIFF file: byte order "II" or "MM", 42, and the
 * offset of a directory. A directory is a number of entries followed by entries of 12 bytes: tag,
 * type, count and value.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/image_file.h"

#include <string.h>

enum { TAG_ORIENTATION = 0x0112, TYPE_SHORT = 3, ENTRY_SIZE = 12 };

/* A TIFF file. Offsets are relative to its first byte. */
typedef struct {
    const uint8_t *bytes;
    size_t size;
    int little;
} tiff;

/* Returns the unsigned number of n bytes at an offset, or 0 beyond the end. */
static uint32_t number(const tiff *t, size_t at, size_t n)
{
    uint32_t v = 0;

    if (at > t->size || n > t->size - at)
        return 0;
    for (size_t i = 0; i < n; i++)
        v = v << 8 | t->bytes[t->little ? at + n - 1 - i : at + i];
    return v;
}

int ted4_exif_orientation(const uint8_t *segment, size_t size)
{
    if (size < 14 || memcmp(segment, "Exif\0\0", 6) != 0)
        return 1;
    const tiff t = { segment + 6, size - 6, segment[6] == 'I' };
    const size_t directory = number(&t, 4, 4), entries = number(&t, directory, 2);

    for (size_t i = 0; i < entries; i++) {
        const size_t entry = directory + 2 + ENTRY_SIZE * i;
        if (number(&t, entry, 2) != TAG_ORIENTATION || number(&t, entry + 2, 2) != TYPE_SHORT)
            continue;
        const uint32_t v = number(&t, entry + 8, 2);
        return v >= 1 && v <= 8 ? (int)v : 1;
    }
    return 1;
}
