/* scene_folder.h - a folder of files that scene loaders read: made once a process, below $TMPDIR or
 * /tmp, removed when it ends.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCENE_FOLDER_H
#define TED4_SCENE_FOLDER_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

/* The folder of a harness, empty at first; all below is about the one chosen last. Gives its path.
 */
const char *fuzz_scene(const char *name);

/* Path of a file of the folder with those bytes; folders on the way are made. The text lives until
 * the next call. What cannot be written ends the process. */
const char *fuzz_file(const char *name, const void *bytes, size_t size);
const char *fuzz_text(const char *name, const char *text);
/* 2 by 2 pixels. */
const char *fuzz_picture(const char *name);
void fuzz_no_file(const char *name);

/* Loads the folder as a scene and looks at all that comes out. Claims: 0 with a dataset whose
 * numbers are finite, whose pictures are at most TED4_IMAGE_MAX_SIDE wide, whose frames and cameras
 * are numbered without a gap; or a message of one line, and an empty dataset. Pixels of the first
 * picture are read too. Gives what ted4_dataset_load() gives. */
int fuzz_load_scene(void);

/* A message says something, in its own room. */
void fuzz_check_message(const ted4_message *m);

#endif
