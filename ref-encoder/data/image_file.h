/* image_file.h - one picture file, PNG or JPEG by its signature, to bytes.
 * Depends on data/dataset.h for ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_IMAGE_FILE_H
#define TED4_IMAGE_FILE_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

/* Largest side that is accepted; guards sizes against overflow. */
#define TED4_IMAGE_MAX_SIDE 32768

/* Interleaved bytes [height][width][channels], display-referred sRGB; alpha not premultiplied. */
typedef struct {
    int width, height;
    int channels;    /* 3, or 4 when the file carries transparency */
    uint8_t *bytes;  /* owned; free() it */
    uint64_t digest; /* of the file: equal for equal files, and else different but for bad luck of
                        2^-64 */
} ted4_image;

typedef struct {
    int width, height;
    int has_alpha;
    int orientation; /* as ted4_exif_orientation; 1 of PNG */
} ted4_image_header;

/* Grey and palette are expanded, 16 bits rounded to 8. 0, or -1 with *m filled and image->bytes
 * NULL. */
int ted4_image_read(const char *path, ted4_image *image, ted4_message *m);

/* The header only: no pixel is decoded, so a file cut short later on is not noticed. A JPEG of
 * other colours than grey or RGB (CMYK) is refused here. 0, or -1 with *m filled. */
int ted4_image_probe(const char *path, ted4_image_header *header, ted4_message *m);

/* exif.c: how the camera was held, from the payload of a JPEG's APP1 segment: 1 upright (also when
 * the segment does not tell, or is damaged), 3 upside down, 6 and 8 turned by a quarter; 2, 4, 5, 7
 * the same mirrored. 5 to 8 show width and height exchanged. */
int ted4_exif_orientation(const uint8_t *segment, size_t size);

/* image_jpeg.c: the JPEG half of ted4_image_read. */
int ted4_jpeg_decode(const char *path, const uint8_t *bytes, size_t size, ted4_image *image,
                     ted4_message *m);

/* image_png.c: the same of an interlaced PNG of 16 bits. */
int ted4_png_decode_interlaced(const char *path, const uint8_t *bytes, size_t size,
                               ted4_image *image, ted4_message *m);

#endif
