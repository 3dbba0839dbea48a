/* scene_folder.h - a folder of files for scene loaders, created once per process below $TMPDIR or
 * /tmp, and removed when the process ends.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCENE_FOLDER_H
#define TED4_SCENE_FOLDER_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

/* Chooses the folder of a harness, which is empty at first; the functions below use the folder
 * chosen last. Returns its path. */
const char *fuzz_scene(const char *name);

/* Writes a file with these bytes in the folder, creates the folders on the way, and returns its
 * path. The text is valid until the next call. A file that cannot be written ends the process. */
const char *fuzz_file(const char *name, const void *bytes, size_t size);
const char *fuzz_text(const char *name, const char *text);
/* Writes a picture of 2 by 2 pixels. */
const char *fuzz_picture(const char *name);
void fuzz_no_file(const char *name);

/* Loads the folder as a scene and checks the result. Claims: either 0 and a dataset whose numbers
 * are finite, whose pictures are at most TED4_IMAGE_MAX_SIDE wide, and whose frames and cameras are
 * numbered without a gap; or a message of one line, and an empty dataset. Pixels of the first
 * picture are read too. Returns the result of ted4_dataset_load(). */
int fuzz_load_scene(void);

/* Checks that a message is not empty and ends within its buffer. */
void fuzz_check_message(const ted4_message *m);

#endif
