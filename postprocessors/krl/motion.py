"""IR moves as the words of KRL: words, blends, relative moves, the settings of spline moves."""

from __future__ import annotations

from rpl import ir
from rpl.writing.statements import CannotSayError

from .expressions import Expressions
from .settings import assignment, coupled, grouped

_WORDS = {
    ("joint", "classic"): "PTP",
    ("linear", "classic"): "LIN",
    ("circular", "classic"): "CIRC",
    ("joint", "spline"): "SPTP",
    ("linear", "spline"): "SLIN",
    ("circular", "spline"): "SCIRC",
    ("spline", "spline"): "SPL",
}


Words = dict[str, object]  # of a macro


class Motion:
    """The words of moves inside of one scope."""

    def __init__(self, expressions: Expressions) -> None:
        self.expressions = expressions

    def move(self, move: ir.Move) -> Words:
        word = _WORDS.get((move.kind, move.motion_class))
        if word is None:
            raise CannotSayError(f"KRL has no {move.motion_class} {move.kind} move")
        self.refuse(move)
        relative, axes = self.relative(move)
        words: Words = {"word": word, "relative": relative, "reference": axes, "via": "", "angle": ""}
        words["target"] = self.expressions.stored(move.target)
        if move.kind == "circular":
            if move.via is None:
                raise CannotSayError("a circle needs an auxiliary point")
            words["via"] = self.expressions.stored(move.via)
            if move.swept is not None:
                words["angle"] = self.expressions.text(move.swept)
        words["blend"] = self.blend(move.blend)
        words["settings"] = self.settings(move.settings)
        return words

    def refuse(self, move: ir.Move) -> None:
        """Settings that the passes before should have made modal, and those that KRL does not have at a move."""
        left = {
            "a tool of its own": move.tool,
            "a frame of its own": move.frame,
            "a load of its own": move.load,
            "a speed of its own": move.speed,
            "an acceleration of its own": move.acceleration,
            "an orientation mode of its own": move.orientation or move.circle_orientation,
            "a search": move.search,
            "triggers of its own": move.triggers or None,
        }
        for what, value in left.items():
            if value is not None:
                raise CannotSayError(f"a move with {what}")

    def relative(self, move: ir.Move) -> tuple[str, str]:
        match move.relative:
            case None:
                return "", ""
            case "joints":
                return "_REL", ""
            case "base" if move.kind != "joint" or not self.shows_joints(move.target):
                return "_REL", " #BASE" if move.kind == "joint" else ""
            case "tool":
                return "_REL", " #TOOL"
        raise CannotSayError(f"a move relative to {move.relative}")

    def shows_joints(self, target: ir.Expression) -> bool:
        return isinstance(self.expressions.type(target), ir.JointsType)

    def blend(self, blend: ir.Blend | None) -> str:
        match blend:
            case None | ir.BlendStop():
                return ""
            case ir.BlendPercent(percent=ir.System(name="blend_joint"), path=path):
                return " C_PTP" + self.blend(path)
            case ir.BlendSpeed(percent=ir.System(name="blend_speed")):
                return " C_VEL"
            case ir.BlendDistance(distance=distance, rotation=rotation):
                words = ""
                if distance is not None or rotation is None:
                    self.modal(distance, "blend_distance")
                    words = " C_DIS"
                if rotation is not None:
                    self.modal(rotation, "blend_rotation")
                    words += " C_ORI"
                return words
        raise CannotSayError("a blend whose size is not the modal one")

    def modal(self, size: ir.Expression | None, name: str) -> None:
        if size is not None and not (isinstance(size, ir.System) and size.name == name):
            raise CannotSayError("a blend whose size is not the modal one")

    def settings(self, settings: tuple[tuple[ir.Expression, ir.Expression], ...]) -> list[str]:
        if not settings:
            return []
        base = coupled(settings, self.expressions)
        shown = ["$BASE=EK({place},{kind},{frame})".format(**base[0])] if base is not None else []
        for target, value in grouped(settings[base[1] :] if base is not None else settings):
            if isinstance(target, str):
                shown.append(f"{target}={self.expressions.text(value)}")
            else:
                shown.append(assignment(ir.Assign(target, value), self.expressions))
        return shown

    def path_rule(self, rule: ir.PathRule) -> Words:
        """A line of a spline block about its speeds."""
        what, _, edge = rule.rule.partition("_")
        words: Words = {"rule": "TIME_BLOCK", "edge": edge.upper(), "value": "", "from_start": False}
        if rule.value is None:
            return words
        if what == "constant":
            words |= {"rule": "CONST_VEL", "from_start": rule.reference == "start"}
            return words | {"value": self.expressions.measured(rule.value, "mm")}
        measured = edge == "end"
        return words | {
            "value": self.expressions.measured(rule.value, "s") if measured else self.expressions.text(rule.value)
        }

    def spline(self, spline: ir.Spline) -> tuple[Words, Words]:
        """The words of the first and of the last line of a spline block."""
        word = "PTP_SPLINE" if spline.kind == "joint" else "SPLINE"
        head: Words = {"word": word, "settings": self.settings(spline.settings)}
        return head, {"blend": self.blend(spline.blend)}
