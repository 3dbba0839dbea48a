/* stop.c - see stop.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "stop.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "tool/leftovers.h"

static const int signals[] = { SIGINT, SIGTERM };
enum { N_SIGNALS = (int)(sizeof signals / sizeof signals[0]) };

static volatile sig_atomic_t asked, silent, keeping;

static void say(const char *word)
{
    if (!silent && write(STDERR_FILENO, word, strlen(word)) < 0)
        silent = 1;
}

/* The signal handler. Unless it only records the signal, it raises it again with the default
 * action, which takes effect when the handler returns. */
static void take(int signal)
{
    struct sigaction usual;
    const int before = errno, again = asked != 0;

    asked = signal;
    memset(&usual, 0, sizeof usual);
    usual.sa_handler = SIG_DFL;
    for (int i = 0; i < N_SIGNALS; i++)
        sigaction(signals[i], &usual, NULL);
    if (!keeping && !again)
        say("\nted4enc: stopped before training; nothing was written\n");
    else if (!again)
        say("\nted4enc: stopping after this step; once more ends at once\n");
    if (!keeping || again) {
        ted4_leftovers_remove();
        raise(signal);
    }
    errno = before;
}

void ted4_stop_on_signals(int quiet)
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

void ted4_stop_keep(void)
{
    keeping = 1;
}

int ted4_stop_asked(void)
{
    return asked;
}
