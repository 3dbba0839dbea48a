/* attest.c - prints the table of annex J.9. Takes two minutes of one core: two functions over all
 * 2^32 binary32 numbers. `make attest` compares it with the text.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "attest.h"

static float pow2_of(float x)
{
    return ted4_pow2(x);
}

static float sigmoid_of(float x)
{
    return ted4_sigmoid(x);
}

int main(void)
{
    attest_short(stdout);
    attest_real(pow2_of, "pow2", stdout);
    attest_real(sigmoid_of, "sigmoid", stdout);
    return fflush(stdout) == 0 ? 0 : 3;
}
