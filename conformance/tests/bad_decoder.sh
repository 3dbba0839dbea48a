#!/bin/sh
# Decoders that do not conform, each in its own way: ted4conf run has to detect all of them.
#     bad_decoder.sh WAY ARGUMENTS OF THE CONTRACT...       TED4DEC: a decoder that does conform
way=$1
shift
good() { "$TED4DEC" "$@"; }
# declining FEATURES ARGUMENT...: conforms, but declines the features in a JSON list
declining() { features=$1; shift; good "$@" | sed "s/\"declines\":\[\]/\"declines\":[$features]/"; }
valid='{"result":"valid","tiers":{}}' limit='{"result":"limit","error":"limit.memory"}'
case $way in
class-t-*) exec python3 "$(dirname "$0")/class_t.py" "${way#class-t-}" "$@" ;;
esac
if [ "$1" = --ted4-capabilities ]; then
    case $way in
    no-capabilities) exit 0 ;;
    old-protocol) good "$@" | sed 's/"protocol":1/"protocol":0/' ;;
    declines-all) declining '"motion.none","motion.bank","motion.concat","motion.inr"' "$@" ;;
    declines-moving) declining '"motion.bank","motion.concat","motion.inr"' "$@" ;;
    not-lenient) good "$@" | sed 's/"lenient":true/"lenient":false/' ;;
    fewer-tiers) good "$@" |
        sed 's/"tiers":\[[^]]*\],"class":"X"/"tiers":["T0","T3"],"class":null/' ;;
    class-alone) good "$@" | sed 's/,"T5"//' ;;
    class-unknown) good "$@" | sed 's/"class":"X"/"class":"x"/' ;;
    compact-alone) good "$@" | sed 's/"Main",//' ;;
    compact-unclaimed|compact-refused) good "$@" | sed 's/,"Compact"//' ;;
    profile-unknown) good "$@" | sed 's/"Main",/"Main","main",/' ;;
    tier-unknown) good "$@" | sed 's/"T0",/"T0","T9",/' ;;
    knob-number) good "$@" | sed 's/"knobs":\[/"knobs":[1,/' ;;
    declines-number) declining 1 "$@" ;;
    lenient-text) good "$@" | sed 's/"lenient":true/"lenient":"yes"/' ;;
    level-*) good "$@" | sed "s/\"max_level\":31/\"max_level\":${way#level-}/" ;;
    without-*) good "$@" | sed "s/\"${way#without-}\":/\"no\":/" ;;
    limit-above-1) good "$@" | sed 's/"max_level":31/"max_level":1/' ;;
    no-knobs|knobs-refused) good "$@" |
        sed 's/"knobs":\["max_alloc_total","max_work"\]/"knobs":[]/' ;;
    *) good "$@" ;;
    esac
    exit
fi
case $way in
good|declines-*|no-knobs|not-lenient|fewer-tiers|class-*|without-*) good "$@" ;;
compact-unclaimed) good "$@" ;;
compact-refused)
    if [ "$(od -An -tu1 -j10 -N1 "$2")" -eq 1 ]; then
        echo '{"result":"unsupported","error":"unsupported.profile","offset":10}'
    else
        good "$@"
    fi ;;
knobs-refused) case "$*" in *--knob*) exit 2 ;; *) good "$@" ;; esac ;;
crash) kill -SEGV $$ ;;
hang) sleep 600 ;;
hang-behind) sleep 600 & good "$@"; wait ;;
silent) exit 0 ;;
exit-code) good "$@"; exit 1 ;;
chatter) echo 'reading...'; good "$@" ;;
chatter-behind) good "$@"; echo done ;;
two-answers) good "$@"; good "$@" ;;
no-json) echo valid ;;
no-utf8) printf '{"result":"valid","x":"\377"}\n' ;;
flood) head -c 9000000 /dev/zero | tr '\0' ' '; good "$@" ;;
says-valid) echo '{"result":"valid"}' ;;
says-invalid) echo '{"result":"invalid","error":"con.magic","offset":0}' ;;
limit-above-1)
    if [ "$(od -An -tu1 -j11 -N1 "$2")" -gt 1 ]; then echo "$limit"; else good "$@"; fi ;;
says-no-limit) echo '{"result":"limit","error":"banana"}' ;;
says-limit) echo "$limit" ;;
wrong-hash) good "$@" |
    sed 's/\("T3":{"bytes":[0-9]*,"xxh3":"\)./\1x/; s/\("T3":{[^}]*"sha256":"\)./\1x/' ;;
half-wrong) good "$@" | sed 's/\("T2":{[^}]*"sha256":"\)./\1x/' ;;
no-hashes) good "$@" | sed 's/"xxh3":"[0-9a-f]*"/"none":0/g; s/"sha256":"[0-9a-f]*"/"no":0/g' ;;
no-tier) good "$@" | sed 's/"T4":{[^}]*},//' ;;
wrong-records) good "$@" | sed 's/\("T5":\[{"bytes":[0-9]*,"xxh3":"\)./\1x/' ;;
no-records) good "$@" | sed 's/"T5":\[.*\]/"T5":[]/' ;;
records-and-error) good "$@" | sed '/"T5"/s/"xxh3"/"error":"rec.non-finite","xxh3"/6g' ;;
wrong-bytes) good "$@" | sed 's/"bytes":/"bytes":1/g' ;;
text-bytes) good "$@" | sed 's/"bytes":\([0-9]*\)/"bytes":"\1"/g' ;;
no-result) good "$@" | sed 's/"result":"[a-z]*"/"result":1/' ;;
no-offset) good "$@" | sed 's/"offset":\([0-9]*\)/"offset":"\1"/' ;;
tiers-of-invalid) good "$@" | sed '/"result":"invalid"/s/}$/,"tiers":{}}/' ;;
salvages-strictly) good "$@" | sed '/"result":"invalid"/s/}$/,"salvage":{}}/' ;;
wrong-offset) good "$@" | sed 's/"offset":/"offset":1/' ;;
wrong-error) good "$@" | sed 's/"error":"[a-z]*\./"error":"xyz./' ;;
salvages-nothing) good "$@" | sed 's/,"salvage":.*$/}/' ;;
salvages-less) good "$@" | sed 's/"tiles":2/"tiles":1/' ;;
salvages-wrongly) good "$@" | sed 's/\("salvage":.*"T3":{[^}]*"sha256":"\)./\1x/' ;;
salvages-to-the-end) good "$@" | sed 's/\("salvage":.*"offset":\)/\11/' ;;
salvages-always) case "$*" in
    *lenient*) good "$@" | sed '/salvage/!s/}$/,"salvage":{"tiles":1}}/' ;;
    *) good "$@" ;;
    esac ;;
salvages-and-forgives) case "$*" in *lenient*) echo "$valid" ;; *) good "$@" ;; esac ;;
moody) if mkdir "$MOOD" 2>/dev/null; then good "$@"; else rmdir "$MOOD"; echo "$valid"; fi ;;
spoils-input) good "$@"; chmod u+w "$2"; : > "$2" ;;
esac
