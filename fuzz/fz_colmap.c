/* fz_colmap.c - COLMAP's model: u8 kind (0 to 2 text, 3 to 5 binary; cameras, images, points3D),
 * then that file. The other two files, and the pictures that they name, exist and are valid.
 * Claims: those of fuzz_load_scene(); no count in a binary file makes the loader allocate more than
 * the file's size justifies (the memory of the process is limited).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "scene_folder.h"

static const char *const part[3] = { "sparse/0/cameras", "sparse/0/images", "sparse/0/points3D" };
static const char *const good[3] = {
    "1 OPENCV 2 2 2 2 1 1 0.01 0 0 0\n2 SIMPLE_PINHOLE 4 4 3 2 2\n",
    "1 1 0 0 0 0 0 3 1 a1.png\n\n2 1 0 0 0 0.5 0 3 2 a2.png\n\n",
    "1 0 0 0 255 0 0 0.5\n2 1 -1 0.5 0 255 0 0.5 1 2\n"
};

static const char *name_of(unsigned i, const char *end)
{
    static char name[64];

    (void)snprintf(name, sizeof name, "%s.%s", part[i], end);
    return name;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const unsigned kind = size > 0 ? data[0] % 6 : 0;

    if (size < 1)
        return 0;
    (void)fuzz_scene("colmap");
    (void)fuzz_picture("images/a1.png");
    (void)fuzz_picture("images/a2.png");
    for (unsigned i = 0; i < 3; i++) {
        fuzz_no_file(name_of(i, "bin"));
        (void)fuzz_text(name_of(i, "txt"), good[i]);
    }
    (void)fuzz_file(name_of(kind % 3, kind < 3 ? "txt" : "bin"), data + 1, size - 1);
    (void)fuzz_load_scene();
    return 0;
}
