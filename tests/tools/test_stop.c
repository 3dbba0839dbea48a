/* test_stop.c - ted4enc is asked to end by a signal: at any step but the last it reports the step
 * at which it stopped and how to continue, and writes no file; the same command with --resume then
 * writes the same bytes as a run without disturbance. A second signal ends it at once.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "mishap.h"
#include "tool/stop.h"
#include "tool/leftovers.h"

/* A probe at step 300, stage 2 from 1200 on, trials at 1305, the integer stage at 1760. */
static const char *const options[] = {
    "ted4enc",  "scene",         "-o",           "out/x.ted4",       "-f",    "-j1",
    "--preset", "draft",         "--iterations", "1200,700",         "--log", "out/l",
    "--set",    "offsets=4",     "--set",        "feature=8",        "--set", "phi=4",
    "--set",    "bank_dim=8",    "--set",        "deform_width=8",   "--set", "head_width=12",
    "--set",    "hyper_width=8", "--set",        "ar_width=8",       "--set", "slices=2",
    "--set",    "octaves=4",     "--set",        "init_anchors=150", "--set", "max_anchors=260",
    "--set",    "grow_every=20", "--set",        "probe=0.2",        "--set", "activation=0"
};
enum { N_OPTIONS = (int)(sizeof options / sizeof options[0]) };

/* Where standard error of the next child goes; negative: into the file err. */
static int messages = -1;

static pid_t begin(const char *one, const char *two, const char *three)
{
    const char *argv[N_OPTIONS + 6] = { NULL };
    int n = N_OPTIONS;
    char path[1024];
    const pid_t child = fork();

    assert_true(child >= 0);
    if (child > 0)
        return child;
    memcpy(argv, options, sizeof options);
    if (one != NULL && strcmp(one, "--checkpoint") == 0) {
        argv[n++] = "--checkpoint-every";
        argv[n++] = "86400";
    }
    argv[n++] = one;
    argv[n++] = two;
    argv[n] = three;

    const int err = messages >= 0
                        ? messages
                        : open(tiny_path(&folder, "err"), O_WRONLY | O_CREAT | O_TRUNC, 0666);

    snprintf(path, sizeof path, "%s/ted4enc", build);
    if (err < 0 || dup2(err, STDERR_FILENO) < 0 || chdir(folder.path) != 0)
        _exit(100);
    execv(path, (char *const *)(uintptr_t)argv);
    _exit(101);
}

static void read_words(char *text, size_t size)
{
    read_text("err", text, size);
}

/* When to send the signal: when the log has this text; or when the checkpoint was written for the
 * nth time; or, if both are empty, soon after the start. */
typedef struct {
    const char *logged;
    int written;
} moment;

static void wait_for(const moment *m)
{
    char text[MOST_LOG];
    ino_t last = 0;

    for (int i = 0, n = 0; i < 60000; i++) {
        struct stat s;

        if (m->logged == NULL && stat(tiny_path(&folder, "out/c"), &s) == 0 && s.st_ino != last &&
            ++n >= m->written)
            return;
        if (m->logged == NULL && is_there("out/c"))
            last = s.st_ino;
        if (m->logged != NULL && is_there("out/l")) {
            read_text("out/l", text, sizeof text);
            if (strstr(text, m->logged) != NULL)
                return;
        }
        pause_us(500);
    }
    fail_msg("the moment did not come");
}

static const moment moments[] = { { NULL, 0 }, { "\"step\":250,", 0 },  { NULL, 1 },
                                  { NULL, 2 }, { "\"step\":1500,", 0 }, { "\"step\":1750,", 0 } };

/* Begins the program and sends the signal at that moment. A program that ended before the signal
 * came begins again: on a busy machine this one may look at the log too late. */
static int signalled(const moment *m, int signal)
{
    for (int tries = 0; tries < 20; tries++) {
        const pid_t child = begin("--checkpoint", "out/c", NULL);

        if (m->written == 0 && m->logged == NULL)
            pause_us(60000);
        else
            wait_for(m);
        kill(child, signal);

        const int status = finish(child);

        if (status != 0)
            return status;
        begin_test();
    }
    return 0;
}

