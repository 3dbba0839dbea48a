/* train_parts.h - measures the parts of a training step by the functions that perform them. The
 * linker inserts the functions of train_parts.c in front of them (-Wl,--wrap, bench.mk), so that
 * the trainer itself is unchanged. If a part calls another part, the time counts for the inner one
 * only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BENCH_TRAIN_PARTS_H
#define TED4_BENCH_TRAIN_PARTS_H

#include "train/state/trainer.h"

enum { STAGE_1, STAGE_2, STAGE_INTEGER, STAGES };
extern const char *const stage_name[STAGES];

/* Roughly in the order of a step. */
#define PARTS(P)                                \
    P(PICTURE, "picture file to pixels")        \
    P(SCHEDULE, "checks, schedule")             \
    P(VISIBLE, "visible anchors")               \
    P(GENERATE, "heads, deformation")           \
    P(PROJECT, "projection")                    \
    P(BIN, "sorting, tile lists")               \
    P(BLEND, "blending")                        \
    P(LOSS, "L1, SSIM, gradient")               \
    P(BLEND_BWD, "blending, back")              \
    P(PROJECT_BWD, "projection, back")          \
    P(GENERATE_BWD, "heads, deformation, back") \
    P(REGULARISE, "volume, bank, statistics")   \
    P(RATE, "rate, forward and back")           \
    P(ADAM, "masks, Adam")                      \
    P(REST, "the rest, quantisation too")

#define AS_ENUM(name, text) PART_##name,
typedef enum { PARTS(AS_ENUM) N_PARTS } train_part;
#undef AS_ENUM
extern const char *const part_name[N_PARTS];

/* The part that is running; only the trainer's own thread uses it. A caller that resets ms begins a
 * step with parts_begin and ends it with parts_end. */
typedef struct {
    double ms[N_PARTS];
    train_part current;
    double since;                /* when current began or was resumed */
    void (*leave)(train_part p); /* NULL, or called whenever part p gives way to another part */
} parts_clock;
extern parts_clock parts;

void parts_begin(void);
void parts_end(void);
/* Runs a step between parts_begin and parts_end. Returns its duration in ms. */
double parts_step(ted4_trainer *t);

/* parts_options: the preset "fast", with the largest number of anchors that it allows from the
 * beginning, and short stages. parts_load: loads the scene of a program that is called with SCENE
 * DOWNSCALE, and returns the time to decode one of its pictures, in ms. These and parts_step end
 * the program on failure. */
void parts_options(ted4_train_options *o, int steps);
double parts_load(ted4_dataset *d, int argc, char *const *argv);
int parts_stage(const ted4_trainer *t);
void parts_fail(const ted4_message *m);

#endif
