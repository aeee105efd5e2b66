"""A share of all speeds and a highest speed that a program sets for what follows (RAPID VelSet), for targets without.

Each move gets the speed that comes of it where the setting is known at the move; other moves are refused. Where the
target can set an override, that says the share, and only the highest speed is worked into the moves.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import real

_SHARE, _LIMIT = "speed_percent", "speed_limit"
REFUSED = code(
    "speed-share-hangs-on-run",
    Severity.LOSS,
    "the target's programs cannot set a share or a highest value of all speeds, and what it is at this move hangs on "
    "the run",
    "say the speed of the move, or give the routine a speed as argument",
    stops=True,
)


@legalising(
    unless=lambda context: _SHARE in context.capabilities.system_variables or context.capabilities.carries_rules,
    sees=(f"system {_SHARE}", f"system {_LIMIT}"),
)
def speed_shares(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such settings, and programs that set them and never ask for them."""
    can = context.capabilities
    names = frozenset((_LIMIT,) if "override" in can.system_variables else (_LIMIT, _SHARE))
    assigned = [one for one in _assignments(program) if one.target.name in names]
    targets = {id(one.target) for one in assigned}
    asked = any(
        isinstance(one, ir.System) and one.name in names and id(one) not in targets
        for one in walk_for({"System"}, program)
    )
    if (
        not assigned
        or asked
        or any(isinstance(one, ir.Move) and not _by_profile(one) for one in walk_for({"Move"}, program))
    ):
        return program
    defaults = dict(rules_of(context.source).system_defaults)
    worker = _Shares(context, SettingsInForce.of(program, defaults), names, float(defaults.get(_LIMIT, 0.0) or 0.0))

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, lambda one: worker.statement(one, editor)))

    return edit_routines(program, context, work)


@dataclass(frozen=True, slots=True)
class _Setting:
    target: ir.System
    value: ir.Expression


def _assignments(program: ir.Program) -> Iterator[_Setting]:
    for one in walk_for({"Assign"}, program):
        match one:
            case ir.Assign(target=ir.System(name=name) as target, value=value) if name in (_SHARE, _LIMIT):
                yield _Setting(target, value)


def _by_profile(move: ir.Move) -> bool:
    return move.speed is not None and move.speed.profile is not None


@dataclass(slots=True)
class _Shares:
    """`usual`: the highest speed (mm/s) of a controller that is told none."""

    context: Context
    flow: SettingsInForce
    names: frozenset[str]
    usual: float

    def statement(self, statement: ir.Statement, editor: Editor) -> ir.Body:
        match statement:
            case ir.Assign(target=ir.System(name=name), origin=origin) if name in self.names:
                return (ir.Nothing(origin=origin),)
            case ir.Move(speed=ir.Speed() as speed):
                return (self.move(statement, speed, editor),)
        return (inside(statement, lambda inner: map_body(inner, lambda one: self.statement(one, editor))),)

    def move(self, move: ir.Move, speed: ir.Speed, editor: Editor) -> ir.Statement:
        limit, share = self.known(move, _LIMIT, editor), self.known(move, _SHARE, editor)
        if _SHARE not in self.names and limit == self.usual:
            return move  # the override says the share
        if self.flow.never_comes_to(move):
            return move
        if limit is None or share is None:
            return stopped(move, REFUSED, self.context)
        new = self.scaled(speed, share / 100, limit, editor)
        return move if new is speed else replace(move, speed=new)

    def known(self, move: ir.Move, name: str, editor: Editor) -> float | None:
        """The setting at a move; None where the run decides it."""
        state = self.flow.at(move)[name]
        return None if state is None else constant_number(state, editor.scope)

    def scaled(self, speed: ir.Speed, share: float, limit: float, editor: Editor) -> ir.Speed:
        path = speed.path if speed.path is not None else _component(speed.profile, "path")
        rotation = speed.rotation if speed.rotation is not None else _component(speed.profile, "rotation")
        if _SHARE not in self.names:  # what is left of the limit before the override's share
            slowest = path if path is None else _least(path, limit / max(share, 0.001), self.usual, editor)
            return speed if slowest is path else replace(speed, path=slowest)
        if path is None or rotation is None:
            return speed
        faster, turning = _times(path, share, editor), _times(rotation, share, editor)
        slowest = _least(faster, limit, self.usual, editor)
        if slowest is path and turning is rotation:
            return speed
        return replace(speed, path=slowest, rotation=speed.rotation if turning is rotation else turning)


def _component(profile: ir.Expression | None, name: str) -> ir.Expression | None:
    match profile:
        case None:
            return None
        case ir.Aggregate(entries=entries):
            return next((value for key, value in entries if key == name), None)
    return ir.Field(profile, name)


def _times(speed: ir.Expression, share: float, editor: Editor) -> ir.Expression:
    if share == 1.0:
        return speed
    number = constant_number(speed, editor.scope)
    return ir.Binary("*", speed, real(share)) if number is None else real(round(number * share, 9))


def _least(speed: ir.Expression, limit: float, usual: float, editor: Editor) -> ir.Expression:
    """The speed, at most the limit. A speed that is not known is taken to be below what a controller has as its own."""
    number = constant_number(speed, editor.scope)
    if number is None:
        return speed if limit >= usual else ir.Builtin("min", (speed, real(limit)))
    return real(limit) if limit < number else speed


__all__ = ["REFUSED", "speed_shares"]
