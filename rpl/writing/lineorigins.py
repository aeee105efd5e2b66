"""Where the lines of written files come from.

Writers put the remarks of a statement before its lines, whatever the target. So the program is written a second time
with a numbered remark at each statement and declaration; without these remarks it has to be the files that were
written, line for line, else nothing is said about that file. No writer needs to know of it, and nothing is guessed.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence

from rpl import ir
from rpl.passes.collector import paused_cycle_collector
from rpl.passes.expanded import expanded
from rpl.passes.rewrite import changed, each, rewrite_bodies
from rpl.source import NOWHERE, Comment, Origin, decode
from rpl.writing.target import OutputFile

_BLOCKS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop)
# Lines of a numbered part have no indentation that means anything; what stands outside of the part is no statement's.
_LINE_NUMBER = re.compile(r"\s*\d*:")
_NUMBERED = 1000
_NUMBERS = re.compile(r"[\d\s]+")

# For each line of a file the place in the source that it comes from, None where it is of the writer's own making.
LineOrigins = Mapping[str, tuple[Origin | None, ...]]


def line_origins(
    program: ir.Program, files: Iterable[OutputFile], write: Callable[[ir.Program], Sequence[OutputFile]]
) -> LineOrigins:
    """The origins of the lines of `files`, which `write` has made of the program."""
    written = list(files)
    marks = _Marks(_sign(written))
    with paused_cycle_collector():
        again = {file.path: file for file in write(marks.marked(expanded(program)))}
    found: dict[str, tuple[Origin | None, ...]] = {}
    for file in written:
        marked = again.get(file.path)
        lines = text_lines(file)
        rows = _rows(text_lines(marked), lines, marks.pattern) if marked is not None else None
        numbers = rows if rows is not None else [None] * len(lines)
        found[file.path] = tuple(marks.origins[number] if number is not None else None for number in numbers)
    return found


def text_lines(file: OutputFile) -> list[str]:
    """The lines of a written file."""
    return decode(file.data)[0].replace("\r\n", "\n").removesuffix("\n").split("\n")


class _Marks:
    """Gives each statement and declaration a number, and a remark with it."""

    def __init__(self, sign: str) -> None:
        self.origins: list[Origin] = []
        self.sign, self.pattern = sign, re.compile(rf"{sign}(\d+)@")

    def marked(self, program: ir.Program) -> ir.Program:
        return changed(program, modules=each(program.modules, self._module))

    def _module(self, module: ir.Module) -> ir.Module:
        declarations = each(module.declarations, self._declaration)
        return changed(module, declarations=declarations, routines=each(module.routines, self._routine))

    def _routine(self, routine: ir.Routine) -> ir.Routine:
        handlers = each(routine.handlers, lambda handler: changed(handler, body=self._body(handler.body)))
        return changed(
            routine,
            declarations=each(routine.declarations, self._declaration),
            body=self._body(routine.body),
            handlers=handlers,
            undo=self._body(routine.undo),
            backward=self._body(routine.backward),
            origin=self._numbered(routine.origin),
        )

    def _declaration(self, declaration: ir.Declaration) -> ir.Declaration:
        return changed(declaration, origin=self._numbered(declaration.origin))

    def _body(self, body: ir.Body) -> ir.Body:
        return each(body, self._statement)

    def _statement(self, statement: ir.Statement) -> ir.Statement:
        origin = self._numbered(statement.origin)
        whole = rewrite_bodies(statement, self._body) if isinstance(statement, _BLOCKS) else statement
        return changed(whole, origin=origin)

    def _numbered(self, origin: Origin) -> Origin:
        self.origins.append(origin if origin.source else NOWHERE)
        mark = Comment(f"{self.sign}{len(self.origins) - 1}@")
        return Origin(origin.source, origin.start, origin.end, (mark, *origin.comments))


def _sign(files: Iterable[OutputFile]) -> str:
    """What marks begin with: nothing that was written looks like one."""
    text, sign = "\n".join(decode(file.data)[0] for file in files), "@"
    while re.search(rf"{sign}\d+@", text):
        sign += "@"
    return sign


def _rows(marked: Sequence[str], lines: Sequence[str], pattern: re.Pattern[str]) -> list[int | None] | None:
    """The number of the statement for each of the lines; None where the marked text is another one. A line that stands
    further out than its statement belongs to the block around it."""
    found: list[int | None] = []
    open_marks: list[tuple[int, int]] = []  # indentation and number
    for text in marked:
        mark = pattern.search(text)
        margin = _NUMBERED if _LINE_NUMBER.match(text) else len(text) - len(text.lstrip())
        while open_marks and text.strip() and open_marks[-1][0] >= margin + (mark is None):
            open_marks.pop()
        if mark is not None:
            open_marks.append((margin, int(mark[1])))
            continue
        at = len(found)
        if at >= len(lines) or _NUMBERS.sub("", text) != _NUMBERS.sub("", lines[at]):
            return None
        found.append(open_marks[-1][1] if open_marks and text.strip() else None)
    return found if len(found) == len(lines) else None
