"""AFFIX part TO hand [RIGIDLY], UNFIX part FROM hand and CLOSE gripper ON part, as the arithmetic of frames.

AL (Stanford, 1974) had the statement: the place of a frame is kept up to date when the frame changes that it is affixed
to, and RIGIDLY makes it symmetric (docs/rpl.md, Affixments). What can be affixed stands in the program's text, so no
run needs to know of it: AFFIX keeps the relative pose and sets a flag, and behind each statement that changes a frame
stands a call of the procedure that moves what hangs on it (following.py). Runs, passes and targets see assignments.
The tool changes by moves, not by statements: what is affixed to it is brought up to date before it is looked at.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeGuard

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import children, is_statement, rewrite, walk
from rpl.passes.scope import ProgramScope, Scope
from rpl.source import Origin

from .following import MOST_STEPS, TOOL, Following, Pair
from .references import by_reference

Key = tuple[int, int]
NO_FRAME = code(
    "affix-not-a-frame",
    Severity.ERROR,
    "{name} cannot be affixed: {why}",
    "affix frames of the module: FRAME name = {{...}} or VAR name: POSE outside of the routines",
)
TO_ITSELF = code(
    "affix-to-itself", Severity.ERROR, "{name} is affixed to itself", "name the frame that it is to move with"
)
NOT_AFFIXED = code(
    "unfix-not-affixed",
    Severity.ERROR,
    "{name} is never affixed to {other}: no statement of the program says AFFIX {name} TO {other}",
    "name the frame that stands behind TO in its AFFIX",
)
OUT_OF_SIGHT = code(
    "affixed-out-of-sight",
    Severity.ERROR,
    "no module sees all frames that are affixed to each other here: {names}",
    "declare them in one module, or GLOBAL with names that stand once in the program",
)
TANGLED = code(
    "affixed-too-often",
    Severity.ERROR,
    f"{{name}} moves other frames in more than {MOST_STEPS} ways",
    "affix each frame to one other",
)
UNSEEN_CHANGE = code(
    "affixed-frame-changed-here",
    Severity.ERROR,
    "{name} takes part in an affixment and is changed where nothing can follow it: {where}",
    "change it by a statement of its own: call a procedure that assigns to it, or call the function in an assignment",
)
HELD = code(
    "held-part-read-here",
    Severity.ERROR,
    "{name} can be affixed to the tool and is read where its place cannot be worked out first: {where}",
    "read it into a variable by a statement of its own, in front of this or inside of the loop",
)
_AGAIN = (ir.While, ir.Repeat, ir.WaitUntil, ir.DeclareInterrupt, ir.OrderInterrupt)
_ENDS = (ir.Return, ir.Raise, ir.WaitUntil, ir.DeclareInterrupt, ir.OrderInterrupt, ir.TaskControl)
_BLOCKS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop, ir.Spline)


@dataclass(frozen=True, slots=True)
class Affixing:
    """An AFFIX, UNFIX or CLOSE ... ON as it was read. kind: affix, rigidly, unfix. parent: nothing where that is the
    tool. A call of nothing stands in its place in the body until the whole program is known."""

    kind: str
    child: ir.Expression
    parent: ir.Expression | None
    origin: Origin
    gripper: str = ""

    @property
    def stand_in(self) -> ir.CallRoutine:
        return ir.CallRoutine("", (), origin=self.origin)


def with_affixments(
    program: ir.Program, read: Sequence[Affixing], hanging: Iterable[tuple[str, Origin]], diagnostics: Diagnostics
) -> ir.Program:
    """The program with its affixments as arithmetic. hanging: the frames that were declared ON another one, by name and
    place. What cannot be affixed is reported and stays as text."""
    if not read:
        return program
    statements = {_key(one.origin): one for one in read}
    fixed = {(*_key(origin), name.lower()) for name, origin in hanging}
    work = _Affixments(ProgramScope(program), statements, fixed, diagnostics)
    work.resolve()
    work.settle()
    return replace(program, modules=work.modules())


def _key(origin: Origin) -> Key:
    return id(origin.source), origin.start


def _quiet(origin: Origin) -> Origin:
    """The place without its comments: they stand once."""
    return replace(origin, comments=())


@dataclass(slots=True)
class _Affixments:
    scopes: ProgramScope
    statements: Mapping[Key, Affixing]
    hanging: set[tuple[int, int, str]]
    diagnostics: Diagnostics
    pairs: list[Pair] = field(default_factory=list)
    moved: dict[int, str] = field(default_factory=dict)  # frame -> the procedure that a change of it calls
    meant: dict[Key, Pair] = field(default_factory=dict)  # the pairs of the statements that are as they should be
    added: dict[int, tuple[list[ir.Variable], list[ir.Routine]]] = field(default_factory=dict)  # to modules
    called: set[str] = field(default_factory=set)  # the procedures that are needed
    released: dict[int, list[Pair]] = field(default_factory=dict)  # by the routine that opens a gripper
    with_tool: set[int] = field(default_factory=set)  # the frames that hang together with the tool
    carried: set[int] = field(default_factory=set)  # those of them that the tool can carry along
    _taken: set[str] = field(default_factory=set)

    # ---- what the statements mean

    def resolve(self) -> None:
        """Find the frames of every AFFIX, then those of every UNFIX."""
        places = [
            (self.scopes.routine(module, routine), self.statements[_key(node.origin)])
            for module, routine in self.scopes.routines()
            for node in walk(routine)
            if self._stands_for(node)
        ]
        for scope, statement in sorted(places, key=lambda place: place[1].kind == "unfix"):
            child, parent = self._frame(statement.child, scope, statement.origin), self._parent(statement, scope)
            if child is None or parent is None:
                continue
            if child is parent:
                self.diagnostics.report(TO_ITSELF, statement.origin, name=child.name)
                continue
            self._take(statement, child, parent, scope)

    def _parent(self, statement: Affixing, scope: Scope) -> ir.Variable | None:
        if statement.parent is not None:
            return self._frame(statement.parent, scope, statement.origin)
        if statement.kind == "rigidly":
            why = "a robot is moved by MOVE, not by its data (leave RIGIDLY out)"
            self.diagnostics.report(NO_FRAME, statement.origin, name="TOOL", why=why)
            return None
        return TOOL

    def _stands_for(self, node: object) -> TypeGuard[ir.CallRoutine]:
        return isinstance(node, ir.CallRoutine) and not node.name and _key(node.origin) in self.statements

    def _take(self, statement: Affixing, child: ir.Variable, parent: ir.Variable, scope: Scope) -> None:
        pair = next((one for one in self.pairs if one.child is child and one.parent is parent), None)
        if pair is None:
            if statement.kind == "unfix":
                self.diagnostics.report(NOT_AFFIXED, statement.origin, name=child.name, other=parent.name)
                return
            pair = Pair(child, parent, _quiet(statement.origin))
            self.pairs.append(pair)
        pair.rigid |= statement.kind == "rigidly"
        pair.one_way |= statement.kind == "affix"
        self.meant[_key(statement.origin)] = pair
        opens = scope.routine(f"open_{statement.gripper}") if statement.gripper else None
        if opens is not None and pair not in self.released.setdefault(id(opens), []):
            self.released[id(opens)].append(pair)

    def _frame(self, named: ir.Expression, scope: Scope, at: Origin) -> ir.Variable | None:
        """The frame that an AFFIX names, or nothing, reported."""
        if not isinstance(named, ir.Name):
            what = "part of a variable" if isinstance(named, ir.Field | ir.Index) else "value"
            self.diagnostics.report(NO_FRAME, at, name=_written(named), why=f"it is a {what}, not a frame of its own")
            return None
        found = scope.value(named.id)
        why = "nothing of that name is declared here" if found is None else ""
        if found is not None:
            declared = found.declaration
            if isinstance(declared, ir.Variable) and not found.routine:
                why = self._refusal(declared, scope)
                if not why:
                    return declared
            elif isinstance(declared, ir.Parameter):
                why = "a parameter is another frame in each call"
            else:
                why = "it is a variable of the routine" if found.routine else "it is a signal"
        self.diagnostics.report(NO_FRAME, at, name=named.id, why=why)
        return None

    def _refusal(self, declared: ir.Variable, scope: Scope) -> str:
        type = scope.resolve(declared.type)
        if isinstance(type, ir.ArrayType):
            return "it is an array"
        if not isinstance(type, ir.PoseType):
            return f"its type is {_type_word(type)}, and only a POSE has a place that can be moved with another"
        if declared.storage == "constant":
            return "it is a constant, which does not move"
        if (*_key(declared.origin), declared.name.lower()) in self.hanging:
            return "it hangs on another frame by its declaration (ON)"
        return ""

    # ---- the data and procedures of the frames

    def settle(self) -> None:
        """Name the data, write the procedures, and say in which modules they stand."""
        self._taken = {name.lower() for name in self._names()}
        for pairs in self._groups():
            frames = {id(frame): frame for pair in pairs for frame in (pair.child, pair.parent)}
            home = self._home(frames)
            if home is None:
                names = ", ".join(frame.name for frame in frames.values())
                self.diagnostics.report(OUT_OF_SIGHT, pairs[0].origin, name=names, names=names)
                self.meant = {key: pair for key, pair in self.meant.items() if pair not in pairs}
                continue
            local = all(frame.scope == "module" for frame in frames.values()) and self._opens_in(home, pairs)
            for pair in pairs:
                pair.name(self._free)
            variables, routines = self.added.setdefault(id(home), ([], []))
            variables += [one for pair in pairs for one in pair.declarations("module" if local else "global")]
            for frame in frames.values():
                routines += self._procedure(frame, pairs, "task" if local else "global")

    def _opens_in(self, home: ir.Module, pairs: Sequence[Pair]) -> bool:
        """Whether the routines that release any of the pairs stand in that module."""
        return all(
            module is home
            for module, routine in self.scopes.routines()
            if any(pair in pairs for pair in self.released.get(id(routine), ()))
        )

    def _procedure(self, frame: ir.Variable, pairs: Sequence[Pair], scope: str) -> list[ir.Routine]:
        following = Following(pairs)
        body = following.body(frame)
        if frame is TOOL:
            self.carried |= following.frames.keys()
            self.with_tool |= {id(one) for pair in pairs for one in (pair.child, pair.parent)}
        if following.steps > MOST_STEPS:
            self.diagnostics.report(TANGLED, frame.origin, name=frame.name)
        if not body:
            return []
        name = self.moved[id(frame)] = self._free(f"{frame.name}_moved")
        return [ir.Routine(name, body=body, scope=scope, origin=_quiet(frame.origin))]

    def _groups(self) -> list[list[Pair]]:
        """The pairs that hang together through their frames, in the order of the text."""
        groups: list[list[Pair]] = []
        for pair in self.pairs:
            ends = (pair.child, pair.parent)
            touching = [
                g for g in groups if any(end is other for o in g for other in (o.child, o.parent) for end in ends)
            ]
            groups = [group for group in groups if group not in touching]
            joined = [*(one for group in touching for one in group), pair]
            groups.append(sorted(joined, key=self.pairs.index))
        return groups

    def _home(self, frames: Mapping[int, ir.Variable]) -> ir.Module | None:
        """The module that sees all the frames by their names; first the one of the first frame."""
        declared = [frame for frame in frames.values() if frame is not TOOL]
        first = self.scopes.home(declared[0])
        for module in sorted(self.scopes.program.modules, key=lambda one: one is not first):
            seen = [(self.scopes.module(module).value(frame.name), frame) for frame in declared]
            if all(found is not None and found.declaration is frame for found, frame in seen):
                return module
        return None

    def _names(self) -> Iterator[str]:
        for module in self.scopes.program.modules:
            yield from (routine.name for routine in module.routines)
            for node in walk(module):
                if isinstance(node, ir.Variable | ir.Parameter | ir.SignalDeclaration):
                    yield node.name

    def _free(self, wanted: str) -> str:
        found, number = wanted, 1
        while found.lower() in self._taken:
            number += 1
            found = f"{wanted}_{number}"
        self._taken.add(found.lower())
        return found

    # ---- the program with them

    def modules(self) -> tuple[ir.Module, ...]:
        """The modules with their statements replaced and followed by what they ask for, and with what was added."""
        bodies = {
            id(module): tuple(self._in_routine(one, self.scopes.routine(module, one)) for one in module.routines)
            for module in self.scopes.program.modules
        }
        done = []
        for module in self.scopes.program.modules:
            variables, procedures = self.added.get(id(module), ([], []))
            routines = (*bodies[id(module)], *(one for one in procedures if one.name in self.called))
            done.append(replace(module, declarations=(*module.declarations, *variables), routines=routines))
        return tuple(done)

    def _in_routine(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        nodes = list(walk(routine))
        actions = {id(node.action) for node in nodes if isinstance(node, ir.Trigger | ir.DeclareInterrupt)}
        inside = {id(one) for node in nodes if isinstance(node, ir.Spline) for one in node.body}

        def change(node: object) -> object:
            if not is_statement(node):
                return node
            if self._stands_for(node):
                return self._written_out(node.origin)
            known = "an action of a trigger or interrupt" if id(node) in actions else ""
            before = () if id(node) in inside else self._up_to_date(node, scope, known)
            behind = self._followed(node, scope, known)
            return (*before, node, *behind) if before or behind else node

        for declaration in routine.declarations:
            self._report_held(declaration, scope, "a first value in a routine")
        done = rewrite(routine, change)
        released = [pair for pair in self.released.get(id(routine), ()) if pair in self.meant.values()]
        if not released:
            return done
        quiet = _quiet(routine.origin)
        loose = [one for pair in released for one in pair.unfix(quiet, quiet)]
        return replace(done, body=(self._call(TOOL, quiet), *loose, *done.body))

    def _call(self, frame: ir.Variable, origin: Origin) -> ir.CallRoutine:
        self.called.add(self.moved[id(frame)])
        return ir.CallRoutine(self.moved[id(frame)], origin=_quiet(origin))

    def _followed(self, statement: ir.Statement, scope: Scope, known: str) -> tuple[ir.Statement, ...]:
        """The calls that a change of frames asks for. known: what the statement is part of where none can follow."""
        frames = list(self._changed(statement, scope))
        if frames and (known or isinstance(statement, (*_ENDS, *_BLOCKS))):
            where = known or _where(statement)
            self.diagnostics.report(UNSEEN_CHANGE, statement.origin, name=frames[0].name, where=where)
            return ()
        return tuple(self._call(frame, statement.origin) for frame in frames)

    def _up_to_date(self, statement: ir.Statement, scope: Scope, known: str) -> tuple[ir.Statement, ...]:
        """The call in front of what looks at a frame that the tool can carry, or changes one beside it."""
        if not self.carried:
            return ()
        if known or isinstance(statement, _AGAIN):
            self._report_held(statement, scope, known or "a condition that is looked at again and again")
            return ()
        looks = any(id(frame) in self.carried for frame in self._read(statement, scope))
        if looks or any(id(frame) in self.with_tool for frame in self._changed(statement, scope)):
            return (self._call(TOOL, statement.origin),)
        return ()

    def _report_held(self, node: ir.Statement | ir.Declaration, scope: Scope, where: str) -> None:
        frame = next((one for one in self._read(node, scope) if id(one) in self.carried), None)
        if frame is not None:
            self.diagnostics.report(HELD, node.origin, name=frame.name, where=where)

    def _read(self, node: ir.Statement | ir.Declaration, scope: Scope) -> Iterator[ir.Variable]:
        """The variables that a statement itself looks at: not those that it gives a whole new value. What stands in a
        spline block belongs to it."""
        stack: list[object] = [node]
        while stack:
            part = stack.pop()
            if isinstance(part, ir.Name):
                found = scope.value(part.id)
                if found is not None and isinstance(found.declaration, ir.Variable):
                    yield found.declaration
            target = part.target if isinstance(part, ir.Assign) else None
            stack.extend(
                child
                for child in children(part)
                if not (child is target and isinstance(child, ir.Name))
                and (not is_statement(child) or isinstance(node, ir.Spline))
            )

    def _written_out(self, origin: Origin) -> ir.Statement | tuple[ir.Statement, ...]:
        statement, pair = self.statements[_key(origin)], self.meant.get(_key(origin))
        if pair is None:
            return ir.Opaque(statement.origin.text, origin=origin)
        done: list[ir.Statement] = []
        if statement.gripper:
            done.append(ir.CallRoutine(f"close_{statement.gripper}", origin=origin))
        if {id(pair.child), id(pair.parent)} & self.with_tool:
            done.append(self._call(TOOL, origin))
        first = _quiet(origin) if statement.gripper else origin
        if statement.kind == "unfix":
            return (*done, *pair.unfix(first, _quiet(origin)))
        return (*done, *pair.affix(statement.kind == "rigidly", first, _quiet(origin)))

    def _changed(self, statement: ir.Statement, scope: Scope) -> Iterator[ir.Variable]:
        """The frames of affixments that a statement itself changes, each once, without those that its blocks change."""
        seen: set[int] = set()
        for place in _places(statement, scope):
            while isinstance(place, ir.Field | ir.Index):
                place = place.base
            found = scope.value(place.id) if isinstance(place, ir.Name) else None
            frame = found.declaration if found is not None else None
            if isinstance(frame, ir.Variable) and id(frame) in self.moved and id(frame) not in seen:
                seen.add(id(frame))
                yield frame


def _places(statement: ir.Statement, scope: Scope) -> Iterator[ir.Expression]:
    """What a statement writes to: by assignment, by a search, and by REFERENCE in the calls that it makes."""
    stack: list[object] = [statement]
    while stack:
        node = stack.pop()
        match node:
            case ir.Assign(target=target):
                yield target
            case ir.Search(found=found) if found is not None:
                yield found
            case ir.CallRoutine(dynamic=dynamic, arguments=arguments) if dynamic is not None:
                yield from (one.value for one in arguments if one.value is not None)
            case ir.Call(name=name, arguments=arguments) | ir.CallRoutine(name=name, arguments=arguments):
                yield from by_reference(name, arguments, scope)
            case ir.TaskControl(task=task, arguments=arguments):
                yield from by_reference(task, arguments, scope)
        stack.extend(child for child in children(node) if not is_statement(child))


def _where(statement: ir.Statement) -> str:
    if isinstance(statement, ir.TaskControl):
        return "another task has it by REFERENCE"
    head = isinstance(statement, _BLOCKS)
    return f"a function has it by REFERENCE in {'the head of a block' if head else 'a statement that waits or leaves'}"


def _written(named: ir.Expression) -> str:
    match named:
        case ir.Name(id=name):
            return name
        case ir.Field(base=base, name=name):
            return f"{_written(base)}.{name}"
        case ir.Index(base=base):
            return f"{_written(base)}[...]"
    return named.origin.text or "this"


def _type_word(type: ir.Type) -> str:
    return type.__class__.__name__.removesuffix("Type").upper() if not isinstance(type, ir.NamedType) else type.name
