/* belongs.h - tests whether a .ted4 file can belong to a scene. The test compares what both say
 * about time and space, and the pictures: if the rendered pictures have a larger error than one
 * constant colour per picture, the file was trained on another scene, or hardly at all.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BELONGS_H
#define TED4_BELONGS_H

#include <stddef.h>
#include <stdint.h>

#include "data/dataset.h"
#include "ted4.h"
#include "tool/camera_list.h"

/* Returns 1, or 0 with why filled: the number of frames or the frame rate differs, or too few
 * cameras see the cube in which the anchors of the file lie. */
int ted4_belongs_scene(const ted4_info *file, const ted4_dataset *d, char *why, size_t why_size);

/* Returns 1, or 0 with why filled: no picture of the split is as large as any from which the file
 * was learnt, so that its Gaussians have another blur (annex I.4). taken: the cameras that the file
 * lists; if it lists none, nothing is known. */
int ted4_belongs_size(const ted4_camera_list *taken, const ted4_dataset *d, int want_test,
                      char *why, size_t why_size);

/* Sums of the squared errors of all pictures so far: of the rendered pictures, and of the mean
 * colour of each picture. */
typedef struct {
    double drawn, mean;
} ted4_belongs_sum;

/* Adds a picture to the sums. truth, drawn: [pixels][3]. */
void ted4_belongs_add(ted4_belongs_sum *s, const uint8_t *truth, const uint8_t *drawn,
                      size_t pixels);
/* Returns 1, or 0 with why filled: the error of the rendered pictures is the larger one. */
int ted4_belongs_pictures(const ted4_belongs_sum *s, char *why, size_t why_size);

#endif
