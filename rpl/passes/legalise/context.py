"""What every legalisation pass is given, and how it makes new names and temporaries."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.columns import Stretch
from rpl.ir.standing import NOTHING, Standing
from rpl.passes.analog import AnalogRanges
from rpl.passes.capabilities import Capabilities
from rpl.passes.scope import Fold, ProgramScope, rules_of
from rpl.source import Origin


class Arm(Protocol):
    """What the passes need to know of an arm (rpl.emulator.model.RobotModel is one). Joints in its own units (deg, mm),
    poses as 4x4 matrices in mm, flange in the robot's base frame."""

    @property
    def name(self) -> str: ...

    @property
    def axes(self) -> int: ...

    @property
    def home(self) -> Any: ...

    @property
    def speeds(self) -> Any: ...

    @property
    def accelerations(self) -> Any: ...

    @property
    def pulses_per_degree(self) -> Any: ...

    @property
    def pulse_scale(self) -> Any: ...

    def external_pulses(self, number: int) -> float | None: ...

    def forward(self, joints: Any) -> Any: ...

    def inverse(self, flange: Any, reference: Any) -> Any: ...

    def expand_turns(self, solution: Any) -> Any: ...

    def posture(self, joints: Any) -> Any: ...

    @property
    def has_sides(self) -> bool: ...

    def in_posture(self, flange: Any, near: Any, asked: Mapping[str, str]) -> Any: ...

    def same_posture(self, joints: Any, other: Any) -> Any: ...

    def nearest(self, flange: Any, reference: Any) -> Any: ...

    def nearest_turn(self, joints: Any, reference: Any) -> Any: ...

    def within_limits(self, joints: Any) -> Any: ...


@dataclass(frozen=True, slots=True)
class Unreached:
    """A place or joints to which an arm does not come: what it is in words, why not, and where it stands."""

    what: str
    reason: str
    origin: Origin


@dataclass(slots=True)
class Context:
    """`source` and `target` are dialect names. `robot` is the arm the source was written for, `to_robot` the arm that
    will run the result; either may be None (then what needs it is reported). `taken` are all names in use, folded.
    `register_names`: (bank, number) -> source name for data that has got a number, filled by the passes (types beside);
    `registers`: the numbers that an earlier translation gave, to be honoured; `said_numbers`: those that remarks behind
    declarations say (folded name -> bank and number). `signal_groups`: groups of signals that
    had a name and are written by their numbers, and signals of a number that are written by their names.
    `signal_names`: the names of numbered signals, (kind, number) -> name. `analog`: what
    is said of analogue signals, by language. `stretches`: of runs, for each of which one move stands in the program;
    `before`: the reports that were there in front of the passes. `unreached`: places to which the arm that runs the
    result does not come, by where they stand in the source; `flanges`: where it has to come, as far as that is known,
    4x4 in mm, in the arm's base. `there`: what stands on the robot that will run it. `unknown`: data, folded, that the
    source's controller keeps and whose value stands in no file; its zero is nothing to begin with. `renamed`: data that
    passes have given another name, as the target's people name it: name before the passes -> name. `options`: the
    target's own, by name."""

    source: str
    target: str
    capabilities: Capabilities
    diagnostics: Diagnostics
    robot: Arm | None = None
    to_robot: Arm | None = None
    taken: set[str] = field(default_factory=set)
    register_names: dict[tuple[str, int], str] = field(default_factory=dict)
    register_types: dict[tuple[str, int], str] = field(default_factory=dict)
    registers: Mapping[tuple[str, int], str] = field(default_factory=dict)
    said_numbers: dict[str, tuple[str, int]] = field(default_factory=dict)
    signal_groups: dict[str, ir.Signal] = field(default_factory=dict)
    signal_names: dict[tuple[str, int], str] = field(default_factory=dict)
    analog: Mapping[str, AnalogRanges] = field(default_factory=dict)
    stretches: tuple[Stretch, ...] = ()
    before: int = 0
    unreached: dict[tuple[int, int], Unreached] = field(default_factory=dict)
    flanges: list[Any] = field(default_factory=list)
    options: Mapping[str, str] = field(default_factory=dict)
    there: Standing = NOTHING
    unknown: set[str] = field(default_factory=set)
    renamed: dict[str, str] = field(default_factory=dict)

    @property
    def foreign(self) -> bool:
        """Is the target another language than the source?"""
        return self.source != self.target

    def not_reached(self, origin: Origin, what: str, reason: str) -> None:
        """The arm that runs the result does not come to what stands there."""
        self.unreached[id(origin.source), origin.start] = Unreached(what, reason, origin)

    def fresh(self, stem: str) -> str:
        """A name that nothing in the program has: `stem`, else `stem2`, `stem3`, ... Deterministic."""
        fold = Fold(False)
        name, number = stem, 1
        while fold(name) in self.taken:
            number += 1
            name = f"{stem}{number}"
        self.taken.add(fold(name))
        return name


def array(values: Any) -> Any:
    """Joints or a matrix as an arm takes them. Most translations ask nothing of an arm, so what works with arrays is
    loaded here."""
    import numpy as np

    return np.array(values, dtype=np.float64)


def names_in(program: ir.Program) -> set[str]:
    """All declared names of the program and of its dialects' preludes, folded to lower case."""
    taken: set[str] = set()
    for module in program.modules:
        taken.add(module.name.lower())
        for declaration in module.declarations:
            _add(declaration, taken)
        for routine in module.routines:
            taken.add(routine.name.lower())
            taken.update(parameter.name.lower() for parameter in routine.parameters)
            for declaration in routine.declarations:
                _add(declaration, taken)
    return taken


def _add(declaration: ir.Declaration, taken: set[str]) -> None:
    match declaration:
        case ir.EnumDeclaration(name=name, members=members):
            taken.add(name.lower())
            taken.update(member.lower() for member in members)
        case ir.Initialise() | ir.Unread():
            return
        case _:
            taken.add(declaration.name.lower())


__all__ = ["Arm", "Context", "ProgramScope", "array", "names_in", "rules_of"]
