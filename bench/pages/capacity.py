"""bench/capacity.md: how much model is chosen, against fixed settings: bars 4 to 6 of the lab.
SPDX-License-Identifier: BSD-2-Clause"""
import os

from . import capacity_misses
from .bars import Bars, First
from .capacity_cost import Costs, temporal, weight_bits
from .compare import is_mixed, of_one_encoder
from .earlier import earlier
from .notes import read_notes
from .plot import Plot
from .rows import mark, own_options
from .words import Page, cells, fixed, signed

EQUAL_PSNR = 0.1    # dB: a fixed setting that far below auto still counts as equal
NEAR_BEST = 0.02    # share of the cost
MOST_TIME = 0.25    # share of the training time
THINGS = {"things0": "0", "things1": "1", "things2": "2", "things4": "4", "things8": "8"}
TIMES = {"things4": "16", "long2": "32", "long4": "64"}
FINE_BITS = 16      # of a weight: coarse grids have fewer, full precision more
SETTINGS = {
    "auto": "as much of *whole* as pays, which trials in stage 2 decide",
    "whole": "the sizes of the preset, fixed",
    "lean": "as *whole*, with a small entropy model",
    "less": "as *lean*, with three quarters of the Gaussians per anchor, of the feature and of "
            "the heads' width, and half of the width of F_deform and of the bank",
    "small": "as *lean*, with half of the Gaussians per anchor, of the feature, the temporal "
             "feature and the heads' width, a quarter of the width of F_deform and of the bank, "
             "and an even smaller entropy model",
    "static": "as *lean*, without time",
}


def write(runs, charts, results, _):
    """{name of the file: text}, with charts drawn."""
    bars, costs = Bars(), Costs(runs)
    cost_bar(runs, bars, costs, results)
    time_bar(runs, bars)
    for scene in ("still", "chair", "moment"):
        still_bar(runs, bars, scene)
    things_bar(bars, costs)
    body = Page()
    sections(runs, body, costs, charts)
    notes = read_notes(os.environ.get("TED4_NOTES", "bench/capacity-notes.md"))
    capacity_misses.section(body, costs, missed_scenes(runs, costs), notes)
    head = Page()
    head.heading("Capacity: no more model than a scene needs", 1)
    head.prose("""With `--capacity auto` (*auto*), training makes the model smaller as long as that
        lowers the rate-distortion cost of the file. This page compares the result with fixed
        settings, scene by scene, and says [where it misses](#scenes-that-miss-bar-4). `make
        capacity` writes it from [capacity.csv](capacity.csv); the runs are those of capacity.txt.
        † marks rows that other sources made.""")
    head.prose(runs.summary() + ".")
    head.prose(bars.summary())
    bars.show(head, "command, then `python3 -m bench.pages capacity`")
    head.say()
    return {"capacity.md": head.text() + body.text()}


def command(patterns):
    return f"`bench/capacity.sh {patterns}`"


def rows_of(runs, scene):
    return [run for run in runs.all if run.scene == scene and run.has()]


def over_best(runs, costs, scene):
    """By what share auto costs more than the best of all fixed settings that are wanted; None as
    long as one of these is missing, or where the rows are of two encoders."""
    auto = runs.first(scene, "auto")
    wanted = [runs.first(scene, variant) for variant in runs.variants if runs.of(scene, variant)]
    if not all(run.has() for run in wanted) or is_mixed(rows_of(runs, scene)):
        return None
    return costs.of(auto) / costs.of(costs.best_fixed(scene)) - 1


def is_near_best(runs, costs, scene):
    """At most 2 % above, or within the spread that seeds make."""
    spread = costs.spread(scene)
    more = (costs.of(runs.first(scene, "auto")) - costs.of(costs.best_fixed(scene)))
    return (over_best(runs, costs, scene) <= NEAR_BEST
            or spread is not None and more <= spread)


