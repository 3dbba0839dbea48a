/* assert.h - for xxHash, which includes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#undef assert
#define assert(condition) ((void)0)
#undef static_assert
#define static_assert _Static_assert
