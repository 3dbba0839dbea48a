/* raster.c - manages the workspace and runs the stages of the forward pass: projection (project.c),
 * sorting by depth and into tiles (bin.c), and blending (blend.c).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/raster_state.h"

#include <stdlib.h>

int ted4_growing_grow(ted4_growing *b, size_t n, size_t element_size)
{
    const size_t align = 64;

    if (n > (SIZE_MAX / 2 - align) / element_size)
        return -1;
    if (n * element_size <= b->size)
        return 0;

    size_t size = n * element_size;
    size = (size + size / 2 + align) / align * align;
    free(b->data);
    b->data = aligned_alloc(align, size);
    b->size = b->data != NULL ? size : 0;
    return b->data != NULL ? 0 : -1;
}

void ted4_growing_free(ted4_growing *b)
{
    free(b->data);
    b->data = NULL;
    b->size = 0;
}

ted4_raster *ted4_raster_new(void)
{
    return calloc(1, sizeof(ted4_raster));
}

void ted4_raster_free(ted4_raster *r)
{
    if (r == NULL)
        return;

    ted4_growing *const all[] = { &r->splat2d, &r->box,      &r->first_instance, &r->key[0],
                                  &r->key[1],  &r->chunk,    &r->hist,           &r->tile_first,
                                  &r->owner,   &r->instance, &r->reach };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        ted4_growing_free(all[i]);
    free(r);
}

uint64_t ted4_raster_skipped(const ted4_raster *r)
{
    return r->n_skipped;
}

int ted4_raster_project(struct ted4_raster *r, const ted4_splats *s, const ted4_view *v,
                        const ted4_parallel *p)
{
    return TED4_IN_USE(ted4_raster_project)(r, s, v, p);
}

int ted4_raster_blend(struct ted4_raster *r, const ted4_view *v, const ted4_parallel *p,
                      int keep_state, float *image)
{
    return TED4_IN_USE(ted4_raster_blend)(r, v, p, keep_state, image);
}

int ted4_raster_forward(ted4_raster *r, const ted4_splats *s, const ted4_view *v,
                        const ted4_parallel *p, int keep_state, float *image)
{
    r->tiles_x = ((uint32_t)v->width + TED4_TILE - 1) / TED4_TILE;
    r->tiles_y = ((uint32_t)v->height + TED4_TILE - 1) / TED4_TILE;
    /* Places of tiles have 16 bits; a chunk counts its instances in 32, and may fill all tiles. */
    if (r->tiles_x > UINT16_MAX || r->tiles_y > UINT16_MAX ||
        (uint64_t)r->tiles_x * r->tiles_y * TED4_CHUNK > UINT32_MAX)
        return -1;
    if (ted4_raster_project(r, s, v, p) != 0 || ted4_raster_bin(r, s, p) != 0)
        return -1;
    return ted4_raster_blend(r, v, p, keep_state, image);
}
