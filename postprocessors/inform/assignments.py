"""Assignments as instructions: one operation each, helper variables where an operand is more than a variable."""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.passes.rewrite import rewrite_parts
from rpl.writing.statements import CannotSayError

from . import tables
from .operands import Registers, bank_of, constant, element, is_digital, numbered, operand, signal, simple, variable
from .positions import Positions, rounded


@dataclass(slots=True)
class Assignments:
    """Prints assignments of one job into `lines`."""

    registers: Registers
    positions: Positions

    @property
    def lines(self) -> list[str]:
        return self.positions.lines

    def assign(self, assign: ir.Assign) -> list[str]:
        self.positions.lines = []
        target, value = assign.target, assign.value
        match target:
            case ir.Signal():
                self.output(target, value)
            case ir.Field(base=base, name=name):
                self.component(base, name, value)
            case _:
                place = variable(target)
                if bank_of(place) == "P":
                    self.positions.position(place, value)
                else:
                    self.number(place, value)
        return self.lines

    def prepared(self, condition: ir.Expression) -> tuple[list[str], ir.Expression]:
        """The condition with components of positions in variables, and the lines that put them there."""
        self.positions.lines = []

        def change(expression: ir.Expression) -> ir.Expression:
            if isinstance(expression, ir.Field):
                helper = self.registers.helper("R")
                self.number(helper, expression)
                return ir.Name(helper)
            return rewrite_parts(expression, change)

        return self.lines, change(condition)

    # ---- outputs

    def output(self, target: ir.Signal, value: ir.Expression) -> None:
        """`DOUT OT#(1) ON`, `DOUT OG#(1) B000`, `AOUT AO#(1) 5.0`."""
        if target.kind in ("digital_in", "group_in", "analog_in"):
            raise CannotSayError("an input cannot be set")
        place = signal(target)
        if target.kind == "analog_out":
            self.lines.append(f"AOUT {place} {self.simple_number(value, 'R')}")
        elif is_digital(target):
            if isinstance(value, ir.BoolLiteral):
                self.lines.append(f"DOUT {place} {'ON' if value.value else 'OFF'}")
                return
            self.lines.append(f"DOUT {place} {self.byte(value)}")
        else:
            known = constant(value)
            if known is not None and not 0 <= known <= 255:
                raise CannotSayError("a group of outputs takes 0 to 255")
            self.lines.append(f"DOUT {place} {self.byte(value) if known is None else int(known)}")

    def byte(self, value: ir.Expression) -> str:
        """A value as a byte variable."""
        shown = simple(value)
        if shown is not None and bank_of(shown) == "B":
            return shown
        helper = self.registers.helper("B")
        self.number(helper, value)
        return helper

    def simple_number(self, value: ir.Expression, bank: str) -> str:
        """A constant or variable; anything else through a helper."""
        shown = simple(value)
        if shown is not None:
            return shown
        helper = self.registers.helper(bank)
        self.number(helper, value)
        return helper

    # ---- numbers, truth values, texts

    def number(self, place: str, value: ir.Expression) -> None:
        """place := value."""
        shown = simple(value)
        if shown is not None:
            self.fits(place, constant(value))
            if shown != place:
                self.lines.append(f"SET {place} {shown}")
            return
        match value:
            case ir.Convert(how=how, operand=inner):
                self.converted(place, how, inner)
            case ir.Signal():
                self.input(place, value)
            case ir.Binary():
                self.operation(place, value)
            case ir.Unary(op="+", operand=inner):
                self.number(place, inner)
            case ir.Unary(op="-", operand=inner):
                self.operation(place, ir.Binary("*", inner, ir.IntLiteral(-1)))
            case ir.Builtin():
                self.function(place, value)
            case ir.Field(base=base, name=name):
                self.read_component(place, base, name)
            case ir.System(name="actual_joint", indices=(ir.IntLiteral(value=axis),)):
                self.read_component(place, ir.System("actual_joints"), f"j{axis}")
            case ir.VendorValue(dialect="inform", text=text):
                self.lines.append(f"GETS {place} {text}" if text.startswith("$") else f"{text} {place}")
            case _:
                raise CannotSayError(f"a value of this kind: {value.__class__.__name__}")

    def fits(self, place: str, value: float | None) -> None:
        limits = tables.RANGES.get(bank_of(place))
        if value is not None and limits is not None and not limits[0] <= value <= limits[1]:
            raise CannotSayError(f"{value:g} is outside of {limits[0]}..{limits[1]}, the range of {place}")

    def converted(self, place: str, how: str, value: ir.Expression) -> None:
        """A value of another type; SET drops the decimals where the place has none."""
        match how:
            case "real" | "bit":
                self.number(place, value)
            case "code" | "char":
                self.lines.append(f"{'ASC' if how == 'code' else 'CHR$'} {place} {operand(value)}")
            case "truth":
                shown = self.simple_number(value, "R")
                self.lines.extend([f"IFTHENEXP {shown}<>0", f"SET {place} 1", "ELSE", f"SET {place} 0", "ENDIF"])
            case _:
                self.whole(place, how, value)

    def whole(self, place: str, how: str, value: ir.Expression) -> None:
        """A whole number of a real one: cut, rounded, or the next one below."""
        real = self.registers.helper("R")
        self.number(real, value)
        goal = place if bank_of(place) in tables.WHOLE else self.registers.helper("D")
        if how == "round_half_away":
            self.lines.extend([f"IFTHENEXP {real}<0.0", f"SUB {real} 0.5", "ELSE", f"ADD {real} 0.5", "ENDIF"])
        self.lines.append(f"SET {goal} {real}")
        if how == "floor":
            cut = self.registers.helper("R")
            self.lines.extend([f"SET {cut} {goal}", f"IFTHENEXP {cut}>{real}", f"DEC {goal}", "ENDIF"])
        if goal != place:
            self.lines.append(f"SET {place} {goal}")

    def input(self, place: str, given: ir.Signal) -> None:
        """`DIN B000 IN#(1)`."""
        if bank_of(place) in ("B",) or given.kind.startswith("analog"):
            self.lines.append(f"DIN {place} {signal(given)}")
            return
        helper = self.registers.helper("B")
        self.lines.extend([f"DIN {helper} {signal(given)}", f"SET {place} {helper}"])

    def operation(self, place: str, value: ir.Binary) -> None:
        """`SET a b`, `ADD a c`."""
        if value.op == "&":
            self.lines.append(f"CAT$ {place} {operand(value.left)} {operand(value.right)}")
            return
        if value.op == "mod":
            self.remainder(place, value)
            return
        word = tables.ARITHMETIC.get(value.op) or tables.BITS.get(value.op)
        if word is None:
            raise CannotSayError(f"INFORM has no operation {value.op}")
        if value.op in tables.BITS and bank_of(place) != "B":
            raise CannotSayError("operations on bits are for bytes")
        bank = bank_of(place)
        if value.op == "div" and bank not in tables.WHOLE:  # DIV of real numbers keeps the fraction
            whole = self.registers.helper("D")
            self.number(whole, value)
            self.lines.append(f"SET {place} {whole}")
            return
        left, right = self.simple_number(value.left, bank), self.simple_number(value.right, bank)
        if right == place and left != place:
            if value.op in ("+", "*", "band", "bor", "bxor"):
                left, right = right, left
            else:
                helper = self.registers.helper(bank)
                self.lines.extend([f"SET {helper} {right}"])
                right = helper
        if left != place:
            self.lines.append(f"SET {place} {left}")
        if word in ("ADD", "SUB") and right == "1" and bank in tables.WHOLE:
            self.lines.append(f"{'INC' if word == 'ADD' else 'DEC'} {place}")
        else:
            self.lines.append(f"{word} {place} {right}")

    def remainder(self, place: str, value: ir.Binary) -> None:
        """left - left div right * right."""
        bank = bank_of(place)
        left, right = self.simple_number(value.left, bank), self.simple_number(value.right, bank)
        helper = self.registers.helper(bank)
        self.lines.extend([f"SET {helper} {left}", f"DIV {helper} {right}"])
        if bank not in tables.WHOLE:
            cut = self.registers.helper("D")
            self.lines.extend([f"SET {cut} {helper}", f"SET {helper} {cut}"])
        self.lines.append(f"MUL {helper} {right}")
        if place in (left, right) and left != place:
            other = self.registers.helper(bank)
            self.lines.extend([f"SET {other} {left}", f"SUB {other} {helper}", f"SET {place} {other}"])
            return
        if left != place:
            self.lines.append(f"SET {place} {left}")
        self.lines.append(f"SUB {place} {helper}")

    def function(self, place: str, value: ir.Builtin) -> None:
        if value.function == "abs":
            self.number(place, value.arguments[0])
            self.lines.extend([f"IFTHENEXP {place}<0", f"MUL {place} -1", "ENDIF"])
            return
        if value.function == "number_text":
            self.number_text(place, value.arguments)
            return
        word = tables.FUNCTIONS.get(value.function)
        if word is not None:
            given = self.simple_number(value.arguments[0], "R")
            if bank_of(given) != "R":
                helper = self.registers.helper("R")
                self.lines.append(f"SET {helper} {given}")
                given = helper
            self.lines.append(f"{word} {place} {given}")
            return
        word = tables.TEXT_FUNCTIONS.get(value.function)
        if word is None:
            raise CannotSayError(f"INFORM has no function {value.function}")
        parts = (self.simple_number(one, "R") if isinstance(one, ir.Field) else operand(one) for one in value.arguments)
        shown = " ".join(parts)
        self.lines.append(f"{word} {place} {shown}")

    def number_text(self, place: str, arguments: tuple[ir.Expression, ...]) -> None:
        """A number without decimals as text."""
        if constant(arguments[1]) != 0:
            raise CannotSayError("a text of a number with a fixed count of decimals")
        helper = self.registers.helper("D")
        self.whole(helper, "round_half_away", arguments[0])
        self.lines.append(f"VAL2STR {place} {helper}")

    # ---- components of positions

    def read_component(self, place: str, base: ir.Expression, name: str) -> None:
        """GETE counts in 0.001 mm or 0.0001 degrees."""
        constants = self.positions.constants
        known = None if constants.name(base) else constants.known(base)
        axis = axis_of(name)
        if axis and known is not None and known.kind == "joints":
            self.number(place, ir.RealLiteral(known.values[axis - 1]))
            return
        number, counts = (axis, self.positions.job.pulses(axis)) if axis else component(name)
        if known is not None and known.kind == "pose":
            value = known.values[ir.POSE.index(name)]
            self.number(place, ir.RealLiteral(value))
            return
        source = self.positions.as_variable(base)
        helper = self.registers.helper("D")
        self.lines.append(f"GETE {helper} {source} ({number})")
        if bank_of(place) == "R":
            self.lines.extend([f"SET {place} {helper}", f"DIV {place} {float(counts)!r}"])
            return
        real = self.registers.helper("R")
        self.lines.extend([f"SET {real} {helper}", f"DIV {real} {float(counts)!r}", f"SET {place} {real}"])

    def component(self, base: ir.Expression, name: str, value: ir.Expression) -> None:
        axis = axis_of(name)
        number, counts = (axis, self.positions.job.pulses(axis)) if axis else component(name)
        place = element(base)
        if place is None or bank_of(place) != "P":
            raise CannotSayError("only a position variable has components")
        self.positions.changed(place)
        known = constant(value)
        if known is not None:
            self.lines.append(f"SETE {place} ({number}) {round(known * counts)}")
            return
        self.lines.append(f"SETE {place} ({number}) {self.counted(value, counts)}")

    def counted(self, value: ir.Expression, counts: float) -> str:
        """A variable with the value in counts of positions. Whole counts stay such, other parts are rounded."""
        terms = summands(value)
        whole = self.registers.helper("D")
        began = False
        for sign, term in sorted(terms, key=lambda one: self.order(one[1], counts)):
            known = constant(term)
            if known is not None and began:
                if round(known * counts):
                    self.lines.append(f"{'ADD' if sign > 0 else 'SUB'} {whole} {round(known * counts)}")
                continue
            if began:
                more = self.registers.helper("D")
                self.count(more, term, counts)
                self.lines.append(f"{'ADD' if sign > 0 else 'SUB'} {whole} {more}")
                continue
            self.count(whole, term, counts)
            if sign < 0:
                self.lines.append(f"MUL {whole} -1")
            began = True
        return whole

    def order(self, term: ir.Expression, counts: float) -> int:
        """What is whole counts comes first, constants come last."""
        if constant(term) is not None:
            return 2
        inner, times = whole_product(term)
        place = simple(inner)
        whole = place is not None and bank_of(place) in tables.WHOLE and times * counts == int(times * counts)
        return 0 if whole or self.component_read(term, counts) is not None else 1

    def component_read(self, term: ir.Expression, counts: float) -> tuple[ir.Expression, int] | None:
        """The place and number of a component that is counted in the same unit, and is no number that is known."""
        match term:
            case ir.Field(base=base, name=name) if not axis_of(name):
                number, unit = component(name)
                constants = self.positions.constants
                known = None if constants.name(base) else constants.known(base)
                return (base, number) if unit == counts and known is None else None
        return None

    def count(self, whole: str, term: ir.Expression, counts: float) -> None:
        """whole := the term in counts."""
        read = self.component_read(term, counts)
        term, times = whole_product(term)
        factor = times * counts
        if read is not None:
            self.lines.append(f"GETE {whole} {self.positions.as_variable(read[0])} ({read[1]})")
        elif (place := simple(term)) is not None and bank_of(place) in tables.WHOLE and factor == int(factor):
            self.lines.extend([f"SET {whole} {place}", f"MUL {whole} {int(factor)}"])
        else:
            real = self.registers.helper("R")
            self.number(real, term)
            self.lines.append(f"MUL {real} {float(factor)!r}")
            exact = factor == int(factor) and self.is_whole(term)
            self.lines.extend([f"SET {whole} {real}"] if exact else rounded(real, whole))

    def is_whole(self, term: ir.Expression) -> bool:
        """Is it a whole number in any case?"""
        known = constant(term)
        if known is not None:
            return float(known).is_integer()
        match term:
            case ir.Binary(op="+" | "-" | "*", left=left, right=right):
                return self.is_whole(left) and self.is_whole(right)
            case ir.Convert(how="real", operand=operand) | ir.Unary(op="-" | "+", operand=operand):
                return self.is_whole(operand)
        place = numbered(term)
        return place is not None and (
            place[0] in tables.WHOLE or (place[0] == "R" and place[1] in self.registers.set_whole)
        )


