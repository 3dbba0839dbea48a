/* process.c - see process.h. Every run is a process group, so that all processes it has started end
 * with it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include "tool/clock.h"

enum { MAX_ARGUMENTS = 24, MAX_PROCESSES = 256 };
/* A pipe is read in pieces of 16 KiB and holds 64 KiB (pipe(7)). */
enum { PIECE = 1 << 14, PIECES = 4 };

/* The process groups that run; 0: none. No terminal reaches them, and each is timed by this program
 * alone, so that they must not outlive it. */
static atomic_int running[MAX_PROCESSES];

static void end_running(void)
{
    for (int i = 0; i < MAX_PROCESSES; i++) {
        const int group = atomic_load(&running[i]);

        if (group > 0)
            kill(-group, SIGKILL);
    }
}

/* The default action takes effect when the handler returns. */
static void take(int signal)
{
    end_running();
    raise(signal);
}

/* Puts a group in the place of another; 0: of none, or none. */
static void change_running(int from, int to)
{
    int i = 0;

    while (i < MAX_PROCESSES && !atomic_compare_exchange_strong(&running[i], &(int) { from }, to))
        i++;
}

/* From the first call on, what runs is ended with this program: by a signal, unless that is
 * ignored, or by its own end. */
static void watch(void)
{
    static const int signals[] = { SIGINT, SIGTERM, SIGHUP, SIGPIPE };
    static int watched;
    struct sigaction mine, before;

    if (watched)
        return;
    watched = 1;
    memset(&mine, 0, sizeof mine);
    mine.sa_handler = take;
    mine.sa_flags = (int)SA_RESETHAND;
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(signals[i], &mine, NULL);
    if (atexit(end_running) != 0)
        conf_die("no memory");
}

static _Noreturn void child(const conf_process_options *o, const char *const *argv, int out,
                            int err)
{
    const int null = open("/dev/null", O_RDONLY);
    char *list[MAX_ARGUMENTS] = { NULL };
    char shell[] = "sh", flag[] = "-c", name[] = "ted4conf";
    conf_bytes command = { NULL, 0, 0 };
    struct rlimit limit = { (rlim_t)o->memory, (rlim_t)o->memory }, core = { 0, 0 };
    int n = 0;

    setpgid(0, 0);
    dup2(null, 0);
    dup2(out, 1);
    dup2(err, 2);
    setrlimit(RLIMIT_CORE, &core);
    if (o->environment != NULL && strchr(o->environment, '=') != NULL) {
        char *const variable = conf_copy(o->environment), *const value = strchr(variable, '=');

        *value = '\0';
        setenv(variable, value + 1, 1);
    }
    conf_print(&command, "%s \"$@\"", o->command);
    list[n++] = shell;
    list[n++] = flag;
    list[n++] = (char *)command.data;
    list[n++] = name;
    for (; *argv != NULL && n + 1 < MAX_ARGUMENTS; argv++)
        list[n++] = conf_copy(*argv);
    if (o->memory > 0) /* limits the program itself: set last, as a runner with sanitizers may use
                          more already */
        setrlimit(RLIMIT_AS, &limit);
    execv("/bin/sh", list);
    _exit(127);
}

void conf_process_start(conf_process *p, const conf_process_options *o, const char *const *argv)
{
    int out[2], err[2];

    memset(p, 0, sizeof *p);
    watch();
    if (pipe(out) != 0 || pipe(err) != 0)
        conf_die("pipe: %s", strerror(errno));
    for (int i = 0; i < 2; i++) {
        fcntl(out[i], F_SETFD, FD_CLOEXEC);
        fcntl(err[i], F_SETFD, FD_CLOEXEC);
    }
    p->options = o;
    p->started = ted4_clock();
    p->pid = fork();
    if (p->pid < 0)
        conf_die("fork: %s", strerror(errno));
    if (p->pid == 0)
        child(o, argv, out[1], err[1]);
    setpgid(p->pid, p->pid);
    change_running(0, (int)p->pid);
    close(out[1]);
    close(err[1]);
    p->out = out[0];
    p->err = err[0];
    conf_add(&p->answer, "", 0);
    conf_add(&p->complaint, "", 0);
}

