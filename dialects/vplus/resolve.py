"""The last step of reading: with all types known, truths and numbers are told apart and texts are joined.

V+ has no truth values: a comparison gives -1 or 0. Here comparisons are truths, and a conversion is written down
wherever one meets a number (`minus_bit`) or a number stands where a truth is asked for (`truth`).
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite

from .expressions import root_name, significant
from .inference import BOOL, POSE, REAL, Symbols, is_location, is_settled

TEXT, JOINTS = "text", "joints"
_COMPARISONS = frozenset(("=", "<>", "<", ">", "<=", ">="))
_LOGIC = frozenset(("and", "or", "xor", "cand", "cor"))
_ARITHMETIC = frozenset(("-", "*", "/", "mod", "band", "bor", "bxor"))
_LETTERS = {"t": TEXT, "c": TEXT, "p": POSE, "b": BOOL, "j": JOINTS, "n": REAL, "i": REAL}


class Resolver:
    """Rewrites the body of one program."""

    def __init__(self, symbols: Symbols, program: str, parameters: dict[str, tuple[str, ...]]) -> None:
        """`parameters`: the kinds of every program's parameters, by its significant name."""
        self.symbols, self.program, self.parameters = symbols, program, parameters

    def body(self, body: ir.Body) -> ir.Body:
        """The body in its final form."""
        return tuple(s if is_settled(s) else rewrite(s, self.node) for s in body)

    # ---- kinds

    def kind(self, expression: ir.Expression | None) -> str | None:
        """What kind of value an expression gives."""
        match expression:
            case ir.BoolLiteral() | ir.Present():
                return BOOL
            case ir.IntLiteral() | ir.RealLiteral() | ir.Quantity() | ir.Magnitude():
                return REAL
            case ir.TextLiteral():
                return TEXT
            case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
                return self.symbols.kind(self.program, name)
            case ir.Signal(kind=kind):
                return BOOL if kind in ("digital_in", "digital_out", "flag") else REAL
            case ir.Unary(op=op):
                return BOOL if op == "not" else REAL
            case ir.Binary(op=op, left=left, right=right):
                return self.of_binary(op, left, right)
            case ir.Convert(how=how):
                return BOOL if how == "truth" else REAL
            case ir.Field(name=name):
                return REAL if name != "trans" else None
            case ir.Aggregate(type_name=name):
                return JOINTS if name == "joints" else POSE
            case ir.VendorValue(type=type):
                return {ir.StringType: TEXT, ir.PoseType: POSE, ir.JointsType: JOINTS}.get(type.__class__, REAL)
        return self.of_call(expression)

    def of_binary(self, op: str, left: ir.Expression, right: ir.Expression) -> str:
        if op in _COMPARISONS or op in _LOGIC:
            return BOOL
        if op == "&" or (op == "+" and TEXT in (self.kind(left), self.kind(right))):
            return TEXT
        return POSE if op == ":" else REAL

    def of_call(self, expression: ir.Expression | None) -> str | None:
        match expression:
            case ir.Builtin(function=function, arguments=arguments):
                row = ir.FUNCTIONS.get(function)
                if row is None:
                    return REAL
                if row.result.isdigit():
                    return self.kind(arguments[int(row.result)]) if arguments else None
                return _LETTERS.get(row.result)
            case ir.System(name=name):
                variable = ir.SYSTEM_VARIABLES.get(name)
                kinds = {"P": POSE, "J": JOINTS, "b": BOOL, "n": REAL, "i": REAL}
                return kinds.get(variable.type) if variable is not None else None
        return None

    def truth(self, expression: ir.Expression) -> ir.Expression:
        """The expression where a truth is asked for."""
        if self.kind(expression) != REAL:
            return expression
        if isinstance(expression, ir.Convert) and expression.how == "minus_bit":
            return expression.operand
        if isinstance(expression, ir.IntLiteral | ir.RealLiteral):
            return ir.BoolLiteral(expression.value != 0)
        return ir.Convert("truth", expression, origin=expression.origin)

    def number(self, expression: ir.Expression) -> ir.Expression:
        """The expression where a number is asked for."""
        if self.kind(expression) != BOOL:
            return expression
        return ir.Convert("minus_bit", expression, origin=expression.origin)

    # ---- nodes, from below

    def node(self, node: object) -> object:
        match node:
            case ir.Binary():
                return self.binary(node)
            case ir.Unary():
                return self.unary(node)
            case ir.Builtin():
                return self.builtin(node)
            case ir.Index(indices=indices):
                return replace(node, indices=tuple(self.number(index) for index in indices))
            case ir.Field(base=base, name=name) if not name.startswith("j"):
                return replace(node, base=self.pose(base))
            case ir.Aggregate(entries=entries):
                return replace(node, entries=tuple((key, self.number(value)) for key, value in entries))
            case ir.Quantity(value=value):
                return replace(node, value=self.number(value))
            case ir.Signal() | ir.System():
                return node
        return self.statement(node)

    def binary(self, node: ir.Binary) -> ir.Expression:
        op, left, right = node.op, node.left, node.right
        if op in _LOGIC:
            return replace(node, left=self.truth(left), right=self.truth(right))
        if op == "+" and TEXT in (self.kind(left), self.kind(right)):
            return replace(node, op="&")
        if op == ":":
            return replace(node, left=self.pose(left), right=self.pose(right))
        if op in _COMPARISONS:
            return self.compared(node)
        if op in _ARITHMETIC or op == "+":
            return replace(node, left=self.number(left), right=self.number(right))
        return node

    def compared(self, node: ir.Binary) -> ir.Expression:
        """Two truths compare as truths; beside a number each is a number."""
        left, right = self.kind(node.left), self.kind(node.right)
        if left == right == BOOL and node.op in ("=", "<>"):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                if isinstance(one, ir.BoolLiteral):
                    same = one.value == (node.op == "=")
                    return other if same else ir.Unary("not", other, origin=node.origin)
            return node
        if left == right == TEXT and self.symbols.upper:
            return replace(node, left=_in_capitals(node.left), right=_in_capitals(node.right))
        if BOOL in (left, right):
            return replace(node, left=self.number(node.left), right=self.number(node.right))
        return node

    def unary(self, node: ir.Unary) -> ir.Expression:
        if node.op == "not":
            return replace(node, operand=self.truth(node.operand))
        if node.op == "+" and self.kind(node.operand) == POSE:  # a location that is passed by value
            return ir.Builtin("pose_of", (node.operand,), origin=node.origin)
        if node.op == "+" and self.kind(node.operand) != REAL:
            return node
        return replace(node, operand=self.number(node.operand))

    def pose(self, expression: ir.Expression) -> ir.Expression:
        """The expression where a transformation is asked for: of a precision point the one it means."""
        if self.kind(expression) != JOINTS:
            return expression
        reached = ir.Builtin("joints_to_target", (expression,), origin=expression.origin)
        return ir.Builtin("pose_of", (reached,), origin=expression.origin)

    def builtin(self, node: ir.Builtin) -> ir.Expression:
        row = ir.FUNCTIONS.get(node.function)
        if row is None:
            return node
        letters = row.parameters.replace("?", "")
        if letters.endswith("*"):
            letters = letters[:-1] + letters[-2] * len(node.arguments)
        arguments = []
        for letter, argument in zip(letters, node.arguments, strict=False):
            if letter == "p" and node.function != "pose_of":
                argument = self.pose(argument)
            elif letter in "ni" or (letter == "x" and node.function == "format"):
                argument = self.number(argument)
            arguments.append(argument)
        if node.function == "pose_of":
            return self.pose_of(node, arguments[0])
        return replace(node, arguments=tuple(arguments))

    def pose_of(self, node: ir.Builtin, argument: ir.Expression) -> ir.Expression:
        """The mark of SET goes where the value is a transformation anyhow."""
        if self.kind(argument) == JOINTS:
            return self.pose(argument)
        if root_name(argument) is not None:
            return argument
        target = isinstance(argument, ir.System) and argument.name.endswith("_pose")
        made = isinstance(argument, ir.Builtin) and argument.function in ("current_target", "joints_to_target")
        return node if target or made or not is_location(argument) else argument

    def statement(self, node: object) -> object:
        match node:
            case ir.If(branches=branches):
                return replace(node, branches=tuple((self.truth(condition), body) for condition, body in branches))
            case ir.While(condition=condition) | ir.WaitUntil(condition=condition):
                return replace(node, condition=self.truth(condition))
            case ir.DeclareInterrupt(condition=condition):
                return replace(node, condition=self.truth(condition))
            case ir.Repeat(until=until):
                return replace(node, until=self.truth(until))
            case ir.For(start=start, stop=stop, step=step):
                by = self.number(step) if step is not None else None
                return replace(node, start=self.number(start), stop=self.number(stop), step=by)
            case ir.Switch():
                return self.switch(node)
            case ir.Assign(target=target, value=value):
                wanted = self.kind(target)
                given = self.truth(value) if wanted == BOOL else self.number(value) if wanted == REAL else value
                return replace(node, value=given)
            case ir.CallRoutine(name=name) | ir.TaskControl(task=name):
                return replace(node, arguments=self.arguments(name, node.arguments))
            case ir.Message(text=text) if self.kind(text) != TEXT:
                shown = ir.Builtin("format", (ir.TextLiteral("% .8g"), self.number(text)), origin=node.origin)
                return replace(node, text=shown)
        return node

    def arguments(self, name: str, given: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        """Arguments as their parameters want them: a truth for one that only holds truths, else a number."""
        kinds = self.parameters.get(significant(name), ())
        done = []
        for position, argument in enumerate(given):
            value = argument.value
            if value is not None and not (position < len(kinds) and kinds[position] == BOOL):
                argument = replace(argument, value=self.number(value))
            done.append(argument)
        return tuple(done)

    def switch(self, node: ir.Switch) -> ir.Switch:
        """Truths are compared as truths only when all are."""
        kinds = {self.kind(value) for case in node.cases for value in case.values} | {self.kind(node.selector)}
        if BOOL not in kinds or kinds == {BOOL}:
            return node
        cases = tuple(replace(case, values=tuple(self.number(value) for value in case.values)) for case in node.cases)
        return replace(node, selector=self.number(node.selector), cases=cases)


def _in_capitals(text: ir.Expression) -> ir.Expression:
    """With UPPER on, capitals and small letters are the same in a comparison."""
    if isinstance(text, ir.TextLiteral):
        return replace(text, value=text.value.upper())
    return ir.Builtin("text_upper", (text,), origin=text.origin)


__all__ = ["Resolver"]
