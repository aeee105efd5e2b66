"""Hypothesis strategy for small programs that are well typed, end, and switch outputs according to what they computed.

Every program has the module `work` with a procedure `main`. It computes with whole numbers, reals (multiples of a power
of two, so that every controller gets the same), BOOLs, texts, an array and a record, in bounded loops and branches.
At its end each value goes bit by bit to digital outputs. No division by zero, no overflow, no negative MOD, no variable
without a value. `expected_outputs` computes the outputs on its own, as an oracle for whatever runs or translates it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import strategies as st

from rpl import ir

INTS, REALS, BOOLS, TEXTS = ("count", "total"), ("width", "depth"), ("ready", "full"), ("label",)
ARRAY, RECORD, RECORD_VARIABLE = "layers", "part", "current"
BITS = 8
_INT, _REAL, _BOOL, _TEXT = ir.IntType(), ir.RealType(), ir.BoolType(), ir.StringType(ir.IntLiteral(40))


def name(text: str) -> ir.Name:
    return ir.Name(text)


def number(value: int) -> ir.Expression:
    return ir.IntLiteral(value) if value >= 0 else ir.Unary("-", ir.IntLiteral(-value))


def real(value: float) -> ir.Expression:
    return ir.RealLiteral(value) if value >= 0 else ir.Unary("-", ir.RealLiteral(-value))


def op(sign: str, left: ir.Expression, right: ir.Expression) -> ir.Expression:
    return ir.Binary(sign, left, right)


@dataclass
class _Writer:
    """Draws one program. `counters`: loop counters that a body may read but not write."""

    draw: st.DrawFn
    counters: list[str] = field(default_factory=list)
    loops: int = 0
    inside: int = 0
    callable: list[ir.Routine] = field(default_factory=list)

    def choose(self, *options: object) -> object:
        return self.draw(st.sampled_from(options))

    # ---- expressions

    def int(self, depth: int = 2) -> ir.Expression:
        kind = self.choose(
            "literal", "name", "sum", "product", "div", "mod", "max", "element", "field", "trunc", "call"
        )
        if depth == 0 and kind not in ("literal", "element", "field"):
            kind = "name"
        match kind:
            case "literal":
                return number(self.draw(st.integers(-20, 20)))
            case "sum":
                return op(str(self.choose("+", "-")), self.int(depth - 1), self.int(depth - 1))
            case "product":
                return op("*", self.int(depth - 1), number(self.draw(st.integers(-9, 9))))
            case "div":
                return op("div", self.int(depth - 1), number(self.draw(st.integers(1, 9))))
            case "mod":
                return self.wrapped(self.int(depth - 1), self.draw(st.integers(2, 9)))
            case "max":
                return ir.Builtin(str(self.choose("min", "max")), (self.int(depth - 1), self.int(depth - 1)))
            case "element":
                return ir.Index(name(ARRAY), (number(self.draw(st.integers(1, 3))),))
            case "field":
                return ir.Field(name(RECORD_VARIABLE), "pieces")
            case "trunc":
                return ir.Convert("trunc", self.real(depth - 1))
            case "call" if any(routine.returns == _INT for routine in self.callable):
                return self.call_function()
        return name(str(self.choose(*INTS, *self.counters)))

    def wrapped(self, value: ir.Expression, limit: int = 1000) -> ir.Expression:
        """Not negative and below the limit."""
        return op("mod", ir.Builtin("abs", (value,)), number(limit))

    def real(self, depth: int = 2) -> ir.Expression:
        kind = self.choose("literal", "name", "sum", "half", "convert", "field", "quotient")
        if depth == 0 and kind not in ("literal", "field"):
            kind = "name"
        match kind:
            case "literal":
                return real(self.draw(st.integers(-40, 40)) / 4)
            case "sum":
                return op(str(self.choose("+", "-")), self.real(depth - 1), self.real(depth - 1))
            case "half":
                return op("*", self.real(depth - 1), real(0.5))
            case "quotient":
                return op("/", ir.Convert("real", self.int(depth - 1)), real(4.0))
            case "convert":
                return ir.Convert("real", self.int(depth - 1))
            case "field":
                return ir.Field(name(RECORD_VARIABLE), "weight")
        return name(str(self.choose(*REALS)))

    def bool(self, depth: int = 2) -> ir.Expression:
        kind = self.choose("literal", "name", "ints", "reals", "texts", "logic", "not", "field")
        if depth == 0 and kind not in ("literal", "field"):
            kind = "name"
        match kind:
            case "literal":
                return ir.BoolLiteral(self.draw(st.booleans()))
            case "ints":
                return op(self.comparison(), self.int(depth - 1), self.int(depth - 1))
            case "reals":
                return op(self.comparison(), self.real(depth - 1), self.real(depth - 1))
            case "texts":
                return op(str(self.choose("=", "<>")), name(TEXTS[0]), self.text())
            case "logic":
                return op(str(self.choose("and", "or", "xor")), self.bool(depth - 1), self.bool(depth - 1))
            case "not":
                return ir.Unary("not", self.bool(depth - 1))
            case "field":
                return ir.Field(name(RECORD_VARIABLE), "good")
        return name(str(self.choose(*BOOLS)))

    def comparison(self) -> str:
        return str(self.choose("=", "<>", "<", ">", "<=", ">="))

    def text(self) -> ir.Expression:
        literal = ir.TextLiteral(str(self.choose("", "a", "box", "pallet")))
        return op("&", literal, ir.TextLiteral("x")) if self.draw(st.booleans()) else literal

    def call_function(self) -> ir.Expression:
        routine = self.draw(st.sampled_from([routine for routine in self.callable if routine.returns == _INT]))
        return ir.Call(routine.name, tuple(ir.Argument(self.int(0)) for _ in routine.parameters))

    # ---- statements

    def body(self, most: int = 3) -> ir.Body:
        count = self.draw(st.integers(1, most))
        return tuple(statement for _ in range(count) for statement in self.statement())

    def statement(self) -> ir.Body:
        kind = self.choose("assign", "assign", "assign", "if", "switch", "for", "while", "repeat", "loop", "call")
        if self.inside >= 2 and kind not in ("assign", "call"):
            kind = "assign"
        if kind == "assign":
            return (self.assign(),)
        if kind == "call":
            return self.call()
        self.inside += 1
        done = self.block(str(kind))
        self.inside -= 1
        return done

    def assign(self) -> ir.Statement:
        match self.choose("int", "real", "bool", "text", "element", "field"):
            case "int":
                return ir.Assign(name(str(self.choose(*INTS))), self.wrapped(self.int()))
            case "real":
                return ir.Assign(name(str(self.choose(*REALS))), self.tamed(self.real()))
            case "bool":
                return ir.Assign(name(str(self.choose(*BOOLS))), self.bool())
            case "text":
                return ir.Assign(name(TEXTS[0]), self.text())
            case "element":
                place = ir.Index(name(ARRAY), (number(self.draw(st.integers(1, 3))),))
                return ir.Assign(place, self.wrapped(self.int()))
        match self.choose("pieces", "weight", "good"):
            case "pieces":
                return ir.Assign(ir.Field(name(RECORD_VARIABLE), "pieces"), self.wrapped(self.int()))
            case "weight":
                return ir.Assign(ir.Field(name(RECORD_VARIABLE), "weight"), self.tamed(self.real()))
        return ir.Assign(ir.Field(name(RECORD_VARIABLE), "good"), self.bool())

    def tamed(self, value: ir.Expression) -> ir.Expression:
        """A real that stays small and exact however often it is computed: quarters below 1000."""
        whole = ir.Convert("trunc", op("*", value, real(4.0)))
        return op("/", ir.Convert("real", self.wrapped(whole, 4000)), real(4.0))

    def block(self, kind: str) -> ir.Body:
        match kind:
            case "if":
                branches = tuple((self.bool(), self.body(2)) for _ in range(self.draw(st.integers(1, 2))))
                return (ir.If(branches, self.body(2) if self.draw(st.booleans()) else ()),)
            case "switch":
                cases = tuple(
                    ir.Case(tuple(number(value) for value in values), self.body(2)) for values in ((0,), (1, 2))
                )
                default = self.body(2) if self.draw(st.booleans()) else None
                return (ir.Switch(self.wrapped(self.int(), 4), cases, default),)
            case "for":
                return (self.counting(),)
        counter = f"step{self.loops}"
        self.loops += 1
        start = ir.Assign(name(counter), number(0))
        more = ir.Assign(name(counter), op("+", name(counter), number(1)))
        limit = number(self.draw(st.integers(0, 3)))
        self.counters.append(counter)
        inner = self.body(2)
        self.counters.remove(counter)
        match kind:
            case "while":
                return start, ir.While(op("<", name(counter), limit), (*inner, more))
            case "repeat":
                return start, ir.Repeat(op(">=", name(counter), limit), (*inner, more))
        leave = ir.If(((op(">=", name(counter), limit), (ir.ExitLoop(),)),))
        return start, ir.Loop((leave, *inner, more))

    def counting(self) -> ir.Statement:
        counter = f"index{self.loops}"
        self.loops += 1
        start, stop = self.draw(st.integers(-1, 4)), self.draw(st.integers(-1, 4))
        step = self.draw(st.sampled_from((None, 1, 2, -1)))
        self.counters.append(counter)
        inner = self.body(2)
        self.counters.remove(counter)
        return ir.For(counter, number(start), number(stop), None if step is None else number(step), inner)

    def call(self) -> ir.Body:
        procedures = [routine for routine in self.callable if routine.kind == "procedure"]
        if not procedures:
            return (self.assign(),)
        routine = self.draw(st.sampled_from(procedures))
        free = list(INTS)
        given = []
        for parameter in routine.parameters:
            if parameter.mode == "reference":
                given.append(ir.Argument(name(free.pop())))
            else:
                given.append(ir.Argument(self.int(1)))
        return (ir.CallRoutine(routine.name, tuple(given)),)


def _function(writer: _Writer, called: str) -> ir.Routine:
    """A function of one parameter that looks at nothing else."""
    limit, factor = writer.draw(st.integers(0, 9)), writer.draw(st.integers(-3, 3))
    early = ir.If(((op(">", name("given"), number(limit)), (ir.Return(number(factor)),)),))
    result = ir.Return(op("+", op("*", writer.wrapped(name("given"), 100), number(factor)), number(limit)))
    return ir.Routine(called, "function", (ir.Parameter("given", _INT),), _INT, body=(early, result))


def _procedure(writer: _Writer, called: str) -> ir.Routine:
    """A procedure that changes a parameter given by reference and one given by value."""
    amount = writer.draw(st.integers(0, 9))
    body = (
        ir.Assign(name("given"), op("+", writer.wrapped(name("given"), 100), number(amount))),
        ir.Assign(name("changed"), writer.wrapped(op("+", name("changed"), name("given")))),
    )
    parameters = (ir.Parameter("given", _INT), ir.Parameter("changed", _INT, "reference"))
    return ir.Routine(called, "procedure", parameters, body=body)


def _bits(first: int, value: ir.Expression) -> list[ir.Statement]:
    done: list[ir.Statement] = []
    for bit in range(BITS):
        digit = op("mod", op("div", value, number(2**bit)), number(2))
        done.append(ir.Assign(ir.Signal("digital_out", number(first + bit)), op("=", digit, number(1))))
    return done


def _report() -> tuple[ir.Statement, ...]:
    """Values to outputs: 1.. BOOLs, then eight bits of each number."""
    done: list[ir.Statement] = []
    bools = [
        *(name(text) for text in BOOLS),
        ir.Field(name(RECORD_VARIABLE), "good"),
        op("=", name("label"), ir.TextLiteral("box")),
    ]
    for position, value in enumerate(bools):
        done.append(ir.Assign(ir.Signal("digital_out", number(1 + position)), value))
    ints: list[ir.Expression] = [name(text) for text in INTS]
    ints += [ir.Index(name(ARRAY), (number(i),)) for i in (1, 2, 3)]
    ints.append(ir.Field(name(RECORD_VARIABLE), "pieces"))
    reals = [*(name(text) for text in REALS), ir.Field(name(RECORD_VARIABLE), "weight")]
    ints += [ir.Convert("trunc", op("*", value, real(4.0))) for value in reals]
    for position, value in enumerate(ints):
        done.extend(_bits(11 + 10 * position, op("mod", value, number(256))))
    return tuple(done)


@st.composite
def executable_programs(draw: st.DrawFn, dialect: str = "rpl") -> ir.Program:
    """A program that runs to its end; see the head of this module."""
    writer = _Writer(draw)
    helpers = [_function(writer, "score"), _procedure(writer, "store")]
    writer.callable = helpers
    start: list[ir.Statement] = [ir.Assign(name(text), number(draw(st.integers(0, 50)))) for text in INTS]
    start += [ir.Assign(name(text), real(draw(st.integers(0, 80)) / 4)) for text in REALS]
    start += [ir.Assign(name(text), ir.BoolLiteral(draw(st.booleans()))) for text in BOOLS]
    start.append(ir.Assign(name("label"), ir.TextLiteral("box")))
    start += [ir.Assign(ir.Index(name(ARRAY), (number(i),)), number(i * 7)) for i in (1, 2, 3)]
    start += [
        ir.Assign(ir.Field(name(RECORD_VARIABLE), "pieces"), number(draw(st.integers(0, 50)))),
        ir.Assign(ir.Field(name(RECORD_VARIABLE), "weight"), real(draw(st.integers(0, 80)) / 4)),
        ir.Assign(ir.Field(name(RECORD_VARIABLE), "good"), ir.BoolLiteral(draw(st.booleans()))),
    ]
    body = writer.body(5)
    counters = [f"{kind}{i}" for i in range(writer.loops) for kind in ("step", "index")]
    local = tuple(ir.Variable(counter, _INT, scope="routine") for counter in counters)
    main = ir.Routine("main", declarations=local, body=(*start, *body, *_report()))
    declared: list[ir.Declaration] = [
        ir.RecordDeclaration(RECORD, (("pieces", _INT), ("weight", _REAL), ("good", _BOOL))),
        *(ir.Variable(text, _INT) for text in INTS),
        *(ir.Variable(text, _REAL) for text in REALS),
        *(ir.Variable(text, _BOOL) for text in BOOLS),
        *(ir.Variable(text, _TEXT) for text in TEXTS),
        ir.Variable(ARRAY, ir.ArrayType(_INT, (number(3),))),
        ir.Variable(RECORD_VARIABLE, ir.NamedType(RECORD)),
    ]
    return ir.Program((ir.Module("work", dialect, tuple(declared), (main, *helpers)),), entry="main")
