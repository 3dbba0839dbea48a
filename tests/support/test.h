/* test.h - cmocka, after the headers that it needs. Every test in C includes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TEST_H
#define TED4_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* cmocka 2 takes this name for deprecated, and 1 knows no other. */
#ifdef assert_uint_in_range
#undef assert_in_range
#define assert_in_range(value, low, high) assert_uint_in_range(value, low, high)
#endif

#endif
