"""KRL motion to IR: moves of both generations (PTP, SPTP ...), spline blocks, path triggers.

What a move does not say stays None and is taken from the modal variables; a move without C_xxx stops exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lark import Token, Tree

from rpl import ir
from rpl.reading.pieces import Close, Open
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import Origin

from .expressions import Make, Pieces
from .statements import Build, Lowered, Pair, Pairs, Statements, code_text

_KINDS = {"ptp": "joint", "lin": "linear", "circ": "circular", "spl": "spline"}
_JOINT_COMPONENTS = frozenset(("a1", "a2", "a3", "a4", "a5", "a6"))
_AXES = 6


@dataclass(frozen=True, slots=True)
class Tail:
    """What stands behind a move's target."""

    blends: tuple[str, ...]
    axes: str | None  # BASE or TOOL of a relative move
    settings: Pairs


def _path_blend(words: tuple[str, ...], origin: Origin) -> ir.BlendDistance | ir.BlendSpeed | None:
    """C_DIS, C_ORI, C_VEL: alone or together (the first that is reached counts)."""
    distance = rotation = None
    for word in words:
        if word in ("C_DIS", "C_SPL"):
            distance = ir.System("blend_distance", origin=origin)
        elif word == "C_ORI":
            rotation = ir.System("blend_rotation", origin=origin)
        elif word == "C_VEL":
            return ir.BlendSpeed(ir.System("blend_speed", origin=origin))
    return ir.BlendDistance(distance, rotation) if distance or rotation else None


def blend_of(words: tuple[str, ...], origin: Origin) -> ir.Blend:
    """The blend of a move with these words behind it."""
    path = _path_blend(words, origin)
    if "C_PTP" in words:
        return ir.BlendPercent(ir.System("blend_joint", origin=origin), path)
    return path or ir.BlendStop()


