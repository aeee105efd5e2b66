"""RAPID's other installed instructions: signals, waiting, interrupts, operator, clocks, stops.

Each maker gets the arguments and gives statements, or None when an option has no neutral form. Sources: RAPID reference
manuals, instructions SetDO, WaitDI, CONNECT, TPWrite...
"""

from __future__ import annotations

from rpl import ir
from rpl.source import Origin

from .arguments import Arguments
from .dialogs import BUTTONS, keys_asked
from .expressions import Expressions, as_bool, truth_of
from .functions import bit_mask
from .motion import MOTION, Made, Make

_TIMEOUT = "ERR_WAIT_MAXTIME"
_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


def _level(signal: ir.Expression, value: ir.Expression) -> ir.Expression:
    """The condition that a digital signal has a value."""
    truth = truth_of(value)
    if truth is None:
        return ir.Binary("=", ir.Convert("bit", signal), value)
    return signal if truth else ir.Unary("not", signal)


# ---- outputs


def _set(value: bool) -> Make:
    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        signal = expressions.signal(arguments.need(1)[0], "digital_out")
        return ir.Assign(signal, ir.BoolLiteral(value), origin=origin)

    return make


def _output(kind: str) -> Make:
    """SetDO [\\SDelay|\\Sync] signal, value. \\Sync only waits for the fieldbus, which is at once here."""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        signal, value = arguments.need(2)
        if set(arguments.options) - {"sdelay", "sync"}:
            return None
        target = expressions.signal(signal, kind)
        written = as_bool(value) if kind == "digital_out" else value
        delay = arguments.options.get("sdelay")
        if delay is not None:
            return ir.SetAfter(target, written, delay, origin=origin)
        return ir.Assign(target, written, origin=origin)

    return make


