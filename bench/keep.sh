#!/bin/sh
# keep.sh FILE.md COMMAND...: shows what the command prints and puts it, with the machine and the
# command's name in make, between the first two fences of FILE.md, in the place of what was there.
# MAKE_TARGET: that name. CC: the compiler.
set -e
file=$1
shift
out=$(mktemp)
trap 'rm -f "$out"' EXIT
{
    echo "\$ make $MAKE_TARGET"
    processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
    echo "$processor, $(nproc) cores; $("${CC:-cc}" --version | head -n 1)"
} >"$out"
if ! "$@" >>"$out"; then
    cat "$out"
    exit 1
fi
cat "$out"
awk -v out="$out" '
    /^```/ && fence < 2 {
        if (++fence == 1) {
            print
            while ((getline line < out) > 0)
                print line
        }
    }
    fence != 1' "$file" >"$file.new"
mv "$file.new" "$file"
