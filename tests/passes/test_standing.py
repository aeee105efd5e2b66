"""Controllers whose stop points hold the program against one that runs ahead over all moves."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.kept_frames import tool_one

KUKA = "kuka_kr6r900sixx"
HEAD = """VAR seen: INT = 0
VAR watch: CLOCK
VAR part: INTERRUPT
VAR passed: REAL
VAR p: POSE
TRAP counted()
    seen = seen + 1
END TRAP
PROCEDURE watched()
    INTERRUPT DELETE part
END PROCEDURE
PROCEDURE main()
    p = {x: 500, y: 50, z: 400, a: 0, b: 180, c: 0}
    MOVE TO p
    CONNECT part TO counted
    ARM part ON edge WHEN $timer[1] > 0.3
    $timer[1] = 0
    $timer_stopped[1] = FALSE
    MOVE LINEAR TO offset(p, 0, 0, 60) SPEED 100 mm/s
"""
TAIL = "\n    SET do[1] TO {}\nEND PROCEDURE\n"
# What stands behind a move of 0.6 s during which the interrupt comes, and what holds then.
CASES = [
    ("INTERRUPT DELETE part", "seen = 1"),
    ("watched()", "seen = 1"),
    ("IF seen = 1 THEN p.x = 1", "p.x = 1"),
    ("passed = $timer[1]", "passed > 0.55"),
    (
        "CLOCK RESET watch\n    CLOCK START watch\n    MOVE LINEAR TO p SPEED 100 mm/s\n    CLOCK STOP watch",
        "clock_seconds(watch) > 0.55",
    ),
]


@pytest.mark.parametrize(("behind", "holds"), CASES)
def test_nothing_comes_before_the_robot_stands(behind: str, holds: str) -> None:
    text = HEAD + "    " + behind + TAIL.format(holds)
    read = read_sources([source_from_text("p.rpl", text)], "rpl", Diagnostics())
    assert [each[2] for each in run_program(read.program, KUKA).outputs] == [True]
    diagnostics = Diagnostics()
    written = translate_program(read, "krl", KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "krl", Diagnostics())
    result = prove_programs(read.program, back.program, KUKA, entry="main", to_entry=entry_name(back.program))
    assert result.agrees, result.as_text()


FLAGS = """/PROG  MAIN
/MN
   1:  R[1]=0 ;
   2:  F[1]=OFF ;
   3:  RUN COUNTS ;
   4:J P[1] 100% FINE    ;
   5:L P[2] 50mm/sec FINE    ;
   6:  F[1]=ON ;
   7:  WAIT    .10(sec) ;
   8:  DO[1]=(R[1]>10) ;
/POS
P[1]{
   GP1:
  UF : 0, UT : 0, CONFIG : 'N U T, 0, 0, 0',
  X = 400 mm, Y = 0 mm, Z = 100 mm, W = 180 deg, P = 0 deg, R = 0 deg
};
P[2]{
   GP1:
  UF : 0, UT : 0, CONFIG : 'N U T, 0, 0, 0',
  X = 400 mm, Y = 100 mm, Z = 100 mm, W = 180 deg, P = 0 deg, R = 0 deg
};
/END
"""
COUNTS = """/PROG  COUNTS
/MN
   1:  LBL[1] ;
   2:  WAIT    .10(sec) ;
   3:  R[1]=R[1]+1 ;
   4:  IF F[1]=OFF,JMP LBL[1] ;
/POS
/END
"""


def test_a_flag_for_another_task_waits_for_the_robot() -> None:
    sources = [source_from_text("MAIN.LS", FLAGS)]
    read = read_sources([*sources, source_from_text("COUNTS.LS", COUNTS)], "tp", Diagnostics())
    written = translate_program(read, "krl", "fanuc_lrmate200id", None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "krl", Diagnostics())
    result = run_program(back.program, "fanuc_lrmate200id", None, written.renamed.get("MAIN", "MAIN"), 60.0)
    assert [each[2] for each in result.outputs] == [True]


LISTING = """/PROG  MAIN
/MN
   1:  UFRAME_NUM=0 ;
   2:J P[1] 50% FINE ;
   3:  R[1]=0 ;
   4:  LBL[1] ;
   5:  R[1]=R[1]+1 ;
   6:L P[2] 200mm/sec FINE DB 30mm,CALL ADD(R[1]) ;
   7:L P[1] 200mm/sec FINE TB .10sec,CALL ADD(10) ;
   8:  IF R[1]<2,JMP LBL[1] ;
   9:  R[1]=50 ;
  10:  IF (R[24]=23),DO[1]=ON ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,	CONFIG : 'N U T, 0, 0, 0',
	X = 420.000 mm,	Y = 0.000 mm,	Z = 0.000 mm,
	W = 180.000 deg,	P = 0.000 deg,	R = 0.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,	CONFIG : 'N U T, 0, 0, 0',
	X = 420.000 mm,	Y = 100.000 mm,	Z = 0.000 mm,
	W = 180.000 deg,	P = 0.000 deg,	R = 0.000 deg
};
/END
"""
ADD = "/PROG  ADD\n/MN\n   1:  R[24]=R[24]+AR[1] ;\n/POS\n/END\n"


def test_a_jump_back_from_a_move_finds_it_still_going_on() -> None:
    kept = "[*NUMREG*]$NUMREG  Storage: CMOS  Access: RW  : ARRAY[1,200] OF Numeric Reg\n  [24] = 0  ''\n"
    sources = [source_from_text("MAIN.LS", LISTING), source_from_text("ADD.LS", ADD), tool_one()]
    sources.append(source_from_text("NUMREG.VA", kept))
    read = read_sources(sources, "tp", Diagnostics())
    written = translate_program(read, "krl", "fanuc_lrmate200id", None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "krl", Diagnostics())
    ran = run_program(back.program, "fanuc_lrmate200id", entry="MAIN")
    assert [each[2] for each in ran.outputs] == [True]
