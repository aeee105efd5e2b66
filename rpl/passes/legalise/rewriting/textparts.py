"""Helper routines for texts on controllers that cut texts into parts and join them, and can look at nothing else.

They need `text_part`, `text_length`, `&` and the comparison of texts; what is said of letters concerns those of ASCII.
Each has the name of the helper that does the same where a text is an array of characters (see helpers).
"""

from __future__ import annotations

from typing import Final

from rpl.passes.capabilities import Capabilities, RoutineRule, TextRule

# Functions of the IR -> helper.
FUNCTIONS: Final = {
    "text_find": "rpl_text_find",
    "text_find_any": "rpl_text_find_any",
    "text_match": "rpl_text_match",
    "text_member": "rpl_text_member",
    "text_upper": "rpl_text_upper",
    "text_lower": "rpl_text_lower",
    "text_map": "rpl_text_map",
    "from_code": "rpl_from_code",
    "character_code": "rpl_character_code",
}
NUMBER_TEXT, PUT = "rpl_number_text", "rpl_text_put"
PARSE_REAL, PARSE_WHOLE = "rpl_parse_number", "rpl_parse_whole"


def by_parts(capabilities: Capabilities) -> bool:
    """Does the target have texts as values with these few operations, in numbered storage or by its own word?"""
    has = {"text_part", "text_length"} <= capabilities.functions and "&" in capabilities.operators
    stored = bool(capabilities.storage.banks) or TextRule.PARTS in capabilities.texts.rules
    return has and stored and RoutineRule.TEXT_RESULTS in capabilities.routines.rules


_LOWER, _UPPER = "abcdefghijklmnopqrstuvwxyz", "ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def _mapped(name: str, olds: str, news: str) -> str:
    return f"""
FUNCTION {name}(t: STRING): STRING
    VAR done: STRING
    done = rpl_text_map(t, "{olds}", "{news}")
    RETURN done
END FUNCTION
"""


# Characters in the order of their codes, without those that a text of a listing may not hold; what is none of them
# stops the program.
_SIGNS, _FIRST_SIGN = "()*+,-./0123456789:", ord("(")
_CAPITALS, _FIRST_CAPITAL = "<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ", ord("<")
_SMALL, _FIRST_SMALL = _LOWER, ord("a")
_ALONE = " #_"


def _from_code() -> str:
    alone = "".join(f'    IF code = {ord(sign)} THEN RETURN "{sign}"\n' for sign in _ALONE)
    ranges = "".join(
        f"""    IF code >= {first} AND code <= {first + len(signs) - 1} THEN
        sign = text_part("{signs}", code - {first - 1}, 1)
        RETURN sign
    END IF
"""
        for signs, first in ((_SIGNS, _FIRST_SIGN), (_CAPITALS, _FIRST_CAPITAL), (_SMALL, _FIRST_SMALL))
    )
    return f"""
FUNCTION rpl_from_code(code: INT): STRING
    VAR sign: STRING
{alone}{ranges}    MESSAGE "no such character"
    HALT
    sign = ""
    RETURN sign
END FUNCTION
"""


def _character_code() -> str:
    alone = "".join(f'    IF sign = "{sign}" THEN RETURN {ord(sign)}\n' for sign in _ALONE)
    ranges = "".join(
        f"""    found = rpl_text_find("{signs}", 1, sign)
    IF found > 0 THEN RETURN found + {first - 1}
"""
        for signs, first in ((_CAPITALS, _FIRST_CAPITAL), (_SIGNS, _FIRST_SIGN), (_SMALL, _FIRST_SMALL))
    )
    return f"""
FUNCTION rpl_character_code(t: STRING): INT
    VAR sign: STRING
    VAR found: INT
    sign = text_part(t, 1, 1)
{ranges}{alone}    MESSAGE "no such character"
    HALT
    RETURN 0
END FUNCTION
"""


