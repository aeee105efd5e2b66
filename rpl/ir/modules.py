"""Declarations, routines, modules and whole programs of the IR."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.ir.actions import Assign
from rpl.ir.expressions import Expression, Signal
from rpl.ir.statements import Body
from rpl.ir.types import Type
from rpl.source import NOWHERE, Origin

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
