"""Routines of `rpl.library` that a translated program brings along for functions its new controller does not have.

They are read when first asked for; a program gets only those it uses, once. Their names are made free in the program.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import InternalError
from rpl.library import routines as texts_of
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.rewriting import textparts
from rpl.passes.legalise.rewriting.formulas import call
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.typing import normalise
from rpl.source import NOWHERE, source_from_text

_NAME = re.compile(r"\brpl_\w+")
_TEXT_REFERENCE = re.compile(r"REFERENCE (?=\w+: STRING)")
_HEAD = re.compile(r"\w+ \w+\((.*)\)")
# What texts are asked for on controllers where they are arrays of characters.
_OF_CHARACTERS = {"rpl_text_find": "text_match", "rpl_parse_number": "parse_number"}


def common_library(context: Context, more: Mapping[str, str] | None = None) -> Library:
    """Functions of numbers and texts. `more`: texts of routines that only this program can ask for."""
    by_parts = textparts.by_parts(context.capabilities)
    files = ("numbers", "texts", "sourcetexts", "geometry", *(["textparts"] if by_parts else []))
    return Library(context, files, {} if by_parts else _OF_CHARACTERS, dict(more or {}))


@dataclass(slots=True)
class Library:
    """The routines asked for so far, by the names they get in the program.

    `files`: where they stand, a later one before an earlier one. `own`: functions of the target that are called in the
    place of routines. `target`: the type of targets in the program's notation."""

    context: Context
    files: Sequence[str]
    own: Mapping[str, str] = field(default_factory=dict)
    more: Mapping[str, str] = field(default_factory=dict)
    target: ir.Type | None = None
    names: dict[str, str] = field(default_factory=dict)
    _texts: dict[str, str] = field(default_factory=dict)

    def found(self, routine: str) -> str | None:
        """The text of a routine; None where the library has no such routine."""
        if routine in self.more:
            return self.more[routine]
        return next((texts[routine] for texts in map(texts_of, reversed(self.files)) if routine in texts), None)

    def takes(self, routine: str) -> int | None:
        """How many arguments a routine takes; None where the library has no such routine."""
        text = self.found(routine)
        head = _HEAD.search(text) if text else None
        return head[1].count(": ") if head else None

    def name(self, routine: str) -> str:
        """The name under which the program can call this routine."""
        if routine not in self.names:
            text = self.found(routine)
            if text is None:
                raise InternalError(f"the library has no routine {routine}")
            self.names[routine] = self.context.fresh(routine)
            self._texts[routine] = text
            for needed in sorted(set(_NAME.findall(text)) - {routine, *self.own}):
                self.name(needed)
        return self.names[routine]

    def call(self, routine: str, *arguments: ir.Expression) -> ir.Call:
        return call(self.name(routine), *arguments)

    def routines(self) -> list[ir.Routine]:
        """The routines asked for, each in front of those that it calls."""
        text = "\n".join(self._texts.values())
        if RoutineRule.TEXT_RESULTS in self.context.capabilities.routines.rules:
            text = _TEXT_REFERENCE.sub("", text)  # texts are values there
        called = {**self.own, **self.names}
        text = _NAME.sub(lambda match: called.get(match[0], match[0]), text)
        read = _read(text)
        inside = names_in(read) - {module.name.lower() for module in read.modules}
        self.context.taken |= inside  # what later passes add to the routines gets other names
        return [self._placed(routine) for routine in read.modules[0].routines]

    def added_to(self, program: ir.Program, task: str = "") -> ir.Program:
        """The program with the routines asked for; `task` is the one whose support module holds them."""
        return with_support(program, self.context, (), self.routines(), task) if self.names else program

    def _placed(self, routine: ir.Routine) -> ir.Routine:
        """The routine for this program's targets and this controller; it has no place in the user's sources."""

        def typed(type: ir.Type) -> ir.Type:
            return self.target if self.target is not None and isinstance(type, ir.TargetType) else type

        def expression(node: ir.Expression) -> ir.Expression:
            if isinstance(node, ir.Call) and node.name in ("controller_joints", "controller_place"):
                return self._kinematics(node)
            return replace(rewrite_parts(node, expression), origin=NOWHERE)

        def statements(body: ir.Body) -> ir.Body:
            return tuple(replace(rewrite_parts(one, expression, statements), origin=NOWHERE) for one in body)

        declared = (
            replace(one, type=typed(one.type), origin=NOWHERE) if isinstance(one, ir.Variable) else one
            for one in routine.declarations
        )
        return replace(
            routine,
            parameters=tuple(replace(one, type=typed(one.type)) for one in routine.parameters),
            returns=None if routine.returns is None else typed(routine.returns),
            declarations=tuple(declared),
            body=statements(routine.body),
            scope="global",
            origin=NOWHERE,
        )

    def _kinematics(self, asked: ir.Call) -> ir.Expression:
        """The controller's own function for the joints of a target, or for the target of joints."""
        inverse, forward = self.context.capabilities.places.kinematics or ("", "")
        joints = asked.name == "controller_joints"
        given = ",".join(one.value.id for one in asked.arguments if isinstance(one.value, ir.Name))
        type = ir.JointsType() if joints or self.target is None else self.target
        return ir.VendorValue(self.context.target, f"{inverse if joints else forward}({given})", type)


@lru_cache(maxsize=64)
def _read(text: str) -> ir.Program:
    """Routines of the library as a program; many programs ask for the same ones."""
    diagnostics = Diagnostics()
    source = source_from_text("rpl_support.rpl", f"MODULE rpl_support\n{text}\nEND MODULE\n")
    read = normalise(registry.dialect("rpl").read([source], diagnostics).program, diagnostics)
    if diagnostics.has_errors or not read.modules:
        raise InternalError(f"routines of the library: {[item.as_text() for item in diagnostics]}")
    return read
