/* out_glb.c - binary glTF 2.0 with KHR_gaussian_splatting: one mesh of points, with one buffer view
 * of floats per attribute.
 * In glTF, +Y is up and cameras look along -Z; programs for the other formats expect Y down and Z
 * forward. So that all show a scene the same way up, positions, rotations and spherical harmonics
 * are rotated by 180 degrees about X. COLOR_0 is a
 * fallback for viewers that do not support splats.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "export.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/bytes.h"
#include "sh.h"
#include "ted4.h"

enum {
    GLTF_FLOAT = 5126,
    GLTF_UNSIGNED_SHORT = 5123,
    MAX_ATTRIBUTES = 5 + TED4_SH_MAX_COEFS,
    GLB_HEADER = 12,
    GLB_CHUNK = 8
};

/* An attribute. fill writes the value of Gaussian i. */
typedef struct glb_attribute {
    char name[64];
    const char *type;
    int component; /* GLTF_FLOAT, or GLTF_UNSIGNED_SHORT normalised */
    int coef;      /* index of the coefficient of spherical harmonics */
    size_t size;   /* bytes per Gaussian, a multiple of 4 */
    void (*fill)(uint8_t *out, const ted4_frame *x, size_t i, const struct glb_attribute *a);
} glb_attribute;

static void glb_floats(uint8_t *out, int n, const float *v)
{
    for (int k = 0; k < n; k++)
        ted4_store32(out + 4 * k, ted4_float_bits(v[k]));
}

static void glb_position(uint8_t *out, const ted4_frame *x, size_t i, const glb_attribute *a)
{
    (void)a;
    glb_floats(out, 3, (const float[]) { x->mean[0][i], -x->mean[1][i], -x->mean[2][i] });
}

/* The quaternion (0, 1, 0, 0) times the rotation, stored as x y z w. */
static void glb_rotation(uint8_t *out, const ted4_frame *x, size_t i, const glb_attribute *a)
{
    (void)a;
    glb_floats(out, 4,
               (const float[]) { x->rot[0][i], -x->rot[3][i], x->rot[2][i], -x->rot[1][i] });
}

static void glb_scale(uint8_t *out, const ted4_frame *x, size_t i, const glb_attribute *a)
{
    (void)a;
    glb_floats(out, 3, (const float[]) { x->scale[0][i], x->scale[1][i], x->scale[2][i] });
}

static void glb_opacity(uint8_t *out, const ted4_frame *x, size_t i, const glb_attribute *a)
{
    (void)a;
    glb_floats(out, 1, (const float[]) { fminf(fmaxf(x->opacity[i], 0.0f), 1.0f) });
}

static void glb_short(uint8_t *out, double v)
{
    const unsigned n = (unsigned)(65535.0 * fmin(fmax(v, 0.0), 1.0) + 0.5);

    out[0] = (uint8_t)(n & 255);
    out[1] = (uint8_t)(n >> 8);
}

