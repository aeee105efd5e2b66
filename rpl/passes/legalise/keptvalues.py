"""Data that the source's controller keeps between programs and whose value stands in no file: registers, variables,
taught tools and frames.

What is certainly set before it is read begins at zero. Anything else is named, and the program stops at its beginning
until somebody gives the value: a zero that nobody has set would move the robot somewhere else.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.kept import UnsetRead, unset_reads, without_unknown
from rpl.passes.legalise.context import Context
from rpl.source import Origin

UNKNOWN = code(
    "kept-value-unknown",
    Severity.LOSS,
    "{name} is read before the program sets it: its value stands on the controller only, and in no file that was read",
    "add the controller's file with the values to the project, or give the value in the cell file:"
    ' [variables] "{path}" = ...',
    stops=True,
)


def kept_values_known(program: ir.Program, context: Context) -> ir.Program:
    """For all targets; first of all, because a zero is a value like any other to what follows."""
    unset = unset_reads(program)
    done = without_unknown(program)
    if not unset:
        return done
    for one in unset:
        context.diagnostics.report(UNKNOWN, one.origin, name=one.name, path=one.path)
    stops = {name.lower(): _stop([one for one in unset if name in one.roots]) for one in unset for name in one.roots}

    def stopped(routine: ir.Routine, dialect: str) -> ir.Routine:
        stop = stops.get(routine.name.lower())
        return routine if stop is None else replace(routine, body=(replace(stop, dialect=dialect), *routine.body))

    modules = tuple(
        replace(module, routines=tuple(stopped(one, module.dialect) for one in module.routines))
        for module in done.modules
    )
    return replace(done, modules=modules)


def _stop(unset: list[UnsetRead]) -> ir.Vendor:
    """The place to fill in. Its origin is that of the first report, so that it is not reported once more."""
    names = ", ".join(one.name for one in unset)
    first = unset[0].origin
    where = Origin(first.source, first.start, first.start)  # no text: the names stand there in the source's place
    return ir.Vendor("", f"set first, as on the controller: {names}", "unknown", origin=where)


__all__ = ["kept_values_known"]