def _invert(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    signal = expressions.signal(arguments.need(1)[0], "digital_out")
    return ir.Assign(signal, ir.Unary("not", signal), origin=origin)


def _pulse(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """PulseDO [\\High] [\\PLength] signal: the opposite of its state, or high, for 0.2 s if not said."""
    signal = expressions.signal(arguments.need(1)[0], "digital_out")
    if set(arguments.options) - {"high", "plength"}:
        return None
    value: ir.Expression = _TRUE if "high" in arguments.options else ir.Unary("not", signal)
    length = arguments.options.get("plength") or ir.RealLiteral(0.2, "0.2")
    return ir.Pulse(signal, value, length, origin=origin)


# ---- waiting

# What a wait shows meanwhile; nothing in a run depends on it.
SHOWN_WAITING = frozenset(
    ("visualize", "header", "message", "msgarray", "wrap", "icon", "image", "visualizetime", "uiactivesignal")
)


def _wait_until(condition: ir.Expression, arguments: Arguments, origin: Origin, known: frozenset[str]) -> Made:
    options = arguments.options
    if set(options) - known - SHOWN_WAITING:
        return None
    timeout, timed_out = options.get("maxtime"), options.get("timeflag")
    error = _TIMEOUT if timeout is not None and timed_out is None else None
    return ir.WaitUntil(condition, timeout, timed_out, error, "inpos" in options, origin=origin)


def _wait_signal(kind: str) -> Make:
    """WaitDI signal, value [\\MaxTime] [\\TimeFlag]"""
    known = frozenset(("maxtime", "timeflag"))

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        signal, value = arguments.need(2)
        return _wait_until(_level(expressions.signal(signal, kind), value), arguments, origin, known)

    return make


def _wait_number(kind: str, equal: bool) -> Make:
    """WaitAI signal, \\LT|\\GT, value and WaitGI signal, [\\NOTEQ|\\LT|\\GT,] value"""
    signs = {"lt": "<", "gt": ">", "noteq": "<>"}

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        signal, value = arguments.need(2)
        options = dict(arguments.options)
        sign = next((signs[name] for name in signs if name in options), "=" if equal else None)
        if sign is None or len(set(options) & set(signs)) > 1:
            return None
        condition = ir.Binary(sign, expressions.signal(signal, kind), value)
        return _wait_until(condition, arguments, origin, frozenset(("maxtime", "timeflag", *signs)))

    return make


def _wait_condition(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """WaitUntil [\\InPos,] condition [\\MaxTime] [\\TimeFlag] [\\PollRate]"""
    known = frozenset(("inpos", "maxtime", "timeflag", "pollrate"))
    return _wait_until(arguments.need(1)[0], arguments, origin, known)


def _wait_time(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    if set(arguments.options) - {"inpos"}:
        return None
    return ir.Wait(arguments.need(1)[0], "inpos" in arguments.options, origin=origin)


# ---- tasks that wait for each other


def _meet(mode: str, error: str) -> Make:
    """WaitSyncTask [\\InPos,] point, tasks [\\TimeOut] and SyncMoveOn; SyncMoveOff point [\\TimeOut]. Only the name of
    the point counts (data type syncident). SyncMoveOn and SyncMoveOff wait until the robot stands."""
    count = 1 if mode == "apart" else 2
    known = frozenset(("timeout", "inpos") if mode == "wait" else ("timeout",))

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        point, *rest = arguments.need(count)
        options = arguments.options
        if set(options) - known:
            return None
        limit = options.get("timeout")
        raised, tasks = error if limit is not None else None, rest[0] if rest else None
        return ir.Meet(point, tasks, mode, limit, raised, "inpos" in options, origin=origin)

    return make


# ---- interrupts


def _order_signal(kind: str) -> Make:
    """ISignalDI [\\Single|\\SingleSafe] signal, 0|1|edge, interrupt"""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        name, value, handle = arguments.need(3)
        if set(arguments.options) - {"single", "singlesafe"}:
            return None
        once = bool(arguments.options)
        signal = expressions.signal(name, kind)
        truth = truth_of(value)
        if truth is not None:
            return ir.OrderInterrupt(handle, "edge", _level(signal, value), once=once, origin=origin)
        match value:
            case ir.Name(id=word) if word.lower() == "edge":
                return ir.OrderInterrupt(handle, "change", signal, once=once, origin=origin)
            case ir.IntLiteral(value=2):
                return ir.OrderInterrupt(handle, "change", signal, once=once, origin=origin)
        return None

    return make


def _order_change(kind: str | None) -> Make:
    """ISignalGI [\\Single] signal, interrupt and IPers [\\Single] data, interrupt"""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        watched, handle = arguments.need(2)
        if set(arguments.options) - {"single", "singlesafe"}:
            return None
        condition = expressions.signal(watched, kind) if kind else watched
        return ir.OrderInterrupt(handle, "change", condition, once=bool(arguments.options), origin=origin)

    return make


def _order_timer(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    time, handle = arguments.need(2)
    if set(arguments.options) - {"single", "singlesafe"}:
        return None
    return ir.OrderInterrupt(handle, "timer", time=time, once=bool(arguments.options), origin=origin)


def _order_error(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """IError domain, type, interrupt: the run knows errors of all domains and types alike."""
    domain, kind, handle = arguments.need(3)
    if arguments.options:
        return None
    match domain, kind:
        case ir.Name(id=all_domains), ir.Name(id=all_types):
            if all_domains.lower() == "common_err" and all_types.lower() == "type_all":
                return ir.OrderInterrupt(handle, "error", origin=origin)
    return None


def _control(op: str, arguments_needed: int) -> Make:
    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        handles = arguments.need(arguments_needed)
        return ir.ControlInterrupt(op, handles[0] if handles else None, origin=origin)

    return make


# ---- operator


def _joined(first: ir.Expression, second: ir.Expression) -> ir.Expression:
    return ir.Binary("+", first, second)


def _tp_write(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """TPWrite text [\\Num|\\Bool|\\Pos|\\Orient|\\Dnum]"""
    text = arguments.need(1)[0]
    if set(arguments.options) - {"num", "bool", "pos", "orient", "dnum"}:
        return None
    for value in arguments.options.values():
        if value is None:
            return None
        text = _joined(text, ir.Builtin("value_text", (value,)))
    return ir.Message("write", text, origin=origin)


def _tp_erase(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    arguments.need(0)
    return ir.Message("clear", ir.TextLiteral(""), origin=origin)


def _key(value: ir.Expression) -> ir.Expression | None:
    match value:
        case ir.Name(id=name) if name.lower() == "stempty":
            return None
        case ir.TextLiteral(value=""):
            return None
    return value


def _tp_read_keys(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """TPReadFK answer, text, key1 .. key5 [\\MaxTime]"""
    answer, text, *keys = arguments.need(7)
    if set(arguments.options) - {"maxtime"}:
        return None
    shown = tuple(map(_key, keys))
    return ir.Dialog(answer, text, shown, timeout=arguments.options.get("maxtime"), origin=origin)


def _tp_read_number(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    answer, text = arguments.need(2)
    if set(arguments.options) - {"maxtime"}:
        return None
    return ir.Dialog(answer, text, kind="number", timeout=arguments.options.get("maxtime"), origin=origin)


def _shown(arguments: Arguments) -> tuple[ir.Expression | None, ir.Expression, dict[str, ir.Expression | None]]:
    """Header and lines of a box on the screen, and the options that say more than how it looks."""
    text = arguments.need(1)[0]
    options = dict(arguments.options)
    header = options.pop("header", None)
    for line in ("msgline2", "msgline3", "msgline4", "msgline5"):
        more = options.pop(line, None)
        if more is not None:
            text = _joined(_joined(text, ir.TextLiteral(" ")), more)
    for harmless in ("wrap", "icon", "image"):
        options.pop(harmless, None)
    return header, text, options


def _ui_message(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """UIMsgBox [\\Header] line [\\MsgLine2] ... [\\Buttons] [\\Result]: a choice whose answer is
    taken, or it waits to be acknowledged (by which key is all the same)."""
    header, text, options = _shown(arguments)
    buttons, result = options.pop("buttons", None), options.pop("result", None)
    if result is not None:
        limit = options.pop("maxtime", None)
        return None if options else keys_asked(result, text, header, limit, {"buttons": buttons}, origin)
    if buttons is not None and (not isinstance(buttons, ir.Name) or buttons.id.lower() not in BUTTONS):
        return None
    return None if options else ir.Message("quit", text, sender=header, origin=origin)


def _ui_write(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """UIMsgWrite [\\Header] line [\\MsgLine2] ...: a message that nobody has to acknowledge."""
    header, text, options = _shown(arguments)
    return None if options else ir.Message("write", text, sender=header, origin=origin)


def _error_write(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """ErrWrite [\\W|\\I] header, reason [\\RL2] ..."""
    header, text = arguments.need(2)
    options = dict(arguments.options)
    for line in ("rl2", "rl3", "rl4"):
        more = options.pop(line, None)
        if more is not None:
            text = _joined(_joined(text, ir.TextLiteral(" ")), more)
    if set(options) - {"w", "i"}:
        return None
    return ir.Message("notify" if options else "error", text, sender=header, origin=origin)


# ---- numbers, clocks, stops


def _do(procedure: str, count: int) -> Make:
    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        return ir.Do(procedure, tuple(arguments.need(count)), origin=origin)

    return make


def _bit(on: bool) -> Make:
    """BitSet and BitClear data, position (counted from 1)."""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        data, number = arguments.need(2)
        mask = bit_mask(number)
        value = ir.Binary("bor", data, mask) if on else ir.Binary("band", data, ir.Unary("bnot", mask))
        return ir.Assign(data, value, origin=origin)

    return make


def _clock(op: str) -> Make:
    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        return ir.Clock(op, arguments.need(1)[0], origin=origin)

    return make


def _halt(kind: str, known: frozenset[str] = frozenset()) -> Make:
    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        arguments.need(0)
        return None if set(arguments.options) - known else ir.Halt(kind, origin=origin)

    return make


def _take_lock(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """WaitTestAndSet data: wait until it is FALSE, and make it TRUE."""
    lock = arguments.need(1)[0]
    free = ir.WaitUntil(ir.Unary("not", lock), origin=origin)
    return None if arguments.options else (free, ir.Assign(lock, _TRUE, origin=origin))


def _numbered_call(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """CallByVar name, number: calls the procedure with that name and number."""
    name, number = arguments.need(2)
    called = _joined(name, ir.Builtin("number_text", (number, ir.IntLiteral(0))))
    return ir.CallRoutine("", (), called, origin=origin)


def _book_error(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """BookErrNo variable: gives it an error number that nobody else uses."""
    variable = arguments.need(1)[0]
    booked = expressions.project.booked_errors
    key = variable.id.lower() if isinstance(variable, ir.Name) else repr(variable)
    number = booked.setdefault(key, 5001 + len(booked))
    return ir.Assign(variable, ir.IntLiteral(number), origin=origin)


INSTRUCTIONS: dict[str, Make] = {
    **MOTION,
    "set": _set(True),
    "reset": _set(False),
    "setdo": _output("digital_out"),
    "setao": _output("analog_out"),
    "setgo": _output("group_out"),
    "invertdo": _invert,
    "pulsedo": _pulse,
    "waitdi": _wait_signal("digital_in"),
    "waitdo": _wait_signal("digital_out"),
    "waitai": _wait_number("analog_in", equal=False),
    "waitao": _wait_number("analog_out", equal=False),
    "waitgi": _wait_number("group_in", equal=True),
    "waitgo": _wait_number("group_out", equal=True),
    "waituntil": _wait_condition,
    "waittime": _wait_time,
    "isignaldi": _order_signal("digital_in"),
    "isignaldo": _order_signal("digital_out"),
    "isignalgi": _order_change("group_in"),
    "isignalgo": _order_change("group_out"),
    "ipers": _order_change(None),
    "itimer": _order_timer,
    "ierror": _order_error,
    "isleep": _control("off", 1),
    "iwatch": _control("on", 1),
    "ienable": _control("enable", 0),
    "idisable": _control("disable", 0),
    "idelete": _control("delete", 1),
    "tpwrite": _tp_write,
    "tperase": _tp_erase,
    "tpreadfk": _tp_read_keys,
    "tpreadnum": _tp_read_number,
    "uimsgbox": _ui_message,
    "uimsgwrite": _ui_write,
    "uimsgwriteabort": _tp_erase,
    "errwrite": _error_write,
    "incr": _do("increment", 1),
    "decr": _do("decrement", 1),
    "add": _do("increment", 2),
    "clear": _do("clear", 1),
    "bitset": _bit(True),
    "bitclear": _bit(False),
    "clkreset": _clock("reset"),
    "clkstart": _clock("start"),
    "clkstop": _clock("stop"),
    "stop": _halt("stop", frozenset(("noregain", "allmovetasks"))),
    "break": _halt("stop"),
    "exitcycle": _halt("cycle"),
    "bookerrno": _book_error,
    "waittestandset": _take_lock,
    "callbyvar": _numbered_call,
    "waitsynctask": _meet("wait", "ERR_WAITSYNCTASK"),
    "syncmoveon": _meet("together", "ERR_SYNCMOVEON"),
    "syncmoveoff": _meet("apart", "ERR_SYNCMOVEOFF"),
}
