"""Moves that are joined by a switch (V+ CPON) in a language whose moves say so themselves."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 {first}
 MOVE #PPOINT(0,-45,180,0,45,0)
 MOVE #PPOINT(10,-45,180,0,45,0)
 BREAK
.END
"""


@pytest.mark.parametrize(
    ("first", "moves"),
    [
        ("CPON ALWAYS", 2),
        ("FINE 50 ALWAYS", 2),
        ("ACCEL 80, 80", 2),
        ("CPOFF ALWAYS", 2),
        ("IF SIG(1001) THEN\nCPOFF ALWAYS\nEND", 4),
    ],
)
def test_a_switch_that_says_the_usual_is_no_loss(first: str, moves: int) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", PROGRAM.format(first=first))], "vplus", diagnostics)
    files = translate_program(read, "rapid", "adept_viper_s650", None, diagnostics).files
    assert not diagnostics.of(Severity.LOSS)
    text = "".join(file.data.decode() for file in files)
    assert text.count("MoveAbsJ") == moves


LINES = """.PROGRAM off()
 CPOFF ALWAYS
.END
.PROGRAM on()
 CPON ALWAYS
.END
.PROGRAM main()
 n = 0
 SPEED 100 MMPS ALWAYS
 {first}
 MOVES TRANS(330,50,260,0,180,0)
 MOVES TRANS(330,90,260,0,180,0)
 {between}
 MOVES TRANS(330,130,260,0,180,0)
 MOVES TRANS(330,130,300,0,180,0)
 BREAK
.END
"""
STOPS = {
    "krl": "LIN {X 330,Y {y},Z 260,A 180,B 0,C 180}",
    "urscript": "movel(p[0.33, {m}, 0.26, 0, 3.141592654, 0], a=0.5, v=0.1)",
}


@pytest.mark.parametrize("target", STOPS)
@pytest.mark.parametrize(
    ("first", "between", "stops"),
    [
        ("CPON ALWAYS", "", []),
        ("CPOFF", "", [50]),
        ("", "CPON ALWAYS", []),
        ("CPOFF", "CPOFF", [50, 130]),
        ("CPOFF ALWAYS", "CPON", [50, 90]),
        ("CPOFF ALWAYS", "CPON ALWAYS", [50, 90]),
        ("", "CPOFF ALWAYS", [130]),
        ("CALL off()", "CALL on()", [50, 90]),
        ('CALLS "of"+$CHR(102)', 'CALLS "on"', [50, 90]),
        ("10 n = n+1\nIF n < 3 GOTO 10\nCPOFF ALWAYS", "CPON ALWAYS", [50, 90]),
        (
            "FOR i = 1 TO 2\nCPOFF ALWAYS\nEND\nCPOFF ALWAYS",
            "IF n > 1 THEN\nCPON ALWAYS\nELSE\nCPON ALWAYS\nEND",
            [50, 90],
        ),
    ],
)
def test_each_move_says_whether_it_is_joined(first: str, between: str, stops: list[int], target: str) -> None:
    diagnostics = Diagnostics()
    text = LINES.format(first=first, between=between)
    read = read_sources([source_from_text("p.v2", text)], "vplus", diagnostics)
    files = translate_program(read, target, None, None, diagnostics).files
    assert not diagnostics.of(Severity.LOSS)
    lines = [line.strip() for file in files for line in file.data.decode().splitlines()]
    form = STOPS[target]
    found = [y for y in (50, 90, 130) if form.replace("{y}", str(y)).replace("{m}", f"{y / 1000:g}") in lines]
    assert found == stops


@pytest.mark.parametrize(("between", "warned"), [("", 1), ("BREAK", 0)])
def test_a_way_from_where_the_robot_is_begins_where_it_stands(between: str, warned: int) -> None:
    diagnostics = Diagnostics()
    lines = f".PROGRAM main()\n MOVE #PPOINT(10,-80,170,0,60,0)\n {between}\n DRIVE 1, 15, 50\n BREAK\n HERE #p\n"
    text = lines + " DECOMPOSE v[1] = #p\n IF ABS(v[1]-25) < 0.02 THEN\n SIGNAL 1\n END\n.END\n"
    read = read_sources([source_from_text("p.v2", text)], "vplus", diagnostics)
    files = translate_program(read, "inform", "adept_viper_s650", None, diagnostics).files
    assert [one.code.name for one in diagnostics.of(Severity.WARNING)].count("relative-move-stands") == warned
    back = read_sources([source_from_bytes(file.path, file.data) for file in files], "inform", Diagnostics())
    result = run_program(back.program, "adept_viper_s650", entry="MAIN")
    assert [value for _, _, value in result.outputs] == [True]


ZIGZAG = """.PROGRAM main()
 MOVE TRANS(330,0,260,0,180,0)
 CALL zigzag(t1)
 CPOFF ALWAYS
 CALL zigzag(t2)
 CPON ALWAYS
 IF t1 < t2-0.05 THEN
 SIGNAL 1
 END
.END
.PROGRAM zigzag(secs)
 BREAK
 SPEED 300 MMPS ALWAYS
 TIMER 1 = 0
 FOR i = 1 TO 4
 MOVES TRANS(330,40*i-20,290,0,180,0)
 MOVES TRANS(330,40*i,260,0,180,0)
 END
 BREAK
 secs = TIMER(1)
.END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript"])
def test_a_routine_that_is_called_either_way_asks_for_it(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", ZIGZAG)], "vplus", diagnostics)
    done = translate_program(read, target, "adept_viper_s650", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], target, Diagnostics())
    entry = done.renamed.get("main", "main")
    for program, start in ((read.program, "main"), (back.program, entry)):
        result = run_program(program, "adept_viper_s650", entry=start)
        assert result.fault is None and [value for _, _, value in result.outputs] == [True]
