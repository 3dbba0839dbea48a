/* test_teller.c - the progress messages of a program: their lines, when they are printed, and that
 * quiet mode prints none. Standard error of this program is redirected to a file in the meantime.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "test.h"
#include "temporary.h"
#include "tool/teller.h"

static char said[65536];

static int count(const char *what)
{
    int n = 0;

    for (const char *at = said; (at = strstr(at, what)) != NULL; at++)
        n++;
    return n;
}

typedef struct {
    char name[TEMPORARY_SIZE];
    int usual;
} capture;

static capture begin_capture(void)
{
    capture c = { .usual = dup(STDERR_FILENO) };
    const int file = temporary_file(c.name, "test_teller");

    assert_true(file >= 0);
    assert_true(c.usual >= 0);
    assert_true(dup2(file, STDERR_FILENO) >= 0);
    close(file);
    return c;
}

/* Sets said to the text captured so far. */
static void look(const capture *c)
{
    FILE *f = fopen(c->name, "rb");

    if (f == NULL)
        abort();
    said[fread(said, 1, sizeof said - 1, f)] = 0;
    fclose(f);
}

/* Ends the redirection; the captured text is in said. */
static void end_capture(capture c)
{
    assert_true(dup2(c.usual, STDERR_FILENO) >= 0);
    close(c.usual);
    look(&c);
    remove(c.name);
}

static void pause_s(double seconds)
{
    const struct timespec t = { (time_t)seconds,
                                (long)(1e9 * (seconds - (double)(time_t)seconds)) };

    nanosleep(&t, NULL);
}

