/* dataset.h - posed images in time, whatever layout they came in.
 * Loaders: one file a layout (load_*.c).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DATASET_H
#define TED4_DATASET_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/parallel.h"

/* Pinhole after undistortion and downscaling; camera axes right, down, forward; x_cam = R x_world +
 * t. Pixel centres at + 0.5. */
typedef struct {
    int width, height;
    double fx, fy, cx, cy;
    double R[9], t[3];
} ted4_camera;

typedef struct {
    ted4_camera camera;
    uint32_t frame;     /* index of its time, 0 .. n_frames - 1; t = frame / (n_frames - 1) */
    uint32_t camera_id; /* same physical camera, same number */
    uint8_t is_test;
    char *path; /* image file; owned by the dataset */
} ted4_picture;

typedef struct ted4_dataset {
    char *layout;           /* "colmap", "blender", "nerfstudio", ...; owned */
    ted4_picture *pictures; /* [n_pictures] sorted: test flag apart, by file order of the layout */
    size_t n_pictures;
    uint32_t n_frames, n_cameras;
    float *points;      /* [n_points][3] world; may be random, see random_points */
    uint8_t *point_rgb; /* [n_points][3] */
    size_t n_points;
    int random_points;
    double rate; /* frames a second, 0: unknown */
    uint8_t background[3];
    uint64_t content; /* digest of all picture files; 0 until ted4_dataset_verify */
    char **warnings;  /* [n_warnings] what was passed over or put right while loading, one
                       * sentence a kind; owned */
    size_t n_warnings;
    int ahead; /* threads for ted4_dataset_ahead; 0 after loading, the caller may change it: no
                  pixel depends on it */
    struct ted4_source *sources;    /* [n_pictures] how files become pixels; owned, opaque */
    struct ted4_image_cache *cache; /* owned, opaque */
} ted4_dataset;

typedef struct {
    int downscale;      /* integer factor, area average; 1 = none. A layout may hold reduced copies,
                           which are used */
    int white;          /* background of RGBA images: 1 white (default), 0 black */
    uint32_t seed;      /* for random points */
    size_t cache_bytes; /* bound of decoded pixels kept in memory */
    uint32_t max_frames;         /* only so many times, the first ones; 0: 300 of Neu3D, else all */
    int premultiplied;           /* colours of RGBA images are multiplied by alpha already; 0:
                                  * straight, as PNG has it */
    const char *const *hold_out; /* [n_hold_out] cameras whose pictures are test, and no others,
                                  * whatever the layout says: the camera's label, its folder, or
                                  * the name of a picture of it; borrowed */
    size_t n_hold_out;           /* 0: the layout's split */
    /* Told about once a second while a video is unpacked: its file, and how many frames there are
     * by then. NULL: nobody is told. */
    void (*unpacking)(void *user, const char *video, size_t frames);
    void *user;
} ted4_dataset_options;

/* One clear message, "file:line-or-field: what was found, what was expected". */
typedef struct {
    char text[1024];
} ted4_message;

/* 0, or -1 with *m filled and *d empty. Every picture is opened once to read its size; pixels are
 * decoded on demand. */
int ted4_dataset_load(ted4_dataset *d, const char *folder, const ted4_dataset_options *o,
                      ted4_message *m);
void ted4_dataset_free(ted4_dataset *d);

/* Interleaved RGB bytes [height][width][3] of picture i, composited, undistorted, downscaled. The
 * pointer stays valid until ted4_dataset_release(d, i). Safe from several threads. NULL with *m
 * filled when the file cannot be decoded any more, or is not the one that was decoded before. */
const uint8_t *ted4_dataset_pixels(ted4_dataset *d, size_t i, ted4_message *m);
void ted4_dataset_release(ted4_dataset *d, size_t i);

/* Says that the pixels of picture i will be asked for soon: d->ahead threads decode them meanwhile
 * where that is of use. */
void ted4_dataset_ahead(ted4_dataset *d, size_t i);
/* More pictures than this need not be announced at a time, and more threads do not decode them.
 * A step on 64 cores takes a few milliseconds, and a large picture's file some tens of one
 * thread's. */
enum { TED4_DATASET_AHEAD = 16 };

/* Decodes every picture once, on the threads of p (NULL: here), and sets d->content. 0, or -1 with
 * *m naming the first that cannot be decoded. May add warnings. */
int ted4_dataset_verify(ted4_dataset *d, const ted4_parallel *p, ted4_message *m);

/* What a training sees of the scene in one number: cameras, times, split, points, background,
 * d->content; not where its files lie. */
uint64_t ted4_dataset_digest(const ted4_dataset *d);

/* What was found, for a reader: layout, pictures, cameras, frames, sizes, focal lengths, camera
 * centres, points, background, and the rate where there are several frames. */
void ted4_dataset_print(const ted4_dataset *d, FILE *out);

#endif
