#!/bin/sh
# Tier E computes with integers only (spec 12.1): no floating-point literals, double or libm in
# norm/ and read/. The type float may occur where values are only passed on (blobs, header steps).
export LC_ALL=C
bad=0
for f in ref-decoder/norm/*.[ch] ref-decoder/read/*.[ch]; do
    [ -f "$f" ] || continue
    gcc -fpreprocessed -dD -E -P "$f" 2>/dev/null | sed 's/"[^"]*"//g' |
        grep -nE 'math\.h|\bdouble\b|\b(exp2?f?|log2?f?|sqrtf?|powf?|rintf?|floorf?|ldexpf?) *\(|[^0-9a-zA-Z_.][0-9]+\.[0-9]*f?\b' |
        sed "s|^|$f: |" | grep . && bad=1
done
exit $bad
