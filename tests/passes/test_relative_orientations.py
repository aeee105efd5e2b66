"""A straight move by an amount whose orientation is constant turns nothing, whatever angles it says."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
PROGRAM = """DEF demo()
DECL E6POS P
PTP {A1 0.0,A2 -80.0,A3 100.0,A4 0.0,A5 60.0,A6 0.0}
P=$POS_ACT
$ORI_TYPE=#CONSTANT
LIN_REL {Z 10.0,B 5.0}
WAIT SEC 0
IF (ABS($POS_ACT.Z-P.Z-10.0)<0.05) AND (ABS($POS_ACT.B-P.B)<0.05) THEN
  $OUT[1]=TRUE
ENDIF
END
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
def test_nothing_turns(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("demo.src", PROGRAM)], "krl", diagnostics)
    written = translate_program(read, target, ROBOT, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, ROBOT, None, written.renamed.get("demo", "demo"))
    assert [value for _, _, value in result.outputs] == [True]
