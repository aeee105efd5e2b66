"""The predefined data and system routines, written in KRL and read by the same reader as any program."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib import resources
from pathlib import Path

from rpl import __version__, ir
from rpl.diagnostics import Diagnostics
from rpl.errors import InternalError
from rpl.reading.cache import kept, stamps
from rpl.source import source_from_text

from .kinematics import kinematics

_FILES = ("prelude.src", "prelude.dat")


@cache
def prelude() -> ir.Module:
    """The prelude as one module; kept between runs, because every check of a program asks for it."""
    here = Path(__file__).parent
    return kept("krl-prelude", (__version__, stamps((here, Path(ir.__file__).parent))), _read)


def _read() -> ir.Module:
    from .project import read

    folder = resources.files(__package__ or "")
    sources = [source_from_text(name, folder.joinpath(name).read_text("utf-8")) for name in _FILES]
    diagnostics = Diagnostics()
    modules = read(sources, diagnostics).program.modules
    if diagnostics.has_errors or len(modules) != 1:
        raise InternalError(f"the KRL prelude does not read: {[item.as_text() for item in diagnostics]}")
    module = modules[0]
    return replace(module, routines=(*module.routines, *kinematics()))
