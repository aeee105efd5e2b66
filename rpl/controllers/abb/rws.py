"""The client of ABB's web services: files, state, mastership, and loading modules into tasks.

A file replaces another by a copy that the controller makes itself (`fs-overwrite`), which is one request: what the
manual says of renaming does not tell what becomes of a file of that name. Files go to the folder of the profile; those
in a folder that is called like a task are loaded into that one, others into the profile's, else the only motion task.
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import PurePosixPath

from rpl.controllers.abb.answers import Item, checked, items, one
from rpl.controllers.abb.calls import FIRST, GENERATIONS, SECOND, Generation
from rpl.controllers.abb.session import Session
from rpl.controllers.link import (
    LARGEST_FILE,
    MOST_FILES,
    GarbledError,
    Identity,
    LinkError,
    LoginError,
    LostError,
    NotThereError,
    RefusedError,
    RemoteFile,
    State,
)
from rpl.controllers.pins import check_key
from rpl.controllers.profile import Profile
from rpl.controllers.rules import safe_name
from rpl.errors import UsageError

_DEEPEST = 12
_TEMPORARY, _LONGEST_NAME = "$TEMP", 32
_MODULES = (".mod", ".modx", ".sys", ".sysx")
_MODULE_LINE = re.compile(rb"(?im)^\s*MODULE\s+([A-Za-z]\w*)")
_STOPPED = ("emergencystop", "emergencystopreset")


class RwsLink:
    """A connection to one controller (see `rpl.controllers.link.Link`)."""

    can_rename = True

    def __init__(self, profile: Profile, session: Session) -> None:
        self.profile = profile
        self.session = session
        self._tasks: tuple[Mapping[str, str], ...] | None = None

    @property
    def generation(self) -> Generation:
        return self.session.generation

    # ---- who and what

    def _values(self, wanted: str, *kinds: str, **names: str) -> Mapping[str, str]:
        path = self.generation.path(wanted, **names)
        return one(checked(self.session.get(path), f"{self.profile.name}: {path}"), *kinds)

    def _values_if_known(self, wanted: str, *kinds: str, **names: str) -> Mapping[str, str]:
        """Nothing, where this controller does not know the question."""
        try:
            return self._values(wanted, *kinds, **names)
        except RefusedError:
            return {}

    def identity(self) -> Identity:
        system = self._values("system", "sys-system-li", "sys-system")
        who = self._values_if_known("identity", "ctrl-identity-info", "ctrl-identity-info-li")
        arm = self._values_if_known("robottype", "sys-robottype")
        return Identity(
            maker="ABB",
            model=arm.get("robot-type", ""),
            serial=who.get("ctrl-id", ""),
            firmware=system.get("rwversion", ""),
            name=who.get("ctrl-name", system.get("name", "")),
        )

    def state(self) -> State:
        control = self._values("ctrlstate", "pnl-ctrlstate").get("ctrlstate")
        execution = self._values("execution", "rap-execution").get("ctrlexecstate")
        task = self._motion_task()
        pointer = self._values_if_known("pointer", "pcp-info", task=task) if task else {}
        module = pointer.get("modulemame", pointer.get("modulename"))  # the former is how controllers spell it
        begin = pointer.get("beginposition", "").partition(",")[0]
        return State(
            mode=self._values("opmode", "pnl-opmode").get("opmode"),
            running=None if execution is None else execution == "running",
            motors_on=None if control is None else control == "motoron",
            emergency_stop=None if control is None else control in _STOPPED,
            program=f"{module}/{pointer.get('routinename', '')}" if module else None,
            line=int(begin) if begin.isdigit() else None,
            selected=(),  # what runs is in the memory of the program, not in the files
            opened=(),
        )

    def tasks(self) -> tuple[Mapping[str, str], ...]:
        """What the controller says of each task, asked once."""
        if self._tasks is None:
            answer = checked(self.session.get(self.generation.path("tasks")), f"{self.profile.name}: tasks")
            self._tasks = tuple(item.values for item in items(answer) if item.kind == "rap-task-li")
        return self._tasks

    def _motion_task(self) -> str | None:
        """The only task that moves a robot, or the profile's only one."""
        if len(self.profile.tasks) == 1:
            return self.profile.tasks[0]
        moving = [task.get("name", "") for task in self.tasks() if task.get("motiontask", "").lower() == "true"]
        return moving[0] if len(moving) == 1 else None

    # ---- files

    def _target(self, name: str) -> str:
        return self.generation.file_path(self.profile.folder, safe_name(name))

    def files(self) -> Sequence[RemoteFile]:
        found: list[RemoteFile] = []
        folders = [("", 0)]
        while folders:
            folder, depth = folders.pop()
            for item in self._listed(folder):
                name = f"{folder}/{item.title}" if folder else item.title
                if item.kind == "fs-file":
                    size = item.values.get("fs-size", "")
                    found.append(RemoteFile(name, int(size) if size.isdecimal() else None))
                elif depth < _DEEPEST:
                    folders.append((name, depth + 1))
            if len(found) + len(folders) > MOST_FILES:
                raise GarbledError(f"{self.profile.name} holds more than {MOST_FILES} files")
        return sorted(found, key=lambda file: file.name)

    def _listed(self, folder: str) -> Iterator[Item]:
        """What lies in a folder. Raises GarbledError for names that lead elsewhere."""
        path = self.generation.file_path(self.profile.folder, folder)
        for item in items(checked(self.session.get(path), folder or self.profile.folder)):
            if item.kind not in ("fs-file", "fs-dir"):
                continue
            if item.kind == "fs-dir" and (item.title in (".", "..") or not item.has_self):
                continue
            if "/" in safe_name(item.title):
                raise GarbledError(f"the controller names a file {item.title!r}, which is none of this folder")
            yield item

    def fetch(self, name: str) -> bytes:
        return checked(self.session.get(self._target(name), LARGEST_FILE, raw=True), name).body

    def put(self, name: str, data: bytes) -> None:
        target = self._target(name)
        answer = self.session.put(target, data)
        if answer.status == 404 and "/" in name:  # the folder is not there
            self._make(str(PurePosixPath(safe_name(name)).parent))
            answer = self.session.put(target, data)
        checked(answer, name)

    def _make(self, folder: str) -> None:
        """Create a folder; those above it may be missing too."""
        above = self.generation.file_path(self.profile.folder)
        if self.generation.number == "1":
            answer = self.session.post(above, fs_action="create", fs_newname=folder)
        else:
            answer = self.session.post(f"{above}/create", fs_newname=folder)
        if answer.status != 409:
            checked(answer, folder)

    def rename(self, old: str, new: str) -> None:
        first, second = PurePosixPath(safe_name(old)), PurePosixPath(safe_name(new))
        if first.parent != second.parent:
            raise RefusedError(f"{new}: a file of this controller stays in its folder")
        if self.generation.number == "1":
            answer = self.session.post(self._target(old), fs_action="copy", fs_newname=second.name, fs_overwrite="true")
        else:
            answer = self.session.post(f"{self._target(old)}/copy", fs_newname=second.name, fs_overwrite="true")
        checked(answer, new)
        self.delete(old)

    def delete(self, name: str) -> None:
        checked(self.session.delete(self._target(name)), name)

    # ---- mastership, and loading into tasks

    def lock(self) -> None:
        """In manual mode the controller gives it only to whom the pendant lets: then it is refused."""
        what = "the mastership of RAPID (a program that was killed holds it for up to five minutes)"
        checked(self.session.post(self.generation.path("take")), what)

    def unlock(self) -> None:
        checked(self.session.post(self.generation.path("give")), "the mastership of RAPID")

    def take_in(self, names: Sequence[str]) -> None:
        """Load modules into their tasks; one that is there is replaced. The controller must hold still, and the caller
        the mastership (`lock`)."""
        loaded: dict[str, set[str]] = {}
        for name in names:
            if PurePosixPath(name.lower()).suffix not in _MODULES:
                continue
            task = self._task_of(name)
            if task not in loaded:
                loaded[task] = self._modules(task)
            module = self._module_name(name)
            there = module.lower() in loaded[task]
            if there:
                self._keep(task, module)
            path = f"{self.profile.folder.rstrip('/')}/{safe_name(name)}"
            call = self.generation.path("load", task=task)
            checked(self.session.post(call, modulepath=path, replace=str(there).lower()), name)

    def take_out(self, names: Sequence[str]) -> None:
        """Unload modules; what the memory held of them is kept on this machine."""
        for name in names:
            if PurePosixPath(name.lower()).suffix not in _MODULES:
                continue
            task, module = self._task_of(name), self._module_name(name)
            if module.lower() in self._modules(task):
                self._keep(task, module)
                call = self.generation.path("unload", task=task)
                checked(self.session.post(call, module=module), name)

    def memory(self, task: str, module: str) -> bytes:
        """The text of a module as the task has it now: points may have been taught since it was loaded. 1.0 knows that
        only by saving it to a file, which is removed again; the caller must hold the mastership for that."""
        if self.generation.number == "2":
            text = self._values("text", "rap-module-text", task=task, module=module).get("module-text")
            if text is None:
                raise GarbledError(f"{self.profile.name}: the controller does not give the text of {module}")
            try:
                return text.encode(self.profile.encoding or "utf-8", "surrogateescape")
            except UnicodeEncodeError:
                raise GarbledError(
                    f"{self.profile.name}: {module} has characters that {self.profile.encoding} has not"
                ) from None
        name = f"rpl_{module}"[:_LONGEST_NAME]
        path = self.generation.file_path(_TEMPORARY, f"{name}.mod")
        saved = self.generation.path("save", task=task, module=module)
        checked(self.session.post(saved, name=name, path=_TEMPORARY), f"the text of {module}")
        try:
            return checked(self.session.get(path, LARGEST_FILE, raw=True), f"the text of {module}").body
        finally:
            self.session.delete(path)

    def _keep(self, task: str, module: str) -> None:
        """What is in the memory may be in no file: it is kept before it is replaced. Raises when that fails."""
        folder = self.profile.state_folder / "memory" / re.sub(r"\W", "_", self.profile.name) / safe_name(task)
        folder.mkdir(parents=True, exist_ok=True)
        text = self.memory(task, module)
        name = f"{safe_name(module)}-{time.strftime('%Y%m%d-%H%M%S')}-{hashlib.sha256(text).hexdigest()[:8]}.mod"
        with (folder / name).open("wb") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())

    def _modules(self, task: str) -> set[str]:
        answer = checked(self.session.get(self.generation.path("modules", task=task)), f"modules of {task}")
        return {item.values.get("name", "").lower() for item in items(answer) if item.kind == "rap-module-info-li"}

    def _module_name(self, name: str) -> str:
        """What the file on the controller calls its module; its own name where it does not say."""
        try:
            found = _MODULE_LINE.search(self.fetch(name))
        except NotThereError:
            found = None
        return found[1].decode("latin-1") if found else PurePosixPath(name).stem

    def _task_of(self, name: str) -> str:
        known = {task.get("name", "").lower(): task.get("name", "") for task in self.tasks()}
        for folder in PurePosixPath(name).parts[:-1]:
            if folder.lower() in known:
                return known[folder.lower()]
        task = self._motion_task()
        if task is None:
            raise RefusedError(
                f"{name}: is it for {', '.join(sorted(known.values()))}? Name `tasks` in the profile, or put it into a "
                "folder that is called like its task"
            )
        return task

    def close(self) -> None:
        try:
            self.session.get(self.generation.path("logout"))
        except LinkError:
            pass  # the session ends by itself
        finally:
            self.session.close()


