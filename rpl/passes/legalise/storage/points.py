"""Taught points as points of the routines that use them, for controllers that keep their points in the program.

A taught point is a target or joint position with a constant value that nothing assigns, or one that is written out at a
move. Each routine numbers its own points: as an earlier translation did, as their names say (P7), else in order of use.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import count

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.rows import Cells
from rpl.passes.capabilities import Bank
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import is_constant
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.storage.banks import own_number
from rpl.passes.legalise.storage.rowpoints import Keys, of_one_shape, shown, shown_in_rows
from rpl.passes.scope import Scope
from rpl.passes.typewords import type_word

COPIED = code(
    "taught-point-copied",
    Severity.WARNING,
    "{name} is one point in the source; here each of these programs has its own copy: {routines}",
    "teach the copies anew together, or keep the point where all programs read it",
    several="{count} points of the source have a copy in each program that uses them: [{name} ({routines})]",
)
_POSE = {"x", "y", "z", "a", "b", "c"}
_POSITIONS = (ir.TargetType, ir.JointsType)


def is_point(value: ir.Expression | None) -> bool:
    """Is it a position (or an array of such) written out in constants, with all its components?"""
    return is_written(value) and is_whole(value)


def is_written(value: ir.Expression | None) -> bool:
    return isinstance(value, ir.Aggregate) and all(is_written(one) or is_constant(one) for _, one in value.entries)


def is_whole(value: ir.Expression | None) -> bool:
    """Does a written position leave no component out (but flags and external axes)?"""
    if not isinstance(value, ir.Aggregate):
        return False
    names = {name for name, _ in value.entries}
    if None in names:
        return all(is_whole(one) or not isinstance(one, ir.Aggregate) for _, one in value.entries)
    return "trans" in names or "robax" in names or names >= _POSE or "j1" in names


def _own_number(name: str, bank: Bank) -> int | None:
    """The number that the name of a point says, also behind the letter that some put before one (`XP6`)."""
    number = own_number(name, bank)
    return own_number(name[1:], bank) if number is None and name[:1].isalpha() else number


def poses_of_moves(program: ir.Program, context: Context) -> frozenset[str]:
    """Folded names that stand nowhere but as the place that a move goes to or as a value that is copied whole, both
    moved by a way or not."""
    at_moves = context.capabilities.places.move_functions
    named: Counter[str] = Counter()
    placed: Counter[str] = Counter()
    for node in walk_for({"Name", "Move", "Assign"}, *program.modules):
        match node:
            case ir.Name(id=name):
                named[name.lower()] += 1
            case ir.Move(target=target, relative=None):
                head = _head(target, at_moves)
                if isinstance(head, ir.Name):
                    placed[head.id.lower()] += 1
            case ir.Assign(value=ir.Name(id=name) | ir.Builtin(function="offset", arguments=(ir.Name(id=name), *_))):
                placed[name.lower()] += 1
    return frozenset(name for name, count in placed.items() if count == named[name])


def _head(target: ir.Expression, at_moves: frozenset[str]) -> ir.Expression:
    """The place itself of one that is moved by a way, as far as the target says that at the move."""
    while True:
        match target:
            case ir.Builtin(function=how, arguments=(inner, *_)) if how in at_moves:
                target = inner
            case ir.Binary(op=how, left=inner) if how in at_moves:
                target = inner
            case _:
                return target


@dataclass(slots=True)
class Points:
    """The points of one routine after the other."""

    context: Context
    unchanged: Unchanged
    of_moves: frozenset[str] = frozenset()  # poses as `poses_of_moves` finds them
    made: list[ir.Variable | ir.VariableRows] = field(default_factory=list)
    found: dict[object, ir.Name] = field(default_factory=dict)
    keys: Keys = field(default_factory=Keys)
    in_rows: dict[object, tuple[int, int]] = field(default_factory=dict)  # which of `made`, which of its rows
    alone: set[tuple[int, int]] = field(default_factory=set)  # of those, what is declared by itself
    used: set[int] = field(default_factory=set)
    lowest: int = 0  # all numbers below are taken in the routine
    routine: str = ""
    earlier: Mapping[str, int] = field(default_factory=dict)  # numbers that a map gives to points of the routine
    kept: frozenset[int] = frozenset()
    own: set[int] = field(default_factory=set)  # numbers that names of the program say for themselves
    seen_names: int = 0  # of how many names these are
    homes: dict[int, tuple[ir.Variable, list[str]]] = field(default_factory=dict)  # who has a copy, by declaration

    def begin(self, routine: ir.Routine) -> None:
        self.made, self.found, self.used, self.lowest, self.routine = [], {}, set(), 0, routine.name.lower()
        self.in_rows, self.alone = {}, set()
        home = self.bank()
        self.earlier = {name.lower(): at for (bank, at), name in self.context.registers.items() if bank == home}
        self.kept = frozenset(self.earlier.values())

    def is_taught(self, declaration: ir.Variable, scope: Scope) -> bool:
        """Does the variable (or each element of an array) hold one position written out in constants all the time?"""
        if declaration.name.lower() in self.unchanged.assigned or declaration.initial is None:
            return False
        if declaration.name.lower() in self.unchanged.initialised | self.context.said_numbers.keys():
            return False
        return is_point(declaration.initial)

    def is_pose_of_moves(self, declaration: ir.Variable, scope: Scope) -> bool:
        """Is it a taught pose that is nothing but where moves go, or is copied whole?"""
        if not isinstance(scope.resolve(declaration.type), ir.PoseType) or not self.is_taught(declaration, scope):
            return False
        return declaration.name.lower() in self.of_moves

    def named(self, expression: ir.Name, declaration: ir.Variable, scope: Scope) -> ir.Name | None:
        """The point for a variable."""
        type = scope.resolve(declaration.type)
        if isinstance(type, ir.PoseType) and self.is_pose_of_moves(declaration, scope):
            type = ir.TargetType(self.context.capabilities.places.notation)
        if not isinstance(type, _POSITIONS) or not self.is_taught(declaration, scope):
            return None
        value = declaration.initial
        self.at_home(declaration)
        return None if value is None else self.point(id(declaration), type, value, declaration.name, expression)

    def element(self, expression: ir.Index, declaration: ir.Variable, scope: Scope) -> ir.Name | None:
        """The point for an element of a constant array."""
        type = scope.resolve(declaration.type)
        element = scope.resolve(type.element) if isinstance(type, ir.ArrayType) else None
        if not isinstance(type, ir.ArrayType) or not isinstance(element, _POSITIONS):
            return None
        if not self.is_taught(declaration, scope):
            return None
        value: ir.Expression | None = declaration.initial
        numbers = []
        for index in expression.indices:
            at = constant(index, scope)
            if not isinstance(at, int) or not isinstance(value, ir.Aggregate):
                return None
            if not 0 <= at - type.base < len(value.entries):
                return None
            value = value.entries[at - type.base][1]
            numbers.append(at)
        self.at_home(declaration)
        label = f"{declaration.name}[{','.join(map(str, numbers))}]"
        return None if value is None else self.point((id(declaration), *numbers), element, value, label, expression)

    def at_home(self, declaration: ir.Variable) -> None:
        """Note that the routine at hand has a copy of the point."""
        names = self.homes.setdefault(id(declaration), (declaration, []))[1]
        if self.routine not in names:
            names.append(self.routine)

    def report_copies(self) -> None:
        """Report the points that several routines have a copy of: teaching one anew leaves the others behind."""
        for declaration, routines in self.homes.values():
            if len(routines) > 1:
                shown = ", ".join(sorted(routines))
                self.context.diagnostics.report(COPIED, declaration.origin, name=declaration.name, routines=shown)

    def written(self, value: ir.Aggregate, type: ir.Type | None) -> ir.Name | None:
        """The point for a position that is written out where it is used. In the map of numbers its value stands for a
        name."""
        if not isinstance(type, _POSITIONS) or not is_point(value):
            return None
        key = self.keys.key(value)
        if key in self.in_rows:
            self.alone.add(self.in_rows[key])
        return self.point(key, type, value, "", value)

    def of_rows(self, rows: ir.Rows, type: ir.Type | None) -> ir.Rows | None:
        """The moves with the points for the positions that they go to; None where that has to be seen move by move."""
        import numpy as np

        bank, target = self.context.capabilities.storage.points, rows.sample.target
        assert bank is not None  # asked only for targets that have points
        own = self.own_numbers()
        if not isinstance(type, _POSITIONS) or not isinstance(target, ir.Aggregate) or not is_point(target):
            return None
        if self.earlier or own or not of_one_shape(rows):
            return None
        moves, at = np.arange(rows.cells.stretch.first, rows.cells.stretch.end), len(self.made)
        numbers, first, new = list[int](), max(bank.first, self.lowest), list[int]()
        free = (number for number in count(first) if number not in self.used)
        for which, key in enumerate(self.keys.keys(target, rows.cells, moves)):
            name = self.found.get(key)
            if name is None:
                self.lowest = next(free)
                name = self.found[key] = ir.Name(f"{bank.name}{self.lowest}")
                self.in_rows[key] = at, len(new)
                new.append(which)
                numbers.append(self.lowest)
            else:
                numbers.append(int(name.id.removeprefix(bank.name)))
        if not new:
            return None
        self.used.update(numbers)
        given, these = np.array(numbers), np.array(new)
        cells = Cells(rows.cells.stretch, target, rows.cells.signed)
        home, word, fresh = self.bank(), type_word(type) or "", given[these].tolist()
        for number, known in zip(fresh, shown_in_rows(target, cells, moves[these]), strict=True):
            self.context.register_names[home, number] = known
            self.context.register_types[home, number] = word
        sample = ir.Variable(f"{bank.name}{given[these[0]]}", type, target, storage="constant", scope="routine")
        self.made.append(ir.VariableRows(sample, cells, bank.name, moves[these], given[these]))
        return rows.naming(bank.name, given, int(these[0]))

    def declarations(self) -> list[ir.Declaration]:
        """The points of the routine; those of rows that a move by itself goes to, too, by themselves."""
        done: list[ir.Declaration] = []
        for at, one in enumerate(self.made):
            if not isinstance(one, ir.VariableRows):
                done.append(one)
                continue
            first = 0
            for which in sorted(row for made, row in self.alone if made == at):
                done += [*([one.part(first, which)] if which > first else []), one.variable(which)]
                first = which + 1
            if first < len(one.numbers):
                done.append(one.part(first, len(one.numbers)))
        return done

    def point(self, key: object, type: ir.Type, value: ir.Expression, label: str, used: ir.Expression) -> ir.Name:
        bank = self.context.capabilities.storage.points
        assert bank is not None  # asked only for targets that have points
        if key not in self.found:
            known = label or shown(value)
            number = self.number(known)
            name = f"{bank.name}{number}"
            self.used.add(number)
            self.context.register_names[self.bank(), number] = known
            self.context.register_types[self.bank(), number] = type_word(type) or ""
            variable = ir.Variable(name, type, value, storage="constant", scope="routine", label=label)
            self.made.append(variable)
            self.found[key] = ir.Name(name)
        return replace(self.found[key], origin=used.origin)

    def bank(self) -> str:
        """The name of this routine's points in the map of numbers."""
        bank = self.context.capabilities.storage.points
        return f"{self.routine}.{bank.name if bank is not None else ''}"

    def number(self, label: str) -> int:
        bank = self.context.capabilities.storage.points
        assert bank is not None  # asked only for targets that have points
        given = self.earlier.get(label.lower())
        for wanted in (given, _own_number(label, bank)):
            if wanted is not None and wanted not in self.used:
                return wanted
        reserved = (self.used, self.kept, self.own_numbers())
        free = (
            number for number in count(max(bank.first, self.lowest)) if not any(number in some for some in reserved)
        )
        self.lowest = next(free)
        return self.lowest

    def own_numbers(self) -> set[int]:
        """Numbers that names of the program say for themselves."""
        bank, names = self.context.capabilities.storage.points, self.context.taken
        if bank is not None and len(names) != self.seen_names:  # names are only ever added
            found = {_own_number(name, bank) for name in names}
            self.own, self.seen_names = {number for number in found if number is not None}, len(names)
        return self.own