/* Intensity of an sRGB value in [0, 1] (IEC 61966-2-1). */
static double linear(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* glTF wants linear colours and alpha. 8 bits would show steps in dark colours. */
static void glb_colour(uint8_t *out, const ted4_frame *x, size_t i, const glb_attribute *a)
{
    const size_t n_coefs = (size_t)ted4_sh_count(x->sh_degree);

    (void)a;
    for (size_t c = 0; c < 3; c++)
        glb_short(out + 2 * c, linear(0.5 + TED4_SH_C0 * (double)x->sh[(i * 3 + c) * n_coefs]));
    glb_short(out + 6, (double)x->opacity[i]);
}

/* A rotation by 180 degrees about X changes the signs of y and z, and therefore of the basis
 * functions whose total degree in y and z is odd. */
static const float SH_SIGN[TED4_SH_MAX_COEFS] = { 1, -1, -1, 1,  -1, 1, 1,  -1,
                                                  1, -1, 1,  -1, -1, 1, -1, 1 };

static void glb_sh(uint8_t *out, const ted4_frame *x, size_t i, const glb_attribute *a)
{
    const size_t n_coefs = (size_t)ted4_sh_count(x->sh_degree);
    float v[3];

    for (size_t c = 0; c < 3; c++)
        v[c] = SH_SIGN[a->coef] * x->sh[(i * 3 + c) * n_coefs + (size_t)a->coef];
    glb_floats(out, 3, v);
}

static int list_attributes(glb_attribute *a, int sh_degree)
{
    static const glb_attribute fixed[] = {
        { "POSITION", "VEC3", GLTF_FLOAT, 0, 12, glb_position },
        { "COLOR_0", "VEC4", GLTF_UNSIGNED_SHORT, 0, 8, glb_colour },
        { "KHR_gaussian_splatting:ROTATION", "VEC4", GLTF_FLOAT, 0, 16, glb_rotation },
        { "KHR_gaussian_splatting:SCALE", "VEC3", GLTF_FLOAT, 0, 12, glb_scale },
        { "KHR_gaussian_splatting:OPACITY", "SCALAR", GLTF_FLOAT, 0, 4, glb_opacity },
    };
    int n = sizeof fixed / sizeof *fixed;

    memcpy(a, fixed, sizeof fixed);
    for (int l = 0; l <= sh_degree; l++) {
        for (int m = 0; m <= 2 * l; m++, n++) {
            a[n] = (glb_attribute) { "", "VEC3", GLTF_FLOAT, l * l + m, 12, glb_sh };
            snprintf(a[n].name, sizeof a[n].name, "KHR_gaussian_splatting:SH_DEGREE_%d_COEF_%d", l,
                     m);
        }
    }
    return n;
}

/* Text that grows in an array of fixed size. The longest JSON (degree 3) has about 5 kB. */
typedef struct {
    char text[16384];
    size_t n;
} glb_json;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
say(glb_json *j, const char *format, ...)
{
    va_list ap;

    va_start(ap, format);
    const int n = vsnprintf(j->text + j->n, sizeof j->text - j->n, format, ap);
    va_end(ap);
    if (n > 0)
        j->n += (size_t)n < sizeof j->text - j->n ? (size_t)n : sizeof j->text - j->n - 1;
}

/* glTF requires the bounds of POSITION. */
static void say_bounds(glb_json *j, const ted4_frame *x)
{
    float low[3] = { FLT_MAX, FLT_MAX, FLT_MAX }, high[3] = { -FLT_MAX, -FLT_MAX, -FLT_MAX };

    for (size_t i = 0; i < x->n; i++) {
        for (int c = 0; c < 3; c++) {
            const float v = c == 0 ? x->mean[c][i] : -x->mean[c][i];

            low[c] = fminf(low[c], v);
            high[c] = fmaxf(high[c], v);
        }
    }
    say(j, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", (double)low[0], (double)low[1],
        (double)low[2], (double)high[0], (double)high[1], (double)high[2]);
}

static void say_mesh(glb_json *j, const ted4_frame *x, const glb_attribute *a, int n, size_t size)
{
    size_t at = 0;

    say(j, ",\"extensionsUsed\":[\"KHR_gaussian_splatting\"]"
           ",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]"
           ",\"meshes\":[{\"primitives\":[{\"mode\":0,\"attributes\":{");
    for (int i = 0; i < n; i++)
        say(j, "%s\"%s\":%d", i == 0 ? "" : ",", a[i].name, i);
    say(j, "},\"extensions\":{\"KHR_gaussian_splatting\":{\"kernel\":\"ellipse\""
           ",\"colorSpace\":\"srgb_rec709_display\",\"projection\":\"perspective\""
           ",\"sortingMethod\":\"cameraDistance\"}}}]}],\"accessors\":[");
    for (int i = 0; i < n; i++) {
        say(j, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
            i == 0 ? "" : ",", i, a[i].component, x->n, a[i].type);
        if (i == 0)
            say_bounds(j, x);
        say(j, "%s}", a[i].component == GLTF_UNSIGNED_SHORT ? ",\"normalized\":true" : "");
    }
    say(j, "],\"bufferViews\":[");
    for (int i = 0; i < n; i++, at += a[i - 1].size * x->n)
        say(j, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34962}",
            i == 0 ? "" : ",", at, a[i].size * x->n);
    say(j, "],\"buffers\":[{\"byteLength\":%zu}]", size);
}

static int write_chunk_head(FILE *f, size_t size, const char type[4])
{
    uint8_t head[GLB_CHUNK];

    ted4_store32(head, (uint32_t)size);
    memcpy(head + 4, type, 4);
    return fwrite(head, sizeof head, 1, f) == 1 ? 0 : -1;
}

static int write_values(FILE *f, const ted4_frame *x, const glb_attribute *a, int n)
{
    for (int k = 0; k < n; k++) {
        for (size_t i = 0; i < x->n; i++) {
            uint8_t bytes[16];

            a[k].fill(bytes, x, i, &a[k]);
            if (fwrite(bytes, a[k].size, 1, f) != 1)
                return -1;
        }
    }
    return 0;
}

/* glTF forbids empty accessors, so without Gaussians the file is an empty scene without a
 * buffer. */
static int write_glb(FILE *f, const ted4_frame *x)
{
    glb_attribute a[MAX_ATTRIBUTES];
    glb_json j = { "", 0 };
    const int n = list_attributes(a, x->sh_degree);
    uint8_t head[GLB_HEADER];
    size_t size = 0, total;

    for (int i = 0; i < n; i++)
        size += a[i].size * x->n;
    say(&j, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"ted4dec %s\"},\"scene\":0",
        TED4_VERSION);
    if (x->n > 0)
        say_mesh(&j, x, a, n, size);
    else
        say(&j, ",\"scenes\":[{}]");
    say(&j, "}");
    while (j.n % 4 != 0)
        say(&j, " ");
    total = GLB_HEADER + GLB_CHUNK + j.n + (x->n > 0 ? GLB_CHUNK + size : 0);
    if (total > UINT32_MAX) {
        errno = EFBIG;
        return -1;
    }
    memcpy(head, "glTF", 4);
    ted4_store32(head + 4, 2);
    ted4_store32(head + 8, (uint32_t)total);
    if (fwrite(head, sizeof head, 1, f) != 1 || write_chunk_head(f, j.n, "JSON") != 0 ||
        fwrite(j.text, j.n, 1, f) != 1)
        return -1;
    if (x->n == 0)
        return 0;
    return write_chunk_head(f, size, "BIN") != 0 ? -1 : write_values(f, x, a, n);
}

const ted4_format ted4_format_glb = {
    ".glb", "binary glTF with KHR_gaussian_splatting, spherical harmonics of --sh-degree; +Y up",
    TED4_SH_MAX_DEGREE, write_glb
};
