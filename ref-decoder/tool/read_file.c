/* read_file.c - reads whole files and streams into memory; see cli.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cli.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Returns the size beyond which all files get the same verdict, by what their file header says
 * (spec 5.1); data holds at least that. More bytes than the level allows (spec 13) are refused for
 * their number, whatever they are, and what begins in another way is refused for its beginning. */
static size_t most_of_ted4(const uint8_t *data)
{
    enum { LEVEL_AT = 11, BOUNDED = 4, UNBOUNDED = 31 };
    static const uint8_t magic[8] = { 0x89, 'T', 'E', 'D', '4', '\r', '\n', 0x1a };
    const unsigned level = data[LEVEL_AT];

    if (memcmp(data, magic, sizeof magic) != 0)
        return 0;
    if (level == UNBOUNDED)
        return SIZE_MAX;
    return level >= 1 && level <= BOUNDED ? (size_t)1 << (20 + 2 * level) : 0;
}

/* Reads into a buffer that doubles, so that pipes work and no reported file size is trusted. With
 * only_ted4, it stops where what follows does not change the verdict. */
static uint8_t *read_stream(FILE *f, int only_ted4, size_t *size)
{
    size_t capacity = 1 << 16, n = 0;
    uint8_t *data = malloc(capacity);

    while (data != NULL) {
        n += fread(data + n, 1, capacity - n, f);
        if (n < capacity || (only_ted4 && n > most_of_ted4(data)))
            break;
        uint8_t *const more = capacity > SIZE_MAX / 2 ? NULL : realloc(data, capacity *= 2);

        if (more == NULL)
            free(data);
        data = more;
    }
    if (data != NULL && ferror(f)) {
        free(data);
        data = NULL;
    }
    *size = n;
    return data;
}

static uint8_t *read_path(const char *path, int only_ted4, size_t *size)
{
    const int is_stdin = strcmp(path, "-") == 0;
    FILE *const f = is_stdin ? stdin : fopen(path, "rb");
    uint8_t *data;

    if (f == NULL)
        return NULL;
    data = read_stream(f, only_ted4, size);
    if (!is_stdin) {
        const int why = errno;

        fclose(f);
        errno = why;
    }
    return data;
}

uint8_t *ted4_read_stream(FILE *f, size_t *size)
{
    return read_stream(f, 0, size);
}

uint8_t *ted4_read_file(const char *path, size_t *size)
{
    return read_path(path, 0, size);
}

uint8_t *ted4_read_ted4(const char *path, size_t *size)
{
    return read_path(path, 1, size);
}
