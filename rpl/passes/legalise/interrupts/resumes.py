"""Resume from an interrupt (KRL), for targets whose traps always return to where they came from.

The interrupt routine drops the motion and raises a flag. Every routine that runs below the level of the declaration
asks for the flag behind each statement that takes time, and returns; the declaring routine lowers it behind the call.
Where the target resumes, its resume drops the motion: what drops it before says nothing more.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import InterruptRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import each_expression, each_statement
from rpl.passes.legalise.interrupts.armedcalls import ArmedElsewhere, armed_calls
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.source import Origin

NOT_BRAKED = code(
    "resume-not-braked",
    Severity.WARNING,
    "{routine} resumes without a brake, which lets the robot finish its motion first; here it is dropped at once",
    "brake in the interrupt's routine before it resumes",
)


@legalising(sees=("ResumeLevel",))
def resumes(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that cannot resume at the level of a declaration but can clear the path."""
    statements, drops = context.capabilities.statements, InterruptRule.STOPPING in context.capabilities.interrupts.rules
    if "ResumeLevel" in statements and "ClearMotion" not in statements:
        return _resume_clears(program)
    if "ResumeLevel" in statements or not ({"ClearMotion", "StartMotion"} <= statements or drops):
        return program
    facts = _Facts.of(program)
    resuming = facts.resuming()
    if not resuming:
        return program
    worker = _Resumes(context.fresh("rpl_resumed"), facts, resuming, drops, context.diagnostics)
    modules = [
        replace(module, routines=tuple(worker.routine(routine) for routine in module.routines))
        for module in program.modules
    ]
    first = modules[0]
    flag = ir.Variable(worker.flag, ir.BoolType(), ir.BoolLiteral(False), scope="global")
    modules.append(ir.Module(context.fresh("rpl_resume"), first.dialect, (flag,), task=first.task, public=True))
    return replace(program, modules=tuple(modules))


def left_by_resumes(program: ir.Program) -> frozenset[str]:
    """Routines that the routine of an interrupt may leave: below the levels that declare it. Folded names."""
    facts = _Facts.of(program)
    resuming = facts.resuming()
    return frozenset(facts.left_by(resuming))


@dataclass(slots=True)
class _Facts:
    """Who calls whom, who resumes, and who declares which interrupt routine."""

    calls: dict[str, set[str]] = field(default_factory=dict)
    has_resume: dict[str, bool] = field(default_factory=dict)
    declares: dict[str, set[str]] = field(default_factory=dict)
    routines: list[ir.Routine] = field(default_factory=list)

    @classmethod
    def of(cls, program: ir.Program) -> _Facts:
        facts = cls()
        for module in program.modules:
            for routine in module.routines:
                facts.routine(routine)
        return facts

    def resuming(self) -> set[str]:
        """The routines that resume, or call one that does."""
        return self.closure({name for name, one in self.has_resume.items() if one})

    def routine(self, routine: ir.Routine) -> None:
        key = routine.name.lower()
        self.routines.append(routine)
        calls, declared = self.calls.setdefault(key, set()), self.declares.setdefault(key, set())
        self.has_resume.setdefault(key, False)
        actions: set[int] = set()  # what an interrupt or trigger runs is not called from here

        def look(statement: ir.Statement) -> None:
            match statement:
                case ir.CallRoutine(name=name) if id(statement) not in actions:
                    calls.add(name.lower())
                case ir.DeclareInterrupt(action=ir.CallRoutine(name=name) as action):
                    declared.add(name.lower())
                    actions.add(id(action))
                case ir.Trigger(action=action):
                    actions.add(id(action))
                case ir.ResumeLevel():
                    self.has_resume[key] = True
            each_expression(statement, call)

        def call(expression: ir.Expression) -> None:
            if isinstance(expression, ir.Call):
                calls.add(expression.name.lower())

        for body in bodies(routine):
            each_statement(body, look)

    def closure(self, names: set[str]) -> set[str]:
        """The routines that call one of these, directly or not, and these."""
        found = set(names)
        grown = True
        while grown:
            grown = False
            for caller, callees in self.calls.items():
                if caller not in found and callees & found:
                    found.add(caller)
                    grown = True
        return found

    def left_by(self, resuming: set[str]) -> set[str]:
        """The routines that run while one of the interrupts may come."""
        declaring = {name for name, declared in self.declares.items() if declared & resuming}
        elsewhere = ArmedElsewhere.of(self.routines, declaring if len(declaring) == 1 else set())
        found: set[str] = set()
        for routine in self.routines:
            if routine.name.lower() in declaring:
                armed = armed_calls(routine, resuming, elsewhere)
                found |= self.below(self.calls[routine.name.lower()] if armed is None else armed)
        return found - resuming

    def below(self, names: set[str]) -> set[str]:
        """These routines, and what they call, directly or not."""
        found: set[str] = set()
        waiting = list(names)
        while waiting:
            callee = waiting.pop()
            if callee not in found:
                found.add(callee)
                waiting.extend(self.calls.get(callee, ()))
        return found


