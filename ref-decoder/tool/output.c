/* output.c - see output.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#define _XOPEN_SOURCE 700 /* realpath() */
#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "leftovers.h"

/* Temporary names that are tried. A process that was killed leaves one with its number, and so may
 * one of another machine or container that writes to the same folder. */
enum { MOST_NAMES = 100 };

/* Bytes of a name that its temporary name begins with: with a number and an ending, they stay below
 * the 255 that file systems allow. */
enum { MOST_LETTERS = 200 };

/* n: what snprintf gave for a buffer of TED4_PATH_SIZE. Returns 0, or -1 with errno set if it is
 * too small. */
static int fits(int n)
{
    if (n >= 0 && n < TED4_PATH_SIZE)
        return 0;
    errno = ENAMETOOLONG;
    return -1;
}

int ted4_output_kept(const char *path)
{
    const char *const slash = strrchr(path, '/');
    const size_t folder = slash != NULL ? (size_t)(slash + 1 - path) : 0;
    size_t n = strlen(path + folder);

    if (n > MOST_LETTERS) {
        n = MOST_LETTERS;
        while (n > 1 && ((unsigned char)path[folder + n] & 0xc0) == 0x80)
            n--;
    }
    return (int)(folder + n);
}

/* Makes a temporary name for path: the first one, or another if number is above 0. Returns 0, or -1
 * with errno set if it is too long. */
static int name_temporary(char out[TED4_PATH_SIZE], const char *path, int number)
{
    const long process = (long)getpid();
    const int n = ted4_output_kept(path);

    return fits(number == 0
                    ? snprintf(out, TED4_PATH_SIZE, "%.*s.%ld.part", n, path, process)
                    : snprintf(out, TED4_PATH_SIZE, "%.*s.%ld-%d.part", n, path, process, number));
}

/* Finds the place of a file: where links at path lead if there is something, otherwise path.
 * Returns 0, or -1 with errno set. */
static int find_place(char place[TED4_PATH_SIZE], const char *path)
{
    char *const real = realpath(path, NULL);
    const int n = snprintf(place, TED4_PATH_SIZE, "%s", real != NULL ? real : path);

    free(real);
    return fits(n);
}

/* Creates a file that will replace the one at place, with the same mode, if replaces is set. What
 * has its name is another's, or a link to what is, and stays. Returns NULL with errno set if it
 * cannot be created. */
static FILE *create(const char *temporary, int replaces, mode_t mode)
{
    const int fd = open(temporary, O_WRONLY | O_CREAT | O_EXCL, replaces ? 0600 : 0666);
    FILE *const f = fd < 0 ? NULL : fdopen(fd, "wb");

    if (f != NULL && replaces) {
        (void)fchmod(fd, mode & 0777); /* a file system may have no modes */
    } else if (f == NULL && fd >= 0) {
        const int why = errno;

        close(fd);
        unlink(temporary);
        errno = why;
    }
    return f;
}

/* Opens the temporary file of o->path, with this mode if the file will replace one. Returns 0, or
 * -1 with errno set. */
static int open_temporary(ted4_output *o, int replaces, mode_t mode)
{
    struct stat there;

    /* Otherwise, a name that is too long would be noticed only when the file is complete. */
    if (lstat(o->path, &there) != 0 && errno == ENAMETOOLONG)
        return -1;
    errno = EEXIST;
    for (int i = 0; i < MOST_NAMES && errno == EEXIST; i++) {
        if (name_temporary(o->temporary, o->path, i) != 0)
            return -1;
        ted4_leftovers_add(o->temporary, 0);
        o->file = create(o->temporary, replaces, mode);
        if (o->file != NULL)
            return 0;
        ted4_leftovers_forget(o->temporary);
    }
    return -1;
}

int ted4_output_open(ted4_output *o, const char *path)
{
    struct stat there;

    o->is_new = 0;
    if (find_place(o->path, path) != 0)
        return -1;

    const int replaces = stat(o->path, &there) == 0;

    if (replaces && !S_ISREG(there.st_mode)) {
        errno = S_ISDIR(there.st_mode) ? EISDIR : EOPNOTSUPP;
        return -1;
    }
    return open_temporary(o, replaces, replaces ? there.st_mode : 0);
}

