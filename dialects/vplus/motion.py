"""V+ motion to IR: moves, the hand, and what stops or holds the robot.

A move goes on into the next one where it would begin to brake (continuous path), which is the neutral blend by speed
with 100 percent. Where a project switches that off and on, the modal variable `blending` decides instead.
"""

from __future__ import annotations

from rpl import ir
from rpl.reading.shapes import StatementError
from rpl.source import Origin

from . import signals, tables
from .expressions import root_name, subtree
from .split import code_of
from .statements import Instruction, Lowered, Statements

_MOVES = {
    "move": "joint", "moves": "linear", "movet": "joint", "movest": "linear", "movef": "joint", "movesf": "linear",
    "appro": "joint", "appros": "linear", "depart": "joint", "departs": "linear",
}  # fmt: skip
_HAND = frozenset(("open", "openi", "close", "closei", "relax", "relaxi"))


class Motion(Statements):
    """Lowers motion instructions."""

    def motion(self, given: Instruction) -> Lowered | None:
        """The statement(s) of a motion instruction; None when it is none."""
        if self.on_belt(given):
            return ir.Vendor("vplus", code_of(given.origin.text), "unknown", origin=given.origin)
        if given.word in _HAND:
            return self.hand(given.word, given.origin)
        match given.word:
            case "move" | "moves":
                return self.move(given, self.needed(given, 0, "a location"))
            case "movet" | "movest":
                return self.move_with_hand(given)
            case "movef" | "movesf":
                return self.fast_transfer(given)
            case "movec":
                return self.arc(given)
            case "appro" | "appros":
                place, distance = self.needed(given, 0, "a location"), self.needed(given, 1, "a distance")
                return self.move(given, approached(place, distance, given.origin))
            case "depart" | "departs":
                return self.depart(given, self.needed(given, 0, "a distance"))
            case "drive":
                return self.drive(given)
            case "ready" | "nest":
                return self.moved(ir.System("home_joints", origin=given.origin), "joint", given.origin)
            case "align":
                return self.align(given)
            case "delay":
                return ir.Wait(self.needed(given, 0, "a time"), in_position=True, origin=given.origin)
            case "break":
                return ir.WaitForMotion(origin=given.origin)
            case "brake":
                return ir.StopMotion(origin=given.origin), ir.ClearMotion(origin=given.origin)
        return None

    def on_belt(self, given: Instruction) -> bool:
        """Does a move follow a conveyor? Only the controller can do that yet."""
        if "%" not in given.origin.text or (given.word not in _MOVES and given.word not in ("movec", "here")):
            return False
        return any("%" in self.written(tree) for tree in given.operands if tree is not None)

    def blend(self) -> ir.Blend | None:
        """None: the modal variable says whether moves are joined."""
        return None if self.facts.joins_change else ir.BlendSpeed(ir.IntLiteral(100))

    def moved(
        self,
        target: ir.Expression,
        kind: str,
        origin: Origin,
        relative: str | None = None,
        speed: ir.Speed | None = None,
        via: ir.Expression | None = None,
    ) -> ir.Move:
        blend = self.blend()
        return ir.Move(kind, target, via=via, relative=relative, speed=speed, blend=blend, origin=origin)

    def move(self, given: Instruction, target: ir.Expression) -> ir.Move:
        return self.moved(target, _MOVES[given.word], given.origin)

    def move_with_hand(self, given: Instruction) -> Lowered:
        """MOVET place, hand: the hand opens (a positive number) or closes while the arm moves."""
        origin = given.origin
        move = self.move(given, self.needed(given, 0, "a location"))
        hand = self.needed(given, 1, "a number for the hand")
        match hand:
            case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
                return (*hand_triggers("open" if value > 0 else "close", origin), move)
            case ir.BoolLiteral():  # TRUE is -1, so both close
                return (*hand_triggers("close", origin), move)
        opens = ir.Binary(">", hand, ir.IntLiteral(0), origin=origin)
        branch = ir.If(((opens, hand_triggers("open", origin)),), hand_triggers("close", origin), origin=origin)
        return branch, move

    def fast_transfer(self, given: Instruction) -> Lowered:
        """MOVEF place, clearance away, clearance there: leave, cross over, arrive. M: the three parts blend into each
        other like moves do; what the controller gains by optimising them is not imitated."""
        origin, kind = given.origin, _MOVES[given.word]
        place = self.needed(given, 0, "a location")
        done: list[ir.Statement] = []
        away, there = self.operand(given, 1), self.operand(given, 2)
        if away is not None:
            done.append(self.depart_by(away, kind, origin))
        if there is not None:
            done.append(self.moved(approached(place, there, origin), kind, origin))
        return (*done, self.moved(place, kind, origin))

    def arc(self, given: Instruction) -> Lowered:
        """MOVEC via, place. M: the order of the two."""
        via, place = self.needed(given, 0, "a point on the way"), self.needed(given, 1, "a location")
        return self.moved(place, "circular", given.origin, via=via)

    def depart(self, given: Instruction, distance: ir.Expression) -> ir.Move:
        return self.depart_by(distance, _MOVES[given.word], given.origin)

    def depart_by(self, distance: ir.Expression, kind: str, origin: Origin) -> ir.Move:
        zero = ir.IntLiteral(0)
        back = negated(distance, origin)
        entries = (("x", zero), ("y", zero), ("z", back), ("a", zero), ("b", zero), ("c", zero))
        return self.moved(ir.Aggregate(entries, "pose", origin=origin), kind, origin, relative="tool")

    def drive(self, given: Instruction) -> Lowered:
        """DRIVE joint, change, speed."""
        origin = given.origin
        joint, change = self.needed(given, 0, "a joint"), self.needed(given, 1, "a change")
        percent = self.operand(given, 2)
        joint = signals.known(joint, self.facts)
        zero = ir.IntLiteral(0)
        if isinstance(joint, ir.IntLiteral):
            if not 1 <= joint.value <= 6:
                return ir.Vendor("vplus", code_of(origin.text), "unknown", origin=origin)
            entries = tuple((f"j{number}", change if number == joint.value else zero) for number in range(1, 7))
        else:
            entries = tuple((f"j{number}", _where(joint, number, change, origin)) for number in range(1, 7))
        speed = ir.Speed(joint=percent) if percent is not None else None
        return self.moved(ir.Aggregate(entries, "joints", origin=origin), "joint", origin, "joints", speed)

    def align(self, given: Instruction) -> Lowered:
        """ALIGN: turn the tool until its z axis is parallel to the nearest axis of the world."""
        here = ir.Builtin("pose_of", (ir.System("end_pose", origin=given.origin),), origin=given.origin)
        target = ir.Builtin("aligned", (here,), origin=given.origin)
        return self.moved(target, "joint", given.origin)

    def hand(self, word: str, origin: Origin) -> tuple[ir.Statement, ...]:
        """OPEN and the like act when the next move begins; OPENI at once behind the present one, then wait."""
        if not word.endswith("i"):
            return hand_triggers(word, origin)
        switched = hand_outputs(word[:-1], origin)
        seconds = self.facts.hand_time_s
        wait: ir.Statement = ir.Vendor("vplus", word.upper(), "unknown", origin=origin)
        if seconds is not None:
            wait = ir.Wait(ir.RealLiteral(seconds), origin=origin)
        return ir.WaitForMotion(origin=origin), *switched, wait

    def here(self, given: Instruction) -> Lowered:
        """HERE place: store where the robot is."""
        tree = given.operands[0] if given.operands else None
        if tree is None:
            raise StatementError("HERE needs a location variable", 0)
        origin = given.origin
        name = root_name(self.place(tree)) if tree.data == "reference" else None
        if name is not None and name.startswith("#"):
            return ir.Assign(self.place(tree), ir.Builtin("current_joints", (), origin=origin), origin=origin)
        here = ir.Builtin("pose_of", (ir.Builtin("current_target", (), origin=origin),), origin=origin)
        return self.stored(subtree(tree), here, origin)


