/* npy_file.h - reads tables of numbers from NumPy array files (.npy). Depends on data/dataset.h for
 * ted4_message.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_NPY_FILE_H
#define TED4_NPY_FILE_H

#include <stddef.h>
#include "data/dataset.h"

/* Reads a two-dimensional array of little-endian float32 or float64 in C order, which must have the
 * given number of columns and only finite numbers. *v is [*rows][columns] and owned by the caller.
 * Returns 0, or -1 with *m filled and *v NULL. */
int ted4_npy_read(const char *path, size_t columns, double **v, size_t *rows, ted4_message *m);

#endif
