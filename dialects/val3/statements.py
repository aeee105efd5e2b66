"""VAL3 statements to IR: assignments, calls, tasks, and what opens, divides and ends blocks."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.reading.pieces import Close, Element, Middle, Open
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import Origin

from .data import FLAGS
from .expressions import parts_of, subtree
from .facts import Header
from .motion import KINDS, Motion
from .places import POSE_PARTS, WORLD, Value, angle, moved_to, pose
from .split import code_of

UNREAD_CONDITION = code(
    "val3-unread-condition", Severity.LOSS, "cannot read this condition: {reason}", "a run stops there"
)
_BOOL = ir.BoolType()
_KEYWORD = re.compile(r"^\w+\s*")
Lowered = Element | tuple[Element, ...]
_ENDS = {"endif": "if", "endwhile": "while", "endfor": "for", "endswitch": "switch", "end": "program"}
# Conditions that are looked at more than once: nothing can be done in front of them.
_REPEATED = ("while_head", "until", "elseif")


class Statements(Motion):
    """Lowers the statements of one file after the other. `headers`: the programs of the file at hand."""

    headers: tuple[Header, ...] = ()

    def lower(self, tree: SyntaxTree, numbers: tuple[str, ...], origin: Origin) -> Lowered:
        self.numbers, self.origin, self.before = numbers, origin, []
        done = self.element_of(tree)
        if not self.before:
            return done
        if tree.data in _REPEATED:
            raise StatementError("this function cannot stand in a condition that is looked at again", 0)
        return (*self.before, *(done if isinstance(done, tuple) else (done,)))

    def element_of(self, tree: SyntaxTree) -> Lowered:
        origin, children = self.origin, tree.children
        match tree.data:
            case "begin":
                return self.begin()
            case "endif" | "endwhile" | "endfor" | "endswitch" | "end":
                return Close(_ENDS[tree.data], None, origin)
            case "if_head":
                return Open("if", self.condition(children[-1]), origin)
            case "elseif":
                return Middle("if", self.condition(children[-1]), origin)
            case "else":
                return Middle("if", None, origin)
            case "while_head":
                return Open("while", self.condition(children[0]), origin)
            case "do_head":
                return Open("do", None, origin)
            case "until":
                return Close("do", self.condition(children[0]), origin)
            case "for_head":
                return self.counting(children)
            case "switch_head":
                return Open("switch", self.condition(children[0], ir.RealType()), origin)
            case "case":
                values = tuple(self.value(subtree(child)).node for child in children)
                return Middle("switch", values, origin)
            case "default":
                return Middle("switch", None, origin)
            case "break":
                return ir.ExitLoop(origin=origin)
            case "return":
                return ir.Return(origin=origin)
            case "call_program":
                return self.called(children)
            case "create" | "create_cyclic":
                return self.created(children)
            case "assign":
                return self.assigned(subtree(children[0]), subtree(children[1]))
        return self.performed(subtree(children[0]))

    def condition(self, tree: object, type: ir.Type = _BOOL) -> ir.Expression:
        """What a block asks. One that cannot be read is a value that only the controller has: the block stays whole."""
        try:
            return self.value(subtree(tree)).node
        except StatementError as error:
            self.diagnostics.report(UNREAD_CONDITION, self.origin, reason=str(error))
            text = _KEYWORD.sub("", code_of(self.origin.text))
            return ir.VendorValue("val3", text, type, origin=self.origin)

    def begin(self) -> Open:
        header = next((one for one in self.headers if one.start <= self.origin.start < one.end), None)
        assert header is not None  # the splitter gives code of programs alone
        self.own = {one.name: one for one in (*header.parameters, *header.locals)}
        self.fathers, self.helpers = {}, []
        return Open("program", (header, self.helpers), self.origin)

    def counting(self, children: Sequence[object]) -> Open:
        counter = subtree(children[0])
        if counter.data != "name":
            raise StatementError("the counter of a loop is a plain variable here", 0)
        bounds = [self.number(subtree(child)) for child in children[1:]]
        step = bounds[2] if len(bounds) > 2 else None
        return Open("for", (str(counter.children[0]), bounds[0], bounds[1], step), self.origin)

    def called(self, children: Sequence[object]) -> ir.Statement:
        routine = subtree(children[0])
        name = str(routine.children[-1])
        items = parts_of(children[1]) if len(children) > 1 else []
        header = self.facts.programs.get(name)
        if header is None:
            return ir.Vendor("val3", self.origin.text, "unknown", origin=self.origin)
        return ir.CallRoutine(name, self.arguments(header, items), origin=self.origin)

    def arguments(self, header: Header, items: list[SyntaxTree]) -> tuple[ir.Argument, ...]:
        if len(items) != len(header.parameters):
            raise StatementError(f"{header.name} takes {len(header.parameters)} arguments", 0)
        given: list[ir.Argument] = []
        for parameter, item in zip(header.parameters, items, strict=True):
            if parameter.sizes != (1,) and item.data == "name":
                value, _ = self.named(str(item.children[0]))
            else:
                value = self.value(item, parameter.kind)
            if value.kind in ("point", "frame", "tool") and parameter.kind == value.kind:
                given.append(ir.Argument(self.in_the_world(value)))
            else:
                given.append(ir.Argument(value.node))
        return tuple(given)

    def in_the_world(self, value: Value) -> ir.Expression:
        """A parameter has no father that could be known: what it is given counts in the world, or on the flange."""
        return moved_to(value, WORLD) if value.kind == "point" else value.place

    def created(self, children: Sequence[object]) -> ir.Statement:
        at = next(at for at, child in enumerate(children) if subtree(child).data == "routine")
        name = str(subtree(children[at]).children[-1])
        items = parts_of(children[at + 1]) if len(children) > at + 1 else []
        header = self.facts.programs.get(name)
        if header is None:
            raise StatementError(f"there is no program {name}", 0)
        return ir.TaskControl("start", name, self.arguments(header, items), origin=self.origin)

    def performed(self, tree: SyntaxTree) -> Lowered:
        if tree.data != "function" or subtree(tree.children[0]).data not in ("name", "foreign"):
            raise StatementError("this is no instruction", 0)
        head = subtree(tree.children[0])
        name = ":".join(map(str, head.children))
        items = parts_of(tree.children[1]) if len(tree.children) > 1 else []
        if name in KINDS:
            return self.move(name, items)
        return self.perform(name, items, self.origin.text)

    # ---- assignments

    def assigned(self, place: SyntaxTree, tree: SyntaxTree) -> Lowered:
        origin = self.origin
        if place.data == "member":
            return self.component(place, tree)
        goal = self.value(place)
        if isinstance(goal.node, ir.Signal):
            return ir.Assign(goal.node, self.value(tree).node, origin=origin)
        if not isinstance(goal.node, ir.Name | ir.Index):
            raise StatementError("nothing can be stored there", 0)
        value = self.value(tree, goal.kind)
        node = value.node
        if goal.kind == "point" and value.kind == "point":
            local = isinstance(goal.node, ir.Name) and goal.node.id in self.own
            if local and isinstance(goal.node, ir.Name) and goal.node.id not in self.fathers:
                self.fathers[goal.node.id] = value.place
                goal = Value(goal.node, "point", value.place)
            node = moved_to(value, goal.place)
        return ir.Assign(goal.node, node, origin=origin)

    def component(self, place: SyntaxTree, tree: SyntaxTree) -> Lowered:
        """`p.trsf`, `p.trsf.x`, `p.trsf.rz`, `p.config.wrist`, `j.j1`, `m.vel`, `t.x`, and whole configurations."""
        name, base = str(place.children[1]), self.value(subtree(place.children[0]))
        node, origin = base.node, self.origin
        match node:
            case ir.Builtin(function="pose_of", arguments=(inner,)):
                node = inner
        match base.kind, name:
            case "point" | "frame" | "tool", "trsf":
                value = self.value(tree, "trsf").node
                if base.kind != "point":
                    return ir.Assign(node, value, origin=origin)
                parts = ("trans", "rot")
                return tuple(ir.Assign(ir.Field(node, one), ir.Field(value, one), origin=origin) for one in parts)
            case "trsf", "rx" | "ry" | "rz":
                angles = [self.value(tree).node if name == one else angle(node, one) for one in ("rx", "ry", "rz")]
                turned = ir.Field(pose((ir.IntLiteral(0),) * 3 + tuple(angles)), "rot")
                return ir.Assign(ir.Field(node, "rot"), turned, origin=origin)
            case "trsf", _ if name in POSE_PARTS[:3]:
                return ir.Assign(ir.Field(node, name), self.number(tree), origin=origin)
            case "config", "shoulder" | "elbow" | "wrist":
                return self.posture(node, ((name, tree),))
            case "point", "config" if tree.data == "aggregate":
                return self.posture(node, tuple(zip(FLAGS, parts_of(tree.children[0]), strict=False)))
            case "point", "config" if (other := self.value(tree)).kind == "config":
                return tuple(ir.Assign(ir.Field(node, n), ir.Field(other.node, n), origin=origin) for n in FLAGS)
            case (("joint" | "mdesc"), _):
                goal = self.value(place)
                return ir.Assign(goal.node, self.number(tree), origin=origin)
        raise StatementError(f"{name} cannot be set here", 0)

    def posture(self, node: ir.Expression, given: tuple[tuple[str, SyntaxTree], ...]) -> tuple[ir.Statement, ...]:
        done = []
        for name, tree in given:
            flag = self.flag(tree)
            if flag is None:
                raise StatementError("a configuration cannot be set back to `same` while the program runs", 0)
            done.append(ir.Assign(ir.Field(node, name), ir.IntLiteral(flag), origin=self.origin))
        return tuple(done)
