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


CLEARED = """ENTRY main
MODULE feeding
    VAR hand: POSE = {x: 0, y: 0, z: 200, a: 0, b: 0, c: 0}
    VAR start: POSE = {x: 900, y: -100, z: 500, a: 0, b: 180, c: 0}
    VAR far: POSE = {x: 900, y: 150, z: 500, a: 0, b: 180, c: 0}
    VAR arrived: BOOL = FALSE
    PROCEDURE main()
        VAR stood: VECTOR
        $tool = hand
        MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0} JOINT SPEED 50 %
        MOVE LINEAR TO start SPEED 250 mm/s
        DECLARE INTERRUPT 21 WHEN di[3] DO stop_feed()
        INTERRUPT ON 21
        SET do[13] TO ON
        feed_on()
        INTERRUPT OFF 21
        stood = current_position()
        MOVE LINEAR TO start SPEED 250 mm/s
        SET do[1] TO NOT arrived
        SET do[2] TO stood.y > -95.0 AND stood.y < 0.0
    END PROCEDURE
    PROCEDURE feed_on()
        MOVE LINEAR TO far SPEED 80 mm/s
        arrived = TRUE
    END PROCEDURE
    PROCEDURE stop_feed()
        STOP MOTION
        CLEAR MOTION
        RESUME LEVEL
    END PROCEDURE
END MODULE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "tp"])
def test_a_routine_that_drops_the_motion_and_resumes(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("feeding.rpl", CLEARED)], "rpl", diagnostics)
    written = translate_program(read, target, "kuka_kr16_2", None, diagnostics)
    lost = [item.as_text() for item in diagnostics.of(Severity.LOSS) if item.code.name != "angles-normalised"]
    assert not lost
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = back.program.entry or written.renamed.get("main", "main")
    result = run_program(back.program, "kuka_kr16_2", parse_cell(CELL), entry)
    assert [value for _, _, value in result.outputs] == [True, True, True]
