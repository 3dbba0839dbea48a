/* file_out.c - see file_out.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "file_out.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAME_SIZE = 4096 };

static int temporary_name(char name[NAME_SIZE], const char *path, char *why, size_t why_size)
{
    if (snprintf(name, NAME_SIZE, "%s.part", path) < NAME_SIZE)
        return 0;
    snprintf(why, why_size, "%.60s...: name too long", path);
    return -1;
}

/* Permissions do not tell all (root, /proc, full file systems), so the temporary file is made and removed again. One that is there
 * already is of a run that was killed: nobody needs it. */
int ted4_file_writable(const char *path, int force, char *why, size_t why_size)
{
    char        name[NAME_SIZE];
    struct stat there;
    FILE       *f;

    if (path[0] == '\0') {
        snprintf(why, why_size, "the output's name is empty");
        return -1;
    }
    if (temporary_name(name, path, why, why_size) != 0)
        return -1;
    if (stat(path, &there) == 0) {
        if (S_ISDIR(there.st_mode)) {
            snprintf(why, why_size, "%s: is a folder, expected a file name", path);
            return -1;
        }
        if (!force) {
            snprintf(why, why_size, "%s: exists; -f overwrites", path);
            return -1;
        }
    }
    f = fopen(name, "wb");
    if (f == NULL) {
        snprintf(why, why_size, "%s: cannot be written: %s", path, strerror(errno));
        return -1;
    }
    fclose(f);
    remove(name);
    return 0;
}

int ted4_file_write(const char *path, const void *data, size_t size, char *why,
                    size_t why_size)
{
    char  name[NAME_SIZE];
    FILE *f;

    if (temporary_name(name, path, why, why_size) != 0)
        return -1;
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
