"""Why a statement is refused, where every target has the same reason: only another controller has it, it was not
read, or it names what no file of the project declares. Each has a code of its own, which says what is to be done.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.passes.legalise.facts.usage import each_expression

__all__ = ["UNDECLARED_PLACE", "UNKNOWN_ROUTINE", "refusal"]

_BY_HAND = "the program stops there; write the line by hand"
FOREIGN = code("other-controllers-instruction", Severity.LOSS, "only {reason} has this instruction", _BY_HAND)
FOREIGN_VALUE = code(
    "other-controllers-value", Severity.LOSS, "only another controller has the value {reason}", _BY_HAND
)
UNREAD = code("unread-instruction", Severity.LOSS, "this could not be read: {reason}", _BY_HAND)
UNKNOWN_WORD = code(
    "undeclared-enumeration",
    Severity.LOSS,
    "#{reason} belongs to an enumeration that is not in what was read",
    "give all files of the project",
)
UNDECLARED_PLACE = code(
    "undeclared-place",
    Severity.LOSS,
    "{reason} is not declared in what was read, or there was no number left for it",
    "give all files of the project, or declare it",
)
UNKNOWN_ROUTINE = code(
    "undeclared-routine",
    Severity.LOSS,
    "{reason} is not in what was read: how it takes its arguments is not known",
    "give all files of the project",
)


def refusal(statement: ir.Statement, dialect: str) -> tuple[Code, str] | None:
    """The code and what its report names, when the statement itself says why `dialect` cannot say it."""
    match statement:
        case ir.Vendor(dialect=owner) if owner != dialect:
            return FOREIGN, owner
        case ir.Opaque(text=text):
            return UNREAD, _short(text)
    found: list[tuple[Code, str]] = []

    def look(expression: ir.Expression) -> None:
        match expression:
            case ir.VendorValue(dialect=owner, text=text) if owner != dialect:
                found.append((FOREIGN_VALUE, _short(text)))
            case ir.EnumLiteral(member=member) if isinstance(statement, ir.CallRoutine):
                found.append((UNKNOWN_WORD, member))

    each_expression(statement, look)
    return found[0] if found else None


def _short(text: str) -> str:
    one = " ".join(text.split())
    return one if len(one) <= 40 else f"{one[:39]}..."
