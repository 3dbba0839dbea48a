/* outputs.c - see outputs.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "outputs.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "file_out.h"
#include "tool/output.h"

enum { N_FILES = 4 };

/* A file of the command line. */
typedef struct {
    const char *option, *path; /* NULL: not given */
    int replaces;              /* 1: it may be there */
    const char *instead;       /* as for ted4_file_writable */
} file;

static int is_device(const char *path)
{
    struct stat s;

    return stat(path, &s) == 0 && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode);
}

static int same_inode(const char *a, const char *b)
{
    struct stat s, t;

    return stat(a, &s) == 0 && stat(b, &t) == 0 && s.st_dev == t.st_dev && s.st_ino == t.st_ino;
}

/* Splits a path: returns its last part, with the folder in *folder. */
static const char *split(const char *path, char folder[TED4_PATH_SIZE])
{
    const char *const slash = strrchr(path, '/');

    snprintf(folder, TED4_PATH_SIZE, "%.*s", slash == NULL ? 1 : (int)(slash - path + 1),
             slash == NULL ? "." : path);
    return slash == NULL ? path : slash + 1;
}

/* Are these names of the same file, which may not be there yet? */
static int are_same(const char *a, const char *b)
{
    char folder_a[TED4_PATH_SIZE], folder_b[TED4_PATH_SIZE];

    return same_inode(a, b) ||
           (strcmp(split(a, folder_a), split(b, folder_b)) == 0 && same_inode(folder_a, folder_b));
}

static int check_names(const file f[N_FILES], char *why, size_t why_size)
{
    for (int i = 1; i < N_FILES; i++) {
        for (int j = 0; j < i; j++) {
            if (f[i].path == NULL || f[j].path == NULL || !are_same(f[i].path, f[j].path))
                continue;
            snprintf(why, why_size, "%s and %s: both are %s", f[i].option, f[j].option, f[i].path);
            return -1;
        }
    }
    return 0;
}

int ted4_outputs_check(const ted4_request *r, char *why, size_t why_size)
{
    const int goes_on = r->force || r->resume;
    const file files[N_FILES] = {
        { "-o", r->out, r->force, "" },
        { "--checkpoint", r->checkpoint, goes_on, "--resume goes on from it, " },
        { "--stage1", r->stage1, 1, "" },
        { "--log", r->log == NULL || is_device(r->log) ? NULL : r->log, goes_on,
          "--resume goes on with it, " },
    };

    if (check_names(files, why, why_size) != 0)
        return -1;
    for (int i = 0; i < N_FILES; i++) {
        const file *const f = &files[i];

        if (f->path != NULL &&
            ted4_file_writable(f->path, f->replaces, f->instead, why, why_size) != 0)
            return -1;
    }
    return 0;
}
