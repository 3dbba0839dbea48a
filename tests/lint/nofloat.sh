#!/bin/sh
# Tier E computes with integers only (spec 12.1): no floating-point literals, double or libm in
# norm/ and read/. The type float may occur where values are only passed on (blobs, header steps).
export LC_ALL=C
# Decimal ones with a point or an exponent, and all hexadecimal ones, which have the exponent p.
number='(^|[^0-9a-z_.])(([0-9]+\.[0-9]*|\.[0-9]+)(e[-+]?[0-9]+)?[fl]?|[0-9]+e[-+]?[0-9]+[fl]?|'
number="$number"'0x[0-9a-f]*\.?[0-9a-f]*p[-+]?[0-9]+[fl]?)([^0-9a-z_.]|$)'
bad=0
command -v gcc >/dev/null ||
    { echo "nofloat.sh: there is no gcc, which takes out comments"; exit 1; }
for f in ref-decoder/norm/*.[ch] ref-decoder/read/*.[ch]; do
    [ -f "$f" ] || continue
    gcc -fpreprocessed -dD -E -P "$f" 2>/dev/null | sed 's/"\([^"\\]\|\\.\)*"//g' |
        grep -niE 'math\.h|\bdouble\b|\b(exp2?f?|log2?f?|sqrtf?|powf?|rintf?|floorf?|ldexpf?) *\(|'"$number" |
        sed "s|^|$f: |" | grep . && bad=1
done
exit $bad
