"""The form of bodies: analytic solids and meshes, each with its faceted twin.

An analytic form says exactly where its surface is (`on_surface`), its facets are for what needs triangles: hulls,
stable states, drawings, ray casts. All lengths are mm in the frame of the body. Boxes, cylinders, spheres, capsules and
extrusions have their frame in the middle of their bounding box, the axis of a cylinder, capsule or extrusion is z; a
mesh has the frame of its file.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rpl.emulator.rotations import FloatArray

Faces = NDArray[np.int64]
_ROUND = 32  # facets around a curved face
_HALF_ROUND = 8  # rings of a half sphere


@dataclass(frozen=True)
class Box:
    """`size`: along x, y and z."""

    size: tuple[float, float, float]

    @cached_property
    def facets(self) -> Facets:
        x, y = self.size[0] / 2.0, self.size[1] / 2.0
        return _prism(((-x, -y), (x, -y), (x, y), (-x, y)), self.size[2])

    def on_surface(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The point (3,) of the surface nearest to `point`, and the normal (3,) there."""
        half = np.array(self.size) / 2.0
        inside = np.clip(point, -half, half)
        off = point - inside
        if (away := float(np.linalg.norm(off))) > 0.0:
            return inside, off / away
        axis = int(np.argmin(half - np.abs(inside)))
        normal = np.zeros(3)
        normal[axis] = math.copysign(1.0, inside[axis])
        inside = inside.copy()
        inside[axis] = normal[axis] * half[axis]
        return inside, normal


