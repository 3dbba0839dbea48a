#!/bin/sh
# The decoder library takes memory only through the caller's allocator (SECURITY.md): base/arena.c
# alone calls malloc, and zlib is given the arena. The library prints nothing, ends no process,
# starts no thread, and keeps no state between calls: no variable of a file or function can change
# (state.py). Its folders are those of DEC_SRC in the Makefile; render/, which draws for programs,
# is a library of its own.
export LC_ALL=C
bad=0
folders=$(sed -n '/^DEC_SRC/,/)))/s/.*addprefix ref-decoder\/,\([^)]*\)).*/\1/p' Makefile |
    tr ' ,' '\n\n' | sed 's/\/\*\.c$//')
[ -n "$folders" ] || { echo "Makefile: no folders in DEC_SRC"; bad=1; }
for f in $(for d in $folders; do ls ref-decoder/$d/*.[ch]; done); do
    text=$(gcc -fpreprocessed -dD -E -P "$f" 2>/dev/null | sed 's/"\([^"\\]\|\\.\)*"//g')
    case $f in
    ref-decoder/base/arena.c) ;;
    *) printf '%s\n' "$text" | grep \
        -E '\b(malloc|calloc|reallocarray|realloc|aligned_alloc|posix_memalign|memalign|mmap|strn?dup|alloca|compress2?|uncompress2?|XXH[0-9]+_createState)\b|\bfree *\(' |
        sed "s|^|$f: memory of its own: |" | grep . && bad=1 ;;
    esac
    printf '%s\n' "$text" | grep \
        -E '(^|[^.>[:alnum:]_])(v?[fd]?printf|f?puts|f?putc|putchar|fwrite|write|perror|fopen|open|exit|_exit|_Exit|quick_exit|abort|assert|raise|signal|longjmp|pthread_create|thrd_create) *\(' |
        sed "s|^|$f: prints, ends or starts a thread: |" | grep . && bad=1
done
# shellcheck disable=SC2046 # file names without spaces
python3 tests/lint/state.py $(for d in $folders; do ls ref-decoder/$d/*.[ch]; done) || bad=1
# Without an allocator, zlib uses malloc.
for f in $(grep -lE '\b(in|de)flateInit2?\(' ref-decoder/read/*.c); do
    grep -q 'zalloc = ted4_zlib_alloc' "$f" || { echo "$f: zlib has malloc"; bad=1; }
done
exit $bad
