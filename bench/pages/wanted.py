"""The runs that a table wants: bench/sweep.txt, stability.txt, capacity.txt, zoo.txt, bd_rate.txt.

The options of a run come out once each, the last value of a name winning, in the order in which
the names first come.
SPDX-License-Identifier: BSD-2-Clause"""
import re
import sys

OPTIONS = "ref-encoder/train/model/options.def"
WITH_VALUE = re.compile(r"--(preset|capacity|lambda|seed|downscale|alpha|hold-out)$")
EXPECTED = "lambdas or seeds (one of them, once), base, scene, case, group or run expected"


class Run:
    """One training that the table wants, and later its row (rows.py).

    place: of the lambda, or of the seed, in its list, from 1. stage1: the options that decide
    stage 1, without those that only stage 2 looks at."""

    def __init__(self, tag, groups="", scene="", where="", variant=""):
        self.tag, self.groups, self.scene = tag, groups, scene
        self.where, self.variant = where, variant
        self.place = self.weight = self.keep = self.stage1 = self.options = ""
        self.state, self.row = "missing", None

    def line(self):
        return "|".join((self.groups, self.tag, self.scene, self.where, self.variant, self.place,
                         self.weight, self.keep, self.stage1, self.options))


class Options:
    """Options of ted4enc as a list of (name, value), where a later value replaces an earlier."""

    def __init__(self, fail):
        self.value = {}
        self.fail = fail

    def take(self, text):
        words = iter(text.split())
        for name in words:
            if "," in name or "|" in name:
                self.fail(f"no commas in options: {name}")
            if name == "--set":
                setting = next(words, "")
                if setting.count("=") != 1:
                    self.fail(f"--set {setting}: NAME=VALUE expected")
                name, value = setting.split("=")
                self.value[f"--set {name}="] = value
            elif WITH_VALUE.match(name):
                self.value[name + " "] = next(words, "")
            elif name == "--black":
                self.value[name] = ""
            else:
                self.fail(f"option {name} not expected here")

    def text(self, chosen=lambda name: True):
        return " ".join(name + value for name, value in self.value.items() if chosen(name))


def read_stages(path):
    """The first stage that looks at each option, from lines TED4_OPTION(kind, stage, name, ...).
    An option that is not there counts as one of stage 1; ted4enc will refuse it."""
    stages = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("TED4_OPTION("):
                part = re.split(r"[(,][ \t]*", line)
                stages[part[3]] = int(part[2]) if part[2].isdigit() else 0
    if stages.get("lambda") != 2:
        sys.exit(f"{path}: not understood")
    return stages


class Table:
    """Reads a table of wanted runs into self.runs, as objects of the class kind. A fault in it
    ends the program."""

    def __init__(self, path, stages, kind):
        self.path, self.stages, self.kind, self.number = path, stages, kind, 0
        self.places, self.place_option, self.base = [], "", ""
        self.where, self.scene_options, self.more_groups = {}, {}, {}
        self.runs, self.tags = [], set()
        with open(path, encoding="utf-8") as file:
            for line in file:
                self.number += 1
                self.read(line.split("#")[0].strip())

    def fail(self, why):
        sys.exit(f"{self.path}:{self.number}: {why}")

    def read(self, line):
        word = line.split()
        if not word:
            return
        if word[0] == "case" and len(word) >= 4:
            del word[2]
            word[0] = "scene"
        if word[0] in ("lambdas", "seeds") and not self.places:
            self.place_option = "--lambda" if word[0] == "lambdas" else "--seed"
            self.places = word[1:]
        elif word[0] == "base":
            self.base = " ".join(word[1:])
        elif word[0] == "scene" and len(word) >= 3:
            self.where[word[1]] = word[2]
            self.scene_options[word[1]] = " ".join(word[3:])
        elif word[0] == "group" and len(word) == 3:
            for scene in word[2].split(","):
                self.more_groups[scene] = self.more_groups.get(scene, "") + "+" + word[1]
        elif word[0] == "run" and len(word) >= 6:
            scenes = list(self.where) if word[3] == "all" else word[3].split(",")
            for scene in scenes:
                for place in word[4].split(","):
                    self.add(word[1], scene, word[2], place, word[5], " ".join(word[6:]))
        else:
            self.fail(EXPECTED)

    def add(self, groups, scene, variant, place, keep, options):
        if scene not in self.where:
            self.fail(f"scene {scene}: not in the table above")
        if not place.isdigit() or not 1 <= int(place) <= len(self.places):
            self.fail(f"place {place}: there are {len(self.places)}")
        tag = f"{scene}-{variant}-{place}"
        if tag in self.tags:
            self.fail(f"{tag}: already in the table")
        self.tags.add(tag)
        base = self.base
        if "--preset " in options:
            base = re.sub(r"--set [^ ]+", "", base)
        all_options = Options(self.fail)
        all_options.take(f"{base} {self.scene_options[scene]} {self.place_option} "
                         f"{self.places[int(place) - 1]} {options}")
        run = self.kind(tag, groups + self.more_groups.get(scene, ""), scene, self.where[scene],
                        variant)
        run.place, run.keep = place, keep
        run.weight = all_options.value.get("--lambda ", "")
        run.stage1, run.options = all_options.text(self.decides_stage1), all_options.text()
        self.runs.append(run)

    def decides_stage1(self, name):
        if name in ("--lambda ", "--capacity "):
            return False
        return not name.startswith("--set ") or self.stages.get(name[6:-1], 0) < 2


def read_table(path, kind=Run):
    """The wanted runs of a table, in its order, as objects of that class."""
    return Table(path, read_stages(OPTIONS), kind).runs
