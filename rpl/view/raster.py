"""Triangles and lines as pixels, by NumPy alone: a depth buffer that is kept per pixel, as graphics hardware has it.

Pictures of a run can so be made where there is no screen and no browser. Triangles are dealt with in groups of one
size, a whole group at a time. Source of the test for being inside: Pineda, A parallel algorithm for polygon
rasterization (1988).
"""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from rpl.emulator.rotations import FloatArray

# So many pixels are looked at in one step, which bounds the memory.
_AT_ONCE = 4_000_000
NOTHING = -1


class Canvas:
    """Pixels with their depth (the smaller the nearer) and the number of the triangle that is seen there."""

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self.depth: FloatArray = np.full(width * height, np.inf)
        self.owner: NDArray[np.int64] = np.full(width * height, NOTHING, dtype=np.int64)

    def triangles(self, corners: FloatArray) -> None:
        """Draw triangles (m, 3, 3): x and y in pixels and depth of each corner, which is linear on the screen."""
        low = np.floor(corners[:, :, :2].min(axis=1)).astype(np.int64)
        high = np.ceil(corners[:, :, :2].max(axis=1)).astype(np.int64)
        seen = np.isfinite(corners).all(axis=(1, 2)) & (high >= 0).all(axis=1)
        seen &= (low[:, 0] < self.width) & (low[:, 1] < self.height)
        low = np.clip(low, 0, [self.width - 1, self.height - 1])
        high = np.clip(high, 0, [self.width - 1, self.height - 1])
        # By the size of the boxes around them, wide and high by powers of the root of two.
        sizes = np.ceil(2.0 * np.log2(np.maximum(high - low + 1, 2))).astype(np.int64)
        classes = sizes[:, 0] * 64 + sizes[:, 1]
        for number in np.unique(classes[seen]):
            rows = np.flatnonzero(seen & (classes == number))
            width, height = (int(np.ceil(2.0 ** (part / 2.0))) for part in divmod(int(number), 64))
            step = max(_AT_ONCE // (width * height), 1)
            for begin in range(0, len(rows), step):
                self._group(corners, rows[begin : begin + step], low, width, height)

    def _group(
        self, corners: FloatArray, rows: NDArray[np.int64], low: NDArray[np.int64], width: int, height: int
    ) -> None:
        y, x = np.mgrid[0:height, 0:width]
        px, py = low[rows, 0][:, None, None] + x, low[rows, 1][:, None, None] + y
        weights = barycentric(corners[rows][:, :, :2, None, None], px + 0.5, py + 0.5)
        inside = (weights >= -1e-9).all(axis=1) & (px < self.width) & (py < self.height)
        depth = np.einsum("mkij,mk->mij", weights, corners[rows, :, 2])[inside]
        place = (py * self.width + px)[inside]
        owner = np.broadcast_to(rows[:, None, None], inside.shape)[inside]
        np.minimum.at(self.depth, place, depth)
        nearest = self.depth[place] >= depth
        self.owner[place[nearest]] = owner[nearest]

    def lines(self, ends: FloatArray, width: float) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
        """The pixels of lines (m, 2, 3) so many pixels wide: where, which line, and how deep; nothing is drawn."""
        finite = np.flatnonzero(np.isfinite(ends).all(axis=(1, 2)))
        reach = np.abs(ends[finite, 1, :2] - ends[finite, 0, :2]).max(axis=1, initial=0.0)
        close = reach < 4.0 * (self.width + self.height)
        finite, reach = finite[close], reach[close]
        counts = np.ceil(reach).astype(np.int64) + 1
        line = np.repeat(finite, counts)
        within = np.arange(len(line)) - np.repeat(np.cumsum(counts) - counts, counts)
        share = within / np.maximum(np.repeat(counts, counts) - 1, 1)
        points = ends[line, 0] + share[:, None] * (ends[line, 1] - ends[line, 0])
        off = np.arange(int(np.ceil(width))) - (np.ceil(width) - 1.0) / 2.0
        dx, dy = (values.ravel() for values in np.meshgrid(off, off))
        round_ = np.hypot(dx, dy) <= width / 2.0 + 0.2
        dx, dy = dx[round_], dy[round_]
        x = np.floor(points[:, 0, None] + dx).astype(np.int64).ravel()
        y = np.floor(points[:, 1, None] + dy).astype(np.int64).ravel()
        kept = (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)
        line, depth = np.repeat(line, len(dx))[kept], np.repeat(points[:, 2], len(dx))[kept]
        return (y * self.width + x)[kept], line, depth


def barycentric(corners: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """Shares (m, 3, ...) of the corners (m, 3, 2, ...) of triangles at points; NaN for triangles without an area."""
    (ax, ay), (bx, by), (cx, cy) = ((corners[:, corner, 0], corners[:, corner, 1]) for corner in range(3))
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    with np.errstate(divide="ignore", invalid="ignore"):
        second = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
        third = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
    return np.stack([1.0 - second - third, second, third], axis=1)


def png(pixels: NDArray[np.uint8]) -> bytes:
    """Pixels (height, width, 3) as a PNG file (W3C, Portable Network Graphics, third edition, 2023).

    Each row is written as its difference from the row above (filter 2): most rows are like it.
    """
    height, width, _ = pixels.shape
    flat = pixels.reshape(height, width * 3)
    above = np.vstack([np.zeros((1, width * 3), dtype=np.uint8), flat[:-1]])
    rows = np.hstack([np.full((height, 1), 2, dtype=np.uint8), flat - above])
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    pieces = ((b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in pieces
    )
