/* video.h - unpacks video files into folders of pictures with the program ffmpeg. Depends on
 * data/dataset.h for ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIDEO_H
#define TED4_VIDEO_H

#include <stddef.h>
#include "data/dataset.h"

/* Returns the path of the folder that holds the first most frames of a video (all if most is 0; at
 * most TED4_MAX_FRAMES) as pictures 000001.png, 000002.png and so on. These are the frames as
 * stored: none is duplicated or dropped to even out the frame rate. The folder is made once, in
 * $XDG_CACHE_HOME/ted4, else in ted4-UID in $TMPDIR or /tmp; its name depends on the video's path,
 * size and date. It may be removed whenever no program reads it. Progress is reported to
 * o->unpacking. The path is owned by the caller. Returns NULL with *m filled on failure. */
char *ted4_video_unpack(const char *video, size_t most, const ted4_dataset_options *o,
                        ted4_message *m);

#endif
