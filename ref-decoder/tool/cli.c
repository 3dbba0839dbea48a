/* cli.c - see cli.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cli.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Files are read in pieces that double, so that pipes work and no size is believed. */
static uint8_t *read_all(FILE *f, size_t *size)
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
    data = read_all(f, size);
    if (!is_stdin) {
        const int why = errno;

        fclose(f);
        errno = why;
    }
    return data;
}

static const char *verdict_name(ted4_verdict v)
{
    static const char *const name[] = { "valid", "invalid", "limit", "unsupported", "io" };

    return name[v];
}

int ted4_report(const char *program, const char *path, const ted4_error *e, int json)
{
    const ted4_verdict verdict = ted4_status_verdict(e->code);

    if (json) {
        json_t *const name = json_string(path);         /* NULL: not UTF-8 */
        json_t *const o =
            json_pack("{s:o, s:s, s:s, s:I, s:s}", "file", name != NULL ? name : json_null(),
                      "verdict", verdict_name(verdict), "error", ted4_status_id(e->code), "offset",
                      (json_int_t)e->offset, "text", ted4_status_text(e->code));

        json_dumpf(o, stdout, JSON_COMPACT);
        putchar('\n');
        json_decref(o);
    }
    fprintf(stderr, "%s: %s: byte %zu: %s [%s] (specification %s)\n", program, path, e->offset,
            ted4_status_text(e->code), ted4_status_id(e->code), ted4_status_section(e->code));
    return verdict == TED4_INVALID || verdict == TED4_UNSUPPORTED ? TED4_EXIT_REFUSED
                                                                  : TED4_EXIT_TOOL;
}
