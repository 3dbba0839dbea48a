/* train_parts.h - the parts of a training step, told apart by the functions that do them: the
 * linker puts those of train_parts.c in between (-Wl,--wrap, bench.mk), so the trainer itself is
 * not touched and a part that another calls is counted once, for the inner one.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BENCH_TRAIN_PARTS_H
#define TED4_BENCH_TRAIN_PARTS_H

#include "train/state/trainer.h"

enum { STAGE_1, STAGE_2, STAGE_INTEGER, STAGES };
extern const char *const stage_name[STAGES];

/* In about the order in which a step does them. */
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

/* What goes on now; the trainer's own thread alone looks at it. Whoever empties ms begins a step
 * by parts_begin and ends it by parts_end. */
typedef struct {
    double ms[N_PARTS];
    train_part current;
    double since;                /* when current began or went on */
    void (*leave)(train_part p); /* NULL, or called whenever a part, p, gives way to another */
} parts_clock;
extern parts_clock parts;

void parts_begin(void);
void parts_end(void);
/* A step between the two: how many ms it took. */
double parts_step(ted4_trainer *t);

/* The preset "fast" with as many anchors as it may have from the beginning, and short stages;
 * and the scene of a program that takes SCENE DOWNSCALE, with the time that it takes to decode one
 * of its pictures, in ms. They end the program where they fail, and so does parts_step. */
void parts_options(ted4_train_options *o, int steps);
double parts_load(ted4_dataset *d, int argc, char *const *argv);
int parts_stage(const ted4_trainer *t);
void parts_fail(const ted4_message *m);

#endif
