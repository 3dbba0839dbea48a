/* camera_lens.c - see camera_lens.h. A focal length of the frame, in whatever form, goes before any
 * at the top of the file; at one level fl_x goes before a matrix, and a matrix before an angle.
 * camera_angle_y stands for fl_y where there is neither fl_y nor a matrix.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_lens.h"

#include <math.h>
#include <string.h>

#define HALF_TURN 3.14159265358979324

static const char *const matrices[] = { "K", "intrinsics", "intrinsic_matrix",
                                        "camera_intrinsics" };

enum { N_MATRICES = sizeof matrices / sizeof matrices[0] };

typedef struct {
    const json_t *file, *frame;
    double width, height, fx, fy, cx, cy, skew;
    const char *wrong; /* of what failed */
} lens;

static int fail(lens *l, const char *wrong)
{
    l->wrong = wrong;
    return -1;
}

/* Reads a number of one level, the frame or the file. Returns 1, 0 if there is none, or -1. */
static int number(lens *l, const json_t *level, const char *name, double *v)
{
    const json_t *const field = json_object_get(level, name);

    if (field == NULL)
        return 0;
    if (!json_is_number(field) || !isfinite(json_number_value(field)))
        return fail(l, "has a lens with a field that is no number");
    *v = json_number_value(field);
    return 1;
}

/* Appends the numbers of a list, also of lists in it, to v[9]. Returns 0, or -1. */
static int gather(const json_t *list, double v[9], size_t *n)
{
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *const item = json_array_get(list, i);

        if (json_is_array(item)) {
            if (gather(item, v, n) != 0)
                return -1;
            continue;
        }
        if (!json_is_number(item) || !isfinite(json_number_value(item)) || *n == 9)
            return -1;
        v[(*n)++] = json_number_value(item);
    }
    return 0;
}

/* Reads a matrix of one level. Returns as number. */
static int matrix(lens *l, const json_t *level)
{
    const json_t *list = NULL;
    double K[9];
    size_t n = 0;

    for (int i = 0; i < N_MATRICES && list == NULL; i++)
        list = json_object_get(level, matrices[i]);
    if (list == NULL)
        return 0;
    if (!json_is_array(list) || gather(list, K, &n) != 0 ||
        (n != 4 && (n != 9 || K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1)))
        return fail(l, "has a K other than fx s cx, 0 fy cy, 0 0 1 or fx fy cx cy");
    l->fx = K[0];
    l->fy = n == 9 ? K[4] : K[1];
    l->cx = K[2];
    l->cy = n == 9 ? K[5] : K[3];
    l->skew = n == 9 ? K[1] : 0;
    return 1;
}

/* Reads an angle of view across size pixels, as a focal length. wrong: what to say of an angle that
 * is none. Returns as number. */
static int angle(lens *l, const json_t *level, const char *name, double size, double *f,
                 const char *wrong)
{
    double v = 0;
    const int found = number(l, level, name, &v);

    if (found <= 0)
        return found;
    if (!(v > 0 && v < HALF_TURN))
        return fail(l, wrong);
    *f = 0.5 * size / tan(0.5 * v);
    return found;
}

/* Reads the focal lengths, and the centre if a matrix gives it, of one level. Returns as number. */
static int focal(lens *l, const json_t *level)
{
    int found = number(l, level, "fl_x", &l->fx);

    /* fl_y at the top may be common to frames that each have their own fl_x. */
    if (found > 0 && json_object_get(l->file, "fl_y") == NULL)
        l->fy = l->fx;
    if (found == 0) {
        found = matrix(l, level);
        if (found != 0)
            return found;
        found = angle(l, level, "camera_angle_x", l->width, &l->fx,
                      "has a camera_angle_x that is not between 0 and pi");
        if (found > 0)
            l->fy = l->fx;
    }
    return found < 0 || json_object_get(level, "fl_y") != NULL ||
                   angle(l, level, "camera_angle_y", l->height, &l->fy,
                         "has a camera_angle_y that is not between 0 and pi") >= 0
               ? found
               : -1;
}

