/* test_process.c - decoders as processes (conformance/tool/process.h): after they have ended, their
 * output is complete, whenever the end was noticed.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <signal.h>
#include <sys/time.h>
#include <time.h>

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_late_answer),
        cmocka_unit_test(test_left_behind),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
