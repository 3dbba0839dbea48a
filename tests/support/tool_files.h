/* tool_files.h - the programs run as users run them, in a folder with three random files. Looks for
 * them in $TED4_BUILD (set by tests/run.sh).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_FILES_H
#define TED4_TOOL_FILES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test.h"
#include "random_scene.h"
#include "temporary.h"

enum { MAX_TEXT = 1 << 16, PATH_SIZE = TEMPORARY_SIZE + 128 };

static char folder[TEMPORARY_SIZE];
static const char *build;

/* a file for each kind of view input, none, colour, full: name, and what it holds. */
static struct {
    ted4_info info;
    ted4_recon *recon;
} file[3];

static char out[MAX_TEXT]; /* standard output of the last program */

/* Runs a program in the folder; returns its exit code. */
static inline int run(const char *format, ...)
{
    char command[8192];
    va_list ap;
    int n = snprintf(command, sizeof command, "cd '%s' && PATH='%s':\"$PATH\" && exec 2>err && ",
                     folder, build);

    va_start(ap, format);
    n += vsnprintf(command + n, sizeof command - (size_t)n, format, ap);
    va_end(ap);
    assert_true(n < (int)sizeof command);
    FILE *const f = popen(command, "r");
    assert_non_null(f);
    out[fread(out, 1, sizeof out - 1, f)] = '\0';
    const int status = pclose(f);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/* Returns the folder from which the test was started, the project's root. */
static inline const char *root(void)
{
    static char path[1024];

    assert_non_null(getcwd(path, sizeof path));
    return path;
}

static inline void path_of(char path[PATH_SIZE], const char *name)
{
    snprintf(path, PATH_SIZE, "%s/%s", folder, name);
}

static inline uint8_t *contents(const char *name, size_t *size)
{
    uint8_t *const data = malloc(1 << 22);
    char path[PATH_SIZE];

    path_of(path, name);
    FILE *const f = fopen(path, "rb");
    assert_non_null(f);
    assert_non_null(data);
    *size = fread(data, 1, 1 << 22, f);
    fclose(f);
    return data;
}

static inline size_t size_of(const char *name)
{
    size_t size;

    free(contents(name, &size));
    return size;
}

static inline void write_contents(const char *name, const void *data, size_t size)
{
    char path[PATH_SIZE];

    path_of(path, name);
    FILE *const f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
}

static inline int exists(const char *name)
{
    char path[PATH_SIZE];

    path_of(path, name);
    return access(path, F_OK) == 0;
}

/* The first random scene with that view input and a few frames, as vN.ted4, and opened by the
 * library. */
static inline void make_file(int view)
{
    for (uint64_t seed = 0; seed < 1000; seed++) {
        ted4_scene *s = random_scene(seed);
        uint8_t *data;
        size_t size;
        char name[16];

        assert_non_null(s);
        if (s->head.view != view || s->head.n_anchors < 50 || s->head.frames < 3 ||
            s->head.frames > 60 || abs(s->head.exponent) > 12) {
            ted4_scene_free(s);
            continue;
        }
        assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
        ted4_scene_free(s);
        snprintf(name, sizeof name, "v%d.ted4", view);
        write_contents(name, data, size);
        assert_int_equal(ted4_decode(data, size, NULL, &s, &(ted4_error) { TED4_OK, 0 }), TED4_OK);
        ted4_scene_info(s, &file[view].info);
        assert_int_equal(ted4_recon_new(&file[view].recon, s, NULL), TED4_OK);
        ted4_scene_free(s);
        free(data);
        return;
    }
    fail();
}

static inline int setup(void **state)
{
    (void)state;
    build = getenv("TED4_BUILD");
    if (build == NULL)
        return 0;
    temporary_folder(folder, "ted4-tools");
    for (int view = 0; view < 3; view++)
        make_file(view);
    return 0;
}

static inline int teardown(void **state)
{
    (void)state;
    if (build == NULL)
        return 0;
    for (int view = 0; view < 3; view++)
        ted4_recon_free(file[view].recon);
    return run("rm -rf '%s'", folder);
}

static inline void need_programs(void)
{
    if (build == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        skip();
    }
}

#endif
