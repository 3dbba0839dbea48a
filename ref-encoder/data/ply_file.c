/* ply_file.c - reads the vertices of a PLY point cloud; see ted4_ply_read in point_cloud.h. A file
 * begins with a text header of lines "format F 1.0", "element NAME COUNT" and "property TYPE NAME",
 * which ends with "end_header". The elements follow in that order, with one vertex per line (ascii)
 * or packed without padding (binary).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/point_cloud.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

enum { MAX_PROPERTIES = 256 }; /* a Gaussian splat file has 62 */

typedef enum { I8, U8, I16, U16, I32, U32, F32, F64, N_TYPES } ply_type;

static const struct {
    const char *name[2];
    size_t size;
} types[N_TYPES] = {
    { { "char", "int8" }, 1 },     { { "uchar", "uint8" }, 1 },    { { "short", "int16" }, 2 },
    { { "ushort", "uint16" }, 2 }, { { "int", "int32" }, 4 },      { { "uint", "uint32" }, 4 },
    { { "float", "float32" }, 4 }, { { "double", "float64" }, 8 },
};

enum { X, Y, Z, RED, GREEN, BLUE, N_WANTED };
static const char *const wanted[N_WANTED][3] = {
    { "x" },
    { "y" },
    { "z" },
    { "red", "diffuse_red", "r" },
    { "green", "diffuse_green", "g" },
    { "blue", "diffuse_blue", "b" },
};

typedef struct {
    const char *path;
    const uint8_t *bytes;
    size_t size, at; /* at: offset of the next byte to read */
    size_t line;
    int binary;
    int in_vertex, elements;
    uint64_t count;
    ply_type type[MAX_PROPERTIES];
    size_t offset[MAX_PROPERTIES];
    size_t n_properties, stride;
    int index[N_WANTED]; /* number of the property, or -1 if absent */
} ply;

/* Reads the next header line without its line end, truncated to the buffer. Returns 1, or 0 at the
 * end of the file. */
static int next_line(ply *p, char *text, size_t capacity)
{
    size_t n = 0;

    if (p->at >= p->size)
        return 0;
    while (p->at < p->size && p->bytes[p->at] != '\n') {
        if (n + 1 < capacity && p->bytes[p->at] != '\r')
            text[n++] = (char)p->bytes[p->at];
        p->at++;
    }
    p->at += p->at < p->size;
    p->line++;
    text[n] = 0;
    return 1;
}

static int find_type(const char *name)
{
    for (int i = 0; i < N_TYPES; i++)
        if (strcmp(name, types[i].name[0]) == 0 || strcmp(name, types[i].name[1]) == 0)
            return i;
    return -1;
}

static int read_property(ply *p, const char *type_name, const char *name, ted4_message *m)
{
    const int type = find_type(type_name);

    if (type < 0)
        return ted4_say(m, "%s:%zu: vertex property of type \"%s\", expected a number type",
                        p->path, p->line, type_name);
    if (p->n_properties == MAX_PROPERTIES)
        return ted4_say(m, "%s:%zu: more than %d vertex properties", p->path, p->line,
                        MAX_PROPERTIES);
    for (int i = 0; i < N_WANTED; i++)
        for (int k = 0; k < 3 && wanted[i][k] != NULL; k++)
            if (strcmp(name, wanted[i][k]) == 0)
                p->index[i] = (int)p->n_properties;
    p->type[p->n_properties] = (ply_type)type;
    p->offset[p->n_properties++] = p->stride;
    p->stride += types[type].size;
    return 0;
}

/* Reads one header line after the first. Returns 1 if it is end_header, 0 for other lines, or -1
 * with *m filled. */
static int read_header_line(ply *p, const char *line, ted4_message *m)
{
    char a[64], b[64];

    if (strcmp(line, "end_header") == 0)
        return 1;
    if (sscanf(line, "format %63s", a) == 1) {
        p->binary = strcmp(a, "binary_little_endian") == 0;
        if (!p->binary && strcmp(a, "ascii") != 0)
            return ted4_say(m, "%s:%zu: format \"%s\", expected ascii or binary_little_endian",
                            p->path, p->line, a);
    } else if (sscanf(line, "element %63s %63s", a, b) == 2) {
        p->in_vertex = strcmp(a, "vertex") == 0;
        if (p->elements++ == 0 && !p->in_vertex)
            return ted4_say(m, "%s:%zu: first element \"%s\", expected vertex", p->path, p->line,
                            a);
        if (p->in_vertex && sscanf(b, "%" SCNu64, &p->count) != 1)
            return ted4_say(m, "%s:%zu: vertex count \"%s\"", p->path, p->line, b);
    } else if (p->in_vertex && sscanf(line, "property %63s %63s", a, b) == 2) {
        return read_property(p, a, b, m);
    }
    return 0;
}

