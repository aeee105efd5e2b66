"""The override as a factor of the moves' speeds, for controllers whose programs cannot set it.

A variable takes the place of the override. Where the program's course tells its value, speeds are multiplied by it
beforehand; elsewhere the run multiplies. A move that has begun keeps its speed, which is the difference that is told.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.data.datalists import started_first
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

SCALED = code(
    "override-in-speeds",
    Severity.WARNING,
    "the target's programs cannot set the override; the moves behind this have their speeds multiplied by it",
    "a move that has begun keeps its speed; what the operator sets comes on top",
)
READ = code(
    "override-taken-as-full",
    Severity.WARNING,
    "the target's programs cannot read the override, which this one never sets; it is taken as 100 percent",
)
_FULL = 100.0
_OVERRIDE = ir.System("override")
_BLOCKS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop)


@legalising(
    unless=lambda context: "override" in context.capabilities.system_variables or context.capabilities.carries_rules
)
def scaled_override(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the override among their system variables, whose moves say their own speeds."""
    if not any(_is_override(node) for node in walk(program)):
        return program
    moves = [node for node in walk(program) if isinstance(node, ir.Move)]
    if any(isinstance(node, ir.Spline) for node in walk(program)) or not all(map(_says_speed, moves)):
        return program
    if any(isinstance(node, ir.DeclareInterrupt) and any(map(_sets, walk((node.action,)))) for node in walk(program)):
        return program
    sets = [node for node in walk(program) if _sets(node)]
    for node in sets:
        assert isinstance(node, ir.Assign)
        context.diagnostics.report(SCALED, node.origin)
    return _Factor(program, context, bool(sets)).done()


