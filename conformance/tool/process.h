/* process.h - a decoder as a process of its own: its answer on stdout, its end, its time.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_PROCESS_H
#define CONF_PROCESS_H

#include <sys/types.h>
#include "text.h"

enum { CONF_MAX_OUTPUT = 8 << 20, CONF_MAX_STDERR = 600 };

typedef struct {
    const char *command;     /* for sh -c; the arguments come behind it */
    const char *environment; /* NAME=VALUE more; NULL: none */
    double timeout;          /* seconds */
    uint64_t memory;         /* RLIMIT_AS in bytes; 0: as it is */
} conf_process_options;

typedef enum { CONF_ENDED, CONF_CRASHED, CONF_HUNG, CONF_TOO_LONG } conf_process_end;

/* One run. All zero: none. */
typedef struct {
    pid_t pid;    /* 0: not running */
    int out, err; /* pipes */
    double started, ms;
    const conf_process_options *options;
    conf_bytes answer;    /* owned */
    conf_bytes complaint; /* owned: beginning of stderr */
    conf_process_end end;
    int code; /* exit code, or signal */
} conf_process;

/* argv: NULL at the end. */
void conf_process_start(conf_process *p, const conf_process_options *o, const char *const *argv);
/* Waits up to ms milliseconds for something to happen to n processes (those with pid 0 are left
 * out), reads what they say, ends those whose time is over. Gives the number of one that has ended,
 * with pid 0 now, or -1. */
int conf_process_wait(conf_process *const *p, int n, int ms);
/* The caller has not looked for time seconds: that is not held against those that run. */
void conf_process_excuse(conf_process *const *p, int n, double time);
void conf_process_free(conf_process *p);

#endif
