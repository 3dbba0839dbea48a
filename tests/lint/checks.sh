#!/bin/sh
# Checks in tests do what they seem to do. A running maximum is one of larger() (support/larger.h),
# since fmax() skips NaN; exempt are the deviations of annex E, which are written as it says. No
# assertion stands in a comment or behind "#if 0".
export LC_ALL=C
exempt=tests/support/spec_tolerance.h
bad=0
for f in $(find tests -name '*.[ch]' | sort); do
    case $f in "$exempt") ;; *)
        sed -nE '/ = fmaxf?\($/{N; s/\n *//}; s/^ *(.*[^ ]) = fmaxf?\(\1, .*/\1/p' "$f" |
            sed "s|^|$f: a maximum that skips NaN: |" | grep . && bad=1 ;;
    esac
    grep -nE '^ *(//|/\*|\*).*\b(assert_[a-z_]+|fail_msg|fail) ?\(.*;|^ *# *if +0\b' "$f" |
        sed "s|^|$f: left out: |" | grep . && bad=1
done
exit $bad
