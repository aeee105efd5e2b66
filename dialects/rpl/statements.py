"""Statements of RPL without an inside (and without motion): parse tree to IR."""

from __future__ import annotations

from collections.abc import Callable

from lark import Token

from rpl import ir
from rpl.ir import words
from rpl.reading.shapes import StatementError, SyntaxTree

from .affixes import Affixing
from .expressions import (
    Reading,
    argument,
    expression,
    first,
    lvalue,
    names,
    plain_values,
    state,
    tokens,
    trees,
    wording,
)
from .expressions import arguments as lower_arguments

Lowering = Callable[[SyntaxTree, Reading], ir.Statement]


def action(tree: SyntaxTree, at: Reading) -> ir.Assign | ir.CallRoutine:
    """What a trigger or an interrupt does: an assignment or a call."""
    done = ACTIONS[tree.data](tree, at)
    if not isinstance(done, ir.Assign | ir.CallRoutine):
        raise StatementError("only an assignment or a call of a routine can stand here", 0)
    return done


def _assign(tree: SyntaxTree, at: Reading) -> ir.Statement:
    target, value = trees(tree)
    return ir.Assign(lvalue(target, at), expression(value, at), origin=at.origin)


def _set(tree: SyntaxTree, at: Reading) -> ir.Statement:
    target, value = trees(tree)
    return ir.Assign(lvalue(target, at), state(value, at), origin=at.origin)


def _call(tree: SyntaxTree, at: Reading) -> ir.Statement:
    invoked = next(trees(tree))
    name = names(invoked)[0]
    given = lower_arguments(next(trees(invoked)), at)
    word = name.lower() if next(tokens(invoked, "NAME"), None) is not None else ""
    if word in words.PROCEDURE_WORDS:
        left_out = [argument == ir.Argument(None) for argument in given]
        values = iter(plain_values(tuple(a for a, out in zip(given, left_out, strict=True) if not out), word))
        return ir.Do(word, tuple(None if out else next(values) for out in left_out), origin=at.origin)
    return ir.CallRoutine(name, given, origin=at.origin)


def _call_by_name(tree: SyntaxTree, at: Reading) -> ir.Statement:
    name = next(iter(names(tree)), "")
    parts = list(trees(tree))
    given = lower_arguments(parts[1], at) if len(parts) > 1 else ()
    return ir.CallRoutine(name, given, expression(parts[0], at), origin=at.origin)


