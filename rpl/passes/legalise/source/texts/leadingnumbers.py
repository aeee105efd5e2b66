"""Numbers read from a text that may go on behind them (V+ VAL), for targets where such a text is an error: a function
of the program reads it sign by sign. It gives 0 where no number begins, as the source does; what is written out becomes
its number.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.helpers import Helpers
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.numeric import written_number
from rpl.passes.scope import rules_of

_HELPER = "rpl_leading_number"
# `part`: 0 blanks in front, 1 digits, 2 behind the point, 3 to 5 the power of ten, 6 behind ^, 7 the number is over.
# The digits are gathered as a whole number and divided once: 12.25 is 1225 / 100.
_TEXT = """
FUNCTION rpl_leading_number(t: STRING): REAL
    VAR i: INT
    VAR sign: INT
    VAR part: INT
    VAR base: INT
    VAR digit: INT
    VAR places: INT
    VAR power: INT
    VAR direction: INT
    VAR value: REAL
    VAR factor: REAL
    VAR minus: BOOL
    part = 0
    base = 10
    places = 0
    power = 0
    direction = 1
    value = 0.0
    factor = 1.0
    minus = FALSE
    FOR i = 1 TO text_length(t)
        sign = character_code(text_part(t, i, 1))
        IF sign >= 97 THEN sign = sign - 32
        digit = 99
        IF sign >= 48 AND sign <= 57 THEN digit = sign - 48
        IF base = 16 AND sign >= 65 AND sign <= 70 THEN digit = sign - 55
        IF part = 6 THEN
            part = 1
            IF sign = 66 THEN
                base = 2
                sign = 0
            END IF
            IF sign = 72 THEN
                base = 16
                sign = 0
            END IF
        END IF
        IF part = 0 AND digit < 10 THEN part = 1
        IF part = 0 THEN
            IF sign = 43 OR sign = 45 THEN
                minus = sign = 45
                part = 1
            ELSE IF sign = 94 THEN
                base = 8
                part = 6
            ELSE IF sign = 46 THEN
                part = 2
            ELSE IF sign <> 32 AND sign <> 9 THEN
                part = 7
            END IF
        ELSE IF part <= 2 AND digit < base THEN
            value = value * base + digit
            IF part = 2 THEN places = places + 1
        ELSE IF part = 1 AND sign = 46 AND base = 10 THEN
            part = 2
        ELSE IF part <= 2 AND sign = 69 AND base = 10 THEN
            part = 3
        ELSE IF part = 3 AND (sign = 43 OR sign = 45) THEN
            part = 4
            IF sign = 45 THEN direction = -1
        ELSE IF part >= 3 AND part <= 5 AND digit < 10 THEN
            part = 5
            power = power * 10 + digit
        ELSE IF sign > 0 THEN
            part = 7
        END IF
    END FOR
    power = power * direction - places
    FOR i = 1 TO power
        factor = factor * 10.0
    END FOR
    FOR i = power TO -1
        factor = factor * 10.0
    END FOR
    IF power < 0 THEN value = value / factor
    IF power > 0 THEN value = value * factor
    IF minus THEN RETURN -value
    RETURN value
END FUNCTION
"""


@legalising(
    unless=lambda context: (
        TextRule.LEADING_NUMBERS in context.capabilities.texts.rules
        or context.capabilities.carries_rules
        or not rules_of(context.source).leading_numbers
    ),
    sees=("function text_value",),
)
def leading_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that read texts which hold nothing but a number."""
    worker = _Leading(program, context)
    return worker.helpers.added_to(worker.program())


class _Leading(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.helpers = Helpers(context, {_HELPER: _TEXT})
        self.marks = rules_of(context.source).number_marks

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        match done:
            case ir.Builtin(function="text_value", arguments=(ir.TextLiteral(value=text),)):
                number = written_number(text, self.marks, leading=True) or 0
                size = ir.RealLiteral(abs(float(number)))
                return ir.Unary("-", size, origin=done.origin) if number < 0 else size
            case ir.Builtin(function="text_value", arguments=(text,)):
                return self.helpers.call(_HELPER, text)
        return done


__all__ = ["leading_numbers"]
