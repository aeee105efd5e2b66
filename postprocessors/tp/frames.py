"""Tools and user frames: which number a value has, and the lines that give the number its value.

Constant values stand in the controller's tables (the dump SYSFRAME.VA), not in programs. A value that is kept in a
position register is handed over where it is selected.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.standing import NOTHING, Standing
from rpl.passes.fold import constant
from rpl.passes.scope import Scope
from rpl.passes.values import pose_of
from rpl.source import NOWHERE
from rpl.writing.statements import CannotSayError

from . import tables
from .expressions import Expressions
from .lines import Line
from .positions import Position, position_of

WORLD = (0.0,) * 6


@dataclass(slots=True)
class Numbers:
    """The numbers of one kind: `UTOOL` or `UFRAME`. `first`: the number of nothing at all (UFRAME 0 is the world)."""

    word: str
    most: int
    constants: dict[int, tuple[float, ...]] = field(default_factory=dict)
    registers: dict[str, int] = field(default_factory=dict)
    own: set[int] = field(default_factory=set)  # those whose values the writer puts into the controller's table
    there: Standing = NOTHING  # the controller's numbers in use are given to nothing else

    def of_constant(self, value: tuple[float, ...]) -> int:
        number = next((number for number, known in self.constants.items() if known == value), None)
        if number is None:
            number = self.there.like(self.word, value)
            if number is None or number in self.constants:
                number = self._free()
                self.own.add(number)
            self.constants[number] = value
        return number

    def of_register(self, register: str) -> int:
        if register not in self.registers:
            self.registers[register] = self._free()
        return self.registers[register]

    def _free(self) -> int:
        taken = {*self.constants, *self.registers.values(), *self.there.of(self.word)}
        free = next((n for n in range(1, self.most + 1) if n not in taken), None)
        if free is None:
            raise CannotSayError(f"there are only {self.most} numbers for {self.word}")
        return free


@dataclass(slots=True)
class Frames:
    """Tools and user frames of a whole program. `scratch`, `second`: position registers that carry values over."""

    scratch: int = tables.PR.last
    second: int = tables.PR.last - 1
    tools: Numbers = field(default_factory=lambda: Numbers("UTOOL", tables.MOST_TOOLS))
    frames: Numbers = field(default_factory=lambda: Numbers("UFRAME", tables.MOST_FRAMES))
    kept: Mapping[int, tuple[float, ...]] = field(default_factory=dict)  # registers that hold one value all the time
    moved_to: frozenset[int] = frozenset()  # position registers that only moves look at
    free: list[int] = field(default_factory=list)  # number registers that nothing has, the next one first
    saved: dict[str, int] = field(default_factory=dict)  # registers of the writer's own, by their comments
    selected: dict[str, set[str]] = field(default_factory=lambda: {"UTOOL": set(), "UFRAME": set()})

    def select(self, kind: str, value: ir.Expression, expressions: Expressions) -> tuple[list[Line], str]:
        """The lines that select a tool or frame, and its number ('' when it is computed)."""
        numbers = self._numbers(kind)
        table = _table_element(value, kind)
        if table is not None:
            return self._line(numbers, _number_text(table, expressions)), _number_text(table, expressions)
        register = expressions.element(value) if isinstance(value, ir.Index | ir.Name) else None
        if register is not None and register.startswith("PR["):
            number = str(numbers.of_register(register))
            return [Line(f"  {kind}[{number}]={register}"), *self._line(numbers, number)], number
        if register is not None:
            raise CannotSayError("a tool or frame has to be in a position register")
        pose = constant_pose(value, expressions.scope)
        if kind == "UFRAME" and pose == WORLD:
            return self._line(numbers, "0"), "0"
        number = str(numbers.of_constant(pose))
        return self._line(numbers, number), number

    def beside(self, there: Standing) -> None:
        """Keep off the numbers that the controller has for something else; what it has alike is not put there anew."""
        for one in (self.tools, self.frames):
            one.there = there
            alike = (number for number, value in one.constants.items() if there.like(one.word, value) == number)
            one.own.difference_update(alike)

    def is_kept(self, register: str) -> bool:
        """Does the position register hold one value all the time?"""
        digits = register[3:-1].partition(":")[0]
        return digits.isdigit() and int(digits) in self.kept

    def apart(self, kind: str, register: str) -> tuple[list[Line], str]:
        """The lines that select what a position register holds now under a number that no move has."""
        numbers = self._numbers(kind)
        number = str(numbers.of_register(f"{register} seen"))
        return [Line(f"  {kind}[{number}]={register}"), Line(f"  {kind}_NUM={number}")], number

    def keeper(self, label: str) -> str:
        """A register of the writer's own."""
        if label not in self.saved:
            if not self.free:
                raise CannotSayError(f"no register is free for the {label}")
            self.saved[label] = self.free.pop(0)
        return f"R[{self.saved[label]}:{label}]"

    def _line(self, numbers: Numbers, number: str) -> list[Line]:
        self.selected[numbers.word].add(number)
        return [Line(f"  {numbers.word}_NUM={number}")]

    def only(self, word: str) -> str:
        """The one number that the program ever selects, if there is only one."""
        found = self.selected[word]
        return next(iter(found)) if len(found) == 1 else ""

    def pose(self, word: str, number: str) -> tuple[float, ...] | None:
        """The constant value behind a number."""
        if word == "UFRAME" and number == "0":
            return WORLD
        numbers = self._numbers(word)
        found = numbers.constants.get(int(number)) if number.isdigit() else None
        if found is None:
            holder = next((name for name, given in numbers.registers.items() if str(given) == number), "")
            digits = holder[3:-1].partition(":")[0]
            found = self.kept.get(int(digits)) if digits.isdigit() else None
        return found

    def chosen_values(self) -> dict[tuple[str, int], Position]:
        """What the numbers stand for that the writer has given, and a number of nothing that is selected."""
        return {
            (numbers.word, number): Position("pose", value)
            for numbers in (self.tools, self.frames)
            for number, value in numbers.constants.items()
            if number in numbers.own
        }

    def poses(self) -> dict[tuple[str, int], tuple[float, ...]]:
        """The constant values behind numbers, by word and number."""
        both = (self.tools, self.frames)
        return {(one.word, number): value for one in both for number, value in one.constants.items()}

    def declared(self, declaration: ir.Declaration, scope: Scope) -> None:
        """Take over the numbers of frames with values that the program declares."""
        match declaration:
            case ir.Variable(
                name="UTOOL" | "UFRAME" as word, type=ir.ArrayType(base=first), initial=ir.Aggregate(entries=entries)
            ):
                for number, (_, value) in enumerate(entries, first):
                    with suppress(CannotSayError):  # it stands on the controller only
                        self._numbers(word).constants[number] = constant_pose(value, scope)
            case ir.Initialise(assign=ir.Assign(target=ir.Index(base=ir.Name(id=word), indices=(index,)), value=value)):
                if word in ("UTOOL", "UFRAME") and isinstance(index, ir.IntLiteral):
                    self._numbers(word).constants[index.value] = constant_pose(value, scope)
                    self._numbers(word).own.add(index.value)

    def _numbers(self, word: str) -> Numbers:
        return self.tools if word == "UTOOL" else self.frames


