"""Writing RPL: every node of the IR has its text, so this target refuses nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.registry import Target

if TYPE_CHECKING:
    from rpl.ir import Program
    from rpl.writing.target import Capabilities, OutputFile, WriteContext


def _capabilities() -> Capabilities:
    from .target import CAPABILITIES

    return CAPABILITIES


def _write(program: Program, context: WriteContext) -> list[OutputFile]:
    from .target import write

    return write(program, context)


TARGET = Target(
    name="rpl",
    title="RPL, the universal robot programming language",
    capabilities=_capabilities,
    write=_write,
    options={"files": "`program` (the default): one file for all modules; `module`: one for each"},
)
