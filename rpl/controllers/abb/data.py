"""RAPID data, signals and the log of a virtual ABB controller. Which signals are configured is in no program: one that
nobody has set is there, and off."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING

from rpl.controllers.abb.inside import UNKNOWN, Inside, RefusalError
from rpl.controllers.abb.pages import NOTHING, Page, Thing
from rpl.controllers.virtual.store import NotDoneError
from rpl.errors import UsageError
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions.texts import parsed, value_text
from rpl.runtime.values import Value

if TYPE_CHECKING:
    from rpl.controllers.abb.asked import Asked


def _name_of(inside: Inside, path: str) -> str:
    """`T_ROB1/MainModule/reg1` or `T_ROB1/reg1` as the program calls it. Raises RefusalError."""
    task, *rest = path.split("/")
    inside.task(task)
    if not 1 <= len(rest) <= 2:
        raise RefusalError(404, UNKNOWN, f"{path}: there is no such data")
    return ".".join(rest)


def symbol_text(inside: Inside, path: str) -> str:
    """The value of data as RAPID writes it. Raises RefusalError."""
    name = _name_of(inside, path)
    try:
        return value_text(inside.cabinet.variable(name), True)
    except (UsageError, NotDoneError, ProgramError):
        raise RefusalError(404, UNKNOWN, f"{path}: there is no such data, or it has no value") from None


def read_symbol(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    return Page((Thing("rap-data", f"RAPID/{found[1]}", {"value": symbol_text(inside, found[1])}),))


def set_symbol(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    """1.0 takes the mastership by itself, if nobody else has it; 2.0 wants it held."""
    holder = inside.masters.get("rapid")
    if holder != request.session and (request.is_second or holder is not None):
        raise RefusalError(403, UNKNOWN, "the mastership of RAPID is not held")
    name, text = _name_of(inside, found[1]), request.form.get("value", "")

    def changed(old: Value) -> Value:
        return parsed(text, old)

    try:
        inside.cabinet.set_variable(name, changed)
    except (UsageError, NotDoneError):
        raise RefusalError(404, UNKNOWN, f"{found[1]}: there is no such data") from None
    except (ValueError, ProgramError):
        raise RefusalError(400, UNKNOWN, f"{text}: this is no value for {found[1]}") from None
    return NOTHING


def search_symbols(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    """Persistent data of a task."""
    task = request.form.get("blockurl", "").removeprefix("RAPID").strip("/").partition("/")[0]
    names = [name.replace(".", "/") for name in inside.cabinet.data_names()]
    return Page(
        tuple(
            Thing("rap-sympropper-li", f"RAPID/{task}/{name}", {"name": name.rpartition("/")[2], "symtyp": "per"})
            for name in names
        )
    )


# ---- signals


def signal_text(inside: Inside, path: str) -> str:
    """The logical value of a signal, by its path `network/device/name` or its name."""
    value = inside.cabinet.signal(path.rpartition("/")[2])
    if value is None:
        return "0"
    return str(int(value)) if isinstance(value, bool) or float(value).is_integer() else f"{value:g}"


def _signal(inside: Inside, path: str) -> Thing:
    name = path.rpartition("/")[2]
    kind = name[:2].upper() if name[:2].upper() in ("DI", "DO", "AI", "AO", "GI", "GO") else "DO"
    values = {"name": name, "type": kind, "lvalue": signal_text(inside, path), "lstate": "not simulated"}
    return Thing("ios-signal", path, values | {"unitnm": "DRV_1", "phstate": "valid"}, path)


def signals(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    """Those that somebody has set or that the program uses."""
    things = [_signal(inside, f"Local/DRV_1/{name}") for name in inside.cabinet.signal_names()]
    return Page(tuple(Thing("ios-signal-li", one.title, one.values, one.href) for one in things))


def read_signal(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    return Page((_signal(inside, found[1]),))


def set_signal(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    name, text = found[1].rpartition("/")[2], request.form.get("lvalue", "")
    try:
        value = float(text)
    except ValueError:
        raise RefusalError(400, UNKNOWN, f"lvalue: {text!r} is no value") from None
    inside.cabinet.set_signal(name, int(value) if value.is_integer() else value)
    return NOTHING


# ---- the log


def log(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    """What programs have said and why they ended, the newest first."""
    moment = time.strftime("%Y-%m-%d T %H:%M:%S")
    messages = list(enumerate(inside.cabinet.messages, 1))
    return Page(tuple(_entry(number, text, moment) for number, text in reversed(messages)))


def _entry(number: int, text: str, moment: str) -> Thing:
    values = {"msgtype": "1", "code": "80001", "tstamp": moment, "title": text, "desc": text, "argc": "0"}
    empty = {"conseqs": "", "causes": "", "actions": ""}
    return Thing("elog-message-li", f"/rw/elog/0/{number}", values | empty, f"0/{number}")
