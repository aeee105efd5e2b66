"""Flags that the controller evaluates all the time (`cyclic_flag[2] := in1 or in2`), for targets that have none: the
expression stands wherever the flag is read.

A flag with one definition in front of all its readings is just that expression. Otherwise a variable keeps which
definition holds, and the flag is false before the first. An expression that cannot stand at a reading (it names data
that is not seen there, calls a routine, or leads back to its flag) is refused where it is given.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope

LOST = code(
    "cyclic-flag-lost",
    Severity.LOSS,
    "the target has no flags that its controller evaluates all the time, and {why}",
    "read the condition itself where the flag is read",
)
_FLAG = "cyclic_flag"
_JUMPS = (ir.Label, ir.Goto)


@legalising(unless=lambda context: _FLAG in context.capabilities.system_variables, sees=(f"system {_FLAG}",))
def cyclic_flags(program: ir.Program, context: Context) -> ir.Program:
    """The program without flags that are evaluated cyclically."""
    if not _has_flags(program):
        return program
    seen = _Seen(program, context)
    seen.program()
    for flag in seen.flags.values():
        flag.why = flag.why or seen.computed or _why(flag, seen.flags)
    done = _Read(program, context, seen).program()
    data = tuple(flag.variable for flag in seen.flags.values() if flag.variable is not None)
    if not data:
        return done
    first = done.modules[0]
    home = ir.Module(context.fresh("rpl_cyclic_flags"), first.dialect, data, task=first.task, public=True)
    return replace(done, modules=(*done.modules, home))


def _has_flags(program: ir.Program) -> bool:
    return any(isinstance(node, ir.System) and node.name == _FLAG for node in walk_for({"System"}, program))


@dataclass(slots=True)
class _Flag:
    """`values`: its definitions, each once, with the declarations that its names mean. `read_before`: it is read at a
    place that its definition need not have come to. `why`: the reason that it is refused."""

    number: int
    values: list[tuple[ir.Expression, dict[str, int]]] = field(default_factory=list)
    given: int = 0
    read_before: bool = False
    scopes: list[Scope] = field(default_factory=list)
    why: str = ""
    variable: ir.Variable | None = None

    @property
    def at_once(self) -> bool:
        """Is every reading behind the only definition?"""
        return self.given == 1 and not self.read_before


def _why(flag: _Flag, flags: dict[int, _Flag]) -> str:
    """The reason that a flag's definitions cannot stand where it is read; empty when they can."""
    for value, names in flag.values:
        if any(isinstance(node, ir.Call) for node in walk(value)):
            return "the expression calls a routine"
        for scope in flag.scopes:
            for name, declaration in names.items():
                symbol = scope.value(name)
                if symbol is None or id(symbol.declaration) != declaration:
                    return f"{name} is not seen where the flag is read"
    if _leads_back(flag.number, flag, flags, set()):
        return "the flag is defined by its own value"
    return ""


def _leads_back(number: int, flag: _Flag, flags: dict[int, _Flag], passed: set[int]) -> bool:
    for value, _ in flag.values:
        for node in walk(value):
            match node:
                case ir.System(name="cyclic_flag", indices=(ir.IntLiteral(value=other),)):
                    if other == number:
                        return True
                    if other in flags and other not in passed:
                        passed.add(other)
                        if _leads_back(number, flags[other], flags, passed):
                            return True
    return False


