"""TP motion to IR: J, L, C, A, S with their speeds, terminations and options."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from lark import Tree

from rpl import ir
from rpl.controllerfiles import controller_named
from rpl.diagnostics import Severity, code
from rpl.reading.pieces import Open
from rpl.reading.shapes import StatementError, SyntaxTree

from . import modal, tables
from .expressions import Typed
from .statements import HIT, Lowered, Many, Statements

OTHER_FRAME = code(
    "tp-other-frame",
    Severity.WARNING,
    "P[{number}] was recorded with {name} {recorded}, but {active} is active here; controllers stop there"
    " (a run goes on with the active one)",
    "record the point again or select {name} {recorded}",
)
NOT_TAUGHT = code(
    "tp-untaught-position",
    Severity.WARNING,
    "P[{number}] was never taught; the controller stops at this move",
    "teach the position or take the move out",
)
MISSING_POSITION = code(
    "tp-missing-position",
    Severity.WARNING,
    "this listing has no position P[{number}]; the controller stops at this move",
)
SECOND_ARM = code(
    "tp-second-arm",
    Severity.WARNING,
    "P[{number}] has places of two arms, in groups 1 and {group}; one arm is driven here, and a run stops at this move",
    "give each arm a program of its own",
)
KINDS = {"J": "joint", "L": "linear", "C": "circular", "A": "linear", "S": "spline"}


@dataclass(slots=True)
class Options:
    """What stands behind a move's first point."""

    second: Typed | None = None
    speed: ir.Speed | None = None
    speed_text: str = ""
    path_speed: ir.Expression | None = None
    blend: ir.Blend | None = None
    cnt: ir.Expression | None = None
    acceleration: ir.Expression | None = None
    offsets: list[tuple[str, Typed]] = field(default_factory=list)  # for the point that stands before them
    via_offsets: list[tuple[str, Typed]] = field(default_factory=list)
    triggers: list[ir.Trigger] = field(default_factory=list)
    nested: tuple[str, ir.Expression] | None = None
    skip: tuple[bool, SyntaxTree, tuple[Typed, Typed] | None] | None = None
    incremental: bool = False
    orientation: str | None = None
    vendor: list[tuple[str, str]] = field(default_factory=list)
    coordinated: bool = False
    remote: bool = False


