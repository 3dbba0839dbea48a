/* test_output.c - tool/output.h, tool/file_out.h: what is in the way of an output, or of its
 * temporary file, stays.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <limits.h>
#include <stddef.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "test.h"
#include "temporary.h"
#include "tool/file_out.h"
#include "tool/output.h"

static char folder[TEMPORARY_SIZE];

/* What has the temporary name of an output is another's, be it a link that somebody laid there: it
 * stays as it is. */
static void test_name_taken(void **state)
{
    char path[256], other[256], taken[300], text[16] = "";
    ted4_output o;
    FILE *f;

    (void)state;
    snprintf(path, sizeof path, "%s/x.ply", folder);
    snprintf(other, sizeof other, "%s/other", folder);
    snprintf(taken, sizeof taken, "%s.%ld.part", path, (long)getpid());
    f = fopen(other, "w");
    assert_non_null(f);
    assert_true(fputs("theirs", f) > 0);
    assert_int_equal(fclose(f), 0);
    assert_int_equal(symlink("other", taken), 0);
    assert_int_equal(ted4_output_open(&o, path), 0);
    assert_true(fputs("ours", o.file) > 0);
    assert_int_equal(ted4_output_close(&o), 0);
    f = fopen(other, "r");
    assert_non_null(f);
    assert_non_null(fgets(text, sizeof text, f));
    fclose(f);
    assert_string_equal(text, "theirs");
    assert_int_equal(remove(path) | remove(other) | remove(taken), 0);
}

/* A name as long as a file may have, of letters of three bytes. The temporary one is whole letters
 * too. A longer name is refused at once. */
static void test_long_name(void **state)
{
    char path[600];
    int n = snprintf(path, sizeof path, "%s/", folder);
    ted4_output o;
    struct stat s;

    (void)state;
    for (int i = 0; i < NAME_MAX / 3; i++)
        n += snprintf(path + n, sizeof path - (size_t)n, "\xe5\xad\x97");
    assert_int_equal(ted4_output_open(&o, path), 0);

    const char *const end = strchr(o.temporary + strlen(folder), '.');

    assert_int_equal((size_t)(end - o.temporary - (ptrdiff_t)strlen(folder) - 1) % 3, 0);
    assert_int_equal(ted4_output_close(&o), 0);
    assert_int_equal(stat(path, &s), 0);
    assert_int_equal(remove(path), 0);
    strcat(path, "x");
    assert_int_equal(ted4_output_open(&o, path), -1);
    assert_int_equal(errno, ENAMETOOLONG);
    assert_int_equal(ted4_output_open_new(&o, path), -1);
    assert_int_equal(errno, ENAMETOOLONG);
}

/* A pipe, as a device or a folder, is not replaced by a file. */
static void test_no_file(void **state)
{
    char path[256];
    ted4_output o;
    struct stat s;

    (void)state;
    snprintf(path, sizeof path, "%s/x.ply", folder);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(ted4_output_open(&o, path), -1);
    assert_int_equal(errno, EOPNOTSUPP);
    assert_int_equal(lstat(path, &s), 0);
    assert_true(S_ISFIFO(s.st_mode));
    assert_int_equal(remove(path), 0);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(ted4_output_open(&o, path), -1);
    assert_int_equal(errno, EISDIR);
    assert_int_equal(rmdir(path), 0);
}

static void make(const char *path, const char *text)
{
    FILE *const f = fopen(path, "w");

    assert_non_null(f);
    assert_true(fputs(text, f) > 0);
    assert_int_equal(fclose(f), 0);
}

/* Asserts that the file has this text, and removes it. */
static void expect_text(const char *path, const char *want)
{
    char text[16] = "";
    FILE *const f = fopen(path, "r");

    assert_non_null(f);
    assert_non_null(fgets(text, sizeof text, f));
    fclose(f);
    assert_string_equal(text, want);
    assert_int_equal(remove(path), 0);
}

/* link of the system, which fails with this number unless it is 0. */
static int unlinked;

int __real_link(const char *from, const char *to);
int __wrap_link(const char *from, const char *to);

int __wrap_link(const char *from, const char *to)
{
    errno = unlinked;
    return unlinked != 0 ? -1 : __real_link(from, to);
}

/* A new file replaces nothing, be it that it appears while the new one is written, or a link that
 * leads nowhere; on file systems without links, too. */
