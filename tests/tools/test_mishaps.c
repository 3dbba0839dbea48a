/* test_mishaps.c - ted4enc as a program that is killed, or whose disk is full: one line on standard
 * error gives the reason, the exit status is 3, no partly written file remains, and the last
 * checkpoint leads to the same bytes as a run without disturbance. For pictures and values see
 * test_mishaps_scene.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "mishap.h"
#include "random_source.h"

/* ---- kill -9 ---- */

/* A program that is killed while it tests whether it can write, or while it writes its last file,
 * leaves a file with its process number in the name. */
static void remove_leftovers(pid_t child)
{
    static const char *const outputs[] = { "x", "c", "l" };
    char name[64];

    for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; i++) {
        snprintf(name, sizeof name, "out/%s.%ld.part", outputs[i], (long)child);
        if (is_there(name))
            gone(name);
    }
}

/* Returns whether the checkpoint differs from *old, which it then replaces. */
static int is_new(ball_file *old)
{
    ball_file now = is_there("out/c") ? read_file("out/c") : (ball_file) { calloc(1, 1), 0 };
    const int same = now.size == old->size && memcmp(now.bytes, old->bytes, now.size) == 0;

    free(old->bytes);
    *old = now;
    return !same;
}

/* Kills the program again and again, after varying times, until it has resumed from enough
 * checkpoints. The time adapts to the machine: it shrinks if the program ended before it was
 * killed, and then starts from the beginning, and grows if there was no new checkpoint yet. */
static void kill_again(const char *options, const outcome *want, int enough)
{
    enum { MOST_LIVES = 200 };
    ball_file last = { calloc(1, 1), 0 };
    random_source r = random_seed(1);
    long longest = 400000;
    int killed = 0;
    char arguments[256];

    snprintf(arguments, sizeof arguments,
             "-o out/x.ted4 --checkpoint out/c --log out/l --resume %s", options);
    for (int life = 0; killed < enough && life < MOST_LIVES; life++) {
        const pid_t child = start(arguments, 0);

        pause_us((long)((double)longest * random_unit(&r)));
        kill(child, SIGKILL);
        const int status = finish(child);
        remove_leftovers(child);
        if (status == 0) {
            expect_same("out/x.ted4", &want->file);
            expect_log("out/l", want->log);
            gone("out/c");
            (void)is_new(&last);
            longest /= 2;
        } else {
            assert_int_equal(status, 1000 + SIGKILL);
            if (is_new(&last))
                killed++;
            else
                longest += longest / 2;
        }
    }
    free(last.bytes);
    assert_int_equal(killed, enough);
}

/* Kills the program several times, then lets it run to its end: file and log are those of a run
 * without disturbance, whose log contains that. */
static void expect_survival(const char *options, int kills, const char *that)
{
    char arguments[256];
    outcome want;

    begin_test();
    want = make_outcome(options);
    assert_non_null(strstr(want.log, that));
    kill_again(options, &want, kills);
    snprintf(arguments, sizeof arguments, "--checkpoint out/c --log out/l --resume %s", options);
    run_calmly(arguments);
    expect_same("out/x.ted4", &want.file);
    expect_log("out/l", want.log);
    gone("out/c");
    free(want.file.bytes);
}

static void test_killed(void **state)
{
    (void)state;
    expect_survival("--iterations 130,70", 6, "\"step\":");
}

/* Includes what the presets do besides training: the probe, and trials of smaller models. */
static void test_killed_deciding(void **state)
{
    (void)state;
    expect_survival("--iterations 1000,200 --set probe=0.2 --set capacity=1", 4,
                    "\"event\":\"capacity\"");
}

/* ---- a full disk ---- */

static void test_full_checkpoint(void **state)
{
    (void)state;
    begin_test();
    make_checkpoint();

    ball_file before = read_file("out/c"), after;

    assert_int_equal(run("-o out/x.ted4 --checkpoint out/c --resume", 20000), 3);
    expect_words("out/c: File too large");
    expect_files("c");
    after = read_file("out/c");
    ball_check_same(&before, &after);
    free(before.bytes);
    free(after.bytes);
    resume_to_reference();
}

static void test_full_output(void **state)
{
    (void)state;
    begin_test();
    assert_int_equal(run("-o out/x.ted4", 1000), 3);
    expect_words("out/x.ted4: File too large");
    expect_files("");
    assert_int_equal(run("-o out/x.ted4 --stage1 out/s", 1000), 3);
    expect_words("out/s: File too large");
    expect_files("");
}

