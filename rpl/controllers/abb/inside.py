"""What only an ABB controller has inside: modules in the memory of tasks, mastership, the queues of messages, and the
volumes of its file service. Files of $HOME are the cabinet's files; other volumes have their name in front (`$temp/`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError
from rpl.diagnostics import Diagnostic
from rpl.source import source_from_bytes

# Numbers that clients and ABB's pages name: not master of RAPID, the program runs, no such request for RMMP, a queue
# of that name is there, somebody else is master. Others are not public: -1.
NOT_MASTER, PROGRAM_RUNS, NO_REQUEST, QUEUE_IS_THERE = -1073414146, -1073442809, -1073445870, -1073445879
OTHER_IS_MASTER, UNKNOWN = -1073445862, -1
MODULES = (".mod", ".modx", ".sys", ".sysx")
MAIN_TASK = "T_ROB1"
VOLUMES = ("home", "temp", "release", "system", "options", "backup", "internal", "syspar", "ramdisk")
_ROUTINE = re.compile(r"(?im)^\s*(?:LOCAL\s+)?(?:PROC|TRAP|FUNC\s+\w+)\s+([A-Za-z]\w*)")
_MAIN = re.compile(rb"(?i)\bPROC\s+main\s*\(")
_WITHOUT_VALUES = re.compile(rb"(?im)^\s*PROC\s+([A-Za-z]\w*)\s*\(\s*\)")
_MODULE = re.compile(r"(?im)^\s*MODULE\s+([A-Za-z]\w*)\s*(\([^)]*\))?")


class RefusalError(Exception):
    """A request is not carried out: the status of HTTP, the controller's number, and its words."""

    def __init__(self, status: int, code: int, message: str) -> None:
        super().__init__(message)
        self.status = status
        self.code = code
        self.message = message


@dataclass(frozen=True, slots=True)
class Loaded:
    """A module in the memory of a task: its text as it was loaded, and the file it came from."""

    name: str
    file: str
    data: bytes
    is_system: bool

    def routine_at(self, line: int) -> str:
        """The routine that a line (1 ...) is in."""
        above = b"\n".join(self.data.splitlines()[:line]).decode("latin-1")
        return next((found[1] for found in reversed(list(_ROUTINE.finditer(above)))), "")


