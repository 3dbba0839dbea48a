/* image_file.h - reads one picture file into bytes; its signature tells PNG from JPEG. Depends on
 * data/dataset.h for ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_IMAGE_FILE_H
#define TED4_IMAGE_FILE_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

/* Largest accepted width and height; guards size computations against overflow. */
#define TED4_IMAGE_MAX_SIDE 32768

/* A picture as interleaved bytes [height][width][channels], display-referred sRGB, with straight
 * alpha. */
typedef struct {
    int width, height;
    int channels;   /* 3, or 4 when the file carries transparency */
    uint8_t *bytes; /* owned; free() it */
    /* Digest of the file: equal for equal files; different files collide with probability 2^-64. */
    uint64_t digest;
} ted4_image;

typedef struct {
    int width, height;
    int has_alpha;
    int orientation; /* as ted4_exif_orientation; 1 for PNG */
} ted4_image_header;

/* Reads a picture. Greyscale and palettes are expanded to RGB, and 16 bits are rounded to 8.
 * Returns 0, or -1 with *m filled and image->bytes NULL. */
int ted4_image_read(const char *path, ted4_image *image, ted4_message *m);

/* Reads only the header. No pixel is decoded, so that a truncated file is not detected. A JPEG
 * whose colours are neither greyscale nor RGB (CMYK) is refused here. Returns 0, or -1 with *m
 * filled. */
int ted4_image_probe(const char *path, ted4_image_header *header, ted4_message *m);

/* exif.c: returns the EXIF orientation from the payload of a JPEG's APP1 segment: 1 is upright
 * (also if the segment is damaged or does not say), 3 is upside down, 6 and 8 are quarter turns; 2,
 * 4, 5, 7 are the same, mirrored. Values 5 to 8 exchange width and height when shown. */
int ted4_exif_orientation(const uint8_t *segment, size_t size);

/* image_jpeg.c: decodes a JPEG for ted4_image_read. Returns 0, or -1 with *m filled. */
int ted4_jpeg_decode(const char *path, const uint8_t *bytes, size_t size, ted4_image *image,
                     ted4_message *m);

/* image_png.c: decodes an interlaced 16-bit PNG for ted4_image_read. Returns 0, or -1 with *m
 * filled. */
int ted4_png_decode_interlaced(const char *path, const uint8_t *bytes, size_t size,
                               ted4_image *image, ted4_message *m);

#endif
