"""Numbers of signals that a program works out: one below the first is a fault, as an index of an array is."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

KRL = "DEF a()\nDECL INT i\ni={number}\n$OUT[i]=TRUE\n$OUT[5]=$OUT[i]\nEND\n"
TP = "/PROG A\n/MN\n   1:  R[1]={number} ;\n   2:  DO[R[1]]=ON ;\n/POS\n/END\n"
INFORM = "/JOB\n//NAME A\n//INST\nNOP\nSET B000 {number}\nDOUT OT#(B000) ON\nEND\n"


@pytest.mark.parametrize(
    ("language", "name", "text"), [("krl", "a.src", KRL), ("tp", "A.LS", TP), ("inform", "A.JBI", INFORM)]
)
def test_there_is_no_signal_of_the_number_zero(language: str, name: str, text: str) -> None:
    """KRL, TP and INFORM count signals from 1 (System Variables: $OUT[1..]; HandlingTool: DO[1]; INFORM: OT#(1))."""
    ends = []
    for number in (0, 1):
        sources = [source_from_text(name, text.format(number=number))]
        ends.append(run_program(read_sources(sources, language, Diagnostics()).program, None))
    assert ends[0].status == "fault" and ends[0].fault is not None and "number 0" in ends[0].fault.message
    assert ends[1].status == "finished" and ends[1].outputs
