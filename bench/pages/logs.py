"""Logs of trainings: the JSON lines that `ted4enc --log FILE` writes.
SPDX-License-Identifier: BSD-2-Clause"""
import json


def read_lines(path, number=float):
    """Whole lines of a log as dictionaries; none without the file. A kill may leave half a line.
    number: what becomes of the text of a number."""
    lines = []
    try:
        with open(path, encoding="utf-8") as file:
            for text in file:
                try:
                    lines.append(json.loads(text, parse_float=number, parse_int=number))
                except ValueError:
                    continue
    except FileNotFoundError:
        pass
    return lines


def read_steps(path, number=float):
    """The lines that tell of a step, without those of an event (what the monitor has found, trials
    of smaller models)."""
    return [line for line in read_lines(path, number) if "step" in line and "event" not in line]


def training_times(paths):
    """wall, stage 1's wall, cpu, stage 1's cpu of a whole training, in seconds, from its logs:
    stage 1's, then the run's own. They include what the trainer threw away itself (a new beginning,
    a rollback), and leave out what a kill lost."""
    wall = first_wall = cpu = first_cpu = 0
    for path in paths:
        before = cpu    # seconds count from step 0 in every log, those of processors from its start
        for line in read_steps(path):
            wall, cpu = line["seconds"], before + line["cpu_seconds"]
            if line["stage"] == "1":
                first_wall, first_cpu = wall, cpu
    return wall, first_wall, cpu, first_cpu


def thinned(paths, most):
    """At most about that many of the lines of a training, as JSON with seconds from its beginning;
    numbers keep their text, but for seconds with one digit."""
    lines = [line for path in paths for line in read_steps(path, number=str)]
    each = max(1, -(-len(lines) // most))
    found = []
    for i, line in enumerate(lines, 1):
        if i % each == 0 or i == len(lines):
            cells = [f'"{name}":{line.get(name) or "null"}'
                     for name in ("loss", "psnr", "anchors", "bytes")]
            found.append(f'{{"step":{line["step"]},"stage":"{line["stage"]}",' + ",".join(cells)
                         + f',"seconds":{float(line["seconds"]):.1f}}}')
    return found


def predicted(path, whole):
    """What the log of a training of so many seconds predicted: the smallest and the largest
    estimate of its time, from a tenth of it on, as parts of that time; and the last PSNR and bytes.
    As text; "" where it is not known."""
    parts, psnr, size = [], "", ""
    for line in read_lines(path, number=str):
        if "left" not in line:
            continue
        psnr, size = line.get("psnr") or "", line.get("bytes") or ""
        now, left = float(line["seconds"]), float(line["left"])
        if now >= whole / 10 and left >= 0:
            parts.append((now + left) / whole)
    low, high = (f"{min(parts):.3f}", f"{max(parts):.3f}") if parts else ("", "")
    return low, high, psnr, size
