/* build.c - see build.h: the steps in order.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "build.h"

#include <stdlib.h>
#include <string.h>
#include "write/encode.h"

void conf_build_file(conf_build *b, const conf_recipe *r, conf_bytes *file)
{
    const conf_line *const seed = conf_line_find(r, "seed"), *const level =
                                                                 conf_line_find(r, "level");
    uint8_t *out;
    size_t size;
    ted4_error e = { TED4_OK, 0 };

    memset(b, 0, sizeof *b);
    b->recipe = r;
    b->chance.state = seed != NULL ? conf_seed(seed->rest) : conf_seed(r->id);
    b->level = level != NULL ? (int)conf_line_number(level, 1, 0, 31) : 0;
    conf_build_header(b);
    b->scene = ted4_scene_new(&b->head, NULL);
    if (b->scene == NULL)
        conf_die("%s: no memory", r->id);
    conf_build_nets(b);
    conf_build_positions(b);
    conf_build_masks(b);
    if (ted4_scene_steps(b->scene, NULL, &e) != TED4_OK)
        conf_die("%s: networks: %s at %zu", r->id, ted4_status_id(e.code), e.offset);
    conf_build_symbols(b);
    conf_build_pack(b);
    if (ted4_encode(b->scene, b->level, NULL, &out, &size, &e) != TED4_OK)
        conf_die("%s: %s at %zu: no valid scene", r->id, ted4_status_id(e.code), e.offset);
    memset(file, 0, sizeof *file);
    conf_add(file, out, size);
    free(out);
}

void conf_build_end(conf_build *b)
{
    ted4_scene_free(b->scene);
    b->scene = NULL;
}
