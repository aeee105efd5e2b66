"""Tables of tools and frames (TOOL_DATA[n], UFRAME[n]) as data with names of their own, where moves name such data.

Only a table of which each use says its element by a number is taken apart; elements that nothing uses vanish with it. A
name comes from the table of names beside it (TOOL_NAME for TOOL_DATA): a word as it is, several as one behind the kind
(tVacuumCup). Else the number stays: tool1, wobj3. A number in force that the source keeps beside and that nothing reads
goes too.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes import rigid
from rpl.passes.capabilities import MoveSetting, Settings
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.values.framenumbers import Element, element_of, said_numbers
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.storage.unused import without_unused
from rpl.passes.scope import ProgramScope
from rpl.passes.values import pose_of
from rpl.source import Origin

_STEMS = {"tool": ("tool", "t"), "base": ("wobj", "wobj")}  # without and with a name
_PLAIN_STEMS = {"tool": ("tool", "tool"), "base": ("frame", "frame")}  # where they are plain poses
_DATA, _NAMES = "data", "name"  # how a table and the one with its names end
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


@legalising(unless=lambda context: not _named(context.capabilities.settings), sees=("Index",))
def poses_of_tables(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose moves say their frame; the others select an element of a table themselves."""
    kinds = _kinds(program)
    tables = {name: one for name, one in _tables(program).items() if any(table == name for table, _ in kinds)}
    if not tables:
        return program
    return _Tables(program, context, tables, kinds).program()


@legalising()
def drop_called_ahead(program: ir.Program, context: Context) -> ir.Program:
    """The program without the unused parts of its prelude: routines that are evaluated read its tables no more. The
    names beside tables of poses stay where those get names from them, right behind."""
    if not _named(context.capabilities.settings):
        return without_unused(program, context)
    declared = (one for module in program.modules for one in module.declarations if isinstance(one, ir.Variable))
    return without_unused(
        program, context, frozenset(_names_beside(one.name.lower()) for one in declared if _is_table(one.type))
    )


def _names_beside(table: str) -> str:
    """The table, by its folded name, with the names of this one's elements; empty: there is none."""
    return table.removesuffix(_DATA) + _NAMES if table.endswith(_DATA) else ""


def _named(settings: Settings) -> bool:
    return settings.bare is not None or MoveSetting.FRAME in settings.of_moves


def _kinds(program: ir.Program) -> dict[Element, str]:
    """What elements of tables are set as, tool or base."""
    found: dict[Element, str] = {}
    for node in walk_for({"Assign", "Move"}, *program.modules):
        given: tuple[tuple[ir.Expression | None, str], ...] = ()
        match node:
            case ir.Assign(target=ir.System(name=name), value=value) if name in _STEMS:
                given = ((value, name),)
            case ir.Move(tool=tool, frame=frame):
                given = ((tool, "tool"), (frame, "base"))
        for place, kind in given:
            element = element_of(place)
            if element is not None:
                found.setdefault(element, kind)
    return found


def _tables(program: ir.Program) -> dict[str, ir.Variable]:
    """Tables of poses that modules declare, each use of which says its element by a number."""
    declared = [one for module in program.modules for one in module.declarations if isinstance(one, ir.Variable)]
    found = {one.name.lower(): one for one in declared if _is_table(one.type)}
    names = Counter(one.name.lower() for one in declared)
    used, told = Counter[str](), Counter[str]()
    for node in walk(*program.modules):
        match node:
            case ir.Name(id=name):
                used[name.lower()] += 1
            case ir.Variable(name=name) | ir.Parameter(name=name):
                names[name.lower()] += 1  # once more: those of routines hide the table
        element = element_of(node)
        if element is not None:
            told[element[0]] += 1
    return {name: one for name, one in found.items() if used[name] == told[name] and names[name] == 2}


def _is_table(type: ir.Type) -> bool:
    return isinstance(type, ir.ArrayType) and len(type.dimensions) == 1 and isinstance(type.element, ir.PoseType)


