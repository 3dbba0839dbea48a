/* out_ply.c - PLY of 3D Gaussian splatting, binary little-endian, with the usual order of
 * properties. Comments come after the properties, because one widespread reader expects the vertex
 * count in line 3. The normals are zero; they are present because that reader requires them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "export.h"

#include <float.h>
#include <math.h>

#include "base/bytes.h"
#include "sh.h"

/* Opacity is stored as its logit, so 0 and 1 are first moved inwards by this much. */
#define OPACITY_MARGIN 0x1p-20

enum { MAX_FLOATS = 17 + 3 * (TED4_SH_MAX_COEFS - 1) };

static int write_header(FILE *f, const ted4_frame *x, int n_rest)
{
    fprintf(f, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n", x->n);
    fputs("property float x\nproperty float y\nproperty float z\n"
          "property float nx\nproperty float ny\nproperty float nz\n"
          "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n",
          f);
    for (int i = 0; i < n_rest; i++)
        fprintf(f, "property float f_rest_%d\n", i);
    fputs("property float opacity\n"
          "property float scale_0\nproperty float scale_1\nproperty float scale_2\n"
          "property float rot_0\nproperty float rot_1\n"
          "property float rot_2\nproperty float rot_3\n",
          f);
    for (const char *c = x->comment; *c != '\0'; c++) {
        if (c == x->comment || c[-1] == '\n')
            fputs("comment ", f);
        putc(*c, f);
    }
    return fputs("end_header\n", f) < 0 ? -1 : 0;
}

static float logit(float opacity)
{
    const double o = fmin(fmax((double)opacity, OPACITY_MARGIN), 1.0 - OPACITY_MARGIN);

    return (float)log(o / (1.0 - o));
}

/* Fills v with the properties of Gaussian i. In f_rest, the channel is the slowest index. Returns
 * the number of floats. */
static int fill_record(float *v, const ted4_frame *x, size_t i)
{
    const int n_coefs = ted4_sh_count(x->sh_degree);
    const float *const sh = x->sh + i * 3 * (size_t)n_coefs;
    int n = 0;

    for (int c = 0; c < 3; c++)
        v[n++] = x->mean[c][i];
    for (int c = 0; c < 3; c++)
        v[n++] = 0.0f;
    for (int c = 0; c < 3; c++)
        v[n++] = sh[c * n_coefs];
    for (int c = 0; c < 3; c++)
        for (int k = 1; k < n_coefs; k++)
            v[n++] = sh[c * n_coefs + k];
    v[n++] = logit(x->opacity[i]);
    for (int c = 0; c < 3; c++)
        v[n++] = logf(fmaxf(x->scale[c][i], FLT_MIN));
    for (int c = 0; c < 4; c++)
        v[n++] = x->rot[c][i];
    return n;
}

static int write_ply(FILE *f, const ted4_frame *x)
{
    if (write_header(f, x, 3 * (ted4_sh_count(x->sh_degree) - 1)) != 0)
        return -1;
    for (size_t i = 0; i < x->n; i++) {
        float v[MAX_FLOATS];
        uint8_t bytes[4 * MAX_FLOATS];
        const int n = fill_record(v, x, i);

        for (int k = 0; k < n; k++)
            ted4_store32(bytes + 4 * k, ted4_float_bits(v[k]));
        if (fwrite(bytes, 4, (size_t)n, f) != (size_t)n)
            return -1;
    }
    return 0;
}

const ted4_format ted4_format_ply = {
    ".ply", "3D Gaussian splatting PLY, spherical harmonics of --sh-degree", TED4_SH_MAX_DEGREE,
    write_ply
};
