"""What linking makes of a routine, and the frames it runs in.

An instruction is a closure over nothing but constants: it gets the frame's values and gives the next program counter,
or one of the negative answers below after it has put the task into another state. All that changes while running hangs
on the frame's values (place 0 is the task), so a deep copy of the tasks is a snapshot.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from rpl.runtime.values import Value
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.ir.rules import Rules

Values = list[Value]
Instruction = Callable[[Values], int]
Read = Callable[[Values], Value]
Write = Callable[[Values, Value], None]

SWITCHED = -1  # another frame runs: fetch it
BLOCKED = -2  # the task waits
ATTEND = -3  # interrupts may be pending; the frame's counter is set
TASK = 0  # place of the task in a frame's values


@dataclass(slots=True, eq=False)
class HandlerCode:
    """An error handler: the codes it takes (none: all) and where it begins."""

    codes: tuple[Read, ...]
    start: int


@dataclass(frozen=True, slots=True)
class Branch:
    """An instruction that decides: goes on at `held` when its condition holds, else at `failed`; a wait stays."""

    at: int
    held: int
    failed: int


@dataclass(slots=True, eq=False)
class Code:
    """A routine (or the action of an interrupt) as instructions. `statements` gives, per instruction, where its
    statement starts and where the next one does; `origins` where it stands in the source. `branches`: the instructions
    that decide; `actions`: of interrupts and triggers in it, which are code of their own."""

    name: str
    rules: Rules
    kind: str = "procedure"
    instructions: list[Instruction] = field(default_factory=list)
    statements: list[tuple[int, int]] = field(default_factory=list)
    origins: list[Origin] = field(default_factory=list)
    size: int = 1
    handlers: tuple[HandlerCode, ...] = ()
    undo: int | None = None
    prepare: tuple[Callable[[Values], None], ...] = ()
    places: dict[str, tuple[int, bool]] = field(default_factory=dict)
    globals_needed: int = 0
    branches: list[Branch] = field(default_factory=list)
    actions: list[Code] = field(default_factory=list)
    predefined: bool = False

    def __deepcopy__(self, memo: object) -> Code:
        return self

    def origin(self, counter: int) -> Origin:
        return self.origins[counter] if 0 <= counter < len(self.origins) else NOWHERE


@dataclass(slots=True, eq=False)
class Handling:
    """An error being handled in a frame: its number and where the failed statement starts and ends."""

    number: float
    name: str
    message: str
    retry: int
    next: int


@dataclass(slots=True, eq=False)
class Frame:
    """One call. kind: call, interrupt, trigger, error. `counter` is the next instruction, `at` the one that called;
    `result` the place in the caller's values that gets the function's value; `priority` of the interrupt; `wait` the
    suspended wait of the interrupted frame below; `level` the frame that declared the interrupt; `goes_on`:
    what it braked goes on at its end."""

    code: Code
    values: Values
    kind: str = "call"
    counter: int = 0
    at: int = 0
    result: int | None = None
    returned: bool = False
    handling: Handling | None = None
    priority: int | None = None
    wait: object = None
    level: Frame | None = None
    number: int = 0
    goes_on: bool = False
    leaving: object = None


class Ref:
    """A variable passed by reference: a place in a list."""

    __slots__ = ("key", "store")

    def __init__(self, store: Values, key: int) -> None:
        self.store = store
        self.key = key

    def get(self) -> Value:
        return self.store[self.key]

    def set(self, value: Value) -> None:
        self.store[self.key] = value


class Watching(Protocol):
    """Who is told that something has another value: the machine."""

    def changed(self) -> None: ...


class HasMachine(Protocol):
    """A task, as far as a reference asks for it."""

    @property
    def machine(self) -> Watching: ...


class WatchedRef(Ref):
    """A reference to a variable that some condition reads: writing it wakes who waits."""

    __slots__ = ("task",)

    def __init__(self, store: Values, key: int, task: HasMachine) -> None:
        super().__init__(store, key)
        self.task = task

    def set(self, value: Value) -> None:
        self.store[self.key] = value
        self.task.machine.changed()


class PartRef:
    """A reference to a component of a record: a key of its parts."""

    __slots__ = ("key", "store")

    def __init__(self, store: dict[str, Value], key: str) -> None:
        self.store = store
        self.key = key

    def get(self) -> Value:
        return self.store[self.key]

    def set(self, value: Value) -> None:
        self.store[self.key] = value


class ComponentRef:
    """A reference to a component of an immutable value (a pose's x): writing replaces the whole."""

    __slots__ = ("base", "name")

    def __init__(self, base: AnyRef, name: str) -> None:
        self.base = base
        self.name = name

    def get(self) -> Value:
        return self.base.get().get(self.name)

    def set(self, value: Value) -> None:
        self.base.set(self.base.get().replaced(self.name, value))


class CallRef:
    """A reference to what is read and written by closures (a signal, a system variable, a character of a text)."""

    __slots__ = ("read", "values", "write")

    def __init__(self, values: Values, read: Read, write: Write) -> None:
        self.values = values
        self.read = read
        self.write = write

    def get(self) -> Value:
        return self.read(self.values)

    def set(self, value: Value) -> None:
        self.write(self.values, value)


AnyRef = Ref | PartRef | ComponentRef | CallRef
