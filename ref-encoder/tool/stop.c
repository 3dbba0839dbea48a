/* stop.c - see stop.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "stop.h"

#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "tool/leftovers.h"

static const int signals[] = { SIGINT, SIGTERM, SIGHUP };
enum { N_SIGNALS = (int)(sizeof signals / sizeof signals[0]) };

/* The first signal, or 0. Two signals can be handled at the same time, by two threads. */
static atomic_int asked;
static volatile sig_atomic_t silent, keeping;

static void take(int signal);

static void say(const char *word)
{
    if (!silent && write(STDERR_FILENO, word, strlen(word)) < 0)
        silent = 1;
}

/* Gives a signal, if it is handled here, another action. */
static void change(int signal, void (*to)(int))
{
    struct sigaction later, now;

    memset(&later, 0, sizeof later);
    later.sa_handler = to;
    if (sigaction(signal, NULL, &now) == 0 && now.sa_handler == take)
        sigaction(signal, &later, NULL);
}

/* The signal handler. It records the first signal during training. Any other one ends the program:
 * unfinished files are removed, and the signal is raised again with the default action, which takes
 * effect when the handler returns. But SIGHUP is ignored while the last step is made: that a
 * terminal was closed is told by the system and by a shell, and is one request. */
static void take(int signal)
{
    int none = 0;
    const int before = errno, first = atomic_compare_exchange_strong(&asked, &none, signal);
    const int at_once = !keeping || (!first && signal != SIGHUP);

    if (!at_once)
        change(SIGHUP, SIG_IGN);
    for (int i = 0; i < N_SIGNALS && at_once; i++)
        change(signals[i], SIG_DFL);
    if (first)
        say(keeping ? "\nted4enc: stopping after this step; once more ends at once\n"
                    : "\nted4enc: stopped; nothing was written\n");
    if (at_once) {
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
    signal(SIGPIPE, SIG_IGN);
}

void ted4_stop_keep(void)
{
    keeping = 1;
}

int ted4_stop_asked(void)
{
    return asked;
}