@dataclass(slots=True)
class _Tables:
    source: ir.Program
    context: Context
    tables: dict[str, ir.Variable]
    kinds: dict[Element, str]
    names: dict[Element, ir.Expression] = field(default_factory=dict)
    listed: dict[Element, list[ir.Assign]] = field(default_factory=dict)  # values that data lists give
    assigned: set[Element] = field(default_factory=set)  # by the program

    def program(self) -> ir.Program:
        nodes = [*walk(*(one for module in self.source.modules for one in module.routines))]
        said = said_numbers(nodes)
        self.look()
        for node in nodes:
            element = element_of(node)
            if element is not None and element[0] in self.tables and element not in self.names:
                self.names[element] = self.named(element, said.get(element, element[1]))

        unread = self.unread()

        def change(node: object) -> object:
            match node:
                case ir.Assign(target=ir.Name(id=name), origin=origin) if name.lower() in unread:
                    return ir.Nothing(origin=origin) if origin.comments else ()
            element = element_of(node)
            return self.names.get(element, node) if element is not None else node

        modules = []
        for module in self.source.modules:
            kept = [
                new
                for one in module.declarations
                for new in self.declared(one)
                if not (isinstance(new, ir.Variable) and new.name.lower() in unread)
            ]
            modules.append(rewrite(replace(module, declarations=tuple(kept)), change))
        return replace(self.source, modules=tuple(modules))

    def look(self) -> None:
        """Where elements get their values."""
        for module in self.source.modules:
            for one in module.declarations:
                element = element_of(one.assign.target) if isinstance(one, ir.Initialise) else None
                if element is not None and isinstance(one, ir.Initialise):
                    self.listed.setdefault(element, []).append(one.assign)
            for node in walk(*module.routines):
                element = element_of(node.target) if isinstance(node, ir.Assign) else None
                if element is not None:
                    self.assigned.add(element)

    def unread(self) -> set[str]:
        """Numbers in force beside the tables (UFRAME_NUM) that the program only sets, to a plain number."""
        used, noted = Counter[str](), Counter[str]()
        for node in walk_for({"Name", "Assign"}, *self.source.modules):
            match node:
                case ir.Name(id=name):
                    used[name.lower()] += 1
                case ir.Assign(target=ir.Name(id=name), value=ir.IntLiteral()):
                    noted[name.lower()] += 1
        return {
            name
            for name, count in noted.items()
            if used[name] == count and any(name.startswith(f"{table}_") for table in self.tables)
        }

    def named(self, element: Element, number: int) -> ir.Expression:
        """The element's new name; the frame that its controller calls 0 is the robot's own and no datum."""
        kind = self.kinds.get(element)
        if number == 0 and kind is not None and self.is_nowhere(element):
            return ir.System("null_frame")
        if kind is None:
            return ir.Name(self.context.fresh(f"{self.tables[element[0]].name}{number}"))
        bare, stem = (_STEMS if self.context.capabilities.settings.bare else _PLAIN_STEMS)[kind]
        text = self.word(element)
        if _IDENTIFIER.fullmatch(text) and text.lower() != f"{bare}{number}":
            return ir.Name(self.context.fresh(text))
        word = "".join(word[:1].upper() + word[1:] for word in re.findall(r"[A-Za-z0-9]+", text))
        return ir.Name(self.context.fresh(f"{stem}{word}" if word else f"{bare}{number}"))

    def is_nowhere(self, element: Element) -> bool:
        """Is it no offset at all, which nothing sets?"""
        first = self.first(element)
        scope = ProgramScope(self.source).module(self.source.modules[0])
        return element not in self.assigned and (first is None or pose_of(constant(first, scope)) == rigid.IDENTITY)

    def word(self, element: Element) -> str:
        """What the table of names beside it says; empty: nothing."""
        names = _names_beside(element[0])
        for module in self.source.modules:
            for one in module.declarations:
                match one:
                    case ir.Initialise(
                        assign=ir.Assign(
                            target=ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at), *_)),
                            value=ir.TextLiteral(value=text),
                        )
                    ) if (name.lower(), at) == (names, element[1]):
                        return text
        return ""

    def first(self, element: Element) -> ir.Expression | None:
        """The value that the table declares for the element, or a data list gives it once."""
        table, listed = self.tables[element[0]], self.listed.get(element, [])
        if len(listed) == 1 and not any(isinstance(one, ir.Name) for one in walk(listed[0].value)):
            return listed[0].value
        match table.type, table.initial:
            case ir.ArrayType(base=base), ir.Aggregate(entries=entries) if 0 <= element[1] - base < len(entries):
                return entries[element[1] - base][1]
        return None

    def declared(self, one: ir.Declaration) -> Sequence[ir.Declaration]:
        match one:
            case ir.Variable(name=name, type=ir.ArrayType(element=type)) if self.tables.get(name.lower()) is one:
                return [
                    replace(one, name=new.id, type=type, initial=self.first(element), origin=_bare(one, at))
                    for at, (element, new) in enumerate(sorted(self.own(name), key=lambda pair: pair[0]))
                ]
            case ir.Initialise(assign=ir.Assign(target=target, value=value)):
                element = element_of(target)
                if element is None or element[0] not in self.tables:
                    return [one]
                if element not in self.names or self.first(element) is value:
                    return []
        return [one]

    def own(self, table: str) -> Iterator[tuple[Element, ir.Name]]:
        for element, new in self.names.items():
            if element[0] == table.lower() and isinstance(new, ir.Name):
                yield element, new


def _bare(one: ir.Variable, at: int) -> Origin:
    return one.origin if at == 0 else replace(one.origin, comments=())
