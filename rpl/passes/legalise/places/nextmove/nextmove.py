"""Settings for the next move only, as settings of that move, for targets without such statements.

It must be certain which move is the next: followed through straight lines, and into every branch of a choice. A value
that may change on the way is kept. Where the next move is not certain, or stands in a routine that is called, the
setting is refused with the reason.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.capabilities import Capabilities, MoveSetting, SettingRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.activations import Activations, called
from rpl.passes.legalise.facts.effects import blocks, is_constant, statements_in
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside, leaves
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising

UNCERTAIN = code(
    "next-move-uncertain",
    Severity.LOSS,
    "{setting} is set for the next move, and which one that is cannot be said here: {reason}",
    "set it directly in front of its move",
    stops=True,
)
# Settings that moves say with their speed and their corner.
_AT_MOVES = frozenset(("path_speed", "joint_speed", "blend_distance", "blend_joint"))
_OTHER_MOTION = (ir.MoveExternal, ir.Spline)


@legalising(
    unless=lambda context: (
        SettingRule.NEXT_MOVE in context.capabilities.settings.rules
        and (not context.capabilities.settings.of_moves & {MoveSetting.SPEED, MoveSetting.BLEND})
    ),
    sees=("SetForNextMove",),
)
def settings_of_next_move(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without settings for one move; where these say no speeds and corners, for those."""
    can = context.capabilities
    facts = Activations.of(program)
    moving = {key for key, routine in facts.routines.items() if any(map(moves, _every(routine)))}
    movers = {key for key in facts.routines if facts.reached({key}) & moving}
    outermost = set(facts.routines) - {one for callees in facts.calls.values() for one in callees}

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        if not any(set_at_move(one, can) for one in _every(routine)):
            return routine
        follow = _Follow(editor, movers, id(routine) in outermost)
        for body in bodies(routine):
            left = follow.body(body, {})
            if id(routine) not in outermost:
                follow.lose(left or {}, "the routine ends before it")
        return edit_bodies(routine, _Attach(editor, follow).body)

    return edit_routines(program, context, work)


def set_at_move(statement: ir.Statement, can: Capabilities) -> bool:
    """Is it a setting that the target has to say at the move?"""
    if not isinstance(statement, ir.SetForNextMove):
        return False
    setting = statement.setting.value if isinstance(statement.setting, ir.Magnitude) else statement.setting
    name = setting.name if isinstance(setting, ir.System) else ""
    return SettingRule.NEXT_MOVE not in can.settings.rules or name in _AT_MOVES


def _every(routine: ir.Routine) -> list[ir.Statement]:
    return [statement for body in bodies(routine) for statement in statements_in(body)]


def moves(statement: ir.Statement) -> bool:
    """Does the statement move the robot, or set something for its next move?"""
    return isinstance(statement, (ir.Move, *_OTHER_MOTION, ir.SetForNextMove))


@dataclass(slots=True)
class _Pending:
    """A setting on its way. `changes`: something between may change its value. `lost`: why no move can take it."""

    statement: ir.SetForNextMove
    changes: bool = False
    lost: str = ""


Waiting = dict[str, _Pending]