int ted4_output_exists(const char *path)
{
    struct stat there;

    return lstat(path, &there) == 0;
}

int ted4_output_open_new(ted4_output *o, const char *path)
{
    o->is_new = 1;
    if (ted4_output_exists(path)) {
        errno = EEXIST;
        return -1;
    }
    if (fits(snprintf(o->path, TED4_PATH_SIZE, "%s", path)) != 0)
        return -1;
    return open_temporary(o, 0, 0);
}

static void discard(const char *temporary)
{
    remove(temporary);
    ted4_leftovers_forget(temporary);
}

void ted4_output_cancel(ted4_output *o)
{
    const int why = errno;

    fclose(o->file);
    discard(o->temporary);
    errno = why;
}

/* Gives the temporary file its name. A link replaces nothing; where the file system has none, a
 * file that appears in the moment before the renaming is replaced. Returns 0, or -1 with errno
 * set. */
static int give_name(const ted4_output *o)
{
    if (o->is_new) {
        if (link(o->temporary, o->path) == 0) {
            unlink(o->temporary);
            return 0;
        }
        if (errno == EEXIST)
            return -1;
        if (ted4_output_exists(o->path)) {
            errno = EEXIST;
            return -1;
        }
    }
    return rename(o->temporary, o->path);
}

int ted4_output_close(ted4_output *o)
{
    if (fflush(o->file) != 0 || ferror(o->file)) {
        if (errno == 0)
            errno = EIO;
        ted4_output_cancel(o);
        return -1;
    }
    if (fclose(o->file) == 0 && give_name(o) == 0) {
        ted4_leftovers_forget(o->temporary);
        return 0;
    }
    const int why = errno;

    discard(o->temporary);
    errno = why;
    return -1;
}

int ted4_output_keep(ted4_output *o)
{
    const int n = fflush(o->file) == 0 ? fsync(fileno(o->file)) : 0;

    /* Some file systems cannot do it. What fflush met is kept for ted4_output_close. */
    if (n == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS)
        return ted4_output_close(o);
    ted4_output_cancel(o);
    return -1;
}

int ted4_output_is_stdout(const char *path)
{
    return strcmp(path, "-") == 0;
}

int ted4_has_suffix(const char *path, const char *suffix)
{
    const size_t n = strlen(path), m = strlen(suffix);

    return n > m && strcasecmp(path + n - m, suffix) == 0;
}

/* Finds the conversion. Returns the number of conversions (0 or 1), or -1 if the pattern is
 * invalid. */
static int find_conversion(const char *pattern, size_t *at, size_t *length, int *zero, int *width)
{
    int found = 0;

    for (size_t i = 0; pattern[i] != '\0'; i++) {
        size_t k = i + 1;

        if (pattern[i] != '%')
            continue;
        *at = i;
        *zero = pattern[k] == '0';
        *width = 0;
        k += (size_t)*zero;
        if (pattern[k] >= '1' && pattern[k] <= '9')
            *width = pattern[k++] - '0';
        if (pattern[k] != 'd' || (*zero && *width == 0) || ++found > 1)
            return -1;
        *length = k + 1 - i;
        i = k;
    }
    return found;
}

int ted4_pattern_count(const char *pattern)
{
    size_t at, length;
    int zero, width;

    return find_conversion(pattern, &at, &length, &zero, &width);
}

int ted4_pattern_make(char out[TED4_PATH_SIZE], const char *pattern, uint32_t number)
{
    size_t at = 0, length = 0;
    int zero = 0, width = 0, n;

    if (find_conversion(pattern, &at, &length, &zero, &width) == 1) {
        char digits[16];

        snprintf(digits, sizeof digits, zero ? "%0*" PRIu32 : "%*" PRIu32, width, number);
        n = snprintf(out, TED4_PATH_SIZE, "%.*s%s%s", (int)at, pattern, digits,
                     pattern + at + length);
    } else {
        n = snprintf(out, TED4_PATH_SIZE, "%s", pattern);
    }
    return fits(n);
}
