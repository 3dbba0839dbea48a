/* process.h - runs a decoder as a separate process: its answer on stdout, how it ended, and its
 * time limit.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_PROCESS_H
#define CONF_PROCESS_H

#include <sys/types.h>
#include "text.h"

enum { CONF_MAX_OUTPUT = 8 << 20, CONF_MAX_STDERR = 600 };

typedef struct {
    const char *command;     /* run by sh -c, with the arguments appended */
    const char *environment; /* an additional NAME=VALUE; NULL: none */
    double timeout;          /* seconds */
    uint64_t memory;         /* RLIMIT_AS in bytes; 0: unchanged */
} conf_process_options;

typedef enum { CONF_ENDED, CONF_CRASHED, CONF_HUNG, CONF_TOO_LONG } conf_process_end;

/* One run. All zero: no run. */
typedef struct {
    pid_t pid;    /* 0: not running */
    int out, err; /* pipes */
    double started, ms;
    const conf_process_options *options;
    conf_bytes answer;    /* owned */
    conf_bytes complaint; /* owned: the beginning of stderr */
    conf_process_end end;
    int code; /* exit code, or number of the signal */
} conf_process;

/* argv ends with NULL. What runs is ended together with the caller, also where a signal ends that:
 * SIGINT, SIGTERM, SIGHUP or SIGPIPE, unless it is ignored. */
void conf_process_start(conf_process *p, const conf_process_options *o, const char *const *argv);
/* Waits up to ms milliseconds for an event in n processes (those with pid 0 are skipped), reads
 * their output, and kills those that exceed their time limit. Returns the index of a process that
 * has ended, whose pid is now 0, or -1. */
int conf_process_wait(conf_process *const *p, int n, int ms);
/* Extends the time limits of the running processes by time seconds, in which the caller did not
 * wait for them. */
void conf_process_excuse(conf_process *const *p, int n, double time);
void conf_process_free(conf_process *p);

#endif
