/* gen_tables.c - prints ref-decoder/norm/tables.c. The text of annex A: annex_a.h.
 *     cc tests/gen/gen_tables.c -lm -o /tmp/gen_tables;  /tmp/gen_tables >
 *         ref-decoder/norm/tables.c
 * SPDX-License-Identifier: BSD-2-Clause */
#include <inttypes.h>
#include <stdio.h>
#include "table_math.h"

static void print_entries(const struct table *t, const char *indent, int hex, const char *last)
{
    for (int i = 0; i < t->n; i++) {
        printf(i % 8 == 0 ? "%s" : " ", indent);
        printf(hex ? "0x%08" PRIx64 : "%" PRId64, t->entry(i));
        printf("%s", i + 1 < t->n ? "," : last);
        if (i % 8 == 7 || i + 1 == t->n)
            printf("\n");
    }
}

static void print_c(void)
{
    printf("/* tables.c - annex A. Made by tests/gen/gen_tables.c, checked by "
           "test_tables.c; do not edit.\n"
           " * SPDX-License-Identifier: BSD-2-Clause */\n"
           "#include \"norm/tables.h\"\n");
    for (int i = 0; i < N_TABLES; i++) {
        const struct table *t = &table_list[i];

        printf("\n/* ");
        if (i < N_ANNEX)
            printf("spec A.%d ", i + 1);
        printf("%s: %s */\nconst %s %s[%s] = {\n", t->name, t->text, t->type, t->c_name, t->size);
        print_entries(t, "    ", t->entry == table_step, ",");
        printf("};\n");
    }
}

int main(void)
{
    print_c();
    return 0;
}
