#!/bin/sh
# test_makefile.sh - what the Makefile takes from the environment and what from the command line:
# build folder, optimisation and machine only from the latter, and the number of jobs from the
# machine. Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
# value VARIABLE WORD...: prints its value in a make of its own, with these words before and after
# env.
value() {
    variable=$1; shift
    printf 'include Makefile\nshow:\n\t@echo "$(%s)"\n' "$variable" |
        env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS -u ARCH -u OPT -u B "$@" -f - show 2>&1 | tail -n 1
}
# gives NAME WANTED VARIABLE WORD...
gives() {
    name=$1 wanted=$2; shift 2
    value "$@" >"$out/value"
    if [ "$(cat "$out/value")" = "$wanted" ]; then ok "$name"
    else fail "$name" "$(cat "$out/value"), not $wanted"; fi
}
gives arch_environment '' ARCH ARCH=x86_64 make
gives arch_asked -march=native ARCH make ARCH=-march=native
gives opt_environment -O3 OPT OPT=-O0 make
gives opt_asked -O1 OPT make OPT=-O1
gives folder_environment build B B=elsewhere make
gives folder_asked build-x B make B=build-x
gives folder_of_a_make_within build-x B MAKEFLAGS='-- B=build-x' make

cores=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc)
gives jobs "-j$cores" JOBS OMP_NUM_THREADS=64 OMP_THREAD_LIMIT=65 make
gives jobs_asked '' JOBS make -j1

# A name with an apostrophe reaches make-deb.sh unchanged.
name="Pat O'Brien <pat@example.org>"
mkdir "$out/bin"
printf '#!/bin/sh\nprintf "%%s\\n" "$MAINTAINER"\n' >"$out/bin/sh"
chmod +x "$out/bin/sh"
env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS -u MAINTAINER PATH="$out/bin:$PATH" \
    make -s deb "MAINTAINER=$name" >"$out/value" 2>&1
if [ "$(cat "$out/value")" = "$name" ]; then ok maintainer
else fail maintainer "$(cat "$out/value")"; fi
exit $bad
