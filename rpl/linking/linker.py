"""What the parts that link one routine ask of each other. `routine.RoutineLinker` stands behind it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from rpl.runtime.code import Code, Values

if TYPE_CHECKING:
    from rpl import ir
    from rpl.linking.assembler import Assembler, Make
    from rpl.linking.expressions import Compiler
    from rpl.linking.symbols import Symbols
    from rpl.source import Origin

Fill = Callable[[Values, Values], None]


@dataclass(frozen=True, slots=True)
class Plan:
    """How the places of a routine's parameters are filled from the caller's values."""

    code: Callable[[], Code]
    fills: tuple[Fill, ...]


class Calls(Protocol):
    """The calls of the routine."""

    def emit(self, name: str, arguments: tuple[ir.Argument, ...], origin: Origin, result: int | None) -> None: ...
    def plan(self, routine: ir.Routine, arguments: tuple[ir.Argument, ...], origin: Origin) -> Plan: ...
    def dynamic(self, statement: ir.CallRoutine) -> Make: ...


class Flattener(Protocol):
    """Calls inside expressions, moved in front."""

    def statement(self, statement: ir.Statement) -> ir.Statement: ...
    def expression(self, expression: ir.Expression) -> ir.Expression: ...
    def kept(self, expression: ir.Expression) -> ir.Name: ...


class Statements(Protocol):
    """The statements of the routine."""

    def statement(self, statement: ir.Statement) -> None: ...


class Linker(Protocol):
    """What the parts of linking one routine share."""

    @property
    def linked(self) -> Symbols: ...
    @property
    def compiler(self) -> Compiler: ...
    @property
    def assembler(self) -> Assembler: ...
    @property
    def calls(self) -> Calls: ...
    @property
    def flattener(self) -> Flattener: ...
    @property
    def statements(self) -> Statements: ...
    @property
    def code(self) -> Code: ...
    def action(self, action: ir.Assign | ir.CallRoutine, name: str) -> Code: ...
    def vendor_function(self, vendor: ir.Vendor, result: int | None) -> Make: ...
