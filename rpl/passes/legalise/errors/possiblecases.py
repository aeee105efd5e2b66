"""Choices by data that only ever holds some members of an enumeration: the other cases are left out.

Data that a controller keeps for its inline forms names modes of interpolation that no program of the project chooses.
A target without such a mode would stop there for nothing. Conservative and by name: fields of one name count as one,
whatever record they belong to; what is passed on, or set to anything else than a member, may hold every member.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all, expansion
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

_READERS = frozenset(("parse_value",))  # procedures that fill data of any type
_TELLING = {"scan_from": ".ret1", "format_into": ".ret1"}  # procedures that set a field of the record that they get
_NO_MEMBERS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.Quantity, ir.Aggregate)


@legalising(sees=("Switch",))
def possible_cases(program: ir.Program, context: Context) -> ir.Program:
    """The program without cases that no value leads to."""
    held = _Held.of(program)
    if held.anything:
        return program

    def body(statements: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in statements:
            inner = rewrite_bodies(statement, body)
            members = held.members(inner.selector) if isinstance(inner, ir.Switch) else None
            if isinstance(inner, ir.Switch) and members is not None:
                done.extend(_left(inner, members))
            else:
                done.append(inner)
        same = len(done) == len(statements) and all(a is b for a, b in zip(done, statements, strict=True))
        return statements if same else tuple(done)

    return edit_all(program, body)


def _left(choice: ir.Switch, members: frozenset[str]) -> ir.Body:
    """What is left of a choice between members of an enumeration."""
    kept: list[ir.Case] = []
    all_in_one = False
    for case in choice.cases:
        values = _values(case)
        if values is None:
            return (choice,)
        if values & members:
            kept.append(case)
            all_in_one = members <= values
    if len(kept) == 1 and all_in_one:
        return expansion(choice.origin, kept[0].body) or (ir.Nothing(origin=choice.origin),)
    if not kept:
        return expansion(choice.origin, choice.default or ()) or (ir.Nothing(origin=choice.origin),)
    return (choice,) if len(kept) == len(choice.cases) else (replace(choice, cases=tuple(kept)),)


def _values(case: ir.Case) -> frozenset[str] | None:
    """The members of a case, folded; None when it has other values."""
    members = [value.member.lower() for value in case.values if isinstance(value, ir.EnumLiteral)]
    return frozenset(members) if len(members) == len(case.values) else None


@dataclass(slots=True)
class _Held:
    """Members by the folded name of a variable, or of a field with a dot in front. `open`: names that may hold any
    member; `anything`: nothing is known at all. `copies`: what each name is also given."""

    found: dict[str, set[str]] = field(default_factory=dict)
    open: set[str] = field(default_factory=set)
    copies: dict[str, set[str]] = field(default_factory=dict)
    anything: bool = False

    @classmethod
    def of(cls, program: ir.Program) -> _Held:
        held = cls()
        for node in walk(program):
            held.note(node)
        held.close()
        return held

    def note(self, node: object) -> None:
        match node:
            case ir.Variable(name=name, initial=initial) if initial is not None:
                self.given(name.lower(), initial)
            case ir.Parameter(name=name):
                self.open.add(name.lower())
            case ir.Aggregate(entries=entries):
                for field_name, entry in entries:
                    if field_name is not None:
                        self.given(f".{field_name.lower()}", entry)
                    elif isinstance(entry, ir.EnumLiteral):
                        self.anything = True
            case ir.Assign(target=target, value=value):
                key = _key(target)
                if key is not None:
                    self.given(key, value)
            case ir.Argument(value=value) if value is not None:
                self.opened(value)
            case ir.Do(procedure=procedure, arguments=arguments):
                self.anything = self.anything or procedure in _READERS
                if procedure in _TELLING:
                    self.open.add(_TELLING[procedure])
                for place in arguments:
                    if place is not None:
                        self.opened(place)

    def opened(self, value: ir.Expression) -> None:
        key = _key(value)
        if key is not None:
            self.open.add(key)

    def given(self, key: str, value: ir.Expression) -> None:
        match value:
            case ir.EnumLiteral(member=member):
                self.found.setdefault(key, set()).add(member.lower())
            case ir.Name() | ir.Field() | ir.Index():
                source = _key(value)
                if source is None:
                    self.open.add(key)
                else:
                    self.copies.setdefault(key, set()).add(source)
            case _ if not isinstance(value, _NO_MEMBERS):
                self.open.add(key)

    def close(self) -> None:
        """What is copied from a name is held too."""
        changed = True
        while changed:
            changed = False
            for key, sources in self.copies.items():
                held, size = self.found.setdefault(key, set()), len(self.found[key])
                for source in sources:
                    held |= self.found.get(source, set())
                    if source in self.open and key not in self.open:
                        self.open.add(key)
                        changed = True
                changed = changed or len(held) != size

    def members(self, place: ir.Expression) -> frozenset[str] | None:
        """What the place may hold; None when that is not known."""
        key = _key(place)
        known = None if key is None or key in self.open else self.found.get(key)
        return frozenset(known) if known else None


def _key(place: ir.Expression) -> str | None:
    """Fields by their own name, variables and elements of arrays by that of the variable."""
    match place:
        case ir.Field(name=name):
            return f".{name.lower()}"
        case ir.Name(id=name):
            return name.lower()
        case ir.Index(base=base):
            return _key(base)
    return None


__all__ = ["possible_cases"]
