"""Number types: whole numbers of a language with one number type for targets with two, and the reverse.

From one type (RAPID num): what holds whole numbers only becomes INT, so that it can index, select and count; a
real number in such a place is rounded by a function (passes.legalise.wholesubscripts has looked at subscripts before).
Arithmetic that the target lacks (remainder, rounding, minimum, ...) goes by functions too. To one type: whole numbers
are declared as real, characters as texts.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import Fault
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import repeatable
from rpl.passes.legalise.facts.values.wholes import Wholes, place_key
from rpl.passes.legalise.rewriting.library import Library
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

_INT, _REAL = ir.IntType(), ir.RealType()
_POWER_LIMIT = 4


@legalising()
def numbers(program: ir.Program, context: Context) -> ir.Program:
    """Number types in the target's form."""
    types = context.capabilities.types
    if "IntType" in types:
        one_type = not any(isinstance(one, ir.IntType) for one in rules_of(context.source).type_names.values())
        program = _Split(program, context, one_type).program()
    if not {"IntType", "CharType"} <= types:
        program = _Joined(program, context).program()
    return program


class _Joined(Rewriter):
    """To a target without a type of whole numbers or of characters."""

    acts_on = frozenset(("IntType", "CharType", "Convert"))

    def type(self, type: ir.Type) -> ir.Type:
        have = self.context.capabilities.types
        if isinstance(type, ir.IntType) and "IntType" not in have:
            return _REAL
        if isinstance(type, ir.CharType) and "CharType" not in have:
            return ir.StringType(ir.IntLiteral(1))
        return super().type(type)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Convert(how="code", operand=operand) if "CharType" not in self.context.capabilities.types:
                return ir.Builtin("character_code", (self.expression(operand),), origin=expression.origin)
            case ir.Convert(how="char", operand=operand) if "CharType" not in self.context.capabilities.types:
                return ir.Builtin("from_code", (self.expression(operand),), origin=expression.origin)
        return super().expression(expression)


