/* msan_zlib.c - linked into MSan builds only (-Wl,--wrap): zlib is not compiled for MSan, so the
 * bytes that it has written are marked as initialised. Nothing else changes: every call goes to
 * zlib with its own arguments, and zlib's result is returned.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <sanitizer/msan_interface.h>
#include <zlib.h>

int __real_inflate(z_stream *z, int flush);
int __real_compress2(Bytef *to, uLongf *n_to, const Bytef *from, uLong n_from, int level);
int __real_uncompress2(Bytef *to, uLongf *n_to, const Bytef *from, uLong *n_from);
int __wrap_inflate(z_stream *z, int flush);
int __wrap_compress2(Bytef *to, uLongf *n_to, const Bytef *from, uLong n_from, int level);
int __wrap_uncompress2(Bytef *to, uLongf *n_to, const Bytef *from, uLong *n_from);

int __wrap_inflate(z_stream *z, int flush)
{
    Bytef *const begin = z->next_out;
    const int result = __real_inflate(z, flush);

    __msan_unpoison(z, sizeof *z);
    __msan_unpoison(begin, (size_t)(z->next_out - begin));
    return result;
}

int __wrap_compress2(Bytef *to, uLongf *n_to, const Bytef *from, uLong n_from, int level)
{
    const int result = __real_compress2(to, n_to, from, n_from, level);

    __msan_unpoison(n_to, sizeof *n_to);
    __msan_unpoison(to, *n_to);
    return result;
}

int __wrap_uncompress2(Bytef *to, uLongf *n_to, const Bytef *from, uLong *n_from)
{
    const int result = __real_uncompress2(to, n_to, from, n_from);

    __msan_unpoison(n_to, sizeof *n_to);
    __msan_unpoison(n_from, sizeof *n_from);
    __msan_unpoison(to, *n_to);
    return result;
}
