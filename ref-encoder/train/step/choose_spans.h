/* choose_spans.h - chooses the symbols of life spans by rate and distortion. Depends on trainer.h,
 * norm/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CHOOSE_SPANS_H
#define TED4_CHOOSE_SPANS_H

#include "norm/gaussian.h"
#include "train/state/trainer.h"

/* The components of tau: a_s, log2 b_s, a_f, log2 b_f (spec 11.4). */
enum { TED4_SPAN_PARTS = 4 };

/* The span of one anchor, and the models of its symbols. */
typedef struct {
    float step;                     /* of tau, positive */
    int32_t mu[TED4_SPAN_PARTS];    /* Q8 (spec 10.1) */
    uint8_t sigma[TED4_SPAN_PARTS]; /* indices */
    int k[TED4_SPAN_PARTS];         /* symbols, -32767 to 32767; k[0] <= k[2] */
} ted4_coded_span;

/* Returns the ideal code length of all symbols, in bits (spec 9.4). */
double ted4_span_bits(const ted4_coded_span *s);
/* Returns the number of times at which activations are compared: those of n_frames >= 1 frames, and
 * halfway between them. */
static inline size_t ted4_span_n_times(uint32_t n_frames)
{
    return 2 * (size_t)n_frames - 1;
}
/* Returns time i of n, from 0 to 1. */
static inline float ted4_span_time(size_t i, size_t n)
{
    return n > 1 ? (float)i / (float)(n - 1) : 0.0f;
}
/* time: [n], ascending. activation: [n] out, from 0 to 1 (spec 11.4). */
void ted4_span_activation(const ted4_coded_span *s, const float *time, size_t n, float *activation);
/* Moves symbols towards their means, where the bits saved are worth the change of activation at n
 * >= 1 times. Afterwards k[0] <= k[2] still. The time that it takes hardly depends on n. */
void ted4_span_choose(ted4_coded_span *s, size_t n);

/* Chooses the symbols of all spans, and moves the trainer's values to those that have changed. The
 * trainer must be in its integer stage. Does nothing if the model has no activation. Returns 0, or
 * -1 with t->message filled. */
int ted4_choose_spans(ted4_trainer *t);

#endif
