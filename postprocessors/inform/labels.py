"""Labels of one job: at most eight characters, told apart where their beginnings are the same."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir
from rpl.passes.rewrite import visit_bodies
from rpl.writing.statements import CannotSayError

from . import tables


@dataclass(slots=True)
class Labels:
    """Name of the IR, folded -> label."""

    names: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, body: ir.Body) -> Labels:
        found = cls()
        wanted: list[str] = []

        def look(statements: ir.Body) -> ir.Body:
            for statement in statements:
                if isinstance(statement, ir.Label):
                    wanted.append(statement.name)
                visit_bodies(statement, look)
            return statements

        look(body)
        for name in wanted:  # those that may stay as they are come first
            if _spelled(name) == name:
                found.names[name.lower()] = name
        for name in wanted:
            if name.lower() not in found.names:
                found.names[name.lower()] = found.free(name)
        return found

    def free(self, name: str) -> str:
        stem, taken = _spelled(name), set(self.names.values())
        count, label = 1, stem
        while label in taken:
            count += 1
            label = f"{stem[: tables.LONGEST_LABEL - len(str(count))]}{count}"
        return label

    def fresh(self, name: str) -> str:
        label = self.free(name)
        self.names[f" {label}"] = label  # no label of a program has a blank
        return label

    def name(self, name: str) -> str:
        if name.lower() not in self.names:
            raise CannotSayError(f"there is no label {name}")
        return self.names[name.lower()]


_SIGNS = "_-"  # beside letters and digits, in jobs of plants (`*NO_PICK`); a longer name says more without them


def _spelled(name: str) -> str:
    plain = "".join(sign for sign in name.upper() if sign.isascii() and (sign.isalnum() or sign in _SIGNS))
    if len(plain) > tables.LONGEST_LABEL or not plain.strip(_SIGNS):
        plain = "".join(sign for sign in plain if sign.isalnum())
    return plain[: tables.LONGEST_LABEL] or "L"
