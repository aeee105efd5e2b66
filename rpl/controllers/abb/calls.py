"""Where a controller is asked for what, in both generations of its web services.

1.0: pages of 3HAC050973-001 (rapid_task_*, msh_domain_*, fs_*, panel_*); 2.0: verbs are part of the path, the
mastership of RAPID is called `edit`. Save, the text of a module and the 2.0 column come from notes of people who tried
them on RobotWare 6.16, 7.21 and 8.1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal
from urllib.parse import quote

Number = Literal["1", "2"]
FORM = "application/x-www-form-urlencoded"


@dataclass(frozen=True, slots=True)
class Generation:
    """number: 1 or 2. interface: name of its port. `paths`: by what is wanted, with names to be filled in. `accepts`:
    the media type of answers; `form` and `file`: those of what is sent. `protocol`: of the websocket."""

    number: Number
    interface: str
    secure: bool
    paths: Mapping[str, str]
    accepts: str
    form: str
    file: str
    protocol: str

    def path(self, wanted: str, **names: str) -> str:
        return self.paths[wanted].format(**{key: quote(value, safe="") for key, value in names.items()})

    def file_path(self, folder: str, name: str = "") -> str:
        """The address of a file or folder: 1.0 takes `$` only as it is, 2.0 has environment variables without it."""
        whole = "/".join(part for part in (folder.strip("/"), name) if part)
        if self.number == "2":
            whole = whole.removeprefix("$")
        return "/fileservice/" + quote(whole, safe="/$:")


_SAME = {
    "system": "/rw/system",
    "robottype": "/rw/system/robottype",
    "identity": "/ctrl/identity",
    "opmode": "/rw/panel/opmode",
    "execution": "/rw/rapid/execution",
    "tasks": "/rw/rapid/tasks",
    "pointer": "/rw/rapid/tasks/{task}/pcp",
    "joints": "/rw/motionsystem/mechunits/{unit}/jointtarget",
    "pose": "/rw/motionsystem/mechunits/{unit}/robtarget",
    "signals": "/rw/iosystem/signals",
    "log": "/rw/elog/0",
    "logout": "/logout",
    "subscription": "/subscription",
}

FIRST = Generation(
    "1",
    "rws",
    False,
    _SAME
    | {
        "ctrlstate": "/rw/panel/ctrlstate",
        "modules": "/rw/rapid/modules?task={task}",
        "load": "/rw/rapid/tasks/{task}?action=loadmod",
        "unload": "/rw/rapid/tasks/{task}?action=unloadmod",
        "save": "/rw/rapid/modules/{module}?action=save&task={task}",
        "take": "/rw/mastership/rapid?action=request",
        "give": "/rw/mastership/rapid?action=release",
        "data": "/rw/rapid/symbol/data/RAPID/{task}/{module}/{name}",
    },
    accepts="application/json",
    form=FORM,
    file="application/octet-stream",
    protocol="robapi2_subscription",
)

SECOND = Generation(
    "2",
    "rws2",
    True,
    _SAME
    | {
        "ctrlstate": "/rw/panel/ctrl-state",
        "modules": "/rw/rapid/tasks/{task}/modules",
        "load": "/rw/rapid/tasks/{task}/loadmod",
        "unload": "/rw/rapid/tasks/{task}/unloadmod",
        "text": "/rw/rapid/tasks/{task}/modules/{module}/text",
        "take": "/rw/mastership/edit/request",
        "give": "/rw/mastership/edit/release",
        "data": "/rw/rapid/symbol/RAPID/{task}/{module}/{name}/data",
    },
    accepts="application/hal+json;v=2.0",
    form=f"{FORM};v=2.0",
    file="application/octet-stream;v=2.0",
    protocol="rws_subscription",
)
GENERATIONS = {each.number: each for each in (FIRST, SECOND)}
