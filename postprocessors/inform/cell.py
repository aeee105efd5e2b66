"""What all jobs share: numbers of tools and user frames, and position variables that hold constants.

A constant position that is needed as a variable is kept in a position variable of its own, whose value stands in the
header of every job that uses it. Constant tools and user frames have their values in the controller's files TOOL.CND
and UFRAME.CND; a tool that is kept in a variable gets its value by SETTOOL.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.standing import NOTHING, Standing
from rpl.writing.statements import CannotSayError

from . import tables
from .operands import Registers, selected
from .places import WORLD, Position, Values


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
    tools: dict[int, Values] = field(default_factory=dict)
    frames: dict[int, Values] = field(default_factory=dict)
    by_variable: dict[str, int] = field(default_factory=dict)
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

    def give(self, values: Mapping[tuple[str, int], Position]) -> None:
        """The tools and frames that have got their numbers already."""
        self.tools.update({number: one.values for (bank, number), one in values.items() if bank == tables.TL})
        self.frames.update({number: one.values for (bank, number), one in values.items() if bank == tables.UF})

    def tool(self, value: Values, said: ir.Expression | None = None) -> int:
        """The number of a constant tool, that which is `said` or one with this value; 0 is the flange."""
        named = None if said is None else selected(said)
        if named is not None:
            return named[1]
        if value == WORLD:
            return 0
        number = _number_of(self.tools, value, self.there.like(tables.TL, value))
        if number is None:
            number = self._next_tool()
        self.tools[number] = value
        return number

    def tool_in(self, place: str) -> int:
        """The number of a tool that is kept in a position variable."""
        if place not in self.by_variable:
            self.by_variable[place] = self._next_tool()
        return self.by_variable[place]

    def _next_tool(self) -> int:
        taken = {*self.tools, *self.by_variable.values(), *self.there.of(tables.TL)}
        free = next((one for one in range(1, tables.TOOLS + 1) if one not in taken), None)
        if free is None:
            raise CannotSayError(f"there are only {tables.TOOLS} tools")
        return free

    def frame(self, value: Values, said: ir.Expression | None = None) -> int:
        """The number of a constant user frame, that which is `said` or one with this value; 0 stands for the base."""
        named = None if said is None else selected(said)
        if named is not None:
            return named[1]
        if value == WORLD:
            return 0
        number = _number_of(self.frames, value, self.there.like(tables.UF, value))
        if number is None:
            taken = {*self.frames, *self.there.of(tables.UF)}
            number = next((one for one in range(1, tables.USER_FRAMES + 1) if one not in taken), None)
        if number is None:
            raise CannotSayError(f"there are only {tables.USER_FRAMES} user frames")
        self.frames[number] = value
        return number

    def value_of_tool(self, number: int) -> Values | None:
        """None for a tool that is kept in a variable."""
        return WORLD if number == 0 else self.tools.get(number)

    def conditions(self, bank: str) -> dict[int, Values]:
        """The tools or user frames whose values go beside the jobs: those that the controller has not."""
        given = self.tools if bank == tables.TL else self.frames
        return {number: one for number, one in sorted(given.items()) if (bank, number) not in self.there.poses}


def _number_of(given: Mapping[int, Values], value: Values, there: int | None) -> int | None:
    return next((number for number, known in given.items() if known == value), there)
