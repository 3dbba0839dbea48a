"""Comparisons of a few runs: medium preset, tinted cameras, scenes without motion: bars 2, 3, 4.
SPDX-License-Identifier: BSD-2-Clause"""
from ..bars import DELIVERED, First
from ..compare import is_mixed
from ..rows import mark
from ..words import cells, counted, fixed, signed
from .context import sweep


def short_table(page, *runs):
    page.table("run", "λ", "PSNR dB", "SSIM", "bytes", "training s", "jobs x threads")
    for run in runs:
        if run.has():
            page.row(run.name(), run.weight, *cells(run, "psnr:2 ssim:4 bytes train_s:0 team"))
        else:
            page.row_missing(run.tag, run.weight)


def medium_section(report):
    run = report.runs.find("kitchen_full-medium-1")
    page = report.tables
    page.heading("Medium preset, every pixel")
    page.prose("""Times are of training steps, probe and checkpoints; they leave out the first look
        at the scene, previews and coding.""")
    short_table(page, run)
    measured, ok = "", None
    if run.has():
        ok = (run.count("psnr") >= 27 and run.count("bytes") <= 1.5e6
              and run.count("train_s") <= 3600
              and run.count("jobs") * run.count("threads") <= 2)
        measured = (f"{fixed(run.count('train_s') / 60, 1)} min of steps by "
                    f"{counted(int(run.count('threads')), 'thread')}; "
                    f"{fixed(run.number('psnr'), 2)} dB; {fixed(run.count('bytes') / 1e6, 2)} MB"
                    f"{mark([run])}; what limits it: [notes](report.md#notes)")
    report.bars.add(2, "kitchen at full size, `--preset medium`, highest rate, two cores",
                    "60 minutes; 27 dB (aim 30); 1.5 MB", measured, ok, sweep("medium"))


def tint_section(report):
    page = report.tables
    page.heading("Cameras whose colours differ")
    page.prose("""`kitchen_tint` is `kitchen` with a colour bias per camera and the held-out camera
        untouched; both are at 240x135. Its pictures are JPEG and those of `kitchen` are not, so
        that the held-out pictures of the two differ. *tint_by_kitchen* is therefore trained on
        `kitchen` and judged, like the others, by the held-out pictures of `kitchen_tint`;
        *kitchen-fast-2* is the same training judged by those of `kitchen`.""")
    with_it, without, by_tint, plain = (report.runs.find(tag) for tag in (
        "tint-colour-2", "tint-nocolour-2", "tint_by_kitchen-fast-2", "kitchen-fast-2"))
    short_table(page, with_it, without, by_tint, plain)
    gain, loss = difference(with_it, without), difference(with_it, by_tint)
    report.bars.add(3, "kitchen_tint with colour correction against without",
                    "at least 1 dB better",
                    "" if gain is None else signed(gain, 2, " dB") + mark([with_it, without]),
                    None if gain is None else gain >= 1, sweep("tint"))
    measured, own = "", difference(with_it, plain)
    if loss is not None:
        measured = signed(loss, 2, " dB") + mark([with_it, by_tint])
    report.bars.add(3, "kitchen_tint with colour correction against kitchen, both judged by the "
                    "held-out pictures of kitchen_tint", "within 0.5 dB", measured,
                    None if loss is None else loss >= -0.5, sweep("tint kitchen-fast-2"),
                    None if own is None else First(
                        "each scene judged by its own held-out pictures, within 0.5 dB",
                        signed(own, 2, " dB") + mark([with_it, plain]), own >= -0.5))


def difference(run, other):
    """Of PSNR, dB; None where one is missing, or the present sources made only one of them."""
    both = run.has() and other.has() and not is_mixed([run, other])
    return run.count("psnr") - other.count("psnr") if both else None


def still_section(report):
    page, runs = report.tables, report.runs
    page.heading("Scenes in which nothing moves")
    page.prose("""*static* is the same encoder with time compiled out (`--set motion=0 --set
        activation=0`). The table shows the bytes of the bank, of temporal features φ and of
        activations τ, and whether the header announces a temporal mask.""")
    page.table("run", "PSNR dB", "bytes", "bank", "φ", "τ", "temporal mask", "against static")
    pairs = [(scene, runs.find(scene + "-whole-2"), runs.find(scene + "-static-2"))
             for scene in ("still", "chair")]
    for _, whole, static in pairs:
        still_row(page, whole, static)
        still_row(page, static)
    spent = [(scene, run) for scene, run, _ in pairs if run.has()]
    both = [(scene, rate_against(whole, static), mark([whole, static]))
            for scene, whole, static in pairs
            if whole.has() and static.has() and not is_mixed([whole, static])]
    report.bars.add(4, "still and chair: bank, temporal feature, activation, temporal mask",
                    "not one byte", "; ".join(
                        f"{scene}: {for_time(run):.0f} bytes"
                        + (", a temporal mask" if run.count("temporal_mask") else "")
                        + mark([run]) for scene, run in spent),
                    verdict([for_time(run) == 0 and not run.count("temporal_mask")
                             for _, run in spent if run.text("b_bank")]), sweep("still"))
    is_same = len(both) == 2 and all(rate == 0 for _, rate, _ in both)
    report.bars.add(4, "still and chair: rate against time compiled out", "within 2 %",
                    "; ".join(f"{scene}: {signed(rate, 2, ' %')}{old}"
                              for scene, rate, old in both)
                    + ("; the same training: where the probe finds no motion, it begins again "
                       "without time" if is_same else ""),
                    DELIVERED if is_same else verdict([abs(rate) <= 2 for _, rate, _ in both]),
                    sweep("still"))


def verdict(met):
    """Of both scenes; None while one is missing and none has missed."""
    return False if False in met else True if len(met) == 2 else None


def for_time(run):
    return run.count("b_bank") + run.count("b_phi") + run.count("b_tau")


def rate_against(run, other):
    """Percent; None where the present sources made only one of them."""
    if is_mixed([run, other]):
        return None
    return 100 * (run.count("bytes") / other.count("bytes") - 1)


def still_row(page, run, other=None):
    """other: the run to compare with."""
    if not run.has():
        page.row_missing(run.tag)
        return
    against = ""
    if other is not None and other.has():
        against = (signed(rate_against(run, other), 2, " %") + ", "
                   + signed(difference(run, other), 2, " dB"))
    page.row(run.name(), *cells(run, "psnr:2 bytes b_bank b_phi b_tau"),
             "yes" if run.count("temporal_mask") else "no", against)
