"""Print expressions as RAPID. What RAPID cannot say raises CannotSayError; the statement around it is then guarded."""

from __future__ import annotations

import operator
import re
from collections.abc import Sequence

from rpl import ir
from rpl.ir.columns import as_float, column_of
from rpl.passes.scope import Scope
from rpl.passes.typewords import component_names, word_type
from rpl.passes.typing import type_of
from rpl.writing.precedence import ExpressionPrinter, Printed
from rpl.writing.rows import mark_of
from rpl.writing.statements import CannotSayError
from rpl.writing.text import NumberStyle, number_text

from .functions import (
    BYTE_BASES,
    FUNCTIONS,
    MOTION_TASK,
    OWN_FUNCTIONS,
    PARTS_OF_TIME,
    PLACES_BESIDE,
    POSE_OFFSETS,
    TARGETS_FOR_POSITIONS,
)
from .tables import (
    COMPONENTS,
    NESTED,
    OPERATOR_TABLE,
    OR_LEVEL,
    PREFIXES,
    READERS,
    RELATION_LEVEL,
    SPEED_NAMES,
    SYSTEM_RECORDS,
    ZONE_NAMES,
)

LONGEST_TEXT = 80
UNSET_AXIS = "9E9"
_REAL = re.compile(r"(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+")
_ZEROS = re.compile(r"\.0*$")
_INT = re.compile(r"\d+")
_STYLE = NumberStyle(largest_plain=1e9, smallest_plain=1e-4)
_SIGNIFICANT = 9


