/* monitor.h - notices a training that goes wrong, and says what and where; rollback.h takes it back
 * to its last good state. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MONITOR_H
#define TED4_MONITOR_H

#include "train/state/trainer.h"

/* A Gaussian all of whose scales are below this (normalised space: times half the scene) has no
 * extent. */
#define TED4_NO_EXTENT 1e-7f

/* Rollbacks before a failure ends training. */
enum { TED4_ROLLBACKS = 3 };

const char *ted4_term_name(int term);

/* All that return int return 0, or -1 with t->message, and with monitor.found when it is an
 * anomaly. values: of the networks and colour maps, with anchors of all anchors, too. loss: of the
 * picture. look: after the update; gradients, values, loss, and how much was drawn of in and s. */
int ted4_monitor_values(ted4_trainer *t, int anchors);
int ted4_monitor_loss(ted4_trainer *t, double loss);
int ted4_monitor_look(ted4_trainer *t, double loss, const ted4_generate_input *in,
                      const ted4_splats *s);
/* An anomaly: its message is what, term, the anchor and what has happened to it (format). Returns
 * -1.
 */
int ted4_monitor_anomaly(ted4_trainer *t, const char *cause, int64_t anchor, const char *what,
                         const char *term, const char *format, ...);

/* Will the next step begin with keeping the state? Then the last good state matters no more. */
int ted4_monitor_due(const ted4_trainer *t);
/* No good state is kept: the next step keeps its own beginning. */
void ted4_monitor_forget(ted4_trainer *t);
/* Nothing looks suspicious: this state may replace an older one on the disk. */
int ted4_monitor_calm(const ted4_trainer *t);
/* A line of the log was written: peaks begin anew. */
void ted4_monitor_line(ted4_trainer *t);

#endif
