/* judge.h - checks whether a decoder's output is an answer at all, and whether it is the right one.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_JUDGE_H
#define CONF_JUDGE_H

#include "process.h"
#include "suite.h"

/* declined: the decoder has announced that it does not support the vector; missing: the file does
 * not exist, or its hash differs. */
typedef enum {
    CONF_PASS,
    CONF_FAIL,
    CONF_NO_ANSWER,
    CONF_DECLINED,
    CONF_MISSING,
    CONF_NOT_RUN,
    CONF_OUTCOMES
} conf_outcome;
extern const char *const conf_outcome_name[CONF_OUTCOMES];

typedef struct {
    conf_outcome outcome;
    char reason[400];
} conf_verdict;

/* Returns the document that a run has printed, as a new reference, or NULL with *v filled if there
 * is no answer. */
json_t *conf_judge_document(const conf_process *p, conf_verdict *v);
/* Checks the object printed for --ted4-capabilities. Returns 1, or 0 with *v filled if it breaks
 * the contract. */
int conf_judge_capabilities(const json_t *capabilities, conf_verdict *v);
/* Returns the first of T0 to T4 that the decoder does not list, or NULL. A strict decoder must
 * support all of them (R-DMP-070). */
const char *conf_judge_lacks(const json_t *capabilities);
/* Returns 1 if the decoder accepts that knob. */
int conf_has_knob(const json_t *capabilities, const char *name);
/* Returns 1 if the decoder may skip this vector. */
int conf_judge_declines(const json_t *capabilities, const json_t *descriptor);
/* Returns 1 if the descriptor expects that result. */
int conf_expects(const json_t *descriptor, const char *result);
/* Returns 1 if the decoder claims lenient mode (spec 3.3). */
int conf_judge_lenient(const json_t *capabilities);
/* Returns 1 if got contains at least one hash, and all of its hashes and its number of bytes, if it
 * has one, equal those of want. */
int conf_same_hash(const json_t *want, const json_t *got);
/* Judges an answer by its descriptor. T5 is judged for class X only (judge_t.h judges class T). */
void conf_judge(const json_t *capabilities, const json_t *descriptor, const json_t *answer,
                conf_verdict *v);
/* Judges the answer of lenient mode to a vector whose descriptor has "salvage". conf_judge must
 * have passed the verdict of that answer already. */
void conf_judge_salvage(const json_t *capabilities, const json_t *descriptor, const json_t *answer,
                        conf_verdict *v);

#endif
