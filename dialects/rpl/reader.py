"""Files of RPL to a program: every MODULE becomes one; what stands outside is a module named like its file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir import words
from rpl.ir.walk import is_statement
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.reading.pieces import Attribute, Element, Item, ModulePart
from rpl.reading.shapes import ShapeParser, SyntaxTree
from rpl.registry import ReadResult
from rpl.source import Comment, Origin, Source

from .affixes import Affixing, with_affixments
from .affixment import Affixment, affix
from .blocks import DECLARED, Builder, lower, scoped
from .expressions import Reading
from .signalparameters import with_signal_parameters
from .splitter import NUMBERS, split

REPLACED = code(
    "rpl-entry-not-begun",
    Severity.WARNING,
    "{entry} is not begun by itself: the tasks that may move the robot ({tasks}) are the program",
    "write BACKGROUND behind a task that runs beside {entry}, or add TASK main ENTRY {entry}",
)


@cache
def _parser() -> ShapeParser:
    return ShapeParser("rpl.lark", NUMBERS)


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """Read all sources as one program."""
    parser = _parser()
    modules: list[ir.Module] = []
    tasks: list[ir.Task] = []
    places: list[Origin] = []
    entry = ""
    files: list[FileReport] = []
    affixed: list[Affixment] = []
    affixing: list[Affixing] = []
    for source in sources:
        builder = Builder(diagnostics)

        def lowered(tree: SyntaxTree, numbers: tuple[str, ...], origin: Origin) -> Element | tuple[Element, ...]:
            return lower(tree, Reading(numbers, origin, affixed, affixing))

        assembly = assemble(source, words.NATIVE, split(source), parser, lowered, builder.build, diagnostics)
        found = _File(source)
        for item in assembly.items:
            found.take(item)
        modules.extend(found.finish())
        tasks.extend(found.tasks)
        places.extend(found.places)
        entry = entry or found.entry
        files.append(assembly.report)
    _report_replaced(modules, tasks, entry, places, diagnostics)
    program = ir.Program(tuple(modules), tuple(tasks), entry)
    hanging = [(name, origin) for name, _, origin in affixed]
    program = with_affixments(affix(program, affixed, diagnostics), affixing, hanging, diagnostics)
    modules = [with_signal_parameters(module) for module in program.modules]
    return ReadResult(replace(program, modules=tuple(modules)), tuple(files))


def _report_replaced(
    modules: Sequence[ir.Module], tasks: Sequence[ir.Task], entry: str, places: Sequence[Origin], found: Diagnostics
) -> None:
    """A task that moves the robot is a program of its own: where there is one, nothing else is begun by itself."""
    moving = [task for task in tasks if task.kind == "motion"]
    first = entry or next((r.name for m in modules for r in m.routines if r.name.lower() == "main"), "")
    if not moving or not first or any(task.entry.lower() == first.lower() for task in moving):
        return
    at = places[list(tasks).index(moving[0])]
    found.report(REPLACED, at, entry=first, tasks=", ".join(task.name for task in moving))


class _File:
    """Sorts what stands at the top of one file."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.modules: list[ir.Module] = []
        self.tasks: list[ir.Task] = []
        self.places: list[Origin] = []
        self.entry = ""
        self.comments: list[Comment] = []
        self.loose: list[Item] = []

    def take(self, item: Item) -> None:
        match item:
            case ModulePart(data=ir.Module() as module):
                if self.comments:
                    comments = (*self.comments, *module.origin.comments)
                    module = replace(module, origin=replace(module.origin, comments=comments))
                    self.comments = []
                self.modules.append(module)
            case ModulePart(data=ir.Task() as task):
                self.tasks.append(task)
                self.places.append(item.origin)
            case ModulePart(data=str(entry)):
                self.entry = entry
            case ir.Nothing() if not self.loose:
                self.comments.extend(item.origin.comments)
            case _:
                self.loose.append(item)

    def finish(self) -> list[ir.Module]:
        """The modules; loose declarations, routines and statements make one more."""
        if self.loose:
            self.modules.insert(0, self._own_module())
        elif self.comments and self.modules:
            last = self.modules[-1]
            rest = ir.Unread("", origin=replace(last.origin, comments=tuple(self.comments)))
            self.modules[-1] = replace(last, declarations=(*last.declarations, rest))
        return self.modules

    def _own_module(self) -> ir.Module:
        declarations: list[ir.Declaration] = []
        routines: list[ir.Routine] = []
        attributes: list[tuple[str, str]] = []
        body: list[ir.Statement] = []
        for item in self.loose:
            if isinstance(item, ir.Routine):
                routines.append(item)
            elif isinstance(item, Attribute):
                attributes.append((item.name, item.value))
            elif is_statement(item):
                body.append(item)
            elif isinstance(item, DECLARED):
                declarations.append(scoped(item, "module"))
        origin = Origin(self.source, 0, 0, tuple(self.comments))
        if body:
            if all(isinstance(item, ir.Nothing) for item in body):
                declarations.extend(ir.Unread("", origin=item.origin) for item in body)
            else:
                routines.insert(0, ir.Routine("main", body=tuple(body), origin=body[0].origin))
        return ir.Module(
            self.source.name, words.NATIVE, tuple(declarations), tuple(routines), tuple(attributes), origin=origin
        )
