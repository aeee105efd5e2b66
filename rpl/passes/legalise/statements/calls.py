"""Functions, procedures, operators and conversions that a target does not have, in terms of those it has.

What is an expression stays one where an expression can say it; what needs an algorithm becomes a call of a helper
routine (see helpers); what needs statements is done in front of the statement (texts, see texts).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import RoutineRule, TextRule
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import Effects, is_constant
from rpl.passes.legalise.kinds import holds_none
from rpl.passes.legalise.rewriting import scanning
from rpl.passes.legalise.rewriting.bodies import Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.rewriting.library import Library, common_library
from rpl.passes.legalise.rewriting.textparts import PUT
from rpl.passes.legalise.routines.results import text_results
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.statements.texts import TextHoister
from rpl.passes.rewrite import changed
from rpl.passes.scope import ProgramScope

_LONGEST_PRODUCT = 4
_HELPER_OPERATORS = {"band": "rpl_band", "bor": "rpl_bor", "bxor": "rpl_bxor"}
# Conversions of a BOOL to a number: what TRUE becomes (FALSE becomes 0).
_BIT_WEIGHTS = {"bit": 1, "minus_bit": -1}
_TURNED = {"<": ">", ">": "<", "<=": ">=", ">=": "<="}
# Procedures whose result is TRUE where texts have room enough.
_ALWAYS_WORK = frozenset(("text_append", "text_copy", "text_clear", "format_into"))
# Procedures that leave a text as it is where it has no room for the new one.
_FILLING = frozenset(("text_append", "text_append_length", "text_copy"))
_HELPER_FUNCTIONS = {
    "floor": "rpl_floor",
    "ceil": "rpl_ceil",
    "exp": "rpl_exp",
    "log": "rpl_log",
    "power": "rpl_power",
    "sign": "rpl_sign",
    "bit_shift_left": "rpl_shift_left",
    "bit_shift_right": "rpl_shift_right",
}
_ACTS_ON = frozenset(("Index", "CallRoutine", "Do", "Builtin", "Binary", "operator bnot", "Convert"))


@legalising()
def rewrite_calls(program: ir.Program, context: Context) -> ir.Program:
    """The program with only the functions, procedures, operators and conversions of the target."""
    helpers = common_library(context)
    if RoutineRule.TEXT_RESULTS not in context.capabilities.routines.rules:
        program = text_results(program, context)
    effects = Effects(program)
    scopes = ProgramScope(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Calls(editor, helpers).body)

    modules = []
    for module in program.modules:
        editor = Editor(context, effects, scopes.module(module))
        rewriter = _Calls(editor, helpers)
        declarations = tuple(
            changed(one, initial=rewriter.flat(one.initial))
            if isinstance(one, ir.Variable) and one.initial is not None and not holds_none(one, _ACTS_ON)
            else one
            for one in module.declarations
        )
        modules.append(changed(module, declarations=declarations))
    program = changed(program, modules=tuple(modules))
    return helpers.added_to(edit_routines(program, context, work, _ACTS_ON))


class _Calls(TextHoister):
    acts_on = _ACTS_ON

    def __init__(self, editor: Editor, helpers: Library) -> None:
        super().__init__(editor, self.ruled, helpers)
        self.capabilities = editor.capabilities

    # ---- statements

    def placed(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=ir.Index(base=base, indices=(place,)), value=sign) if self.cuts and isinstance(
                self.editor.type_of(base), ir.StringType
            ):
                put = self.helpers.call(PUT, base, place, sign)
                return super().placed(ir.Assign(base, put, origin=statement.origin))
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                routine = self.editor.scope.routine(name)
                if routine is not None and routine.kind == "function" and routine.returns is not None:
                    unused = self.editor.temporary("unused", self.editor.scope.resolve(routine.returns))
                    call = ir.Assign(unused, ir.Call(name, arguments), origin=statement.origin)
                    return super().placed(call)
            case ir.Do(procedure=procedure) if procedure not in self.capabilities.procedures:
                done = self.procedure(statement)
                if done is not None:
                    return tuple(inner for one in done for inner in super(_Calls, self).placed(one))
        return super().placed(statement)

    def procedure(self, statement: ir.Do) -> ir.Body | None:
        """A built-in procedure as assignments."""
        value: ir.Expression
        match statement.procedure, statement.arguments:
            case "increment" | "decrement" as name, (target, *rest) if target is not None:
                step = rest[0] if rest and rest[0] is not None else ir.IntLiteral(1)
                value = ir.Binary("+" if name == "increment" else "-", target, step)
            case "clear", (target,) if target is not None:
                value = ir.IntLiteral(0)
            case "text_clear", (target,) if target is not None:
                value = ir.TextLiteral("")
            case "text_copy", (target, text) if target is not None and text is not None:
                value = text
            case "text_append", (target, text) if target is not None and text is not None:
                value = ir.Binary("&", target, text)
            case "format_into", arguments:
                return self.formatted(statement, arguments)
            case "scan_from", arguments:
                return self.scanned(statement, arguments)
            case ("parse_number" | "parse_value") as name, arguments:
                read = self.parsed(name, arguments)
                unused = self.editor.temporary("unused", ir.BoolType())
                return None if read is None else (ir.Assign(unused, read, origin=statement.origin),)
            case _:
                return None
        return (ir.Assign(target, value, origin=statement.origin),)

    def scanned(self, statement: ir.Do, arguments: tuple[ir.Expression | None, ...]) -> ir.Body | None:
        """Numbers read by a format, where they can be read at all."""
        if not self.reads_numbers and "parse_number" not in self.capabilities.procedures:
            return None
        done = scanning.scanned(arguments, self.helpers.call, self.editor.temporary, self.whole)
        if done is None:
            return None
        self.editor.context.diagnostics.report(scanning.NO_STATE, statement.origin)
        return expansion(statement.origin, done)

    def formatted(self, statement: ir.Do, arguments: tuple[ir.Expression | None, ...]) -> ir.Body | None:
        """Formatted values behind the first `offset` characters of a text."""
        if len(arguments) < 4 or "&" not in self.capabilities.operators:
            return None
        buffer, _, offset, template, *values = arguments
        if buffer is None or not isinstance(template, ir.TextLiteral):
            return None
        text = self.from_template(template.value, [value for value in values if value is not None])
        if text is None:
            return None
        if offset is None or (is_constant(offset) and not isinstance(offset, ir.Name)):
            return (ir.Assign(buffer, text, origin=statement.origin),)
        kept = ir.Builtin("text_part", (buffer, ir.IntLiteral(1), offset))
        empty = ir.Binary("=", offset, ir.IntLiteral(0))
        branches = ((empty, (ir.Assign(buffer, text),)),)
        otherwise = (ir.Assign(buffer, ir.Binary("&", kept, text)),)
        length = ir.Assign(offset, ir.Builtin("text_length", (buffer,)))
        return expansion(statement.origin, (ir.If(branches, otherwise), length))

    # ---- expressions

    def ruled(self, expression: ir.Expression) -> Lowered | None:
        """The rule for one expression whose operands are done."""
        done: ir.Expression | None = None
        match expression:
            case ir.Builtin(function=name) if name in ir.PROCEDURES:
                return self.procedure_as_function(expression)
            case ir.Builtin(function=name):
                if name not in self.capabilities.functions:
                    done = self.function(expression) or self.text_function(expression)
            case ir.Binary():
                done = self.operator(expression)
            case ir.Unary(op="bnot", operand=operand) if "bnot" not in self.capabilities.operators:
                done = ir.Binary("-", ir.Unary("-", operand), ir.IntLiteral(1))
            case ir.Convert(how=how) if how not in self.capabilities.conversions:
                done = self.conversion(expression)
        if done is None:
            return self.text_statements(expression)
        return (), done if done.origin is expression.origin else replace(done, origin=expression.origin)

    def procedure_as_function(self, expression: ir.Builtin) -> Lowered | None:
        """`ok = StrAdd(a[], b[])` where procedures give no value: done, and then it has worked."""
        name = expression.function
        read = self.parsed(name, expression.arguments)
        if read is not None:
            return (), read
        has = name in self.capabilities.procedures
        if name in self.capabilities.functions or (has and self.builds):
            return None
        room = self.room_for(expression)
        if room is not None:
            return self.where_there_is_room(expression, room)
        if name == "text_append_length":
            return self.length_behind(expression)
        call = ir.Do(name, expression.arguments)
        done = (call,) if has else self.procedure(call)
        if done is None or name not in _ALWAYS_WORK:
            return None
        return tuple(inner for one in done for inner in super(_Calls, self).placed(one)), ir.BoolLiteral(True)

    def room_for(self, expression: ir.Builtin) -> ir.Expression | None:
        """Is there room for the longer text? None where its variable has no size of its own."""
        if expression.function not in _FILLING or len(expression.arguments) != 2:
            return None
        target, text = expression.arguments
        type = self.editor.type_of(target)
        if not isinstance(type, ir.StringType) or not isinstance(type.capacity, ir.IntLiteral):
            return None
        size: ir.Expression = ir.Builtin("text_length", (text,))
        if isinstance(text, ir.TextLiteral):
            size = ir.IntLiteral(len(text.value))
        elif isinstance(self.editor.type_of(text), ir.CharType):
            size = ir.IntLiteral(1)
        if expression.function != "text_copy":
            size = ir.Binary("+", ir.Builtin("text_length", (target,)), size)
        return ir.Binary("<=", size, type.capacity)

    def where_there_is_room(self, expression: ir.Builtin, room: ir.Expression) -> Lowered:
        """`ok = StrAdd(a[], b[])`: a text that is full stays as it is, and that is the result."""
        whole = expression.function == "text_append_length"
        result = self.editor.temporary("length" if whole else "fits", ir.IntType() if whole else ir.BoolType())
        target = expression.arguments[0]
        done: list[ir.Statement] = [
            ir.Do("text_copy" if expression.function == "text_copy" else "text_append", expression.arguments)
        ]
        if whole:
            done.append(ir.Assign(result, ir.Builtin("text_length", (target,))))
            first: ir.Body = (ir.Assign(result, ir.IntLiteral(0)),)
        else:
            done.append(ir.Assign(result, ir.BoolLiteral(True)))
            first = (ir.Assign(result, ir.BoolLiteral(False)),)
        choice = ir.If(((room, tuple(done)),), origin=expression.origin)
        body = self.body((*first, choice))
        return body, result

    def length_behind(self, expression: ir.Builtin) -> Lowered | None:
        """The length of a text behind appending to it; there is room enough in texts."""
        statements = self.placed(ir.Do("text_append", expression.arguments, origin=expression.origin))
        length = ir.Builtin("text_length", expression.arguments[:1], origin=expression.origin)
        first, value = self.ruled(length) or ((), length)
        return (*statements, *first), value

    def whole(self, *expressions: ir.Expression) -> bool:
        return all(isinstance(self.editor.type_of(one), ir.IntType) for one in expressions)

    def separates(self) -> bool:
        """Does the target tell whole numbers from real ones?"""
        return "IntType" in self.capabilities.types

    def can(self, function: str) -> bool:
        return function in self.capabilities.functions

    def operator(self, e: ir.Binary) -> ir.Expression | None:
        left, right, op = e.left, e.right, e.op
        match op:
            case "=" | "<>" | "<" | ">" | "<=" | ">=":
                return self.comparison(e)
            case "/" if self.separates() and self.whole(left, right):
                return replace(e, left=_real(left)) if is_constant(left) else replace(e, right=_real(right))
            case "div" if self.separates() and not self.whole(left, right):
                return self.truncated(ir.Binary("/", left, right))
            case "mod" if self.separates() and not self.whole(left, right):
                return self.helpers.call("rpl_mod", left, right)
            case "mod" if op not in self.capabilities.operators and self.repeatable(left) and self.repeatable(right):
                quotient = ir.Binary("div", left, right)
                return ir.Binary("-", left, ir.Binary("*", quotient, right))
            case "mod" if op not in self.capabilities.operators:
                return ir.Convert("round_half_away", self.helpers.call("rpl_mod", left, right))
            case "**" if op not in self.capabilities.operators:
                return self.power(left, right)
            case "xor" if op not in self.capabilities.operators:
                return replace(e, op="<>")
            case "band" | "bor" | "bxor" if op not in self.capabilities.operators:
                return self.helpers.call(_HELPER_OPERATORS[op], left, right)
            case "band" | "bor" | "bxor" if self.separates() and not self.whole(left, right):
                return replace(e, left=self.as_whole(left), right=self.as_whole(right))
        return None

    def as_whole(self, expression: ir.Expression) -> ir.Expression:
        if self.whole(expression):
            return expression
        return self.helpers.call("rpl_trunc", expression)

    def comparison(self, e: ir.Binary) -> ir.Expression | None:
        """A BOOL read as 0 or 1 and compared is the BOOL; texts compare by a function where they must."""
        for left, right, op in ((e.left, e.right, e.op), (e.right, e.left, _TURNED.get(e.op, e.op))):
            value = constant_number(right, self.editor.scope)
            match left, right:
                case ir.Convert(how=how, operand=one), ir.Convert(how=other_how, operand=other) if (
                    how == other_how and how in _BIT_WEIGHTS and op in ("=", "<>")
                ):
                    return ir.Binary(op, one, other)
                case ir.Convert(how=how, operand=bit), _ if how in _BIT_WEIGHTS and value is not None:
                    return _bit_test(op, bit, value, _BIT_WEIGHTS[how])
        if (
            e.op not in ("=", "<>")
            or RoutineRule.TEXT_RESULTS in self.capabilities.routines.rules
            or not self.can("text_equal")
        ):
            return None
        if not all(isinstance(self.editor.type_of(side), ir.StringType) for side in (e.left, e.right)):
            return None
        same = ir.Builtin("text_equal", (e.left, e.right))
        return same if e.op == "=" else ir.Unary("not", same)

    def power(self, base: ir.Expression, exponent: ir.Expression) -> ir.Expression:
        if self.can("power"):
            return ir.Builtin("power", (base, exponent))
        count = exponent.value if isinstance(exponent, ir.IntLiteral | ir.RealLiteral) else 0
        if count in range(1, _LONGEST_PRODUCT + 1) and self.repeatable(base):
            product = base
            for _ in range(int(count) - 1):
                product = ir.Binary("*", product, base)
            return product if not self.whole(base) else _real(product)
        return self.helpers.call("rpl_power", base, exponent)

    def repeatable(self, expression: ir.Expression) -> bool:
        """May it stand twice: a variable or a literal?"""
        return isinstance(expression, ir.Name) or is_constant(expression)

    def truncated(self, value: ir.Expression) -> ir.Expression:
        if self.can("trunc") or "trunc" in self.capabilities.conversions:
            return ir.Builtin("trunc", (value,)) if self.can("trunc") else ir.Convert("trunc", value)
        return self.helpers.call("rpl_trunc", value)

    def conversion(self, e: ir.Convert) -> ir.Expression | None:
        operand = e.operand
        match e.how:
            case "round_half_away" if self.can("round"):
                return ir.Builtin("round", (operand,))
            case "trunc":
                return self.truncated(operand)
            case "truth":
                return ir.Binary("<>", operand, ir.IntLiteral(0))
            case "bit" if isinstance(operand, ir.BoolLiteral):
                return ir.IntLiteral(int(operand.value))
            case "bit":
                if self._read_by_target(operand):
                    return None
                return self.helpers.call("rpl_bit", operand)
            case "minus_bit" if isinstance(operand, ir.BoolLiteral):
                return ir.Unary("-", ir.IntLiteral(1)) if operand.value else ir.IntLiteral(0)
            case "minus_bit" if "bit" in self.capabilities.conversions:
                return ir.Unary("-", ir.Convert("bit", operand))
            case "minus_bit":
                return self.helpers.call("rpl_minus_bit", operand)
            case "floor" if self.can("floor"):
                return ir.Builtin("floor", (operand,))
            case "floor":
                return self.helpers.call("rpl_floor", operand)
            case "code" if isinstance(operand, ir.TextLiteral) and len(operand.value) == 1:
                return ir.IntLiteral(ord(operand.value))
            case "char" if isinstance(operand, ir.IntLiteral) and operand.value in range(32, 127):
                return ir.TextLiteral(chr(operand.value))
            case "code" if self.can("character_code"):
                return ir.Builtin("character_code", (operand,))
            case "char" if self.can("from_code"):
                return ir.Builtin("from_code", (operand,))
        return None

    def _read_by_target(self, operand: ir.Expression) -> bool:
        """Where signals have names, they read as numbers."""
        return isinstance(operand, ir.Signal) and bool(self.capabilities.io.signal_prefixes)

    def function(self, e: ir.Builtin) -> ir.Expression | None:
        made = _FUNCTIONS.get(e.function)
        if made is not None:
            done = made(self, e.arguments)
            if done is not None:
                return done
        helper = _HELPER_FUNCTIONS.get(e.function)
        return self.helpers.call(helper, *e.arguments) if helper else None


def _log10(calls: _Calls, arguments: tuple[ir.Expression, ...]) -> ir.Expression | None:
    """By the natural logarithm."""
    natural = ir.Builtin("log", arguments) if calls.can("log") else calls.helpers.call("rpl_log", *arguments)
    return ir.Binary("/", natural, ir.RealLiteral(math.log(10.0)))


def _capacity(calls: _Calls, arguments: tuple[ir.Expression, ...]) -> ir.Expression | None:
    """The declared capacity of a text, where it is written in its declaration."""
    type = calls.editor.type_of(arguments[0])
    return type.capacity if isinstance(type, ir.StringType) and isinstance(type.capacity, ir.IntLiteral) else None


def _real(value: ir.Expression) -> ir.Expression:
    match value:
        case ir.IntLiteral(value=number):
            return ir.RealLiteral(float(number), origin=value.origin)
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number)):
            return replace(value, operand=ir.RealLiteral(float(number)))
    return ir.Binary("*", value, ir.RealLiteral(1.0))


def _bit_test(op: str, bit: ir.Expression, value: float, weight: int) -> ir.Expression:
    """`bit op value` for a bit that is 0 or `weight`."""
    tests = {
        "=": lambda b: b == value,
        "<>": lambda b: b != value,
        "<": lambda b: b < value,
        ">": lambda b: b > value,
        "<=": lambda b: b <= value,
        ">=": lambda b: b >= value,
    }
    when_set, when_clear = tests[op](weight), tests[op](0)
    if when_set == when_clear:
        return ir.BoolLiteral(when_set)
    return bit if when_set else ir.Unary("not", bit)


# ---- functions by expressions


Arguments = tuple[ir.Expression, ...]


def _round(calls: _Calls, given: Arguments) -> ir.Expression | None:
    if len(given) > 1 and given[1] != ir.IntLiteral(0):
        return calls.helpers.call("rpl_round", *given)
    if "round_half_away" in calls.capabilities.conversions:
        return ir.Convert("round_half_away", given[0])
    return None


def _trunc(calls: _Calls, given: Arguments) -> ir.Expression | None:
    if len(given) > 1 and given[1] != ir.IntLiteral(0):
        return calls.helpers.call("rpl_cut", *given)
    return calls.truncated(given[0])


def _least(helper: str) -> Callable[[_Calls, Arguments], ir.Expression | None]:
    def made(calls: _Calls, given: Arguments) -> ir.Expression | None:
        whole = calls.separates() and calls.whole(*given)
        return calls.helpers.call(f"{helper}_int" if whole else helper, *given)

    return made


def _sine(calls: _Calls, given: Arguments) -> ir.Expression | None:
    """Arc sine is 90 degrees less the arc cosine."""
    return ir.Binary("-", ir.RealLiteral(90.0), ir.Builtin("acos", given)) if calls.can("acos") else None


def _cosine(calls: _Calls, given: Arguments) -> ir.Expression | None:
    return ir.Binary("-", ir.RealLiteral(90.0), ir.Builtin("asin", given)) if calls.can("asin") else None


def _tangent(calls: _Calls, given: Arguments) -> ir.Expression | None:
    """Arc tangent is the angle of the vector (1, x)."""
    return ir.Builtin("atan2", (given[0], ir.RealLiteral(1.0))) if calls.can("atan2") else None


def _tan(calls: _Calls, given: Arguments) -> ir.Expression | None:
    if not (calls.can("sin") and calls.can("cos") and calls.repeatable(given[0])):
        return None
    return ir.Binary("/", ir.Builtin("sin", given), ir.Builtin("cos", given))


def _power(calls: _Calls, given: Arguments) -> ir.Expression | None:
    if "**" in calls.capabilities.operators:
        return ir.Binary("**", *given)
    return calls.power(*given)


def _size(calls: _Calls, given: Arguments) -> ir.Expression | None:
    """The size of an array that is declared with constant bounds, or of a text."""
    type = calls.editor.type_of(given[0])
    if isinstance(type, ir.StringType | ir.CharType):
        return ir.Builtin("text_length", given[:1])
    which = given[1].value if len(given) > 1 and isinstance(given[1], ir.IntLiteral) else 1
    if len(given) == 1 and calls.can("dimension"):
        return ir.Builtin("dimension", (given[0], ir.IntLiteral(1)))
    if isinstance(type, ir.ArrayType) and 0 < which <= len(type.dimensions):
        return type.dimensions[which - 1]
    return None


def _equal(calls: _Calls, given: Arguments) -> ir.Expression | None:
    """Texts compare by the operator; without regard to case both in upper case."""
    ignore = given[2] if len(given) > 2 else ir.BoolLiteral(False)
    if not isinstance(ignore, ir.BoolLiteral) or RoutineRule.TEXT_RESULTS not in calls.capabilities.routines.rules:
        return None
    left, right = given[0], given[1]
    if not ignore.value:
        return ir.Binary("=", left, right)
    if TextRule.CASE not in calls.capabilities.texts.rules:
        return ir.Builtin("text_equal", (left, right, ignore))  # the target compares so by itself
    return ir.Binary("=", *(_upper(calls, side) for side in (left, right)))


def _upper(calls: _Calls, text: ir.Expression) -> ir.Expression:
    if isinstance(text, ir.TextLiteral):
        return replace(text, value=text.value.upper())
    upper = ir.Builtin("text_upper", (text,))
    return calls.by_helpers(upper) or upper if calls.cuts else upper


def _fraction(calls: _Calls, given: Arguments) -> ir.Expression | None:
    if not calls.repeatable(given[0]):
        return None
    return ir.Binary("-", given[0], ir.Convert("real", calls.truncated(given[0])))


def _code(calls: _Calls, given: Arguments) -> ir.Expression | None:
    """The code of a text's first character, where the target tells that of a text of one character."""
    if (
        "code" not in calls.capabilities.conversions
        or RoutineRule.TEXT_RESULTS not in calls.capabilities.routines.rules
    ):
        return None
    match given[0]:
        case ir.TextLiteral(value=text) if text:
            return ir.IntLiteral(ord(text[0]))
        case ir.Builtin(function="text_part", arguments=(_, _, ir.IntLiteral(value=1))):
            return ir.Convert("code", given[0])
    first = ir.Builtin("text_part", (given[0], ir.IntLiteral(1), ir.IntLiteral(1)))
    return ir.Convert("code", first) if calls.can("text_part") else None


def _from_code(calls: _Calls, given: Arguments) -> ir.Expression | None:
    if (
        "char" not in calls.capabilities.conversions
        or RoutineRule.TEXT_RESULTS not in calls.capabilities.routines.rules
    ):
        return None
    return calls.text_function(ir.Builtin("from_code", given)) or ir.Convert("char", given[0])


_FUNCTIONS: dict[str, Callable[[_Calls, Arguments], ir.Expression | None]] = {
    "character_code": _code,
    "from_code": _from_code,
    "round": _round,
    "trunc": _trunc,
    "min": _least("rpl_min"),
    "max": _least("rpl_max"),
    "asin": _sine,
    "acos": _cosine,
    "atan": _tangent,
    "tan": _tan,
    "power": _power,
    "length": _size,
    "dimension": _size,
    "text_equal": _equal,
    "fraction": _fraction,
    "log10": _log10,
    "text_capacity": _capacity,
}
