/* train_record.h - a short training of a benchmark, of each step of which something is measured:
 * a sample, some doubles that the benchmark gives a meaning; and medians of them by stage.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BENCH_TRAIN_RECORD_H
#define TED4_BENCH_TRAIN_RECORD_H

#include "train_parts.h"

typedef struct {
    int steps;              /* of a stage */
    size_t members;         /* doubles of a sample */
    double *sample[STAGES]; /* owned: [n][members] */
    size_t n[STAGES];
    size_t anchors[STAGES]; /* at a stage's end */
    double splats[STAGES];
} train_record;

/* Steps of a stage of which no median knows, as memory and caches have yet to fill. */
enum { RECORD_WARM_UP = 15 };

void record_init(train_record *r, int steps, size_t members);
void record_free(train_record *r);

/* Does a step and fills its sample. */
typedef void (*record_step)(ted4_trainer *t, void *sample);

/* Trains by parts_options, in place of what the record had before; ends the program where that
 * fails. */
void record_training(train_record *r, ted4_dataset *d, const ted4_parallel *team, record_step step);

/* Of each member over the steps of a stage, the first ones aside; 0 where there was no step. */
void record_medians(const train_record *r, int stage, double *median);

/* The lines of which scene and how many steps, without its end, and of what a stage had. */
void record_print_title(const train_record *r, const ted4_dataset *d, char *const *argv);
void record_print_stage(const train_record *r, int stage);

#endif
