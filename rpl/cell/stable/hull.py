"""The convex hull of a part as a flat support meets it: how high the centre of mass stands on each facet, how high it
has to be lifted to roll over each edge, and how much of all directions each facet takes up.

A rigid part touches a plane with its hull only, so nothing else of its form decides how it comes to rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rpl.emulator.rotations import FloatArray, IntArray
from rpl.errors import UsageError

_PARALLEL = 1e-12  # 1 - cosine between the normals of two triangles of one plane


class Solid(Protocol):
    """Triangles: vertices (n, 3) in mm, faces (m, 3), counter-clockwise from outside."""

    @property
    def vertices(self) -> FloatArray: ...

    @property
    def faces(self) -> NDArray[np.int64]: ...


@dataclass(frozen=True, slots=True, eq=False)
class Hull:
    """Triangles of the hull; lengths in mm from the centre of mass, `f` facets, `e` edges."""

    corners: FloatArray  # (v, 3), in the frame of the centre of mass
    facets: IntArray  # (f, 3), places in `corners`
    normals: FloatArray  # (f, 3), outwards
    heights: FloatArray  # (f,): of the centre of mass when the facet lies on the support
    shares: FloatArray  # (f,): part of all directions from the centre of mass that goes through the facet
    neighbours: IntArray  # (e, 2): facets on both sides of an edge
    saddles: FloatArray  # (e,): greatest height of the centre of mass on the way over the edge

    @property
    def largest_mm(self) -> float:
        """The longest side of the bounding box in the part's frame."""
        return float((self.corners.max(axis=0) - self.corners.min(axis=0)).max())

    def under(self, down: FloatArray) -> int:
        """The facet that a ray from the centre of mass along `down` (3,) leaves through."""
        slant = self.normals @ down
        with np.errstate(divide="ignore"):
            return int(np.argmin(np.where(slant > 0.0, self.heights / slant, np.inf)))


def hull_of(solid: Solid, centre: FloatArray) -> Hull:
    """The hull seen from `centre` (3,). Raises UsageError where it encloses no volume, or not the centre of mass."""
    try:
        from scipy.spatial import ConvexHull, QhullError
    except ImportError:
        raise UsageError("stable states need the package scipy: pip install 'robot-rpl[cell]'") from None

    used = np.unique(solid.faces)
    try:
        found = ConvexHull(solid.vertices[used] - centre)
    except (QhullError, ValueError):
        raise UsageError("the shape is flat: its hull encloses no volume, so nothing says how it rests") from None
    kept, facets = np.unique(found.simplices, return_inverse=True)
    facets = facets.reshape(found.simplices.shape)
    corners = found.points[kept]
    normals, heights = found.equations[:, :3], -found.equations[:, 3]
    if heights.min() <= 1e-9 * np.abs(corners).max():
        raise UsageError("the centre of mass lies outside the convex hull of the shape")
    neighbours, saddles = _edges(found.neighbors, facets, corners, normals, heights)
    return Hull(corners, facets, normals, heights, _shares(corners[facets]), neighbours, saddles)


def _shares(triangles: FloatArray) -> FloatArray:
    """Solid angles of triangles (f, 3, 3) from the origin over 4 pi; they add to 1 around a point inside a hull.

    Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, IEEE Transactions on Biomedical Engineering, 1983.
    """
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    la, lb, lc = (np.linalg.norm(one, axis=1) for one in (a, b, c))
    volume = np.abs(np.einsum("ij,ij->i", a, np.cross(b, c)))
    ab, bc, ca = (np.einsum("ij,ij->i", one, two) for one, two in ((a, b), (b, c), (c, a)))
    angles = 2.0 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
    return np.asarray(angles / angles.sum())


def _edges(
    beside: IntArray, facets: IntArray, corners: FloatArray, normals: FloatArray, heights: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Pairs of neighbouring facets and the saddle between them.

    While the part rolls over an edge, its down direction goes from one normal to the other. The centre of mass is
    highest when it stands right above the edge, at its distance from the edge's line, if the way passes there; else at
    the higher of the two ends.
    """
    one = np.repeat(np.arange(len(facets)), 3)
    other = beside.reshape(-1)
    first = one < other
    opposite = np.tile(np.arange(3), len(facets))[first]
    one, other = one[first], other[first]
    start = corners[facets[one, (opposite + 1) % 3]]
    along = corners[facets[one, (opposite + 2) % 3]] - start
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-300)
    off = np.linalg.norm(start - np.einsum("ij,ij->i", start, along)[:, None] * along, axis=1)
    cosine = np.einsum("ij,ij->i", normals[one], normals[other])
    low, high = heights[one], heights[other]
    above = (low >= cosine * high) & (high >= cosine * low) & (cosine < 1.0 - _PARALLEL)
    top = np.maximum(low, high)
    return np.stack([one, other], axis=1), np.where(above, np.maximum(off, top), top)
