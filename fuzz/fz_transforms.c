/* fz_transforms.c - the JSON files of D-NeRF and nerfstudio: u8 kind (0 transforms.json; 1, 2 the
 * training or the test file of a pair whose other file is valid), then that file. The pictures
 * a.png and b.png and points.ply exist. Claims: those of fuzz_load_scene().
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "scene_folder.h"

#define POSE "[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]"

static const char *const name[3] = { "transforms.json", "transforms_train.json",
                                     "transforms_test.json" };
static const char good[] = "{\"camera_angle_x\":0.7,\"frames\":[{\"file_path\":\"./"
                           "a\",\"time\":0,\"transform_matrix\":" POSE "},"
                           "{\"file_path\":\"b.png\",\"time\":1,\"transform_matrix\":" POSE "}]}";
static const char points[] = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty "
                             "float y\nproperty float z\nend_header\n0 0 1\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const unsigned kind = size > 0 ? data[0] % 3 : 0;

    if (size < 1)
        return 0;
    (void)fuzz_scene("transforms");
    (void)fuzz_picture("a.png");
    (void)fuzz_picture("b.png");
    (void)fuzz_text("points.ply", points);
    for (unsigned i = 0; i < 3; i++)
        if (kind == 0 || i == 0)
            fuzz_no_file(name[i]);
        else
            (void)fuzz_text(name[i], good);
    (void)fuzz_file(name[kind], data + 1, size - 1);
    (void)fuzz_load_scene();
    return 0;
}
