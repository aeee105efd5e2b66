"""Declarations and the headers of routines, modules and tasks of RPL: parse tree to IR.

The scope of a declaration is empty here when it was not written; the block around it knows the default.
"""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.ir import words
from rpl.reading.pieces import Attribute, Element, ModulePart
from rpl.reading.shapes import Slot, StatementError, SyntaxTree

from .expressions import Reading, expression, first, lvalue, name_of, names, state, tokens, trees, type_of, wording
from .statements import texts

Lowering = Callable[[SyntaxTree, Reading], Element | tuple[Element, ...]]


def scope_of(tree: SyntaxTree) -> str:
    """The scope that was written, or nothing."""
    return next((words.SCOPE_WORDS[wording(token)] for token in tokens(tree, "SCOPE")), "")


def _variable(tree: SyntaxTree, at: Reading) -> Element | tuple[Element, ...]:
    storage = words.STORAGE_WORDS[wording(next(tokens(tree, "STORAGE")))]
    type_tree, *initial = trees(tree)
    value = first(initial[0], at) if initial else None
    type = type_of(type_tree, at)
    done = tuple(ir.Variable(name, type, value, storage, scope_of(tree), origin=at.origin) for name in names(tree))
    return done if len(done) > 1 else done[0]


def _record(tree: SyntaxTree, at: Reading) -> Element:
    name = names(tree)[0]
    fields = tuple((names(member)[0], type_of(next(trees(member)), at)) for member in trees(tree))
    return ir.RecordDeclaration(name, fields, scope_of(tree), origin=at.origin)


def _enum(tree: SyntaxTree, at: Reading) -> Element:
    name, *members = names(tree)
    return ir.EnumDeclaration(name, tuple(members), scope_of(tree), origin=at.origin)


def _alias(tree: SyntaxTree, at: Reading) -> Element:
    return ir.AliasDeclaration(names(tree)[0], type_of(next(trees(tree)), at), scope_of(tree), origin=at.origin)


def _signal(tree: SyntaxTree, at: Reading) -> Element:
    return ir.SignalDeclaration(names(tree)[0], _as_signal(first(tree, at)), scope_of(tree), origin=at.origin)


def _as_signal(value: ir.Expression) -> ir.Signal:
    if not isinstance(value, ir.Signal):
        raise StatementError("a signal is written di[1], do[1], gi[1 TO 8], do(name) or the like", 0)
    return value


def _frame(tree: SyntaxTree, at: Reading) -> Element:
    name = names(tree)[0]
    value, *base = trees(tree)
    if base:
        at.affixed.append((name, expression(base[0], at), at.origin))
    return ir.Variable(name, ir.PoseType(), expression(value, at), "variable", scope_of(tree), origin=at.origin)


def _gripper(tree: SyntaxTree, at: Reading) -> tuple[Element, ...]:
    """A gripper on one output: a name for the signal, and the routines that OPEN and CLOSE call."""
    name = names(tree)[0]
    signal, *rest = trees(tree)
    times = [part for part in rest if part.data == "gripper_time"]
    states = [state(part, at) for part in rest if part.data != "gripper_time"]
    opened, closed = states or [ir.BoolLiteral(False), ir.BoolLiteral(True)]
    routines = []
    for verb, value in (("open", opened), ("close", closed)):
        body: list[ir.Statement] = [ir.Assign(ir.Name(name, origin=at.origin), value, origin=at.origin)]
        if times:
            body.append(ir.Wait(first(times[0], at), origin=at.origin))
        routines.append(ir.Routine(f"{verb}_{name}", body=tuple(body), origin=at.origin))
    declared = ir.SignalDeclaration(name, _as_signal(expression(signal, at)), "", origin=at.origin)
    return declared, *routines


def _external(tree: SyntaxTree, at: Reading) -> Element:
    return ir.ExternalDeclaration(names(tree)[0], texts(tree)[0], origin=at.origin)


def _initialise(tree: SyntaxTree, at: Reading) -> Element:
    target, value = trees(tree)
    assign = ir.Assign(lvalue(target, at), expression(value, at), origin=at.origin)
    return ir.Initialise(assign, origin=at.origin)


def _unread(tree: SyntaxTree, at: Reading) -> Element:
    return ir.Unread(texts(tree)[0], origin=at.origin)


def _attribute(tree: SyntaxTree, at: Reading) -> Element:
    name, value = texts(tree)
    return Attribute(name, value, at.origin)


def routine_head(tree: SyntaxTree, at: Reading) -> ir.Routine:
    """The routine that a header declares, still without its inside."""
    kind = wording(next(tokens(tree, "ROUTINE_KIND")))
    token = next(tokens(tree, "NAME", "QUOTED"))
    if token.type == "NAME":
        _refuse_builtin(token.lower(), kind)
    returns = next((type_of(next(trees(part)), at) for part in trees(tree) if part.data == "returns"), None)
    parameters = tuple(_parameter(part, at) for part in trees(tree) if part.data == "parameter")
    return ir.Routine(
        name_of(token),
        kind,
        parameters,
        returns,
        scope=scope_of(tree) or "task",
        open_ended=next(tokens(tree, "ELLIPSIS"), None) is not None,
        origin=at.origin,
    )


def _refuse_builtin(word: str, kind: str) -> None:
    taken = words.PROCEDURE_WORDS if kind == "procedure" else words.FUNCTION_WORDS
    if word in taken:
        raise StatementError(f"{word} is built in; write `{word}` with backticks at every use to mean your own", 0)


def _parameter(tree: SyntaxTree, at: Reading) -> ir.Parameter:
    said: set[str] = set()
    choice = None
    for part in trees(tree):
        if part.data == "parameter_word":
            said.add(wording(next(tokens(part, "PARAMETER_WORD"))))
        elif part.data == "choice":
            choice = at.integer(next(child for child in part.children if isinstance(child, Slot)))
    modes = said & {"value", "reference", "readonly"}
    if len(modes) > 1:
        raise StatementError("a parameter is passed in one way only: VALUE, REFERENCE or READONLY", 0)
    return ir.Parameter(
        names(tree)[0],
        type_of(list(trees(tree))[-1], at),
        next(iter(modes), "value"),
        "optional" in said,
        "switch" in said,
        choice,
    )


def module_head(tree: SyntaxTree, at: Reading) -> ir.Module:
    """The module that a header opens, still empty."""
    dialect, task, public = words.NATIVE, "", False
    for part in trees(tree):
        match part.data:
            case "using":
                dialect = names(part)[0]
            case "of_task":
                task = names(part)[0]
            case "public":
                public = True
    return ir.Module(names(tree)[0], dialect, task=task, public=public, origin=at.origin)


def _entry(tree: SyntaxTree, at: Reading) -> Element:
    return ModulePart("", (), (), names(tree)[0], at.origin)


def _task(tree: SyntaxTree, at: Reading) -> Element:
    name, entry = names(tree)
    kind, cyclic = "motion", False
    modules: tuple[str, ...] = ()
    for part in trees(tree):
        match part.data:
            case "background":
                kind = "background"
            case "cyclic":
                cyclic = True
            case "modules":
                modules = tuple(names(part))
    return ModulePart("", (), (), ir.Task(name, entry, kind, cyclic, modules), at.origin)


DECLARATIONS: dict[str, Lowering] = {
    "variable": _variable,
    "record": _record,
    "enum": _enum,
    "alias": _alias,
    "signal": _signal,
    "frame": _frame,
    "gripper": _gripper,
    "external": _external,
    "initialise": _initialise,
    "unread": _unread,
    "attribute": _attribute,
    "entry": _entry,
    "task": _task,
}