static void test_new(void **state)
{
    static const int systems[] = { 0, EPERM, EOPNOTSUPP, ENOSYS };
    char path[256];
    ted4_output o;

    (void)state;
    snprintf(path, sizeof path, "%s/x.ted4", folder);
    for (size_t i = 0; i < sizeof systems / sizeof systems[0]; i++) {
        unlinked = systems[i];
        assert_int_equal(ted4_output_open_new(&o, path), 0);
        assert_true(fputs("ours", o.file) > 0);
        assert_int_equal(ted4_output_close(&o), 0);
        assert_int_equal(ted4_output_exists(o.temporary), 0);
        assert_int_equal(ted4_output_open_new(&o, path), -1);
        assert_int_equal(errno, EEXIST);
        expect_text(path, "ours");
        assert_int_equal(ted4_output_open_new(&o, path), 0);
        make(path, "theirs");
        assert_int_equal(ted4_output_close(&o), -1);
        assert_int_equal(errno, EEXIST);
        expect_text(path, "theirs");
        assert_int_equal(ted4_output_open_new(&o, path), 0);
        assert_int_equal(symlink("nowhere", path), 0);
        assert_int_equal(ted4_output_keep(&o), -1);
        assert_int_equal(errno, EEXIST);
        assert_int_equal(ted4_output_open_new(&o, path), -1);
        assert_int_equal(errno, EEXIST);
        assert_int_equal(remove(path), 0);
    }
    unlinked = 0;
}

/* What has taken long to make gets a name beside the one that is taken, and the message says it. */
static void test_kept_beside(void **state)
{
    char path[256], beside[2][300], why[1024];

    (void)state;
    snprintf(path, sizeof path, "%s/x.ted4", folder);
    snprintf(beside[0], sizeof beside[0], "%s/x.%ld.ted4", folder, (long)getpid());
    snprintf(beside[1], sizeof beside[1], "%s/x.%ld-1.ted4", folder, (long)getpid());
    make(path, "theirs");
    assert_int_equal(ted4_file_write(path, 0, "ours", 4, why, sizeof why), -1);
    assert_non_null(strstr(why, "x.ted4: exists; -f overwrites"));
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ted4_file_keep(path, 0, "ours", 4, why, sizeof why), -1);
        assert_memory_equal(why, beside[i], strlen(beside[i]));
    }
    expect_text(beside[0], "ours");
    expect_text(beside[1], "ours");
    assert_int_equal(ted4_file_keep(path, 1, "ours", 4, why, sizeof why), 0);
    expect_text(path, "ours");
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(ted4_file_keep(path, 1, "ours", 4, why, sizeof why), -1);
    expect_text(beside[0], "ours");
    assert_int_equal(rmdir(path), 0);
    snprintf(path, sizeof path, "%s/none/x.ted4", folder);
    assert_int_equal(ted4_file_keep(path, 0, "ours", 4, why, sizeof why), -1);
    assert_non_null(strstr(why, "none/x.ted4: No such file or directory"));
}

/* fsync of the system, which fails with this number unless it is 0. */
static int sync_fails, synced;

int __wrap_fsync(int file);

int __wrap_fsync(int file)
{
    synced += file > 2;
    errno = sync_fails;
    return sync_fails != 0 ? -1 : 0;
}

/* Keeps a file of some letters at path, where fsync fails with error. Returns what
 * ted4_output_keep returns, with its errno. */
static int keep(const char *path, int error)
{
    ted4_output o;

    sync_fails = error;
    synced = 0;
    assert_int_equal(ted4_output_open(&o, path), 0);
    assert_true(fputs("new", o.file) > 0);
    return ted4_output_keep(&o);
}

/* A file that is kept is on the medium before it has its name; where the file system cannot say so,
 * it is kept all the same, and where the medium fails, what was there stays. */
static void test_keep(void **state)
{
    char path[256], text[16] = "";
    ted4_output o;
    FILE *f;

    (void)state;
    synced = 0;
    snprintf(path, sizeof path, "%s/x.ted4", folder);
    assert_int_equal(ted4_output_open(&o, path), 0);
    assert_true(fputs("old", o.file) > 0);
    assert_int_equal(ted4_output_close(&o), 0);
    assert_int_equal(synced, 0);
    assert_int_equal(keep(path, EIO), -1);
    assert_int_equal(errno, EIO);
    f = fopen(path, "r");
    assert_non_null(f);
    assert_non_null(fgets(text, sizeof text, f));
    fclose(f);
    assert_string_equal(text, "old");
    assert_int_equal(keep(path, EINVAL), 0);
    assert_int_equal(keep(path, 0), 0);
    assert_int_equal(synced, 1);
    assert_int_equal(remove(path), 0);
}

static int folder_make(void **state)
{
    (void)state;
    temporary_folder(folder, "ted4-output");
    return 0;
}

static int folder_remove(void **state)
{
    (void)state;
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_name_taken),  cmocka_unit_test(test_long_name),
        cmocka_unit_test(test_no_file),     cmocka_unit_test(test_new),
        cmocka_unit_test(test_kept_beside), cmocka_unit_test(test_keep)
    };

    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
