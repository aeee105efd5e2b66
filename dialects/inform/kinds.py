"""What each position variable holds where: pulses or a pose, in which frame, taken with which tool.

INFORM has one bank of position variables for all of these and decides at run time; the IR decides by type. So the lines
of every job are gone through in the order they can run (labels, jumps and blocks included) with what each variable
holds, until nothing changes any more. A variable that holds pulses here and a pose there becomes two in the IR; where
both could have come, it is always a pose: pulses are converted where they are stored.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import cast

from rpl import ir
from rpl.reading.pieces import Item, ModulePart
from rpl.source import NOWHERE, Origin

from . import tables
from .jobs import POSE, Frame, Job
from .syntax import Command, Given, Group, JobName, LabelBy, LabelName, Nest, Numbered, Operand, SystemName, Word

JOINTS, TARGET, MIXED, UNKNOWN = "joints", "target", "mixed", "unknown"
_ROUNDS = 8
BASE = Frame()
DIFFERENT_TOOL = ir.IntLiteral(-1)
DIFFERENT = Frame("different")  # which frame depends on the way the program came


@dataclass(frozen=True, slots=True)
class Kind:
    """`form`: joints, target, mixed or unknown; frame and tool of a target (tool None: the job's own)."""

    form: str = UNKNOWN
    frame: Frame = BASE
    tool: ir.Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False)


ON, OFF, AS_FOUND = "on", "off", "as found"  # as found: a called job leaves the shift of its caller
Key = tuple[str, int | None]
SHIFTED: Key = ("SHIFT", 0)  # whether positions are shifted (SFTON), kept like what a variable holds
TOOL: Key = ("TOOL", 0)  # the tool of the last move
# Instructions whose first operand is only written.
_WRITE = frozenset(("SET", "GETS", "CNVRT", "MULMAT", "INVMAT", "MSHIFT", "GETPOS", "GETARG", "CONVSFT"))
_CHANGE = frozenset((*_WRITE, "ADD", "SUB", "MUL", "DIV", "SETE", "MFRAME", "CLEAR"))
_CALLER, _CALLER_TOOL = -1, -2  # the "arguments" that tell a job so
INHERITED = ir.IntLiteral(-2)  # the tool that the job found when it was called
State = dict[Key, Kind]
NOTHING = Kind()


def joined(one: Kind, other: Kind) -> Kind:
    """What a variable holds where two ways meet."""
    if one == other or other.form == UNKNOWN:
        return one
    if one.form == UNKNOWN:
        return other
    if one.form != other.form:
        return Kind(MIXED, origin=other.origin)
    frame = one.frame if one.frame == other.frame else DIFFERENT
    tool = one.tool if one.tool == other.tool or other.tool is None else DIFFERENT_TOOL
    return Kind(one.form, frame, other.tool if one.tool is None else tool, one.origin)


def is_mixed(kind: Kind) -> bool:
    """Does it depend on the way the program came what a position is or in which frame it is given?"""
    return kind.form == MIXED or (kind.form == TARGET and kind.frame == DIFFERENT)


def key_of(operand: Operand) -> Key | None:
    """The position variable that an operand is; what computed indices reach is one variable (number None)."""
    if not isinstance(operand, ir.Index) or not isinstance(operand.base, ir.Name):
        return None
    bank, number = operand.base.id, operand.indices[0]
    if bank not in ("P", "LP"):
        return None
    return bank, number.value if isinstance(number, ir.IntLiteral) else None


