"""How long the robot stands is compared between controllers, so that a wait that ends by its time-out is."""

from dataclasses import replace

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.proof.record import Happening, Place, signal_names
from rpl.source import source_from_text

ROBOT = "kuka_kr6r900sixx"
RAPID = """MODULE part
  VAR bool late;
  PROC main()
    MoveAbsJ [[0,-90,90,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
    WaitDI di1,1\\MaxTime:=2\\TimeFlag:=late;
    SetDO do1,1;
    MoveAbsJ [[10,-90,90,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
    WaitTime 0.5;
    MoveAbsJ [[0,-90,90,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
KRL = """DEF part()
$VEL_AXIS[1]=100
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
$TIMER[1]=-2000
$TIMER_STOP[1]=FALSE
WAIT FOR $IN[1] OR $TIMER_FLAG[1]
$OUT[1]=TRUE
PTP {A1 10,A2 -90,A3 90,A4 0,A5 45,A6 0}
WAIT SEC 0.5
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
END
"""


def proved(a: str, b: str) -> ProofResult:
    programs = []
    for text, language, name in ((a, "rapid", "part.mod"), (b, "krl", "part.src")):
        diagnostics = Diagnostics()
        programs.append(read_sources([source_from_text(name, text)], language, diagnostics).program)
        assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return prove_programs(programs[0], programs[1], ROBOT)


def waits(result: ProofResult) -> list[float]:
    return [round(one.amount, 1) for one in result.deviations if one.kind == "wait"]


def test_the_same_time_out_is_the_same() -> None:
    result = proved(RAPID, KRL)
    assert result.agrees and waits(result) == [], result.as_text()


@pytest.mark.parametrize(
    ("old", "new", "amounts"),
    [
        ("MaxTime:=2", "MaxTime:=2.4", [0.4]),
        ("    WaitDI di1,1\\MaxTime:=2\\TimeFlag:=late;\n    SetDO do1,1;", "    SetDO do1,1;", [2.0]),
    ],
)
def test_another_time_out_is_told(old: str, new: str, amounts: list[float]) -> None:
    assert old in RAPID
    result = proved(RAPID.replace(old, new), KRL)
    assert result.verdict == "alike" and waits(result) == amounts, result.as_text()


def test_a_wait_at_another_move_is_told() -> None:
    wait, move = RAPID.splitlines(keepends=True)[7:9]
    assert "WaitTime" in wait and "MoveAbsJ" in move
    result = proved(RAPID.replace(wait + move, move + wait), KRL)
    assert result.agrees and 0.5 in waits(result), result.as_text()


def test_what_an_input_ends_has_no_length_of_its_own() -> None:
    from rpl.cell import Cell, Input

    cell = Cell(inputs=(Input(1.5, "di1", True),))
    programs = [
        read_sources([source_from_text(name, text)], language, Diagnostics()).program
        for text, language, name in ((RAPID, "rapid", "part.mod"), (KRL, "krl", "part.src"))
    ]
    result = prove_programs(programs[0], programs[1], ROBOT, cell=cell)
    assert result.agrees and waits(result) == [], result.as_text()


def test_two_outputs_are_never_one() -> None:
    from rpl.proof.events import crossed_difference
    from rpl.proof.tolerance import Tolerance

    def switched(number: int, *names: str) -> Happening:
        return Happening("output", 1.0, True, signal_names("digital_out", names, number), Place("a", number, "x"))

    ours = (switched(1, "grip"), switched(2, "lamp"))
    swapped = (switched(11, "grip"), switched(12, "lamp"))
    one = (switched(11, "grip", "lamp"), switched(11, "grip", "lamp"))
    assert crossed_difference([("main", ours, swapped)], Tolerance(), True) is None
    found = crossed_difference([("main", ours, one)], Tolerance(), True)
    assert found is not None and found.kind == "output" and "two of the other" in found.explanation
    back = crossed_difference([("main", one, ours)], Tolerance(), True)
    assert back is not None


def test_helpers_and_delayed_outputs_give_no_moment() -> None:
    from rpl.proof.findings import Findings
    from rpl.proof.motion import Driven
    from rpl.proof.record import Record
    from rpl.proof.standing import compare_standing
    from rpl.proof.tolerance import Tolerance

    out = Happening("output", 1.0, True, signal_names("digital_out", [], 3), Place("a", 1, "x"))
    for other in (replace(out, t=2.0, helper=True), replace(out, t=2.0, timed=("pulse", 1.0)), replace(out, t=2.0)):
        found = Findings()
        records = Record("finished", 3.0, {"main": (out,)}, {}), Record("finished", 3.0, {"main": (other,)}, {})
        compare_standing(records, [("main", (out,), (other,))], {"main": Driven(())}, Tolerance(), found)
        assert bool(found.deviations) == (not other.helper and other.timed is None)
