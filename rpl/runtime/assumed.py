"""Data that had no value when a program first read it and got one all the same, because whoever started the run asked
for that: what a controller keeps and no file of the project gives. Each is kept with its place and the value assumed,
so that a result says on what it rests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rpl.runtime.functions.texts import value_text
from rpl.runtime.values import JointsValue, PoseValue, TargetValue, Value
from rpl.source import Origin

_ANGLES, _QUATERNION = ("a", "b", "c"), ("q1", "q2", "q3", "q4")
_JOINTS = ("j1", "j2", "j3", "j4", "j5", "j6")


@dataclass(frozen=True, slots=True)
class Assumed:
    """A datum as the program calls it, the value it got, and the statement that read it first."""

    name: str
    value: Value
    task: str
    origin: Origin

    @property
    def shown(self) -> str:
        """The value in words."""
        match self.value:
            case bool():
                return str(self.value).upper()
            case "":
                return "an empty text"
            case TargetValue(pose=pose) | (PoseValue() as pose):
                names = _ANGLES if pose.rot.convention == "zyx" else _QUATERNION
                return _listed((*"xyz", *names), (*pose.trans, *pose.rot.parts))
            case JointsValue(axes=axes):
                return _listed(_JOINTS, axes.values)
        return value_text(self.value)

    def as_json(self) -> dict[str, object]:
        """A stable document: name, value in words, task, file, line."""
        place = {"file": self.origin.file, "line": self.origin.line}
        return {"name": self.name, "value": self.shown, "task": self.task, **place}


def _listed(names: Sequence[str], numbers: Sequence[float | None]) -> str:
    return ", ".join(f"{name} {number or 0.0:.6g}" for name, number in zip(names, numbers, strict=True))


__all__ = ["Assumed"]
