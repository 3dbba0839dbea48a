/* fz_query_time.c - any numerator, denominator and camera, queried from one of a few scenes: u8
 * scene, u32 num, u32 den, u8 factor, f32 camera[3]. Claims: a query is refused exactly if den is 0
 * or above 2^24 - 1, or num > den; equal fractions give the same records; num = 0 and num = den
 * give the records of the first and last row of the bank, and frame j of F those of j / (F - 1),
 * however the fraction is written; a NaN or infinite camera gives rec.non-finite or has no effect.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include "harness.h"
#include "random_scene.h"

enum { SCENES = 6, MOST = (1 << 24) - 1 };

/* Scenes that are made once and kept for all inputs: one of each kind of motion, and two with
 * random headers. */
static ted4_recon *recon_of(unsigned which)
{
    static ted4_recon *made[SCENES];
    random_source r = random_seed(which);
    ted4_header h = random_header(&r);
    ted4_scene *s;

    if (made[which] != NULL)
        return made[which];
    h.n_anchors = 40;
    h.exponent = 1;
    h.view = (uint8_t)(which % 3);
    h.motion = (uint8_t)(which % 4);
    h.temporal_mask = 0;
    h.deform_layers = h.motion != TED4_MOTION_NONE ? 2 : 0;
    h.deform_width = h.deform_layers;
    h.phi_dim = h.motion == TED4_MOTION_BANK || h.motion == TED4_MOTION_CONCAT ? 3 : 0;
    h.bank_dim = h.phi_dim;
    h.bank_rows = h.phi_dim > 0 ? 7 : 0;
    s = random_scene_of(&r, &h, 0);
    fuzz_require(s != NULL && ted4_recon_new(&made[which], s, NULL) == TED4_OK, "a scene");
    ted4_scene_free(s);
    return made[which];
}

/* Returns TED4_OK and the hash of the records, or a refusal. */
static ted4_status ask(ted4_recon *r, uint32_t num, uint32_t den, const float camera[3],
                       uint8_t hash[16])
{
    ted4_query q = { .num = num, .den = den };
    ted4_gaussians g;

    memcpy(q.camera, camera, sizeof q.camera);
    memset(hash, 0, 16);

    const ted4_status verdict = ted4_recon_query(r, &q, NULL, &g);

    fuzz_require(verdict == TED4_OK || g.n == 0, "nothing with a refusal");
    for (size_t i = 0; i < g.n; i++)
        fuzz_require(isfinite(g.mean[0][i]) && isfinite(g.opacity[i]) && isfinite(g.colour[2][i]),
                     "finite");
    if (verdict == TED4_OK)
        ted4_gaussians_hash(&g, hash);
    return verdict;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const float far[3] = { 1, 2, -9 };
    fuzz_source in = { data, data + size };
    ted4_recon *r = recon_of(fuzz_u8(&in) % SCENES);
    const uint32_t num = fuzz_u32(&in), den = fuzz_u32(&in), factor = 1 + fuzz_u8(&in);
    const int legal = den >= 1 && den <= MOST && num <= den;
    float camera[3];
    uint8_t a[16], b[16];

    for (int c = 0; c < 3; c++)
        camera[c] = ted4_bits_float(fuzz_u32(&in));

    const ted4_status verdict = ask(r, num, den, camera, a);

    fuzz_require((verdict == TED4_E_QUERY) == !legal, "refused exactly when out of range");
    if (!legal)
        return 0;
    fuzz_require(verdict == TED4_OK || verdict == TED4_E_REC_NONFINITE, "a query");
    if ((uint64_t)den * factor <= MOST) {
        (void)ask(r, num, den, far, b);
        fuzz_require(ask(r, num * factor, den * factor, camera, b) == verdict &&
                         memcmp(a, b, 16) == 0,
                     "equal fractions");
    }
    if (num == 0 || num == den) {
        (void)ask(r, 1, 2, camera, b);
        fuzz_require(ask(r, num > 0, 1, camera, b) == verdict && memcmp(a, b, 16) == 0, "the ends");
    }
    return 0;
}
