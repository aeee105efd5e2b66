"""Interrupts of other languages as jobs: one that only calculates is a job beside, one that stops the robot ends its
moves by UNTIL. Each program sets an output per expectation."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.cell import read_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
SUFFIXES = {"tp": "ls", "krl": "src", "rapid": "mod", "vplus": "v2"}


def outputs_of(
    language: str, text: str, tmp_path: Path, inputs: dict[float, tuple[int, bool]]
) -> tuple[set[int], Diagnostics, str]:
    """Outputs that are on at the end of the run as jobs, the report, and the text of all jobs."""
    diagnostics = Diagnostics()
    robot = "fanuc_lrmate200id" if language == "tp" else ROBOT
    read = read_sources([source_from_text(f"one.{SUFFIXES[language]}", text)], language, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    translation = translate_program(read, "inform", robot, None, diagnostics)
    again = Diagnostics()
    jobs = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(jobs, "inform", again)
    assert not again.has_errors, [item.as_text() for item in again]
    cell = tmp_path / "cell.toml"
    lines = [
        f'[[input]]\ntime = {time}\nsignal = "IN#({number})"\nvalue = {str(on).lower()}\n'
        for time, (number, on) in inputs.items()
    ]
    cell.write_text("\n".join(lines), "utf-8")
    run = run_program(back.program, robot, read_cell(str(cell)), "ONE", 60.0)
    assert run.status == "finished", run.fault
    state: dict[int, bool] = {}
    for _, name, value in run.outputs:
        state[int(str(name).partition("(")[2].rstrip(")"))] = bool(value)
    whole = "".join(file.data.decode("ascii") for file in translation.files if file.path.endswith(".JBI"))
    return {number for number, on in state.items() if on}, diagnostics, whole


START = "PTP {A1 0, A2 -90, A3 90, A4 0, A5 60, A6 0}\nLIN {X 450, Y 0, Z 600, A 0, B 90, C 0}\n"
COUNTING = f"""DEF one()
DECL INT I
INTERRUPT DECL 5 WHEN $IN[1]==TRUE DO seen()
{START}$VEL.CP = 0.05
INTERRUPT ON 5
LIN {{X 450, Y 150, Z 600, A 0, B 90, C 0}}
WAIT SEC 2
INTERRUPT OFF 5
WAIT SEC 2
$OUT[2] = ($POS_ACT.Y > 149.9)
END
DEF seen()
IF $OUT[11] THEN
  $OUT[12] = TRUE
ENDIF
$OUT[11] = TRUE
END
"""


def test_an_interrupt_that_takes_no_time_is_a_job_beside(tmp_path: Path) -> None:
    """It comes with each rise of the signal while it is on, and the move goes on."""
    twice = {2.0: (1, True), 2.5: (1, False), 3.0: (1, True), 3.5: (1, False), 8.5: (1, True)}
    on, diagnostics, text = outputs_of("krl", COUNTING, tmp_path, twice)
    assert on == {2, 11, 12} and not diagnostics.of(Severity.LOSS)
    assert "interrupt-watched" in {item.code.name for item in diagnostics.of(Severity.WARNING)}
    assert "PSTART JOB:RPL_INTERRUPT_5 SUB1" in text
    once = {2.0: (1, True), 2.5: (1, False), 8.5: (1, True)}
    assert outputs_of("krl", COUNTING, tmp_path, once)[0] == {2, 11}


LEAVING = f"""DEF one()
{START}INTERRUPT DECL 7 WHEN $IN[1]==TRUE DO found()
$VEL.CP = 0.05
search()
$OUT[1] = ($POS_ACT.Y > 10) AND ($POS_ACT.Y < 140)
LIN {{X 450, Y 0, Z 600, A 0, B 90, C 0}}
$OUT[2] = (ABS($POS_ACT.Y) < 0.1)
END
DEF search()
INTERRUPT ON 7
LIN {{X 450, Y 150, Z 600, A 0, B 90, C 0}}
WAIT SEC 0
INTERRUPT OFF 7
$OUT[3] = TRUE
END
DEF found()
INTERRUPT OFF 7
$OUT[4] = TRUE
BRAKE
RESUME
END
"""


def test_an_interrupt_that_leaves_its_level_ends_the_move(tmp_path: Path) -> None:
    on, diagnostics, text = outputs_of("krl", LEAVING, tmp_path, {2.5: (1, True)})
    assert on == {1, 2, 4} and not diagnostics.of(Severity.LOSS)
    assert "UNTIL IN#(1)=ON" in text
    assert outputs_of("krl", LEAVING, tmp_path, {59.0: (1, True)})[0] == {2, 3}


TIMED = """MODULE One
  VAR intnum beat;
  VAR num beats := 0;
  PROC main()
    CONNECT beat WITH tick;
    ITimer 0.2, beat;
    WaitTime 1.1;
    IDelete beat;
    WaitTime 0.5;
    IF beats = 5 SetDO do1, 1;
  ENDPROC
  TRAP tick
    beats := beats + 1;
  ENDTRAP
