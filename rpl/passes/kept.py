"""Data that a controller keeps and whose value stands in no file of the project: registers, variables, taught frames.

Such a variable's first value, or that of an element, is a `VendorValue` that names it in the controller's words. The
question here is whether a program may read it before it has set it on some way. A list that is read by a computed
number counts as one: as set where any of its elements has been set or is known.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import is_statement, walk
from rpl.passes.rewrite import visit_parts
from rpl.passes.scope import rules_of
from rpl.passes.settable import settable
from rpl.source import Origin

Keys = frozenset[str]
_NONE: Keys = frozenset()
# All components of a place; setting each of them sets the place.
_WHOLE = tuple(frozenset(names) for names in (ir.POSE, ir.AXES))
# Built-in procedures that read their first argument before they change it.
_CHANGING = frozenset(("increment", "decrement", "text_append"))


TAKEN_AS_ZERO = code(
    "kept-value-zero",
    Severity.WARNING,
    "{name} is read before the program sets it, and its value stands on the controller only: it begins at zero here",
    "add the controller's file with the values to the project, or give the value in the cell file:"
    ' [variables] "{path}" = ...',
)


def report_taken_as_zero(program: ir.Program, diagnostics: Diagnostics) -> None:
    """What a run takes for granted about data that the controller keeps: once for each."""
    unset = unset_reads(program)
    faults = _places(program, faulting=True) if unset else _NONE
    for one in unset:
        if one.key.partition("[")[0] in faults:
            continue  # a run that reads such a place ends there
        diagnostics.report(TAKEN_AS_ZERO, one.origin, name=one.name, path=one.path)


@dataclass(frozen=True, slots=True)
class UnsetRead:
    """A kept value that may be read before it is set. `key`: the variable (`R2`) or element (`R[2]`), folded; a whole
    list ends with `[]`. `name`: in the controller's words. `origin`: a place that reads it. `roots`: the routines that
    nothing calls and from which that place is reached. `may_be_set`: it is a place that something in the program sets,
    whole or in part, though not certainly before."""

    key: str
    name: str
    path: str
    origin: Origin
    roots: tuple[str, ...]
    may_be_set: bool = False


def _places(program: ir.Program, *, faulting: bool = False) -> Keys:
    """Kept places, and lists of such. `faulting`: of languages in which reading one without a value is a fault."""
    found: set[str] = set()
    for module in program.modules:
        if faulting and not rules_of(module.dialect).undefined:
            continue
        for one in module.declarations:
            if isinstance(one, ir.Variable) and one.storage == "persistent":
                type = one.type.element if isinstance(one.type, ir.ArrayType) else one.type
                found |= {one.name.lower()} if zero_of(type) is None else set()
    return frozenset(found)


def kept_values(program: ir.Program) -> dict[str, tuple[str, str]]:
    """The kept values that no file gives: key -> name in the controller's words and in a cell file."""
    found: dict[str, tuple[str, str]] = {}
    for module in program.modules:
        for one in module.declarations:
            match one:
                case ir.Initialise(assign=ir.Assign(target=target)):
                    _known_element(target, found)
            if not isinstance(one, ir.Variable) or one.storage != "persistent":
                continue
            name = one.name.lower()
            match one.initial, one.type:
                case ir.VendorValue(text=text), _:
                    found[name] = text, one.name
                case ir.Aggregate(entries=entries), ir.ArrayType(base=base):
                    unknown = [at for at, (_, value) in enumerate(entries, base) if isinstance(value, ir.VendorValue)]
                    texts = {at: value.text for at, (_, value) in enumerate(entries, base)
                             if isinstance(value, ir.VendorValue)}  # fmt: skip
                    found.update({f"{name}[{at}]": (texts[at], f"{one.name}[{at}]") for at in unknown})
                    if unknown and len(unknown) >= len(entries) - (base == 0):
                        found[f"{name}[]"] = f"{one.name}[...]", f"{one.name}[{max(unknown[0], 1)}]"
    return found


