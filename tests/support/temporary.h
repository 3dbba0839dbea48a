/* temporary.h - a temporary folder or file of a test, below $TMPDIR or /tmp. A failure to make it
 * ends the test program. Depends on nothing.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TEMPORARY_H
#define TED4_TEMPORARY_H

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { TEMPORARY_SIZE = 192 }; /* of a path */

static inline void temporary_made(int ok, const char *path)
{
    if (!ok) {
        perror(path);
        exit(1);
    }
}

static inline void temporary_name(char *path, const char *name)
{
    const char *base = getenv("TMPDIR");
    const int n = snprintf(path, TEMPORARY_SIZE, "%s/%s-XXXXXX",
                           base != NULL && *base != '\0' ? base : "/tmp", name);

    temporary_made(n > 0 && n < TEMPORARY_SIZE, path);
}

static inline void temporary_folder(char *path, const char *name)
{
    temporary_name(path, name);
    temporary_made(mkdtemp(path) != NULL, path);
}

/* Returns a descriptor open for writing, owned by the caller. */
static inline int temporary_file(char *path, const char *name)
{
    int fd;

    temporary_name(path, name);
    fd = mkstemp(path);
    temporary_made(fd >= 0, path);
    return fd;
}

#endif
