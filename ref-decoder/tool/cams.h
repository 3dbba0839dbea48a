/* cams.h - the chunk CAMS (spec 16.4): the cameras that took a scene's pictures, or a path for a
 * player's camera, and which way is up.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_CAMS_H
#define TED4_TOOL_CAMS_H

#include <stddef.h>
#include <stdint.h>

#include "render/raster.h"
#include "times.h"

enum {
    TED4_CAMS_HEAD = 20,    /* bytes before the cameras */
    TED4_CAMS_CAMERA = 80,  /* bytes of a camera */
    TED4_CAMS_MOST = 65536, /* cameras of a chunk */
    TED4_CAMS_SIDE = 16384  /* largest width and height */
};

typedef enum { TED4_CAMS_TAKEN, TED4_CAMS_PATH, TED4_CAMS_KINDS } ted4_cams_kind;

/* A camera of the chunk. */
typedef struct {
    ted4_view view; /* near_z and background are 0 */
    ted4_time time; /* den 0: the camera belongs to all times */
} ted4_cams_camera;

/* A chunk's payload. Fixed-size cameras, so that reading needs no memory. */
typedef struct {
    float up[3]; /* unit vector in scene coordinates; all 0: unknown */
    ted4_cams_kind kind;
    size_t n;
    const uint8_t *camera; /* borrowed: [n][TED4_CAMS_CAMERA] */
} ted4_cams;

/* Reads a payload. Returns 0, or -1 if it breaks a rule of 16.4: then nothing of it may be used.
 * All cameras are checked. */
int ted4_cams_read(const uint8_t *payload, size_t size, ted4_cams *c);
/* Returns camera i < c->n. */
ted4_cams_camera ted4_cams_get(const ted4_cams *c, size_t i);

/* Writes the first TED4_CAMS_HEAD bytes of a payload, and one camera. */
void ted4_cams_put_head(uint8_t *to, const float up[3], ted4_cams_kind kind, size_t n);
void ted4_cams_put(uint8_t to[TED4_CAMS_CAMERA], const ted4_cams_camera *camera);

#endif
