# SPDX-License-Identifier: BSD-2-Clause
"""Pass 1 (5.3, R-CON-010): file header, file size, chunk frames, hashes and order. Payloads are not
parsed."""

from collections import namedtuple

from levels import LEVELS
from verdict import Refusal, require
from xxh3 import xxh3_64

MAGIC = b"\x89TED4\r\n\x1a"
FILE_HEADER = 12                    # bytes of 5.1
FRAME = 12                          # type, flags, size
CRITICAL, SAFE_TO_COPY = 1, 2

# What may follow what (R-CON-003); ancillary chunks may stand anywhere after HEAD.
FOLLOWS = {None: ("HEAD",), "HEAD": ("NETE",), "NETE": ("NETR",), "NETR": ("BANK", "POSN"),
           "BANK": ("POSN",),
           "POSN": ("TILE",), "TILE": ("TILE", "ENDS")}
KNOWN = ("HEAD", "NETE", "NETR", "BANK", "POSN", "TILE", "ENDS")

# start: offset of the type; payload is data[begin:end].
Chunk = namedtuple("Chunk", "type start begin end")


def pass_one(data):
    """The level and the list of chunks of a file whose container is valid."""
    level = file_header(data)
    chunks, last, at = [], None, FILE_HEADER
    while last != "ENDS":
        chunk = frame(data, at)
        if judge(data, chunk, last):
            last = chunk.type
        chunks.append(chunk)
        at = chunk.end + 8
    require(at == len(data), "con.trailing", at)                        # R-CON-005
    return level, chunks


def file_header(data):
    """5.1, R-CON-001; each element is judged if its bytes are present. Then the file size; if it
    exceeds its bound, the error is at `level`."""
    require(len(data) >= 8, "con.truncated", len(data))
    require(data[:8] == MAGIC, "con.magic", 0)
    require(len(data) > 8, "con.truncated", len(data))
    require(data[8] == 1, "con.version", 8)
    require(len(data) > 10, "con.truncated", len(data))                 # any minor
    require(data[10] <= 1, "unsupported.profile", 10)
    require(len(data) > 11, "con.truncated", len(data))
    require(data[11] in LEVELS, "con.level", 11)
    require(len(data) <= LEVELS[data[11]].file_bytes, "lvl.exceeded", 11)
    return data[11]


def frame(data, at):
    """The chunk at `at`, if it lies in the file and its hash is right (R-CON-002)."""
    require(len(data) - at >= FRAME, "con.truncated", len(data))
    begin = at + FRAME
    end = begin + int.from_bytes(data[at + 8:at + 12], "little")
    require(len(data) - end >= 8, "con.truncated", len(data))
    require(xxh3_64(data[at:end]) == int.from_bytes(data[end:end + 8], "little"),
            "con.chunk-hash", at)
    return Chunk(data[at:at + 4].decode("latin-1"), at, begin, end)


def judge(data, chunk, last):
    """Type, order, flags, criticality, in this order (chapter 14). Returns whether it is one of the
    known chunks."""
    for i in range(4):
        byte = data[chunk.start + i:chunk.start + i + 1]
        require(byte.isalnum(), "con.reserved", chunk.start)  # bytes.isalnum is ASCII only
    known = chunk.type in KNOWN
    require(chunk.type in FOLLOWS[last] if known else last is not None, "con.chunk-order",
            chunk.start)
    flags = int.from_bytes(data[chunk.start + 4:chunk.start + 8], "little")
    if known:
        require(flags == CRITICAL, "con.reserved", chunk.start + 4)
    else:
        require(flags <= CRITICAL + SAFE_TO_COPY, "con.reserved", chunk.start + 4)
        require(not flags & CRITICAL, "con.unknown-critical", chunk.start)
    return known


def walk_chunks(chunks, has_bank, n_tiles):
    """The chunks in order, for pass 2, which judges what depends on HEAD (R-CON-010): whether BANK
    is present, and the number of TILE. The walk ends with con.chunk-order at the first known chunk
    that stands where another should.
    """
    tiles = 0
    for chunk in chunks:
        wrong = (chunk.type == "BANK" and not has_bank
                 or chunk.type == "POSN" and has_bank and not any(c.type == "BANK" for c in chunks)
                 or chunk.type == "TILE" and tiles == n_tiles
                 or chunk.type == "ENDS" and tiles < n_tiles)
        if wrong:
            raise Refusal("con.chunk-order", chunk.start)
        tiles += chunk.type == "TILE"
        yield chunk
