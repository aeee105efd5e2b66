"""Tools and bases by their numbers: what the source keeps as data with a name, or as a literal, is an element of the
controller's tables (`$TOOL=TOOL_DATA[1]`, whose value and name stand in `$config.dat`).

Data that nothing assigns and that stands as a tool or base gets a number of its own, the one that its name says where
it says one; wherever the program reads it, it reads the table. Counted in public programs: 34 of 38 settings of $TOOL
and 32 of 63 of $BASE are `..._DATA[n]`, two of 101 a value.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.mentioned import mentioned
from rpl.passes.legalise.facts.values.framenumbers import (
    Element,
    Key,
    element_of,
    is_shared,
    key_of,
    label_of,
    names_in,
    own_number,
    said_numbers,
)
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts, visit_bodies
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import pose_of

from .. import tables

_DECIMALS = 6  # a REAL of the controller has seven digits


@legalising(sees=("system tool", "system base"))
def frame_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Tools and bases that nothing assigns are numbers of the controller's tables."""
    if tables.CONFIG in context.taken or not any(_selected(node) for node in walk_for({"Assign"}, *program.modules)):
        return program
    scopes = ProgramScope(program)
    unchanged = unchanged_in(program)
    found = _found(program, scopes, unchanged)
    said = said_numbers(walk(*(routine for module in program.modules for routine in module.routines)))
    world = {key for key, pose in found["base"].items() if _said(key, said) == 0 and pose == rigid.IDENTITY}
    for key in world:
        del found["base"][key]
    flange = {key for key, pose in found["tool"].items() if pose == rigid.IDENTITY and not names_in(key[0])}
    for key in flange:
        del found["tool"][key]
    made = {name: _numbered(name, found[name], said, context) for name in tables.SELECTED}
    numbers: dict[Key, ir.Expression] = dict.fromkeys(world | flange, ir.System("null_frame"))
    numbers |= {key: element(name, n) for name, table in made.items() for key, n in table.numbers.items()}
    if not numbers:
        return program
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            work = _Numbers(numbers, scopes.routine(module, routine))
            routines.append(edit_bodies(routine, work.body))
        modules.append(replace(module, routines=tuple(routines)))
    done = _without_noted(replace(program, modules=tuple(modules)))
    gone = {id for _, declared in numbers for id in declared}
    done, remarks = _without_unread(done, gone)
    if not any(table.numbers for table in made.values()):
        return done
    context.taken.add(tables.CONFIG)
    home = ir.Module(tables.CONFIG, program.modules[0].dialect, tuple(_lines(made, remarks)), public=True)
    return replace(done, modules=(*done.modules, home))


class _Numbers:
    """The statements of one routine with elements of the tables in place of the data."""

    def __init__(self, numbers: Mapping[Key, ir.Expression], scope: Scope) -> None:
        self.numbers, self.scope = numbers, scope

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(map(self.statement, body))

    def statement(self, statement: ir.Statement) -> ir.Statement:
        match statement:
            case ir.Assign(target=ir.System(name=name), value=value) if name in tables.SELECTED:
                found = self.numbers.get(key_of(value, self.scope))
                if found is not None:
                    return replace(statement, value=found)
        return rewrite_parts(statement, self.change, self.body)

    def change(self, expression: ir.Expression) -> ir.Expression:
        """Named data only: a literal elsewhere is another place that happens to be the same."""
        if isinstance(expression, ir.Field | ir.Name | ir.Index):
            found = self.numbers.get(key_of(expression, self.scope))
            if found is not None:
                return found
        return rewrite_parts(expression, self.change)


def _said(key: Key, said: Mapping[Element, int]) -> int | None:
    """The number that the program notes where it selects the element; None: none."""
    element = element_of(key[0])
    return None if element is None else said.get(element)


def element(name: str, number: int) -> ir.Index:
    """What stands for a number: `TOOL_DATA[2]`."""
    return ir.Index(ir.Name(tables.SELECTED[name]), (ir.IntLiteral(number),))


# ---- which data has a number


