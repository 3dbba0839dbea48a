/* dataset.h - posed images over time, independent of the layout that they were loaded from.
 * There is one loader per layout (load_*.c).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DATASET_H
#define TED4_DATASET_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/parallel.h"

/* Pinhole camera after undistortion and downscaling. Camera axes point right, down, forward; x_cam
 * = R x_world + t. Pixel centres are at + 0.5. */
typedef struct {
    int width, height;
    double fx, fy, cx, cy;
    double R[9], t[3];
} ted4_camera;

typedef struct {
    ted4_camera camera;
    uint32_t frame;     /* index of its time, 0 .. n_frames - 1; time is frame / (n_frames - 1) */
    uint32_t camera_id; /* pictures of one physical camera have the same number */
    uint8_t is_test;
    char *path; /* image file; owned by the dataset */
} ted4_picture;

typedef struct ted4_dataset {
    char *layout; /* "colmap", "blender", "nerfstudio", ...; owned */
    /* [n_pictures] training pictures before test pictures, each in the order of the layout */
    ted4_picture *pictures;
    size_t n_pictures;
    uint32_t n_frames, n_cameras;
    float *points;      /* [n_points][3] in world coordinates; drawn at random if random_points */
    uint8_t *point_rgb; /* [n_points][3] */
    size_t n_points;
    int random_points;
    double rate; /* frames per second; 0: unknown */
    uint8_t background[3];
    int has_alpha;    /* 1: a picture has transparency, and lies on the background */
    uint64_t content; /* digest of all picture files; 0 before ted4_dataset_verify */
    /* [n_warnings] what was skipped or corrected while loading, one sentence per kind; owned */
    char **warnings;
    size_t n_warnings;
    /* Number of threads for ted4_dataset_ahead. It is 0 after loading; the caller may change it. No
     * pixel depends on it. */
    int ahead;
    struct ted4_source *sources;    /* [n_pictures] how to decode each file; owned, opaque */
    struct ted4_image_cache *cache; /* owned, opaque */
} ted4_dataset;

typedef struct {
    /* downscale: integer factor, by area averaging; 1: none. Reduced copies that the layout
     * provides are used. */
    int downscale;
    int white;          /* background of RGBA images; 1: white (default), 0: black */
    uint32_t seed;      /* for random points */
    size_t cache_bytes; /* most memory for decoded pixels */
    /* max_frames: keep only the first so many times; 0: 300 for Neu3D, all for other layouts */
    uint32_t max_frames;
    /* premultiplied: colours of RGBA images are already multiplied by alpha; 0: straight alpha, as
     * PNG specifies */
    int premultiplied;
    /* hold_out: [n_hold_out] cameras whose pictures are the test pictures, in place of the layout's
     * split. Each is named by the camera's label, a folder of cameras, or the name of one of its
     * pictures. Borrowed. */
    const char *const *hold_out;
    size_t n_hold_out; /* 0: use the layout's split */
    /* Called about once per second while a video is unpacked, with the video's file and the number
     * of frames so far. NULL: not called. */
    void (*unpacking)(void *user, const char *video, size_t frames);
    void *user;
} ted4_dataset_options;

/* An error message of the form "file:line-or-field: what was found, what was expected". */
typedef struct {
    char text[1024];
} ted4_message;

/* Loads a scene. Every picture is opened once to read its size; pixels are decoded on demand.
 * Returns 0, or -1 with *m filled and *d empty. */
int ted4_dataset_load(ted4_dataset *d, const char *folder, const ted4_dataset_options *o,
                      ted4_message *m);
void ted4_dataset_free(ted4_dataset *d);

/* Returns the interleaved RGB bytes [height][width][3] of picture i, after compositing,
 * undistortion and downscaling. The pointer is valid until ted4_dataset_release(d, i). May be
 * called from several threads. Returns NULL with *m filled if the file can no longer be decoded, or
 * has changed since it was first decoded. */
const uint8_t *ted4_dataset_pixels(ted4_dataset *d, size_t i, ted4_message *m);
void ted4_dataset_release(ted4_dataset *d, size_t i);

/* Announces that the pixels of picture i will be needed soon: d->ahead threads decode it in the
 * background where that helps. */
void ted4_dataset_ahead(ted4_dataset *d, size_t i);
/* Largest useful number of announced pictures, and of decoding threads. A training step takes a few
 * milliseconds on 64 cores, and decoding a large picture some tens of milliseconds on one
 * thread. */
enum { TED4_DATASET_AHEAD = 16 };

/* Decodes every picture once, on the threads of p (NULL: on the calling thread), and sets
 * d->content. May add warnings. Returns 0, or -1 with *m naming the first picture that cannot be
 * decoded. */
int ted4_dataset_verify(ted4_dataset *d, const ted4_parallel *p, ted4_message *m);

/* Returns a digest of everything in the scene that training depends on: cameras and lenses, times,
 * split, points, background and d->content. It does not depend on where the files are stored. */
uint64_t ted4_dataset_digest(const ted4_dataset *d);

/* Prints a summary of the dataset: layout, pictures, cameras, frames, sizes, focal lengths, camera
 * centres, points, background, and the rate if there are several frames. */
void ted4_dataset_print(const ted4_dataset *d, FILE *out);

#endif
