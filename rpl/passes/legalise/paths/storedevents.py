"""Stored path events (RAPID's trigger data) back to statements before the moves that name them.

What is stored is known where the variable is defined in one place only, or where its definition stands before the move
in one straight run of statements. An event that calls the trap of an interrupt calls the trap itself; where the
interrupt sleeps, or is deleted while the event may still come, a flag decides.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.rewrite import rewrite_bodies, visit_bodies

_Known = dict[str, ir.DefineTrigger]


def events_before_moves(program: ir.Program, context: Context) -> ir.Program:
    """The program with triggers as statements; what is not known stays for the writer to report."""
    return _Before(program, context).program()


@dataclass(slots=True)
class _Definitions:
    """Where path events are defined, and what each move means by their names."""

    single: dict[str, ir.DefineTrigger | None] = field(default_factory=dict)  # None: in several places
    homes: dict[str, set[str]] = field(default_factory=dict)  # name -> routines that define it
    nearest: dict[tuple[int, str], ir.DefineTrigger] = field(default_factory=dict)  # of moves, by their identity
    unknown: set[str] = field(default_factory=set)  # names that some move uses without a known definition

    def read(self, program: ir.Program) -> None:
        for module in program.modules:
            for routine in module.routines:
                for node in walk_for({"DefineTrigger"}, *bodies(routine)):
                    if isinstance(node, ir.DefineTrigger):
                        name = base_name(node.target) or ""
                        self.single[name] = None if name in self.single else node
                        self.homes.setdefault(name, set()).add(routine.name.lower())
        if not self.single:
            return
        for module in program.modules:
            for routine in module.routines:
                for body in bodies(routine):
                    self.run(body, {}, routine.name.lower())

    def run(self, body: ir.Body, known: _Known, home: str) -> _Known:
        """Follows a run of statements; `known` is what the names mean before it."""
        for statement in body:
            match statement:
                case ir.DefineTrigger(target=ir.Name(id=name)):
                    known = {**known, name.lower(): statement}
                    continue
                case ir.Label():
                    known = {}
                case ir.Move(triggers=triggers):
                    self.note(statement, triggers, known)
            if blocks(statement):
                inner = {base_name(one.target) or "" for one in walk(statement) if isinstance(one, ir.DefineTrigger)}
                known = {name: one for name, one in known.items() if name not in inner}

                def branch(part: ir.Body, known: _Known = known) -> ir.Body:
                    self.run(part, known, home)
                    return part

                visit_bodies(statement, branch)
            elif any(isinstance(node, ir.CallRoutine | ir.Call) for node in walk(statement)):
                known = {name: one for name, one in known.items() if self.homes[name] == {home}}
        return known

    def note(self, move: ir.Move, triggers: tuple[ir.Expression | ir.Trigger, ...], known: _Known) -> None:
        for one in triggers:
            name = "" if isinstance(one, ir.Trigger) else base_name(one) or ""
            if name in known:
                self.nearest[id(move), name] = known[name]
            elif name and self.single.get(name) is None:
                self.unknown.add(name)

    def at(self, move: ir.Move, name: str) -> ir.DefineTrigger | None:
        return self.single.get(name) or (None if name in self.unknown else self.nearest.get((id(move), name)))

    def resolved(self, name: str) -> bool:
        """Does every move that names it know what it means?"""
        return name in self.single and name not in self.unknown


class _Before:
    def __init__(self, program: ir.Program, context: Context) -> None:
        self.source, self.context = program, context
        self.definitions = _Definitions()
        self.definitions.read(program)
        self.trap_of: dict[str, str | None] = {}
        self.ordered: set[str] = set()  # interrupts that something else than a path event brings
        self.events: set[str] = set()  # interrupts that path events bring
        self.kept_awake: dict[str, bool] = {}  # by interrupt: is it only deleted, behind moves that stand?
        self.flags: dict[str, ir.Variable] = {}
        self.wrappers: dict[str, ir.Routine] = {}
        for node in walk_for(
            {"ConnectInterrupt", "OrderInterrupt", "DefineTrigger", "ControlInterrupt", "Move"}, *program.modules
        ):
            self.collect(node)

    def collect(self, node: object) -> None:
        match node:
            case ir.ConnectInterrupt(handle=handle, routine=routine):
                name = base_name(handle) or ""
                self.trap_of[name] = routine if self.trap_of.get(name, routine) == routine else None
            case ir.OrderInterrupt(handle=handle):
                self.ordered.add(base_name(handle) or "")
            case ir.DefineTrigger(target=target, interrupt=handle) if handle is not None:
                if self.definitions.resolved(base_name(target) or ""):
                    self.events.add(base_name(handle) or "")
            case ir.ControlInterrupt(op=op, handle=handle) if handle is not None and op != "delete":
                self.kept_awake[base_name(handle) or ""] = False
            case ir.Move(triggers=triggers, blend=blend) if blend not in (None, ir.BlendStop()):
                for one in triggers:
                    defined = None if isinstance(one, ir.Trigger) else self.definitions.at(node, base_name(one) or "")
                    if defined is not None and defined.interrupt is not None:
                        self.kept_awake[base_name(defined.interrupt) or ""] = False

    def program(self) -> ir.Program:
        if not self.definitions.single and not any(
            isinstance(node, ir.Move) and node.triggers for node in walk_for({"Move"}, *self.source.modules)
        ):
            return self.source
        modules = []
        for module in self.source.modules:
            routines = [edit_bodies(one, self.body) for one in module.routines]
            routines = [replace(one, declarations=self.kept(one.declarations)) for one in routines]
            modules.append(replace(module, routines=tuple(routines), declarations=self.kept(module.declarations)))
        done = replace(self.source, modules=tuple(modules))
        task = self.source.modules[0].task
        return with_support(done, self.context, [*self.flags.values()], [*self.wrappers.values()], task)

    def kept(self, declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
        return tuple(one for one in declarations if not self.is_resolved(one))

    def is_resolved(self, declaration: ir.Declaration) -> bool:
        return (
            isinstance(declaration, ir.Variable)
            and isinstance(declaration.type, ir.TriggerType)
            and self.definitions.resolved(declaration.name.lower())
        )

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            match statement:
                case ir.DefineTrigger(target=target) if self.definitions.resolved(base_name(target) or ""):
                    done.extend(_remarks(statement))
                case ir.Move(triggers=triggers) if triggers:
                    done.extend(self.move(statement))
                case ir.ControlInterrupt(op=op, handle=handle) if handle is not None and self.is_event(handle):
                    done.extend(self.controlled(statement, base_name(handle) or "", op == "on"))
                case ir.ConnectInterrupt(handle=handle) if self.is_event(handle):
                    done.append(statement)
                    later = replace(statement, origin=replace(statement.origin, comments=()))
                    done.extend(self.controlled(later, base_name(handle) or "", True))
                case _:
                    done.append(rewrite_bodies(statement, self.body))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def move(self, move: ir.Move) -> list[ir.Statement]:
        before: list[ir.Statement] = []
        kept: list[ir.Expression | ir.Trigger] = []
        for one in move.triggers:
            trigger = one if isinstance(one, ir.Trigger) else self.resolved(move, one)
            if trigger is None:
                kept.append(one)
            else:
                before.append(replace(trigger, origin=replace(move.origin, comments=())))
        return [*before, replace(move, triggers=tuple(kept))]

    def resolved(self, move: ir.Move, name: ir.Expression) -> ir.Trigger | None:
        defined = self.definitions.at(move, base_name(name) or "")
        if defined is None or defined.interrupt is None:
            return None if defined is None else defined.trigger
        handle = base_name(defined.interrupt) or ""
        routine = self.trap_of.get(handle)
        if routine is None:
            return None
        called = self.wrapper(handle, routine) if self.flagged(handle) else routine
        return replace(defined.trigger, action=ir.CallRoutine(called))

    # ---- interrupts that path events bring

    def is_event(self, handle: ir.Expression) -> bool:
        name = base_name(handle) or ""
        return name in self.events and name not in self.ordered and self.trap_of.get(name) is not None

    def flagged(self, handle: str) -> bool:
        """Does a flag say whether its events come through?"""
        return handle not in self.ordered and not self.kept_awake.get(handle, True)

    def controlled(self, statement: ir.Statement, handle: str, awake: bool) -> ir.Body:
        """What switches it on or off: the flag, or nothing where no event can come any more."""
        if not self.flagged(handle):
            return _remarks(statement) if not isinstance(statement, ir.ConnectInterrupt) else ()
        flag = ir.Name(self.flag(handle).name)
        return (ir.Assign(flag, ir.BoolLiteral(awake), origin=statement.origin),)

    def flag(self, handle: str) -> ir.Variable:
        if handle not in self.flags:
            name = self.context.fresh(f"{handle}_on")
            self.flags[handle] = ir.Variable(name, ir.BoolType(), ir.BoolLiteral(False), scope="global")
        return self.flags[handle]

    def wrapper(self, handle: str, trap: str) -> str:
        if handle not in self.wrappers:
            test = ir.Name(self.flag(handle).name)
            body = (ir.If(((test, (ir.CallRoutine(trap),)),)),)
            self.wrappers[handle] = ir.Routine(self.context.fresh(f"{handle}_event"), body=body, scope="global")
        return self.wrappers[handle].name


def _remarks(statement: ir.Statement) -> ir.Body:
    return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
