/* image_file.c - see image_file.h. PNG files are read through libpng's simplified interface, which
 * needs no setjmp here. Headers are read by hand, because with either library a decoder must be set
 * up before it gives the size.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/image_file.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "data/data_util.h"

static const uint8_t png_signature[8] = { 0x89, 'P', 'N', 'G', 13, 10, 26, 10 };

static uint32_t be32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static int is_jpeg(const uint8_t *p, size_t size)
{
    return size >= 3 && p[0] == 0xff && p[1] == 0xd8 && p[2] == 0xff;
}

static int check_size(const char *path, uint32_t width, uint32_t height, ted4_message *m)
{
    if (width < 1 || height < 1 || width > TED4_IMAGE_MAX_SIDE || height > TED4_IMAGE_MAX_SIDE)
        return ted4_say(m, "%s: picture of %ux%u pixels, expected 1 to %d a side", path,
                        (unsigned)width, (unsigned)height, TED4_IMAGE_MAX_SIDE);
    return 0;
}

/* PNG: IHDR is the first chunk. Transparency is stated by bit 2 of its colour type, or by a tRNS
 * chunk before the data. */
static int probe_png(FILE *f, const char *path, ted4_image_header *h, ted4_message *m)
{
    uint8_t c[8 + 13 + 4];

    if (fread(c, 1, sizeof c, f) != sizeof c || be32(c) != 13 || memcmp(c + 4, "IHDR", 4) != 0)
        return ted4_say(m, "%s: PNG without a complete IHDR chunk", path);
    if (check_size(path, be32(c + 8), be32(c + 12), m) != 0)
        return -1;
    h->width = (int)be32(c + 8);
    h->height = (int)be32(c + 12);
    h->has_alpha = (c[17] & 4) != 0;
    while (!h->has_alpha && fread(c, 1, 8, f) == 8 && memcmp(c + 4, "IDAT", 4) != 0) {
        h->has_alpha = memcmp(c + 4, "tRNS", 4) == 0;
        /* PNG's own bound, which holds in a long of 32 bits too. */
        if (be32(c) > INT32_MAX)
            return ted4_say(m, "%s: PNG with a chunk of more than 2^31 - 1 bytes", path);
        if (fseek(f, (long)be32(c), SEEK_CUR) != 0 || fseek(f, 4, SEEK_CUR) != 0)
            break;
    }
    return 0;
}

