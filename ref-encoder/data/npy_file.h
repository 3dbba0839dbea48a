/* npy_file.h - tables of numbers in NumPy's array file (.npy).
 * Depends on data/dataset.h for ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_NPY_FILE_H
#define TED4_NPY_FILE_H

#include <stddef.h>
#include "data/dataset.h"

/* A two-dimensional array of little-endian float32 or float64 in C order with that many columns,
 * all finite. *v: owned by the caller, [*rows][columns]. 0, or -1 with *m filled and *v NULL. */
int ted4_npy_read(const char *path, size_t columns, double **v, size_t *rows, ted4_message *m);

#endif
