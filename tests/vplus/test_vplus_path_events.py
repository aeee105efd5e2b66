"""Actions on the path in V+: steps behind a move, waits for a place on it, steps behind the next move for corners."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
FROM, HALF, TO = (f"{{X {x},Y {y},Z 300,A 0,B 180,C 0}}" for x, y in ((400, -100), (400, 0), (480, 0)))
HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}"


def translated(body: str) -> tuple[list[str], set[str], bool]:
    """KRL statements in V+: the steps between the first and the last move home, the warnings, and whether both mean the
    same."""
    steps = f"BAS(#INITMOV,0)\n$VEL.CP=0.05\n{HOME}\nLIN {FROM}\n{body}\n{HOME}"
    text = f"DEF prog( )\nDECL INT n\n{steps}\nEND\nDEF sub( )\n$OUT[2]=TRUE\nEND\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("prog.src", text)], "krl", diagnostics)
    files = translate_program(read, "vplus", KUKA, None, diagnostics).files
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "vplus", Diagnostics())
    result = prove_programs(read.program, back.program, KUKA, KUKA, None, entry="prog", to_entry="prog")
    lines = [line.strip() for line in files[0].data.decode("ascii").split("\r\n")]
    lines = lines[: lines.index(".END")]
    start = next(at for at, line in enumerate(lines) if "400, -100" in line) + 2
    found = [line for line in lines[start:-2] if not line.startswith(("SPEED", "RIGHTY", "LEFTY", "ABOVE", "NOFLIP"))]
    return found, {item.code.name for item in diagnostics}, result.agrees


MOVES = "MOVES TRANS(400, 0, 300, 0, 180)"
ON = "DO $OUT[1]=TRUE"


@pytest.mark.parametrize(
    ("body", "steps"),
    [
        (f"TRIGGER WHEN DISTANCE=0 DELAY=0 {ON}\nLIN {HALF}", [MOVES, "SIGNAL 1", "BREAK"]),
        (f"TRIGGER WHEN DISTANCE=1 DELAY=0 {ON}\nLIN {HALF}", [MOVES, "BREAK", "SIGNAL 1"]),
        (
            f"TRIGGER WHEN PATH=-20 DELAY=0 {ON}\nLIN {HALF}",
            [MOVES, "WAIT DISTANCE(HERE, DEST) <= 20", "SIGNAL 1", "BREAK"],
        ),
        (
            f"TRIGGER WHEN PATH=30 ONSTART DELAY=0 {ON}\nLIN {HALF}",
            ["SET p1 = DEST", MOVES, "WAIT DISTANCE(HERE, DEST) <= DISTANCE(p1, DEST)-30", "SIGNAL 1", "BREAK"],
        ),
        (
            f"TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[1]=FALSE\nTRIGGER WHEN PATH=-60 DELAY=0 {ON}\nLIN {HALF}",
            [
                *(MOVES, "WAIT DISTANCE(HERE, DEST) <= 60", "SIGNAL 1"),
                *("WAIT DISTANCE(HERE, DEST) <= 20", "SIGNAL -1", "BREAK"),
            ],
        ),
    ],
)
def test_actions_come_at_their_place(body: str, steps: list[str]) -> None:
    found, codes, equal = translated(body)
    assert found == steps
    assert equal
    assert ("vplus-path-cycle" in codes) == any(step.startswith("WAIT") for step in steps)


def test_a_delay_is_counted_by_a_program_of_its_own() -> None:
    found, _, equal = translated(f"TRIGGER WHEN DISTANCE=0 DELAY=500 {ON}\nLIN {HALF}")
    assert found == [MOVES, "EXECUTE 7 rpl.later.1()", "BREAK"]
    assert equal


def test_a_time_before_the_end_is_the_way_at_the_programmed_speed() -> None:
    found, codes, equal = translated(f"TRIGGER WHEN PATH=0 DELAY=-400 {ON}\nLIN {HALF}")
    assert found == [MOVES, "WAIT DISTANCE(HERE, DEST) <= 20", "SIGNAL 1", "BREAK"]
    assert equal and "vplus-path-time" in codes


def test_what_acts_in_a_corner_stands_behind_the_next_move() -> None:
    corner = f"$APO.CDIS=5\nTRIGGER WHEN DISTANCE=1 DELAY=0 {ON}\nLIN {HALF} C_DIS\nLIN {TO}"
    found, codes, equal = translated(corner)
    next_move = "MOVES TRANS(480, 0, 300, 0, 180)"
    assert found == [MOVES, next_move, "SIGNAL 1", "BREAK"]
    assert equal and "vplus-corner-stopped" not in codes


def test_a_place_behind_a_corner_belongs_to_the_next_move() -> None:
    corner = f"$APO.CDIS=5\nTRIGGER WHEN PATH=30 DELAY=0 {ON}\nLIN {HALF} C_DIS\nLIN {TO}"
    found, _, equal = translated(corner)
    assert found[3] == "WAIT DISTANCE(HERE, DEST) <= DISTANCE(p1, DEST)-30"
    assert equal


def test_a_program_called_on_the_path_holds_the_moves() -> None:
    found, codes, _ = translated(f"TRIGGER WHEN PATH=-20 DELAY=0 DO sub( ) PRIO=-1\nLIN {HALF}")
    assert found[2] == "CALL sub()" and "vplus-path-call" in codes


SIGNALS = """/PROG  A
/ATTR
/MN
   1:J P[1] 100% FINE ;
   2:L P[2] 200mm/sec CNT50 ;
   3:  DO[1]=ON ;
   4:  R[1]=5 ;
   5:L P[3] 200mm/sec FINE ;
   6:L P[2] 200mm/sec CNT50 ;
   7:  WAIT DI[1]=ON ;
   8:L P[1] 200mm/sec FINE ;
/POS
"""
POINT = """P[{n}]{{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   {x}  mm,	Y =     {y}  mm,	Z =   300.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
}};
"""


def test_an_output_between_two_moves_with_a_corner_keeps_the_corner() -> None:
    points = [(1, 400.0, -50.0), (2, 400.0, 50.0), (3, 480.0, 50.0)]
    text = SIGNALS + "".join(POINT.format(n=n, x=x, y=y) for n, x, y in points) + "/END\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("a.ls", text)], "tp", diagnostics)
    (file,) = translate_program(read, "vplus", "fanuc_lrmate200id", None, diagnostics).files
    lines = [line.strip() for line in file.data.decode("ascii").split("\r\n")]
    lines = [line for line in lines if not line.startswith("SPEED")]
    first = lines.index("MOVES p2")
    assert lines[first + 1 : first + 5] == ["r1 = 5", "MOVES p3", "SIGNAL 1", "BREAK"]
    second = lines.index("MOVES p2", first + 1)
    assert lines[second + 1] == "BREAK"  # nobody knows how long the program waits
    assert "corner-stops-behind" in {item.code.name for item in diagnostics}


def test_a_corner_before_the_end_of_a_loop_stops_only_where_the_loop_ends() -> None:
    body = f"FOR n=1 TO 3\nLIN {HALF} C_DIS\nLIN {TO} C_DIS\nENDFOR\n$OUT[1]=TRUE\nHALT"
    found, codes, _ = translated(f"$APO.CDIS=5\n{body}")
    assert found.count("BREAK") == 1
    assert found[found.index("END") + 1 : found.index("END") + 3] == ["BREAK", "SIGNAL 1"]
    assert "vplus-corner-may-stop" in codes