@dataclass(frozen=True)
class Cylinder:
    """About z."""

    diameter: float
    height: float

    @cached_property
    def facets(self) -> Facets:
        return _prism(_circle(self.diameter / 2.0), self.height)

    def on_surface(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The point (3,) of the surface nearest to `point`, and the normal (3,) there."""
        radius, half = self.diameter / 2.0, self.height / 2.0
        far = float(math.hypot(point[0], point[1]))
        side = np.array([point[0], point[1], 0.0]) / far if far > 1e-12 else np.array([1.0, 0.0, 0.0])
        flat = np.array([0.0, 0.0, math.copysign(1.0, point[2])])
        beside, beyond = far - radius, abs(float(point[2])) - half
        if beside <= 1e-9 and beyond <= 1e-9:  # inside, or on it but for rounding
            if beside > beyond:
                return side * radius + np.array([0.0, 0.0, point[2]]), side
            return side * far + flat * half, flat
        found = side * min(far, radius) + np.array([0.0, 0.0, min(max(float(point[2]), -half), half)])
        off = point - found
        return found, np.asarray(off / np.linalg.norm(off))


@dataclass(frozen=True)
class Sphere:
    """About the frame."""

    diameter: float

    @cached_property
    def facets(self) -> Facets:
        return _ball(self.diameter / 2.0, 0.0)

    def on_surface(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The point (3,) of the surface nearest to `point`, and the normal (3,) there."""
        away = float(np.linalg.norm(point))
        normal = point / away if away > 0.0 else np.array([0.0, 0.0, 1.0])
        return normal * (self.diameter / 2.0), normal


@dataclass(frozen=True)
class Capsule:
    """A cylinder about z with half spheres on its ends; `length` is that of the cylinder between them."""

    diameter: float
    length: float

    @cached_property
    def facets(self) -> Facets:
        return _ball(self.diameter / 2.0, self.length / 2.0)

    def on_surface(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The point (3,) of the surface nearest to `point`, and the normal (3,) there."""
        half = self.length / 2.0
        middle = np.array([0.0, 0.0, min(max(point[2], -half), half)])
        off = point - middle
        away = float(np.linalg.norm(off))
        normal = off / away if away > 1e-12 else np.array([1.0, 0.0, 0.0])
        return middle + normal * (self.diameter / 2.0), np.asarray(normal)


@dataclass(frozen=True)
class Extrusion:
    """An outline in x and y, any simple polygon without its first corner repeated, drawn along z."""

    outline: tuple[tuple[float, float], ...]
    height: float

    @cached_property
    def facets(self) -> Facets:
        corners = np.array(self.outline)
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
        return _prism(tuple((float(x), float(y)) for x, y in corners - middle), self.height)

    def on_surface(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The point (3,) of the surface nearest to `point`, and the normal (3,) there."""
        return self.facets.on_surface(point)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles from a file, in mm."""

    vertices: FloatArray  # (n, 3)
    faces: Faces  # (m, 3), counter-clockwise from outside
    path: str = ""

    @cached_property
    def facets(self) -> Facets:
        return Facets(self.vertices, self.faces)

    def on_surface(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The point (3,) of the surface nearest to `point`, and the normal (3,) there."""
        return self.facets.on_surface(point)


Shape = Box | Cylinder | Sphere | Capsule | Extrusion | Mesh


@dataclass(frozen=True, eq=False)
class Facets:
    """Triangles: vertices (n, 3) in mm, faces (m, 3), counter-clockwise from outside."""

    vertices: FloatArray
    faces: Faces

    @cached_property
    def normals(self) -> FloatArray:
        """Of the faces, outwards, of length one (m, 3)."""
        a, b, c = (self.vertices[self.faces[:, place]] for place in range(3))
        crossed = np.cross(b - a, c - a)
        return np.asarray(crossed / np.maximum(np.linalg.norm(crossed, axis=1, keepdims=True), 1e-300))

    @cached_property
    def bounds(self) -> FloatArray:
        """Lowest and highest corner (2, 3)."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @cached_property
    def volume(self) -> float:
        """mm3; by the divergence theorem, so negative for a mesh that is inside out."""
        return float(self._tetrahedra.sum()) / 6.0

    @cached_property
    def centre(self) -> FloatArray:
        """Centre of mass (3,) of a body of even density; the middle of its bounds where it encloses nothing."""
        if abs(self.volume) < 1e-9:
            return np.asarray(self.bounds.mean(axis=0))
        corners = self.vertices[self.faces].sum(axis=1)
        return np.asarray((self._tetrahedra[:, None] * corners).sum(axis=0) / (24.0 * self.volume))

    @cached_property
    def _tetrahedra(self) -> FloatArray:
        a, b, c = (self.vertices[self.faces[:, place]] for place in range(3))
        return np.asarray(np.einsum("ij,ij->i", a, np.cross(b, c)))

    def on_surface(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The point (3,) of the triangles nearest to `point`, and the normal (3,) of its face.

        For each triangle the foot of the perpendicular where it lies inside, else the nearest point of its edges.
        """
        found = _nearest_in_triangles(point, *(self.vertices[self.faces[:, place]] for place in range(3)))
        face = int(np.argmin(((found - point) ** 2).sum(axis=1)))
        return found[face], self.normals[face]

    def pierced(self, start: FloatArray, direction: FloatArray) -> tuple[float, int] | None:
        """How far (mm) along a ray from `start` (3,) the first face is met, and which; None when none is.

        Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection (1997), for all faces at once.
        """
        a, b, c = (self.vertices[self.faces[:, place]] for place in range(3))
        first, second = b - a, c - a
        across = np.cross(direction, second)
        slant = np.einsum("ij,ij->i", first, across)
        inverse = 1.0 / np.where(np.abs(slant) > 1e-12, slant, np.inf)
        off = start - a
        u = np.einsum("ij,ij->i", off, across) * inverse
        turned = np.cross(off, first)
        v = (turned @ direction) * inverse
        away = np.einsum("ij,ij->i", second, turned) * inverse
        inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9)
        hit = (inverse != 0.0) & inside & (away >= -1e-9)
        if not hit.any():
            return None
        face = int(np.argmin(np.where(hit, away, np.inf)))
        return float(away[face]), face


def moved(points: FloatArray, pose: FloatArray) -> FloatArray:
    """Points (n, 3) carried by a pose (4, 4)."""
    return np.asarray(points @ pose[:3, :3].T + pose[:3, 3])


def bounds_at(shape: Shape, pose: FloatArray) -> FloatArray:
    """Lowest and highest corner (2, 3) of a body that stands at a pose (4, 4)."""
    corners = moved(shape.facets.vertices, pose)
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


def _circle(radius: float) -> tuple[tuple[float, float], ...]:
    turns = [2.0 * math.pi * number / _ROUND for number in range(_ROUND)]
    return tuple((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns)


def _ball(radius: float, half: float) -> Facets:
    """A ball, or with `half` > 0 a capsule about z whose cylinder reaches from -half to half."""
    steps = [math.pi / 2.0 * number / _HALF_ROUND for number in range(1, _HALF_ROUND + 1)]
    lower = [(radius * math.sin(turn), -half - radius * math.cos(turn)) for turn in steps]
    upper = [(across, -height) for across, height in reversed(lower)]
    rings = lower + (upper if half else upper[1:])
    around = _circle(1.0)
    points = [(across * c, across * s, height) for across, height in rings for c, s in around]
    reach = half + radius
    vertices = np.array([(0.0, 0.0, -reach), *points, (0.0, 0.0, reach)])
    last, top = len(vertices) - 1, 1 + (len(rings) - 1) * _ROUND
    faces: list[tuple[int, int, int]] = []
    for place in range(_ROUND):
        after = (place + 1) % _ROUND
        faces.append((0, 1 + after, 1 + place))
        for low in range(1, top, _ROUND):
            high = low + _ROUND
            faces += [(low + place, low + after, high + after), (low + place, high + after, high + place)]
        faces.append((top + place, top + after, last))
    return Facets(vertices, np.array(faces, dtype=np.int64))


def _prism(outline: Sequence[tuple[float, float]], height: float) -> Facets:
    """A simple polygon drawn along z, with its middle at z = 0."""
    if _crosses_itself(outline):
        raise ValueError("the outline crosses itself")
    corners = outline if _area(outline) > 0.0 else outline[::-1]
    count, half = len(corners), height / 2.0
    vertices = np.array([(x, y, -half) for x, y in corners] + [(x, y, half) for x, y in corners])
    caps = _ears(corners)
    faces = [(a, c, b) for a, b, c in caps] + [(count + a, count + b, count + c) for a, b, c in caps]
    for place in range(count):
        after = (place + 1) % count
        faces += [(place, after, count + after), (place, count + after, count + place)]
    return Facets(vertices, np.array(faces, dtype=np.int64))


def _area(outline: Sequence[tuple[float, float]]) -> float:
    """Of a polygon, positive where it is counter-clockwise (the shoelace formula)."""
    following = [*outline[1:], outline[0]]
    return sum(x * v - u * y for (x, y), (u, v) in zip(outline, following, strict=True)) / 2.0


def _crosses_itself(outline: Sequence[tuple[float, float]]) -> bool:
    """Do two sides that are no neighbours meet? By the sides on which each has the ends of the other."""
    count = len(outline)
    sides = [(outline[place], outline[(place + 1) % count]) for place in range(count)]
    for first, (a, b) in enumerate(sides):
        for second in range(first + 2, count - (first == 0)):
            c, d = sides[second]
            if _area((a, b, c)) * _area((a, b, d)) < 0.0 and _area((c, d, a)) * _area((c, d, b)) < 0.0:
                return True
    return False


def _ears(outline: Sequence[tuple[float, float]]) -> list[tuple[int, int, int]]:
    """Triangles of a simple counter-clockwise polygon, by cutting ears off (Meisters, Polygons Have Ears, 1975).

    Raises ValueError for an outline that touches itself: no ear is left then.
    """
    left = list(range(len(outline)))
    found: list[tuple[int, int, int]] = []
    while len(left) > 3:
        for place, corner in enumerate(left):
            three = (left[place - 1], corner, left[(place + 1) % len(left)])
            if _is_ear(outline, three, left):
                found.append(three)
                left.remove(corner)
                break
        else:
            raise ValueError("the outline touches itself")
    return [*found, (left[0], left[1], left[2])]


def _is_ear(outline: Sequence[tuple[float, float]], three: tuple[int, int, int], left: Sequence[int]) -> bool:
    a, b, c = (outline[number] for number in three)
    if _area((a, b, c)) <= 0.0:
        return False
    return not any(
        min(_area((a, b, p)), _area((b, c, p)), _area((c, a, p))) >= 0.0
        for p in (outline[number] for number in left if number not in three)
    )


def _nearest_in_triangles(p: FloatArray, a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """The point of each triangle (m, 3) nearest to p: inside its plane where the foot lies in it, else on an edge."""
    first, second = b - a, c - a
    normal = np.cross(first, second)
    square = np.maximum(np.einsum("ij,ij->i", normal, normal), 1e-300)
    off = p - a
    v = np.einsum("ij,ij->i", np.cross(off, second), normal) / square
    w = np.einsum("ij,ij->i", np.cross(first, off), normal) / square
    inside = (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0)
    foot = a + v[:, None] * first + w[:, None] * second
    edges = np.stack([_nearest_on_edges(p, a, b), _nearest_on_edges(p, b, c), _nearest_on_edges(p, c, a)])
    nearest = np.argmin(((edges - p) ** 2).sum(axis=2), axis=0)
    return np.asarray(np.where(inside[:, None], foot, edges[nearest, np.arange(len(a))]))


def _nearest_on_edges(p: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    along = end - start
    square = np.maximum((along * along).sum(axis=1), 1e-300)
    share = np.clip(((p - start) * along).sum(axis=1) / square, 0.0, 1.0)
    return np.asarray(start + share[:, None] * along)
