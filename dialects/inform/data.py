"""Instructions on variables: SET, arithmetic, bits, texts, system values, and the elements of positions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.reading.shapes import StatementError

from . import tables
from .kinds import JOINTS, TARGET, Kind, frame_of, key_of
from .operands import UNIFIED, Operands, plain_bank, tags_of
from .syntax import Command, Formula, Group, Numbered, Operand, SystemName, Word, value_of

EXTERNAL_ELEMENT = code(
    "inform-external-element",
    Severity.WARNING,
    "elements of a station's position are taken as 0.0001 deg (or 0.001 mm); a position in pulses counts otherwise",
)
Statements = tuple[ir.Statement, ...]


class Data(Operands):
    """Instructions that only change variables."""

    def set(self, place: Operand, value: ir.Expression) -> Statements:
        return (ir.Assign(self.value(place), value, origin=self.origin),)

    def needs(self, command: Command, count: int) -> tuple[Operand, ...]:
        if len(command.items) < count:
            raise StatementError(f"{command.word} needs {count} operands", len(command.word))
        return command.items

    def call(self, function: str, *arguments: ir.Expression) -> ir.Expression:
        return ir.Builtin(function, arguments, origin=self.origin)

    # ---- SET and arithmetic

    def on_set(self, command: Command) -> Statements:
        target, source = self.needs(command, 2)[:2]
        if self.is_position(target):
            if isinstance(source, Numbered):
                return self.set_position(target, self.numbered_pose(source), Kind(TARGET))
            value, kind = self.position(source)
            return self.set_position(target, value, kind)
        if isinstance(target, Numbered) and target.word in ("UF", "TL"):
            return (ir.Assign(self.numbered_pose(target), self.position(source)[0], origin=self.origin),)
        if source == Word("LOGICEXP"):
            condition = self.condition(command.items[2:])
            number = self.whole(value_of(target)) if isinstance(target, ir.Index) else False
            return self.set(target, ir.Convert("bit", condition, origin=self.origin) if number else condition)
        return self.set(target, self.value(source))

    def numbered_pose(self, operand: Numbered) -> ir.Expression:
        if operand.word == "UF":
            return self.user_frame(operand.number)
        if operand.word == "TL":
            return self.tool(operand.number)
        raise StatementError(f"{operand.word}# is no position", 0)

    def set_position(self, target: Operand, value: ir.Expression, kind: Kind) -> Statements:
        """A position variable takes the form of what it is given."""
        if not self.is_position(target):
            raise StatementError("a position variable is needed here", 0)
        assert isinstance(target, ir.Index)  # is_position says so
        key = key_of(target)
        if key is not None and self.shared.project.is_unified(self.job.name, key):
            self.report_once(UNIFIED, f"unified {key}", name=self.spelled(target))
            value, kind = self.as_target(value, kind), Kind(TARGET)
        return (ir.Assign(self.variable(target, kind.form), value, origin=self.origin),)

    def as_target(self, value: ir.Expression, kind: Kind) -> ir.Expression:
        """Joints, or a target of any frame, as a target in the base frame."""
        if kind.form == TARGET:
            return self.call("displaced", value, self.frame(kind.frame)) if kind.frame.kind == "user" else value
        base = ir.System("null_frame", origin=self.origin)
        return self.call("joints_to_target", value, self.tool(kind.tool), base)

    def arithmetic(self, command: Command) -> Statements:
        """`ADD a b` and kin: a := a op b. Whole numbers divide to whole numbers; positions element by element."""
        target, source = self.needs(command, 2)[:2]
        op = tables.ARITHMETIC[command.word]
        if self.is_position(target):
            return self.position_arithmetic(command.word, target, source, command.items[2:])
        value = self.value(source)
        if (
            op == "/"
            and self.whole(value_of(target))
            and not isinstance(source, Formula)
            and self.whole(value_of(source))
        ):
            op = "div"
        place = self.value(target)
        return self.set(target, ir.Binary(op, place, value, origin=self.origin))

    def position_arithmetic(self, word: str, target: Operand, source: Operand, rest: tuple[Operand, ...]) -> Statements:
        place, kind = self.position(target)
        if kind.form == "external":
            raise StatementError(f"{word} of base or station positions is not read", 0)
        if self.is_position(source):
            other, given = self.position(source)
            if word not in ("ADD", "SUB"):
                raise StatementError(f"positions cannot be {'multiplied' if word == 'MUL' else 'divided'}", 0)
            if given.form != kind.form:
                raise StatementError("a position in pulses and a pose cannot be added", 0)
            function = "element_sum" if word == "ADD" else "element_difference"
            return self.set_position(target, self.call(function, place, other), kind)
        if word not in ("MUL", "DIV"):
            raise StatementError("only a position can be added to a position", 0)
        if isinstance(source, Group):
            return self.scaled_element(word, target, source, rest)
        factor = self.value(source)
        if word == "DIV":
            one = ir.RealLiteral(1.0)
            factor = ir.Binary("/", one, factor, origin=self.origin)
        return self.set_position(target, self.call("element_product", place, factor), kind)

    def scaled_element(self, word: str, target: Operand, element: Operand, rest: tuple[Operand, ...]) -> Statements:
        """`MUL P000 (3) 2`, `DIV P000 (3) D000`: one element of a position; like all of them, in whole counts."""
        if not rest:
            raise StatementError(f"{word} of an element needs a number", 0)
        factor = self.value(rest[0])
        op = "div" if word == "DIV" and self.whole(value_of(rest[0])) else tables.ARITHMETIC[word]

        def scaled(number: int) -> Statements:
            value: ir.Expression = ir.Binary(op, self.element_of(target, number), factor, origin=self.origin)
            if not self.whole(value_of(rest[0])):
                value = ir.Convert("round_half_away", value, origin=self.origin)
            return self.with_element(target, number, value)

        return self.by_element(element, scaled)

    def on_inc(self, command: Command) -> Statements:
        place = self.needs(command, 1)[0]
        op = "+" if command.word == "INC" else "-"
        return self.set(place, ir.Binary(op, self.value(place), ir.IntLiteral(1), origin=self.origin))

    def on_clear(self, command: Command) -> Statements:
        """`CLEAR B000 10`: so many variables of the bank, from that one on; ALL: the rest of the bank."""
        first = self.needs(command, 1)[0]
        if not (isinstance(first, ir.Index) and isinstance(first.base, ir.Name)):  # STACK, QUE, $ERRNO ...
            return (ir.Vendor("inform", " ".join(self.origin.text.split()), "none", origin=self.origin),)
        count = command.items[1] if len(command.items) > 1 else ir.IntLiteral(1)
        number = first.indices[0]
        if count == Word("ALL"):
            at = number if isinstance(number, ir.IntLiteral) else None
            if at is None:
                raise StatementError("CLEAR ... ALL is read with a constant variable", 0)
            count = ir.IntLiteral(max(tables.LAST_VARIABLE - at.value + 1, 1))
        if not isinstance(count, ir.IntLiteral) or count.value > tables.LAST_BYTE:
            raise StatementError(f"CLEAR is read with a constant number of variables up to {tables.LAST_BYTE}", 0)
        zero: ir.Expression = ir.IntLiteral(0)
        if first.base.id.endswith("S"):
            zero = ir.TextLiteral("")
        done: list[ir.Statement] = []
        for each in range(count.value):
            place: ir.Expression = ir.Binary("+", number, ir.IntLiteral(each), origin=self.origin) if each else number
            if isinstance(number, ir.IntLiteral):
                place = ir.IntLiteral(number.value + each)
            done.extend(self.set(ir.Index(first.base, (place,), origin=self.origin), zero))
        return tuple(done)

    def bits(self, command: Command) -> Statements:
        target, source = self.needs(command, 2)[:2]
        place = self.value(target)
        return self.set(target, ir.Binary(tables.BITS[command.word], place, self.value(source), origin=self.origin))

    def on_not(self, command: Command) -> Statements:
        """NOT a b: a := the byte b with all its bits changed."""
        target, source = self.needs(command, 2)[:2]
        return self.set(target, ir.Binary("bxor", self.value(source), ir.IntLiteral(255), origin=self.origin))

    def function(self, command: Command) -> Statements:
        target, source = self.needs(command, 2)[:2]
        return self.set(target, self.call(tables.FUNCTIONS[command.word], self.value(source)))

    # ---- texts

    def on_text(self, command: Command) -> Statements:
        items = self.needs(command, 2)
        radix = next((relation.right for tag, relation in tags_of(items) if tag == "RADIX"), None)
        if radix is not None and command.word == "VAL":
            return self.value_to_base(items[0], self.value(items[1]), self.value(radix))
        values = [self.value(item) for item in items[1:]]
        match command.word, values:
            case "CAT$", [one, other]:
                return self.set(items[0], ir.Binary("&", one, other, origin=self.origin))
            case "MID$", [text, begin, length]:
                return self.set(items[0], self.call("text_part", text, begin, length))
            case "LEN", [text]:
                return self.set(items[0], self.call("text_length", text))
            case "ASC", [text]:
                return self.set(items[0], self.call("character_code", text))
            case "CHR$", [number]:
                return self.set(items[0], self.call("from_code", number))
            case "VAL", [text]:
                return self.set(items[0], self.call("text_value", text))
            case "VAL2STR", [number]:
                return self.set(items[0], self.call("value_text", number))
            case "STRSTR", [text, wanted]:
                return self.set(items[0], self.call("text_find", text, ir.IntLiteral(1), wanted))
        raise StatementError(f"{command.word} has other operands", 0)

    def value_to_base(self, target: Operand, text: ir.Expression, base: ir.Expression) -> Statements:
        """`VAL D000 S000 RADIX=16`: digit by digit."""
        origin = self.origin
        names = (tables.DIGITS, tables.DIGITS_AT, tables.DIGIT, tables.DIGITS_SUM)
        for name in names:
            type: ir.Type = ir.StringType() if name == tables.DIGITS else ir.IntType()
            self.shared.used.scalar(name, type, origin)
        whole, at, digit, total = (ir.Name(name, origin=origin) for name in names)

        def put(place: ir.Expression, value: ir.Expression) -> ir.Statement:
            return ir.Assign(place, value, origin=origin)

        def number(value: int) -> ir.Expression:
            return ir.IntLiteral(value, origin=origin)

        one = self.call("text_part", whole, at, number(1))
        known = self.call("text_find", ir.TextLiteral(tables.DIGIT_WORDS, origin=origin), number(1), one)
        small = ir.Binary(">", digit, number(16), origin=origin)
        sums = ir.Binary("*", total, base, origin=origin)
        body = (
            put(digit, known),
            ir.If(((small, (put(digit, ir.Binary("-", digit, number(6), origin=origin)),)),), origin=origin),
            put(total, ir.Binary("+", sums, ir.Binary("-", digit, number(1), origin=origin), origin=origin)),
            put(at, ir.Binary("+", at, number(1), origin=origin)),
        )
        more = ir.Binary("<=", at, self.call("text_length", whole), origin=origin)
        first = (put(whole, text), put(at, number(1)), put(total, number(0)))
        return (*first, ir.While(more, body, origin=origin), *self.set(target, total))

    # ---- system values and registers

    def on_gets(self, command: Command) -> Statements:
        target, source = self.needs(command, 2)[:2]
        if not isinstance(source, SystemName):
            raise StatementError("GETS needs a system variable ($...)", 0)
        if source.name in tables.POSITIONS and self.is_position(target):
            what, pulses = tables.POSITIONS[source.name]
            tool = self.flow.tool(self.state)
            kind = Kind(JOINTS if pulses else TARGET, tool=tool)
            return self.set_position(target, self.robot_position(what, pulses, tool), kind)
        flag = {tables.SEARCH_STATUS: tables.SEARCH_FOUND, tables.WAIT_STATUS: tables.WAIT_LATE}.get(source.name)
        if flag is not None:
            self.shared.used.scalar(flag, ir.BoolType(), self.origin)
            state: ir.Expression = ir.Name(flag, origin=self.origin)
            if flag == tables.WAIT_LATE:
                state = ir.Unary("not", state, origin=self.origin)
            return self.set(target, ir.Convert("bit", state, origin=self.origin))
        if source.name == tables.RETURNED and not self.is_position(target):
            base = target.base if isinstance(target, ir.Index) else None
            text = isinstance(base, ir.Name) and plain_bank(base.id).startswith("S")
            return self.set(target, self.returned(text))
        if tables.TIMER.fullmatch(source.name):
            return self.set(target, self.value(Word(source.name)))
        type: ir.Type = ir.IntType()
        if self.is_position(target):
            type = ir.TargetType("inform")
        elif source.name.startswith("S"):
            type = ir.StringType()
        value = ir.VendorValue("inform", f"${source.name}", type, origin=self.origin)
        return self.set_position(target, value, Kind(TARGET)) if self.is_position(target) else self.set(target, value)

    def robot_position(self, what: str, pulses: bool, number: ir.Expression) -> ir.Expression:
        """Where the robot is, or was when the last search found its signal; poses in the base frame. M: with the
        tool of the last move."""
        tool, base = self.tool(number), ir.System("null_frame", origin=self.origin)
        if what == "current":
            return self.call("current_joints") if pulses else self.call("current_target", tool, base)
        self.shared.used.scalar(tables.SEARCH_PLACE, ir.TargetType("inform"), self.origin)
        place = ir.Name(tables.SEARCH_PLACE, origin=self.origin)
        return self.call("target_to_joints", place, tool, base) if pulses else place

    def on_settm(self, command: Command) -> Statements:
        """SETTM TM000 TSTART, TSTOP, TRESET or a time after which its flag comes."""
        timer, given = self.needs(command, 2)[:2]
        found = tables.TIMER.fullmatch(timer.text) if isinstance(timer, Word) else None
        if found is None:
            raise StatementError("SETTM needs a timer, TM000 ...", len(command.word))
        place, stopped = self.timer("timer", found[1]), self.timer("timer_stopped", found[1])
        if given in (Word("TSTART"), Word("TSTOP")):
            halts = ir.BoolLiteral(given == Word("TSTOP"), origin=self.origin)
            return (ir.Assign(stopped, halts, origin=self.origin),)
        zero = ir.IntLiteral(0, origin=self.origin)
        left = zero if given == Word("TRESET") else ir.Unary("-", self.value(given), origin=self.origin)
        set_to = ir.Assign(place, ir.Quantity(left, tables.TIMER_UNIT), origin=self.origin)
        if left is zero:
            return (set_to,)
        return set_to, ir.Assign(stopped, ir.BoolLiteral(False), origin=self.origin)

    def returned(self, text: bool) -> ir.Expression:
        """The value that the last RET gave back; a real number where any job of the project gives one back."""
        name = tables.RETURN_TEXT if text else tables.RETURN_VALUE
        type: ir.Type = ir.RealType() if self.shared.project.gives_back_real() else ir.IntType()
        self.shared.used.scalar(name, ir.StringType() if text else type, self.origin)
        return ir.Name(name, origin=self.origin)

    def on_register(self, command: Command) -> Statements:
        """SETREG MREG#(n) v; GETREG v MREG#(n)."""
        target, source = self.needs(command, 2)[:2]
        return self.set(target, self.value(source))

    def on_getfile(self, command: Command) -> Statements:
        """GETFILE v FILE#(n) (element): a number of a condition file, which only the controller knows."""
        place = self.needs(command, 1)[0]
        text = " ".join(self.origin.text.split())
        return self.set(place, ir.VendorValue("inform", text, ir.IntType(), origin=self.origin))

    def on_getprm(self, command: Command) -> Statements:
        place = self.needs(command, 1)[0]
        text = " ".join(self.origin.text.split()[2:])
        return self.set(place, ir.VendorValue("inform", f"GETPRM {text}", ir.IntType(), origin=self.origin))

    def on_getarg(self, command: Command) -> Statements:
        """GETARG v IARG#(n): the n-th argument of the call."""
        target, source = self.needs(command, 2)[:2]
        if not isinstance(source, Numbered) or not isinstance(source.number, ir.IntLiteral):
            raise StatementError("GETARG needs IARG#(n)", 0)
        value = ir.Name(f"IARG{source.number.value}", origin=self.origin)
        if self.is_position(target):
            key = (self.job.name.upper(), source.number.value)
            known = self.shared.project.arguments.get(key, Kind(TARGET))
            return self.set_position(target, value, known)
        return self.set(target, value)

    # ---- elements of positions

    def by_element(self, operand: Operand, done: Callable[[int], Statements]) -> Statements:
        """What is done with the element of this number; a variable's value chooses among them."""
        group = operand.values if isinstance(operand, Group) else ()
        match group:
            case (ir.IntLiteral(value=number),) if 1 <= number <= 8:
                return done(number)
            case (ir.Index() as variable,):
                return (self.chosen_element(self.value(variable), done),)
        raise StatementError("the number of an element is needed: (1) to (8)", 0)

    def chosen_element(self, selector: ir.Expression, done: Callable[[int], Statements]) -> ir.Statement:
        """M: a variable may be the number; one that the position has no element for stops the job."""
        origin = replace(self.origin, comments=())
        cases = [ir.Case((ir.IntLiteral(number),), done(number), origin=origin) for number in range(1, 7)]
        alarm = ir.Message("error", ir.TextLiteral("undefined element"), origin=origin)
        return ir.Switch(selector, tuple(cases), (alarm, ir.Halt(origin=origin)), origin=self.origin)

    def on_gete(self, command: Command) -> Statements:
        """GETE D P (n): in 0.001 mm, 0.0001 deg or pulses."""
        target, source, element = self.needs(command, 3)[:3]
        return self.by_element(element, lambda number: self.set(target, self.element_of(source, number)))

    def element_of(self, source: Operand, number: int) -> ir.Expression:
        place, kind = self.position(source)
        if kind.form == JOINTS:
            return self.call("joint_pulses", place, ir.IntLiteral(number))
        field, count = self.field(place, kind, number)
        scaled = ir.Binary("*", field, ir.RealLiteral(round(1.0 / count, 6)), origin=self.origin)
        return ir.Convert("round_half_away", scaled, origin=self.origin)

    def field(self, place: ir.Expression, kind: Kind, number: int) -> tuple[ir.Expression, float]:
        """The component and how much of its unit one count is."""
        if kind.form == "external":
            self.report_once(EXTERNAL_ELEMENT, "external element")
            return ir.Field(place, f"e{min(number, 6)}", origin=self.origin), tables.DEG_PER_COUNT
        if number > 6:
            return ir.Field(place, f"e{number - 6}", origin=self.origin), tables.DEG_PER_COUNT
        count = tables.MM_PER_COUNT if number <= 3 else tables.DEG_PER_COUNT
        return ir.Field(place, tables.POSE_ELEMENTS[number - 1], origin=self.origin), count

    def on_sete(self, command: Command) -> Statements:
        match command.items:
            case (ir.Index(), Numbered(word="TL")):  # the tool that a position is taught with: `kinds` keeps it
                return (ir.Nothing(origin=self.origin),)
        target, element, source = self.needs(command, 3)[:3]
        value = self.value(source)
        return self.by_element(element, lambda number: self.with_element(target, number, value))

    def with_element(self, target: Operand, number: int, value: ir.Expression) -> Statements:
        """The position with another value of one element, in the element's unit."""
        place, kind = self.position(target)
        if kind.form == JOINTS:
            pulses = [self.call("joint_pulses", place, ir.IntLiteral(each)) for each in range(1, 7)]
            if number > 6:
                raise StatementError("an arm has six axes", 0)
            pulses[number - 1] = value
            return (ir.Assign(place, self.call("joints_from_pulses", *pulses), origin=self.origin),)
        field, count = self.field(place, kind, number)
        if isinstance(value, ir.IntLiteral):
            scaled: ir.Expression = ir.RealLiteral(float(f"{value.value * count:.12g}"))
        else:
            scaled = ir.Binary("*", value, ir.RealLiteral(count), origin=self.origin)
        return (ir.Assign(field, scaled, origin=self.origin),)

    # ---- frames

    def on_cnvrt(self, command: Command) -> Statements:
        """CNVRT a b frame [tool]: position b in another form."""
        target, source, where = self.needs(command, 3)[:3]
        value, kind = self.position(source)
        tools = [item.number for item in command.items if isinstance(item, Numbered) and item.word == "TL"]
        tool = self.tool(tools[0] if tools else kind.tool)
        before = self.frame(kind.frame)
        if where == Word("PULSE"):
            done = value if kind.form == JOINTS else self.call("target_to_joints", value, tool, before)
            return self.set_position(target, done, Kind(JOINTS))
        frame = frame_of(where)
        if frame is None:
            raise StatementError("CNVRT needs a frame: BF, RF, UF#(n) or PULSE", 0)
        after = self.frame(frame)
        if kind.form == JOINTS:
            return self.set_position(target, self.call("joints_to_target", value, tool, after), Kind(TARGET, frame))
        if frame != kind.frame:
            change: ir.Expression = self.call("inverse", after)
            if frame.kind != "user":
                change = before
            elif kind.frame.kind == "user":
                change = ir.Binary(":", change, before, origin=self.origin)
            value = self.call("displaced", value, change)
        return self.set_position(target, value, Kind(TARGET, frame))

    def in_base(self, operand: Operand) -> ir.Expression:
        """A position as a pose in the base frame."""
        value, kind = self.position(operand)
        if kind.form == JOINTS:
            base = ir.System("null_frame", origin=self.origin)
            return self.call("pose_of", self.call("joints_to_target", value, self.tool(kind.tool), base))
        pose = self.call("pose_of", value)
        if kind.frame.kind == "user":
            return ir.Binary(":", self.frame(kind.frame), pose, origin=self.origin)
        return pose

    def on_mframe(self, command: Command) -> Statements:
        """MFRAME UF#(n) origin x-axis xy-plane; newer controllers: MFRAME UF#(n) P BF, the place itself."""
        match command.items:
            case (Numbered() as known, origin, Word()) if self.is_position(origin):
                return (ir.Assign(self.numbered_pose(known), self.in_base(origin), origin=self.origin),)
        target, *points = self.needs(command, 4)[:4]
        vectors = [ir.Field(self.in_base(point), "trans", origin=self.origin) for point in points]
        frame = self.call("frame_from_points", *vectors)
        if isinstance(target, Numbered):
            return (ir.Assign(self.numbered_pose(target), frame, origin=self.origin),)
        place = self.position(target)[0]
        return (ir.Assign(place, self.call("displaced", place, frame), origin=self.origin),)

    def on_settool(self, command: Command) -> Statements:
        target, source = self.needs(command, 2)[:2]
        if not isinstance(target, Numbered) or target.word != "TL":
            raise StatementError("SETTOOL needs TL#(n)", 0)
        place = self.numbered_pose(target)
        value, kind = self.position(source)
        if kind.form == JOINTS:
            raise StatementError("a tool cannot be a position in pulses", 0)
        return (ir.Assign(place, self.call("pose_of", value), origin=self.origin),)

    def on_mulmat(self, command: Command) -> Statements:
        target, one, other = self.needs(command, 3)[:3]
        product = self.call("displaced", self.target(other), self.target(one))
        return self.set_position(target, product, Kind(TARGET))

    def on_invmat(self, command: Command) -> Statements:
        target, source = self.needs(command, 2)[:2]
        value = self.target(source)
        inverse = self.call("inverse", value)
        # inverse . inverse . value: a target again, whose configuration is that of the value
        twice = ir.Binary(":", inverse, inverse, origin=self.origin)
        return self.set_position(target, self.call("displaced", value, twice), Kind(TARGET))

    def target(self, operand: Operand) -> ir.Expression:
        value, kind = self.position(operand)
        if kind.form != TARGET:
            raise StatementError("a position in pulses cannot stand here", 0)
        return value

    def on_mshift(self, command: Command) -> Statements:
        """MSHIFT a frame b c: the shift that leads from b to c, in the axes of the frame (M)."""
        target, where, one, other = self.needs(command, 4)[:4]
        frame = frame_of(where)
        if frame is None:
            raise StatementError("MSHIFT needs a frame", 0)
        poses = []
        for point in (one, other):
            value, kind = self.position(point)
            if kind.form == JOINTS:
                value = self.call("joints_to_target", value, self.tool(kind.tool), self.frame(frame))
            elif kind.frame != frame:
                raise StatementError("MSHIFT is read for points of its own frame", 0)
            poses.append(value)
        return self.set_position(target, self.call("element_difference", poses[1], poses[0]), Kind(TARGET, frame))
