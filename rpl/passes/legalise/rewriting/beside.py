"""Tasks that a rewritten program begins beside itself: their routines, the data they share with it, what they may do.

A task sees no variable of the routine that begins it, so such values are copied into data of the module first.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import Usage, doing, usage_of
from rpl.passes.legalise.rewriting.editing import Editor
from rpl.source import Origin

_MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.StopMotion, ir.StartMotion, ir.ClearMotion, ir.ResumeLevel)
_OWN = {"nearest": ir.RealType(), "was": ir.RealType(), "now": ir.RealType()}  # variables that the tasks made here have


def tidy(origin: Origin) -> Origin:
    """The place without its comments, which stand at the first statement."""
    return replace(origin, comments=()) if origin.comments else origin


def local_names(routine: ir.Routine) -> frozenset[str]:
    """The parameters and variables of a routine, folded."""
    own = [d.name.lower() for d in routine.declarations if isinstance(d, ir.Variable)]
    counters = [node.counter.lower() for node in walk(*bodies(routine)) if isinstance(node, ir.For) and node.scoped]
    return frozenset((*own, *counters, *(parameter.name.lower() for parameter in routine.parameters)))


def moves_or_waits(statement: object, routines: frozenset[str]) -> bool:
    """Does the statement drive the robot, or call a routine (of these, folded) that does?"""
    return does_any(statement, _MOTION, routines)


def does_any(statement: object, kinds: tuple[type, ...], routines: frozenset[str]) -> bool:
    """Is one of these kinds in the statement, or a call of a routine (of these, folded) that has one (`closure`)?"""
    for node in walk(statement):
        match node:
            case ir.CallRoutine(name=name) | ir.Call(name=name) if name.lower() in routines:
                return True
        if isinstance(node, kinds):
            return True
    return False


def closure(program: ir.Program, kinds: tuple[type, ...]) -> frozenset[str]:
    """The routines (folded) that do one of these statements, themselves or by what they call."""
    return doing(program, lambda node: isinstance(node, kinds))


@dataclass(slots=True)
class Beside:
    """What a pass adds to the modules of a program. `moving`: the flag that says whether the watched move goes on."""

    program: ir.Program
    context: Context
    usage: Usage = field(init=False)
    routines: frozenset[str] = field(init=False)
    moving: str | None = None
    homes: dict[int, int] = field(default_factory=dict)
    data: dict[int, list[ir.Variable]] = field(default_factory=dict)
    made: dict[int, list[ir.Routine]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.usage = usage_of(self.program)
        self.routines = closure(self.program, _MOTION)
        for at, module in enumerate(self.program.modules):
            for routine in module.routines:
                self.homes[id(routine)] = at

    def moving_name(self) -> str:
        if self.moving is None:
            self.moving = self.context.fresh("rpl_moving")
        return self.moving

    def moving_flag(self) -> ir.Variable:
        return ir.Variable(self.moving_name(), ir.BoolType(), ir.BoolLiteral(False), scope="global")

    # ---- data and routines of a module

    def kept(self, editor: Editor, routine: ir.Routine, stem: str, type: ir.Type) -> ir.Name:
        """New data of the routine's module."""
        variable = ir.Variable(self.context.fresh(stem), type, scope="global")
        self.data.setdefault(self.homes[id(routine)], []).append(variable)
        editor.scope = editor.scope.with_value(variable)
        return ir.Name(variable.name)

    def routine(self, routine: ir.Routine, made: ir.Routine) -> None:
        """A new routine in the module of another one."""
        self.made.setdefault(self.homes[id(routine)], []).append(made)

    def task(self, routine: ir.Routine, stem: str, body: ir.Body) -> str:
        """A routine that is begun as a task; its name."""
        name = self.context.fresh(stem)
        used = {node.id for node in walk(*body) if isinstance(node, ir.Name)}
        mine = tuple(ir.Variable(word, type, scope="routine") for word, type in _OWN.items() if word in used)
        self.routine(routine, ir.Routine(name, declarations=mine, body=body, scope="global"))
        return name

    def placed(self, program: ir.Program) -> ir.Program:
        """The rewritten program with all that was added; its modules are those of the program as it was."""
        modules = tuple(
            replace(
                module,
                declarations=(*module.declarations, *self.data.get(at, ())),
                routines=(*module.routines, *self.made.get(at, ())),
            )
            for at, module in enumerate(program.modules)
        )
        return replace(program, modules=modules)

    # ---- values

    def settled(
        self,
        editor: Editor,
        routine: ir.Routine,
        value: ir.Expression,
        stem: str,
        before: list[ir.Statement],
        type: ir.Type | None = None,
    ) -> ir.Expression:
        """A value (a pose, if no type is said) that a task may look at: as it stands where nothing changes it, else a
        copy that is made now."""
        if self.stays(value, routine):
            return value
        kept = self.kept(editor, routine, stem, type or ir.PoseType())
        before.append(ir.Assign(kept, value))
        return kept

    def stays(self, value: object, routine: ir.Routine) -> bool:
        """Is it made of literals and of data that nothing changes?"""
        own = local_names(routine)
        for node in walk(value):
            match node:
                case ir.Name(id=name) if name.lower() in own or name.lower() in self.usage.assigned:
                    return False
                case ir.System(name=name) if name not in ("null_frame", "world"):
                    return False
                case ir.Call() | ir.Signal() | ir.VendorValue():
                    return False
                case ir.Builtin(function=function) if function.startswith(("current_", "random")):
                    return False
        return True

    def own(self, editor: Editor, routine: ir.Routine, body: ir.Body, before: list[ir.Statement]) -> ir.Body:
        """The statements with copies in place of the routine's variables; the copies are made before."""
        local = local_names(routine)
        copies: dict[str, ir.Name] = {}

        def change(node: object) -> object:
            if not isinstance(node, ir.Name) or node.id.lower() not in local:
                return node
            copy = copies.get(node.id.lower())
            if copy is None:
                type = editor.type_of(node)
                if type is None:
                    return node
                copy = self.kept(editor, routine, "rpl_given", type)
                copies[node.id.lower()] = copy
                before.append(ir.Assign(copy, ir.Name(node.id)))
            return ir.Name(copy.id, origin=node.origin)

        return tuple(rewrite(one, change) for one in body)
