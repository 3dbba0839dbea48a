/* transforms_lens.c - reads the lens of a frame of a transforms file from fl_x, fl_y, cx, cy; or K,
 * a 3x3 matrix (or fx fy cx cy) that may have several names; or camera_angle_x. camera_angle_y
 * stands for fl_y where there is neither fl_y nor a matrix. A frame's own fields take precedence
 * over those at the top of the file. k1 k2 k3 p1 p2 are OpenCV's. Pixel centres are at + 0.5, also
 * in K.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/transforms.h"

#include <math.h>
#include <string.h>
#include "math/elementary.h"

static const char *const matrices[] = { "K", "intrinsics", "intrinsic_matrix",
                                        "camera_intrinsics" };

enum { N_MATRICES = sizeof matrices / sizeof matrices[0] };

int ted4_transforms_has_focal(const json_t *object)
{
    int found = json_object_get(object, "fl_x") != NULL;

    for (int i = 0; i < N_MATRICES; i++)
        found |= json_object_get(object, matrices[i]) != NULL;
    return found;
}

/* Reads a number of the frame, else of the file. Returns as ted4_json_number. */
static int number(ted4_transforms *t, const char *name, double *v)
{
    const int found = ted4_json_number(t->frame, t->where, name, v, t->m);

    return found != 0 ? found : ted4_json_number(t->root, t->path, name, v, t->m);
}

static int check_model(ted4_transforms *t)
{
    static const char *const known[] = { "OPENCV",        "PINHOLE", "SIMPLE_PINHOLE",
                                         "SIMPLE_RADIAL", "RADIAL",  "PERSPECTIVE" };
    static const char *const foreign[] = { "k4", "k5", "k6" };
    const char *model = known[0];
    double v = 0;

    const int found = ted4_json_text(t->frame, t->where, "camera_model", &model, t->m);
    if (found < 0 ||
        (found == 0 && ted4_json_text(t->root, t->path, "camera_model", &model, t->m) < 0))
        return -1;
    size_t i = 0;
    while (i < sizeof known / sizeof known[0] && strcmp(model, known[i]) != 0)
        i++;
    if (i == sizeof known / sizeof known[0])
        return ted4_say(t->m, "%s.camera_model: %s, expected OPENCV or PINHOLE", t->where, model);
    const int above = json_is_true(json_object_get(t->root, "is_fisheye"));
    if (above || json_is_true(json_object_get(t->frame, "is_fisheye")))
        return ted4_say(t->m, "%s.is_fisheye: true, expected a perspective camera",
                        above ? t->path : t->where);
    for (i = 0; i < sizeof foreign / sizeof foreign[0]; i++)
        if (number(t, foreign[i], &v) < 0)
            return -1;
        else if (v != 0)
            return ted4_say(t->m, "%s.%s: %g, only k1 k2 k3 p1 p2 are supported", t->where,
                            foreign[i], v);
    return 0;
}

/* Reads the size that the intrinsics refer to: w and h, or the size of the picture if absent. */
static int read_size(ted4_transforms *t, ted4_lens *l)
{
    double w = l->width, h = l->height;

    if (number(t, "w", &w) < 0 || number(t, "h", &h) < 0)
        return -1;
    if (!(w >= 1 && h >= 1 && w <= 1e6 && h <= 1e6) || w != floor(w) || h != floor(h))
        return ted4_say(t->m, "%s: w, h are %g, %g, expected whole numbers of pixels", t->where, w,
                        h);
    l->width = (int)w;
    l->height = (int)h;
    l->cx = 0.5 * w;
    l->cy = 0.5 * h;
    return 0;
}

/* Reads a matrix fx s cx, 0 fy cy, 0 0 1, or a list fx fy cx cy. Returns as ted4_json_number. */
static int read_matrix(ted4_transforms *t, const json_t *o, const char *where, ted4_lens *l)
{
    double K[9];
    int n = 0, i = 0;

    while (i < N_MATRICES && n == 0)
        n = ted4_json_numbers(o, where, matrices[i++], K, 4, 9, t->m);
    if (n <= 0)
        return n;
    if (n != 4 && (n != 9 || K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1))
        return ted4_say(t->m, "%s.%s: expected fx s cx, 0 fy cy, 0 0 1 or fx fy cx cy", where,
                        matrices[i - 1]);
    l->fx = K[0];
    l->fy = n == 9 ? K[4] : K[1];
    l->cx = K[2];
    l->cy = n == 9 ? K[5] : K[3];
    l->skew = n == 9 ? K[1] : 0;
    return 1;
}

/* Reads an angle of view across size pixels, as a focal length. Returns as ted4_json_number. */
static int read_angle(ted4_transforms *t, const json_t *o, const char *where, const char *name,
                      int size, double *focal)
{
    double angle = 0;
    const int found = ted4_json_number(o, where, name, &angle, t->m);

    if (found <= 0)
        return found;
    if (!(angle > 0 && angle < TED4_PI))
        return ted4_say(t->m, "%s: %s is %g, expected an angle between 0 and pi", t->where, name,
                        angle);
    *focal = 0.5 * size / ted4_math_tan(0.5 * angle);
    return found;
}

/* Reads the focal length, and the centre if a matrix gives it, from one level, which is the frame
 * or the top of the file. Returns as ted4_json_number. */
static int read_focal(ted4_transforms *t, const json_t *o, const char *where, ted4_lens *l)
{
    int found = ted4_json_number(o, where, "fl_x", &l->fx, t->m);

    /* fl_y at the top may be common to frames that each have their own fl_x. */
    if (found > 0 && json_object_get(t->root, "fl_y") == NULL)
        l->fy = l->fx;
    if (found == 0) {
        found = read_matrix(t, o, where, l);
        if (found != 0)
            return found;
        found = read_angle(t, o, where, "camera_angle_x", l->width, &l->fx);
        if (found > 0)
            l->fy = l->fx;
    }
    return found < 0 || json_object_get(o, "fl_y") != NULL ||
                   read_angle(t, o, where, "camera_angle_y", l->height, &l->fy) >= 0
               ? found
               : -1;
}

/* Reads the fields of one level that are single numbers. */
static int read_numbers(ted4_transforms *t, const json_t *o, const char *where, ted4_lens *l)
{
    const struct {
        const char *name;
        double *to;
    } fields[] = {
        { "fl_y", &l->fy }, { "cx", &l->cx }, { "cy", &l->cy }, { "k1", &l->k1 },
        { "k2", &l->k2 },   { "k3", &l->k3 }, { "p1", &l->p1 }, { "p2", &l->p2 },
    };

    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        if (ted4_json_number(o, where, fields[i].name, fields[i].to, t->m) < 0)
            return -1;
    return 0;
}

int ted4_transforms_lens(ted4_transforms *t, ted4_lens *l)
{
    const int own = ted4_transforms_has_focal(t->frame) ||
                    json_object_get(t->frame, "camera_angle_x") != NULL;

    if (check_model(t) != 0 || read_size(t, l) != 0)
        return -1;
    const int above = own ? 1 : read_focal(t, t->root, t->path, l);
    if (above == 0)
        return ted4_say(t->m,
                        "%s: no fl_x, no K and no camera_angle_x here or at the top of the file",
                        t->where);
    return above < 0 || read_numbers(t, t->root, t->path, l) != 0 ||
                   read_focal(t, t->frame, t->where, l) < 0 ||
                   read_numbers(t, t->frame, t->where, l) != 0
               ? -1
               : 0;
}