class Expressions:
    """Prints the expressions of one scope."""

    def __init__(
        self, scope: Scope, long_texts: list[str] | None = None, beside: bool = False, foreign: bool = False
    ) -> None:
        """long_texts: where texts that had to be cut are listed. beside: the task does not move the robot. foreign: the
        program comes from another language."""
        self.scope, self.beside, self.foreign = scope, beside, foreign
        self.printer = ExpressionPrinter(OPERATOR_TABLE, self.hook)
        self.long_texts: list[str] = [] if long_texts is None else long_texts

    def text(self, expression: ir.Expression) -> str:
        return self.printer.text(expression)

    def hook(self, expression: ir.Expression, printer: ExpressionPrinter) -> str | Printed:
        match expression:
            case ir.IntLiteral():
                return integer(expression)
            case ir.RealLiteral():
                return real(expression, self.foreign)
            case ir.BoolLiteral(value=value):
                return "TRUE" if value else "FALSE"
            case ir.TextLiteral(value=value):
                if len(value) > LONGEST_TEXT:
                    self.long_texts.append(value)
                return text_literal(value)
            case ir.Name(id=name):
                return name
            case ir.Index(base=ir.Index(base=base, indices=outer), indices=inner):
                return self.hook(ir.Index(base, (*outer, *inner)), printer)
            case ir.Index(base=base, indices=indices):
                return f"{printer.atom(base)}{{{self.list(indices)}}}"
            case ir.Field():
                return self.field(expression)
            case ir.Unary(op="not", operand=operand):
                return self.negation(operand)
            case ir.Binary():
                return self.operation(expression)
            case ir.Call(name=name, arguments=arguments):
                return f"{name}({self.arguments(name, arguments)})"
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Aggregate():
                return self.aggregate(expression)
            case ir.System(name=name):
                return self.system(name)
            case ir.Signal():
                return self.condition(expression)
            case ir.Quantity(value=value, unit=unit):
                return self.scaled(value, ir.UNITS[unit])
            case ir.Magnitude(value=value, unit=unit):
                return self.scaled(value, 1.0 / ir.UNITS[unit])
            case ir.Convert():
                return self.converted(expression)
            case ir.Present(name=name):
                return f"Present({name})"
        raise CannotSayError(f"a {expression.__class__.__name__} has no form in this language")

    def list(self, expressions: tuple[ir.Expression, ...]) -> str:
        return ",".join(self.text(expression) for expression in expressions)

    # ---- names and components

    def field(self, expression: ir.Field) -> str:
        if isinstance(expression.base, ir.Builtin | ir.Call | ir.Aggregate | ir.Binary):
            raise CannotSayError("a component can only be taken of a variable")
        base = self.printer.atom(expression.base)
        type = type_of(expression.base, self.scope)
        name = expression.name
        nested = NESTED.get(type.__class__, {}).get(name)
        if nested is not None:
            return f"{base}.{'.'.join(nested)}"
        if isinstance(type, ir.NamedType | None):
            return f"{base}.{name}"
        if name in ir.ANGLES:
            raise CannotSayError("orientations have quaternion components only")
        return f"{base}.{COMPONENTS.get(type.__class__, {}).get(name, name)}"

    def value_of_signal(self, signal: ir.Signal, compared: bool = False) -> str:
        """The number that a signal reads as. A name that does not show its kind is read by the function of its kind;
        what is `compared` with 0 or 1 is an input."""
        name = self.signal(signal)
        if (signal.kind == "digital_in" and compared) or name.lower().startswith(PREFIXES[signal.kind]):
            return name
        return f"{READERS[signal.kind]}({name})"

    def signal(self, signal: ir.Expression) -> str:
        """A signal by its name (or a parameter that stands for one)."""
        match signal:
            case ir.Signal(name=str() as name, index=None):
                return name
            case ir.Signal():
                raise CannotSayError("signals have names, not numbers")
            case ir.Convert(how="bit", operand=operand):
                return self.signal(operand)
        return self.printer.atom(signal)

    def condition(self, signal: ir.Signal) -> str | Printed:
        """A digital signal as a condition; the value of another one."""
        name = self.value_of_signal(signal, compared=True)
        return Printed(f"{name}=1", RELATION_LEVEL) if signal.kind.startswith("digital") else name

    # ---- operators and conversions

    def negation(self, operand: ir.Expression) -> Printed:
        match operand:
            case ir.Signal() if operand.kind.startswith("digital"):
                return Printed(f"{self.value_of_signal(operand, compared=True)}=0", RELATION_LEVEL)
        return Printed(f"NOT {self.printer.atom(operand)}", OR_LEVEL)

    def operation(self, expression: ir.Binary) -> str:
        left, right = expression.left, expression.right
        functions = {"band": "BitAnd", "bor": "BitOr", "bxor": "BitXOr", "**": "Pow"}
        match expression:
            case ir.Binary("band", ir.Builtin("bit_shift_left", (value, places)), ir.IntLiteral(value=255)):
                return f"BitLSh({self.text(value)},{self.text(places)})"
            case ir.Binary("band", ir.Builtin("text_value", (decimal,)), ir.IntLiteral(value=255)):
                return f"StrToByte({self.text(decimal)})"
            case ir.Binary("band", ir.Builtin("based_number", (digits, ir.IntLiteral(base))), ir.IntLiteral(255)) if (
                base in BYTE_BASES
            ):
                return f"StrToByte({self.text(digits)}\\{BYTE_BASES[base]})"
            case ir.Binary(op="band", right=ir.Unary(op="bnot", operand=mask)):  # of a byte, as BitClear makes it
                return f"BitAnd({self.text(left)},BitNeg({self.text(mask)}))"
        if expression.op in functions:
            return f"{functions[expression.op]}({self.text(left)},{self.text(right)})"
        if expression.op == ":":
            if isinstance(type_of(left, self.scope), ir.RotationType):
                return f"({self.printer.atom(left)}*{self.printer.atom(right)})"
            return f"PoseMult({self.text(left)},{self.text(right)})"
        raise CannotSayError(f"there is no operator {expression.op}")

    def scaled(self, value: ir.Expression, factor: float) -> str | Printed:
        if factor == 1.0:
            return self.printer.printed(value)
        match value:
            case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
                return rounded(float(number) * factor)
        return self.printer.printed(ir.Binary("*", value, ir.RealLiteral(factor)))

    def converted(self, expression: ir.Convert) -> str | Printed:
        operand = expression.operand
        match expression.how:
            case "real":
                return self.printer.printed(operand)
            case "round_half_away":
                return f"Round({self.text(operand)})"
            case "trunc":
                return f"Trunc({self.text(operand)})"
            case "bit" if isinstance(operand, ir.Signal):
                return self.value_of_signal(operand)
            case "truth":
                return Printed(f"{self.printer.text(operand, RELATION_LEVEL + 1)}<>0", RELATION_LEVEL)
            case "code":
                return f"StrToByte({self.text(operand)}\\Char)"
            case "char":
                return f"ByteToStr({self.text(operand)}\\Char)"
        raise CannotSayError("a BOOL has no number here")

    # ---- calls and values

    def arguments(self, routine: str, arguments: tuple[ir.Argument, ...]) -> str:
        """Actual arguments with their commas: an option stands behind a backslash, with or without a comma."""
        declared = self.scope.routine(routine) if routine else None
        required = {p.name.lower() for p in declared.parameters if not p.optional} if declared else set()
        parts: list[str] = []
        for argument in arguments:
            if argument.if_present is not None:
                piece, option = f"\\{argument.name}?{argument.if_present}", True
            elif argument.name is None:
                if argument.value is None:
                    raise CannotSayError("an argument cannot be left out")
                piece, option = self.argument(argument.value), False
            elif argument.value is None:
                piece, option = f"\\{argument.name}", True
            else:
                option = argument.name.lower() not in required
                named = f"{argument.name}:={self.argument(argument.value)}"
                piece = f"\\{named}" if option else named
            parts.append(piece if option or not parts else f",{piece}")
        return "".join(parts)

    def argument(self, value: ir.Expression) -> str:
        """A signal is passed as such."""
        return self.signal(value) if isinstance(value, ir.Signal) else self.text(value)

    def builtin(self, expression: ir.Builtin) -> str:
        match expression:
            case ir.Builtin("text_value", (ir.Builtin("text_part", (shown, first, _)),)) if word := PARTS_OF_TIME.get(
                (shown, first)
            ):
                return f"GetTime(\\{word})"
            case ir.Builtin("digits_in_base", (digits, ir.IntLiteral(10), ir.IntLiteral(16))):
                return f"DecToHex({self.text(digits)})"
            case ir.Builtin("digits_in_base", (digits, ir.IntLiteral(16), ir.IntLiteral(10))):
                return f"HexToDec({self.text(digits)})"
            case ir.Builtin("displaced", (place, ir.System(name="displacement"))):
                return f"ORobT({self.text(place)})"
        patterns = FUNCTIONS.get(expression.function) or OWN_FUNCTIONS.get(expression.function)
        if patterns is None:
            raise CannotSayError(f"there is no function {expression.function}")
        arguments = list(expression.arguments)
        if expression.function in POSE_OFFSETS and isinstance(type_of(arguments[0], self.scope), ir.PoseType):
            return self.moved_pose(expression.function, arguments)
        for position in range(TARGETS_FOR_POSITIONS.get(expression.function, 0)):
            arguments[position] = self.target_at(arguments[position])
        if expression.function in ("joints_to_target", "target_to_joints") and arguments[2:] == [ir.Name("wobj0")]:
            arguments.pop()
        if self.beside and expression.function in PLACES_BESIDE:
            return self.seen_from_beside(expression.function, arguments)
        if expression.function.startswith("current_") and arguments[:1] == [ir.Builtin("current_tool", ())]:
            pattern = "C" + {"current_target": "RobT", "current_position": "Pos"}[expression.function]
            return f"{pattern}(\\WObj:={self.text(arguments[1])})"
        if expression.function == "text_equal" and isinstance(arguments[-1], ir.BoolLiteral):
            ignore_case = arguments.pop()
            if ignore_case == ir.BoolLiteral(True):
                arguments = [ir.Builtin("text_upper", (argument,)) for argument in arguments]
        found = patterns.get(len(arguments))
        if found is None:
            raise CannotSayError(f"{expression.function} is not known with {len(arguments)} arguments")
        return found.format(*(self.text(argument) for argument in arguments))

    def moved_pose(self, function: str, arguments: Sequence[ir.Expression]) -> str:
        """Offs and RelTool take robtargets only: of a pose they are products (turned about x, then new y, new z)."""
        pose, *numbers = arguments
        still = ir.Aggregate(tuple((None, ir.IntLiteral(number)) for number in (1, 0, 0, 0)), "rotation")
        way = ir.Aggregate(tuple((None, number) for number in numbers[:3]), "vector")
        turns = [turn for turn in enumerate(numbers[3:]) if turn[1] not in (ir.IntLiteral(0), ir.RealLiteral(0.0))]
        turned: ir.Expression = still
        for axis, angle in turns:
            angles = [angle if 2 - axis == place else ir.IntLiteral(0) for place in range(3)]
            turn = ir.Builtin("rotation_zyx", tuple(angles))
            turned = turn if turned is still else ir.Binary(":", turned, turn)
        by = ir.Aggregate(((None, way), (None, turned)), "pose")
        return self.text(ir.Builtin("compose", (by, pose) if function == "offset" else (pose, by)))

    def seen_from_beside(self, function: str, arguments: Sequence[ir.Expression]) -> str:
        """Where the robot of the motion task is. Tool and work object are always named: this task has none in use."""
        options = [f"\\TaskName:={text_literal(MOTION_TASK)}"]
        if function != "current_joints":
            named = [*arguments[:2], *(ir.Name(name) for name in ("tool0", "wobj0")[len(arguments) :])]
            options += [f"\\{word}:={self.text(one)}" for word, one in zip(("Tool", "WObj"), named, strict=True)]
        return f"{PLACES_BESIDE[function]}({''.join(options)})"

    def target_at(self, position: ir.Expression) -> ir.Expression:
        """A robtarget at a position, for functions that look at nothing else of it."""
        match position:
            case ir.Field(base=base, name="trans") if isinstance(type_of(base, self.scope), ir.TargetType | None):
                return base
        return ir.Aggregate((("trans", position),), "target rapid")

    def system(self, name: str) -> str:
        words = {
            "error_number": "ERRNO",
            "interrupt_number": "INTNO",
            "override": "CSpeedOverride()",
            "actual_pose": "CRobT()",
            "actual_joints": "CJointT()",
            **SYSTEM_RECORDS,
        }
        if name not in words:
            raise CannotSayError(f"there is no system variable for {name.replace('_', ' ')}")
        return words[name]

    def aggregate(self, expression: ir.Aggregate) -> str:
        entries = expression.entries
        if not entries or all(name is None for name, _ in entries):
            return f"[{','.join(self.text(value) for _, value in entries)}]"
        type = word_type(expression.type_name, self.scope) if expression.type_name else None
        if type is None:
            raise CannotSayError("a structured value of unknown type cannot be written in order")
        order = component_names(type, self.scope)
        given = {(name or "").lower(): value for name, value in entries}
        strange = set(given) - {name.lower() for name in order}
        if strange:
            raise CannotSayError(f"there is no component {', '.join(sorted(strange))} in {expression.type_name}")
        values = tuple(given.get(name.lower()) for name in order)
        if all(value is not None for value in values):
            named = self.predefined(expression, tuple(value for value in values if value is not None))
            if named:
                return named
        parts = [self.text(v) if v is not None else missing(type, name) for v, name in zip(values, order, strict=True)]
        return f"[{','.join(parts)}]"

    def predefined(self, expression: ir.Aggregate, values: tuple[ir.Expression, ...]) -> str | None:
        """The name of a predefined speed or zone of these values."""
        table = {"speed": SPEED_NAMES, "zone": ZONE_NAMES}.get(expression.type_name or "")
        if table is None:
            return None
        numbers = [number_of(value) for value in values]
        known = tuple(number for number in numbers if number is not None)
        if any(map(column_of, known)):  # compared one after the other, so that not all have to be looked into
            found = (name for given, name in table.items() if all(map(operator.eq, given, known)))
            return next(found, None)
        return table.get(known) if len(known) == len(numbers) else None


