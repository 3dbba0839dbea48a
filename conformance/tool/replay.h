/* replay.h - `ted4conf replay`: the decoder that is linked in, against the suite, in one process. Seconds; crashes and hangs are the caller's affair.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_REPLAY_H
#define CONF_REPLAY_H

/* stop: at the first failure. validate: the validator (spec 3.6) too, which has to find the errors that are expected and no others in valid files.
 * Exit code: 0 all pass, 1 not. */
int conf_replay(const char *suite, const char *list, int stop, int validate);

#endif
