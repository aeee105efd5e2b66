"""Search moves, which KRL has not: an interrupt that brakes, keeps the position, and leaves the move.

A routine of its own holds the move, so that RESUME drops exactly that. The error numbers are the source's:
signal already there, nothing found.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

_PRIORITY = 5  # more urgent than the interrupts that passes.interrupts numbers


@legalising()
def searches(program: ir.Program, context: Context) -> ir.Program:
    """Moves that watch a condition."""
    worker = _Searches(context, set(rules_of(context.source).errors))
    scopes = ProgramScope(program)
    modules = tuple(
        replace(module, routines=tuple(worker.routine(r, scopes.routine(module, r)) for r in module.routines))
        for module in program.modules
    )
    if not worker.routines:
        return program
    first = modules[0]
    home = ir.Module(
        context.fresh("rpl_search"), first.dialect, tuple(worker.declarations), tuple(worker.routines), task=first.task
    )
    return replace(program, modules=(*modules, home))


def _local_names(routine: ir.Routine) -> frozenset[str]:
    names = {parameter.name.lower() for parameter in routine.parameters}
    names.update(d.name.lower() for d in routine.declarations if isinstance(d, ir.Variable))
    return frozenset(names)


def _target(context: Context) -> ir.Type:
    return ir.TargetType(context.source)


def _names(part: object, local: frozenset[str]) -> Iterator[ir.Name]:
    """The variables of the routine that are asked."""
    return (node for node in walk(part) if isinstance(node, ir.Name) and node.id.lower() in local)


@dataclass(slots=True)
class _Searches:
    context: Context
    errors: set[str]
    declarations: list[ir.Declaration] = field(default_factory=list)
    routines: list[ir.Routine] = field(default_factory=list)
    typed: Callable[[ir.Expression], ir.Type | None] = field(default=lambda value: None)
    passed: dict[str, ir.Type | None] = field(default_factory=dict)  # the routine's own numbers that a move is set by

    def routine(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        self.typed = lambda value: type_of(value, scope)
        return edit_bodies(routine, lambda body: self.body(body, _local_names(routine)))

    def body(self, body: ir.Body, local: frozenset[str]) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            if isinstance(statement, ir.Move) and statement.search is not None and self.possible(statement, local):
                done.extend(self.search(statement, statement.search))
            else:
                done.append(rewrite_bodies(statement, lambda b: self.body(b, local)))
        return tuple(done)

    def possible(self, move: ir.Move, local: frozenset[str]) -> bool:
        """The generated routine sees global data only; the goal is passed, and numbers that the move is set by."""
        looked = move.search is not None and any(True for _ in _names(move.search.condition, local))
        settings = replace(move, target=ir.IntLiteral(0), search=None)
        self.passed = {}
        for name in _names(settings, local):
            self.passed[name.id] = self.typed(name)
        return not looked and all(isinstance(one, ir.IntType | ir.RealType) for one in self.passed.values())

    def helpers(
        self, move: ir.Move, search: ir.Search, hit: str, place: str, react: str, travel: str
    ) -> tuple[ir.Routine, ir.Routine]:
        """What runs when the condition comes, and the move that is watched meanwhile."""
        number, stops = ir.IntLiteral(_PRIORITY), search.stop != "none"
        kind = self.typed(move.target)
        shift = move.relative is not None and isinstance(kind, ir.PoseType)
        goal = kind if kind is not None and (shift or isinstance(kind, ir.JointsType)) else _target(self.context)
        given = tuple(ir.Parameter(name, type) for name, type in self.passed.items() if type is not None)
        return (
            ir.Routine(
                react,
                body=(
                    *((ir.StopMotion(),) if stops else ()),
                    ir.Assign(ir.Name(place), ir.System("interrupt_pose")),
                    ir.Assign(ir.Name(hit), ir.BoolLiteral(True)),
                    *((ir.ResumeLevel(),) if stops else ()),
                ),
                scope="global",
            ),
            ir.Routine(
                travel,
                parameters=(ir.Parameter("goal", goal), *given),
                body=(
                    ir.ControlInterrupt("on", number),
                    replace(move, target=ir.Name("goal"), search=None, blend=ir.BlendStop()),
                    ir.WaitForMotion(),
                    ir.ControlInterrupt("off", number),
                ),
                scope="global",
            ),
        )

    def search(self, move: ir.Move, search: ir.Search) -> list[ir.Statement]:
        target = ir.TargetType(self.context.source)
        hit, place = self.context.fresh("rpl_hit"), self.context.fresh("rpl_found")
        react, travel = self.context.fresh("rpl_on_hit"), self.context.fresh("rpl_search_move")
        self.declarations += [
            ir.Variable(hit, ir.BoolType(), ir.BoolLiteral(False), scope="global"),
            ir.Variable(place, target, scope="global"),
        ]
        number = ir.IntLiteral(_PRIORITY)
        self.routines += self.helpers(move, search, hit, place, react, travel)
        condition = search.condition if search.edge != "falling" else ir.Unary("not", search.condition)
        origin, later = move.origin, replace(move.origin, comments=())
        steps: list[ir.Statement] = [ir.Assign(ir.Name(hit), ir.BoolLiteral(False), origin=origin)]
        if search.hit is None and "ERR_SIGSUPSEARCH" in self.errors:
            already: ir.Body = (ir.Raise(ir.Name("ERR_SIGSUPSEARCH"), origin=later),)
            steps.append(ir.If(((condition, already),), origin=later))
        failed: ir.Body = ()
        if search.hit is None and "ERR_WHLSEARCH" in self.errors:
            failed = (ir.Raise(ir.Name("ERR_WHLSEARCH"), origin=later),)
        after: list[ir.Statement] = []
        if search.hit is not None:
            after.append(ir.Assign(search.hit, ir.Name(hit), origin=later))
        if search.found is not None:
            kept = ir.Assign(search.found, ir.Name(place), origin=later)
            after.append(ir.If(((ir.Name(hit), (kept,)),), failed, origin=later))
        elif failed:
            after.append(ir.If(((ir.Unary("not", ir.Name(hit)), failed),), origin=later))
        way: list[ir.Statement] = [
            ir.DeclareInterrupt(number, condition, ir.CallRoutine(react), origin=later),
            ir.CallRoutine(travel, tuple(map(ir.Argument, (move.target, *map(ir.Name, self.passed)))), origin=later),
            ir.ControlInterrupt("off", number, origin=later),
        ]
        if search.hit is not None and search.edge != "either":  # where the condition holds at once there is no move
            at_once: list[ir.Statement] = [ir.Assign(ir.Name(hit), ir.BoolLiteral(True), origin=later)]
            if search.found is not None:
                at_once.append(ir.Assign(ir.Name(place), ir.System("actual_pose"), origin=later))
            there = ir.If(((condition, tuple(at_once)),), tuple(way), origin=later)
            way = [ir.WaitForMotion(origin=later), there]
        return [*steps, *way, *after]