@dataclass(slots=True)
class _Follow:
    """Follows the settings to their moves. `taken`: the settings of each move, by identity."""

    editor: Editor
    movers: set[int]
    outermost: bool
    every: dict[int, _Pending] = field(default_factory=dict)
    taken: dict[int, list[_Pending]] = field(default_factory=dict)

    def lose(self, waiting: Waiting, reason: str) -> None:
        for one in waiting.values():
            one.lost = one.lost or reason

    def body(self, body: ir.Body, waiting: Waiting) -> Waiting | None:
        """The settings that no move of the body has taken; None where its end is not reached."""
        now: Waiting | None = waiting
        for statement in body:
            if now is None:  # behind a jump, until a label
                if not isinstance(statement, ir.Label):
                    continue
                now = {}
            now = self.statement(statement, now)
        return now

    def statement(self, statement: ir.Statement, waiting: Waiting) -> Waiting | None:
        match statement:
            case ir.SetForNextMove() if not set_at_move(statement, self.editor.capabilities):
                return waiting
            case ir.SetForNextMove():
                pending = self.every.setdefault(id(statement), _Pending(statement))
                # a later value for the same setting takes the place of the earlier one
                return {**waiting, repr(statement.setting): pending}
            case ir.Move():
                self.taken.setdefault(id(statement), []).extend(waiting.values())
                return {}
            case ir.Nothing():
                return waiting
            case ir.If(branches=branches, otherwise=otherwise):
                return self.choice([*(body for _, body in branches), otherwise], statement, waiting)
            case ir.Switch(cases=cases, default=default):
                return self.choice([*(case.body for case in cases), default or ()], statement, waiting)
            case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
                if any(map(moves, statements_in(body))):
                    self.lose(waiting, "it stands in a loop")
                    waiting = {}
                self.lose(self.body(body, {}) or {}, "the loop may go on or end before it")
            case ir.Label():
                self.lose(waiting, "there is a label before it")
                return {}
        if isinstance(statement, _OTHER_MOTION):
            self.lose(waiting, "it is no move with settings of its own")
            return {}
        if leaves(statement):
            if not (isinstance(statement, ir.Return | ir.Halt) and self.outermost):
                self.lose(waiting, "the program goes elsewhere before it")
            return None
        if any(id(one) in self.movers for one in called(statement, self.editor.scope)):
            self.lose(waiting, "a routine that moves is called before it")
            return {}
        if isinstance(statement, ir.CallRoutine) and statement.dynamic is not None:
            self.lose(waiting, "a routine chosen at run time is called before it")
            return {}
        for one in waiting.values():
            one.changes = True
        return waiting

    def choice(self, ways: list[ir.Body], statement: ir.Statement, waiting: Waiting) -> Waiting | None:
        for one in waiting.values():
            one.changes = one.changes or bool(called(statement, self.editor.scope))
        ends = [end for end in (self.body(way, dict(waiting)) for way in ways) if end is not None]
        if not ends:
            return None
        for end in ends:
            for key, one in end.items():
                if any(other.get(key) is not one for other in ends):
                    one.lost = one.lost or "only some ways go through a move"
        return {key: one for key, one in ends[0].items() if all(end.get(key) is one for end in ends)}


class _Attach:
    """Puts the settings to their moves."""

    def __init__(self, editor: Editor, follow: _Follow) -> None:
        self.editor = editor
        self.follow = follow
        self.kept: dict[int, ir.Name] = {}
        self.told: set[tuple[int, int]] = set()  # source and line of what is refused

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def refused(self, statement: ir.SetForNextMove, reason: str) -> ir.Body:
        """One stop for all settings of one line of the source."""
        line = (id(statement.origin.source), statement.origin.line)
        if line in self.told:
            return ()
        if statement.origin.source is not None:
            self.told.add(line)
        setting = statement.setting
        name = setting.name.replace("_", " ") if isinstance(setting, ir.System) else "a setting"
        return (stopped(statement, UNCERTAIN, self.editor.context, setting=name, reason=reason),)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.SetForNextMove(value=value) if set_at_move(statement, self.editor.capabilities):
                pending = self.follow.every[id(statement)]
                if pending.lost:
                    return self.refused(statement, pending.lost)
                if pending.changes and not _fixed(value):
                    type = self.editor.type_of(value)
                    if type is None:
                        return (statement,)
                    kept = self.kept[id(statement)] = self.editor.temporary("for_next_move", type)
                    return expansion(statement.origin, (ir.Assign(kept, value),))
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.Move():
                given = [one for one in self.follow.taken.get(id(statement), ()) if not one.lost]
                if not given:
                    return (statement,)
                pairs = tuple(_pair(one.statement, self.kept.get(id(one.statement))) for one in given)
                own = [place for place, _ in statement.settings]
                added = tuple(pair for pair in pairs if pair[0] not in own)
                return (replace(statement, settings=(*statement.settings, *added)),)
        if blocks(statement):
            return (inside(statement, self.body),)
        return (statement,)


def _fixed(value: ir.Expression) -> bool:
    return is_constant(value) or isinstance(value, ir.EnumLiteral)


def _pair(statement: ir.SetForNextMove, kept: ir.Name | None) -> tuple[ir.Expression, ir.Expression]:
    setting, value = statement.setting, statement.value if kept is None else kept
    if isinstance(setting, ir.Magnitude):
        return setting.value, ir.Quantity(value, setting.unit)
    return setting, value
