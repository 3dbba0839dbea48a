/* salvage.c - see salvage.h. Takes the strict decoder's scene of the valid file and removes its
 * last tiles, so that lenient decoding is checked without being used.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "salvage.h"

#include <string.h>
#include "answer.h"

/* R-LEN-002: reduces n_anchors of the scene to n and leaves everything else unchanged. */
static void keep_first(ted4_scene *s, uint32_t n)
{
    const size_t all = s->head.n_anchors;

    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t c = 0; c < s->shape.dim[t]; c++)
            memmove(s->symbol[t] + c * n, s->symbol[t] + c * all, n * sizeof *s->symbol[t]);
    s->head.n_anchors = n;
    ted4_shape_make(&s->shape, &s->head);
    ted4_scene_hash(s, s->hash);
}

/* Returns the status with that identifier. Ends the program if there is none. */
static ted4_status status_of(const conf_line *l, const char *id)
{
    for (int i = 0; i < TED4_N_STATUS; i++)
        if (strcmp(ted4_status_id((ted4_status)i), id) == 0)
            return (ted4_status)i;
    conf_line_bad(l, "no such error identifier");
}

json_t *conf_salvage(const conf_line *l, const conf_bytes *valid, const conf_stream *s,
                     const json_t *stop, const json_t *queries)
{
    const char *const id = l->n > 2 ? l->word[2]
                                    : json_string_value(json_object_get(stop, "error"));
    ted4_salvage what = { .n_tiles = (uint32_t)conf_line_number(l, 1, 0, UINT32_MAX) };
    ted4_scene *scene;
    json_t *o;

    if (what.n_tiles == 0)
        return json_null();
    if (ted4_decode(valid->data, valid->size, NULL, &scene, NULL) != TED4_OK)
        conf_line_bad(l, "the file that is broken was not valid");
    what.stop.code = status_of(l, id);
    what.stop.offset = l->n > 2 ? conf_stream_where(s, l, 4)
                                : (size_t)json_integer_value(json_object_get(stop, "offset"));
    what.anchors_declared = scene->head.n_anchors;
    what.tiles_declared = scene->shape.n_tiles;
    if (what.n_tiles > what.tiles_declared)
        conf_line_bad(l, "more tiles than there are");
    if (what.n_tiles < what.tiles_declared)
        keep_first(scene, what.n_tiles * scene->head.tile_size);
    o = conf_salvaged(scene, &what, queries);
    ted4_scene_free(scene);
    return o;
}