class _Resumes:
    def __init__(self, flag: str, facts: _Facts, resuming: set[str], drops: bool, diagnostics: Diagnostics) -> None:
        self.flag, self.drops, self.diagnostics = flag, drops, diagnostics
        self.handlers = resuming
        self.declaring = {name for name, declared in facts.declares.items() if declared & resuming}
        self.watched = facts.left_by(resuming)

    def routine(self, routine: ir.Routine) -> ir.Routine:
        key = routine.name.lower()
        if key in self.handlers:
            body = _dropped_at_once(routine.body, self.drops)
            at_once = next((one for one in walk(*body) if isinstance(one, ir.ResumeLevel)), None)
            if at_once is not None and not any(isinstance(one, ir.StopMotion) for one in walk(*body)):
                self.diagnostics.report(NOT_BRAKED, at_once.origin, routine=routine.name)
            return edit_bodies(replace(routine, body=body), self.handler)
        if key in self.declaring:
            return edit_bodies(routine, self.level)
        if key in self.watched and routine.kind == "procedure":
            return edit_bodies(routine, self.interruptible)
        return routine

    def handler(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            if isinstance(statement, ir.ResumeLevel):
                later = replace(statement.origin, comments=())
                done.append(ir.Assign(ir.Name(self.flag), ir.BoolLiteral(True), origin=statement.origin))
                if not _clears(body):
                    done += [ir.StopMotion(origin=later)] if self.drops else []
                    done.append(ir.ClearMotion(origin=later))
                done.append(ir.Return(origin=later))
            else:
                done.append(rewrite_bodies(statement, self.handler))
        return tuple(done)

    def level(self, body: ir.Body) -> ir.Body:
        """In the declaring routine the flag is lowered behind calls."""
        done: list[ir.Statement] = []
        for statement in body:
            done.append(rewrite_bodies(statement, self.level))
            if isinstance(statement, ir.CallRoutine) and statement.name.lower() in self.watched:
                done.append(ir.Assign(ir.Name(self.flag), ir.BoolLiteral(False), origin=_later(statement)))
        return tuple(done)

    def interruptible(self, body: ir.Body) -> ir.Body:
        """Below it every statement that takes time is followed by the question whether to leave."""
        done: list[ir.Statement] = []
        for statement in body:
            if isinstance(statement, ir.WaitUntil):
                either = ir.Binary("or", statement.condition, ir.Name(self.flag))
                statement = replace(statement, condition=either)
            done.append(rewrite_bodies(statement, self.interruptible))
            takes_time = isinstance(statement, ir.Move | ir.Spline | ir.Wait | ir.WaitUntil | ir.WaitForMotion)
            if takes_time or (isinstance(statement, ir.CallRoutine) and statement.name.lower() in self.watched):
                leave = ir.Return(origin=_later(statement))
                done.append(ir.If(((ir.Name(self.flag), (leave,)),), origin=_later(statement)))
        return tuple(done)


def _resume_clears(program: ir.Program) -> ir.Program:
    """Routines that brake, drop the motion and certainly resume, without the second of these."""

    def without(routine: ir.Routine) -> ir.Routine:
        body = routine.body
        clears = _clears(body) and bool(body) and isinstance(body[-1], ir.ResumeLevel)
        leaves = any(isinstance(node, ir.StartMotion | ir.Return | ir.Goto | ir.Raise) for node in walk(*body))
        stops = next((at for at, one in enumerate(body) if isinstance(one, ir.StopMotion)), None)
        if not clears or leaves or stops is None:
            return routine
        rest = (ir.Nothing(origin=one.origin) if isinstance(one, ir.ClearMotion) else one for one in body[stops:])
        return replace(routine, body=(*body[:stops], *rest))

    modules = (replace(module, routines=tuple(map(without, module.routines))) for module in program.modules)
    return replace(program, modules=tuple(modules))


def _clears(body: ir.Body) -> bool:
    return any(isinstance(statement, ir.ClearMotion) for statement in body)


def _dropped_at_once(body: ir.Body, drops: bool) -> ir.Body:
    """A routine that brakes and certainly resumes drops the motion there already: where the target's brake drops it
    (`drops`), and where it moves away itself before it resumes, which a motion that stands stopped would hold up."""
    if not body or not isinstance(body[-1], ir.ResumeLevel) or any(isinstance(one, ir.StartMotion) for one in body):
        return body
    done: list[ir.Statement] = []
    for at, statement in enumerate(body):
        if drops and isinstance(statement, ir.ClearMotion) and any(isinstance(one, ir.StopMotion) for one in body[:at]):
            done.append(ir.Nothing(origin=statement.origin))
            continue
        done.append(statement)
        if not isinstance(statement, ir.StopMotion):
            continue
        later = _later(statement)
        if drops:
            done += [ir.ClearMotion(origin=later), ir.WaitForMotion(origin=later)]
        elif any(isinstance(node, ir.Move | ir.MoveExternal | ir.Spline) for node in walk(*body[at:])):
            done += [ir.ClearMotion(origin=later), ir.StartMotion(origin=later)]
    return tuple(done)


def _later(statement: ir.Statement) -> Origin:
    return replace(statement.origin, comments=())