def grid_scenes(runs, costs):
    """Scenes with a grid of fixed settings."""
    return [scene for scene in runs.scenes
            if runs.of(scene, "auto") and len(costs.fixed(scene)) >= 2]


def missed_scenes(runs, costs):
    return [scene for scene in grid_scenes(runs, costs)
            if over_best(runs, costs, scene) is not None and not is_near_best(runs, costs, scene)]


def cost_bar(runs, bars, costs, results):
    """4: cost on every scene with a grid."""
    scenes = grid_scenes(runs, costs)
    over = {scene: over_best(runs, costs, scene) for scene in scenes}
    over = {scene: more for scene, more in over.items() if more is not None}
    missed = missed_scenes(runs, costs)
    mixed = [scene for scene in scenes if is_mixed(rows_of(runs, scene))]
    measured = ""
    if over:
        worst = max(over, key=over.get)
        measured = f"{len(over) - len(missed)} of {len(scenes)} scenes"
        if missed:
            measured += "; not " + ", ".join(f"{scene} {signed(100 * over[scene], 1, ' %')}"
                                             for scene in missed)
        measured += (f"; most: {worst} {signed(100 * over[worst], 1, ' %')}"
                     + mark([run for scene in over for run in rows_of(runs, scene)]))
    if mixed:
        measured += ("; " if measured else "") + f"rows of two encoders: {', '.join(mixed)}"
    bars.add(4, "cost of auto against the best fixed setting",
             "at most 2 % more, or one standard deviation over seeds, on every scene", measured,
             False if missed else True if scenes and len(over) == len(scenes)
             else "?" if scenes and len(over) + len(mixed) == len(scenes) else None,
             command("auto grid"), first_cost(results))


def first_cost(results):
    """The bar of the cost as it first was; its rows are gone."""
    measured, was_met = earlier(results, "cost_six_cameras")
    return First("the same, own scenes with six cameras instead of twelve",
                 measured or "not measured any more", was_met)


def time_bar(runs, bars):
    """4: processor time of auto against that of the options as they are."""
    pairs = [(runs.first(scene, "auto"), runs.first(scene, "whole")) for scene in runs.scenes
             if runs.of(scene, "auto") and runs.of(scene, "whole")]
    there = [pair for pair in pairs if all(run.has() for run in pair)]
    same = [pair for pair in there if not is_mixed(pair)]
    more = {auto.scene: auto.count("cpu_s") / whole.count("cpu_s") - 1 for auto, whole in same}
    worst = max(more, key=more.get, default=None)
    bars.add(4, "training time of auto against the same options fixed, CPU", "at most 25 % more",
             (f"most: {worst} {signed(100 * more[worst], 0, ' %')}"
              + mark([run for pair in same for run in pair])) if more else "",
             False if more and more[worst] > MOST_TIME
             else True if pairs and len(same) == len(pairs)
             else "?" if pairs and len(there) == len(pairs) else None,
             command("'*-auto-1' '*-whole-1'"))


def still_bar(runs, bars, scene):
    """5: a scene without time. It is compared with the smallest fixed file of about auto's quality,
    or better."""
    auto = runs.first(scene, "auto")
    text, ok = "", None
    if auto.has():
        fixed_runs = Costs(runs).fixed(scene)
        equal = [run for run in fixed_runs
                 if run.has() and run.count("psnr") > auto.count("psnr") - EQUAL_PSNR]
        best = min(equal, key=lambda run: run.count("bytes"), default=None)
        text = (f"{temporal(auto):.0f} bytes for time; {auto.text('bytes')} bytes at "
                f"{fixed(auto.number('psnr'), 2)} dB, "
                + ("no fixed setting as good" if best is None else
                   f"{best.variant} {best.text('bytes')} at {fixed(best.number('psnr'), 2)} dB"))
        ok = (temporal(auto) == 0 and auto.count("motion") == 0 and auto.count("activation") == 0
              and (best is None or auto.count("bytes") < best.count("bytes")))
        if ok and not all(run.has() for run in fixed_runs):
            ok = None
        ok, text = of_one_encoder(ok, text, [auto] + fixed_runs)
    bars.add(5, f"{scene}: syntax for time, size",
             f"none; smaller than any fixed setting of equal PSNR ({EQUAL_PSNR} dB)", text, ok,
             command(f"'{scene}-*'"))


