"""Modal settings as V+ steps: SPEED, ACCEL, DURATION, FINE, CPON, postures, TOOL and BASE.

The reader makes two or three settings of one SPEED (joints, path, turning); side by side they become one again.
"""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.passes import rigid
from rpl.writing.statements import CannotSayError

from . import spelling, tables
from .expressions import Expressions
from .units import scaled

_SPEEDS = ("joint_speed", "path_speed", "swivel_speed")
Setting = ir.Assign | ir.SetForNextMove


def parts(setting: ir.Statement) -> tuple[str, ir.Expression, bool] | None:
    """Name, value, and whether it stays."""
    match setting:
        case ir.Assign(target=ir.System(name=name), value=value):
            return name, value, True
        case ir.SetForNextMove(setting=ir.System(name=name), value=value):
            return name, value, False
    return None


def speed(body: Sequence[ir.Statement], expressions: Expressions) -> tuple[str, int] | None:
    """One SPEED of the settings at the head of a body, and how many there are."""
    found: list[tuple[ir.Expression, bool]] = []
    for statement, name in zip(body, _SPEEDS, strict=False):
        known = parts(statement)
        if known is None or known[0] != name or (found and known[2] != found[0][1]):
            break
        found.append((known[1], known[2]))
    if len(found) < 2:
        return None
    always = " ALWAYS" if found[0][1] else ""
    joint, path = found[0][0], found[1][0]
    if len(found) == 3:
        turning = _share(found[2][0], tables.FULL_ROTATION_SPEED_DEG_S, expressions)
        if _share(path, tables.FULL_PATH_SPEED_MM_S, expressions) == expressions.text(joint):
            shown = expressions.text(joint)
            return f"SPEED {shown}{f', {turning}' if turning != shown else ''}{always}", 3
        return f"SPEED {expressions.text(path)}, {turning} MMPS{always}", 3
    return f"SPEED {expressions.text(path)} MMPS{always}", 2


def _share(value: ir.Expression, full: float, expressions: Expressions) -> str:
    """A speed as percent of the full one."""
    known = expressions.known(value)
    if known is not None:
        return spelling.number(known * 100.0 / full, 9)
    return expressions.text(scaled(value, 100.0 / full))


def acceleration(body: Sequence[ir.Statement], expressions: Expressions) -> tuple[str, int] | None:
    """ACCEL up, down."""
    names = ("acceleration_percent", "deceleration_percent")
    values = []
    for statement, name in zip(body, names, strict=False):
        known = parts(statement)
        if known is None or known[0] != name or not known[2]:
            break
        values.append(expressions.text(known[1]))
    return (f"ACCEL {', '.join(values)}", len(values)) if values else None


def setting(name: str, value: ir.Expression, always: bool, expressions: Expressions) -> list[str]:
    """The step(s) that set one variable."""
    text, ending = expressions.text, " ALWAYS" if always else ""
    match name:
        case "tool" | "base":
            if not always:
                raise CannotSayError(f"a {name} for one move")
            return [_base(value, expressions) if name == "base" else f"TOOL {text(value)}"]
        case "override":
            return [f"SPEED {text(value)} MONITOR"]
        case "deceleration_percent":
            return [f"ACCEL , {text(value)}"]
        case "move_duration":
            return [f"DURATION {expressions.measured(value, 's')}{ending}"]
        case "blending" if isinstance(value, ir.BoolLiteral):
            return [f"{'CPON' if value.value else 'CPOFF'}{ending}"]
        case "scale_acceleration" if isinstance(value, ir.BoolLiteral):
            return [f"{'ENABLE' if value.value else 'DISABLE'} SCALE.ACCEL"]
        case "end_tolerance":
            known = expressions.known(value)
            if known is not None and known > 100.0:
                return [f"COARSE {spelling.number(known / tables.COARSE_FACTOR, 9)}{ending}"]
            return [f"FINE {text(value)}{ending}"]
        case "joint_speed":  # path speeds stand at their moves
            return [f"SPEED {text(value)}{ending}"]
        case "path_speed":
            return [f"SPEED {text(value)} MMPS{ending}"]
        case "posture_shoulder" | "posture_elbow" | "posture_wrist" if isinstance(value, ir.EnumLiteral):
            word = tables.POSTURES.get((name, value.member.lower()))
            if word is not None:
                return [word]
    raise CannotSayError(f"there is no setting for {name.replace('_', ' ')}")


def _base(frame: ir.Expression, expressions: Expressions) -> str:
    """BASE says how the robot was moved, which is the inverse of the frame; M: a location says the same."""
    match frame:
        case ir.System(name="null_frame"):
            return "BASE"
        case ir.Builtin(function="inverse", arguments=(ir.Aggregate(entries=entries),)):
            x, y, z, turn, *others = (value for _, value in entries)
            if all(expressions.known(one) == 0 for one in others):
                return f"BASE {', '.join(map(expressions.text, (x, y, z, turn)))}"
        case ir.Builtin(function="inverse", arguments=(place,)):
            return f"BASE {expressions.text(place)}"
        case ir.Aggregate(entries=entries) if len(entries) == 6:
            x, y, z, turn, *others = (value for _, value in entries)
            known = [expressions.known(one) for one in (x, y, z, turn)]
            if any(expressions.known(one) != 0 for one in others):
                raise CannotSayError("a base that is tilted")
            if known[3] == 0:
                back = [value.operand if isinstance(value, ir.Unary) else ir.Unary("-", value) for value in (x, y, z)]
                parts = (one if at is None else -at for one, at in zip(back, known, strict=False))
                return f"BASE {', '.join(_shown(one, expressions) for one in parts)}, 0"
            if None not in known:
                at = rigid.Vector(*(one or 0.0 for one in known[:3]))
                moved = rigid.Pose(at, rigid.rotation_of_turns((3, known[3] or 0.0))).inverse.position
                numbers = (moved.x, moved.y, moved.z, -(known[3] or 0.0))
                return f"BASE {', '.join(_shown(one, expressions) for one in numbers)}"
    return f"BASE INVERSE({expressions.text(frame)})"


def _shown(value: ir.Expression | float, expressions: Expressions) -> str:
    return spelling.number(value + 0.0, 9) if isinstance(value, float | int) else expressions.text(value)
