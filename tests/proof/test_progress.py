"""Inputs come to two programs where they are equally far, not at one moment on the clock."""

from __future__ import annotations

import math

import pytest

from rpl import ir
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_sources
from rpl.proof.explore import Budget, explore
from rpl.proof.progress import Progress, moment, progress_of
from rpl.proof.prove import prove_programs
from rpl.proof.watched import side_of
from rpl.proof.wiring import in_words_of
from rpl.simulation import run_program
from rpl.source import source_from_bytes

ROBOT = load_robot("kuka_kr6r900sixx")
POINT = "[[{x},{y},500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
HOME = "MoveAbsJ [[0,-90,90,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;"
SIDE, CENTRE = (f"MoveL {POINT.format(x=500, y=y)},{{v}},fine,tool0;" for y in (200, -200))


def rapid(*lines: str, more: tuple[str, ...] = ()) -> ir.Program:
    text = "\n".join(("MODULE Job", "PROC main()", *lines, "ENDPROC", *more, "ENDMODULE", ""))
    return read_sources([source_from_bytes("job.mod", text.encode())], "rapid", Diagnostics()).program


def krl(*lines: str, more: tuple[str, ...] = ()) -> ir.Program:
    text = "\n".join(("DEF JOB( )", "$TOOL=$NULLFRAME", "$BASE=$NULLFRAME", *lines, "END", *more, ""))
    return read_sources([source_from_bytes("job.src", text.encode())], "krl", Diagnostics()).program


def driven(*lines: str, cell: str = "") -> Progress:
    program = rapid(*lines)
    result = run_program(program, ROBOT, parse_cell(cell), controller="plain")
    found = progress_of(result, program)
    assert result.status == "finished" and found is not None
    return found


def moves(speed: str, *behind: str) -> tuple[str, ...]:
    return (HOME, SIDE.format(v=speed), CENTRE.format(v=speed), *behind)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_on_the_way_it_is_the_same_place(share: float) -> None:
    slow, fast = driven(*moves("v50")), driven(*moves("v100"))
    begin, end = slow.stops[2].begin, slow.stops[3].begin
    time_s = begin + share * (end - begin)
    there = moment(time_s, slow, fast)
    assert there < time_s - 1.0
    places = slow.way.at(time_s)[2], fast.way.at(there)[2]
    assert places[0] is not None and places[0] == pytest.approx(places[1], abs=1e-3)


def test_at_a_stop_it_is_as_long_after_the_robot_has_come_there() -> None:
    slow, fast = (driven(*moves(speed, "WaitTime 3;", HOME)) for speed in ("v50", "v100"))
    a, b = slow.stops[3], fast.stops[3]
    assert a.end - a.begin == pytest.approx(3.0)
    assert moment(a.begin + 1.25, slow, fast) == pytest.approx(b.begin + 1.25)


def test_where_the_other_does_not_stop_it_is_as_long_after_it_passes() -> None:
    waits = driven(HOME, SIDE.format(v="v50"), "WaitTime 2;", CENTRE.format(v="v50"))
    passes = driven(HOME, CENTRE.format(v="v50"))
    stop = waits.stops[2]
    assert moment(stop.begin + 0.5, waits, passes) > passes.stops[1].end


def test_without_a_robot_nothing_is_moved() -> None:
    program = rapid("Set do1;")
    assert progress_of(run_program(program, None), program) is None


TRAP = ("VAR intnum i1;", "CONNECT i1 WITH tr;", "ISignalDI di1,1,i1;")
COUNTS = ("TRAP tr", "Set do2;", "ENDTRAP")
SLOW = rapid(*TRAP, *moves("v50"), more=COUNTS)
KRL_TRAP = ("GLOBAL INTERRUPT DECL 3 WHEN $IN[1] DO HIT( )", "INTERRUPT ON 3", "$VEL.CP=0.2")
PTP_HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}"
KRL_MOVES = tuple(f"LIN {{X 500,Y {y},Z 500,A 180,B 0,C 180}}" for y in (200, -200))
FAST = krl(*KRL_TRAP, PTP_HOME, *KRL_MOVES, more=("GLOBAL DEF HIT( )", "$OUT[2]=TRUE", "END"))


def test_an_input_that_the_exploration_gives_meets_both_at_one_place() -> None:
    """One program drives four times as fast: at one moment the input would come beside another move of it."""
    sides = (
        side_of(SLOW, ROBOT, controller="plain"),
        side_of(FAST, ROBOT, controller="plain", words=lambda cell: in_words_of(cell, SLOW, FAST)),
    )
    found = explore(sides)
    pairs = [
        (one.time_s, other.time_s)
        for cell, there in zip(found.cells, found.others, strict=True)
        for one, other in zip(cell.inputs, there.inputs, strict=True)
        if one.time_s > 0.0
    ]
    assert pairs and all(there < here for here, there in pairs)
    result = prove_programs(SLOW, FAST, ROBOT, ROBOT, budget=Budget(seconds=math.inf))
    assert result.verdict == "alike" and "place" not in [one.kind for one in result.open]


def test_an_output_at_another_place_is_still_told() -> None:
    late = krl(*KRL_TRAP, PTP_HOME, *KRL_MOVES, more=("GLOBAL DEF HIT( )", "WAIT SEC 1", "$OUT[2]=TRUE", "END"))
    result = prove_programs(SLOW, late, ROBOT, ROBOT, budget=Budget(seconds=math.inf))
    assert result.verdict == "different"