def unknown_data(program: ir.Program) -> set[str]:
    """Data of which no file gives any part, folded."""
    kept, found = kept_values(program), set[str]()
    for module in program.modules:
        for one in module.declarations:
            match one:
                case ir.Variable(name=name, storage="persistent", initial=ir.VendorValue()) if name.lower() in kept:
                    found.add(name.lower())
                case ir.Variable(name=name, storage="persistent", initial=ir.Aggregate(entries=entries)) if entries:
                    whole = f"{name.lower()}["
                    if sum(key.startswith(whole) and key != f"{whole}]" for key in kept) == len(entries):
                        found.add(name.lower())
    return found


def _known_element(place: ir.Expression, found: dict[str, tuple[str, str]]) -> None:
    """A value that is given behind the declaration: the element is known, and with it some element of the list."""
    match place:
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)):
            found.pop(f"{name.lower()}[{at}]", None)
            found.pop(f"{name.lower()}[]", None)
        case ir.Name(id=name):
            found.pop(name.lower(), None)


def unset_reads(program: ir.Program) -> list[UnsetRead]:
    """Kept values without a known value that some way of the program reads before it sets them, in order of names."""
    kept = kept_values(program)
    if not kept:
        return []
    routines = [routine for module in program.modules for routine in module.routines]
    flows = {routine.name.lower(): _Flow(routine, kept) for routine in routines}
    changed = True
    while changed:
        changed = sum(flow.settle(flows) for flow in flows.values()) > 0
    called = {name for flow in flows.values() for name in flow.runs}
    roots = [flow for name, flow in flows.items() if name not in called] or list(flows.values())
    found: dict[str, tuple[Origin, list[str]]] = {}
    for flow in roots:
        for key, origin in flow.needs.items():
            whole = key.partition(".")[0]
            names = found.setdefault(whole, (origin, []))[1]
            if flow.name not in names:
                names.append(flow.name)
    places = _places(program)
    late = {key for key in found if key.partition("[")[0] in places}
    index = settable(program) if late else None
    return [
        UnsetRead(key, *kept[key], origin, tuple(names), index is not None and key in late and index.may_set(key))
        for key, (origin, names) in sorted(found.items())
    ]


@dataclass(slots=True)
class _Step:
    """One step of a routine's flow. `ways`: the labels to which it may jump; `falls`: it may go on behind."""

    reads: dict[str, Origin] = field(default_factory=dict)
    sets: Keys = _NONE
    calls: str = ""
    starts: str = ""
    joins: str = ""
    ways: tuple[str, ...] = ()
    falls: bool = True
    leaves: bool = False


