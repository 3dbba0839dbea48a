/* test_process.c - decoders as processes (conformance/tool/process.h): after they have ended, their
 * output is complete, whenever the end was noticed.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <poll.h>
#include <signal.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "test.h"
#include "conformance/tool/process.h"

static const char *const none[] = { NULL };

static void sleep_a_while(int signal)
{
    const struct timespec t = { 1, 0 };

    (void)signal;
    nanosleep(&t, NULL);
}

/* The process prints and ends after its pipes were checked, and before its end is checked: the
 * signal makes this interval long. */
static void test_late_answer(void **state)
{
    const conf_process_options o = { "sleep 0.5; printf answer; printf complaint >&2; exit 5;",
                                     NULL, 30, 0 };
    const struct itimerval soon = { { 0, 0 }, { 0, 200000 } };
    struct sigaction slow = { .sa_handler = sleep_a_while };
    conf_process p, *const all[] = { &p };

    (void)state;
    assert_int_equal(sigaction(SIGALRM, &slow, NULL), 0);
    conf_process_start(&p, &o, none);
    assert_int_equal(setitimer(ITIMER_REAL, &soon, NULL), 0);
    while (conf_process_wait(all, 1, 10000) < 0)
        ;
    assert_int_equal(p.end, CONF_ENDED);
    assert_int_equal(p.code, 5);
    assert_string_equal((char *)p.answer.data, "answer");
    assert_string_equal((char *)p.complaint.data, "complaint");
    conf_process_free(&p);
}

/* A process that leaves another one behind, which holds its pipes open: it has ended, and its
 * output counts. */
static void test_left_behind(void **state)
{
    const conf_process_options o = { "printf answer; sleep 60 & exit 0;", NULL, 30, 0 };
    conf_process p, *const all[] = { &p };

    (void)state;
    conf_process_start(&p, &o, none);
    while (conf_process_wait(all, 1, 1000) < 0)
        ;
    assert_int_equal(p.end, CONF_ENDED);
    assert_string_equal((char *)p.answer.data, "answer");
    assert_true(p.ms < 2e4);
    conf_process_free(&p);
}

static int status_of(pid_t child)
{
    int status = -1;

    assert_true(child > 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

/* A runner that a signal ends takes the decoders with it: nobody else would end one that hangs. */
static void test_runner_ended(void **state)
{
    static const int signals[] = { SIGINT, SIGTERM, SIGHUP, SIGPIPE };
    const conf_process_options o = { "sleep 60; exit 0;", NULL, 60, 0 };

    (void)state;
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        conf_process p, *const all[] = { &p };
        pid_t decoder = 0;
        int ends[2];

        assert_int_equal(pipe(ends), 0);

        const pid_t runner = fork();

        if (runner == 0) {
            conf_process_start(&p, &o, none);
            if (write(ends[1], &p.pid, sizeof p.pid) != sizeof p.pid)
                _exit(100);
            for (;;)
                (void)conf_process_wait(all, 1, 1000);
        }
        assert_int_equal(read(ends[0], &decoder, sizeof decoder), sizeof decoder);
        assert_int_equal(kill(-decoder, 0), 0);
        assert_int_equal(kill(runner, signals[i]), 0);

        const int status = status_of(runner);

        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == signals[i]);
        close(ends[1]); /* the decoder has the other one that is still open */
        assert_int_equal(poll(&(struct pollfd) { ends[0], POLLIN, 0 }, 1, 20000), 1);
        assert_int_equal(read(ends[0], &decoder, sizeof decoder), 0);
        close(ends[0]);
    }
}

/* The folder of a file in the root, as of /results.json: there is nothing to make. */
static void test_root(void **state)
{
    (void)state;

    const pid_t child = fork();

    if (child == 0) {
        conf_make_folder("");
        _exit(0);
    }
    assert_int_equal(status_of(child), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_late_answer),
        cmocka_unit_test(test_left_behind),
        cmocka_unit_test(test_runner_ended),
        cmocka_unit_test(test_root),
    };

    /* A shell that runs commands in the background, or nohup, makes them ignore signals. */
    signal(SIGINT, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
