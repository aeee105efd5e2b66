"""Lines of data sections (`.LOCATIONS`, `.REALS`, `.DOUBLES`, `.STRINGS`): a name and its values, as stored to disk."""

from __future__ import annotations

import re
from dataclasses import dataclass

from rpl import ir
from rpl.reading.shapes import StatementError

_DATUM = re.compile(r"(?P<name>[$#%]?[A-Za-z_][\w.]*)[ \t]*(?:\[(?P<indices>[\d,\s]*)\])?[ \t]*=?[ \t]*(?P<rest>.*)")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_MOST_INDEX = 100_000


@dataclass(frozen=True, slots=True)
class Line:
    """What a line gives a value to, by its indices if it is an element."""

    name: str
    indices: tuple[int, ...]
    values: tuple[ir.Expression, ...]


def datum(section: str, text: str) -> Line:
    """One line. Raises StatementError when it does not fit its section."""
    found = _DATUM.fullmatch(text)
    if found is None:
        raise StatementError("a data section has lines of a name and its values", 0)
    indices = tuple(int(part) for part in (found["indices"] or "").split(",") if part.strip())
    if any(index > _MOST_INDEX for index in indices):
        raise StatementError(f"the index {max(indices)} is too large", 0)
    rest, name = found["rest"].strip(), found["name"]
    if section == ".STRINGS":
        if not name.startswith("$") or len(rest) < 2 or rest[0] != '"' or rest[-1] != '"':
            raise StatementError('a line of .STRINGS is $name "text"', 0)
        return Line(name, indices, (ir.TextLiteral(rest[1:-1]),))
    numbers = [part for part in re.split(r"[\s,]+", rest) if part]
    if not numbers or not all(_NUMBER.fullmatch(part) for part in numbers):
        raise StatementError("only numbers can stand behind the name", 0)
    values = tuple(_number(part) for part in numbers)
    _check(section, name, len(values))
    return Line(name, indices, values)


def _check(section: str, name: str, count: int) -> None:
    if section in (".REALS", ".DOUBLES"):
        if count != 1 or name[0] in "$#%":
            raise StatementError(f"a line of {section} is a name and one number", 0)
    elif name[0] in "$%" or (count != 6 and name[0] != "#") or count > 6:
        raise StatementError("a location has six numbers, a precision point one for each joint", 0)


def _number(text: str) -> ir.Expression:
    sign, digits = (text[0], text[1:]) if text[0] in "+-" else ("", text)
    value: ir.Expression
    if digits.isdigit() and len(digits) < 10:
        value = ir.IntLiteral(int(digits), digits)
    else:
        value = ir.RealLiteral(float(digits), digits)
    return ir.Unary("-", value) if sign == "-" else value
