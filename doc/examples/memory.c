/* memory.c - decodes a file that lies in memory, within a memory limit, and prints why it is
 * refused.
 *     cc memory.c $(pkg-config --cflags --libs ted4)
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "read_file.h"

int main(int argc, char **argv)
{
    size_t size;
    unsigned char *data = read_file(argc, argv, &size);
    ted4_options options = { 0 };
    ted4_error e;
    ted4_scene *scene;
    ted4_info info;

    options.max_bytes = (uint64_t)256 << 20; /* of memory */
    if (ted4_decode(data, size, &options, &scene, &e) != TED4_OK) {
        printf("%s at byte %zu: %s\n", ted4_status_id(e.code), e.offset, ted4_status_text(e.code));
        free(data);
        return 1;
    }
    free(data); /* the scene does not refer to it */
    ted4_scene_info(scene, &info);
    for (int i = 0; i < 16; i++)
        printf("%02x", info.hash[i]);
    printf("\n");
    ted4_scene_free(scene);
    return 0;
}
