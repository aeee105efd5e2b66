"""Routines that a translated program brings along for functions its new controller does not have.

They are written in RPL, one text each, and read when first asked for; a program gets only those it uses, once, in the
module `rpl_support`. Their names are made free in the program.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import InternalError
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.rewriting import scanning, textparts
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.typing import normalise
from rpl.source import NOWHERE, source_from_text

_NAME = re.compile(r"\brpl_\w+")
_TEXT_REFERENCE = re.compile(r"REFERENCE (?=\w+: STRING)")

_TEXTS: dict[str, str] = {
    "rpl_trunc": """
FUNCTION rpl_trunc(x: REAL): INT
    VAR whole: INT
    whole = to_nearest(x)
    IF x >= 0 AND whole > x THEN whole = whole - 1
    IF x < 0 AND whole < x THEN whole = whole + 1
    RETURN whole
END FUNCTION
""",
    "rpl_floor": """
FUNCTION rpl_floor(x: REAL): INT
    VAR whole: INT
    whole = to_nearest(x)
    IF whole > x THEN whole = whole - 1
    RETURN whole
END FUNCTION
""",
    "rpl_ceil": """
FUNCTION rpl_ceil(x: REAL): INT
    VAR whole: INT
    whole = to_nearest(x)
    IF whole < x THEN whole = whole + 1
    RETURN whole
END FUNCTION
""",
    "rpl_round": """
FUNCTION rpl_round(x: REAL, decimals: INT): REAL
    VAR scale: REAL
    VAR whole: INT
    VAR i: INT
    scale = 1.0
    FOR i = 1 TO decimals
        scale = scale * 10.0
    END FOR
    whole = to_nearest(x * scale)
    RETURN to_real(whole) / scale
END FUNCTION
""",
    "rpl_cut": """
FUNCTION rpl_cut(x: REAL, decimals: INT): REAL
    VAR scale: REAL
    VAR i: INT
    scale = 1.0
    FOR i = 1 TO decimals
        scale = scale * 10.0
    END FOR
    RETURN to_real(rpl_trunc(x * scale)) / scale
END FUNCTION
""",
    "rpl_mod": """
FUNCTION rpl_mod(a: REAL, b: REAL): REAL
    RETURN a - to_real(rpl_trunc(a / b)) * b
END FUNCTION
""",
    "rpl_min": """
FUNCTION rpl_min(a: REAL, b: REAL): REAL
    IF b < a THEN RETURN b
    RETURN a
END FUNCTION
""",
    "rpl_max": """
FUNCTION rpl_max(a: REAL, b: REAL): REAL
    IF b > a THEN RETURN b
    RETURN a
END FUNCTION
""",
    "rpl_min_int": """
FUNCTION rpl_min_int(a: INT, b: INT): INT
    IF b < a THEN RETURN b
    RETURN a
END FUNCTION
""",
    "rpl_max_int": """
FUNCTION rpl_max_int(a: INT, b: INT): INT
    IF b > a THEN RETURN b
    RETURN a
END FUNCTION
""",
    "rpl_bit": """
FUNCTION rpl_bit(b: BOOL): INT
    IF b THEN RETURN 1
    RETURN 0
END FUNCTION
""",
    "rpl_minus_bit": """
FUNCTION rpl_minus_bit(b: BOOL): INT
    IF b THEN RETURN -1
    RETURN 0
END FUNCTION
""",
    # e to the power: x = k ln 2 + r with r small, a series for r, then k doublings or halvings
    "rpl_exp": """
FUNCTION rpl_exp(x: REAL): REAL
    VAR rest: REAL
    VAR term: REAL
    VAR sum: REAL
    VAR k: INT
    VAR i: INT
    k = rpl_floor(x / 0.693147180559945)
    rest = x - to_real(k) * 0.693147180559945
    sum = 1.0
    term = 1.0
    FOR i = 1 TO 18
        term = term * rest / to_real(i)
        sum = sum + term
    END FOR
    FOR i = 1 TO k
        sum = sum * 2.0
    END FOR
    FOR i = 1 TO -k
        sum = sum / 2.0
    END FOR
    RETURN sum
END FUNCTION
""",
    # natural logarithm: x = m 2^k with m near 1, then twice the area tangent of (m-1)/(m+1)
    "rpl_log": """
FUNCTION rpl_log(x: REAL): REAL
    VAR m: REAL
    VAR z: REAL
    VAR term: REAL
    VAR sum: REAL
    VAR k: INT
    VAR i: INT
    m = x
    k = 0
    IF m <= 0 THEN
        m = sqrt(-1.0)
        RETURN m
    END IF
    WHILE m > 1.5
        m = m / 2.0
        k = k + 1
    END WHILE
    WHILE m < 0.75
        m = m * 2.0
        k = k - 1
    END WHILE
    z = (m - 1.0) / (m + 1.0)
    term = z
    sum = 0.0
    FOR i = 0 TO 12
        sum = sum + term / to_real(2 * i + 1)
        term = term * z * z
    END FOR
    RETURN 2.0 * sum + to_real(k) * 0.693147180559945
