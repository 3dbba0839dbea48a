/* video_out.h - pictures as a video file, by the program ffmpeg.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIDEO_OUT_H
#define TED4_VIDEO_OUT_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>

#include "output.h"

/* A running ffmpeg. The file appears under its name when it is complete. */
typedef struct {
    int pipe; /* to ffmpeg: raw pictures */
    pid_t child;
    FILE *messages;   /* what ffmpeg says; owned */
    size_t bytes;     /* of a picture */
    int broken;       /* 1: a picture could not be written */
    ted4_output file; /* ffmpeg writes its temporary file, too */
} ted4_video_out;

/* Starts ffmpeg for pictures of width x height pixels, rate_num / rate_den per second. Odd sizes
 * get a black column or row. SIGPIPE must be ignored by the program. Returns 0, or -1 with a reason
 * in why. */
int ted4_video_out_open(ted4_video_out *v, const char *path, int width, int height,
                        uint32_t rate_num, uint32_t rate_den, char *why, size_t why_size);
/* Writes one picture, [height][width][3] bytes of sRGB. Returns 0, or -1 if ffmpeg has ended:
 * ted4_video_out_close then knows why. */
int ted4_video_out_write(ted4_video_out *v, const uint8_t *rgb);
/* Waits for ffmpeg and gives the file its name. If keep is 0, or ffmpeg failed, no file is left.
 * Returns 0, or -1 with a reason in why. */
int ted4_video_out_close(ted4_video_out *v, int keep, char *why, size_t why_size);

#endif
