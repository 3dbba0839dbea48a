"""Tables of what the stability lab trains beside its scenes and variants: other initial points,
single parts left out, other cameras.
SPDX-License-Identifier: BSD-2-Clause"""
from .compare import is_mixed
from .rows import mark
from .stability_tables import quality_cell
from .words import fixed, signed


def points_section(lab):
    """Scenes SCENE_sfm, of the group sfm, beside SCENE."""
    page, runs = lab.page, lab.runs
    wanted = [scene for scene in runs.scenes if runs.wants(scene, "whole", "sfm")]
    if not wanted:
        return
    page.heading("Initial points as structure from motion gives them")
    page.prose("""The initial points of the lab's scenes lie on true surfaces, of moving objects
        too, at all times, and have true colours. Here the same scenes begin with a quarter as many
        points (`--points sfm`), which lie only on what never moves, are less exact in depth, and
        have the tint of the camera that sees them. The table shows PSNR in dB of the whole method:
        mean of all held-out pictures / worst of all, as means over seeds.""")
    page.table("scene", "on surfaces", "as structure from motion", "difference of the mean")
    for scene in wanted:
        plain = lab.cell(scene.removesuffix("_sfm"), "whole")
        cell = lab.cell(scene, "whole")
        if plain.mean("psnr") is None or cell.mean("psnr") is None:
            page.row_missing(plain.scene)
            continue
        page.row(plain.scene, *(fixed(one.mean("psnr"), 2) + " / " + fixed(one.mean("worst"), 2)
                                + mark(one.wanted) for one in (plain, cell)),
                 "-" if is_mixed(cell.there + plain.there)
                 else signed(cell.mean("psnr") - plain.mean("psnr"), 2))


def paired(cell, other_cell):
    """The runs of two cells that have the same seed, sources of the same kind, and ended with a
    file: [(one, other)]."""
    pairs = [(run, other) for run in cell.there for other in other_cell.there
             if run.place == other.place]
    return [pair for pair in pairs
            if all(run.text("status") == "fine" for run in pair) and not is_mixed(pair)]


def difference_cell(cell, other_cell):
    """How much better a cell is than another, and how much larger, over the seeds of both."""
    pairs = paired(cell, other_cell)
    if not pairs:
        return "-"
    psnr = sum(a.number("psnr") - b.number("psnr") for a, b in pairs) / len(pairs)
    size = sum(a.number("bytes") / b.number("bytes") - 1 for a, b in pairs) / len(pairs)
    return (f"{signed(psnr, 2)}; {signed(100 * size, 1, ' %')}"
            + mark(cell.there + other_cell.there)
            + (f" ({len(pairs)} of {len(cell.wanted)})" if len(pairs) < len(cell.wanted) else ""))


def parts_section(lab):
    """Variants of the group parts beside the whole method."""
    page, runs = lab.page, lab.runs
    variants = [variant for variant in runs.variants
                if any(runs.wants(scene, variant, "parts") for scene in lab.scenes)]
    if not variants:
        return
    page.heading("Without what was made for real captures")
    page.prose("""Each variant lacks one part: *nodropout* the dropout of anchors, *noposes* the
        refinement of poses, *noclosing* the rule that stops anchors whose motion is not worth its
        bits. The table shows the PSNR of the whole method in dB, and by how much each variant
        differs from it in PSNR (dB) and in bytes, as means over seeds.""")
    page.table("scene", "whole", *variants)
    for scene in lab.scenes:
        whole = lab.cell(scene, "whole")
        page.row(scene, fixed(whole.mean("psnr"), 2) + mark(whole.wanted),
                 *(difference_cell(lab.cell(scene, variant), whole) for variant in variants))


def colours_section(lab):
    """Scenes of the groups colours and turns, with all their variants."""
    page, runs = lab.page, lab.runs
    wanted = [lab.cell(scene, variant) for scene in runs.scenes for variant in runs.variants
              if any(runs.wants(scene, variant, group) for group in ("colours", "turns"))]
    if not wanted:
        return
    page.heading("Colours, exposures, and cameras that take turns")
    page.prose("""*dusk0* is *dusk* without drifting exposures, and *tints40* is *tints4* without
        tints; *nocolour* trains without any correction of colours. *tints4* is judged by
        held-out times of its own cameras, as they are: a file has one look, so that correction
        makes pictures of cameras that differ in colour worse ([limits](../doc/limits.md)). *relay*
        has cameras that take turns. The table shows PSNR in dB as above.""")
    page.table("scene", "variant", "PSNR", "bytes")
    for cell in wanted:
        page.row(cell.scene, cell.variant, quality_cell(cell), fixed(cell.mean("bytes"), 0))
