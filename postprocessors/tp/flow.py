"""Labels by number, and the short forms of IF."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from rpl import ir
from rpl.passes.rewrite import visit_bodies
from rpl.source import Origin
from rpl.writing.statements import CannotSayError

from . import tables
from .expressions import Expressions
from .texts import comment

_NUMBERED = re.compile(r"(?:lbl|label|l)?[_\[]?(\d+)\]?", re.IGNORECASE)


class If(NamedTuple):
    condition: ir.Expression
    body: ir.Body
    otherwise: ir.Body


@dataclass(slots=True)
class Labels:
    """The label numbers of one program: a number in the name stays, the others take the next free one."""

    numbers: dict[str, int] = field(default_factory=dict)
    comments: dict[int, str] = field(default_factory=dict)

    @classmethod
    def of(cls, body: ir.Body) -> Labels:
        """Numbers for all labels of a body."""
        found = cls()
        labels = list(_labels(body))
        for label in labels:
            name = label.name
            match = _NUMBERED.fullmatch(name)
            number = int(match[1]) if match is not None else 0
            if 0 < number <= tables.LAST_LABEL and number not in found.comments:
                found.numbers[name.lower()] = number
                found.comments[number] = comment(said_of(label))
        for label in labels:
            if label.name.lower() not in found.numbers:
                found.numbers[label.name.lower()] = found.fresh(said_of(label) or label.name.replace("_", " "))
        return found

    def number(self, name: str) -> int:
        if name.lower() not in self.numbers:
            written = _NUMBERED.fullmatch(name)
            if (
                written is not None
                and 0 < int(written[1]) <= tables.LAST_LABEL
                and int(written[1]) not in self.comments
            ):
                return int(written[1])  # a listing that jumps to a label it does not have keeps doing so
            raise CannotSayError(f"there is no label {name}")
        return self.numbers[name.lower()]

    def text(self, name: str) -> str:
        return self.shown(self.number(name))

    def origin(self, label: ir.Label) -> Origin:
        """The label's origin without the remark that its brackets hold."""
        shown = self.comments[self.number(label.name)]
        kept = tuple(one for one in label.origin.comments if not (one.behind and one.text.strip() == shown))
        return replace(label.origin, comments=kept)

    def shown(self, number: int) -> str:
        """The number and its comment, as they stand at the label itself."""
        label = self.comments.get(number, "")
        return f"{number}{':' + label if label else ''}"

    def fresh(self, label: str) -> int:
        """The next free number."""
        number = next((n for n in range(1, tables.LAST_LABEL + 1) if n not in self.comments), None)
        if number is None:
            raise CannotSayError("there are no more label numbers")
        self.comments[number] = comment(label)
        return number


def said_of(label: ir.Label) -> str:
    """The remark on the label's own line."""
    return next((one.text.strip() for one in label.origin.comments if one.behind), "")


def _labels(body: ir.Body) -> Iterator[ir.Label]:
    found: list[ir.Label] = []

    def look(statements: ir.Body) -> ir.Body:
        for statement in statements:
            if isinstance(statement, ir.Label):
                found.append(statement)
            visit_bodies(statement, look)
        return statements

    look(body)
    yield from found


def single_jump(statement: ir.Statement | None) -> tuple[ir.Expression, str] | None:
    """The condition and label of `if condition then goto label`."""
    match statement:
        case ir.If(branches=((condition, (ir.Goto(label=label),)),), otherwise=()):
            return condition, label
    return None


def choice(found: If, expressions: Expressions, labels: Labels, call: Callable[[ir.CallRoutine], str]) -> str | None:
    """`IF R[1]=5,JMP LBL[3]` or `IF DI[1]=ON,CALL X`; None when it needs a block."""
    if found.otherwise:
        return None
    match found.body:
        case (ir.Goto(label=label),):
            return f"IF {expressions.condition(found.condition)},JMP LBL[{labels.number(label)}]"
        case (ir.CallRoutine() as routine,):
            return f"IF {expressions.condition(found.condition)},{call(routine).rstrip()}"
    return None
