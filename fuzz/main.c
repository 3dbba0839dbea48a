/* main.c - replays inputs through one harness, without libFuzzer: replay NAME PATH..., where PATH
 * is a file or a folder of files. It is also useful for examining a find in a debugger. The exit
 * status is 3 if a path cannot be read.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "harness.h"
#include "inputs.h"

int main(int argc, char **argv)
{
    fuzz_entry *run = argc > 2 ? fuzz_find(argv[1]) : NULL;
    size_t n = 0;

    if (run == NULL) {
        fprintf(stderr,
                "replay: usage: replay NAME PATH..., the name of a harness of fuzz/list.def\n");
        return 3;
    }
    for (int i = 2; i < argc; i++)
        if (fuzz_replay(run, argv[i], &n) != 0) {
            perror(argv[i]);
            return 3;
        }
    printf("%s: %zu inputs\n", argv[1], n);
    return 0;
}
