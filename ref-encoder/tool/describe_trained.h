/* describe_trained.h - adds to a coded file what the command line asks it to say about the scene:
 * ted4enc --title, --author, --licence, --cameras, --thumbnail.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DESCRIBE_TRAINED_H
#define TED4_DESCRIBE_TRAINED_H

#include "data/dataset.h"
#include "request.h"

/* Says before training what ted4_describe_trained would refuse after it, whatever the file. Returns
 * 0, or -1 with why filled. */
int ted4_describe_possible(const ted4_request *r, const ted4_dataset *d, char *why,
                           size_t why_size);

/* Replaces *bytes (malloc) by the file with these chunks, or leaves it as it is if r asks for
 * nothing. Returns 0, or -1 with why filled and *bytes unchanged. */
int ted4_describe_trained(const ted4_request *r, const ted4_dataset *d, const ted4_parallel *p,
                          uint8_t **bytes, size_t *size, char *why, size_t why_size);

#endif
