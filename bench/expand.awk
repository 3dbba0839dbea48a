# expand.awk - a table of runs (bench/sweep.txt, bench/stability.txt, bench/zoo.txt), a run a line:
#     GROUPS|TAG|SCENE|WHERE|VARIANT|PLACE|LAMBDA|KEEP|STAGE1|OPTIONS
# PLACE: of the lambda, or of the seed, in its list, from 1. STAGE1: the options that decide stage 1, with no part that only stage 2 looks at, as
# ref-encoder/train/model/options.def says. Options come out once each, the last value of a name winning, in the order in which names first come.
# Usage: awk -f expand.awk ref-encoder/train/model/options.def bench/sweep.txt. A fault in the table ends it with status 1.
# SPDX-License-Identifier: BSD-2-Clause

function fail(why) {
    print FILENAME ":" FNR ": " why >"/dev/stderr"
    failed = 1
    exit 1
}

# options.def: TED4_OPTION(kind, first stage, name, ...   An option that is not there counts as one of stage 1; ted4enc will refuse it.
FNR == NR {
    if ($0 ~ /^TED4_OPTION\(/) {
        split($0, part, /[(,][ \t]*/)
        stage[part[4]] = part[3]
    }
    next
}

# Words from number i on into value[name], order[1..n_order].
function take(i,    name) {
    for (; i <= NF; i++) {
        name = $i
        if (index(name, ",") > 0 || index(name, "|") > 0)
            fail("no commas in options: " name)
        if (name == "--set") {
            if (split($(++i), half, "=") != 2)
                fail("--set " $i ": NAME=VALUE expected")
            keep_value("--set " half[1] "=", half[2])
        } else if (name ~ /^--(preset|capacity|lambda|seed|downscale|alpha|hold-out)$/) {
            keep_value(name " ", $(++i))
        } else if (name == "--black") {
            keep_value(name, "")
        } else {
            fail("option " name " not expected here")
        }
    }
}

function keep_value(name, v) {
    if (!(name in value))
        order[++n_order] = name
    value[name] = v
}

function take_text(text,    line) {
    line = $0
    $0 = text
    take(1)
    $0 = line
}

# Does the option matter before stage 2?
function early(name) {
    if (name == "--lambda " || name == "--capacity ")
        return 0
    if (name !~ /^--set /)
        return 1
    sub(/^--set /, "", name)
    sub(/=$/, "", name)
    return stage[name] < 2
}

function one_run(groups, scene, variant, place, keep, options,    i, all, first, tag) {
    if (!(scene in where))
        fail("scene " scene ": not in the table above")
    if (!(place in place_value))
        fail("place " place ": there are " n_places)
    tag = scene "-" variant "-" place
    if (tag in seen)
        fail(tag ": already in the table")
    seen[tag] = 1
    n_order = 0
    split("", value)
    first = base
    if (options ~ /--preset /)
        gsub(/--set [^ ]+/, "", first)
    take_text(first " " scene_options[scene] " " place_option " " place_value[place] " " options)
    first = ""
    for (i = 1; i <= n_order; i++) {
        all = all " " order[i] value[order[i]]
        if (early(order[i]))
            first = first " " order[i] value[order[i]]
    }
    print groups more_groups[scene] "|" tag "|" scene "|" where[scene] "|" variant "|" place "|" value["--lambda "] "|" keep "|" substr(first, 2) "|" substr(all, 2)
}

{ sub(/#.*/, "") }
NF == 0 { next }
!("lambda" in stage) || stage["lambda"] != 2 { fail("options.def was not understood") }
($1 == "lambdas" || $1 == "seeds") && n_places == 0 {
    place_option = $1 == "lambdas" ? "--lambda" : "--seed"
    n_places = NF - 1
    for (i = 2; i <= NF; i++)
        place_value[i - 1] = $i
    next
}
$1 == "base" { sub(/^[ \t]*base[ \t]*/, ""); base = $0; next }
$1 == "case" && NF >= 4 { sub(/^[ \t]*case[ \t]+[^ \t]+[ \t]+[^ \t]+/, "scene " $2) }
$1 == "scene" && NF >= 3 {
    name = $2
    all_scenes = all_scenes (all_scenes == "" ? "" : ",") name
    where[name] = $3
    sub(/^[ \t]*scene[ \t]+[^ \t]+[ \t]+[^ \t]+[ \t]*/, "")
    scene_options[name] = $0
    next
}
$1 == "group" && NF == 3 {
    n_scene = split($3, a_scene, ",")
    for (s = 1; s <= n_scene; s++)
        more_groups[a_scene[s]] = more_groups[a_scene[s]] "+" $2
    next
}
$1 == "run" && NF >= 6 {
    groups = $2; variant = $3; keep = $6
    n_scene = split($4 == "all" ? all_scenes : $4, a_scene, ",")
    n_place = split($5, a_place, ",")
    sub(/^[ \t]*run([ \t]+[^ \t]+)([ \t]+[^ \t]+)([ \t]+[^ \t]+)([ \t]+[^ \t]+)([ \t]+[^ \t]+)[ \t]*/, "")
    options = $0
    for (s = 1; s <= n_scene; s++)
        for (l = 1; l <= n_place; l++)
            one_run(groups, a_scene[s], variant, a_place[l], keep, options)
    next
}
{ fail("lambdas or seeds (one of them, once), base, scene, case, group or run expected") }
END { exit failed }
