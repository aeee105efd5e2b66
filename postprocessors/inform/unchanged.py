"""Jobs that were read and not changed: they are written as they stand in their files.

Their texts are read anew; where that gives the same program (as it is given to the writer, behind the passes in front
of it), nothing has been rewritten since, and the texts say everything, also what the neutral program does not keep
(dates, groups, points that nobody uses).
"""

from __future__ import annotations

from pathlib import PureWindowsPath

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.project import read_sources
from rpl.source import NOWHERE, Source
from rpl.writing.target import OutputFile, WriteContext

from .passes.asread import AS_READ

_HEADER = "NPOS"  # every job has it, no module of another language


def _origins(module: ir.Module) -> list[Source]:
    """The files from which the values of the module's data are."""
    found = (getattr(node, "origin", NOWHERE).source for node in walk(*module.declarations))
    return [one for one in dict.fromkeys(found) if one is not None]


def _read_anew(sources: list[Source], context: WriteContext) -> ir.Program:
    program = read_sources(sources, "inform", Diagnostics()).program
    for one in AS_READ:
        program = one(program, context)
    return program


def unchanged(program: ir.Program, context: WriteContext) -> list[OutputFile] | None:
    """The files of a program that is exactly what its own jobs say; None for any other program."""
    sources: list[Source] = []
    kept: list[Source] = []
    for module in program.modules:
        jobs = [routine for routine in module.routines if routine.origin.source is not None]
        if not module.routines:  # what the controller keeps: from its own files, where these give it
            kept += _origins(module)
            continue
        source = module.origin.source
        if source is None or not jobs or _HEADER not in dict(module.attributes):
            return None
        if source not in sources:
            sources.append(source)
    sources += [one for one in dict.fromkeys(kept) if one not in sources]
    if not sources or _read_anew(sources, context) != program:
        return None
    names = [PureWindowsPath(source.path).name for source in sources]
    if len({name.upper() for name in names}) < len(names):
        return None
    return [OutputFile(name, source.data) for name, source in zip(names, sources, strict=True)]
