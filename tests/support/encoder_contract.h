/* encoder_contract.h - what a conforming encoder guarantees (spec 3.4): the file of a scene has no
 * errors for a validator, decodes to the encoder's own reconstruction, declares the lowest level
 * that fits, and codes blobs and probabilities in their shortest form. The file holds no META
 * chunk, so it declares no fidelity that could be wrong. For test_encoder_contract.c and
 * test_encoder_trained.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ENCODER_CONTRACT_H
#define TED4_ENCODER_CONTRACT_H

#include <stdlib.h>
#include <string.h>
#include "norm/limits.h"
#include "test.h"
#include "write/encode.h"

enum { LEVEL_AT = 11 };

/* Returns whether a finding is the writer's responsibility, whatever the scene. */
static inline int contract_of_writer(const char *id)
{
    static const char *const all[] = { "adv.level",       "adv.minor",      "adv.chunk",
                                       "adv.chunk-flags", "adv.meta-flags", "adv.meta-text",
                                       "adv.meta-key",    "adv.blob-raw",   "adv.prob" };

    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (strcmp(id, all[i]) == 0)
            return 1;
    return 0;
}

/* Fails on errors, on findings that are the writer's responsibility and, if *trained, on warnings.
 * Hints are allowed. */
static inline void contract_judge(void *trained, const ted4_finding *f)
{
    if (f->severity == TED4_ERROR || contract_of_writer(f->id) ||
        (*(int *)trained && f->severity == TED4_WARNING))
        fail_msg("%s at byte %zu", f->id, f->offset);
}

/* Hashes the records of a scene at time num / den. */
static inline void contract_reconstruct(const ted4_scene *s, uint32_t num, uint32_t den,
                                        uint8_t hash[16])
{
    const ted4_query q = { num, den, { 0.25f, -0.5f, -3 } };
    ted4_gaussians g;
    ted4_recon *r;

    memset(hash, 0, 16);
    assert_int_equal(ted4_recon_new(&r, s, NULL), TED4_OK);
    if (ted4_recon_query(r, &q, NULL, &g) == TED4_OK)
        ted4_gaussians_hash(&g, hash);
    ted4_recon_free(r);
}

/* Asserts that a file decodes to the scene it was made from. */
static inline void contract_same(const ted4_scene *scene, const uint8_t *data, size_t size)
{
    ted4_scene *back;
    uint8_t ours[16], theirs[16];

    assert_int_equal(ted4_decode(data, size, NULL, &back, NULL), TED4_OK);
    ted4_scene_hash(scene, ours);
    assert_memory_equal(ours, back->hash, 16);
    for (uint32_t i = 0; i <= 3; i++) {
        contract_reconstruct(scene, i, 3, ours);
        contract_reconstruct(back, i, 3, theirs);
        assert_memory_equal(ours, theirs, 16);
    }
    ted4_scene_free(back);
}

/* Asserts that the level is the lowest: with any lower level, a decoder refuses the file. No hash
 * covers the level. */
static inline void contract_lowest(const ted4_scene *scene, uint8_t *data, size_t size)
{
    const uint8_t level = data[LEVEL_AT];
    ted4_scene *s;
    ted4_error e;

    assert_int_equal(level, ted4_level_lowest(&scene->head, &scene->shape, size));
    for (unsigned below = 1; below < level; below++) {
        if (ted4_limits_of(below) == NULL)
            continue;
        data[LEVEL_AT] = (uint8_t)below;
        assert_int_equal(ted4_decode(data, size, NULL, &s, &e), TED4_E_LVL_EXCEEDED);
    }
    data[LEVEL_AT] = level;
}

/* trained: the scene comes from our trainer, which is also responsible for the scene's contents. */
static inline void contract_kept(const ted4_scene *scene, int trained)
{
    uint8_t *data;
    size_t size;

    assert_int_equal(ted4_encode(scene, 0, NULL, &data, &size, NULL), TED4_OK);
    assert_int_equal(ted4_validate(data, size, NULL, contract_judge, &trained), TED4_OK);
    contract_same(scene, data, size);
    contract_lowest(scene, data, size);
    free(data);
}

#endif