END FUNCTION
""",
    "rpl_power": """
FUNCTION rpl_power(a: REAL, b: REAL): REAL
    VAR factor: REAL
    VAR result: REAL
    VAR whole: INT
    VAR half: INT
    whole = to_nearest(b)
    IF to_real(whole) <> b THEN
        IF a = 0 THEN RETURN 0.0
        RETURN rpl_exp(b * rpl_log(a))
    END IF
    factor = a
    result = 1.0
    IF whole < 0 THEN
        factor = 1.0 / a
        whole = -whole
    END IF
    WHILE whole > 0
        half = whole DIV 2
        IF whole - 2 * half = 1 THEN result = result * factor
        factor = factor * factor
        whole = half
    END WHILE
    RETURN result
END FUNCTION
""",
    # Two's complement of any length: what holds of non-negative numbers carries over by -1 - x for the complement. No
    # helper calls itself, because not every target can.
    "rpl_band": """
FUNCTION rpl_band(a: INT, b: INT): INT
    VAR x: INT
    VAR y: INT
    VAR bit: INT
    VAR sum: INT
    x = a
    y = b
    IF x < 0 THEN x = -1 - x
    IF y < 0 THEN y = -1 - y
    bit = 1
    sum = 0
    WHILE x > 0 AND y > 0
        IF x - 2 * (x DIV 2) = 1 AND y - 2 * (y DIV 2) = 1 THEN sum = sum + bit
        x = x DIV 2
        y = y DIV 2
        bit = bit * 2
    END WHILE
    IF a < 0 AND b < 0 THEN RETURN a + b + 1 + sum
    IF a < 0 THEN RETURN b - sum
    IF b < 0 THEN RETURN a - sum
    RETURN sum
END FUNCTION
""",
    "rpl_bor": """
FUNCTION rpl_bor(a: INT, b: INT): INT
    RETURN a + b - rpl_band(a, b)
END FUNCTION
""",
    "rpl_bxor": """
FUNCTION rpl_bxor(a: INT, b: INT): INT
    RETURN a + b - 2 * rpl_band(a, b)
END FUNCTION
""",
    "rpl_sign": """
FUNCTION rpl_sign(x: REAL): REAL
    IF x < 0.0 THEN RETURN -1.0
    IF x > 0.0 THEN RETURN 1.0
    RETURN 0.0
END FUNCTION
""",
    "rpl_shift_left": """
FUNCTION rpl_shift_left(a: INT, count: INT): INT
    VAR value: INT
    VAR i: INT
    value = a
    FOR i = 1 TO count
        value = value * 2
    END FOR
    RETURN value
END FUNCTION
""",
    "rpl_shift_right": """
FUNCTION rpl_shift_right(a: INT, count: INT): INT
    VAR value: INT
    VAR i: INT
    value = a
    FOR i = 1 TO count
        IF value < 0 THEN value = value - 1
        value = value DIV 2
    END FOR
    RETURN value
END FUNCTION
""",
    "rpl_text_part": """
PROCEDURE rpl_text_part(REFERENCE result: STRING, REFERENCE t: STRING, first: INT, count: INT)
    VAR i: INT
    IF first < 1 OR count < 0 OR first + count - 1 > text_length(t) THEN
        MESSAGE "A part of a text is outside"
        HALT
    END IF
    text_clear(result)
    FOR i = 1 TO count
        result[i] = t[first + i - 1]
    END FOR
END PROCEDURE
""",
    "rpl_text_upper": """
PROCEDURE rpl_text_upper(REFERENCE result: STRING, REFERENCE t: STRING)
    VAR i: INT
    VAR sign: INT
    text_clear(result)
    FOR i = 1 TO text_length(t)
        sign = to_code(t[i])
        IF sign >= 97 AND sign <= 122 THEN sign = sign - 32
        result[i] = to_char(sign)
    END FOR
END PROCEDURE
""",
    "rpl_text_lower": """
PROCEDURE rpl_text_lower(REFERENCE result: STRING, REFERENCE t: STRING)
    VAR i: INT
    VAR sign: INT
    text_clear(result)
    FOR i = 1 TO text_length(t)
        sign = to_code(t[i])
        IF sign >= 65 AND sign <= 90 THEN sign = sign + 32
        result[i] = to_char(sign)
    END FOR
END PROCEDURE
""",
    "rpl_text_map": """
PROCEDURE rpl_text_map(REFERENCE result: STRING, REFERENCE t: STRING, REFERENCE olds: STRING, REFERENCE news: STRING)
    VAR i: INT
    VAR k: INT
    VAR sign: INT
    text_clear(result)
    FOR i = 1 TO text_length(t)
        sign = to_code(t[i])
        FOR k = text_length(olds) TO 1 STEP -1
            IF to_code(t[i]) = to_code(olds[k]) THEN sign = to_code(news[k])
        END FOR
        result[i] = to_char(sign)
    END FOR
END PROCEDURE
""",
    # Target's own reading of a number; a text without one stops the program, as it does where it comes from.
    "rpl_text_value": """
