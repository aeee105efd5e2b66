"""The names that a source gives its signals, for runs of what was written in a language that only numbers them.

A translation that numbers named signals says which number each got; cell files and the comparison of two runs need that
to know one physical signal in both.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir

_WIRING = "signal_names"


def with_signal_names(program: ir.Program, written: ir.Program) -> ir.Program:
    """The program as it was read back, with the signals that the written one declares, as far as it lacks them."""
    known = {name for module in program.modules for name in _declared(module)}
    names = {
        name: declaration
        for module in written.modules
        for name, declaration in _declared(module).items()
        if name not in known and declaration.signal.index is not None
    }
    if not names or not program.modules:
        return program
    first = program.modules[0]
    declarations = tuple(replace(one, scope="global") for one in names.values())
    wiring = ir.Module(_WIRING, first.dialect, declarations, task=first.task, public=True)
    return replace(program, modules=(*program.modules, wiring))


def _declared(module: ir.Module) -> dict[str, ir.SignalDeclaration]:
    return {one.name.lower(): one for one in module.declarations if isinstance(one, ir.SignalDeclaration)}
