"""The stable states of a part: how it can rest on a flat support, how likely each is, and how it then stands.

Two estimators: `fast` (rpl.cell.stable.basins) and `dynamic` (rpl.cell.stable.drops). A part that falls from no height
stays as it is held; from its largest side on it has forgotten that.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rpl.cell.shapes import Capsule, Cylinder, Mesh, Shape, Sphere
from rpl.cell.stable.basins import Basins, basins_of
from rpl.cell.stable.drops import Drop, dropped
from rpl.cell.stable.hull import Hull, Solid, hull_of
from rpl.emulator.rotations import FloatArray, matrix_to_quaternion
from rpl.errors import UsageError

METHODS = ("fast", "dynamic")
DROPS = 1000
AS_DRAWN = (0.0, 0.0, -1.0)
Vector = tuple[float, float, float]
_Z_95 = 1.959964  # of the normal distribution: 95 of 100 lie within


@dataclass(frozen=True, slots=True)
class StableState:
    """One way to rest on a level support.

    normal: direction in the frame of the part that points down.
    rotation: quaternion w, x, y, z that carries the part's frame into the world's (z up): it turns `normal` to
    (0, 0, -1) by the least angle; every further turn about the vertical is the same state.
    height_mm: of the origin of the part's frame above the support; com_height_mm: of its centre of mass.
    interval: 95 % confidence interval of the probability where it was counted (Wilson's), else None.
    """

    normal: Vector
    rotation: tuple[float, float, float, float]
    probability: float
    height_mm: float
    com_height_mm: float
    interval: tuple[float, float] | None = None


def stable_states(
    shape: Shape,
    *,
    method: str = "fast",
    com: Sequence[float] | None = None,
    drop_height_mm: float | None = None,
    down: Sequence[float] = AS_DRAWN,
    seed: int = 1,
    drops: int = DROPS,
    drop: Drop | None = None,
    tell: Callable[[int], None] = lambda done: None,
) -> tuple[StableState, ...]:
    """All stable states, the likeliest first; their probabilities add to 1. The same arguments give the same answer.

    com: centre of mass in the part's frame, mm; that of an even density where None.
    drop_height_mm: how far the lowest point of the part falls; None is far enough for the full probabilities. The state
    that the part is held in, its direction `down` towards the support, then keeps 1 - r and the full probabilities get
    r = drop_height_mm / (longest side of its box), at most 1: linear between the two ends of the textbook's rule.
    drops, seed: of the method `dynamic`; `tell` hears how many drops are done. drop: how it falls there.
    Raises UsageError for a flat shape, a centre of mass outside, and a library that is missing.
    """
    if method not in METHODS:
        raise UsageError(f"the method {method!r} is not known: there are {' and '.join(METHODS)}")
    if drop_height_mm is not None and not drop_height_mm >= 0.0:
        raise UsageError(f"a drop height of {drop_height_mm:g} mm is below 0")
    solid: Solid = shape if isinstance(shape, Mesh) else shape.facets
    centre, inertia = mass_properties(solid)
    if com is not None:
        centre = _vector(com, "the centre of mass")
    hull = hull_of(solid, centre)
    basins = basins_of(hull)
    states = [
        _standing(hull.normals[facet], float(hull.heights[facet]), float(chance), centre)
        for facet, chance in zip(basins.lowest, basins.probabilities, strict=True)
    ]
    if com is None and (exact := _exact(shape)) is not None:
        states = [_replaced(state, exact) for state in states]
    if method == "dynamic":
        if drops < 1:
            raise UsageError(f"{drops} drops are none")
        counts = dropped(hull, basins, inertia, drops, seed, drop or Drop(), tell)
        states = [_counted(state, int(count), drops) for state, count in zip(states, counts, strict=True)]
    if drop_height_mm is not None:
        share = min(drop_height_mm / hull.largest_mm, 1.0)
        states = _held(states, held_state(hull, basins, down), share)
    return tuple(sorted(states, key=lambda one: (-round(one.probability, 9), tuple(round(c, 6) for c in one.normal))))


def held_state(hull: Hull, basins: Basins, down: Sequence[float]) -> int:
    """The state that a part ends in when it is put down gently with this direction towards the support."""
    direction = _vector(down, "the direction down")
    length = float(np.linalg.norm(direction))
    if length == 0.0:
        raise UsageError("the direction down is 0,0,0, which points nowhere")
    return int(basins.state_of[hull.under(direction / length)])


def mass_properties(solid: Solid) -> tuple[FloatArray, FloatArray]:
    """Centre of mass (3,) in mm and the tensor of inertia (3, 3) in mm2 about it, of a mass of one with even density.

    Sums over the tetrahedra between the origin and each triangle, whose second moments are known in closed form
    (Tonon, Explicit Exact Formulas for the 3-D Tetrahedron Inertia Tensor, J. Math. Statistics 1, 2005).
    """
    a, b, c = (solid.vertices[solid.faces[:, place]] for place in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    volume = float(volumes.sum())
    longest = float((solid.vertices.max(axis=0) - solid.vertices.min(axis=0)).max())
    if not abs(volume) > 1e-12 * longest**3:
        raise UsageError("the shape encloses no volume, so it has no centre of mass")
    total = a + b + c
    centre = (volumes[:, None] * total).sum(axis=0) / (4.0 * volume)
    moments = np.einsum("i,ij,ik->jk", volumes, total, total)
    for corner in (a, b, c):
        moments += np.einsum("i,ij,ik->jk", volumes, corner, corner)
    spread = moments / (20.0 * volume) - np.outer(centre, centre)
    return np.asarray(centre), np.asarray(np.trace(spread) * np.eye(3) - spread)


def rotation_down(normal: FloatArray) -> FloatArray:
    """The rotation (3, 3) of least angle that carries a direction (3,) to (0, 0, -1); half a turn about x for +z."""
    x, y, z = (float(one) for one in normal)
    if z > 1.0 - 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    # Rodrigues' formula for the turn from n to -z, whose cosine is -n_z.
    share = 1.0 / (1.0 - z)
    return np.array([[1.0 - x * x * share, -x * y * share, x], [-x * y * share, 1.0 - y * y * share, y], [-x, -y, -z]])


def _standing(normal: FloatArray, com_height: float, probability: float, centre: FloatArray) -> StableState:
    unit = normal / np.linalg.norm(normal) + 0.0
    quaternion = matrix_to_quaternion(rotation_down(unit))
    return StableState(
        (float(unit[0]), float(unit[1]), float(unit[2])),
        (float(quaternion[0]), float(quaternion[1]), float(quaternion[2]), float(quaternion[3])),
        probability,
        com_height + float(unit @ centre),
        com_height,
    )


def _exact(shape: Shape) -> list[tuple[FloatArray, float, float]] | None:
    """Normal, height of the centre of mass and probability of each state, of forms whose curved faces are known.

    The rule of rpl.cell.stable.basins with the true angles: an end of a cylinder is seen under 2 pi (1 - half / slant).
    """
    match shape:
        case Sphere(diameter=diameter):
            return [(np.array(AS_DRAWN), diameter / 2.0, 1.0)]
        case Capsule(diameter=diameter, length=length) if length > 0.0:
            return [(np.array([0.0, -1.0, 0.0]), diameter / 2.0, 1.0)]
        case Cylinder(diameter=diameter, height=height):
            radius, half = diameter / 2.0, height / 2.0
            slant = math.hypot(radius, half)
            end = (1.0 - half / slant) / 2.0 * (1.0 - half / slant)
            side = half / slant * math.sqrt(1.0 - radius / slant)
            total = side + 2.0 * end
            ends = [(np.array([0.0, 0.0, z]), half, end / total) for z in (-1.0, 1.0)]
            return [*ends, (np.array([0.0, -1.0, 0.0]), radius, side / total)]
    return None


def _replaced(state: StableState, exact: list[tuple[FloatArray, float, float]]) -> StableState:
    """The state of a faceted form by the exact one that it stands for: that with the same direction along the axis."""
    normal, height, probability = min(exact, key=lambda one: abs(float(one[0][2]) - state.normal[2]))
    return _standing(normal, height, probability, np.zeros(3))


def _counted(state: StableState, count: int, drops: int) -> StableState:
    """Wilson's score interval (Probable Inference, Journal of the American Statistical Association 22, 1927)."""
    found = count / drops
    square = _Z_95**2 / drops
    middle = (found + square / 2.0) / (1.0 + square)
    half = _Z_95 * math.sqrt(found * (1.0 - found) / drops + square / (4.0 * drops)) / (1.0 + square)
    return replace(state, probability=found, interval=(max(middle - half, 0.0), min(middle + half, 1.0)))


def _held(states: Sequence[StableState], first: int, share: float) -> list[StableState]:
    """`share` of the full probabilities, and the rest for the state that the part is held in."""

    def mixed(place: int, probability: float) -> float:
        return share * probability + (1.0 - share) * (place == first)

    return [
        replace(
            one,
            probability=mixed(place, one.probability),
            interval=one.interval and (mixed(place, one.interval[0]), mixed(place, one.interval[1])),
        )
        for place, one in enumerate(states)
    ]


def _vector(values: Sequence[float], what: str) -> FloatArray:
    vector = np.array([float(one) for one in values])
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise UsageError(f"{what} is not three numbers")
    return vector
