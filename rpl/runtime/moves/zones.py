"""How large a zone is on two moves: of the path, and extended, where the tool and external axes go over.

The corner path begins at the zone of the place. Tool and external axes begin to go over to the next target at the
extended zone, which is never smaller. Where the tool turns or external axes move far beside the way, the zone is
reduced to the smallest of its sizes relative to the programmed motion: size along the way / way, angle / angle turned,
size of an external axis / its way; where the tool centre point does not move, the angle and the axes alone decide.
Source: ABB RAPID Reference Manual, zonedata ("Reduced zone") and overview 5, 2.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl.runtime.moves.orders import BlendOrder

if TYPE_CHECKING:
    from rpl.emulator.planner import PlannedMove
    from rpl.runtime.values import Record

MOST = 0.5
# Smaller ways (mm) and turns (degrees) are none.
NO_WAY, NO_TURN = 1e-6, 1e-3


@dataclass(frozen=True, slots=True)
class ZoneSize:
    """`path`: mm before and behind the point, where the corner path begins; `extended`: where tool and external axes
    begin to go over, None: with the path. `shares`: of the two moves instead, where they have no way."""

    path: float | None = None
    extended: float | None = None
    shares: tuple[float, float] | None = None


def zone_size(
    order: BlendOrder, first: PlannedMove, second: PlannedMove | None, sliding: tuple[bool, ...] = ()
) -> ZoneSize:
    """The zone at the end of the first move; `second`: where it is known already. Half of each move is the most, which
    is for whoever makes the corner to see to."""
    assert order.zone is not None
    radius = float(order.distance if order.distance is not None else order.zone.get("path") or 0.0)
    moves = [move for move in (first, second) if move is not None]
    ways = [_way(move) for move in moves]
    limits = [_limits(order.zone, radius, move, way, sliding) for move, way in zip(moves, ways, strict=True)]
    if min(ways) < NO_WAY:  # between a way and none, half of the smaller one is nothing
        if max(ways) >= NO_WAY or not all(limits):
            return ZoneSize()
        shares = [min((MOST, *found)) for found in limits]
        return ZoneSize(shares=(shares[0], shares[-1]))
    if radius <= 0.0:
        return ZoneSize()
    sizes = [share * way for way, found in zip(ways, limits, strict=True) for share in found if way >= NO_WAY]
    extended = min(sizes, default=radius)
    return ZoneSize(min(radius, extended), extended if extended > radius else None)


def largest(order: BlendOrder, first: PlannedMove, second: PlannedMove | None, sliding: tuple[bool, ...]) -> float:
    """The largest of the zones at the end of the first move, mm: before it the program may go on."""
    assert order.zone is not None
    names = ("rotation_path", "external_path") if order.distance is not None else (
        "path", "rotation_path", "external_path")  # fmt: skip
    sizes = [float(order.zone.get(name) or 0.0) for name in names]
    size = zone_size(order, first, second, sliding)
    most = max(*sizes, order.distance or 0.0)
    reduced = size.path is not None and size.path < float(order.distance or order.zone.get("path") or 0.0)
    return size.path if reduced and size.path is not None else most


def _limits(zone: Record, radius: float, move: PlannedMove, way: float, sliding: tuple[bool, ...]) -> list[float]:
    """The sizes of the zone relative to what the tool and the external axes do on one move. M: a size of zero is none:
    who fills in the path's zone alone means that."""
    shares = []
    turn = _turn(move)
    if turn > NO_TURN:
        shares += _relative(max(float(zone.get("rotation_path") or 0.0), radius), way, NO_WAY)
        shares += _relative(float(zone.get("rotation") or 0.0), turn, NO_TURN)
    for place, moved in enumerate(abs(move.external_end - move.external_start)):
        if moved > NO_WAY:
            name = "linear_external" if place < len(sliding) and sliding[place] else "rotary_external"
            shares += _relative(max(float(zone.get("external_path") or 0.0), radius), way, NO_WAY)
            shares += _relative(float(zone.get(name) or 0.0), float(moved), NO_WAY)
    return shares


def _relative(size: float, whole: float, least: float) -> list[float]:
    return [size / whole] if size > 0.0 and whole >= least else []


def _way(move: PlannedMove) -> float:
    import numpy as np

    return float(move.geometry.distance(np.array([1.0]))[0])


def _turn(move: PlannedMove) -> float:
    """Degrees that the tool turns by from the start of the move to its end."""
    import numpy as np

    from rpl.emulator.rotations import rotation_angle

    start, end = move.geometry.tcp(np.array([0.0, 1.0]))[:, :3, :3]
    return float(np.rad2deg(rotation_angle(start.T @ end)))
