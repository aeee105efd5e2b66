"""What linking asks of the program as a whole: names, places of global data, the code of other routines.

`program.LinkedProgram` stands behind it; the parts that compile routines know no more than this.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol

from rpl.source import NOWHERE

if TYPE_CHECKING:
    from rpl import ir
    from rpl.linking.types import Types
    from rpl.passes.roles import Roles
    from rpl.passes.scope import ProgramScope, Scope
    from rpl.runtime.code import Code, Read
    from rpl.runtime.values import SignalRef, Value


class GlobalSlot:
    """One global variable: its declaration, how its first value is made, and how one from outside fits into it. `kept`:
    the controller keeps its value from one run to the next; `label`: the comment of a numbered one."""

    __slots__ = ("assigns", "fitted", "initial", "kept", "label", "name", "needs", "origin", "qualified", "watched")

    def __init__(self, name: str, qualified: str) -> None:
        self.name = name
        self.qualified = qualified
        self.initial: Read | None = None
        self.assigns: list[Read] = []
        self.fitted: Callable[[Value], Value] | None = None
        self.needs: set[int] = set()
        self.watched = False
        self.kept = False
        self.label = ""
        self.origin = NOWHERE


class Symbols(Protocol):
    """The symbols of a program and the code of its routines."""

    @property
    def program(self) -> ir.Program: ...
    @property
    def scopes(self) -> ProgramScope: ...
    @property
    def slots(self) -> Sequence[GlobalSlot]: ...
    @property
    def assumes(self) -> bool: ...
    @property
    def roles(self) -> Roles: ...
    @property
    def cyclic(self) -> tuple[ir.Expression, ...]: ...
    def types(self, scope: Scope) -> Types: ...
    def code_of(self, routine: ir.Routine) -> Code: ...
    def routine(self, scope: Scope, name: str) -> ir.Routine | None: ...
    def slot(self, declaration: ir.Variable, module: ir.Module) -> int: ...
    def home_of(
        self, declaration: ir.Variable, module: ir.Module | None, dialect: str
    ) -> tuple[ir.Variable, ir.Module]: ...
    def initial_assigns(self, module: ir.Module, declaration: ir.Variable) -> list[tuple[ir.Module, ir.Assign]]: ...
    def declare_signal(self, declaration: ir.SignalDeclaration) -> SignalRef | None: ...
