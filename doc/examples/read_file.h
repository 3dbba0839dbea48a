/* read_file.h - for the examples: reads the whole file that the command line names.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef READ_FILE_H
#define READ_FILE_H

#include <stdio.h>
#include <stdlib.h>
#include <ted4/ted4.h>

/* Returns the bytes, owned by the caller. Ends the program if there is no such file. */
static unsigned char *read_file(int argc, char **argv, size_t *size)
{
    FILE *const f = argc == 2 ? fopen(argv[1], "rb") : NULL;
    unsigned char *data = NULL;
    size_t room = 0;

    *size = 0;
    while (f != NULL && !feof(f) && !ferror(f)) {
        room = 2 * room + 65536;
        data = realloc(data, room);
        if (data == NULL)
            break;
        *size += fread(data + *size, 1, room - *size, f);
    }
    if (data == NULL || ferror(f)) {
        if (argc == 2)
            perror(argv[1]);
        else
            fprintf(stderr, "usage: %s FILE.ted4\n", argv[0]);
        exit(3);
    }
    fclose(f);
    return data;
}

#endif
