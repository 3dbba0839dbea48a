/* judge_t.h - judges T5 of a decoder that claims class T: its records must be within the thresholds
 * of annex E.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_JUDGE_T_H
#define CONF_JUDGE_T_H

#include "judge.h"

/* Returns 1 if there is more to judge than conf_judge checks: for a decoder of class T and a valid
 * vector with queries. */
int conf_class_t_asked(const json_t *capabilities, const json_t *descriptor);
/* Judges T5 of an answer that conf_judge has passed, using the records that --dump has written to
 * folder. file: the vector. *v does not change if the records keep the thresholds. */
void conf_judge_class_t(const conf_bytes *file, const json_t *descriptor, const json_t *answer,
                        const char *folder, conf_verdict *v);

#endif
