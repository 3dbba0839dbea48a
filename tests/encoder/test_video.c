/* test_video.c - videos that are unpacked, by programs that stand in for ffmpeg: what is missing,
 * damaged, unfinished or left over.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "test.h"
#include "data/video.h"
#include "data/video_folder.h"
#include "tiny_scene.h"
#include "tool/leftovers.h"

/* Puts a program in place of ffmpeg, which works in the folder of the frames. */
static void fake_ffmpeg(const tiny_folder *f, const char *commands)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "#!/bin/sh\n%s\n", commands);
    tiny_text(f, "bin/ffmpeg", s.text);
    must(chmod(tiny_path(f, "bin/ffmpeg"), 0700) == 0, "chmod");
}

/* Returns whether folder/name is there. */
static int has(const char *folder, const char *name)
{
    char path[1400];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

/* Unpacks f/a.gif, and returns whether that went well. folder: that of the frames, or as before. */
static int unpacked(const tiny_folder *f, char folder[1200])
{
    ted4_message m;
    char *const at = ted4_video_unpack(tiny_path(f, "a.gif"), 0, NULL, &m);

    if (at != NULL)
        snprintf(folder, 1200, "%s", at);
    free(at);
    return at != NULL;
}

/* A folder that lacks a frame stays until all frames of another can take its place; and one that
 * another program has completed in the meantime stays as it is. */
static void test_unpacked_twice(void **state)
{
    static const char good[] = "echo 1 >000001.png; echo 2 >000002.png";
    static const char other[] =
        "to=${PWD%.*}; rm -r \"$to\"; mkdir \"$to\"; cd \"$to\"\n"
        "echo 1 >000001.png; : >theirs; echo 1 >count; echo 1 >\"$OLDPWD/000001.png\"";
    tiny_folder f = tiny_new();
    char folder[1200], path[1400];
    char *const programs = strdup(getenv("PATH"));

    (void)state;
    snprintf(path, sizeof path, "%s:%s", tiny_path(&f, "bin"), programs);
    setenv("PATH", path, 1);
    setenv("XDG_CACHE_HOME", tiny_path(&f, "cache"), 1);
    tiny_text(&f, "a.gif", "GIF89a");
    fake_ffmpeg(&f, good);
    assert_true(unpacked(&f, folder));
    snprintf(path, sizeof path, "%s/000001.png", folder);
    must(remove(path) == 0, path);
    fake_ffmpeg(&f, "echo broken >&2; exit 1");
    assert_false(unpacked(&f, folder));
    assert_true(has(folder, "000002.png"));
    fake_ffmpeg(&f, good);
    assert_true(unpacked(&f, folder));
    assert_true(has(folder, "000001.png"));
    must(remove(path) == 0, path);
    fake_ffmpeg(&f, other);
    assert_true(unpacked(&f, folder));
    assert_true(has(folder, "theirs"));
    assert_false(has(folder, "000002.png"));
    /* A frame without bytes, as a crash of the machine may leave it, is none. */
    fake_ffmpeg(&f, good);
    snprintf(path, sizeof path, "%s/000001.png", folder);
    must(truncate(path, 0) == 0, path);
    assert_true(unpacked(&f, folder));
    assert_true(has(folder, "000002.png"));
    /* ffmpeg goes on after errors, and then frames are missing or made up. */
    tiny_text(&f, "a.gif", "GIF89a2");
    fake_ffmpeg(&f, "echo x >000001.png; echo damaged >&2");
    assert_false(unpacked(&f, folder));
    setenv("PATH", programs, 1);
    unsetenv("XDG_CACHE_HOME");
    free(programs);
    tiny_free(&f);
}

/* Makes a folder of the cache with a file in it, as old as that many seconds. */
static void old_folder(const tiny_folder *f, const char *name, time_t seconds)
{
    char file[200];
    struct timespec at[2] = { { 0, UTIME_OMIT }, { 0, 0 } };

    at[1].tv_sec = time(NULL) - seconds;
    snprintf(file, sizeof file, "cache/ted4/%s/000001.png", name);
    tiny_text(f, file, "x");
    *strrchr(file, '/') = 0;
    must(utimensat(AT_FDCWD, tiny_path(f, file), at, 0) == 0, file);
}

/* What killed programs left goes: folders with a name of their own that nobody holds any more. */
static void test_sweep(void **state)
{
    static const struct {
        const char *name;
        time_t age;
        int locked, stays;
    } cases[] = {
        { "a.mp4-0123456789abcdef.Ab0xyZ", 3600, 0, 0 },
        { "b.mp4-0123456789abcdef.Ab0xyZ", 3600, 1, 1 },
        { "c.mp4-0123456789abcdef.Ab0xyZ", 10, 0, 1 },
        { "d.mp4-0123456789abcdef", 3600, 0, 1 },
        { "e.mp4-0123456789abcdef.notes1.txt", 3600, 0, 1 },
    };
    tiny_folder f = tiny_new();
    int locks[5];

    (void)state;
    for (size_t i = 0; i < 5; i++) {
        char path[1400];
        old_folder(&f, cases[i].name, cases[i].age);
        snprintf(path, sizeof path, "%s/%s", tiny_path(&f, "cache/ted4"), cases[i].name);
        locks[i] = cases[i].locked ? open(path, O_RDONLY) : -1;
        assert_true(locks[i] < 0 || flock(locks[i], LOCK_EX) == 0);
    }
    ted4_video_folder_sweep(tiny_path(&f, "cache/ted4"));
    for (size_t i = 0; i < 5; i++) {
        assert_int_equal(has(tiny_path(&f, "cache/ted4"), cases[i].name), cases[i].stays);
        if (locks[i] >= 0)
            close(locks[i]);
    }
    tiny_free(&f);
}

#ifdef __linux__
/* Returns how many files and folders lie in a folder. */
static int entries(const char *folder)
{
    DIR *const d = opendir(folder);
    int n = -2; /* . and .. */

    must(d != NULL, folder);
    while (readdir(d) != NULL)
        n++;
    closedir(d);
    return n;
}

/* Waits at most ten seconds until the process is gone, or is a zombie that nobody waits for. */
static int is_gone(long process)
{
    char path[64], state[64] = "";

    snprintf(path, sizeof path, "/proc/%ld/stat", process);
    for (int i = 0; i < 1000; i++) {
        FILE *in = fopen(path, "r");
        if (in == NULL)
            return 1;
        if (fscanf(in, "%*d %*s %1s", state) != 1)
            state[0] = 0;
        fclose(in);
        if (state[0] == 'Z')
            return 1;
        nanosleep(&(struct timespec) { 0, 10000000 }, NULL);
    }
    return 0;
}

static void default_signal(int number)
{
    struct sigaction usual;

    memset(&usual, 0, sizeof usual);
    usual.sa_handler = SIG_DFL;
    sigaction(number, &usual, NULL);
}

/* Starts a program that unpacks a video, ends it by a signal while ffmpeg works, and checks that it
 * takes ffmpeg with it. Where a signal can be caught, none of the frames stays either. */
static void end_unpacking(int signal)
{
    tiny_folder f = tiny_new();
    char path[1400], folder[1200];
    char *const programs = strdup(getenv("PATH"));
    long ffmpeg = 0;
    int status;

    snprintf(path, sizeof path, "%s:%s", tiny_path(&f, "bin"), programs);
    setenv("PATH", path, 1);
    setenv("XDG_CACHE_HOME", tiny_path(&f, "cache"), 1);
    tiny_text(&f, "a.gif", "GIF89a");
    snprintf(path, sizeof path,
             "for i in 01 02 03; do echo x >0000$i.png; done; : >count\n"
             "echo $$ >'%s.new'; mv '%s.new' '%s'; exec sleep 600",
             tiny_path(&f, "process"), tiny_path(&f, "process"), tiny_path(&f, "process"));
    fake_ffmpeg(&f, path);
    const pid_t child = fork();
    if (child == 0) {
        default_signal(signal); /* in the background, SIGINT is ignored */
        ted4_leftovers_watch();
        unpacked(&f, folder);
        _exit(0);
    }
    for (int i = 0; i < 1000 && access(tiny_path(&f, "process"), F_OK) != 0; i++)
        nanosleep(&(struct timespec) { 0, 10000000 }, NULL);
    FILE *in = fopen(tiny_path(&f, "process"), "r");
    must(in != NULL && fscanf(in, "%ld", &ffmpeg) == 1, "ffmpeg's number");
    fclose(in);
    must(kill(child, signal) == 0 && waitpid(child, &status, 0) == child, "kill");
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    assert_true(is_gone(ffmpeg));
    assert_int_equal(entries(tiny_path(&f, "cache/ted4")), signal == SIGKILL);
    setenv("PATH", programs, 1);
    unsetenv("XDG_CACHE_HOME");
    free(programs);
    tiny_free(&f);
}

static void test_ended(void **state)
{
    (void)state;
    end_unpacking(SIGKILL);
    end_unpacking(SIGTERM);
    end_unpacking(SIGINT);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unpacked_twice),
        cmocka_unit_test(test_sweep),
#ifdef __linux__
        cmocka_unit_test(test_ended),
#endif
    };

    return cmocka_run_group_tests_name("video", tests, NULL, NULL);
}
