"""INFORM writing: words, ranges, headers, conditions, helpers; each by a small program of the IR."""

from __future__ import annotations

import pytest
from rpl.postprocessors.inform import tables
from rpl.postprocessors.inform.conditions import alternatives, text
from rpl.postprocessors.inform.labels import Labels

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.writing.statements import CannotSayError
from rpl.writing.target import WriteContext

X, Y = ir.Index(ir.Name("R"), (ir.IntLiteral(0),)), ir.Index(ir.Name("R"), (ir.IntLiteral(1),))
N, M = ir.Index(ir.Name("D"), (ir.IntLiteral(0),)), ir.Index(ir.Name("D"), (ir.IntLiteral(1),))
FLAG = ir.Index(ir.Name("B"), (ir.IntLiteral(3),))
SPOT = ir.Index(ir.Name("P"), (ir.IntLiteral(5),))
POSE = ir.Aggregate(tuple((name, ir.RealLiteral(float(at))) for at, name in enumerate(("x", "y", "z", "a", "b", "c"))))


GP7 = "motoman_gp7"


def output(number: int) -> ir.Signal:
    return ir.Signal("digital_out", ir.IntLiteral(number))


def written(
    *body: ir.Statement, points: tuple[ir.Variable, ...] = (), robot: str = ""
) -> tuple[list[str], list[str], Diagnostics]:
    """Header and instructions of the job, and what was reported."""
    routine = ir.Routine("Work", declarations=points, body=body)
    program = ir.Program((ir.Module("Work", "inform", routines=(routine,)),))
    diagnostics = Diagnostics()
    context = WriteContext(diagnostics, load_robot(robot) if robot else None)
    file, *beside = registry.target("inform").write(program, context)
    assert {one.path for one in beside} <= {"TOOL.CND", "UFRAME.CND"}
    lines = file.data.decode("ascii").split("\r\n")
    at = lines.index("NOP")
    assert file.path == "WORK.JBI" and lines[-2:] == ["END", ""]
    return lines[:at], lines[at + 1 : -2], diagnostics


@pytest.mark.parametrize(
    ("place", "value", "wanted"),
    [
        (N, ir.IntLiteral(7), ["SET D000 7"]),
        (N, ir.Binary("+", N, ir.IntLiteral(1)), ["INC D000"]),
        (N, ir.Binary("-", N, ir.IntLiteral(1)), ["DEC D000"]),
        (N, ir.Binary("div", M, ir.IntLiteral(2)), ["SET D000 D001", "DIV D000 2"]),
        (X, ir.Binary("div", N, M), ["SET D099 D000", "DIV D099 D001", "SET R000 D099"]),
        (N, ir.Binary("+", M, N), ["ADD D000 D001"]),
        (N, ir.Binary("-", M, N), ["SET D099 D000", "SET D000 D001", "SUB D000 D099"]),
        (N, ir.Binary("mod", N, M), ["SET D099 D000", "DIV D099 D001", "MUL D099 D001", "SUB D000 D099"]),
        (
            X,
            ir.Binary("mod", X, Y),
            [
                *("SET R099 R000", "DIV R099 R001", "SET D099 R099", "SET R099 D099"),
                *("MUL R099 R001", "SUB R000 R099"),
            ],
        ),
        (X, ir.Binary("*", Y, ir.RealLiteral(0.5)), ["SET R000 R001", "MUL R000 0.5"]),
        (X, ir.Builtin("sin", (Y,)), ["SIN R000 R001"]),
        (X, ir.Builtin("abs", (Y,)), ["SET R000 R001", "IFTHENEXP R000<0", "MUL R000 -1", "ENDIF"]),
        (FLAG, ir.BoolLiteral(True), ["SET B003 1"]),
        (FLAG, ir.Signal("digital_in", ir.IntLiteral(4)), ["DIN B003 IN#(4)"]),
        (X, ir.Field(SPOT, "y"), ["GETE D099 P005 (2)", "SET R000 D099", "DIV R000 1000.0"]),
        (ir.Field(SPOT, "a"), ir.RealLiteral(-90.0), ["SET P005 P127", "SETE P005 (6) -900000"]),
        (
            ir.Field(SPOT, "z"),
            X,
            [
                *("SET P005 P127", "SET R099 R000", "MUL R099 1000.0", "IFTHENEXP R099<0.0", "SUB R099 0.5"),
                *("ELSE", "ADD R099 0.5", "ENDIF", "SET D099 R099", "SETE P005 (3) D099"),
            ],
        ),
        (SPOT, ir.System("actual_pose"), ["GETS P005 $PX001"]),
        (output(2), ir.BoolLiteral(True), ["DOUT OT#(2) ON"]),
        (output(2), FLAG, ["DOUT OT#(2) B003"]),
        (ir.Signal("group_out", ir.IntLiteral(9), ir.IntLiteral(16)), ir.IntLiteral(5), ["DOUT OG#(2) 5"]),
        (ir.Signal("group_out", ir.IntLiteral(5), ir.IntLiteral(8)), ir.IntLiteral(5), ["DOUT OGH#(2) 5"]),
    ],
)
def test_assignments(place: ir.Expression, value: ir.Expression, wanted: list[str]) -> None:
    _, lines, diagnostics = written(ir.Assign(place, value))
    assert lines == wanted
    assert not diagnostics.has_losses


