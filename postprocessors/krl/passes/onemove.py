"""What one move is to be driven with: KRL's speeds are modal, so it is set before the move and set back behind it.

The value to go back to is the constant that the settings are known to have there, or else it is kept in a variable.
Only what the kind of move is driven by is set. A least duration has no modal counterpart and is named.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.settingwords import DROPPED, USUAL
from rpl.passes.legalise.stages import legalising

_JOINT = frozenset(("joint_speed", "joint_acceleration"))
_PATH = frozenset(
    ("path_speed", "swivel_speed", "twist_speed", "path_acceleration", "swivel_acceleration", "twist_acceleration")
)
_TURNING = frozenset(("orientation_mode", "circle_orientation"))


@legalising()
def settings_of_one_move(program: ir.Program, context: Context) -> ir.Program:
    """Moves with settings of their own, but for spline moves, which have them in KRL."""
    flow = SettingsInForce.begun_by(program, context.source)
    reported: set[str] = set()
    always = _said_by_all(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        worker = _Around(editor, flow, reported, always)
        return edit_bodies(routine, worker.body)

    return edit_routines(program, context, work)


def _said_by_all(program: ir.Program) -> frozenset[str]:
    """Settings that each move which is driven by them says itself, and that nothing else asks for or sets: nothing has
    to be set back behind a move."""
    found = _JOINT | _PATH
    for node in walk_for({"Move", "Spline", "MoveExternal", "Vendor", "Opaque"}, *program.modules):
        match node:
            case ir.Move(motion_class="classic", kind=kind, settings=settings):
                own = {place.name for place, _ in settings if isinstance(place, ir.System)}
                found -= (_JOINT if kind == "joint" else _PATH) - own
                found -= {one.name for _, value in settings for one in walk(value) if isinstance(one, ir.System)}
            case ir.Move() | ir.Spline() | ir.MoveExternal() | ir.Vendor() | ir.Opaque():
                return frozenset()
    asked = Counter(node.name for node in walk_for({"System"}, *program.modules) if isinstance(node, ir.System))
    moves = (node for node in walk_for({"Move"}, *program.modules) if isinstance(node, ir.Move))
    asked.subtract(place.name for move in moves for place, _ in move.settings if isinstance(place, ir.System))
    return frozenset(name for name in found if not asked[name])


class _Around:
    def __init__(self, editor: Editor, flow: SettingsInForce, reported: set[str], always: frozenset[str]) -> None:
        self.editor, self.flow, self.reported, self.always = editor, flow, reported, always

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Move) and statement.motion_class == "classic":
            statement = self.turned(statement)
            if statement.settings:
                return self.move(statement)
        return (inside(statement, self.body),)

    def turned(self, move: ir.Move) -> ir.Move:
        """How the tool turns on the way, as settings."""
        own = {"orientation_mode": move.orientation, "circle_orientation": move.circle_orientation}
        can = self.editor.capabilities.system_variables
        added = tuple(
            (ir.System(name), ir.EnumLiteral(word))
            for name, word in own.items()
            if word is not None and name in can and word != USUAL[name]
        )
        if not any(own.values()) or not can.issuperset(own):
            return move
        return replace(move, settings=(*move.settings, *added), orientation=None, circle_orientation=None)

    def move(self, move: ir.Move) -> ir.Body:
        used = _JOINT | _TURNING if move.kind == "joint" else _PATH | _TURNING
        here, later = move.origin, replace(move.origin, comments=())
        before: list[ir.Statement] = []
        behind: list[ir.Statement] = []
        for place, value in move.settings:
            name = place.name if isinstance(place, ir.System) else ""
            if name in _JOINT | _PATH | _TURNING and name in self.editor.capabilities.system_variables:
                if name in used:
                    self.around(ir.System(name), value, move, before, behind)
            elif name not in self.reported:
                self.reported.add(name)
                self.editor.context.diagnostics.report(DROPPED, move.origin, name=name.replace("_", " ") or "a setting")
        done = replace(move, settings=(), origin=later if before else here)
        first = [replace(one, origin=later if at else here) for at, one in enumerate(before)]
        return (*first, done, *(replace(one, origin=later) for one in behind))

    def around(
        self,
        place: ir.System,
        value: ir.Expression,
        move: ir.Move,
        before: list[ir.Statement],
        behind: list[ir.Statement],
    ) -> None:
        if place.name in self.always:
            before.append(ir.Assign(place, value))
            return
        old = self.flow.at(move).get(place.name)
        if place.name in _TURNING:
            old = ir.EnumLiteral(USUAL[place.name])
        if old is None:
            kept = self.editor.temporary(f"old_{place.name}", ir.RealType())
            one = replace(place, indices=(ir.IntLiteral(1),)) if place.name.startswith("joint") else place
            before.append(ir.Assign(kept, one))
            old = kept
        before.append(ir.Assign(place, value))
        behind.append(ir.Assign(place, old))


__all__ = ["settings_of_one_move"]
