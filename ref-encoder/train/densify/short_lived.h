/* short_lived.h - initial points that exist only for a while: found by colour before training
 * starts.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SHORT_LIVED_H
#define TED4_SHORT_LIVED_H

#include "train/state/trainer.h"

/* A cloud made from several times holds points of things that have moved on since. As static
 * anchors they would be wrong at most times and fade away before activation is learnt, and with
 * them every trace of fast motion. So an anchor whose colour is found at its place by at least half
 * of the cameras at some times, but at most others by clearly fewer, or at some by hardly any
 * (ted4_photo_votes_span), starts with its activation around those times. Needs three cameras or
 * more at a time: with fewer, chance matches decide. Does nothing without activation. 0, or -1 with
 * t->message. */
int ted4_init_short_lived(ted4_trainer *t);

/* Was this anchor given such a span? */
int ted4_is_short_lived(const ted4_trainer *t, size_t i);

#endif