def test_flags_are_bytes() -> None:
    """One byte for each number, from the top of the bank."""
    one, two = (ir.Signal("flag", ir.IntLiteral(number)) for number in (1, 7))
    _, lines, diagnostics = written(
        ir.Assign(one, ir.BoolLiteral(True)),
        ir.Assign(two, ir.BoolLiteral(False)),
        ir.WaitUntil(one),
    )
    assert lines[:2] == ["SET B099 1", "SET B098 0"]
    assert any("B099" in line for line in lines[2:])
    assert not diagnostics.has_losses


def test_waiting_for_the_robot_behind_a_label() -> None:
    _, lines, diagnostics = written(ir.Label("again"), ir.WaitForMotion())
    assert lines[-1] == "TIMER T=0.01"
    assert not diagnostics.has_losses


def test_limited_wait_for_a_computed_condition() -> None:
    """Looked at every 0.01 s, as often as the limit takes."""
    wait = ir.WaitUntil(ir.Binary(">", N, M), timeout=ir.RealLiteral(2.0), timed_out=FLAG)
    _, lines, diagnostics = written(wait)
    assert lines == [
        *("SET D099 200", "WHILEEXP D000<=D001 ANDEXP D099>0", "TIMER T=0.01", "DEC D099", "ENDWHILE"),
        *("IFTHENEXP D000>D001", "SET B003 0", "ELSE", "SET B003 1", "ENDIF"),
    ]
    assert not diagnostics.has_losses


def test_joints_with_a_tool_in_a_variable() -> None:
    """The posture of the flange, the place of flange and tool."""
    home = ir.Aggregate(tuple((f"j{n}", ir.RealLiteral(v)) for n, v in enumerate((0.0, 0, 0, 0, -90, 0), 1)))
    move = ir.Move("joint", home, tool=ir.Index(ir.Name("P"), (ir.IntLiteral(9),)))
    head, lines, diagnostics = written(ir.Assign(ir.Index(ir.Name("P"), (ir.IntLiteral(9),)), SPOT), move, robot=GP7)
    assert any(line.startswith("///RCONF 1,") for line in head)
    assert lines[1] == "SETTOOL TL#(1) P009"
    assert [line.split()[0] for line in lines[2:4]] == ["SET", "MULMAT"] and lines[3].endswith("P009")
    assert sum(line.startswith("SETE ") for line in lines) == 6 and lines[-1].startswith("MOVJ P")
    assert not diagnostics.has_losses


