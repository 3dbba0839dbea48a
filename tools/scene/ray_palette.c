/* ray_palette.c - see ray_palette.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_palette.h"

#include <stdlib.h>
#include <string.h>

/* A pixel and its place in the picture. key: the value of the channel to sort by. */
typedef struct {
    uint8_t key, rgba[4];
    uint32_t at;
} pixel;

typedef struct {
    size_t first, n;
    int channel, width;
} box;

/* Orders by the key, and pixels with equal keys by place, so that the order is unique. */
static int by_key(const void *x, const void *y)
{
    const pixel *const a = x, *const b = y;

    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    return a->at < b->at ? -1 : a->at > b->at;
}

/* Finds the widest channel of a box, and its width. */
static void measure(const pixel *p, box *b)
{
    b->width = 0;
    for (int k = 0; k < 4; k++) {
        int low = 255, high = 0;

        for (size_t i = b->first; i < b->first + b->n; i++) {
            low = p[i].rgba[k] < low ? p[i].rgba[k] : low;
            high = p[i].rgba[k] > high ? p[i].rgba[k] : high;
        }
        if (high - low > b->width) {
            b->width = high - low;
            b->channel = k;
        }
    }
}

/* Halves a box at the middle of its widest channel, by which it is sorted. */
static box halve(pixel *p, box *b)
{
    int low = 255, high = 0;
    size_t cut = b->first;

    for (size_t i = b->first; i < b->first + b->n; i++) {
        p[i].key = p[i].rgba[b->channel];
        low = p[i].key < low ? p[i].key : low;
        high = p[i].key > high ? p[i].key : high;
    }
    qsort(p + b->first, b->n, sizeof *p, by_key);
    while (p[cut].key <= (low + high) / 2)
        cut++;

    box rest = { .first = cut, .n = b->first + b->n - cut };

    b->n = cut - b->first;
    measure(p, b);
    measure(p, &rest);
    return rest;
}

static void mean(const pixel *p, const box *b, uint8_t rgba[4])
{
    for (int k = 0; k < 4; k++) {
        uint64_t sum = 0;

        for (size_t i = b->first; i < b->first + b->n; i++)
            sum += p[i].rgba[k];
        rgba[k] = (uint8_t)((sum + b->n / 2) / b->n);
    }
}

int ted4_ray_palette(const uint8_t *rgba, size_t n, uint8_t palette[TED4_RAY_PALETTE][4],
                     uint8_t *index)
{
    pixel *const p = malloc(n * sizeof *p);
    box boxes[TED4_RAY_PALETTE] = { { .n = n } };
    int used = 1;

    if (p == NULL)
        return -1;
    for (size_t i = 0; i < n; i++) {
        p[i] = (pixel) { .at = (uint32_t)i };
        memcpy(p[i].rgba, rgba + 4 * i, 4);
    }
    measure(p, boxes);
    while (used < TED4_RAY_PALETTE) {
        int widest = 0;

        for (int i = 1; i < used; i++)
            widest = boxes[i].width > boxes[widest].width ? i : widest;
        if (boxes[widest].width == 0)
            break;
        boxes[used] = halve(p, &boxes[widest]);
        used++;
    }
    for (int k = 0; k < used; k++) {
        mean(p, &boxes[k], palette[k]);
        for (size_t i = boxes[k].first; i < boxes[k].first + boxes[k].n; i++)
            index[p[i].at] = (uint8_t)k;
    }
    free(p);
    return used;
}