def summands(value: ir.Expression, sign: int = 1) -> list[tuple[int, ir.Expression]]:
    """What a sum adds and takes away."""
    match value:
        case ir.Binary(op="+" | "-" as op, left=left, right=right):
            return [*summands(left, sign), *summands(right, sign if op == "+" else -sign)]
        case ir.Unary(op="-", operand=operand):
            return summands(operand, -sign)
        case ir.Convert(how="real", operand=operand):
            return summands(operand, sign)
    return [(sign, value)]


def whole_product(term: ir.Expression) -> tuple[ir.Expression, float]:
    """A variable and the constant that it is multiplied by."""
    match term:
        case ir.Binary(op="*", left=left, right=right):
            for one, other in ((left, right), (right, left)):
                times = constant(other)
                if times is not None and simple(one) is not None and constant(one) is None:
                    return one, float(times)
        case ir.Convert(how="real", operand=operand):
            return whole_product(operand)
    return term, 1.0


def component(name: str) -> tuple[int, int]:
    """The number of a component and how many counts its unit has."""
    lower = name.lower()
    if lower not in tables.POSE_ELEMENTS:
        raise CannotSayError(f"a position variable has no component {name} that can be counted here")
    number = tables.POSE_ELEMENTS.index(lower) + 1
    return number, round(1 / (tables.MM_PER_COUNT if number <= 3 else tables.DEG_PER_COUNT))


def axis_of(name: str) -> int:
    """The number of a joint; 0 for other components."""
    lower = name.lower()
    return tables.JOINT_ELEMENTS.index(lower) + 1 if lower in tables.JOINT_ELEMENTS else 0
