/* contract.h - the driver contract of the conformance suite (conformance/README.md): how a test
 * runner calls a decoder.
 *     ted4dec --ted4-capabilities
 *     ted4dec --ted4-run FILE --tiers T0,T5 [--queries FILE] [--knob name=value] [--mode
 *     strict|lenient] [--dump DIR]
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CONTRACT_H
#define TED4_CONTRACT_H

#include <jansson.h>

#include "ted4.h"

/* What a query is. */
#define TED4_CONTRACT_QUERY "expected {\"t\":[num,den],\"cam\":[x,y,z]}"
/* Reads a query of a list. Returns 0, or -1 if it is none. */
int ted4_contract_query(const json_t *from, ted4_query *q);

/* Returns 1 if this is a command line of the contract, else 0. */
int ted4_contract_asked(int argc, char **argv);
/* Runs such a command line and prints one JSON object on stdout. Returns the exit code: 0 for every
 * verdict; 3 for wrong usage, or if a file cannot be written or memory runs out. */
int ted4_contract(int argc, char **argv);

#endif