def things_bar(bars, costs):
    """6: bytes for time by how many things move, mean over seeds."""
    means = [costs.mean(scene, "auto", temporal) for scene in THINGS]
    known = [value for value in means if value is not None]
    grows = (means[0] in (0, None)
             and all(a < b for a, b in zip(known, known[1:])))
    ok = False if known and not grows else True if len(known) == len(means) else None
    autos = [run for scene in THINGS for run in costs.runs.present(scene, "auto")]
    ok, measured = of_one_encoder(ok, ", ".join(f"{value:.0f}" for value in known), autos)
    bars.add(6, "bytes for time with 0, 1, 2, 4, 8 moving objects, mean over seeds",
             "0 first, then rising", measured, ok,
             command("'things*-auto-*'"), first_things(costs.runs) if ok is not None else None)


def first_things(runs):
    """The bar of things_bar as it first was: of one seed alone. None without all of its rows."""
    autos = [runs.first(scene, "auto") for scene in THINGS]
    if not all(run.has() for run in autos):
        return None
    spent = [temporal(run) for run in autos]
    return First("the same, of seed 1 alone", ", ".join(f"{value:.0f}" for value in spent),
                 spent[0] == 0 and all(a < b for a, b in zip(spent, spent[1:])))


# ---- the sections ----

def model(run):
    """The chosen sizes, as the page explains them."""
    return (f"{run.text('n_offsets')}/{run.text('feature_dim')}/{run.text('phi_dim')}, "
            f"{run.text('bank_rows')}x{run.text('bank_dim')}, "
            f"{run.text('deform_width')}/{run.text('head_width')}, "
            f"{run.text('hyper_layers')}x{run.text('hyper_width')}/"
            f"{run.text('n_slices')}x{run.text('ar_width')}, {run.text('view')}"
            + (", linear" if run.number("scale_domain") == 1 else ""))


def show_scene(runs, page, costs, scene):
    best = costs.best_fixed(scene)
    for variant in runs.variants:
        if not runs.of(scene, variant):
            continue
        run = runs.first(scene, variant)
        if not run.has():
            page.row_missing(scene, variant)
            continue
        cost = costs.of(run)
        against = None
        if best is not None and cost is not None:
            against = 100 * (cost / costs.of(best) - 1)
        page.row(scene, variant + mark([run]), *cells(run, "bytes psnr:2"), fixed(cost, 5),
                 signed(against, 1, " %"), f"{temporal(run):.0f}",
                 *cells(run, "cpu_s:0 trial_steps decode_ms:2"), fixed(weight_bits(run), 0),
                 model(run))


def content_chart(charts, page, costs, name, title, x_label, places):
    """Curves over how much moves, or for how long: for which scenes, at which numbers."""
    plot = Plot()
    for label, variant, colour in (("auto", "auto", "#0072b2"), ("fixed", "whole", "#d55e00")):
        markers = ("circle", "triangle") if variant == "auto" else ("square", "diamond")
        for what, value, marker, dash in (("file", "bytes", markers[0], ""),
                                          ("for time", temporal, markers[1], "7 4")):
            series = plot.series(f"{label}, {what}", colour, marker, dash)
            for scene, place in places.items():
                mean = costs.mean(scene, variant, value)
                series.point(place, None if mean is None else mean / 1000)
    if plot.is_empty():
        return
    with charts.open(name, 460, 360, title) as svg:
        plot.draw(svg, 0, 4, 450, 350, title, x_label, "kB (1000 bytes)",
                  ticks=" ".join(places.values()))
    page.say()
    page.say(f"![{title}]({charts.place}/{name}.svg)")


