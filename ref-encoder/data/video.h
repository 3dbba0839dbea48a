/* video.h - video files as folders of pictures, taken apart by the program ffmpeg.
 * Depends on data/dataset.h for ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIDEO_H
#define TED4_VIDEO_H

#include <stddef.h>
#include "data/dataset.h"

/* The folder that holds the first most frames of a video (0: all, at most TED4_MAX_FRAMES) as
 * pictures 000001.png, 000002.png, ...: frames as stored, none doubled or dropped for the sake of
 * an even rate. It is made once, in $XDG_CACHE_HOME/ted4, else in ted4-UID in $TMPDIR or /tmp,
 * under a name that changes with the video's path, size and date; it may be removed at any time
 * when no program reads it. o->unpacking hears of it. Owned by the caller; NULL with *m filled. */
char *ted4_video_unpack(const char *video, size_t most, const ted4_dataset_options *o,
                        ted4_message *m);

#endif