def test_rounding_is_spelled_out() -> None:
    _, lines, _ = written(ir.Assign(N, ir.Convert("round_half_away", X)))
    assert lines == [
        *("SET R099 R000", "IFTHENEXP R099<0.0", "SUB R099 0.5", "ELSE", "ADD R099 0.5", "ENDIF", "SET D000 R099"),
    ]


def compared(left: ir.Expression, op: str, right: ir.Expression) -> ir.Binary:
    return ir.Binary(op, left, right)


def test_and_binds_before_or() -> None:
    one, two, three = (compared(N, "=", ir.IntLiteral(n)) for n in (1, 2, 3))
    mixed = ir.Binary("and", ir.Binary("or", one, two), three)
    assert text(alternatives(mixed)) == "D000=1 ANDEXP D000=3 OREXP D000=2 ANDEXP D000=3"
    assert text(alternatives(ir.Unary("not", mixed))) == "D000<>1 ANDEXP D000<>2 OREXP D000<>3"


def test_most_comparisons() -> None:
    """M: how many comparisons a condition may have."""
    one = compared(N, "=", ir.IntLiteral(1))
    long: ir.Expression = one
    for _ in range(tables.MOST_TERMS):
        long = ir.Binary("or", long, one)
    with pytest.raises(CannotSayError):
        alternatives(long)


def test_blocks_and_jumps() -> None:
    full = compared(N, ">=", ir.IntLiteral(4))
    _, lines, _ = written(
        ir.Label("once_more_please"),
        ir.If(((full, (ir.Goto("once_more_please"),)),)),
        ir.If(((full, (ir.Assign(FLAG, ir.BoolLiteral(True)),)),), (ir.Halt("exit"),)),
        ir.For("D4", ir.IntLiteral(0), ir.IntLiteral(9), ir.IntLiteral(2), (ir.Halt(),)),
        ir.While(ir.Signal("digital_in", ir.IntLiteral(1)), (ir.Wait(ir.RealLiteral(0.5)),)),
        ir.Return(),
    )
    assert lines == [
        *("*ONCEMORE", "JUMP *ONCEMORE IF D000>=4"),
        *("IFTHENEXP D000>=4", "SET B003 1", "ELSE", "ABORT", "ENDIF"),
        *("FOR D004=0 TO 9 STEP 2", "PAUSE", "NEXT D004"),
        *("WHILEEXP IN#(1)=ON", "TIMER T=0.50", "ENDWHILE"),
    ]


def test_labels_stay_apart() -> None:
    labels = Labels.of((ir.Label("go_on_with_a"), ir.Label("go_on_with_b"), ir.Label("GOONWITH")))
    assert [labels.name(name) for name in ("GOONWITH", "go_on_with_a", "go_on_with_b")] == [
        *("GOONWITH", "GOONWIT2", "GOONWIT3"),
    ]


def test_a_short_label_stays_as_it_is() -> None:
    labels = Labels.of((ir.Label("no_pick"), ir.Label("NO-PLACE"), ir.Label("__")))
    assert [labels.name(name) for name in ("no_pick", "NO-PLACE", "__")] == ["NO_PICK", "NO-PLACE", "L"]


def test_waits() -> None:
    first = ir.Signal("digital_in", ir.IntLiteral(1))
    both = ir.Binary("and", first, ir.Signal("digital_in", ir.IntLiteral(2)))
    _, lines, _ = written(ir.WaitUntil(first, ir.RealLiteral(2.0), FLAG), ir.WaitUntil(both))
    assert lines == [
        *("WAIT IN#(1)=ON T=2.00", "GETS B003 $B014", "XOR B003 1"),
        *("WHILEEXP IN#(1)=OFF OREXP IN#(2)=OFF", "TIMER T=0.01", "ENDWHILE"),
    ]


def point(name: str, x: float) -> ir.Variable:
    values = (("x", x), ("y", 0.0), ("z", 500.0), ("a", 180.0), ("b", 0.0), ("c", 180.0))
    flags = tuple((name, ir.IntLiteral(0)) for name in tables.FLAGS)
    entries = (*((n, ir.RealLiteral(v)) for n, v in values), *flags)
    return ir.Variable(name, ir.TargetType("inform"), ir.Aggregate(entries), "constant", "routine")


