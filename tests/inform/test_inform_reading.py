"""Lines of a job and what they become; what cannot be read costs itself alone."""

import pytest
from inform_helpers import body_of, job, read, run

from rpl import ir, registry

B0 = ir.Name("B000")
IN1, OT1 = ir.Signal("digital_in", ir.IntLiteral(1)), ir.Signal("digital_out", ir.IntLiteral(1))


def whole(value: int) -> ir.IntLiteral:
    return ir.IntLiteral(value)


STATEMENTS = [
    ("SET B000 5", ir.Assign(B0, whole(5))),
    ("SET I000 -3", ir.Assign(ir.Name("I000"), whole(-3))),
    ("ADD B000 2", ir.Assign(B0, ir.Binary("+", B0, whole(2)))),
    ("DIV B000 2", ir.Assign(B0, ir.Binary("div", B0, whole(2)))),
    ("INC B000", ir.Assign(B0, ir.Binary("+", B0, whole(1)))),
    ("DOUT OT#(1) ON", ir.Assign(OT1, ir.BoolLiteral(True))),
    ("DIN B000 IN#(1)", ir.Assign(B0, ir.Convert("bit", IN1))),
    ("WAIT IN#(1)=OFF", ir.WaitUntil(ir.Unary("not", IN1))),
    ("TIMER T=0.50", ir.Wait(ir.RealLiteral(0.5))),
    ("WAIT T=1.00", ir.Wait(ir.RealLiteral(1.0))),
    ("PULSE OT#(1) T=0.20", ir.Pulse(OT1, ir.BoolLiteral(True), ir.RealLiteral(0.2))),
    ("AOUT AO#(2) 5.0", ir.Assign(ir.Signal("analog_out", whole(2)), ir.RealLiteral(5.0))),
    ('MSG "HELLO"', ir.Message("notify", ir.TextLiteral("HELLO"))),
    ("PAUSE IF IN#(1)=ON", ir.If(((IN1, (ir.Halt(),)),))),
    ("ABORT", ir.Halt("exit")),
    ("RET IF B000>=3", ir.If(((ir.Binary(">=", B0, whole(3)), (ir.Return(),)),))),
    ("DOUT OG#(2) B000", ir.Assign(ir.Signal("group_out", whole(9), whole(16)), B0)),
    ("DIN B000 IGH#(2)", ir.Assign(B0, ir.Signal("group_in", whole(5), whole(8)))),
    ("SPEED V=100.0", ir.Assign(ir.System("path_speed"), ir.RealLiteral(100.0))),
    ("ARCON ASF#(3)", ir.Vendor("inform", "ARCON ASF#(3)", "none")),
]


@pytest.mark.parametrize(("line", "statement"), STATEMENTS, ids=[line for line, _ in STATEMENTS])
def test_an_instruction(line: str, statement: ir.Statement) -> None:
    assert body_of(job(line)) == (statement,)


def test_conditions_join_and_before_or() -> None:
    """M: ANDEXP binds more tightly than OREXP."""
    (found,) = body_of(job("IFTHENEXP IN#(1)=ON OREXP IN#(2)=ON ANDEXP IN#(3)=OFF\nPAUSE\nENDIF"))
    assert isinstance(found, ir.If)
    condition = found.branches[0][0]
    assert isinstance(condition, ir.Binary)
    assert condition.op == "or"
    assert isinstance(condition.right, ir.Binary)
    assert condition.right.op == "and"


@pytest.mark.parametrize("words", [("IFTHENEXP", "ELSEIFEXP", "ANDEXP"), ("IFTHEN", "ELSEIF", "ANDIF")])
def test_both_spellings_of_branches(words: tuple[str, str, str]) -> None:
    first, second, join = words
    (found,) = body_of(job(f"{first} B000=1\nINC B000\n{second} B000=2 {join} B001=3\nDEC B000\nELSE\nPAUSE\nENDIF"))
    assert isinstance(found, ir.If)
    assert [len(body) for _, body in found.branches] == [1, 1]
    assert found.otherwise == (ir.Halt(),)


def test_a_bank_with_computed_numbers_is_an_array() -> None:
    program, _ = read(job("SET B001 B[I000]\nSET I001 3"))
    names = {
        declaration.name for declaration in program.modules[0].declarations if isinstance(declaration, ir.Variable)
    }
    assert names == {"B", "I000", "I001"}