@dataclass(slots=True)
class _Factor:
    """The rewriting of one program. `starts`: the override where a routine begins, None where calls differ."""

    program: ir.Program
    context: Context
    is_set: bool
    name: str = ""
    setters: frozenset[str] = frozenset()
    starts: dict[str, float | None] = field(default_factory=dict)
    used: bool = False
    final: bool = False

    def done(self) -> ir.Program:
        self.name = self.context.fresh("rpl_override")
        self.setters = doing(self.program, _sets)
        self.starts = {} if self.beside() else dict.fromkeys(started_first(self.program), _FULL)
        for _ in range(8):
            before = dict(self.starts)
            self.routines()
            if self.starts == before:
                break
        else:
            self.starts = {}
        self.final, self.used = True, False
        modules = self.routines()
        if not self.used:  # every value was known: nobody asks the variable
            return replace(self.program, modules=tuple(_without(module, self.name) for module in modules))
        variable = ir.Variable(self.name, ir.RealType(), ir.RealLiteral(_FULL), storage="variable", scope="global")
        first = modules[0]
        home = ir.Module(f"{self.name}_data", first.dialect, (variable,), task=first.task, public=True)
        return replace(self.program, modules=(*modules, home))

    def beside(self) -> bool:
        """Is it set by what runs beside the program, when an interrupt comes, or is a routine called by a text?"""
        tasks = {task.entry.lower() for task in self.program.tasks if task.kind != "motion"}
        for node in walk(self.program):
            match node:
                case ir.DeclareInterrupt(action=action):
                    tasks.update(one.name.lower() for one in walk((action,)) if isinstance(one, ir.CallRoutine))
                case ir.CallRoutine(dynamic=value) if value is not None:
                    return True
                case ir.ConnectInterrupt(routine=name) | ir.TaskControl(op="start", task=name):
                    tasks.add(name.lower())
        return bool(tasks & self.setters)

    def routines(self) -> list[ir.Module]:
        found = []
        for module in self.program.modules:
            routines = []
            for routine in module.routines:
                if not self.final and routine.name.lower() not in self.starts:
                    continue  # nobody is known to have come here
                known = self.starts.get(routine.name.lower())
                body, _ = self.body(routine.body, known)
                others = edit_bodies(replace(routine, body=()), lambda other: self.body(other, None)[0])
                routines.append(replace(others, body=body))
            found.append(replace(module, routines=tuple(routines)))
        return found

    def body(self, statements: ir.Body, known: float | None) -> tuple[ir.Body, float | None]:
        done: list[ir.Statement] = []
        for statement in statements:
            new, known = self.statement(statement, known)
            done.append(new)
        return tuple(done), known

    def statement(self, statement: ir.Statement, known: float | None) -> tuple[ir.Statement, float | None]:
        if isinstance(statement, ir.CallRoutine):
            self.called(statement.name, known)
        match statement:
            case ir.Assign(target=ir.System(name="override"), value=value):
                place = replace(statement, target=ir.Name(self.name, origin=statement.origin))
                number = value.value if isinstance(value, ir.IntLiteral | ir.RealLiteral) else None
                return self.read(place, known), None if number is None else float(number)
            case ir.Label():
                return statement, None
        if not isinstance(statement, _BLOCKS):
            scaled = self.read(statement, known)
            if isinstance(scaled, ir.Move) and scaled.speed is not None:
                scaled = replace(scaled, speed=self.scaled(scaled.speed, known))
            return scaled, None if self.changes(statement) else known
        changes = self.changes(statement)
        looping = changes and not isinstance(statement, ir.If | ir.Switch)
        inner = None if looping else known
        done = rewrite_parts(statement, lambda one: self.replaced(one, inner), lambda one: self.body(one, inner)[0])
        return done, None if changes else known

    def called(self, name: str, known: float | None) -> None:
        if not self.final:
            key = name.lower()
            same = key not in self.starts or self.starts[key] == known
            self.starts[key] = known if same else None

    def changes(self, statement: ir.Statement) -> bool:
        """May the override be another one behind it?"""
        for node in walk((statement,)):
            match node:
                case ir.CallRoutine(name=name) | ir.Call(name=name) if not name or name.lower() in self.setters:
                    return True
                case ir.Label() | ir.Do():
                    return True
            if _sets(node):
                return True
        return False

    def read(self, statement: ir.Statement, known: float | None) -> ir.Statement:
        return rewrite_parts(statement, lambda one: self.replaced(one, known))

    def replaced(self, expression: ir.Expression, known: float | None) -> ir.Expression:
        for node in walk((expression,)):
            if isinstance(node, ir.Call):
                self.called(node.name, known)
        return rewrite(expression, lambda node: self.value(known) if _is_override(node) else node)

    def value(self, known: float | None) -> ir.Expression:
        if not self.is_set:
            return ir.RealLiteral(_FULL)
        if known is not None:
            return ir.RealLiteral(known)
        self.used = True
        return ir.Name(self.name)

    def scaled(self, speed: ir.Speed, known: float | None) -> ir.Speed:
        if not self.is_set or known == _FULL:
            return speed

        def times(value: ir.Expression | None, slower: bool = False) -> ir.Expression | None:
            if value is None:
                return None
            if isinstance(value, ir.Quantity):
                return replace(value, value=times(value.value, slower) or value.value)
            full = ir.RealLiteral(_FULL)
            share = ir.Binary("/", self.value(known), full) if known is None else ir.RealLiteral(known / _FULL)
            if known is not None and isinstance(value, ir.IntLiteral | ir.RealLiteral):
                number = value.value / (known / _FULL) if slower else value.value * (known / _FULL)
                return ir.RealLiteral(float(f"{number:.9g}"))
            return ir.Binary("/" if slower else "*", value, share)

        return replace(
            speed,
            path=times(speed.path),
            rotation=times(speed.rotation),
            joint=times(speed.joint),
            axis=times(speed.axis),
            duration=times(speed.duration, slower=True),
        )


def _without(module: ir.Module, name: str) -> ir.Module:
    """The module without settings of the variable, which nobody reads."""

    def change(node: object) -> object:
        if isinstance(node, ir.Assign) and node.target == ir.Name(name):
            return ir.Nothing(origin=node.origin)
        return node

    return replace(module, routines=tuple(rewrite(routine, change) for routine in module.routines))


def _is_override(node: object) -> bool:
    return isinstance(node, ir.System) and node == _OVERRIDE


def _sets(node: object) -> bool:
    return isinstance(node, ir.Assign) and _is_override(node.target)


def _says_speed(move: ir.Move) -> bool:
    speed = move.speed
    if speed is None or speed.profile is not None:
        return False
    return any(one is not None for one in (speed.path, speed.rotation, speed.joint, speed.axis, speed.duration))
