#!/bin/sh
# Encoders that do not conform, each in its own way: ted4conf encode has to detect all of them.
#     bad_encoder.sh WAY ARGUMENTS OF THE CONTRACT...
# MADE: a file; MADE.json: the answer of the encoder that made it.
way=$1
shift
while [ $# -gt 0 ]; do
    [ "$1" != -o ] || out=$2
    shift
done
suite=conformance/vectors
case $way in
no-file) ;;
pipe) mkfifo "$out" ;;
folder) mkdir "$out" ;;
broken) head -c 200 "$MADE" >"$out" ;;
level-too-low)
    file=$suite/valid/levels/LVL-frames-65.ted4
    { head -c 11 "$file"; printf '\001'; tail -c +13 "$file"; } >"$out" ;;
wasteful) cp "$WASTE" "$out" ;;
*) cp "$MADE" "$out" ;;
esac
case $way in
crash) kill -SEGV $$ ;;
hang) sleep 600 ;;
silent) ;;
exit-code) cat "$MADE.json"; exit 3 ;;
chatter) echo 'training...'; cat "$MADE.json" ;;
other-hash) sed 's/"hash":"[0-9a-f]\{8\}/"hash":"00000000/' "$MADE.json" ;;
no-hash) echo '{"bytes":1}' ;;
wasteful) cat "$WASTE.json" ;;
*) cat "$MADE.json" ;;
esac