class _Split(Rewriter):
    """To a target that tells whole numbers from real ones."""

    def __init__(self, program: ir.Program, context: Context, one_type: bool) -> None:
        super().__init__(program, context)
        self.wholes = Wholes.of(program, self.scopes) if one_type else None
        self.library = Library(context, ("wholenumbers",))

    def program(self) -> ir.Program:
        done = super().program()
        task = done.modules[0].task if done.modules else ""
        return self.library.added_to(done, task)

    def made(self, key: str, *arguments: ir.Expression) -> ir.Call:
        """A call of the function brought along."""
        return self.library.call(f"rpl_{key}", *arguments)

    # ---- types

    def whole_type(self, type: ir.Type) -> ir.Type:
        """The type with INT for its numbers."""
        match self.scope.resolve(type):
            case ir.RealType():
                return _INT
            case ir.ArrayType(element=element) as array:
                return replace(array, element=self.whole_type(element))
        return type

    def declared(self, key: int | tuple[int, str], type: ir.Type) -> ir.Type:
        whole = self.wholes is not None and self.wholes.is_whole(key)
        return self.whole_type(type) if whole else type

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        match declaration:
            case ir.Variable():
                done = super().declaration(declaration)
                return [
                    replace(one, type=self.declared(id(declaration), one.type)) if isinstance(one, ir.Variable) else one
                    for one in done
                ]
            case ir.RecordDeclaration(fields=fields):
                key = id(declaration)
                new = tuple((name, self.declared((key, name.lower()), type)) for name, type in fields)
                return [replace(declaration, fields=new)]
        return super().declaration(declaration)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        done = super().routine(module, routine)
        parameters = tuple(
            replace(new, type=self.declared(id(old), new.type))
            for new, old in zip(done.parameters, routine.parameters, strict=True)
        )
        returns = None if done.returns is None else self.declared(id(routine), done.returns)
        return replace(done, parameters=parameters, returns=returns)

    def counter_type(self, statement: ir.For) -> ir.Type:
        if self.wholes is not None and self.wholes.counts_whole(statement):
            return _INT
        return super().counter_type(statement)

    def counting(self, statement: ir.For) -> ir.Body:
        """A whole counter goes to a whole bound: the last one that it can reach."""
        fractional = not self.is_int(statement.stop) and isinstance(self.type_of(statement.stop), ir.RealType)
        if not fractional or not self.whole_counter(statement):
            return super().counting(statement)
        start, stop = self.expression(statement.start), self.expression(statement.stop)
        step = None if statement.step is None else constant_number(statement.step, self.scope)
        if statement.step is None and statement.automatic:
            last: ir.Expression = self.made("bound", start, stop)
        else:
            last = self.made("ceil" if step is not None and step < 0 else "floor", stop)
        done = super().counting(statement)
        return tuple(replace(one, stop=last) if isinstance(one, ir.For) else one for one in done)

    def whole_counter(self, statement: ir.For) -> bool:
        if statement.scoped:
            return isinstance(self.counter_type(statement), ir.IntType)
        return self.is_int(ir.Name(statement.counter))

    # ---- expressions

    def is_int(self, old: ir.Expression) -> bool:
        """Will the expression, once rewritten, be of type INT?"""
        match old:
            case ir.Name() | ir.Index() | ir.Field():
                type = self.type_of(old)
                if isinstance(type, ir.IntType):
                    return True
                key = place_key(old, self.scope)
                return isinstance(type, ir.RealType) and self.wholes is not None and key is not None and (
                    self.wholes.is_whole(key)
                )  # fmt: skip
            case ir.Unary(op="-" | "+", operand=operand):
                return self.is_int(operand)
            case ir.Binary(op="+" | "-" | "*", left=left, right=right):
                return self.is_int(left) and self.is_int(right)
            case ir.Binary(op="mod", left=left, right=right):
                return self.is_whole(left) and self.is_whole(right)
            case ir.Binary(op="div"):
                return True
            case ir.Builtin(function="abs" | "min" | "max", arguments=arguments):
                return all(map(self.is_int, arguments))
            case ir.Builtin(function="round" | "trunc" as function, arguments=(_,)):
                return not self.has(function)
            case ir.Call(name=name):
                routine = self.scope.routine(name)
                if routine is not None and self.wholes is not None and isinstance(routine.returns, ir.RealType):
                    return self.wholes.is_whole(id(routine))
        return isinstance(self.type_of(old), ir.IntType)

    def has(self, function: str) -> bool:
        return function in self.context.capabilities.functions

    def whole(self, old: ir.Expression) -> ir.Expression:
        """The expression where only an INT may stand."""
        new = self.expression(old)
        if self.is_int(old) or self.type_of(old) is None:
            return new
        return self.made("round", new) if isinstance(self.type_of(old), ir.RealType) else new

    def subscript(self, old: ir.Expression) -> ir.Expression:
        """A subscript: rounded only where the controller would not stop at a fraction, as the source's does."""
        return (
            self.expression(old) if Fault.INDEX_FRACTION in self.context.capabilities.errors.faults else self.whole(old)
        )

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Index(base=base, indices=indices):
                return replace(expression, base=self.expression(base), indices=tuple(map(self.subscript, indices)))
            case ir.System(indices=indices) if indices:
                return replace(expression, indices=tuple(map(self.whole, indices)))
            case ir.Signal(index=index, last=last) if index is not None:
                return replace(expression, index=self.whole(index), last=None if last is None else self.whole(last))
            case ir.Binary(op="div", left=left, right=right) if not (self.is_whole(left) and self.is_whole(right)):
                return self.cut(expression)
            case ir.Binary(op="mod", left=left, right=right) if not (self.is_whole(left) and self.is_whole(right)):
                return self.remainder(expression)
            case ir.Binary(op="div" | "mod" as op, left=left, right=right):
                return self.divided(expression, op, self.whole(left), self.whole(right))
            case ir.Binary(op="**", left=base, right=exponent) if not self.can("**"):
                return self.power(expression, base, exponent)
            case ir.Builtin(function="power", arguments=(base, exponent)) if not self.has("power"):
                return self.power(expression, base, exponent)
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Convert(how=how, operand=operand) if how in ("trunc", "round_half_away"):
                return self.converted(expression, how, operand)
        return super().expression(expression)

    def can(self, op: str) -> bool:
        return op in self.context.capabilities.operators

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=target, value=value) if self.is_int(target):
                place = self.expression(target)
                match value:
                    case ir.Builtin(function="round", arguments=(inner,)) | ir.Convert("round_half_away", inner):
                        if not self.is_int(inner) and not self.has("round"):
                            rounded = ir.Convert("round_half_away", self.expression(inner), origin=value.origin)
                            return [replace(statement, target=place, value=rounded)]
                return [replace(statement, target=place, value=self.expression(value))]
        return super().statement(statement)

    def converted(self, expression: ir.Convert, how: str, operand: ir.Expression) -> ir.Expression:
        """A conversion inside an expression: a function, where the target converts only what it stores."""
        new = self.expression(operand)
        if self.is_int(operand):
            return new
        function = "round" if how == "round_half_away" else "trunc"
        if self.has(function):
            return replace(expression, operand=new)
        return self.made(function, new)

    def is_whole(self, old: ir.Expression) -> bool:
        return self.is_int(old) or not isinstance(self.type_of(old), ir.RealType)

    def cut(self, old: ir.Binary) -> ir.Expression:
        """A whole division of what may be fractional (7.9 div 2 is 3): the quotient, cut."""
        quotient = ir.Binary("/", self.expression(old.left), self.expression(old.right), origin=old.origin)
        if self.has("trunc"):
            return ir.Builtin("trunc", (quotient,), origin=old.origin)
        return self.made("trunc", quotient)

    def remainder(self, old: ir.Binary) -> ir.Expression:
        """What is left of a number that may be fractional (7.5 mod 2 is 1.5)."""
        left, right = self.expression(old.left), self.expression(old.right)
        if not (repeatable(left) and repeatable(right)):
            return self.made("mod_real", left, right)
        quotient = ir.Binary("/", left, right, origin=old.origin)
        if self.has("trunc"):
            cut: ir.Expression = ir.Builtin("trunc", (quotient,), origin=old.origin)
        else:
            cut = self.made("trunc", quotient)
        return ir.Binary("-", left, ir.Binary("*", cut, right), origin=old.origin)

    def divided(self, old: ir.Binary, op: str, left: ir.Expression, right: ir.Expression) -> ir.Expression:
        if self.can(op):
            return replace(old, left=left, right=right)
        if op == "mod" and self.can("div") and repeatable(left) and repeatable(right):
            quotient = ir.Binary("div", left, right, origin=old.origin)
            return ir.Binary("-", left, ir.Binary("*", quotient, right), origin=old.origin)
        return self.made("mod", left, right) if op == "mod" else replace(old, left=left, right=right)

    def power(self, old: ir.Expression, base: ir.Expression, exponent: ir.Expression) -> ir.Expression:
        """A small whole power as a product; any other is left to be reported."""
        new = self.expression(base)
        if isinstance(exponent, ir.IntLiteral) and 1 <= exponent.value <= _POWER_LIMIT and repeatable(new):
            product = new
            for _ in range(exponent.value - 1):
                product = ir.Binary("*", product, new, origin=old.origin)
            return product
        return rewrite_parts(old, self.expression)

    def builtin(self, expression: ir.Builtin) -> ir.Expression:
        name, arguments = expression.function, expression.arguments
        row = ir.FUNCTIONS.get(name)
        kinds = row.parameters.replace("?", "").replace("*", "") if row else ""
        new = tuple(
            self.whole(one) if at < len(kinds) and kinds[at] == "i" else self.expression(one)
            for at, one in enumerate(arguments)
        )
        if self.has(name):
            return replace(expression, arguments=new)
        match name, new:
            case (("round" | "trunc"), (one,)):
                return one if self.is_int(arguments[0]) else self.made(name, one)
            case (("round" | "trunc"), (_, _)):
                return self.made(f"{name}_to", *new)
            case (("floor" | "ceil"), _):
                return new[0] if self.is_int(arguments[0]) else self.made(name, *new)
            case (("min" | "max"), (_, _)):
                key = f"{name}_whole" if all(map(self.is_int, arguments)) else name
                return self.made(key, *new)
            case "asin", (one,):
                return self.made("asin", one)
            case "atan", (one,):
                return ir.Builtin("atan2", (one, ir.RealLiteral(1.0)), origin=expression.origin)
        return replace(expression, arguments=new)