@dataclass(slots=True)
class Project:
    """What is known of all jobs together."""

    jobs: Mapping[str, Job]
    indirect: frozenset[str]  # global banks with computed indices
    globals: dict[Key, Kind] = field(default_factory=dict)
    arguments: dict[tuple[str, int], Kind] = field(default_factory=dict)
    forms: dict[tuple[str, Key], dict[str, Origin]] = field(default_factory=dict)  # per job ("" globals) and variable
    # Variables and arguments that hold pulses or a pose, one cannot tell which: their pulses are stored as a pose.
    unified: set[tuple[str, Key]] = field(default_factory=set)
    tools_left: dict[Key, Kind] = field(default_factory=dict)  # with which tool a job ends
    shifts_left: dict[Key, Kind] = field(default_factory=dict)  # whether positions are shifted when a job ends
    changed: bool = False
    assuming: bool = False  # nothing else is known of them: variables that are filled by elements are poses
    real_back: bool | None = None
    changes: dict[str, frozenset[Key] | None] = field(default_factory=dict)

    def is_unified(self, job: str, key: Key) -> bool:
        """Is what is put there stored as a pose in the base frame, whatever it was?"""
        home = job if key[0] != "P" else ""
        return (home, key) in self.unified or (home, (key[0], None)) in self.unified

    def gives_back_real(self) -> bool:
        """Does any RET give back a real number?"""
        if self.real_back is None:
            self.real_back = any(
                command.word == "RET" and command.items and _is_real(command.items[0])
                for job in self.jobs.values()
                for command, _ in job.mentions()
            )
        return self.real_back

    def changed_in(self, job: str) -> frozenset[Key] | None:
        """Global position variables that a job and those it calls may give another value; None: one cannot tell."""
        if job not in self.changes:
            found: set[Key] = set()
            seen, todo = {job}, [job]
            while todo:
                one = self.jobs.get(todo.pop())
                if one is None:
                    self.changes[job] = None
                    return None
                for command, _ in one.mentions():
                    if command.word in _CHANGE and command.items:
                        key = key_of(command.items[0])
                        found |= {key} if key is not None and key[0] == "P" else set()
                    if command.word in ("CALL", "JUMP", "PSTART"):
                        called = _called(command)
                        todo += [name for name in called if name not in seen]
                        seen.update(called)
            self.changes[job] = frozenset(found)
        return self.changes[job]

    def note(self, job: str, key: Key, kind: Kind) -> None:
        """The variable is given this somewhere."""
        if kind.form in (JOINTS, TARGET):
            home = job if key[0].startswith("L") else ""
            self.forms.setdefault((home, key), {}).setdefault(kind.form, kind.origin)
        if not key[0].startswith("L"):
            self.update(self.globals, key, kind)

    def argument(self, job: str, number: int, kind: Kind) -> None:
        if (job.upper(), ("ARGUMENT", number)) in self.unified:
            kind = replace(kind, form=TARGET, frame=BASE)
        self.update(self.arguments, (job.upper(), number), kind)

    def update(self, table: dict[tuple[str, int], Kind] | dict[Key, Kind], key: object, kind: Kind) -> None:
        known = cast("dict[object, Kind]", table)
        before = known.get(key, NOTHING)
        now = joined(before, kind)
        if now != before:
            known[key] = now
            self.changed = True


def settle(project: Project, locals_of: Mapping[str, frozenset[str]]) -> dict[str, Flow]:
    """Go through all jobs until what flows between them is stable; gives each job's flow."""
    for _ in range(_ROUNDS):
        flows = _settled(project, locals_of)
        mixed = {each for flow in flows.values() for each in flow.mixed()}
        if mixed <= project.unified:
            break
        project.unified |= mixed
    return flows


def _settled(project: Project, locals_of: Mapping[str, frozenset[str]]) -> dict[str, Flow]:
    """The same with what is known to be stored as a pose."""
    project.globals.clear()
    project.arguments.clear()
    project.tools_left.clear()
    project.shifts_left.clear()
    project.forms.clear()
    for name, job in project.jobs.items():
        for (bank, number), point in job.points.items():
            if bank == "P":
                key: Key = (bank, number)
                project.note(name, key, kind_of_point(point.form, point.frame, point.tool, point.line.origin))
    flows: dict[str, Flow] = {}
    for project.assuming in (False, True):
        for _ in range(_ROUNDS + 2 * len(project.jobs)):  # what calls pass on goes one job further each time
            project.changed = False
            for name, job in project.jobs.items():
                flows[name] = Flow(project, job, project.indirect | locals_of[name])
                flows[name].run()
            if not project.changed:
                break
    return flows


def kind_of_point(form: str, frame: Frame, tool: int, origin: Origin) -> Kind:
    if form == POSE:
        return Kind(TARGET, frame, ir.IntLiteral(tool), origin)
    return Kind(JOINTS, BASE, ir.IntLiteral(tool), origin)


