/* stop.h - handling of SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal was closed). Before
 * training, a signal ends the program with a message. During training, the first signal is
 * recorded for ted4_stop_asked, and the second ends the program at once, unless it is SIGHUP.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STOP_H
#define TED4_STOP_H

/* Installs the handlers. A signal that was ignored before, as SIGHUP under nohup, stays ignored.
 * From now on a pipe that nobody reads any more is an error of output like others, and does not end
 * the program: a closed terminal ends what reads the messages too, before the last checkpoint is
 * written. quiet: no message is printed when a signal arrives. */
void ted4_stop_on_signals(int quiet);
/* Training begins: from now on the first signal no longer ends the program. */
void ted4_stop_keep(void);
/* Returns the signal that has arrived, or 0. */
int ted4_stop_asked(void);

#endif
