"""The findings of the report: a plain sentence or two each, whose numbers come from the rows.

A finding is a function of the report; it returns its text and the runs behind it, or None while one
of them is missing.
SPDX-License-Identifier: BSD-2-Clause"""
from ..compare import Change, base_of, is_mixed, seed_spread, whole_run, within_seeds
from ..rows import mark
from ..seeded import Seeded
from ..words import anchor, counted, fixed, signed
from . import estimate, lives, precision, singles, variant_bars
from .held_out import cameras_text, folders
from .rate import is_monotone

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
    if any(is_monotone(report.runs, scene) is None for scene in report.scenes):
        return None
    first, last = whole[0], whole[-1]
    falling = all(is_monotone(report.runs, scene) for scene in report.scenes)
    return (f"One weight, λ, trades size for quality: on `{SCENE}` it leads from {kb(first)} at "
            f"{db(first)} (λ {first.weight}) to {kb(last)} at {db(last)} (λ {last.weight}). "
            + (f"On all {len(report.scenes)} scenes both fall with every step." if falling else
               "Not on every scene do both fall with every step."), rows)


def by_scene(values, text):
    """(scene, value) pairs in words; "alone" where there is one."""
    alone = " alone" if len(values) == 1 else ""
    return " and ".join(f"{text(value)} (`{scene}`{alone})" for scene, value in values)


def changes(report, variant):
    """(scene, Change) where the bars judge a variant."""
    runs, base = report.runs, base_of(variant)
    return [(scene, Change(runs, scene, variant)) for scene in variant_bars.scenes_of(runs, variant)
            if variant_bars.has_rows(runs, scene, variant, base)]


def seeded_on(report, variant):
    """Comparisons over seeds of a variant, by scene."""
    found = [Seeded(report.runs, scene, variant)
             for scene in variant_bars.scenes_of(report.runs, variant)]
    return [seeded for seeded in found if seeded.changes]


def compared_on(all_seeded, more=""):
    """Means over seeds on all scenes. more: after the first one."""
    alone = " alone" if len(all_seeded) == 1 else ""
    return " and ".join(f"{compared(seeded)}{more if k == 0 else ''} on `{seeded.scene}`{alone} "
                        f"({len(seeded.changes)} seeds)" for k, seeded in enumerate(all_seeded))


def rows_of(report, variant, scenes):
    return [run for scene in scenes for one in (variant, base_of(variant))
            for run in report.runs.of(scene, one)]


def rows_over_seeds(all_seeded):
    return [run for seeded in all_seeded for pair in seeded.pairs for run in pair]


def activation(report):
    there = [(scene, change.psnr) for scene, change in changes(report, "noactive")
             if change.psnr is not None]
    if not there:
        return None
    text = ("Without life spans, that is, with anchors that are always present, PSNR at equal "
            "bytes changes by "
            + by_scene(there, lambda psnr: signed(psnr, 2, " dB")) + ".")
    recipe = seeded_on(report, "recipe_noactive")
    if recipe:
        text += (f" Without them, the paper's recipe alone is {compared_on(recipe)}"
                 f"{together(report, *recipe)}.")
    return text, (rows_of(report, "noactive", [scene for scene, _ in there])
                  + rows_over_seeds(recipe))


def deformation(report):
    seeded, recipe = seeded_on(report, "inr"), seeded_on(report, "recipe_inr")
    if not seeded or not recipe:
        return None
    known = [one.scene for one in seeded]
    single = [(scene, change) for scene, change in changes(report, "inr")
              if change.psnr is not None and scene not in known]
    chance = all(within_seeds(report.runs, *one) for one in single)
    text = ("In the paper's recipe alone, a network of place and time as wide as F_deform is "
            f"{compared_on(recipe, ' than the bank of motions')}. With multi-view seeding, which "
            f"does much of the same work, it is {compared_on(seeded)}"
            f"{together(report, *seeded, *recipe)}.")
    if single:
        text += " At one seed it " + " and ".join(
            f"{loses(change.psnr)} on `{scene}`" for scene, change in single) + (
                ", less than seeds differ." if chance else ".")
    return text, (rows_over_seeds(seeded + recipe)
                  + rows_of(report, "inr", [scene for scene, _ in single]))


def prior(report):
    by_default, as_fixed = (
        [(scene, change.bd_rate) for scene, change in changes(report, variant)
         if change.bd_rate is not None] for variant in ("factorised_flat_auto", "factorised_flat"))
    if not by_default or not as_fixed:
        return None
    rates = [by_scene(known, lambda rate: f"{rate:.1f} %") for known in (as_fixed, by_default)]
    return ("With a factorised prior in place of the hyperprior, files take "
            f"{rates[0]} more bytes at equal PSNR (BD-rate) when the capacity is fixed, and "
            f"{rates[1]} when each chooses its capacity, as by default. The paper's figure is "
            "25 %.",
            rows_of(report, "factorised_flat_auto", [scene for scene, _ in by_default])
            + rows_of(report, "factorised_flat", [scene for scene, _ in as_fixed]))


