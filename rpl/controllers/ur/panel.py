"""What Universal Robots' controller knows beside the cabinet: which program is loaded, modes, its own words for states.

All of its interfaces say the same of one moment, each in its words: they ask here.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError
from rpl.source import source_from_bytes

# What this controller says that it is.
VERSION = (5, 12, 2, 1101534)
BUILT = "Sep 08 2022"


@dataclass
class Panel:
    """loaded: the file that `play` would run. `operational`: manual or automatic where a password protects the modes,
    else none. speed: what the slider shows (0 ... 1); the emulated robot does not follow it."""

    cabinet: Cabinet
    loaded: str = ""
    operational: str = "NONE"
    powered: bool = True
    released: bool = True
    protective_stop: bool = False
    popup: str = ""
    speed: float = 1.0
    log: list[str] = field(default_factory=list)

    @property
    def model(self) -> str:
        """UR10 of `ur10e`: the e-Series says no e."""
        name = self.cabinet.model.name if self.cabinet.model is not None else "ur5e"
        return name.upper().removesuffix("E")

    @property
    def robot_mode(self) -> str:
        if not self.powered or self.cabinet.emergency_stop:
            return "POWER_OFF"
        return "RUNNING" if self.released else "IDLE"

    @property
    def safety(self) -> str:
        if self.cabinet.emergency_stop:
            return "ROBOT_EMERGENCY_STOP"
        return "PROTECTIVE_STOP" if self.protective_stop else "NORMAL"

    @property
    def program_state(self) -> str:
        return {"stopped": "STOPPED", "running": "PLAYING", "paused": "PAUSED"}[self.cabinet.phase]

    @property
    def is_ready(self) -> bool:
        """Could a program move the robot now?"""
        return self.robot_mode == "RUNNING" and self.safety == "NORMAL"

    def load(self, name: str) -> None:
        """Raises NotDoneError: missing, or syntax."""
        self.cabinet.store.kept(name)
        errors = self.cabinet.check([name])
        if errors:
            raise NotDoneError("syntax", errors[0].message)
        self.loaded = name

    def play(self) -> None:
        """From where it was paused, else from the beginning. Raises NotDoneError."""
        if not self.is_ready:
            raise NotDoneError("emergency-stop")
        if self.cabinet.phase == "running":
            raise NotDoneError("busy", self.cabinet.program)
        if self.cabinet.phase != "paused":
            if not self.loaded:
                raise NotDoneError("missing", "no program is loaded")
            errors = self.cabinet.select([self.loaded])
            if errors:
                raise NotDoneError("syntax", errors[0].message)
        self.cabinet.start()

    def run_text(self, text: bytes, name: str = "pushed.script") -> None:
        """A program that was pushed takes the place of the one that runs. Raises NotDoneError."""
        if not self.is_ready:
            raise NotDoneError("emergency-stop")
        self.cabinet.stop()
        errors = self.cabinet.select_sources([source_from_bytes(name, text)])
        if errors:
            said = f"{errors[0].origin.line}: {errors[0].message}"
            self.cabinet.messages.append(f"syntax error in {name}:{said}")
            raise NotDoneError("syntax", said)
        self.cabinet.start()
