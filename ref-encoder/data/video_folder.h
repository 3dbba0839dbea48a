/* video_folder.h - folders of the video cache that are being filled. They have a name of their own,
 * and whoever fills one holds a lock on it, so that those whose program was killed can be told from
 * others and removed. A signal that ends the program removes its folder (tool/leftovers.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIDEO_FOLDER_H
#define TED4_VIDEO_FOLDER_H

#include "data/data_util.h"

/* The frames of a video, from 1 on, and the file that tells how many a complete folder holds. */
#define TED4_VIDEO_FRAME "%06d.png"
#define TED4_VIDEO_COUNT "count"

/* A folder that is being filled. */
typedef struct {
    char *path; /* owned: FINAL.XXXXXX */
    int lock;   /* descriptor, or -1 */
} ted4_video_folder;

/* Makes a new folder beside the final one, and locks it. Returns 0, or -1 with *m filled and
 * nothing to free. */
int ted4_video_folder_make(ted4_video_folder *v, const char *final, ted4_message *m);

/* Removes the folder, if it still has its own name, and frees what *v owns. */
void ted4_video_folder_leave(ted4_video_folder *v);

/* Removes the folders in cache that nobody fills any more. They are those that nobody has locked,
 * and in which nothing has been made for a minute: a program locks its folder later than that only
 * if it was stopped in between. */
void ted4_video_folder_sweep(const char *cache);

/* Removes a folder that holds only files. */
void ted4_video_folder_remove(const char *path);

#endif
