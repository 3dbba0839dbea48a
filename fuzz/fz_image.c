/* fz_image.c - a PNG or JPEG file: its header alone, the whole file, and the same bytes as an EXIF
 * segment. Pictures of more than MOST pixels are not decoded here, so that a run stays fast;
 * reading their header still tests whether they are accepted. Claims: header and picture have the
 * same size, 1 to TED4_IMAGE_MAX_SIDE per side, and an orientation of 1 to 8; the pixels have 3 or
 * 4 channels, and all of them are set. Otherwise there is a message and no pixel. Reading a second
 * time gives the same result.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "data/image_file.h"
#include "harness.h"
#include "scene_folder.h"

enum { MOST = 1 << 18 };

static void check_pixels(const char *path, const ted4_image_header *h)
{
    ted4_image a, b;
    ted4_message m;

    if (ted4_image_read(path, &a, &m) != 0) {
        fuzz_check_message(&m);
        fuzz_require(a.bytes == NULL, "no pixel");
        return;
    }
    fuzz_require(a.width == h->width && a.height == h->height, "the size of the header");
    fuzz_require(a.channels == 3 || a.channels == 4, "3 or 4 channels");
    fuzz_require(ted4_image_read(path, &b, &m) == 0 && b.digest == a.digest, "again");
    fuzz_require(memcmp(a.bytes, b.bytes,
                        (size_t)a.width * (size_t)a.height * (size_t)a.channels) == 0,
                 "the same pixels");
    free(a.bytes);
    free(b.bytes);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const int orientation = ted4_exif_orientation(data, size);
    ted4_image_header h;
    ted4_message m;
    const char *path;

    fuzz_require(orientation >= 1 && orientation <= 8, "an orientation");
    (void)fuzz_scene("image");
    path = fuzz_file("picture", data, size);
    if (ted4_image_probe(path, &h, &m) != 0) {
        fuzz_check_message(&m);
        return 0;
    }
    fuzz_require(h.width >= 1 && h.height >= 1 && h.width <= TED4_IMAGE_MAX_SIDE &&
                     h.height <= TED4_IMAGE_MAX_SIDE,
                 "a size");
    fuzz_require(h.orientation >= 1 && h.orientation <= 8, "an orientation of the file");
    if ((int64_t)h.width * h.height <= MOST)
        check_pixels(path, &h);
    return 0;
}
