/* belongs.h - can a file be of a scene? Asked of what both say about time and space, and of the
 * pictures: a model that is further from them than one colour each was made for others.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BELONGS_H
#define TED4_BELONGS_H

#include <stddef.h>
#include <stdint.h>

#include "data/dataset.h"
#include "ted4.h"

/* 1, or 0 with why filled: number of times, frames a second, or cameras that do not look at where
 * the file lies. */
int ted4_belongs_scene(const ted4_info *file, const ted4_dataset *d, char *why, size_t why_size);

/* Squared errors of all pictures so far, against the drawn ones and against the mean colour of
 * each. */
typedef struct {
    double drawn, mean;
} ted4_belongs_sum;

void ted4_belongs_add(ted4_belongs_sum *s, const uint8_t *truth, const uint8_t *drawn,
                      size_t pixels);
/* 1, or 0 with why filled. */
int ted4_belongs_pictures(const ted4_belongs_sum *s, char *why, size_t why_size);

#endif
