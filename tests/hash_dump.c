/* hash_dump.c - what a decoder made of a stream, as lines that must be the same on every machine and with every compiler:
 *     hash_dump FILE.ted4...   class-x; then for each file its size, ends, t4, and one line for each of three queries
 * Built by bench/determinism.sh from ref-decoder/{base,norm,read,recon,kernel} and this file alone.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#define XXH_STATIC_LINKING_ONLY
#include <xxhash.h>
#include "base/bytes.h"
#include "norm/syntax.h"
#include "norm/tables.h"

static void print_hash(const char *name, const uint8_t hash[16])
{
    printf("%s ", name);
    for (int i = 0; i < 16; i++)
        printf("%02x", hash[i]);
    printf("\n");
}

/* The whole file; NULL: it cannot be read. */
static uint8_t *read_file(const char *path, size_t *size)
{
    FILE *f = fopen(path, "rb");
    uint8_t *data = NULL;
    long n;

    if (f == NULL)
        return NULL;
    if (fseek(f, 0, SEEK_END) == 0 && (n = ftell(f)) > 0 && fseek(f, 0, SEEK_SET) == 0) {
        *size = (size_t)n;
        data = malloc(*size);
        if (data != NULL && fread(data, 1, *size, f) != *size) {
            free(data);
            data = NULL;
        }
    }
    fclose(f);
    return data;
}

/* spec 10.4: all k q as little-endian patterns, type by type, component by component. */
static void print_attributes(const ted4_scene *s)
{
    const size_t n = s->head.n_anchors;
    XXH128_canonical_t canonical;
    XXH3_state_t state;

    XXH3_INITSTATE(&state);
    (void)XXH3_128bits_reset(&state);
    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t i = 0; i < n * s->shape.dim[t]; i++) {
            const float q = s->head.step[t] * ted4_bits_float(ted4_step[s->step_index[t][i % n]]);
            uint8_t bytes[4];

            ted4_store32(bytes, ted4_float_bits((float)s->symbol[t][i] * q));
            (void)XXH3_128bits_update(&state, bytes, sizeof bytes);
        }
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&state));
    print_hash("t4", canonical.digest);
}

static void print_queries(const ted4_scene *s)
{
    static const ted4_query queries[] = {
        { 0, 1, { 0.5f, -1.0f, 2.0f } },
        { 1, 3, { 0.5f, -1.0f, 2.0f } },
        { 1, 1, { -3.0f, 0.25f, 0.125f } },
    };
    ted4_recon *r;

    if (ted4_recon_new(&r, s, NULL) != TED4_OK) {
        printf("query limit.memory\n");
        return;
    }
    for (size_t i = 0; i < sizeof queries / sizeof queries[0]; i++) {
        ted4_gaussians g;
        uint8_t hash[16];
        const ted4_status status = ted4_recon_query(r, &queries[i], NULL, &g);

        if (status != TED4_OK) {
            printf("query %s\n", ted4_status_id(status));
            continue;
        }
        ted4_gaussians_hash(&g, hash);
        print_hash("query", hash);
    }
    ted4_recon_free(r);
}

/* 0, or 1: refused, or 3: not read. */
static int dump(const char *path)
{
    size_t size = 0;
    uint8_t *data = read_file(path, &size);
    ted4_scene *scene;
    ted4_error error = { TED4_OK, 0 };
    ted4_info info;

    if (data == NULL) {
        fprintf(stderr, "hash_dump: %s: cannot be read\n", path);
        return 3;
    }
    if (ted4_decode(data, size, NULL, &scene, &error) != TED4_OK) {
        fprintf(stderr, "hash_dump: %s: byte %zu: %s\n", path, error.offset,
                ted4_status_text(error.code));
        free(data);
        return 1;
    }
    ted4_scene_info(scene, &info);
    printf("file %zu bytes\n", size);
    print_hash("ends", info.hash);
    print_attributes(scene);
    print_queries(scene);
    ted4_scene_free(scene);
    free(data);
    return 0;
}

int main(int argc, char **argv)
{
    int worst = 0;

    printf("class-x %s\n", ted4_recon_class_x() ? "yes" : "no");
    for (int i = 1; i < argc; i++) {
        const int code = dump(argv[i]);

        worst = code > worst ? code : worst;
    }
    return worst;
}
