/* to_jpeg.c - converts a PNG picture to a smaller JPEG, which the pages show.
 *     to_jpeg IN.png OUT.jpg
 * Exit status: 0, or 3 with a message on standard error.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <png.h>
#include <jpeglib.h>

/* With this quality, all pictures of the pages take 0.6 MB together, and error pictures still show
 * where the errors are. */
enum { QUALITY = 40, FINE = 0, TROUBLE = 3 };

typedef struct {
    int width, height;
    uint8_t *rgb; /* owned: [height][width][3] */
} picture;

static int failed(const char *path, const char *why)
{
    fprintf(stderr, "to_jpeg: %s: %s\n", path, why);
    return TROUBLE;
}

static int read_png(const char *path, picture *p)
{
    png_image png = { .version = PNG_IMAGE_VERSION };

    if (!png_image_begin_read_from_file(&png, path))
        return failed(path, png.message);
    png.format = PNG_FORMAT_RGB;
    p->width = (int)png.width;
    p->height = (int)png.height;
    p->rgb = malloc(PNG_IMAGE_SIZE(png));
    if (p->rgb == NULL || !png_image_finish_read(&png, NULL, p->rgb, 0, NULL)) {
        png_image_free(&png);
        return failed(path, p->rgb == NULL ? "out of memory" : png.message);
    }
    return FINE;
}

static int write_jpeg(const char *path, picture *p)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    FILE *const f = fopen(path, "wb");

    if (f == NULL)
        return failed(path, "cannot be made");
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, f);
    jpeg.image_width = (JDIMENSION)p->width;
    jpeg.image_height = (JDIMENSION)p->height;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, QUALITY, TRUE);
    jpeg.optimize_coding = TRUE;
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < p->height; y++) {
        JSAMPROW row = p->rgb + 3 * (size_t)y * (size_t)p->width;
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    return fclose(f) == 0 ? FINE : failed(path, "cannot be written");
}

int main(int argc, char **argv)
{
    picture p = { 0 };
    int status;

    if (argc != 3)
        return failed("usage", "to_jpeg IN.png OUT.jpg");
    status = read_png(argv[1], &p);
    if (status == FINE)
        status = write_jpeg(argv[2], &p);
    free(p.rgb);
    return status;
}
