"""What is seen of a controller from outside: who it is, what it does, where the robot stands, its signals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from rpl.controllers.link import Identity, State

Shown = str | int | float | bool


@dataclass(frozen=True, slots=True)
class Status:
    """One look at a controller. joints: degrees (mm for linear axes), as its maker counts them; xyz_mm and
    `orientation` (in its maker's notation, by name) of its present tool in its present frame; None: it does not say."""

    identity: Identity
    state: State
    joints: tuple[float, ...] | None = None
    xyz_mm: tuple[float, ...] | None = None
    orientation: Mapping[str, float] = field(default_factory=dict)
    signals: Mapping[str, Shown] = field(default_factory=dict)
    messages: tuple[str, ...] = ()

    def as_json(self) -> dict[str, object]:
        return {
            "identity": self.identity.said(),
            "state": self.state.as_json(),
            "joints": list(self.joints) if self.joints is not None else None,
            "xyz_mm": list(self.xyz_mm) if self.xyz_mm is not None else None,
            "orientation": dict(self.orientation),
            "signals": dict(self.signals),
            "messages": list(self.messages),
        }

    def lines(self) -> Iterator[str]:
        """The same for people."""
        yield "controller   " + (", ".join(f"{word} {value}" for word, value in self.identity.said().items()) or "-")
        said = self.state.as_json()
        known = [_said(word, value) for word, value in said.items() if value is not None]
        unknown = [word.replace("_", " ") for word, value in said.items() if value is None]
        yield "state        " + ", ".join([*known, f"not said: {', '.join(unknown)}"] if unknown else known)
        if self.joints is not None:
            yield "joints       " + ", ".join(f"{value:.3f}" for value in self.joints)
        if self.xyz_mm is not None:
            turned = "".join(f", {word} {value:.4f}" for word, value in self.orientation.items())
            yield "tool         " + ", ".join(f"{value:.3f}" for value in self.xyz_mm) + " mm" + turned
        for name, value in self.signals.items():
            yield f"{name:<12} {value}"
        for text in self.messages:
            yield f"message      {text}"


def _said(word: str, value: object) -> str:
    shown = word.replace("_", " ")
    if isinstance(value, bool):
        return shown if value else f"not {shown}"
    return f"{shown} {', '.join(map(str, value)) or 'none' if isinstance(value, list) else value}"


@dataclass(frozen=True, slots=True)
class Sample:
    """Values at one moment: `t`, s since the watching began."""

    t: float
    values: Mapping[str, Shown | tuple[float, ...] | None]
