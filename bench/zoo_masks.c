/* zoo_masks.c - measures how well moving content is reproduced in training pictures: PSNR over all
 * pixels of the masks that ted4scene --masks wrote, as one JSON line.
 *     zoo_masks SCENE IMAGES <VIEWS
 * VIEWS: one line "PATH frame ..." per picture, as ted4eval FILE.ted4 SCENE --split train -v
 * --images IMAGES prints them to standard error. The mask of SCENE/NAME.png is
 * SCENE/truth/masks/NAME.png. Without masks, or if nothing moves, moving_psnr is null.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <png.h>

enum { MAX_LINE = 8192, MAX_PATH = 4096, FINE = 0, TROUBLE = 3 };

typedef struct {
    int width, height;
    uint8_t *bytes; /* owned */
} picture;

typedef struct {
    uint64_t pixels, pictures;
    double squares; /* sum of squared errors over three channels */
} sums;

static int failed(const char *what, const char *why)
{
    fprintf(stderr, "zoo_masks: %s: %s\n", what, why);
    return TROUBLE;
}

static int read_picture(const char *path, png_uint_32 format, picture *p)
{
    png_image png = { .version = PNG_IMAGE_VERSION };

    p->bytes = NULL;
    if (!png_image_begin_read_from_file(&png, path))
        return failed(path, png.message);
    png.format = format;
    p->width = (int)png.width;
    p->height = (int)png.height;
    p->bytes = malloc(PNG_IMAGE_SIZE(png));
    if (p->bytes == NULL || !png_image_finish_read(&png, NULL, p->bytes, 0, NULL)) {
        png_image_free(&png);
        return failed(path, p->bytes == NULL ? "out of memory" : png.message);
    }
    return FINE;
}

static void add(const picture *truth, const picture *ours, const picture *mask, sums *s)
{
    for (size_t i = 0; i < (size_t)mask->width * (size_t)mask->height; i++) {
        if (mask->bytes[i] == 0)
            continue;
        s->pixels++;
        for (size_t k = 3 * i; k < 3 * i + 3; k++) {
            const double e = truth->bytes[k] - ours->bytes[k];

            s->squares += e * e;
        }
    }
    s->pictures++;
}

static int same_size(const picture *a, const picture *b)
{
    return a->width == b->width && a->height == b->height;
}

/* Compares picture n of the images within its mask. */
static int add_picture(const char *images, unsigned n, const char *mask_path, sums *s)
{
    char path[MAX_PATH];
    picture truth = { 0 }, ours = { 0 }, mask = { 0 };
    int code;

    snprintf(path, sizeof path, "%s/truth/%05u.png", images, n);
    code = read_picture(path, PNG_FORMAT_RGB, &truth);
    snprintf(path, sizeof path, "%s/ours/%05u.png", images, n);
    if (code == FINE)
        code = read_picture(path, PNG_FORMAT_RGB, &ours);
    if (code == FINE)
        code = read_picture(mask_path, PNG_FORMAT_GRAY, &mask);
    if (code == FINE && !(same_size(&truth, &mask) && same_size(&ours, &mask)))
        code = failed(mask_path, "not as large as its picture");
    if (code == FINE)
        add(&truth, &ours, &mask, s);
    free(truth.bytes);
    free(ours.bytes);
    free(mask.bytes);
    return code;
}

/* Finds the mask of the picture that a line of VIEWS begins with. Returns 0 if that is not a
 * picture of scene. */
static int mask_of(const char *scene, char *line, char mask[MAX_PATH])
{
    const size_t n = strlen(scene);
    char *const end = strstr(line, " frame ");

    if (end == NULL || strncmp(line, scene, n) != 0 || line[n] != '/')
        return 0;
    *end = '\0';

    char *const dot = strrchr(line + n, '.');

    if (dot != NULL)
        *dot = '\0';
    return snprintf(mask, MAX_PATH, "%s/truth/masks%s.png", scene, line + n) < MAX_PATH;
}

int main(int argc, char **argv)
{
    static char line[MAX_LINE];
    char mask[MAX_PATH];
    sums s = { 0 };
    unsigned n = 0;

    if (argc != 3)
        return failed("usage", "zoo_masks SCENE IMAGES <VIEWS");
    while (fgets(line, sizeof line, stdin) != NULL) {
        if (strstr(line, " frame ") == NULL)
            continue;
        if (mask_of(argv[1], line, mask) && access(mask, R_OK) == 0 &&
            add_picture(argv[2], n, mask, &s) != FINE)
            return TROUBLE;
        n++;
    }
    if (s.pixels > 0 && s.squares > 0)
        printf("{\"moving_psnr\":%.4f,",
               10 * log10(255.0 * 255.0 * 3.0 * (double)s.pixels / s.squares));
    else
        printf("{\"moving_psnr\":null,");
    printf("\"moving_pixels\":%llu,\"pictures\":%llu}\n", (unsigned long long)s.pixels,
           (unsigned long long)s.pictures);
    return FINE;
}
