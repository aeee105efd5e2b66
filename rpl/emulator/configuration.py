"""What the emulator asks of a controller's way to write down which of an arm's postures is meant.

Every brand has its own flags beside a pose; each dialect that has some offers an object with this protocol. The core
hands it the robot model and never looks at the flags itself.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray

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


def format_number(value: float, places: int) -> str:
    """A number with at most `places` decimals, no trailing zeros and never a negative zero."""
    text = f"{value:.{places}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