class _Seen(Rewriter):
    """Where each flag is given an expression and where it is read."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.flags: dict[int, _Flag] = {}
        self.computed = ""
        self.behind: set[int] = set()
        self.depth = 0

    def flag(self, number: int) -> _Flag:
        return self.flags.setdefault(number, _Flag(number))

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.behind, self.depth = set(), 0
        jumps = any(isinstance(node, _JUMPS) for node in walk(routine))
        self.depth = 1 if jumps else 0
        return super().routine(module, routine)

    def body(self, body: ir.Body) -> ir.Body:
        self.depth += 1
        done = super().body(body)
        self.depth -= 1
        return done

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=ir.System(name="cyclic_flag", indices=(ir.IntLiteral(value=number),)), value=value):
                self.expression(value)
                self.define(number, value)
                return [statement]
            case ir.Assign(target=ir.System(name="cyclic_flag")):
                self.computed = "the flag's number is computed"
        return super().statement(statement)

    def actions(self, body: ir.Body) -> ir.Body:
        for one in body:
            if isinstance(one, ir.Assign) and isinstance(one.target, ir.System) and one.target.name == _FLAG:
                self.computed = "a trigger or an interrupt gives the flag its value"
        return super().actions(body)

    def define(self, number: int, value: ir.Expression) -> None:
        flag = self.flag(number)
        names: dict[str, int] = {}
        for node in walk(value):
            symbol = self.scope.value(node.id) if isinstance(node, ir.Name) else None
            if isinstance(node, ir.Name) and symbol is not None:
                names[node.id] = id(symbol.declaration)
        flag.given += 1
        if value not in [known for known, _ in flag.values]:
            flag.values.append((value, names))
        if self.depth == 1:
            self.behind.add(number)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.System(name="cyclic_flag", indices=(ir.IntLiteral(value=number),)):
                flag = self.flag(number)
                flag.scopes.append(self.scope)
                flag.read_before = flag.read_before or number not in self.behind
            case ir.System(name="cyclic_flag"):
                self.computed = "the flag's number is computed"
        return rewrite_parts(expression, self.expression)


class _Read(Rewriter):
    """The expressions at the readings, and what is left of the definitions."""

    def __init__(self, program: ir.Program, context: Context, seen: _Seen) -> None:
        super().__init__(program, context)
        self.flags = seen.flags

    def holds(self, flag: _Flag) -> ir.Variable:
        """The variable that says which definition holds: whether there is one, its number, or the value itself."""
        if flag.variable is None:
            numbered = len(flag.values) > 1 and not _plain(flag)
            type: ir.Type = ir.IntType() if numbered else ir.BoolType()
            initial: ir.Expression = ir.IntLiteral(0) if numbered else ir.BoolLiteral(False)
            name = self.context.fresh(f"cyclic_flag_{flag.number}")
            flag.variable = ir.Variable(name, type, initial, "persistent", "global")
        return flag.variable

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=ir.System(name="cyclic_flag", indices=indices), value=value, origin=origin):
                flag = self.flags.get(indices[0].value) if isinstance(indices[0], ir.IntLiteral) else None
                if flag is None or flag.why:
                    why = flag.why if flag is not None else "the flag's number is computed"
                    self.context.diagnostics.report(LOST, origin, why=why)
                    return [ir.Vendor(self.context.source, origin.text.strip(), "unknown", origin=origin)]
                if flag.at_once:
                    return [ir.Nothing(origin=origin)]
                name = ir.Name(self.holds(flag).name)
                return [ir.Assign(name, self.kept(flag, value), origin=origin)]
        return super().statement(statement)

    def kept(self, flag: _Flag, value: ir.Expression) -> ir.Expression:
        """What the variable gets where the flag is given this expression."""
        if _plain(flag):
            return value
        if len(flag.values) == 1:
            return ir.BoolLiteral(True)
        return ir.IntLiteral(1 + [known for known, _ in flag.values].index(value))

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.System(name="cyclic_flag", indices=(ir.IntLiteral(value=number),)) if number in self.flags:
                flag = self.flags[number]
                return expression if flag.why else self.reading(flag, expression)
        return rewrite_parts(expression, self.expression)

    def reading(self, flag: _Flag, expression: ir.Expression) -> ir.Expression:
        if not flag.values:
            return ir.BoolLiteral(False, origin=expression.origin)
        if flag.at_once:
            return self.expression(flag.values[0][0])
        name = ir.Name(self.holds(flag).name, origin=expression.origin)
        if _plain(flag):
            return name
        if len(flag.values) == 1:
            return ir.Binary("and", name, self.expression(flag.values[0][0]), origin=expression.origin)
        parts: list[ir.Expression] = []
        for number, (value, _) in enumerate(flag.values, 1):
            chosen = ir.Binary("=", name, ir.IntLiteral(number))
            if value == ir.BoolLiteral(False):
                continue
            always = value == ir.BoolLiteral(True)
            parts.append(chosen if always else ir.Binary("and", chosen, self.expression(value)))
        whole = parts[0]
        for part in parts[1:]:
            whole = ir.Binary("or", whole, part, origin=expression.origin)
        return whole


def _plain(flag: _Flag) -> bool:
    """Is the flag only ever given TRUE or FALSE?"""
    return all(isinstance(value, ir.BoolLiteral) for value, _ in flag.values)
