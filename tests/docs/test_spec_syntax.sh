#!/bin/sh
# test_spec_syntax.sh - the syntax tables of 5.1, 5.2 and 9.1, parsed from the text, agree with what
# the decoder traces of small vectors with and without each mask, motion and activation, except
# those of a later minor version. (For the table of 6.1 see test_spec_resources.c.) An error in a
# table is detected.
# SPDX-License-Identifier: BSD-2-Clause
. tests/support/speak.sh
need spec_syntax ted4dec

# differs CHAPTERS FILE: whether the trace of that vector differs from the tables in that folder.
differs() {
    "$TED4_BUILD/ted4dec" "$2" --trace >"$out/trace" || { echo "$2: no trace"; return 0; }
    awk -v bytes="$(wc -c <"$2")" -f tests/spec/syntax.awk "$1"/05-*.md "$1"/09-*.md "$out/trace" \
        >"$out/said" && return 1
    sed "s|^|$2: |" "$out/said"
}

find conformance/vectors/worked conformance/vectors/valid -name '*.ted4' -size -5 \
    ! -name '*-minor-*' | LC_ALL=C sort >"$out/files"
sed 's/ted4$/json/' "$out/files" | xargs cat >"$out/descriptors"
check features "$out/descriptors" '"motion.none"' '"motion.bank"' '"motion.concat"' '"motion.inr"' \
    '"temporal-mask.on"' '"temporal-mask.off"' '"offset-mask.on"' \
    '"offset-mask.off"' '"activation.on"' '"activation.off"' '"slices.many"' '"tile.multi"'
while read -r file; do
    ! differs spec "$file" || { echo "$file" >>"$out/different"; break; }
done <"$out/files"
if [ ! -e "$out/different" ]; then ok tables; else fail tables "see above"; fi

# broken NAME CHAPTER SCRIPT: the text, changed by the script, no longer holds for a vector with all
# parts.
broken() {
    rm -rf "$out/spec"; mkdir "$out/spec"
    cp spec/05-*.md spec/09-*.md "$out/spec"
    sed -i "$3" "$out"/spec/"$2"-*.md
    if cmp -s "$out"/spec/"$2"-*.md spec/"$2"-*.md; then fail "$1" "the sentence is not there";
        return; fi
    if differs "$out/spec" conformance/vectors/worked/WRK-masks.ted4 >/dev/null; then ok "$1";
    else fail "$1" "not found out"; fi
}
broken magic      05 '/^| magic/s/1A`/1B`/'
broken major      05 '/^| major/s/| 1 |/| 2 |/'
broken header     05 '/^| minor/d'
broken flags      05 '/^| flags/s/u32/u16/'
broken chunk_hash 05 '/^| hash/s/u64/u32/'
broken condition  09 '/^| dynamic_prob/s/= 1/= 0/'
broken count      09 's/^| offset_prob\[6\]/| offset_prob[5]/'
broken width      09 '/^| size/s/u32/u16/'
exit $bad
