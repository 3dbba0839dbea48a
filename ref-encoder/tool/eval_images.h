/* eval_images.h - pictures that ted4eval writes: the folders of --images, and the sheet. Depends on
 * data/dataset.h, tool/picture_out.h, file_out.h, moving_pixels.h, sheet.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EVAL_IMAGES_H
#define TED4_EVAL_IMAGES_H

#include "data/dataset.h"
#include "sheet.h"

typedef struct {
    const char *folder;
    size_t number; /* of the picture: it is named NNNNN.png */
} ted4_eval_images;

/* Makes the folder unless it is there, and unless overwrite is set, makes sure that none of the
 * pictures 0 to n - 1 is in it. moving: their masks count as well. Returns 0, or -1 with *m
 * filled. */
int ted4_eval_images_begin(const char *folder, size_t n, int moving, int overwrite,
                           ted4_message *m);

/* Writes a picture to the folders truth, ours, and error (5 times the difference), and with a
 * median (moving_pixels.h; or else NULL) its mask to moving. truth, ours, median:
 * [height][width][3] of the camera. Returns 0, or -1 with *m filled. */
int ted4_eval_images_write(const ted4_eval_images *to, const ted4_camera *c, const uint8_t *truth,
                           const uint8_t *ours, const uint8_t *median, ted4_message *m);

/* Writes a sheet as ted4_file_keep does, as a PNG. */
int ted4_eval_sheet_write(const ted4_sheet *s, const char *path, int force, char *why,
                          size_t why_size);

#endif