class Flow:
    """One job: what its variables hold before each instruction."""

    def __init__(self, project: Project, job: Job, indirect: frozenset[str]) -> None:
        self.project, self.job, self.indirect = project, job, indirect
        self.labels: dict[str, State] = {}
        self.before: dict[int, State] = {}
        self.moved = False

    def run(self) -> None:
        for _ in range(_ROUNDS):
            self.moved = False
            self.ends(self.through(self.job.body, {}))
            if not self.moved:
                return

    def kind(self, operand: Operand, state: State) -> Kind:
        """What a position operand holds."""
        key = key_of(operand)
        return NOTHING if key is None else self.held(key, state)

    def held(self, key: Key, state: State) -> Kind:
        if key in state:
            return state[key]
        if key == SHIFTED:
            return self.project.arguments.get((self.job.name.upper(), _CALLER), Kind(OFF))
        if key == TOOL:
            return Kind("tool", tool=INHERITED)
        if key[0] == "P" and key in self.project.globals:
            return self.project.globals[key]
        if key[1] is not None:  # nobody names it: what computed indices have put there
            return self.held((key[0], None), state)
        return NOTHING

    def mixed(self) -> set[tuple[str, Key]]:
        """Variables and arguments of which one cannot tell what they hold where they are read."""
        found: set[tuple[str, Key]] = set()
        for command, nodes in self.job.mentions():
            state = self.before.get(id(command), {})
            for node in nodes:
                if command.word in _WRITE and node is command.items[0]:
                    continue
                key = key_of(node)
                kind = NOTHING if key is None else self.held(key, state)
                if kind.form == MIXED or (is_mixed(kind) and self.needs_frame(command, node)):
                    assert key is not None
                    found.add((self.job.name if key[0] != "P" else "", self.holder(key, state)))
            if command.word == "GETARG" and len(command.items) > 1 and isinstance(command.items[1], Numbered):
                number = command.items[1].number
                if isinstance(number, ir.IntLiteral) and self.is_wanted_in_base(command.items[0]):
                    found.add((self.job.name.upper(), ("ARGUMENT", number.value)))
        for (job, argument), kind in self.project.arguments.items():
            if kind.form == MIXED and argument >= 0:
                found.add((job, ("ARGUMENT", argument)))
        return found

    def is_wanted_in_base(self, operand: Operand) -> bool:
        key = key_of(operand)
        return key is not None and self.project.is_unified(self.job.name, key)

    def needs_frame(self, command: Command, node: object) -> bool:
        """Does the frame of a pose count where it stands? Its numbers alone do where they are read and copied."""
        items, word = command.items, command.word
        if word in ("CALL", "PSTART"):
            name = next((item.name.upper() for item in items if isinstance(item, JobName)), "")
            given = _given(command)
            wanted = (n for n, value in enumerate(given, 1) if (name, ("ARGUMENT", n)) in self.project.unified)
            return any(given[n - 1] == node for n in wanted)
        if word == "SET":
            return len(items) > 1 and items[1] == node and self.is_wanted_in_base(items[0])
        if word in ("CNVRT", "MSHIFT", "MFRAME"):
            return any(item == node for item in items[1:])
        if word in ("IMOV", "SIMOV", "SFTON"):
            return not any(frame_of(item) is not None for item in items)
        return word in tables.MOVES

    def holder(self, key: Key, state: State) -> Key:
        """The variable whose value this is: itself, or all that computed indices reach."""
        known = key in state or key in self.project.globals
        return key if known or key[1] is None else (key[0], None)

    def join(self, one: State | None, other: State | None) -> State | None:
        if one is None or other is None:
            return other if one is None else one
        return {key: joined(self.held(key, one), self.held(key, other)) for key in {*one, *other}}

    # ---- order

    def through(self, items: Iterable[Item], state: State | None) -> State | None:
        """The state behind a list of lines; None where it cannot be reached."""
        for item in items:
            if isinstance(item, ir.Label):
                state = self.join(state, self.labels.get(item.name))
            elif isinstance(item, ModulePart) and isinstance(item.data, Command):
                state = self.command(item.data, state)
            elif isinstance(item, ModulePart) and isinstance(item.data, Nest):
                state = self.nest(item.data, state)
        return state

    def nest(self, nest: Nest, state: State | None) -> State | None:
        self.remember(nest.head, state)
        for head, _ in nest.sections:
            if head is not None:
                self.remember(head, state)
        if nest.kind in ("while", "for"):
            for _ in range(_ROUNDS):
                after = self.join(state, self.through(nest.sections[0][1], state))
                if after == state:
                    break
                state = after
            return state
        ends: State | None = None
        complete = False
        for head, items in nest.sections:
            complete = complete or (head is not None and head.word in ("ELSE", "DEFAULT"))
            if nest.kind == "switch" and head is None:
                continue
            ends = self.join(ends, self.through(items, None if state is None else dict(state)))
        return ends if complete else self.join(ends, state)

    def remember(self, command: Command, state: State | None) -> None:
        known = self.before.get(id(command))
        self.before[id(command)] = self.join(known, state) or {}

    def command(self, command: Command, state: State | None) -> State | None:
        self.remember(command, state)
        if state is None:
            return None
        conditional = _is_conditional(command)
        match command.word:
            case "JUMP":
                self.jump(command, state)
                if any(isinstance(item, JobName) for item in command.items):
                    self.ends(self.call(command, state))
                return state if conditional else None
            case "RET" | "END" | "ABORT":
                self.ends(state)
                return state if conditional else None
            case "CALL" | "PSTART":
                return self.call(command, state)
            case "SFTON" | "SFTOF" | "SFTON3D" | "SFTOF3D":
                return {**state, SHIFTED: Kind(ON if command.word.startswith("SFTON") else OFF)}
            case word if word in tables.MOVES:
                now = self.driven(command, state)
                return self.join(state, now) if conditional else now
        now = self.transfer(command, state)
        return self.join(state, now) if conditional and now != state else now

    def jump(self, command: Command, state: State) -> None:
        for item in command.items:
            if isinstance(item, LabelName):
                self.reach(item.name, state)
            elif isinstance(item, LabelBy):
                for label in _labels(self.job.body):
                    self.reach(label, state)

    def reach(self, label: str, state: State) -> None:
        before = self.labels.get(label)
        now = dict(state) if before is None else self.join(before, state) or {}
        if now != before:
            self.labels[label] = now
            self.moved = True

    def call(self, command: Command, state: State) -> State:
        """The called job may give other values to global variables."""
        name = next((item.name for item in command.items if isinstance(item, JobName)), "")
        self.project.argument(name, _CALLER, self.held(SHIFTED, state))
        left = None
        if command.word != "PSTART":
            if (tool := self.caller_tool(state)) is not None:
                self.project.argument(name, _CALLER_TOOL, tool)
            left = self.project.tools_left.get((name.upper(), 0))
            state = self.shift_left(command, name.upper(), state)
        if left is not None and left.tool != INHERITED:
            now = self.held(TOOL, state)
            state = {**state, TOOL: joined(now, left) if _is_conditional(command) else left}
        given = _given(command)
        for number, value in enumerate(given, 1):
            self.project.argument(name, number, self.kind(value, state))
        changed = self.project.changed_in(name.upper())
        if changed is not None and ("P", None) not in changed:
            return {key: joined(kind, self.held(key, {})) if key in changed else kind for key, kind in state.items()}
        return {key: kind if key[0] != "P" else joined(kind, self.held(key, {})) for key, kind in state.items()}

    def shift_left(self, command: Command, name: str, state: State) -> State:
        """M: a shift stays when the job that began it ends (jobs that only begin one are in use), until SFTOF.
        A job that is called by a number may be any."""
        left = [kind for (job, _), kind in self.project.shifts_left.items() if name in ("", job)]
        if all(kind.form == AS_FOUND for kind in left):
            return state
        after = left[0] if len(left) == 1 and not _is_conditional(command) else Kind(MIXED)
        before = self.held(SHIFTED, state)
        return {**state, SHIFTED: joined(before, after) if after.form == MIXED else after}

    # ---- the tool

    def tool(self, state: State) -> ir.Expression:
        """The tool that the controller works with: that of the last move; the job's own where no move is known."""
        tool = self.held(TOOL, state).tool
        if tool == INHERITED:
            tool = self.project.arguments.get((self.job.name.upper(), _CALLER_TOOL), NOTHING).tool
        return ir.IntLiteral(self.job.tool) if tool is None else tool

    def caller_tool(self, state: State) -> Kind | None:
        """The tool that a called job finds; None where no move is known that came before (it takes its own then)."""
        known = self.project.arguments.get((self.job.name.upper(), _CALLER_TOOL))
        if self.held(TOOL, state).tool == INHERITED and known is None:
            return None
        return Kind("tool", tool=self.tool(state))

    def ends(self, state: State | None) -> None:
        if state is not None:
            key = (self.job.name.upper(), 0)
            self.project.update(self.project.tools_left, key, self.held(TOOL, state))
            self.project.update(self.project.shifts_left, key, state.get(SHIFTED, Kind(AS_FOUND)))

    def driven(self, command: Command, state: State) -> State:
        """A move takes the tool of its position."""
        arm = next((item for item in command.items if isinstance(item, ir.Index)), None)
        if arm is None or not isinstance(arm.base, ir.Name) or arm.base.id not in ("C", "P", "LP"):
            return state
        number = arm.indices[0]
        tool = self.kind(arm, state).tool
        if arm.base.id == "C" and isinstance(number, ir.IntLiteral):
            point = self.job.points.get(("C", number.value))
            tool = None if point is None else ir.IntLiteral(point.tool)
        return {**state, TOOL: Kind("tool", tool=ir.IntLiteral(self.job.tool) if tool is None else tool)}

    # ---- what instructions do

    def transfer(self, command: Command, state: State) -> State:
        items = command.items
        target = key_of(items[0]) if items else None
        if target is None:
            return state
        kind = self.result(command, state)
        if kind is None or kind.form == UNKNOWN:
            return state
        kind = replace(kind, origin=command.origin)
        if self.project.is_unified(self.job.name, target):
            kind = replace(kind, form=TARGET, frame=BASE)
        self.project.note(self.job.name, target, kind)
        if target[1] is None:
            kind = joined(self.held(target, state), kind)
        return {**state, target: kind}

    def result(self, command: Command, state: State) -> Kind | None:
        """What the first operand holds afterwards; None: as before."""
        items = command.items
        match command.word:
            case "SET" if len(items) > 1:
                return self.kind(items[1], state)
            case "GETS" if len(items) > 1 and isinstance(items[1], SystemName):
                pulses = tables.POSITIONS.get(items[1].name, ("", False))[1]
                return Kind(JOINTS if pulses else TARGET, tool=self.tool(state))
            case "CNVRT" if len(items) > 2:
                if items[2] == Word("PULSE"):
                    return Kind(JOINTS)
                tool = next((i.number for i in items if isinstance(i, Numbered) and i.word == "TL"), None)
                before = self.kind(items[1], state)
                return Kind(TARGET, frame_of(items[2]) or BASE, before.tool if tool is None else tool)
            case "MULMAT" | "INVMAT" | "MSHIFT" | "CONVSFT":
                return Kind(TARGET)
            case "GETPOS" if len(items) > 1 and isinstance(items[1], Numbered):
                number = items[1].number
                point = self.job.points.get(("C", number.value)) if isinstance(number, ir.IntLiteral) else None
                return kind_of_point(point.form, point.frame, point.tool, command.origin) if point else None
            case "GETARG" if len(items) > 1 and isinstance(items[1], Numbered):
                number = items[1].number
                if isinstance(number, ir.IntLiteral):
                    return self.project.arguments.get((self.job.name.upper(), number.value))
            case "SETE" if len(items) > 1 and isinstance(items[1], Numbered) and items[1].word == "TL":
                return replace(self.kind(items[0], state), tool=items[1].number)
            case "SETE" if self.project.assuming and self.kind(items[0], state).form == UNKNOWN:
                return Kind(TARGET) if isinstance(items[1], Group) else None
        return None


