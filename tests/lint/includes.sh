#!/bin/sh
# Who may include whom (a folder may always include itself). System headers are not looked at.
allow='
ref-decoder                 base
ref-decoder/base            base ted4.h
ref-decoder/norm            base norm ted4.h
ref-decoder/kernel          base norm kernel ted4.h
ref-decoder/recon           base norm recon kernel ted4.h
ref-decoder/read            base norm read kernel ted4.h
ref-decoder/render          base render ted4.h
ref-decoder/tool            base render tool ted4.h
ref-encoder/math            math
ref-encoder/kernel          base render kernel
ref-encoder/data            base math data
ref-encoder/eval            base eval
ref-encoder/write           base norm math write kernel ted4.h
ref-encoder/train           base norm recon render math data kernel train write ted4.h
ref-encoder/tool            base norm render math data eval kernel train write tool ted4.h
'
bad=0
for f in $(find ref-decoder ref-encoder -name '*.[ch]'); do
    folder=$(dirname "$f")
    may=$(echo "$allow" | awk -v d="$folder" '$1 == d { $1 = ""; print }')
    for i in $(sed -n 's/^#include "\(.*\)"/\1/p' "$f"); do
        case $i in
        */*) to=${i%%/*} ;;
        *) [ -f "$folder/$i" ] && continue; to=$i ;;
        esac
        case " $may " in
        *" $to "*) ;;
        *) echo "$f: may not include $i"; bad=1 ;;
        esac
    done
done
exit $bad
