/* monitor.h - detects anomalies of training, and reports what happened and where. rollback.h
 * restores the last good state. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MONITOR_H
#define TED4_MONITOR_H

#include "train/state/trainer.h"

/* A Gaussian has no extent if all of its scales are below this. The unit is that of normalised
 * space, about half the extent of the scene. */
#define TED4_NO_EXTENT 1e-7f

/* Number of rollbacks before a failure ends training. */
enum { TED4_ROLLBACKS = 3 };

const char *ted4_term_name(int term);

/* The functions that return int return 0, or -1 with t->message filled, and with monitor.found set
 * if it is an anomaly. values: checks the networks and the colour maps and, if anchors is set, all
 * anchors. loss: checks the loss of a picture. look: call after the update; checks gradients,
 * values, the loss, and how much of in and s was drawn. */
int ted4_monitor_values(ted4_trainer *t, int anchors);
int ted4_monitor_loss(ted4_trainer *t, double loss);
int ted4_monitor_look(ted4_trainer *t, double loss, const ted4_generate_input *in,
                      const ted4_splats *s);
/* Reports an anomaly. The message consists of what, term, the anchor (unless it is -1) and a text
 * by format that says what happened. Returns -1. */
int ted4_monitor_anomaly(ted4_trainer *t, const char *cause, int64_t anchor, const char *what,
                         const char *term, const char *format, ...);

/* Returns whether the next step begins by keeping the state, so that the last good state is no
 * longer needed. */
int ted4_monitor_due(const ted4_trainer *t);
/* Drops the last good state; the next step keeps the state with which it begins. */
void ted4_monitor_forget(ted4_trainer *t);
/* Returns whether nothing is suspicious, so that this state may replace an older one on the
 * disk. */
int ted4_monitor_calm(const ted4_trainer *t);
/* Call after a line of the log was written. Resets the peaks of the gradients. */
void ted4_monitor_line(ted4_trainer *t);

#endif
