"""IR moves as VAL3: movej, movel, movec with a point, a tool and a movement descriptor.

What has no name becomes data (`data.Store`); what is worked out at the movement is put into a helper datum in front of
it. A point has to hang on the frame of the movement: one that hangs elsewhere is copied into a helper that does.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.passes.fold import constant_number
from rpl.writing.statements import CannotSayError
from rpl.writing.text import number_text

from . import tables
from .data import UNLIMITED
from .expressions import Expressions, point_row

_BRAKING = ir.System("deceleration_percent")
_WORDS = {"joint": "movej", "linear": "movel", "circular": "movec"}


@dataclass(frozen=True, slots=True)
class MoveText:
    """What the template needs: lines in front, the instruction's word, its points, tool and descriptor."""

    before: tuple[str, ...]
    word: str
    points: tuple[str, ...]
    tool: str
    descriptor: str


class Motion:
    """Prints moves inside of one scope."""

    def __init__(self, expressions: Expressions) -> None:
        self.expressions, self.store = expressions, expressions.store
        self.before: list[str] = []

    def move(self, move: ir.Move) -> MoveText:
        self.refuse(move)
        self.before = []
        word = _WORDS.get(move.kind)
        if word is None:
            raise CannotSayError(f"there is no {move.kind} move")
        tool = self.hung(move.tool, "tool", "flange")
        joints = isinstance(self.expressions.type(move.target), ir.JointsType)
        if joints and move.kind != "joint":
            raise CannotSayError("a path movement to joint values")
        if joints:
            points = [self.joints(move.target)]
        else:
            frame = self.hung(move.frame, "frame", "world")
            self.expressions.around = (tool, "world")  # frames stand at the moves alone: none is in force
            points = [self.place(move.target, frame, "pMove")]
            if move.kind == "circular":
                if move.via is None:
                    raise CannotSayError("a circle needs its point on the way")
                points.insert(0, self.place(move.via, frame, "pVia"))
        self.expressions.around = None
        descriptor = self.descriptor(move)
        return MoveText(tuple(self.before), word, tuple(points), tool, descriptor)

    def refuse(self, move: ir.Move) -> None:
        for what, found in (
            ("a relative move", move.relative),
            ("a circle by its angle", move.swept),
            ("a load of its own", move.load),
            ("an orientation rule of its own", move.orientation not in (None, "variable")),
            ("a circle's orientation rule", move.circle_orientation not in (None, "base")),
            ("settings of its own", [one for one, _ in move.settings if one != _BRAKING]),
            ("actions on its path", move.triggers),
            ("a search", move.search),
            ("a motion group", move.group != 1),
            (f"{move.motion_class} motion", move.motion_class not in ("classic", "process")),
        ):
            if found:
                raise CannotSayError(f"a move with {what}")

    def hung(self, value: ir.Expression | None, role: str, root: str) -> str:
        """The name of the tool or frame; one that is worked out is put into a helper."""
        try:
            name = self.expressions.tool(value) if role == "tool" else self.expressions.frame(value)
        except CannotSayError:
            name = ""
        if value is not None and (not name or (role == "frame" and is_chosen(value))):  # None has a name
            name = self.store.helper("tMove" if role == "tool" else "fMove", role, root)
            self.before.append(f"{name}.trsf={self.expressions.text(value)}")
        return name

    def joints(self, target: ir.Expression) -> str:
        if isinstance(target, ir.Name | ir.Index):
            return self.expressions.storage(target)
        if isinstance(target, ir.Builtin):
            return self.expressions.text(target)
        known = dict(target.entries) if isinstance(target, ir.Aggregate) else {}
        numbers = [constant_number(part, self.expressions.scope) for part in known.values()]
        if all(number is not None for number in numbers):
            given = dict(zip(known, numbers, strict=True))
            row = " ".join(f'{name}="{number_text(given.get(name) or 0.0, 10)}"' for name in tables.JOINTS)
            return self.store.once("jPos", "jointRx", row)
        name = self.store.helper("jMove", "jointRx")
        self.before.append(f"{name}={self.expressions.text(target)}")
        return name

    def place(self, target: ir.Expression, frame: str, wish: str) -> str:
        """A point of the frame."""
        e = self.expressions
        if isinstance(target, ir.Aggregate):
            try:
                return self.store.once("pPoint", "pointRx", point_row(target, e.scope), frame)
            except CannotSayError:
                pass
        elif e.is_point(target) and e.father(target) == frame:
            return e.point(target)
        root = origin_of(target) if e.is_point(target) else None
        # A point whose configuration nothing sets keeps the one it is made with: as at the start of the movement.
        name = self.store.helper(wish if root is not None else f"{wish}Any", "pointRx", frame)
        self.before.append(f"{name}.trsf={e.text(target)}")
        if root is not None:
            self.before.append(f"{name}.config={e.storage(root)}.config")
        return name

    def strengths(self, move: ir.Move) -> tuple[float, float]:
        """Acceleration and deceleration, percent; as each other where only one is said."""
        scope = self.expressions.scope
        given = [move.acceleration, next((value for _, value in move.settings), None)]
        numbers = [None if one is None else constant_number(one, scope) for one in given]
        if any(one is not None and number is None for one, number in zip(given, numbers, strict=True)):
            raise CannotSayError("an acceleration that is worked out")
        up = 100.0 if numbers[0] is None else numbers[0]
        return up, up if numbers[1] is None else numbers[1]

    def descriptor(self, move: ir.Move) -> str:
        """The movement descriptor; components that are worked out are set in front."""
        speed, joint = move.speed or ir.Speed(), move.kind == "joint"
        wanted = speed.joint if joint else speed.path
        if wanted is None or speed.duration is not None or speed.profile is not None or speed.axis is not None:
            raise CannotSayError("a move without a speed of its kind")
        blend = "off"
        distance: ir.Expression = ir.IntLiteral(0)
        match move.blend:
            case None | ir.BlendStop():
                pass
            case ir.BlendDistance(distance=given) if given is not None:
                blend, distance = "joint" if joint else "Cartesian", given
            case _:
                raise CannotSayError("a corner is given by its distance")
        scope = self.expressions.scope
        share, leave = constant_number(wanted, scope), constant_number(distance, scope)
        if share is not None and leave is not None:
            if leave <= 0.0:
                blend = "off"
            up, down = self.strengths(move)
            vel, tmax = (share, UNLIMITED) if joint else (100.0, share)
            return self.store.descriptor(vel, tmax, blend, leave, (up, down))
        if move.acceleration is not None or move.settings:
            raise CannotSayError("a speed that is worked out beside an acceleration of its own")
        part = "vel" if joint else "tvel"
        name = self.store.helper(f"m{'J' if joint else 'L'}{blend.capitalize()[:5]}", "mdesc")
        self.store.data[name].values = [f'blend="{blend}"']
        self.before.append(f"{name}.{part}={self.expressions.text(wanted)}")
        for component in ("leave", "reach") if blend != "off" else ():
            self.before.append(f"{name}.{component}={self.expressions.text(distance)}")
        return name


def is_chosen(frame: ir.Expression) -> bool:
    """Does the run decide which frame of a list it is? A point hangs on one that is named in the data."""
    return isinstance(frame, ir.Index) and not all(isinstance(one, ir.IntLiteral) for one in frame.indices)


def origin_of(target: ir.Expression) -> ir.Expression | None:
    """The variable that a point's configuration is of."""
    match target:
        case ir.Name() | ir.Index():
            return target
        case ir.Builtin(function="current_target" | "joints_to_target") | ir.System():
            return None
        case ir.Builtin(arguments=(first, *_)):
            return origin_of(first)
    return None
