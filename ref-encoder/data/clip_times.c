/* clip_times.c - the times of pictures in clips. See clip.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/clip.h"

#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/picture_path.h"

static uint64_t number_of(const ted4_clip *clip, size_t i)
{
    return (uint64_t)ted4_picture_number(clip->pictures.names[i]);
}

/* Returns the first picture without a number larger than that of the picture before, or
 * pictures.n. */
static size_t first_stray(const ted4_clip *clip)
{
    double before = -1;

    for (size_t i = 0; i < clip->pictures.n; i++) {
        const double number = ted4_picture_number(clip->pictures.names[i]);
        if (number <= before)
            return i;
        before = number;
    }
    return clip->pictures.n;
}

static uint64_t common_divisor(uint64_t a, uint64_t b)
{
    while (b > 0) {
        const uint64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Finds base and step of all numbers. Returns whether there are any numbers. */
static int find_step(ted4_clips *c)
{
    int any = 0;

    for (const ted4_clip *clip = c->list; clip < c->list + c->n; clip++) {
        if (clip->is_video)
            continue;
        if (first_stray(clip) < clip->pictures.n)
            return 0;
        c->base = any && c->base < number_of(clip, 0) ? c->base : number_of(clip, 0);
        any = 1;
    }
    c->step = 0;
    for (const ted4_clip *clip = c->list; clip < c->list + c->n; clip++)
        for (size_t i = 0; i < clip->pictures.n && !clip->is_video; i++)
            c->step = common_divisor(number_of(clip, i) - c->base, c->step);
    c->step = c->step > 0 ? c->step : 1;
    return any;
}

/* The numbers count frames if more pictures are there than are missing. Cameras that number their
 * pictures independently, or by a clock, would lack most of them. */
static void judge_numbers(ted4_clips *c)
{
    uint64_t there = 0, expected = 0;

    if (!find_step(c))
        return;
    for (const ted4_clip *clip = c->list; clip < c->list + c->n; clip++) {
        const size_t n = clip->pictures.n;
        if (clip->is_video)
            continue;
        there += n;
        expected += (number_of(clip, n - 1) - c->base) / c->step + 1;
    }
    c->is_counted = there > expected - there;
    c->expected = expected;
    c->lacking = expected - there;
}

/* Leaves out pictures that are not among the first most frames. */
static int number_clip(ted4_clip *clip, const ted4_clips *c)
{
    const int counted = c->is_counted && !clip->is_video;
    const size_t n = clip->pictures.n;
    size_t kept = 0;

    clip->frame = malloc(n * sizeof *clip->frame);
    if (clip->frame == NULL)
        return -1;
    for (size_t i = 0; i < n; i++) {
        const uint64_t frame = counted ? (number_of(clip, i) - c->base) / c->step : i;
        if (c->most > 0 && frame >= c->most) {
            clip->frames = c->most;
            free(clip->pictures.names[i]);
        } else {
            clip->frames = (size_t)frame + 1;
            clip->frame[kept] = (uint32_t)frame;
            clip->pictures.names[kept++] = clip->pictures.names[i];
        }
    }
    clip->pictures.n = kept;
    return 0;
}

int ted4_clips_number(ted4_clips *c, ted4_message *m)
{
    judge_numbers(c);
    for (size_t i = 0; i < c->n; i++)
        if (number_clip(&c->list[i], c) != 0)
            return ted4_say_no_memory(m);
    return 0;
}

/* Returns the first frame of which the clip has no picture. */
static size_t first_gap(const ted4_clip *clip)
{
    size_t i = 0;

    while (i < clip->pictures.n && clip->frame[i] == i)
        i++;
    return i;
}

/* Does any picture have a larger number than the one before? Names such as f1_v2, f2_v2 have none,
 * and are not meant to count by their last number. */
static int rises(const ted4_clip *clip)
{
    for (size_t i = 1; i < clip->pictures.n; i++)
        if (ted4_picture_number(clip->pictures.names[i]) >
            ted4_picture_number(clip->pictures.names[i - 1]))
            return 1;
    return 0;
}

/* Names the picture for which numbers are not used, where other names seem to count. */
static int say_stray(const ted4_clips *c, ted4_raw_scene *s)
{
    const ted4_clip *clip = c->list;

    while (clip < c->list + c->n &&
           (clip->is_video || first_stray(clip) == clip->pictures.n || !rises(clip)))
        clip++;
    if (clip == c->list + c->n)
        return 0;
    const size_t i = first_stray(clip);
    char *const *name = clip->pictures.names + i;
    const double number = ted4_picture_number(*name);
    const char *before = number < 0 ? "" : strrchr(name[-1], '/') + 1;
    return ted4_raw_scene_warn(s,
                               "%.500s has %s%.200s%s: the numbers in names are not used, and the "
                               "pictures of each clip are counted in their order",
                               *name,
                               number == -1   ? "no number"
                               : number == -2 ? "a number of more than 15 digits"
                                              : "no larger number than ",
                               before, number < 0 ? "" : " before it");
}

static int say_gaps(const ted4_clips *c, ted4_raw_scene *s)
{
    const ted4_clip *first = NULL;
    size_t missing = 0, frames = 0;

    for (const ted4_clip *clip = c->list; clip < c->list + c->n; clip++) {
        frames += clip->frames;
        missing += clip->frames - clip->pictures.n;
        if (first == NULL && clip->pictures.n < clip->frames)
            first = clip;
    }
    if (first == NULL)
        return 0;
    return ted4_raw_scene_warn(s,
                               "clips lack pictures by the numbers in their names: %zu of %zu; the "
                               "first: %s has none of number %llu",
                               missing, frames, first->name,
                               (unsigned long long)(c->base + first_gap(first) * c->step));
}

static int say_ends(const ted4_clips *c, ted4_raw_scene *s)
{
    size_t shortest = SIZE_MAX, longest = 0;

    for (const ted4_clip *clip = c->list; clip < c->list + c->n; clip++) {
        shortest = clip->frames < shortest ? clip->frames : shortest;
        longest = clip->frames > longest ? clip->frames : longest;
    }
    if (shortest >= longest)
        return 0;
    return ted4_raw_scene_warn(s,
                               "clips have from %zu to %zu frames: at the last times some cameras "
                               "are missing (--max-frames %zu leaves these times out)",
                               shortest, longest, shortest);
}

int ted4_clips_say(const ted4_clips *c, int together, ted4_raw_scene *s, ted4_message *m)
{
    int result = 0;

    if (!c->is_counted && c->lacking > 0)
        result = ted4_raw_scene_warn(s,
                                     "by the numbers in their names, clips would lack %llu of %llu "
                                     "pictures: the pictures of each clip are counted in their "
                                     "order instead",
                                     (unsigned long long)c->lacking,
                                     (unsigned long long)c->expected);
    if (result == 0)
        result = say_stray(c, s);
    if (result == 0)
        result = say_gaps(c, s);
    if (result == 0 && together)
        result = say_ends(c, s);
    return result == 0 ? 0 : ted4_say_no_memory(m);
}