def _open_gripper(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.CallRoutine(f"open_{names(tree)[0]}", origin=at.origin)


def _affix(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return _affixing("rigidly" if _has(tree, "RIGIDLY") else "affix", tree, at)


def _unfix(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return _affixing("unfix", tree, at)


def _affixing(kind: str, tree: SyntaxTree, at: Reading) -> ir.Statement:
    child, parent = trees(tree)
    tool = parent.data == "name" and any(token.lower() == "tool" for token in tokens(parent, "NAME"))
    return _taken(Affixing(kind, expression(child, at), None if tool else expression(parent, at), at.origin), at)


def _taken(affixing: Affixing, at: Reading) -> ir.Statement:
    at.affixing.append(affixing)
    return affixing.stand_in


def _close_gripper(tree: SyntaxTree, at: Reading) -> ir.Statement:
    name, part = names(tree)[0], next(trees(tree), None)
    if part is None:
        return ir.CallRoutine(f"close_{name}", origin=at.origin)
    return _taken(Affixing("affix", expression(part, at), None, at.origin, name), at)


def _set_after(tree: SyntaxTree, at: Reading) -> ir.Statement:
    signal, value, delay = trees(tree)
    return ir.SetAfter(expression(signal, at), state(value, at), expression(delay, at), origin=at.origin)


def _pulse(tree: SyntaxTree, at: Reading) -> ir.Statement:
    signal, value, duration = trees(tree)
    return ir.Pulse(expression(signal, at), state(value, at), expression(duration, at), origin=at.origin)


def _bare(make: Callable[..., ir.Statement], **settings: object) -> Lowering:
    """A statement that says everything by its keyword."""
    return lambda tree, at: make(**settings, origin=at.origin)


def _label(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.Label(names(tree)[0], origin=at.origin)


def _goto(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.Goto(names(tree)[0], origin=at.origin)


def _optional(tree: SyntaxTree, at: Reading) -> ir.Expression | None:
    inner = next(trees(tree), None)
    return None if inner is None else expression(inner, at)


def _return(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.Return(_optional(tree, at), origin=at.origin)


def _raise(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.Raise(_optional(tree, at), origin=at.origin)


def _halt(tree: SyntaxTree, at: Reading) -> ir.Statement:
    word = next((wording(token) for token in tokens(tree, "HALT_KIND")), "")
    return ir.Halt(words.HALT_WORDS[word], origin=at.origin)


def _has(tree: SyntaxTree, terminal: str) -> bool:
    return next(tokens(tree, terminal), None) is not None


def _wait(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.Wait(first(tree, at), _has(tree, "AT_REST"), origin=at.origin)


def options(parts: list[SyntaxTree]) -> dict[str, SyntaxTree]:
    """Clauses by their name; each may stand once."""
    found: dict[str, SyntaxTree] = {}
    for part in parts:
        if part.data in found:
            raise StatementError(f"{part.data.rstrip('_').upper()} is given twice", 0)
        found[part.data] = part
    return found


def _valued(found: dict[str, SyntaxTree], key: str, at: Reading) -> ir.Expression | None:
    return first(found[key], at) if key in found else None


def _worded(found: dict[str, SyntaxTree], key: str) -> str | None:
    return names(found[key])[0] if key in found else None


def _wait_until(tree: SyntaxTree, at: Reading) -> ir.Statement:
    condition, *rest = trees(tree)
    found = options(rest)
    return ir.WaitUntil(
        expression(condition, at),
        _valued(found, "timeout", at),
        _valued(found, "flag", at),
        _worded(found, "error"),
        "at_rest" in found,
        origin=at.origin,
    )


def _meet(tree: SyntaxTree, at: Reading) -> ir.Statement:
    word = wording(next(tokens(tree, "MEET_OP"))).split()[1]
    identity, *rest = trees(tree)
    found = options(rest)
    return ir.Meet(
        expression(identity, at),
        _valued(found, "with_tasks", at),
        "wait" if word == "at" else word,
        _valued(found, "timeout", at),
        _worded(found, "error"),
        "at_rest" in found,
        origin=at.origin,
    )


def _declare_interrupt(tree: SyntaxTree, at: Reading) -> ir.Statement:
    priority, *rest, condition, done = trees(tree)
    found = options(rest)
    return ir.DeclareInterrupt(
        expression(priority, at),
        expression(condition, at),
        action(done, at),
        "everywhere" in found,
        _valued(found, "named_as", at),
        "once" in found,
        "braking" in found,
        origin=at.origin,
    )


def _for_next_move(tree: SyntaxTree, at: Reading) -> ir.Statement:
    setting, value = trees(tree)
    return ir.SetForNextMove(lvalue(setting, at), expression(value, at), origin=at.origin)


def _trap_errors(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.OnError(names(tree)[0], origin=at.origin)


def _connect(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.ConnectInterrupt(first(tree, at), names(tree)[0], origin=at.origin)


def _arm(tree: SyntaxTree, at: Reading) -> ir.Statement:
    handle, *rest = trees(tree)
    found = options(rest)
    return ir.OrderInterrupt(
        expression(handle, at),
        names(tree)[0],
        _valued(found, "when", at),
        _valued(found, "time", at),
        "once" in found,
        origin=at.origin,
    )


def _control_interrupt(tree: SyntaxTree, at: Reading) -> ir.Statement:
    word = wording(next(tokens(tree, "INTERRUPT_OP")))
    return ir.ControlInterrupt(word.split()[1], _optional(tree, at), origin=at.origin)


def _stop_motion(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.StopMotion(_has(tree, "HARD"), origin=at.origin)


def _message(tree: SyntaxTree, at: Reading) -> ir.Statement:
    text, *rest = trees(tree)
    found = options(rest)
    kind = _worded(found, "kind") or "notify"
    return ir.Message(kind, expression(text, at), _valued(found, "from_", at), origin=at.origin)


def _ask(tree: SyntaxTree, at: Reading) -> ir.Statement:
    text, *rest = trees(tree)
    found = options(rest)
    if "into" not in found:
        raise StatementError("ASK needs INTO and the variable for the answer", 0)
    keys: tuple[ir.Expression | None, ...] = ()
    if "keys" in found:
        given = [argument(key, at) for key in trees(found["keys"])]
        if any(key.name is not None or key.if_present is not None for key in given):
            raise StatementError("KEYS takes texts, or ? for a key that is not there", 0)
        keys = tuple(key.value for key in given)
    return ir.Dialog(
        lvalue(next(trees(found["into"])), at),
        expression(text, at),
        keys,
        _worded(found, "kind") or "keys",
        _valued(found, "timeout", at),
        _valued(found, "flag", at),
        _valued(found, "from_", at),
        origin=at.origin,
    )


def _clock(tree: SyntaxTree, at: Reading) -> ir.Statement:
    word = wording(next(tokens(tree, "CLOCK_OP")))
    return ir.Clock(word.split()[1], first(tree, at), origin=at.origin)


def _task_control(tree: SyntaxTree, at: Reading) -> ir.Statement:
    word = wording(next(tokens(tree, "TASK_OP")))
    brackets = next(trees(tree), None)
    given = () if brackets is None else lower_arguments(brackets, at)
    return ir.TaskControl(word.split()[0], names(tree)[0], given, origin=at.origin)


def _written(tree: SyntaxTree) -> list[str]:
    return [words.disclose(token) for token in tokens(tree, "TEXT")]


def _vendor(tree: SyntaxTree, at: Reading) -> ir.Statement:
    dialect, effect = names(tree)
    return ir.Vendor(dialect, _written(tree)[0], effect, origin=at.origin)


def _opaque(tree: SyntaxTree, at: Reading) -> ir.Statement:
    return ir.Opaque(_written(tree)[0], origin=at.origin)


def texts(tree: SyntaxTree) -> list[str]:
    """The texts among the children."""
    return _written(tree)


def word_token(tree: SyntaxTree, terminal: str) -> Token | None:
    """The token of this terminal, if any."""
    return next(tokens(tree, terminal), None)


ACTIONS: dict[str, Lowering] = {"assign": _assign, "set": _set, "call": _call, "call_by_name": _call_by_name}

STATEMENTS: dict[str, Lowering] = {
    **ACTIONS,
    "open_gripper": _open_gripper,
    "close_gripper": _close_gripper,
    "affix": _affix,
    "unfix": _unfix,
    "set_after": _set_after,
    "pulse": _pulse,
    "exit_loop": _bare(ir.ExitLoop),
    "next_pass": _bare(ir.NextPass),
    "label": _label,
    "goto": _goto,
    "return_": _return,
    "halt": _halt,
    "wait": _wait,
    "wait_until": _wait_until,
    "wait_for_motion": _bare(ir.WaitForMotion),
    "look_ahead": _bare(ir.LookAhead),
    "declare_interrupt": _declare_interrupt,
    "connect": _connect,
    "arm": _arm,
    "control_interrupt": _control_interrupt,
    "stop_motion": _stop_motion,
    "start_motion": _bare(ir.StartMotion),
    "clear_motion": _bare(ir.ClearMotion),
    "store_motion": _bare(ir.StoreMotion),
    "restore_motion": _bare(ir.StoreMotion, restore=True),
    "resume_level": _bare(ir.ResumeLevel),
    "raise_": _raise,
    "retry": _bare(ir.Retry),
    "try_next": _bare(ir.TryNext),
    "message": _message,
    "ask": _ask,
    "clock": _clock,
    "task_control": _task_control,
    "meet": _meet,
    "enter_critical": _bare(ir.Critical, enter=True),
    "leave_critical": _bare(ir.Critical, enter=False),
    "for_next_move": _for_next_move,
    "trap_errors": _trap_errors,
    "trap_errors_off": _bare(ir.OnError, routine=None),
    "vendor": _vendor,
    "opaque": _opaque,
    "nothing": _bare(ir.Nothing),
}