def number_of(value: ir.Expression) -> float | None:
    """The number of a literal (a BOOL counts 0 or 1)."""
    match value:
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return as_float(number)
        case ir.BoolLiteral(value=truth):
            return float(truth)
        case ir.Quantity(value=inner, unit=unit):
            size = number_of(inner)
            return None if size is None else size * ir.UNITS[unit]
    return None


def missing(type: ir.Type, name: str) -> str:
    """What a component gets that the source left out."""
    match type, name:
        case ir.TargetType() | ir.JointsType(), "ext":
            return f"[{','.join([UNSET_AXIS] * 6)}]"
        case ir.TargetType(), "conf":
            return "[0,0,0,0]"
        case ir.TargetType() | ir.PoseType(), "trans":
            return "[0,0,0]"
        case ir.TargetType() | ir.PoseType(), "rot":
            return "[1,0,0,0]"
        case ir.ExternalType(), _:
            return UNSET_AXIS
        case ir.ToolType(), "held":
            return "TRUE"
        case ir.ToolType(), "load":  # as light as the controller allows
            return "[0.001,[0,0,0.001],[1,0,0,0],0,0,0]"
        case ir.WorkObjectType(), "held" | "fixed":
            return "TRUE" if name == "fixed" else "FALSE"
        case ir.WorkObjectType(), "unit":
            return '""'
        case (ir.ToolType(), "frame") | (ir.WorkObjectType(), "user_frame" | "object_frame"):
            return "[[0,0,0],[1,0,0,0]]"
        case ir.LoadType(), "axes":
            return "[1,0,0,0]"
        case ir.LoadType(), "cog":
            return "[0,0,0]"
        case ir.LoadType(), _:
            return "0.001" if name == "mass" else "0"
        case ir.RotationType(), "q1":
            return "1"
        case ir.VectorType() | ir.AxesType() | ir.ConfigType() | ir.RotationType(), _:
            return "0"
    raise CannotSayError(f"the component {name} is missing")


