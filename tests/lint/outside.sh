#!/bin/sh
# Functions that reach beyond the process (its environment, other programs, code that is loaded, the
# network) occur only in the files named here, each with the functions that it may use. Tests are
# exempt.
export LC_ALL=C
allow="
ref-decoder/base/level.c       getenv
ref-decoder/tool/cli.c         getenv
ref-decoder/tool/video_out.c   fork execlp
ref-encoder/data/video.c       getenv fork execlp
tools/scene/ray_set.c          fork execlp
conformance/tool/process.c     fork execv setenv
conformance/tool/scratch.c     getenv fork execl
conformance/tool/mutant_build.c getenv system
conformance/tool/mutants.c     fork
fuzz/scene_folder.c            getenv
bench/bench_decode.c           setenv
bench/bench_render.c           setenv
bench/bench_train.c            setenv
player/wasm/include/stdlib.h   getenv
"
words="getenv|secure_getenv|environ|setenv|unsetenv|putenv|clearenv|system|popen|wordexp"
words="$words|execl|execle|execlp|execv|execve|execvp|execvpe|execveat|fexecve|fork|vfork|clone"
words="$words|posix_spawnp?|dlopen|dlsym|syscall|socket"
folders="ref-decoder ref-encoder conformance fuzz bench tools player doc"
found=$(grep -rlwE "$words" $folders --include='*.[ch]' | while read -r f; do
    # Comments and strings do not count, nor do members of a structure.
    gcc -fpreprocessed -dD -E -P "$f" 2>/dev/null | sed 's/"\([^"\\]\|\\.\)*"//g' |
        grep -oE "(\.|->)? *\b($words)\b" | grep -v '^[.-]' | tr -d ' ' | sort -u | sed "s|^|$f |"
done)
allowed=$(echo "$allow" | awk '{ for (i = 2; i <= NF; i++) print $1, $i }')
bad=0
for one in $(echo "$found" | tr ' ' ':'); do
    echo "$allowed" | grep -qxF "$(echo "$one" | tr ':' ' ')" ||
        { echo "${one%:*}: may not use ${one#*:}"; bad=1; }
done
for one in $(echo "$allowed" | tr ' ' ':'); do
    echo "$found" | grep -qxF "$(echo "$one" | tr ':' ' ')" ||
        { echo "tests/lint/outside.sh: ${one%:*} does not use ${one#*:}"; bad=1; }
done
exit $bad