/* The second line of the log does not fit. */
static void test_full_log(void **state)
{
    char text[MOST_LOG];
    const char *end = strchr(reference.log, '\n') + 1;

    (void)state;
    begin_test();
    assert_int_equal(run("-o out/x.ted4 --log out/l", (rlim_t)(end - reference.log) + 200), 3);
    expect_words("out/l: ");
    expect_files("l");
    read_text("out/l", text, sizeof text);
    assert_non_null(strchr(text, '\n'));
    assert_string_equal(strchr(text, '\n'), "\n");
    gone("out/l");
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(run("-o out/x.ted4 --log /dev/full", 0), 3);
        expect_words("/dev/full: No space left on device");
        expect_files("");
    }
}

/* The disk becomes full while frames of a video are unpacked: the message of ffmpeg is passed on,
 * and its frames are removed. */
static void test_full_video_cache(void **state)
{
    static const char *const failing[] = {
        "printf x >000001.png; echo 'No space left on device' >&2; exit 1",
        "echo 'No space left on device' >&2; kill -9 $$"
    };
    const ted4_dataset_options o = { .downscale = 1, .seed = 3, .cache_bytes = 1 << 20 };
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_message m;
    tiny_string script = { "", 0 };
    char *path = ted4_text_copy(getenv("PATH"));

    (void)state;
    must(path != NULL, "PATH");
    setenv("XDG_CACHE_HOME", tiny_path(&f, "cache"), 1);
    tiny_bytes(&f, "one.mp4",
               "\0\0\0\x18"
               "ftypmp42",
               12);
    tiny_text(&f, "cams.json",
              "{\"cameras\": [{\"name\": \"one\", \"w\": 16, \"h\": 12, \"K\": "
              "[[9,0,8],[0,9,6],[0,0,1]], \"w2c\": " TINY_POSE "}]}");
    for (size_t i = 0; i < sizeof failing / sizeof failing[0]; i++) {
        script.n = 0;
        tiny_add(&script, "#!/bin/sh\n%s\n", failing[i]);
        tiny_text(&f, "bin/ffmpeg", script.text);
        must(chmod(tiny_path(&f, "bin/ffmpeg"), 0700) == 0, "ffmpeg");
        setenv("PATH", tiny_path(&f, "bin"), 1);
        assert_int_equal(ted4_dataset_load(&d, f.path, &o, &m), -1);
        setenv("PATH", path, 1);
        if (strstr(m.text, "one.mp4: ffmpeg") == NULL ||
            strstr(m.text, "No space left on device") == NULL)
            fail_msg("%s", m.text);
        assert_int_equal(rmdir(tiny_path(&f, "cache/ted4")), 0); /* it is empty */
    }
    unsetenv("XDG_CACHE_HOME");
    free(path);
    tiny_free(&f);
}

static void test_full_stdout(void **state)
{
    (void)state;
    begin_test();
    if (access("/dev/full", W_OK) != 0) {
        print_message("skipped: no /dev/full\n");
        skip();
    }

    const int out = dup(STDOUT_FILENO), full = open("/dev/full", O_WRONLY);

    fflush(stdout);
    assert_true(out >= 0);
    assert_true(full >= 0);
    assert_true(dup2(full, STDOUT_FILENO) >= 0);
    const int status = run("-o out/x.ted4 --json", 0), checked = run("--check", 0);
    assert_true(dup2(out, STDOUT_FILENO) >= 0);
    close(out);
    close(full);
    assert_int_equal(status, 3);
    assert_int_equal(checked, 3);
    expect_words("standard output: No space left on device");
    gone("out/x.ted4");
}

/* Whoever read standard output has ended: what is printed there is lost, which is an error. */
static void test_closed_stdout(void **state)
{
    int ends[2], status;

    (void)state;
    begin_test();
    fflush(stdout);
    assert_int_equal(pipe(ends), 0);
    close(ends[0]);

    const int out = dup(STDOUT_FILENO);

    assert_true(out >= 0);
    assert_true(dup2(ends[1], STDOUT_FILENO) >= 0);
    close(ends[1]);
    status = run("--check", 0);
    assert_true(dup2(out, STDOUT_FILENO) >= 0);
    close(out);
    assert_int_equal(status, 3);
    expect_words("standard output: Broken pipe");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_killed),          cmocka_unit_test(test_killed_deciding),
        cmocka_unit_test(test_full_checkpoint), cmocka_unit_test(test_full_output),
        cmocka_unit_test(test_full_log),        cmocka_unit_test(test_full_video_cache),
        cmocka_unit_test(test_full_stdout),     cmocka_unit_test(test_closed_stdout),
    };

    return cmocka_run_group_tests_name("kill and full disk", tests, set_up, tear_down);
}