/* Reads the current content of a pipe; if the pipe is closed, *fd becomes -1. Returns 0 if the
 * output is too long, else 1. */
static int drain(int *fd, conf_bytes *to, size_t most, int keep_all)
{
    uint8_t piece[PIECE];
    const ssize_t n = read(*fd, piece, sizeof piece);

    if (n <= 0) {
        if (n < 0 && errno == EINTR)
            return 1;
        close(*fd);
        *fd = -1;
        return 1;
    }
    if (to->size + (size_t)n <= most)
        conf_add(to, piece, (size_t)n);
    else if (keep_all)
        return 0;
    else
        conf_add(to, piece, most - to->size);
    return 1;
}

/* Kills what is left of the process group and takes the exit status; not the other way around, as
 * afterwards the number may be another's. */
static void finish(conf_process *p, conf_process_end end)
{
    int status = 0;

    kill(-p->pid, SIGKILL);
    change_running((int)p->pid, 0);
    while (waitpid(p->pid, &status, 0) < 0 && errno == EINTR)
        ;
    if (p->out >= 0)
        close(p->out);
    if (p->err >= 0)
        close(p->err);
    p->ms = 1e3 * (ted4_clock() - p->started);
    p->end = end == CONF_ENDED && WIFSIGNALED(status) ? CONF_CRASHED : end;
    p->code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    p->pid = 0;
}

static int leader_ended(const conf_process *p)
{
    siginfo_t info;

    info.si_pid = 0;
    return waitid(P_PID, (id_t)p->pid, &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == p->pid;
}

/* Reads the pipes; f tells which of them are readable. Returns 0 if stdout has become too long,
 * else 1. */
static int hear(conf_process *p, const struct pollfd *f)
{
    if (f[0].revents != 0 && p->out >= 0 && !drain(&p->out, &p->answer, CONF_MAX_OUTPUT, 1))
        return 0;
    if (f[1].revents != 0 && p->err >= 0)
        (void)drain(&p->err, &p->complaint, CONF_MAX_STDERR, 0);
    return 1;
}

/* Reads what the leader wrote between the last look at its pipes and its end, which is still in
 * them. Other processes of the group may write on for ever: their output does not count. */
static int last_words(conf_process *p)
{
    for (int i = 0; i < PIECES; i++) {
        struct pollfd f[2] = { { p->out, POLLIN, 0 }, { p->err, POLLIN, 0 } };

        if (poll(f, 2, 0) > 0 && !hear(p, f))
            return 0;
    }
    return 1;
}

static int look(conf_process *p, const struct pollfd *f)
{
    const int ended = leader_ended(p);

    if (!hear(p, f) || (ended && !last_words(p))) {
        finish(p, CONF_TOO_LONG);
        return 1;
    }
    if (ended) {
        finish(p, CONF_ENDED);
        return 1;
    }
    if (ted4_clock() - p->started > p->options->timeout) {
        finish(p, CONF_HUNG);
        return 1;
    }
    return 0;
}

int conf_process_wait(conf_process *const *p, int n, int ms)
{
    struct pollfd f[2 * MAX_PROCESSES];
    int waiting = ms;

    if (n > MAX_PROCESSES)
        conf_die("more than %d processes", MAX_PROCESSES);
    for (int i = 0; i < n; i++) {
        f[2 * i] = (struct pollfd) { p[i]->pid > 0 ? p[i]->out : -1, POLLIN, 0 };
        f[2 * i + 1] = (struct pollfd) { p[i]->pid > 0 ? p[i]->err : -1, POLLIN, 0 };
        if (p[i]->pid > 0 && p[i]->out < 0 && waiting > 1)
            waiting = 1; /* closed its stdout and is about to end */
    }
    (void)poll(f, (nfds_t)(2 * n), waiting);
    for (int i = 0; i < n; i++)
        if (p[i]->pid > 0 && look(p[i], &f[2 * i]))
            return i;
    return -1;
}

void conf_process_excuse(conf_process *const *p, int n, double time)
{
    for (int i = 0; i < n; i++)
        if (p[i]->pid > 0)
            p[i]->started += time;
}

void conf_process_free(conf_process *p)
{
    conf_free(&p->answer);
    conf_free(&p->complaint);
}
