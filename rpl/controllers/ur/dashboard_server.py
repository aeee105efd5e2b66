"""The dashboard of the virtual controller (TCP 29999): the words of Universal Robots' article 15690.

It loads `.script` files too, which the real one does not: a virtual controller has no pendant to put them into `.urp`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial

from rpl.controllers.ur.dashboard import BANNER
from rpl.controllers.ur.panel import BUILT, VERSION, Panel
from rpl.controllers.virtual.lines import answer, line_of
from rpl.controllers.virtual.store import NotDoneError
from rpl.controllers.virtual.transcript import Kind

_ROOT = "/programs/"


def _load(panel: Panel, name: str) -> str:
    path = name.removeprefix(_ROOT)
    try:
        panel.load(path)
    except NotDoneError as error:
        return f"File not found: {name}" if error.why == "missing" else f"Error while loading program: {name}"
    return f"Loading program: {_ROOT}{path}"


def _play(panel: Panel, _: str) -> str:
    try:
        panel.play()
    except NotDoneError:
        return "Failed to execute: play"
    return "Starting program"


def _stop(panel: Panel, _: str) -> str:
    if panel.cabinet.phase == "stopped":
        return "Failed to execute: stop"
    panel.cabinet.stop()
    return "Stopped"


def _pause(panel: Panel, _: str) -> str:
    if panel.cabinet.phase != "running":
        return "Failed to execute: pause"
    panel.cabinet.pause()
    return "Pausing program"


def _loaded(panel: Panel, _: str) -> str:
    return f"Loaded program: {_ROOT}{panel.loaded}" if panel.loaded else "No program loaded"


def _saved(panel: Panel, _: str) -> str:
    # ur-rtde looks for a capital True, the article has a small one; both words are in "True".
    return f"True {panel.loaded}" if panel.loaded else "False"


def _power(on: bool, released: bool | None = None) -> Callable[[Panel, str], str]:
    def done(panel: Panel, _: str) -> str:
        if on and panel.cabinet.emergency_stop:
            return "Failed to execute: power on" if not released else "Failed to execute: brake release"
        panel.powered = on
        panel.released = on and (released if released is not None else panel.released)
        panel.cabinet.motors_on = panel.powered and panel.released
        if not on:
            panel.cabinet.stop()
            return "Powering off"
        return "Brake releasing" if released else "Powering on"

    return done


def _unlock(panel: Panel, _: str) -> str:
    panel.protective_stop = False
    return "Protective stop releasing"


def _restart(panel: Panel, _: str) -> str:
    panel.cabinet.release_emergency_stop()
    panel.protective_stop, panel.powered, panel.released = False, False, False
    return "Restarting safety"


def _operational(panel: Panel, mode: str) -> str:
    if mode.upper() not in ("MANUAL", "AUTOMATIC"):
        return "Failed setting operational mode"
    panel.operational = mode.upper()
    return f"Operational mode '{mode.lower()}' is set"


def _no_operational(panel: Panel, _: str) -> str:
    panel.operational = "NONE"
    return "No longer controlling the operational mode. Current operational mode: 'NONE'."


def _popup(panel: Panel, text: str) -> str:
    panel.popup = text
    return "showing popup"


def _no_popup(panel: Panel, _: str) -> str:
    panel.popup = ""
    return "closing popup"


def _log(panel: Panel, text: str) -> str:
    panel.log.append(text)
    return "Added log message"


def _version(panel: Panel, _: str) -> str:
    return f"URSoftware {'.'.join(map(str, VERSION))} ({BUILT})"


def _said(text: str) -> Callable[[Panel, str], str]:
    return lambda panel, _: text


# Words -> what they are about, and what is done; those with an argument end in a space.
_WORDS: dict[str, tuple[Kind, Callable[[Panel, str], str]]] = {
    "load installation ": ("load", _said("Failed to load installation")),
    "load ": ("select", _load),
    "play": ("start", _play),
    "stop": ("stop", _stop),
    "pause": ("stop", _pause),
    "shutdown": ("other", _said("Shutting down")),
    "running": ("look", lambda panel, _: f"Program running: {str(panel.cabinet.phase == 'running').lower()}"),
    "robotmode": ("look", lambda panel, _: f"Robotmode: {panel.robot_mode}"),
    "get loaded program": ("look", _loaded),
    "popup ": ("other", _popup),
    "close popup": ("other", _no_popup),
    "close safety popup": ("other", _said("closing safety popup")),
    "addtolog ": ("other", _log),
    "isprogramsaved": ("look", _saved),
    "programstate": ("look", lambda panel, _: f"{panel.program_state} {panel.loaded or '<unnamed>'}"),
    "polyscopeversion": ("look", _version),
    "version": ("look", lambda panel, _: ".".join(map(str, VERSION))),
    "set operational mode ": ("set", _operational),
    "get operational mode": ("look", lambda panel, _: panel.operational),
    "clear operational mode": ("set", _no_operational),
    "power on": ("servo", _power(True)),
    "power off": ("servo", _power(False)),
    "brake release": ("servo", _power(True, True)),
    "safetystatus": ("look", lambda panel, _: f"Safetystatus: {panel.safety}"),
    "safetymode": ("look", lambda panel, _: f"Safetymode: {panel.safety}"),
    "unlock protective stop": ("servo", _unlock),
    "restart safety": ("servo", _restart),
    "is in remote control": ("look", lambda panel, _: str(panel.cabinet.mode == "remote").lower()),
    "get serial number": ("look", lambda panel, _: panel.cabinet.serial),
    "get robot model": ("look", lambda panel, _: panel.model),
    "generate flight report ": ("other", _said("Flight Report generated with id: 1")),
    "generate support file ": ("other", _said("Completed successfully: support.zip")),
    "setuserrole ": ("set", _said("Setting user role is not supported")),
}


def _meant(line: str) -> tuple[Kind, Callable[[Panel, str], str], str] | None:
    """What a line asks for, with its argument."""
    folded = line.lower()
    for words, (kind, work) in _WORDS.items():
        if words.endswith(" ") and folded.startswith(words):
            return kind, work, line[len(words) :].strip()
        if folded == words:
            return kind, work, ""
    return None


async def serve_dashboard(panel: Panel, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """One client, from the greeting to `quit`."""
    panel.cabinet.told("dashboard", "connect", "", counts=False)
    writer.write(f"{BANNER}\n".encode())
    while (line := await line_of(reader)) is not None:
        if line.lower() in ("quit", "exit"):
            writer.write(b"Disconnected\n")
            await writer.drain()
            return
        meant = _meant(line)
        if meant is None:
            refusal = f'could not understand: "{line[:200]}"'
            await answer(panel.cabinet, writer, "dashboard", ("other", line), partial(str, refusal))
            continue
        kind, work, argument = meant
        await answer(panel.cabinet, writer, "dashboard", (kind, line), partial(work, panel, argument))
