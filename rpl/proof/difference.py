"""The first difference of two runs, as data and in words."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.proof.record import Place, Value


@dataclass(frozen=True, slots=True)
class Side:
    """What one of the two programs did there; `what` in words, None when it did nothing more."""

    what: str | None
    place: Place = field(default_factory=Place)
    t: float | None = None
    value: Value = None

    def as_json(self) -> dict[str, object]:
        return {"what": self.what, **self.place.as_json(), "t": self.t, "value": self.value}


@dataclass(frozen=True, slots=True)
class Difference:
    """kind: task, output, message, dialog, wait, fault, end, place, move, path, joints, time. `level` is the level that
    it refutes."""

    kind: str
    level: str
    explanation: str
    a: Side
    b: Side
    task: str = ""

    def as_json(self) -> dict[str, object]:
        return {
            "kind": self.kind,
            "task": self.task,
            "explanation": self.explanation,
            "a": self.a.as_json(),
            "b": self.b.as_json(),
        }

    def as_text(self) -> str:
        """Several lines: what differs, then both places."""
        lines = [self.explanation]
        for side, name in ((self.a, "A"), (self.b, "B")):
            what = side.what if side.what is not None else "nothing more"
            when = f" at {side.t:.3f} s" if side.t is not None else ""
            lines.append(f"  {name}: {what}{when}")
            if side.place.line:
                lines.append(f"     {side.place}")
        return "\n".join(lines)