class _Flow:
    """The flow of one routine through what is kept. `needs`: what it may read before it is set; `gives`: what is
    certainly set behind it (None: nothing comes back yet). `runs`: the routines that it calls or starts."""

    def __init__(self, routine: ir.Routine, kept: Mapping[str, object]) -> None:
        self.name = routine.name
        self.kept = kept
        own = {one.name.lower() for one in (*routine.parameters, *routine.declarations) if hasattr(one, "name")}
        self.hidden = own
        self.steps: list[_Step] = []
        self.labels: dict[str, int] = {}
        self.numbers = 0
        self.hits: dict[str, Keys] = {}  # flag of a search, what is set where it is TRUE
        self.runs: set[str] = set()
        self.needs: dict[str, Origin] = {}
        self.gives: Keys | None = None
        self.flatten(routine)

    # ---- from statements to steps

    def fresh(self) -> str:
        self.numbers += 1
        return f"#{self.numbers}"

    def flatten(self, routine: ir.Routine) -> None:
        """All bodies as steps; nested statements are put on a stack of work, not entered."""
        further = [body for body in (*(one.body for one in routine.handlers), routine.undo, routine.backward) if body]
        work: list[object] = [("end",)]
        for body in further:
            label = self.fresh()
            self.steps.append(_Step(ways=(label,)))
            work += [*reversed(body), ("label", label), ("end",)]
        work += reversed(routine.body)
        loops: list[tuple[str, str]] = []
        while work:
            item = work.pop()
            match item:
                case ("label", str() as name):
                    self.labels[name] = len(self.steps)
                case ("set", frozenset() as keys):
                    self.steps.append(_Step(sets=keys))
                case ("jump", str() as name):
                    self.steps.append(_Step(ways=(name,), falls=False))
                case ("fork", tuple() as names):
                    self.steps.append(_Step(ways=names))
                case ("into", str() as leave, str() as again):
                    loops.append((leave, again))
                case ("out",):
                    loops.pop()
                case ("end",):
                    self.steps.append(_Step(falls=False, leaves=True))
                case ir.ExitLoop() if loops:
                    self.steps.append(_Step(ways=(loops[-1][0],), falls=False))
                case ir.NextPass() if loops:
                    self.steps.append(_Step(ways=(loops[-1][1],), falls=False))
                case _:
                    work += reversed(self.statement(item))

    def statement(self, statement: object) -> list[object]:
        """Steps for a statement; what is inside is given back as work."""
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                end, made = self.fresh(), list[object]()
                for condition, body in branches:
                    behind = self.fresh()
                    look = _Look(condition, statement.origin)
                    hit, missed = self.found(condition, body)
                    made += [look, ("fork", (behind,)), *hit, *body, ("jump", end), ("label", behind), *missed]
                return [*made, *otherwise, ("label", end)]
            case ir.Switch(selector=selector, cases=cases, default=default):
                self.use(selector, statement.origin)
                end, made = self.fresh(), []
                names = [self.fresh() for _ in cases]
                for name, case in zip(names, cases, strict=True):
                    self.use(case.values, statement.origin)
                    made += [("label", name), *case.body, ("jump", end)]
                return [("fork", tuple(names)), *(default or ()), ("jump", end), *made, ("label", end)]
            case ir.For() | ir.While() | ir.Repeat() | ir.Loop():
                return self.loop(statement)
            case ir.Label(name=name):
                return [("label", name.lower())]
            case ir.Goto(label=name):
                return [("jump", name.lower())]
            case _Look(expression=expression, origin=origin):
                self.use(expression, origin)
                return []
            case ir.Return() | ir.Retry() | ir.TryNext():
                self.plain(statement)
                return [("end",)]
            case ir.Halt(kind="exit" | "cycle") | ir.Raise():
                self.plain(statement)
                self.steps.append(_Step(falls=False))
                return []
        assert is_statement(statement)
        self.plain(statement)
        return []

    def found(self, condition: ir.Expression, body: ir.Body) -> tuple[list[object], list[object]]:
        """Work that says what a search has set: where the condition, its flag, holds, and where it does not."""
        match condition:
            case ir.Name(id=flag) if flag in self.hits:
                known = self.hits[flag]
                for one in body:
                    if isinstance(one, ir.Assign):
                        self.hits[flag] |= self.place(one.target, [])
                return [("set", known)], []
            case ir.Unary(op="not", operand=ir.Name(id=flag)) if flag in self.hits:
                return [], [("set", self.hits[flag])]
        return [], []

    def loop(self, loop: ir.For | ir.While | ir.Repeat | ir.Loop) -> list[object]:
        head, again, leave = self.fresh(), self.fresh(), self.fresh()
        inside = [("into", leave, again), *loop.body, ("label", again), ("out",)]
        match loop:
            case ir.While(condition=condition):
                look = _Look(condition, loop.origin)
                return [("label", head), look, ("fork", (leave,)), *inside, ("jump", head), ("label", leave)]
            case ir.Repeat(until=until):
                return [("label", head), *inside, _Look(until, loop.origin), ("fork", (head,)), ("label", leave)]
            case ir.Loop():
                return [("label", head), *inside, ("jump", head), ("label", leave)]
        self.use((loop.start, loop.stop, loop.step), loop.origin)
        counter = loop.counter.lower()
        self.steps.append(_Step(sets=frozenset((counter,)) & self.kept.keys()))
        passed = [] if loop.at_least_once or _has_a_pass(loop) else [("fork", (leave,))]
        return [*passed, ("label", head), *inside, ("fork", (head,)), ("label", leave)]

    def plain(self, statement: ir.Statement) -> None:
        """A statement without blocks: what it reads, then what it sets, calls and starts."""
        read: list[object] = []
        sets: set[str] = set()
        match statement:
            case ir.Assign(target=target, value=value):
                read.append(value)
                sets |= self.place(target, read)
            case ir.Do(procedure=procedure, arguments=arguments):
                read += arguments if procedure in _CHANGING else arguments[1:]
                if arguments and arguments[0] is not None:
                    sets |= self.place(arguments[0], [])
            case ir.WaitUntil(timed_out=flag) if flag is not None:
                read += [statement.condition, statement.timeout]
                sets |= self.place(flag, read)
            case ir.Dialog(answer=answer):
                read += [statement.text, statement.timeout]
                sets |= self.place(answer, read)
            case ir.Move(search=ir.Search(found=place, hit=flag) as search):
                read.append(replace(statement, search=replace(search, found=None)))
                given = _NONE if place is None else frozenset(self.place(place, read))
                if isinstance(flag, ir.Name):
                    self.hits[flag.id] = given  # only where it found something
                else:
                    sets |= given
            case _:
                read.append(statement)
        self.use(tuple(one for one in read if one is not None), statement.origin)
        if sets:
            self.steps.append(_Step(sets=frozenset(sets)))
        for node in walk(statement):
            match node:
                case ir.CallRoutine(name=name) if node is statement:
                    self.run(_Step(calls=name.lower()), name)
                case ir.TaskControl(op="join", task=name):
                    self.steps.append(_Step(joins=name.lower()))
                case ir.CallRoutine(name=name) | ir.TaskControl(op="start", task=name):
                    self.run(_Step(starts=name.lower()), name)
                case ir.Call(name=name):
                    self.run(_Step(calls=name.lower()), name)

    def run(self, step: _Step, name: str) -> None:
        self.steps.append(step)
        self.runs.add(name.lower())

    def place(self, target: ir.Expression, read: list[object]) -> set[str]:
        """What an assignment to the place sets; the numbers of its elements are read."""
        if isinstance(target, ir.Index):
            read.extend(target.indices)
        if isinstance(target, ir.Field):
            key = self.key(target.base)
            read.extend(target.base.indices if isinstance(target.base, ir.Index) else ())
            return {f"{key}.{target.name.lower()}"} if key else set()
        key = self.key(target)
        return {key} if key else set()

    def key(self, place: object) -> str:
        """The key of a variable, element or list; empty for anything else, a component among it."""
        match place:
            case ir.Name(id=name) if name.lower() in self.kept and name.lower() not in self.hidden:
                return name.lower()
            case ir.Index(base=ir.Name(id=name), indices=(index,)) if name.lower() not in self.hidden:
                one = f"{name.lower()}[{index.value}]" if isinstance(index, ir.IntLiteral) else ""
                return one if one else f"{name.lower()}[]"
        return ""

    def use(self, part: object, origin: Origin) -> None:
        """A step that reads what stands in the part."""
        found: dict[str, Origin] = {}
        for node in _nodes(part):
            key, name = self.key(node), ""
            if isinstance(node, ir.Field):
                key, name = self.key(node.base), f".{node.name.lower()}"
            if key and key in self.kept:
                found.setdefault(key + name, origin)
        if found:
            self.steps.append(_Step(reads=found))

    # ---- along the steps

    def settle(self, flows: Mapping[str, _Flow]) -> bool:
        """Follow the steps with what is known of the routines; True when something new came out."""
        before = (len(self.needs), self.gives)
        states: dict[int, Keys] = {0: _NONE}
        work = [0]
        gives: Keys | None = None
        while work:
            at = work.pop()
            step, state = self.steps[at], states[at]
            for key, origin in step.reads.items():
                if not _is_set(key, state):
                    self.needs.setdefault(key, origin)
            behind: Keys | None = state | step.sets
            flow = flows.get(step.calls or step.starts)
            if flow is not None:
                for key, origin in flow.needs.items():
                    if not _is_set(key, state):
                        self.needs.setdefault(key, origin)
                if step.calls:
                    behind = None if flow.gives is None else state | flow.gives
            if step.joins in flows:
                given = flows[step.joins].gives  # what the task sets is set when it has ended
                behind = None if given is None else state | given
            if behind is None:
                continue
            if step.leaves:
                gives = behind if gives is None else gives & behind
            targets = [self.labels[name] for name in step.ways if name in self.labels]
            for to in [*targets, *([at + 1] if step.falls else [])]:
                known = states.get(to)
                met = behind if known is None else known & behind
                if known is None or met != known:
                    states[to] = met
                    work.append(to)
        self.gives = gives
        return before != (len(self.needs), self.gives)


