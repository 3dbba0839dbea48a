#!/bin/sh
# Tier E decides with integers only (spec 12.1): no floating-point arithmetic, libm or literals in norm/ and read/. The type itself may be named where values
# are only carried (blobs, header steps).
bad=0
for f in ref-decoder/norm/*.[ch] ref-decoder/read/*.[ch]; do
    sed 's|/\*.*\*/||' "$f" | grep -nE '#include <math.h>|\b(double|expf?|logf?|log2f?|sqrtf?|powf?|rintf?|floorf?)\b *\(|[^0-9a-zA-Z_.][0-9]+\.[0-9]+f?\b' |
        grep -vE '^[0-9]+: \*|^[0-9]+:[^"]*"[^"]*"' | sed "s|^|$f:|" | grep . && bad=1
done
exit $bad
