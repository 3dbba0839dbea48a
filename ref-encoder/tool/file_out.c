/* file_out.c - see file_out.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "file_out.h"

#include <errno.h>
#include <libgen.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { NAME_SIZE = 4096 };

int ted4_file_writable(const char *path, int force, char *why, size_t why_size)
{
    char name[NAME_SIZE];

    if (snprintf(name, sizeof name, "%s", path) >= (int)sizeof name) {
        snprintf(why, why_size, "%.60s...: name too long", path);
        return -1;
    }
    if (!force && access(path, F_OK) == 0) {
        snprintf(why, why_size, "%s: exists; -f overwrites", path);
        return -1;
    }
    const char *folder = dirname(name);

    if (access(folder, W_OK) != 0) {
        snprintf(why, why_size, "%s: %s", folder, strerror(errno));
        return -1;
    }
    return 0;
}

int ted4_file_write(const char *path, const void *data, size_t size, char *why,
                    size_t why_size)
{
    char  name[NAME_SIZE];
    FILE *f;

    if (snprintf(name, sizeof name, "%s.part", path) >= (int)sizeof name) {
        snprintf(why, why_size, "%.60s...: name too long", path);
        return -1;
    }
    f = fopen(name, "wb");
    if (f == NULL) {
        snprintf(why, why_size, "%s: %s", name, strerror(errno));
        return -1;
    }
    int bad = fwrite(data, 1, size, f) != size || fflush(f) != 0 || fsync(fileno(f)) != 0;

    bad |= fclose(f) != 0;
    if (bad || rename(name, path) != 0) {
        snprintf(why, why_size, "%s: %s", path, strerror(errno));
        remove(name);
        return -1;
    }
    return 0;
}