@dataclass(frozen=True, slots=True)
class _Look:
    """An expression that is looked at between statements."""

    expression: object
    origin: Origin


def _is_set(key: str, state: Keys) -> bool:
    """Is the variable, element or component set? An element of a list that was filled by a computed number is, and a
    list of which some element was set; a place of which all components were set."""
    if key in state:
        return True
    whole, dot, part = key.partition(".")
    name, bracket, index = whole.partition("[")
    places = {whole}
    if bracket and index == "]":
        places = {one.partition(".")[0] for one in state if one.startswith(f"{name}[")}
    elif bracket:
        places.add(f"{name}[]")
    return any(
        one in state
        or (dot != "" and f"{one}.{part}" in state)
        or any(all(f"{one}.{component}" in state for component in components) for components in _WHOLE)
        for one in places
    )


def _nodes(part: object) -> Iterator[object]:
    """The expressions in a part that are read; those of bodies inside are not among them."""
    stack: list[object] = [part]
    while stack:
        one = stack.pop()
        if isinstance(one, tuple):
            stack.extend(reversed(one))
            continue
        if one is None:
            continue
        match one:
            case ir.Builtin(function="element_difference", arguments=(left, right)) if left == right:
                continue  # PR[1]=PR[1]-PR[1] makes zero of whatever there is
        yield one
        below: list[object] = []
        if isinstance(one, ir.Field):
            # A component of a place, not the whole of it; the numbers of elements are read.
            base = one.base
            below += base.indices if isinstance(base, ir.Index) else () if isinstance(base, ir.Name) else (base,)
        else:
            visit_parts(one, below.append)
        stack.extend(reversed(below))