FUNCTION rpl_text_value(REFERENCE t: STRING): REAL
    VAR value: REAL
    VAR good: BOOL
    good = parse_number(t, value)
    IF NOT good THEN
        MESSAGE "no number in a text"
        HALT
    END IF
    RETURN value
END FUNCTION
""",
    "rpl_character_code": """
FUNCTION rpl_character_code(REFERENCE t: STRING): INT
    VAR code: INT
    code = to_code(t[1])
    RETURN code
END FUNCTION
""",
    "rpl_from_code": """
PROCEDURE rpl_from_code(REFERENCE result: STRING, code: INT)
    text_clear(result)
    result[1] = to_char(code)
END PROCEDURE
""",
    "rpl_padded": """
FUNCTION rpl_padded(t: STRING, width: INT): STRING
    VAR done: STRING
    done = t
    WHILE text_length(done) < width
        done = " " & done
    END WHILE
    RETURN done
END FUNCTION
""",
    "rpl_text_member": """
FUNCTION rpl_text_member(REFERENCE t: STRING, place: INT, REFERENCE signs: STRING): BOOL
    VAR k: INT
    FOR k = 1 TO text_length(signs)
        IF to_code(t[place]) = to_code(signs[k]) THEN RETURN TRUE
    END FOR
    RETURN FALSE
END FUNCTION
""",
    "rpl_text_find_any": """
FUNCTION rpl_text_find_any(REFERENCE t: STRING, first: INT, REFERENCE signs: STRING): INT
    VAR i: INT
    FOR i = first TO text_length(t)
        IF rpl_text_member(t, i, signs) THEN RETURN i
    END FOR
    RETURN text_length(t) + 1
END FUNCTION
""",
    "rpl_text_match": """
FUNCTION rpl_text_match(REFERENCE t: STRING, first: INT, REFERENCE wanted: STRING): INT
    VAR i: INT
    i = text_find(t, first, wanted)
    IF i = 0 THEN i = text_length(t) + 1
    RETURN i
END FUNCTION
""",
}


class Helpers:
    """The helper routines that a program needs, by the names they get in it."""

    def __init__(self, context: Context, more: Mapping[str, str] | None = None) -> None:
        """`more`: texts of routines that only some programs can ask for."""
        self.context = context
        self.names: dict[str, str] = {}
        by_parts = textparts.by_parts(context.capabilities)
        read = "rpl_parse_number(" if by_parts else "parse_number("
        found = scanning.TEXT if by_parts else scanning.TEXT.replace("rpl_text_find(", "text_match(")
        scan = {scanning.SCAN: found.replace("rpl_parse_number(", read)}
        self.texts = (_TEXTS | textparts.TEXTS if by_parts else _TEXTS) | scan
        self.texts = self.texts | dict(more or {})

    def name(self, helper: str) -> str:
        """The name under which the program can call this helper."""
        if helper not in self.names:
            self.names[helper] = self.context.fresh(helper)
            for needed in sorted(set(_NAME.findall(self.texts[helper])) - {helper}):
                self.name(needed)
        return self.names[helper]

    def call(self, helper: str, *arguments: ir.Expression) -> ir.Call:
        return ir.Call(self.name(helper), tuple(ir.Argument(value) for value in arguments))

    def added_to(self, program: ir.Program) -> ir.Program:
        """The program with the helpers asked for."""
        if not self.names:
            return program
        text = "\n".join(self.texts[helper] for helper in self.names)
        if RoutineRule.TEXT_RESULTS in self.context.capabilities.routines.rules:
            text = _TEXT_REFERENCE.sub("", text)  # texts are values there
        text = _NAME.sub(lambda match: self.names.get(match[0], match[0]), text)
        read = _read(text)
        inside = names_in(read) - {module.name.lower() for module in read.modules}
        self.context.taken |= inside  # what later passes add to the helpers gets other names
        routines = [replace(_nowhere(routine), scope="global") for routine in read.modules[0].routines]
        return with_support(program, self.context, (), routines)


@lru_cache(maxsize=64)
def _read(text: str) -> ir.Program:
    """Helper routines as a program; many programs ask for the same ones."""
    diagnostics = Diagnostics()
    source = source_from_text("rpl_support.rpl", f"MODULE rpl_support\n{text}END MODULE\n")
    read = normalise(registry.dialect("rpl").read([source], diagnostics).program, diagnostics)
    if diagnostics.has_errors or not read.modules:
        raise InternalError(f"helper routines: {[item.as_text() for item in diagnostics]}")
    return read


def _nowhere(routine: ir.Routine) -> ir.Routine:
    """Helpers have no place in the user's sources."""
    declarations = tuple(replace(declaration, origin=NOWHERE) for declaration in routine.declarations)
    return replace(routine, origin=NOWHERE, declarations=declarations, body=_bare(routine.body))


def _bare(body: ir.Body) -> ir.Body:
    def expression(node: ir.Expression) -> ir.Expression:
        return replace(rewrite_parts(node, expression), origin=NOWHERE)

    def statements(inner: ir.Body) -> ir.Body:
        return tuple(replace(rewrite_parts(one, expression, statements), origin=NOWHERE) for one in inner)

    return statements(body)
