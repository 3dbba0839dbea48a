/* attest.c - prints the table of annex J.9. Takes two minutes of one core: two functions over all
 * 2^32 binary32 numbers. `make attest` compares it with the text.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "attest.h"

int main(void)
{
    attest_short(stdout);
    attest_samples(stdout);
    attest_real(ted4_pow2, 1, "pow2", stdout);
    attest_real(ted4_sigmoid, 1, "sigmoid", stdout);
    return fflush(stdout) == 0 ? 0 : 3;
}
