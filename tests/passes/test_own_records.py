"""Records of a program that are called like a neutral one: KRL's LOAD beside the loads of tool data."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
LOADED = """DEF JOB()
BAS(#INITMOV,0)
$TOOL={X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0}
LOAD_DATA[2].M=3.0
$LOAD=LOAD_DATA[2]
PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 10.0,A6 0.0}
$OUT[1]=$LOAD.M==3.0
$LOAD.M=1.5
$OUT[2]=$LOAD.M+LOAD_DATA[2].M==4.5
END
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
def test_a_load_of_the_source_beside_tools(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.src", LOADED)], "krl", diagnostics)
    translation = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors
    entry = entry_name(read.program, None)
    result = run_program(back.program, KUKA, None, translation.renamed.get(entry, entry) if entry else None, 20.0)
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True, True]
