/* ours.c - an example for adapter.h: libted4dec behind the contract, without ted4dec.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include "adapter.h"
#include "ted4.h"
#include "tool/tier_hash.h"

/* The file goes with its scene: T0 is about it. */
typedef struct {
    const uint8_t *data;
    size_t size;
    ted4_scene *scene;
    ted4_recon *recon; /* NULL until the first query */
} opened;

static void release(void *scene)
{
    opened *o = scene;

    ted4_recon_free(o->recon);
    ted4_scene_free(o->scene);
    free(o);
}

static void *decode(const uint8_t *data, size_t size, uint64_t max_bytes, uint64_t max_work,
                    ted4_adapter_verdict *v)
{
    const ted4_options limit = { .max_bytes = max_bytes, .max_work = max_work };
    opened *o = calloc(1, sizeof *o);
    ted4_error e = { TED4_E_LIMIT_MEMORY, 0 };

    if (o == NULL || ted4_decode(data, size, &limit, &o->scene, &e) != TED4_OK) {
        *v = (ted4_adapter_verdict) { ted4_verdict_name(ted4_status_verdict(e.code)),
                                      ted4_status_id(e.code), e.offset };
        free(o);
        return NULL;
    }
    o->data = data;
    o->size = size;
    return o;
}

static int tier(void *scene, int number, ted4_adapter_sink *sink, void *user)
{
    const opened *o = scene;

    return (number == 0 ? ted4_dump_syntax(o->data, o->size, NULL, sink, user, NULL)
                        : ted4_dump_tier(o->scene, number, NULL, sink, user)) == TED4_OK
               ? 0
               : -1;
}

static const char *query(void *scene, uint32_t num, uint32_t den, const float camera[3],
                         ted4_adapter_sink *sink, void *user)
{
    const ted4_query q = { num, den, { camera[0], camera[1], camera[2] } };
    opened *o = scene;
    ted4_gaussians g;
    ted4_status s = o->recon == NULL ? ted4_recon_new(&o->recon, o->scene, NULL) : TED4_OK;

    if (s == TED4_OK)
        s = ted4_recon_query(o->recon, &q, NULL, &g);
    if (s != TED4_OK)
        return ted4_status_id(s);
    ted4_tier_records(&g, sink, user);
    return NULL;
}

int main(int argc, char **argv)
{
    const ted4_adapter ours = { "adapter-of-libted4dec",
                                TED4_VERSION,
                                31,
                                ted4_recon_class_x(),
                                1,
                                1,
                                decode,
                                tier,
                                query,
                                release };

    return ted4_adapter_main(&ours, argc, argv);
}