def frame_of(operand: Operand) -> Frame | None:
    """The frame that an operand of an instruction names."""
    match operand:
        case Word(text=text) if text in tables.BASE_WORDS:
            return BASE
        case Word(text=text) if text in tables.TOOL_WORDS:
            return Frame("tool")
        case Word(text="MTF" | "MTOOL"):
            return Frame("master")
        case Numbered(word="UF", number=number):
            return Frame("user", number)
    return None


def _is_real(operand: Operand) -> bool:
    match operand:
        case ir.Index(base=ir.Name(id=bank)):
            return bank.removeprefix("L").startswith("R")
    return isinstance(operand, ir.RealLiteral)


def _called(command: Command) -> list[str]:
    """The jobs that it goes to; "" for one that is computed."""
    if any(isinstance(item, LabelName | LabelBy) for item in command.items):
        return []
    return [item.name.upper() for item in command.items if isinstance(item, JobName)] or [""]


def _given(command: Command) -> list[Operand]:
    """What a job is given, `ARGF a ARGF b` or `(a, b)`."""
    given: list[Operand] = [item.value for item in command.items if isinstance(item, Given)]
    given.extend(next((item.values for item in command.items if isinstance(item, Group)), ()))
    return given


def _is_conditional(command: Command) -> bool:
    return any(isinstance(item, Word) and item.text in tables.CONDITION_WORDS for item in command.items)


def _labels(items: Iterable[Item]) -> Iterable[str]:
    for item in items:
        if isinstance(item, ir.Label):
            yield item.name
        elif isinstance(item, ModulePart) and isinstance(item.data, Nest):
            for _, inner in item.data.sections:
                yield from _labels(inner)


labels_of = _labels
