# cams.awk - from COLMAP's cameras.txt and images.txt (SIMPLE_RADIAL lenses) to cams.json, whose
# fields doc/layouts.md describes. First file: name of the picture, tab, clip. The centre of the
# first pixel is at 0.5, 0.5 for COLMAP, and at 0, 0 in cams.json. 17 digits give back every double.
# SPDX-License-Identifier: BSD-2-Clause
# Letter by letter: how many backslashes gsub makes is not the same in every awk.
function text(s,   i, c, t) {
    for (i = 1; i <= length(s); i++) {
        c = substr(s, i, 1)
        t = t (c == "\\" || c == "\"" ? "\\" : "") c
    }
    return "\"" t "\""
}
function row(a, b, c, d) { return sprintf("[%.17g, %.17g, %.17g, %.17g]", a, b, c, d) }
FNR == 1 { file++ }
file == 1 { split($0, p, "\t"); picture[++n] = p[1]; clip[n] = p[2]; next }
/^#/ { next }
file == 2 {
    size[$1] = sprintf("\"w\": %d, \"h\": %d", $3, $4)
    f[$1] = $5; cx[$1] = $6 - 0.5; cy[$1] = $7 - 0.5; k[$1] = $8
    next
}
# Of each picture a line with its pose, then one with its points.
++line % 2 == 0 { next }
{
    w = $2; x = $3; y = $4; z = $5; c = $9; name = $0
    for (i = 0; i < 9; i++) sub(/^[^ ]+ /, "", name)
    lens = sprintf("\"K\": [[%.17g, 0, %.17g], [0, %.17g, %.17g], [0, 0, 1]]", f[c], cx[c], f[c], \
        cy[c])
    lens = lens sprintf(", \"dist\": [%.17g, 0, 0, 0]", k[c])
    a = row(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), $6)
    b = row(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), $7)
    d = row(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), $8)
    next_row = ",\n             "
    camera[name] = size[c] ",\n     " lens ",\n     \"w2c\": [" a next_row b next_row d \
        next_row "[0, 0, 0, 1]]"
}
END {
    printf "{\n  \"fps\": %s,\n  \"cameras\": [", rate
    for (i = 1; i <= n; i++) {
        label = picture[i]; sub(/\.png$/, "", label)
        if (picture[i] in camera)
            printf "%s\n    {\"name\": %s, \"video\": %s, %s}", many++ ? "," : "", text(label), \
                text(clip[i]), camera[picture[i]]
    }
    print "\n  ]\n}"
}
