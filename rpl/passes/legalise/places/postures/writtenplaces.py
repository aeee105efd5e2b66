"""Places as they are written out: which aggregates may be points, whether somebody taught them, and where flags of the
arm configuration go among their entries.
"""

from __future__ import annotations

from rpl import ir

_EXTERNAL = frozenset(ir.COMPONENTS[ir.ExternalType])


def may_be_point(expression: ir.Aggregate) -> bool:
    word = expression.type_name
    return word is None or word.startswith(("target", "joints"))


def check(name: str, value: bool) -> ir.Assign:
    return ir.Assign(ir.System(name), ir.BoolLiteral(value))


def inserted(
    entries: list[tuple[str, ir.Expression]], extra: list[tuple[str | None, ir.Expression]]
) -> tuple[tuple[str | None, ir.Expression], ...]:
    at = next((i for i, (name, _) in enumerate(entries) if name == "ext" or name in _EXTERNAL), len(entries))
    return (*entries[:at], *extra, *entries[at:])


def is_taught(expression: ir.Aggregate) -> bool:
    """A target that only serves as a placeholder has no posture worth a report."""

    def numbers(value: ir.Expression) -> list[float]:
        match value:
            case ir.Aggregate(entries=entries):
                return [number for _, one in entries for number in numbers(one)]
            case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
                return [float(number)]
        return []

    return any(number not in (0.0, 1.0) and abs(number) < 9e8 for number in numbers(expression))
