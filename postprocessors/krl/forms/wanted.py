"""Which settings are asked for behind each statement, where some moves are forms: a form sets what it needs itself, so
what stands in front of it for its sake alone is left out.

Backwards over every routine, with what its callers want behind it and what the routines want that it calls, again until
nothing is added. Conservative: what cannot be followed (refused statements, vendors', interrupts) wants everything.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field

from rpl import ir
from rpl.passes.legalise.facts.effects import children, everything
from rpl.passes.legalise.facts.forward import reactions
from rpl.passes.legalise.facts.liveness import Liveness, Names
from rpl.passes.legalise.facts.settingsinforce import IN_FRAME

from .moves import Form

SETTINGS: Names = frozenset(
    (
        *("tool", "base", "joint_speed", "joint_acceleration", "path_speed", "swivel_speed", "twist_speed"),
        *("path_acceleration", "swivel_acceleration", "twist_acceleration", "blend_joint", "blend_distance"),
        *("orientation_mode", "circle_orientation", "interpolation", "blend_speed", "blend_rotation"),
    )
)
_FRAMES: Names = frozenset(("tool", "base"))
_BLENDS: Names = frozenset(("blend_joint", "blend_distance", "blend_speed", "blend_rotation"))
_JOINT: Names = frozenset(("tool", "base", "joint_speed", "joint_acceleration"))
_PATH: Names = SETTINGS - _BLENDS - _JOINT | _FRAMES
_NOTHING: Names = frozenset()


@dataclass(slots=True)
class Wanted:
    """`asks`: routine (folded) -> settings that it may ask for, itself or by what it calls, before it sets them;
    `ends`: what may be wanted where it has ended. `behind`: id of a statement -> settings that may be asked for behind
    it before they are set again. `always`: what interrupts ask for."""

    forms: Mapping[int, Form]
    asks: dict[str, Names]
    ends: dict[str, Names] = field(default_factory=dict)
    behind: dict[int, Names] = field(default_factory=dict)
    always: Names = _NOTHING

    @classmethod
    def of(cls, program: ir.Program, forms: Mapping[int, Form]) -> Wanted:
        """forms: by the identity of the moves."""
        routines = [routine for module in program.modules for routine in module.routines]
        found = cls(forms, {routine.name.lower(): _NOTHING for routine in routines})
        found.settled(routines, found.asks, ends=False)
        beside = {name.lower() for name in reactions(program)}
        found.always = _NOTHING.union(*(found.asks.get(name, SETTINGS) for name in beside))
        found.ends, found.behind = dict.fromkeys(beside, SETTINGS), {}
        found.settled(routines, found.ends, ends=True)
        return found

    def settled(self, routines: Sequence[ir.Routine], grows: Mapping[str, Names], ends: bool) -> None:
        """Again over all routines, until nothing is added to what grows."""
        before: Mapping[str, Names] | None = None
        while before != grows:
            before = dict(grows)
            for routine in routines:
                key = routine.name.lower()
                start = _Routine(routine, self, self.ends.get(key, _NOTHING) if ends else _NOTHING).start
                if not ends:
                    self.asks[key] |= start

    def called(self, name: str, wanted: Names) -> Names:
        """What is wanted in front of a call, where this is wanted behind it."""
        key = name.lower()
        if key not in self.asks:
            return SETTINGS
        self.ends[key] = self.ends.get(key, _NOTHING) | wanted
        return wanted | self.asks[key]


class _Routine(Liveness):
    def __init__(self, routine: ir.Routine, found: Wanted, after: Names) -> None:
        self.found = found
        super().__init__(routine, SETTINGS, after)

    def body(self, body: ir.Body, wanted: Names) -> Names:
        for statement in reversed(body):
            known = self.found.behind.get(id(statement), _NOTHING)
            self.found.behind[id(statement)] = known | wanted | self.found.always
            wanted = self.statement(statement, wanted) | self.raised | self.found.always
        return wanted

    def read(self, *parts: ir.Expression | None) -> Names:
        found: set[str] = set()
        for part in parts:
            for one in everything(part) if part is not None else ():
                match one:
                    case ir.System(name="actual_pose"):
                        found |= _FRAMES
                    case ir.System(name=name):
                        found.add(name)
                    case ir.Builtin(function=function) if function in IN_FRAME:
                        found |= _FRAMES
                    case ir.Call(name=name):  # in the middle of a statement: anything may be wanted behind it
                        self.found.called(name, SETTINGS)
                        found |= self.found.asks.get(name.lower(), SETTINGS)
        return self.names & found

    def statement(self, statement: ir.Statement, wanted: Names) -> Names:
        match statement:
            case ir.Move() if (form := self.found.forms.get(id(statement))) is not None:
                return wanted - form.sets
            case ir.Move():
                return wanted | of_move(statement) | self.read(*children(statement))
            case ir.Spline() | ir.MoveExternal() | ir.Vendor() | ir.Opaque():
                return SETTINGS
            case ir.Assign(target=ir.System(name=name, indices=indices), value=value) if name in SETTINGS:
                rest = indices != () and indices != (ir.IntLiteral(1),)
                return (wanted if rest else wanted - {name}) | self.read(value)
            case ir.CallRoutine(name=name, arguments=arguments):
                given = self.read(*(one.value for one in arguments))
                return self.found.called(name, wanted) | given
        return super().statement(statement, wanted)


def of_move(move: ir.Move) -> Names:
    """What a move asks for that is no form."""
    return (_JOINT if move.kind == "joint" else _PATH) | _of_corner(move.blend)


def _of_corner(blend: ir.Blend | None) -> Names:
    match blend:
        case None | ir.BlendStop():
            return _NOTHING
        case ir.BlendDistance(rotation=rotation):
            return frozenset(("blend_distance",) if rotation is None else ("blend_distance", "blend_rotation"))
        case ir.BlendPercent(path=path):
            return frozenset(("blend_joint",)) | _of_corner(path)
        case ir.BlendSpeed():
            return frozenset(("blend_speed",))
    return _BLENDS


def is_wanted(wanted: Mapping[int, Names], statement: ir.Statement, settings: Set[str]) -> bool:
    """Is one of these settings asked for behind the statement?"""
    return not wanted.get(id(statement), SETTINGS).isdisjoint(settings)


__all__ = ["SETTINGS", "Wanted", "is_wanted"]
