/* mutant_build.h - builds `ted4conf` with a changed decoder, and runs the suite with it. The
 * changed file is compiled from a folder of its own that comes first in the include path. If it is
 * a header, all sources of the decoder that include it are compiled too; if it is annex L, the code
 * that the annex prints takes the place of zlib. The result is linked with the rest of a build.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_MUTANT_BUILD_H
#define CONF_MUTANT_BUILD_H

#include "mutant_list.h"
#include "mutants.h"
#include "process.h"

/* Makes a new folder for a build; folder has room for CONF_PATH. */
void conf_mutant_folder(char *folder);
void conf_mutant_folder_remove(const char *folder);
/* Stores the contents of a file, changed or not, in folder. */
void conf_mutant_put(const char *folder, const char *file, const conf_bytes *b);
/* Compiles the sources that depend on the files of those of n mutants that are judged at place, and
 * links the program. These files must have been put into folder. Returns 1 on success. */
int conf_mutant_build(const conf_mutant_options *o, const conf_place *place, const conf_mutant *m,
                      size_t n, const char *folder);
/* Prints what compiler and linker said, to help find the cause of a failure. */
void conf_mutant_show_log(const char *folder);
/* Runs the suite with the program in folder, at place, to the first failure. The caller frees p. */
void conf_mutant_replay(const conf_mutant_options *o, const conf_place *place, const char *folder,
                        conf_process *p);

#endif
