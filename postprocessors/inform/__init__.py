"""Yaskawa INFORM jobs (.JBI) as a target; the heavy parts are imported when called."""

from __future__ import annotations

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


def _passes() -> tuple[Placed, ...]:
    from .passes import PASSES

    return PASSES


TARGET = Target(
    name="inform",
    title="Yaskawa INFORM",
    capabilities=_capabilities,
    write=_write,
    passes=_passes,
)