@dataclass
class Inside:
    """tasks: name -> modules by their name in lower case. masters: domain -> the session that holds it."""

    cabinet: Cabinet
    tasks: dict[str, dict[str, Loaded]] = field(default_factory=dict)
    active: dict[str, bool] = field(default_factory=dict)
    masters: dict[str, str] = field(default_factory=dict)
    queues: dict[str, list[Mapping[str, str]]] = field(default_factory=dict)
    folders: set[str] = field(default_factory=set)
    speed_ratio: int = 100

    def __post_init__(self) -> None:
        self.tasks[MAIN_TASK] = {}
        for name in self.cabinet.store.names():
            if PurePosixPath(name.lower()).suffix in MODULES and ".." not in name:
                folder = name.partition("/")[0]
                task = folder.upper() if folder.upper().startswith("T_") else MAIN_TASK
                module = self._module(name)
                self.tasks.setdefault(task, {})[module.name.lower()] = module
        self.active = dict.fromkeys(self.tasks, True)
        if self.cabinet.phase != "running":
            self.select()

    # ---- modules

    def _module(self, file: str) -> Loaded:
        data = self.cabinet.store.kept(file)
        found = _MODULE.search(data.decode("latin-1"))
        name = found[1] if found else PurePosixPath(file).stem
        return Loaded(name, file, data, found is not None and "SYSMODULE" in (found[2] or "").upper())

    def task(self, name: str) -> dict[str, Loaded]:
        if name not in self.tasks:
            raise RefusalError(404, UNKNOWN, f"there is no task {name}")
        return self.tasks[name]

    def may_edit(self, session: str) -> None:
        """Only the master of RAPID may, and only while the program stands."""
        if self.masters.get("rapid") != session:
            raise RefusalError(403, NOT_MASTER, "the mastership of RAPID is not held")
        self.must_stand()

    def must_stand(self) -> None:
        if self.cabinet.phase == "running":
            raise RefusalError(403, PROGRAM_RUNS, "Operation not allowed for current PGM state")

    def load(self, task: str, file: str, replace: bool) -> Loaded:
        """A file becomes a module of a task. Raises RefusalError with what the loader says of its text."""
        modules = self.task(task)
        try:
            module = self._module(file)
        except NotDoneError:
            raise RefusalError(404, UNKNOWN, f"{file}: there is no such file") from None
        errors = self.cabinet.check([file])
        if errors:
            raise RefusalError(400, UNKNOWN, errors[0].as_text())
        if module.name.lower() in modules and not replace:
            raise RefusalError(400, UNKNOWN, f"there is a module {module.name} in {task}")
        modules[module.name.lower()] = module
        self._look_anew(module.name)
        return module

    def unload(self, task: str, name: str) -> None:
        if self.task(task).pop(name.lower(), None) is None:
            raise RefusalError(404, UNKNOWN, f"there is no module {name} in {task}")
        self._look_anew()

    def _look_anew(self, loaded: str = "") -> None:
        """Data and routines are those of the modules in the memory now; those of a module that was just loaded are as
        its text says, other modules keep theirs. M: the program pointer goes to main. Where the modules do not fit
        together nothing of them can be asked for or run."""
        if self.select(loaded):
            self.cabinet.stop()

    def module(self, task: str, name: str) -> Loaded:
        found = self.task(task).get(name.lower())
        if found is None:
            raise RefusalError(404, UNKNOWN, f"there is no module {name} in {task}")
        return found

    @property
    def has_main(self) -> bool:
        """Is there a routine for the program pointer to go to?"""
        return any(_MAIN.search(one.data) for modules in self.tasks.values() for one in modules.values())

    def select(self, loaded: str = "") -> list[Diagnostic]:
        """The program pointer of all tasks goes to main; without one data can be asked for all the same. `loaded`: see
        `_look_anew`."""
        texts = {f"{task}/{one.file}": one.data for task, modules in self.tasks.items() for one in modules.values()}
        first = next((found for data in texts.values() if (found := _WITHOUT_VALUES.search(data))), None)
        if not self.has_main and first is None:
            self.cabinet.stop()
            return []
        entry = "main" if self.has_main or first is None else first[1].decode("latin-1")
        sources = [source_from_bytes(name, data) for name, data in texts.items()]
        return self.cabinet.select_sources(sources, entry, loaded)

    # ---- mastership

    def take(self, domain: str, session: str) -> None:
        if self.cabinet.mode == "manual":
            raise RefusalError(403, NOT_MASTER, "in manual mode the pendant must grant it")
        holder = self.masters.get(domain)
        if holder is not None and holder != session:
            raise RefusalError(403, OTHER_IS_MASTER, "the mastership is held by someone else")
        self.masters[domain] = session

    def give(self, domain: str, session: str) -> None:
        if self.masters.get(domain) != session:
            raise RefusalError(403, NOT_MASTER, "the mastership is not held")
        del self.masters[domain]

    def forget(self, session: str) -> None:
        """A session is over: what it held is free."""
        self.masters = {domain: holder for domain, holder in self.masters.items() if holder != session}

    # ---- volumes

    def place(self, path: str) -> str:
        """The file of the cabinet, or the folder, behind a path of the file service. Raises RefusalError."""
        first, _, rest = path.strip("/").partition("/")
        volume = first.strip("$~:").lower()
        if volume not in VOLUMES:
            raise RefusalError(404, UNKNOWN, f"{path}: there is no such volume")
        if any(part in ("..", ".") for part in rest.split("/")):
            raise RefusalError(400, UNKNOWN, f"{path}: no path leads upwards")
        return rest if volume == "home" else f"${volume}/{rest}".rstrip("/")

    def is_folder(self, place: str) -> bool:
        if place in ("", *(f"${volume}" for volume in VOLUMES)) or place in self.folders:
            return True
        return any(name.startswith(place + "/") for name in self.cabinet.store.names())
