"""The findings of the report: a plain sentence or two each, whose numbers come from the rows.

A finding is a function of the report; it returns its text and the runs behind it, or None while one
of them is missing.
SPDX-License-Identifier: BSD-2-Clause"""
from ..compare import Change, seed_spread, whole_run
from ..rows import mark
from ..seeded import Seeded
from ..words import anchor, fixed
from . import estimate, lives, precision, singles, variant_bars
from .held_out import counted, held_out

SCENE = "kitchen"


def kb(run):
    return f"{run.count('bytes') / 1000:.0f} kB"


def db(run):
    return fixed(run.number("psnr"), 2) + " dB"


def loses(change):
    """A change of PSNR, dB."""
    return f"{'loses' if change < 0 else 'gains'} {abs(change):.2f} dB"


def compared(seeded):
    """The mean over seeds with its standard error."""
    return (f"{abs(seeded.mean):.2f} ± {seeded.error:.2f} dB "
            f"{'worse' if seeded.mean < 0 else 'better'}")


def together(report, *compared_over_seeds):
    """What belongs to such a sentence where not all of its differences hold among all comparisons
    of the report."""
    if all(report.family.is_worse(seeded) != "?" for seeded in compared_over_seeds):
        return ""
    return (f"; among the report's {report.family.count} comparisons over seeds, "
            + ("this could be chance" if len(compared_over_seeds) == 1 else
               "these differences could be chance"))


def rate(report):
    rows = [run for scene in report.scenes for run in report.runs.of(scene, "whole")]
    whole = report.runs.of(SCENE, "whole")
    if len(whole) < 2 or not all(run.has() for run in rows):
        return None
    first, last = whole[0], whole[-1]
    falling = all(b.count("bytes") < a.count("bytes") and b.count("psnr") < a.count("psnr")
                  for scene in report.scenes
                  for a, b in zip(report.runs.of(scene, "whole"),
                                  report.runs.of(scene, "whole")[1:]))
    return (f"One weight, λ, trades size for quality: on `{SCENE}` it leads from {kb(first)} at "
            f"{db(first)} (λ {first.weight}) to {kb(last)} at {db(last)} (λ {last.weight}). "
            + (f"On all {len(report.scenes)} scenes both fall with every step." if falling else
               "Not on every scene do both fall with every step."), rows)


def activation(report):
    runs = report.runs
    change = Change(runs, SCENE, "noactive")
    if change.psnr is None:
        return None
    recipe = Seeded(runs, SCENE, "recipe_noactive")
    more = ""
    if recipe.changes:
        more = (" The paper's recipe alone, which grows no short-lived anchors there, is "
                f"{compared(recipe)} without them{together(report, recipe)}.")
    return (f"Without life spans of anchors `{SCENE}` {loses(change.psnr)} at equal bytes.{more}",
            runs.of(SCENE, "noactive") + runs.of(SCENE, "whole")
            + [run for pair in recipe.pairs for run in pair])


def deformation(report):
    seeded = Seeded(report.runs, SCENE, "inr")
    recipe = Seeded(report.runs, SCENE, "recipe_inr")
    if not seeded.changes or not recipe.changes:
        return None
    return ("In the paper's recipe alone, a network of place and time as wide as F_deform is "
            f"{compared(recipe)} than the bank of motions on `{SCENE}` ({len(recipe.changes)} "
            "seeds). Beside multi-view seeding, which does much of the same work, it is "
            f"{compared(seeded)}{together(report, seeded, recipe)}.",
            [run for one in (seeded, recipe) for pair in one.pairs for run in pair])


def prior(report):
    runs = report.runs
    by_default = Change(runs, SCENE, "factorised_flat_auto")
    as_fixed = Change(runs, SCENE, "factorised_flat")
    if by_default.bd_rate is None or as_fixed.bd_rate is None:
        return None
    return (f"With a factorised prior in the place of the hyperprior, files of `{SCENE}` take "
            f"{by_default.bd_rate:.1f} % more bytes at equal PSNR (BD-rate) when each chooses its "
            f"capacity, as by default, and {as_fixed.bd_rate:.1f} % more when the capacity is "
            "fixed. The paper's figure is 25 %.",
            [run for variant in ("factorised_flat_auto", "whole_auto", "factorised_flat", "whole")
             for run in runs.of(SCENE, variant)])


def still(report):
    pairs = [(scene, *(report.runs.find(f"{scene}-{variant}-2") for variant in
                       ("whole", "static"))) for scene in ("still", "chair")]
    rows = [run for _, *both in pairs for run in both]
    if not all(run.has() for run in rows):
        return None
    spent = sum(singles.for_time(whole) for _, whole, _ in pairs)
    most = max(abs(singles.rate_against(whole, static)) for _, whole, static in pairs)
    return (f"Where nothing moves, the files (`still` and `chair`) hold "
            f"{spent:.0f} bytes of bank, temporal features and activations, and their sizes differ "
            f"by {most:.2f} % from those of an encoder without time.", rows)


def medium(report):
    run = report.runs.find("kitchen_full-medium-1")
    if not run.has():
        return None
    return (f"Preset `medium` trains `kitchen` at full size in "
            f"{run.count('train_s') / 60:.1f} minutes of steps on {run.text('threads')} threads, "
            f"to {db(run)} in {run.count('bytes') / 1e6:.2f} MB.", [run])