def _has_a_pass(loop: ir.For) -> bool:
    match loop.start, loop.stop, loop.step:
        case ir.IntLiteral(value=first), ir.IntLiteral(value=last), None:
            return first <= last or loop.automatic
        case ir.IntLiteral(value=first), ir.IntLiteral(value=last), ir.IntLiteral(value=step):
            return first <= last if step > 0 else first >= last
    return False


def without_unknown(program: ir.Program) -> ir.Program:
    """The program in which kept values without a known value begin at zero, for who has asked about them before."""
    if not kept_values(program):
        return program

    modules = tuple(
        replace(module, declarations=tuple(one for given in module.declarations for one in _begun(given)))
        for module in program.modules
    )
    return replace(program, modules=modules)


def _begun(one: ir.Declaration) -> tuple[ir.Declaration, ...]:
    """A declaration without unknown values; known ones in a list of places, which have no zero, are set behind it."""
    if not isinstance(one, ir.Variable) or one.storage != "persistent":
        return (one,)
    match one.initial, one.type:
        case ir.VendorValue(type=type), _:
            return (replace(one, initial=zero_of(type)),)
        case ir.Aggregate(entries=entries), ir.ArrayType(base=base):
            filled = tuple((name, _known(value)) for name, value in entries)
            if not any(isinstance(value, ir.VendorValue) for _, value in filled):
                return (replace(one, initial=replace(one.initial, entries=filled)),)
            known = [(at, value) for at, (_, value) in enumerate(filled, base) if not isinstance(value, ir.VendorValue)]
            elements = ((ir.Index(ir.Name(one.name), (ir.IntLiteral(at),)), value) for at, value in known)
            given = (ir.Assign(element, value, origin=value.origin) for element, value in elements)
            return (replace(one, initial=None), *(ir.Initialise(each, origin=each.origin) for each in given))
    return (one,)


def _known(value: ir.Expression) -> ir.Expression:
    return (zero_of(value.type) or value) if isinstance(value, ir.VendorValue) else value


def zero_of(type: ir.Type) -> ir.Expression | None:
    """Zero, the empty text, FALSE or the identity; None for a type that has no such value."""
    match type:
        case ir.IntType() | ir.RealType():
            return ir.IntLiteral(0)
        case ir.StringType():
            return ir.TextLiteral("")
        case ir.BoolType():
            return ir.BoolLiteral(False)
        case ir.PoseType():
            return ir.Aggregate(tuple((name, ir.RealLiteral(0.0)) for name in ir.POSE), "pose")
    return None


__all__ = [
    "UnsetRead",
    "kept_values",
    "report_taken_as_zero",
    "unknown_data",
    "unset_reads",
    "without_unknown",
    "zero_of",
]
