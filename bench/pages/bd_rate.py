"""bench/bd_rate.md: files of profile Compact against those that training made before.
SPDX-License-Identifier: BSD-2-Clause"""
import csv
import math

from . import curves
from .bars import Bars, First
from .compare import Change, curve_of
from .rows import Measured, made_with, mark
from .words import Page, fixed, signed

LEAST_GAIN = -25       # percent, BD-rate
MOST_BITS = 20         # of a position, an anchor
RATE_ERROR = 1         # percent, estimate against the file
COMMAND = "`bench/bd_rate.sh`"
BEFORE = "bd_rate-before.csv"
# What stands under the bars.
ATTEMPTS = """Attempts to save more that were left out: masks that weigh all that a Gaussian costs
    (variant "masks"), coarser spans (-0.7 %), and contexts of neighbours in two designs, which
    would gain 0.5 to 1.4 % of a file, all types of values together
    ([compact.md](compact.md#summary)). What limits the savings: the symbols of anchors are most of
    a file, and the hyperprior of profile Main already codes them nearly as well as their neighbours
    allow."""


def write(runs, _charts, results, _pages):
    """{name of the file: text}."""
    bars = Bars()
    now = rates_now(runs)
    rate_bar(runs, bars, rates_before(runs, read_before(results)), now)
    position_bar(runs, bars)
    estimate_bar(runs, bars)
    page = Page()
    page.heading("Profile Compact: rate and quality", 1)
    page.prose("""This page compares files of profile Compact with files of profile Main, at four
        rates in small trainings. `make bd-rate` writes it from [bd_rate.csv](bd_rate.csv); the runs
        are those of bd_rate.txt. "before" is profile Main; "compact" is profile Compact with three
        times the steps in stage 2; "masks" is "compact" with `mask_weight=1` instead of the
        default, 0.4; "seed2" and "seed3" are other seeds. PSNR is that of held-out pictures,
        rendered from the decoded file. BD-rate is the mean difference of bytes at equal PSNR,
        between curves through the four rates ([how](report-tables.md#one-thing-changed)).
        *Estimate* is by how much the bits that training estimates differ from those of the
        attributes' substreams in the file. Decoding times cannot be compared, because other work
        ran beside them; [compact.md](compact.md) has times measured side by side, and what each
        technique gains. † marks rows that other sources made.""")
    page.prose(f"{sum(run.has() for run in runs.all)} of {len(runs.all)} rows are there"
               + made_with(runs.all) + ".")
    page.prose(bars.summary())
    bars.show(page, "command, then `python3 -m bench.pages bd_rate`")
    page.prose("""Bar 1 compares with files that the former default made: profile Main, a shorter
        stage 2, spans that were not yet chosen by rate and distortion, and trials that were
        trained in another order. Today's encoder makes files of profile Main smaller, too. Against
        these,
        BD-rate shows the effect of the profile and of the longer stage 2 alone: """
               + scene_words(now) + ". " + ATTEMPTS)
    rate_table(runs, page)
    run_table(runs, page)
    return {"bd_rate.md": page.text()}


def base_of(variant):
    """What a variant is compared with: "before" of the same seed."""
    return variant.replace("compact", "before") if variant.startswith("compact") else "before"


def change_of(runs, scene, variant):
    return Change(runs, scene, variant, base_of(variant))


def compact_variants(runs, scene):
    """Those of profile Compact with masks as by default, one for each seed."""
    return [variant for variant in runs.variants
            if variant.startswith("compact") and runs.of(scene, variant)]


def verdict(missed, known, wanted):
    """False as soon as one misses the bar, True when all are known and none does."""
    return False if missed else True if known == wanted and wanted else None


def rate_words(rates):
    """The mean over seeds, and each."""
    mean = signed(sum(rates) / len(rates), 1, " %")
    if len(rates) == 1:
        return mean
    return f"{mean} ({len(rates)} seeds: " + ", ".join(signed(one, 1) for one in rates) + ")"


def scene_words(known):
    return ", ".join(f"{scene} {rate_words(rates)}" for scene, rates in known.items())


