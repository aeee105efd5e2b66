"""Data that the source's controller keeps between programs and whose value stands in no file: registers, variables,
taught tools and frames.

What is certainly set before it is read begins at zero. Anything else is named, and the program stops at its beginning
until somebody gives the value: a zero that nobody has set would move the robot somewhere else. At the
declaration stands what is to be filled in, and where the source's controller shows it. A place that the program sets,
though perhaps too late or in parts, does not stop it: that is a warning.
"""

from __future__ import annotations

import re
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.passes.kept import UnsetRead, unknown_data, unset_reads, without_unknown
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.stages import legalising
from rpl.source import Comment, Origin

UNKNOWN = code(
    "kept-value-unknown",
    Severity.LOSS,
    "read before the program sets it, and its value stands on the controller only, in no file that was read: {name}",
    "add the controller's file with the values to the project, or give the value in the cell file: [variables] {path}",
    stops=True,
)

UNCERTAIN = code(
    "kept-value-uncertain",
    Severity.WARNING,
    "may be read before the program has set all of it, and what the controller keeps then stands in no file that was"
    " read: {name}",
    "set it first, add the controller's file with the values to the project, or give the value in the cell file:"
    " [variables] {path}",
)


@legalising()
def kept_values_known(program: ir.Program, context: Context) -> ir.Program:
    """For all targets; first of all, because a zero is a value like any other to what follows."""
    found = unset_reads(program)
    done = without_unknown(program)
    context.unknown |= unknown_data(program)
    unset = [one for one in found if not one.may_be_set]
    _report(UNKNOWN, unset, context)
    _report(UNCERTAIN, [one for one in found if one.may_be_set], context)
    if not unset:
        return done
    stops = {name.lower(): _stop([one for one in unset if name in one.roots]) for one in unset for name in one.roots}

    def stopped(routine: ir.Routine, dialect: str) -> ir.Routine:
        stop = stops.get(routine.name.lower())
        return routine if stop is None else replace(routine, body=(replace(stop, dialect=dialect), *routine.body))

    said = _remarks(unset, context)
    modules = tuple(
        replace(
            module,
            declarations=tuple(_with_remark(one, said) for one in module.declarations),
            routines=tuple(stopped(one, module.dialect) for one in module.routines),
        )
        for module in done.modules
    )
    return replace(done, modules=modules)


def _report(what: Code, found: list[UnsetRead], context: Context) -> None:
    """One report for one cause, the file that is not there; each value with the line that reads it."""
    if not found:
        return
    first = found[0].origin
    names = [found[0].name, *(f"{one.name} ({_line(one.origin, first)})" for one in found[1:])]
    paths = ", ".join(f'"{one.path}" = ...' for one in found)
    context.diagnostics.report(what, first, name=", ".join(names), path=paths)


def _line(origin: Origin, first: Origin) -> str:
    return f"line {origin.line}" if origin.file == first.file else f"{origin.file}, line {origin.line}"


def _remarks(unset: list[UnsetRead], context: Context) -> dict[str, tuple[Comment, ...]]:
    """What is to be filled in, by the folded name of the variable."""
    places = rules_of(context.source).kept_at
    found: dict[str, tuple[Comment, ...]] = {}
    for one in unset:
        word = re.match(r"[A-Z]+", one.name)
        place = places.get(word[0]) if word else None
        shown = f"fill in: {one.name} as on the controller" + (f" ({place})" if place else "")
        name = one.key.partition("[")[0]
        found[name] = (*found.get(name, ()), Comment(shown))
    return found


def _with_remark(one: ir.Declaration, said: dict[str, tuple[Comment, ...]]) -> ir.Declaration:
    """The declaration with the remark on the lines in front of it."""
    remarks = said.get(one.name.lower(), ()) if isinstance(one, ir.Variable) and one.storage == "persistent" else ()
    if not remarks:
        return one
    return replace(one, origin=replace(one.origin, comments=(*one.origin.comments, *remarks)))


def _stop(unset: list[UnsetRead]) -> ir.Vendor:
    """The place to fill in. Its origin is that of the first report, so that it is not reported once more."""
    names = ", ".join(one.name for one in unset)
    first = unset[0].origin
    where = Origin(first.source, first.start, first.start)  # no text: the names stand there in the source's place
    return ir.Vendor("", f"set first, as on the controller: {names}", "unknown", origin=where)


__all__ = ["kept_values_known"]
