/* read_file.c - reads whole files and streams into memory; see cli.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cli.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Reads into a buffer that doubles, so that pipes work and no reported file size is trusted. */
uint8_t *ted4_read_stream(FILE *f, size_t *size)
{
    size_t capacity = 1 << 16, n = 0;
    uint8_t *data = malloc(capacity);

    while (data != NULL) {
        n += fread(data + n, 1, capacity - n, f);
        if (n < capacity)
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

uint8_t *ted4_read_file(const char *path, size_t *size)
{
    const int is_stdin = strcmp(path, "-") == 0;
    FILE *const f = is_stdin ? stdin : fopen(path, "rb");
    uint8_t *data;

    if (f == NULL)
        return NULL;
    data = ted4_read_stream(f, size);
    if (!is_stdin) {
        const int why = errno;

        fclose(f);
        errno = why;
    }
    return data;
}
