"""Which settings are in force at each move, as the program says them: constants carried through branches, loops and
calls of the whole program.

A setting is known where every way to the place has set the same constant (a literal, or data that nothing assigns).
Routines are entered with what all their calls have in common, and leave with what they have set.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.inforce import InForce
from rpl.passes.legalise.facts.usage import Usage, each_expression, usage_of
from rpl.passes.legalise.facts.values.heldtexts import known_calls
from rpl.passes.legalise.kinds import kinds_within
from rpl.passes.scope import Scope, rules_of
from rpl.passes.signatures import PLACES

SETTINGS = frozenset(("tool", "base", "path_speed", "joint_speed", "blend_distance", "blend_joint"))
# What else is followed, because the size of a corner that a speed decides depends on it. The values are those of a
# controller that says nothing (mm/s2 and percent, as the emulator takes them).
BRAKING = {
    "blend_speed": 100.0,
    "path_acceleration": 5000.0,
    "acceleration_percent": 100.0,
    "joint_acceleration": 100.0,
}
# How the tool turns on arcs and on other paths is followed too; setting it again is never left out, for targets start
# with other rules.
_TURNS = "circle_orientation"
_KEEPS = "orientation_mode"
# What all speeds are a share of, and the highest (RAPID VelSet), as a controller has them that says nothing.
_SHARES = {"speed_percent": 100.0, "speed_limit": 5000.0, "override": 100.0}
# Percentage for slowing down, of languages that have one of their own: none where that is as strong as speeding up.
_DOWN = "deceleration_percent"
# How fast the tool turns; as a setting of its own it is never left out.
_TURNING = frozenset(("swivel_speed", "twist_speed"))
# Whether moves are joined at all (V+ CPON): a truth value.
_JOINED = "blending"
# Whether accelerations are a share of what is said, as the speed is.
SCALED = {"scale_acceleration": False}
# The least time of moves, s; none where nothing is said.
_TIMES = {"move_duration": 0.0}
_NUMBERS = BRAKING.keys() | _SHARES.keys() | _TIMES.keys()
_FOLLOWED = SETTINGS | _NUMBERS | SCALED.keys() | _TURNING | {"displacement", _TURNS, _KEEPS, _JOINED, _DOWN}
# Setting -> constant; None: it depends on the run. A place that is never reached has no state.
State = dict[str, "ir.Expression | None"]
Held = Mapping[str, ir.Expression]  # what of it is known, with a `$` in front
_UNKNOWN: State = dict.fromkeys(_FOLLOWED)


# Functions that give or take a pose in the modal frame where they are not told another, with the number of their
# arguments then: tool and frame are the last ones.
IN_FRAME = {function: tool for function, (tool, _) in PLACES.items()}

_ASKING = frozenset(("system actual_pose", *(f"function {name}" for name in IN_FRAME)))


def in_frame(statement: ir.Statement) -> bool:
    """Does the statement read a pose that depends on the modal frame?"""
    if _ASKING.isdisjoint(kinds_within(statement)):
        return False
    found = False

    def look(one: ir.Expression) -> None:
        nonlocal found
        match one:
            case ir.System(name="actual_pose"):
                found = True
            case ir.Builtin(function=function, arguments=arguments) if function in IN_FRAME:
                found = found or len(arguments) == IN_FRAME[function]

    each_expression(statement, look)
    return found


def _plainly_reads(statement: ir.Statement) -> bool:
    """Is it an assignment that reads or converts a place, and calls nothing that may change a setting?"""
    if not isinstance(statement, ir.Assign) or _ASKING.isdisjoint(kinds_within(statement)):
        return False
    inside = list(walk(statement.value))
    reads = any(isinstance(one, ir.Builtin) and one.function in IN_FRAME for one in inside)
    return reads and not any(isinstance(one, ir.Call) for one in inside)


@dataclass(slots=True)
class SettingsInForce:
    """`start`: the settings at the beginning of a program."""

    usage: Usage
    start: State
    moves: dict[int, State] = field(default_factory=dict)
    repeated: dict[int, bool] = field(default_factory=dict)
    kept: list[object] = field(default_factory=list)  # keeps the identities alive
    reached: set[int] = field(default_factory=set)

    @classmethod
    def of(
        cls, program: ir.Program, defaults: dict[str, float | bool | str], begins: Mapping[str, ir.Expression] = {}
    ) -> SettingsInForce:
        """Follow the program; `defaults` are the system variables of its language at the start, `begins` what else the
        target begins with."""
        program = known_calls(program)
        start: State = {name: _default(name, defaults) for name in _FOLLOWED} | dict(begins)
        found = cls(usage_of(program), start)
        _Settings(program, found)
        return found

    @classmethod
    def begun_by(cls, program: ir.Program, dialect: str) -> SettingsInForce:
        """Follow the program as the controller of this dialect begins it."""
        return cls.of(program, dict(rules_of(dialect).system_defaults))

    def arc_rule(self, move: ir.Move) -> str:
        """How the tool turns on an arc that does not say it: `base`, `path`; empty text: it hangs on the run."""
        rule = self.at(move)[_TURNS]
        return rule.member if isinstance(rule, ir.EnumLiteral) else ""

    def at(self, statement: ir.Statement) -> State:
        """The settings at a move, or where an expression of a statement depends on the frame (all unknown where nothing
        leads)."""
        return self.moves.get(id(statement), _UNKNOWN)

    def never_comes_to(self, statement: ir.Statement) -> bool:
        """Does nothing of the program lead to this move?"""
        return id(statement) not in self.reached

    def again(self, statement: ir.Assign) -> bool:
        """Is the setting known to have this value already?"""
        return self.repeated.get(id(statement), False)


def _default(name: str, defaults: dict[str, float | bool | str]) -> ir.Expression | None:
    if name in ("base", "displacement"):
        return ir.System("null_frame")
    if name in (_TURNS, _KEEPS):
        return ir.EnumLiteral(str(defaults.get(name, "base" if name == _TURNS else "variable")))
    value = defaults.get(name, (BRAKING | _SHARES | _TIMES | SCALED).get(name))
    if isinstance(value, bool):
        return ir.BoolLiteral(value)
    return ir.RealLiteral(float(value)) if isinstance(value, int | float) else None


class _Settings(InForce[ir.Expression]):
    """States have the followed settings with a `$` in front, where they are known."""

    heeds = _ASKING | {"Move"} | {f"system {name}" for name in _FOLLOWED}

    def __init__(self, program: ir.Program, found: SettingsInForce) -> None:
        start = {f"${name}": value for name, value in found.start.items() if value is not None}
        super().__init__(program, start)
        self.found = found
        self.plain: dict[int, tuple[Mapping[str, ir.Expression], State]] = {}
        self.follow_program()

    def assigned(self, name: str, target: ir.Expression, value: ir.Expression, before: Held) -> Held:
        if name[1:] not in _FOLLOWED or not name.startswith("$"):
            return before
        new = self.stable(value) if isinstance(target, ir.System) else None
        if new is None:
            return self.without(before, {name})
        return before if before.get(name) is new else {**before, name: new}

    def note(self, statement: ir.Statement, before: Held) -> None:
        match statement:
            case ir.Assign(target=ir.System(name=name)) if name in _FOLLOWED:
                if name not in (_TURNS, _KEEPS, _JOINED, _DOWN, "override", *_TIMES, *_TURNING):
                    known = before.get(f"${name}")
                    same = known is not None and known == self.stable(statement.value)
                    self.found.repeated[id(statement)] = same and self.found.repeated.get(id(statement), True)
            case ir.Move():
                pass
            case _ if not in_frame(statement) and not _plainly_reads(statement):
                return
        self.found.kept.append(statement)
        if self.reaching:
            self.found.reached.add(id(statement))
        state, known_before = self.said(before), self.found.moves.get(id(statement))
        self.found.moves[id(statement)] = state if known_before is None else _both(known_before, state)

    def said(self, held: Held) -> State:
        """Every followed setting by its name."""
        done = self.plain.get(id(held))
        if done is None:
            self.plain[id(held)] = done = held, {name: held.get(f"${name}") for name in _FOLLOWED}
        return done[1]

    def brought(self, state: Held, home: Scope, there: Scope) -> Held:
        done = ((name, _carried(value, home, there)) for name, value in state.items())
        return {name: value for name, value in done if value is not None}

    # ---- constants

    def stable(self, value: ir.Expression) -> ir.Expression | None:
        """The value when it is the same at every place and time."""
        match value:
            case ir.RealLiteral() | ir.IntLiteral() | ir.BoolLiteral():
                return value
            case ir.EnumLiteral(member=member):
                return ir.EnumLiteral(member.lower())
            case ir.System(name="null_frame" | "world"):
                return ir.System("null_frame")
            case ir.Quantity(value=inner) | ir.Unary(operand=inner) | ir.Convert(operand=inner):
                return value if self.stable(inner) is not None else None
            case ir.Field(base=base):
                return value if self.stable(base) is not None else None
            case ir.Index(base=base, indices=indices):
                return value if all(self.stable(one) is not None for one in (base, *indices)) else None
            case ir.Binary(left=left, right=right):
                return value if self.stable(left) is not None and self.stable(right) is not None else None
            case ir.Aggregate(entries=entries):
                return value if all(self.stable(one) is not None for _, one in entries) else None
            case ir.Name(id=name):
                symbol = self.scope.value(name)
                if symbol is None or symbol.routine is not None or not isinstance(symbol.declaration, ir.Variable):
                    return None
                fixed = symbol.declaration.storage == "constant" or name.lower() not in self.found.usage.assigned
                return value if fixed else None
        return None


def _both(one: State, other: State) -> State:
    """What two ways have in common."""
    lost = [name for name, value in one.items() if value is not None and value != other[name]]
    return {**one, **dict.fromkeys(lost)} if lost else one


def _carried(value: ir.Expression, home: Scope, there: Scope) -> ir.Expression | None:
    """A constant of one routine as another one says it: what has no name there, or a name for something else, is said
    by its value, as far as that is written at its declaration."""
    if all(
        (here := home.value(one.id)) is not None
        and (seen := there.value(one.id)) is not None
        and seen.declaration is here.declaration
        for one in walk(value)
        if isinstance(one, ir.Name)
    ):
        return value
    symbol = home.value(value.id) if isinstance(value, ir.Name) else None
    written = symbol.declaration.initial if symbol and isinstance(symbol.declaration, ir.Variable) else None
    named = any(isinstance(one, ir.Name | ir.Index | ir.Field) for one in walk(written)) if written else True
    return None if named else written
