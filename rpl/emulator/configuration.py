"""What the emulator asks of a controller's way to write down which of an arm's postures is meant.

Every brand has its own flags beside a pose; each dialect that has some offers an object with this protocol. The core
hands it the robot model and never looks at the flags itself.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray, IntArray
from rpl.emulator.selection import Chosen

Flags = Mapping[str, int | None]


@dataclass(frozen=True, slots=True, eq=False)
class Selection:
    """The joints (n,) that a controller would take, or None and the reason in words."""

    joints: FloatArray | None
    reason: str = ""


class Notation(Protocol):
    """One brand's configuration flags and the text of its poses."""

    @property
    def name(self) -> str:
        """Name of the dialect."""

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the flags in the order they are written."""

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The flags that the controller shows at these joints (n,)."""

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The one solution for a flange pose (4, 4) that the flags choose, by the controller's own rule.

        A flag that is missing or None follows the controller's rule for a missing one, which may need `reference` (n,),
        the joints before the move.
        """

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """The dialect's text of a pose (4, 4, mm), with the flags of `joints` when given."""

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """The pose (4, 4) and the flags of a pose in the dialect's text; `SourceError` when it is none."""


@runtime_checkable
class BatchNotation(Protocol):
    """A notation that also works on many targets at once, as columns of numbers."""

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the flags."""

    @property
    def pose_fields(self) -> tuple[str, ...]:
        """Names of the numbers of a pose in the order they are written."""

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """The flags (k, f), in the order of `fields`, at joints (k, n)."""

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4), flags (k, f) NaN for a missing one, reference (n,) or (k, n)."""

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) in mm of the numbers (k, p) that the language writes."""

    def values_of(self, poses: FloatArray) -> FloatArray:
        """The numbers (k, p) that the language writes for poses (k, 4, 4)."""


@runtime_checkable
class WordedFlags(Protocol):
    """A notation that writes its flags as words of their own."""

    def parse_flags(self, text: str) -> dict[str, int | None] | None:
        """The flags of such words, None when they are none."""


@runtime_checkable
class ExternalAxes(Protocol):
    """A notation whose targets may carry external axes, which are no matter of the arm's own joints."""

    def external_axes(self, text: str) -> dict[str, float]:
        """The external axes that a target's text gives a value to, by name; degrees or mm."""


def flag_row(fields: Sequence[str], flags: Flags) -> FloatArray:
    """Flags as one row (1, f) of numbers, NaN for a missing one."""
    return np.array([[np.nan if flags.get(name) is None else float(flags[name] or 0) for name in fields]])


def format_number(value: float, places: int) -> str:
    """A number with at most `places` decimals, no trailing zeros and never a negative zero."""
    text = f"{value:.{places}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
