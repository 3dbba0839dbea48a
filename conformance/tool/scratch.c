/* scratch.c - see scratch.h. A signal handler may call next to nothing, and SIGKILL has none. So a
 * process of its own waits for the end of this one, which closes a pipe, and removes the folder.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "scratch.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

/* The process that waits, and this end of its pipe. */
static pid_t keeper;
static int leash = -1;

/* What the decoders of this process still write, while they are being ended, is removed by the
 * second try. */
static const char REMOVE[] = "rm -rf -- \"$0\" || { sleep 1; rm -rf -- \"$0\"; }";

/* Runs in the child process and never returns. It takes no part in signals to this program, and
 * holds none of its outputs open. */
static _Noreturn void keep(const char *folder, int end)
{
    static const int signals[] = { SIGINT, SIGTERM, SIGHUP, SIGPIPE };
    const int null = open("/dev/null", O_RDWR), ended = fcntl(end, F_DUPFD, 3);
    char byte;

    setpgid(0, 0);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        signal(signals[i], SIG_IGN);
    for (int i = 0; i < 3; i++)
        dup2(null, i);
    while (read(ended, &byte, 1) < 0 && errno == EINTR)
        ;
    execl("/bin/sh", "sh", "-c", REMOVE, folder, (char *)NULL);
    _exit(127);
}

void conf_scratch_make(char folder[CONF_PATH])
{
    const char *const base = getenv("TMPDIR");
    int ends[2];

    conf_path(folder, "%s/ted4conf-XXXXXX", base != NULL ? base : "/tmp");
    if (mkdtemp(folder) == NULL)
        conf_die("%s: cannot be made", folder);
    keeper = pipe(ends) == 0 ? fork() : -1;
    if (keeper < 0) {
        rmdir(folder);
        conf_die("no process for %s", folder);
    }
    if (keeper == 0) {
        close(ends[1]);
        keep(folder, ends[0]);
    }
    close(ends[0]);
    leash = ends[1];
    (void)fcntl(leash, F_SETFD, FD_CLOEXEC);
}

void conf_scratch_remove(void)
{
    close(leash);
    while (waitpid(keeper, NULL, 0) < 0 && errno == EINTR)
        ;
}
