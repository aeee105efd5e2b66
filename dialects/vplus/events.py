"""Events between tasks: SET.EVENT of one task lets another go on that waits in WAIT.EVENT. Each task has one flag
(M: any mask but 0 waits for it, and only CLEAR.EVENT takes it down), which is a global variable here, off at first.

Which task a program belongs to is looked up in the texts: what is executed in a task, and what that calls.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from .expressions import significant

_PROGRAM = re.compile(r"^[ \t]*\.PROGRAM[ \t]+([A-Za-z_][\w.]*)", re.IGNORECASE | re.MULTILINE)
_CALLED = re.compile(
    r"^[ \t]*(?:\d+[ \t]+)?(?:CALL[ \t]+|REACTE[ \t]+|REACTI?\b[^;,\r\n]*,[ \t]*)([A-Za-z_][\w.]*)",
    re.IGNORECASE | re.MULTILINE,
)
MAIN = "0"


def tasks_of(texts: Iterable[str], executed: Mapping[str, Iterable[str]]) -> dict[str, str]:
    """Program -> the number (or name) of the only task that it runs in."""
    calls: dict[str, set[str]] = {}
    for text in texts:
        parts = _PROGRAM.split(text)
        for name, body in zip(parts[1::2], parts[2::2], strict=True):
            calls.setdefault(significant(name), set()).update(map(significant, _CALLED.findall(body)))
    found: dict[str, set[str]] = {}

    def reach(program: str, task: str) -> None:
        if program in calls and task not in found.setdefault(program, set()):
            found[program].add(task)
            for other in calls[program]:
                reach(other, task)

    for task, programs in executed.items():
        for program in programs:
            reach(significant(program), task)
    called = {other for names in calls.values() for other in names}
    for program in calls:
        if program not in found and program not in called:
            reach(program, MAIN)
    return {program: next(iter(tasks)) for program, tasks in found.items() if len(tasks) == 1}


__all__ = ["MAIN", "tasks_of"]
