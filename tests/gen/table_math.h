/* table_math.h - annex A from its formulas, in long double: shared by gen_tables.c (prints) and
 * test_tables.c (compares).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TABLE_MATH_H
#define TED4_TABLE_MATH_H

#include <math.h>
#include <stdint.h>
#include <string.h>

static long double table_sigma(int g)
{
    return exp2l((g - 64) / 16.0L);
}

static int64_t table_half(int g)
{
    const long double h = ceill(6 * table_sigma(g));

    return h < 2 ? 2 : h > 4095 ? 4095 : (int64_t)h;
}

static int64_t table_inv(int g)
{
    return (int64_t)rintl(131072 / table_sigma(g));
}

static int64_t table_phi(int i)
{
    if (i == 0 || i == 1024)
        return i == 0 ? 0 : 1 << 24;
    return (int64_t)rintl(8388608 * erfcl((512 - i) / 64.0L / sqrtl(2)));
}

static int64_t table_sin(int i)
{
    return (int64_t)rintl(4096 * sinl(2 * acosl(-1) * i / 1024));
}

static int64_t table_step(int i)
{
    const float v = (float)exp2l((i - 128) / 32.0L);
    uint32_t u;

    memcpy(&u, &v, sizeof u);
    return u;
}

static int64_t table_stepi(int i)
{
    return (int64_t)rintl(4096 * (long double)(float)exp2l((i - 128) / 32.0L));
}

/* Phi is inverted by bisection. */
static int64_t table_where(int i)
{
    long double low = -8, high = 8;

    for (int step = 0; step < 80; step++) {
        const long double z = (low + high) / 2;

        if (erfcl(-z / sqrtl(2)) / 2 < (i + 0.5L) / 256)
            low = z;
        else
            high = z;
    }
    return (int64_t)rintl(16384 * low);
}

/* The first six are those of annex A. */
enum { N_TABLES = 7, N_ANNEX = 6 };

static const struct table {
    const char *name, *type, *c_name, *size, *text;
    int n;
    int64_t (*entry)(int i);
} table_list[N_TABLES] = {
    { "HALF", "uint16_t", "ted4_half", "TED4_N_SIGMA", "clamp(ceil(6 sigma), 2, 4095)", 240,
      table_half },
    { "INV", "int32_t", "ted4_inv", "TED4_N_SIGMA", "rne(2^17 / sigma)", 240, table_inv },
    { "PHI", "int32_t", "ted4_phi", "TED4_N_PHI",
      "rne(2^24 Phi((i - 512) / 64)), the first 0, the last 2^24", 1025, table_phi },
    { "SIN", "int16_t", "ted4_sin", "TED4_N_SIN", "rne(4096 sin(2 pi i / 1024))", 1025, table_sin },
    { "STEP", "uint32_t", "ted4_step", "TED4_N_STEP", "2^((i - 128) / 32), binary32 patterns", 256,
      table_step },
    { "STEPI", "int32_t", "ted4_stepi", "TED4_N_STEP", "rne(4096 STEP[i])", 256, table_stepi },
    { "WHERE", "int32_t", "ted4_where", "TED4_N_WHERE",
      "rne(2^14 Phi^-1((i + 1/2) / 256)), no part of the specification", 256, table_where },
};

#endif
