# SPDX-License-Identifier: BSD-2-Clause
"""The computed tables against the printed ones of annex A, and what chapter 9 says about them."""

import pathlib
import re
import unittest

import tables
from floats import f32_patterns
from gaussian import Cumulative

ANNEX = pathlib.Path(__file__).resolve().parents[2] / "spec" / "annex-a-tables.md"


def printed():
    """Table name to its entries: the numbers inside the fences of each section."""
    sections = re.split(r"^## A\.\d+ ", ANNEX.read_text(encoding="utf-8"), flags=re.M)[1:]
    number = re.compile(r"-?\b(?:0x[0-9a-fA-F]+|\d+)\b")
    return {re.match(r"\w+", section).group():
            [int(digits, 0) for digits in number.findall(section.split("```")[1])]
            for section in sections}


class Tables(unittest.TestCase):
    @unittest.skipUnless(ANNEX.exists(), "the specification is not there")
    def test_annex_a(self):
        annex = printed()
        self.assertEqual({"HALF": 240, "INV": 240, "PHI": 1025, "SIN": 1025, "STEP": 256,
                          "STEPI": 256}, {name: len(t) for name, t in annex.items()})
        for name, entries in annex.items():
            computed = f32_patterns(tables.STEP) if name == "STEP" else getattr(tables, name)
            self.assertEqual(entries, list(computed), name)

    def test_model_is_increasing_for_every_sigma(self):
        for g in range(240):
            for fr in (0, 1, 127, 128, 255) if tables.HALF[g] < 200 else (g,):
                table = Cumulative(g, fr)
                values = [table[j] for j in range(len(table))]
                self.assertEqual((0, 65536), (values[0], values[-1]))
                self.assertTrue(all(a < b for a, b in zip(values, values[1:])), (g, fr))

    def test_products_of_the_model_fit_32_bits(self):
        for half, inverse in zip(tables.HALF, tables.INV):
            self.assertLess((256 * (half + 2) - 128) * inverse, 1 << 31)
            self.assertLess((256 * half + 128 + 255) * inverse, 1 << 31)


if __name__ == "__main__":
    unittest.main()