class Motion(Statements):
    """Lowers motion statements."""

    def on_motion(self, tree: SyntaxTree) -> Lowered:
        letter = str(tree.children[0]).upper()
        first = self.checked(self.typed(_tree(tree.children[1])), _tree(tree.children[1]))
        options = Options()
        for part in tree.children[2:]:
            self.option(_tree(part), options)
        if options.cnt is not None:
            options.blend = self.cnt_blend(letter, options)
        move = self.move(letter, first, options)
        before = tuple(self.vendor(text, effect) for text, effect in options.vendor if effect == "tuning")
        unknown = tuple(self.vendor(text, effect) for text, effect in options.vendor if effect != "tuning")
        if options.nested is not None:
            if before or unknown or options.skip:
                raise StatementError("point logic cannot stand beside these options", 0)
            return Open("point logic", (move, options.nested), self.origin)
        return self.one_or_many((*before, *unknown, move, *self.after(options)))

    def one_or_many(self, items: Many) -> Lowered:
        return items[0] if len(items) == 1 else items

    # ---- options

    def option(self, tree: SyntaxTree, options: Options) -> None:
        method: Callable[[SyntaxTree, Options], None] = getattr(self, f"part_{tree.data}")
        method(tree, options)

    def part_second_point(self, tree: SyntaxTree, options: Options) -> None:
        if options.second is not None:
            raise StatementError("a move has at most two positions", 0)
        options.second = self.checked(self.typed(_tree(tree.children[0])), _tree(tree.children[0]))
        options.via_offsets, options.offsets = options.offsets, []

    def part_speed(self, tree: SyntaxTree, options: Options) -> None:
        value, unit = self.number(_tree(tree.children[0])), str(tree.children[1]).lower()
        if unit not in tables.UNITS:
            raise StatementError(f"{unit} is no unit of speed", 0)
        name, factor = tables.UNITS[unit]
        quantity = ir.Quantity(value, factor, origin=self.origin) if factor else value
        if name == "path":
            options.path_speed = quantity
        options.speed_text = unit
        options.speed = ir.Speed(**{name: quantity})

    def part_max_speed(self, tree: SyntaxTree, options: Options) -> None:
        word = str(tree.children[0]).lower()
        if word in tables.ONLY_CONTROLLER_SPEEDS:
            value: ir.Expression = ir.VendorValue("tp", str(tree.children[0]), ir.RealType(), origin=self.origin)
        else:
            value = ir.RealLiteral(tables.MAX_SPEED_MM_S, origin=self.origin)
        options.speed_text, options.path_speed = word, value
        options.speed = ir.Speed(path=value)

    def part_fine(self, tree: SyntaxTree, options: Options) -> None:
        options.blend = ir.BlendStop()

    def part_cnt(self, tree: SyntaxTree, options: Options) -> None:
        options.cnt = self.number(_tree(tree.children[-1]))

    def part_corner(self, tree: SyntaxTree, options: Options) -> None:
        """CR and CD: a distance in mm before the corner."""
        options.blend = ir.BlendDistance(self.number(_tree(tree.children[1])))

    def part_acc(self, tree: SyntaxTree, options: Options) -> None:
        options.acceleration = self.number(_tree(tree.children[-1]))

    def part_offset(self, tree: SyntaxTree, options: Options) -> None:
        word = "tool_offset" if str(tree.children[0]).lower().startswith("tool") else "offset"
        if len(tree.children) > 1:
            given = self.typed(_tree(tree.children[1]))
        else:
            known = modal.OFFSET if word == "offset" else modal.TOOL_OFFSET
            if known not in self.offsets:
                raise StatementError(f"no {word.upper()} CONDITION stands before this move", 0)
            given = Typed(ir.Name(known), self.offsets[known])
        if given.kind not in ("p", "j"):
            raise StatementError("an offset is a position register", 0)
        options.offsets.append((word, given))

    def part_vision_offset(self, tree: SyntaxTree, options: Options) -> None:
        options.vendor.append((self.written(r"VOFFSET[^ ]*(?:\s*\[[^\]]*\])?"), "unknown"))

    def part_skip(self, tree: SyntaxTree, options: Options) -> None:
        jumps = str(tree.children[0]).lower() == "skipjump"
        latch = None
        if len(tree.children) > 2:
            latch = (self.typed(_tree(tree.children[2])), self.typed(_tree(tree.children[3])))
        options.skip = (jumps, _tree(tree.children[1]), latch)

    def part_time_trigger(self, tree: SyntaxTree, options: Options) -> None:
        word = str(tree.children[0]).upper()
        time = self.number(_tree(tree.children[1]))
        self.unit(tree.children[2], "sec", "s")
        before = word.endswith(("TB", "BEFORE"))
        delay = _negative(time) if before else time
        self.trigger(_tree(tree.children[-1]), options, None, delay, word)

    def part_distance_trigger(self, tree: SyntaxTree, options: Options) -> None:
        distance = self.number(_tree(tree.children[1]))
        self.unit(tree.children[2], "mm")
        self.trigger(_tree(tree.children[-1]), options, _negative(distance), None, "DB")

    def trigger(
        self,
        action: SyntaxTree,
        options: Options,
        distance: ir.Expression | None,
        delay: ir.Expression | None,
        word: str,
    ) -> None:
        if action.data == "nested":
            if delay is None:
                raise StatementError("point logic starts by a time", 0)
            options.nested = (word, delay)
            return
        (done,) = self.action(action)
        if isinstance(done, ir.Pulse):
            on = ir.Assign(done.signal, done.value, origin=self.origin)
            options.triggers.append(ir.Trigger("end", on, distance, delay, origin=self.origin))
            off = ir.Assign(done.signal, ir.BoolLiteral(False), origin=self.origin)
            later = done.duration if delay is None else _sum(delay, done.duration)
            options.triggers.append(ir.Trigger("end", off, distance, later, origin=self.origin))
            return
        if not isinstance(done, ir.Assign | ir.CallRoutine):
            raise StatementError("only an assignment or a call can be started on the way", 0)
        options.triggers.append(ir.Trigger("end", done, distance, delay, origin=self.origin))

    def part_external_velocity(self, tree: SyntaxTree, options: Options) -> None:
        """EV and Ind.EV: speed of extended axes in percent."""
        self.number(_tree(tree.children[1]))
        options.vendor.append((self.written(r"(?:\bInd\.)?\bEV\s*[^%]*%"), "tuning"))

    def part_coordinated(self, tree: SyntaxTree, options: Options) -> None:
        options.coordinated = True

    def part_flag_option(self, tree: SyntaxTree, options: Options) -> None:
        word = str(tree.children[0])
        match word.lower():
            case "inc":
                options.incremental = True
            case "wjnt":
                options.orientation = "wrist"
            case "rtcp":
                options.remote = True
            case lower:
                options.vendor.append((word, "tuning" if lower in tables.HARMLESS_OPTIONS else "unknown"))

    def part_number_option(self, tree: SyntaxTree, options: Options) -> None:
        self.number(_tree(tree.children[1]))
        word = str(tree.children[0])
        text = self.written(rf"\b{word}\s*\S+")
        options.vendor.append((text, "tuning" if word.lower() in tables.HARMLESS_NUMBERS else "unknown"))

    def part_other_option(self, tree: SyntaxTree, options: Options) -> None:
        name = str(tree.children[0]).partition("[")[0].strip()
        options.vendor.append((self.written(rf"\b{re.escape(name)}(?:\s*\[[^\]]*\])?"), "unknown"))

    # ---- the move

    def cnt_blend(self, letter: str, options: Options) -> ir.Blend:
        """CNT n. Between path moves the corner begins where the overlap of their ramps does (controller.toml): a
        distance that grows with speed."""
        percent = options.cnt
        assert percent is not None
        if letter == "J" or options.path_speed is None:
            return ir.BlendPercent(percent)
        if not isinstance(percent, ir.IntLiteral | ir.RealLiteral):
            return ir.BlendPercent(percent)
        controller = controller_named("tp")
        effort = options.acceleration
        share = float(effort.value) / 100.0 if isinstance(effort, ir.IntLiteral | ir.RealLiteral) else 1.0
        speed, number, most = options.path_speed, float(percent.value), max(share, 0.01)
        match speed:
            case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
                size = controller.overlap_distance_mm(number, float(value), most)
            case ir.Quantity(value=ir.IntLiteral(value=value) | ir.RealLiteral(value=value), unit=unit):
                size = controller.overlap_distance_mm(number, float(value) * ir.UNITS[unit], most)
            case _:
                size = controller.overlap_distance_mm(number, 1.0, most)
                seconds = ir.RealLiteral(round(size, 6))
                return ir.BlendPercent(percent, ir.BlendDistance(ir.Binary("*", speed, seconds, origin=self.origin)))
        if size == 0.0:
            return ir.BlendPercent(percent)
        distance: ir.Expression = ir.RealLiteral(round(size, 3))
        return ir.BlendPercent(percent, ir.BlendDistance(distance))

    def move(self, letter: str, first: Typed, options: Options) -> ir.Move:
        via, goal = (first, options.second) if letter == "C" else (None, first)
        if letter == "C" and goal is None:
            raise StatementError("C needs two positions: the second stands on the line behind", 0)
        if letter != "C" and options.second is not None:
            raise StatementError("only C takes two positions", 0)
        assert goal is not None
        if options.speed is None:
            raise StatementError("the move has no speed", 0)
        if letter == "J" and options.path_speed is not None and options.speed_text != "max_speed":
            raise StatementError("J takes a speed in percent or a time", 0)
        if letter != "J" and options.speed.joint is not None:
            raise StatementError("only J takes a speed in percent", 0)
        speed = options.speed
        if letter == "J" and options.path_speed is not None:
            speed = ir.Speed(joint=ir.IntLiteral(100, origin=self.origin))
        kind = KINDS[letter]
        return ir.Move(
            kind,
            self.displaced(goal, options.offsets),
            via=self.displaced(via, options.via_offsets) if via is not None else None,
            relative=("joints" if goal.kind == "j" else "base") if options.incremental else None,
            speed=speed,
            acceleration=options.acceleration,
            blend=options.blend or ir.BlendStop(),
            orientation=options.orientation,
            tool=self.fixed_frame("UTOOL"),
            frame=self.fixed_frame("UFRAME"),
            triggers=tuple(options.triggers),
            search=self.search(options),
            settings=_settings(options),
            origin=self.origin,
        )

    def displaced(self, point: Typed, offsets: list[tuple[str, Typed]]) -> ir.Expression:
        """Offset is added component by component in the selected user frame, W, P and R too; Tool_Offset is composed in
        the position's own axes, rotations too (both measured on virtual controllers, CrossArm). A joint offset is added
        to the joints."""
        node, kind = point.node, point.kind
        for word, offset in offsets:
            if offset.kind == "j":
                joints = self.position(Typed(node, kind), "j")
                node = ir.Builtin("element_sum", (joints, offset.node), origin=self.origin)
                kind = "j"
                continue
            node, kind = self.position(Typed(node, kind), "p"), "p"
            if word == "offset":
                node = ir.Builtin("element_sum", (node, offset.node), origin=self.origin)
            else:
                pose = ir.Builtin("pose_of", (offset.node,), origin=self.origin)
                node = ir.Builtin("displaced_in_tool", (node, pose), origin=self.origin)
        return node

    def search(self, options: Options) -> ir.Search | None:
        if options.skip is None:
            return None
        self.modal.setdefault(modal.SKIP, [])
        latch = options.skip[2]
        found = latch[0].node if latch is not None and latch[1].kind == "p" and latch[0].kind == "p" else None
        return ir.Search(ir.Name(modal.SKIP), found, "stop", "rising", ir.Name(HIT, origin=self.origin))

    def after(self, options: Options) -> Many:
        """Skip,LBL[n]: without the condition the program jumps; SkipJump jumps with it."""
        if options.skip is None:
            return ()
        jumps, target, latch = options.skip
        hit: ir.Expression = ir.Name(HIT, origin=self.origin)
        made: list[ir.Statement] = []
        if latch is not None and not (latch[1].kind == "p" and latch[0].kind == "p"):
            value = self.position(latch[1], latch[0].kind)
            made.append(ir.If(((hit, (ir.Assign(latch[0].node, value, origin=self.origin),)),), origin=self.origin))
        condition = hit if jumps else ir.Unary("not", hit, origin=self.origin)
        made.append(ir.If(((condition, (self.jump(target),)),), origin=self.origin))
        return tuple(made)

    def checked(self, point: Typed, tree: SyntaxTree) -> Typed:
        if point.kind == "u" or point.kind not in ("p", "j"):
            raise StatementError("a move needs a position", 0)
        return point


def _settings(options: Options) -> tuple[tuple[ir.Expression, ir.Expression], ...]:
    """COORD and RTCP. M: of RTCP the selected user frame is the tool fixed in the room; positions stay those of the
    selected tool in that frame."""
    led = ((ir.System("coordinated"), ir.TextLiteral(tables.LEADER)),) if options.coordinated else ()
    return (*led, (ir.System("remote_tool"), ir.BoolLiteral(True))) if options.remote else led


def _sum(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    match one, other:
        case ((ir.IntLiteral() | ir.RealLiteral()), (ir.IntLiteral() | ir.RealLiteral())):
            return ir.RealLiteral(round(float(one.value) + float(other.value), 6), origin=one.origin)
    return ir.Binary("+", one, other, origin=one.origin)


def _negative(value: ir.Expression) -> ir.Expression:
    match value:
        case ir.IntLiteral(value=number):
            return ir.IntLiteral(-number, origin=value.origin)
        case ir.RealLiteral(value=given):
            return ir.RealLiteral(-given if given else 0.0, origin=value.origin)
    return ir.Unary("-", value, origin=value.origin)


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child
