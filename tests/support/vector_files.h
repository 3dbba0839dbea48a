/* vector_files.h - visits the streams in conformance/vectors in the order of their names.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TESTS_VECTOR_FILES_H
#define TED4_TESTS_VECTOR_FILES_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "test.h"

enum { MAX_VECTOR = 1 << 20 };

/* Calls visit(data, size, path) for each stream that find(1) finds with these additional
 * conditions; data is valid during the call only. Returns the number of streams. */
static inline int each_vector(const char *conditions,
                              void (*visit)(const uint8_t *data, size_t size, const char *path))
{
    static uint8_t data[MAX_VECTOR];
    char command[256], path[1024];
    int n = 0;

    snprintf(command, sizeof command, "find conformance/vectors -name '*.ted4' %s | LC_ALL=C sort",
             conditions);

    FILE *const list = popen(command, "r");

    assert_non_null(list);
    for (; fgets(path, sizeof path, list) != NULL; n++) {
        path[strcspn(path, "\n")] = '\0';

        FILE *const f = fopen(path, "rb");

        assert_non_null(f);

        const size_t size = fread(data, 1, sizeof data, f);

        assert_true(size < sizeof data);
        fclose(f);
        visit(data, size, path);
    }
    pclose(list);
    return n;
}

#endif
