/* stop.h - Ctrl-C and requests to end: the first is kept for whoever asks, the second ends the
 * program at once.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STOP_H
#define TED4_STOP_H

/* From here on. quiet: nothing is said when it comes. A signal that was ignored before stays so. */
void ted4_stop_watch(int quiet);
/* The signal that came; 0: none. */
int  ted4_stop_asked(void);

#endif
