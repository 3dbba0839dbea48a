/* camera_list.c - see camera_list.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_list.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rotation.h"

#include "camera_transforms.h"
#include "cams.h"
#include "json_file.h"

static int get_number(const json_t *o, const char *key, float *out)
{
    const json_t *const v = json_object_get(o, key);

    *out = (float)json_number_value(v);
    return json_is_number(v) && isfinite(*out);
}

static int get_numbers(const json_t *o, const char *key, size_t n, float *out)
{
    const json_t *const list = json_object_get(o, key);

    if (!json_is_array(list) || json_array_size(list) != n)
        return 0;
    for (size_t i = 0; i < n; i++) {
        const json_t *const v = json_array_get(list, i);

        out[i] = (float)json_number_value(v);
        if (!json_is_number(v) || !isfinite(out[i]))
            return 0;
    }
    return 1;
}

static int get_side(const json_t *o, const char *key, int *out)
{
    const json_t *const v = json_object_get(o, key);
    const json_int_t n = json_integer_value(v);

    if (!json_is_integer(v) || n < 1 || n > TED4_CAMS_SIDE)
        return 0;
    *out = (int)n;
    return 1;
}

static int get_time(const json_t *o, ted4_listed_camera *c)
{
    const json_t *const frame = json_object_get(o, "frame");
    const json_t *const time = json_object_get(o, "time");

    if (frame == NULL && time == NULL)
        return 1;
    if (frame != NULL && time != NULL)
        return 0;
    if (frame != NULL) {
        const json_int_t n = json_integer_value(frame);

        c->has_frame = 1;
        c->frame = (uint32_t)n;
        return json_is_integer(frame) && n >= 0 && n < UINT32_MAX;
    }
    if (json_is_string(time))
        return ted4_time_parse(json_string_value(time), &c->time) == 0;
    const double t = json_number_value(time);

    if (!json_is_number(time) || !(t >= 0.0 && t <= 1.0))
        return 0;
    c->time = ted4_time_of_part(t);
    return 1;
}

/* Fills *c from the object. Returns NULL, or a text that says what is wrong with the object. */
static const char *get_camera(const json_t *o, ted4_listed_camera *c)
{
    ted4_view *const v = &c->view;

    if (!json_is_object(o))
        return "is not an object";
    if (!get_side(o, "width", &v->width) || !get_side(o, "height", &v->height))
        return "needs width and height, whole numbers from 1 to 16384";
    if (!get_number(o, "fx", &v->fx) || !get_number(o, "fy", &v->fy) ||
        !(v->fx > 0.0f && v->fy > 0.0f))
        return "needs fx and fy above 0";
    if (!get_number(o, "cx", &v->cx) || !get_number(o, "cy", &v->cy))
        return "needs cx and cy";
    if (!get_numbers(o, "R", 9, v->R) || !ted4_is_orthogonal(v->R))
        return "needs R, a rotation of 9 numbers";
    if (!ted4_is_rotation(v->R))
        return "has an R that is a mirror image, not a rotation";
    if (!get_numbers(o, "t", 3, v->t))
        return "needs t, 3 numbers";
    if (json_object_get(o, "pixel") != NULL &&
        !(get_number(o, "pixel", &v->pixel) && v->pixel > 0.0f))
        return "has a pixel that is not a number above 0";
    return get_time(o, c) ? NULL : "needs frame, a whole number, or time, from 0 to 1, or neither";
}

int ted4_camera_list_load(ted4_camera_list *l, const char *path, char *why, size_t why_size)
{
    json_t *const list = ted4_json_load(path, why, why_size);
    const char *wrong = NULL;

    *l = (ted4_camera_list) { 0 };
    if (list == NULL)
        return -1;
    if (json_is_array(json_object_get(list, "frames"))) {
        const int code = ted4_transforms_read(list, path, l, why, why_size);

        json_decref(list);
        if (code != 0)
            ted4_camera_list_free(l);
        return code;
    }
    if (!json_is_array(list) || json_array_size(list) == 0)
        wrong = "expected a list of cameras, or frames as in transforms_train.json";
    else
        l->camera = calloc(json_array_size(list), sizeof *l->camera);
    if (wrong == NULL && l->camera == NULL)
        wrong = "out of memory";
    if (wrong != NULL)
        snprintf(why, why_size, "%s", wrong);
    for (; wrong == NULL && l->n < json_array_size(list); l->n++) {
        wrong = get_camera(json_array_get(list, l->n), &l->camera[l->n]);
        if (wrong != NULL)
            snprintf(why, why_size, "camera %zu %s", l->n, wrong);
    }
    json_decref(list);
    if (wrong == NULL)
        return 0;
    ted4_camera_list_free(l);
    return -1;
}

void ted4_camera_list_free(ted4_camera_list *l)
{
    free(l->camera);
    *l = (ted4_camera_list) { 0 };
}

static json_t *numbers(const float *v, int n)
{
    json_t *const list = json_array();

    for (int i = 0; i < n; i++)
        json_array_append_new(list, json_real((double)v[i]));
    return list;
}

void ted4_camera_list_print(const ted4_camera_list *l, FILE *f)
{
    for (size_t i = 0; i < l->n; i++) {
        const ted4_listed_camera *const c = &l->camera[i];
        const ted4_view *const v = &c->view;
        json_t *const o = json_pack("{s:i, s:i, s:f, s:f, s:f, s:f, s:o, s:o}", "width", v->width,
                                    "height", v->height, "fx", (double)v->fx, "fy", (double)v->fy,
                                    "cx", (double)v->cx, "cy", (double)v->cy, "R", numbers(v->R, 9),
                                    "t", numbers(v->t, 3));
        char time[32];

        snprintf(time, sizeof time, "%" PRIu32 "/%" PRIu32, c->time.num, c->time.den);
        if (v->pixel > 0.0f)
            json_object_set_new(o, "pixel", json_real((double)v->pixel));
        if (c->has_frame)
            json_object_set_new(o, "frame", json_integer(c->frame));
        else if (c->time.den > 0)
            json_object_set_new(o, "time", json_string(time));
        fputs(i == 0 ? "[" : " ", f);
        json_dumpf(o, f, JSON_COMPACT | JSON_REAL_PRECISION(9));
        fputs(i + 1 < l->n ? ",\n" : "]\n", f);
        json_decref(o);
    }
}