def integer(literal: ir.IntLiteral) -> str:
    if _INT.fullmatch(literal.spelling):
        return literal.spelling
    return mark_of(literal) or str(literal.value)


def real(literal: ir.RealLiteral, foreign: bool) -> str:
    """The number as it was spelled when that is RAPID, else with nine significant digits. A whole number of another
    language goes without its `.0`: a num is one all the same, and people leave it out (counted in public programs: 80
    of 124,000 whole numbers have it)."""
    return mark_of(literal) or (foreign_number if foreign else number)(literal.value, literal.spelling)


def foreign_number(value: float, spelling: str) -> str:
    """A number of another language's program, as `real` and `integer` write it."""
    return number(value, _ZEROS.sub("", spelling))


def number(value: float, spelling: str) -> str:
    """A number as `real` and `integer` write it."""
    if isinstance(value, int):
        return integer(ir.IntLiteral(value, spelling))
    if _REAL.fullmatch(spelling) and float(spelling) == value:
        return spelling
    return rounded(value)


def rounded(value: float) -> str:
    """A computed number: nine significant digits, more than a num holds."""
    if abs(value) >= 9e9:
        return UNSET_AXIS if value == 9e9 else number_text(value, style=_STYLE)
    text = f"{value:.{_SIGNIFICANT}g}"
    if "e" not in text and abs(value) >= _STYLE.smallest_plain:  # what is made of it below, and far quicker
        return text
    return number_text(float(text), style=_STYLE)


def text_literal(value: str) -> str:
    """A text of at most 80 characters between quotes; control characters by their code."""
    parts = []
    for sign in value[:LONGEST_TEXT]:
        if sign in '"\\':
            parts.append(sign * 2)
        elif sign < " " or "\x7f" <= sign < "\xa0":
            parts.append(f"\\{ord(sign):02X}")
        else:
            parts.append(sign)
    return f'"{"".join(parts)}"'