def _where(joint: ir.Expression, number: int, change: ir.Expression, origin: Origin) -> ir.Expression:
    """The change for the joint of this number, 0 for the others."""
    same = ir.Convert("bit", ir.Binary("=", joint, ir.IntLiteral(number), origin=origin), origin=origin)
    return ir.Binary("*", change, same, origin=origin)


def approached(place: ir.Expression, distance: ir.Expression, origin: Origin) -> ir.Expression:
    """A place moved back along its own z axis."""
    zero = ir.IntLiteral(0)
    return ir.Builtin("tool_offset", (place, zero, zero, negated(distance, origin)), origin=origin)


def negated(value: ir.Expression, origin: Origin) -> ir.Expression:
    match value:
        case ir.Unary(op="-", operand=operand):
            return operand
    return ir.Unary("-", value, origin=origin)


def hand_outputs(word: str, origin: Origin) -> tuple[ir.Assign, ...]:
    """Both solenoids of the hand as OPEN, CLOSE or RELAX want them."""
    states = ((tables.HAND_OPEN, word == "open"), (tables.HAND_CLOSE, word == "close"))
    return tuple(
        ir.Assign(ir.Signal("digital_out", ir.IntLiteral(number), origin=origin), ir.BoolLiteral(on), origin=origin)
        for number, on in sorted(states, key=lambda state: state[1])
    )


def hand_triggers(word: str, origin: Origin) -> tuple[ir.Statement, ...]:
    """The hand acts when the next move begins."""
    return tuple(ir.Trigger("start", action, origin=origin) for action in hand_outputs(word, origin))


__all__ = ["Motion"]
