"""Forms of bodies as coal takes them: convex solids, and shells of triangles for meshes that are not convex.

coal (the collision library beside Pinocchio) measures signed distances between them: below zero is how far one has to
be moved out of the other (Gilbert, Johnson, Keerthi 1988; van den Bergh 2001). Here all lengths are mm, which it
does not mind. A box, a cylinder, a sphere and a capsule are exact; an extrusion is cut into convex prisms.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from rpl.cell.shapes import Box, Capsule, Cylinder, Extrusion, Mesh, Shape, Sphere
from rpl.emulator.rotations import FloatArray
from rpl.errors import UsageError

if TYPE_CHECKING:
    import coal  # ships no type information

# A mesh whose hull is larger by no more than this share is its hull.
_CONVEX_SHARE = 0.005


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """One form for coal. `at` (4, 4): where its frame is in the frame of the body. In its own frame its bounds are the
    box about `middle` (3,) with the half sizes `half` (3,), grown by `round_mm`."""

    geometry: coal.CollisionGeometry
    at: FloatArray
    middle: FloatArray
    half: FloatArray
    round_mm: float = 0.0

    @property
    def radius(self) -> float:
        """Of a ball about the middle that holds it, mm."""
        return float(np.linalg.norm(self.half)) + self.round_mm


def solids_of(shape: Shape, at: FloatArray) -> tuple[Solid, ...]:
    """The solids that a body at a pose (4, 4) in some frame is made of.

    Raises UsageError where coal is not installed.
    """
    coal = _coal()
    nothing = np.zeros(3)
    match shape:
        case Box(size=size):
            return (Solid(coal.Box(*map(float, size)), at, nothing, np.array(size) / 2.0),)
        case Cylinder(diameter=wide, height=high):
            half = np.array([wide, wide, high]) / 2.0
            return (Solid(coal.Cylinder(wide / 2.0, float(high)), at, nothing, half),)
        case Sphere(diameter=wide):
            return (Solid(coal.Sphere(wide / 2.0), at, nothing, nothing, wide / 2.0),)
        case Capsule(diameter=wide, length=long):
            half = np.array([0.0, 0.0, long / 2.0])
            return (Solid(coal.Capsule(wide / 2.0, float(long)), at, nothing, half, wide / 2.0),)
        case Extrusion():
            return tuple(form.at(at) for form in _of_extrusion(shape))
        case Mesh():
            return (_of_mesh(shape).at(at),)


def _coal() -> coal:
    try:
        import coal
    except ImportError as error:
        raise UsageError("looking for collisions needs coal (pip install 'robot-rpl[kinematics]')") from error
    return coal


@dataclass(frozen=True, slots=True, eq=False)
class _Form:
    """What is worked out of a form once, wherever it stands."""

    geometry: coal.CollisionGeometry
    middle: FloatArray
    half: FloatArray

    def at(self, pose: FloatArray) -> Solid:
        return Solid(self.geometry, pose, self.middle, self.half)


def _hull(points: FloatArray) -> _Form:
    """The convex hull of points (n, 3)."""
    coal = _coal()
    corners = coal.StdVec_Vec3s()
    for point in points:
        corners.append(np.asarray(point, dtype=np.float64))
    low, high = points.min(axis=0), points.max(axis=0)
    return _Form(coal.Convex.convexHull(corners, True, "Qt"), (low + high) / 2.0, (high - low) / 2.0)


@lru_cache(maxsize=256)
def _of_extrusion(shape: Extrusion) -> tuple[_Form, ...]:
    return tuple(_hull(points) for points in _prisms(shape))


@lru_cache(maxsize=256)
def _of_mesh(shape: Mesh) -> _Form:
    """The hull of a convex mesh, else its triangles."""
    coal = _coal()
    facets = shape.facets
    if np.linalg.matrix_rank(facets.vertices - facets.vertices[0], tol=1e-6) == 3:
        hull = _hull(facets.vertices)
        if 0.0 < hull.geometry.computeVolume() <= abs(facets.volume) * (1.0 + _CONVEX_SHARE):
            return hull
    shell = coal.BVHModelOBBRSS()
    shell.beginModel(len(facets.faces), len(facets.vertices))
    shell.addVertices(np.ascontiguousarray(facets.vertices))
    shell.addTriangles(np.ascontiguousarray(facets.faces))
    shell.endModel()
    low, high = facets.bounds
    return _Form(shell, (low + high) / 2.0, (high - low) / 2.0)


def _prisms(shape: Extrusion) -> list[FloatArray]:
    """Corners (n, 3) of the convex prisms of an extrusion: the triangles of its outline, joined while they stay convex
    (Hertel and Mehlhorn, Fast triangulation of simple polygons, 1983)."""
    facets, half = shape.facets, shape.height / 2.0
    count = len(shape.outline)
    flat = facets.vertices[:count, :2]
    pieces = [tuple(face) for face in facets.faces - count if face.min() >= 0]  # those of the upper cap
    joined = True
    while joined:
        joined = False
        for first in range(len(pieces)):
            for second in range(first + 1, len(pieces)):
                whole = _joined(flat, pieces[first], pieces[second])
                if whole is not None:
                    pieces = [one for number, one in enumerate(pieces) if number not in (first, second)]
                    pieces.append(whole)
                    joined = True
                    break
            if joined:
                break
    return [
        np.vstack([np.column_stack([flat[list(piece)], np.full(len(piece), height)]) for height in (-half, half)])
        for piece in pieces
    ]


def _joined(flat: FloatArray, first: tuple[int, ...], second: tuple[int, ...]) -> tuple[int, ...] | None:
    """Two counter-clockwise pieces with a common edge as one; None where it is not convex or there is none."""
    for place, corner in enumerate(first):
        after = first[(place + 1) % len(first)]
        if after in second and second[(second.index(after) + 1) % len(second)] == corner:
            start = second.index(corner)
            rest = tuple(second[(start + step) % len(second)] for step in range(1, len(second) - 1))
            whole = (*first[: place + 1], *rest, *first[place + 1 :])
            return whole if _convex(flat[list(whole)]) else None
    return None


def _convex(corners: FloatArray) -> bool:
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    return bool((before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] >= -1e-9).all())
