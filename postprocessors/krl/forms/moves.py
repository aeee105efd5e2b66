"""What the inline form of a move says, and which moves have one.

A form names a taught point with its own tool and base (FDAT, by number), a constant speed and, in PDAT or LDAT, the
acceleration, the size of the corner and how the tool turns. It sets all these itself, to what is in force there anyway:
what follows a form finds the settings as it would without it. Sources: KUKA's basis package (`dialects/krl/prelude.src`
has what BAS does with the data), public programs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rpl import ir
from rpl.passes.legalise.facts.motion.saidaccelerations import number_of as written_number

from .. import tables

State = Mapping[str, "ir.Expression | None"]

# What BAS(#INITMOV,0) sets, in neutral units (mm, deg, s, percent), with the defaults as shipped.
INITMOV = {
    "advance": 3.0,
    "joint_speed": 100.0,
    "joint_acceleration": 50.0,
    "path_speed": 2000.0,
    "swivel_speed": 200.0,
    "twist_speed": 200.0,
    "path_acceleration": 2300.0,
    "swivel_acceleration": 100.0,
    "twist_acceleration": 100.0,
    "blend_joint": 50.0,
    "blend_distance": 3.0,
    "blend_speed": 100.0,
    "blend_rotation": 5.0,
}
FASTEST_MM_S = INITMOV["path_speed"]  # BAS limits the speed of a path form to the default
USUAL_SIZE = 100.0  # of a corner that the form does not drive: percent or mm, as a new form says it

JOINT_FORM = frozenset(("tool", "base", "joint_speed", "joint_acceleration", "interpolation"))
PATH_FORM = frozenset(
    (
        *("tool", "base", "path_speed", "swivel_speed", "twist_speed", "path_acceleration", "swivel_acceleration"),
        *("twist_acceleration", "blend_distance", "orientation_mode", "circle_orientation", "interpolation"),
    )
)
_ORIENTATIONS = {"variable": "VAR", "constant": "CONSTANT", "wrist": "JOINT"}
_ARCS = {"base": "BASE", "path": "PATH"}


@dataclass(frozen=True, slots=True)
class Form:
    """word: PTP, LIN. tool, base: numbers. speed: percent or m/s. acceleration: percent of the default. corner: the
    setting that has the size of a corner (`blend_joint`, `blend_distance`); size: percent or mm, None where the move
    drives no corner. orientation, arc: members of LDAT."""

    word: str
    tool: int
    base: int
    speed: float
    acceleration: float
    corner: str
    size: float | None
    orientation: str = ""
    arc: str = ""

    @property
    def joint(self) -> bool:
        return self.word == "PTP"

    @property
    def sets(self) -> frozenset[str]:
        return JOINT_FORM | {self.corner} if self.joint else PATH_FORM


def form_of(move: ir.Move, state: State) -> Form | None:
    """The form of a move to a named point where these settings are in force; None: it has none."""
    if not is_plain(move):
        return None
    tool, base = number_of_frame(state.get("tool"), "tool"), number_of_frame(state.get("base"), "base")
    if tool is None or base is None:
        return None
    return _joint_form(move, state, tool, base) if move.kind == "joint" else _path_form(move, state, tool, base)


def is_plain(move: ir.Move) -> bool:
    """Is it a move that says no more than a form can: to one named point, and all else modal?"""
    named = isinstance(move.target, ir.Name) and move.kind in ("joint", "linear") and move.motion_class == "classic"
    own = (move.relative, move.tool, move.frame, move.load, move.speed, move.acceleration, move.orientation)
    more = move.triggers or move.search or move.settings or move.concurrent or move.without_offsets or move.identity
    return named and all(one is None for one in own) and not more and move.group == 1


def _joint_form(move: ir.Move, state: State, tool: int, base: int) -> Form | None:
    speed, acceleration = number_of(state.get("joint_speed")), number_of(state.get("joint_acceleration"))
    match move.blend:
        case None | ir.BlendStop():
            corner, driven = "blend_joint", False
        case ir.BlendPercent(percent=ir.System(name="blend_joint"), path=None):
            corner, driven = "blend_joint", True
        case ir.BlendDistance(distance=None | ir.System(name="blend_distance"), rotation=None):
            corner, driven = "blend_distance", True
        case _:
            return None
    size = number_of(state.get(corner))
    if speed is None or not 0.0 < speed <= 100.0 or acceleration is None or (driven and size is None):
        return None
    share = acceleration / INITMOV["joint_acceleration"] * 100.0
    if not 1.0 <= share <= 100.0 or share != int(share) or (driven and not _is_size(corner, size)):
        return None
    return Form("PTP", tool, base, speed, share, corner, size if driven else None)


def _is_size(corner: str, size: float | None) -> bool:
    return size is not None and size > 0.0 and (corner != "blend_joint" or size <= 100.0)


def _path_form(move: ir.Move, state: State, tool: int, base: int) -> Form | None:
    match move.blend:
        case None | ir.BlendStop():
            driven = False
        case ir.BlendDistance(distance=None | ir.System(name="blend_distance"), rotation=None):
            driven = True
        case _:
            return None
    speed, size = number_of(state.get("path_speed")), number_of(state.get("blend_distance"))
    as_usual = all(
        number_of(state.get(name)) == INITMOV[name] for name in ("swivel_speed", "twist_speed", "path_acceleration")
    )
    if speed is None or not 0.0 < speed <= FASTEST_MM_S or not as_usual:
        return None
    orientation = _ORIENTATIONS.get(_member(state.get("orientation_mode")))
    arc = _ARCS.get(_member(state.get("circle_orientation")))
    if orientation is None or arc is None or (driven and not _is_size("blend_distance", size)):
        return None
    return Form("LIN", tool, base, speed / 1000.0, 100.0, "blend_distance", size if driven else None, orientation, arc)


def _member(value: ir.Expression | None) -> str:
    return value.member.lower() if isinstance(value, ir.EnumLiteral) else ""


def number_of(value: ir.Expression | None) -> float | None:
    """A number that is written, in the neutral unit, without what units add behind its ninth place."""
    known = written_number(value)
    return None if known is None else round(known, 9)


def number_of_frame(value: ir.Expression | None, name: str) -> int | None:
    """The number of a tool or base in force; 0: the flange, the robot's own base."""
    match value:
        case ir.System(name="null_frame"):
            return 0
        case ir.Index(base=ir.Name(id=bank), indices=(ir.IntLiteral(value=number),)):
            return number if bank.upper() == tables.SELECTED[name] and number > 0 else None
    return None
