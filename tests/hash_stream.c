/* hash_stream.c - the streams of bench/determinism.sh: one of the shape of the paper, and small ones of many shapes.
 *     hash_stream PREFIX       writes PREFIX00.ted4, PREFIX01.ted4, ...
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "random_scene.h"

enum { N_STREAMS = 25, PAPER_ANCHORS = 2000 };

static int write_stream(const char *prefix, unsigned number, const ted4_scene *s)
{
    char path[4096];
    uint8_t *data;
    size_t size;
    FILE *f;
    int ok;

    if (s == NULL || ted4_encode(s, 0, NULL, &data, &size, NULL) != TED4_OK)
        return 0;
    (void)snprintf(path, sizeof path, "%s%02u.ted4", prefix, number);
    f = fopen(path, "wb");
    ok = f != NULL && fwrite(data, 1, size, f) == size;
    ok = f != NULL && fclose(f) == 0 && ok;
    free(data);
    return ok;
}

int main(int argc, char **argv)
{
    random_source r = random_seed(1);
    const ted4_header h = random_paper_header(PAPER_ANCHORS);

    for (unsigned i = 0; argc == 2 && i < N_STREAMS; i++) {
        ted4_scene *s = i == 0 ? random_scene_of(&r, &h, 0) : random_scene(i);
        const int ok = write_stream(argv[1], i, s);

        ted4_scene_free(s);
        if (!ok) {
            fprintf(stderr, "hash_stream: stream %u failed\n", i);
            return 3;
        }
    }
    return argc == 2 ? 0 : 3;
}