def colour(report):
    with_it, without, plain = (report.runs.find(tag) for tag in (
        "tint-colour-2", "tint-nocolour-2", "tint_by_kitchen-fast-2"))
    gain, loss = singles.difference(with_it, without), singles.difference(plain, with_it)
    if gain is None or loss is None:
        return None
    return (f"Where the colours of cameras differ (`kitchen_tint`), correcting them {loses(gain)}; "
            f"the result lies {abs(loss):.2f} dB {'below' if loss > 0 else 'above'} that of "
            "cameras that agree.",
            [with_it, without, plain])


def spans(report):
    run = report.runs.find(lives.FAST)
    if not run.text("short_changed"):
        return None
    return (f"{100 * run.count('span_short'):.1f} % of the anchors of `kitchen` live for at most a "
            "fifth of the sequence; they make "
            f"{100 * run.count('short_changed'):.1f} % of the light where pixels change, "
            f"{100 * run.count('short_same'):.1f} % elsewhere.", [run])


def estimated(report):
    known = [(estimate.error_of(run), run) for run in report.runs.all]
    known = [pair for pair in known if pair[0] is not None]
    if not known:
        return None
    worst = abs(estimate.worst_of(known)[0])
    variants = len({run.variant for _, run in known})
    return (f"The rate that training estimates is the rate of the file to within {worst:.2f} % in "
            f"{variants} of {len(report.runs.variants)} variants.", [run for _, run in known])


def integers(report):
    run = whole_run(report.runs, SCENE, 1)
    ideal = precision.bytes_with(run, "float64")
    if ideal is None:
        return None
    return (f"Entropy networks in integers, which decode alike on every machine, cost "
            f"{100 * (run.count('bytes') / ideal - 1):.3f} % of the bytes of `{SCENE}`, and the "
            f"file decodes on one thread in {precision.ms_with(run, 'integer'):.0f} ms, where "
            f"float64 would take {precision.ms_with(run, 'float64'):.0f} ms.", [run])


# Each with its name, and the heading on the page of tables behind it.
ALL = (
    ("Rate and distortion", "Rate and distortion", rate),
    ("Life spans", "Variants on kitchen", activation),
    ("Deformation", "The paper's recipe alone", deformation),
    ("Prior", "Variants on kitchen", prior),
    ("Scenes without motion", "Scenes in which nothing moves", still),
    ("Training time", "Medium preset, every pixel", medium),
    ("Cameras", "Cameras whose colours differ", colour),
    ("Short lives", "How long anchors live", spans),
    ("Estimated rate", "Rate estimated in training against the file", estimated),
    ("Integers", "Precision", integers),
)


def section(report, page):
    page.heading("Ten findings")
    spread = seed_spread(report.runs, SCENE)
    text = """Each finding links to the table behind it. † marks numbers that depend on rows of
        older sources."""
    if spread:
        text += (f" Three seeds of the whole method on `{SCENE}` lie {spread['psnr']:.2f} dB and "
                 f"{spread['share']:.2f} % of the bytes apart"
                 + mark([whole_run(report.runs, SCENE, seed) for seed in (1, 2, 3)])
                 + "; smaller differences are measured over several seeds and given with the "
                 "standard error of their mean.")
    page.prose(text)
    page.say()
    for number, (name, heading, finding) in enumerate(ALL, 1):
        found = finding(report)
        link = f"[table](report-tables.md#{anchor(heading)})"
        text = f"{found[0][:-1]}{mark(found[1])}." if found else "Not run yet."
        page.item(f"**{name}.** {text} ({link})", f"{number}. ")


def ground(report):
    """What the verdicts on variants rest on, and what other scenes say."""
    found = held_out(report, SCENE)
    text = (f"What each part is worth (bar 1) is judged on one scene, `{SCENE}`, by "
            + (counted(found[0], "held-out camera") if found else "an unknown number of cameras")
            + "; more held-out cameras would need new trainings. " + report.family.holds())
    both = {scene: variant_bars.signs(report.runs, SCENE, scene) for scene in report.runs.scenes
            if scene != SCENE}
    agreeing = [f"{sum(a == b for a, b in pairs)} of {len(pairs)} on `{scene}`"
                for scene, pairs in both.items() if pairs]
    if agreeing:
        text += (" Other scenes have some of these variants, most at one seed; the difference has "
                 f"the same sign there for {', '.join(agreeing)}.")
    return text


def open_section(report, page):
    """What was promised, and missed or left open."""
    bars = report.bars
    page.heading("What was promised and not met")
    page.prose(bars.summary("report-tables.md"))
    page.prose(ground(report))
    page.prose("""[All bars](report-tables.md#bars). [Notes](#notes) tell what stands behind those
        that are not met:""")
    page.say()
    for wanted in ("**missed**", "cannot be said", "not run yet"):
        for row in bars.rows:
            if row.verdict == wanted:
                page.item(f"{row.verdict}: {row.what} (asked: {row.limit}"
                          f"{row.said[len(row.verdict):]})")
