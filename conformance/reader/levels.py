# SPDX-License-Identifier: BSD-2-Clause
"""The bounds of chapter 13."""

from collections import namedtuple

from verdict import require

Level = namedtuple("Level", "anchors offsets frames values products file_bytes symbols_per_byte")

NONE = float("inf")                 # level 31: no bound of the format
LEVELS = {1: Level(1 << 14, 10, 64, 1 << 18, 1 << 16, 1 << 22, 256),
          2: Level(1 << 16, 10, 600, 1 << 20, 1 << 16, 1 << 24, 256),
          3: Level(1 << 18, 16, 3600, 1 << 22, 1 << 17, 1 << 26, 512),
          4: Level(1 << 20, 16, 36000, 1 << 24, 1 << 18, 1 << 28, 512),
          31: Level(NONE, NONE, NONE, NONE, NONE, NONE, NONE)}


def check_totals(level, values, products, symbols, file_bytes, offset):
    """R-LVL-001 for the bounds that no single element breaks; `offset` is that of `reserved` of
    HEAD (chapter 14)."""
    bound = LEVELS[level]
    require(values <= bound.values, "lvl.exceeded", offset)
    require(products <= bound.products, "lvl.exceeded", offset)
    require(symbols <= bound.symbols_per_byte * file_bytes, "lvl.exceeded", offset)
