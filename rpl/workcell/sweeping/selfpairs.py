"""Which things of one arm are never looked at together, since they touch however it stands: found by Pinocchio.

Links that follow each other meet in their joint. Links with one other between them are kept apart by the limits of the
axes; where the bodies are capsules of assumed thickness, these would only be wrong about them. Other pairs count as one
piece where they touch at home, or in nearly all of some hundred postures drawn once and for all within the limits (the
rules of MoveIt's setup assistant).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from rpl.cell.armbodies import bodies_of
from rpl.emulator.model import RobotModel
from rpl.workcell.sweeping.geometrymodel import geometry_model
from rpl.workcell.sweeping.tracks import Piece, Thing
from rpl.workcell.sweeping.ways import Way

POSTURES = 200
# In this share of the postures or more is always.
ALWAYS = 0.95


def touching_always(
    ways: Sequence[Way], things: Sequence[tuple[int, Thing, list[Piece]]]
) -> tuple[frozenset[tuple[int, int]], list[tuple[int, int, str]]]:
    """Pairs of things of one robot, by number, the lower first, that are not looked at; and those of them that the
    postures decided, with the reason."""
    apart: set[tuple[int, int]] = set()
    said: list[tuple[int, int, str]] = []
    for number, way in enumerate(ways):
        own = [one for one in things if one[1].way == number]
        links = sorted({thing.link for _, thing, _ in own})
        wanted = []
        for first, second in combinations(own, 2):
            low, high = sorted((first[1].link, second[1].link))
            if low == high:
                continue
            pair = (min(first[0], second[0]), max(first[0], second[0]))
            arm = first[1].kind == "link" and second[1].kind == "link"
            if arm and links.index(high) - links.index(low) <= (2 if bodies_of(way.model).fitted else 1):
                apart.add(pair)
            else:
                wanted.append((pair, first[2], second[2]))
        for place, (at_home, share) in enumerate(_touching(way.model, [(one, other) for _, one, other in wanted])):
            if at_home or share >= ALWAYS:
                pair = wanted[place][0]
                apart.add(pair)
                said.append((*pair, "touch at home" if at_home else "touch in nearly every posture"))
    return frozenset(apart), said


def _touching(model: RobotModel, pairs: Sequence[tuple[list[Piece], list[Piece]]]) -> list[tuple[bool, float]]:
    """For each pair whether it touches at home, and in which share of the drawn postures."""
    pieces: list[Piece] = []
    numbers: dict[int, int] = {}
    solids: list[tuple[int, int]] = []
    owners: list[int] = []
    for place, sides in enumerate(pairs):
        for piece in (piece for side in sides for piece in side):
            if id(piece) not in numbers:
                numbers[id(piece)] = len(pieces)
                pieces.append(piece)
        for first in sides[0]:
            for second in sides[1]:
                solids.append((numbers[id(first)], numbers[id(second)]))
                owners.append(place)
    geometry = geometry_model(model, pieces, solids)
    draws = np.random.default_rng(0).uniform(model.limits[:, 0], model.limits[:, 1], (POSTURES, model.axes))
    counts = np.zeros((1 + POSTURES, len(pairs)), dtype=bool)
    for row, theta in enumerate(model.theta(np.vstack([model.home, draws]))):
        for owner, touches in zip(owners, geometry.collisions(theta), strict=True):
            counts[row, owner] |= touches
    shares = counts[1:].mean(axis=0)
    return [(bool(at_home), float(share)) for at_home, share in zip(counts[0], shares, strict=True)]