TEXTS: Final[dict[str, str]] = {
    "rpl_from_code": _from_code(),
    "rpl_character_code": _character_code(),
    "rpl_text_find": """
FUNCTION rpl_text_find(t: STRING, first: INT, wanted: STRING): INT
    VAR i: INT
    VAR size: INT
    VAR last: INT
    VAR part: STRING
    size = text_length(wanted)
    last = text_length(t) - size + 1
    FOR i = first TO last
        part = text_part(t, i, size)
        IF part = wanted THEN RETURN i
    END FOR
    RETURN 0
END FUNCTION
""",
    "rpl_text_match": """
FUNCTION rpl_text_match(t: STRING, first: INT, wanted: STRING): INT
    VAR found: INT
    found = rpl_text_find(t, first, wanted)
    IF found = 0 THEN found = text_length(t) + 1
    RETURN found
END FUNCTION
""",
    "rpl_text_member": """
FUNCTION rpl_text_member(t: STRING, place: INT, signs: STRING): BOOL
    VAR sign: STRING
    VAR found: INT
    sign = text_part(t, place, 1)
    found = rpl_text_find(signs, 1, sign)
    RETURN found > 0
END FUNCTION
""",
    "rpl_text_find_any": """
FUNCTION rpl_text_find_any(t: STRING, first: INT, signs: STRING): INT
    VAR i: INT
    VAR last: INT
    VAR found: BOOL
    last = text_length(t)
    FOR i = first TO last
        found = rpl_text_member(t, i, signs)
        IF found THEN RETURN i
    END FOR
    RETURN last + 1
END FUNCTION
""",
    "rpl_text_map": """
FUNCTION rpl_text_map(t: STRING, olds: STRING, news: STRING): STRING
    VAR i: INT
    VAR last: INT
    VAR found: INT
    VAR sign: STRING
    VAR done: STRING
    done = ""
    last = text_length(t)
    FOR i = 1 TO last
        sign = text_part(t, i, 1)
        found = rpl_text_find(olds, 1, sign)
        IF found > 0 THEN sign = text_part(news, found, 1)
        done = done & sign
    END FOR
    RETURN done
END FUNCTION
""",
    "rpl_text_upper": _mapped("rpl_text_upper", _LOWER, _UPPER),
    "rpl_text_lower": _mapped("rpl_text_lower", _UPPER, _LOWER),
    PUT: """
FUNCTION rpl_text_put(t: STRING, place: INT, sign: STRING): STRING
    VAR part: STRING
    VAR done: STRING
    VAR rest: INT
    done = sign
    IF place > 1 THEN
        part = text_part(t, 1, place - 1)
        done = part & sign
    END IF
    rest = text_length(t) - place
    IF rest > 0 THEN
        part = text_part(t, place + 1, rest)
        done = done & part
    END IF
    RETURN done
END FUNCTION
""",
    # Halves go away from zero; what is rounded to nothing has no sign.
    NUMBER_TEXT: """
FUNCTION rpl_number_text(x: REAL, decimals: INT): STRING
    VAR size: REAL
    VAR scale: REAL
    VAR before: INT
    VAR behind: INT
    VAR i: INT
    VAR done: STRING
    VAR part: STRING
    size = abs(x)
    scale = 1.0
    FOR i = 1 TO decimals
        scale = scale * 10.0
    END FOR
    before = to_int(size)
    behind = to_nearest((size - before) * scale)
    IF behind >= scale THEN
        before = before + 1
        behind = 0
    END IF
    done = number_text(before, 0)
    IF decimals > 0 THEN
        part = number_text(behind, 0)
        WHILE text_length(part) < decimals
            part = "0" & part
        END WHILE
        done = done & "."
        done = done & part
    END IF
    IF x < 0 AND before + behind > 0 THEN done = "-" & done
    RETURN done
END FUNCTION
""",
    # A sign, digits with a point somewhere, an exponent; blanks around them. state: 0 nothing yet, 1 in the number,
    # 2 behind E, 3 in the exponent, 9 behind the number.
    PARSE_REAL: """
FUNCTION rpl_parse_number(t: STRING, REFERENCE value: REAL): BOOL
    VAR i: INT
    VAR last: INT
    VAR digits: INT
    VAR state: INT
    VAR points: INT
    VAR kind: INT
    VAR sign: STRING
    last = text_length(t)
    digits = 0
    points = 0
    state = 0
    FOR i = 1 TO last
        sign = text_part(t, i, 1)
        kind = rpl_text_find("0123456789+-.Ee ", 1, sign)
        IF kind = 0 THEN RETURN FALSE
        IF kind <= 10 THEN
            IF state = 9 THEN RETURN FALSE
            digits = digits + 1
            IF state = 0 THEN state = 1
            IF state = 2 THEN state = 3
        END IF
        IF kind = 11 OR kind = 12 THEN
            IF state <> 0 AND state <> 2 THEN RETURN FALSE
            state = state + 1
        END IF
        IF kind = 13 THEN
            IF state > 1 OR points > 0 THEN RETURN FALSE
            points = 1
            state = 1
        END IF
        IF kind = 14 OR kind = 15 THEN
            IF state <> 1 OR digits = 0 THEN RETURN FALSE
            state = 2
            digits = 0
        END IF
        IF kind = 16 AND state > 0 THEN
            IF digits = 0 THEN RETURN FALSE
            state = 9
        END IF
    END FOR
    IF digits = 0 THEN RETURN FALSE
    value = text_value(t)
    RETURN TRUE
END FUNCTION
""",
    PARSE_WHOLE: """
FUNCTION rpl_parse_whole(t: STRING, REFERENCE value: INT): BOOL
    VAR x: REAL
    VAR whole: INT
    VAR good: BOOL
    x = 0.0
    good = rpl_parse_number(t, x)
    IF NOT good THEN RETURN FALSE
    whole = to_nearest(x)
    IF whole <> x THEN RETURN FALSE
    value = whole
    RETURN TRUE
END FUNCTION
""",
}
