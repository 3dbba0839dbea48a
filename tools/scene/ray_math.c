/* ray_math.c - sine, angle, sRGB curve and value noise for the project's scenes (ray_math.h
 * explains why libm is not used).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_math.h"

#include <string.h>

/* A Taylor series on [-pi/2, pi/2]; the first omitted term is (pi/2)^21 / 21! = 3e-16. */
double ted4_ray_sin(double turns)
{
    static const double factor[9] = { 1.0 / 342, 1.0 / 272, 1.0 / 210, 1.0 / 156, 1.0 / 110,
                                      1.0 / 72,  1.0 / 42,  1.0 / 20,  1.0 / 6 };
    double r = turns - (double)(int64_t)turns, x, y, s;

    if (r > 0.5)
        r -= 1;
    if (r < -0.5)
        r += 1;
    if (r > 0.25)
        r = 0.5 - r;
    if (r < -0.25)
        r = -0.5 - r;
    x = 2 * RAY_PI * r;
    y = x * x;
    s = 1;
    for (int k = 0; k < 9; k++)
        s = 1 - s * y * factor[k];
    return s * x;
}

double ted4_ray_cos(double turns)
{
    return ted4_ray_sin(turns + 0.25);
}

double ted4_ray_exp2(double x)
{
    const double y = 0.69314718055994531 * x;
    double s = 1;

    for (int k = 20; k > 0; k--)
        s = 1 + s * y / k;
    return s;
}

float ted4_ray_atan2(float y, float x)
{
    const float ax = fabsf(x), ay = fabsf(y);
    float a = 0;

    if (ay > ax)
        a = (float)(RAY_PI / 2) - ray_atan(ax / ay);
    else if (ax > 0)
        a = ray_atan(ay / ax);
    if (x < 0)
        a = (float)RAY_PI - a;
    return y < 0 ? -a : a;
}

/* The cube root by Newton steps. The first guess divides the exponent by three (relative error
 * below 6 %, then 4e-3, 2e-5, 4e-10). */
static float cube_root(float x)
{
    uint32_t bits;
    float r;

    memcpy(&bits, &x, sizeof bits);
    bits = bits / 3 + 0x2a500000u;
    memcpy(&r, &bits, sizeof r);
    for (int i = 0; i < 3; i++)
        r = (2 * r + x / (r * r)) / 3;
    return r;
}

/* The exponent 1 / 2.4 is 5 / 12: x^(5/12) is the cube root of x x^(1/4). */
uint8_t ted4_ray_srgb(float linear)
{
    const float x = ray_clamp(linear, 0, 1);
    const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * cube_root(x * sqrtf(sqrtf(x))) - 0.055f;

    return (uint8_t)(255 * y + 0.5f);
}

void ted4_ray_bytes(vec3 linear, uint8_t rgb[3])
{
    rgb[0] = ted4_ray_srgb(linear.x);
    rgb[1] = ted4_ray_srgb(linear.y);
    rgb[2] = ted4_ray_srgb(linear.z);
}

static float fade(float f)
{
    return f * f * (3 - 2 * f);
}
static float mix(float a, float b, float s)
{
    return a + s * (b - a);
}

/* One z layer of the lattice; fx and fy are smoothed fractions. */
static float layer(int x, int y, int z, float fx, float fy, uint32_t seed)
{
    const float a = mix(ray_random(x, y, z, seed), ray_random(x + 1, y, z, seed), fx);
    const float b = mix(ray_random(x, y + 1, z, seed), ray_random(x + 1, y + 1, z, seed), fx);

    return mix(a, b, fy);
}

float ted4_ray_noise2(float x, float y, uint32_t seed)
{
    const int i = ray_floor(x), j = ray_floor(y);

    return layer(i, j, 0, fade(x - (float)i), fade(y - (float)j), seed);
}

float ted4_ray_noise3(vec3 p, uint32_t seed)
{
    const int i = ray_floor(p.x), j = ray_floor(p.y), k = ray_floor(p.z);
    const float fx = fade(p.x - (float)i), fy = fade(p.y - (float)j);

    return mix(layer(i, j, k, fx, fy, seed), layer(i, j, k + 1, fx, fy, seed),
               fade(p.z - (float)k));
}
