"""What a target knows of places: notations, postures, and what is done with components of a place."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class Postures(StrEnum):
    """What says which of several postures a place is reached in."""

    FLAGS = auto()  # words of the notation in the target
    JOINTS = auto()  # joints that a joint move solves near to; targets have none


class PlaceRule(StrEnum):
    """What a controller does with places."""

    QUATERNIONS = auto()
    """What turns a place is rot, of four numbers (else angles a, b, c about z, y, x)."""

    KEEP_ANGLES = auto()
    """A place keeps its angles a, b and c as they were set (else each angle that is set is put together with the
    others, which are worked out from the place)."""

    WHOLE = auto()
    """A component is set by making a new place of the old one, which must have a value."""

    UNTYPED = auto()
    """What holds a place holds a pose or joints, as it was given last; a component is one of what is there."""

    PARTIAL = auto()
    """A target may leave components out: those of the robot's place hold."""

    IN_BASE = auto()
    """Functions of places know only the tool in use and the robot's base."""

    TURNS = auto()
    """A joint move to a place comes there in the turns that are told with it, by flags or by the joints that it is
    solved near to (else the controller takes each axis the shortest way)."""

    POSTURE_SAID = auto()
    """Every place says a posture, and a joint move heeds it."""

    AXIS_SIGNS = auto()
    """A posture is the sign of every axis: a place that is worked out of a taught one may need another."""


@dataclass(frozen=True, slots=True)
class Places:
    """What is known of places."""

    notation: str
    """Of the arm configuration (rpl.emulator.configuration)."""

    postures: Postures = Postures.FLAGS

    rules: frozenset[PlaceRule] = frozenset((PlaceRule.KEEP_ANGLES, PlaceRule.TURNS))

    kinematics: tuple[str, str] | None = None
    """The controller's functions for the joints of a target (near joints) and for the target of joints, that write 0 or
    an error into a further argument, when that is how it says so."""

    move_functions: frozenset[str] = frozenset()
    """Functions (and `:`) that a move's target may be although nothing else can: a place seen from another one, with
    simple operands."""
