"""How a target's robot moves: ways, paths, what happens on a path, and whether the program goes on meanwhile."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class TurnedWay(StrEnum):
    """A relative move that may turn the tool too: in the axes of the frame or the tool, or as a joint move."""

    BASE = auto()
    TOOL = auto()
    JOINT = auto()


class PathRule(StrEnum):
    """What a path may be."""

    ARCS_BY_ANGLE = auto()
    """An arc may go on for an angle (else it ends at a computed point)."""

    FIXED_ARCS = auto()
    """An arc may keep the tool as it is to the arc (else its end is worked out)."""

    TIMED_ARCS = auto()
    """An arc may say its time, where the other moves can (else it gets the speed that takes so long)."""

    STRAIGHT_DISTANCES = auto()
    """A place on the way of an arc is looked for by how far it is straight from an end of the arc."""

    CURVE_POINTS = auto()
    """Moves of the kind spline in a row, from a first one at its beginning, are one curve through points (INFORM
    MOVS); there are no spline blocks."""

    CUT = auto()
    """A move between constants is cut at the places of its actions, by passes of the target."""

    TO_JOINTS = auto()
    """A straight move may go to joint values."""

    EVEN_WRIST = auto()
    """The wrist axes of a straight move may go evenly to their end values."""

    SEARCHED_DATA = auto()
    """A search may look at a truth value, which another task sets, in place of an input."""


class TriggerRule(StrEnum):
    """What an action on the path may be."""

    OF_MOVES = auto()
    """A move says the actions on its path itself (Move.triggers), and only so."""

    LATE = auto()
    """It may come some time behind the end of a move that stops there (else a task does it)."""

    ANY_VARIABLE = auto()
    """It may assign any variable (else signals: a routine assigns the others)."""


class SearchResult(StrEnum):
    """What a search move gives: the place, and whether there was one."""

    FOUND = auto()
    HIT = auto()


@dataclass(frozen=True, slots=True)
class Motion:
    """What moves can be."""

    relative: bool = False
    """A move may go on from where the one before it ends."""

    tool_ways: bool = True
    """Such a move may go along the tool (else it goes to the place before moved along it, where that is known)."""

    turned_ways: frozenset[TurnedWay] = frozenset(TurnedWay)
    """The relative moves that may turn the tool (the others go to a computed place)."""

    paths: frozenset[PathRule] = frozenset((PathRule.TO_JOINTS, PathRule.EVEN_WRIST))

    triggers: frozenset[TriggerRule] = frozenset((TriggerRule.LATE, TriggerRule.ANY_VARIABLE))

    concurrent: bool = False
    """A move may say that the program goes on while it is driven."""

    search_results: frozenset[SearchResult] = frozenset((SearchResult.FOUND,))