@dataclass(slots=True)
class _Table:
    """The numbers of one kind: those of data, the value behind each, and the declaration that it comes from."""

    numbers: dict[Key, int] = field(default_factory=dict)
    values: dict[int, rigid.Pose] = field(default_factory=dict)
    declared: dict[int, tuple[int, ...]] = field(default_factory=dict)


def _found(program: ir.Program, scopes: ProgramScope, unchanged: Unchanged) -> dict[str, dict[Key, rigid.Pose]]:
    """The tools and bases of constant value, in the order in which the program uses them."""
    found: dict[str, dict[Key, rigid.Pose]] = {name: {} for name in tables.SELECTED}
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for node in walk(*bodies(routine)):
                match node:
                    case ir.Assign(target=ir.System(name=name), value=value) if name in found and _is_data(
                        value, unchanged.assigned
                    ):
                        pose = pose_of(constant(value, scope, unchanged)) if is_shared(value, scope) else None
                        if pose is not None:
                            found[name].setdefault(key_of(value, scope), pose)
    return found


def _numbered(name: str, found: Mapping[Key, rigid.Pose], said: Mapping[Element, int], context: Context) -> _Table:
    bank = tables.SELECTED[name]
    labels = _labels(name, found)
    earlier = {label: number for (kind, number), label in context.registers.items() if kind == bank}
    wanted = {key: earlier.get(labels[key]) or _said(key, said) or own_number(key) for key in found}
    table = _Table()
    for key in sorted(found, key=lambda one: not wanted[one]):
        free = (one for one in (wanted[key], *range(1, tables.MOST_FRAMES + 1)) if one and one not in table.values)
        number = next((one for one in free if one <= tables.MOST_FRAMES), 0)
        if not number:
            break
        table.numbers[key], table.values[number], table.declared[number] = number, found[key], key[1]
        context.register_names[bank, number] = labels[key]
    return table


def _labels(name: str, found: Mapping[Key, rigid.Pose]) -> dict[Key, str]:
    """What each is called: as its data; an element with its index; a value by its kind."""
    labels: dict[Key, str] = {}
    for key in found:
        stem = label_of(key) or name
        others = {one.lower() for one in labels.values()}
        labels[key] = next(
            one for at in range(1, len(found) + 2) if (one := f"{stem} {at}" if at > 1 else stem).lower() not in others
        )
    return labels


def _is_data(value: ir.Expression, assigned: set[str]) -> bool:
    """Is it a literal, or a datum that the program never sets, not even to what it has anyway: what is worked out of
    other data follows when those are taught anew."""
    names = names_in(value)
    if isinstance(value, ir.Name | ir.Index | ir.Field):
        return not names & assigned
    return isinstance(value, ir.Aggregate | ir.Binary) and not names


def _selected(node: object) -> bool:
    return isinstance(node, ir.Assign) and isinstance(node.target, ir.System) and node.target.name in tables.SELECTED


# ---- the tables, and what is left of the data


def _lines(made: Mapping[str, _Table], remarks: Mapping[int, ir.Unread]) -> list[ir.Declaration]:
    """The tables, which the controller has, and behind them the values and names of what was given a number."""
    text = ir.StringType(ir.IntLiteral(tables.LONGEST_FRAME_NAME))
    lines: list[ir.Declaration] = []
    for name, table in made.items():
        bank = tables.SELECTED[name]
        for each, type in ((bank, ir.PoseType()), (tables.NAMES[bank], text)) if table.values else ():
            rows = ir.ArrayType(type, (ir.IntLiteral(tables.MOST_FRAMES),), 1)
            lines.append(ir.Variable(each, rows, storage="persistent", scope="global"))
    for name, table in made.items():
        named = {number: names for key, number in table.numbers.items() if (names := _called(key))}
        for number in sorted(table.values):
            lines += [remarks[one] for one in table.declared[number] if one in remarks]
            lines.append(ir.Initialise(ir.Assign(element(name, number), _pose(table.values[number]))))
            if number in named:
                place = replace(element(name, number), base=ir.Name(tables.NAMES[tables.SELECTED[name]]))
                lines.append(ir.Initialise(ir.Assign(place, ir.TextLiteral(named[number]))))
    return lines


