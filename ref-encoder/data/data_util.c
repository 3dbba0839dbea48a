/* data_util.c - see data_util.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/data_util.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int ted4_say(ted4_message *m, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(m->text, sizeof m->text, format, arguments);
    va_end(arguments);
    return -1;
}

int ted4_say_no_memory(ted4_message *m)
{
    return ted4_say(m, "out of memory while loading the scene");
}

char *ted4_path_join(const char *folder, const char *name)
{
    const size_t n = strlen(folder), k = strlen(name);

    if (name[0] == '/')
        return ted4_text_copy(name);
    while (name[0] == '.' && name[1] == '/')
        name += 2;
    char *path = malloc(n + k + 2);
    if (path != NULL)
        snprintf(path, n + k + 2, "%s%s%s", folder, n > 0 && folder[n - 1] == '/' ? "" : "/", name);
    return path;
}

char *ted4_text_copy(const char *text)
{
    const size_t n = strlen(text) + 1;
    char *copy = malloc(n);

    if (copy != NULL)
        memcpy(copy, text, n);
    return copy;
}

int ted4_text_add(char ***list, size_t *n, const char *format, ...)
{
    char text[1024], **longer = realloc(*list, (*n + 1) * sizeof *longer);
    va_list arguments;

    if (longer == NULL)
        return -1;
    *list = longer;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    longer[*n] = ted4_text_copy(text);
    if (longer[*n] == NULL)
        return -1;
    ++*n;
    return 0;
}

int ted4_is_file(const char *path)
{
    struct stat s;

    return stat(path, &s) == 0 && S_ISREG(s.st_mode);
}

int ted4_is_folder(const char *path)
{
    struct stat s;

    return stat(path, &s) == 0 && S_ISDIR(s.st_mode);
}

int ted4_is_special(const char *path)
{
    struct stat s;

    return stat(path, &s) == 0 && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode);
}

int ted4_may_read(const char *folder, ted4_message *m)
{
    struct stat s;

    if (stat(folder, &s) == 0 && (!S_ISDIR(s.st_mode) || access(folder, R_OK | X_OK) == 0))
        return 0;
    if (errno == ENOENT || errno == ENOTDIR)
        return 0;
    return ted4_say(m, "%s: %s", folder, strerror(errno));
}

int ted4_read_whole(const char *path, uint8_t **bytes, size_t *size, ted4_message *m)
{
    struct stat s;

    *bytes = NULL;
    *size = 0;
    if (stat(path, &s) != 0)
        return ted4_say(m, "%s: %s", path, strerror(errno));
    if (!S_ISREG(s.st_mode))
        return ted4_say(m, "%s: not a file", path);
    FILE *f = fopen(path, "rb");
    if (f == NULL)
        return ted4_say(m, "%s: %s", path, strerror(errno));
    const size_t n = (size_t)s.st_size;
    uint8_t *p = malloc(n + 1);
    const size_t got = p == NULL ? 0 : fread(p, 1, n, f);
    fclose(f);
    if (p == NULL)
        return ted4_say_no_memory(m);
    if (got != n) {
        free(p);
        return ted4_say(m, "%s: read %zu of %zu bytes", path, got, n);
    }
    p[n] = 0;
    *bytes = p;
    *size = n;
    return 0;
}

size_t ted4_mark_size(const uint8_t *bytes, size_t size)
{
    static const uint8_t mark[] = { 0xef, 0xbb, 0xbf };

    return size >= sizeof mark && memcmp(bytes, mark, sizeof mark) == 0 ? sizeof mark : 0;
}

double ted4_det3(const double A[9])
{
    return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
           A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* C is the matrix of cofactors, so that A^-T = C / det A. */
static void cofactors(const double A[9], double C[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            const int c = (j + 1) % 3, e = (j + 2) % 3;
            C[3 * i + j] = A[3 * a + c] * A[3 * b + e] - A[3 * a + e] * A[3 * b + c];
        }
}

const char *ted4_rotation_clean(double R[9])
{
    double C[9];

    for (int i = 0; i < 9; i++)
        if (!isfinite(R[i]))
            return "holds a value that is not finite";
    if (fabs(ted4_det3(R)) < TED4_ROTATION_TOLERANCE)
        return "is singular, expected a rotation";
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            const double dot = R[3 * i] * R[3 * j] + R[3 * i + 1] * R[3 * j + 1] +
                               R[3 * i + 2] * R[3 * j + 2];
            if (fabs(dot - (i == j)) > TED4_ROTATION_TOLERANCE)
                return "is not orthonormal, expected a rotation";
        }
    if (ted4_det3(R) < 0)
        return "is a mirror image, expected a rotation";
    /* Newton's iteration to the nearest rotation, R <- (R + R^-T) / 2, squares the error in each
     * step: 1e-3, 1e-6, 1e-12, rounding. */
    for (int k = 0; k < 4; k++) {
        const double d = ted4_det3(R);
        cofactors(R, C);
        for (int i = 0; i < 9; i++)
            R[i] = 0.5 * (R[i] + C[i] / d);
    }
    return NULL;
}

int ted4_solve3(const double A[9], const double b[3], double x[3])
{
    double C[9], norm = 0;
    const double d = ted4_det3(A);

    for (int i = 0; i < 9; i++)
        norm = fmax(norm, fabs(A[i]));
    if (!(fabs(d) > 1e-9 * norm * norm * norm))
        return -1;
    cofactors(A, C);
    for (int i = 0; i < 3; i++)
        x[i] = (C[i] * b[0] + C[3 + i] * b[1] + C[6 + i] * b[2]) / d;
    return 0;
}

double ted4_distance3(const double a[3], const double b[3])
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];

    return sqrt(x * x + y * y + z * z);
}

int ted4_camera_same(const ted4_camera *a, const ted4_camera *b)
{
    int same = a->width == b->width && a->height == b->height && a->fx == b->fx && a->fy == b->fy &&
               a->cx == b->cx && a->cy == b->cy;

    for (int i = 0; i < 9; i++)
        same &= a->R[i] == b->R[i];
    for (int i = 0; i < 3; i++)
        same &= a->t[i] == b->t[i];
    return same;
}

void ted4_pose_centre(const double R[9], const double t[3], double c[3])
{
    for (int i = 0; i < 3; i++)
        c[i] = -(R[i] * t[0] + R[3 + i] * t[1] + R[6 + i] * t[2]);
}
