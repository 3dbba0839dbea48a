/* replay.h - `ted4conf replay`: the decoder that is linked in, against the suite, in one process.
 * Seconds; crashes and hangs are the caller's affair.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_REPLAY_H
#define CONF_REPLAY_H

typedef struct {
    const char *suite, *list; /* list: as conf_suite_load takes it */
    int stop;                 /* at the first failure */
    int validate; /* the validator (spec 3.6) too, which has to find the errors that are expected
                     and no others in valid files */
    int ways;     /* as other callers may decode (ways.h) */
    int names;    /* a line "at ID" before each vector */
} conf_replay_options;

/* Exit code: 0 all pass, 1 not. */
int conf_replay(const conf_replay_options *o);

#endif
