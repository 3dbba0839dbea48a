# ted4.py - TED4 files in Python, as numpy arrays, by the shared library libted4dec.so.1.
#
#     import ted4
#     scene = ted4.Scene.open("scene.ted4")
#     g = scene.frame(10, camera=(0, 0, -4))
#     g.mean.shape                                  # (number of Gaussians, 3)
#
# TED4_LIBRARY names the library; without it, the system finds it. One file; depends on numpy.
# SPDX-License-Identifier: BSD-2-Clause
"""Decoder of TED4, compressed dynamic scenes of 3D Gaussians."""
import ctypes as c
import operator
import os
import threading
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

_u32, _f32 = c.c_uint32, c.c_float
_DEN_END = 1 << 24  # of the denominators of queries
MOTION = ("none", "bank", "concat", "inr")
VIEW = ("none", "colour", "full")


class _Error(c.Structure):
    _fields_ = [("code", c.c_int), ("offset", c.c_size_t)]


class _Allocator(c.Structure):
    _fields_ = [("alloc", c.c_void_p), ("free", c.c_void_p), ("user", c.c_void_p)]


class _Options(c.Structure):
    _fields_ = [("allocator", _Allocator), ("parallel", c.c_void_p), ("max_bytes", c.c_uint64),
                ("max_work", c.c_uint64), ("trace", c.c_void_p), ("trace_user", c.c_void_p)]


class _Info(c.Structure):
    _fields_ = [("n_anchors", _u32), ("n_offsets", _u32), ("frames", _u32), ("rate_num", _u32),
                ("rate_den", _u32), ("n_gaussians", c.c_size_t), ("n_dynamic", _u32),
                ("level", c.c_int), ("view", c.c_int), ("motion", c.c_int),
                ("activation", c.c_int), ("origin", _f32 * 3), ("exponent", c.c_int),
                ("background", c.c_uint8 * 3), ("hash", c.c_uint8 * 16)]


class _Query(c.Structure):
    _fields_ = [("num", _u32), ("den", _u32), ("camera", _f32 * 3)]


class _Gaussians(c.Structure):
    _fields_ = [("n", c.c_size_t), ("mean", c.POINTER(_f32) * 3), ("scale", c.POINTER(_f32) * 3),
                ("rot", c.POINTER(_f32) * 4), ("opacity", c.POINTER(_f32)),
                ("colour", c.POINTER(_f32) * 3), ("id", c.POINTER(_u32))]


def _load():
    library = c.CDLL(os.environ.get("TED4_LIBRARY") or "libted4dec.so.1")
    for name in ("id", "section", "text"):
        getattr(library, f"ted4_status_{name}").restype = c.c_char_p
    library.ted4_verdict_name.restype = c.c_char_p
    for name in ("ted4_scene_free", "ted4_recon_free", "ted4_scene_info", "ted4_gaussians_hash"):
        getattr(library, name).restype = None
    return library


_library = _load()


class Ted4Error(ValueError):
    """Why a file, or a query, is refused: verdict, id (spec 14), offset in bytes or None, section,
    text."""

    def __init__(self, code, offset=None):
        self._code = code
        self.verdict = _library.ted4_verdict_name(_library.ted4_status_verdict(code)).decode()
        self.id, self.section, self.text = (
            getattr(_library, f"ted4_status_{name}")(code).decode()
            for name in ("id", "section", "text"))
        self.offset = offset if self.verdict in ("invalid", "unsupported") else None
        where = "" if self.offset is None else f" at byte {self.offset}"
        super().__init__(f"{self.id}{where}: {self.text}")

    def __reduce__(self):
        # Other processes make it again by the code: an exception alone would keep only its text.
        return type(self), (self._code, self.offset), self.__dict__


@dataclass(frozen=True, eq=False)  # arrays have no one answer to ==
class Gaussians:
    """The Gaussians of one time: binary32 arrays of n rows. World axes are those of the scene;
    scales are standard deviations; rotations are w, x, y, z; colours are display-referred sRGB."""
    mean: np.ndarray        # (n, 3)
    scale: np.ndarray       # (n, 3)
    rotation: np.ndarray    # (n, 4)
    opacity: np.ndarray     # (n,)
    colour: np.ndarray      # (n, 3)
    id: np.ndarray          # (n,) unsigned: anchor * offsets + offset, the same at all times
    hash: str               # XXH3-128 of the records (spec 15.3), hexadecimal

    def __len__(self):
        return len(self.opacity)

    def records(self):
        """(n, 14): the records of spec 11.6, as `ted4dec -o x.raw --keep-all` writes them."""
        return np.column_stack((self.mean, self.scale, self.rotation, self.opacity, self.colour))


