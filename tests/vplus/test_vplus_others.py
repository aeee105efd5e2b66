"""Moves, signals and tasks of other languages in V+: both programs must mean the same."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}"


POWERS = (
    "abs(power(b, e) - 3) < 0.0001",
    "abs(power(b, -e) - 1 / 3) < 0.0001",
    "abs(power(b, e + 2) - 2187) < 0.01",
    "abs(power(b, 2 * e - 2.5) - 0.00237) < 0.00001",
    "power(2, 3 * e) = 2",
)


def proved(text: str, name: str, dialect: str, robot: str | None, entry: str) -> tuple[list[str], str]:
    """The lines in V+, and what the proof says that is not equal."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    files = translate_program(read, "vplus", robot, None, diagnostics).files
    assert not [item.as_text() for item in diagnostics if item.severity.word in ("error", "loss")]
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "vplus", Diagnostics())
    result = prove_programs(read.program, back.program, robot, robot, None, entry=entry, to_entry=entry)
    lines = [line.strip() for line in files[0].data.decode("ascii").split("\r\n")]
    return lines, "" if result.agrees else result.as_text()


@pytest.mark.parametrize(
    "move",
    [
        "LIN_REL {X 10,Y 0,Z 20,A 10,B 5,C -5}",
        "PTP_REL {A1 5,A3 -3}",
        "$BASE={X 100,Y 0,Z 0,A 30,B 0,C 0}\nLIN_REL {X 10,Y 20,Z 0,A 0,B 10,C 0}",
        "STEP={X 10,Y -20,Z 5,A 3,B 0,C 8}\nLIN_REL STEP",
        "LIN_REL {X 10,Y 0,Z 20,A 10,B 5,C -5} #TOOL",
    ],
)
def test_relative_moves(move: str) -> None:
    text = f"DEF prog( )\nDECL FRAME STEP\n{HOME}\n{move}\n$OUT[1]=($AXIS_ACT.A1 > -90)\nEND\n"
    _, difference = proved(text, "prog.src", "krl", KUKA, "prog")
    assert not difference


def test_a_pulse_with_the_opposite_of_the_present_level() -> None:
    body = "Set do1;\nPulseDO\\PLength:=0.3,do1;\nWaitTime 1;\nPulseDO\\PLength:=0.3,do2;\nWaitTime 1;"
    lines, difference = proved(f"MODULE m\nPROC main()\n{body}\nENDPROC\nENDMODULE\n", "m.mod", "rapid", None, "main")
    assert "IF NOT SIG(1) THEN" in lines
    assert not difference


def test_the_end_of_a_task_is_waited_for_by_a_flag() -> None:
    text = """VAR n: INT = 0
PROCEDURE main()
    START TASK work
    JOIN TASK work
    SET do[1] TO n = 3
END PROCEDURE
PROCEDURE work()
    WAIT 0.5 s
    n = 3
    IF n = 3 THEN RETURN
    n = 4
END PROCEDURE
"""
    lines, difference = proved(text, "p.rpl", "rpl", None, "main")
    start = lines.index("EXECUTE 1 work()")
    assert lines[start - 1 : start + 2] == ["work_runs = TRUE", "EXECUTE 1 work()", "WAIT NOT work_runs"]
    assert lines.count("work_runs = FALSE") == 2
    assert not difference


def test_looking_and_setting_in_one_is_one_step() -> None:
    text = """.PROGRAM p()
        lock = 0
        EXECUTE 1 side()
        n = TAS(lock, 1)
        IF n == 0 THEN
            SIGNAL 1
        END
.END
.PROGRAM side()
        lock = lock+1
.END
"""
    lines, difference = proved(text, "p.v2", "vplus", None, "p")
    assert [line.partition(" = ")[2] for line in lines if "TAS(" in line] == ["TAS(lock, 1)"]
    assert not difference


def test_powers_that_are_not_whole() -> None:
    body = "\n".join(f"SET do[{n}] TO {test}" for n, test in enumerate(POWERS, 1))
    text = f"VAR b: REAL = 27\nVAR e: REAL = 1.5\nPROCEDURE main()\ne = e / 4.5\n{body}\nEND PROCEDURE\n"
    lines, difference = proved(text, "p.rpl", "rpl", None, "main")
    assert not difference
    assert "PAUSE" not in lines


