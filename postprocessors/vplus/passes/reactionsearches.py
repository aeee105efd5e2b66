"""Search moves for targets without them whose interrupts can stop the robot and drop its move (V+ REACTI).

Such an interrupt watches one signal: it notes the joints, and the program goes on behind the move. Any other
condition is looked at again and again while the robot moves. The error numbers are the source's: signal already there,
nothing found.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising

POLLED = code(
    "search-polled",
    Severity.WARNING,
    "the target's interrupts do not watch this condition; the program looks at it while the robot moves",
)
# More urgent than the interrupts that passes.interrupts numbers; further searches come behind those.
_PRIORITIES = (*range(9, 0, -1), *range(40, 128))


@legalising(
    sees=("Move",),
)
def reaction_searches(program: ir.Program, context: Context) -> ir.Program:
    """There are no search moves, but interrupts that drop a move."""
    if not any(isinstance(one, ir.Move) and one.search is not None for one in walk_for({"Move"}, *program.modules)):
        return program
    worker = _Searches(context)
    done = edit_routines(program, context, worker.routine)
    if not worker.declarations:
        return done
    return with_support(done, context, worker.declarations, worker.routines, done.modules[0].task)


def _is_signal(condition: ir.Expression) -> bool:
    """One digital signal, its opposite, or its comparison with a state."""
    match condition:
        case ir.Signal(kind=kind, last=None):
            return kind.startswith("digital") or kind == "flag"
        case ir.Unary(op="not", operand=operand) | ir.Binary(op="=" | "<>", left=operand, right=ir.BoolLiteral()):
            return _is_signal(operand)
    return False


@dataclass(slots=True)
class _Searches:
    context: Context
    declarations: list[ir.Variable] = field(default_factory=list)
    routines: list[ir.Routine] = field(default_factory=list)
    numbers: list[tuple[ir.Expression, bool]] = field(default_factory=list)  # what is watched, each with its priority
    hit: ir.Name = field(default_factory=lambda: ir.Name(""))
    place: ir.Name = field(default_factory=lambda: ir.Name(""))

    def routine(self, editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.Move) and statement.search is not None and statement.search.edge != "either":
                return expansion(statement.origin, self.search(statement, statement.search, editor))
            return (inside(statement, lambda inner: map_body(inner, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    def noted(self) -> ir.Body:
        """What is kept where the condition came."""
        if not self.hit.id:
            self.hit, self.place = ir.Name(self.context.fresh("rpl_hit")), ir.Name(self.context.fresh("rpl_hit_at"))
            self.declarations = [
                ir.Variable(self.hit.id, ir.BoolType(), ir.BoolLiteral(False), scope="global"),
                ir.Variable(self.place.id, ir.JointsType(), scope="global"),
            ]
        joints = ir.Assign(self.place, ir.Builtin("current_joints", ()))
        return joints, ir.Assign(self.hit, ir.BoolLiteral(True))

    def search(self, move: ir.Move, search: ir.Search, editor: Editor) -> ir.Body:
        condition = search.condition if search.edge != "falling" else ir.Unary("not", search.condition)
        bare = replace(move, search=None, blend=ir.BlendStop())
        self.noted()
        way = self.watched(bare, condition, search) if _is_signal(condition) else self.polled(bare, condition, search)
        errors = set(rules_of(self.context.source).errors)
        kept = () if search.found is None else (ir.Assign(search.found, self.found(search.found, move, editor)),)
        missed: ir.Body = ()
        if search.hit is None and search.stop != "none" and "ERR_WHLSEARCH" in errors:
            missed = (ir.Raise(ir.Name("ERR_WHLSEARCH")),)
        behind: ir.Body = (ir.If(((self.hit, kept),), missed),) if kept else ()
        if missed and not kept:
            behind = (ir.If(((ir.Unary("not", self.hit), missed),)),)
        if search.hit is not None:  # where the condition holds at once there is no move
            return (ir.If(((condition, self.noted()),), way), ir.Assign(search.hit, self.hit), *behind)
        if search.stop == "none" or "ERR_SIGSUPSEARCH" not in errors:
            return (*way, *behind)
        already = ir.If(((condition, (ir.Raise(ir.Name("ERR_SIGSUPSEARCH")),)),))
        return (already, *way, *behind)

    def watched(self, move: ir.Move, condition: ir.Expression, search: ir.Search) -> ir.Body:
        """An interrupt on the signal, armed for the move."""
        key = condition, search.stop != "none"
        if key not in self.numbers:
            self.numbers.append(key)
        if not self.routines:
            self.routines.append(ir.Routine(self.context.fresh("rpl_on_hit"), body=self.noted(), scope="global"))
        number = ir.IntLiteral(_PRIORITIES[min(self.numbers.index(key), len(_PRIORITIES) - 1)])
        action = ir.CallRoutine(self.routines[0].name)
        once = search.stop != "none"
        return (
            ir.Assign(self.hit, ir.BoolLiteral(False)),
            ir.DeclareInterrupt(number, condition, action, everywhere=True, once=once, stops=search.stop != "none"),
            ir.ControlInterrupt("on", number),
            move,
            ir.WaitForMotion(),
            ir.ControlInterrupt("off", number),
        )

    def polled(self, move: ir.Move, condition: ir.Expression, search: ir.Search) -> ir.Body:
        """The program looks while the robot moves."""
        self.context.diagnostics.report(POLLED, move.origin)
        stop: ir.Body = (ir.StopMotion(), ir.ClearMotion()) if search.stop != "none" else ()
        stands = ir.Unary("not", ir.System("moving"))
        return (
            ir.Assign(self.hit, ir.BoolLiteral(False)),
            ir.WaitForMotion(),
            replace(move, concurrent=True),
            ir.WaitUntil(ir.Binary("or", condition, stands)),
            ir.If(((condition, (*self.noted(), *stop)),)),
            ir.WaitForMotion(),
        )

    def found(self, target: ir.Expression, move: ir.Move, editor: Editor) -> ir.Expression:
        """Where it came, seen as the move sees its target."""
        if isinstance(editor.type_of(target), ir.JointsType):
            return self.place
        frames = () if move.tool is None else (move.tool,) if move.frame is None else (move.tool, move.frame)
        return ir.Builtin("joints_to_target", (self.place, *frames))


__all__ = ["reaction_searches"]
