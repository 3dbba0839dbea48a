/* build.c - see build.h: the steps in order.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "build.h"

#include <stdlib.h>
#include <string.h>
#include "norm/octree.h"
#include "write/encode.h"

/* Puts positions that lie on a coarse grid in the order of its keys. */
static void sort_on_grid(ted4_scene *s)
{
    uint16_t *p = s->position;

    for (size_t i = 1; s->grid > 0 && s->grid < TED4_OCTREE_DEPTH && i < s->head.n_anchors; i++)
        for (size_t j = i;
             j > 0 && ted4_octree_key(p + 3 * j, s->grid) < ted4_octree_key(p + 3 * j - 3, s->grid);
             j--) {
            uint16_t keep[3];

            memcpy(keep, p + 3 * j, sizeof keep);
            memcpy(p + 3 * j, p + 3 * j - 3, sizeof keep);
            memcpy(p + 3 * j - 3, keep, sizeof keep);
        }
}

void conf_build_file(conf_build *b, const conf_recipe *r, conf_bytes *file)
{
    const conf_line *const seed = conf_line_find(r, "seed"), *const level =
                                                                 conf_line_find(r, "level");
    const conf_line *const profile = conf_line_find(r, "profile");
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
    if (profile != NULL) {
        b->scene->profile = TED4_PROFILE_COMPACT;
        b->scene->grid = (uint8_t)conf_line_number(profile, 2, 0, 16);
    }
    conf_build_nets(b);
    conf_build_positions(b);
    sort_on_grid(b->scene);
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
