/* stop.h - Ctrl-C and requests to end: before training they end the program, with a word; then the
 * first is kept for whoever asks, and the second ends the program at once.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STOP_H
#define TED4_STOP_H

/* From here on. quiet: nothing is said when one comes. A signal that was ignored before stays so.
 */
void ted4_stop_on_signals(int quiet);
/* From here on there is something to keep. */
void ted4_stop_keep(void);
/* The signal that came; 0: none. */
int ted4_stop_asked(void);

#endif
