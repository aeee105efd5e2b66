"""A share of all speeds and a highest speed that a program sets for what follows (RAPID VelSet), for targets without.

Each move gets the speed that comes of it: a number where the setting is known at the move, else what the program
computes from two variables that stand for the setting. Where the target can set an override, that says the share, and
only the highest speed is worked into the moves.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.control.jumps import inside
from rpl.passes.legalise.facts.modalflow import Flow
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import real

_SHARE, _LIMIT = "speed_percent", "speed_limit"
_STEMS = {_SHARE: "rpl_speed_share", _LIMIT: "rpl_speed_limit"}


@legalising(
    unless=lambda context: _SHARE in context.capabilities.system_variables or context.capabilities.carries_rules
)
def speed_shares(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such settings, and programs that set them and never ask for them."""
    can = context.capabilities
    names = frozenset((_LIMIT,) if "override" in can.system_variables else (_LIMIT, _SHARE))
    assigned = [one for one in _assignments(program) if one.target.name in names]
    targets = {id(one.target) for one in assigned}
    asked = any(isinstance(one, ir.System) and one.name in names and id(one) not in targets for one in walk(program))
    if not assigned or asked or any(isinstance(one, ir.Move) and not _by_profile(one) for one in walk(program)):
        return program
    defaults = dict(rules_of(context.source).system_defaults)
    worker = _Shares(context, Flow.of(program, defaults), names, float(defaults.get(_LIMIT, 0.0) or 0.0))

    def moves(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, lambda one: worker.move(one, editor)))

    def settings(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, worker.setting))

    done = edit_routines(edit_routines(program, context, moves), context, settings)
    declared = [
        ir.Variable(name, ir.RealType(), real(1.0 if which == _SHARE else worker.usual), scope="global")
        for which, name in worker.variables.items()
    ]
    return with_support(done, context, declared, (), done.modules[0].task)


@dataclass(frozen=True, slots=True)
class _Setting:
    target: ir.System
    value: ir.Expression


def _assignments(program: ir.Program) -> Iterator[_Setting]:
    for one in walk(program):
        match one:
            case ir.Assign(target=ir.System(name=name) as target, value=value) if name in _STEMS:
                yield _Setting(target, value)


def _by_profile(move: ir.Move) -> bool:
    return move.speed is not None and move.speed.profile is not None


@dataclass(slots=True)
class _Shares:
    """`usual`: the highest speed (mm/s) of a controller that is told none; `variables`: setting -> its variable."""

    context: Context
    flow: Flow
    names: frozenset[str]
    usual: float
    variables: dict[str, str] = field(default_factory=dict)

    def move(self, statement: ir.Statement, editor: Editor) -> ir.Body:
        if isinstance(statement, ir.Move) and statement.speed is not None:
            limit = self.known(statement, _LIMIT, editor, 1.0)
            if _SHARE in self.names:
                speed = self.scaled(statement.speed, self.known(statement, _SHARE, editor, 0.01), limit, editor)
            else:
                speed = self.limited(statement, statement.speed, limit, editor)
            return (statement if speed is statement.speed else replace(statement, speed=speed),)
        return (inside(statement, lambda inner: map_body(inner, lambda one: self.move(one, editor))),)

    def known(self, move: ir.Move, name: str, editor: Editor, unit: float) -> float | ir.Name:
        """The setting at a move, or the variable that stands for it."""
        state = self.flow.at(move)[name]
        number = None if state is None else constant_number(state, editor.scope)
        if number is not None:
            return number * unit
        if name not in self.variables:
            self.variables[name] = self.context.fresh(_STEMS[name])
        return ir.Name(self.variables[name])

    def scaled(self, speed: ir.Speed, share: float | ir.Name, limit: float | ir.Name, editor: Editor) -> ir.Speed:
        path = speed.path if speed.path is not None else _component(speed.profile, "path")
        rotation = speed.rotation if speed.rotation is not None else _component(speed.profile, "rotation")
        if path is None or rotation is None:
            return speed
        faster, turning = _times(path, share, editor), _times(rotation, share, editor)
        slowest = _least(faster, limit, self.usual, editor)
        if slowest is path and turning is rotation:
            return speed
        return replace(speed, path=slowest, rotation=speed.rotation if turning is rotation else turning)

    def limited(self, move: ir.Move, speed: ir.Speed, limit: float | ir.Name, editor: Editor) -> ir.Speed:
        """The speed where an override says the share of it: what is left of the limit before that."""
        path = speed.path if speed.path is not None else _component(speed.profile, "path")
        if path is None or limit == self.usual:
            return speed
        share = self.known(move, _SHARE, editor, 0.01)
        most: float | ir.Expression
        if isinstance(limit, float) and isinstance(share, float):
            most = limit / max(share, 0.001)
        else:
            most = ir.Binary("/", *(one if isinstance(one, ir.Name) else real(one) for one in (limit, share)))
        slowest = _least(path, most, self.usual, editor)
        return speed if slowest is path else replace(speed, path=slowest)

    def setting(self, statement: ir.Statement) -> ir.Body:
        """A setting as that of its variable, or gone where all moves know it."""
        match statement:
            case ir.Assign(target=ir.System(name=name), value=value, origin=origin) if name in _STEMS:
                stays = name not in self.names
                if name not in self.variables:
                    return (statement if stays else ir.Nothing(origin=origin),)
                if name == _SHARE:
                    value = ir.Binary("/", value, real(100.0))
                kept = ir.Assign(ir.Name(self.variables[name]), value, origin=origin)
                return (kept, replace(statement, origin=replace(origin, comments=()))) if stays else (kept,)
        return (inside(statement, lambda inner: map_body(inner, self.setting)),)


def _component(profile: ir.Expression | None, name: str) -> ir.Expression | None:
    match profile:
        case None:
            return None
        case ir.Aggregate(entries=entries):
            return next((value for key, value in entries if key == name), None)
    return ir.Field(profile, name)


def _times(speed: ir.Expression, share: float | ir.Name, editor: Editor) -> ir.Expression:
    if isinstance(share, ir.Name):
        return ir.Binary("*", speed, share)
    if share == 1.0:
        return speed
    number = constant_number(speed, editor.scope)
    return ir.Binary("*", speed, real(share)) if number is None else real(round(number * share, 9))


def _least(speed: ir.Expression, limit: float | ir.Expression, usual: float, editor: Editor) -> ir.Expression:
    """The speed, at most the limit. A speed that is not known is taken to be below what a controller has as its own."""
    if not isinstance(limit, float):
        return ir.Builtin("min", (speed, limit))
    number = constant_number(speed, editor.scope)
    if number is None:
        return speed if limit >= usual else ir.Builtin("min", (speed, real(limit)))
    return real(limit) if limit < number else speed


__all__ = ["speed_shares"]
