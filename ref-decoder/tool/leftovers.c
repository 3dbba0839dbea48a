/* leftovers.c - see leftovers.h. A handler may run at any moment and in any thread, so that a slot
 * is taken and given back by its path alone, atomically.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "leftovers.h"

#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const int signals[] = { SIGINT, SIGTERM, SIGHUP, SIGPIPE };
enum { N_SIGNALS = (int)(sizeof signals / sizeof signals[0]) };

static struct {
    _Atomic(const char *) path; /* NULL: the slot is free */
    atomic_int writer;
    void (*_Atomic empty)(const char *); /* NULL: path is a file */
} slots[TED4_LEFTOVERS];

static void add(const char *path, pid_t writer, void (*empty)(const char *))
{
    for (int i = 0; i < TED4_LEFTOVERS; i++) {
        const char *none = NULL;

        if (atomic_compare_exchange_strong(&slots[i].path, &none, path)) {
            atomic_store(&slots[i].empty, empty);
            atomic_store(&slots[i].writer, (int)writer);
            return;
        }
    }
}

void ted4_leftovers_add(const char *path, pid_t writer)
{
    add(path, writer, NULL);
}

void ted4_leftovers_add_folder(const char *path, void (*empty)(const char *path))
{
    add(path, 0, empty);
}

void ted4_leftovers_written(const char *path, pid_t writer)
{
    for (int i = 0; i < TED4_LEFTOVERS; i++)
        if (atomic_load(&slots[i].path) == path)
            atomic_store(&slots[i].writer, (int)writer);
}

/* A signal ends the child until it has ended by itself; after that, its number may be another's. */
int ted4_leftovers_wait(const char *path, pid_t writer)
{
    siginfo_t info;
    int status = -1;

    while (waitid(P_PID, (id_t)writer, &info, WEXITED | WNOWAIT) < 0 && errno == EINTR)
        ;
    ted4_leftovers_written(path, 0);
    while (waitpid(writer, &status, 0) < 0 && errno == EINTR)
        ;
    return status;
}

void ted4_leftovers_forget(const char *path)
{
    for (int i = 0; i < TED4_LEFTOVERS; i++) {
        if (atomic_load(&slots[i].path) == path) {
            atomic_store(&slots[i].writer, 0);
            atomic_store(&slots[i].empty, NULL);
            atomic_store(&slots[i].path, NULL);
        }
    }
}

void ted4_leftovers_remove(void)
{
    for (int i = 0; i < TED4_LEFTOVERS; i++) {
        const char *path = atomic_load(&slots[i].path);
        const pid_t writer = atomic_load(&slots[i].writer);
        void (*const empty)(const char *) = atomic_load(&slots[i].empty);

        if (path == NULL)
            continue;
        /* It could still make the file after its removal. */
        if (writer > 0 && kill(writer, SIGKILL) == 0)
            waitpid(writer, NULL, 0);
        if (empty != NULL)
            empty(path);
        else
            unlink(path);
    }
}

/* The default action takes effect when the handler returns. */
static void take(int signal)
{
    ted4_leftovers_remove();
    raise(signal);
}

void ted4_leftovers_watch(void)
{
    struct sigaction mine, before;

    memset(&mine, 0, sizeof mine);
    mine.sa_handler = take;
    mine.sa_flags = (int)SA_RESETHAND;
    for (int i = 0; i < N_SIGNALS; i++)
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(signals[i], &mine, NULL);
}
