/* video_kind.h - which kind of video a file is, by its first bytes. Depends on data/dataset.h for
 * ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIDEO_KIND_H
#define TED4_VIDEO_KIND_H

#include "data/dataset.h"

/* Returns the name of the ffmpeg demuxer that reads the file, which ffmpeg must not guess itself:
 * it would take a playlist in any disguise, and open the files that it lists. Returns NULL with *m
 * filled if the file cannot be read or has no signature that is known here, as text has none. */
const char *ted4_video_demuxer(const char *video, ted4_message *m);

#endif
