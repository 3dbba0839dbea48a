# page.awk - judges the zoo and puts bench/zoo.md together, on stdout. Takes -v
#     cases: the table of runs, which tells the twins      notes: page of causes, a heading "## CASE" each
# SPDX-License-Identifier: BSD-2-Clause

# Decibels: below the twin at most; inside the masks of what moves at least, where cameras take turns. Foretold: parts of the time, decibels, parts of the bytes.
BEGIN {
    MOST_BELOW = 1
    LEAST_MOVING = 22
    MOST_TIME = 0.25
    MOST_PSNR = 0.5
    MOST_BYTES = 0.05
}

function read_cases(    line, word) {
    while ((getline line <cases) > 0)
        if (split(line, word, " ") >= 4 && word[1] == "case")
            twin[word[2]] = word[3] == "-" ? "" : word[3]
    close(cases)
}

function read_notes(    line, word, name) {
    while ((getline line <notes) > 0) {
        if (line ~ /^## /) {
            split(line, word, " ")
            name = word[2]
        } else if (name != "" && line != "") {
            gsub(/\|/, "\\|", line)
            note[name] = join(note[name], " ", line)
        }
    }
    close(notes)
}

# The run of a scene.
function run_of(s) { return runs[s, variants[1], 1] }
function is_fine(s) { return get(run_of(s), "status") == "fine" }
function takes_turns(s) { return where[run_of(s)] ~ /\+turns(\+|$)/ }
function command(s) {
    text = where[run_of(s)]
    sub(/^own:/, "ted4scene ", text)
    gsub(/\+/, " --", text)
    gsub(/=/, " ", text)
    return "`" text "`"
}
# Of ted4enc, without what all runs have alike.
function training(s,    text) {
    text = options[run_of(s)]
    gsub(/--(seed|preset) [^ ]+ ?/, "", text)
    sub(/ $/, "", text)
    return text == "" ? "" : ", `" text "`"
}

# Decibels above the twin; "" where one of the two is not known.
function above(s) {
    if (twin[s] == "" || !is_fine(s) || !is_fine(twin[s]) || get(run_of(s), "psnr") == "" || get(run_of(twin[s]), "psnr") == "")
        return ""
    return get(run_of(s), "psnr") - get(run_of(twin[s]), "psnr")
}

# "" is met; else what is missed.
function missed(s,    why) {
    if (!is_fine(s))
        return get(run_of(s), "status") " " get(run_of(s), "exit") ": " get(run_of(s), "why")
    if (above(s) != "" && above(s) < -MOST_BELOW)
        why = "below its twin"
    if (takes_turns(s) && get(run_of(s), "moving_psnr") + 0 < LEAST_MOVING)
        why = join(why, ", ", "what moves")
    return why
}

function show_case(s,    t, why, verdict) {
    t = run_of(s)
    if (!has(t)) {
        row_missing(s "|" command(s) training(s) "|" twin[s])
        return
    }
    why = missed(s)
    verdict = why != "" ? "**" why "**" : "met"
    row(s mark_of(t) "|" command(s) training(s) "|" (twin[s] == "" ? "-" : twin[s]) "|" fixed(get(t, "psnr"), 2) "|" signed(above(s), 2) "|" \
        fixed(get(t, "train_psnr"), 2) "|" fixed(get(t, "moving_psnr"), 2) "|" get(t, "bytes") "|" get(t, "anchors") "|" get(t, "steps") "|" \
        fixed(get(t, "cpu_s"), 0) "|" get(t, "warnings") "|" get(t, "rollbacks") "|" verdict)
}

function larger(x, y) { return x + 0 > y + 0 ? x : y }

# What was foretold of a run: at most so far off.
function foretold(t) {
    off_time[t] = larger(1 - get(t, "estimate_low"), get(t, "estimate_high") - 1)
    off_psnr[t] = size_of(get(t, "last_psnr") - get(t, "psnr"))
    off_bytes[t] = size_of(get(t, "last_bytes") / get(t, "bytes") - 1)
}

# The watch in a training with the default preset.
function judge_long(s,    t) {
    t = runs[s, "medium", 1]
    n_long++
    n_long_there += has(t)
    n_long_back += get(t, "rollbacks") + (has(t) && get(t, "status") != "fine")
}

function judge_alone(s,    t) {
    t = runs[s, "alone", 1]
    n_alone++
    if (!has(t) || get(t, "status") != "fine")
        return
    n_foretold++
    foretold(t)
    worst_time = larger(worst_time, off_time[t])
    worst_psnr = larger(worst_psnr, off_psnr[t])
    worst_bytes = larger(worst_bytes, off_bytes[t])
}

# 1, 0, or "" while runs are missing and nothing is missed yet.
function is_foretold(worst, most) { return worst > most ? 0 : n_foretold < n_alone ? "" : 1 }

# Counts, and lists of names, over all cases.
function judge(    i, s) {
    for (i = 1; i <= n_scenes; i++) {
        s = scenes[i]
        n_old += is_old(run_of(s))
        if (n_runs[s, "alone"] > 0)
            judge_alone(s)
        if (n_runs[s, "medium"] > 0)
            judge_long(s)
        if (!has(run_of(s)))
            continue
        n_there++
        n_fine += is_fine(s)
        n_back += get(run_of(s), "rollbacks") + 0
        if (above(s) != "")
            n_held++
        if (above(s) != "" && above(s) < -MOST_BELOW)
            n_below++
        if (takes_turns(s)) {
            n_turns++
            n_gone += get(run_of(s), "moving_psnr") + 0 < LEAST_MOVING
        }
        if (missed(s) != "")
            misses[++n_misses] = s
    }
}