/* Reads the fields of one level that are single numbers. Returns 0 or -1. */
static int singles(lens *l, const json_t *level)
{
    return number(l, level, "fl_y", &l->fy) < 0 || number(l, level, "cx", &l->cx) < 0 ||
                   number(l, level, "cy", &l->cy) < 0
               ? -1
               : 0;
}

static int has_focal(const json_t *level)
{
    int found = json_object_get(level, "fl_x") != NULL ||
                json_object_get(level, "camera_angle_x") != NULL;

    for (int i = 0; i < N_MATRICES; i++)
        found |= json_object_get(level, matrices[i]) != NULL;
    return found;
}

/* Returns the field of the frame, or else of the file. */
static const json_t *either(const lens *l, const char *name)
{
    const json_t *const own = json_object_get(l->frame, name);

    return own != NULL ? own : json_object_get(l->file, name);
}

/* Refuses lenses that are not perspective. Returns 0 or -1. */
static int check_model(lens *l)
{
    static const char *const known[] = { "OPENCV",        "PINHOLE", "SIMPLE_PINHOLE",
                                         "SIMPLE_RADIAL", "RADIAL",  "PERSPECTIVE" };
    const json_t *const model = either(l, "camera_model");
    const char *const name = json_string_value(model);
    size_t i = 0;

    while (name != NULL && i < sizeof known / sizeof known[0] && strcmp(name, known[i]) != 0)
        i++;
    if (model != NULL && (name == NULL || i == sizeof known / sizeof known[0]))
        return fail(l, "has a camera_model other than OPENCV or PINHOLE: only perspective cameras "
                       "are drawn");
    return json_is_true(json_object_get(l->file, "is_fisheye")) ||
                   json_is_true(json_object_get(l->frame, "is_fisheye"))
               ? fail(l, "is_fisheye: only perspective cameras are drawn")
               : 0;
}

/* Returns whether one of the numbers, of the frame or else of the file, is not 0; or -1. */
static int any(lens *l, const char *const *name, size_t n)
{
    int found = 0;

    for (size_t i = 0; i < n; i++) {
        double v = 0;
        const int own = number(l, l->frame, name[i], &v);

        if (own < 0 || (own == 0 && number(l, l->file, name[i], &v) < 0))
            return -1;
        found |= v != 0;
    }
    return found;
}

static int check_distortion(lens *l, int *distorted)
{
    static const char *const usual[] = { "k1", "k2", "k3", "p1", "p2" };
    static const char *const foreign[] = { "k4", "k5", "k6" };
    const int bent = any(l, usual, sizeof usual / sizeof usual[0]);
    const int strange = any(l, foreign, sizeof foreign / sizeof foreign[0]);

    if (strange > 0)
        return fail(l, "has k4, k5 or k6; of distortion only k1 k2 k3 p1 p2 are known");
    *distorted |= bent > 0 || l->skew != 0;
    return bent < 0 || strange < 0 ? -1 : 0;
}

const char *ted4_camera_lens(const json_t *file, const json_t *frame, ted4_view *v, int *distorted)
{
    lens l = { .file = file,
               .frame = frame,
               .width = v->width,
               .height = v->height,
               .cx = 0.5 * v->width,
               .cy = 0.5 * v->height };
    const int own = has_focal(frame);

    if (check_model(&l) != 0)
        return l.wrong;
    const int above = own ? 1 : focal(&l, file);

    if (above == 0)
        return "needs fl_x, K or camera_angle_x, of its own or at the top of the file";
    if (above < 0 || singles(&l, file) != 0 || focal(&l, frame) < 0 || singles(&l, frame) != 0 ||
        check_distortion(&l, distorted) != 0)
        return l.wrong;
    v->fx = (float)l.fx;
    v->fy = (float)l.fy;
    v->cx = (float)l.cx;
    v->cy = (float)l.cy;
    return isfinite(v->fx) && isfinite(v->fy) && v->fx > 0.0f && v->fy > 0.0f && isfinite(v->cx) &&
                   isfinite(v->cy)
               ? NULL
               : "needs focal lengths above 0";
}
