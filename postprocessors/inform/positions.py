"""Values of position variables: SET, MULMAT, INVMAT, ADD, SUB, CNVRT, GETS, and constants kept in variables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from rpl import ir
from rpl.writing.statements import CannotSayError

from . import tables
from .job import Job
from .operands import Registers, bank_of, constant, element
from .places import WORLD, Constants, Position, flat, inverse, position_of, product


@dataclass(slots=True)
class Positions:
    """Prints what gives position variables their values."""

    registers: Registers
    job: Job
    constants: Constants
    lines: list[str] = field(default_factory=list)
    counted: Callable[[ir.Expression, float], str] | None = None  # a variable with a value in counts of positions
    changes: int = 0  # how often variables other than helpers have been changed
    in_tools: dict[int, str] = field(default_factory=dict)  # tool -> the variable whose value it has just got

    def changed(self, place: str) -> None:
        """The variable has another value now."""
        self.changes += not self.registers.is_helper(place)
        computed = "[" in place
        self.in_tools = {n: one for n, one in self.in_tools.items() if not computed and "[" not in one and one != place}

    def position(self, place: str, value: ir.Expression) -> None:
        """place := value."""
        self.changed(place)
        shown = element(value) if isinstance(value, ir.Index | ir.Name) else None
        if shown is not None:
            if shown != place:
                self.lines.append(f"SET {place} {shown}")
            return
        known = self.constants.lasting(value)
        if known is not None:
            self.lines.append(f"SET {place} {self.named(value, self.kept(known, self.constants.name(value)))}")
            return
        match value:
            case ir.System(name="actual_pose") | ir.Builtin(function="current_target", arguments=()):
                self.lines.append(f"GETS {place} $PX001")
            case ir.System(name="actual_joints") | ir.Builtin(function="current_joints"):
                self.lines.append(f"GETS {place} $PX000")
            case ir.Builtin(function="current_target", arguments=arguments):
                self.current(place, arguments)
            case ir.Aggregate():
                self.aggregate(place, value)
            case ir.Binary(op=":", left=one, right=other) | ir.Builtin(function="compose", arguments=(one, other)):
                self.product(place, one, other)
            case ir.Builtin(function="displaced", arguments=(target, shift)):
                self.product(place, shift, target)
            case ir.Builtin(function="displaced_in_tool", arguments=(target, shift)):
                self.product(place, target, shift)
            case ir.Builtin(function="inverse", arguments=(inner,)):
                self.lines.append(f"INVMAT {place} {self.as_variable(inner)}")
            case ir.Builtin(function="pose_of", arguments=(inner,)):
                self.position(place, inner)
            case ir.Builtin(function="element_sum" | "element_difference" as how, arguments=(one, other)):
                self.sum(place, one, other, "ADD" if how == "element_sum" else "SUB")
            case ir.Builtin(function="offset", arguments=(base, *way)):
                self.offset(place, base, way)
            case ir.Builtin(function="joints_to_target" | "target_to_joints" as how, arguments=(inner, *more)):
                self.converted(place, how, inner, more)
            case ir.VendorValue(dialect="inform", text=text) if text.startswith("$"):
                self.lines.append(f"GETS {place} {text}")
            case _:
                raise CannotSayError("INFORM does not calculate with positions like this")

    def kept(self, position: Position, name: str = "") -> str:
        """The position variable that holds a constant; taught data with a name has one of its own."""
        return self.job.constant(position, self.job.cell.tool_of_variables, name=name)

    def named(self, value: ir.Expression, place: str) -> str:
        """The place, noted as one where the value of named data stands."""
        self.job.cell.stands(self.job.name, self.constants.name(value), place)
        return place

    def as_variable(self, value: ir.Expression) -> str:
        """A position as a variable: its own, one that holds the constant, or a helper."""
        shown = element(value) if isinstance(value, ir.Index | ir.Name) else None
        if shown is not None:
            if bank_of(shown) != "P":
                raise CannotSayError("a position is needed")
            return self.named(value, shown)
        known = self.constants.lasting(value)
        if known is not None:
            return self.named(value, self.kept(known, self.constants.name(value)))
        helper = self.registers.helper("P", "pulses" if self.constants.is_joints(value) else "")
        self.position(helper, value)
        return helper

    def product(self, place: str, one: ir.Expression, other: ir.Expression) -> None:
        """MULMAT place one other."""
        self.lines.append(f"MULMAT {place} {self.as_variable(one)} {self.as_variable(other)}")

    def sum(self, place: str, one: ir.Expression, other: ir.Expression, word: str) -> None:
        first, second = self.as_variable(one), self.as_variable(other)
        if second == place and first != place:
            helper = self.registers.helper("P")
            self.lines.append(f"SET {helper} {second}")
            second = helper
        if first != place:
            self.lines.append(f"SET {place} {first}")
        self.lines.append(f"{word} {place} {second}")

    def offset(self, place: str, base: ir.Expression, way: list[ir.Expression]) -> None:
        """Moved by x, y, z in the axes of its frame."""
        values = [constant(one) for one in way]
        if None in values:
            self.computed_offset(place, base, way)
            return
        x, y, z = (float(one or 0.0) for one in values)
        first = self.as_variable(base)
        if first != place:
            self.lines.append(f"SET {place} {first}")
        if any((x, y, z)):
            self.lines.append(f"ADD {place} {self.kept(Position('pose', (x, y, z, 0.0, 0.0, 0.0)))}")

    def computed_offset(self, place: str, base: ir.Expression, way: list[ir.Expression]) -> None:
        """The way is made component by component, then added."""
        shift = self.registers.helper("P")
        first = self.as_variable(base)
        self.lines.append(f"SET {shift} {self.kept(Position('pose', WORLD))}")
        for number, one in enumerate(way, 1):
            if constant(one) == 0:
                continue
            self.element(shift, number, one)
        if first != place:
            self.lines.append(f"SET {place} {first}")
        self.lines.append(f"ADD {place} {shift}")

    def element(self, place: str, number: int, value: ir.Expression) -> None:
        """SETE of a computed component."""
        if self.counted is None:
            raise CannotSayError("a computed component")
        counts = round(1 / (tables.MM_PER_COUNT if number <= 3 else tables.DEG_PER_COUNT))
        self.lines.append(f"SETE {place} ({number}) {self.counted(value, counts)}")

    def current(self, place: str, arguments: tuple[ir.Expression, ...]) -> None:
        """Where the tool is, in a frame."""
        frame = arguments[1] if len(arguments) > 1 else ir.System("null_frame")
        if self.job.cell.several_tools and arguments[0] != ir.System("tool"):
            self.seen_with(place, self.number_of_tool(arguments[0]))
        else:
            change = self.change_of_tool(arguments[0])
            self.lines.append(f"GETS {place} $PX001")
            if change:
                self.lines.append(f"MULMAT {place} {place} {change}")
        if frame not in (ir.System("null_frame"), ir.System("world")):
            helper = self.registers.helper("P")
            self.position(helper, ir.Builtin("inverse", (frame,)))
            self.lines.append(f"MULMAT {place} {helper} {place}")

    def seen_with(self, place: str, tool: int) -> None:
        """Where the robot is, seen with this tool. $PX001 has the tool of the last move, whichever that was; the pulses
        have none. The value then comes with the tool of all variables."""
        pulses = self.registers.helper("P", "pulses")
        self.lines.extend([f"GETS {pulses} $PX000", f"CNVRT {place} {pulses} BF TL#({tool})"])
        self.as_driven(place, tool)

    def as_driven(self, place: str, tool: int) -> None:
        """A place that came with this tool gets the tool of all variables: a product has that of its first factor."""
        if tool != self.job.cell.tool_of_variables:
            self.lines.append(f"MULMAT {place} {self.kept(Position('pose', WORLD))} {place}")

    def number_of_tool(self, tool: ir.Expression) -> int:
        """The tool's number; one that is kept in a variable is set first."""
        known = self.constants.known(tool)
        if known is not None:
            return self.job.cell.tool(known.values, tool)
        place = self.as_variable(tool)
        number = self.job.cell.tool_in(place)
        if self.in_tools.get(number) != place:
            self.lines.append(f"SETTOOL TL#({number}) {place}")
            self.in_tools[number] = place
        return number

    def change_of_tool(self, tool: ir.Expression) -> str:
        """From the tool of the job, whose place $PX001 is, to another one: inverse(job's) . other; empty: the same."""
        if tool == ir.System("tool"):
            return ""
        job, known = self.job, self.constants.known(tool)
        own = job.cell.value_of_tool(job.tool)
        if known is not None and own is not None:
            if known.values == own:
                return ""
            return self.kept(Position("pose", product(inverse(own), known.values)))
        kept = next((place for place, number in job.cell.by_variable.items() if number == job.tool), "")
        wanted = self.as_variable(tool)
        if kept and self.in_tools.get(job.tool) != kept:  # the variable was changed since the last move
            self.lines.append(f"SETTOOL TL#({job.tool}) {kept}")
            self.in_tools[job.tool] = kept
        if wanted == kept:
            return ""
        if own is None and not kept:
            raise CannotSayError("the place of another tool than the job's own")
        helper = self.registers.helper("P")
        self.lines.append(f"INVMAT {helper} {kept or self.kept(Position('pose', own or WORLD))}")
        self.lines.append(f"MULMAT {helper} {helper} {wanted}")
        return helper

    def with_tool(self, place: str, tool: int) -> str:
        """The same pose in a variable that comes with this tool. A variable has the tool that its value was taught
        with, which stays when its components are changed; the posture of the place does not come along."""
        goal = self.registers.helper("P", f"tool {tool}")
        self.lines.append(f"SET {goal} {self.job.constant(Position('pose', WORLD), tool)}")
        self.copy_components(place, goal)
        return goal

    def with_tool_and_posture(self, place: str, tool: int) -> str:
        """The same pose in a variable that comes with this tool, in the posture of the place: the pulses that bring the
        tool there, and the pose and tool that belong to them."""
        pulses, goal = self.registers.helper("P", "pulses"), self.registers.helper("P", f"tool {tool}")
        self.lines.extend([f"CNVRT {pulses} {place} PULSE TL#({tool})", f"CNVRT {goal} {pulses} BF TL#({tool})"])
        return goal

    def copy_components(self, source: str, goal: str) -> None:
        """The six components of a pose; tool and posture stay those of the goal."""
        count = self.registers.helper("D")
        for number in range(1, len(tables.POSE_ELEMENTS) + 1):
            self.lines.extend([f"GETE {count} {source} ({number})", f"SETE {goal} ({number}) {count}"])

    def converted(self, place: str, how: str, inner: ir.Expression, more: list[ir.Expression]) -> None:
        """CNVRT place source PULSE or BF, with the tool's number."""
        tool, number = "", self.job.cell.tool_of_variables
        if more:
            known = self.constants.known(more[0])
            if known is None:
                raise CannotSayError("a conversion with a computed tool")
            number = self.job.cell.tool(known.values, more[0])
            tool = f" TL#({number})"
        frame = more[1] if len(more) > 1 else ir.System("null_frame")
        framed = frame not in (ir.System("null_frame"), ir.System("world"))
        if how == "joints_to_target":
            self.lines.append(f"CNVRT {place} {self.as_variable(inner)} BF{tool}")
            if framed:
                back = self.registers.helper("P")
                self.position(back, ir.Builtin("inverse", (frame,)))
                self.lines.append(f"MULMAT {place} {back} {place}")
            else:
                self.as_driven(place, number)
            return
        source = ir.Binary(":", frame, inner) if framed else inner
        self.lines.append(f"CNVRT {place} {self.as_variable(source)} PULSE{tool}")

    def aggregate(self, place: str, value: ir.Aggregate) -> None:
        """Constant components from a variable that holds them, computed ones filled in behind."""
        parts = flat(value)
        computed = {name: part for name, part in parts.items() if constant(part) is None}
        if not set(computed) <= set(ir.POSE) or not set(ir.POSE) <= set(parts):
            raise CannotSayError("a position with computed joints or missing components")
        zeros = tuple((n, ir.RealLiteral(0.0) if n in computed else part) for n, part in parts.items())
        known = position_of(ir.Aggregate(zeros))
        if known is None:
            raise CannotSayError("a position with computed flags")
        self.lines.append(f"SET {place} {self.kept(known)}")
        for name, part in computed.items():
            self.element(place, tables.POSE_ELEMENTS.index(name) + 1, part)


def rounded(real: str, whole: str) -> list[str]:
    """whole := the nearest whole number; SET alone drops the decimals."""
    return [f"IFTHENEXP {real}<0.0", f"SUB {real} 0.5", "ELSE", f"ADD {real} 0.5", "ENDIF", f"SET {whole} {real}"]