def test_moves_and_points() -> None:
    speed, slow = ir.Speed(joint=ir.RealLiteral(50.0)), ir.Speed(path=ir.RealLiteral(200.0))
    corner = ir.BlendDistance(ir.RealLiteral(20.0))
    head, lines, diagnostics = written(
        ir.Move("joint", ir.Name("C1"), speed=speed, blend=corner),
        ir.Move("linear", ir.Name("C2"), tool=POSE, frame=POSE, speed=slow, blend=corner),
        ir.Move("circular", ir.Name("C1"), via=ir.Name("C2"), speed=slow, blend=ir.BlendStop()),
        points=(point("C1", 700.0), point("C2", 800.0)),
    )
    assert lines == [
        *("MOVJ C00001 VJ=50.00 PL=1", "MOVC C00002 V=200.0 CR=20.0"),
        *("MOVC C00000 V=200.0", "MOVC C00003 V=200.0 PL=0"),  # each step has a point of its own
    ]
    assert "C00003=700.000,0.000,500.000,180.0000,0.0000,180.0000" in head
    assert "C00001=700.000,0.000,500.000,180.0000,0.0000,180.0000" in head
    assert "////FRAME USER 1" in head or "////FRAME BASE" in head
    assert head.index("///RCONF 0,0,0,0,0,0") < head.index("///POSTYPE USER") < head.index("///USER 1") + 2
    assert [item.code.name for item in diagnostics] == ["inform-joint-corner"]


def test_joints_are_pulses_where_they_can_be_counted() -> None:
    joints = ir.Aggregate(tuple((f"j{n}", ir.RealLiteral(10.0 * n)) for n in range(1, 7)))
    home = ir.Variable("C0", ir.JointsType(), joints, "constant", "routine")
    move = ir.Move("joint", ir.Name("C0"), speed=ir.Speed(joint=ir.RealLiteral(50.0)))
    head, lines, _ = written(move, points=(home,), robot="motoman_ma2010")
    assert "///POSTYPE PULSE" in head and "///PULSE" in head and lines == ["MOVJ C00000 VJ=50.00 PL=0"]
    assert head[-5].startswith("C00000=13414,38153,47787,40914,49012,27285")
    head, _, _ = written(move, points=(home,), robot="motoman_gp7")
    assert "///RECTAN" in head and any(line.startswith("///RCONF ") for line in head)
    _, lines, diagnostics = written(move, points=(home,))
    assert lines[-1] == "PAUSE" and diagnostics.has_losses


def test_guarded_stop_and_long_remarks() -> None:
    _, lines, diagnostics = written(ir.Opaque("this is a line that nobody understands at all"))
    assert lines == ["'this is a line that nobody ", "'understands at all", "PAUSE"] or lines == [
        *("'this is a line that nobody", "'understands at all", "PAUSE"),
    ]
    assert [item.code.name for item in diagnostics] == ["unread-instruction"]


def test_ranges() -> None:
    """M: the ranges of speeds and of bytes."""
    fast = ir.Move("linear", ir.Name("C1"), speed=ir.Speed(path=ir.RealLiteral(2500.0)))
    _, lines, diagnostics = written(fast, points=(point("C1", 700.0),))
    assert lines == ["MOVL C00001 V=1500.0 PL=0"]
    assert [item.code.name for item in diagnostics] == ["inform-range"]
    _, lines, _ = written(ir.Assign(FLAG, ir.IntLiteral(300)))
    assert lines[-1] == "PAUSE"


def test_long_message_is_split() -> None:
    _, lines, _ = written(ir.Message("notify", ir.TextLiteral("x" * 40)))
    assert lines == [f'MSG "{"x" * 32}"', f'MSG "{"x" * 8}"']
