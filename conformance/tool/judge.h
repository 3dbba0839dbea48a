/* judge.h - is an answer the right one? And is it an answer at all?
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_JUDGE_H
#define CONF_JUDGE_H

#include "process.h"
#include "suite.h"

/* declined: the decoder has said beforehand that it does not do this; missing: no file, or another
 * one. */
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

/* The document that a run has printed, a new reference; NULL: no answer, and *v says why. */
json_t *conf_judge_document(const conf_process *p, conf_verdict *v);
/* The object that --ted4-capabilities gives: 1, or 0: it is not what the contract asks for, and *v
 * says why. */
int conf_judge_capabilities(const json_t *capabilities, conf_verdict *v);
/* The first of T0 to T4 that a decoder does not say it can give, which a strict one has to
 * (R-DMP-070); NULL: none. */
const char *conf_judge_lacks(const json_t *capabilities);
/* May the decoder leave this vector out? */
int conf_judge_declines(const json_t *capabilities, const json_t *descriptor);
/* Is that the result that a descriptor expects? */
int conf_expects(const json_t *descriptor, const char *result);
/* Does the decoder claim lenient mode (spec 3.3)? */
int conf_judge_lenient(const json_t *capabilities);
/* The hashes that got gives, at least one of them: 1: those of want. */
int conf_same_hash(const json_t *want, const json_t *got);
/* Answer against descriptor; T5 of class X only (judge_t.h: class T). */
void conf_judge(const json_t *capabilities, const json_t *descriptor, const json_t *answer,
                conf_verdict *v);
/* The answer in lenient mode to a vector whose descriptor says what can be salvaged, beyond its
 * verdict, which conf_judge has passed. */
void conf_judge_salvage(const json_t *capabilities, const json_t *descriptor, const json_t *answer,
                        conf_verdict *v);

#endif
