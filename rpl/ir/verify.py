"""Is a program well built? Structural checks that no single node can promise by its type.

Run behind a reader it finds what the source got wrong (a jump to nowhere); run behind a pass it finds what the pass got
wrong (an operator that does not exist). Types are the affair of passes.typing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.actions import Assign, CallRoutine
from rpl.ir.builtins import FUNCTIONS, PROCEDURES, SYSTEM_VARIABLES
from rpl.ir.expressions import (
    BINARY_OPERATORS,
    CONVERSIONS,
    UNARY_OPERATORS,
    UNITS,
    Binary,
    Builtin,
    Convert,
    Field,
    Index,
    Magnitude,
    Name,
    Quantity,
    Signal,
    System,
    Unary,
)
from rpl.ir.modules import SCOPES, EnumDeclaration, Module, Parameter, Program, RecordDeclaration, Routine, Variable
from rpl.ir.motion import Move, PathRule, Search, Spline, Trigger
from rpl.ir.statements import (
    Body,
    Clock,
    ControlInterrupt,
    Dialog,
    Do,
    ExitLoop,
    For,
    Goto,
    Halt,
    If,
    Label,
    Loop,
    Meet,
    Message,
    NextPass,
    OnError,
    OrderInterrupt,
    Repeat,
    Retry,
    Return,
    Statement,
    Switch,
    TaskControl,
    TryNext,
    While,
)
from rpl.ir.types import SIGNAL_KINDS, SignalType
from rpl.ir.walk import bodies, walk
from rpl.source import NOWHERE, Origin

UNKNOWN_WORD = code("unknown-word", Severity.ERROR, "{what} {word!r} does not exist")
BAD_COUNT = code("wrong-argument-count", Severity.ERROR, "{name} takes {wanted} arguments, {given} are given")
NO_LABEL = code("unknown-label", Severity.ERROR, "there is no label {name} in this routine")
TWICE = code("declared-twice", Severity.ERROR, "{what} {name} is declared twice")
NO_LOOP = code("outside-of-loop", Severity.ERROR, "{word} outside of a loop")
NO_HANDLER = code("outside-of-handler", Severity.ERROR, "{word} outside of an error handler")
NO_PLACE = code("not-assignable", Severity.ERROR, "a value cannot be stored here")
NO_VALUE = code("return-without-value", Severity.ERROR, "function {name} returns without a value")
NO_BRANCH = code("empty-branches", Severity.ERROR, "{word} without a branch")
NO_ROUTINE = code("unknown-entry", Severity.ERROR, "there is no routine {name} to start with")

# Node class -> field -> the words it may hold.
_WORDS: dict[type, dict[str, tuple[str, ...]]] = {
    Binary: {"op": BINARY_OPERATORS},
    Unary: {"op": UNARY_OPERATORS},
    Convert: {"how": CONVERSIONS},
    Quantity: {"unit": tuple(UNITS)},
    Magnitude: {"unit": tuple(UNITS)},
    Signal: {"kind": SIGNAL_KINDS},
    SignalType: {"kind": SIGNAL_KINDS},
    Builtin: {"function": (*FUNCTIONS, *PROCEDURES)},  # a built-in procedure may be asked for its result
    Do: {"procedure": tuple(PROCEDURES)},
    System: {"name": tuple(SYSTEM_VARIABLES)},
    Halt: {"kind": ("stop", "exit", "cycle")},
    Message: {"kind": ("notify", "state", "quit", "write", "error", "clear")},
    Dialog: {"kind": ("keys", "number", "text")},
    Clock: {"op": ("reset", "start", "stop")},
    TaskControl: {"op": ("start", "stop", "pause", "resume", "join")},
    Meet: {"mode": ("wait", "together", "apart")},
    OrderInterrupt: {"event": ("edge", "timer", "change", "error")},
    ControlInterrupt: {"op": ("on", "off", "enable", "disable", "delete", "mask")},
    Trigger: {"reference": ("start", "end", "middle")},
    PathRule: {
        "rule": ("time_start", "time_part", "time_end", "constant_start", "constant_end"),
        "reference": ("start", "end"),
    },
    Search: {"stop": ("none", "stop", "path", "soft"), "edge": ("rising", "falling", "either")},
    Spline: {"kind": ("path", "joint")},
    Move: {
        "kind": ("joint", "linear", "circular", "spline"),
        "motion_class": ("classic", "spline", "process", "velocity", "servo"),
    },
    Variable: {"storage": ("constant", "variable", "persistent"), "scope": SCOPES},
    Parameter: {"mode": ("value", "reference", "readonly")},
    Routine: {"kind": ("procedure", "function", "trap"), "scope": ("module", "task", "global")},
}
_OPTIONAL_WORDS: dict[str, tuple[str, ...]] = {
    "relative": ("base", "tool", "joints"),
    "orientation": ("variable", "constant", "wrist"),
    "circle_orientation": ("base", "path"),
    "configuration": ("exact", "nearest"),
}
_PLACES = (Name, Index, Field, System, Signal)


def verify(program: Program, diagnostics: Diagnostics) -> bool:
    """Check the whole program; report what is wrong. True when nothing was."""
    before = len(diagnostics)
    traps = frozenset(
        node.routine.lower() for node in walk(program.modules) if isinstance(node, OnError) and node.routine is not None
    )
    for module in program.modules:
        _Checker(diagnostics, traps).module(module)
    _entries(program, diagnostics)
    return len(diagnostics) == before


def _entries(program: Program, diagnostics: Diagnostics) -> None:
    known = {routine.name.lower() for module in program.modules for routine in module.routines}
    for entry in (program.entry, *(task.entry for task in program.tasks)):
        if entry and entry.lower() not in known:
            diagnostics.report(NO_ROUTINE, NOWHERE, name=entry)


def _placed(node: object, outer: Origin) -> Origin:
    origin = getattr(node, "origin", NOWHERE)
    return origin if isinstance(origin, Origin) and origin.source is not None else outer


class _Checker:
    """Checks one module. Names are compared without regard to case: no language tells routines apart by it alone.
    `traps`: routines that a task calls for its errors."""

    def __init__(self, diagnostics: Diagnostics, traps: frozenset[str]) -> None:
        self.diagnostics = diagnostics
        self.traps = traps

    def module(self, module: Module) -> None:
        self.names("routine", ((routine.name, routine.origin) for routine in module.routines))
        self.declared(module.declarations)
        for declaration in module.declarations:
            self.words(declaration, declaration.origin)
        for routine in module.routines:
            self.routine(routine)

    def declared(self, declarations: Iterable[object]) -> None:
        values, types = [], []
        for declaration in declarations:
            match declaration:
                case Variable():
                    values.append((declaration.name, declaration.origin))
                case RecordDeclaration():
                    types.append((declaration.name, declaration.origin))
                    self.names("field", ((name, declaration.origin) for name, _ in declaration.fields))
                case EnumDeclaration():
                    types.append((declaration.name, declaration.origin))
                    self.names("member", ((name, declaration.origin) for name in declaration.members))
        self.names("variable", values)
        self.names("type", types)

    def names(self, what: str, found: Iterable[tuple[str, Origin]]) -> None:
        seen: set[str] = set()
        for name, origin in found:
            if name.lower() in seen:
                self.diagnostics.report(TWICE, origin, what=what, name=name)
            seen.add(name.lower())

    def routine(self, routine: Routine) -> None:
        self.names("parameter", ((parameter.name, routine.origin) for parameter in routine.parameters))
        self.declared(routine.declarations)
        self.words(routine, routine.origin)
        every = bodies(routine)
        labels = [node for body in every for node in walk(body) if isinstance(node, Label)]
        self.names("label", ((label.name, label.origin) for label in labels))
        known = {label.name.lower() for label in labels}
        for node in (node for body in every for node in walk(body)):
            if isinstance(node, Goto) and node.label.lower() not in known:
                self.diagnostics.report(NO_LABEL, node.origin, name=node.label)
            if isinstance(node, Return) and node.value is None and routine.kind == "function" and routine.returns:
                self.diagnostics.report(NO_VALUE, node.origin, name=routine.name)
        self.body(routine.body, in_loop=False, in_handler=routine.name.lower() in self.traps)
        for handler in routine.handlers:
            self.body(handler.body, in_loop=False, in_handler=True)
        self.body(routine.undo, in_loop=False, in_handler=False)
        self.body(routine.backward, in_loop=False, in_handler=False)

    def body(self, body: Body, *, in_loop: bool, in_handler: bool) -> None:
        """Statements that need a loop or a handler around them."""
        for statement in body:
            match statement:
                case ExitLoop() | NextPass() if not in_loop:
                    word = "leaving" if isinstance(statement, ExitLoop) else "going on"
                    self.diagnostics.report(NO_LOOP, statement.origin, word=word)
                case Retry() | TryNext() if not in_handler:
                    word = "retrying" if isinstance(statement, Retry) else "trying the next statement"
                    self.diagnostics.report(NO_HANDLER, statement.origin, word=word)
                case If(branches=()) | Switch(cases=(), default=None):
                    self.diagnostics.report(NO_BRANCH, statement.origin, word=statement.__class__.__name__)
            loop = in_loop or isinstance(statement, For | While | Repeat | Loop)
            for inner in _inner_bodies(statement):
                self.body(inner, in_loop=loop, in_handler=in_handler)

    def words(self, root: object, outer: Origin) -> None:
        """Words from closed lists, counts of arguments and places, in a whole tree."""
        for node in walk((root,)):
            at = _placed(node, outer)
            for field, allowed in _WORDS.get(node.__class__, {}).items():
                self.word(node, field, allowed, at)
            match node:
                case Move():
                    for field, allowed in _OPTIONAL_WORDS.items():
                        if getattr(node, field) is not None:
                            self.word(node, field, allowed, at)
                case Builtin(function=name, arguments=given) if name in FUNCTIONS:
                    self.count(name, FUNCTIONS[name].parameters, len(given), at)
                case Builtin(function=name, arguments=given) if name in PROCEDURES:
                    self.count(name, PROCEDURES[name].parameters, len(given), at)
                case Do(procedure=name, arguments=values) if name in PROCEDURES:
                    self.count(name, PROCEDURES[name].parameters, len(values), at)
                case Assign(target=target) if not isinstance(target, _PLACES):
                    self.diagnostics.report(NO_PLACE, at)
                case CallRoutine(name="", dynamic=None):
                    self.diagnostics.report(UNKNOWN_WORD, at, what="routine", word="")

    def word(self, node: object, field: str, allowed: tuple[str, ...], at: Origin) -> None:
        value = getattr(node, field)
        if value not in allowed:
            what = f"{node.__class__.__name__}.{field}"
            self.diagnostics.report(UNKNOWN_WORD, at, what=what, word=value)

    def count(self, name: str, parameters: str, given: int, at: Origin) -> None:
        most = sum(1 for kind in parameters if kind not in "?*")
        least = most - parameters.count("?") - parameters.count("*")
        if given < least or (given > most and "*" not in parameters):
            wanted = str(least) if least == most else f"{least} to {most}"
            self.diagnostics.report(BAD_COUNT, at, name=name, wanted=wanted, given=given)


def _inner_bodies(statement: Statement) -> Iterator[Body]:
    match statement:
        case If(branches=branches, otherwise=otherwise):
            yield from (body for _, body in branches)
            yield otherwise
        case Switch(cases=cases, default=default):
            yield from (case.body for case in cases)
            yield default or ()
        case For(body=body) | While(body=body) | Repeat(body=body) | Loop(body=body):
            yield body