def still(report):
    pairs = [(scene, *(report.runs.find(f"{scene}-{variant}-2") for variant in
                       ("whole", "static"))) for scene in ("still", "chair")]
    rows = [run for _, *both in pairs for run in both]
    if not all(run.has() for run in rows) or any(is_mixed(both) for _, *both in pairs):
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
            f"{run.count('train_s') / 60:.1f} minutes of steps on "
            f"{counted(int(run.count('threads')), 'thread')}, "
            f"to {db(run)} in {run.count('bytes') / 1e6:.2f} MB.", [run])


def colour(report):
    with_it, without, plain = (report.runs.find(tag) for tag in (
        "tint-colour-2", "tint-nocolour-2", "tint_by_kitchen-fast-2"))
    gain, loss = singles.difference(with_it, without), singles.difference(plain, with_it)
    if gain is None or loss is None:
        return None
    return ("Where the colours of cameras differ (`kitchen_tint` alone), correcting them "
            f"{loses(gain)}; the result lies {abs(loss):.2f} dB "
            f"{'below' if loss > 0 else 'above'} that of cameras that agree.",
            [with_it, without, plain])


def spans(report):
    run = report.runs.find(lives.FAST)
    if not run.text("short_changed"):
        return None
    return (f"{100 * run.count('span_short'):.1f} % of the anchors of `kitchen` live for at most a "
            "fifth of the sequence; they contribute "
            f"{100 * run.count('short_changed'):.1f} % of the light where pixels change, and "
            f"{100 * run.count('short_same'):.1f} % elsewhere.", [run])


def estimated(report):
    known = [(run.estimate_error(), run) for run in report.runs.all]
    known = [pair for pair in known if pair[0] is not None]
    if not known:
        return None
    worst = abs(estimate.worst_of(known)[0])
    variants = len({run.variant for _, run in known})
    return (f"The rate that training estimates matches that of the file to within {worst:.2f} % in "
            f"{variants} of {len(report.runs.variants)} variants.", [run for _, run in known])


def integers(report):
    run = whole_run(report.runs, SCENE, 1)
    ideal = precision.bytes_with(run, "float64")
    if ideal is None:
        return None
    ms = {one: precision.median_ms(report.runs, SCENE, one) for one in ("integer", "float64")}
    return (f"Integer entropy networks, which decode identically on every machine, cost "
            f"{100 * (run.count('bytes') / ideal - 1):.3f} % of the bytes of `{SCENE}`; its "
            f"file decodes on one thread in {ms['integer']:.0f} ms, where float64 would take "
            f"{ms['float64']:.0f} ms (medians of {precision.steps_of(report.runs, SCENE)}).",
            [one for _, one in precision.step_runs(report.runs, SCENE)])


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
    """What the verdicts on parts of the method rest on."""
    alone = [scenes for scenes in report.grounds if len(folders(report, scenes)) < 2]
    text = ("What each part is worth (bar 1) is judged on every scene that has its rows, and no "
            "bar is met on one scene alone. ")
    if report.grounds:
        text += (f"Of {counted(len(report.grounds), 'such verdict')} "
                 f"{len(report.grounds) - len(alone)} rest on more than one scene")
    if alone:
        scenes = list(dict.fromkeys(scene for one in alone for scene in one))
        text += (f", and {len(alone)} on one alone (" + ", ".join(f"`{one}`" for one in scenes)
                 + f", {cameras_text(report, scenes)})")
    return (text + ". The runs that would add scenes, seeds and a second held-out camera are "
            "listed in [sweep.txt](sweep.txt). " + report.family.holds())


def open_section(report, page):
    """What was promised, and missed or left open."""
    bars = report.bars
    page.heading("What was promised and not met")
    page.prose(bars.summary("report-tables.md"))
    page.prose(ground(report))
    page.prose("""[All bars](report-tables.md#bars). The [notes](#notes) explain those that are not
        met. "Undecided" stands for those that were measured, but neither met nor missed:""")
    page.say()
    for wanted in ("**missed**", "undecided", "not run yet"):
        for row in bars.rows:
            if row.verdict == wanted:
                more = row.said[len(row.verdict):].lstrip(":; ")
                page.item(f"{row.verdict}: {row.what} (asked: {row.limit}"
                          f"{more and f'; {more}'})")
