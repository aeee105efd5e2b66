"""Accelerations that follow the programmed speed (V+ SCALE.ACCEL): what that makes of each move, for other languages.

While the setting is on, a move at half of the full speed speeds up and brakes with half of what the program says. A
target without it is told the percentages of each move; where they hang on the run, or are less than the target takes,
this is reported. Where the program itself says nothing of accelerations, and the target would need statements around
each move, they are left to the arm, which is said. A target whose programs start with the setting on gets it switched
off first.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.entries import moving_entries
from rpl.passes.legalise.facts.motion.saidaccelerations import number_of
from rpl.passes.legalise.facts.settingsinforce import SCALED, SettingsInForce, State
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

UNKNOWN = code(
    "acceleration-follows-speed",
    Severity.WARNING,
    "the source's controller scales the acceleration by the programmed speed, which hangs on the run here; the target "
    "takes what the program says, or its usual one",
    "times of short moves and corners come out otherwise: look at them on the robot",
)
LEAST = code(
    "acceleration-below-least",
    Severity.WARNING,
    "the move speeds up with {percent:g} percent at its speed in the source; the target takes {least:g} at the least",
    "times of short moves and corners come out otherwise: look at them on the robot",
)
USUAL = code(
    "acceleration-usual",
    Severity.WARNING,
    "the source's controller scales the acceleration by the programmed speed without being told; the target "
    "accelerates as its arm does",
    "times of short moves and corners come out otherwise: set the acceleration at the head of the program if the load "
    "asks for it",
)
SETTING, UP, DOWN = "scale_acceleration", "acceleration_percent", "deceleration_percent"
_TIMED = (ir.DeclareInterrupt, ir.OrderInterrupt, ir.ControlInterrupt, ir.TaskControl, ir.Trigger)
_USUAL_MM_S, _FULL, _LEAST_SHARE = 250.0, 100.0, 1e-3


@legalising(unless=lambda context: not context.foreign or context.capabilities.carries_rules)
def scaled_accelerations(program: ir.Program, context: Context) -> ir.Program:
    """Only between languages, and where one of them has the setting."""
    if starts_on(context.source) or any(_sets(node, SETTING) for node in walk_for({"Assign"}, *program.modules)):
        program = _Shares(program, context).program()
    return _switched_off(program) if starts_on(context.target) else program


def starts_on(dialect: str) -> bool:
    """Do programs of the language start with the setting on?"""
    return bool(rules_of(dialect).system_defaults.get(SETTING, SCALED[SETTING]))


def _sets(node: object, *names: str) -> bool:
    return isinstance(node, ir.Assign) and isinstance(node.target, ir.System) and node.target.name in names


def _switched_off(program: ir.Program) -> ir.Program:
    """The setting off at the beginning of the routines that a program may start with."""
    if not any(isinstance(node, ir.Move) for node in walk_for({"Move"}, *program.modules)):
        return program
    entries = moving_entries(program)
    setting = ir.Assign(ir.System(SETTING), ir.BoolLiteral(False))
    modules = []
    for module in program.modules:
        routines = tuple(
            replace(one, body=(setting, *one.body)) if one.name.lower() in entries and one.body else one
            for one in module.routines
        )
        modules.append(replace(module, routines=routines))
    return replace(program, modules=tuple(modules))


class _Shares:
    """The percentages of one program's moves."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        self.source, self.context = program, context
        rules = rules_of(context.source)
        self.flow = SettingsInForce.of(program, dict(rules.system_defaults))
        self.full = float(rules.system_defaults.get("path_speed", _USUAL_MM_S))
        self.limits = rules_of(context.target).percent_limits.get(UP, (0.0, _FULL))
        self.reported: set[tuple[Code, object]] = set()

    def program(self) -> ir.Program:
        moves = [node for node in walk_for({"Move"}, *self.source.modules) if isinstance(node, ir.Move)]
        shares = {id(move): self.share(move) for move in moves}
        known = all(self.percents(move) is not None for move in moves)
        scaled = any(share not in (None, 1.0) for share in shares.values())
        for move in moves:
            if shares[id(move)] is None or (shares[id(move)] != 1.0 and not known):
                self.report(UNKNOWN, move, "")
        if not known:
            return self.without(SETTING)
        if scaled and self.is_silent():
            self.report(USUAL, next(move for move in moves if shares[id(move)] != 1.0), "")
            return self.without(SETTING)
        said = {id(move): self.said(move, shares[id(move)] or 1.0) for move in moves} if scaled else {}
        program = rewrite(self.source, lambda node: said.get(id(node), node))
        return self.without(SETTING, UP, DOWN, program=program) if scaled else self.without(SETTING)

    def is_silent(self) -> bool:
        """Does no statement say anything of accelerations, where the target has no word for that of one move? People
        write none around each move because another controller has a rule of its own. What happens beside the moves
        may hang on their times, so that these stay."""
        can = self.context.capabilities
        modal = can.system_variables & {UP, "joint_acceleration"} and not (
            can.settings.of_moves and UP not in can.system_variables
        )
        said = any(
            _sets(node, UP, DOWN, SETTING) or (isinstance(node, ir.Move) and node.acceleration is not None)
            for node in walk_for({"Assign", "Move"}, *self.source.modules)
        )
        timed = any(
            isinstance(node, _TIMED)
            for node in walk_for(
                {"DeclareInterrupt", "OrderInterrupt", "ControlInterrupt", "TaskControl", "Trigger"},
                *self.source.modules,
            )
        )
        return bool(modal) and not said and not timed

    def share(self, move: ir.Move) -> float | None:
        """What the move's speed makes of its accelerations; None where that hangs on the run."""
        state, own = self.flow.at(move), _own(move)
        on = own.get(SETTING) or state.get(SETTING)
        if isinstance(on, ir.BoolLiteral) and not on.value:
            return 1.0
        speed = move.speed or ir.Speed()
        if move.kind == "joint" and (speed.path is None or speed.joint is not None):
            said, full = speed.joint or own.get("joint_speed") or state.get("joint_speed"), _FULL
        else:
            said, full = speed.path or own.get("path_speed") or state.get("path_speed"), self.full
        number = number_of(said)
        if number is None or not isinstance(on, ir.BoolLiteral):
            return None
        return min(max(number / full, _LEAST_SHARE), 1.0)

    def percents(self, move: ir.Move) -> tuple[float, float] | None:
        """What the program says for speeding up and slowing down."""
        state, own = self.flow.at(move), _own(move)
        up = number_of(move.acceleration or state.get(UP))
        down = own.get(DOWN) or state.get(DOWN)
        slow = up if down is None else number_of(down)
        return None if up is None or slow is None else (up, slow)

    def said(self, move: ir.Move, share: float) -> ir.Move:
        """The move with its percentages."""
        percents = self.percents(move)
        assert percents is not None  # asked before
        up, down = (float(f"{min(max(one, 1.0), _FULL) * share:.6g}") for one in percents)
        if up == down == _FULL:
            return move
        if min(up, down) < self.limits[0]:
            self.report(LEAST, move, min(up, down), percent=min(up, down), least=self.limits[0])
        rest = tuple(pair for pair in move.settings if not (isinstance(pair[0], ir.System) and pair[0].name == DOWN))
        slow = (ir.System(DOWN, origin=move.origin), ir.RealLiteral(down))
        return replace(move, acceleration=ir.RealLiteral(up), settings=(*rest, slow))

    def without(self, *names: str, program: ir.Program | None = None) -> ir.Program:
        """The program without the settings that its moves say now."""
        return rewrite(
            program or self.source,
            lambda node: (
                ir.Nothing(origin=node.origin) if isinstance(node, ir.Assign) and _sets(node, *names) else node
            ),
        )

    def report(self, what: Code, move: ir.Move, key: object, **arguments: object) -> None:
        if (what, key) not in self.reported:
            self.reported.add((what, key))
            self.context.diagnostics.report(what, move.origin, **arguments)


def _own(move: ir.Move) -> State:
    return {place.name: value for place, value in move.settings if isinstance(place, ir.System)}


__all__ = ["scaled_accelerations", "starts_on"]
