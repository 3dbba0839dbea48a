/* check_report.c - see check_report.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "check_report.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>

#include "tool/json_string.h"
#include "train/model/header_from_options.h"

/* The smallest and the largest picture: [width, height] each. */
static json_t *sizes(const ted4_dataset *d)
{
    const ted4_camera *low = &d->pictures[0].camera, *high = low;

    for (size_t i = 1; i < d->n_pictures; i++) {
        const ted4_camera *const c = &d->pictures[i].camera;

        low = c->width < low->width ? c : low;
        high = c->width > high->width ? c : high;
    }
    return json_pack("[[i,i],[i,i]]", low->width, low->height, high->width, high->height);
}

/* The frame rate that the file will state, as "30/1". */
static void file_rate(const ted4_dataset *d, const ted4_train_options *options, char *text,
                      size_t size)
{
    ted4_header h;

    ted4_header_make(&h, options, d);
    snprintf(text, size, "%" PRIu32 "/%" PRIu32, h.rate_num, h.rate_den);
}

static void describe(const ted4_dataset *d, json_t *o)
{
    size_t tests = 0;
    json_t *const warnings = json_array();

    for (size_t i = 0; i < d->n_pictures; i++)
        tests += d->pictures[i].is_test;
    for (size_t i = 0; i < d->n_warnings; i++)
        json_array_append_new(warnings, ted4_json_string(d->warnings[i]));
    json_object_set_new(o, "layout", ted4_json_string(d->layout));
    json_object_set_new(o, "train", json_integer((json_int_t)(d->n_pictures - tests)));
    json_object_set_new(o, "test", json_integer((json_int_t)tests));
    json_object_set_new(o, "cameras", json_integer(d->n_cameras));
    json_object_set_new(o, "frames", json_integer(d->n_frames));
    json_object_set_new(o, "sizes", d->n_pictures > 0 ? sizes(d) : json_array());
    json_object_set_new(o, "points", json_integer((json_int_t)d->n_points));
    json_object_set_new(o, "random_points", json_boolean(d->random_points));
    json_object_set_new(o, "background",
                        json_pack("[i,i,i]", d->background[0], d->background[1], d->background[2]));
    json_object_set_new(o, "rate", d->rate > 0 ? json_real(d->rate) : json_null());
    json_object_set_new(o, "warnings", warnings);
}

void ted4_check_report(const ted4_dataset *d, const ted4_train_options *options, const char *error,
                       int json)
{
    char rate[32];

    if (!json) {
        if (d == NULL || error != NULL)
            return;
        ted4_dataset_print(d, stdout);
        if (d->n_frames > 1 && d->rate == 0) {
            file_rate(d, options, rate, sizeof rate);
            printf("            (the file will say %s frames/s)\n", rate);
        }
        return;
    }
    json_t *const o = json_object();

    json_object_set_new(o, "error", error != NULL ? ted4_json_string(error) : json_null());
    if (d != NULL)
        describe(d, o);
    if (d != NULL && d->n_frames > 1) {
        file_rate(d, options, rate, sizeof rate);
        json_object_set_new(o, "file_rate", json_string(rate));
    }
    json_dumpf(o, stdout, JSON_COMPACT | JSON_REAL_PRECISION(9));
    putchar('\n');
    json_decref(o);
}