def test_a_variable_that_nothing_is_stored_into_begins_with_zero() -> None:
    text = "MODULE m\nPROC main()\nVAR num n;\nIF n=0 Set do1;\nENDPROC\nENDMODULE\n"
    _, difference = proved(text, "m.mod", "rapid", None, "main")
    assert not difference


def test_a_condition_that_is_no_signal_is_watched_by_a_task() -> None:
    text = """MODULE m
VAR intnum iBeat;
VAR num n:=0;
PROC main()
  CONNECT iBeat WITH beat;
  ITimer 0.2,iBeat;
  WaitTime 1.1;
  IDelete iBeat;
  WaitTime 0.5;
  IF n=5 Set do1;
ENDPROC
TRAP beat
  Incr n;
ENDTRAP
ENDMODULE
"""
    lines, difference = proved(text, "m.mod", "rapid", None, "main")
    start = lines.index("EXECUTE /C 7 rpl.watch.1()")
    assert lines[start + 1].startswith("REACT 2008, beat_timer")
    assert lines[lines.index(".PROGRAM rpl.watch.1()") + 4 :][:2] == ["WAIT NOT (TIMER(15) > 0)", "SIGNAL -2008"]
    assert not difference


COUNTED = """DEF count()
DECL INT i
INTERRUPT DECL 12 WHEN {condition} DO note()
n=0
$FLAG[5]=FALSE
$FLAG[8]=FALSE
INTERRUPT ON 12
FOR i=1 TO 3
  $FLAG[5]=TRUE
  WAIT SEC 0.2
  $FLAG[5]=FALSE
  WAIT SEC 0.2
ENDFOR
INTERRUPT OFF 12
$FLAG[5]=TRUE
WAIT SEC 0.2
IF n==3 THEN
  $OUT[1]=TRUE
ENDIF
END
DEF note()
n=n+1
END
"""


@pytest.mark.parametrize("condition", ["$FLAG[5]==TRUE", "$FLAG[5]", "$FLAG[5] AND NOT $FLAG[8]"])
def test_what_comes_right_behind_the_arming_of_a_reaction_counts(condition: str) -> None:
    data = source_from_text("count.dat", "DEFDAT count\nDECL INT n=0\nENDDAT\n")
    program = source_from_text("count.src", COUNTED.format(condition=condition))
    read = read_sources([program, data], "krl", Diagnostics())
    files = translate_program(read, "vplus", "kuka_kr6r900sixx", None, Diagnostics()).files
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "vplus", Diagnostics())
    result = run_program(back.program, "kuka_kr6r900sixx", None, "count", 10.0)
    assert [(name, value) for _, name, value in result.outputs if name == "1"] == [("1", True)]


def test_one_joint_is_changed_in_a_step_of_its_own() -> None:
    text = "def prog():\n  q = get_actual_joint_positions()\n  q[0] = q[0] + d2r(8)\n  movej(q)\nend\n"
    lines, difference = proved(text, "p.script", "urscript", "ur5e", "prog")
    assert "SET #q = #PPOINT(part1[0], part1[1], part1[2], part1[3], part1[4], part1[5])" in lines
    assert not difference


def test_registers_that_are_filled_in_parts_begin_somewhere() -> None:
    rows = ("PR[2,3]=5", "R[1]=PR[2,3]", "R[2]=3", "PR[R[2],1]=4", "R[3]=PR[3,1]", "DO[1]=(R[1]=5 AND R[3]=4)")
    body = "".join(f"{at:4}:  {row} ;\n" for at, row in enumerate(rows, 1))
    text = f"/PROG  PROG\n/ATTR\n/MN\n{body}/POS\n/END\n"
    lines, difference = proved(text, "prog.ls", "tp", "fanuc_lrmate200id", "prog")
    assert "pr[3] 0 0 0 0 0 0" in lines
    assert not difference


def test_joints_that_are_filled_in_parts_begin_somewhere() -> None:
    text = "DEF prog( )\nDECL E6AXIS J\nDECL FRAME F\nJ.A2=-90\nF.A=20\n$OUT[1]=J.A2==-90 AND F.A>19\nEND\n"
    lines, difference = proved(text, "prog.src", "krl", KUKA, "prog")
    assert "SET #j = #PPOINT(0, 0, 0, 0, 0, 0)" in lines
    assert not difference
