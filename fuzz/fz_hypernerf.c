/* fz_hypernerf.c - the files of Nerfies: u8 kind (0 dataset.json, 1 metadata.json, 2 the camera of
 * picture a, 3 points.npy), then that file. The other files exist and are valid. Claims: those of
 * fuzz_load_scene().
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "scene_folder.h"

enum { KINDS = 4 };

static const char *const name[KINDS] = { "dataset.json", "metadata.json", "camera/a.json",
                                         "points.npy" };
static const char *const good[KINDS - 1] = {
    "{\"ids\":[\"a\",\"b\"],\"train_ids\":[\"a\"],\"val_ids\":[\"b\"]}",
    "{\"a\":{\"warp_id\":0,\"camera_id\":1},\"b\":{\"time_id\":3}}",
    ("{\"focal_length\":3,\"image_size\":[2,2],\"principal_point\":[1,1],\"orientation\":[[1,0,0],["
     "0,1,0],[0,0,1]],\"position\":[0,0,-4],"
     "\"radial_distortion\":[0.01,0,0]}")
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const unsigned kind = size > 0 ? data[0] % KINDS : 0;

    if (size < 1)
        return 0;
    (void)fuzz_scene("hypernerf");
    (void)fuzz_picture("rgb/1x/a.png");
    (void)fuzz_picture("rgb/1x/b.png");
    for (unsigned i = 0; i < KINDS - 1; i++)
        (void)fuzz_text(name[i], good[i]);
    (void)fuzz_text("camera/b.json", good[2]);
    fuzz_no_file(name[KINDS - 1]);
    (void)fuzz_file(name[kind], data + 1, size - 1);
    (void)fuzz_load_scene();
    return 0;
}
