#!/bin/sh
# The decoder library takes memory through the caller's allocator only (SECURITY.md): base/arena.c
# alone calls malloc, and zlib is given the arena. It prints nothing, ends no process, and keeps
# nothing between calls: no variable of a file or function that can change. Its folders are those of
# DEC_SRC in the Makefile; render/ draws for programs and is a library of its own.
bad=0
folders=$(sed -n '/^DEC_SRC/,/)))/s/.*addprefix ref-decoder\/,\([^)]*\)).*/\1/p' Makefile |
    tr ' ,' '\n\n' | sed 's/\/\*\.c$//')
[ -n "$folders" ] || { echo "Makefile: no folders in DEC_SRC"; bad=1; }
for f in $(for d in $folders; do ls ref-decoder/$d/*.[ch]; done); do
    text=$(gcc -fpreprocessed -dD -E -P "$f" 2>/dev/null | sed 's/"[^"]*"//g')
    case $f in
    ref-decoder/base/arena.c) ;;
    *) printf '%s\n' "$text" | grep \
        -E '\b(malloc|calloc|realloc|free|aligned_alloc|strn?dup|alloca|compress2?|uncompress2?|XXH[0-9]+_createState) *\(' |
        sed "s|^|$f: memory of its own: |" | grep . && bad=1 ;;
    esac
    printf '%s\n' "$text" | grep \
        -E '\b(v?f?printf|puts|fputs|putchar|perror|exit|_exit|abort|assert|signal|longjmp) *\(' |
        sed "s|^|$f: prints or ends: |" | grep . && bad=1
    printf '%s\n' "$text" | grep -oE "\bstatic [^(;={]*[;={]" | grep -v "\bconst\b" |
        sed "s|^|$f: keeps: |" | grep . && bad=1
done
# zlib without an allocator takes malloc.
for f in $(grep -lE '\b(in|de)flateInit2?\(' ref-decoder/read/*.c); do
    grep -q 'zalloc = ted4_zlib_alloc' "$f" || { echo "$f: zlib has malloc"; bad=1; }
done
exit $bad
