"""The resources of a virtual ABB controller: what is answered to which request, once for both generations."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from rpl.controllers.abb import data, motion
from rpl.controllers.abb.asked import Asked
from rpl.controllers.abb.inside import (
    NO_REQUEST,
    NOT_MASTER,
    QUEUE_IS_THERE,
    UNKNOWN,
    Inside,
    RefusalError,
)
from rpl.controllers.abb.pages import NOTHING, Page, Thing
from rpl.controllers.virtual.store import NotDoneError

VERSIONS = {False: ("6.15.00.00", "RobotWare Version 6.15.00.00"), True: ("7.14.0", "RobotWare Version 7.14.0")}
Handler = Callable[[Inside, Asked, re.Match[str]], Page]


@dataclass(frozen=True, slots=True)
class Route:
    method: str
    path: re.Pattern[str]
    action: str | None  # None: whichever
    handler: Handler


def answer(inside: Inside, request: Asked) -> Page:
    """Carry a request out. Raises RefusalError."""
    known = False
    for route in ROUTES:
        found = route.path.fullmatch(request.path)
        if found is None:
            continue
        known = True
        if route.method == request.method and route.action in (None, request.action):
            return route.handler(inside, request, found)
    raise RefusalError(405 if known else 404, UNKNOWN, f"{request.method} {request.path}: there is no such resource")


# ---- system and panel


def _system(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    version, name = VERSIONS[request.is_second]
    major, minor = version.split(".")[:2]
    values = {"name": "rpl_system", "rwversion": version, "rwversionname": name, "major": major, "minor": minor}
    return Page((Thing("sys-system-li", "system", values | {"sysid": "{" + inside.cabinet.serial + "}"}),))


def _robottype(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    model = inside.cabinet.model
    name = model.name.removeprefix("ABB ") if model is not None else "none"
    return Page((Thing("sys-robottype", "robottype", {"robot-type": name}),))


def _identity(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    serial = inside.cabinet.serial
    values = {"ctrl-name": "rpl_controller", "ctrl-id": serial, "ctrl-type": "VIRTUAL_CONTROLLER"}
    return Page((Thing("ctrl-identity-info", "identity", values),))


def _environment(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    return Page((Thing("ctrl-env", found[1], {"_value": found[1].strip("$").upper()}),))


def control_state(inside: Inside) -> str:
    if inside.cabinet.emergency_stop:
        return "emergencystop"
    return "motoron" if inside.cabinet.motors_on else "motoroff"


def _control_state(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    return Page((Thing("pnl-ctrlstate", "ctrlstate", {"ctrlstate": control_state(inside)}),))


def _set_control_state(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    wanted, cabinet = request.form.get("ctrl-state", "").lower(), inside.cabinet
    if wanted not in ("motoron", "motoroff"):
        raise RefusalError(400, UNKNOWN, f"ctrl-state: {wanted!r} is none")
    if wanted == "motoron" and (cabinet.emergency_stop or cabinet.mode == "manual"):
        raise RefusalError(403, UNKNOWN, "the motors cannot be switched on now")
    if wanted == "motoroff":
        cabinet.pause()
    cabinet.motors_on = wanted == "motoron"
    return NOTHING


def operation_mode(inside: Inside) -> str:
    return "MANR" if inside.cabinet.mode == "manual" else "AUTO"


def _operation_mode(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    return Page((Thing("pnl-opmode", "opmode", {"opmode": operation_mode(inside)}),))


def _speed(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    return Page((Thing("pnl-speedratio", "speedratio", {"speedratio": str(inside.speed_ratio)}),))


def _set_speed(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    try:
        ratio = float(request.form.get("speed-ratio", ""))
    except ValueError:
        ratio = -1.0
    if not 0.0 <= ratio <= 100.0:
        raise RefusalError(400, UNKNOWN, "speed-ratio: 0 to 100 %")
    inside.speed_ratio = round(ratio)
    return NOTHING


# ---- running


def execution_state(inside: Inside) -> str:
    return "running" if inside.cabinet.phase == "running" else "stopped"


def _execution(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    inside.cabinet.advance()
    return Page((Thing("rap-execution", "execution", {"ctrlexecstate": execution_state(inside), "cycle": "once"}),))


def _start(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    cabinet = inside.cabinet
    if cabinet.mode == "manual":
        raise RefusalError(403, UNKNOWN, "a program is started from outside in automatic mode only")
    if not cabinet.motors_on or cabinet.emergency_stop:
        raise RefusalError(403, UNKNOWN, "the motors are off")
    if not inside.has_main:
        raise RefusalError(403, UNKNOWN, "the program cannot be started: there is no main")
    try:
        cabinet.start()
    except NotDoneError as error:
        raise RefusalError(403, UNKNOWN, f"the program cannot be started: {error}") from None
    return NOTHING


def _stop(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    inside.cabinet.pause()
    return NOTHING


def _reset(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    inside.must_stand()
    if request.is_second and inside.masters.get("rapid") != request.session:
        raise RefusalError(403, NOT_MASTER, "the mastership of RAPID is not held")
    errors = inside.select()
    if errors:
        raise RefusalError(400, UNKNOWN, errors[0].as_text())
    return NOTHING


# ---- tasks and modules


def _tasks(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    running = inside.cabinet.phase == "running"
    return Page(
        tuple(
            Thing(
                "rap-task-li",
                name,
                {
                    "name": name,
                    "type": "norm",
                    "taskstate": "linked" if inside.tasks[name] else "empty",
                    "excstate": "started" if running else "ready",
                    "active": "On" if inside.active[name] else "Off",
                    "motiontask": "TRUE" if name.startswith("T_ROB") else "FALSE",
                },
                f"tasks/{name}",
            )
            for name in sorted(inside.tasks)
        )
    )


def _activate(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    inside.task(found[1])
    inside.must_stand()
    inside.active[found[1]] = request.action == "activate"
    return NOTHING


def _load(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    inside.task(found[1])
    inside.may_edit(request.session)
    path = request.form.get("modulepath", "")
    if not path:
        raise RefusalError(400, UNKNOWN, "modulepath is missing")
    module = inside.load(found[1], inside.place(path), request.form.get("replace", "false").lower() == "true")
    if request.is_second:
        return Page((Thing("rap-task-module-li", module.name, {"name": module.name}),))
    return NOTHING


def _unload(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    inside.task(found[1])
    inside.may_edit(request.session)
    inside.unload(found[1], request.form.get("module", ""))
    return NOTHING


def _modules(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    modules = inside.task(request.query.get("task", ""))
    return Page(
        tuple(
            Thing("rap-module-info-li", one.name, {"name": one.name, "type": "SysMod" if one.is_system else "ProgMod"})
            for one in modules.values()
        )
    )


def _module_text(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    module = inside.module(request.query.get("task", ""), found[1])
    text = module.data.decode("utf-8" if request.is_second else "latin-1", "surrogateescape")
    values = {"module-text": text, "module-length": str(len(text))}
    return Page((Thing("rap-module-text", module.name, values),))


def _save(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    if inside.masters.get("rapid") != request.session:
        raise RefusalError(403, NOT_MASTER, "the mastership of RAPID is not held")
    module = inside.module(request.query.get("task", ""), found[1])
    suffix = ".modx" if request.is_second else ".mod"
    place = inside.place(f"{request.form.get('path', '')}/{request.form.get('name', module.name)}{suffix}")
    _written(inside, place, module.data)
    return NOTHING


def _pointer(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    file, line = inside.cabinet.place
    module = next((one for one in inside.task(found[1]).values() if file == f"{found[1]}/{one.file}"), None)
    values = {"beginposition": f"{line},1", "endposition": f"{line},1"}
    if module is not None:  # `modulemame` is how controllers spell it
        values |= {"modulemame": module.name, "routinename": module.routine_at(line)}
    return Page((Thing("pcp-info", "progpointer", values),))


# ---- mastership and grants


def _masters(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    domains = (found[1],) if found[1] else ("cfg", "motion", "rapid")
    return Page(
        tuple(
            Thing(
                "msh-resource",
                domain,
                {
                    "mastership": "remote" if domain in inside.masters else "nomaster",
                    "mastershipheldbyme": str(inside.masters.get(domain) == request.session).upper(),
                },
            )
            for domain in domains
        )
    )


def _mastership(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    domains = (found[1],) if found[1] else ("cfg", "motion", "rapid")
    for domain in domains:
        if request.action == "release":
            inside.give(domain, request.session)
        else:
            inside.take(domain, request.session)
    return NOTHING


def _grant(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    return NOTHING if request.action == "cancel" else Page(status=202, location="/users/rmmp/poll")


def _grant_asked(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    """Nobody stands at the pendant of a virtual controller; in automatic mode nobody has to."""
    granted = inside.cabinet.mode != "manual"
    values = {"code": "0" if granted else str(NO_REQUEST), "status": "GRANTED" if granted else "NO SUCH REQUEST"}
    return Page((Thing("user-rmmp-poll", "state", values),))


# ---- the file service


def _files(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    place = inside.place(found[1])
    if not inside.is_folder(place):
        return Page(data=_read(inside, place), of_files=True)
    return Page(tuple(_listed(inside, place)), of_files=True)


def _listed(inside: Inside, folder: str) -> Iterator[Thing]:
    store, moment = inside.cabinet.store, time.strftime("%Y-%m-%d T %H:%M:%S")
    seen: set[str] = set()
    top = f"{folder}/" if folder else ""
    below = [one.removeprefix(top) for one in inside.folders if one.startswith(top)]
    for name in [*store.names(), *(f"{top}{one}/" for one in below)]:
        if not name.startswith(top) or (not folder and name.startswith("$")):
            continue
        rest = name.removeprefix(top)
        first, sign, _ = rest.partition("/")
        if sign and first != "..":
            if first not in seen:
                seen.add(first)
                yield Thing("fs-dir", first, {"fs-cdate": moment, "fs-mdate": moment})
        else:
            size = str(store.size(name)) if name in store else "0"
            values = {"fs-cdate": moment, "fs-mdate": moment, "fs-size": size, "fs-readonly": "false"}
            yield Thing("fs-file", rest, values)


def _read(inside: Inside, place: str) -> bytes:
    try:
        return inside.cabinet.store.read(place)
    except NotDoneError:
        raise RefusalError(404, UNKNOWN, f"{place}: there is no such file") from None


# What a controller of ABB answers to each is not public but for 404 and 409; the words are ours.
_WHY = {
    "missing": (404, "there is no such file"),
    "protected": (403, "the file is read-only"),
    "full": (403, "the disk is full"),
    "busy": (403, "the file is in use"),
    "syntax": (400, "the text is not understood"),
    "name": (400, "the name is not allowed"),
    "exists": (409, "there is one of that name"),
    "emergency-stop": (403, "the emergency stop is pressed"),
}


def _refused(place: str, error: NotDoneError) -> RefusalError:
    status, words = _WHY[error.why]
    return RefusalError(status, UNKNOWN, f"{place}: {words}")


def _written(inside: Inside, place: str, content: bytes) -> bool:
    """Is it a new file? Raises RefusalError."""
    folder = place.rpartition("/")[0]
    if not inside.is_folder(folder):
        raise RefusalError(404, UNKNOWN, f"{folder}: there is no such folder")
    is_new = place not in inside.cabinet.store
    try:
        inside.cabinet.store.write(place, content)
    except NotDoneError as error:
        raise _refused(place, error) from None
    return is_new


def _put(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    return Page(status=201 if _written(inside, inside.place(found[1]), request.body) else 200, of_files=True)


def _delete(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    place = inside.place(found[1])
    if place in inside.folders:
        inside.folders.discard(place)
        return NOTHING
    try:
        inside.cabinet.store.delete(place)
    except NotDoneError as error:
        raise _refused(place, error) from None
    return NOTHING


def _copy(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    place, name = inside.place(found[1]), request.form.get("fs-newname", "")
    if not name:
        raise RefusalError(400, UNKNOWN, "fs-newname is missing")
    folder = place.rpartition("/")[0]
    absolute = name.removeprefix("/fileservice/")
    target = inside.place(absolute) if name.startswith("/fileservice/") else f"{folder}/{name}".lstrip("/")
    if ".." in target.split("/"):
        raise RefusalError(400, UNKNOWN, f"{name}: no path leads upwards")
    overwrite = request.form.get("fs-overwrite", "false").lower() == "true"
    if target in inside.cabinet.store and not (overwrite and request.action == "copy"):
        raise RefusalError(409, UNKNOWN, f"{name}: there is one of that name")
    try:
        content = inside.cabinet.store.kept(place)
    except NotDoneError as error:
        raise _refused(place, error) from None
    _written(inside, target, content)
    if request.action == "rename":
        inside.cabinet.store.delete(place)
    return NOTHING


def _create(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    above, name = inside.place(found[1]), request.form.get("fs-newname", "").strip("/")
    if not name or ".." in name.split("/") or not inside.is_folder(above):
        raise RefusalError(400, UNKNOWN, f"fs-newname: {name!r} is no folder")
    parts = f"{above}/{name}".lstrip("/").split("/")
    if inside.is_folder("/".join(parts)):
        raise RefusalError(409, UNKNOWN, f"{name}: there is one of that name")
    inside.folders.update("/".join(parts[:count]) for count in range(1, len(parts) + 1))
    return Page(status=201, of_files=True)


# ---- queues of messages


def _make_queue(inside: Inside, request: Asked, _: re.Match[str]) -> Page:
    name = request.form.get("dipc-queue-name", "")
    if name in inside.queues:
        raise RefusalError(400, QUEUE_IS_THERE, f"there is a queue {name}")
    inside.queues[name] = []
    return Page(status=201)


def _send(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    form = request.form
    message = {"queue-name": form.get("dipc-src-queue-name", "")}
    message |= {key: form.get(key, "") for key in ("dipc-data", "dipc-userdef", "dipc-msgtype", "dipc-cmd")}
    if found[1] not in inside.queues:
        raise RefusalError(404, UNKNOWN, f"there is no queue {found[1]}")
    inside.queues[found[1]].append(message)
    return NOTHING


def _receive(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    if found[1] not in inside.queues:
        raise RefusalError(404, UNKNOWN, f"there is no queue {found[1]}")
    messages, inside.queues[found[1]] = inside.queues[found[1]], []
    return Page(tuple(Thing("dipc-read-li", found[1], message) for message in messages))


def _route(method: str, path: str, handler: Handler, action: str | None = None) -> Route:
    return Route(method, re.compile(path), action, handler)


ROUTES = (
    _route("GET", r"/rw/system", _system),
    _route("GET", r"/rw/system/robottype", _robottype),
    _route("GET", r"/ctrl/identity", _identity),
    _route("GET", r"/ctrl/(\$\w+)", _environment),
    _route("GET", r"/rw/panel/ctrlstate", _control_state),
    _route("POST", r"/rw/panel/ctrlstate", _set_control_state, "setctrlstate"),
    _route("GET", r"/rw/panel/opmode", _operation_mode),
    _route("GET", r"/rw/panel/speedratio", _speed),
    _route("POST", r"/rw/panel/speedratio", _set_speed, "setspeedratio"),
    _route("GET", r"/rw/rapid/execution(?:;ctrlexecstate)?", _execution),
    _route("POST", r"/rw/rapid/execution", _start, "start"),
    _route("POST", r"/rw/rapid/execution", _stop, "stop"),
    _route("POST", r"/rw/rapid/execution", _reset, "resetpp"),
    _route("GET", r"/rw/rapid/tasks", _tasks),
    _route("GET", r"/rw/rapid/tasks/([^/]+)/pcp", _pointer),
    _route("POST", r"/rw/rapid/tasks/([^/]+)", _activate, "activate"),
    _route("POST", r"/rw/rapid/tasks/([^/]+)", _activate, "deactivate"),
    _route("POST", r"/rw/rapid/tasks/([^/]+)", _load, "loadmod"),
    _route("POST", r"/rw/rapid/tasks/([^/]+)", _unload, "unloadmod"),
    _route("GET", r"/rw/rapid/modules", _modules),
    _route("GET", r"/rw/rapid/modules/([^/]+)/text", _module_text),
    _route("POST", r"/rw/rapid/modules/([^/]+)", _save, "save"),
    _route("GET", r"/rw/mastership(?:/(cfg|motion|rapid))?", _masters),
    _route("POST", r"/rw/mastership(?:/(cfg|motion|rapid))?", _mastership),
    _route("POST", r"/users/rmmp", _grant),
    _route("GET", r"/users/rmmp/poll", _grant_asked),
    _route("GET", r"/fileservice/(.+)", _files),
    _route("PUT", r"/fileservice/(.+)", _put),
    _route("DELETE", r"/fileservice/(.+)", _delete),
    _route("POST", r"/fileservice/(.+)", _create, "create"),
    _route("POST", r"/fileservice/(.+)", _copy, "copy"),
    _route("POST", r"/fileservice/(.+)", _copy, "rename"),
    _route("POST", r"/rw/dipc", _make_queue, "dipc-create"),
    _route("POST", r"/rw/dipc/([^/]+)", _send, "dipc-send"),
    _route("GET", r"/rw/dipc/([^/]+)", _receive, "dipc-read"),
    _route("GET", r"/rw/rapid/symbol/data/RAPID/(.+?)(?:;value)?", data.read_symbol),
    _route("POST", r"/rw/rapid/symbol/data/RAPID/(.+)", data.set_symbol, "set"),
    _route("POST", r"/rw/rapid/symbols", data.search_symbols, "search-symbols"),
    _route("GET", r"/rw/iosystem/signals", data.signals),
    _route("GET", r"/rw/iosystem/signals/(.+?)(?:;state)?", data.read_signal),
    _route("POST", r"/rw/iosystem/signals/(.+)", data.set_signal, "set"),
    _route("GET", r"/rw/elog/0", data.log),
    _route("GET", r"/rw/motionsystem/mechunits/([^/]+)/jointtarget", motion.joint_target),
    _route("GET", r"/rw/motionsystem/mechunits/([^/]+)/robtarget", motion.robot_target),
)