def _called(key: Key) -> str:
    """The name that the pendant shows: of the datum; elements of a table of the source have none."""
    numbered = any(isinstance(node, ir.Index) for node in walk(key[0]))
    return "" if numbered else label_of(key)[: tables.LONGEST_FRAME_NAME]


def _pose(pose: rigid.Pose) -> ir.Aggregate:
    place = pose.position
    values = (place.x, place.y, place.z, *pose.rotation.zyx)
    parts = zip(ir.POSE, values, strict=True)
    entries = tuple((part, ir.RealLiteral(round(value, _DECIMALS) + 0.0)) for part, value in parts)
    return ir.Aggregate(entries, type_name="pose")


def _without_unread(program: ir.Program, gone: set[int]) -> tuple[ir.Program, dict[int, ir.Unread]]:
    """The program without the declarations (by identity) that it mentions no more, and the remarks that stood at
    them, but for the one at the head of a program, which is about all of it."""
    used = mentioned(program)
    remarks: dict[int, ir.Unread] = {}
    names: set[str] = set()
    modules = []
    for module in program.modules:
        kept: list[ir.Declaration] = []
        head = next((one for one in module.declarations if one.origin.comments), None) if module.routines else None
        for one in module.declarations:
            if isinstance(one, ir.Variable) and id(one) in gone and one.name.lower() not in used:
                names.add(one.name.lower())
                if one is head:
                    kept.append(ir.Unread("", origin=one.origin))
                elif one.origin.comments:
                    remarks[id(one)] = ir.Unread("", origin=one.origin)
            elif not (isinstance(one, ir.Initialise) and names_in(_base(one.assign.target)) & names):
                kept.append(one)
        if kept or module.routines or not module.declarations:
            modules.append(replace(module, declarations=tuple(kept)))
    return replace(program, modules=tuple(modules)), remarks


def _base(place: ir.Expression) -> ir.Expression:
    while isinstance(place, ir.Index | ir.Field):
        place = place.base
    return place


def _without_noted(program: ir.Program) -> ir.Program:
    """The program without the numbers that the source notes beside its frames (`UFRAME_NUM=2` in front of the frame)
    and that nothing reads: the element says the number."""
    noted: dict[str, int] = {}
    named: dict[str, int] = {}
    for node in walk_for({"Name", "Routine"}, *program.modules):
        if isinstance(node, ir.Name):
            named[node.id.lower()] = named.get(node.id.lower(), 0) + 1
        elif isinstance(node, ir.Routine):
            for body in bodies(node):
                _count_noted(body, noted)
    idle = {name for name, count in noted.items() if named[name] == count}
    if not idle:
        return program

    def whole(body: ir.Body) -> ir.Body:
        kept: list[ir.Statement] = []
        for one in body:
            if _is_noted(one) not in idle:
                kept.append(rewrite_bodies(one, whole))
            elif one.origin.comments:
                kept.append(ir.Nothing(origin=one.origin))
        return tuple(kept)

    modules = []
    for module in program.modules:
        declared = tuple(
            one for one in module.declarations if not (isinstance(one, ir.Variable) and one.name.lower() in idle)
        )
        routines = tuple(edit_bodies(routine, whole) for routine in module.routines)
        modules.append(replace(module, declarations=declared, routines=routines))
    return replace(program, modules=tuple(modules))


def _count_noted(body: ir.Body, noted: dict[str, int]) -> None:
    for one, behind in pairwise(body):
        name = _is_noted(one)
        if name and _selected(behind):
            noted[name] = noted.get(name, 0) + 1

    def inside(inner: ir.Body) -> ir.Body:
        _count_noted(inner, noted)
        return inner

    for one in body:
        visit_bodies(one, inside)


def _is_noted(statement: ir.Statement) -> str:
    """The name of the variable that is given a plain number; empty: it is another statement."""
    match statement:
        case ir.Assign(target=ir.Name(id=name), value=ir.IntLiteral()):
            return name.lower()
    return ""


__all__ = ["frame_numbers"]
