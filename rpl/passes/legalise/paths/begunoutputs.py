"""What a program does when a move begins, in languages whose programs come behind a move only when it ends.

A controller that holds the program only until the robot has begun a move (V+) switches an output that stands behind a
move where that move begins. Elsewhere the program is there near the end of the move: outputs, and looks at inputs and
timers, go in front of the move, or become actions at its begin where the program runs ahead of the robot (KRL). An
output that cannot be put there, and one behind branches that end with moves, is named.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import blocks, is_constant
from rpl.passes.legalise.facts.motion.advance import looks
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

LATE = code(
    "begun-output",
    Severity.WARNING,
    "the source's controller does this when it begins the move in front of it; here that move is at its end by then",
    "look whether that is early enough; else write it in front of the move, or as an action on its path",
)
_OUTPUTS = frozenset(("digital_out", "analog_out", "group_out", "flag"))
_CLOCKS = frozenset(("timer", "timer_stopped", "timer_positive", "time"))
_WAITED = (ir.WaitForMotion, ir.Halt)


@legalising()
def begun_outputs(program: ir.Program, context: Context) -> ir.Program:
    """Outputs, and looks at inputs and timers, of a program that goes on when a move has begun."""
    source, target = (rules_of(one).advance.runs_ahead_of for one in (context.source, context.target))
    if source != "begun" or target == "begun":
        return program
    can = context.capabilities
    ahead = target == "all" and {"LookAhead", "Trigger"} <= can.statements
    put: list[ir.Statement] = []
    modules = tuple(
        replace(module, routines=tuple(_routine(one, can.motion.concurrent, ahead, put) for one in module.routines))
        for module in program.modules
    )
    program = replace(program, modules=modules)
    _Late(program, context, put).report()  # running ahead ends at an output, too, until the move has ended
    return program


def _routine(routine: ir.Routine, goes_on: bool, ahead: bool, put: list[ir.Statement]) -> ir.Routine:
    """The routine with its bodies changed; what now stands in front of a move comes to `put`. goes_on: moves of the
    target may go on beside the program; ahead: it runs ahead over moves, and an action at the begin comes in time."""
    given = frozenset(one.name.lower() for one in routine.parameters if one.mode == "reference")

    def placed(body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        rest = list(body)
        driving = False  # a move that the program does not wait for is on its way
        while rest:
            statement = rest.pop(0)
            statement = inside(statement, placed)
            if isinstance(statement, ir.Move) and _waited_for(statement, goes_on):
                first, rest = _at_begin(statement, rest, given)
                if first and driving:  # the source is held here until that one ends
                    done.append(ir.WaitForMotion(origin=replace(statement.origin, comments=())))
                driving = False
                done.extend(_in_front(first, statement, ahead))
                put.extend(done[-1 - len(first) : -1])
                continue
            if isinstance(statement, ir.Move):
                driving = statement.concurrent
            elif any(isinstance(node, ir.Move | ir.CallRoutine | ir.WaitForMotion) for node in walk(statement)):
                driving = False
            done.append(statement)
        return body if len(done) == len(body) and all(map(_is, done, body)) else tuple(done)

    return edit_bodies(routine, placed)


def _is(one: ir.Statement, other: ir.Statement) -> bool:
    return one is other


def _waited_for(move: ir.Move, goes_on: bool) -> bool:
    """Is what stands behind the move done when it ends, as it is written?"""
    return move.search is None and not (move.concurrent and goes_on)


def _at_begin(
    move: ir.Move, rest: list[ir.Statement], given: frozenset[str]
) -> tuple[list[ir.Statement], list[ir.Statement]]:
    """The statements behind a move that can stand in front of it, and what stays behind it."""
    if any(isinstance(node, ir.Call) for node in walk(move)):
        return [], rest
    first: list[ir.Statement] = []
    behind: list[ir.Statement] = []
    crossed, changed = _keys(move), frozenset[str]()
    for at, statement in enumerate(rest):
        writes, keys = _written(statement), _keys(statement)
        now = _of_now(statement)
        if not _plain(statement) or (now and (writes & (crossed | given) or keys & changed)):
            return first, behind + rest[at:]  # the order of what is done at the begin stays
        if now:
            first.append(statement)
        else:
            behind.append(statement)
            crossed, changed = crossed | keys, changed | writes
    return first, behind


def _plain(statement: ir.Statement) -> bool:
    """Does it only calculate and switch, without a call and without a look at the robot's place?"""
    match statement:
        case ir.Nothing():
            return True
        case ir.Assign():
            return not any(isinstance(node, ir.Call | ir.VendorValue) or looks(node) for node in walk(statement))
        case ir.If(branches=branches, otherwise=otherwise):
            conditions = [condition for condition, _ in branches]
            if any(isinstance(node, ir.Call | ir.VendorValue) or looks(node) for node in walk(*conditions)):
                return False
            return all(map(_plain, (*otherwise, *(one for _, body in branches for one in body))))
    return False