class Scene:
    """A decoded file. Threads may share it; their queries are answered one after another. For
    queries at the same time, each thread opens a Scene of its own."""

    def __init__(self, data, max_bytes=0, max_work=0):
        """data: the bytes of a whole file. max_bytes: of memory, 0: 4 GiB; max_work: steps of spec
        13.4, 0: any. Raises Ted4Error."""
        if not (0 <= max_bytes < 1 << 64 and 0 <= max_work < 1 << 64):
            raise ValueError("max_bytes and max_work are from 0 to 2^64 - 1")
        self._scene, self._recon = c.c_void_p(), c.c_void_p()
        self._lock = threading.Lock()  # of _recon and its arrays, which the next query overwrites
        self._options = _Options(max_bytes=max_bytes, max_work=max_work)
        error = _Error()
        data = data if isinstance(data, bytes) else bytes(memoryview(data))
        if _library.ted4_decode(data, c.c_size_t(len(data)), c.byref(self._options),
                                c.byref(self._scene), c.byref(error)):
            raise Ted4Error(error.code, error.offset)
        info = _Info()
        _library.ted4_scene_info(self._scene, c.byref(info))
        self.anchors, self.offsets, self.frames = info.n_anchors, info.n_offsets, info.frames
        self.gaussian_count, self.moving, self.level = info.n_gaussians, info.n_dynamic, info.level
        self.rate = info.rate_num / info.rate_den
        self.view, self.motion = VIEW[info.view], MOTION[info.motion]
        self.activation = bool(info.activation)
        self.origin, self.exponent = tuple(info.origin), info.exponent
        self.background, self.hash = tuple(info.background), bytes(info.hash).hex()

    @classmethod
    def open(cls, path, **options):
        with open(path, "rb") as file:
            return cls(file.read(), **options)

    def gaussians(self, num, den, camera=(0.0, 0.0, 0.0)):
        """At time num / den, in [0, 1], from a camera centre in world coordinates. Raises
        Ted4Error."""
        num, den = operator.index(num), operator.index(den)
        if not 0 <= num <= den < _DEN_END:
            num, den = 1, 0  # refused by the library, which a larger number may not reach as it is
        x, y, z = camera
        with self._lock:
            return self._queried(_Query(num, den, (_f32 * 3)(x, y, z)))

    def _queried(self, query):
        if not self._recon:
            code = _library.ted4_recon_new(c.byref(self._recon), self._scene,
                                           c.byref(self._options))
            if code:
                raise Ted4Error(code)
        g = _Gaussians()
        code = _library.ted4_recon_query(self._recon, c.byref(query), None, c.byref(g))
        if code:
            raise Ted4Error(code)
        digest = (c.c_uint8 * 16)()
        _library.ted4_gaussians_hash(c.byref(g), digest)

        def rows(pointers):
            return np.stack([array(p) for p in pointers], axis=1)

        def array(pointer):
            if g.n == 0:
                return np.empty(0, pointer._type_)
            return np.ctypeslib.as_array(pointer, (g.n,)).copy()

        return Gaussians(rows(g.mean), rows(g.scale), rows(g.rot), array(g.opacity),
                         rows(g.colour), array(g.id), bytes(digest).hex())

    def frame(self, number, camera=(0.0, 0.0, 0.0)):
        """The Gaussians of a frame, from 0 to frames - 1 (R-HDR-005)."""
        number = operator.index(number)
        if not 0 <= number < self.frames:
            raise IndexError(f"frame {number} of {self.frames}")
        time = Fraction(number, max(self.frames - 1, 1))
        if time.denominator >= _DEN_END:
            return self.gaussians(round(time * (_DEN_END - 1)), _DEN_END - 1, camera)
        return self.gaussians(time.numerator, time.denominator, camera)

    def __copy__(self):
        raise TypeError("a Scene cannot be copied")  # it owns what the library allocated

    def __del__(self):
        if getattr(self, "_recon", None):
            _library.ted4_recon_free(self._recon)
        if getattr(self, "_scene", None):
            _library.ted4_scene_free(self._scene)
