"""Calls of KRL's built-in functions and procedures, of message and technology routines, in neutral terms.

A routine of the same name in the project wins; the callers check that before they come here.
"""

from __future__ import annotations

from rpl import ir
from rpl.source import Origin

from . import tables

Arguments = tuple[ir.Argument, ...]


def _values(arguments: Arguments) -> tuple[ir.Expression, ...] | None:
    """The values when none is left out."""
    values = tuple(argument.value for argument in arguments if argument.value is not None)
    return values if len(values) == len(arguments) else None


def function_call(name: str, arguments: Arguments, origin: Origin) -> ir.Expression:
    """A function's value: a neutral built-in, or a call of a routine that lives elsewhere."""
    lower = name.lower()
    values = _values(arguments)
    if values is None:
        return ir.Call(name, arguments, origin=origin)
    count = len(values)
    if lower in tables.FUNCTIONS:
        return ir.Builtin(tables.FUNCTIONS[lower], values, origin=origin)
    if lower in tables.TEXT_PROCEDURES and lower not in ("swrite", "sread"):
        return ir.Builtin(tables.TEXT_PROCEDURES[lower], values, origin=origin)
    if lower == "strcomp" and count == 3:
        return _compared(values, origin) or ir.Call(name, arguments, origin=origin)
    if lower == "strfind" and count == 4:
        return _found(values, origin) or ir.Call(name, arguments, origin=origin)
    return ir.Call(name, arguments, origin=origin)


def _compared(values: tuple[ir.Expression, ...], origin: Origin) -> ir.Expression | None:
    """StrComp(a[], b[], #CASE_SENS | #NOT_CASE_SENS)"""
    mode = values[2]
    if not isinstance(mode, ir.EnumLiteral):
        return None
    ignore = ir.BoolLiteral(mode.member.lower() == "not_case_sens")
    return ir.Builtin("text_equal", (values[0], values[1], ignore), origin=origin)


def _found(values: tuple[ir.Expression, ...], origin: Origin) -> ir.Expression | None:
    """StrFind(start, text[], wanted[], #CASE_SENS | #NOT_CASE_SENS)"""
    start, text, wanted, mode = values
    if not isinstance(mode, ir.EnumLiteral):
        return None
    if mode.member.lower() == "not_case_sens":
        text, wanted = (ir.Builtin("text_upper", (part,), origin=origin) for part in (text, wanted))
    return ir.Builtin("text_find", (text, start, wanted), origin=origin)


def procedure_call(name: str, arguments: Arguments, text: str, origin: Origin) -> ir.Statement:
    """A call as a statement."""
    lower = name.lower()
    values = _values(arguments)
    if lower == "pulse" and values is not None and len(values) == 3:
        return ir.Pulse(values[0], values[1], values[2], origin=origin)
    if lower in tables.TEXT_PROCEDURES and values is not None:
        return ir.Do(tables.TEXT_PROCEDURES[lower], values, origin=origin)
    if lower in tables.MESSAGES:
        message = _message(tables.MESSAGES[lower], arguments, origin)
        if message is not None:
            return message
    if lower == "msgdialog":
        dialog = _dialog(arguments, origin)
        if dialog is not None:
            return dialog
    effect = tables.vendor_effect(lower)
    if effect is not None:
        return ir.Vendor("krl", text, effect, origin=origin)
    return ir.CallRoutine(name, arguments, origin=origin)


def _text(arguments: Arguments, at: int, origin: Origin) -> ir.Expression | None:
    """The text at a place with its `%1` ... parameters, which follow the sender."""
    text = arguments[at].value if at < len(arguments) else None
    parameters = [argument.value for argument in arguments[at + 2 : at + 5]]
    while parameters and parameters[-1] is None:
        parameters.pop()
    if text is None or not parameters:
        return text
    filled = tuple(value if value is not None else ir.TextLiteral("") for value in parameters)
    return ir.Builtin("message_text", (text, *filled), origin=origin)


def _message(kind: str, arguments: Arguments, origin: Origin) -> ir.Statement | None:
    """MsgXxx(text, module, p1, p2, p3): more arguments than these have no neutral meaning."""
    if any(argument.value is not None for argument in arguments[5:]):
        return None
    text = _text(arguments, 0, origin)
    if text is None:
        return None
    sender = arguments[1].value if len(arguments) > 1 else None
    return ir.Message(kind, text, sender, origin=origin)


def _dialog(arguments: Arguments, origin: Origin) -> ir.Statement | None:
    """MsgDialog(answer, text, module, p1, p2, p3, key1 ... key7)"""
    answer = arguments[0].value if arguments else None
    text = _text(arguments, 1, origin)
    if answer is None or text is None or any(argument.value is not None for argument in arguments[13:]):
        return None
    sender = arguments[2].value if len(arguments) > 2 else None
    keys = tuple(argument.value for argument in arguments[6:13])
    return ir.Dialog(answer, text, keys, sender=sender, origin=origin)
