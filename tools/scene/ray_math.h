/* ray_math.h - vector arithmetic, sine and hash noise for the project's scenes. Of libm, only sqrt
 * and fabs are called, so that pictures have the same bytes on every machine.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_MATH_H
#define RAY_MATH_H

#include <math.h>
#include <stdint.h>

#define RAY_PI 3.14159265358979323846

typedef struct {
    float x, y, z;
} vec3;

static inline vec3 v3(float x, float y, float z)
{
    const vec3 r = { x, y, z };
    return r;
}

static inline vec3 v3_add(vec3 a, vec3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline vec3 v3_sub(vec3 a, vec3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline vec3 v3_mul(vec3 a, vec3 b)
{
    return v3(a.x * b.x, a.y * b.y, a.z * b.z);
}
static inline vec3 v3_scale(vec3 a, float s)
{
    return v3(a.x * s, a.y * s, a.z * s);
}
static inline vec3 v3_along(vec3 a, vec3 d, float t)
{
    return v3_add(a, v3_scale(d, t));
}
static inline float v3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline float v3_length(vec3 a)
{
    return sqrtf(v3_dot(a, a));
}
static inline vec3 v3_unit(vec3 a)
{
    return v3_scale(a, 1.0f / v3_length(a));
}
static inline vec3 v3_mix(vec3 a, vec3 b, float s)
{
    return v3_along(a, v3_sub(b, a), s);
}

static inline float ray_min(float a, float b)
{
    return a < b ? a : b;
}
static inline float ray_max(float a, float b)
{
    return a > b ? a : b;
}
static inline float ray_clamp(float x, float a, float b)
{
    return ray_min(ray_max(x, a), b);
}

/* |x| < 2^31 */
static inline int ray_floor(float x)
{
    const int i = (int)x;
    return i - (x < (float)i);
}

static inline float ray_fract(float x)
{
    return x - (float)ray_floor(x);
}

/* A smooth step from 0 at x <= a to 1 at x >= b. */
static inline float ray_step(float a, float b, float x)
{
    const float s = ray_clamp((x - a) / (b - a), 0, 1);
    return s * s * (3 - 2 * s);
}

/* Multiply a row-major 3 x 3 rotation, or its transpose, by a vector. */
static inline vec3 ray_rotate(const float m[9], vec3 v)
{
    return v3(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
              m[6] * v.x + m[7] * v.y + m[8] * v.z);
}

static inline vec3 ray_unrotate(const float m[9], vec3 v)
{
    return v3(m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
              m[2] * v.x + m[5] * v.y + m[8] * v.z);
}

/* Return the sine and cosine of an angle in turns (1 is a full circle), |turns| < 2^30, with an
 * error of about 1e-15. */
double ted4_ray_sin(double turns);
double ted4_ray_cos(double turns);
/* Returns 2^x for |x| <= 2, with a relative error of about 1e-14. */
double ted4_ray_exp2(double x);
/* Returns the angle of (x, y) in radians, in (-pi, pi], with an error of about 2e-7. */
float ted4_ray_atan2(float y, float x);

/* Arc tangent for 0 <= q < 2.4: a series for |r| <= tan(pi/8), after the identity atan q = pi/4 +
 * atan((q - 1) / (q + 1)) for larger q. The first omitted term is 2e-8. */
static inline float ray_atan(float q)
{
    static const float factor[8] = { 1.0f / 15, 1.0f / 13, 1.0f / 11, 1.0f / 9,
                                     1.0f / 7,  1.0f / 5,  1.0f / 3,  1 };
    const float high = q > 0.41421356f ? 1.0f : 0.0f;
    const float r = high > 0 ? (q - 1) / (q + 1) : q, y = r * r;
    float s = 0;

    for (int k = 0; k < 8; k++)
        s = factor[k] - s * y;
    return r * s + high * (float)(RAY_PI / 4);
}

/* Convert a linear colour channel to an sRGB byte, and a linear colour to its bytes. */
uint8_t ted4_ray_srgb(float linear);
void ted4_ray_bytes(vec3 linear, uint8_t rgb[3]);

static inline uint32_t ray_hash(int x, int y, int z, uint32_t seed)
{
    uint32_t h = ((uint32_t)x * 0x6a09e667u) ^ ((uint32_t)y * 0xbb67ae85u) ^
                 ((uint32_t)z * 0x3c6ef373u) ^ (seed * 0x243f6a89u);

    h = (h ^ h >> 16) * 0x9e3779b1u;
    h = (h ^ h >> 13) * 0x5be0cd19u;
    return h ^ h >> 16;
}

/* Returns a random number in [0, 1). */
static inline float ray_random(int x, int y, int z, uint32_t seed)
{
    return (float)(ray_hash(x, y, z, seed) >> 8) * 0x1p-24f;
}

/* Smooth value noise in [0, 1]; lattice step 1. */
float ted4_ray_noise2(float x, float y, uint32_t seed);
float ted4_ray_noise3(vec3 p, uint32_t seed);

#endif
