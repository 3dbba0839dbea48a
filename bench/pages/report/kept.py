"""What other pages measured, bench/{raster,render,train,memory}.md: bars 8 and 9, and the links.
SPDX-License-Identifier: BSD-2-Clause"""
import re

from ..words import fixed


def page_lines(report, name):
    """Lines of a page; none when it is not there."""
    try:
        with open(f"{report.pages}/{name}", encoding="utf-8") as file:
            return file.read().splitlines()
    except FileNotFoundError:
        return []


def number_after(line, word):
    """The number that follows a word in a line, over spaces and brackets; None without."""
    found = re.match(r"[ (]*([0-9][0-9.]*)", line.partition(word)[2])
    return float(found[1]) if found else None


def machine_of(lines):
    """The line of a page that tells the machine: the one after "$ make ..."."""
    return next((b for a, b in zip(lines, lines[1:]) if a.startswith("$ make ")), "")


def section(report):
    page = report.tables
    page.heading("Speed and memory")
    page.prose("""These numbers were measured separately, on the machine that each page names.""")
    page.table("page", "what", "result", "command")
    raster_row(report)
    render_row(report)
    train_row(report)
    memory_row(report)


def raster_times(report):
    """Milliseconds forward and backward for 100,000 Gaussians with two threads, and how much faster
    these are than one; None where the page does not tell."""
    here, both, faster = False, None, None
    for line in page_lines(report, "raster.md"):
        if "Gaussians, 480x270" in line:
            here = line.startswith("100000 ")
        if here and re.match(" *the first, 2 threads ", line):
            both = number_after(line, " both ")
        if here and "speed-up by 2 threads" in line:
            faster = number_after(line, "2 threads")
    return both, faster


def raster_row(report):
    both, faster = raster_times(report)
    text, ok, short = "", None, "not run yet"
    if both is not None and faster is not None:
        short = f"{both:.1f} ms, {faster:.2f}x of one thread"
        text = (f"{both:.1f} ms; {faster:.2f}x; bits equal: asserted by "
                "`tests/decoder/test_raster.c`, `tests/encoder/test_raster_grad.c` (`make test`); "
                + machine_of(page_lines(report, "raster.md")))
        ok = both <= 20 and faster >= 1.8
    report.bars.add(8, "forward plus backward, 100,000 Gaussians, 480x270, two cores",
                    "at most 20 ms (aim 12); 1 to 2 threads at least 1.8x; bits equal", text, ok,
                    "`make bench-raster`: [raster.md](raster.md)")
    report.tables.row("[raster.md](raster.md)", "rasteriser, forward and backward, 100,000 "
                      "Gaussians, 2 threads", short, "`make bench-raster`")


def render_speeds(report):
    """(preset, median, best) frames per second with two threads and the fastest kernels, which come
    first of each preset."""
    found, preset, is_first = [], "", False
    for line in page_lines(report, "render.md"):
        if line.startswith("preset "):
            preset, is_first = line[len("preset "):].split(":")[0], True
        if ", 2 threads " not in line or not is_first:
            continue
        is_first = False
        best = number_after(line.partition("best")[2], "=")
        median = number_after(line.partition("median")[2], "=")
        if best is not None and median is not None:
            found.append((preset, median, best))
    return found


def render_row(report):
    """The slowest preset's median decides."""
    speeds = render_speeds(report)
    text = "; ".join(f"preset {preset}: {median:.1f} frames/s (best {best:.1f})"
                     for preset, median, best in speeds)
    report.bars.add(9, "100,000 visible Gaussians at 960x536, deformation and heads included, two "
                    "cores", "at least 30 frames/s (aim 73)",
                    text and f"{text}; {machine_of(page_lines(report, 'render.md'))}",
                    min(speed[1] for speed in speeds) >= 30 if speeds else None,
                    "`make bench-render`: [render.md](render.md)")
    report.tables.row("[render.md](render.md)", "rendering a decoded scene, everything new in each "
                      "frame, 2 threads, medians", text or "not run yet", "`make bench-render`")


def train_row(report):
    stage, texts = "", []
    for line in page_lines(report, "train.md"):
        if re.search(": [0-9]+ anchors, ", line):
            stage = line.split(":")[0]
        if re.match(" *a step ", line):
            part = line.split()
            texts.append(f"{stage}: {part[4]} ms per step, {part[6]}x of one thread")
    report.tables.row("[train.md](train.md)", "a training step by its parts, 2 threads",
                      "; ".join(texts) or "not run yet", "`make bench-train`")


def memory_row(report):
    lines = page_lines(report, "memory.md")
    peaks = []
    for line in lines:
        found = line.split("|")
        if len(found) >= 7 and re.match(" *[1-9]", found[5]):
            peaks.append(float(found[5]))
    report.tables.row("[memory.md](memory.md)" if lines else "memory.md",
                      "300 frames of 20 cameras at 1352x1014 in 8 GB",
                      f"peak {fixed(max(peaks), 0)} MiB in {len(peaks)} trainings" if peaks
                      else "not run yet", "`make bench-memory`")
