"""What all jobs share: numbers of tools and user frames, and position variables that hold constants.

A constant position that is needed as a variable is kept in a position variable of its own, whose value stands in the
header of every job that uses it. Tools and user frames get their values by SETTOOL and MFRAME at the start.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl.ir.standing import NOTHING, Standing
from rpl.writing.statements import CannotSayError

from . import tables
from .operands import Registers
from .places import WORLD, Position, Values, product

_ARM_MM = 100.0  # how far the points that define a user frame are from its origin


@dataclass(frozen=True, slots=True)
class Kept:
    """A position and the tool and user frame (0: the base) that it is given in."""

    position: Position
    tool: int = 0
    frame: int = 0
    name: str = ""  # the source's, so that points that happen to be equal are taught apart


@dataclass(slots=True)
class Cell:
    """Shared data of a program. `external`: how many external axes it moves; the first `bases` of them carry the
    robot (base axes), the others are those of the station."""

    registers: Registers
    tool_of_variables: int = 0
    several_tools: bool = False  # moves are driven with different tools
    kept: dict[Kept, int] = field(default_factory=dict)
    tools: dict[Values, int] = field(default_factory=dict)
    frames: dict[Values, int] = field(default_factory=dict)
    by_variable: dict[str, int] = field(default_factory=dict)
    last_tool: int = 0
    there: Standing = NOTHING  # the controller's tools and frames in use are given to nothing else
    external: int = 0
    bases: int = 0
    copies: dict[tuple[str, str], set[str]] = field(default_factory=dict)  # job, taught data -> where its value stands

    def stands(self, job: str, name: str, place: str) -> None:
        """Note a place where the value of named data stands."""
        if name:
            self.copies.setdefault((job, name), set()).add(place)

    def keep(self, what: Kept) -> int:
        """The number of the position variable that holds a constant."""
        if what not in self.kept:
            self.kept[what] = self.registers.take("P")
        return self.kept[what]

    def tool(self, value: Values) -> int:
        """The number of a constant tool; 0 is the flange."""
        if value == WORLD:
            return 0
        if value not in self.tools:
            number = self.there.like("TL", value)
            self.tools[value] = self._next_tool() if number is None else number
        return self.tools[value]

    def tool_in(self, place: str) -> int:
        """The number of a tool that is kept in a position variable."""
        if place not in self.by_variable:
            self.by_variable[place] = self._next_tool()
        return self.by_variable[place]

    def _next_tool(self) -> int:
        self.last_tool += 1
        while self.last_tool in self.there.of("TL"):
            self.last_tool += 1
        if self.last_tool > tables.TOOLS:
            raise CannotSayError(f"there are only {tables.TOOLS} tools")
        return self.last_tool

    def frame(self, value: Values) -> int:
        """The number of a constant user frame; 0 stands for the base."""
        if value == WORLD:
            return 0
        if value not in self.frames:
            number = self.there.like("UF", value)
            taken = {*self.frames.values(), *self.there.of("UF")}
            free = (one for one in range(1, tables.USER_FRAMES + 1) if one not in taken)
            self.frames[value] = next(free, 0) if number is None else number
            if self.frames[value] == 0:
                del self.frames[value]
                raise CannotSayError(f"there are only {tables.USER_FRAMES} user frames")
        return self.frames[value]

    def value_of_tool(self, number: int) -> Values | None:
        """None for a tool that is kept in a variable."""
        if number == 0:
            return WORLD
        return next((value for value, n in self.tools.items() if n == number), None)

    def value_of_frame(self, number: int) -> Values:
        return next((value for value, n in self.frames.items() if n == number), WORLD)

    def setup(self) -> Iterator[tuple[str, tuple[int, ...]]]:
        """The instructions that give tools and frames their values, with the position variables in them."""
        for value, number in self.tools.items():
            if ("TL", number) in self.there.poses:
                continue  # the controller has it
            kept = self.keep(Kept(Position("pose", value)))
            yield f"SETTOOL TL#({number}) P{kept:03d}", (kept,)
        for value, number in self.frames.items():
            if ("UF", number) in self.there.poses:
                continue
            ways = (WORLD, (_ARM_MM, *WORLD[1:]), (0.0, _ARM_MM, *WORLD[2:]))
            points = tuple(self.keep(Kept(Position("pose", product(value, way)))) for way in ways)
            shown = " ".join(f"P{one:03d}" for one in points)
            yield f"MFRAME UF#({number}) {shown}", points