def content(runs, page, costs, title, scenes):
    page.heading(title)
    page.table("scene", "seeds", "auto: bytes", "of them for time", "anchors that move", "PSNR",
               "whole (seed 1): bytes", "of them for time", "anchors that move", "PSNR")
    for scene in scenes:
        if costs.mean(scene, "auto", "bytes") is None:
            page.row_missing(scene)
            continue
        means = [fixed(costs.mean(scene, variant, value), digits)
                 for variant in ("auto", "whole")
                 for value, digits in (("bytes", 0), (temporal, 0), ("dynamic", 0), ("psnr", 2))]
        page.row(scene + mark(runs.of(scene, "auto") + runs.of(scene, "whole")),
                 str(len(runs.of(scene, "auto"))), *means)
    fine = fine_scenes(runs, scenes)
    if fine:
        page.prose(f"""The files *whole* of {', '.join(fine)} hold weights at full precision (see
            *bits per weight* above).""")


def fine_scenes(runs, scenes):
    """Those of the scenes whose fixed settings have weights at full precision."""
    found = {scene: weight_bits(runs.first(scene, "whole")) for scene in scenes}
    return [scene for scene, bits in found.items() if bits is not None and bits > FINE_BITS]


def show_settings(runs, page):
    """What each setting is, with its options."""
    page.say()
    for variant in runs.variants:
        run = next(run for run in runs.all if run.variant == variant)
        options = own_options(runs, run, ("set", "capacity"))
        page.item(f"*{variant}*: {SETTINGS.get(variant, 'other sizes')}"
                  + (options and f" (`{options}`)"))


def sections(runs, page, costs, charts):
    page.heading("Auto against fixed settings")
    show_settings(runs, page)
    page.prose("""The cost is 0.8 L1 + 0.2 (1 - SSIM) of held-out pictures, plus λ times the bits of
        the file divided by the number of values of all anchors in the scene's `whole` run, so that
        a bit weighs the same in every run of a scene. *For time* counts the bytes of the bank, of
        temporal features and of activations, and the networks' share. *CPU s* are seconds of
        training, trials included; of each scene, one machine trained *auto* and *whole*, which bar
        4 compares, and other settings ran on machines up to three times as fast. *Trials* are the
        steps of those trials that train. *Bits per weight* are those of the networks of
        reconstruction and of the bank in the file. *Model* shows K/F/d, rows x width of the bank,
        widths of F_deform/heads, hyperprior/slices, view. Scenes *things0* to *things8* have that
        many moving objects; *long2* and *long4* are *things4* for twice and four times as long, and
        *rest* is *things4* and as long a rest.""")
    fine = fine_scenes(runs, runs.scenes)
    if fine:
        page.prose(f"""Auto also decides how many bits weights get. So do fixed settings, but only
            where the trials that this takes fit into their budget, which grows with the steps,
            while the time of a trial grows with the frames of the scene. On {', '.join(fine)} they
            did not fit: files of fixed settings hold weights at full precision there, and are
            larger for that reason, too. How much of auto's advantage on these scenes is due to it
            was not measured.""")
    page.table("scene", "setting", "bytes", "PSNR", "cost", "against the best fixed", "for time",
               "CPU s", "trials", "decode ms", "bits per weight", "model")
    for scene in runs.scenes:
        show_scene(runs, page, costs, scene)
    content(runs, page, costs, "Number of moving objects", list(THINGS))
    content_chart(charts, page, costs, "things", "Size by number of moving objects",
                  "moving objects, of eight", THINGS)
    content(runs, page, costs, "Length of the sequence", list(TIMES) + ["rest"])
    content_chart(charts, page, costs, "times", "Size by length of the sequence", "times", TIMES)
