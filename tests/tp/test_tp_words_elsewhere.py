"""Words of TP in other languages: the last thing each program does is to switch an output on where the manual's
expectation holds, before and after translation, and nothing of it is refused.
"""

from __future__ import annotations

import pytest
from tp_reading_helpers import ROBOT, listing

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

CELL = '[[input]]\ntime = 0.0\nsignal = "DI[1]"\nvalue = true\n\n[[input]]\ntime = 0.0\nsignal = "RI1"\nvalue = true\n'
START = "UFRAME_NUM=0\nUTOOL_NUM=1\nJ P[1] 50% FINE\nL P[2] 200mm/sec FINE\n"
FRAMES = """[*SYSTEM*]$MNUTOOL  Storage: SHADOW  Access: RW  : ARRAY[1,10] OF POSITION
     [1,1] =
  Group: 1   Config: N D B, 0, 0, 0
  X:     0.000   Y:     0.000   Z:     0.000
  W:     0.000   P:     0.000   R:     0.000
"""
EVERY = ("krl", "rapid", "urscript", "vplus", "inform", "rpl")

WORDS = (
    ("R[1]=7.9\nR[2]=R[1] DIV 2\nIF R[2]=3,DO[1]=ON", EVERY),
    # signals by computed numbers, of a group too; named inputs as numbers
    ("R[1]=106\nDO[R[1]]=ON\nR[2]=101\nR[3]=DI[R[2]]\nIF (R[3]=0 AND DO[106]),DO[1]=(ON)", EVERY),
    ("R[1]=1\nGO[R[1]]=3\nF[100]=ON\nR[2]=RI[1]\nIF (F[100] AND R[2]=1 AND GO[1]=3),DO[1]=(ON)", ("rapid", "rpl")),
    ("R[1]=0\nDO[3]=ON\nIF DI[1]<>DO[3],R[1]=9\nIF DI[1]=DO[3],R[1]=R[1]+1\nIF R[1]=1,DO[1]=ON", EVERY),
    # frames by their variables, components by computed numbers
    ("PR[1]=P[2]\nR[1]=3\nIF (PR[1,R[1]]=200) THEN\nDO[1]=ON\nENDIF", EVERY),
    ("SR[1]='12abc'\nR[1]=SR[1]\nIF R[1]=12,DO[1]=ON", EVERY),
    # what an action on the path sets is worked out when it comes
    (
        START + "R[1]=0\nL P[3] 100mm/sec CNT50 TB .10sec,R[1]=4\nL P[4] 100mm/sec FINE\nIF R[1]=4,DO[1]=ON",
        ("krl", "rapid", "urscript", "vplus", "rpl"),
    ),
    (START + "L P[3] 100mm/sec FINE TB .10sec,DO[1]=(DI[1] AND !DI[2])", ("krl", "rapid", "urscript", "vplus", "rpl")),
    (START + "L P[3] 100mm/sec FINE TB .10sec,F[3]=ON\nWAIT .10(sec)\nDO[1]=(F[3])", EVERY),
    (START + "L P[3] 100mm/sec FINE TB .10sec,DO[2]=PULSE,0.4sec\nWAIT 1.0(sec)\nDO[1]=ON", EVERY),
)
CASES = [(lines, target) for lines, targets in WORDS for target in targets]


def elsewhere(lines: str, target: str) -> list[bool]:
    """What the outputs become in turn, after translation."""
    files = [source_from_text("main.ls", listing(lines)), source_from_text("sysframe.va", FRAMES)]
    given = read_sources(files, "tp", Diagnostics())
    report = Diagnostics()
    done = translate_program(given, target, ROBOT, None, report)
    assert not report.has_losses, [item.as_text() for item in report]
    again = Diagnostics()
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], target, again)
    assert not again.has_errors, [item.as_text() for item in again]
    named = with_signal_names(back.program, done.program)
    cell = in_words_of(parse_cell(CELL), given.program, named)
    result = run_program(named, ROBOT, cell, done.renamed.get("MAIN", "MAIN"), 120.0)
    assert result.status == "finished", result.fault
    return [bool(value) for _, _, value in result.outputs]


@pytest.mark.parametrize(("lines", "target"), CASES)
def test_words_elsewhere(lines: str, target: str) -> None:
    assert elsewhere(lines, target)[-1]