static void stop_at(const moment *m, int signal, const ball_file *want)
{
    const int status = signalled(m, signal);
    char text[4096];
    unsigned long long at = 0, held = 0;
    const char *words;

    if (status == 1000 + signal) { /* before training */
        assert_int_equal(m->written, 0);
        assert_null(m->logged);
        return;
    }
    assert_int_equal(status, 128 + signal);
    read_words(text, sizeof text);
    words = strstr(text, "ted4enc: stopped at step ");
    if (words == NULL || sscanf(words,
                                "ted4enc: stopped at step %llu of 1900; out/c holds step %llu; the "
                                "same command with --resume goes on",
                                &at, &held) != 2)
        fail_msg("said \"%s\"", text);
    assert_true(held <= at || m->logged == NULL);
    assert_false(is_there("out/x.ted4"));
    printf("signal %d at step %llu, %llu held\n", signal, at, held);

    assert_int_equal(finish(begin("--checkpoint", "out/c", "--resume")), 0);
    read_words(text, sizeof text);
    snprintf(text + strlen(text), sizeof text - strlen(text), "\n");

    char going[80];

    snprintf(going, sizeof going, "ted4enc: out/c: going on from step %llu of 1900\n", held);
    assert_non_null(strstr(text, going));
    expect_same("out/x.ted4", want);
    gone("out/c");
    gone("out/l");
}

static void test_moments(void **state)
{
    ball_file want;

    static const int signals[] = { SIGINT, SIGTERM, SIGHUP };

    (void)state;
    begin_test();
    assert_int_equal(finish(begin(NULL, NULL, NULL)), 0);
    want = read_file("out/x.ted4");
    gone("out/x.ted4");
    gone("out/l");
    for (size_t i = 0; i < sizeof moments / sizeof moments[0]; i++)
        stop_at(&moments[i], signals[i % 3], &want);
    free(want.bytes);
}

/* Stops the program at its first message. Returns 0 if that was too late and it stopped
 * elsewhere. */
static int stop_at_loading(void)
{
    char text[4096] = "";

    gone("err");

    const pid_t child = begin("--checkpoint", "out/c", NULL);

    for (int i = 0; i < 60000 && strstr(text, "loading scene\n") == NULL; i++) {
        pause_us(100);
        if (is_there("err"))
            read_words(text, sizeof text);
    }
    kill(child, SIGINT);
    if (finish(child) != 1000 + SIGINT)
        return 0;
    read_words(text, sizeof text);
    assert_non_null(strstr(text, "\nted4enc: stopped; nothing was written\n"));
    expect_files("");
    return 1;
}

static void test_loading(void **state)
{
    int tries = 50;

    (void)state;
    do {
        begin_test();
        finish(begin("--check", NULL, NULL)); /* leaves its messages */
    } while (!stop_at_loading() && --tries > 0);
    assert_true(tries > 0);
}

/* Without a checkpoint nothing is kept, and a message says so. */
static void test_no_checkpoint(void **state)
{
    const moment m = { "\"step\":250,", 0 };
    char text[4096];
    pid_t child;

    (void)state;
    begin_test();
    child = begin(NULL, NULL, NULL);
    wait_for(&m);
    kill(child, SIGINT);
    assert_int_equal(finish(child), 130);
    read_words(text, sizeof text);
    assert_non_null(strstr(text, "; nothing of it is kept (--checkpoint FILE would)\n"));
    expect_files("l");
}

/* After the last step, the file is still written. The log has this step before that, and before the
 * last checkpoint. */
static void test_after_the_last_step(void **state)
{
    enum { TIMES = 10 };
    const moment m = { "\"step\":1900,", 0 };

    (void)state;
    for (int i = 0; i < TIMES; i++) {
        const int saves = i % 2;

        begin_test();

        const pid_t child = begin(saves ? "--checkpoint" : NULL, "out/c", NULL);

        wait_for(&m);
        kill(child, SIGTERM);
        assert_int_equal(finish(child), 0);
        expect_files(saves ? "c l x.ted4" : "l x.ted4");
    }
}

