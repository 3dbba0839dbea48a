/* fz_calibration.c - cams.json of fixed cameras with clips. The clips of two of them, cam0 and
 * cam1, exist, with three pictures each. Claims: those of fuzz_load_scene(); no program is started
 * (ted4_video_unpack() is wrapped).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "scene_folder.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const pictures[] = { "images/cam0/1.png", "images/cam0/2.png",
                                            "images/cam0/3.png", "images/cam1/1.png",
                                            "images/cam1/2.png", "images/cam1/3.png" };

    (void)fuzz_scene("calibration");
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; i++)
        (void)fuzz_picture(pictures[i]);
    (void)fuzz_file("cams.json", data, size);
    (void)fuzz_load_scene();
    return 0;
}