static int read_header(ply *p, ted4_message *m)
{
    char line[512];
    int end = 0;

    if (!next_line(p, line, sizeof line) || strcmp(line, "ply") != 0)
        return ted4_say(m, "%s: not a PLY file", p->path);
    while (end == 0) {
        if (!next_line(p, line, sizeof line))
            return ted4_say(m, "%s:%zu: PLY header without end_header", p->path, p->line);
        end = read_header_line(p, line, m);
    }
    if (end < 0)
        return -1;
    if (p->index[X] < 0 || p->index[Y] < 0 || p->index[Z] < 0)
        return ted4_say(m, "%s: PLY without vertex properties x, y, z", p->path);
    /* In a text file, every value takes at least a digit and a separator. */
    const size_t least = p->binary ? p->stride : 2 * p->n_properties;
    if (p->count > (p->size - p->at + 1) / least)
        return ted4_say(m, "%s: %llu vertices announced, but only %zu bytes follow the header",
                        p->path, (unsigned long long)p->count, p->size - p->at);
    return 0;
}

static uint64_t little_endian(const uint8_t *b, size_t size)
{
    uint64_t v = 0;

    for (size_t i = 0; i < size; i++)
        v |= (uint64_t)b[i] << (8 * i);
    return v;
}

static double binary_value(const uint8_t *b, ply_type type)
{
    const uint64_t v = little_endian(b, types[type].size);
    const uint32_t v32 = (uint32_t)v;
    float f;
    double d;

    switch (type) {
    case I8: return (int8_t)v;
    case I16: return (int16_t)v;
    case I32: return (int32_t)v;
    case F32: memcpy(&f, &v32, sizeof f); return f;
    case F64: memcpy(&d, &v, sizeof d); return d;
    default: return (double)v;
    }
}

/* Reads the wanted properties of the next vertex; absent ones leave value unchanged. Returns -1 if
 * the file ends or something is not a number. */
static int read_vertex(ply *p, double value[N_WANTED])
{
    double all[MAX_PROPERTIES];

    if (p->binary) {
        if (p->size - p->at < p->stride)
            return -1;
        for (size_t i = 0; i < p->n_properties; i++)
            all[i] = binary_value(p->bytes + p->at + p->offset[i], p->type[i]);
        p->at += p->stride;
    } else {
        for (size_t i = 0; i < p->n_properties; i++) {
            const char *start = (const char *)p->bytes + p->at;
            char *end;
            all[i] = strtod(start, &end); /* the text ends with a zero byte */
            if (end == start)
                return -1;
            p->at += (size_t)(end - start);
        }
    }
    for (int i = 0; i < N_WANTED; i++)
        if (p->index[i] >= 0)
            value[i] = all[p->index[i]];
    return 0;
}

static uint8_t colour_byte(double v)
{
    return (uint8_t)(v > 0 ? (v < 255 ? v + 0.5 : 255) : 0);
}

/* Returns the factor that brings colours to 0..255. No file states their range. Float colours are
 * taken as 0..1 unless a value exceeds 1, and integers of more than 8 bits as 0..255 unless a value
 * exceeds 255: then as 0..65535. Reads all vertices in advance and restores the position. */
static double colour_scale(ply *p)
{
    const size_t start = p->at;
    double v[N_WANTED] = { 0 }, high = 0;

    if (p->index[RED] < 0 || p->type[p->index[RED]] <= U8)
        return 1;
    for (uint64_t i = 0; i < p->count && read_vertex(p, v) == 0; i++)
        high = fmax(high, fmax(v[RED], fmax(v[GREEN], v[BLUE])));
    p->at = start;
    if (p->type[p->index[RED]] < F32)
        return high > 255 ? 255.0 / 65535 : 1;
    return high <= 1 ? 255 : 1;
}

static int read_vertices(ply *p, ted4_point_cloud *c, ted4_message *m)
{
    const double scale = colour_scale(p);
    double v[N_WANTED] = { 0, 0, 0, TED4_POINT_GREY, TED4_POINT_GREY, TED4_POINT_GREY };

    for (size_t i = 0; i < c->n; i++) {
        if (read_vertex(p, v) != 0)
            return ted4_say(m, "%s: vertex %zu of %zu cannot be read", p->path, i, c->n);
        for (int k = 0; k < 3; k++) {
            c->xyz[3 * i + (size_t)k] = (float)v[k];
            c->rgb[3 * i + (size_t)k] = colour_byte(v[RED + k] * scale);
        }
        if (!isfinite(c->xyz[3 * i]) || !isfinite(c->xyz[3 * i + 1]) ||
            !isfinite(c->xyz[3 * i + 2]))
            return ted4_say(m, "%s: vertex %zu: a coordinate is not finite", p->path, i);
    }
    return 0;
}

int ted4_ply_read(ted4_point_cloud *c, const char *path, ted4_message *m)
{
    ply p;
    uint8_t *bytes;
    int result = -1;

    memset(&p, 0, sizeof p);
    p.path = path;
    for (int i = 0; i < N_WANTED; i++)
        p.index[i] = -1;
    if (ted4_read_whole(path, &bytes, &p.size, m) != 0)
        return -1;
    p.bytes = bytes;
    if (read_header(&p, m) == 0) {
        if (ted4_point_cloud_alloc(c, (size_t)p.count) != 0)
            ted4_say_no_memory(m);
        else
            result = read_vertices(&p, c, m);
    }
    free(bytes);
    if (result != 0)
        ted4_point_cloud_free(c);
    return result;
}
