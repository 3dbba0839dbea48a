"""Initial points as structure from motion gives them: scenes SCENE_sfm beside SCENE.
SPDX-License-Identifier: BSD-2-Clause"""
from ..words import cells, signed
from .singles import difference


def section(report):
    page, runs = report.tables, report.runs
    wanted = [run for run in runs.all if run.in_group("sfm")]
    if not wanted:
        return
    page.heading("Initial points as structure from motion gives them")
    page.prose("""The initial points of made scenes lie on true surfaces, of moving objects too, at
        all times, and have true colours. Scenes *_sfm* begin with a quarter as many (`ted4scene
        --points sfm`), which lie only on what never moves, are less exact in depth, and have the
        tint of the camera that sees them. *recipe* is explained under [one thing
        changed](#one-thing-changed).""")
    page.table("run", "PSNR dB", "bytes", "on surfaces", "PSNR dB", "bytes", "difference")
    for run in wanted:
        plain = runs.find(run.tag.replace("_sfm-", "-"))
        if run.has() and plain.has():
            page.row(run.name(), *cells(run, "psnr:2 bytes"), plain.name(),
                     *cells(plain, "psnr:2 bytes"), signed(difference(run, plain), 2, " dB"))
        else:
            page.row_missing(run.tag)
