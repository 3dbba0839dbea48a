#!/bin/sh
# test_scene_check.sh - what ted4enc says of a scene: its points, those that --bounds leaves, with a
# warning of the others, and all that --check --json says of it. Prints lines as a cmocka program
# does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need scene_check ted4enc ted4scene ted4info python3
"$TED4_BUILD/ted4scene" pop -o "$out/scene" --size 32x24 --frames 4 --cameras 5 \
    --test-cameras 1 -j 1 2>/dev/null
# inside: prints how many points of a PLY whose records have 27 bytes lie in a box.
inside() {
    python3 - "$@" <<'END'
import struct
import sys

data = open(sys.argv[1], "rb").read().split(b"end_header\n", 1)[1]
low, high = (tuple(map(float, a.split(","))) for a in sys.argv[2:])
points = [struct.unpack_from("<3f", data, at) for at in range(0, len(data), 27)]
print(sum(all(a <= x <= b for a, x, b in zip(low, p, high)) for p in points))
END
}
n=$(inside "$out/scene/points3d.ply" -1,-1,0 1,0.5,2)
equal() { [ "$2" = "$3" ] && ok "$1" || fail "$1" "$2, expected $3"; }
encode() { "$TED4_BUILD/ted4enc" "$out/scene" "$@" >"$out/said" 2>"$out/err"; }
encode --check
equal points "$(grep '^points ' "$out/said") $(grep -c warning "$out/err")" 'points      4000 0'
[ "$n" -gt 0 ] && [ "$n" -lt 4000 ] && ok some_inside || fail some_inside "$n of 4000"
# The corners may be given in any order.
encode --check --bounds 1,-1,2,-1,0.5,0
equal bounds "$(grep '^points ' "$out/said")" "points      $n"
check outside "$out/err" "warning: $((4000 - n)) initial points outside the bounds are not used"
encode --check --json --bounds -1,-1,0,1,0.5,2
equal bounds_json "$(cat "$out/said")" "$(printf '%s' \
    '{"error":null,"layout":"D-NeRF","train":20,"test":4,"cameras":6,"frames":4,' \
    "\"sizes\":[[32,24],[32,24]],\"points\":$n,\"random_points\":false," \
    '"background":[0,0,0],"rate":null,"warnings":[],"file_rate":"30/1"}')"

# The points of a training, too.
small="--preset draft --iterations 2,2 --capacity fixed --seed 1 -j 1 --set init_anchors=150
    --set max_anchors=260 --set offsets=4 --set feature=8 --set phi=4 --set bank_dim=8
    --set deform_width=8 --set head_width=12 --set hyper_width=16 --set ar_width=8 --set slices=2"
# shellcheck disable=SC2086 # words
encode -o "$out/all.ted4" $small
# shellcheck disable=SC2086
encode -o "$out/box.ted4" $small --bounds -1,-1,0,1,0.5,2
check outside_in_training "$out/err" 'initial points outside the bounds are not used'
for f in all box; do "$TED4_BUILD/ted4info" "$out/$f.ted4" | grep '^space ' >"$out/$f"; done
cmp -s "$out/all" "$out/box" && fail box "$(cat "$out/box")" || ok box

# Pictures of three sizes, one that is missing, and no points: what --check --json says of them.
mkdir "$out/mixed"
cat >"$out/mixed.py" <<'END'
import json
import struct
import sys
import zlib

folder = sys.argv[1]


def png(name, width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(
            ">I", zlib.crc32(kind + data))
    row = b"\0" + b"\x40\x80\xc0" * width
    with open(folder + "/" + name, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(
            ">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(row * height)) + chunk(b"IEND", b""))


frames = []
for i in range(6):
    width, height = (40, 20) if i == 2 else (16, 12) if i == 4 else (24, 16)
    png(f"{i}.png", width, height)
    frames.append({"file_path": f"{i}.png", "w": width, "h": height, "time": 0,
                   "fl_x": 30, "fl_y": 30, "cx": width / 2, "cy": height / 2,
                   "transform_matrix": [[1, 0, 0, 0.2 * i], [0, 1, 0, 0.1 * (i % 2)],
                                        [0, 0, 1, 3], [0, 0, 0, 1]]})
for split in ("train", "test"):
    with open(f"{folder}/transforms_{split}.json", "w", encoding="utf-8") as f:
        json.dump({"frames": frames[:5] if split == "train" else frames[5:]}, f)
END
python3 "$out/mixed.py" "$out/mixed"
rm "$out/mixed/3.png"
"$TED4_BUILD/ted4enc" --check --json "$out/mixed" >"$out/said" 2>"$out/err"
equal mixed "$(sed "s|$out/||" "$out/said")" "$(printf '%s' \
    '{"error":null,"layout":"D-NeRF","train":4,"test":1,"cameras":5,"frames":1,' \
    '"sizes":[[16,12],[40,20]],"points":20000,"random_points":true,' \
    '"background":[64,128,192],"rate":null,' \
    '"warnings":["1 of 6 entries has no picture: ' \
    'mixed/transforms_train.json: frames[3]: 3.png"]}')"
exit $bad
