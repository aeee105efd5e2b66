"""Remarks at declarations, for targets that declare nothing because their data have numbers: they stand by themselves.

Registers and points of such targets are made, folded into the lines that use them or gathered elsewhere; the remark of
a declaration stays where the declaration stood. One behind a declaration on its line says what it is about. One that is
nothing but a number of the target (`!R7`, as a translation from there leaves it) is that number.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.saidnumbers import said_number
from rpl.passes.legalise.stages import legalising
from rpl.source import Origin

_NAMED = ir.Variable | ir.Parameter


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def declared_remarks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with numbered data."""
    own = {name.lower() for module in program.modules for one in module.routines for name in _names(one)}
    banks = frozenset(bank.name for bank in context.capabilities.storage.banks.values())
    return replace(program, modules=tuple(_of_module(one, context, banks, own) for one in program.modules))


def _names(routine: ir.Routine) -> Iterator[str]:
    yield from (one.name for one in (*routine.parameters, *routine.declarations) if isinstance(one, _NAMED))


def _of_module(module: ir.Module, context: Context, banks: Set[str], own: Set[str]) -> ir.Module:
    """`own`: names that a routine has for something of its own, folded."""
    numbered = [_with_number(one, context, banks, own) for one in module.declarations]
    declarations = tuple(_apart(numbered))
    routines = tuple(replace(one, declarations=tuple(_apart(one.declarations))) for one in module.routines)
    return replace(module, declarations=declarations, routines=routines)


def _with_number(one: ir.Declaration, context: Context, banks: Set[str], own: Set[str]) -> ir.Declaration:
    """The declaration without the remark that is its number of the target."""
    match one:
        case ir.Variable(name=name, origin=Origin(comments=(*others, comment))) if (
            comment.behind and name.lower() not in own
        ):
            said = said_number(replace(one, name=""), banks)
            if said is not None and not isinstance(one.type, ir.ArrayType):
                context.said_numbers[name.lower()] = said
                return replace(one, origin=replace(one.origin, comments=tuple(others)))
    return one


def _apart(declarations: Iterable[ir.Declaration]) -> Iterator[ir.Declaration]:
    for one in declarations:
        origin = one.origin
        if not origin.comments or isinstance(one, ir.Unread):
            yield one
            continue
        name = getattr(one, "name", "")
        said = tuple(
            replace(comment, text=f" {name}: {comment.text.strip()}", behind=False)
            if comment.behind and name and comment.text.strip()
            else comment
            for comment in origin.comments
        )
        yield ir.Unread("", origin=replace(origin, comments=said))
        yield replace(one, origin=replace(origin, comments=()))


__all__ = ["declared_remarks"]
