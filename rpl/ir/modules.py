"""Declarations, routines, modules and whole programs of the IR."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, cast

from rpl.ir.actions import Assign
from rpl.ir.expressions import Expression, Signal
from rpl.ir.rows import Cells
from rpl.ir.runs import Make, maker_of
from rpl.ir.statements import Body
from rpl.ir.types import Type
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:  # who reads no long program does not wait for it
    import numpy as np
    from numpy.typing import NDArray

# scope of a declaration: routine < module < task < global
SCOPES = ("routine", "module", "task", "global")


@dataclass(frozen=True, slots=True)
class Variable:
    """storage: constant, variable (set anew by a reset or, in a routine, at each call), persistent (survives runs).
    `label`: the comment that a numbered variable has in its controller (FANUC `R[1:count]`)."""

    name: str
    type: Type
    initial: Expression | None = None
    storage: str = "variable"
    scope: str = "module"
    label: str = field(default="", compare=False)
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True, eq=False)
class VariableRows:
    """Variables of one kind whose names are a stem and a number: the places of Rows that have names. sample: the first
    of them; cells: of its value; moves: of the run, whose places they are; numbers: of the names."""

    sample: Variable
    cells: Cells = field(repr=False)
    stem: str
    moves: NDArray[np.int64] = field(repr=False)
    numbers: NDArray[np.int64] = field(repr=False)
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)

    @property
    def name(self) -> str:
        """Of the first one."""
        return self.sample.name

    @property
    def scope(self) -> str:
        return self.sample.scope

    def variables(self) -> Iterator[Variable]:
        return (self.variable(which) for which in range(len(self.numbers)))

    def part(self, first: int, end: int) -> VariableRows:
        """Some of them in a row."""
        moves, numbers = self.moves[first:end], self.numbers[first:end]
        named = replace(self.sample, name=f"{self.stem}{numbers[0]}")
        return VariableRows(named, self.cells, self.stem, moves, numbers, origin=self.origin)

    def variable(self, which: int) -> Variable:
        """One of them, as if it had been declared alone."""
        one, stretch, at = self.sample, self.cells.stretch, int(self.moves[which])
        makes: dict[int, Make[int]] = {key: cell.number for key, cell in self.cells.by_identity.items()}
        make = maker_of(one.initial, makes, stretch.origin)
        value = one.initial if make is None else cast(Expression, make(at, stretch.run.columns.origin(at)))
        return Variable(f"{self.stem}{self.numbers[which]}", one.type, value, one.storage, one.scope, one.label)


@dataclass(frozen=True, slots=True)
class RecordDeclaration:
    name: str
    fields: tuple[tuple[str, Type], ...]
    scope: str = "module"
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class EnumDeclaration:
    name: str
    members: tuple[str, ...]
    scope: str = "module"
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class AliasDeclaration:
    name: str
    type: Type
    scope: str = "module"
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class SignalDeclaration:
    """A name for a physical signal or a group of bits (KRL SIGNAL)."""

    name: str
    signal: Signal
    scope: str = "module"
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class ExternalDeclaration:
    """A routine or datum declared to live elsewhere (KRL EXT, EXTFCT). Kept so that it can be printed."""

    name: str
    text: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Initialise:
    """An assignment in a data list or among declarations (KRL `DEF_GROUP[1]='B1'` in a .dat)."""

    assign: Assign
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Unread:
    """A declaration line that could not be read or is a comment-only line (then `text` is empty)."""

    text: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


Declaration = (
    Variable
    | VariableRows
    | RecordDeclaration
    | EnumDeclaration
    | AliasDeclaration
    | SignalDeclaration
    | ExternalDeclaration
    | Initialise
    | Unread
)


@dataclass(frozen=True, slots=True)
class Parameter:
    """mode: value (a copy), reference (an alias), readonly. `choice`: parameters with one number exclude each other
    (RAPID `\\switch on | switch off`). `switch`: present or not, without a value."""

    name: str
    type: Type
    mode: str = "value"
    optional: bool = False
    switch: bool = False
    choice: int | None = None


@dataclass(frozen=True, slots=True)
class Handler:
    """Error handler for the given error codes (empty: all)."""

    codes: tuple[Expression, ...]
    body: Body
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Routine:
    """kind: procedure, function, trap. scope: module (local), task, global. `open_ended`: a controller's own routine
    that is not described here; it takes any arguments."""

    name: str
    kind: str = "procedure"
    parameters: tuple[Parameter, ...] = ()
    returns: Type | None = None
    declarations: tuple[Declaration, ...] = ()
    body: Body = ()
    handlers: tuple[Handler, ...] = ()
    undo: Body = ()
    backward: Body = ()
    scope: str = "task"
    open_ended: bool = field(default=False, kw_only=True)
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Module:
    """One module. `dialect` names the language whose rules (conversions, look-ahead, defaults, predefined data) govern
    it; `task` the task it belongs to. `attributes` are kept for printing (KRL `&ACCESS`, RAPID `(SYSMODULE)`)."""

    name: str
    dialect: str
    declarations: tuple[Declaration, ...] = ()
    routines: tuple[Routine, ...] = ()
    attributes: tuple[tuple[str, str], ...] = ()
    task: str = ""
    public: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Task:
    """A task that runs from the start. kind: `motion` (may move the robot), `background` (runs beside it, e.g. the KRL
    submit interpreter; `cyclic` starts again at its end)."""

    name: str
    entry: str
    kind: str = "motion"
    cyclic: bool = False
    modules: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Program:
    """Everything read together. `tasks` empty: one motion task from the entry. `entry` empty: found by the rule of the
    command line (main, the file's routine, the only one nobody calls)."""

    modules: tuple[Module, ...]
    tasks: tuple[Task, ...] = ()
    entry: str = ""
