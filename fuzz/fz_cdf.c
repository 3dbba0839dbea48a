/* fz_cdf.c - the Gaussian model of a symbol: u8 sigma index, u8 fraction of mu, then 16-bit slots
 * and values. test_gaussian.c tests all sigma indices with all fractions; here they are sampled.
 * Claims: the cumulative frequencies are those of spec 9.4, computed in wide integers, and strictly
 * increase from 0 to 2^16; every slot belongs to exactly one symbol; any k becomes a symbol, with
 * an escape exactly if k lies outside the window, and is decoded as k.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "norm/gaussian.h"

/* Floor division as in spec 9.4, of 64-bit integers. */
static int64_t floor_div(int64_t x, int64_t y)
{
    return x / y - (x % y != 0 && x < 0);
}

static int64_t cum(unsigned g, int64_t fr, int64_t j)
{
    const int64_t hw = ted4_half[g], size = 2 * hw + 4;
    const int64_t d = 256 * (j - 1 - hw) - 128 - fr;
    int64_t z, i, b, p;

    if (j == 0 || j == size)
        return j == 0 ? 0 : 65536;
    z = floor_div(d * ted4_inv[g], 2048);
    z = z < -131072 ? -131072 : z > 131072 ? 131072 : z;
    i = (z + 131072) / 256;
    b = (z + 131072) % 256;
    p = ted4_phi[i] + (ted4_phi[i + 1 < 1024 ? i + 1 : 1024] - ted4_phi[i]) * b / 256;
    return p / 256 * (65536 - size) / 65536 + j;
}

static void check_slot(unsigned g, int32_t fr, uint32_t slot)
{
    ted4_slots s;
    const uint32_t j = ted4_gauss_find(g, fr, slot, &s);

    fuzz_require(j < ted4_gauss_size(g), "a symbol of the alphabet");
    fuzz_require(s.start <= slot && slot - s.start < s.freq, "the symbol that holds the slot");
    fuzz_require(s.start == cum(g, fr, j) && s.start + s.freq == cum(g, fr, (int64_t)j + 1),
                 "its slots");
}

static void check_value(unsigned g, int32_t mu, int32_t k)
{
    const int64_t m = floor_div(mu, 256), r = k - m, hw = ted4_half[g];
    const ted4_gauss_symbol s = ted4_gauss_of(mu, g, k);
    ted4_slots slots;
    const uint32_t j = ted4_gauss_find(g, (int32_t)(mu - 256 * m), s.slots.start, &slots);

    fuzz_require(slots.start == s.slots.start && slots.freq == s.slots.freq,
                 "value to slots to symbol");
    fuzz_require((s.escape >= 0) == (r < -hw || r > hw + 1), "escapes outside the window only");
    fuzz_require(r ==
                     (s.escape >= 0 ? ted4_gauss_escaped(g, j, s.escape) : ted4_gauss_offset(g, j)),
                 "and back");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_source in = { data, data + size };
    const unsigned g = fuzz_u8(&in) % TED4_N_SIGMA;
    const int32_t fr = fuzz_u8(&in);
    int64_t before = -1;

    for (uint32_t j = 0; j <= ted4_gauss_size(g); j++) {
        const int64_t c = cum(g, fr, j);

        fuzz_require(c == ted4_gauss_cum(g, fr, j) && c > before && c <= 65536,
                     "cumulative frequencies");
        before = c;
    }
    fuzz_require(before == 65536, "the sum of frequencies");
    check_slot(g, fr, 0);
    check_slot(g, fr, 65535);
    while (in.at < in.end) {
        const int32_t mu = (int32_t)(fuzz_u32(&in) << 4) >> 4, near = mu % (1 << 22);
        const int32_t k = (int16_t)fuzz_u16(&in), width = 2 * ted4_half[g] + 9;

        check_slot(g, fr, fuzz_u16(&in));
        check_value(g, mu, ted4_sat16(k));
        /* Values in the window, on its edges, and just outside. */
        check_value(g, near,
                    ted4_sat16((int32_t)floor_div(near, 256) + (k & 0x7fff) % width - width / 2));
    }
    return 0;
}
