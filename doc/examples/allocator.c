/* allocator.c - the library takes its memory from a function of the caller, which counts it.
 *     cc allocator.c $(pkg-config --cflags --libs ted4)
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include "read_file.h"

typedef struct {
    size_t blocks, bytes;
} counter;

static void *count_alloc(void *user, size_t size)
{
    counter *c = user;

    c->blocks++;
    c->bytes += size;
    return malloc(size);
}

static void count_free(void *user, void *block)
{
    counter *c = user;

    c->blocks -= block != NULL;
    free(block);
}

int main(int argc, char **argv)
{
    size_t size;
    unsigned char *data = read_file(argc, argv, &size);
    counter c = { 0, 0 };
    ted4_options options = { 0 };
    ted4_error e;
    ted4_scene *scene;

    options.allocator.alloc = count_alloc;
    options.allocator.free = count_free;
    options.allocator.user = &c;
    if (ted4_decode(data, size, &options, &scene, &e) != TED4_OK)
        return 1;
    printf("%zu bytes taken, %zu blocks held", c.bytes, c.blocks);
    ted4_scene_free(scene);
    printf(", %zu after ted4_scene_free\n", c.blocks);
    free(data);
    return 0;
}