def known_rates(runs, rate_of):
    """{scene: BD-rates of its variants of profile Compact}, of scenes where all are known."""
    known = {}
    for scene in runs.scenes:
        rates = [rate_of(scene, variant) if runs.is_complete(scene, variant) else None
                 for variant in compact_variants(runs, scene)]
        if None not in rates:
            known[scene] = rates
    return known


def rates_now(runs):
    """By one encoder."""
    return known_rates(runs, lambda scene, variant: change_of(runs, scene, variant).bd_rate
                       if runs.is_complete(scene, base_of(variant)) else None)


def read_before(results):
    """{"SCENE-VARIANT": points (PSNR in dB, natural logarithm of bytes) in order of PSNR}."""
    points = {}
    with open(f"{results}/{BEFORE}", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            points.setdefault(row["tag"].rsplit("-", 1)[0], []).append(
                (float(row["psnr"]), math.log(float(row["bytes"]))))
    return {name: sorted(of_name) for name, of_name in points.items()}


def rates_before(runs, before):
    """Against files of the former default."""
    def rate_of(scene, variant):
        base = before.get(f"{scene}-{base_of(variant)}", [])
        return curves.as_percent(curves.bjontegaard(base, curve_of(runs.present(scene, variant))))
    return known_rates(runs, rate_of)


def rate_verdict(runs, known):
    missed = [scene for scene, rates in known.items() if sum(rates) > LEAST_GAIN * len(rates)]
    return verdict(missed, len(known), len(runs.scenes))


def rate_bar(runs, bars, known, now):
    bars.add(1, f"BD-rate against the former default, profile Main ([rows]({BEFORE})), four rates",
             f"{LEAST_GAIN} % or better on each scene",
             scene_words(known) + mark(runs.all), rate_verdict(runs, known), COMMAND,
             First("against files of profile Main by the same encoder", scene_words(now),
                   rate_verdict(runs, now)))


def position_bar(runs, bars):
    compact = [run for run in runs.all if run.variant.startswith("compact")]
    known = known_of(compact, Measured.position_bits)
    most = max(known, key=known.get, default=None)
    bars.add(2, "positions", f"at most {MOST_BITS} bits per anchor",
             "" if most is None else f"{fixed(min(known.values()), 1)} to "
             f"{fixed(known[most], 1)} bits, most: {most}{mark(compact)}",
             verdict(any(bits > MOST_BITS for bits in known.values()), len(known), len(compact)),
             COMMAND)


def known_of(runs, value):
    """{tag: value} of the runs for which it is known."""
    found = {run.tag: value(run) for run in runs}
    return {tag: number for tag, number in found.items() if number is not None}


def estimate_bar(runs, bars):
    known = known_of(runs.all, Measured.estimate_error)
    most = max(known, key=lambda tag: abs(known[tag]), default=None)
    bars.add(5, "rate estimated in training against the file", "within 1 %",
             "" if most is None else f"at most {signed(known[most], 2, ' %')}: {most}"
             + mark(runs.all),
             verdict(any(abs(error) > RATE_ERROR for error in known.values()), len(known),
                     len(runs.all)), COMMAND)


def rate_table(runs, page):
    page.heading("BD-rate")
    page.table("scene", "variant", "BD-rate", "PSNR at equal bytes", "rows")
    for scene in runs.scenes:
        for variant in runs.variants:
            base = base_of(variant)
            if variant.startswith("before") or not runs.of(scene, variant):
                continue
            rows = runs.present(scene, base) + runs.present(scene, variant)
            wanted = len(runs.of(scene, base) + runs.of(scene, variant))
            change = change_of(runs, scene, variant)
            page.row(scene, variant + mark(rows), change.bd_rate_text(),
                     signed(change.psnr, 2, " dB"), f"{len(rows)} of {wanted}")


def run_table(runs, page):
    page.heading("Runs")
    page.table("run", "λ", "bytes", "PSNR, dB", "anchors", "position, bits per anchor",
               "estimate", "decoding, ms", "training, CPU s")
    for run in runs.all:
        if not run.has():
            page.row_missing(run.tag)
            continue
        page.row(run.name(), run.weight, run.text("bytes"), fixed(run.number("psnr"), 2),
                 run.text("anchors"), fixed(run.position_bits(), 1),
                 signed(run.estimate_error(), 2, " %"), fixed(run.number("decode_ms"), 1),
                 fixed(run.number("cpu_s"), 0))
