"""FANUC TP listings (.LS) as a target; the heavy parts are imported when called."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rpl.registry import Target

if TYPE_CHECKING:
    from rpl.ir import Program
    from rpl.passes.capabilities import Capabilities
    from rpl.passes.legalise.stages import Placed
    from rpl.writing.target import OutputFile, WriteContext


def _capabilities() -> Capabilities:
    from .capabilities import CAPABILITIES

    return CAPABILITIES


def _write(program: Program, context: WriteContext) -> list[OutputFile]:
    from .writer import write

    return write(program, context)


def _fitted(options: Mapping[str, str]) -> Capabilities:
    from .capabilities import fitted

    return fitted(options)


def _passes() -> tuple[Placed, ...]:
    from .passes import PASSES

    return PASSES


TARGET = Target(
    name="tp",
    title="FANUC TP",
    capabilities=_capabilities,
    write=_write,
    passes=_passes,
    longest_line=320,
    encodings=("ascii",),
    options={"names": "longest program name: 36 (default) or 8 for old controllers"},
    fitted=_fitted,
)
