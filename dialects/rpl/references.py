"""Which variables a call gives to parameters by REFERENCE: the routine can change them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpl import ir
from rpl.passes.scope import Scope


def by_reference(name: str, arguments: Sequence[ir.Argument], scope: Scope) -> Iterator[ir.Expression]:
    """The arguments of a call that the routine of that name takes by reference; none where it is not known."""
    routine = scope.routine(name)
    if routine is None:
        return
    named = {scope.fold(parameter.name): parameter for parameter in routine.parameters}
    positional = iter([parameter for parameter in routine.parameters if not parameter.optional])
    for argument in arguments:
        parameter = named.get(scope.fold(argument.name)) if argument.name else next(positional, None)
        if parameter is not None and parameter.mode == "reference" and argument.value is not None:
            yield argument.value
