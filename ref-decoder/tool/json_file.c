/* json_file.c - see json_file.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "json_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"

json_t *ted4_json_load(const char *path, char *why, size_t why_size)
{
    static const uint8_t mark[] = { 0xef, 0xbb, 0xbf };
    json_error_t e;
    size_t size;
    uint8_t *const data = ted4_read_file(path, &size);
    json_t *json;

    if (data == NULL) {
        snprintf(why, why_size, "%s", strerror(errno));
        return NULL;
    }
    const size_t skipped = size >= sizeof mark && memcmp(data, mark, sizeof mark) == 0 ? sizeof mark
                                                                                       : 0;
    json = json_loadb((const char *)data + skipped, size - skipped, JSON_REJECT_DUPLICATES, &e);
    if (json == NULL)
        snprintf(why, why_size, "line %d: %s", e.line, e.text);
    free(data);
    return json;
}
