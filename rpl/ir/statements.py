"""Statements of the IR except motion (ir.motion) and declarations (ir.modules)."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.ir.actions import Assign, CallRoutine, Nothing, Opaque, Vendor
from rpl.ir.expressions import Argument, Expression
from rpl.ir.motion import (
    DefineTrigger,
    Move,
    MoveExternal,
    PathRule,
    Spline,
    Trigger,
)
from rpl.ir.rows import Rows
from rpl.ir.runs import Run
from rpl.source import NOWHERE, Origin


@dataclass(frozen=True, slots=True)
class If:
    """`branches` are (condition, body) tried in order."""

    branches: tuple[tuple[Expression, Body], ...]
    otherwise: Body = ()
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Case:
    values: tuple[Expression, ...]
    body: Body
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Switch:
    """First matching case only, no fall-through; `default` None: nothing happens without a match."""

    selector: Expression
    cases: tuple[Case, ...]
    default: Body | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class For:
    """Counting loop; bounds and step are evaluated once.

    `step` None: +1, or with `automatic` -1 when start > stop. `at_least_once`: the first pass is not checked (RAPID).
    `scoped`: the counter exists in the loop only (RAPID); otherwise it is the declared variable and keeps the first
    value past the end (KRL), or with `keeps_last` the value of the last pass (FANUC).
    """

    counter: str
    start: Expression
    stop: Expression
    step: Expression | None
    body: Body
    automatic: bool = False
    at_least_once: bool = False
    scoped: bool = False
    keeps_last: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class While:
    condition: Expression
    body: Body
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Repeat:
    """Body first, then leave when `until` is true."""

    until: Expression
    body: Body
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Loop:
    """Endless; left by ExitLoop, Goto, Return or Halt."""

    body: Body
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class ExitLoop:
    """Leave the innermost loop."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class NextPass:
    """Go on with the next pass of the innermost loop (URScript continue)."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Label:
    name: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Goto:
    label: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Return:
    value: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Halt:
    """The program's own stop. kind: `stop` (can be continued: KRL HALT, RAPID Stop) or `exit` (ends the task: RAPID
    EXIT, V+ ABORT) or `cycle` (start the main routine again: RAPID ExitCycle)."""

    kind: str = "stop"
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Wait:
    """Wait for a time (a quantity in s). `in_position`: first wait until the robot stands."""

    time: Expression
    in_position: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class WaitUntil:
    """Wait until a condition holds. With `timeout` (s): when it passes, `timed_out` (a BOOL variable) becomes TRUE and
    the program goes on, or without it `error` is raised. `poll`: the controller looks every so many seconds."""

    condition: Expression
    timeout: Expression | None = None
    timed_out: Expression | None = None
    error: str | None = None
    in_position: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class WaitForMotion:
    """Wait until all motion commanded so far has ended (V+ BREAK, KRL WAIT SEC 0's effect)."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class LookAhead:
    """`allow`: the next statement must not stop the advance run (KRL CONTINUE)."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Pulse:
    """Set a digital output to `value` for `duration` s, then to the opposite; the program goes on at once."""

    signal: Expression
    value: Expression
    duration: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class SetAfter:
    """Set an output `delay` s later without waiting (RAPID `SetDO \\SDelay`)."""

    signal: Expression
    value: Expression
    delay: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class DeclareInterrupt:
    """The edge of `condition` runs `action` once armed. `priority`: lower is more urgent. `identity` says which one it
    is (without it the priority does, as in KRL). `once`: disarmed when it comes (V+ REACT). `stops`: the robot brakes
    at once when it comes (V+ REACTI)."""

    priority: Expression
    condition: Expression
    action: CallRoutine | Assign
    everywhere: bool = False
    identity: Expression | None = None
    once: bool = False
    stops: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class ConnectInterrupt:
    """RAPID CONNECT: give the interrupt variable an identity and a trap routine."""

    handle: Expression
    routine: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class OrderInterrupt:
    """Arm an interrupt: on the edge of `condition` (event `edge`), after/every `time` s (event `timer`), on each change
    of `condition`'s value (event `change`), or on an error (event `error`). `once`: only the first time."""

    handle: Expression
    event: str
    condition: Expression | None = None
    time: Expression | None = None
    once: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class ControlInterrupt:
    """op: on, off, enable, disable, delete, mask. `handle` None: all of them. `mask`: interrupts that are not more
    urgent than the priority `handle` wait until the mask is lifted (`handle` None)."""

    op: str
    handle: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class StopMotion:
    """Brake the motion now (KRL BRAKE, RAPID StopMove); `hard`: with the emergency ramp."""

    hard: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class StartMotion:
    """Go on with a stopped motion (RAPID StartMove)."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class ClearMotion:
    """Forget the rest of the current path (RAPID ClearPath)."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class StoreMotion:
    """Put the current path aside (RAPID StorePath) or, with `restore`, take it up again (RestoPath)."""

    restore: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class ResumeLevel:
    """Leave the interrupt routine and every routine down to the level of the declaration, dropping its motion (KRL
    RESUME)."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Raise:
    """Raise an error to the nearest handler. `code` None inside a handler: pass the current one to the caller."""

    code: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Retry:
    """In an error handler: execute the failed statement again."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class TryNext:
    """In an error handler: go on behind the failed statement."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Message:
    """Text to the operator. kind: notify, state, quit (stops until acknowledged), write, error, clear."""

    kind: str
    text: Expression
    sender: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Dialog:
    """Ask the operator: `answer` becomes the number of the key (1-based), the number or the text typed.

    kind: keys, number, text. Texts left out (None in `keys`) are keys that do not exist. `timeout` in s."""

    answer: Expression
    text: Expression
    keys: tuple[Expression | None, ...] = ()
    kind: str = "keys"
    timeout: Expression | None = None
    timed_out: Expression | None = None
    sender: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Clock:
    """Stop watch statement: op reset, start, stop on a variable of ClockType."""

    op: str
    clock: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Do:
    """Call a neutral built-in procedure, one of ir.builtins.PROCEDURES (string functions with outputs, and the like).
    Output arguments are lvalues."""

    procedure: str
    arguments: tuple[Expression | None, ...]
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class TaskControl:
    """Another task: op start, stop (end it), pause, resume, join (wait until it has ended). `task` is its routine."""

    op: str
    task: str
    arguments: tuple[Argument, ...] = ()
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Critical:
    """Begin (`enter`) or end of a section in which no other task runs (URScript enter_critical)."""

    enter: bool
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Meet:
    """Tasks wait for each other: the program goes on when each task of `tasks` (an array of their names, or of records
    whose first component is one) is at the point `identity`. That is a text; of a variable that only stands for a point
    (RAPID syncident) its name counts, with its indices.

    mode: `wait`, `together` (from here on the robots of these tasks are driven together: moves of the same identity
    begin and end at the same time) or `apart` (no longer; the tasks are those that went together). `timeout` in s:
    when it passes, `error` is raised. `in_position`: first wait until the robot stands."""

    identity: Expression
    tasks: Expression | None = None
    mode: str = "wait"
    timeout: Expression | None = None
    error: str | None = None
    in_position: bool = False
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class SetForNextMove:
    """A modal system variable has this value for the next commanded move only (V+ SPEED without ALWAYS)."""

    setting: Expression
    value: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class OnError:
    """From now on an error that no handler takes calls `routine` in this task (V+ REACTE); None: no longer. The routine
    ends by Retry (the failed statement again), TryNext (behind it) or Return (as Retry)."""

    routine: str | None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Instruction:
    """Several statements that are one instruction of the controller that a program is written for. Only a pass right
    in front of that target's writer makes it; RPL prints its parts. `text`: the instruction where it is known there,
    or empty; the writer puts it together then from the parts. Each part is accounted for by itself."""

    text: str
    parts: Body
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


Statement = (
    Assign
    | CallRoutine
    | If
    | Switch
    | For
    | While
    | Repeat
    | Loop
    | ExitLoop
    | NextPass
    | Label
    | Goto
    | Return
    | Halt
    | Wait
    | WaitUntil
    | WaitForMotion
    | LookAhead
    | Pulse
    | SetAfter
    | DeclareInterrupt
    | ConnectInterrupt
    | OrderInterrupt
    | ControlInterrupt
    | StopMotion
    | StartMotion
    | ClearMotion
    | StoreMotion
    | ResumeLevel
    | Raise
    | Retry
    | TryNext
    | Message
    | Dialog
    | Clock
    | Do
    | TaskControl
    | Critical
    | Meet
    | SetForNextMove
    | OnError
    | Instruction
    | Vendor
    | Opaque
    | Nothing
    | Move
    | MoveExternal
    | Spline
    | Trigger
    | PathRule
    | DefineTrigger
    | Run
    | Rows
)
Body = tuple[Statement, ...]