/* The same as signalled, with two signals at once. */
static int signalled_twice(const moment *m)
{
    int status = 0;

    for (int tries = 0; tries < 20 && status == 0; tries++) {
        begin_test();

        const pid_t child = begin(NULL, NULL, NULL);

        wait_for(m);
        kill(child, SIGSTOP);
        kill(child, SIGINT);
        kill(child, SIGTERM);
        kill(child, SIGCONT);
        status = finish(child);
    }
    return status;
}

/* The second signal ends the program by its default action; a signal that was ignored at the start
 * stays ignored, also after another one. */
static void test_again(void **state)
{
    const moment m = { "\"step\":250,", 0 };
    pid_t child;
    int status;

    (void)state;
    status = signalled_twice(&m);
    if (status != 1000 + SIGINT && status != 1000 + SIGTERM)
        fail_msg("status %d", status);
    gone("out/l");
    signal(SIGINT, SIG_IGN);
    child = begin(NULL, NULL, NULL);
    signal(SIGINT, SIG_DFL);
    wait_for(&m);
    kill(child, SIGINT);
    assert_int_equal(finish(child), 0);
    signal(SIGINT, SIG_IGN);
    child = begin(NULL, NULL, NULL);
    signal(SIGINT, SIG_DFL);
    gone("out/l");
    wait_for(&m);
    kill(child, SIGTERM);
    pause_us(100);
    kill(child, SIGINT);
    assert_int_equal(finish(child), 128 + SIGTERM);
}

/* A second signal ends the program at once, and leaves no file that is not complete, as a
 * checkpoint that is being written. */
static void test_again_in_a_write(void **state)
{
    static const int signals[] = { SIGINT, SIGTERM };

    (void)state;
    begin_test();
    for (size_t i = 0; i < 2; i++) {
        const char *const path = tiny_path(&folder, "out/c.part");
        FILE *const f = fopen(path, "w");

        assert_non_null(f);
        fclose(f);
        fflush(NULL);

        const pid_t child = fork();

        assert_true(child >= 0);
        if (child == 0) {
            ted4_stop_on_signals(1);
            ted4_stop_keep();
            ted4_leftovers_add(path, 0);
            raise(SIGINT);
            if (ted4_stop_asked() == SIGINT)
                raise(signals[i]);
            _exit(100);
        }
        assert_int_equal(finish(child), 1000 + signals[i]);
        expect_files("");
    }
}

/* Both the system and a shell tell a program that its terminal was closed: that is one request. */
static void test_hung_up_twice(void **state)
{
    const moment m = { "\"step\":250,", 0 };
    pid_t child;

    (void)state;
    begin_test();
    child = begin("--checkpoint", "out/c", NULL);
    wait_for(&m);
    for (int i = 0; i < 3; i++) {
        kill(child, SIGHUP);
        pause_us(100);
    }
    assert_int_equal(finish(child), 128 + SIGHUP);
    expect_files("c l");
}

/* Where messages go to a program, as to tee, the end of the terminal ends that too. Nobody reads
 * what ted4enc says of its last checkpoint: it is written all the same. */
static void test_unheard(void **state)
{
    const moment m = { "\"step\":250,", 0 };
    int ends[2];
    pid_t child;

    (void)state;
    begin_test();
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(fcntl(ends[0], F_SETFD, FD_CLOEXEC), 0);
    messages = ends[1];
    child = begin("--checkpoint", "out/c", NULL);
    messages = -1;
    close(ends[1]);
    wait_for(&m);
    close(ends[0]);
    kill(child, SIGHUP);
    assert_int_equal(finish(child), 128 + SIGHUP);
    expect_files("c l");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_loading),       cmocka_unit_test(test_moments),
        cmocka_unit_test(test_no_checkpoint), cmocka_unit_test(test_after_the_last_step),
        cmocka_unit_test(test_again),         cmocka_unit_test(test_again_in_a_write),
        cmocka_unit_test(test_hung_up_twice), cmocka_unit_test(test_unheard)
    };

    /* A shell that runs commands in the background, or nohup, makes them ignore signals. */
    signal(SIGINT, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    return cmocka_run_group_tests_name("ending by a signal", tests, set_up, tear_down);
}
