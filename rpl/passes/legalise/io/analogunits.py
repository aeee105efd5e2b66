"""Analogue values in the unit of the target's controller: KRL's 0.5 of full scale are 5 V for INFORM, 1000 counts for a
controller whose converter counts to 2000.

What one number stands for is fixed by a language, said by a program, or told by the cell file (`[analog.LANGUAGE]`).
Where the I/O configuration alone knows it, the statement is refused: a bare number would be another voltage.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.ir.analog import AnalogRange
from rpl.passes.analog import AnalogRanges
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.source import NOWHERE, Origin

UNKNOWN = code(
    "analog-unit-unknown",
    Severity.LOSS,
    "what a number of the analogue signal {name} stands for in {language} is said by the controller's I/O"
    " configuration alone",
    'say it in the cell file: [analog.{language}] "{name}" = {{ numbers = [0, 1], volts = [0, 10] }}',
    stops=True,
)
OTHER_UNIT = code(
    "analog-other-unit",
    Severity.LOSS,
    "the analogue signal {name} is a {unit} signal in {language}, and a {other} signal in {target}",
    "wire it to a channel of the same kind, and say so in the cell file ([analog.LANGUAGE])",
    stops=True,
)
USUAL = code(
    "analog-usual-range",
    Severity.WARNING,
    "the analogue signal {name} is taken as {text} ({language}), as the controller's modules are as a rule",
    "where the I/O configuration is another one, say it in the cell file ([analog.{language}])",
)
_KINDS = ("analog_in", "analog_out")
_SWAPPED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "=": "=", "<>": "<>"}
_DIGITS = 12


@legalising(sees=("signal analog_in", "signal analog_out"))
def analog_units(program: ir.Program, context: Context) -> ir.Program:
    """For all targets; a signal with the same range on both controllers stays as it is."""
    languages = {module.dialect for module in program.modules}
    known = {one: context.analog.get(one) or AnalogRanges(one) for one in (*languages, context.target)}
    worker = _Units(context, known, known[context.target])
    for module in program.modules:
        for routine in module.routines:
            worker.languages[id(routine)] = module.dialect

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        worker.scope = editor.scope
        worker.language = worker.languages[id(routine)]
        return edit_bodies(routine, worker.body)

    return edit_routines(program, context, work)


@dataclass(slots=True)
class _Units:
    context: Context
    sources: dict[str, AnalogRanges]
    target: AnalogRanges
    languages: dict[int, str] = field(default_factory=dict)
    language: str = ""
    scope: Scope | None = None
    at: Origin = NOWHERE
    told: set[str] = field(default_factory=set)

    # ---- what a signal's numbers stand for

    def signal(self, expression: ir.Expression) -> tuple[ir.Signal, str] | None:
        """The analogue signal that an expression is, and its own name (empty: it has a number only)."""
        if isinstance(expression, ir.Signal):
            return (expression, expression.name or "") if expression.kind in _KINDS else None
        if isinstance(expression, ir.Name) and self.scope is not None:
            symbol = self.scope.value(expression.id)
            if symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration):
                signal = symbol.declaration.signal
                return (signal, symbol.declaration.name) if signal.kind in _KINDS else None
        return None

    def ranges(self, signal: ir.Signal, own: str) -> tuple[AnalogRange, AnalogRange] | None:
        """Its range here and on the target's controller; None where it must not pass, which is reported."""
        number = signal.index.value if isinstance(signal.index, ir.IntLiteral) else None
        names = {name for name in (own, signal.name) if name}
        prefix = self.context.capabilities.io.signal_prefixes.get(signal.kind)
        further = {f"{prefix}{number}"} if prefix and number is not None else set()
        here = self.sources[self.language].of(signal.kind, number, names)
        there = self.target.of(signal.kind, number, names | further)
        shown = own or signal.name or self.shown(signal.kind, number)
        report = self.context.diagnostics.report
        if here is None or there is None:
            language = self.language if here is None else self.context.target
            report(UNKNOWN, self.at, name=shown, language=language)
            return None
        if here.unit != there.unit:
            target = self.context.target
            report(OTHER_UNIT, self.at, name=shown, unit=here.unit, language=self.language, other=there.unit,
                   target=target)  # fmt: skip
            return None
        for language, one in ((self.language, here), (self.context.target, there)):
            same = _factors(here, there) == (1.0, 0.0)
            if one.usual and not same and f"{shown} {language}" not in self.told:
                self.told.add(f"{shown} {language}")
                report(USUAL, self.at, name=shown, text=one.text, language=language)
        return here, there

    def shown(self, kind: str, number: int | None) -> str:
        if number is None:
            return "with a computed number"
        return registry.dialect(self.language).signal_name(kind, number)

    def refused(self, text: str) -> ir.VendorValue:
        return ir.VendorValue(self.language, text, ir.RealType())

    # ---- rewriting

    def body(self, body: ir.Body) -> ir.Body:
        done = tuple(self.statement(statement) for statement in body)
        return body if all(new is old for new, old in zip(done, body, strict=True)) else done

    def statement(self, statement: ir.Statement) -> ir.Statement:
        before, self.at = self.at, statement.origin if statement.origin is not NOWHERE else self.at
        done = self.changed(statement)
        self.at = before
        return done

    def changed(self, statement: ir.Statement) -> ir.Statement:
        match statement:
            case ir.Assign(target=target, value=value) if (found := self.signal(target)) is not None:
                return replace(statement, value=self.written(found, value))
            case ir.SetAfter(signal=signal, value=value, delay=delay) if (found := self.signal(signal)) is not None:
                return replace(statement, value=self.written(found, value), delay=self.expression(delay))
        return rewrite_parts(statement, self.expression, self.body)

    def written(self, found: tuple[ir.Signal, str], value: ir.Expression) -> ir.Expression:
        """The value for the target's output."""
        ranges = self.ranges(*found)
        if ranges is None:
            return self.refused(self.at.text.strip() or "an analogue value")
        factor, offset = _factors(*ranges)
        inner = self.expression(value)
        return inner if (factor, offset) == (1.0, 0.0) else self.scaled(inner, factor, offset)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Binary(op=op, left=left, right=right) if op in _SWAPPED:
                for one, other, swap in ((left, right, False), (right, left, True)):
                    limit = _number(other)
                    if limit is not None and (found := self.signal(one)) is not None:
                        return self.compared(expression, found, limit, swap)
        found = self.signal(expression)
        if found is None:
            return rewrite_parts(expression, self.expression)
        ranges = self.ranges(*found)
        if ranges is None:
            return self.refused(found[1] or "an analogue value")
        here, there = ranges
        factor, offset = _factors(there, here)
        return expression if (factor, offset) == (1.0, 0.0) else self.scaled(expression, factor, offset)

    def compared(self, comparison: ir.Binary, found: tuple[ir.Signal, str], limit: float, swap: bool) -> ir.Expression:
        """A comparison with a number: the number becomes one of the target."""
        ranges = self.ranges(*found)
        read, op = (comparison.right, _SWAPPED[comparison.op]) if swap else (comparison.left, comparison.op)
        if ranges is None:
            return replace(comparison, op=op, left=self.refused(found[1] or "an analogue value"),
                           right=ir.RealLiteral(limit))  # fmt: skip
        factor, offset = _factors(*ranges)
        if (factor, offset) == (1.0, 0.0):
            return comparison
        op = _SWAPPED[op] if factor < 0.0 else op
        return replace(comparison, op=op, left=read, right=ir.RealLiteral(_neat(limit * factor + offset)))

    def scaled(self, value: ir.Expression, factor: float, offset: float) -> ir.Expression:
        """value * factor + offset, worked out where the value is a number."""
        known = _number(value)
        if known is not None:
            return ir.RealLiteral(_neat(known * factor + offset), origin=value.origin)
        if self.scope is not None and isinstance(type_of(value, self.scope), ir.IntType):
            value = ir.Convert("real", value, origin=value.origin)
        inverse = _neat(1.0 / factor)
        divided = abs(factor) < 1.0 and inverse == round(inverse)
        made = ir.Binary("/" if divided else "*", value, ir.RealLiteral(inverse if divided else _neat(factor)),
                         origin=value.origin)  # fmt: skip
        if offset == 0.0:
            return made
        return ir.Binary("+" if offset > 0.0 else "-", made, ir.RealLiteral(abs(offset)), origin=value.origin)


def _factors(here: AnalogRange, there: AnalogRange) -> tuple[float, float]:
    """a, b of the straight line from a number here to the one there that stands for the same level: a * x + b."""
    at_zero = there.number(here.level(0.0))
    return _neat(there.number(here.level(1.0)) - at_zero), _neat(at_zero)


def _neat(value: float) -> float:
    """Without the noise of the last bits."""
    return float(f"{value:.{_DIGITS}g}")


def _number(value: ir.Expression) -> float | None:
    match value:
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return float(number)
        case ir.Unary(op="-", operand=operand):
            inner = _number(operand)
            return None if inner is None else -inner
        case ir.Convert(how="real", operand=operand):
            return _number(operand)
    return None


__all__ = ["analog_units"]