static double clock_s(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Waits until what was captured n times, a minute at most: a busy machine lets a thread wait. */
static void wait_for(const capture *c, const char *what, int n)
{
    look(c);
    for (int i = 0; i < 1200 && count(what) < n; i++) {
        pause_s(0.05);
        look(c);
    }
}

static void expect_time(double seconds, const char *want)
{
    char text[40];

    ted4_teller_time(seconds, text, sizeof text);
    assert_string_equal(text, want);
}

static void test_times(void **state)
{
    (void)state;
    expect_time(0, "1 s");
    expect_time(44.2, "45 s");
    expect_time(99.9, "100 s");
    expect_time(100.1, "2 min");
    expect_time(12 * 60 - 1, "12 min");
    expect_time(200 * 60, "3 h 20 min");
}

static void expect_line(const ted4_facts *f, double clock, double since, const char *want)
{
    char text[600];

    ted4_teller_line(f, clock, since, text, sizeof text);
    assert_string_equal(text, want);
}

static void test_lines(void **state)
{
    ted4_facts f = { .kind = TED4_TELL_TRAINING,
                     .step = 2700,
                     .total = 14000,
                     .stage = "1",
                     .share = -1,
                     .loss = 0.05,
                     .psnr = -1,
                     .bytes = -1,
                     .ms = -1,
                     .anchors = 3900,
                     .left = -1 };

    (void)state;
    expect_line(&f, 100, 0, "2700/14000 stage 1  loss 0.05000  anchors 3900");
    f.psnr = 25.125;
    f.bytes = 34868;
    f.ms = 12.34;
    f.left = 90;
    f.when = 80;
    expect_line(&f, 100, 0,
                "2700/14000 stage 1  loss 0.05000  psnr 25.12  anchors 3900  bytes 34868  12.3 "
                "ms/step  70 s left");
    f.train_psnr = 1;
    f.share = 0.333;
    f.stage = "trials of smaller models";
    expect_line(&f, 300, 0,
                "2700/14000 trials of smaller models: 33 %  loss 0.05000  train psnr 25.12  "
                "anchors 3900  bytes 34868  12.3 ms/step  1 s left");
    expect_line(&(ted4_facts) { .kind = TED4_TELL_UNPACKING, .name = "cam00.mp4", .step = 120 }, 0,
                7, "unpacking cam00.mp4: 120 frames");
    expect_line(&(ted4_facts) { .kind = TED4_TELL_UNPACKING, .name = "cam00.mp4", .step = 1 }, 0, 7,
                "unpacking cam00.mp4: 1 frame");
    expect_line(&(ted4_facts) { .kind = TED4_TELL_DRAWING, .step = 1, .total = 1 }, 0, 7,
                "1 of 1 picture compared");
    expect_line(&(ted4_facts) { .kind = TED4_TELL_LOADING, .name = "a/b" }, 0, 7,
                "loading a/b, 7 s so far");
    expect_line(&(ted4_facts) { .kind = TED4_TELL_CODING }, 0, 7,
                "coding and checking the file, 7 s so far");
    expect_line(&(ted4_facts) { 0 }, 0, 7, "");
}

/* A separate thread reports progress while the caller does nothing; the interval grows when
 * training begins. */
static void test_thread(void **state)
{
    const capture c = begin_capture();
    const double began = clock_s();
    double unpacking;
    ted4_teller t;

    (void)state;
    ted4_teller_begin(&t, "tool", 0);
    assert_true(t.pause[0] == 3);
    assert_true(t.pause[1] == 30);
    t.pause[0] = 0.6;
    t.pause[1] = 60;
    ted4_teller_say(&t, "first %d", 1);
    ted4_teller_now(&t, &(ted4_facts) { .kind = TED4_TELL_UNPACKING, .name = "x.mp4", .step = 3 });
    wait_for(&c, "tool: unpacking x.mp4: 3 frames\n", 3);
    ted4_teller_now(&t, &(ted4_facts) { .kind = TED4_TELL_TRAINING, .stage = "1", .share = -1 });
    unpacking = clock_s() - began;
    pause_s(1.2);
    ted4_teller_end(&t);
    end_capture(c);
    assert_memory_equal(said, "tool: first 1\n", 14);
    assert_true(count("tool: unpacking x.mp4: 3 frames\n") >= 3);
    assert_true(count("unpacking") <= unpacking / 0.6);
    assert_int_equal(count("stage"), 0);
    assert_int_equal(count("\r"), 0);
}

static void test_show_and_quiet(void **state)
{
    ted4_teller t;

    (void)state;
    for (int quiet = 0; quiet < 2; quiet++) {
        const capture c = begin_capture();

        ted4_teller_begin(&t, "tool", quiet);
        t.pause[0] = t.pause[1] = 0;
        ted4_teller_say(&t, "words");
        ted4_teller_now(&t, &(ted4_facts) { .kind = TED4_TELL_CODING });
        ted4_teller_show(&t);
        if (quiet)
            pause_s(0.7);
        else
            wait_for(&c, "tool: coding", 2);
        ted4_teller_error(&t, "trouble");
        ted4_teller_end(&t);
        end_capture(c);
        if (quiet)
            assert_string_equal(said, "tool: trouble\n");
        else {
            assert_int_equal(count("tool: words\n"), 1);
            assert_true(count("tool: coding") >= 2);
            assert_int_equal(count("tool: trouble\n"), 1);
        }
    }
}

/* On a terminal the progress line is not ended, and is erased before anything else is printed. */
static void test_terminal(void **state)
{
    const capture c = begin_capture();
    ted4_teller t;

    (void)state;
    ted4_teller_begin(&t, "tool", 0);
    t.terminal = 1;
    ted4_teller_now(&t, &(ted4_facts) { .kind = TED4_TELL_CODING });
    ted4_teller_show(&t);
    ted4_teller_say(&t, "words");
    ted4_teller_end(&t);
    end_capture(c);
    assert_string_equal(
        said, "\r\033[Ktool: coding and checking the file, 1 s so far\r\033[Ktool: words\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_times),    cmocka_unit_test(test_lines),
        cmocka_unit_test(test_thread),   cmocka_unit_test(test_show_and_quiet),
        cmocka_unit_test(test_terminal),
    };

    return cmocka_run_group_tests_name("progress messages", tests, NULL, NULL);
}
