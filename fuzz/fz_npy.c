/* fz_npy.c - NumPy's array file: as a table of 3 columns, and as poses_bounds.npy of a scene with
 * two clips. Claims: a table consists of all the numbers after the file's header, and all are
 * finite; otherwise there is a message and no table. For the scene, the claims are those of
 * fuzz_load_scene().
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include "base/bytes.h"
#include "data/npy_file.h"
#include "harness.h"
#include "scene_folder.h"

/* Returns the number of bytes after the header, which has 6 bytes of signature, 2 of version, and 2
 * or 4 that give the length of its rest. */
static size_t table_size(const uint8_t *data, size_t size)
{
    const size_t start = data[6] == 1 ? 10 + (size_t)ted4_load16(data + 8)
                                      : 12 + (size_t)ted4_load32(data + 8);

    return size - start;
}

static void check_table(const char *path, size_t columns, const uint8_t *data, size_t size)
{
    ted4_message m;
    double *v = NULL;
    size_t rows = 0;

    if (ted4_npy_read(path, columns, &v, &rows, &m) != 0) {
        fuzz_check_message(&m);
        fuzz_require(v == NULL && rows == 0, "no table");
        return;
    }
    fuzz_require(rows > 0 && (rows * columns * 4 == table_size(data, size) ||
                              rows * columns * 8 == table_size(data, size)),
                 "all that stands behind the header");
    for (size_t i = 0; i < rows * columns; i++)
        fuzz_require(isfinite(v[i]), "finite");
    free(v);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *path;

    (void)fuzz_scene("npy");
    (void)fuzz_picture("images/cam0/1.png");
    (void)fuzz_picture("images/cam2/1.png");
    path = fuzz_file("poses_bounds.npy", data, size);
    check_table(path, 3, data, size);
    check_table(path, 17, data, size);
    (void)fuzz_load_scene();
    return 0;
}
