"""The backup of the robot that will run a translation, read with the target's own dialect."""

from __future__ import annotations

from pathlib import Path

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.ir.standing import Standing
from rpl.project import ReadProgram, read_program

_SHARED = ("task", "global")


def read_standing(path: Path, target: str) -> Standing:
    """What a file, a folder or an archive of a backup says. Raises UsageError when the path does not exist or holds
    nothing of that language. What of it cannot be read is left out: it is not translated."""
    if target not in registry.dialect_names():
        raise UsageError(f"a backup cannot be read: programs of {target} are written, not read")
    read = read_program([path], target, Diagnostics())
    if not read.sources:
        raise UsageError(f"{path}: there is nothing of {registry.dialect(target).title} in the backup")
    own = registry.dialect(target).standing(read.sources)
    signals = dict(own.signals)
    for module in read.reduced.modules:
        for one in module.declarations:
            match one:
                case ir.SignalDeclaration(
                    name=name, signal=ir.Signal(kind=kind, index=ir.IntLiteral(value=at), last=None)
                ):
                    signals.setdefault((kind, at), name)
    names = dict(own.names) if own.numbers else {**_names(read), **own.names}
    return Standing(names, own.numbers, own.computed, signals, own.poses)


def _names(read: ReadProgram) -> dict[str, str]:
    """What programs declare for all others: modules, routines and data."""
    found: dict[str, str] = {}
    for module in read.reduced.modules:
        home = module.origin.file or module.name
        found[module.name.lower()] = home
        for routine in module.routines:
            if routine.scope in _SHARED:
                found[routine.name.lower()] = routine.origin.file or home
        for one in module.declarations:
            if isinstance(one, ir.Variable) and one.scope in _SHARED:
                found[one.name.lower()] = one.origin.file or home
    return found
