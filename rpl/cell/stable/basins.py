"""Which facets of a hull make one resting state, and how likely each state is: the fast, quasi-static estimator.

The height of the centre of mass over all orientations is a landscape: its valleys are the stable states, its passes lie
where the part rolls over an edge. A part that bounces and rolls has energy enough for every pass at first and loses it;
at each pass that it can no longer cross it is shut into one of the two sides. How likely it is then on which side is
taken in proportion to the orientations there, each weighted with the energy that is left above it:

    W(side) = sum over its states of  solid angle * (1 - height of the centre of mass / height of the pass) ** k

The probability of a state is the product of these choices down the tree of passes (such trees are known as
disconnectivity graphs: Becker and Karplus, 1997). k is half the number of axes about which the part has to be lifted to
tilt it, as the volume in phase space that belongs to an energy grows: 1 on a flat facet; 1/2 on a face that rolls one
way, such as the side of a cylinder; 0 on a ball.

For a long bar of rectangular section, which has one kind of pass, this is the rule of Pender and Uhrin (Predicting
Non-Square 2D Dice Probabilities, arXiv:1407.6307, 2014): angle times energy barrier; and solid angle and energy barrier
are what Boothroyd's and Ngoi's measures for parts are made of. What is new against their plain product is which barrier
counts: not the lowest edge around a facet, behind which may lie a facet of the same kind, but the pass that parts one
group of states from another. Nothing in it is fitted; tests/cell/test_stable_published.py holds it against throws.

Facets of a curved face are one state: passes between them are so low that they stop nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from rpl.cell.stable.hull import Hull
from rpl.emulator.rotations import FloatArray, IntArray

# A pass is none when it is this much higher than the valley, in parts of its height: 16 or more facets around a circle.
_CURVED = 0.02
_CURVED_COSINE = np.cos(np.radians(23.0))  # between neighbouring facets of a curved face
_SAME_PLANE = np.radians(0.5)
_LEVEL_SLOPE = 0.2  # of the height over the angle, in parts of the height
_ANOTHER_AXIS = 0.1
_LEVEL = 1e-10  # rounding: a facet that is no valley at all


@dataclass(frozen=True, slots=True, eq=False)
class Basins:
    """The states of a hull, in no order."""

    state_of: IntArray  # (f,): the state that a part lying on this facet, or rolling from it, ends in
    probabilities: FloatArray  # (s,)
    leaving: FloatArray  # (s,): height of the centre of mass that the state is left at; infinite for the only state
    lowest: IntArray  # (s,): a facet that it lies on with the centre of mass as low as it gets


@dataclass(slots=True)
class _Group:
    """Facets that passes up to now connect."""

    facet: int  # the lowest
    low: float
    share: float
    energy: float  # sum of share * height
    rolling: float  # sum of share * axes about which it rolls freely
    # Of curved faces within: share, mean height, k. They are taken out of the sums above.
    curved: list[tuple[float, float, float]] = field(default_factory=list)
    parts: tuple[_Group, _Group] | None = None
    chances: tuple[float, float] = (1.0, 0.0)
    shut_at: float = np.inf

    def weight(self, height: float) -> float:
        flat = max(self.share - self.energy / height, 0.0)
        return flat + sum(share * math.pow(max(1.0 - mean / height, 0.0), k) for share, mean, k in self.curved)

    def take(self, other: _Group) -> None:
        self.share += other.share
        self.energy += other.energy
        self.rolling += other.rolling
        self.curved += other.curved

    def settle(self) -> None:
        """A face that is whole: a curved one has an exponent of its own."""
        if self.rolling > 0.0:
            self.curved = [(self.share, self.energy / self.share, 1.0 - self.rolling / self.share / 2.0)]
            self.share = self.energy = self.rolling = 0.0


class _Forest:
    """Sets of facets that grow together."""

    def __init__(self, count: int) -> None:
        self.above = list(range(count))

    def top(self, one: int) -> int:
        while self.above[one] != one:
            self.above[one] = self.above[self.above[one]]
            one = self.above[one]
        return one


def basins_of(hull: Hull) -> Basins:
    """States and probabilities. Passes are taken from the lowest upwards; each joins two groups of facets."""
    count = len(hull.heights)
    cosines = np.einsum("ij,ij->i", hull.normals[hull.neighbours[:, 0]], hull.normals[hull.neighbours[:, 1]])
    joined, states = _Forest(count), _Forest(count)
    groups = {
        facet: _Group(facet, low, share, share * low, share * free)
        for facet, (low, share, free) in enumerate(
            zip(hull.heights.tolist(), hull.shares.tolist(), _free_axes(hull, cosines).tolist(), strict=True)
        )
    }
    curved = np.flatnonzero(cosines >= _CURVED_COSINE)
    # First facets of curved faces grow together, where they do not have a valley of their own; then all.
    for edges, deepest in ((curved, _CURVED), (np.arange(len(cosines)), _LEVEL)):
        for edge in edges[np.argsort(hull.saddles[edges], kind="stable")].tolist():
            one, other = hull.neighbours[edge].tolist()
            first, second = joined.top(one), joined.top(other)
            if first == second:
                continue
            if groups[first].low > groups[second].low:
                first, second, one, other = second, first, other, one
            deep, shallow = groups[first], groups[second]
            height = float(hull.saddles[edge])
            if height - shallow.low <= deepest * height:
                # The shallow one is a single state: all passes within it are lower still. It rolls on over this edge.
                states.above[states.top(other)] = states.top(one)
                deep.take(shallow)
            elif deepest == _LEVEL:
                groups[first] = _branch(deep, shallow, height)
            else:
                continue
            joined.above[second] = first
            del groups[second]
        if deepest == _CURVED:
            for group in groups.values():
                group.settle()
    (whole,) = groups.values()
    return _told(whole, [states.top(facet) for facet in range(count)])


def _branch(deep: _Group, shallow: _Group, height: float) -> _Group:
    weights = deep.weight(height), shallow.weight(height)
    total = sum(weights)
    chances = (weights[0] / total, weights[1] / total) if total > 0.0 else (0.5, 0.5)
    deep.shut_at = shallow.shut_at = height
    both = _Group(deep.facet, deep.low, 0.0, 0.0, 0.0, parts=(deep, shallow), chances=chances)
    both.take(deep)
    both.take(shallow)
    return both


def _free_axes(hull: Hull, cosines: FloatArray) -> FloatArray:
    """About how many axes (f,) the part rolls on from a facet without being lifted: 0 on a flat face, 1 on the side of
    a cylinder or cone, 2 on a ball; from the directions of the neighbours that lie as high."""
    one, other = hull.neighbours[:, 0], hull.neighbours[:, 1]
    angles = np.arccos(np.clip(cosines, -1.0, 1.0))
    slope = np.abs(hull.heights[one] - hull.heights[other]) / np.maximum(hull.heights[one], hull.heights[other])
    rolls = np.flatnonzero((cosines >= _CURVED_COSINE) & (angles > _SAME_PLANE) & (slope <= _LEVEL_SLOPE * angles))
    turns = hull.normals[one[rolls]] - hull.normals[other[rolls]]
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    spread = np.zeros((len(hull.heights), 3, 3))
    for side in (one, other):
        np.add.at(spread, side[rolls], turns[:, :, None] * turns[:, None, :])
    sizes = np.linalg.eigvalsh(spread)
    return np.asarray((sizes > _ANOTHER_AXIS * np.maximum(sizes.sum(axis=1, keepdims=True), 0.5)).sum(axis=1), float)


def _told(whole: _Group, tops: list[int]) -> Basins:
    names: dict[int, int] = {}
    chances: list[float] = []
    leaving: list[float] = []
    lowest: list[int] = []
    ahead = [(whole, 1.0)]
    while ahead:
        group, chance = ahead.pop()
        if group.parts is None:
            names[tops[group.facet]] = len(chances)
            chances.append(chance)
            leaving.append(group.shut_at)
            lowest.append(group.facet)
        else:
            ahead += [(part, chance * share) for part, share in zip(group.parts, group.chances, strict=True)]
    state_of = np.array([names[top] for top in tops], dtype=np.int64)
    return Basins(state_of, np.array(chances), np.array(leaving), np.array(lowest, dtype=np.int64))
