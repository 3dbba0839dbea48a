/* data_util.h - helpers of the scene loaders: messages, paths, whole files, rotations. Depends on
 * data/dataset.h for ted4_message. Used inside ref-encoder/data only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DATA_UTIL_H
#define TED4_DATA_UTIL_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

#if defined(__GNUC__)
#define TED4_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define TED4_PRINTF(text, first)
#endif

#define TED4_PI 3.14159265358979323846

/* Fills *m and returns -1, so that a loader can write "return ted4_say(...)". Text that is too long
 * is cut off. */
int ted4_say(ted4_message *m, const char *format, ...) TED4_PRINTF(2, 3);
int ted4_say_no_memory(ted4_message *m);

/* Returns folder/name, or name itself if it is absolute. Owned by the caller; NULL if memory runs
 * out. */
char *ted4_path_join(const char *folder, const char *name);
char *ted4_text_copy(const char *text); /* owned by the caller; NULL: no memory */
/* Appends a text to (*list)[*n], both owned by the caller. Returns 0, or -1 if memory runs out. */
int ted4_text_add(char ***list, size_t *n, const char *format, ...) TED4_PRINTF(3, 4);
int ted4_is_file(const char *path);
int ted4_is_folder(const char *path);
/* Is it a pipe, a socket or a device? To open a pipe could take for ever. */
int ted4_is_special(const char *path);
/* May the folder be listed and searched? Returns 0 if so, or if there is no such folder, else -1
 * with *m filled. */
int ted4_may_read(const char *folder, ted4_message *m);

/* Reads a whole file and appends a zero byte that *size does not count. *bytes is owned by the
 * caller. Returns 0, or -1 with *m filled. */
int ted4_read_whole(const char *path, uint8_t **bytes, size_t *size, ted4_message *m);

/* Returns the number of bytes of the mark with which some editors begin a text in UTF-8: 3, or 0 if
 * there is none. */
size_t ted4_mark_size(const uint8_t *bytes, size_t size);

/* Largest deviation of a given rotation from orthonormal. Files print 6 digits or more. */
#define TED4_ROTATION_TOLERANCE 1e-3

/* Checks that R (row-major) is a rotation, and makes it orthonormal up to rounding. Returns NULL,
 * or a text that says what is wrong with it. */
const char *ted4_rotation_clean(double R[9]);

/* Returns the determinant of a row-major 3x3 matrix. */
double ted4_det3(const double A[9]);
/* Computes x = A^-1 b for a row-major 3x3 matrix. Returns 0, or -1 if A is singular to working
 * precision. */
int ted4_solve3(const double A[9], const double b[3], double x[3]);

double ted4_distance3(const double a[3], const double b[3]);

/* Are size, lens and pose the same? */
int ted4_camera_same(const ted4_camera *a, const ted4_camera *b);
/* Computes c = -R^T t, the camera centre of a world-to-camera pose. */
void ted4_pose_centre(const double R[9], const double t[3], double c[3]);

/* SplitMix64, a counter passed through a mixing function, so that all seeds are equally good.
 * Returns a uniform number in [0, 1). */
static inline double ted4_split_uniform(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

#endif
