"""ABB RAPID as a target: the record that the registry finds. Heavy modules load when asked for."""

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
    from .write import write

    return write(program, context)


def _passes() -> tuple[Placed, ...]:
    from .passes import PASSES

    return PASSES


TARGET = Target(
    "rapid",
    "ABB RAPID",
    _capabilities,
    _write,
    passes=_passes,
    options={"header": "yes: begin each module with the load header of program files"},
    encodings=("latin-1", "utf-8"),
    rows=True,
)