def _of_now(statement: ir.Statement) -> bool:
    """Does it matter when it is done? Settings of the arm belong to the moves behind them."""
    for node in walk(statement):
        if isinstance(node, ir.Assign) and isinstance(node.target, ir.System) and node.target.name not in _CLOCKS:
            return False
    return any(
        isinstance(node, ir.Signal) or (isinstance(node, ir.System) and node.name in _CLOCKS)
        for node in walk(statement)
    )


def _keys(*nodes: object) -> frozenset[str]:
    """Variables, kinds of signals and system variables that stand in a statement."""
    found = set()
    for node in walk(*nodes):
        match node:
            case ir.Name(id=name):
                found.add(name.lower())
            case ir.Signal(kind=kind):
                found.add(f"${kind}")
            case ir.System(name=name):
                found.add(f"%{name}")
    return frozenset(found)


def _written(statement: ir.Statement) -> frozenset[str]:
    targets = [node.target for node in walk(statement) if isinstance(node, ir.Assign)]
    return _keys(*targets)


def _in_front(first: list[ir.Statement], move: ir.Move, ahead: bool) -> list[ir.Statement]:
    """The move behind what is done at its begin; its comments stay on top."""
    done: list[ir.Statement] = []
    for statement in first:
        match statement:
            case ir.Assign(target=ir.Signal(kind=kind), value=value) if ahead and kind == "digital_out":
                if is_constant(value):
                    inner = replace(statement, origin=replace(statement.origin, comments=()))
                    statement = ir.Trigger("start", inner, origin=statement.origin)
        done.append(statement)
    if done and move.origin.comments:
        top = done[0].origin
        done[0] = replace(done[0], origin=replace(top, comments=(*move.origin.comments, *top.comments)))
        move = replace(move, origin=replace(move.origin, comments=()))
    return [*done, move]


class _Late:
    """Names the outputs behind a move that the program does not wait for. `driving`: routines that end with one."""

    def __init__(self, program: ir.Program, context: Context, put: list[ir.Statement]) -> None:
        self.program, self.context = program, context
        self.put = {id(one) for one in put}
        self.driving: dict[str, bool | None] = {}
        self.named = False
        self.seen: set[int] = set()

    def report(self) -> None:
        routines = [routine for module in self.program.modules for routine in module.routines]
        for _ in routines:
            before = dict(self.driving)
            for routine in routines:
                self.driving[routine.name.lower()] = self.body(routine.body, None)
            if before == self.driving:
                break
        self.named = True
        for routine in routines:
            for body in bodies(routine):
                self.body(body, False)

    def body(self, body: ir.Body, going: bool | None) -> bool | None:
        """Is the robot driving behind the body? None: as before it."""
        for statement in body:
            going = self.statement(statement, going)
        return going

    def statement(self, statement: ir.Statement, going: bool | None) -> bool | None:
        if id(statement) in self.put:
            return going
        match statement:
            case ir.Move(concurrent=concurrent, search=search):
                return not concurrent and search is None
            case ir.CallRoutine(name=name):
                after = self.driving.get(name.lower())
                return going if after is None else after
            case ir.Assign(target=ir.Signal(kind=kind)) if kind in _OUTPUTS:
                if going and self.named and id(statement) not in self.seen:
                    self.seen.add(id(statement))
                    self.context.diagnostics.report(LATE, statement.origin)
                return going
        if isinstance(statement, _WAITED):
            return False
        inner = blocks(statement)
        if not inner:
            return going
        loop = isinstance(statement, ir.For | ir.While | ir.Repeat | ir.Loop)
        ends = [self.body(one, going) for one in inner]
        if loop and ends[0]:
            self.body(inner[0], True)
        known = [*ends, going] if loop or isinstance(statement, ir.Switch) else ends
        return True if True in known else (False if all(one is False for one in known) else None)
