"""An interrupt that brakes, moves away and resumes: the rest of the braked move is dropped, the move away is made."""

import pytest

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
PROGRAM = """DEF demo()
DECL E6POS P
INTERRUPT DECL 22 WHEN $IN[3] DO AWAY( )
PTP {A1 0.0,A2 -80.0,A3 100.0,A4 0.0,A5 70.0,A6 0.0}
P=$POS_ACT
SEEK( )
INTERRUPT OFF 22
$OUT[13]=FALSE
IF ABS($POS_ACT.Z-P.Z-20.0)<0.5 THEN
  $OUT[1]=TRUE
ENDIF
IF ($POS_ACT.Y-P.Y>1.0) AND ($POS_ACT.Y-P.Y<40.0) THEN
  $OUT[2]=TRUE
ENDIF
END
DEF SEEK( )
INTERRUPT ON 22
$VEL.CP=0.05
$OUT[13]=TRUE
LIN_REL {Y 60.0}
WAIT SEC 0
END
DEF AWAY( )
INTERRUPT OFF 22
BRAKE
$VEL.CP=0.5
LIN_REL {Z 20.0}
RESUME
END
"""
CELL = '[[reaction]]\nwhen = "do13"\nafter = 0.3\nsignal = "di3"\nvalue = true\n'


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
def test_the_move_away_is_made(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("demo.src", PROGRAM)], "krl", diagnostics)
    written = translate_program(read, target, ROBOT, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, ROBOT, parse_cell(CELL), written.renamed.get("demo", "demo"))
    assert [value for _, _, value in result.outputs] == [True, False, True, True]
