/* file_out.c - see file_out.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "file_out.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "tool/json_string.h"
#include "tool/output.h"

/* Permissions alone do not tell whether a file can be written (root, /proc, full file systems), so
 * the temporary file is created and removed again. */
int ted4_file_writable(const char *path, int force, const char *instead, char *why, size_t why_size)
{
    ted4_output o;
    struct stat there;

    if (path[0] == '\0') {
        snprintf(why, why_size, "the output's name is empty");
        return -1;
    }
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode)) {
        snprintf(why, why_size, "%s: is %s, expected a file name", path,
                 S_ISDIR(there.st_mode) ? "a folder" : "a pipe or a device");
        return -1;
    }
    if (!force && ted4_output_exists(path)) {
        snprintf(why, why_size, "%s: exists; %s-f overwrites", path, instead);
        return -1;
    }
    if (ted4_output_open(&o, path) != 0) {
        snprintf(why, why_size, "%.*s: cannot be written: %s", ted4_whole_letters(path, 200), path,
                 strerror(errno));
        return -1;
    }
    ted4_output_cancel(&o);
    return 0;
}

int ted4_file_write(const char *path, const void *data, size_t size, char *why, size_t why_size)
{
    ted4_output o;
    int bad = ted4_output_open(&o, path) != 0;

    if (!bad) {
        fwrite(data, 1, size, o.file);
        bad = ted4_output_keep(&o) != 0;
    }
    if (bad)
        snprintf(why, why_size, "%s: %s", path, strerror(errno));
    return bad ? -1 : 0;
}