# 1, 0, or "" while rows are missing and nothing is missed yet.
function so_far(bad) { return bad > 0 ? 0 : n_there < n_scenes ? "" : 1 }

function show_bars(    i) {
    bar(1, "cases that end with exit status 0", "all of at least 24", n_fine + 0 " of " n_there + 0, n_scenes < 24 ? 0 : so_far(n_there - n_fine), "`bench/zoo.sh`")
    bar(1, "held-out pictures against the twin", "at most " MOST_BELOW " dB below", n_held - n_below " of " n_held + 0, so_far(n_below), "`bench/zoo.sh`")
    bar(2, "cameras that take turns: what moves, in training pictures", "at least " LEAST_MOVING " dB", n_turns - n_gone " of " n_turns + 0, so_far(n_gone),
        "`bench/zoo.sh 'turns*'`")
    bar(3, "the watch goes back to a checkpoint", "never", n_back + 0 " times", so_far(n_back), "`bench/zoo.sh`")
    bar(3, "the same in long trainings, and that they end well", "never", n_long_there + 0 " trainings, " n_long_back + 0 " times",
        n_long_back > 0 ? 0 : n_long_there < n_long ? "" : 1, "`bench/zoo.sh long`")
    alone = "`bench/zoo.sh --jobs 1 --threads 0 alone`"
    bar(4, "estimate of the whole time, from a tenth of it on; alone on the machine", "within 25 %",
        n_foretold > 0 ? "at worst " fixed(100 * worst_time, 1) " %, " n_foretold " runs" : "-", is_foretold(worst_time, MOST_TIME), alone)
    bar(4, "`psnr` of the last line", "within 0.5 dB", n_foretold > 0 ? "at worst " fixed(worst_psnr, 2) " dB" : "-", is_foretold(worst_psnr, MOST_PSNR), alone)
    bar(4, "`bytes` of the last line", "within 5 %", n_foretold > 0 ? "at worst " fixed(100 * worst_bytes, 2) " %" : "-", is_foretold(worst_bytes, MOST_BYTES), alone)
    table("#,what,bar,measured,verdict,command; then `bench/zoo_page.sh`")
    for (i = 1; i <= n_bars; i++)
        say(bars[i])
}

function show_long(    i, t) {
    if (n_long == 0)
        return
    say("")
    say("## Long trainings")
    say("")
    say("With the default preset.")
    table("case,held out,training,what moves,bytes,steps,seconds,back")
    for (i = 1; i <= n_scenes; i++) {
        t = runs[scenes[i], "medium", 1]
        if (n_runs[scenes[i], "medium"] == 0)
            continue
        if (!has(t))
            row_missing(scenes[i])
        else
            row(scenes[i] mark_of(t) "|" values(t, "psnr:2 train_psnr:2 moving_psnr:2 bytes steps cpu_s:0 rollbacks"))
    }
}

function show_alone(    i, t) {
    if (n_alone == 0)
        return
    say("")
    say("## What is foretold")
    say("")
    say("The largest difference between the time that `ted4enc` says and the time that the whole training takes, from a tenth of it on, in hundredths; and between")
    say("the last line's `psnr` and `bytes` and those of the file. Each run has the machine for itself.")
    table("case,seconds,time,psnr,bytes")
    for (i = 1; i <= n_scenes; i++) {
        t = runs[scenes[i], "alone", 1]
        if (n_runs[scenes[i], "alone"] == 0)
            continue
        if (!has(t))
            row_missing(scenes[i])
        else
            row(scenes[i] mark_of(t) "|" fixed(get(t, "train_s"), 0) "|" fixed(100 * off_time[t], 1) " %|" fixed(off_psnr[t], 2) " dB|" fixed(100 * off_bytes[t], 2) " %")
    }
}

function show_misses(    i) {
    say("")
    say("## What misses")
    say("")
    if (n_misses == 0)
        say(n_there > 0 ? "Nothing." : "Not run yet.")
    for (i = 1; i <= n_misses; i++)
        say("* " misses[i] " (" missed(misses[i]) "): " (misses[i] in note ? note[misses[i]] : "**not explained yet**"))
}

END {
    if (failed)
        exit 1
    read_cases()
    read_notes()
    judge()
    say("# The zoo: scenes as other people write them")
    say("")
    say("Written by `make zoo` from [zoo.csv](zoo.csv): " n_there + 0 " of " n_scenes " wanted runs are there, " n_old + 0 " of them older than the sources (†).")
    say("Each case shows the content of its twin, which is friendly, in a way in which others write scenes; [zoo.txt](zoo.txt) is the table.")
    say("The command makes the scene; then `ted4enc SCENE -o FILE.ted4 --preset draft --seed 1` with the options that stand behind it. The preset is draft, for")
    say("the default's 60,000 steps take ten minutes a case on one core even for pictures of 96x64.")
    show_bars()
    say("")
    say("## Every case")
    say("")
    say("PSNR in dB: of held-out pictures, the same against the twin's, of training pictures, and of these inside the masks of what moves and of its shadow, over")
    say("all pixels. Seconds are of one core; warnings those of ted4enc; back: how often the watch went back to a checkpoint.")
    table("case,command,twin,held out,against twin,training,what moves,bytes,anchors,steps,seconds,warnings,back,verdict")
    for (i = 1; i <= n_scenes; i++)
        show_case(scenes[i])
    show_long()
    show_alone()
    show_misses()
    for (i = 1; i <= n_body; i++)
        print body[i]
}