class Motion(Statements):
    """Compiles motion statements."""

    def tail(self, tree: SyntaxTree) -> Tail:
        words: list[str] = []
        axes: str | None = None
        makes: list[Pairs] = []
        for part in tree.children:
            for child in _tree(part).children:
                if isinstance(child, Tree):
                    makes.append(self.setting(child))
                elif isinstance(child, Token) and child.type == "ENUM_LITERAL":
                    axes = child[1:].strip().upper()
                elif isinstance(child, Token) and child.type == "BLEND":
                    words.append(child.upper())
        if axes not in (None, "BASE", "TOOL"):
            raise StatementError(f"expected #BASE or #TOOL, not #{axes}", 0)

        def settings(pieces: Pieces, origin: Origin) -> list[Pair]:
            return _all_axes([pair for make in makes for pair in make(pieces, origin)])

        return Tail(tuple(words), axes, settings)

    def setting(self, tree: SyntaxTree) -> Pairs:
        target, value = _tree(tree.children[0]), _tree(tree.children[1])
        pairs = self.settings(target, value)
        if pairs is not None:
            return pairs
        place, given = self.reference(target), self.expression(value)
        return lambda pieces, origin: [(place(pieces, origin), given(pieces, origin))]

    def on_move(self, tree: SyntaxTree) -> Build:
        word = str(tree.children[0]).lower()
        target_tree, tail = _tree(tree.children[1]).children[0], self.tail(_tree(tree.children[2]))
        if isinstance(target_tree, Token):  # `!`: to be taught
            return lambda pieces, origin: ir.Vendor("krl", code_text(origin), "unknown", origin=origin)
        target = self.expression(_tree(target_tree))
        base_word, relative = word.removesuffix("_rel"), word.endswith("_rel")
        spline = base_word in ("sptp", "slin", "spl")
        kind = _KINDS[base_word if base_word == "spl" else base_word.removeprefix("s")]

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            goal = target(pieces, origin)
            return ir.Move(
                kind,
                goal,
                relative=self.relative(goal, kind, tail.axes) if relative else None,
                blend=blend_of(tail.blends, origin),
                settings=tuple(tail.settings(pieces, origin)),
                motion_class="spline" if spline else "classic",
                origin=origin,
            )

        return make

    def relative(self, goal: ir.Expression, kind: str, axes: str | None) -> str:
        """What a relative move's numbers are: joints, or a shift in the axes of the base or the tool."""
        if kind == "joint" and axes is None and self.is_joints(goal):
            return "joints"
        return (axes or "BASE").lower()

    def is_joints(self, goal: ir.Expression) -> bool:
        match goal:
            case ir.Aggregate(entries=entries, type_name=name):
                if name is not None:
                    return name.lower() in ("axis", "e6axis")
                return any((key or "").lower() in _JOINT_COMPONENTS for key, _ in entries)
            case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
                return self.facts.types.get(name.lower(), "") in ("axis", "e6axis")
            case ir.System(name=name):
                return name.endswith("_joints")
        return False

    def on_arc(self, tree: SyntaxTree) -> Build:
        word = str(tree.children[0]).lower()
        tail = self.tail(_tree(tree.children[-1]))
        via, target, *angle = [self.expression(_tree(child)) for child in tree.children[1:-1]]
        relative, spline = word.endswith("_rel"), word.startswith("s")

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            return ir.Move(
                "circular",
                target(pieces, origin),
                via=via(pieces, origin),
                swept=angle[0](pieces, origin) if angle else None,
                relative=(tail.axes or "BASE").lower() if relative else None,
                blend=blend_of(tail.blends, origin),
                settings=tuple(tail.settings(pieces, origin)),
                motion_class="spline" if spline else "classic",
                origin=origin,
            )

        return make

    def on_spline_open(self, tree: SyntaxTree) -> Build:
        kind = "joint" if str(tree.children[0]).upper().startswith("PTP") else "path"
        tail = self.tail(_tree(tree.children[1]))
        return lambda pieces, origin: Open("spline", (kind, tail.blends, tuple(tail.settings(pieces, origin))), origin)

    def on_spline_close(self, tree: SyntaxTree) -> Build:
        tail = self.tail(_tree(tree.children[0]))
        return lambda pieces, origin: Close("spline", tail.blends, origin)

    def on_time_block(self, tree: SyntaxTree) -> Build:
        """TIME_BLOCK START, PART=share, END=seconds."""
        edge = str(tree.children[0]).split()[-1].lower()
        value = self.expression(_tree(tree.children[1])) if len(tree.children) > 1 else None
        if (value is None) != (edge == "start"):
            raise StatementError(f"TIME_BLOCK {edge.upper()} {'takes no' if value else 'needs a'} value", 0)

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            given = value(pieces, origin) if value is not None else None
            if given is not None and edge == "end":
                given = ir.Quantity(given, "s", origin=origin)
            return ir.PathRule(f"time_{edge}", given, origin=origin)

        return make

    def on_const_vel(self, tree: SyntaxTree) -> Build:
        """CONST_VEL START=mm, END=mm, from the end of the next segment or its start (ONSTART)."""
        edge, value = str(tree.children[0]).split()[-1].lower(), self.expression(_tree(tree.children[1]))
        reference = "start" if len(tree.children) > 2 else "end"
        return lambda pieces, origin: ir.PathRule(f"constant_{edge}", value(pieces, origin), reference, origin=origin)

    def on_trigger(self, tree: SyntaxTree) -> Build:
        kind = str(tree.children[0]).upper()
        place = self.expression(_tree(tree.children[1]))
        from_start = False
        delay: Make | None = None
        priority: Make | None = None
        action: Callable[[Pieces, Origin], ir.Assign | ir.CallRoutine] | None = None
        position = 2
        while position < len(tree.children):
            child = tree.children[position]
            if isinstance(child, Token) and child.type == "ONSTART":
                from_start = True
            elif isinstance(child, Token) and child.type in ("DELAY", "PRIO"):
                position += 1
                value = self.expression(_tree(tree.children[position]))
                delay, priority = (value, priority) if child.type == "DELAY" else (delay, value)
            else:
                action = self.action(_tree(child))
            position += 1
        if action is None:
            raise StatementError("the trigger does nothing", 0)
        done = action

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            where = place(pieces, origin)
            reference, distance = _point(kind, where, from_start)
            if reference is None:
                return ir.Vendor("krl", code_text(origin), "unknown", origin=origin)
            return ir.Trigger(
                reference,
                done(pieces, origin),
                distance,
                ir.Quantity(delay(pieces, origin), "ms", origin=origin) if delay else None,
                priority(pieces, origin) if priority else None,
                origin=origin,
            )

        return make


def _point(kind: str, where: ir.Expression, from_start: bool) -> tuple[str | None, ir.Expression | None]:
    """Reference point and distance. DISTANCE=0 is the start, 1 the end (the middle of a corner path); PATH counts along
    the path from the end, or from the start with ONSTART."""
    if kind == "PATH":
        return ("start" if from_start else "end"), where
    if isinstance(where, ir.IntLiteral) and where.value in (0, 1):
        return ("middle" if where.value else "start"), None
    return None, None


def _all_axes(pairs: list[Pair]) -> list[Pair]:
    """M: a spline move's settings name axis 1 alone where all axes are meant (as the inline forms write them)."""
    done: list[Pair] = []
    for target, value in pairs:
        if isinstance(target, ir.System) and target.name in ("joint_speed", "joint_acceleration"):
            others = [t for t, _ in pairs if isinstance(t, ir.System) and t.name == target.name]
            if len(others) == 1 and target.indices == (ir.IntLiteral(1),):
                done.extend((ir.System(target.name, (ir.IntLiteral(n),), origin=target.origin), value)
                            for n in range(1, _AXES + 1))  # fmt: skip
                continue
        done.append((target, value))
    return done


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child
