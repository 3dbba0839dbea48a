/* contract.h - the driver contract of the conformance suite (conformance/README.md): what a test
 * runner asks of a decoder.
 *     ted4dec --ted4-capabilities
 *     ted4dec --ted4-run FILE --tiers T0,T5 [--queries FILE] [--knob name=value] [--mode
 *     strict|lenient] [--dump DIR]
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CONTRACT_H
#define TED4_CONTRACT_H

/* Is this such a command line? */
int ted4_contract_asked(int argc, char **argv);
/* Answers it: one JSON object on stdout. Exit code: 0 for every verdict; 3 for wrong usage or
 * failing output. */
int ted4_contract(int argc, char **argv);

#endif
