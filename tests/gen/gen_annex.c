/* gen_annex.c - prints an annex of the specification that is made by a program: gen_annex
 * a|b|c|h|b1|b2|b3. b1 to b3: the files of annex B. Run by `make spec-annexes`;
 * tests/docs/test_spec_annexes.c compares.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "annex_b_compact.h"
#include "annex_a.h"
#include "annex_c.h"
#include "annex_h.h"

static int print_file(ted4_scene *s)
{
    size_t size;
    uint8_t *data = annex_b_encode(s, &size);
    const int ok = fwrite(data, 1, size, stdout) == size;

    free(data);
    return ok ? 0 : 3;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*print)(FILE *out);
    } annex[] = { { "a", annex_a }, { "b", annex_b_all }, { "c", annex_c }, { "h", annex_h } };
    const char *which = argc == 2 ? argv[1] : "";

    if (strcmp(which, "b1") == 0)
        return print_file(annex_b_smallest());
    if (strcmp(which, "b2") == 0)
        return print_file(annex_b_dynamic());
    if (strcmp(which, "b3") == 0)
        return print_file(annex_b_compact());
    for (size_t i = 0; i < sizeof annex / sizeof *annex; i++)
        if (strcmp(which, annex[i].name) == 0) {
            annex[i].print(stdout);
            return fflush(stdout) == 0 ? 0 : 3;
        }
    fprintf(stderr, "usage: gen_annex a|b|c|h|b1|b2|b3\n");
    return 3;
}
