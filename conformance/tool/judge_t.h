/* judge_t.h - T5 of a decoder that claims class T: are its records within the thresholds of annex
 * E?
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_JUDGE_T_H
#define CONF_JUDGE_T_H

#include "judge.h"

/* 1: there is something to judge beyond what conf_judge looks at: a valid vector with queries,
 * asked of a decoder of class T. */
int conf_class_t_asked(const json_t *capabilities, const json_t *descriptor);
/* The T5 of an answer that conf_judge has passed, with the records that --dump has left in folder.
 * file: the vector. Leaves *v as it is when they keep the thresholds. */
void conf_judge_class_t(const conf_bytes *file, const json_t *descriptor, const json_t *answer,
                        const char *folder, conf_verdict *v);

#endif