ENDMODULE
"""


def test_an_interrupt_by_time(tmp_path: Path) -> None:
    on, diagnostics, _ = outputs_of("rapid", TIMED.replace("main()", "one()"), tmp_path, {})
    assert on == {1} and not diagnostics.of(Severity.LOSS)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("BRAKE\nRESUME", "WAIT SEC 1", id="it takes time and the robot moves on"),
        pytest.param("BRAKE\nRESUME", "BRAKE", id="the move would have to go on from its middle"),
        pytest.param("$IN[1]==TRUE", "$IN[1] AND $IN[2]", id="a move ends at one input"),
    ],
)
def test_other_interrupts_are_refused_by_name(old: str, new: str, tmp_path: Path) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("one.src", LEAVING.replace(old, new))], "krl", diagnostics)
    translate_program(read, "inform", ROBOT, None, diagnostics)
    lost = [(item.code.name, item.origin.line) for item in diagnostics.of(Severity.LOSS)]
    assert lost == [("interrupt-not-watched", 4)]  # not at what switches it on and off


def test_arguments_of_a_job_beside_are_variables(tmp_path: Path) -> None:
    text = """.PROGRAM one()
        EXECUTE 2 beat(3)
        WAIT done
        IF beats == 3 THEN
            SIGNAL 1
        END
.END
.PROGRAM beat(count)
        AUTO i
        FOR i = 1 TO count
            beats = beats+1
        END
        done = TRUE
.END
"""
    on, diagnostics, _ = outputs_of("vplus", "\n".join(text.splitlines()), tmp_path, {})
    assert on == {1} and not diagnostics.of(Severity.LOSS)


AT_ONCE = f"""DEF one()
{START}INTERRUPT DECL 5 WHEN $OUT[20]==TRUE DO seen()
FIRST
INTERRUPT ON 5
THEN
WAIT SEC 0.5
END
DEF seen()
$OUT[11] = TRUE
END
"""


@pytest.mark.parametrize(
    ("first", "then", "comes"),
    [
        ("$OUT[20] = FALSE", "$OUT[20] = TRUE", True),  # in the very moment in which the interrupt is turned on
        ("$OUT[20] = TRUE", "WAIT SEC 0.5", False),  # it held before: no rise
        ("$OUT[20] = TRUE", "WAIT SEC 0.5\n$OUT[20] = FALSE\nWAIT SEC 0.1\n$OUT[20] = TRUE", True),
        ("$OUT[20] = TRUE", "INTERRUPT OFF 5\n$OUT[20] = FALSE\nINTERRUPT ON 5\n$OUT[20] = TRUE", True),
    ],
)
def test_what_comes_as_soon_as_the_interrupt_is_on_is_seen(tmp_path: Path, first: str, then: str, comes: bool) -> None:
    on, diagnostics, _ = outputs_of("krl", AT_ONCE.replace("FIRST", first).replace("THEN", then), tmp_path, {})
    assert not diagnostics.of(Severity.LOSS)
    assert (11 in on) == comes


LATE = """/PROG  ONE
/ATTR
/MN
   1:  J P[1] 100% FINE ;
   2:  L P[2] 100mm/sec FINE TA    .30sec,DO[5]=ON ;
   3:  R[1]=DO[5] ;
   4:  DO[1]=(R[1]=0) ;
   5:  WAIT    .50(sec) ;
   6:  R[1]=DO[5] ;
   7:  DO[2]=(R[1]=1) ;
/POS
P[1]{
   GP1:
    UF : 0, UT : 1,
    J1= 0 deg, J2= 0 deg, J3= 0 deg, J4= 0 deg, J5= -60 deg, J6= 0 deg
};
P[2]{
   GP1:
    UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',
    X = 450.0 mm, Y = 80.0 mm, Z = 300.0 mm, W = 180.0 deg, P = 0.0 deg, R = 0.0 deg
};
/END
"""


def test_what_comes_a_time_behind_the_end_of_a_move_is_a_job_beside(tmp_path: Path) -> None:
    on, diagnostics, text = outputs_of("tp", LATE, tmp_path, {})
    assert on == {1, 2, 5} and not diagnostics.of(Severity.LOSS)
    assert "PSTART JOB:RPL_ON_PATH" in text and "TIMER T=0.30\r\nDOUT OT#(5) ON" in text
