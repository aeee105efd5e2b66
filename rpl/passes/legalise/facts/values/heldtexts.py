"""Texts that a variable can hold, where a program only ever gives it literal ones.

Conservative and by name: variables of one name count as one; what is passed on, read in or computed may hold any text.
What a text begins with is looked for in the statements in front of its use, too.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.kept import of_program
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.rewrite import rewrite_bodies

_BY_TEXT = frozenset(("call by text",))


@dataclass(frozen=True, slots=True)
class HeldTexts:
    """By folded name: the texts of its assignments, and its first value. `unknown`: names that may hold any text."""

    texts: dict[str, frozenset[str]]
    unknown: frozenset[str]

    @staticmethod
    def of(program: ir.Program) -> HeldTexts:
        found: dict[str, set[str]] = {}
        unknown: set[str] = set()
        for node in walk_for({"Assign", "Variable", "Parameter"}, *program.modules):
            match node:
                case ir.Assign(target=ir.Name(id=name), value=ir.TextLiteral(value=text)):
                    found.setdefault(name.lower(), set()).add(text)
                case ir.Variable(name=name, initial=ir.TextLiteral(value=text)):
                    found.setdefault(name.lower(), set()).add(text)
                case ir.Variable(name=name, initial=initial) if initial is not None:
                    unknown.add(name.lower())
                case ir.Parameter(name=name):
                    unknown.add(name.lower())
        for module in program.modules:
            for routine in module.routines:
                rest = rewrite(routine, _without_literals)
                for body in bodies(rest):
                    unknown |= {name.lower() for name in assigned_in(body)}
        return HeldTexts({name: frozenset(texts) for name, texts in found.items()}, frozenset(unknown))

    def of_name(self, name: str) -> frozenset[str] | None:
        """Every text that it can hold; None when that is not known."""
        return None if name.lower() in self.unknown else self.texts.get(name.lower())


def text_beginning(text: ir.Expression) -> tuple[str, bool]:
    """What the text certainly begins with, and whether that is all of it."""
    match text:
        case ir.TextLiteral(value=known):
            return known, True
        case ir.Binary(op="&", left=left, right=right):
            first, whole = text_beginning(left)
            if not whole:
                return first, False
            more, all_known = text_beginning(right)
            return first + more, all_known
    return "", False


def named_by(call: ir.CallRoutine, held: HeldTexts, names: Set[str]) -> set[str]:
    """Those procedures (folded names) that a call by a text may mean; none where nothing is known of the text."""
    if call.dynamic is None:
        return set()
    texts = held.of_name(call.dynamic.id) if isinstance(call.dynamic, ir.Name) else None
    if texts is not None:
        return {text.rpartition(":")[2].lower() for text in texts} & names
    start, whole = text_beginning(call.dynamic)
    start = start.rpartition(":")[2].lower()
    return {name for name in names if start and (name == start if whole else name.startswith(start))}


def named_by_texts(program: ir.Program) -> set[str]:
    """Procedures (folded) that calls by a text are known to mean, as far as anything is known of the text."""
    return set(_named_by_texts(program))


@of_program
def _named_by_texts(program: ir.Program) -> frozenset[str]:
    calls = _calls_by_text(_told_texts(program))
    held = HeldTexts.of(program) if calls else HeldTexts({}, frozenset())
    return frozenset(name for call in calls for name in named_by(call, held, _procedures(program)))


def known_calls(program: ir.Program) -> ir.Program:
    """The program with a choice of plain calls for each call by a text of which anything is known. Only to be looked
    at: what decides is left out, and what other statements were stays what it was."""
    if not _calls_by_text(program):
        return program
    held, names = HeldTexts.of(program), _procedures(program)
    program = _told_texts(program)

    def change(node: object) -> object:
        if not isinstance(node, ir.CallRoutine) or not (found := sorted(named_by(node, held, names))):
            return node
        asked, calls = node.dynamic or ir.TextLiteral(""), [replace(node, name=name, dynamic=None) for name in found]
        branches = tuple((asked, (call,)) for call in calls[:-1])
        return ir.If(branches, (calls[-1],), origin=node.origin) if branches else calls[-1]

    return replace(program, modules=tuple(rewrite(module, change) for module in program.modules))


def _procedures(program: ir.Program) -> set[str]:
    return {one.name.lower() for module in program.modules for one in module.routines if one.kind == "procedure"}


def _calls_by_text(program: ir.Program) -> list[ir.CallRoutine]:
    nodes = walk_for(_BY_TEXT, *program.modules)
    return [one for one in nodes if isinstance(one, ir.CallRoutine) and one.dynamic is not None]


def _told_texts(program: ir.Program) -> ir.Program:
    """The program whose calls by a text say what stands in front of them puts together in it."""
    if not _calls_by_text(program):
        return program

    def body(statements: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for place, one in enumerate(statements):
            if isinstance(one, ir.CallRoutine) and one.dynamic is not None:
                done.append(replace(one, dynamic=as_written_before(one.dynamic, statements[:place])))
            else:
                done.append(rewrite_bodies(one, body) if blocks(one) else one)
        return tuple(done)

    return edit_all(program, body)


def as_written_before(text: ir.Expression, before: ir.Body) -> ir.Expression:
    """A variable as the expression that the statements in front of it, in the same block, have put together in it
    (`s = "A"`, `s = s & n`: `"A" & n`); the variable itself where a call, a jump or a block stands between."""
    if isinstance(text, ir.Binary) and text.op == "&":
        return replace(text, left=as_written_before(text.left, before))
    if not _is_variable(text):
        return text
    for place in range(len(before) - 1, -1, -1):
        match before[place]:
            case ir.Assign(target=target, value=value) if _same_variable(target, text):
                return _with_first(value, text, before[:place])
            case ir.Assign(value=value) if not any(isinstance(node, ir.Call) for node in walk(value)):
                continue
            case ir.Nothing() | ir.Message():
                continue
        return text
    return text


def _with_first(value: ir.Expression, variable: ir.Expression, before: ir.Body) -> ir.Expression:
    """The joined text, its first part as what stands in front says, where that is the variable itself."""
    if isinstance(value, ir.Binary) and value.op == "&":
        return replace(value, left=_with_first(value.left, variable, before))
    return as_written_before(value, before) if _same_variable(value, variable) else value


def _is_variable(text: ir.Expression) -> bool:
    """A variable, also one that has a number in place of a name (`SR[16]`)."""
    match text:
        case ir.Index(base=ir.Name(), indices=indices):
            return all(isinstance(index, ir.IntLiteral) for index in indices)
    return isinstance(text, ir.Name)


def _same_variable(one: ir.Expression, other: ir.Expression) -> bool:
    if isinstance(one, ir.Name) and isinstance(other, ir.Name):
        return one.id.lower() == other.id.lower()
    return _is_variable(one) and one == other


def _without_literals(node: object) -> object:
    match node:
        case ir.Assign(target=ir.Name(), value=ir.TextLiteral()):
            return ir.Nothing()
    return node


__all__ = ["HeldTexts", "as_written_before", "known_calls", "named_by_texts", "text_beginning"]