def constant_pose(value: ir.Expression, scope: Scope) -> tuple[float, ...]:
    """x, y, z, a, b, c of a constant pose. Raises CannotSayError when it is computed."""
    if isinstance(value, ir.System) and value.name in ("null_frame", "world"):
        return WORLD
    try:
        position = position_of(value, scope)
    except CannotSayError:
        pose = pose_of(constant(value, scope))
        if pose is None:
            raise CannotSayError("a tool or frame is a constant or in a position register") from None
        place = pose.position
        position = Position("pose", (place.x, place.y, place.z, *pose.rotation.zyx))
    if position.kind != "pose":
        raise CannotSayError("a tool or frame is a pose")
    return tuple(one + 0.0 for one in position.values)


def _table_element(value: ir.Expression, kind: str) -> ir.Expression | None:
    """The number of an element of the controller's own table (`UTOOL[3]`), as programs read from listings have it."""
    match value:
        case ir.Index(base=ir.Name(id=name), indices=(index,)) if name.upper() == kind:
            return index
        case ir.Name(id=name) if name.upper().startswith(kind) and name[len(kind) :].isdigit():
            return ir.IntLiteral(int(name[len(kind) :]), origin=NOWHERE)
    return None


def _number_text(index: ir.Expression, expressions: Expressions) -> str:
    return expressions.operand(index)
