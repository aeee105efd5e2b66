"""What typing looks up again and again: the components of a type as lists write them, the parameters of a routine as
calls give them."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir

# Functions that see the robot with a tool and in a frame -> where these stand among the arguments.
PLACES: dict[str, tuple[int, int]] = {
    "current_target": (0, 1),
    "current_position": (0, 1),
    "joints_to_target": (1, 2),
    "target_to_joints": (1, 2),
    "target_to_joints_near": (2, 3),
    "is_reachable": (2, 3),
}
KINEMATICS = ("joints_to_target", "target_to_joints", "target_to_joints_near", "is_reachable")


@dataclass(slots=True)
class Layout:
    """Components of a type as aggregates write them: types by position, and by written name with the neutral name."""

    word: str
    positional: tuple[ir.Type | None, ...]
    complete: bool  # a component that is not found is an error (not so for a record that was not read)
    named: dict[str, tuple[str, ir.Type | None]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Signature:
    """A routine's parameters as a call's arguments find them."""

    parameters: tuple[ir.Parameter, ...]
    by_name: dict[str, ir.Parameter]
    positional: tuple[ir.Parameter, ...]
    open_ended: bool  # or unknown: any number of arguments may be right

    @property
    def takes(self) -> str:
        """How many arguments it takes, in words: some only by their names."""
        by_name = [p.name for p in self.parameters if p not in self.positional]
        count = len(self.positional)
        return f"{count} argument{'s' * (count != 1)}" + (f", and by name {', '.join(by_name)}" if by_name else "")