def connect(profile: Profile) -> RwsLink:
    """A session that is let in. Raises LinkError, or UsageError for a profile that does not say enough."""
    if not profile.host:
        raise UsageError(f"{profile.name}: which controller? Give its host")
    said = profile.option("generation", "")
    if said and said not in GENERATIONS:
        raise UsageError(f"{profile.name}: generation is 1 or 2, not {said}")
    if said or profile.port is not None:
        return _let_in(profile, GENERATIONS[said or "1"])
    try:
        return _let_in(profile, FIRST)
    except LoginError:
        raise
    except LinkError as first:
        try:
            return _let_in(profile, SECOND)
        except LostError:
            raise first from None


def fingerprint(certificate: bytes) -> str:
    """Of a certificate in DER, as keys of SSH are written."""
    return "SHA256:" + base64.b64encode(hashlib.sha256(certificate).digest()).decode().rstrip("=")


def _let_in(profile: Profile, generation: Generation) -> RwsLink:
    session = Session(
        profile,
        generation,
        lambda port, certificate: check_key(profile, "tls", port, fingerprint(certificate), "certificate"),
    )
    try:
        who = profile.user or "nobody"
        items(checked(session.get(generation.path("system")), f"{profile.name}: {who} asks to be let in"))
    except LinkError:
        session.close()
        raise
    return RwsLink(profile, session)