def test_points_are_constants_of_their_job() -> None:
    points = "///TOOL 2\n///USER 1\n///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,1,0,0,0\nC00007=1.5,2,3,10,20,30"
    program, _ = read(job("MOVL C00007 V=12.5 PL=0", points))
    routine = program.modules[-1].routines[0]
    (point,) = routine.declarations
    assert isinstance(point, ir.Variable)
    assert (point.name, point.storage) == ("C00007", "constant")
    assert isinstance(point.initial, ir.Aggregate)
    values = {name: value.value for name, value in point.initial.entries if isinstance(value, ir.RealLiteral)}
    assert values == {"x": 1.5, "y": 2, "z": 3, "c": 10, "b": 20, "a": 30}
    flags = {name: value.value for name, value in point.initial.entries if isinstance(value, ir.IntLiteral)}
    assert flags == {"noflip": 1, "lower": 0, "rear": 0, "r180": 0, "t180": 1, "s180": 0}
    move = routine.body[-1]
    assert isinstance(move, ir.Move)
    assert (move.frame, move.tool) == (ir.Name("UF1"), ir.Name("TL2"))


@pytest.mark.parametrize(
    ("flags", "told"), [("1,0,0,0,1,0", False), ("1,0,0,0,1,0,0,0", False), ("1,0,0,0,1,0,0,1", True)]
)
def test_flags_behind_the_sixth_are_not_dropped_in_silence(flags: str, told: bool) -> None:
    """Unused on six-axis arms (DX100 data transmission manual); an arm of seven axes sets them."""
    points = f"///TOOL 2\n///POSTYPE ROBOT\n///RECTAN\n///RCONF {flags}\nC00007=1.5,2,3,10,20,30"
    _, diagnostics = read(job("MOVL C00007 V=12.5 PL=0", points))
    assert ("inform-form-of-more-axes" in [each.code.name for each in diagnostics]) is told


def test_remarks_comments_and_disabled_lines_are_kept() -> None:
    program, _ = read(job("'first\nSET B000 1  //second\nCOMM MOVJ P001\nRET"))
    notes = [
        comment.text for statement in program.modules[-1].routines[0].body for comment in statement.origin.comments
    ]
    assert notes == ["first", "second", "COMM MOVJ P001"]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("SET B000", "needs 2 operands"),
        ("JUMP ON", "label or a job"),
        ("MOVL C00001 V=10.0", "is not among the points"),
        ("SETE P001 (9) 5", "number of an element"),
        ("WAIT", "needs a condition"),
        ("SET B000 = ) 5", "did not expect"),
    ],
)
def test_a_bad_line_is_reported_with_its_place(line: str, words: str) -> None:
    program, diagnostics = read(job(f"SET B000 1\n{line}\nSET B000 2"))
    errors = [item for item in diagnostics if item.severity.word == "error"]
    assert errors
    assert any(words in item.message for item in errors)
    assert {item.origin.line for item in errors} == {12}
    kept = [type(statement).__name__ for statement in program.modules[-1].routines[0].body]
    assert kept.count("Assign") == 2


def test_an_unknown_instruction_is_kept_and_reported() -> None:
    program, diagnostics = read(job("FROBNICATE B000 5"))
    assert [item.code.name for item in diagnostics] == ["inform-unknown-instruction"]
    assert ir.Vendor("inform", "FROBNICATE B000 5", "unknown") in program.modules[-1].routines[0].body


def test_recognised_by_content() -> None:
    recognise = registry.dialect("inform").recognise
    assert recognise("a.txt", job("SET B000 1")) > 90
    assert recognise("a.jbi", "DEF prog()\nEND\n") == 0


CHAIN_POINT = "///TOOL 0\n///POSTYPE PULSE\n///PULSE\nC00000=0,0,0,0,-90000,0"


@pytest.mark.parametrize("backwards", [False, True])
def test_what_a_position_holds_is_known_through_long_chains_of_jobs_in_any_order(backwards: bool) -> None:
    """A variable that is filled element by element holds what its first value held, however many jobs lie between."""
    count = 14
    jobs = [job(f"SET P{n:03d} P{n + 1:03d}\nSETE P{n:03d} (1) 1000", name=f"J{n:02d}") for n in range(count)]
    calls = "\n".join(f"CALL JOB:J{n:02d}" for n in reversed(range(count)))
    main = job(f"MOVJ C00000 VJ=10.0\nGETS P{count:03d} $PX000\n{calls}\nMOVJ P000 VJ=10.0", CHAIN_POINT)
    assert run(main, *(reversed(jobs) if backwards else jobs), robot="ur5e").status == "finished"
    program, diagnostics = read(*jobs, main)
    assert not diagnostics.has_errors
    kinds = {
        one.name: one.type for module in program.modules for one in module.declarations if isinstance(one, ir.Variable)
    }
    assert isinstance(kinds["P000"], ir.JointsType)
