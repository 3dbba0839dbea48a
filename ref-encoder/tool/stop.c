/* stop.c - see stop.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "stop.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

static const int signals[] = { SIGINT, SIGTERM };
enum { N_SIGNALS = (int)(sizeof signals / sizeof signals[0]) };

static volatile sig_atomic_t asked, silent;

static void take(int signal)
{
    static const char  word[] = "\nted4enc: stopping after this step; once more ends at once\n";
    struct sigaction   usual;
    const int          before = errno, again = asked != 0;

    asked = signal;
    memset(&usual, 0, sizeof usual);
    usual.sa_handler = SIG_DFL;
    for (int i = 0; i < N_SIGNALS; i++)
        sigaction(signals[i], &usual, NULL);
    /* Two that came at once: the second's usual end comes when this returns. */
    if (again)
        raise(signal);
    else if (!silent && write(STDERR_FILENO, word, sizeof word - 1) < 0)
        silent = 1;
    errno = before;
}

void ted4_stop_watch(int quiet)
{
    struct sigaction mine, before;

    silent = quiet;
    memset(&mine, 0, sizeof mine);
    mine.sa_handler = take;
    mine.sa_flags = SA_RESTART;
    for (int i = 0; i < N_SIGNALS; i++)
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(signals[i], &mine, NULL);
}

int ted4_stop_asked(void)
{
    return asked;
}
