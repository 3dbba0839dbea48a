/* train_record.h - runs a short training for a benchmark that measures something at each step. A
 * sample consists of doubles whose meaning the benchmark defines; the medians are computed by
 * stage.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BENCH_TRAIN_RECORD_H
#define TED4_BENCH_TRAIN_RECORD_H

#include "train_parts.h"

typedef struct {
    int steps;              /* steps per stage */
    size_t members;         /* number of doubles per sample */
    double *sample[STAGES]; /* owned: [n][members] */
    size_t n[STAGES];
    size_t anchors[STAGES]; /* at the end of the stage */
    double splats[STAGES];
} train_record;

/* Number of steps at the beginning of a stage that no median includes, as memory and caches are not
 * filled yet. */
enum { RECORD_WARM_UP = 15 };

void record_init(train_record *r, int steps, size_t members);
void record_free(train_record *r);

/* Runs a step and fills its sample. */
typedef void (*record_step)(ted4_trainer *t, void *sample);

/* Trains with parts_options and replaces the content of the record. Ends the program on failure. */
void record_training(train_record *r, ted4_dataset *d, const ted4_parallel *team, record_step step);

/* Computes the median of each member over the steps of a stage without the first ones; 0 if there
 * are none. */
void record_medians(const train_record *r, int stage, double *median);

/* Print the line with the scene and the number of steps, without a line end, and the line about a
 * stage. */
void record_print_title(const train_record *r, const ted4_dataset *d, char *const *argv);
void record_print_stage(const train_record *r, int stage);

#endif
