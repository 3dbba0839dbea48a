/* replay.h - `ted4conf replay`: checks the linked decoder against the suite in one process, which
 * takes seconds. Crashes and hangs are not caught: the caller has to handle them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_REPLAY_H
#define CONF_REPLAY_H

typedef struct {
    const char *suite, *list; /* list: see conf_suite_load */
    int stop;                 /* 1: stop at the first failure */
    int validate; /* 1: also run the validator (spec 3.6), which has to find the expected errors,
                     and none in valid files */
    int ways;     /* 1: also decode with other options (ways.h) */
    int threads;  /* above 1: also decode and query on so many threads (callers.h) */
    int names;    /* 1: print a line "at ID" before each vector */
} conf_replay_options;

/* Returns the exit code: 0 if all vectors pass, else 1. A vector fails, too, if its file is not
 * there, unless it is one that is made on demand; such a vector is passed over. If there is no file
 * at all, the process ends with a message and code 3. */
int conf_replay(const conf_replay_options *o);

#endif
