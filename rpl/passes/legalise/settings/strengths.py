"""How strongly a move speeds up and slows down, in percent, as the target says it.

Some controllers have one percentage for both (RAPID AccSet, TP ACC), others one for each (V+ ACCEL, INFORM ACC= and
DEC=). A percentage in force for all moves is written at each of them where the target has it there only, and one for
both is written as both where the target has two. A deceleration of its own that the target cannot say is reported with
what it becomes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import MoveSetting
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.saidaccelerations import number_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.settingwords import DROPPED
from rpl.passes.legalise.stages import legalising

SLOWS_DOWN = code(
    "deceleration-of-acceleration",
    Severity.WARNING,
    "the source slows down with {down} percent, the target with the {up} percent with which it speeds up",
    "look at the stops on the robot, or change the acceleration of these moves",
)
UP, DOWN = "acceleration_percent", "deceleration_percent"
_RAMPS = frozenset(("acceleration_ramp", "stop_ramp"))
_FULL = 100.0


@legalising(unless=lambda context: not context.foreign or context.capabilities.carries_rules)
def strengths(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with rules of their own, and programs that say such a percentage."""
    if not any(map(_says, walk_for({"Move", "Assign"}, *program.modules))):
        return program
    return edit_all(program, _Strengths(program, context).body)


def has_both(dialect: str) -> bool:
    """Does the language have a percentage of its own for slowing down?"""
    return DOWN in rules_of(dialect).system_defaults


def own_deceleration(move: ir.Move) -> ir.Expression | None:
    """What the move itself says about slowing down."""
    return next((value for place, value in move.settings if _is(place, DOWN)), None)


def without_own(move: ir.Move) -> ir.Move:
    """The move without its own percentage for slowing down."""
    return replace(move, settings=tuple(pair for pair in move.settings if not _is(pair[0], DOWN)))


def is_usual_ramp(name: str, value: ir.Expression) -> bool:
    """Does the acceleration change as fast as the controller can? No other controller has a setting for it."""
    return name in _RAMPS and number_of(value) == _FULL


def _is(place: ir.Expression, name: str) -> bool:
    return isinstance(place, ir.System) and place.name == name


def _says(node: object) -> bool:
    match node:
        case ir.Assign(target=ir.System(name=name)):
            return name in (UP, DOWN)
        case ir.Move():
            return node.acceleration is not None or own_deceleration(node) is not None
    return False


class _Strengths:
    """`at_moves`: the target says the percentage at its moves only."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        can = context.capabilities
        self.context, self.flow = context, SettingsInForce.begun_by(program, context.source)
        said = {name for node in walk_for({"Assign"}, *program.modules) for name in _set(node)}
        self.apart = has_both(context.source) or DOWN in said
        in_numbers = {"path_acceleration", "axis_acceleration"} <= can.settings.speeds
        self.at_moves = UP not in can.system_variables and not in_numbers
        self.modal, self.moves_say = DOWN in can.system_variables, MoveSetting.DECELERATION in can.settings.of_moves
        self.reported: set[tuple[str, str]] = set()
        moves = [node for node in walk_for({"Move"}, *program.modules) if isinstance(node, ir.Move)]
        self.known = all(self.flow.at(move).get(UP) is not None for move in moves)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Move():
                return (self.move(statement),)
            case ir.Assign(target=ir.System(name="acceleration_percent")):
                return self.setting(statement)
            case ir.Assign(target=ir.System(name="deceleration_percent")) if not self.modal:
                return (ir.Nothing(origin=statement.origin),)
        return (inside(statement, self.body),)

    def setting(self, statement: ir.Assign) -> ir.Body:
        """The percentage for all moves: of each move, or of both ramps."""
        if self.at_moves and self.known:
            return (ir.Nothing(origin=statement.origin),)
        if not self.modal or self.apart:
            return (statement,)
        later = replace(statement.origin, comments=())
        return statement, ir.Assign(ir.System(DOWN), statement.value, origin=later)

    def move(self, move: ir.Move) -> ir.Move:
        state, own = self.flow.at(move), own_deceleration(move)
        up = move.acceleration or state.get(UP)
        down = own or (state.get(DOWN) if self.apart else up)
        if move.acceleration is None and self.at_moves and up is not None and number_of(up) != _FULL:
            move = replace(move, acceleration=up)
        if self.modal:
            return move
        bare = without_own(move)
        if self.moves_say and down is not None:
            pair = (ir.System(DOWN, origin=move.origin), down)
            return bare if number_of(down) == _FULL else replace(bare, settings=(*bare.settings, pair))
        if down is None and (self.apart or self.moves_say):
            self.report(move, "a deceleration that depends on the run")
        elif number_of(up) != number_of(down) or number_of(down) is None:
            self.differs(move, up, down)
        return bare

    def report(self, move: ir.Move, what: str) -> None:
        if (what, "") not in self.reported:
            self.reported.add((what, ""))
            self.context.diagnostics.report(DROPPED, move.origin, name=what)

    def differs(self, move: ir.Move, up: ir.Expression | None, down: ir.Expression | None) -> None:
        """Each pair once."""
        if up == down:
            return
        shown = tuple("a computed" if (number := number_of(one)) is None else f"{number:g}" for one in (up, down))
        if (shown[0], shown[1]) not in self.reported:
            self.reported.add((shown[0], shown[1]))
            self.context.diagnostics.report(SLOWS_DOWN, move.origin, up=shown[0], down=shown[1])


def _set(node: object) -> Iterator[str]:
    if isinstance(node, ir.Assign) and isinstance(node.target, ir.System):
        yield node.target.name


__all__ = ["has_both", "is_usual_ramp", "own_deceleration", "strengths", "without_own"]
