"""`read(print(ir)) == ir` for every node of the IR, and printing what was read gives the same text again."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path
from typing import get_args

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "ir"))
import strategies as make

SLOW = (HealthCheck.too_slow, HealthCheck.data_too_large)
quick = settings(max_examples=120, deadline=None, suppress_health_check=SLOW, derandomize=True)


def printed(program: ir.Program) -> str:
    files = registry.target("rpl").write(program, WriteContext(Diagnostics()))
    return files[0].data.decode("utf-8")


def read(text: str) -> ir.Program:
    diagnostics = Diagnostics()
    program = registry.dialect("rpl").read([source_from_text("t.rpl", text)], diagnostics).program
    # Drawn tasks and entries are any names, so that one may stand for the other.
    said = [item.as_text() for item in diagnostics if item.code.name != "rpl-entry-not-begun"]
    assert said == [], text
    return program


def round_trip(program: ir.Program) -> None:
    text = printed(program)
    again = read(text)
    assert again == program, text
    assert printed(again) == text


def in_program(*body: ir.Statement) -> ir.Program:
    return ir.Program((ir.Module("m", "rpl", (), (ir.Routine("main", body=body),)),))


@quick
@given(make.expressions)
def test_expressions(expression: ir.Expression) -> None:
    round_trip(in_program(ir.Assign(ir.Name("x"), expression), ir.Return(expression), ir.Wait(expression)))


@quick
@given(make.simple)
def test_simple_statements(statement: ir.Statement) -> None:
    round_trip(in_program(statement))


@quick
@given(make.bodies)
def test_bodies(body: ir.Body) -> None:
    round_trip(in_program(*body))


@quick
@given(st.lists(make.declarations, max_size=3), st.lists(make.declarations, max_size=3), make.bodies)
def test_declarations(outer: list[ir.Declaration], inner: list[ir.Declaration], body: ir.Body) -> None:
    routine = ir.Routine("main", declarations=tuple(inner), body=body)
    round_trip(ir.Program((ir.Module("m", "krl", tuple(outer), (routine,)),)))


@quick
@given(make.programs)
def test_programs(program: ir.Program) -> None:
    round_trip(program)


# Built by hand, so that the check below does not rest on luck.
_ONE = ir.Name("x")
_SPEED = ir.Speed(*[_ONE] * 8)
_TRIGGER = ir.Trigger("end", ir.CallRoutine("f", (ir.Argument(_ONE, "n", "o"),), _ONE), _ONE, _ONE, _ONE)
_BLENDS: tuple[ir.Blend, ...] = (
    ir.BlendStop(),
    ir.BlendPercent(_ONE, ir.BlendDistance(_ONE, _ONE)),
    ir.BlendSpeed(_ONE),
    ir.BlendLevel(_ONE),
    ir.BlendZone(_ONE, _ONE, _ONE),
)
_FULL: tuple[ir.Statement, ...] = (
    *make.BARE,
    *(ir.MoveExternal(_ONE, _SPEED, blend) for blend in _BLENDS),
    ir.Move(
        "circular",
        ir.Aggregate(((None, ir.EnumLiteral("m")),), "t"),
        _ONE,
        ir.Magnitude(ir.Quantity(_ONE, "mm"), "m"),
        "tool",
        tool=_ONE,
        frame=_ONE,
        load=_ONE,
        speed=_SPEED,
        acceleration=_ONE,
        blend=ir.BlendStop(),
        orientation="wrist",
        circle_orientation="path",
        configuration="exact",
        triggers=(_TRIGGER,),
        search=ir.Search(_ONE, _ONE, "soft", "either", _ONE),
        settings=((_ONE, _ONE),),
        concurrent=True,
        without_offsets=True,
        group=2,
        identity=_ONE,
        motion_class="spline",
    ),
    ir.Spline("joint", (ir.Move("spline", _ONE), ir.Vendor("krl", "t", "time")), ir.BlendStop(), ((_ONE, _ONE),)),
    *(ir.PathRule(*rule) for rule in (("time_start",), ("time_part", _ONE), ("constant_start", _ONE, "start"))),
    _TRIGGER,
    ir.DefineTrigger(_ONE, _TRIGGER, _ONE),
    ir.If(((ir.BoolLiteral(True), ()),), (ir.Opaque("?"),)),
    ir.Switch(_ONE, (ir.Case((_ONE,), (ir.Raise(_ONE),)),), (ir.Nothing(),)),
    ir.For("i", _ONE, _ONE, _ONE, (ir.Halt("cycle"),), True, True, True, True),
    ir.While(_ONE, (ir.Label("l"), ir.Goto("l"))),
    ir.Repeat(_ONE, (ir.Clock("start", _ONE),)),
    ir.Loop((ir.ExitLoop(),)),
    ir.Return(ir.Call("f", (ir.Argument(None, "s"),))),
    ir.Wait(ir.Convert("trunc", ir.Unary("-", ir.RealLiteral(0.5))), True),
    ir.WaitUntil(_ONE, _ONE, _ONE, "e", True),
    ir.Pulse(ir.Signal("digital_out", _ONE, _ONE), _ONE, _ONE),
    ir.SetAfter(ir.Signal("analog_out", name="a"), _ONE, _ONE),
    ir.DeclareInterrupt(_ONE, _ONE, ir.Assign(_ONE, ir.Present("p")), True, _ONE, True, True),
    ir.ConnectInterrupt(_ONE, "t"),
    ir.OrderInterrupt(_ONE, "edge", _ONE, _ONE, True),
    ir.ControlInterrupt("off", _ONE),
    ir.StopMotion(True),
    ir.StoreMotion(True),
    ir.Message("state", ir.TextLiteral("t"), _ONE),
    ir.Dialog(_ONE, _ONE, (None, _ONE), "number", _ONE, _ONE, _ONE),
    ir.Do("text_append", (_ONE, None)),
    ir.TaskControl("stop", "t", (ir.Argument(_ONE),)),
    ir.Assign(ir.Index(ir.Field(_ONE, "f"), (_ONE,)), ir.Binary("+", ir.IntLiteral(1), ir.System("timer", (_ONE,)))),
    ir.Assign(_ONE, ir.Builtin("sin", (_ONE,))),
    ir.Assign(_ONE, ir.VendorValue("rapid", "f(1)", ir.RealType())),
    ir.Critical(True),
    ir.Meet(_ONE, _ONE, "together", _ONE, "e", True),
    ir.Meet(ir.TextLiteral("t"), mode="apart"),
    ir.SetForNextMove(_ONE, _ONE),
    ir.OnError("f"),
)
_TYPES: tuple[ir.Type, ...] = (
    *make.PLAIN_TYPES,
    ir.ArrayType(ir.StringType(_ONE), (_ONE, None), 0),
    ir.TargetType("krl", False),
    ir.ConfigType("krl"),
    ir.SignalType("digital_in"),
    ir.VendorType("rapid", "socketdev"),
    ir.NamedType("r"),
)
_DECLARATIONS: tuple[ir.Declaration, ...] = (
    *(ir.Variable("v", type, _ONE, "constant", "global") for type in _TYPES),
    ir.RecordDeclaration("r", (("f", ir.IntType()),), "global"),
    ir.EnumDeclaration("e", ("m",), "global"),
    ir.AliasDeclaration("a", ir.IntType(), "global"),
    ir.SignalDeclaration("s", ir.Signal("flag", _ONE), "global"),
    ir.ExternalDeclaration("x", "EXT x()"),
    ir.Initialise(ir.Assign(_ONE, _ONE)),
    ir.Unread("?"),
)
_PARAMETER = ir.Parameter("p", ir.IntType(), "reference", True, True, 3)
EVERYTHING = ir.Program(
    (
        ir.Module(
            "m",
            "krl",
            _DECLARATIONS,
            (
                ir.Routine(
                    "f",
                    "function",
                    (_PARAMETER,),
                    ir.IntType(),
                    _DECLARATIONS,
                    _FULL,
                    (ir.Handler((_ONE,), (ir.Retry(),)),),
                    (ir.Nothing(),),
                    (ir.Nothing(),),
                    "global",
                    open_ended=True,
                ),
            ),
            (("access", "RVP"),),
            "t",
            True,
        ),
    ),
    (ir.Task("t", "f", "background", True, ("m",)),),
    "f",
)


def test_everything() -> None:
    round_trip(EVERYTHING)


def test_instructions_of_targets_are_printed_as_their_parts() -> None:
    parts = (ir.Label("l"), ir.Goto("l"))

    def program(body: ir.Body) -> ir.Program:
        return ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("f", body=body),)),))

    assert printed(program((ir.Instruction("", parts),))) == printed(program(parts))


def test_everything_is_everything() -> None:
    """A node or a field that is added to the IR has to be added above, where losing it is seen."""
    nodes = list(walk((EVERYTHING,)))
    parts = (ir.Statement, ir.Expression, ir.Declaration, ir.Type)
    alone = {ir.Instruction, ir.Run, ir.Rows, ir.VariableRows}  # printed as what they stand for
    wanted = {node for part in parts for node in get_args(part)} - alone
    assert sorted(node.__name__ for node in wanted - {type(node) for node in nodes}) == []
    used = {
        (type(node), field.name)
        for node in nodes
        for field in dataclasses.fields(node)  # type: ignore[arg-type]
        if getattr(node, field.name) != _default(field)
    }
    unused = [
        f"{kind.__name__}.{field.name}"
        for kind in {type(node) for node in nodes}
        for field in dataclasses.fields(kind)  # type: ignore[arg-type]
        if field.compare and (kind, field.name) not in used
    ]
    assert unused == []


def _default(field: dataclasses.Field[object]) -> object:
    return field.default if field.default is not dataclasses.MISSING else object()
