/* file_out.c - see file_out.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "file_out.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tool/json_string.h"
#include "tool/output.h"

/* Names that are tried beside one that is taken. */
enum { MOST_NAMES = 100 };

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

/* Returns 0, or -1 with errno set. */
static int put(const char *path, int force, const void *data, size_t size)
{
    ted4_output o;

    if ((force ? ted4_output_open(&o, path) : ted4_output_open_new(&o, path)) != 0)
        return -1;
    fwrite(data, 1, size, o.file);
    return ted4_output_keep(&o);
}

int ted4_file_write(const char *path, int force, const void *data, size_t size, char *why,
                    size_t why_size)
{
    if (put(path, force, data, size) == 0)
        return 0;
    if (!force && errno == EEXIST)
        snprintf(why, why_size, "%s: exists; -f overwrites", path);
    else
        snprintf(why, why_size, "%s: %s", path, strerror(errno));
    return -1;
}

/* Makes the name beside path that holds the number of this process, before the suffix: the first
 * one, or another if n is above 0. */
static void name_beside(char out[TED4_PATH_SIZE], const char *path, int n)
{
    const char *const suffix = strrchr(path, '.');
    const size_t stem = suffix != NULL ? (size_t)(suffix - path) : strlen(path);
    const int kept = ted4_output_kept(path);
    char number[40] = "";

    if (n > 0)
        snprintf(number, sizeof number, "-%d", n);
    snprintf(out, TED4_PATH_SIZE, "%.*s.%ld%s%s", (int)stem < kept ? (int)stem : kept, path,
             (long)getpid(), number, path + stem);
}

int ted4_file_keep(const char *path, int force, const void *data, size_t size, char *why,
                   size_t why_size)
{
    char beside[TED4_PATH_SIZE];
    int error = put(path, force, data, size) == 0 ? 0 : errno;
    const int taken = error == EEXIST || error == EISDIR || error == EOPNOTSUPP;

    if (error == 0)
        return 0;
    for (int i = 0; i < MOST_NAMES && taken && error != 0; i++) {
        name_beside(beside, path, i);
        error = put(beside, 0, data, size) == 0 ? 0 : errno;
        if (error != EEXIST)
            break;
    }
    if (error == 0)
        snprintf(why, why_size, "%s holds the result: %s has been made meanwhile, and stays",
                 beside, path);
    else
        snprintf(why, why_size, "%s: %s", path, strerror(error));
    return -1;
}
