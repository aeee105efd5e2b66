"""Interrupts that stop the robot and are never armed together: each ends the moves of its own part of the program; a
search that leaves its level is used twice and through two calls."""

import pytest
from there_and_back import entry_of

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.record import signal_names
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
PLACE = "X 450,Y {y},Z {z},A 0,B 180,C 0"
PROGRAM = f"""DEF one()
INTERRUPT DECL 21 WHEN CURTAIN==TRUE DO curtainhit()
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
FOUND=0
findtop()
$OUT[1]=(FOUND==1) AND (TOPZ>320) AND (TOPZ<390)
findtop()
$OUT[2]=(FOUND==2) AND (TOPZ>320) AND (TOPZ<390)
$OUT[3]=(AFTER==2)
across()
INTERRUPT OFF 21
$OUT[4]=(HITS==1) AND ($POS_ACT.Y>3) AND ($POS_ACT.Y<90)
END
DEF across()
INTERRUPT ON 21
$OUT[31]=TRUE
$VEL.CP=0.1
LIN {{{PLACE.format(y=100, z=350)}}}
WAIT SEC 0
END
DEF findtop()
INTERRUPT DECL 20 WHEN TOUCH==TRUE DO touched()
PTP {{{PLACE.format(y=0, z=400)},S 2,T 2}}
lower()
$OUT[30]=FALSE
AFTER=AFTER+1
WAIT SEC 0.3
END
DEF lower()
search()
FOUND=-10
END
DEF search()
INTERRUPT ON 20
$OUT[30]=TRUE
$VEL.CP=0.05
LIN {{{PLACE.format(y=0, z=300)}}}
WAIT SEC 0
INTERRUPT OFF 20
END
DEF touched()
INTERRUPT OFF 20
BRAKE
TOPZ=$POS_ACT.Z
FOUND=FOUND+1
RESUME
END
DEF curtainhit()
HITS=HITS+1
BRAKE
WAIT SEC 0.2
RESUME
END
"""
DATA = "DEFDAT one\nSIGNAL CURTAIN $IN[7]\nSIGNAL TOUCH $IN[6]\n"
DATA += "INT FOUND=0\nINT HITS=0\nINT AFTER=0\nREAL TOPZ=0\nENDDAT\n"
CELL = "\n".join(
    f'[[reaction]]\nwhen = "$OUT[{output}]"\nbecomes = {value}\n'
    f'after = {after}\nsignal = "$IN[{number}]"\nvalue = {value}'
    for output, number, time in ((30, 6, 0.5), (31, 7, 0.3))
    for value, after in (("true", time), ("false", 0.05))
)


@pytest.mark.parametrize("target", [None, "krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_each_stops_its_own_moves(target: str | None) -> None:
    sources = [source_from_text("one.src", PROGRAM), source_from_text("one.dat", DATA)]
    read, cell = read_sources(sources, "krl", Diagnostics()), parse_cell(CELL)
    program, entry = read.program, "ONE"
    if target is not None:
        translation = translate_program(read, target, ROBOT)
        assert [item.as_text() for item in translation.losses] == []
        back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
        program = with_signal_names(back.program, translation.program)
        cell = in_words_of(cell, read.program, program)
        entry = entry_of(translation, "ONE")
    run = run_program(program, ROBOT, cell, entry, 60.0)
    assert run.status == "finished", run.fault
    state: dict[str, bool] = {}
    for event in run.trace:
        if event.kind == "output":
            kind, index, last, _ = event.port or (None, None, None, None)
            known = [str(name) for name in (event.data.get("signal"), *event.names) if name]
            state |= dict.fromkeys(signal_names(kind, known, index, last), bool(event.data.get("value")))
    assert all(state.get(f"digital_out:{number}") for number in range(1, 5)), state