static int is_frame_header(int marker)
{
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

enum { APP1 = 0xe1 };

/* Reads the payload of an APP1 segment, of which a file may have several. Returns 0, or -1 if the
 * file is truncated. */
static int read_exif(FILE *f, int size, ted4_image_header *h)
{
    uint8_t *payload = malloc((size_t)size + 1);
    const int whole = payload != NULL && fread(payload, 1, (size_t)size, f) == (size_t)size;

    if (whole && h->orientation == 1)
        h->orientation = ted4_exif_orientation(payload, (size_t)size);
    free(payload);
    return whole ? 0 : -1;
}

/* JPEG: segments of the form "ff marker length16 ..." precede the frame header, which holds
 * precision, height and width. */
static int probe_jpeg(FILE *f, const char *path, ted4_image_header *h, ted4_message *m)
{
    uint8_t s[8];
    int c = 0;

    if (fseek(f, 2, SEEK_SET) != 0)
        return ted4_say(m, "%s: %s", path, strerror(errno));
    for (;;) {
        while ((c = fgetc(f)) != EOF && c != 0xff)
            ;
        while (c == 0xff)
            c = fgetc(f);
        if (c == EOF || c == 0xd9 || c == 0xda || fread(s, 1, 2, f) != 2)
            break;
        const int length = s[0] << 8 | s[1];
        if (is_frame_header(c)) {
            if (length < 8 || fread(s, 1, 6, f) != 6)
                break;
            if (s[5] != 1 && s[5] != 3)
                return ted4_say(m, "%s: JPEG of %d colours (CMYK?), expected grey or RGB", path,
                                s[5]);
            h->height = s[1] << 8 | s[2];
            h->width = s[3] << 8 | s[4];
            return check_size(path, (uint32_t)h->width, (uint32_t)h->height, m);
        }
        if (length < 2 ||
            (c == APP1 ? read_exif(f, length - 2, h) : fseek(f, length - 2, SEEK_CUR)) != 0)
            break;
    }
    return ted4_say(m, "%s: JPEG without a frame header (cut short?)", path);
}

int ted4_image_probe(const char *path, ted4_image_header *header, ted4_message *m)
{
    uint8_t head[8];
    int result;
    FILE *f = ted4_is_folder(path) ? NULL : fopen(path, "rb");

    memset(header, 0, sizeof *header);
    header->orientation = 1;
    if (f == NULL)
        return ted4_say(m, "%s: %s", path,
                        ted4_is_folder(path) ? "a folder, expected a picture" : strerror(errno));
    const size_t n = fread(head, 1, sizeof head, f);
    if (n == sizeof head && memcmp(head, png_signature, sizeof head) == 0)
        result = probe_png(f, path, header, m);
    else if (is_jpeg(head, n))
        result = probe_jpeg(f, path, header, m);
    else
        result = ted4_say(m, "%s: neither PNG nor JPEG", path);
    fclose(f);
    return result;
}

/* Does the header state 16 bits and interlacing? The offsets are those of the two fields. */
static int is_wide_interlaced(const uint8_t *bytes, size_t size)
{
    enum { DEPTH = 24, INTERLACE = 28 };

    return size > INTERLACE && bytes[DEPTH] == 16 && bytes[INTERLACE] != 0;
}

/* Removes the chunks by which libpng would convert colours: pixels are used as they are stored, as
 * those of JPEG and video are, whatever a program has stated about them. Returns the new size. */
static size_t drop_colour_tags(uint8_t *bytes, size_t size)
{
    static const char *const tags[] = { "gAMA", "cHRM", "iCCP", "sRGB" };
    size_t from = sizeof png_signature, to = from;

    while (from < size) {
        const size_t left = size - from;
        const size_t whole = left >= 12 && be32(bytes + from) <= left - 12
                                 ? be32(bytes + from) + (size_t)12
                                 : left; /* libpng says what is wrong with it */
        int drop = 0;

        for (size_t i = 0; whole >= 12 && i < sizeof tags / sizeof *tags; i++)
            drop |= memcmp(bytes + from + 4, tags[i], 4) == 0;
        if (!drop) {
            memmove(bytes + to, bytes + from, whole);
            to += whole;
        }
        from += whole;
    }
    return to;
}

/* Decodes a PNG. 16-bit files are taken as sRGB, like all others, and not as linear light. */
static int decode_png(const char *path, const uint8_t *bytes, size_t size, ted4_image *image,
                      ted4_message *m)
{
    png_image p;

    if (is_wide_interlaced(bytes, size))
        return ted4_png_decode_interlaced(path, bytes, size, image, m);
    memset(&p, 0, sizeof p);
    p.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&p, bytes, size))
        return ted4_say(m, "%s: PNG: %s", path, p.message);
    p.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    image->channels = (p.format & PNG_FORMAT_FLAG_ALPHA) != 0 ? 4 : 3;
    p.format = image->channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    if (check_size(path, p.width, p.height, m) != 0) {
        png_image_free(&p);
        return -1;
    }
    image->width = (int)p.width;
    image->height = (int)p.height;
    /* At the largest accepted side, RGBA takes 2^32 bytes. */
    if ((size_t)p.width * p.height <= SIZE_MAX / (size_t)image->channels)
        image->bytes = malloc((size_t)p.width * p.height * (size_t)image->channels);
    if (image->bytes == NULL) {
        png_image_free(&p);
        return ted4_say_no_memory(m);
    }
    if (!png_image_finish_read(&p, NULL, image->bytes, 0, NULL)) {
        free(image->bytes);
        image->bytes = NULL;
        return ted4_say(m, "%s: PNG: %s (cut short or damaged)", path, p.message);
    }
    return 0;
}

int ted4_image_read(const char *path, ted4_image *image, ted4_message *m)
{
    uint8_t *bytes;
    size_t size;
    int result;

    memset(image, 0, sizeof *image);
    if (ted4_read_whole(path, &bytes, &size, m) != 0)
        return -1;
    const uint64_t digest = XXH3_64bits(bytes, size);

    if (size >= sizeof png_signature && memcmp(bytes, png_signature, sizeof png_signature) == 0)
        result = decode_png(path, bytes, drop_colour_tags(bytes, size), image, m);
    else if (is_jpeg(bytes, size))
        result = ted4_jpeg_decode(path, bytes, size, image, m);
    else
        result = ted4_say(m, "%s: neither PNG nor JPEG", path);
    image->digest = digest;
    free(bytes);
    return result;
}
