"""Interrupts that drop the present move: what was commanded behind it begins anew from where the robot then stands."""

from helpers import krl

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

VIPER = "adept_viper_s650"
START = "MOVE TRANS(400,-150,300,0,180,0)\nBREAK\nSPEED 50 MMPS ALWAYS"
SEEN = ".PROGRAM seen()\n{steps}\n.END"


def vplus(body: str, steps: str, when: float = 1.5, **more: float) -> RunResult:
    """Run V+ steps; input 1 comes at a time, and the program `seen` reacts."""
    text = f".PROGRAM test()\n{body}\n.END\n{SEEN.format(steps=steps)}\n"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("p.v2", text)], "vplus", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    cell = parse_cell(f'[[input]]\ntime = {when}\nsignal = "1001"\nvalue = true\n')
    return run_program(program, VIPER, cell, entry="test", max_time_s=30.0, **more)


def moves(result: RunResult) -> list[tuple[list[float], bool]]:
    """Where each move ended, and whether it was cut off."""
    return [
        (event.data["xyz_mm"], bool(event.data.get("interrupted"))) for event in result.trace if event.kind == "move"
    ]


def test_a_move_queued_behind_a_dropped_one_goes_on_from_there() -> None:
    ways = "MOVES TRANS(400,150,300,0,180,0)\nMOVES TRANS(450,150,300,0,180,0)\nBREAK\nSIGNAL 2"
    result = vplus(f"{START}\nREACTI 1001, seen\n{ways}", "SIGNAL 1")
    assert result.status == "finished", result.fault
    assert [name for _, name, _ in result.outputs] == ["1", "2"]
    _, cut, last = moves(result)
    assert cut[1] and -150 < cut[0][1] < 0
    assert last == ([450.0, 150.0, 300.0], False)


def test_the_reaction_may_move_before_the_queued_move() -> None:
    ways = "MOVES TRANS(400,150,300,0,180,0)\nMOVES TRANS(450,150,300,0,180,0)\nBREAK"
    result = vplus(f"{START}\nREACTI 1001, seen\n{ways}", "DEPARTS 20\nBREAK")
    assert result.status == "finished", result.fault
    _, cut, up, last = moves(result)
    assert cut[1] and abs(up[0][2] - 320.0) < 1e-3 and abs(up[0][1] - cut[0][1]) < 1e-3
    assert last == ([450.0, 150.0, 300.0], False)


def test_in_a_corner_both_moves_are_dropped() -> None:
    # The corner takes a few hundredths of a second; the input comes at its beginning, in it and behind it.
    ways = "SPEED 300 MMPS ALWAYS\nMOVES TRANS(400,0,300,0,180,0)\nMOVES TRANS(450,0,300,0,180,0)\nBREAK\nSIGNAL 2"
    end = vplus(f"{START}\nREACTI 1001, seen\n{ways}", "SIGNAL 1", when=60.0)
    assert end.status == "finished"
    first = next(event.t for event in end.trace if event.kind == "move" and not event.stops)
    for early in (-0.02, -0.005, 0.0, 0.005, 0.02):
        result = vplus(f"{START}\nREACTI 1001, seen\n{ways}", "SIGNAL 1", when=first + early)
        assert result.status == "finished", (early, result.fault)
        assert {name for _, name, _ in result.outputs} == {"1", "2"}, early


def test_a_search_that_ends_its_move_lets_the_next_one_begin_there() -> None:
    body = "MOVES TRANS(400,150,300,0,180,0)\nMOVES TRANS(400,-100,300,0,180,0)\nBREAK\nSIGNAL 2"
    result = vplus(f"{START}\nREACTI 1001, seen, 5\n{body}", "IGNORE 1001\nSET there = HERE\nSIGNAL 1")
    assert result.status == "finished", result.fault
    assert moves(result)[-1] == ([400.0, -100.0, 300.0], False)


def test_a_motion_braked_in_an_interrupt_still_goes_on() -> None:
    cell = "[[input]]\ntime = 0.7\nsignal = '$IN[1]'\nvalue = true\n"
    armed = "INTERRUPT DECL 5 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 5\n$VEL.CP=0.05\n"
    body = f"{armed}PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}\nLIN_REL {{Z 60}}\n$OUT[2]=TRUE"
    result = krl(body, more="DEF HIT( )\nBRAKE\n$OUT[1]=TRUE\nEND", robot="kuka_kr6r900sixx", cell=cell)
    assert result.status == "finished", result.fault
    assert [name for _, name, _ in result.outputs] == ["$OUT[1]", "$OUT[2]"]
