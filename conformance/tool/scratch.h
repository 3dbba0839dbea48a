/* scratch.h - a folder for the files of a run, which does not outlive the program.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_SCRATCH_H
#define CONF_SCRATCH_H

#include "text.h"

/* Makes a folder in $TMPDIR or /tmp. It is removed with all that is in it by conf_scratch_remove,
 * or soon after this process has ended, whatever ends it. One folder at a time. */
void conf_scratch_make(char folder[CONF_PATH]);
/* Removes the folder, and waits until that is done. */
void conf_scratch_remove(void);

#endif
