# SPDX-License-Identifier: BSD-2-Clause
"""Verdicts of chapter 14: a byte string is valid, or one Refusal says why it is not."""


class Refusal(Exception):
    """The one error that is reported: an identifier of 14.3 and a byte offset (None for limits)."""

    def __init__(self, error, offset=None):
        super().__init__(error, offset)
        self.error = error
        self.offset = offset

    @property
    def result(self):
        """invalid, limit or unsupported, from the first word of the identifier (chapter 14)."""
        word = self.error.split(".")[0]
        return word if word in ("limit", "unsupported") else "invalid"


def require(holds, error, offset):
    """The rule behind `error`, judged at `offset`."""
    if not holds:
        raise Refusal(error, offset)
