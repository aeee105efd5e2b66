"""What kind of value each V+ name has, found from how the whole project uses it.

The sign in front of a name says text (`$`), precision point (`#`) or belt (`%`). A name without one is a number or a
transformation: it is a transformation where it is moved to, composed, or given to a function of locations, or passed to
a parameter that is. Arrays have as many dimensions as they are used with, and last indices as their indices can be.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.source import NOWHERE, Origin

from . import tables
from .blocks import DataPart, ProgramPart
from .bounds import NOTHING, Bounds
from .expressions import root_name, significant

TWO_KINDS = code(
    "vplus-two-kinds",
    Severity.ERROR,
    "{name} is a location here and a number in {file}:{line}",
    "use different names for them",
)

Symbol = tuple[str, str]  # program ("" for all), significant name
POSE, REAL, BOOL = "pose", "real", "bool"
_THREE = 3
_KIND_TYPES: dict[str, ir.Type] = {
    "text": tables.TEXT,
    "joints": tables.JOINTS,
    "belt": ir.VendorType("vplus", "belt"),
    POSE: tables.POSE,
    BOOL: ir.BoolType(),
}


@dataclass(slots=True)
class Entry:
    """What is known of one name."""

    name: str
    pose: Origin | None = None
    number: Origin | None = None
    rank: int = 0
    last: dict[int, int] = field(default_factory=dict)  # dimension -> largest index
    unforeseen: set[int] = field(default_factory=set)  # dimensions with an index nobody can foresee
    asked: set[int] = field(default_factory=set)  # the same, where elements are only read
    read: dict[int, int] = field(default_factory=dict)  # dimension -> largest calculated index that is only read
    filled: bool = False  # elements get values in the project
    origin: Origin = NOWHERE
    double: bool = False
    fixed: bool = False  # its size is declared


@dataclass(slots=True)
class Symbols:
    """All names of a project. `own`: program -> names that belong to it alone (parameters, AUTO, LOCAL)."""

    entries: dict[Symbol, Entry] = field(default_factory=dict)
    own: dict[str, dict[str, str]] = field(default_factory=dict)
    links: list[tuple[Symbol, Symbol]] = field(default_factory=list)

    # variables that only hold truths (see `truths`)
    truths: frozenset[Symbol] = frozenset()
    # are texts compared without looking at capitals
    upper: bool = False

    def symbol(self, program: str, name: str) -> Symbol:
        key = significant(name)
        return (program, key) if key in self.own.get(program, ()) else ("", key)

    def entry(self, program: str, name: str) -> Entry:
        symbol = self.symbol(program, name)
        found = self.entries.get(symbol)
        if found is None:
            found = self.entries[symbol] = Entry(name)
        return found

    def kind(self, program: str, name: str) -> str:
        """pose, real, bool, text, joints or belt."""
        sigils = {"$": "text", "#": "joints", "%": "belt"}
        if name[0] in sigils:
            return sigils[name[0]]
        symbol = self.symbol(program, name)
        if symbol in self.truths:
            return BOOL
        found = self.entries.get(symbol)
        return POSE if found is not None and found.pose is not None else REAL

    def type(self, program: str, name: str) -> ir.Type:
        """The type of a variable, arrays with their last indices."""
        element = element_type(self.kind(program, name))
        found = self.entries.get(self.symbol(program, name))
        if found is None or not found.rank:
            return element
        bounds = tuple(ir.IntLiteral(last_index(found, dimension)) for dimension in range(found.rank))
        open_ones = (at for at in range(found.rank) if is_open(found, at) and not found.fixed)
        grows = tuple((at, found.last.get(at, 0)) for at in open_ones)
        return ir.ArrayType(element, bounds, base=0, grows=grows)


def element_type(kind: str) -> ir.Type:
    """The neutral type of a kind."""
    return _KIND_TYPES.get(kind, tables.REAL)


def last_index(entry: Entry, dimension: int) -> int:
    known = entry.last.get(dimension, 0)
    if not entry.filled:
        known = max(known, entry.read.get(dimension, 0))
    usual = tables.LAST_INDEX if entry.rank < _THREE else tables.LAST_INDEX_OF_THREE
    open_ended = is_open(entry, dimension) and not entry.fixed
    return max(known, usual) if open_ended else known


def is_open(entry: Entry, dimension: int) -> bool:
    """Can nobody tell how many elements there will be? Reading one that was never filled is an error anyhow."""
    return dimension in entry.unforeseen or (dimension in entry.asked and not entry.filled)


def infer(programs: dict[str, ProgramPart], data: list[DataPart], diagnostics: Diagnostics) -> Symbols:
    """Look at every program; `programs` by their significant names."""
    symbols = Symbols()
    for key, part in programs.items():
        own = symbols.own.setdefault(key, {})
        for name, count in part.header.parameters:
            own[significant(name)] = "parameter"
            symbols.entries[key, significant(name)] = Entry(name, rank=count)
        _declared(symbols, key, part)
    bounds = Bounds(symbols.own)
    lookers = [_Looker(symbols, key, part, programs, bounds) for key, part in programs.items()]
    bounds.collect(programs, {looker.key: looker.nodes for looker in lookers})
    bounds.stored(data)
    bounds.solve()
    for looker in lookers:
        looker.look()
    for section in data:
        _stored(symbols, section)
    _connect(symbols)
    for entry in symbols.entries.values():
        if entry.pose is not None and entry.number is not None:
            diagnostics.report(TWO_KINDS, entry.pose, name=entry.name, file=entry.number.file, line=entry.number.line)
            entry.pose = None
    return symbols


def _declared(symbols: Symbols, key: str, part: ProgramPart) -> None:
    """AUTO and LOCAL names are the program's own; GLOBAL ones everybody's."""
    own = symbols.own[key]
    for declared in part.declared:
        for name, bounds in declared.names:
            known = significant(name)
            if declared.kind == "global":
                own.pop(known, None)
                entry = symbols.entries.setdefault(("", known), Entry(name))
            else:
                own.setdefault(known, declared.kind)
                entry = symbols.entries.setdefault((key, known), Entry(name))
            entry.rank = max(entry.rank, len(bounds))
            entry.double = entry.double or declared.type == "double"
            for dimension, bound in enumerate(bounds):
                entry.fixed = entry.fixed or declared.kind == "auto"
                if isinstance(bound, ir.IntLiteral):
                    entry.last[dimension] = max(entry.last.get(dimension, 0), bound.value)
            if declared.type == "loc" and name[0] not in "$#%":
                entry.pose = entry.pose or NOWHERE


def _stored(symbols: Symbols, section: DataPart) -> None:
    for datum, part in section.values:
        entry = symbols.entry("", datum.name)
        if section.section == ".LOCATIONS" and datum.name[0] not in "$#%":
            entry.pose = entry.pose or part.origin
        entry.rank = max(entry.rank, len(datum.indices))
        entry.filled = True
        for dimension, index in enumerate(datum.indices):
            entry.last[dimension] = max(entry.last.get(dimension, 0), index)


def _connect(symbols: Symbols) -> None:
    """What is passed by reference is of one kind on both sides."""
    changed = True
    while changed:
        changed = False
        for one, other in symbols.links:
            first, second = symbols.entries[one], symbols.entries[other]
            for source, target in ((first, second), (second, first)):
                if source.pose is not None and target.pose is None:
                    target.pose = source.pose
                    changed = True
            if first.rank and second.rank:
                changed = _same_size(first, second) or changed


def _same_size(first: Entry, second: Entry) -> bool:
    """Arrays that are passed have the larger size on both sides."""
    before = [
        (dict(one.last), dict(one.read), set(one.unforeseen), set(one.asked), one.filled) for one in (first, second)
    ]
    for dimension in range(max(first.rank, second.rank)):
        most = max(first.last.get(dimension, 0), second.last.get(dimension, 0))
        first.last[dimension] = second.last[dimension] = most
        read = max(first.read.get(dimension, 0), second.read.get(dimension, 0))
        first.read[dimension] = second.read[dimension] = read
    first.unforeseen = second.unforeseen = first.unforeseen | second.unforeseen
    first.asked = second.asked = first.asked | second.asked
    first.filled = second.filled = first.filled or second.filled
    return before != [(one.last, one.read, one.unforeseen, one.asked, one.filled) for one in (first, second)]


class _Looker:
    """Looks at one program."""

    def __init__(
        self, symbols: Symbols, key: str, part: ProgramPart, programs: dict[str, ProgramPart], bounds: Bounds
    ) -> None:
        self.symbols, self.key, self.part, self.programs, self.bounds = symbols, key, part, programs, bounds
        self.nodes = list(walk(tuple(statement for statement in part.body if not is_settled(statement))))
        self.filled: set[int] = set()  # elements that get values, by identity

    def look(self) -> None:
        here = NOWHERE
        self.filled = {id(place) for node in self.nodes for place in self.filling(node)}
        for node in self.nodes:
            origin = getattr(node, "origin", NOWHERE)
            here = origin if origin.source is not None else here
            self.node(node, here)

    def entry(self, name: str, here: Origin) -> Entry:
        entry = self.symbols.entry(self.key, name)
        if entry.origin is NOWHERE:
            entry.origin = here
        return entry

    def node(self, node: object, here: Origin) -> None:
        match node:
            case ir.Name(id=name):
                self.entry(name, here)
            case ir.Index(base=ir.Name(id=name)):
                self.indexed(node, name, here)
            case ir.Assign(target=target, value=value):
                self.assigned(target, value, here)
            case ir.For(counter=counter):
                self.number(ir.Name(counter), here)
            case ir.Move(target=target, via=via):
                self.place(target, here)
                self.place(via, here)
            case ir.Binary(op=":", left=left, right=right):
                self.place(left, here)
                self.place(right, here)
            case ir.Binary(op="-" | "*" | "/" | "mod" | "band" | "bor" | "bxor", left=left, right=right):
                self.number(left, here)
                self.number(right, here)
            case ir.Builtin(function=function, arguments=arguments):
                row = ir.FUNCTIONS.get(function)
                letters = row.parameters.replace("?", "") if row is not None else ""
                for letter, argument in zip(letters, arguments, strict=False):
                    if letter == "p":
                        self.place(argument, here)
            case ir.Field(base=base):
                self.place(base, here)
            case ir.CallRoutine(name=name, arguments=arguments) if name:
                self.called(name, arguments, here)
            case ir.TaskControl(task=name, arguments=arguments):
                self.called(name, arguments, here)

    def place(self, expression: ir.Expression | None, here: Origin) -> None:
        """The expression must be a location."""
        name = root_name(expression)
        if name is not None and name[0] not in "$#%":
            entry = self.entry(name, here)
            entry.pose = entry.pose or here

    def number(self, expression: ir.Expression, here: Origin) -> None:
        name = root_name(expression)
        if name is not None and name[0] not in "$#%":
            entry = self.entry(name, here)
            entry.number = entry.number or here

    def assigned(self, target: ir.Expression, value: ir.Expression, here: Origin) -> None:
        if isinstance(target, ir.System) and target.name in ("tool", "base"):
            self.place(value, here)
            return
        if root_name(target) is None:
            return
        if is_location(value):
            self.place(target, here)
        elif not isinstance(value, ir.Name | ir.Index):
            self.number(target, here)

    def filling(self, node: object) -> Iterator[ir.Expression | None]:
        """Places that a step gives a value to, or asks whether they have one."""
        match node:
            case ir.Assign(target=place) | ir.Dialog(answer=place):
                yield place
            case ir.Builtin(function="is_uninitialised", arguments=(place,)):
                yield place
            case ir.CallRoutine() | ir.TaskControl():
                for symbol, given in self.bounds.handed(self.key, node, self.programs):
                    if symbol in self.bounds.changed:
                        names = ((root_name(one.value), one.value) for one in node.arguments)
                        yield from (
                            value for name, value in names if name is not None and significant(name) == given[1]
                        )

    def indexed(self, node: ir.Index, name: str, here: Origin) -> None:
        entry = self.entry(name, here)
        entry.rank = max(entry.rank, len(node.indices))
        filled = id(node) in self.filled
        entry.filled = entry.filled or filled
        for dimension, index in enumerate(node.indices):
            most = self.bounds.largest(self.key, index)
            if most is None or most == NOTHING:
                (entry.unforeseen if filled else entry.asked).add(dimension)
            elif not filled and not isinstance(index, ir.IntLiteral):
                entry.read[dimension] = max(entry.read.get(dimension, 0), most)
            else:
                entry.last[dimension] = max(entry.last.get(dimension, 0), most)

    def called(self, name: str, arguments: tuple[ir.Argument, ...], here: Origin) -> None:
        """Arguments and parameters are of one kind."""
        key = significant(name)
        part = self.programs.get(key)
        if part is None:
            return
        for (parameter, count), argument in zip(part.header.parameters, arguments, strict=False):
            value = argument.value
            if isinstance(value, ir.Unary | ir.Builtin) and is_location(value):
                self.symbols.entry(key, parameter).pose = here
            if isinstance(value, ir.Unary):
                value = value.operand
            given = root_name(value)
            if given is None or (given[0] in "$#%" and not count):
                if value is not None and is_location(value):
                    entry = self.symbols.entry(key, parameter)
                    entry.pose = entry.pose or here
                continue
            entry = self.entry(given, here)
            if count and isinstance(value, ir.Name):
                entry.rank = max(entry.rank, count)
            if (count > 0) == (entry.rank > 0 and isinstance(value, ir.Name)) or not count:
                self.symbols.links.append((self.symbols.symbol(self.key, given), (key, significant(parameter))))


_NUMBERS = (ir.IntLiteral, ir.RealLiteral)


def is_settled(statement: ir.Statement) -> bool:
    """Does the statement hold nothing but written out numbers? Most of a generated program does; no name is in it."""
    match statement:
        case ir.Move(target=ir.Aggregate(entries=entries), via=None, speed=None, triggers=(), search=None):
            return _are_numbers(entries)
        case ir.Assign(target=ir.Signal(index=ir.IntLiteral(), last=None), value=ir.BoolLiteral()):
            return True
    return isinstance(statement, ir.Nothing | ir.WaitForMotion)


def _are_numbers(entries: tuple[tuple[str | None, ir.Expression], ...]) -> bool:
    for _, value in entries:
        inner = value.operand if isinstance(value, ir.Unary) else value
        if inner.__class__ not in _NUMBERS:
            return False
    return True


def is_location(expression: ir.Expression) -> bool:
    """Is the value certainly a transformation?"""
    match expression:
        case ir.Binary(op=":"):
            return True
        case ir.Builtin(function=function, arguments=arguments):
            row = ir.FUNCTIONS.get(function)
            if row is None:
                return False
            return row.result == "p" or ((row.result == "0" and row.parameters.startswith("p")) and bool(arguments))
        case ir.Aggregate(type_name="pose") | ir.System(name="null_frame" | "tool" | "base"):
            return True
        case ir.VendorValue(type=type):
            return isinstance(type, ir.PoseType)
    return False


__all__ = ["Entry", "Symbols", "element_type", "infer", "is_location", "is_settled"]
